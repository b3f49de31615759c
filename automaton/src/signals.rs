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
    let mut formulas = Substitution::default();
    let mut found: Vec<Option<Expression>> = vec![None; signals.len()];
    while found.iter().any(Option::is_none) {
        let is_open = |name: &str| {
            let mut open = signals.iter().zip(&found).filter(|(_, found)| found.is_none());
            open.any(|((signal, _), _)| signal == name)
        };
        let is_ready = |formula: &Expression| !formula.variables().into_iter().any(is_open);
        let ready = signals.iter().zip(&found).map(|((_, formula), found)| match found {
            None if is_ready(formula) => Some(formula.substitute(&formulas)),
            known => known.clone(),
        });
        let ready: Vec<Option<Expression>> = ready.collect();
        if ready == found {
            let open = signals.iter().zip(&found).filter(|(_, found)| found.is_none());
            return Err(cycle(&open.map(|(signal, _)| signal).collect::<Vec<_>>()));
        }
        found = ready;
        formulas = Substitution::new(
            signals.iter().zip(&found).filter_map(|((name, _), it)| Some((name, it.clone()?))),
        );
    }
    let names = signals.iter().map(|(name, _)| name.clone());
    Ok(names.zip(found.into_iter().flatten()).collect())
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
