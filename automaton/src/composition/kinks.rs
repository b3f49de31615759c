//! Where rates have kinks or jumps that are known beforehand: at the points of tables, where cases of a
//! formula change, and at the kinks of its functions, if what decides moves along a line. Integration
//! steps end there, for within a step a rate has to be smooth.

use pleach_guards::{BinaryOperator, EvaluationError, Expression, Interpolation, UnaryOperator};

/// The places of kinks or jumps on a line through the states: a sum of coordinates with coefficients.
pub(crate) struct Kinks {
    /// In ascending order.
    places: Box<[f64]>,
    /// Whether the rate may jump there.
    are_jumps: bool,
    constant: f64,
    coefficients: Box<[(usize, f64)]>,
}

/// Times that are nearer to each other are one instant, as a part of the numbers that they are computed from.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// How the sum of coordinates moves: where it begins and how fast it rises.
struct Line {
    start: f64,
    speed: f64,
    /// The size of the numbers that its start is computed from.
    size: f64,
}

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
                    // A flat table is 0 on both sides of its points.
                    if table.interpolation() != Interpolation::Flat {
                        let places = table.points().iter().map(|point| point.0).collect();
                        let are_jumps = table.interpolation() == Interpolation::Steps;
                        found.extend(Kinks::along(place, places, are_jumps, names)?);
                    }
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

    /// Whether the rate may jump at one of them.
    pub(super) fn are_jumps(&self) -> bool {
        self.are_jumps
    }

    /// The first instant after `settled` at which a step should end, if coordinates begin and move as
    /// `motion` says; none if one of them does not move along a line. What is within rounding of
    /// `settled` happens there.
    pub(super) fn next(&self, settled: f64, motion: Motion<'_>) -> Option<f64> {
        let Line { start, speed, .. } = self.line(motion)?;
        let begin = settled + self.rounding(settled, motion);
        let (here, rises) = (start + speed * begin, speed > 0.0);
        let passed = self.places.partition_point(|place| *place <= here);
        // With one that was passed, as far as rounding tells.
        let count = self.places.len();
        let first = if rises { passed.saturating_sub(1) } else { count - count.min(passed + 1) };
        (first..count).find_map(|number| {
            let place = self.places[if rises { number } else { count - 1 - number }];
            Some((place - start) / speed).filter(|time| *time > begin)
        })
    }

    /// By how much times around this one may be rounded.
    pub(super) fn rounding(&self, time: f64, motion: Motion<'_>) -> f64 {
        let numbers = |line: Line| time.abs() + line.size / line.speed.abs();
        self.line(motion).map_or(0.0, |line| 2.0 * ROUNDING * numbers(line))
    }

    /// None if it is none, or rests.
    fn line(&self, motion: Motion<'_>) -> Option<Line> {
        let mut line = Line { start: self.constant, speed: 0.0, size: self.constant.abs() };
        for &(coordinate, coefficient) in &self.coefficients {
            let (first, rate) = motion(coordinate)?;
            line.start += coefficient * first;
            line.speed += coefficient * rate;
            line.size += (coefficient * first).abs();
        }
        Some(line).filter(|line| line.speed != 0.0)
    }
}

/// By coordinate, where it begins and how fast it moves, if it moves along a line.
pub(super) type Motion<'a> = &'a dyn Fn(usize) -> Option<(f64, f64)>;

#[cfg(test)]
mod tests {
    use pleach_guards::{Table, piecewise, variable};

    use super::*;

    const NAMES: [&str; 2] = ["x", "y"];

    /// The kinks of a formula of x and y.
    fn kinks(formula: &Expression) -> Box<[Kinks]> {
        Kinks::of(formula, &NAMES).expect("it is of x and y alone")
    }

    /// Its only kinks.
    fn only(formula: &Expression) -> Kinks {
        let [only] = <[Kinks; 1]>::try_from(kinks(formula).into_vec())
            .unwrap_or_else(|all| panic!("{} kinks", all.len()));
        only
    }

    /// All times at which steps end where x and y begin and move so.
    fn ends(kinks: &Kinks, motion: [(f64, f64); 2]) -> Vec<f64> {
        let mut ends = Vec::new();
        while let Some(next) =
            kinks.next(ends.last().copied().unwrap_or(0.0), &|at| Some(motion[at]))
        {
            ends.push(next);
            assert!(ends.len() < 10, "steps go on");
        }
        ends
    }

    #[test]
    fn formulas_have_kinks_and_jumps_where_their_parts_do() {
        let [x, y] = NAMES.map(variable);
        let told = |formula: Expression| {
            let told = |one: &Kinks| (one.constant, one.coefficients.to_vec(), one.are_jumps);
            kinks(&formula).iter().map(told).collect::<Vec<_>>()
        };
        assert_eq!(told((2.0 * &x - 1.0).abs()), [(-1.0, vec![(0, 2.0)], false)]);
        assert_eq!(told((2.0 * &x - 1.0).sign()), [(-1.0, vec![(0, 2.0)], true)]);
        let apart = [(0.0, vec![(0, 1.0), (1, -3.0)], false)];
        assert_eq!(told(x.min(3.0 * &y)), apart);
        assert_eq!(told(x.max(3.0 * &y).power(2.0).sin()), apart);
        let cases = |condition| piecewise([(condition, y.abs())], &x).expect("a comparison");
        let [inner, outer] = [(0.0, vec![(1, 1.0)], false), (-2.0, vec![(0, 1.0)], true)];
        let mut found = told(cases(x.at_least(2.0)));
        found.sort_by_key(|(_, _, are_jumps)| *are_jumps);
        assert!(found == [inner.clone(), outer] || found == [inner, (2.0, vec![(0, -1.0)], true)]);
        assert!(told(&x * &y + x.sin()).is_empty() && told((&x * &y).abs()).is_empty());
        assert_eq!(told(x.abs() + y.sign()).len(), 2);
    }

    /// 2x − 3y + 1 begins at −3 and rises by 1.75 a second.
    #[test]
    fn steps_end_at_a_kink_and_at_a_jump() {
        let [x, y] = NAMES.map(variable);
        let line = 2.0 * &x - 3.0 * &y + 1.0;
        let motion = [(1.0, 0.5), (2.0, -0.25)];
        for formula in [line.abs(), line.sign()] {
            let found = ends(&only(&formula), motion);
            assert!(matches!(found[..], [end] if (end - 3.0 / 1.75).abs() < 1e-15), "{found:?}");
            assert!(ends(&only(&formula), [(3.0, 0.5), (2.0, -0.25)]).is_empty(), "it is passed");
            assert!(ends(&only(&formula), [(1.0, 1.5), (2.0, 1.0)]).is_empty(), "it stands still");
            assert_eq!(only(&formula).next(0.0, &|at| (at == 0).then_some((1.0, 0.5))), None);
        }
    }

    /// Beside an instant, within its rounding, it is over; and beyond that it is to come.
    #[test]
    fn an_instant_within_rounding_is_that_instant() {
        let jump = only(&(variable("x") - 600.0).sign());
        for start in [0.0, -1e6] {
            let next = |settled: f64| jump.next(settled, &|_| Some((start, 1.0)));
            let time = 600.0 - start;
            let rounding = jump.rounding(time, &|_| Some((start, 1.0)));
            assert!(rounding < 1e-12 * (start.abs() + 1200.0), "{rounding}");
            assert_eq!(next(time - 1.5 * rounding), Some(time));
            assert_eq!(next(time - 0.5 * rounding), None);
            assert_eq!(next(time), None);
        }
    }

    #[test]
    fn the_points_of_a_table_are_passed_in_the_order_of_the_way() {
        let table = Table::linear([(0.0, 1.0), (1.0, 3.0), (3.0, 2.0)]);
        let table = only(&table.expect("its points are in order").at(variable("x")));
        let passed = |start: f64, rate: f64| ends(&table, [(start, rate), (0.0, 0.0)]);
        assert_eq!(passed(-1.0, 0.5), [2.0, 4.0, 8.0]);
        assert_eq!(passed(0.5, 0.5), [1.0, 5.0]);
        assert_eq!(passed(4.0, -2.0), [0.5, 1.5, 2.0]);
        assert_eq!(passed(1.0, -1.0), [1.0], "it begins on a point");
        assert!(passed(4.0, 1.0).is_empty() && passed(-1.0, -1.0).is_empty());
    }

    #[test]
    fn kinks_are_known_where_all_that_decides_moves_along_lines() {
        let [x, y] = NAMES.map(variable);
        let both = only(&(&x + &y).abs());
        assert!(both.are_known(|_| true) && !both.are_known(|at| at == 0));
        assert!(only(&x.abs()).are_known(|at| at == 0));
    }
}
