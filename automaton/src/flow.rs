//! How the state changes while time passes in a location.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use nalgebra::DMatrix;
use pleach_guards::{Expression, Substitution, constant};
use thiserror::Error;

use crate::coordinates::Coordinate;
use crate::lists::mapped;
use crate::outline;

/// The flow of a location.
///
/// | made by | is | solved by |
/// | --- | --- | --- |
/// | a list of [rates](crate::Coordinate::rate) | data: ẋ as formulas, 0 for coordinates that are not listed | its closed form where it is constant or linear, else an integrator |
/// | [`Flow::field`] | a function x ↦ ẋ under a name | an integrator |
/// | [`Flow::exact`] | a function that carries x over a duration, under a name | itself |
///
/// ```
/// use pleach_automaton::{coordinates, Flow};
///
/// coordinates! { struct Ball { height = "h", velocity = "v" } }
/// let Ball { height, velocity } = Ball::coordinates();
///
/// let fall: Flow<Ball> = [height.rate(&velocity), velocity.rate(-9.81)].into();
/// assert_eq!(fall.to_string(), "ḣ = v, v̇ = −9.81");
/// ```
pub struct Flow<S> {
    motion: Motion<S>,
}

pub(crate) enum Motion<S> {
    Rates(Arc<[Rate]>),
    Field(Arc<str>, Arc<Field<S>>),
    Exact(Arc<str>, Arc<Solution<S>>),
}

type Field<S> = dyn Fn(&S) -> S + Send + Sync;
type Solution<S> = dyn Fn(&mut S, f64) + Send + Sync;

/// The rate of one coordinate of the states `S`, as a formula; made by
/// [`Coordinate::rate`](crate::Coordinate::rate). Once it is a part of a flow, its type no longer says
/// of which states: what reads formulas is the same for all.
pub struct Rate<S = ()> {
    coordinate: &'static str,
    rate: Expression,
    state: PhantomData<fn() -> S>,
}

impl<S> Rate<S> {
    pub(crate) fn new(coordinate: &'static str, rate: Expression) -> Self {
        Rate { coordinate, rate, state: PhantomData }
    }

    /// The same without the type of the states.
    pub(crate) fn untyped(self) -> Rate {
        Rate::new(self.coordinate, self.rate)
    }

    pub(crate) fn substitute(&self, substitution: &Substitution) -> Self {
        Rate::new(self.coordinate, self.rate.substitute(substitution))
    }

    /// The name of the coordinate.
    pub fn coordinate(&self) -> &'static str {
        self.coordinate
    }

    /// How fast it changes, per second.
    pub fn rate(&self) -> &Expression {
        &self.rate
    }
}

/// A matrix or an offset does not have the dimension of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "a matrix of {rows} rows and {columns} columns with an offset of {offset} entries makes no \
     flow of {dimension} coordinates: all must be {dimension}"
)]
pub struct InvalidMatrix {
    /// The rows of the matrix.
    pub rows: usize,
    /// Its columns.
    pub columns: usize,
    /// The entries of the offset.
    pub offset: usize,
    /// How many coordinates there are.
    pub dimension: usize,
}

impl<S> Flow<S> {
    /// The flow whose exact solution `advance` computes: it carries a state over a duration ≥ 0
    /// in seconds. `name` is a formula such as `τ̇ = 1`.
    pub fn exact(name: &str, advance: impl Fn(&mut S, f64) + Send + Sync + 'static) -> Self {
        Flow { motion: Motion::Exact(name.into(), Arc::new(advance)) }
    }

    /// The flow ẋ = f(x): `field` gives, as a state, the rates of all coordinates per second.
    pub fn field(name: &str, field: impl Fn(&S) -> S + Send + Sync + 'static) -> Self {
        Flow { motion: Motion::Field(name.into(), Arc::new(field)) }
    }

    /// The flow of these rates, whose coordinates are those of `S`.
    pub(crate) fn of_rates(rates: Vec<Rate>) -> Self {
        Flow { motion: Motion::Rates(rates.into()) }
    }

    /// The rates, unless the flow is a function.
    pub fn rates(&self) -> Option<&[Rate]> {
        match &self.motion {
            Motion::Rates(rates) => Some(rates),
            Motion::Field(..) | Motion::Exact(..) => None,
        }
    }

    /// The rates, shared; none if the flow is a function.
    pub(crate) fn shared_rates(&self) -> Option<Arc<[Rate]>> {
        match &self.motion {
            Motion::Rates(rates) => Some(rates.clone()),
            Motion::Field(..) | Motion::Exact(..) => None,
        }
    }

    /// The name or the formulas, as text.
    pub fn name(&self) -> Cow<'_, str> {
        match &self.motion {
            Motion::Rates(rates) => Cow::Owned(listed(rates)),
            Motion::Field(name, _) | Motion::Exact(name, _) => Cow::Borrowed(name),
        }
    }

    /// Carries `state` over `duration` seconds, at least 0, and returns whether it did: only an
    /// [exact](Flow::exact) flow can by itself.
    #[must_use]
    pub fn advance(&self, state: &mut S, duration: f64) -> bool {
        match &self.motion {
            Motion::Exact(_, advance) => {
                advance(state, duration);
                true
            }
            Motion::Rates(_) | Motion::Field(..) => false,
        }
    }

    /// The same flow with expressions in the place of variables, as far as it is data.
    pub(crate) fn substitute(&self, substitution: &Substitution) -> Self {
        match self.rates() {
            Some(rates) => Flow::of_rates(substituted(rates, substitution)),
            None => self.clone(),
        }
    }

    /// The flow ẋ = A x + b of these coordinates; entries that are 0 leave no term.
    ///
    /// # Errors
    ///
    /// [`InvalidMatrix`] unless A has a row and a column and b an entry for each coordinate.
    ///
    /// ```
    /// use nalgebra::dmatrix;
    /// use pleach_automaton::{Flow, Vector};
    ///
    /// let turn = dmatrix![0.0, 1.0; -4.0, 0.0];
    /// let flow = Flow::linear(&Vector::<2>::coordinates(), &turn, &[0.0, 2.5])?;
    /// assert_eq!(flow.to_string(), "ẋ₁ = x₂, ẋ₂ = −4 · x₁ + 2.5");
    /// # Ok::<(), pleach_automaton::InvalidMatrix>(())
    /// ```
    pub fn linear(
        coordinates: &[Coordinate<S>],
        matrix: &DMatrix<f64>,
        offset: &[f64],
    ) -> Result<Self, InvalidMatrix> {
        let dimension = coordinates.len();
        if matrix.shape() != (dimension, dimension) || offset.len() != dimension {
            let (rows, columns) = matrix.shape();
            return Err(InvalidMatrix { rows, columns, offset: offset.len(), dimension });
        }
        let rates = coordinates.iter().enumerate().map(|(row, coordinate)| {
            let entries = coordinates.iter().enumerate();
            let terms = entries.filter_map(|(column, other)| match matrix[(row, column)] {
                0.0 => None,
                1.0 => Some(other.into()),
                entry => Some(entry * other),
            });
            let constant = (offset[row] != 0.0).then(|| constant(offset[row]));
            coordinate.rate(terms.chain(constant).sum::<Expression>())
        });
        Ok(rates.collect::<Vec<_>>().into())
    }

    pub(crate) fn motion(&self) -> &Motion<S> {
        &self.motion
    }

    pub(crate) fn outline(&self) -> outline::Motion<'_> {
        match &self.motion {
            Motion::Rates(rates) => outline::Motion::Rates(rates),
            Motion::Field(name, _) | Motion::Exact(name, _) => outline::Motion::Function(name),
        }
    }
}

impl<S, const N: usize> From<[Rate<S>; N]> for Flow<S> {
    fn from(rates: [Rate<S>; N]) -> Self {
        Vec::from(rates).into()
    }
}

impl<S> From<Vec<Rate<S>>> for Flow<S> {
    fn from(rates: Vec<Rate<S>>) -> Self {
        Flow::of_rates(mapped(rates, Rate::untyped))
    }
}

impl<S> From<Rate<S>> for Flow<S> {
    fn from(rate: Rate<S>) -> Self {
        [rate].into()
    }
}

fn listed(rates: &[Rate]) -> String {
    let texts: Vec<String> = rates.iter().map(Rate::to_string).collect();
    texts.join(", ")
}

fn substituted(rates: &[Rate], substitution: &Substitution) -> Vec<Rate> {
    rates.iter().map(|rate| rate.substitute(substitution)).collect()
}

// Written by hand, because derives would ask the same of S.

impl<S> Clone for Rate<S> {
    fn clone(&self) -> Self {
        Rate::new(self.coordinate, self.rate.clone())
    }
}

impl<S> Clone for Flow<S> {
    fn clone(&self) -> Self {
        Flow { motion: self.motion.clone() }
    }
}

impl<S> Clone for Motion<S> {
    fn clone(&self) -> Self {
        match self {
            Motion::Rates(rates) => Motion::Rates(rates.clone()),
            Motion::Field(name, field) => Motion::Field(name.clone(), field.clone()),
            Motion::Exact(name, advance) => Motion::Exact(name.clone(), advance.clone()),
        }
    }
}

impl<S> fmt::Display for Rate<S> {
    /// The dot stands over the first letter of the name, as one writes it.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        const DOT_ABOVE: char = '\u{307}';
        let mut letters = self.coordinate.chars();
        if let Some(first) = letters.next() {
            write!(formatter, "{}{}", dotted(first, DOT_ABOVE), letters.as_str())?;
        }
        write!(formatter, " = {}", self.rate)
    }
}

/// Letters with a dot above that are characters of their own, each beside the letter without: not
/// every font combines them.
pub(crate) const DOTTED: [(char, char); 21] = [
    ('a', 'ȧ'),
    ('b', 'ḃ'),
    ('c', 'ċ'),
    ('d', 'ḋ'),
    ('e', 'ė'),
    ('f', 'ḟ'),
    ('g', 'ġ'),
    ('h', 'ḣ'),
    ('m', 'ṁ'),
    ('n', 'ṅ'),
    ('o', 'ȯ'),
    ('p', 'ṗ'),
    ('r', 'ṙ'),
    ('s', 'ṡ'),
    ('t', 'ṫ'),
    ('w', 'ẇ'),
    ('x', 'ẋ'),
    ('y', 'ẏ'),
    ('z', 'ż'),
    ('T', 'Ṫ'),
    ('X', 'Ẋ'),
];

/// A letter with a dot above, as one character where there is one.
fn dotted(letter: char, dot: char) -> String {
    match DOTTED.iter().find(|(plain, _)| *plain == letter) {
        Some((_, composed)) => composed.to_string(),
        None => format!("{letter}{dot}"),
    }
}

impl<S> fmt::Debug for Rate<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Rate({self})")
    }
}

impl<S> fmt::Display for Flow<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name())
    }
}

impl<S> fmt::Debug for Flow<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Flow({self})")
    }
}
