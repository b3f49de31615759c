//! Conjunctions of linear comparisons over a box, decided in exact fractions.

use num_rational::BigRational as Fraction;
use num_traits::{One, Signed, ToPrimitive, Zero};
use pleach_guards::{Comparison, Interval, LinearForm, Relation};

use super::simplex::{LinearProgram, Outcome};

/// Where a number of linear inequalities hold, within a box.
pub(super) struct Polyhedron<'a> {
    variables: &'a [&'a str],
    ranges: &'a [Interval],
    inequalities: Vec<Inequality>,
}

/// A linear form that is to be at most 0, or less if it is strict.
struct Inequality {
    form: LinearForm<Fraction>,
    strict: bool,
}

/// What a polyhedron is found to hold.
#[derive(Debug, PartialEq)]
pub(super) enum Content {
    /// This point, far from its faces if there is room; up to rounding.
    Point(Vec<f64>),
    /// Nothing: a sum of its inequalities contradicts itself, which was verified.
    Nothing,
}

/// The point that has most room, or the multipliers of a contradiction.
type Widest = Result<Vertex, Vec<Fraction>>;

struct Vertex {
    room: Fraction,
    point: Vec<f64>,
    multipliers: Vec<Fraction>,
}

impl<'a> Polyhedron<'a> {
    /// Where those of `comparisons` hold that are linear, with a range for each variable.
    pub(super) fn new(
        comparisons: &[Comparison],
        variables: &'a [&'a str],
        ranges: &'a [Interval],
    ) -> Self {
        let inequalities = comparisons.iter().filter_map(Inequality::of).collect();
        Polyhedron { variables, ranges, inequalities }
    }

    /// A point, or that there is none; `None` if neither could be established.
    ///
    /// The point sought first is the one farthest from all faces, up to a distance of 1 in each
    /// coordinate. Where no point has any distance, only the strict faces must be avoided.
    pub(super) fn content(&self) -> Option<Content> {
        let widest = match self.widest(Inequality::extent)? {
            Ok(vertex) => vertex,
            Err(multipliers) => return self.refuted_by(&multipliers),
        };
        let touching = !widest.room.is_positive();
        if !touching || !self.inequalities.iter().any(|inequality| inequality.strict) {
            return Some(Content::Point(widest.point));
        }
        match self.widest(Inequality::strictness)? {
            Ok(vertex) if vertex.room.is_positive() => Some(Content::Point(vertex.point)),
            Ok(Vertex { multipliers, .. }) | Err(multipliers) => self.refuted_by(&multipliers),
        }
    }

    /// Maximises the room between a point and the faces, of which `share` says how much of it each
    /// inequality must leave. The last unknown of the program is the room.
    fn widest(&self, share: fn(&Inequality) -> Fraction) -> Option<Widest> {
        let axes = self.axes();
        let room = axes.iter().map(Axis::unknowns).sum::<usize>();
        let unit = |unknown: usize| {
            let mut row = vec![Fraction::zero(); room + 1];
            row[unknown] = Fraction::one();
            row
        };

        let mut rows = Vec::new();
        for inequality in &self.inequalities {
            let mut row = vec![Fraction::zero(); room + 1];
            let mut bound = -inequality.form.constant();
            for (variable, coefficient) in inequality.form.coefficients() {
                let axis = &axes[self.variables.iter().position(|name| *name == variable)?];
                axis.write(coefficient, &mut row);
                bound -= coefficient * &axis.origin;
            }
            row[room] = share(inequality);
            rows.push((row, bound));
        }
        for axis in &axes {
            rows.extend(axis.length.iter().map(|length| (unit(axis.column), length.clone())));
        }
        rows.push((unit(room), Fraction::one()));

        match (LinearProgram { objective: unit(room), rows }).solve() {
            Outcome::Unbounded => None,
            Outcome::Infeasible { multipliers } => Some(Err(multipliers)),
            Outcome::Optimal { point, multipliers } => {
                let coordinates = axes.iter().zip(self.ranges).map(|(axis, range)| {
                    let value = axis.value(&point).to_f64()?;
                    Some(value.clamp(range.lower(), range.upper()))
                });
                let room = point[room].clone();
                Some(Ok(Vertex { room, point: coordinates.collect::<Option<_>>()?, multipliers }))
            }
        }
    }

    fn axes(&self) -> Vec<Axis> {
        let axes = self.ranges.iter().scan(0, |column, range| {
            let axis = Axis::of(*range, *column);
            *column += axis.unknowns();
            Some(axis)
        });
        axes.collect()
    }

    /// Whether the inequalities, multiplied and added, say that something is below 0 which nowhere
    /// in the box is (Farkas' lemma). This does not rely on how the multipliers were found.
    fn refuted_by(&self, multipliers: &[Fraction]) -> Option<Content> {
        let zero = Fraction::zero();
        let used = || self.inequalities.iter().zip(multipliers).filter(|(_, by)| **by != zero);
        if used().any(|(_, multiplier)| multiplier.is_negative()) {
            return None;
        }
        let mut least: Fraction =
            used().map(|(inequality, by)| inequality.form.constant() * by).sum();
        for (variable, range) in self.variables.iter().zip(self.ranges) {
            let terms = used()
                .filter_map(|(inequality, by)| Some(inequality.form.coefficient(variable)? * by));
            let slope: Fraction = terms.sum();
            if slope != zero {
                let end = if slope.is_positive() { range.lower() } else { range.upper() };
                least += slope * Fraction::from_float(end)?;
            }
        }
        let strict = used().any(|(inequality, _)| inequality.strict);
        (least.is_positive() || strict && least == zero).then_some(Content::Nothing)
    }
}

impl Inequality {
    fn of(comparison: &Comparison) -> Option<Self> {
        let Comparison { left, relation, right } = comparison;
        let difference = match relation {
            Relation::AtMost | Relation::LessThan => left - right,
            Relation::AtLeast | Relation::MoreThan => right - left,
        };
        let form = difference.linear_form_over(&|number| Fraction::from_float(number))?;
        Some(Inequality { form, strict: relation.is_strict() })
    }

    /// By how much the form can change when each coordinate changes by at most 1. Where it is
    /// constant, only a strict inequality needs any room.
    fn extent(&self) -> Fraction {
        let extent: Fraction = self.form.coefficients().map(|(_, factor)| factor.abs()).sum();
        if extent.is_zero() { self.strictness() } else { extent }
    }

    fn strictness(&self) -> Fraction {
        if self.strict { Fraction::one() } else { Fraction::zero() }
    }
}

/// A coordinate in terms of unknowns that are not negative: the distance from the lower end of its
/// range, or that below the upper end, or, where there are no ends, the difference of two unknowns.
struct Axis {
    origin: Fraction,
    direction: Option<Fraction>,
    length: Option<Fraction>,
    column: usize,
}

impl Axis {
    /// A float that is not finite is no fraction, so that infinite ends fall away.
    fn of(range: Interval, column: usize) -> Axis {
        let lower = Fraction::from_float(range.lower());
        let upper = Fraction::from_float(range.upper());
        let length = lower.as_ref().zip(upper.as_ref()).map(|(lower, upper)| upper - lower);
        let (origin, direction) = match (lower, upper) {
            (Some(lower), _) => (lower, Some(Fraction::one())),
            (None, Some(upper)) => (upper, Some(-Fraction::one())),
            (None, None) => (Fraction::zero(), None),
        };
        Axis { origin, direction, length, column }
    }

    fn unknowns(&self) -> usize {
        if self.direction.is_some() { 1 } else { 2 }
    }

    /// Adds `coefficient` times the coordinate, without its origin, to a row.
    fn write(&self, coefficient: &Fraction, row: &mut [Fraction]) {
        match &self.direction {
            Some(direction) => row[self.column] += coefficient * direction,
            None => {
                row[self.column] += coefficient;
                row[self.column + 1] -= coefficient;
            }
        }
    }

    fn value(&self, point: &[Fraction]) -> Fraction {
        let distance = match &self.direction {
            Some(direction) => &point[self.column] * direction,
            None => &point[self.column] - &point[self.column + 1],
        };
        &self.origin + distance
    }
}
