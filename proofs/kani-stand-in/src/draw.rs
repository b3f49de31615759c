//! Drawing values.

use crate::case::{self, Drawn, Ended, Source};
use crate::dice::Dice;

/// A type whose values can be drawn.
pub trait Arbitrary: Sized {
    /// Some value that is admitted; the case is dropped if there is none, or none is found.
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self;
}

/// Any value.
pub fn any<T: Arbitrary>() -> T {
    T::any_where(|_| true)
}

/// Any value that is admitted.
pub fn any_where<T: Arbitrary, F: Fn(&T) -> bool>(admits: F) -> T {
    T::any_where(admits)
}

/// From how many values half of the random draws come.
const FEW: u64 = 4;

/// A value of a type that has few: the one with the ordinal that is drawn.
fn among<T: Copy + Into<Drawn>>(
    choices: u32,
    value_at: impl Fn(u32) -> T,
    admits: impl Fn(&T) -> bool,
) -> T {
    let ordinal = case::with(|case| match &mut case.source {
        Source::Enumeration(odometer) => {
            odometer.draw(choices, |ordinal| admits(&value_at(ordinal)))
        }
        Source::Chance(dice) => {
            let admitted = || (0..choices).filter(|&ordinal| admits(&value_at(ordinal)));
            let count = admitted().count() as u64;
            // Equal numbers matter, and are rare among many: half of the draws come from a few.
            let few = if dice.below(2) == 0 { count.min(FEW) } else { count };
            if count == 0 { None } else { admitted().nth(dice.below(few) as usize) }
        }
    });
    let Some(ordinal) = ordinal else { case::reject() };
    note(value_at(ordinal))
}

/// A value of a type that has too many to go through them.
fn by_chance<T: Copy + Into<Drawn>>(
    draw: impl Fn(&mut Dice) -> T,
    admits: impl Fn(&T) -> bool,
) -> T {
    /// Draws after which a case is dropped.
    const PATIENCE: u32 = 1000;
    let value = case::with(|case| match &mut case.source {
        Source::Enumeration(_) => Err(Ended::TooMany),
        Source::Chance(dice) => {
            let mut draws = (0..PATIENCE).map(|_| draw(dice));
            draws.find(|value| admits(value)).ok_or(Ended::Rejected)
        }
    });
    match value {
        Ok(value) => note(value),
        Err(reason) => case::end(reason),
    }
}

fn note<T: Copy + Into<Drawn>>(value: T) -> T {
    case::with(|case| case.drawn.push(value.into()));
    value
}

impl Arbitrary for bool {
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
        among(2, |ordinal| ordinal == 1, admits)
    }
}

impl Arbitrary for u8 {
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
        among(256, |ordinal| ordinal as u8, admits)
    }
}

/// In the order 0, −1, 1, −2, …: a fault shows with small numbers first.
impl Arbitrary for i8 {
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
        let zigzag = |ordinal: u32| {
            let half = (ordinal / 2) as i8;
            if ordinal.is_multiple_of(2) { half } else { -1 - half }
        };
        among(256, zigzag, admits)
    }
}

macro_rules! integers {
    ($($integer:ty),+) => {
        $(
            /// Half of them small, one in eight extreme.
            impl Arbitrary for $integer {
                fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
                    let draw = |dice: &mut Dice| match dice.below(8) {
                        0 => if dice.below(2) == 0 { <$integer>::MIN } else { <$integer>::MAX },
                        1..5 => (dice.below(9) as $integer).wrapping_sub(4),
                        _ => dice.bits() as $integer,
                    };
                    by_chance(draw, admits)
                }
            }
        )+
    };
}

integers!(u16, u32, u64, i16, i32, i64);

/// Any bits, small multiples of ¼, numbers in [0, 1), and the special ones, NaN among them.
impl Arbitrary for f64 {
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
        const SPECIAL: [f64; 8] = [
            0.0,
            -0.0,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            f64::MIN_POSITIVE,
            f64::MAX,
            f64::MIN,
        ];
        let draw = |dice: &mut Dice| match dice.below(8) {
            0 => SPECIAL[dice.below(SPECIAL.len() as u64) as usize],
            1..4 => (dice.below(65) as f64 - 32.0) / 4.0,
            4..6 => (dice.bits() >> 11) as f64 / (1_u64 << 53) as f64,
            _ => f64::from_bits(dice.bits()),
        };
        by_chance(draw, admits)
    }
}

impl<T: Arbitrary, const N: usize> Arbitrary for [T; N] {
    fn any_where(admits: impl Fn(&Self) -> bool) -> Self {
        let values = std::array::from_fn(|_| any());
        if !admits(&values) {
            case::reject();
        }
        values
    }
}
