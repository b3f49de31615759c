//! Models by name, and whether runs stay in enclosures.

use std::ops::ControlFlow;

use pleach_automaton::composition::Policy;
use pleach_automaton::{Automaton, Composition, Name, Record, Trajectory};
use pleach_guards::Interval;
use pleach_verify::reach::{Enclosure, Model, Settings, StateSet, Uncertain, explore};

pub type Named = Automaton<Name, Name, Record>;

pub fn over(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap()
}

pub fn boxed(sides: &[(f64, f64)]) -> StateSet {
    StateSet::from_box(sides.iter().map(|(lower, upper)| over(*lower, *upper)).collect())
}

pub fn enclosed(
    automaton: &Named,
    uncertain: &[Uncertain],
    start: &StateSet,
    settings: &Settings,
) -> (Model, Enclosure) {
    let model = Model::with_uncertain(automaton, uncertain).unwrap();
    let starts = std::slice::from_ref(start);
    let found = explore(&model, starts, settings, &[], &mut |_, _| ControlFlow::Continue(()));
    (model, found.unwrap())
}

/// A run from `state` with these parameters.
pub fn run(
    automaton: &Named,
    parameters: &[(&str, f64)],
    state: &[f64],
    policy: Policy,
    horizon: f64,
) -> Trajectory {
    let mut automaton = automaton.clone();
    for (name, value) in parameters {
        automaton = automaton.with(name, *value).unwrap();
    }
    let names: Vec<&str> = automaton.names().to_vec();
    let state = Record::new(names.into_iter().zip(state.iter().copied())).unwrap();
    let composition =
        Composition::builder().add_in("automaton", &automaton, state).build().unwrap();
    let settings = pleach_automaton::Settings { policy, ..Default::default() };
    composition.run_with(settings, horizon).unwrap()
}

/// The first sample of a run that is in no set of its location at its time, as text; `error` is how far
/// a sample of the simulator may be from the exact solution.
pub fn escape(
    model: &Model,
    enclosure: &Enclosure,
    run: &Trajectory,
    error: f64,
) -> Option<String> {
    enclosure.escape(model, run, &[], error).map(|escape| escape.to_string())
}
