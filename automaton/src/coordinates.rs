//! States made of named coordinates, and the variables that stand for them in formulas.

mod vector;

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, Deref, Div, Mul, Neg, Sub};

use pleach_guards::{Expression, Valuation, variable};

use crate::flow::Rate;
use crate::reset::{Assignment, NewValue};

pub use vector::Vector;

/// A state x ∈ ℝⁿ whose coordinates have names.
///
/// Usually a struct that [`coordinates!`](crate::coordinates!) declares, or a [`Vector`]. A state
/// is its coordinates and nothing else: writing them and reading them back gives the same state.
pub trait Coordinates: Valuation + Clone + Send + Sync + 'static {
    /// The names of the coordinates in their order, each different.
    const NAMES: &'static [&'static str];

    /// The state with these coordinates; `values` has as many as there are names.
    fn from_values(values: &[f64]) -> Self;

    /// Writes the coordinates into `values`, which has as many places as there are names.
    fn write(&self, values: &mut [f64]);

    /// The names of the coordinates of this state, in their order: those of the type, unless states
    /// are [records](crate::Record) whose names are known at run time.
    fn names(&self) -> &[&'static str] {
        Self::NAMES
    }

    /// A state with the same names and these coordinates.
    fn like(&self, values: &[f64]) -> Self {
        Self::from_values(values)
    }

    /// The coordinates in their order.
    fn to_values(&self) -> Vec<f64> {
        let mut values = vec![0.0; self.names().len()];
        self.write(&mut values);
        values
    }
}

/// The state of an automaton that is all locations.
impl Coordinates for () {
    const NAMES: &'static [&'static str] = &[];

    fn from_values(_values: &[f64]) -> Self {}

    fn write(&self, _values: &mut [f64]) {}
}

/// A coordinate of states `S` as a variable in formulas.
///
/// It is an [`Expression`] in all that follows from reading it; beyond that it can be given a
/// [rate](Coordinate::rate) by a flow and a [value](Coordinate::becomes) by a reset. What is given to a coordinate of
/// one state cannot end up in an automaton over another: that does not compile.
pub struct Coordinate<S> {
    expression: Expression,
    name: &'static str,
    state: PhantomData<fn() -> S>,
}

impl<S> Coordinate<S> {
    /// The coordinate called `name`; [`coordinates!`](crate::coordinates!) makes them all.
    pub fn new(name: &'static str) -> Self {
        Coordinate { expression: variable(name), name, state: PhantomData }
    }

    /// The name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The flow ẋ = `rate` of this coordinate.
    pub fn rate(&self, rate: impl Into<Expression>) -> Rate<S> {
        Rate::new(self.name, rate.into())
    }

    /// The reset x⁺ = `value` of this coordinate, where `value` is worked out in x⁻.
    pub fn becomes(&self, value: impl Into<Expression>) -> Assignment<S> {
        Assignment::new(self.name, NewValue::Exactly(value.into()))
    }

    /// The reset x⁺ ∈ [`lower`, `upper`] of this coordinate, where both ends are worked out in x⁻:
    /// any number of the interval, of which the [policy](crate::Policy) of a run takes one.
    pub fn becomes_within(
        &self,
        lower: impl Into<Expression>,
        upper: impl Into<Expression>,
    ) -> Assignment<S> {
        Assignment::new(self.name, NewValue::Within(lower.into(), upper.into()))
    }
}

impl<S> Deref for Coordinate<S> {
    type Target = Expression;

    fn deref(&self) -> &Expression {
        &self.expression
    }
}

impl<S> Clone for Coordinate<S> {
    fn clone(&self) -> Self {
        Coordinate { expression: self.expression.clone(), name: self.name, state: PhantomData }
    }
}

impl<S> fmt::Debug for Coordinate<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Coordinate").field(&self.name).finish()
    }
}

impl<S> From<Coordinate<S>> for Expression {
    fn from(coordinate: Coordinate<S>) -> Expression {
        coordinate.expression
    }
}

impl<S> From<&Coordinate<S>> for Expression {
    fn from(coordinate: &Coordinate<S>) -> Expression {
        coordinate.expression.clone()
    }
}

/// A number on the left.
macro_rules! number {
    ($trait:ident, $symbol:tt, $method:ident, $number:ty) => {
        impl<S> $trait<Coordinate<S>> for $number {
            type Output = Expression;

            fn $method(self, right: Coordinate<S>) -> Expression {
                Expression::from(self) $symbol right.expression
            }
        }

        impl<S> $trait<&Coordinate<S>> for $number {
            type Output = Expression;

            fn $method(self, right: &Coordinate<S>) -> Expression {
                Expression::from(self) $symbol &right.expression
            }
        }
    };
}

macro_rules! operator {
    ($trait:ident, $method:ident, $symbol:tt) => {
        impl<S, E: Into<Expression>> $trait<E> for Coordinate<S> {
            type Output = Expression;

            fn $method(self, right: E) -> Expression {
                self.expression $symbol right
            }
        }

        impl<S, E: Into<Expression>> $trait<E> for &Coordinate<S> {
            type Output = Expression;

            fn $method(self, right: E) -> Expression {
                &self.expression $symbol right
            }
        }

        number!($trait, $symbol, $method, f64);
        number!($trait, $symbol, $method, i32);
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<S> Neg for Coordinate<S> {
    type Output = Expression;

    fn neg(self) -> Expression {
        -self.expression
    }
}

impl<S> Neg for &Coordinate<S> {
    type Output = Expression;

    fn neg(self) -> Expression {
        -&self.expression
    }
}

/// Declares states with named coordinates: structs of numbers that are [`Coordinates`].
///
/// `Ball` is a plain struct of `f64`; `Ball::coordinates()` is the same struct with a
/// [`Coordinate`](crate::Coordinate) in each field, to be taken apart and used in formulas. A
/// coordinate is called like its field, or by the name after an equals sign.
///
/// ```
/// use pleach_automaton::{coordinates, Coordinates};
///
/// coordinates! {
///     /// A ball above the floor, in metres and metres a second.
///     pub struct Ball { height = "h", velocity = "v" }
/// }
///
/// let Ball { height, velocity } = Ball::coordinates();
/// assert_eq!((&velocity * 2.0 - 1.0).to_string(), "v · 2 − 1");
///
/// let ball = Ball { height: 2.0, velocity: 0.0 };
/// assert_eq!(height.at_most(3.0).margin(&ball)?, 1.0);
/// assert_eq!(Ball::from_values(&ball.to_values()), ball);
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
#[macro_export]
macro_rules! coordinates {
    ($(
        $(#[$attribute:meta])*
        $visibility:vis struct $state:ident {
            $($(#[$note:meta])* $field:ident $(= $word:literal)?),+ $(,)?
        }
    )+) => {$(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        $visibility struct $state<CoordinateValue = f64> {
            $($(#[$note])* #[allow(missing_docs)] pub $field: CoordinateValue),+
        }

        impl $state {
            /// The coordinates as variables for formulas.
            #[must_use]
            $visibility fn coordinates() -> $state<$crate::Coordinate<$state>> {
                $state {
                    $($field: $crate::Coordinate::new($crate::coordinates!(@word $field $($word)?))),+
                }
            }
        }

        impl $crate::guards::Valuation for $state {
            fn value(&self, variable: &str) -> ::core::option::Option<f64> {
                $(if variable == $crate::coordinates!(@word $field $($word)?) {
                    return ::core::option::Option::Some(self.$field);
                })+
                ::core::option::Option::None
            }
        }

        impl $crate::Coordinates for $state {
            const NAMES: &'static [&'static str] = {
                const NAMES: &[&str] = &[$($crate::coordinates!(@word $field $($word)?)),+];
                const _: () = assert!(
                    $crate::discrete::vocabulary::all_differ(NAMES),
                    "two names are the same"
                );
                NAMES
            };

            fn from_values(values: &[f64]) -> Self {
                let mut values = values.iter().copied();
                // Where fewer values are given than there are names, the rest are what is not a number.
                $state { $($field: values.next().unwrap_or(f64::NAN)),+ }
            }

            fn write(&self, values: &mut [f64]) {
                for (place, value) in values.iter_mut().zip([$(self.$field),+]) {
                    *place = value;
                }
            }
        }
    )+};
    (@word $field:ident $word:literal) => { $word };
    (@word $field:ident) => { stringify!($field) };
}

#[cfg(test)]
mod tests {
    use super::*;

    crate::coordinates! {
        struct Tank { level = "ℓ", inflow }
    }

    #[test]
    fn coordinates_read_like_expressions() {
        let Tank { level, inflow } = Tank::coordinates();
        let formula = 2.0 * &level + &inflow - level.power(2.0) / 3.0;
        assert_eq!(formula.to_string(), "2 · ℓ + inflow − ℓ² ÷ 3");
        assert_eq!((-&level).to_string(), "−ℓ");
    }

    crate::coordinates! {
        struct T { x }
    }

    #[test]
    fn states_may_be_called_as_they_like() {
        let T { x } = T::coordinates();
        assert_eq!((&x + 1.0).to_string(), "x + 1");
        assert_eq!(T::from_values(&[2.0]), T { x: 2.0 });
    }

    #[test]
    fn vectors_have_up_to_a_hundred_coordinates() {
        assert_eq!(Vector::<13>::NAMES[12], "x₁₃");
        assert_eq!(Vector::<100>::NAMES.last(), Some(&"x₁₀₀"));
        let state = Vector::<13>::from_values(&[1.5; 13]);
        assert_eq!((state.value("x₁₃"), state.value("x₁₄")), (Some(1.5), None));
    }

    #[test]
    fn names_lead_to_fields() {
        let tank = Tank { level: 1.0, inflow: 2.0 };
        assert_eq!(tank.value("ℓ"), Some(1.0));
        assert_eq!(tank.value("level"), None);
        assert_eq!(Tank::from_values(&tank.to_values()), tank);
    }
}
