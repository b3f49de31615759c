//! Where predicates hold, as half-spaces.

use pleach_guards::{Comparison, Expression, Interval, Predicate, Ranges, Relation, Truth};
use thiserror::Error;

use super::polytope::{Polytope, Template, over_box};
use super::vector::{around_zero, dot, radius};

/// How many alternatives the disjunctive form of a predicate may have.
const ALTERNATIVES: usize = 256;

/// The states with d · x ≤ b, where d is known up to a spread.
#[derive(Clone, Debug, PartialEq)]
pub struct HalfSpace {
    /// d.
    pub direction: Vec<f64>,
    /// What has to be added to the entries given, to make them those of d.
    spread: Vec<Interval>,
    /// b.
    bound: Interval,
    /// Whether the boundary is left out.
    is_open: bool,
}

/// Comparisons that hold together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Conjunction {
    /// Those that are affine, their boundaries included.
    pub half_spaces: Vec<HalfSpace>,
    /// The others.
    pub others: Vec<Comparison>,
}

/// Where a predicate holds: in one of these at least.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    /// The alternatives.
    pub alternatives: Vec<Conjunction>,
}

/// Why sets cannot be cut by a predicate.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RegionError {
    /// It rests on a function.
    #[error("`{predicate}` rests on a function or a proposition: write it as a formula")]
    Function {
        /// The predicate.
        predicate: String,
    },
    /// It has too many alternatives.
    #[error("`{predicate}` has more than {ALTERNATIVES} alternatives: split it")]
    Alternatives {
        /// The predicate.
        predicate: String,
    },
    /// It reads what is no variable of the state.
    #[error("`{predicate}` reads `{variable}`, which is no variable of the model")]
    Variable {
        /// The predicate.
        predicate: String,
        /// What it reads.
        variable: String,
    },
}

/// Variables by name, in a box.
pub(super) struct Named<'a> {
    pub names: &'a [String],
    pub sides: &'a [Interval],
}

impl Ranges for Named<'_> {
    fn range(&self, variable: &str) -> Option<Interval> {
        let place = self.names.iter().position(|name| name == variable)?;
        self.sides.get(place).copied()
    }
}

impl Region {
    /// Where `predicate` holds, or its boundary is; over these variables.
    ///
    /// # Errors
    ///
    /// [`RegionError`] if it is not made of comparisons of formulas over the variables, or has too
    /// many alternatives.
    pub fn of(predicate: &Predicate, variables: &[String]) -> Result<Self, RegionError> {
        let mut region = Region::exactly(predicate, variables)?;
        for conjunction in &mut region.alternatives {
            conjunction.half_spaces.iter_mut().for_each(|half_space| half_space.is_open = false);
        }
        Ok(region)
    }

    /// Where `predicate` holds; boundaries only where they belong to it.
    ///
    /// # Errors
    ///
    /// As for [`of`](Self::of).
    pub fn exactly(predicate: &Predicate, variables: &[String]) -> Result<Self, RegionError> {
        let text = || predicate.to_string();
        let stranger =
            predicate.variables().into_iter().find(|name| !variables.iter().any(|v| v == name));
        if let Some(variable) = stranger {
            return Err(RegionError::Variable { predicate: text(), variable: variable.to_owned() });
        }
        if !predicate.is_data() || !predicate.propositions().is_empty() {
            return Err(RegionError::Function { predicate: text() });
        }
        let cases =
            predicate.by_cases(ALTERNATIVES).and_then(|it| it.disjunctive_form(ALTERNATIVES));
        let cases = cases.map_err(|_| RegionError::Alternatives { predicate: text() })?;
        let alternatives = cases.iter().map(|case| Conjunction::of(case, variables));
        Ok(Region { alternatives: alternatives.collect() })
    }
}

impl Conjunction {
    fn of(comparisons: &[Comparison], variables: &[String]) -> Self {
        let mut conjunction = Conjunction::default();
        for comparison in comparisons {
            match HalfSpace::of(comparison, variables) {
                Some(half_space) => conjunction.half_spaces.push(half_space),
                None => conjunction.others.push(comparison.clone()),
            }
        }
        conjunction
    }

    /// How far the set stays away from it at least: the largest of the bounds that its comparisons
    /// miss by; negative where none of them tells the two apart.
    pub(super) fn clearance(&self, polytope: &Polytope, variables: &[String]) -> f64 {
        let Some(sides) = polytope.hull() else { return f64::INFINITY };
        let named = Named { names: variables, sides: &sides };
        let affine = self.half_spaces.iter().map(|half_space| {
            let opposite: Vec<f64> = half_space.direction.iter().map(|entry| -entry).collect();
            let most =
                polytope.template().position(&opposite).map(|place| polytope.bounds()[place]);
            let most = most.unwrap_or(f64::INFINITY).min(over_box(&opposite, &sides));
            (Interval::point(-most) - Interval::point(half_space.bound_over(&sides))).lower()
        });
        let others = self.others.iter().map(|other| {
            margin(other).range(&named).map_or(f64::NEG_INFINITY, |range| -range.upper())
        });
        affine.chain(others).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part of `polytope` in which it may hold; `None` if there is none.
    ///
    /// The directions of the half-spaces are in the template, or the set is cut less.
    pub fn cut(&self, polytope: &Polytope, variables: &[String]) -> Option<Polytope> {
        let sides = polytope.hull()?;
        let mut cut = polytope.clone();
        let mut has_changed = false;
        for half_space in &self.half_spaces {
            let bound = half_space.bound_over(&sides);
            let opposite: Vec<f64> = half_space.direction.iter().map(|entry| -entry).collect();
            let misses = |most: f64| most < -bound || half_space.is_open && most <= -bound;
            if let Some(place) = cut.template().position(&opposite)
                && misses(cut.bounds()[place])
            {
                return None;
            }
            if misses(over_box(&opposite, &sides)) {
                return None;
            }
            if let Some(place) = cut.template().position(&half_space.direction)
                && bound < cut.bounds()[place]
            {
                cut.cut(place, bound);
                has_changed = true;
            }
        }
        let cut = if has_changed { cut.tightened()? } else { cut };
        let sides = cut.hull()?;
        let named = Named { names: variables, sides: &sides };
        let never = |other: &Comparison| {
            !matches!(other.truth(&named), Ok(Truth::Always | Truth::Undecided))
        };
        (!self.others.iter().any(never)).then_some(cut)
    }
}

impl HalfSpace {
    /// Where a comparison holds, if it is affine.
    fn of(comparison: &Comparison, variables: &[String]) -> Option<Self> {
        let number = |value: f64| value.is_finite().then(|| Interval::point(value));
        let form = margin(comparison).linear_form_over(&number)?;
        let zero = Interval::point(0.0);
        let entry = |name: &String| form.coefficient(name).map_or(zero, |entry| -*entry);
        let entries: Vec<Interval> = variables.iter().map(entry).collect();
        let bound = *form.constant();
        let is_finite = |entry: &Interval| entry.lower().is_finite() && entry.upper().is_finite();
        (entries.iter().all(is_finite) && is_finite(&bound)).then(|| HalfSpace {
            direction: entries.iter().map(Interval::midpoint).collect(),
            spread: entries.iter().map(|entry| around_zero(radius(*entry))).collect(),
            bound,
            is_open: comparison.relation.is_strict(),
        })
    }

    /// What d · x is at most, for the states of a box that are in it.
    pub(super) fn bound_over(&self, sides: &[Interval]) -> f64 {
        (self.bound + dot(&self.spread, sides)).upper()
    }

    /// The rate of d · x, where x changes at `rates`.
    pub(super) fn rate(&self, rates: &[Interval]) -> Interval {
        let entries = self.direction.iter().zip(&self.spread);
        let entries: Vec<Interval> =
            entries.map(|(entry, spread)| Interval::point(*entry) + *spread).collect();
        dot(&entries, rates)
    }

    /// d · x ≤ b is the opposite of d · x > b: the half-space with the other side, closed.
    #[must_use]
    pub(super) fn opposite(&self) -> HalfSpace {
        HalfSpace {
            direction: self.direction.iter().map(|entry| -entry).collect(),
            spread: self.spread.clone(),
            bound: -self.bound,
            is_open: false,
        }
    }

    /// b − d · x for the points x of a set.
    fn distance(&self, set: &Polytope, sides: &[Interval]) -> Interval {
        let most = |direction: &[f64]| {
            set.bound(direction).unwrap_or(f64::INFINITY).min(over_box(direction, sides))
        };
        let opposite: Vec<f64> = self.direction.iter().map(|entry| -entry).collect();
        let along = Interval::new(-most(&opposite), most(&self.direction));
        self.bound - along.unwrap_or(Interval::WHOLE) + dot(&self.spread, sides)
    }

    /// Adds its direction and the opposite one to a template.
    pub fn add_to(&self, template: &mut Template) {
        template.add_both(&self.direction);
    }
}

/// The directions of the affine comparisons of a predicate.
pub(super) fn directions(predicate: &Predicate, variables: &[String]) -> Vec<Vec<f64>> {
    match predicate {
        Predicate::Comparison(comparison) => {
            let half_space = HalfSpace::of(comparison, variables);
            half_space.into_iter().map(|half_space| half_space.direction).collect()
        }
        Predicate::Not(inner) => directions(inner, variables),
        Predicate::All(parts) | Predicate::Any(parts) => {
            parts.iter().flat_map(|part| directions(part, variables)).collect()
        }
        _ => Vec::new(),
    }
}

/// Between which numbers the margin of a predicate in negation normal form is, in a set.
pub(super) fn margin_over(predicate: &Predicate, set: &Polytope, variables: &[String]) -> Interval {
    let joined = |parts: &[Predicate], none: f64, take: fn(f64, f64) -> f64| {
        let ranges = parts.iter().map(|part| margin_over(part, set, variables));
        let ends = ranges.fold((none, none), |(lower, upper), range| {
            (take(lower, range.lower()), take(upper, range.upper()))
        });
        Interval::new(ends.0, ends.1).unwrap_or(Interval::WHOLE)
    };
    match predicate {
        Predicate::Comparison(comparison) => {
            let Some(sides) = set.hull() else { return Interval::WHOLE };
            match HalfSpace::of(comparison, variables) {
                Some(half_space) => half_space.distance(set, &sides),
                None => {
                    let named = Named { names: variables, sides: &sides };
                    margin(comparison).range(&named).unwrap_or(Interval::WHOLE)
                }
            }
        }
        Predicate::All(parts) => joined(parts, f64::INFINITY, f64::min),
        Predicate::Any(parts) => joined(parts, f64::NEG_INFINITY, f64::max),
        _ => Interval::WHOLE,
    }
}

/// What is at least 0 where the comparison holds.
fn margin(comparison: &Comparison) -> Expression {
    match comparison.relation {
        Relation::AtMost | Relation::LessThan => &comparison.right - &comparison.left,
        Relation::AtLeast | Relation::MoreThan => &comparison.left - &comparison.right,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{FAINT, fraction, holds, points};

    fn half_space(text: &str) -> HalfSpace {
        let predicate: Predicate = text.parse().expect("a predicate");
        let Predicate::Comparison(comparison) = predicate else { panic!("it is one comparison") };
        HalfSpace::of(&comparison, &["x".to_owned()]).expect("it is affine")
    }

    /// The points where a · x is at most 1, a being the product of two numbers and no number: they lie
    /// within the bound on d · x, whether d is above a or below.
    #[test]
    fn coefficients_that_are_no_numbers_are_covered() {
        for (one, other) in [(0.1, 3.0), (0.7, 3.0), (1.1, 1.1), (0.3, 0.7), (0.9, 1.3)] {
            let half_space = half_space(&format!("{one} * ({other} * x) <= 1"));
            let gain = fraction(one) * fraction(other);
            let farthest = gain.recip();
            let along = fraction(half_space.direction[0]) * &farthest;
            let sides = [Interval::new(0.0, 20.0).expect("in order")];
            assert!(fraction(half_space.bound_over(&sides)) >= along, "{one} · {other}");
        }
    }

    /// −a · x at x = 4, where −d · x is a number, and known.
    #[test]
    fn margins_count_what_coefficients_are_off_by() {
        for (one, other) in [(0.1, 3.0), (0.7, 3.0), (1.1, 1.1), (0.3, 0.7), (0.9, 1.3)] {
            let half_space = half_space(&format!("{one} * ({other} * x) <= 0"));
            let mut template = Template::boxes(1);
            half_space.add_to(&mut template);
            let bounds = template.directions().iter().map(|direction| 4.0 * direction[0]).collect();
            let set = Polytope::new(template.into(), bounds);
            let found = half_space.distance(&set, &points(&[4.0]));
            let exact = -(fraction(one) * fraction(other) * fraction(4.0));
            assert!(holds(found, &exact), "{one} · {other}: {found}");
        }
    }

    /// From 1 to 2⁻⁶⁰ it is less than 1.
    #[test]
    fn clearances_are_rounded_down() {
        let region: Predicate = format!("x <= {FAINT}").parse().expect("a predicate");
        let variables = ["x".to_owned()];
        let region = Region::of(&region, &variables).expect("it is affine");
        let set = Polytope::around(Template::boxes(1), &points(&[1.0]));
        let clearance = region.alternatives[0].clearance(&set, &variables);
        assert!(fraction(clearance) <= fraction(1.0) - fraction(FAINT));
    }
}
