//! Forced transitions that follow each other while no time passes.
//!
//! A cycle of forced transitions is gone round in no time if, one reset after the other, each guard
//! holds where the one before has landed, and each landing is within the invariant. It goes on for
//! ever if it comes back to the state in which it began: such a state is looked for.
//!
//! If all guards can hold strictly there, that is an error, and so it is if every round is followed by
//! another one, as where a reset puts the state on the boundary of its own guard. Where only some rounds
//! are, and guards hold on their boundary alone, as at the point where the water of two tanks is gone,
//! runs end there if they ever come there, which is worth a note. A cycle that can be repeated, but in
//! another state each time, may count to a number or never end; it gets a note, too.

use petgraph::algo::tarjan_scc;
use petgraph::graph::DiGraph;
use pleach_guards::{Predicate, Substitution, not, variable};

use super::inquiry::{Inquiry, closed, open};
use super::reachability::Reach;
use super::report::{FindingPlace, Kind, Shown};

/// The most cycles that are looked at, and the longest.
const MOST_CYCLES: usize = 500;
const LONGEST_CYCLE: usize = 12;

impl Inquiry<'_> {
    pub(super) fn report_cycles(&mut self, reach: &Reach) {
        let cycles = self.forced_cycles(reach);
        if cycles.len() >= MOST_CYCLES {
            let place =
                FindingPlace { component: self.model.component.clone(), ..FindingPlace::default() };
            let message = format!("of the cycles of forced transitions, {MOST_CYCLES} are checked");
            self.note(Kind::Unexplored, place, message);
        }
        for cycle in cycles {
            self.report_cycle(&cycle);
        }
    }

    fn report_cycle(&mut self, cycle: &[usize]) {
        let Some(round) = self.round(cycle) else { return };
        let place = self.model.place_of(cycle);
        let strict = Predicate::all([round.closed_invariants.clone(), round.open_guards.clone()]);
        if let Some(witness) = self.example(&(strict.clone() & round.returns.clone())) {
            let message = "no time passes while they follow each other for ever: \
                           make one of the guards false after the others"
                .to_owned();
            self.error(Kind::TimelessCycle, place, message, witness);
            return;
        }
        if let Some(witness) = self.for_ever(cycle, &round, &strict) {
            let message = "no time passes while they follow each other for ever, since what they \
                           wait for stays true: make one of the guards false after the others"
                .to_owned();
            self.error(Kind::TimelessCycle, place, message, witness);
            return;
        }
        let loose = Predicate::all([round.closed_invariants.clone(), round.guards.clone()]);
        if let Some(witness) = self.example(&(loose.clone() & round.returns.clone())) {
            let message = "on the boundary of their guards they follow each other for ever, and \
                           no time passes: a run that comes there ends"
                .to_owned();
            self.note_with(Kind::TimelessCycle, place, message, witness);
            return;
        }
        let again = strict.clone() & strict.substitute(&round.reset);
        if let Some(witness) = self.example(&again) {
            let message = "no time passes while they follow each other more than once; whether \
                           that ends is not known"
                .to_owned();
            self.note_with(Kind::TimelessCycle, place, message, witness);
            return;
        }
        self.witness(Kind::TimelessCycle, &place, &(loose & round.returns));
    }

    /// A state from which the cycle is gone round without end: wherever its guards hold and nothing
    /// else goes first, that is so again after a round.
    fn for_ever(&self, cycle: &[usize], round: &Round, strict: &Predicate) -> Option<Shown> {
        let alone = Predicate::all([round.guards.clone(), self.unhindered(cycle)?]);
        let witness = self.robust_example(&(strict.clone() & alone.clone()))?;
        let ends = alone.clone() & not(alone.substitute(&round.reset));
        (!self.is_possible(&ends)).then_some(witness)
    }

    /// That no other forced transition goes first on the way round.
    fn unhindered(&self, cycle: &[usize]) -> Option<Predicate> {
        let (mut reset, mut assigned) = (Substitution::default(), Vec::new());
        let mut refused = Vec::new();
        for &number in cycle {
            let transition = &self.model.transitions[number];
            let leaving = self.model.modes[transition.source].leaving.iter();
            let first = leaving.take_while(|&&other| other != number);
            let first = first.filter(|&&other| self.model.is_forced(other));
            refused.extend(
                first.map(|&other| self.model.transitions[other].refused().substitute(&reset)),
            );
            assigned.extend(transition.assignments().iter().map(|(name, _)| name.as_str()));
            reset = after(&reset, &transition.substitution()?, &assigned);
        }
        Some(Predicate::all(refused))
    }

    /// Where the cycle can be gone round once, and what it does; nothing if a reset is a function.
    fn round(&self, cycle: &[usize]) -> Option<Round> {
        let mut reset = Substitution::default();
        let (mut guards, mut open_guards, mut invariants) = (Vec::new(), Vec::new(), Vec::new());
        let mut assigned: Vec<&str> = Vec::new();
        for &number in cycle {
            let transition = &self.model.transitions[number];
            invariants.push(self.standing(transition.source).substitute(&reset));
            guards.push(transition.guard.predicate().substitute(&reset));
            open_guards.push(open(transition.guard.predicate()).substitute(&reset));
            let names = transition.assignments().iter().map(|(name, _)| name.as_str());
            assigned.extend(names);
            reset = after(&reset, &transition.substitution()?, &assigned);
        }
        let returns = assigned.iter().map(|name| {
            let (before, now) = (variable(name), variable(name).substitute(&reset));
            if before == now {
                Predicate::all([])
            } else {
                now.at_most(&before) & now.at_least(&before)
            }
        });
        Some(Round {
            guards: Predicate::all(guards),
            open_guards: Predicate::all(open_guards),
            closed_invariants: closed(&Predicate::all(invariants)),
            returns: Predicate::all(returns),
            reset,
        })
    }

    /// Simple cycles of live forced transitions, each once.
    fn forced_cycles(&self, reach: &Reach) -> Vec<Vec<usize>> {
        let model = self.model;
        let mut graph = DiGraph::<(), usize>::new();
        let nodes: Vec<_> = model.modes.iter().map(|_| graph.add_node(())).collect();
        let numbers = (0..model.transitions.len())
            .filter(|&number| reach.is_live[number] && model.is_forced(number));
        for number in numbers {
            let transition = &model.transitions[number];
            graph.add_edge(nodes[transition.source], nodes[transition.target], number);
        }
        let mut cycles = Vec::new();
        for component in tarjan_scc(&graph) {
            let mut members: Vec<usize> = component.iter().map(|node| node.index()).collect();
            members.sort_unstable();
            for &start in &members {
                let from_here: Vec<usize> =
                    members.iter().copied().filter(|&one| one >= start).collect();
                self.extend_cycle(start, &from_here, reach, &mut Vec::new(), &mut cycles);
            }
        }
        cycles
    }

    /// Follows transitions among `members` until they come back to `start`.
    fn extend_cycle(
        &self,
        start: usize,
        members: &[usize],
        reach: &Reach,
        path: &mut Vec<usize>,
        cycles: &mut Vec<Vec<usize>>,
    ) {
        let model = self.model;
        let here = path.last().map_or(start, |&last| model.transitions[last].target);
        let leaving = model.modes[here].leaving.iter().copied();
        for number in leaving.filter(|&one| reach.is_live[one] && model.is_forced(one)) {
            let target = model.transitions[number].target;
            let visited = path.iter().any(|&before| model.transitions[before].source == target);
            if cycles.len() >= MOST_CYCLES || !members.contains(&target) {
                continue;
            }
            path.push(number);
            if target == start {
                cycles.push(path.clone());
            } else if !visited && path.len() < LONGEST_CYCLE {
                self.extend_cycle(start, members, reach, path, cycles);
            }
            path.pop();
        }
    }
}

/// A cycle gone round once, as formulas over the state in which it begins.
struct Round {
    guards: Predicate,
    open_guards: Predicate,
    closed_invariants: Predicate,
    /// The state afterwards is the state before.
    returns: Predicate,
    reset: Substitution,
}

/// The reset that does `first` and then `second`, which between them change `assigned`.
fn after(first: &Substitution, second: &Substitution, assigned: &[&str]) -> Substitution {
    Substitution::new(assigned.iter().map(|name| {
        let name = *name;
        (name, variable(name).substitute(second).substitute(first))
    }))
}
