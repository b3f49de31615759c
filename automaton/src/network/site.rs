//! What every robot knows from the beginning: the floor plan, the access points, the radio and
//! the settings.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::geometry::{
    Disc, FreeSpace, FreeSpaceError, Repair, Workspace, WorkspaceError,
};
use pleach_continuous::network::reliability::ReliabilityError;
use pleach_continuous::network::{LinkReliability, WithMargin};
use pleach_discrete::network::IdSet;
use pleach_discrete::network::NodeId;

use super::Link;
use super::access_point::PATIENCE;
use super::automata::Automata;
use super::renumbering::Renumbering;
use super::robot::ROUNDS_TO_BE_HEARD;
use super::scenario::{LinkLengths, Scenario, Settings};
use crate::builder::BuildError;

/// Steps of two robots towards each other from where they begin to watch each other to where they
/// could come into contact.
const WATCHED_STEPS: f64 = 8.0;

/// Control periods for which a roll is valid at the least.
const ROLL_MARGIN: u32 = 6;

/// Rounds for which news may be under way beside those over links of trees: over the wire from one access
/// point to another, and while trees grow.
const ROUNDS_TO_SPARE: usize = 5;

/// Common knowledge of the robots; it does not change during a mission.
#[derive(Clone, Debug)]
pub struct Site {
    /// 𝒲.
    pub workspace: Workspace,
    /// What of its polygons was repaired, since they touch.
    pub repairs: Vec<Repair>,
    /// 𝒲_f, the free space of the robots' centres by what these know: it keeps ρ + e + m from walls, with
    /// the errors e of positions and m of moves.
    pub free_space: FreeSpace,
    /// Where the access points stand.
    pub access_points: Vec<Point>,
    /// How reliable a link is at least whose ends measure this distance: R(d + 2e), where R is
    /// [`radio`](Self::radio).
    pub link: Link,
    /// How reliable a link is over its true length, eq. (27).
    pub radio: Link,
    /// The control settings, every default filled in.
    pub settings: Settings,
    /// Number of robots.
    pub robots: usize,
    /// Where they start, by number, and their numbers by where that is, from west to east.
    starts: Vec<Point>,
    west_to_east: Vec<NodeId>,
    /// How long links of the tree may be as long as there are robots left; where robots start too far apart
    /// for these, as long as [`stretched`](Self::stretched).
    pub usual: LinkLengths,
    /// How long they may be once no robot is left that can be recruited.
    pub stretched: LinkLengths,
    /// Whether `usual` is `stretched`, since the robots start so far apart.
    begins_stretched: bool,
    /// The distance up to which robots watch each other.
    watch_radius: f64,
    /// Whether links behave as a model of the caller's says, and not as `[link]` does.
    has_own_link: bool,
    /// The automata that every robot runs.
    pub automata: Automata,
    /// What people call nodes and tasks, where that is not their numbers here.
    names: Option<Arc<Renumbering>>,
    /// How ways are measured where they are not those of the floor plan.
    #[cfg(feature = "abstraction")]
    measure: Option<std::sync::Arc<dyn Measure>>,
}

/// The numbers of robots by where they start.
fn from_west_to_east(starts: &[Point]) -> Vec<NodeId> {
    let mut numbers: Vec<NodeId> = (0..starts.len()).collect();
    numbers.sort_by(|&one, &other| starts[one].x.total_cmp(&starts[other].x));
    numbers
}

/// A way to measure ways where only the shape of a network matters: by a graph of places.
#[cfg(feature = "abstraction")]
pub trait Measure: std::fmt::Debug + Send + Sync {
    /// The length of the shortest way.
    fn distance(&self, from: Point, to: Point) -> f64;
}

/// Why no site can be made of a scenario.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SiteError {
    /// The polygons do not make a workspace.
    #[error(transparent)]
    Workspace(#[from] WorkspaceError),
    /// The robots have no free space.
    #[error(transparent)]
    FreeSpace(#[from] FreeSpaceError),
    /// The radio's ranges make no sense.
    #[error(transparent)]
    Range(#[from] ReliabilityError),
    /// An automaton is not well formed.
    #[error(transparent)]
    Build(#[from] BuildError),
}

impl Site {
    /// Prepares what the robots of `scenario` know.
    ///
    /// # Errors
    /// When polygons, clearance or ranges are not valid, and when an automaton is not well formed.
    pub fn new(scenario: &Scenario) -> Result<Self, SiteError> {
        let settings = Settings::resolve(scenario);
        let (workspace, repairs) = scenario.workspace()?;
        let free_space = Self::free_space(&workspace, &settings)?;
        let radio = scenario.link.link()?;
        let link = Self::as_measured(&radio, &settings)?;
        let starts: Vec<Point> = scenario.robot.iter().map(|robot| robot.position.into()).collect();
        Ok(Site {
            workspace,
            repairs,
            free_space,
            access_points: scenario.access_point.iter().map(|ap| ap.position.into()).collect(),
            robots: starts.len(),
            west_to_east: from_west_to_east(&starts),
            starts,
            usual: settings.usual_links(),
            stretched: settings.stretched_links(),
            begins_stretched: false,
            watch_radius: Self::watch_radius(&settings, &link),
            settings,
            has_own_link: false,
            link,
            radio,
            automata: Automata::new()?,
            names: None,
            #[cfg(feature = "abstraction")]
            measure: None,
        })
    }

    /// 𝒲_f. A robot that measures itself outside, because it has strayed, counts as about to re-enter.
    fn free_space(workspace: &Workspace, settings: &Settings) -> Result<FreeSpace, FreeSpaceError> {
        let free_space = FreeSpace::new(workspace, settings.planning_clearance())?;
        match settings.errors.are_none() {
            true => Ok(free_space),
            false => free_space.with_reach(REACH * settings.planning_clearance()),
        }
    }

    /// A link may be longer by 2e than its ends measure it.
    fn as_measured(radio: &Link, settings: &Settings) -> Result<Link, ReliabilityError> {
        match settings.link_margin() {
            0.0 => Ok(radio.clone()),
            margin => Ok(Link::new(WithMargin::new(radio.clone(), margin)?)),
        }
    }

    /// The same site where links behave as `model` says. The lengths of links follow.
    ///
    /// # Errors
    /// When links reach no farther than positions may be off.
    pub(super) fn with_link(
        self,
        model: impl LinkReliability + 'static,
    ) -> Result<Self, ReliabilityError> {
        let radio = Link::new(model);
        let link = Self::as_measured(&radio, &self.settings)?;
        let settings = &self.settings;
        let usual = settings.link_lengths(radio.distance_at(settings.build_reliability));
        let longest = radio.distance_at(settings.tree_reliability);
        let stretched = settings.stretched_link_lengths(longest);
        let watch_radius = Self::watch_radius(&self.settings, &link);
        Ok(Site { link, radio, usual, stretched, watch_radius, has_own_link: true, ..self })
    }

    /// Whether links behave as the model given to [`with_link`](super::scenario::ValidScenario::with_link) says.
    pub const fn has_own_link(&self) -> bool {
        self.has_own_link
    }

    /// The same site where the lengths of ways are those of `measure`.
    #[cfg(feature = "abstraction")]
    #[must_use]
    pub fn measured_by(self, measure: impl Measure + 'static) -> Self {
        Site { measure: Some(std::sync::Arc::new(measure)), ..self }
    }

    /// Some steps more than the distance from which two robots could come into contact in one control period,
    /// and well in range.
    fn watch_radius(settings: &Settings, link: &Link) -> f64 {
        let meeting = settings.meeting_distance();
        let watched = meeting + WATCHED_STEPS * settings.longest_step();
        watched.min(Self::well_in_range(settings, link)).max(meeting)
    }

    /// From where no step of two robots leads out of the range of the radio.
    fn well_in_range(settings: &Settings, link: &Link) -> f64 {
        link.range() - 2.0 * settings.longest_step()
    }

    /// How long links of the tree may be, before and after no robot was left that can be recruited.
    pub const fn lengths(&self, stretched: bool) -> LinkLengths {
        if stretched { self.stretched } else { self.usual }
    }

    /// The same site, where robots derive everything anew.
    pub(super) fn without_caching(&self) -> Self {
        Site { settings: Settings { caching: false, ..self.settings }, ..self.clone() }
    }

    /// The same site where the robots start at other places. Links are as long as before.
    pub(super) fn with_starts(&self, starts: Vec<Point>) -> Self {
        Site { west_to_east: from_west_to_east(&starts), starts, ..self.clone() }
    }

    /// The site of a fleet, with the same workspace and radio, whose nodes and tasks have these numbers in the whole.
    /// Links are made for the rates of its robots.
    pub(super) fn of_fleet(&self, fleet: &Scenario, outward: &Renumbering) -> Self {
        let settings = Settings::resolve(fleet);
        let starts: Vec<Point> = fleet.robot.iter().map(|robot| robot.position.into()).collect();
        let longest = self.radio.distance_at(settings.build_reliability);
        Site {
            access_points: fleet.access_point.iter().map(|ap| ap.position.into()).collect(),
            robots: starts.len(),
            west_to_east: from_west_to_east(&starts),
            starts,
            usual: settings.link_lengths(longest),
            settings,
            names: Some(Arc::new(outward.clone())),
            ..self.clone()
        }
    }

    /// The number by which people know a node.
    pub(super) fn name_of(&self, node: NodeId) -> usize {
        self.names.as_ref().and_then(|names| names.node(node)).unwrap_or(node)
    }

    /// The numbers by which people know these nodes.
    pub(super) fn names_of(&self, nodes: &[NodeId]) -> Vec<usize> {
        nodes.iter().map(|&node| self.name_of(node)).collect()
    }

    /// The number by which people know a task.
    pub(super) fn name_of_task(&self, task: usize) -> usize {
        self.names.as_ref().and_then(|names| names.task(task)).unwrap_or(task)
    }

    /// The same site where links are from the beginning as long as they may be.
    pub(super) fn stretched_from_the_start(self) -> Self {
        Site { usual: self.stretched, begins_stretched: true, ..self }
    }

    /// Whether links are from the beginning as long as they may be, since the robots start so far apart.
    pub(super) const fn begins_stretched(&self) -> bool {
        self.begins_stretched
    }

    /// Whether links may be any longer when no robot is left that can be recruited.
    pub(super) fn could_stretch(&self) -> bool {
        self.stretched.build > self.usual.build
    }

    /// Whether robots stand on places of a graph, as explorers have it, and no distance says whether they meet.
    fn is_graph(&self) -> bool {
        #[cfg(feature = "abstraction")]
        return self.measure.is_some();
        #[cfg(not(feature = "abstraction"))]
        false
    }

    /// Whether robots at this distance move only if they have heard each other in the same control
    /// period: they may come into contact within a few periods. Robots on places of a graph never do.
    pub(super) fn is_near(&self, distance: f64) -> bool {
        !self.is_graph() && distance <= self.watch_radius
    }

    /// Whether robots at this distance are in contact, which they are up to `contact`. Always on a graph of places, where
    /// explorers decide which robots meet.
    pub(super) fn may_touch(&self, distance: f64, contact: f64) -> bool {
        self.is_graph() || distance <= contact
    }

    /// Whether two robots could come into contact in this control period that were this far apart when one
    /// of them was heard last, so many periods ago.
    pub(super) fn could_meet(&self, distance: f64, periods: u32) -> bool {
        let way = f64::from(periods) * self.settings.longest_step();
        !self.is_graph() && distance <= self.settings.meeting_distance() + way
    }

    /// Whether a robot that is not heard any more, and was this far away, has not just gone out of range.
    pub(super) fn is_well_in_range(&self, distance: f64) -> bool {
        !self.is_graph() && distance <= Self::well_in_range(&self.settings, &self.link)
    }

    /// The number of the access point that is this node; none if it is a robot.
    pub(super) fn access_point_of(&self, node: NodeId) -> Option<usize> {
        node.checked_sub(self.robots).filter(|&number| number < self.access_points.len())
    }

    /// Where a robot starts, if there is one of this number.
    pub fn start_of(&self, robot: NodeId) -> Option<Point> {
        self.starts.get(robot).copied()
    }

    /// The robots that start [well in range](Self::is_well_in_range) of this place, and where.
    pub(super) fn starts_well_in_range(
        &self,
        place: Point,
    ) -> impl Iterator<Item = (NodeId, Point)> {
        let range = Self::well_in_range(&self.settings, &self.link);
        let is_west = |&robot: &NodeId| self.starts[robot].x < place.x - range;
        let first = self.west_to_east.partition_point(is_west);
        let starts = self.west_to_east[first..].iter().map(|&robot| (robot, self.starts[robot]));
        let eastward = starts.take_while(move |(_, start)| start.x <= place.x + range);
        eastward.filter(move |(_, start)| self.is_well_in_range((start - place).norm()))
    }

    /// Control periods for which a roll is valid: as long as it may take to reach every robot, some
    /// messages being lost. Beacons that stay the same carry it over three links in a period.
    pub(super) fn roll_validity(&self) -> u32 {
        ROLL_MARGIN + 2 * self.nodes().div_ceil(ROUNDS_TO_BE_HEARD) as u32
    }

    /// Control periods for which an access point waits to hear again of a task that has been serviced: until it would
    /// miss a robot, and until every robot goes by that.
    pub fn patience_with_tasks(&self) -> u32 {
        PATIENCE + self.roll_validity()
    }

    /// For how many rounds news is under way, without losses, between nodes of trees that are no deeper than
    /// this: up one tree and down another, and no longer than there are nodes to pass it on.
    pub(super) fn rounds_across(&self, depth: usize) -> usize {
        (2 * depth + ROUNDS_TO_SPARE).min(self.nodes())
    }

    /// The longest wait of a node that is told of another; no longer than that among as many nodes as there are.
    pub(super) fn longer_wait(&self, known: usize, told: usize) -> usize {
        known.max(told.min(self.nodes()))
    }

    /// The number of the user, after those of robots and access points.
    pub(super) const fn user(&self) -> NodeId {
        self.nodes()
    }

    /// How many robots and access points there are.
    pub const fn nodes(&self) -> usize {
        self.robots + self.access_points.len()
    }

    /// Where a robot at `from` would service a task: the nearest place to which a way leads; where none does,
    /// the nearest of all.
    pub fn place_to_service(&self, task: Point, from: Point) -> Point {
        let reached = self.free_space.nearest_reached(task, from);
        reached.unwrap_or_else(|| self.free_space.nearest(task))
    }

    /// The numbers of all access points.
    pub(super) fn all_access_points(&self) -> Arc<IdSet> {
        Arc::new((0..self.access_points.len()).collect())
    }

    /// The length of the shortest way to the place from which a task is serviced, from the nearest of these places or of
    /// the free places beside them; infinite if there is none.
    pub(super) fn way_from(&self, places: &[Point], task: Point) -> f64 {
        let ways = places.iter().map(|&place| {
            let start = self.free_space.nearest(place);
            self.distance(start, self.place_to_service(task, start))
        });
        ways.fold(f64::INFINITY, f64::min)
    }

    /// The length of the shortest way in 𝒲_f; infinite if there is none.
    pub fn distance(&self, from: Point, to: Point) -> f64 {
        #[cfg(feature = "abstraction")]
        if let Some(measure) = &self.measure {
            return measure.distance(from, to);
        }
        self.free_space.distance(from, to)
    }

    /// The length of the shortest way around these discs; none if they close it. None of them counts where ways are not
    /// those of the floor plan.
    pub(super) fn distance_around(&self, from: Point, to: Point, discs: &[Disc]) -> Option<f64> {
        if discs.is_empty() || self.is_graph() {
            return Some(self.distance(from, to));
        }
        self.free_space.detour(from, to, discs).map(|way| way.length)
    }

    /// The length of a link as the tree counts it: how far it has to reach so that a robot can walk from one end to the
    /// other without losing it. That is the distance of its ends, unless the [way](pleach_continuous::geometry::Geodesic::reach) around walls leads
    /// farther from one of them. Infinite if no way leads there.
    pub(super) fn link_length(&self, from: Point, to: Point) -> f64 {
        #[cfg(feature = "abstraction")]
        if let Some(measure) = &self.measure {
            return measure.distance(from, to);
        }
        self.free_space.link_reach(from, to)
    }

    /// The length of a link, or infinity when that is longer than any link of the tree.
    pub(super) fn walk(&self, from: Point, to: Point) -> f64 {
        match (to - from).norm() > REACH_OF_INTEREST * self.stretched.hard && !self.is_graph() {
            true => f64::INFINITY,
            false => self.link_length(from, to),
        }
    }

    /// Whether a robot that walks from one of these access points to the other is within this distance of one of them all
    /// along.
    pub(super) fn are_within_changeover(&self, one: Point, other: Point, reach: f64) -> bool {
        #[cfg(feature = "abstraction")]
        if let Some(measure) = &self.measure {
            return measure.distance(one, other) <= 2.0 * reach;
        }
        self.free_space.geodesic(one, other).is_some_and(|way| way.gap(one) <= reach)
    }

    /// How many links lead from one place to within `rest` of another along the shortest way, each as long as it may be.
    pub(super) fn links_between(&self, from: Point, to: Point, longest: f64, rest: f64) -> f64 {
        #[cfg(feature = "abstraction")]
        if let Some(measure) = &self.measure {
            return ((measure.distance(from, to) - rest).max(0.0) / longest).ceil();
        }
        let way = self.free_space.geodesic(from, to);
        way.map_or(f64::INFINITY, |way| f64::from(way.links(from, longest, rest)))
    }
}

/// A robot this many clearances outside of 𝒲_f or less walks back into it. It strays by less, and from
/// a full clearance the way back could lead through a wall.
const REACH: f64 = 0.99;

/// Links longer than this many times d_hard are never measured around walls: they cannot be
/// links of the tree, nor become such within a period.
const REACH_OF_INTEREST: f64 = 1.5;
