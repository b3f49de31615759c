//! The user: a person with a list of tasks, at the first access point.
//!
//! Tasks may have times: control periods, counted from the user's first one, in which it begins to ask for
//! them and in which it takes them back.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::Location as _;
use pleach_discrete::network::{NodeId, REQUESTS, Request, RequestEvent};
use pleach_guards::Guard;

use super::act::{Act, acting};
use super::beacon::{Bulletin, Notice};
use super::member::{NodeOutputs, Sense};
use super::message::Message;
use super::order::Order;
use super::record::{End, MissionEvent, Outcome};
use super::robot::{RobotError, RobotFault};
use super::scenario::Task;
use super::service::{Asked, Asking, Deserted, Informed, Preparing, Waiting};
use super::shared::Shared;
use super::site::Site;
use crate::located::{Current, DataOf, Holds, Place as _};
use crate::network::guards::{control, service as guards};
use crate::node::{Input, Node};
use crate::{Automaton, BuildError, Flow, Transfer};

/// A user sends its tasks to the first access point and receives notices from it.
///
/// The network is given one control period to connect. From then on the user tells in every period all that
/// it has asked for so far, until the mission ends: messages may be lost, and an access point that restarts
/// has forgotten it. If the access point stops for good, the mission ends for the user.
#[derive(Clone, Debug)]
pub struct User {
    site: Arc<Site>,
    request: Current<Asked>,
    /// The remaining acts of the row that was taken last.
    acts: UserActs,
    tasks: Arc<[Task]>,
    /// Control periods that are over.
    passed: u32,
    news: Bulletin,
    clock: f64,
    /// Control periods that are over since the first access point was heard.
    silence: u32,
}

/// Control periods after which the first access point counts as stopped, beside those for which robots may
/// still move.
const PATIENCE: u32 = 100;

/// What a user does when it takes a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub(super) enum UserAct {
    /// τ := 0.
    RestartClock,
    /// Another control period is over.
    CountPeriod,
    /// Another control period without news.
    CountSilence,
    /// It sends all that it has asked for so far to the first access point.
    Ask,
}

/// What a user does when it takes a row, in this order.
pub(super) type UserActs = &'static [UserAct];

/// The automaton of a user.
pub(super) type RequestAutomaton = Automaton<Request, RequestEvent, User>;

crate::observed! {
    impl Observed for User as user;
    quantities {
        /// τ: seconds since the last sample.
        clock: user.clock,
        /// Δt: seconds from sample to sample.
        period: user.site.settings.period,
        /// Control periods that are over since the first access point was heard.
        silence: f64::from(user.silence),
        /// Control periods after which it counts as stopped: no robot moves any more.
        patience: f64::from(user.patience()),
    }
    propositions {
        /// The first access point has answered its request.
        hears_answer: user.news.number() > 0,
        /// The newest notice says that the mission has ended.
        hears_end: matches!(user.notice(), Notice::Ended { .. }),
    }
}

impl Holds<Asked> for User {
    type Effects = UserActs;

    fn current(&self) -> &Current<Asked> {
        &self.request
    }

    fn current_mut(&mut self) -> &mut Current<Asked> {
        &mut self.request
    }

    fn carry_out(&mut self, acts: UserActs) {
        self.acts = acts;
    }
}

impl Act for UserAct {
    fn name(self) -> &'static str {
        match self {
            UserAct::RestartClock => "τ := 0",
            UserAct::CountPeriod => "count the period",
            UserAct::CountSilence => "count the silence",
            UserAct::Ask => "ask for the tasks",
        }
    }
}

fn row<A: DataOf<Asked>, B: DataOf<Asked>>(
    event: RequestEvent,
    guard: Guard,
    acts: UserActs,
    next: fn(&A) -> B,
) -> Transfer<Request, RequestEvent, User> {
    acting(event, guard, acts, next)
}

/// The automaton of a user.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(super) fn request_automaton() -> Result<RequestAutomaton, BuildError> {
    use RequestEvent as On;
    use UserAct::{Ask, CountPeriod, CountSilence, RestartClock};
    use guards::{access_point_missed, another_period, answer_heard, prepared, request_over};
    const ANOTHER_PERIOD: UserActs = &[RestartClock, CountPeriod, CountSilence, Ask];
    const INFORMED: UserActs = &[RestartClock, CountPeriod];
    let builder = Automaton::builder(REQUESTS, Request::Preparing).observing();
    let builder = Request::ALL.iter().fold(builder, |builder, &location| {
        let flow = Flow::exact("τ̇ = 1", |user: &mut User, duration| user.clock += duration);
        builder.flow(location, flow).invariant(location, control::waiting())
    });
    builder
        .carried_out(row(On::Prepared, prepared(), &[RestartClock], |_: &Preparing| Asking))
        .carried_out(row(On::AnswerHeard, answer_heard(), &[], |_: &Preparing| Waiting))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Preparing| Informed))
        .carried_out(row(On::PeriodOver, another_period(), ANOTHER_PERIOD, |_: &Asking| Asking))
        .carried_out(row(On::AnswerHeard, answer_heard(), &[], |_: &Asking| Waiting))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Asking| Informed))
        .carried_out(row(On::Missed, access_point_missed(), &[], |_: &Asking| Deserted))
        .carried_out(row(On::PeriodOver, another_period(), ANOTHER_PERIOD, |_: &Waiting| Waiting))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Waiting| Informed))
        .carried_out(row(On::Missed, access_point_missed(), &[], |_: &Waiting| Deserted))
        .carried_out(row(On::PeriodOver, another_period(), INFORMED, |_: &Informed| Informed))
        .carried_out(row(On::AnswerHeard, answer_heard(), &[], |_: &Informed| Waiting))
        .carried_out(row(On::PeriodOver, another_period(), &[RestartClock], |_: &Deserted| {
            Deserted
        }))
        .build()
}

impl User {
    /// A user who wants nothing yet.
    pub fn new(site: Arc<Site>) -> Self {
        User {
            request: Current::new(Asked::Preparing(Preparing)),
            acts: &[],
            tasks: Arc::from([]),
            passed: 0,
            news: Bulletin::first(Shared::new(Notice::Quiet)),
            clock: site.settings.period,
            silence: 0,
            site,
        }
    }

    /// The access point that the user sends its requests to.
    fn first_access_point(&self) -> NodeId {
        self.site.robots
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.news.notice()
    }

    /// How the mission has ended, once it has heard so or misses the first access point.
    pub fn known_end(&self) -> Option<End> {
        match (&*self.request, self.notice()) {
            (Asked::Deserted(_), _) => Some(self.end_without_access_point()),
            (_, Notice::Ended { outcome, reason, task }) => {
                Some(End::new(*outcome, reason.to_string(), *task))
            }
            _ => None,
        }
    }

    fn end_without_access_point(&self) -> End {
        let reason = format!(
            "access point 0 has not been heard of for {} control periods: without it no task is \
             announced and no robot moves",
            self.patience()
        );
        End::new(Outcome::Blocked, reason, None)
    }

    fn patience(&self) -> u32 {
        PATIENCE + self.site.roll_validity()
    }

    fn hear(&mut self, message: &Message, outputs: &mut NodeOutputs) -> Result<(), RobotError> {
        match message {
            Message::News(news) => {
                self.news.merge(news);
                self.silence = 0;
                self.jump(outputs)
            }
            Message::Beacon { .. }
            | Message::Multiplier { .. }
            | Message::Flow(_)
            | Message::Demand(_)
            | Message::Shortage
            | Message::AskFlow(_)
            | Message::GrantFlow(_)
            | Message::Probe(_)
            | Message::Proposal { .. }
            | Message::Objection { .. }
            | Message::Consent { .. }
            | Message::Request(_) => Ok(()),
        }
    }

    /// Takes a row, if one is enabled.
    fn jump(&mut self, outputs: &mut NodeOutputs) -> Result<(), RobotError> {
        let site = Arc::clone(&self.site);
        site.automata.request.step_in_place::<Asked>(self)?;
        for act in std::mem::take(&mut self.acts) {
            match act {
                UserAct::RestartClock => self.clock = 0.0,
                UserAct::CountPeriod => self.passed = self.passed.saturating_add(1),
                UserAct::CountSilence => self.silence = self.silence.saturating_add(1),
                UserAct::Ask => {
                    let order = Order::by(self.passed, &self.tasks);
                    outputs.send(self.first_access_point(), Message::Request(order));
                }
            }
        }
        Ok(())
    }
}

impl Node for User {
    type Message = Message;
    type Sense = Sense;
    type Report = MissionEvent;
    type Body = Point;
    type Error = RobotError;

    fn step(
        &mut self,
        input: Input<'_, Message, Sense>,
        outputs: &mut NodeOutputs,
    ) -> Result<(), RobotError> {
        match input {
            Input::Sensed(Sense::Tasks(tasks)) => self.tasks = tasks,
            Input::Heard { message, .. } => self.hear(message, outputs)?,
            Input::Tick { .. } => self.jump(outputs)?,
            Input::Sensed(Sense::Position(_) | Sense::Fix(_) | Sense::Bodies(_)) => {}
        }
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some((self.site.settings.period - self.clock).max(0.0))
    }

    fn flow(&mut self, duration: f64) {
        let site = Arc::clone(&self.site);
        site.automata.request.flow_in_place::<Asked>(self, duration);
    }

    fn check_invariant(&self) -> Result<(), RobotError> {
        let node = self.site.user();
        let holds = self.site.automata.request.check_invariant(self.request.location(), self);
        holds.map_err(|source| RobotFault::Invariant { node, source }.into())
    }

    /// It stands at the first access point.
    fn body(&self) -> Point {
        self.site.access_points.first().copied().unwrap_or_else(Point::origin)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::super::scenario::Scenario;
    use super::*;

    fn user() -> User {
        let hall: Scenario = serde_json::from_value(json!({
            "name": "hall",
            "workspace": {"boundary": [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]]},
            "link": {"full_range": 1.0, "max_range": 2.0},
            "control": {"clearance": 0.04, "service_radius": 0.2, "step_radius": 0.1},
            "access_point": [{"position": [5.0, 5.0]}],
            "robot": [{"position": [4.0, 5.0], "rate": 0.1}],
            "task": [{"position": [8.0, 8.0]}],
        }))
        .expect("it is a scenario");
        User::new(Arc::new(Site::new(&hall).expect("its numbers make sense")))
    }

    impl User {
        /// The control periods of a user who hears this news at the beginning of some of them, until it
        /// knows how the mission has ended.
        fn waits_for_end(&mut self, news: &Bulletin, hears: impl Fn(u32) -> bool) -> u32 {
            let (node, mut outputs) = (self.site.robots, NodeOutputs::of(self.site.nodes()));
            for period in 0..1_000 {
                if hears(period) {
                    let message = Message::News(news.clone());
                    let heard = Input::Heard { from: node, message: &message };
                    self.step(heard, &mut outputs).expect("it goes on");
                }
                for _ in 0..2 {
                    self.step(Input::Tick { passed: 0 }, &mut outputs).expect("it goes on");
                }
                self.flow(self.time_to_tick().expect("it has a clock"));
                if self.known_end().is_some() {
                    return period;
                }
            }
            1_000
        }
    }

    #[test]
    fn the_mission_ends_when_the_first_access_point_is_missed_for_long() {
        let quiet = Bulletin::first(Shared::new(Notice::Quiet));
        let patience = user().patience();
        assert!(patience > user().site.roll_validity() + 60);
        let ends_after = |hears: &dyn Fn(u32) -> bool| user().waits_for_end(&quiet, hears);
        assert_eq!(ends_after(&|_| false), patience + 1, "one is for the network to connect");
        assert_eq!(ends_after(&|period| period == 50), 50 + patience);
        assert_eq!(ends_after(&|period| period % (patience - 1) == 0), 1_000);
        let mut deserted = user();
        deserted.waits_for_end(&quiet, |_| false);
        let end = deserted.known_end().expect("it is over");
        assert_eq!(end.outcome, Outcome::Blocked);
        assert!(
            end.reason.starts_with("access point 0 has not been heard of for"),
            "{}",
            end.reason
        );
    }

    #[test]
    fn a_user_that_has_heard_the_end_misses_nobody() {
        let ended = Notice::Ended {
            outcome: Outcome::Serviced,
            reason: "done".to_owned().into(),
            task: None,
        };
        let mut user = user();
        let news = user.news.next(user.site.robots, Shared::new(ended));
        assert_eq!(user.waits_for_end(&news, |period| period == 0), 0);
        user.waits_for_end(&news, |_| false);
        assert_eq!(user.known_end().map(|end| end.outcome), Some(Outcome::Serviced));
    }

    /// A team that is cut off gives up, and its leader reaches the task: of two notices with one number the second one
    /// is known only later.
    #[test]
    fn a_user_asks_again_when_the_mission_goes_on_after_its_end() {
        let ended = Notice::Ended {
            outcome: Outcome::Blocked,
            reason: "cut off".to_owned().into(),
            task: None,
        };
        let mut user = user();
        let news = user.news.next(user.site.robots, Shared::new(ended));
        user.waits_for_end(&news, |period| period == 0);
        let passed = user.passed;
        let goes_on = news.next(user.site.robots, Shared::new(Notice::Quiet));
        let patience = user.patience();
        assert_eq!(user.waits_for_end(&goes_on, |period| period == 0), patience);
        assert_eq!(user.known_end().map(|end| end.outcome), Some(Outcome::Blocked));
        assert_eq!(user.passed, passed + patience);
    }
}
