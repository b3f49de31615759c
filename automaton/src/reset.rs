//! What a jump does to the state: x⁻ → x⁺, as assignments or as a function under a name.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use pleach_guards::Expression;

/// The reset of a transition.
///
/// It is data where it is a list of assignments, which all read x⁻ and leave every other
/// coordinate as it is; or else a function with the name that diagrams show, which analyses report
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
/// let halt = Reset::new("halt", |ball: &mut Ball| ball.velocity = 0.0);
/// assert_eq!(halt.to_string(), "halt");
/// ```
pub struct Reset<S> {
    action: Action<S>,
}

pub(crate) enum Action<S> {
    Assignments(Arc<[Assignment<S>]>),
    Function(Arc<str>, Arc<dyn Fn(&mut S) + Send + Sync>),
}

/// One coordinate's new value, as a formula over x⁻; made by
/// [`Coordinate::becomes`](crate::Coordinate::becomes).
pub struct Assignment<S> {
    coordinate: &'static str,
    value: Expression,
    state: PhantomData<fn() -> S>,
}

impl<S> Assignment<S> {
    pub(crate) fn new(coordinate: &'static str, value: Expression) -> Self {
        Assignment { coordinate, value, state: PhantomData }
    }

    /// The name of the coordinate that is assigned.
    pub fn coordinate(&self) -> &'static str {
        self.coordinate
    }

    /// What it becomes.
    pub fn value(&self) -> &Expression {
        &self.value
    }
}

impl<S> Reset<S> {
    /// The reset that `apply` carries out; `name` says it in a few words or as a formula.
    pub fn new(name: &str, apply: impl Fn(&mut S) + Send + Sync + 'static) -> Self {
        Reset { action: Action::Function(name.into(), Arc::new(apply)) }
    }

    /// The reset that changes nothing, x⁺ = x⁻.
    pub fn identity() -> Self {
        Reset { action: Action::Assignments(Arc::new([])) }
    }

    /// Whether it changes nothing.
    pub fn is_identity(&self) -> bool {
        matches!(&self.action, Action::Assignments(assignments) if assignments.is_empty())
    }

    /// The assignments, unless the reset is a function.
    pub fn assignments(&self) -> Option<&[Assignment<S>]> {
        match &self.action {
            Action::Assignments(assignments) => Some(assignments),
            Action::Function(..) => None,
        }
    }

    /// The name or the formula, as text; empty for the identity.
    pub fn name(&self) -> Cow<'_, str> {
        match &self.action {
            Action::Assignments(assignments) => {
                let texts: Vec<String> = assignments.iter().map(Assignment::to_string).collect();
                Cow::Owned(texts.join(", "))
            }
            Action::Function(name, _) => Cow::Borrowed(name),
        }
    }

    pub(crate) fn action(&self) -> &Action<S> {
        &self.action
    }
}

impl<S, const N: usize> From<[Assignment<S>; N]> for Reset<S> {
    fn from(assignments: [Assignment<S>; N]) -> Self {
        Reset { action: Action::Assignments(Arc::new(assignments)) }
    }
}

impl<S> From<Vec<Assignment<S>>> for Reset<S> {
    fn from(assignments: Vec<Assignment<S>>) -> Self {
        Reset { action: Action::Assignments(assignments.into()) }
    }
}

impl<S> From<Assignment<S>> for Reset<S> {
    fn from(assignment: Assignment<S>) -> Self {
        [assignment].into()
    }
}

// Written by hand, because derives would ask the same of S.

impl<S> Clone for Assignment<S> {
    fn clone(&self) -> Self {
        Assignment::new(self.coordinate, self.value.clone())
    }
}

impl<S> Clone for Reset<S> {
    fn clone(&self) -> Self {
        Reset { action: self.action.clone() }
    }
}

impl<S> Clone for Action<S> {
    fn clone(&self) -> Self {
        match self {
            Action::Assignments(assignments) => Action::Assignments(assignments.clone()),
            Action::Function(name, apply) => Action::Function(name.clone(), apply.clone()),
        }
    }
}

impl<S> fmt::Display for Assignment<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} := {}", self.coordinate, self.value)
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
