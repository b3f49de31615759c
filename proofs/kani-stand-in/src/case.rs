//! The case that runs at present: where its values come from, and what was drawn so far.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::fmt;
use std::panic::resume_unwind;

use crate::dice::Dice;

/// Where the values of a case come from.
pub(crate) enum Source {
    /// The combinations one after the other.
    Enumeration(Odometer),
    /// Chance.
    Chance(Dice),
}

/// A case in the making.
pub(crate) struct Case {
    pub(crate) source: Source,
    /// What was drawn, for messages.
    pub(crate) drawn: Vec<Drawn>,
    /// The most values that a case which meets the assumptions has drawn.
    pub(crate) values: usize,
    /// The places of satisfied covers, over all cases.
    pub(crate) covered: BTreeSet<(&'static str, u32, u32)>,
}

/// A value that was drawn.
#[derive(Clone, Copy)]
pub(crate) enum Drawn {
    Truth(bool),
    Integer(i128),
    Float(f64),
}

impl fmt::Display for Drawn {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Drawn::Truth(truth) => write!(formatter, "{truth}"),
            Drawn::Integer(integer) => write!(formatter, "{integer}"),
            Drawn::Float(float) => write!(formatter, "{float:?}"),
        }
    }
}

impl From<bool> for Drawn {
    fn from(truth: bool) -> Self {
        Drawn::Truth(truth)
    }
}

impl From<f64> for Drawn {
    fn from(float: f64) -> Self {
        Drawn::Float(float)
    }
}

macro_rules! from_integers {
    ($($integer:ty),+) => {
        $(impl From<$integer> for Drawn {
            fn from(integer: $integer) -> Self {
                Drawn::Integer(i128::from(integer))
            }
        })+
    };
}

from_integers!(u8, u16, u32, u64, i8, i16, i32, i64);

/// Why a case ended before its body did.
pub(crate) enum Ended {
    /// An assumption does not hold.
    Rejected,
    /// A draw has too many values to go through.
    TooMany,
}

thread_local! {
    static CASE: RefCell<Option<Case>> = const { RefCell::new(None) };
}

/// Begins to run cases.
pub(crate) fn begin(source: Source) {
    let case = Case { source, drawn: Vec::new(), values: 0, covered: BTreeSet::new() };
    CASE.with(|cell| *cell.borrow_mut() = Some(case));
}

/// The case that runs at present.
///
/// # Panics
///
/// Outside of a harness.
pub(crate) fn with<T>(act: impl FnOnce(&mut Case) -> T) -> T {
    CASE.with(|cell| match cell.borrow_mut().as_mut() {
        Some(case) => act(case),
        None => panic!("kani::any and kani::cover work within a harness only"),
    })
}

/// Ends the case without failing it, and without the message of a panic.
pub(crate) fn end(reason: Ended) -> ! {
    resume_unwind(Box::new(reason))
}

pub(crate) fn reject() -> ! {
    end(Ended::Rejected)
}

/// One digit for each draw; each run of the body reads them from the first on.
#[derive(Default)]
pub(crate) struct Odometer {
    digits: Vec<Digit>,
    read: usize,
}

struct Digit {
    ordinal: u32,
    choices: u32,
}

impl Odometer {
    /// The next draw: the ordinal of the first value from the present one on that is admitted,
    /// of this many; none if no such value is left.
    pub(crate) fn draw(&mut self, choices: u32, admits: impl Fn(u32) -> bool) -> Option<u32> {
        if self.read == self.digits.len() {
            // No run is begun to find that nothing is left.
            let choices = (0..choices).rev().find(|&last| admits(last)).map_or(0, |last| last + 1);
            self.digits.push(Digit { ordinal: 0, choices });
        }
        let digit = &mut self.digits[self.read];
        self.read += 1;
        while digit.ordinal < choices && !admits(digit.ordinal) {
            digit.ordinal += 1;
        }
        (digit.ordinal < choices).then_some(digit.ordinal)
    }

    /// Moves on to the next combination; false after the last.
    pub(crate) fn advance(&mut self) -> bool {
        self.digits.truncate(self.read);
        self.read = 0;
        while let Some(mut digit) = self.digits.pop() {
            digit.ordinal += 1;
            if digit.ordinal < digit.choices {
                self.digits.push(digit);
                return true;
            }
        }
        false
    }
}
