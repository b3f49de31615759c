//! What a jump does to the state: x⁻ → x⁺, as assignments or as a function under a name.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use pleach_guards::{EvaluationError, Expression, Substitution, Valuation};

use crate::coordinates::Coordinates;

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
    form: Form<S>,
    apply: Arc<Apply<S>>,
}

enum Form<S> {
    Assignments(Arc<[Assignment<S>]>),
    Function(Arc<str>),
}

type Apply<S> = dyn Fn(&mut S) -> Result<(), EvaluationError> + Send + Sync;

/// One coordinate's new value over x⁻; made by
/// [`Coordinate::becomes`](crate::Coordinate::becomes) and
/// [`Coordinate::becomes_within`](crate::Coordinate::becomes_within).
pub struct Assignment<S> {
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
    fn least(&self, state: &impl Valuation) -> Result<f64, EvaluationError> {
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
    pub fn assignments(&self) -> Option<&[Assignment<S>]> {
        match &self.form {
            Form::Assignments(assignments) => Some(assignments),
            Form::Function(_) => None,
        }
    }

    /// The name or the formula, as text; empty for the identity.
    pub fn name(&self) -> Cow<'_, str> {
        match &self.form {
            Form::Assignments(assignments) => {
                let texts: Vec<String> = assignments.iter().map(Assignment::to_string).collect();
                Cow::Owned(texts.join(", "))
            }
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
    /// The same reset with expressions in the place of variables, as far as it is data.
    pub(crate) fn substitute(&self, substitution: &Substitution) -> Self {
        match self.assignments() {
            Some(assignments) => {
                let changed = assignments
                    .iter()
                    .map(|one| Assignment::new(one.coordinate, one.value.substitute(substitution)));
                changed.collect::<Vec<_>>().into()
            }
            None => self.clone(),
        }
    }
}

impl<S: Coordinates> From<Vec<Assignment<S>>> for Reset<S> {
    fn from(assignments: Vec<Assignment<S>>) -> Self {
        let assignments: Arc<[Assignment<S>]> = assignments.into();
        let listed = assignments.clone();
        let apply = Arc::new(move |state: &mut S| {
            *state = assign(&listed, state)?;
            Ok(())
        });
        Reset { form: Form::Assignments(assignments), apply }
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

/// x⁺, where every formula reads x⁻.
fn assign<S: Coordinates>(assignments: &[Assignment<S>], before: &S) -> Result<S, EvaluationError> {
    let mut after = before.to_values();
    for assignment in assignments {
        let value = assignment.value.least(before)?;
        let place = before.names().iter().position(|name| *name == assignment.coordinate);
        let unknown =
            || EvaluationError::UnknownVariable { variable: assignment.coordinate.into() };
        after[place.ok_or_else(unknown)?] = value;
    }
    Ok(before.like(&after))
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

impl<S> Clone for Form<S> {
    fn clone(&self) -> Self {
        match self {
            Form::Assignments(assignments) => Form::Assignments(assignments.clone()),
            Form::Function(name) => Form::Function(name.clone()),
        }
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
