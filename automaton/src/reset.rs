//! What a jump does to the state: x⁻ → x⁺, as assignments or as a function under a name.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use pleach_guards::{EvaluationError, Expression, Substitution, Valuation};

use crate::coordinates::Coordinates;
use crate::lists::mapped;
use crate::outline::Effect;

/// The reset of a transition.
///
/// It is data where it is a list of assignments, of values or of intervals from which a run takes
/// one, which all read x⁻ and leave every other coordinate as it is; or else a function with the name that diagrams show, which analyses report
/// as unchecked.
///
/// ```
/// use pleach_automaton::{coordinates, Reset};
///
/// coordinates! { struct Ball { height, velocity } }
/// let Ball { velocity, .. } = Ball::coordinates();
///
/// let bounce: Reset<Ball> = velocity.becomes(-0.5 * &velocity).into();
/// assert_eq!(bounce.to_string(), "velocity := −0.5 · velocity");
///
/// let scatter: Reset<Ball> = velocity.becomes_within(0.5, 0.6).into();
/// assert_eq!(scatter.to_string(), "velocity :∈ [0.5, 0.6]");
///
/// let halt = Reset::new("halt", |ball: &mut Ball| ball.velocity = 0.0);
/// assert_eq!(halt.to_string(), "halt");
/// ```
pub struct Reset<S> {
    form: Form,
    apply: Arc<Apply<S>>,
}

#[derive(Clone)]
enum Form {
    Assignments(Arc<[Assignment]>),
    Function(Arc<str>),
}

type Apply<S> = dyn Fn(&mut S) -> Result<(), EvaluationError> + Send + Sync;

/// One coordinate's new value over x⁻, in the states `S`; made by
/// [`Coordinate::becomes`](crate::Coordinate::becomes) and
/// [`Coordinate::becomes_within`](crate::Coordinate::becomes_within). Once it is a part of a reset, its
/// type no longer says of which states.
pub struct Assignment<S = ()> {
    coordinate: &'static str,
    value: NewValue,
    state: PhantomData<fn() -> S>,
}

/// What a coordinate becomes in a jump.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// The value of this formula.
    Exactly(Expression),
    /// Any number of the interval between these two, its ends included.
    Within(Expression, Expression),
}

impl<S> Assignment<S> {
    pub(crate) fn new(coordinate: &'static str, value: NewValue) -> Self {
        Assignment { coordinate, value, state: PhantomData }
    }

    /// The same without the type of the states.
    fn untyped(self) -> Assignment {
        Assignment::new(self.coordinate, self.value)
    }

    /// The name of the coordinate that is assigned.
    pub fn coordinate(&self) -> &'static str {
        self.coordinate
    }

    /// What it becomes.
    pub fn value(&self) -> &NewValue {
        &self.value
    }
}

impl NewValue {
    /// Its formulas: one, or the two ends of an interval.
    pub fn formulas(&self) -> impl Iterator<Item = &Expression> {
        let (first, second) = match self {
            NewValue::Exactly(value) => (value, None),
            NewValue::Within(lower, upper) => (lower, Some(upper)),
        };
        [first].into_iter().chain(second)
    }

    /// The same of formulas with expressions in the place of variables.
    #[must_use]
    pub fn substitute(&self, substitution: &Substitution) -> Self {
        match self {
            NewValue::Exactly(value) => NewValue::Exactly(value.substitute(substitution)),
            NewValue::Within(lower, upper) => {
                NewValue::Within(lower.substitute(substitution), upper.substitute(substitution))
            }
        }
    }

    /// Its value in `state`; of an interval its lower end.
    fn least(&self, state: &dyn Valuation) -> Result<f64, EvaluationError> {
        match self {
            NewValue::Exactly(value) | NewValue::Within(value, _) => value.evaluate(state),
        }
    }
}

impl<S> Reset<S> {
    /// The reset that `apply` carries out; `name` says it in a few words or as a formula.
    pub fn new(name: &str, apply: impl Fn(&mut S) + Send + Sync + 'static) -> Self {
        let apply = move |state: &mut S| {
            apply(state);
            Ok(())
        };
        Reset { form: Form::Function(name.into()), apply: Arc::new(apply) }
    }

    /// The reset that `apply` carries out, which leaves the state as it is where it fails.
    pub(crate) fn fallible(
        name: &str,
        apply: impl Fn(&mut S) -> Result<(), EvaluationError> + Send + Sync + 'static,
    ) -> Self {
        Reset { form: Form::Function(name.into()), apply: Arc::new(apply) }
    }

    /// The reset that changes nothing, x⁺ = x⁻.
    pub fn identity() -> Self {
        Reset { form: Form::Assignments(Arc::new([])), apply: Arc::new(|_| Ok(())) }
    }

    /// Whether it changes nothing.
    pub fn is_identity(&self) -> bool {
        self.assignments().is_some_and(<[_]>::is_empty)
    }

    /// The assignments, unless the reset is a function.
    pub fn assignments(&self) -> Option<&[Assignment]> {
        match &self.form {
            Form::Assignments(assignments) => Some(assignments),
            Form::Function(_) => None,
        }
    }

    /// The assignments, shared; an empty list if the reset is a function.
    pub(crate) fn shared_assignments(&self) -> Arc<[Assignment]> {
        match &self.form {
            Form::Assignments(assignments) => assignments.clone(),
            Form::Function(_) => Arc::default(),
        }
    }

    pub(crate) fn outline(&self) -> Effect<'_> {
        match &self.form {
            Form::Assignments(assignments) => Effect::Assignments(assignments),
            Form::Function(name) => Effect::Function(name),
        }
    }

    /// The name or the formula, as text; empty for the identity.
    pub fn name(&self) -> Cow<'_, str> {
        match &self.form {
            Form::Assignments(assignments) => Cow::Owned(listed(assignments)),
            Form::Function(name) => Cow::Borrowed(name),
        }
    }

    /// Turns x⁻ into x⁺. Of an interval it takes the lower end, as [`Policy::Early`] does.
    ///
    /// # Errors
    ///
    /// The first formula that has no value in x⁻; the state is then as before.
    ///
    /// [`Policy::Early`]: crate::Policy::Early
    pub fn apply(&self, state: &mut S) -> Result<(), EvaluationError> {
        (self.apply)(state)
    }
}

impl<S: Coordinates> Reset<S> {
    /// The reset of these assignments, whose coordinates are those of `S`.
    fn of_assignments(assignments: Vec<Assignment>) -> Self {
        let assignments: Arc<[Assignment]> = assignments.into();
        let listed = assignments.clone();
        let apply = Arc::new(move |state: &mut S| {
            let mut values = state.to_values();
            assign(&listed, state, state.names(), &mut values)?;
            *state = state.like(&values);
            Ok(())
        });
        Reset { form: Form::Assignments(assignments), apply }
    }

    /// The same reset with expressions in the place of variables, as far as it is data.
    pub(crate) fn substitute(&self, substitution: &Substitution) -> Self {
        match self.assignments() {
            Some(assignments) => Reset::of_assignments(substituted(assignments, substitution)),
            None => self.clone(),
        }
    }
}

impl<S: Coordinates> From<Vec<Assignment<S>>> for Reset<S> {
    fn from(assignments: Vec<Assignment<S>>) -> Self {
        Reset::of_assignments(mapped(assignments, Assignment::untyped))
    }
}

impl<S: Coordinates, const N: usize> From<[Assignment<S>; N]> for Reset<S> {
    fn from(assignments: [Assignment<S>; N]) -> Self {
        Vec::from(assignments).into()
    }
}

impl<S: Coordinates> From<Assignment<S>> for Reset<S> {
    fn from(assignment: Assignment<S>) -> Self {
        vec![assignment].into()
    }
}

/// Writes x⁺ over the values of x⁻; every formula reads x⁻.
fn assign(
    assignments: &[Assignment],
    before: &dyn Valuation,
    names: &[&str],
    values: &mut [f64],
) -> Result<(), EvaluationError> {
    for assignment in assignments {
        let value = assignment.value.least(before)?;
        let place = names.iter().position(|name| *name == assignment.coordinate);
        let unknown =
            || EvaluationError::UnknownVariable { variable: assignment.coordinate.into() };
        values[place.ok_or_else(unknown)?] = value;
    }
    Ok(())
}

pub(crate) fn listed(assignments: &[Assignment]) -> String {
    let texts: Vec<String> = assignments.iter().map(Assignment::to_string).collect();
    texts.join(", ")
}

fn substituted(assignments: &[Assignment], substitution: &Substitution) -> Vec<Assignment> {
    let changed =
        |one: &Assignment| Assignment::new(one.coordinate, one.value.substitute(substitution));
    assignments.iter().map(changed).collect()
}

// Written by hand, because derives would ask the same of S.

impl<S> Clone for Assignment<S> {
    fn clone(&self) -> Self {
        Assignment::new(self.coordinate, self.value.clone())
    }
}

impl<S> Clone for Reset<S> {
    fn clone(&self) -> Self {
        Reset { form: self.form.clone(), apply: self.apply.clone() }
    }
}

impl<S> fmt::Display for Assignment<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.value {
            NewValue::Exactly(value) => write!(formatter, "{} := {value}", self.coordinate),
            NewValue::Within(lower, upper) => {
                write!(formatter, "{} :∈ [{lower}, {upper}]", self.coordinate)
            }
        }
    }
}

impl<S> fmt::Debug for Assignment<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Assignment({self})")
    }
}

impl<S> fmt::Display for Reset<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.name())
    }
}

impl<S> fmt::Debug for Reset<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "Reset({self})")
    }
}
