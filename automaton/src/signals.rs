//! Signals: names that stand for formulas.
//!
//! An output of a plant, the error of a loop, a power: what several guards and flows read, or what a
//! run is to record, has a name of its own. Formulas of signals may name other signals, but none may
//! depend on itself.

use pleach_guards::{Expression, Substitution};

/// A name with the formula for which it stands.
pub(crate) type Signal = (String, Expression);

/// The signals in their order, as formulas that name none of them.
///
/// # Errors
///
/// The names along a cycle, the first of them again at its end.
pub(crate) fn resolved(signals: &[Signal]) -> Result<Vec<Signal>, Vec<String>> {
    let mut found: Vec<Signal> = Vec::new();
    let mut open: Vec<&Signal> = signals.iter().collect();
    while !open.is_empty() {
        let is_open = |name: &str| open.iter().any(|(signal, _)| signal == name);
        let (waiting, ready): (Vec<&Signal>, Vec<&Signal>) =
            open.iter().partition(|(_, formula)| formula.variables().into_iter().any(is_open));
        if ready.is_empty() {
            return Err(cycle(&waiting));
        }
        let formulas = Substitution::new(found.iter().cloned());
        let resolved = |(name, formula): &Signal| (name.clone(), formula.substitute(&formulas));
        found.extend(ready.into_iter().map(resolved));
        open = waiting;
    }
    found.sort_by_key(|(name, _)| signals.iter().position(|(signal, _)| signal == name));
    Ok(found)
}

/// A way through signals of which each depends on another, up to where it comes back to itself.
fn cycle(signals: &[&Signal]) -> Vec<String> {
    let mut way: Vec<&Signal> = Vec::new();
    let mut next = signals.first().copied();
    while let Some(signal) = next {
        if let Some(begin) = way.iter().position(|passed| passed.0 == signal.0) {
            way.drain(..begin);
            break;
        }
        way.push(signal);
        let read = signal.1.variables();
        next = signals.iter().copied().find(|(name, _)| read.contains(&**name));
    }
    way.iter().chain(way.first()).map(|(name, _)| name.clone()).collect()
}

/// A cycle in words.
pub(crate) fn listed(cycle: &[String]) -> String {
    let names: Vec<String> = cycle.iter().map(|name| format!("`{name}`")).collect();
    names.join(" → ")
}
