//! The automaton of the control period: what a robot does at each tick of its clock (Algorithm 5).
//!
//! Each row of [`CONTROL`] carries a list of [`Act`]s. They are what the robot does when it takes
//! the row, in their order; drawings show them as its reset.

use std::sync::Arc;

use pleach_discrete::network::{CONTROL, Stage, StageEvent};
use pleach_guards::Guard;

use crate::located::{Current, DataOf, Holds};
use crate::network::guards::control as guards;
use crate::{Automaton, BuildError, Flow, Transfer};

use super::context::context;
use super::{Robot, RobotError};
use crate::network::act::{self, acting};
use crate::network::control::{
    Beacons, Control, Iterations, Moving, Negotiation, OldFlows, Reserving, Sweeps,
};
use crate::network::member::NodeOutputs;

/// The automaton of the control period.
pub type ControlAutomaton = Automaton<Stage, StageEvent, Robot>;

macro_rules! acts {
    ($($(#[$note:meta])+ $act:ident = $name:literal,)+) => {
        /// A part of the work of a control period.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Act {
            $($(#[$note])+ $act),+
        }

        impl act::Act for Act {
            fn name(self) -> &'static str {
                match self {
                    $(Act::$act => $name),+
                }
            }
        }
    };
}

acts! {
    /// τ := 0 and u := 0.
    RestartClock = "τ := 0, u := 0",
    /// It takes the transitions of its duty and of the mission that are enabled (line 9).
    Jump = "jump",
    /// What it considers once a period: whether its post is needed, and robots in its way.
    Consider = "consider post and partner",
    /// It puts together what it has heard.
    Deliberate = "deliberate",
    /// It tells its public state, unless it has told it often enough.
    TellBeacon = "tell beacon",
    /// The links over which it can route.
    SurveyLinks = "survey links",
    /// It tells its flows to those who receive them.
    TellFlows = "tell flows",
    /// Routes begin where those of the period before ended.
    BeginRoutes = "begin routes",
    /// It tells its multiplier, if that has changed in this period.
    TellMultiplier = "tell λ",
    /// F_ij from the multipliers, if one has changed (line 2).
    StepPrimal = "primal step",
    /// λ_i from the flows (line 2).
    StepDual = "dual step",
    /// n := 0: rounds are counted anew.
    CountRounds = "n := 0",
    /// It begins a sweep: what is not carried goes to the parent in the tree.
    BeginSweep = "begin sweep",
    /// It takes what its children have told into its flow to the parent.
    EndSweep = "end sweep",
    /// c_i of the flows as they are now.
    SettleResidual = "settle c",
    /// It reports a shortage if it cannot pass on what it is sent.
    AdmitShortage = "admit shortage",
    /// Overloaded robots are relieved of what does not come over the tree, and a sweep begins.
    SweepAgain = "relieve, begin sweep",
    /// It asks the receivers of its flows for what it plans to send.
    AskForFlows = "ask for flows",
    /// It changes its flows as they are granted, grants others what it can forward, and asks again
    /// where it has had no answer.
    SettleFlows = "settle flows",
    /// The flows in use are those of this period.
    EndRoutes = "end routes",
    /// u := QP(ψ, cell): target, geodesic and motion problem (lines 4 to 7).
    Propose = "u := QP(ψ, cell)",
    /// It tells the move that it intends.
    TellProposal = "tell proposal",
    /// It consents to the moves that it has heard of, or objects.
    JudgeMoves = "judge moves",
    /// Without the consent of all that rely on it, it does not move.
    StayWithoutConsent = "u := 0 without consent",
    /// The certified move begins (line 8).
    SetOff = "set off",
}

/// The acts of the row that was taken last.
pub type Acts = &'static [Act];

impl Holds<Control> for Robot {
    type Effects = Acts;

    fn current(&self) -> &Current<Control> {
        self.schedule.control()
    }

    fn current_mut(&mut self) -> &mut Current<Control> {
        self.schedule.control_mut()
    }

    fn carry_out(&mut self, acts: Acts) {
        self.schedule.carry_out(acts);
    }
}

impl Robot {
    /// The clock calls, after `passed` rounds without a tick: the robot takes the next row of its
    /// control period.
    #[inline(never)]
    pub(super) fn tick(
        &mut self,
        passed: usize,
        outputs: &mut NodeOutputs,
    ) -> Result<(), RobotError> {
        self.schedule.pass_rounds(passed + 1);
        let site = Arc::clone(&self.site);
        site.automata.control.step_in_place::<Control>(self)?;
        for act in self.schedule.take_acts() {
            self.perform(*act, outputs)?;
        }
        self.tell_observers(outputs);
        Ok(())
    }

    fn perform(&mut self, act: Act, outputs: &mut NodeOutputs) -> Result<(), RobotError> {
        match act {
            Act::RestartClock => self.restart_clock(),
            Act::Jump => self.jump()?,
            Act::Consider => self.begin_period()?,
            Act::Deliberate => {
                self.end_round();
                self.deliberate()?;
            }
            Act::TellBeacon => self.tell_beacon(outputs),
            Act::SurveyLinks => {
                if self.schedule.take_new() {
                    self.look_around();
                }
                self.survey_links();
            }
            Act::TellFlows => self.routing.send_flows(context!(self), outputs),
            Act::BeginRoutes => self.routing.begin(context!(self)),
            Act::TellMultiplier => self.routing.send_report(outputs),
            Act::StepPrimal => self.routing.primal_step(context!(self)),
            Act::StepDual => self.routing.dual_step(context!(self)),
            Act::CountRounds => self.schedule.count_rounds_anew(),
            Act::BeginSweep => self.routing.begin_sweep(context!(self), outputs),
            Act::EndSweep => self.routing.end_sweep(context!(self)),
            Act::SettleResidual => self.routing.settle_residual(context!(self)),
            Act::AdmitShortage => self.routing.admit_shortage(context!(self), outputs),
            Act::SweepAgain => self.routing.sweep_again(context!(self), outputs),
            Act::AskForFlows => self.ask_for_flows(outputs),
            Act::SettleFlows => self.take_in_requests(outputs),
            Act::EndRoutes => self.end_routes(),
            Act::Propose => self.propose()?,
            Act::TellProposal => self.tell_proposal(outputs),
            Act::JudgeMoves => self.judge_moves(outputs),
            Act::StayWithoutConsent => self.stay_without_consent(),
            Act::SetOff => self.set_off(),
        }
        Ok(())
    }
}

fn row<A: DataOf<Control>, B: DataOf<Control>>(
    event: StageEvent,
    guard: Guard,
    acts: Acts,
    next: fn(&A) -> B,
) -> Transfer<Stage, StageEvent, Robot> {
    acting(event, guard, acts, next)
}

/// The automaton of the control period (Algorithm 5).
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn control_automaton() -> Result<ControlAutomaton, BuildError> {
    use Act::*;
    use StageEvent as On;
    Automaton::builder(CONTROL, Stage::Moving)
        .observing()
        .flow(Stage::Moving, Flow::exact("ẋ = u, τ̇ = 1", Robot::advance))
        .invariant(Stage::Moving, guards::moving())
        .at_most_one(&["hears_demands", "hears_flows", "hears_shortages"])
        .carried_out(row(
            On::SampleDue,
            guards::sample_due(),
            &[RestartClock, CountRounds, Jump, Consider, TellBeacon],
            |_: &Moving| Beacons,
        ))
        .carried_out(row(
            On::NextRound,
            guards::next_round(),
            &[Deliberate, Jump, TellBeacon],
            |_: &Beacons| Beacons,
        ))
        .carried_out(row(
            On::RoutesDue,
            guards::routes_due(),
            &[Deliberate, Jump, SurveyLinks, TellMultiplier, CountRounds],
            |_: &Beacons| Iterations,
        ))
        .carried_out(row(
            On::OldFlowsDue,
            guards::old_flows_due(),
            &[Deliberate, Jump, SurveyLinks, TellFlows],
            |_: &Beacons| OldFlows,
        ))
        .carried_out(row(
            On::OldFlowsHeard,
            guards::heard(),
            &[BeginRoutes, TellMultiplier, CountRounds],
            |_: &OldFlows| Iterations,
        ))
        .carried_out(row(
            On::MultipliersHeard,
            guards::multipliers_heard(),
            &[StepPrimal, TellFlows],
            |_: &Iterations| Iterations,
        ))
        .carried_out(row(
            On::NextIteration,
            guards::next_iteration(),
            &[StepDual, TellMultiplier],
            |_: &Iterations| Iterations,
        ))
        .carried_out(row(
            On::SweepDue,
            guards::sweep_due(),
            &[StepDual, BeginSweep, CountRounds],
            |_: &Iterations| Sweeps,
        ))
        .carried_out(row(
            On::DemandsHeard,
            guards::demands_heard(),
            &[EndSweep, TellFlows],
            |_: &Sweeps| Sweeps,
        ))
        .carried_out(row(
            On::SweepOver,
            guards::sweep_over(),
            &[SettleResidual, AdmitShortage],
            |_: &Sweeps| Sweeps,
        ))
        .carried_out(row(
            On::SweepsOver,
            guards::sweeps_over(),
            &[SettleResidual, AskForFlows, CountRounds],
            |_: &Sweeps| Reserving,
        ))
        .carried_out(row(
            On::ShortagesHeard,
            guards::shortages_heard(),
            &[TellFlows],
            |_: &Sweeps| Sweeps,
        ))
        .carried_out(row(On::ReliefsHeard, guards::reliefs_heard(), &[SweepAgain], |_: &Sweeps| {
            Sweeps
        }))
        .carried_out(row(
            On::GrantsHeard,
            guards::grants_heard(),
            &[SettleFlows],
            |_: &Reserving| Reserving,
        ))
        .carried_out(row(
            On::RoutesDone,
            guards::routes_done(),
            &[EndRoutes, Propose, TellProposal, CountRounds],
            |_: &Reserving| Negotiation,
        ))
        .carried_out(row(
            On::ProposalsHeard,
            guards::proposals_heard(),
            &[JudgeMoves],
            |_: &Negotiation| Negotiation,
        ))
        .carried_out(row(
            On::NextAttempt,
            guards::next_attempt(),
            &[TellProposal],
            |_: &Negotiation| Negotiation,
        ))
        .carried_out(row(
            On::MoveCertified,
            guards::move_certified(),
            &[StayWithoutConsent, SetOff, Jump],
            |_: &Negotiation| Moving,
        ))
        .build()
}
