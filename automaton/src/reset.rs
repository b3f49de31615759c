//! What a jump and what time does to the state: resets and flows, each under a name.

use std::fmt;
use std::sync::Arc;

/// The reset of a transition: x⁻ → x⁺, as a function with the name that diagrams show.
pub struct Reset<S> {
    name: Arc<str>,
    apply: fn(&mut S),
}

impl<S> Reset<S> {
    /// The reset that `apply` carries out; `name` says it in a few words or as a formula.
    pub fn new(name: &str, apply: fn(&mut S)) -> Self {
        Reset { name: name.into(), apply }
    }

    /// The reset that changes nothing, x⁺ = x⁻; its name is empty.
    pub fn identity() -> Self {
        Reset::new("", |_| {})
    }

    /// The name, empty for the identity.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Turns x⁻ into x⁺.
    pub fn apply(&self, state: &mut S) {
        (self.apply)(state);
    }
}

/// The flow of a location: how the state changes while time passes there, as a function with the
/// name that diagrams show.
pub struct Flow<S> {
    name: Arc<str>,
    advance: fn(&mut S, f64),
}

impl<S> Flow<S> {
    /// The flow whose exact solution `advance` computes: it carries a state over a duration ≥ 0
    /// in seconds. `name` is a formula such as `τ̇ = 1`.
    pub fn new(name: &str, advance: fn(&mut S, f64)) -> Self {
        Flow { name: name.into(), advance }
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Carries `state` over `duration` seconds.
    pub fn advance(&self, state: &mut S, duration: f64) {
        (self.advance)(state, duration);
    }
}

// Written by hand, because derives would ask the same of S.

impl<S> Clone for Reset<S> {
    fn clone(&self) -> Self {
        Reset { name: self.name.clone(), apply: self.apply }
    }
}

impl<S> Clone for Flow<S> {
    fn clone(&self) -> Self {
        Flow { name: self.name.clone(), advance: self.advance }
    }
}

impl<S> fmt::Debug for Reset<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Reset").field(&self.name).finish()
    }
}

impl<S> fmt::Debug for Flow<S> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("Flow").field(&self.name).finish()
    }
}
