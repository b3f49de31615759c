//! The combinations of locations that the components of a composition can be in.

use std::collections::BTreeMap;

use pleach_guards::always;

use super::labels::Label;
use super::model::Model;
use super::reachability::Reach;

/// The most combinations that are looked at.
const MOST_STATES: usize = 20_000;

/// Combinations of locations, and how components go from one to another.
pub(super) struct Product {
    /// By component: the location. The first combination is the initial one.
    pub(super) states: Vec<Vec<usize>>,
    steps: Vec<Step>,
    /// Whether all combinations that can be reached are there.
    pub(super) is_complete: bool,
    /// By combination: whether it is reached by jumps of which the guards concern one component at
    /// most, so that the times at which several components jump do not matter.
    pub(super) is_certain: Vec<bool>,
}

/// A jump between two combinations.
struct Step {
    from: usize,
    to: usize,
    label: Option<usize>,
    /// The participants.
    components: Vec<usize>,
    /// Those with a guard.
    guarded: Vec<usize>,
}

/// What can be reached by transitions that are live in their components, if partners take labels
/// together.
pub(super) fn explore(models: &[Model], reaches: &[Reach], labels: &[Label]) -> Product {
    let initial: Vec<usize> = models.iter().map(|model| model.initial).collect();
    let mut numbers = BTreeMap::from([(initial.clone(), 0)]);
    let mut product = Product {
        states: vec![initial],
        steps: Vec::new(),
        is_complete: true,
        is_certain: Vec::new(),
    };
    let mut from = 0;
    while from < product.states.len() {
        let here = product.states[from].clone();
        for (label, jump) in jumps(models, reaches, labels, &here) {
            let mut next = here.clone();
            for &(component, transition) in &jump {
                next[component] = models[component].transitions[transition].target;
            }
            let to = match numbers.get(&next) {
                Some(&known) => known,
                None if product.states.len() >= MOST_STATES => {
                    product.is_complete = false;
                    continue;
                }
                None => {
                    numbers.insert(next.clone(), product.states.len());
                    product.states.push(next);
                    product.states.len() - 1
                }
            };
            let is_guarded = |&&(component, transition): &&(usize, usize)| {
                *models[component].transitions[transition].guard.predicate() != always()
            };
            let guarded = jump.iter().filter(is_guarded).map(|(component, _)| *component).collect();
            let components = jump.into_iter().map(|(component, _)| component).collect();
            product.steps.push(Step { from, to, label, components, guarded });
        }
        from += 1;
    }
    product.find_certain(models.len());
    product
}

/// Components with the transitions that they take.
type Jump = Vec<(usize, usize)>;

/// All jumps from one combination of locations, each with its label if it has one.
fn jumps(
    models: &[Model],
    reaches: &[Reach],
    labels: &[Label],
    locations: &[usize],
) -> Vec<(Option<usize>, Jump)> {
    let live = |component: usize| {
        let leaving = models[component].modes[locations[component]].leaving.iter().copied();
        leaving.filter(move |&number| reaches[component].is_live[number])
    };
    let mut jumps = Vec::new();
    for (component, model) in models.iter().enumerate() {
        for number in live(component).filter(|&number| model.is_own(number)) {
            jumps.push((None, vec![(component, number)]));
        }
    }
    for (number, label) in labels.iter().enumerate() {
        let part = |&(component, event): &(usize, usize)| {
            let transitions = &models[component].transitions;
            let transition = live(component).find(|&number| transitions[number].event == event)?;
            Some((component, transition))
        };
        if let Some(jump) = label.participants.iter().map(part).collect::<Option<Jump>>() {
            jumps.push((Some(number), jump));
        }
    }
    jumps
}

impl Product {
    fn find_certain(&mut self, components: usize) {
        let mut after = vec![Vec::new(); self.states.len()];
        for (number, step) in self.steps.iter().enumerate() {
            after[step.from].push(number);
        }
        self.is_certain = vec![false; self.states.len()];
        for free in 0..components {
            let mut is_seen = vec![false; self.states.len()];
            let mut open = vec![0];
            while let Some(state) = open.pop() {
                if !std::mem::replace(&mut is_seen[state], true) {
                    self.is_certain[state] = true;
                    let steps = after[state].iter().map(|&number| &self.steps[number]);
                    let certain = steps.filter(|step| step.guarded.iter().all(|one| *one == free));
                    open.extend(certain.map(|step| step.to));
                }
            }
        }
    }

    /// Whether the label is ever taken.
    pub(super) fn takes(&self, label: usize) -> bool {
        self.steps.iter().any(|step| step.label == Some(label))
    }

    /// By combination: whether `component` can still take part in a jump, then or later.
    pub(super) fn goes_on(&self, component: usize) -> Vec<bool> {
        let mut before = vec![Vec::new(); self.states.len()];
        let mut goes_on = vec![false; self.states.len()];
        let mut open = Vec::new();
        for step in &self.steps {
            before[step.to].push(step.from);
            if step.components.contains(&component) {
                open.push(step.from);
            }
        }
        while let Some(state) = open.pop() {
            if !std::mem::replace(&mut goes_on[state], true) {
                open.extend(&before[state]);
            }
        }
        goes_on
    }
}
