//! Runs that are observed as they happen, and kept no farther than observers keep them.
//!
//! [`Composition::stream`] runs like [`Composition::run_with`], but keeps no trajectory: a
//! [`RunObserver`] gets every flow and every jump, in their order. So the memory of a run does not
//! grow with it. What is kept is up to observers: [`Samples`] keeps the values on a grid of times,
//! [`CsvLog`] writes them with the signals and both sides of every jump, and `()` keeps nothing. Two observers make a
//! pair of observers.
//!
//! ```
//! use pleach_automaton::composition::Settings;
//! use pleach_automaton::composition::stream::{CsvLog, Samples};
//! use pleach_automaton::{coordinates, from, Automaton};
//! use pleach_discrete::vocabulary;
//!
//! vocabulary! {
//!     enum Lamp: Location { Dark = "dark", Lit = "lit" }
//!     enum Timer: Event { Elapsed = "elapsed" }
//! }
//! coordinates! { struct Clock { clock = "t" } }
//! let Clock { clock } = Clock::coordinates();
//! let lamp = Automaton::starting_in(Lamp::Lit)
//!     .initially(Clock { clock: 0.0 })
//!     .flow(Lamp::Lit, clock.rate(1.0))
//!     .transition(from(Lamp::Lit).on(Timer::Elapsed).to(Lamp::Dark).must(clock.at_least(1.5)))
//!     .build()?;
//!
//! let (mut samples, mut log) = (Samples::every(1.0), CsvLog::every(1.0, Vec::new()));
//! let finish = lamp.alone()?.stream(Settings::default(), 2.0, &mut (&mut samples, &mut log))?;
//! assert_eq!(finish.values, [1.5]);
//! assert_eq!(samples.rows(), [(0.0, vec![0.0]), (1.0, vec![1.0]), (2.0, vec![1.5])]);
//! let text = String::from_utf8(log.finish()?)?;
//! assert_eq!(text.lines().nth(3), Some("1.5,0,,,1.5")); // before the jump
//! assert_eq!(text.lines().nth(4), Some("1.5,1,automaton,elapsed,1.5")); // and after it
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod log;

use std::ops::ControlFlow;

use super::simulation::{Failure, Simulation, SimulationError, Taken};
use super::{Composition, Move, Settings};
use crate::executor::{Ending, Observer};
use crate::moment::Moment;
use crate::time::HybridTime;
use crate::trace::TraceEntry;
use crate::trajectory::Doubt;

pub use log::{CsvLog, Samples};

/// Sees a run as it happens.
pub trait RunObserver {
    /// A run of `composition` up to `horizon` seconds is about to begin. It does not if this is an error, which says
    /// what is wrong and what would be right.
    fn begins(&mut self, _composition: &Composition, _horizon: f64) -> Result<(), String> {
        Ok(())
    }

    /// Time passes, up to a jump of any component or to the end of the run.
    fn flows(&mut self, _flow: &Flowing<'_>) {}

    /// A jump is taken.
    fn jumps(&mut self, _jump: &Jumping<'_>) {}
}

/// A flow of a run that is observed.
pub struct Flowing<'a> {
    simulation: &'a Simulation<'a>,
    /// The hybrid time at which it begins.
    pub from: HybridTime,
    /// When it ends, in seconds.
    pub until: f64,
}

/// A jump of a run that is observed.
pub struct Jumping<'a> {
    composition: &'a Composition,
    /// The jump leads from (t, j) to (t, j + 1).
    pub at: HybridTime,
    /// The event or the label.
    pub label: &'a str,
    /// The moves of the components.
    pub moves: &'a [Move],
    /// x⁻, by variable.
    pub before: &'a [f64],
    /// x⁺, by variable.
    pub after: &'a [f64],
}

/// How a run that was observed has ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finish {
    /// When and why.
    pub ending: Ending<Failure>,
    /// The values of the variables at the end.
    pub values: Vec<f64>,
    /// The locations of the components at the end, as numbers.
    pub locations: Vec<usize>,
    /// Where it is undecided whether something happens.
    pub doubts: Vec<Doubt>,
}

impl Flowing<'_> {
    /// The composition that runs.
    pub fn composition(&self) -> &Composition {
        self.simulation.composition()
    }

    /// The locations of the components, as numbers.
    pub fn locations(&self) -> &[usize] {
        self.simulation.locations()
    }

    /// The values at instant `t` of the flow, by variable. At the end they are x⁻ of a jump there.
    pub fn values_at(&self, t: f64) -> Vec<f64> {
        self.simulation.values_at(Moment::from(t))
    }
}

impl Jumping<'_> {
    /// The names of the components that take part.
    pub fn components(&self) -> impl Iterator<Item = &str> {
        self.composition.names_of(self.moves)
    }

    /// The composition that runs.
    pub fn composition(&self) -> &Composition {
        self.composition
    }
}

impl RunObserver for () {}

impl<O: RunObserver + ?Sized> RunObserver for &mut O {
    fn begins(&mut self, composition: &Composition, horizon: f64) -> Result<(), String> {
        (**self).begins(composition, horizon)
    }

    fn flows(&mut self, flow: &Flowing<'_>) {
        (**self).flows(flow);
    }

    fn jumps(&mut self, jump: &Jumping<'_>) {
        (**self).jumps(jump);
    }
}

impl<A: RunObserver, B: RunObserver> RunObserver for (A, B) {
    fn begins(&mut self, composition: &Composition, horizon: f64) -> Result<(), String> {
        self.0.begins(composition, horizon)?;
        self.1.begins(composition, horizon)
    }

    fn flows(&mut self, flow: &Flowing<'_>) {
        self.0.flows(flow);
        self.1.flows(flow);
    }

    fn jumps(&mut self, jump: &Jumping<'_>) {
        self.0.jumps(jump);
        self.1.jumps(jump);
    }
}

impl Composition {
    /// Runs the composition for `horizon` seconds and shows every flow and jump to `observer`. Nothing
    /// of the run is kept, so that [`Settings::memory_limit`] is no matter.
    ///
    /// # Errors
    ///
    /// As for [`run_with`](Self::run_with), and [`SimulationError::Observer`] if the observer refuses to begin.
    pub fn stream(
        &self,
        settings: Settings,
        horizon: f64,
        observer: &mut impl RunObserver,
    ) -> Result<Finish, SimulationError> {
        let simulation = Simulation::new(self, settings, horizon)?.unrecorded();
        observer.begins(self, horizon).map_err(SimulationError::Observer)?;
        let mut view = View { composition: self, values: self.initial.clone(), observer };
        simulation.finish(&mut view)
    }
}

/// What the executor reports, for an observer.
struct View<'a, O> {
    composition: &'a Composition,
    /// The present state.
    values: Vec<f64>,
    observer: &'a mut O,
}

impl<'a, O: RunObserver> Observer<Simulation<'a>> for View<'_, O> {
    fn flows(
        &mut self,
        simulation: &Simulation<'a>,
        now: HybridTime,
        duration: f64,
    ) -> ControlFlow<std::convert::Infallible> {
        let end = simulation.end_of(duration);
        self.observer.flows(&Flowing { simulation, from: now, until: end.seconds() });
        self.values = simulation.values_at(end);
        ControlFlow::Continue(())
    }

    fn jumped(&mut self, entry: TraceEntry<Taken>) {
        let Taken { label, moves, changes } = entry.jump;
        let before = self.values.clone();
        changes.iter().for_each(|&(slot, value)| self.values[slot] = value);
        self.observer.jumps(&Jumping {
            composition: self.composition,
            at: entry.at,
            label: &label,
            moves: &moves,
            before: &before,
            after: &self.values,
        });
    }
}
