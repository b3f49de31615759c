//! The answer to a question.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use crate::automaton::diagram::{FlowpipePicture, Patch};
use crate::automaton::trajectory::Sample;
use crate::guards::{Expression, Interval, Substitution, constant, variable};
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
    /// The names that stand for formulas of its variables.
    pub signals: Vec<(String, Expression)>,
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
        let is_open = |name: &str| self.uncertain.iter().any(|one| one.parameter == name);
        let numbers = automaton.parameters().filter(|(name, _)| !is_open(name));
        let numbers = Substitution::new(numbers.map(|(name, value)| (name, constant(value))));
        let signals = automaton.signals();
        let signals =
            signals.map(|(name, it)| (name.to_owned(), it.substitute(&numbers))).collect();
        Ok(Solution { model, proofs, signals, nearest })
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

    /// The sets in the plane of two variables or signals, or of the time, which is called `t` unless a
    /// variable is; with runs.
    ///
    /// # Errors
    ///
    /// A sentence about a name that is none of them, or about a signal that reads an input.
    pub fn picture(
        &self,
        title: &str,
        names: [&str; 2],
        runs: &[Run],
    ) -> Result<FlowpipePicture, String> {
        let quantities = [self.quantity(names[0])?, self.quantity(names[1])?];
        let visits = self.proofs.iter().flat_map(|proof| &proof.enclosure.visits);
        let patches = visits.flat_map(|visit| {
            visit.segments.iter().filter_map(|segment| {
                let ends = |quantity: &Quantity| quantity.ends(&segment.set, segment.time);
                let [across, up] = quantities.each_ref().map(ends);
                Some(Patch { location: visit.location, across: across?, up: up? })
            })
        });
        let shown = |sample: &Sample| -> Option<Sample> {
            let [across, up] = quantities.each_ref().map(|quantity| quantity.along(sample));
            let ((x, x_rate), (y, y_rate)) = (across?, up?);
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

    /// What a name stands for.
    fn quantity(&self, name: &str) -> Result<Quantity, String> {
        let variables = self.model.variables();
        let signal = self.signals.iter().find(|(signal, _)| signal == name);
        let formula = match signal {
            Some((_, formula)) => formula.clone(),
            None if variables.iter().any(|known| known == name) => variable(name),
            None if name == "t" || name == "time" => return Ok(Quantity::Time),
            None => {
                let signals = self.signals.iter().map(|(name, _)| name);
                let known: Vec<&str> =
                    variables.iter().chain(signals).map(String::as_str).collect();
                let known = known.join(", ");
                return Err(format!("there is no variable `{name}`: there are {known}, and time"));
            }
        };
        let stranger = |it: &&str| !variables.iter().any(|known| known == it);
        if let Some(input) = formula.variables().into_iter().find(stranger) {
            return Err(format!("`{name}` reads the input `{input}`, which sets do not hold"));
        }
        let rates = variables.iter().map(|name| formula.derivative(name)).collect();
        Ok(Quantity::Formula { names: variables.to_vec(), formula, rates })
    }
}

/// What is drawn along an axis.
enum Quantity {
    Time,
    /// A formula of variables with these names, and its derivatives with respect to them.
    Formula {
        names: Vec<String>,
        formula: Expression,
        rates: Vec<Expression>,
    },
}

impl Quantity {
    /// Its least and its largest value in a set.
    fn ends(&self, set: &Polytope, time: Interval) -> Option<[f64; 2]> {
        let range = match self {
            Quantity::Time => time,
            Quantity::Formula { names, formula, .. } => {
                let sides = names.iter().cloned().zip(set.hull()?);
                formula.range(&sides.collect::<BTreeMap<String, Interval>>()).ok()?
            }
        };
        Some([range.lower(), range.upper()])
    }

    /// Its value at an instant of a run, and its rate.
    fn along(&self, sample: &Sample) -> Option<(f64, f64)> {
        let Quantity::Formula { names, formula, rates } = self else {
            return Some((sample.t, 1.0));
        };
        let named = names.iter().map(String::as_str).zip(sample.values.iter().copied());
        let state: Vec<(&str, f64)> = named.collect();
        let slope =
            |(rate, change): (&Expression, &f64)| Some(rate.evaluate(&state[..]).ok()? * change);
        let rate = rates.iter().zip(&sample.rates).map(slope).sum::<Option<f64>>()?;
        Some((formula.evaluate(&state[..]).ok()?, rate))
    }
}
