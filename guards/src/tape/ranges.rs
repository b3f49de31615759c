//! What the expressions of a tape can be where their variables are in intervals.

use std::f64::consts::PI;

use super::{Action, Places, Tape};
use crate::expression::{BinaryOperator, UnaryOperator};
use crate::interval::Interval;
use crate::range::Truth;

impl Tape {
    /// Writes to `results`, in the order of the expressions, intervals that contain their values
    /// wherever variable *i* is in `values[i]`. Where an expression has no value, its interval says
    /// nothing, and what is missing in `values` may be anything.
    ///
    /// `places` is room, to be used again and again.
    ///
    /// ```
    /// use pleach_guards::{Interval, Tape, variable};
    ///
    /// let (x, y) = (variable("x"), variable("y"));
    /// let tape = Tape::compile([&(&x * &x), &(&x / &y)], &["x", "y"])?;
    /// let (mut places, mut results) = (Vec::new(), Vec::new());
    /// let values = [Interval::new(-1.0, 2.0)?, Interval::new(2.0, 4.0)?];
    /// tape.ranges(&values, &mut places, &mut results);
    /// assert!(results[0].contains(4.0) && !results[0].contains(-0.1));
    /// assert!(results[1].contains(-0.5) && results[1].contains(1.0) && !results[1].contains(1.1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn ranges(
        &self,
        values: &[Interval],
        places: &mut Vec<Interval>,
        results: &mut Vec<Interval>,
    ) {
        places.clear();
        places.extend(values.iter().take(self.variables));
        places.resize(self.variables, Interval::WHOLE);
        places.extend(self.constants.iter().map(|&value| Interval::point(value)));
        places.resize(places.len() + self.computed, Interval::WHOLE);
        for instruction in &self.instructions {
            for number in 0..instruction.width {
                let operands = instruction.operands.map(|place| place + number);
                let range = self.range(instruction.action, operands, places);
                places[(instruction.target + number) as usize] = range;
            }
        }
        results.clear();
        for Places { first, count } in &self.results {
            results.extend(&places[*first as usize..][..*count as usize]);
        }
    }

    /// Whether a function is among the instructions that may change by much where its operand changes by
    /// little: an exponential, a quotient or a periodic function, but no polynomial.
    pub fn is_sharp(&self) -> bool {
        self.instructions.iter().any(|instruction| match instruction.action {
            Action::Unary(operator) => is_sharp(operator),
            Action::Quotient | Action::Root => true,
            Action::Power => {
                let place = (instruction.operands[1] as usize).checked_sub(self.variables);
                let exponent = place.and_then(|place| self.constants.get(place));
                !exponent.is_some_and(|exponent| is_polynomial(*exponent))
            }
            _ => false,
        })
    }

    /// Whether the operand of such a function varies by more than the values of the function at the ends
    /// could tell, with the `places` of the last [`ranges`](Self::ranges): an exponential then changes by
    /// a factor of hundreds, and a wave by half a turn.
    pub fn is_strained(&self, places: &[Interval]) -> bool {
        let ranges = |place: u32, number: u32| places.get((place + number) as usize).copied();
        self.instructions.iter().any(|instruction| {
            let [first, second, ..] = instruction.operands;
            (0..instruction.width).any(|number| {
                let (one, other) = (ranges(first, number), ranges(second, number));
                match (instruction.action, one, other) {
                    (Action::Unary(operator), Some(range), _) => strains(operator, range),
                    (Action::Quotient, _, Some(divisor)) => ratio(divisor) > MOST_GROWTH,
                    (Action::Root, Some(base), _) => ratio(base) > MOST_GROWTH * MOST_GROWTH,
                    (Action::Power, Some(base), Some(exponent)) => {
                        let exponent = exponent.lower();
                        let growth = ratio(base).ln() * exponent.abs();
                        !is_polynomial(exponent) && growth > MOST_GROWTH.ln()
                    }
                    _ => false,
                }
            })
        })
    }

    /// What the result of an instruction can be.
    fn range(&self, action: Action, operands: [u32; 4], places: &[Interval]) -> Interval {
        let at = |number: usize| places[operands[number] as usize];
        let product = || {
            let is_square = operands[0] == operands[1];
            let square = is_square.then(|| at(0).power(2.0)).flatten();
            square.unwrap_or_else(|| at(0) * at(1))
        };
        match action {
            Action::Sum => at(0) + at(1),
            Action::Difference => at(0) - at(1),
            Action::Product => product(),
            Action::Quotient => BinaryOperator::Quotient.range(at(0), at(1)),
            Action::ProductSum => product() + at(2),
            Action::ProductLess => product() - at(2),
            Action::LessProduct => at(2) - product(),
            Action::Opposite => -at(0),
            Action::Gather => places[self.gathered[operands[0] as usize] as usize],
            Action::Root => at(0).power(0.5).unwrap_or(Interval::WHOLE),
            Action::Unary(operator) => operator.range(at(0)).unwrap_or(Interval::WHOLE),
            Action::Binary(operator) => operator.range(at(0), at(1)),
            Action::Power => power(at(0), at(1)),
            Action::Lookup(table) => self.tables[table as usize].range(at(0)),
            Action::Choice(relation) => match relation.truth(at(0), at(1)) {
                Truth::Always => at(2),
                Truth::Never => at(3),
                Truth::Undecided => at(2).hull(at(3)),
            },
        }
    }
}

/// A power whose exponent is one number.
fn power(base: Interval, exponent: Interval) -> Interval {
    let is_number = exponent.lower() == exponent.upper();
    let power = is_number.then(|| base.power(exponent.lower())).flatten();
    power.unwrap_or(Interval::WHOLE)
}

/// Powers up to this one are seen by an integrator as other polynomials are.
const HIGHEST_POWER: f64 = 8.0;
/// By what factor something may grow within what is looked at.
const MOST_GROWTH: f64 = 400.0;

fn is_polynomial(exponent: f64) -> bool {
    exponent % 1.0 == 0.0 && (0.0..=HIGHEST_POWER).contains(&exponent)
}

fn is_sharp(operator: UnaryOperator) -> bool {
    use UnaryOperator::{Cosine, Exponential, HyperbolicTangent, Sine, Tangent};
    matches!(operator, Exponential | HyperbolicTangent | Sine | Cosine | Tangent)
}

fn strains(operator: UnaryOperator, operand: Interval) -> bool {
    use UnaryOperator::{Cosine, Exponential, HyperbolicTangent, Sine, Tangent};
    match operator {
        // Below −746 it is 0.
        Exponential => {
            let felt = Interval::new(-746.0, f64::INFINITY).ok();
            let felt = felt.and_then(|felt| felt.intersection(operand));
            felt.is_some_and(|felt| felt.width() > MOST_GROWTH.ln())
        }
        // Beyond 20 it is 1 to rounding.
        HyperbolicTangent => {
            let bent = Interval::new(-20.0, 20.0).ok().and_then(|bent| bent.intersection(operand));
            bent.is_some_and(|bent| bent.width() > MOST_GROWTH.ln())
        }
        Sine | Cosine | Tangent => operand.width() > PI,
        _ => false,
    }
}

/// The largest magnitude by the smallest.
fn ratio(range: Interval) -> f64 {
    let sizes = range.abs();
    sizes.upper() / sizes.lower()
}
