//! The automaton of an access point's control period: rounds of beacons.

use std::sync::Arc;

use pleach_discrete::network::{ROUNDS, Round, RoundEvent};
use pleach_guards::Guard;

use crate::located::{Current, DataOf, Holds};
use crate::network::guards::control as guards;
use crate::{Automaton, BuildError, Flow, Transfer};

use super::AccessPoint;
use crate::network::act::{Act, acting};
use crate::network::member::NodeOutputs;
use crate::network::robot::RobotError;
use crate::network::service::{Listening, Resting, Rounds};

/// The automaton of an access point's control period.
pub type RoundAutomaton = Automaton<Round, RoundEvent, AccessPoint>;

/// A part of the work of a control period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RoundAct {
    /// τ := 0.
    RestartClock,
    /// It notices who is missing, and the first access point calls the roll.
    CallRoll,
    /// It processes the messages received, and serves the user.
    Deliberate,
    /// The first access point sends the user the newest notice.
    TellUser,
    /// It tells its public state, unless it has told it often enough.
    TellBeacon,
    /// After the first rounds, the nodes of which it has heard nothing are out of range.
    Forget,
}

/// What an access point does when it takes a row, in this order.
pub type RoundActs = &'static [RoundAct];

impl Act for RoundAct {
    fn name(self) -> &'static str {
        match self {
            RoundAct::RestartClock => "τ := 0",
            RoundAct::CallRoll => "call the roll",
            RoundAct::Deliberate => "deliberate, serve",
            RoundAct::TellUser => "tell the user",
            RoundAct::TellBeacon => "tell beacon",
            RoundAct::Forget => "forget silent nodes",
        }
    }
}

impl Holds<Rounds> for AccessPoint {
    type Effects = RoundActs;

    fn current(&self) -> &Current<Rounds> {
        self.schedule.current()
    }

    fn current_mut(&mut self) -> &mut Current<Rounds> {
        self.schedule.current_mut()
    }

    fn carry_out(&mut self, acts: RoundActs) {
        self.schedule.carry_out(acts);
    }
}

impl AccessPoint {
    /// The clock is due: the access point takes the next row of its control period.
    pub(super) fn tick(&mut self, outputs: &mut NodeOutputs) -> Result<(), RobotError> {
        let site = Arc::clone(&self.site);
        site.automata.rounds.step_in_place::<Rounds>(self)?;
        for act in self.schedule.take_acts() {
            match act {
                RoundAct::RestartClock => {
                    self.schedule.begin_period();
                    self.outbox.send_beacon_again();
                    self.neighbours.expect_all();
                }
                RoundAct::CallRoll => self.call_roll()?,
                RoundAct::Forget => self.forget_silent(),
                RoundAct::Deliberate => {
                    let known = self.notices.bulletin().id();
                    self.process_news()?;
                    self.serve()?;
                    if self.notices.bulletin().id() != known {
                        self.tell_user(outputs);
                    }
                }
                RoundAct::TellUser => self.tell_user(outputs),
                RoundAct::TellBeacon => self.tell_beacon(outputs),
            }
        }
        self.schedule.end_round();
        Ok(())
    }
}

fn row<A: DataOf<Rounds>, B: DataOf<Rounds>>(
    event: RoundEvent,
    guard: Guard,
    acts: RoundActs,
    next: fn(&A) -> B,
) -> Transfer<Round, RoundEvent, AccessPoint> {
    acting(event, guard, acts, next)
}

/// The automaton of an access point's control period.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn round_automaton() -> Result<RoundAutomaton, BuildError> {
    use RoundAct::{CallRoll, Deliberate, Forget, RestartClock, TellBeacon, TellUser};
    let wait = |point: &mut AccessPoint, duration: f64| point.schedule.pass(duration);
    Automaton::builder(ROUNDS, Round::Resting)
        .observing()
        .flow(Round::Resting, Flow::exact("τ̇ = 1", wait))
        .invariant(Round::Resting, guards::waiting())
        .carried_out(row(
            RoundEvent::SampleDue,
            guards::sample_due(),
            &[RestartClock, CallRoll, TellUser, TellBeacon],
            |_: &Resting| Listening { round: 1 },
        ))
        .carried_out(row(
            RoundEvent::NextRound,
            guards::next_round(),
            &[Forget, Deliberate, TellBeacon],
            |listening: &Listening| Listening { round: listening.round + 1 },
        ))
        .carried_out(row(
            RoundEvent::RoundsOver,
            guards::rounds_over(),
            &[Forget, Deliberate],
            |_: &Listening| Resting,
        ))
        .build()
}
