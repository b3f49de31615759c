//! What the expressions of a tape can be where their variables are in intervals.

use super::{Action, Places, Tape};
use crate::expression::BinaryOperator;
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
