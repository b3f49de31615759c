//! Rounds of jumps: who takes what, in which order.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::{Failure, Halt, Simulation, Taken};
use crate::composition::Policy;
use crate::composition::blueprint::Leaving;
use crate::composition::jumps::{Joint, Standing};
use crate::composition::tension::{Conditions, Readiness};
use crate::executor::{Limit, Round};

impl Simulation<'_> {
    /// Takes one round of jumps of these groups; says whether there was one.
    pub(super) fn take_round(
        &mut self,
        round: &mut Round<'_, Taken>,
        groups: &BTreeSet<usize>,
        readiness: Readiness,
    ) -> Result<bool, Halt> {
        self.round += 1;
        let members = |group: &usize| &self.composition.groups[*group].components[..];
        let components = match groups.len() {
            1 => groups.first().map_or(Cow::default(), |group| members(group).into()),
            _ => {
                let mut components: Vec<usize> = groups.iter().flat_map(members).copied().collect();
                components.sort_unstable();
                components.into()
            }
        };
        let mut any = false;
        for &component in components.iter() {
            if self.jumped[component] == self.round {
                continue;
            }
            if let Some(jump) = self.next_of(component, readiness)? {
                self.take(&jump, round)?;
                any = true;
            }
        }
        Ok(any)
    }

    /// Takes one round of jumps of those of the groups whose last flow has ended because an invariant
    /// does, so that no time can pass for them; says whether there was one.
    pub(super) fn leave(
        &mut self,
        round: &mut Round<'_, Taken>,
        groups: &BTreeSet<usize>,
    ) -> Result<bool, Halt> {
        let leaving = groups.iter().copied().filter(|&group| self.groups[group].must_leave);
        let leaving: BTreeSet<usize> = leaving.collect();
        let jumped =
            !leaving.is_empty() && self.take_round(round, &leaving, Readiness::Possible)?;
        for group in leaving {
            let state = &mut self.groups[group];
            if std::mem::take(&mut state.must_leave) {
                // What cannot leave is outside, if only by rounding.
                state.allowance = 0.0;
            }
        }
        Ok(jumped)
    }

    /// The first jump in total order that `component` can take part in.
    fn next_of(
        &mut self,
        component: usize,
        readiness: Readiness,
    ) -> Result<Option<Joint>, Failure> {
        let group = self.composition.components[component].group;
        if let Some(joint) = self.compelled(group, component) {
            return Ok(Some(joint));
        }
        let mut candidates = self.candidates(component, readiness);
        if !matches!(self.settings.policy, Policy::Random { .. }) {
            return candidates.next().transpose();
        }
        let mut candidates = candidates.collect::<Result<Vec<Joint>, _>>()?;
        if candidates.is_empty() {
            return Ok(None);
        }
        let drawn = self.groups[group].chance.below(candidates.len());
        Ok(Some(candidates.swap_remove(drawn)))
    }

    /// The jump that a component is made to take beyond an accumulation of jumps.
    fn compelled(&mut self, group: usize, component: usize) -> Option<Joint> {
        let compelled = self.groups[group].compelled;
        let (_, event) = compelled.filter(|(compelled, _)| *compelled == component)?;
        self.groups[group].compelled = None;
        let mut leaving = self.standing().leaving(component).iter();
        let transition = leaving.position(|leaving| leaving.event == event)?;
        Some(Joint { label: None, parts: vec![(component, transition)] })
    }

    /// The jumps in total order that `component` can take part in.
    fn candidates(
        &self,
        component: usize,
        readiness: Readiness,
    ) -> impl Iterator<Item = Result<Joint, Failure>> {
        let conditions = self.conditions(self.composition.components[component].group);
        let leaving = self.standing().leaving(component).iter().enumerate();
        leaving.filter_map(move |(transition, leaving)| {
            let label = self.composition.components[component].labels[leaving.event];
            let joint = match label {
                None if !conditions.is_wanted(leaving, readiness) => return None,
                None => self.standing().alone(component, transition, &self.values),
                Some(label) => self.joint(label, &conditions, readiness),
            };
            joint.transpose()
        })
    }

    /// The jump that all participants of a label take together, if they can and one of them wants.
    fn joint(
        &self,
        label: usize,
        conditions: &Conditions<'_>,
        readiness: Readiness,
    ) -> Result<Option<Joint>, Failure> {
        let participants = &self.composition.labels[label].participants;
        if participants.iter().any(|(component, _)| self.jumped[*component] == self.round) {
            return Ok(None);
        }
        let Some(joint) = self.standing().together(label, &self.values)? else { return Ok(None) };
        let is_wanted = |leaving: &Leaving| conditions.is_wanted(leaving, readiness);
        let is_wanted = self.standing().is_for_one(&joint, &self.values, is_wanted)?;
        Ok(is_wanted.then_some(joint))
    }

    pub(super) fn take(&mut self, jump: &Joint, round: &mut Round<'_, Taken>) -> Result<(), Halt> {
        if self.jumps >= self.settings.jump_limit {
            return Err(Limit::Jumps(self.settings.jump_limit).into());
        }
        let group = self.composition.components[jump.parts[0].0].group;
        let (policy, chance) = (self.settings.policy, &mut self.groups[group].chance);
        let mut share = || match policy {
            Policy::Early => 0.0,
            Policy::Late => 1.0,
            Policy::Random { .. } => chance.share(),
        };
        let standing = Standing::new(self.composition, &self.locations);
        let taken = standing.taken(jump, &self.values, &mut share)?;
        for &(slot, value) in &taken.changes {
            (self.values[slot], self.rests[slot]) = (value, 0.0);
        }
        for one in &taken.moves {
            self.locations[one.component] = one.target;
            self.jumped[one.component] = self.round;
        }
        self.jumps += 1;
        self.latest = group;
        let latest = &mut self.groups[group].latest;
        *latest = [latest[1], taken.moves.first().copied()];
        // What was planned was planned for other locations.
        self.ground(group);
        self.groups[group].is_eager = false;
        self.groups[group].must_leave = false;
        if let Some(record) = &mut self.record {
            record.jumped(round.now(), group, &taken, self.composition, &self.values);
            let memory = self.settings.memory_limit;
            if record.size() > memory {
                return Err(Limit::Memory(memory).into());
            }
        }
        match &taken.moves[..] {
            [alone] => round.jumped(alone.component, taken),
            all if all.len() == self.locations.len() => round.jumped_together(taken),
            some => round.jumped_some(some.iter().map(|one| one.component).collect(), taken),
        }
        self.watch_chattering(group)
    }

    pub(super) fn standing(&self) -> Standing<'_> {
        Standing::new(self.composition, &self.locations)
    }

    pub(super) fn conditions(&self, group: usize) -> Conditions<'_> {
        Conditions {
            standing: self.standing(),
            group: &self.composition.groups[group],
            policy: self.policy_of(group),
            allowance: self.groups[group].allowance,
        }
    }

    /// Whether what may be taken is taken as soon as it can be, or as late.
    pub(super) fn policy_of(&self, group: usize) -> Policy {
        match self.settings.policy {
            Policy::Random { .. } if self.groups[group].is_eager => Policy::Early,
            Policy::Random { .. } => Policy::Late,
            policy => policy,
        }
    }
}
