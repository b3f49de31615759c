//! The mission automaton: what each step of the mission carries over, and when (Algorithms 1, 3
//! and 5).
//!
//! Resets are functions from the data of one phase to that of the next. They read the robot as it
//! was before the jump, with the duty that it has taken in the same jump, and change nothing; any
//! other effect of a step is a [`MissionEffect`]. The steps themselves are in the chapters on the
//! election of a leader (`leader`) and of a recruit (`recruit`), on the path Σ and its subgroups
//! (`path`), and on the primary team (`team`).

use std::sync::Arc;

use pleach_discrete::network::{Agreement, Election, MISSION, MissionStep, NoticeId, Phase};
use pleach_guards::Guard;

use crate::located::{Current, DataOf, Holds, Place as _};
use crate::network::guards::mission as guards;
use crate::{Automaton, BuildError, Transfer, TransitionError};

use super::duties::Label;
use super::{Robot, leader, path, recruit, team};
use crate::network::beacon::{Announced, CallRoute, Notice};
use crate::network::duty::Duty;
use crate::network::mission::{
    Advance, Ended, Idle, LeaderElection, Mission, PathAgreement, RecruitElection, Shift,
};
use crate::network::record::MissionEvent;

/// The automaton of the mission as one robot sees it.
pub type MissionAutomaton = Automaton<Phase, MissionStep, Robot>;

/// The effects of a step of the mission other than another phase.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum MissionEffect {
    /// The robot reports to observers.
    Report(MissionEvent),
    /// It issues the next notice.
    Issue(Notice),
    /// It goes by this announcement.
    Learn(Announced),
    /// The leader is of the tree of this access point when it is elected.
    LedFrom(Option<usize>),
    /// It has reached the task of the announcement that it goes by.
    Accomplish,
    /// It has forgotten what became of the election by the announcement that it goes by.
    Forgotten,
    /// It takes part in this election, from the way to the caller that it knows.
    Elect(Election, Option<CallRoute>),
    /// It forgets the way to the caller.
    ForgetRoute,
    /// It takes part in this agreement about Σ.
    Agree(Option<Agreement>),
    /// It goes by the announcement that the newest notice follows from.
    KeepUp,
    /// Its stillness is counted from 0.
    Restart,
    /// From now on links of the tree may be as long as they ever are.
    Stretch,
    /// It does not make the move that it has set off on: that would lead it nowhere.
    Stay,
}

pub(super) type Effects = Vec<MissionEffect>;

impl Holds<Mission> for Robot {
    type Effects = Effects;

    fn current(&self) -> &Current<Mission> {
        self.mission.current()
    }

    fn current_mut(&mut self) -> &mut Current<Mission> {
        self.mission.current_mut()
    }

    fn carry_out(&mut self, effects: Effects) {
        for effect in effects {
            match effect {
                MissionEffect::Report(event) => self.report(event),
                MissionEffect::Issue(notice) => self.mission.notices_mut().issue(self.id, notice),
                MissionEffect::Learn(announced) => {
                    let task = announced.1.position;
                    let target = self.site.place_to_service(task, self.body.position());
                    self.mission.learn(announced, target);
                }
                MissionEffect::LedFrom(root) => self.mission.is_led_from(root),
                MissionEffect::Accomplish => self.mission.accomplish(),
                MissionEffect::Forgotten => self.mission.notices_mut().forget_election(self.id),
                MissionEffect::Elect(election, route) => {
                    self.ballot.begin(election, route);
                    self.answer_election();
                }
                MissionEffect::ForgetRoute => self.ballot.set_route(None),
                MissionEffect::Agree(agreement) => self.ballot.agree(agreement),
                MissionEffect::KeepUp => self.mission.keep_up(),
                MissionEffect::Restart => self.body.count_still_periods_anew(),
                MissionEffect::Stretch => self.mission.notices_mut().stretch(),
                MissionEffect::Stay => self.stay(),
            }
        }
    }
}

impl Robot {
    /// Takes at most one step of the mission, together with the duty automaton if that has a
    /// transition for it; returns whether it did.
    pub(super) fn jump_mission(&mut self) -> Result<bool, TransitionError> {
        let site = Arc::clone(&self.site);
        let mut phase = self.phase();
        let Some(step) = site.automata.mission.enabled(phase, self)? else { return Ok(false) };
        self.jump_duty(Label::Mission(step.jump().event))?;
        step.fire(&mut phase, self)?;
        Ok(true)
    }

    /// The phase of the mission as the robot knows it.
    pub(super) fn phase(&self) -> Phase {
        self.mission.location()
    }

    /// Merges what it knows of the mission with the beacons of its neighbours.
    pub(super) fn hear_notices(&mut self) {
        let longest_wait = self.longest_wait();
        let notices = self.mission.notices_mut();
        notices.wait_for(longest_wait);
        for neighbour in self.neighbours.iter() {
            notices.merge(&neighbour.beacon, &self.site);
            notices.merge_bulletin(&neighbour.beacon.bulletin);
            self.ballot.merge(&neighbour.beacon);
        }
        self.answer_election();
        if self.phase() == Phase::Shift {
            self.report_arrival();
            self.yield_post();
        }
        self.review_team();
    }

    /// Places its token in the election that it takes part in, if it can by now.
    fn answer_election(&mut self) {
        match self.phase() {
            Phase::LeaderElection => self.answer_announcement(),
            Phase::RecruitElection => self.answer_call(),
            _ => {}
        }
    }

    /// The identity of the next notice on the mission if this robot issues it.
    pub(super) fn next_notice_id(&self) -> NoticeId {
        self.notice_id().next(self.id)
    }
}

type Row = Transfer<Phase, MissionStep, Robot>;

/// The mission ends.
pub(super) fn end<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Ended {
    effects.push(MissionEffect::ForgetRoute);
    let is_on_its_way = matches!(*robot.duty, Duty::Shifting(_));
    Ended { walk: robot.mission.walk().filter(|_| is_on_its_way) }
}

fn keep_up<A>(_: &A, _: &Robot, effects: &mut Effects) -> Idle {
    effects.extend([MissionEffect::KeepUp, MissionEffect::ForgetRoute]);
    Idle
}

fn called<A: DataOf<Mission>>(guard: Guard) -> Row {
    Transfer::new(MissionStep::Called, guard, "answer the call", recruit::answer::<A>)
}

fn path_heard<A: DataOf<Mission>>() -> Row {
    let (guard, name) = (guards::path_heard(), "vote on break points");
    Transfer::where_known(MissionStep::PathHeard, guard, name, path::vote::<A>)
}

fn resumed<A: DataOf<Mission>>() -> Row {
    Transfer::new(MissionStep::Resumed, guards::resumed(), "go on", path::resume::<A>)
}

/// The mission automaton (Algorithms 1 to 5).
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn mission_automaton() -> Result<MissionAutomaton, BuildError> {
    use MissionStep as Step;
    // A notice has one content; an election has a winner or not; at most one subgroup is moving.
    let notices = [
        "announced",
        "called",
        "path_announced",
        "resumed",
        "service_announced",
        "service_unheard",
        "end_announced",
        "overtaken",
        "announcement_heard",
    ];
    let bid = "place a bid for the task";
    Automaton::builder(MISSION, Phase::Idle)
        .observing()
        .at_most_one(&notices)
        .at_most_one(&["won", "unaided"])
        .at_most_one(&["subgroup_arrived", "relieved"])
        .carried_out(Transfer::from_any(
            Phase::OPEN,
            Step::Ended,
            guards::ended(),
            "stop",
            end::<Mission>,
        ))
        .carried_out(Transfer::from_any_where_known(
            Phase::OPEN,
            Step::Announced,
            guards::announced(),
            bid,
            leader::begin_election::<Mission>,
        ))
        .carried_out(Transfer::where_known(
            Step::Announced,
            guards::announced(),
            bid,
            leader::begin_election::<Ended>,
        ))
        .carried_out(Transfer::from_any(
            Phase::PURSUING,
            Step::Overtaken,
            guards::overtaken(),
            "wait",
            keep_up::<Mission>,
        ))
        .carried_out(Transfer::new(Step::Overtaken, guards::overtaken(), "wait", keep_up::<Ended>))
        .carried_out(Transfer::from_any(
            Phase::PURSUING,
            Step::Serviced,
            guards::serviced(),
            "wait",
            team::wait::<Mission>,
        ))
        .carried_out(Transfer::where_known(
            Step::Repeated,
            guards::repeated(),
            "announce the service again",
            team::announce_service_again,
        ))
        .carried_out(Transfer::staying_in(
            Phase::OPEN,
            Step::Informed,
            guards::informed(),
            "go by the announcement",
            leader::learn::<Mission>,
        ))
        .carried_out(called::<Idle>(guards::called()))
        .carried_out(called::<LeaderElection>(guards::called()))
        .carried_out(called::<Advance>(guards::called()))
        .carried_out(called::<RecruitElection>(guards::called_again()))
        .carried_out(called::<PathAgreement>(guards::called_again()))
        .carried_out(called::<Shift>(guards::called_again()))
        .carried_out(resumed::<Idle>())
        .carried_out(resumed::<LeaderElection>())
        .carried_out(resumed::<RecruitElection>())
        .carried_out(resumed::<PathAgreement>())
        .carried_out(resumed::<Shift>())
        .carried_out(Transfer::new(
            Step::Elected,
            guards::elected(),
            "the winner leads",
            leader::conclude,
        ))
        .carried_out(Transfer::new(
            Step::Bound,
            guards::bound(),
            "call for a recruit",
            recruit::call,
        ))
        .carried_out(Transfer::new(Step::Unbound, guards::unbound(), "lead on", leader::lead_on))
        .carried_out(Transfer::new(
            Step::Trapped,
            guards::trapped(),
            "call for a recruit",
            recruit::call,
        ))
        .carried_out(Transfer::new(
            Step::Foreseen,
            guards::foreseen(),
            "call for a recruit, and go on",
            recruit::call_ahead,
        ))
        .carried_out(Transfer::new(
            Step::Blocked,
            guards::blocked(),
            "report why",
            team::give_up::<Advance>,
        ))
        .carried_out(Transfer::new(
            Step::Blocked,
            guards::blocked(),
            "report why",
            team::give_up::<Shift>,
        ))
        .carried_out(Transfer::where_known(
            Step::Recruited,
            guards::recruited(),
            "announce Σ",
            recruit::announce_path,
        ))
        .carried_out(Transfer::new(
            Step::Unaided,
            guards::unaided(),
            "ask other trees, or report why",
            recruit::end_unaided,
        ))
        .carried_out(path_heard::<Idle>())
        .carried_out(path_heard::<LeaderElection>())
        .carried_out(path_heard::<Advance>())
        .carried_out(path_heard::<RecruitElection>())
        .carried_out(Transfer::where_known(
            Step::PointsAgreed,
            guards::points_agreed(),
            "form the subgroups",
            path::form_subgroups,
        ))
        .carried_out(Transfer::new(
            Step::SubgroupArrived,
            guards::subgroup_arrived(),
            "the next subgroup is active",
            path::next_subgroup,
        ))
        .carried_out(Transfer::new(
            Step::Relieved,
            guards::relieved(),
            "announce that the team advances",
            path::announce_advance,
        ))
        .carried_out(Transfer::where_known(
            Step::Reached,
            guards::reached(),
            "announce the service",
            team::announce_service,
        ))
        .build()
}
