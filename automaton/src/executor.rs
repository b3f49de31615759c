//! The executor: it runs any [`System`] over hybrid time.
//!
//! # Semantics
//!
//! A run alternates between jumps, which take no time, and flows, which let time pass. From hybrid
//! time (0, 0) on, the executor repeats:
//!
//! 1. **Finished?** If the system says that it is, the run ends.
//! 2. **A round of jumps.** The system takes the transitions that are enabled now, in a total
//!    order: first a transition that all components share, and if there is none, at most one
//!    transition of each component, by ascending index. Jumps are never simultaneous: the state
//!    x⁻ that a jump finds is the state x⁺ that the jump before it leaves, and a jump at (t, j) leads
//!    to (t, j + 1). After a round with a jump the executor begins again at 1, so that a guard
//!    which is true on entering a location is seen at that same instant.
//! 3. **A flow.** When nothing is enabled any more, time passes up to the instant at which the next
//!    transition that has to be taken becomes enabled, and not beyond it. The flow lands on the
//!    side of the guard where the transition can be taken; so an event on the boundary between two
//!    flows happens once, at the end of the first.
//!
//! The run covers the closed interval from 0 to the horizon: jumps at the horizon itself are taken.
//! Transitions that only *may* be taken are up to the system, in its rounds.
//!
//! A run whose jumps come ever faster, so that infinitely many of them would happen before an instant
//! that time never reaches, is recognised and ended ([`zeno`](crate::zeno)).
//!
//! Every run ends with a [`Reason`]. Nothing in it depends on clocks, threads or chance.
//!
//! # Example
//!
//! A metronome: its clock flows by τ̇ = 1, and where τ = 0.5 it ticks and resets the clock.
//!
//! ```
//! use std::convert::Infallible;
//! use pleach_automaton::{Executor, Reason, Round, System, Trace};
//!
//! const PERIOD: f64 = 0.5;
//!
//! struct Metronome { clock: f64, ticks: u32 }
//!
//! impl System for Metronome {
//!     type Jump = &'static str;
//!     type Finish = Infallible;
//!     type Error = Infallible;
//!
//!     fn finished(&self) -> Option<Infallible> {
//!         None
//!     }
//!
//!     fn jump(&mut self, round: &mut Round<'_, &'static str>) -> Result<(), Infallible> {
//!         if self.clock >= PERIOD {
//!             (self.clock, self.ticks) = (0.0, self.ticks + 1);
//!             round.jumped(0, "tick");
//!         }
//!         Ok(())
//!     }
//!
//!     fn time_to_jump(&self) -> Result<Option<f64>, Infallible> {
//!         Ok(Some(PERIOD - self.clock))
//!     }
//!
//!     fn flow(&mut self, duration: f64) -> Result<(), Infallible> {
//!         self.clock += duration;
//!         Ok(())
//!     }
//! }
//!
//! let (mut metronome, mut trace) = (Metronome { clock: 0.0, ticks: 0 }, Trace::new());
//! let ending = Executor::new(2.25, 1)?.run(&mut metronome, &mut trace)?;
//!
//! assert_eq!(ending.reason, Reason::Horizon);
//! assert_eq!((metronome.clock, metronome.ticks), (0.25, 4));
//! assert_eq!(trace.entries()[3].at.to_string(), "(2 s, 3)");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::convert::Infallible;
use std::fmt;
use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::moment::Moment;
use crate::time::HybridTime;
use crate::trace::{Participants, TraceEntry};
use crate::zeno::{Zeno, ZenoDetector};

/// What the executor runs: components with their states and whatever they share.
pub trait System {
    /// A jump as traces record it.
    type Jump;
    /// How a run can end by itself.
    type Finish;
    /// What can go wrong.
    type Error;

    /// Whether the run is over.
    fn finished(&self) -> Option<Self::Finish>;

    /// Takes one round of the transitions enabled now, each component at most one of its own, in
    /// the order of the [module](self), and tells `round` of each jump as it is taken.
    ///
    /// # Errors
    ///
    /// Whatever keeps the system from going on.
    fn jump(&mut self, round: &mut Round<'_, Self::Jump>) -> Result<(), Self::Error>;

    /// How many seconds the current flow takes until a transition that has to be taken becomes
    /// enabled, or until it would leave an invariant, whichever is first; `None` if it never will.
    /// Asked only when no transition is enabled.
    ///
    /// # Errors
    ///
    /// Whatever keeps the system from going on.
    fn time_to_jump(&self) -> Result<Option<f64>, Self::Error>;

    /// The instant of that jump, where `now` is the present: [`time_to_jump`](Self::time_to_jump)
    /// from now, unless the system knows it better than to the rounding of a duration.
    ///
    /// # Errors
    ///
    /// Whatever keeps the system from going on.
    fn next_jump(&self, now: Moment) -> Result<Option<Moment>, Self::Error> {
        Ok(self.time_to_jump()?.map(|wait| now + Moment::from(wait)))
    }

    /// Lets `duration` > 0 seconds pass, at most [`time_to_jump`](Self::time_to_jump). If it is
    /// exactly that, the transition must be enabled afterwards, whatever rounding does: the flow
    /// lands on the crossed side.
    ///
    /// # Errors
    ///
    /// Whatever keeps the system from going on.
    fn flow(&mut self, duration: f64) -> Result<(), Self::Error>;
}

/// Observes a run of a system.
pub trait Observer<S: System + ?Sized> {
    /// A jump has been taken.
    ///
    /// An observer that does not look at jumps sets [`SEES_JUMPS`](Self::SEES_JUMPS) to false.
    fn jumped(&mut self, _entry: TraceEntry<S::Jump>) {}

    /// Whether it is told of [jumps](Self::jumped). Where it is not, no entries are made.
    const SEES_JUMPS: bool = true;

    /// `duration` seconds are about to pass from `now` on; the system is in the state x⁺ of the
    /// last jump. A break ends the run here.
    fn flows(&mut self, _system: &S, _now: HybridTime, _duration: f64) -> ControlFlow<S::Finish> {
        ControlFlow::Continue(())
    }
}

/// No observer.
impl<S: System + ?Sized> Observer<S> for () {
    const SEES_JUMPS: bool = false;
}

/// A round of jumps while it is under way.
pub struct Round<'a, J> {
    now: HybridTime,
    /// None where no observer looks at jumps.
    report: Option<&'a mut dyn FnMut(TraceEntry<J>)>,
}

impl<J> Round<'_, J> {
    /// The hybrid time of the next jump.
    pub fn now(&self) -> HybridTime {
        self.now
    }

    /// `component` has jumped by itself.
    pub fn jumped(&mut self, component: usize, jump: J) {
        self.record(Participants::One(component), jump);
    }

    /// These components, in ascending order, have jumped together: this is one jump.
    pub fn jumped_some(&mut self, components: Box<[usize]>, jump: J) {
        self.record(Participants::Some(components), jump);
    }

    /// All components have jumped together: this is one jump.
    pub fn jumped_together(&mut self, jump: J) {
        self.record(Participants::All, jump);
    }

    /// The components that `participants` finds have jumped together: this is one jump. It is
    /// asked only where an observer looks at jumps.
    pub(crate) fn jumped_by(&mut self, jump: J, participants: impl FnOnce() -> Participants) {
        let by = if self.report.is_some() { participants() } else { Participants::All };
        self.record(by, jump);
    }

    fn record(&mut self, by: Participants, jump: J) {
        if let Some(report) = &mut self.report {
            report(TraceEntry { at: self.now, by, jump });
        }
        self.now = self.now.after_jump();
    }
}

/// How far a run may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Executor {
    horizon: f64,
    round_limit: u32,
    detects_zeno: bool,
}

/// Jumps closer than this many spacings of the numbers around the present time count as jumps at one
/// instant: what is measured of the time between them is mostly rounding.
const SPACINGS: f64 = 16.0;

/// When and why a run ended. It prints as `(15 s, 3): the horizon is reached`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ending<F> {
    /// The hybrid time reached.
    pub at: HybridTime,
    /// The reason.
    pub reason: Reason<F>,
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Reason<F> {
    /// The system said so.
    Finished(F),
    /// The observer said so.
    Interrupted(F),
    /// The time allowed has passed.
    Horizon,
    /// A timelock: a transition is due, so that time cannot pass, and none can be taken. It also
    /// stands for a time to the next jump that is too short to change t, negative, or NaN.
    Blocked,
    /// More rounds of jumps at one instant than allowed, or at instants only a few spacings of the
    /// numbers apart; of a composition with the last of them.
    JumpLimit(Option<LastJump>),
    /// As for a jump limit, in a composition of which it is known why: the flows of two locations
    /// lead to the boundary between them, so that neither can be followed.
    Sliding(Sliding),
    /// The run is as long or as large as the settings allow.
    Limit(Limit),
    /// Jumps come ever faster and add up at an instant before the horizon.
    Zeno(Zeno),
}

/// The last jump of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LastJump {
    /// The component; of several that jump together the first.
    pub component: usize,
    /// The location to which it leads, as a number.
    pub location: usize,
}

/// Two locations of a component whose flows both lead to the boundary between them. A solution in
/// the sense of Filippov (1988, doi:10.1007/978-94-015-7793-9) would slide along the boundary by a
/// mixture of the two flows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sliding {
    /// The component.
    pub component: usize,
    /// The locations, as numbers.
    pub locations: [usize; 2],
    /// The share of the second location's flow in the mixture that stays on the boundary, between 0
    /// and 1.
    pub share: f64,
}

/// What a run was allowed to use up, and has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
#[non_exhaustive]
pub enum Limit {
    /// Jumps.
    #[error("the run reached its limit of {0} jumps")]
    Jumps(u64),
    /// Pieces of flows and spans of time examined for events.
    #[error("the run reached its limit of {0} steps")]
    Steps(u64),
    /// Memory for the trajectory, in bytes.
    #[error("the trajectory reached its limit of {0} bytes")]
    Memory(u64),
}

impl<F: fmt::Display> fmt::Display for Ending<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.at, self.reason)
    }
}

impl<F: fmt::Display> fmt::Display for Reason<F> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Finished(finish) | Reason::Interrupted(finish) => finish.fmt(formatter),
            Reason::Horizon => formatter.write_str("the horizon is reached"),
            Reason::Blocked => {
                formatter.write_str("neither time can pass nor a transition be taken")
            }
            Reason::JumpLimit(_) => {
                formatter.write_str("there are more rounds of jumps at one instant than allowed")
            }
            Reason::Sliding(_) => {
                formatter.write_str("the flows of two locations lead to the boundary between them")
            }
            Reason::Limit(limit) => limit.fmt(formatter),
            Reason::Zeno(zeno) => write!(formatter, "jumps accumulate at {} s", zeno.accumulation),
        }
    }
}

impl Reason<Infallible> {
    /// The same for a system that can end by itself in ways that this one does not have.
    pub(crate) fn without_finish<F>(self) -> Reason<F> {
        match self {
            Reason::Finished(never) | Reason::Interrupted(never) => match never {},
            Reason::Horizon => Reason::Horizon,
            Reason::Blocked => Reason::Blocked,
            Reason::JumpLimit(last) => Reason::JumpLimit(last),
            Reason::Sliding(sliding) => Reason::Sliding(sliding),
            Reason::Limit(limit) => Reason::Limit(limit),
            Reason::Zeno(zeno) => Reason::Zeno(zeno),
        }
    }
}

/// The limits of an [`Executor`] make no sense.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum InvalidLimit {
    /// The horizon is negative, infinite or NaN.
    #[error("the horizon is {0} s: it must be finite and at least 0")]
    Horizon(f64),
    /// Not a single round is allowed.
    #[error("the limit of rounds at one instant is 0: it must be at least 1")]
    NoRound,
}

impl Executor {
    /// How long a run may take, in seconds.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }

    /// Runs up to `horizon` seconds, finite and ≥ 0, with at most `round_limit` ≥ 1 rounds of jumps
    /// at one instant. A component jumps at most once a round, so that the limit does not depend on
    /// how many components there are.
    ///
    /// # Errors
    ///
    /// [`InvalidLimit`] outside these ranges.
    pub fn new(horizon: f64, round_limit: u32) -> Result<Self, InvalidLimit> {
        if !(horizon.is_finite() && horizon >= 0.0) {
            return Err(InvalidLimit::Horizon(horizon));
        }
        if round_limit == 0 {
            return Err(InvalidLimit::NoRound);
        }
        Ok(Executor { horizon, round_limit, detects_zeno: true })
    }

    /// The same, without looking at whether jumps accumulate: for systems that do so themselves.
    #[must_use]
    pub fn without_zeno_detection(self) -> Self {
        Executor { detects_zeno: false, ..self }
    }

    /// Runs `system` from hybrid time (0, 0) to its end, by the semantics of the [module](self).
    ///
    /// # Errors
    ///
    /// The first error of the system.
    pub fn run<S: System>(
        &self,
        system: &mut S,
        observer: &mut impl Observer<S>,
    ) -> Result<Ending<S::Finish>, S::Error> {
        let mut now = HybridTime::START;
        // t is the number nearest to this; summing durations loses nothing.
        let mut clock = Moment::default();
        let mut rounds = 0;
        let mut has_jumped = false;
        let mut zeno = ZenoDetector::new(self.horizon);
        let reason = loop {
            if let Some(finish) = system.finished() {
                break Reason::Finished(finish);
            }
            let before = now;
            now = take_round(system, observer, now)?;
            if now > before {
                has_jumped = true;
                rounds += 1;
                if rounds > self.round_limit {
                    break Reason::JumpLimit(None);
                }
                continue;
            }
            let due = system.next_jump(clock)?.unwrap_or(Moment::from(f64::INFINITY));
            // Jumps whose instant is nearest to the horizon are taken.
            let next = if due.seconds() > self.horizon { Moment::from(self.horizon) } else { due };
            let duration = (next - clock).seconds();
            let t = next.seconds();
            // Too short a time to change t may pass between jumps, but not twice in a row.
            let passes = t > now.t || duration > 0.0 && t == now.t && has_jumped;
            if now.t >= self.horizon && (due.seconds() > self.horizon || !passes) {
                break Reason::Horizon;
            }
            if !passes {
                break Reason::Blocked;
            }
            if let ControlFlow::Break(finish) = observer.flows(system, now, duration) {
                break Reason::Interrupted(finish);
            }
            system.flow(duration)?;
            has_jumped = false;
            if t - now.t > SPACINGS * f64::EPSILON * t {
                rounds = 0;
            }
            (clock, now) = (next, HybridTime { t, ..now });
            if let Some(zeno) = zeno.after_flow(now.t, duration).filter(|_| self.detects_zeno) {
                break Reason::Zeno(zeno);
            }
        };
        Ok(Ending { at: now, reason })
    }
}

/// Returns the hybrid time after the jumps of the round.
fn take_round<S: System, O: Observer<S>>(
    system: &mut S,
    observer: &mut O,
    now: HybridTime,
) -> Result<HybridTime, S::Error> {
    let report: &mut dyn FnMut(TraceEntry<S::Jump>) = &mut |entry| observer.jumped(entry);
    let mut round = Round { now, report: O::SEES_JUMPS.then_some(report) };
    system.jump(&mut round)?;
    Ok(round.now)
}
