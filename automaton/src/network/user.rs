//! The user: a person with a list of tasks, at the first access point.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::Location as _;
use pleach_discrete::network::{NodeId, REQUESTS, Request, RequestEvent};
use pleach_guards::Guard;
use pleach_guards::network::{control, service as guards};

use super::act::{Act, acting};
use super::beacon::{Bulletin, Notice};
use super::member::Sense;
use super::message::Message;
use super::record::{End, MissionEvent};
use super::robot::{RobotError, RobotFault};
use super::service::{Asked, Asking, Informed, Preparing, Waiting};
use super::shared::Shared;
use super::site::Site;
use crate::located::{Current, DataOf, Holds, Place as _};
use crate::node::{Input, Node, Outputs};
use crate::{Automaton, BuildError, Flow, Transfer};

/// A user sends its tasks to the first access point and receives notices from it.
///
/// The network is given one control period to connect. The user then repeats its request in every
/// period until the mission ends: an access point that restarts has forgotten it.
#[derive(Clone, Debug)]
pub struct User {
    site: Arc<Site>,
    request: Current<Asked>,
    /// The remaining acts of the row that was taken last.
    acts: UserActs,
    tasks: Arc<[Point]>,
    news: Bulletin,
    clock: f64,
}

/// What a user does when it takes a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UserAct {
    /// τ := 0.
    RestartClock,
    /// It sends its tasks to the first access point.
    Ask,
}

/// What a user does when it takes a row, in this order.
pub type UserActs = &'static [UserAct];

/// The automaton of a user.
pub type RequestAutomaton = Automaton<Request, RequestEvent, User>;

crate::observed! {
    impl Observed for User as user;
    /// What the guards of the user read.
    pub const USER_GLOSSARY;
    quantities {
        /// τ: seconds since the last sample.
        clock: user.clock,
        /// Δt: seconds from sample to sample.
        period: user.site.settings.period,
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
/// Never with the table and guards of this crate; they are checked all the same.
pub fn request_automaton() -> Result<RequestAutomaton, BuildError> {
    use RequestEvent as On;
    use UserAct::{Ask, RestartClock};
    use guards::{another_period, answer_heard, prepared, request_over};
    let builder = Automaton::builder(REQUESTS, Request::Preparing).observing();
    let builder = Request::ALL.iter().fold(builder, |builder, &location| {
        let flow = Flow::exact("τ̇ = 1", |user: &mut User, duration| user.clock += duration);
        builder.flow(location, flow).invariant(location, control::waiting())
    });
    builder
        .carried_out(row(On::Prepared, prepared(), &[RestartClock], |_: &Preparing| Asking))
        .carried_out(row(On::AnswerHeard, answer_heard(), &[], |_: &Preparing| Waiting))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Preparing| Informed))
        .carried_out(row(On::PeriodOver, another_period(), &[RestartClock, Ask], |_: &Asking| {
            Asking
        }))
        .carried_out(row(On::AnswerHeard, answer_heard(), &[], |_: &Asking| Waiting))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Asking| Informed))
        .carried_out(row(On::PeriodOver, another_period(), &[RestartClock, Ask], |_: &Waiting| {
            Waiting
        }))
        .carried_out(row(On::EndHeard, request_over(), &[], |_: &Waiting| Informed))
        .carried_out(row(On::PeriodOver, another_period(), &[RestartClock], |_: &Informed| {
            Informed
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
            news: Bulletin::first(Shared::new(Notice::Quiet)),
            clock: site.settings.period,
            site,
        }
    }

    /// The access point that the user sends its requests to.
    fn desk(&self) -> NodeId {
        self.site.robots
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.news.notice()
    }

    /// How the mission has ended, once it has heard so.
    pub fn announced_end(&self) -> Option<End> {
        match self.notice() {
            Notice::Ended { outcome, reason, task } => {
                Some(End { outcome: *outcome, reason: reason.to_string(), task: *task })
            }
            _ => None,
        }
    }

    /// Takes a row, if one is enabled.
    fn jump(&mut self, outputs: &mut Outputs<Message, MissionEvent>) -> Result<(), RobotError> {
        let site = Arc::clone(&self.site);
        site.automata.request.step_in_place::<Asked>(self)?;
        for act in std::mem::take(&mut self.acts) {
            match act {
                UserAct::RestartClock => self.clock = 0.0,
                UserAct::Ask => {
                    outputs.send(self.desk(), Message::Request(Arc::clone(&self.tasks)))
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
        outputs: &mut Outputs<Message, MissionEvent>,
    ) -> Result<(), RobotError> {
        match input {
            Input::Sensed(Sense::Tasks(tasks)) => self.tasks = tasks,
            Input::Heard { message: Message::News(news), .. } => {
                self.news.merge(news);
                self.jump(outputs)?;
            }
            Input::Tick { .. } => self.jump(outputs)?,
            Input::Sensed(Sense::Position(_) | Sense::Fix(_)) | Input::Heard { .. } => {}
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
        let node = self.site.nodes();
        let holds = self.site.automata.request.check_invariant(self.request.location(), self);
        holds.map_err(|source| RobotFault::Invariant { node, source }.into())
    }

    /// It stands at the first access point.
    fn body(&self) -> Point {
        self.site.access_points.first().copied().unwrap_or_else(Point::origin)
    }
}
