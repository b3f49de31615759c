//! The answer to a question.

use std::ops::ControlFlow;

use crate::automaton::diagram::{FlowpipePicture, Patch};
use crate::automaton::trajectory::Sample;
use crate::guards::Interval;
use crate::verify::reach::{
    Counterexample, Effort, Model, Polytope, Proof, ReachError, Run, Settings, falsify, prove, runs,
};

use super::{Initial, Problem};

/// How a question is answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// No run comes to a forbidden state.
    Holds,
    /// One does.
    Violated,
    /// Neither was found.
    Undecided,
}

/// What was found of a question.
#[derive(Clone, Debug)]
pub struct Solution {
    /// The model that was enclosed.
    pub model: Model,
    /// For each alternative of the initial states.
    pub proofs: Vec<Proof>,
    /// The run that comes nearest to forbidden states, where one was looked for.
    pub nearest: Option<Box<Counterexample>>,
}

impl Problem {
    /// Encloses all runs and, where that does not decide, looks for one that comes to a forbidden
    /// state, and then encloses all in [finer](Proof::refined) sets. `progress` is told how long runs have
    /// lasted in what is enclosed; it may end the search.
    ///
    /// # Errors
    ///
    /// [`ReachError`] if a part of the model cannot be enclosed.
    pub fn solve(
        &self,
        effort: &Effort,
        progress: &mut dyn FnMut(Interval) -> ControlFlow<()>,
    ) -> Result<Solution, ReachError> {
        let Some(automaton) = self.automata.first() else {
            return Err(crate::verify::reach::ModelError::Initial.into());
        };
        let model = Model::with_uncertain(automaton, &self.uncertain)?;
        let mut prove = |initial: &Initial, settings: &Settings| {
            let model = model.clone().beginning_in(&initial.locations)?;
            let starts = std::slice::from_ref(&initial.states);
            prove(&model, starts, &self.forbidden, settings, progress)
        };
        let mut proofs = Vec::new();
        for initial in &self.initial {
            proofs.push(prove(initial, &self.settings)?);
        }
        let is_decided = self.forbidden.is_empty() || proofs.iter().all(Proof::holds);
        let nearest = if is_decided { None } else { self.nearest(effort) };
        if nearest.as_ref().is_none_or(|run| !run.is_violation) {
            let coarse = self.initial.iter().zip(proofs);
            let finer = coarse.map(|(initial, proof)| {
                proof.refined(&self.settings, |finer| prove(initial, finer))
            });
            proofs = finer.collect::<Result<_, _>>()?;
        }
        Ok(Solution { model, proofs, nearest })
    }

    /// The run of all that were tried that comes nearest to forbidden states.
    fn nearest(&self, effort: &Effort) -> Option<Box<Counterexample>> {
        let mut nearest: Option<Box<Counterexample>> = None;
        for initial in &self.initial {
            let begins = |name: &str| initial.locations.iter().any(|location| location == name);
            for automaton in self.automata.iter().filter(|it| begins(it.initial().as_str())) {
                let (starts, settings) = (initial.starts(), &self.settings);
                let found =
                    falsify(automaton, &self.uncertain, starts, &self.forbidden, settings, effort);
                let Some(found) = found else { continue };
                if nearest.as_ref().is_none_or(|known| found.margin > known.margin) {
                    nearest = Some(Box::new(found));
                }
            }
        }
        nearest
    }

    /// Runs to be drawn into a picture, `count` for each alternative of the initial states.
    pub fn runs(&self, count: usize) -> Vec<Run> {
        let mut drawn = Vec::new();
        for initial in &self.initial {
            let begins = |name: &str| initial.locations.iter().any(|location| location == name);
            for automaton in self.automata.iter().filter(|it| begins(it.initial().as_str())) {
                let (starts, settings) = (initial.starts(), &self.settings);
                drawn.extend(runs(automaton, &self.uncertain, starts, settings, count, 1));
            }
        }
        drawn
    }
}

impl Solution {
    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        match &self.nearest {
            Some(run) if run.is_violation => Verdict::Violated,
            _ if self.proofs.iter().all(Proof::holds) => Verdict::Holds,
            _ => Verdict::Undecided,
        }
    }

    /// The sets in the plane of two variables, or of the time, which is called `t` unless a variable
    /// is; with runs.
    ///
    /// # Errors
    ///
    /// The name that is no variable.
    pub fn picture(
        &self,
        title: &str,
        names: [&str; 2],
        runs: &[Run],
    ) -> Result<FlowpipePicture, String> {
        let variables = self.model.variables();
        let quantity = |name: &str| match variables.iter().position(|variable| variable == name) {
            Some(place) => Ok(Some(place)),
            None if name == "t" || name == "time" => Ok(None),
            None => Err(format!(
                "there is no variable `{name}`: there are {}, and time",
                variables.join(", ")
            )),
        };
        let [across, up] = [quantity(names[0])?, quantity(names[1])?];
        let ends = |set: &Polytope, time: Interval, quantity: Option<usize>| -> Option<[f64; 2]> {
            let side = match quantity {
                Some(place) => *set.hull()?.get(place)?,
                None => time,
            };
            Some([side.lower(), side.upper()])
        };
        let visits = self.proofs.iter().flat_map(|proof| &proof.enclosure.visits);
        let patches = visits.flat_map(|visit| {
            visit.segments.iter().filter_map(|segment| {
                let across = ends(&segment.set, segment.time, across)?;
                let up = ends(&segment.set, segment.time, up)?;
                Some(Patch { location: visit.location, across, up })
            })
        });
        let shown = |sample: &Sample| -> Option<Sample> {
            let along = |quantity: Option<usize>| match quantity {
                Some(place) => Some((*sample.values.get(place)?, *sample.rates.get(place)?)),
                None => Some((sample.t, 1.0)),
            };
            let ((x, x_rate), (y, y_rate)) = (along(across)?, along(up)?);
            Some(Sample { t: sample.t, values: vec![x, y], rates: vec![x_rate, y_rate] })
        };
        let phases = runs.iter().flat_map(|run| run.trajectory.intervals().take(run.lawful));
        let phases = phases.map(|phase| phase.samples.iter().filter_map(shown).collect());
        let segments: usize = self
            .proofs
            .iter()
            .flat_map(|proof| &proof.enclosure.visits)
            .map(|visit| visit.segments.len())
            .sum();
        Ok(FlowpipePicture {
            title: title.to_owned(),
            subtitle: format!(
                "all states that are reached, in {segments} sets; {} runs",
                runs.len()
            ),
            names: names.map(str::to_owned),
            locations: self.model.locations().iter().map(|place| place.name.clone()).collect(),
            patches: patches.collect(),
            runs: phases.collect(),
        })
    }
}
