//! Where rates have kinks or jumps that are known beforehand: at the points of tables, where cases of a
//! formula change, and at the kinks of its functions, if what decides moves along a line. Integration
//! steps end there, for within a step a rate has to be smooth.

use pleach_guards::expression::{BinaryOperator, UnaryOperator};
use pleach_guards::{EvaluationError, Expression, Interpolation};

/// The places of kinks or jumps on a line through the states: a sum of coordinates with coefficients.
pub(crate) struct Kinks {
    /// In ascending order.
    places: Box<[f64]>,
    /// Whether the rate may jump there.
    are_jumps: bool,
    constant: f64,
    coefficients: Box<[(usize, f64)]>,
}

/// A jump lies between two ends of steps that are this far from it, as a part of the numbers that its
/// time is computed from.
const BESIDE: f64 = 32.0 * f64::EPSILON;
/// Times that are nearer to each other, as a part of them, are one.
const SAME: f64 = 8.0 * f64::EPSILON;

impl Kinks {
    /// Those of a formula over coordinates of these names.
    pub(super) fn of(
        formula: &Expression,
        names: &[&str],
    ) -> Result<Box<[Kinks]>, EvaluationError> {
        let (mut found, mut parts) = (Vec::new(), vec![formula]);
        while let Some(part) = parts.pop() {
            match part {
                Expression::Unary(operator, operand) => {
                    parts.push(operand);
                    let are_jumps = *operator == UnaryOperator::Sign;
                    if are_jumps || *operator == UnaryOperator::AbsoluteValue {
                        found.extend(Kinks::along(operand, [0.0].into(), are_jumps, names)?);
                    }
                }
                Expression::Power(operand, _) => parts.push(operand),
                Expression::Binary(operator, left, right) => {
                    parts.extend([&**left, &**right]);
                    if matches!(operator, BinaryOperator::Minimum | BinaryOperator::Maximum) {
                        let apart = &**left - &**right;
                        found.extend(Kinks::along(&apart, [0.0].into(), false, names)?);
                    }
                }
                Expression::Choice(choice) => {
                    let (left, right) = (&choice.condition.left, &choice.condition.right);
                    parts.extend([left, right, &choice.then, &choice.otherwise]);
                    found.extend(Kinks::along(&(left - right), [0.0].into(), true, names)?);
                }
                Expression::Lookup(table, place) => {
                    parts.push(place);
                    let places = table.points().iter().map(|point| point.0).collect();
                    let are_jumps = table.interpolation() != Interpolation::Linear;
                    found.extend(Kinks::along(place, places, are_jumps, names)?);
                }
                _ => {}
            }
        }
        Ok(found.into())
    }

    /// These places of `line`, if it is one.
    fn along(
        line: &Expression,
        places: Box<[f64]>,
        are_jumps: bool,
        names: &[&str],
    ) -> Result<Option<Kinks>, EvaluationError> {
        let Some(form) = line.linear_form() else { return Ok(None) };
        let coefficients = form.coefficients().map(|(name, coefficient)| {
            let unknown = || EvaluationError::UnknownVariable { variable: name.to_owned() };
            let coordinate = names.iter().position(|listed| *listed == name);
            Ok((coordinate.ok_or_else(unknown)?, *coefficient))
        });
        let coefficients = coefficients.collect::<Result<_, EvaluationError>>()?;
        Ok(Some(Kinks { places, are_jumps, constant: *form.constant(), coefficients }))
    }

    /// Whether they are known, where `is_line` says which coordinates move along a line.
    pub(super) fn are_known(&self, is_line: impl Fn(usize) -> bool) -> bool {
        self.coefficients.iter().all(|&(coordinate, _)| is_line(coordinate))
    }

    /// The first time after `after` at which a step should end, if coordinates begin and move as `motion`
    /// says; none if one of them does not move along a line.
    pub(super) fn next(
        &self,
        after: f64,
        motion: impl Fn(usize) -> Option<(f64, f64)>,
    ) -> Option<f64> {
        let (mut start, mut speed, mut size) = (self.constant, 0.0, self.constant.abs());
        for &(coordinate, coefficient) in &self.coefficients {
            let (first, rate) = motion(coordinate)?;
            start += coefficient * first;
            speed += coefficient * rate;
            size += (coefficient * first).abs();
        }
        if speed == 0.0 {
            return None;
        }
        let here = start + speed * after;
        let passed = self.places.partition_point(|place| *place <= here);
        // With the last place that was passed, since a step may have to end right behind it.
        let count = self.places.len();
        let first =
            if speed > 0.0 { passed.saturating_sub(1) } else { count - count.min(passed + 1) };
        (first..count).find_map(|number| {
            let place = self.places[if speed > 0.0 { number } else { count - 1 - number }];
            let time = (place - start) / speed;
            let numbers = time.abs() + (size + place.abs()) / speed.abs();
            let beside = if self.are_jumps { BESIDE * numbers } else { 0.0 };
            [time - beside, time + beside].into_iter().find(|time| *time > after + SAME * after)
        })
    }
}
