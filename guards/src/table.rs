//! Tables of values, and how they are read between their points.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

use crate::expression::{Choice, Expression};
use crate::interval::Interval;
use crate::predicate::Comparison;

/// A function of one number that is given at points.
///
/// Before the first point it has the value of the first, after the last that of the last.
///
/// ```
/// use pleach_guards::{Table, variable};
///
/// let demand = Table::linear([(0.0, 1.0), (10.0, 3.0), (20.0, 2.0)])?;
/// let formula = demand.at(variable("t")) * 2.0;
/// assert_eq!(formula.evaluate(&[("t", 5.0)])?, 4.0);
/// assert_eq!(formula.to_string(), "linear((0, 1), (10, 3), (20, 2), t) · 2");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    interpolation: Interpolation,
    /// In the order of their places, of which no two are the same.
    points: Arc<[(f64, f64)]>,
}

/// What a table says between its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Interpolation {
    /// The straight line from one point to the next.
    Linear,
    /// The value of the point before.
    Steps,
    /// 0, and at a point no number: the slope of steps.
    Flat,
}

impl Table {
    /// The table that joins its points, pairs of place and value, by straight lines.
    ///
    /// # Errors
    ///
    /// [`InvalidTable`] unless there is a point, all numbers and their differences are finite, and each
    /// place is larger than the one before.
    pub fn linear(points: impl Into<Vec<(f64, f64)>>) -> Result<Table, InvalidTable> {
        Table::new(Interpolation::Linear, points)
    }

    /// The table that keeps the value of a point up to the next point.
    ///
    /// # Errors
    ///
    /// As for [`linear`](Self::linear).
    pub fn steps(points: impl Into<Vec<(f64, f64)>>) -> Result<Table, InvalidTable> {
        Table::new(Interpolation::Steps, points)
    }

    /// The table of these points, read like this.
    ///
    /// # Errors
    ///
    /// As for [`linear`](Self::linear).
    pub fn new(
        interpolation: Interpolation,
        points: impl Into<Vec<(f64, f64)>>,
    ) -> Result<Table, InvalidTable> {
        let points = points.into();
        if points.is_empty() {
            return Err(InvalidTable::Empty);
        }
        for (index, &(place, value)) in points.iter().enumerate() {
            if !(place.is_finite() && value.is_finite()) {
                return Err(InvalidTable::NotFinite { index, place, value });
            }
            let Some(&(before, value_before)) = index.checked_sub(1).map(|last| &points[last])
            else {
                continue;
            };
            if before >= place {
                return Err(InvalidTable::Order { index, before, place });
            }
            if !((place - before).is_finite() && (value - value_before).is_finite()) {
                return Err(InvalidTable::TooFarApart { index });
            }
        }
        Ok(Table { interpolation, points: points.into() })
    }

    /// The value at `place`, as an expression.
    pub fn at(&self, place: impl Into<Expression>) -> Expression {
        Expression::Lookup(self.clone(), Arc::new(place.into()))
    }

    /// The points in their order, as pairs of place and value.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// What it says between its points.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The value at `place`.
    pub(crate) fn value(&self, place: f64) -> f64 {
        if place.is_nan() {
            return place;
        }
        let after = self.points.partition_point(|point| point.0 <= place);
        let before = after.saturating_sub(1);
        match self.interpolation {
            Interpolation::Flat if self.points[before].0 == place => f64::NAN,
            Interpolation::Flat => 0.0,
            Interpolation::Steps => self.points[before].1,
            Interpolation::Linear => match self.points.get(before..before + 2) {
                Some(&[(from, start), (to, end)]) if place > from => {
                    let value = start + (end - start) * ((place - from) / (to - from));
                    value.clamp(start.min(end), start.max(end))
                }
                _ => self.points[before].1,
            },
        }
    }

    /// Encloses the values at all `places`.
    pub(crate) fn range(&self, places: Interval) -> Interval {
        let ends = self.around(places.lower()).hull(self.around(places.upper()));
        let inside = |point: &&(f64, f64)| places.contains(point.0);
        let (first, last) = (
            self.points.partition_point(|point| point.0 < places.lower()),
            self.points.partition_point(|point| point.0 <= places.upper()),
        );
        let met = &self.points[first..last];
        if self.interpolation == Interpolation::Flat {
            return if met.is_empty() { Interval::point(0.0) } else { Interval::WHOLE };
        }
        let points = met.iter().filter(inside).map(|point| Interval::point(point.1));
        points.fold(ends, Interval::hull)
    }

    /// Encloses the exact value at `place` and the rounded one.
    fn around(&self, place: f64) -> Interval {
        let rounded = Interval::point(self.value(place));
        let after = self.points.partition_point(|point| point.0 <= place);
        let segment = self.points.get(after.wrapping_sub(1)..after.saturating_add(1));
        match (self.interpolation, segment) {
            (Interpolation::Linear, Some(&[(from, start), (to, end)])) => {
                let [place, from, start, to, end] =
                    [place, from, start, to, end].map(Interval::point);
                let exact = start + (end - start) * ((place - from) / (to - from));
                exact.intersection(start.hull(end)).map_or(rounded, |exact| exact.hull(rounded))
            }
            _ => rounded,
        }
    }

    /// The table of its slopes; at a point of a kink that of the line after it.
    pub(crate) fn derivative(&self) -> Table {
        let (interpolation, points) = match self.interpolation {
            Interpolation::Steps | Interpolation::Flat => {
                (Interpolation::Flat, self.points.clone())
            }
            Interpolation::Linear => {
                let lines = self.points.windows(2);
                let slopes = lines.map(|line| (line[1].1 - line[0].1) / (line[1].0 - line[0].0));
                let places = self.points.iter().map(|point| point.0);
                let before = (self.points[0].0.next_down(), 0.0);
                let slopes = places.zip(slopes.chain([0.0]));
                (Interpolation::Steps, [before].into_iter().chain(slopes).collect())
            }
        };
        Table { interpolation, points }
    }

    /// Its lines or steps, each with the condition on `place` under which it counts.
    pub(crate) fn pieces(&self, place: &Expression) -> Option<Vec<(crate::Predicate, Expression)>> {
        let last = self.points.len() - 1;
        let piece = |index: usize| {
            let (from, start) = self.points[index];
            let value = match (self.interpolation, self.points.get(index + 1)) {
                (Interpolation::Linear, Some(&(to, end))) => {
                    start + (place - from) * ((end - start) / (to - from))
                }
                _ => start.into(),
            };
            let begun = place.at_least(from);
            let condition = match self.points.get(index + 1) {
                Some(&(to, _)) => begun & place.less_than(to),
                None => begun,
            };
            (condition, value)
        };
        let before = (place.less_than(self.points[0].0), self.points[0].1.into());
        let is_value = self.interpolation != Interpolation::Flat;
        is_value.then(|| [before].into_iter().chain((0..=last).map(piece)).collect())
    }
}

impl Choice {
    /// Which of the two it is, given the sides of its condition; NaN if one of them is.
    #[inline]
    pub(crate) fn select(
        relation: crate::Relation,
        (left, right): (f64, f64),
        (then, otherwise): (f64, f64),
    ) -> f64 {
        if left.is_nan() || right.is_nan() {
            f64::NAN
        } else if relation.judge(left, right).holds {
            then
        } else {
            otherwise
        }
    }

    /// The same choice with other parts.
    pub(crate) fn with(&self, [left, right, then, otherwise]: [Expression; 4]) -> Choice {
        let relation = self.condition.relation;
        Choice { condition: Comparison { left, relation, right }, then, otherwise }
    }
}

/// Why points make no [`Table`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InvalidTable {
    /// There is no point.
    Empty,
    /// A number is infinite or NaN.
    NotFinite {
        /// The index of the point, from 0.
        index: usize,
        /// Its place.
        place: f64,
        /// Its value.
        value: f64,
    },
    /// A place or a value differs from the one before by more than any number.
    TooFarApart {
        /// The index of the point, from 0.
        index: usize,
    },
    /// A place is not larger than the one before.
    Order {
        /// The index of the point, from 0.
        index: usize,
        /// The place of the point before.
        before: f64,
        /// Its place.
        place: f64,
    },
}

impl fmt::Display for InvalidTable {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => formatter.write_str("a table needs at least one point"),
            Self::NotFinite { index, place, value } => {
                write!(formatter, "point {index} of a table, ({place}, {value}), is not finite")
            }
            Self::TooFarApart { index } => write!(
                formatter,
                "point {index} of a table is too far from the one before: their differences overflow"
            ),
            Self::Order { index, before, place } => write!(
                formatter,
                "point {index} of a table is at {place}, which is not after {before}: \
                 give the points in ascending order, each place once"
            ),
        }
    }
}

impl Error for InvalidTable {}
