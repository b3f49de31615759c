//! The user: a person with a list of tasks, at the first access point.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{Bulletin, NodeId};

use super::beacon::Notice;
use super::member::Sense;
use super::message::Message;
use super::record::MissionEvent;
use super::robot::RobotError;
use super::shared::Shared;
use super::site::Site;
use crate::node::{Input, Node, Outputs};

/// A user tells the first access point what there is to do, and hears from it what comes of it.
///
/// The network is given one control period to find itself. Then the user repeats its request in
/// every period until it has heard an answer.
#[derive(Clone, Debug)]
pub struct User {
    site: Arc<Site>,
    tasks: Arc<[Point]>,
    news: Shared<Bulletin<Notice>>,
    clock: f64,
    is_new: bool,
}

impl User {
    /// A user who wants nothing yet.
    pub fn new(site: Arc<Site>) -> Self {
        User {
            tasks: Arc::from([]),
            news: Shared::new(Bulletin::first(Notice::Quiet)),
            clock: site.settings.period,
            is_new: true,
            site,
        }
    }

    /// The access point that the user talks to.
    fn desk(&self) -> NodeId {
        self.site.robots
    }

    fn hear(&mut self, news: &Shared<Bulletin<Notice>>) {
        if news.sequence() > self.news.sequence() {
            self.news = news.clone();
        }
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.news.notice()
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
            Input::Heard { message: Message::News(news), .. } => self.hear(news),
            Input::Tick => {
                self.clock = 0.0;
                let waits_for_answer = self.news.sequence() == 0;
                if !std::mem::take(&mut self.is_new) && waits_for_answer {
                    outputs.send(self.desk(), Message::Request(Arc::clone(&self.tasks)));
                }
            }
            Input::Sensed(Sense::Position(_)) | Input::Heard { .. } => {}
        }
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        Some((self.site.settings.period - self.clock).max(0.0))
    }

    fn flow(&mut self, duration: f64) {
        self.clock += duration;
    }

    /// It stands at the first access point.
    fn body(&self) -> Point {
        self.site.access_points.first().copied().unwrap_or_else(Point::origin)
    }
}
