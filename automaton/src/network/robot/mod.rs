//! One robot: its own state, and what it makes of the messages it hears.
//!
//! Everything here is local. A robot knows its own position and duty, what every robot knows
//! from the beginning ([`Site`]), and the messages of the neighbours that it hears. It is a
//! [`Node`](crate::node::Node): `step` says what it does with each input, stage by stage of a
//! control period. The chapters follow that period: it listens (`hearing`), keeps its place in the tree (`attachment`,
//! `links`), takes part in the mission (`mission`,
//! `leader`, `recruit`, `path`, `team`), exchanges duties with a robot in its way
//! (`exchange`) or makes way (`yielding`), routes its packets (`routing`) and moves (`motion`);
//! what its guards see of all this are `facts`.

mod abstraction;
mod attachment;
mod exchange;
mod facts;
mod hearing;
mod leader;
mod links;
mod mission;
mod motion;
mod path;
mod recruit;
mod routing;
mod step;
mod team;
mod yielding;

use std::collections::BTreeMap;
use std::sync::Arc;

use pleach_continuous::geometry::Destination;
use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::{Point, Vector};
use pleach_discrete::network::{
    Agreement, Bid, Bulletin, Dealings, Election, IdSet, Lineage, MissionStep, NodeId, Phase, Post,
    PostId, Role, RoleEvent, Subgroup,
};

pub use facts::{Facts, VARIABLES};
pub use links::TreeLink;
pub use routing::RouteLink;
pub use step::{RobotError, Stage};

use crate::automaton::{Jump, TransitionError};

use super::automata::{MissionAutomaton, RoleAutomaton};
use super::beacon::{Beacon, Notice, TeamReport, Voice};
use super::duty::{Duty, Hop, Path, Station};
use super::record::MissionEvent;
use super::shared::Shared;
use super::site::Site;
use hearing::Neighbour;

/// A robot of the network.
#[derive(Clone, Debug)]
pub struct Robot {
    // What it knows from the beginning.
    id: NodeId,
    rate: f64,
    site: Arc<Site>,

    // Where it stands in its control period, and whether that is its first.
    stage: Stage,
    is_new: bool,

    // Its continuous state: x, u and the clock τ, with ẋ = u and τ̇ = 1 between jumps.
    position: Point,
    velocity: Vector,
    clock: f64,

    // Where it is in its two automata.
    role: Role,
    phase: Phase,
    facts: Facts,
    is_quiet: bool,

    // What has changed since it last deliberated, spoke and measured its facts.
    has_news: bool,
    is_unspoken: bool,
    is_unmeasured: bool,
    voice: Voice,

    // Its duty, and the exchange of duties that it is engaged in.
    duty: Duty,
    left_post: Option<PostId>,
    dealings: Dealings<Duty>,
    last_partner: Option<NodeId>,
    /// The number of the offer answered last, by the robot that made it.
    answered: BTreeMap<NodeId, u32>,

    // What it hears and where it hangs.
    neighbours: Vec<Neighbour>,
    /// Where in the table of neighbours the next beacon is expected.
    heard_up_to: usize,
    parent: Option<NodeId>,
    lineage: Option<Arc<Lineage>>,
    below: Arc<IdSet>,
    can_detach: bool,
    barren_periods: u32,

    // What it was told of the mission.
    bulletin: Shared<Bulletin<Notice>>,
    tasks: Vec<TaskNotice>,
    roster: Arc<IdSet>,
    eligible: Arc<IdSet>,
    election: Option<Election>,
    /// What it has bid in this election itself.
    bid: Option<Bid>,
    waited_rounds: usize,
    route: Option<(u32, Shared<Vec<Hop>>)>,
    awaits_release: bool,
    path: Option<Arc<Path>>,
    agreement: Option<Agreement>,
    subgroups: Vec<Subgroup>,
    subgroup: usize,
    team: Option<TeamReport>,

    // Communication variables.
    routing: routing::RoutingState,
    links: Vec<RouteLink>,
    /// The link whose other end is expected to tell its multiplier next.
    expected_link: usize,
    inflow: f64,
    inflows: Vec<(NodeId, f64)>,
    /// The robots that send their demand here in a sweep, ascending, each with what has been heard
    /// of it.
    demands: Vec<(NodeId, Option<f64>)>,
    residual: f64,
    has_swept: bool,
    is_frugal: bool,
    has_shortage_news: bool,
    has_untold_flows: bool,
    is_unsettled: bool,

    // Motion.
    destination: Option<Destination>,
    waypoint: Option<Point>,
    proposal: Option<Segment>,
    heard_moves: Vec<(NodeId, Segment)>,
    must_judge_moves: bool,
    arrival: Point,
    resting_place: Point,
    still_periods: u32,

    // What it tells observers; no robot reads it.
    log: Vec<MissionEvent>,
}

/// A task that this robot has heard of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TaskNotice {
    number: usize,
    position: Point,
    /// The point of 𝒲_f nearest to it, where the leader goes.
    target: Point,
}

impl Robot {
    /// A robot at the start of a mission: redundant, alone, at rest.
    pub fn new(id: NodeId, position: Point, rate: f64, site: Arc<Site>) -> Self {
        let post = Post::redundant(PostId(id as u32));
        Robot {
            id,
            rate,
            stage: Stage::Sample,
            is_new: true,
            position,
            velocity: Vector::zeros(),
            clock: site.settings.period,
            role: Role::Redundant,
            phase: Phase::Idle,
            facts: Facts::default(),
            is_quiet: false,
            has_news: true,
            is_unspoken: true,
            is_unmeasured: true,
            voice: Voice::default(),
            duty: Duty::Hold(Station { post, reference: position }),
            left_post: None,
            dealings: Dealings::new(),
            last_partner: None,
            answered: BTreeMap::new(),
            neighbours: Vec::new(),
            heard_up_to: 0,
            parent: None,
            lineage: None,
            below: Arc::new(IdSet::singleton(id)),
            can_detach: false,
            barren_periods: 0,
            bulletin: Shared::new(Bulletin::first(Notice::Quiet)),
            tasks: Vec::new(),
            roster: Arc::default(),
            eligible: Arc::default(),
            election: None,
            bid: None,
            waited_rounds: 0,
            route: None,
            awaits_release: false,
            path: None,
            agreement: None,
            subgroups: Vec::new(),
            subgroup: 0,
            team: None,
            routing: routing::RoutingState::new(site.settings.routing_method),
            links: Vec::new(),
            expected_link: 0,
            inflow: 0.0,
            inflows: Vec::new(),
            demands: Vec::new(),
            residual: 0.0,
            has_swept: false,
            is_frugal: false,
            has_shortage_news: false,
            has_untold_flows: false,
            is_unsettled: true,
            destination: None,
            waypoint: None,
            proposal: None,
            heard_moves: Vec::new(),
            must_judge_moves: false,
            arrival: position,
            resting_place: position,
            still_periods: 0,
            log: Vec::new(),
            site,
        }
    }

    /// What the robot tells its neighbours now: the very same beacon as before unless something
    /// in it has changed.
    fn next_beacon(&mut self) -> Arc<Beacon> {
        if !std::mem::take(&mut self.is_unspoken)
            && let Some(beacon) = self.voice.last()
        {
            return beacon;
        }
        let (beacon, is_new) = self.voice.say(self.public_state());
        self.has_news |= is_new;
        beacon
    }

    fn public_state(&self) -> Beacon {
        Beacon {
            sender: self.id,
            position: self.position,
            bulletin: self.bulletin.clone(),
            election: self.election.clone(),
            agreement: self.agreement.clone(),
            route: self.route.clone(),
            crossing: Vec::new(),
            lineage: self.lineage.clone(),
            parent: self.parent,
            below: Arc::clone(&self.below),
            duty: Some(self.duty),
            parked: self.is_parked(),
            way: self.way_asked_for(),
            can_detach: self.can_detach,
            offer: self.dealings.offer().cloned(),
            offers_made: self.dealings.offers_made(),
            reply: self.dealings.reply().cloned(),
            team: self.team,
        }
    }

    /// x_i.
    pub const fn position(&self) -> Point {
        self.position
    }

    /// The role, a location of the role automaton.
    pub const fn role(&self) -> Role {
        self.role
    }

    /// The phase, a location of the mission automaton.
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    /// What it does.
    pub const fn duty(&self) -> &Duty {
        &self.duty
    }

    /// The newest word on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        self.bulletin.notice()
    }

    /// The number of the newest word on the mission that it knows.
    pub fn word_number(&self) -> u32 {
        self.bulletin.sequence()
    }

    /// The task announced last, as far as it knows.
    pub fn current_task(&self) -> Option<usize> {
        self.tasks.last().map(|task| task.number)
    }

    /// c_i at the last sample.
    pub const fn residual(&self) -> f64 {
        self.residual
    }

    /// A control period begins: what is looked at once a period.
    fn begin_period(&mut self) {
        self.stir();
        self.retire_if_barren();
        self.consider_exchange();
    }

    /// After each round of messages: the robot puts together what it has heard.
    ///
    /// What comes of it depends on nothing but what the robot hears and its own state. Where
    /// neither has changed, and no wait is over, there is nothing to do.
    fn deliberate(&mut self) {
        let is_due = self.count_round();
        if !std::mem::take(&mut self.has_news) && !is_due {
            return;
        }
        self.reflect();
    }

    /// The robot puts together what it has heard, whether or not there is news in it.
    fn reflect(&mut self) {
        (self.is_unspoken, self.is_unmeasured) = (true, true);
        self.handle_exchange();
        self.keep_place();
        self.hear_word();
        self.remember_parent();
    }

    /// Takes at most one transition of the mission automaton.
    fn step_mission(
        &mut self,
        automaton: &MissionAutomaton,
    ) -> Result<Option<Jump<Phase, MissionStep>>, TransitionError> {
        let mut phase = self.phase;
        let Some(step) = automaton.enabled(phase, self)? else { return Ok(None) };
        let jump = step.jump();
        self.phase = jump.target;
        step.fire(&mut phase, self)?;
        self.is_quiet = false;
        self.stir();
        Ok(Some(jump))
    }

    /// Takes at most one transition of the role automaton.
    fn step_role(
        &mut self,
        automaton: &RoleAutomaton,
    ) -> Result<Option<Jump<Role, RoleEvent>>, TransitionError> {
        let mut role = self.role;
        let jump = automaton.step(&mut role, self)?;
        self.role = role;
        if jump.is_some() {
            self.is_quiet = false;
            self.stir();
        }
        Ok(jump)
    }

    /// The robot's state has changed: it has something to think over, to say and to measure.
    fn stir(&mut self) {
        (self.has_news, self.is_unspoken, self.is_unmeasured) = (true, true, true);
    }

    fn report(&mut self, event: MissionEvent) {
        self.log.push(event);
    }

    fn clearance(&self) -> f64 {
        self.site.settings.clearance
    }
}
