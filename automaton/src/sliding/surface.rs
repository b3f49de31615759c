//! The surface between two locations, and what the flows of both do on it.

mod forms;

use pleach_discrete::{Event, Location};
use pleach_guards::{
    Comparison, Expression, Predicate, Substitution, always, constant, maximum, never, not,
};

use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::flow::{Flow, Rate};
use crate::reset::{Assignment, NewValue, Reset};

use forms::{are_opposite, conjuncts, margin, negated, plus, times, without};

/// A surface σ = 0 between two locations.
pub(super) struct Surface<L, S> {
    /// Before it, where σ < 0, and behind it.
    pub(super) sides: [L; 2],
    /// The rows that lead from the first side to the second, and back.
    pub(super) crossings: [usize; 2],
    /// σ.
    margin: Expression,
    /// The comparison σ ≥ 0 or σ > 0.
    comparison: Comparison,
    /// What else is asked of a crossing.
    rests: [Predicate; 2],
    /// dσ/dt in the flow of each side.
    speeds: [Expression; 2],
    motions: Vec<Motion>,
    /// What the names of parameters stand for.
    numbers: Substitution,
    state: std::marker::PhantomData<fn() -> S>,
}

/// How a coordinate moves on both sides.
struct Motion {
    coordinate: &'static str,
    rates: [Expression; 2],
    /// ∂σ/∂x.
    slope: Expression,
}

/// States beyond a surface by this, relative to the right side of the comparison or to 1 if that is
/// larger, are on it.
const ON_IT: f64 = 1e-9;
/// A state that leaves a surface is put beside it by this, relative to the same, so that rounding does
/// not put it on the other side.
const BESIDE: f64 = 1e-12;

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// The surfaces between the locations, in the order of the rows.
    pub(super) fn surfaces(&self) -> Vec<Surface<L, S>> {
        let mut surfaces: Vec<Surface<L, S>> = Vec::new();
        for there in 0..self.rows.len() {
            for back in there + 1..self.rows.len() {
                let sides = [self.rows[there].source, self.rows[there].target];
                let is_new =
                    |known: &Surface<L, S>| !known.sides.iter().all(|side| sides.contains(side));
                if surfaces.iter().all(is_new) {
                    surfaces.extend(self.surface([there, back]));
                }
            }
        }
        surfaces
    }

    /// The surface that these two rows cross, if they do cross one.
    fn surface(&self, crossings: [usize; 2]) -> Option<Surface<L, S>> {
        let [there, back] = crossings.map(|number| &self.rows[number]);
        let sides = [there.source, there.target];
        if sides != [back.target, back.source] || sides[0] == sides[1] {
            return None;
        }
        let [there, back] = crossings.map(|number| {
            let transition = &self.graph[petgraph::graph::EdgeIndex::new(number)];
            let crosses = transition.urgency.is_forced() && transition.reset.is_identity();
            crosses.then(|| conjuncts(transition.guard.predicate()))
        });
        let (there, back) = (there?, back?);
        let numbers = self.numbers();
        let (here, beyond, comparison) = there.iter().enumerate().find_map(|(here, one)| {
            let Predicate::Comparison(one) = one else { return None };
            let beyond = back.iter().position(|other| {
                matches!(other, Predicate::Comparison(other) if are_opposite(one, other, &numbers))
            });
            Some((here, beyond?, one.clone()))
        })?;
        let margin = margin(&comparison);
        let motions = self.motions(sides, &margin)?;
        let speeds = [0, 1].map(|side| {
            let terms = motions.iter().map(|one| times(&one.slope, &one.rates[side]));
            terms.reduce(plus).unwrap_or_else(|| constant(0.0))
        });
        let numbers = self.numbers();
        (speeds[0] != speeds[1]).then(|| Surface {
            sides,
            crossings,
            margin,
            comparison,
            rests: [without(there, here), without(back, beyond)],
            speeds,
            motions,
            numbers,
            state: std::marker::PhantomData,
        })
    }

    /// How the coordinates move on both sides that do so, or that the margin reads.
    fn motions(&self, sides: [L; 2], margin: &Expression) -> Option<Vec<Motion>> {
        let flows = sides.map(|side| {
            let flow = self.mode(side).and_then(|mode| mode.flow.as_ref());
            flow.map_or(Some(&[][..]), Flow::rates)
        });
        let [one, other] = flows;
        let flows = [one?, other?];
        let rate = |rates: &[Rate], name: &str| {
            let given = rates.iter().find(|rate| rate.coordinate() == name);
            given.map_or_else(|| constant(0.0), |rate| rate.rate().clone())
        };
        let motion = |coordinate: &&'static str| Motion {
            coordinate,
            rates: flows.map(|rates| rate(rates, coordinate)),
            slope: margin.derivative(coordinate),
        };
        Some(self.names().iter().map(motion).collect())
    }
}

impl<L: Location, S: Coordinates> Surface<L, S> {
    /// The surface and the side on which a row begins to cross it.
    pub(super) fn crossed_by(&self, row: usize) -> Option<(&Self, usize)> {
        let side = self.crossings.iter().position(|number| *number == row)?;
        Some((self, side))
    }

    /// The coordinates that tell where it is.
    pub(super) fn variables(&self) -> impl Iterator<Item = &'static str> {
        let names = self.margin.variables();
        self.motions.iter().map(|one| one.coordinate).filter(move |name| names.contains(name))
    }

    /// Where the flow of a side leads to the surface.
    fn leads(&self, side: usize) -> Predicate {
        let speed = &self.speeds[side];
        if side == 0 { speed.more_than(0.0) } else { speed.less_than(0.0) }
    }

    /// Where it does not.
    fn leads_away(&self, side: usize) -> Predicate {
        let speed = &self.speeds[side];
        if side == 0 { speed.at_most(0.0) } else { speed.at_least(0.0) }
    }

    /// A small part of the right side of the comparison, or of 1 if that is larger.
    fn small(&self, part: f64) -> Expression {
        let right = self.comparison.right.abs();
        match self.number(&right) {
            Some(right) => constant(part * right.max(1.0)),
            None => part * maximum([constant(1.0), right]),
        }
    }

    /// What is asked of a crossing from a side, beside its guard: for it to end on the surface, and
    /// for it to lead across.
    pub(super) fn entry(&self, side: usize) -> [Predicate; 2] {
        let far = 1 - side;
        let tolerance = self.small(ON_IT);
        let [on, beyond] = match side {
            0 => [self.margin.at_most(&tolerance), self.margin.more_than(&tolerance)],
            _ => {
                let tolerance = negated(&tolerance);
                [self.margin.at_least(&tolerance), self.margin.less_than(&tolerance)]
            }
        };
        let enters = self.leads(side) & self.leads(far) & on;
        [enters, self.leads(side) & self.leads_away(far) | beyond]
    }

    /// Where sliding ends on a side: its flow leads to the surface no longer, or what else is asked of
    /// a crossing from there fails.
    pub(super) fn exit(&self, side: usize) -> Predicate {
        match &self.rests[side] {
            rest if *rest == always() => self.leads_away(side),
            rest => self.leads_away(side) | not(rest.clone()),
        }
    }

    /// The mixture of both flows that stays on the surface.
    pub(super) fn flow(&self) -> Flow<S> {
        let [near, far] = &self.speeds;
        let share = near / (near - far);
        let mixed = |one: &Motion| {
            let [first, second] = &one.rates;
            if first == second {
                first.clone()
            } else {
                plus(first.clone(), &share * (second - first))
            }
        };
        let pivot = self.pivot();
        let rates = self.motions.iter().map(|one| {
            let rate = match &pivot {
                Some((place, slope)) if place.coordinate == one.coordinate => {
                    self.pivot_rate(place, *slope, &mixed)
                }
                _ => mixed(one),
            };
            (one.coordinate, rate)
        });
        let moving = rates.filter(|(_, rate)| *rate != constant(0.0));
        moving.map(|(coordinate, rate)| Rate::new(coordinate, rate)).collect::<Vec<_>>().into()
    }

    /// The rate of the pivot that makes up for those of all others: σ is constant but for rounding.
    fn pivot_rate(
        &self,
        pivot: &Motion,
        slope: f64,
        mixed: &impl Fn(&Motion) -> Expression,
    ) -> Expression {
        let others = self.motions.iter().filter(|one| one.coordinate != pivot.coordinate);
        let terms = others.map(|one| times(&one.slope, &mixed(one)));
        let rest = terms.reduce(plus).unwrap_or_else(|| constant(0.0));
        if rest == constant(0.0) { rest } else { rest / -slope }
    }

    /// If σ is of degree one: a coordinate that the two flows move differently, the one with the
    /// largest coefficient in σ, and that coefficient.
    fn pivot(&self) -> Option<(&Motion, f64)> {
        let mut slopes = Vec::new();
        for one in &self.motions {
            slopes.push((one, self.number(&one.slope)?));
        }
        let different = slopes.into_iter().filter(|(one, _)| one.rates[0] != one.rates[1]);
        let largest = different.max_by(|(_, one), (_, other)| one.abs().total_cmp(&other.abs()));
        largest.filter(|(_, slope)| *slope != 0.0)
    }

    /// The expression as a number, if it is one.
    fn number(&self, expression: &Expression) -> Option<f64> {
        let form = expression.substitute(&self.numbers).linear_form()?;
        form.coefficients().next().is_none().then_some(*form.constant())
    }

    /// The reset that puts a state near the surface on it.
    pub(super) fn onto(&self) -> Reset<S> {
        self.moved(&self.margin)
    }

    /// The reset that puts a state on the surface beside it, on a side.
    pub(super) fn off(&self, side: usize) -> Reset<S> {
        let (margin, least) = (self.margin.clone(), self.small(BESIDE));
        self.moved(&if side == 0 { margin + least } else { margin - least })
    }

    /// The reset that lowers σ by `change`: by the pivot, or else along the difference of the flows.
    fn moved(&self, change: &Expression) -> Reset<S> {
        let assign = |one: &Motion, step: Expression| {
            let value = pleach_guards::variable(one.coordinate) - step;
            Assignment::new(one.coordinate, NewValue::Exactly(value))
        };
        if let Some((pivot, slope)) = self.pivot() {
            let step = match slope {
                1.0 => change.clone(),
                -1.0 => negated(change),
                _ => change / slope,
            };
            return assign(pivot, step).into();
        }
        let [near, far] = &self.speeds;
        let different = self.motions.iter().filter(|one| one.rates[0] != one.rates[1]);
        let assignments = different.map(|one| {
            let [first, second] = &one.rates;
            assign(one, change * (first - second) / (near - far))
        });
        assignments.collect::<Vec<_>>().into()
    }

    /// What becomes of a predicate on the surface, where σ is 0.
    pub(super) fn truth(&self, predicate: &Predicate) -> Predicate {
        self.on_it(predicate, &|one, _| !one.relation.is_strict())
    }

    /// What becomes of an invariant on the surface, which belongs to both sides.
    pub(super) fn closure(&self, invariant: &Predicate) -> Predicate {
        self.on_it(invariant, &|_, is_negated| !is_negated)
    }

    /// The predicate with comparisons of σ with 0 decided.
    fn on_it(
        &self,
        predicate: &Predicate,
        decide: &impl Fn(&Comparison, bool) -> bool,
    ) -> Predicate {
        self.decided(predicate, decide, false)
    }

    fn decided(
        &self,
        predicate: &Predicate,
        decide: &impl Fn(&Comparison, bool) -> bool,
        is_negated: bool,
    ) -> Predicate {
        let all = |parts: &[Predicate]| -> Vec<Predicate> {
            parts.iter().map(|part| self.decided(part, decide, is_negated)).collect()
        };
        match predicate {
            Predicate::Comparison(one) if self.is_its_own(one) => {
                if decide(one, is_negated) {
                    always()
                } else {
                    never()
                }
            }
            Predicate::Not(inner) => match self.decided(inner, decide, !is_negated) {
                inner if inner == always() => never(),
                inner if inner == never() => always(),
                inner => not(inner),
            },
            Predicate::All(parts) => {
                let parts = all(parts);
                if parts.contains(&never()) { never() } else { Predicate::all(parts) }
            }
            Predicate::Any(parts) => {
                let parts = all(parts);
                if parts.contains(&always()) { always() } else { Predicate::any(parts) }
            }
            other => other.clone(),
        }
    }

    /// Whether the comparison is one of σ with 0, either way.
    fn is_its_own(&self, one: &Comparison) -> bool {
        let turned = Comparison { relation: one.relation.opposite(), ..one.clone() };
        [one, &turned].into_iter().any(|one| are_opposite(one, &self.comparison, &self.numbers))
    }
}
