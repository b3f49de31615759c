//! Motion: target, motion problem and move (Sec. IV, Algorithm 5).
//!
//! The robot solves the motion problem (21)–(22) with all other robots fixed, and proposes the
//! solution. What becomes of the proposal is told in `negotiation`.

use pleach_continuous::geometry::{Disc, HalfPlane, cell};
use pleach_continuous::network::LinkReliability as _;
use pleach_continuous::network::acceptance::{FULL_LOAD, Segment};
use pleach_continuous::network::motion::{Motion, MotionProblem};
use pleach_continuous::{Point, Vector};
use pleach_discrete::network::Phase;

use super::Robot;
use super::context::context;
use super::hearing::Neighbour;
use super::links::TreeLink;
use crate::automaton::TransitionError;
use crate::network::duty::Course;
use crate::network::scenario::MotionSolver;

/// A robot this share of ρ from the reference of its post has settled.
const SETTLED: f64 = 0.02;
/// Distances kept are larger than required by this share, so that rounding has no effect.
pub(super) const MARGIN: f64 = 1e-4;
/// A robot this many ρ behind another stands in a queue.
const QUEUE: f64 = 2.2;
/// A robot that stays within this share of ρ or σ, the smaller one, stands still.
pub(super) const STILL: f64 = 0.3;
/// Control periods without progress after which a robot measures its position anew, and one of the primary team makes
/// room for others.
pub(super) const PERSISTENCE: u32 = 4;
/// A proposed move shorter than this share of σ is not made.
const LEAST_MOVE: f64 = 1e-6;
/// Relative slack when lengths are compared with limits: they are sums of rounded ones.
pub(super) const ROUNDING: f64 = 1e-9;

impl Robot {
    /// Whether the robot stands still unless it is asked for; robots that settle on their post
    /// count as parked.
    pub(super) fn is_parked(&self) -> bool {
        match self.duty.course() {
            Course::AlongPath(_) => self.active_subgroup().is_none(),
            Course::WithTeam if self.goes_on_while_recruiting() => {
                self.body.still_periods() >= PERSISTENCE
            }
            Course::WithTeam => self.phase() != Phase::Advance,
            Course::AtPost => true,
        }
    }

    /// Whether a child of the post that this robot has left is still attached to this robot, although
    /// another one holds the post now. Where none does, this robot counts as its holder on the way.
    pub(super) fn is_held_by_old_news(&self) -> bool {
        self.duty.left().is_some_and(|left| {
            self.holder(left).is_some()
                && self.neighbours.iter().any(|neighbour| {
                    neighbour.beacon.parent == Some(self.id) && neighbour.is_attached_to(Some(left))
                })
        })
    }

    /// Redundant robots are still attached to the new leader: they need a moment to attach elsewhere.
    pub(super) fn bears_redundant(&self) -> bool {
        self.children().any(|child| child.post().is_some_and(|post| post.is_redundant()))
    }

    /// Whether the robot has not settled at `reference`: a move there may end as far off as it strays.
    pub(super) fn is_off(&self, reference: Point) -> bool {
        self.is_apart(self.body.position(), reference)
    }

    /// Whether a robot here has not settled there.
    pub(super) fn is_apart(&self, here: Point, there: Point) -> bool {
        (there - here).norm() > self.settling_radius()
    }

    /// How far from the reference of its post a robot may settle.
    pub(super) fn settling_radius(&self) -> f64 {
        SETTLED * self.clearance() + self.stray()
    }

    /// Whether the robot may move in this period.
    pub(super) fn is_active(&self) -> bool {
        self.goal().is_some()
    }

    /// Eq. (26): within δ of the place that it goes to along Σ, and of the task serviced there,
    /// on the whole way that is left.
    pub(super) fn has_arrived(&self) -> bool {
        let Some(hop) = self.next_hop() else { return false };
        let radius = self.site.settings.arrival_radius();
        let near = |from: Point, place: Point| (from - place).norm() <= radius;
        if !near(self.body.position(), hop.place.reference) {
            return self.queues_behind_arrived();
        }
        let services = self.task_at(&hop.post).is_none_or(|task| {
            let way = self.site.free_space.geodesic(self.body.position(), hop.place.reference);
            near(self.body.position(), task)
                && way.is_some_and(|way| way.waypoints.iter().all(|&corner| near(corner, task)))
        });
        services
            && (self.links_hold_at(hop.post) || self.has_settled_at(hop.post, hop.place.reference))
    }

    /// Whether the robot stands right behind the next member of its subgroup, which has arrived:
    /// the places of a team that had bunched may be too close together for all to be within δ of
    /// theirs while the break point at the end is still there.
    fn queues_behind_arrived(&self) -> bool {
        let (Some(place), Some(active)) = (self.duty.place(), self.active_subgroup()) else {
            return false;
        };
        let ahead = place + 1;
        ahead < active.end
            && self.has_reported(ahead)
            && self
                .neighbours_at(ahead)
                .next()
                .is_some_and(|next| next.distance <= QUEUE * self.clearance())
    }

    /// Lines 4 to 7 of Algorithm 5: the next position, if the robot moves.
    ///
    /// # Errors
    /// When a guard of its target has no value.
    pub(super) fn propose(&mut self) -> Result<(), TransitionError> {
        let target = self.target()?;
        self.approach(target);
        Ok(())
    }

    /// Solves the motion problem towards `goal` and keeps its solution as the proposal.
    fn approach(&mut self, goal: Option<Point>) {
        self.negotiation.begin();
        let Some(goal) = goal else {
            if self.negotiation.navigation_mut().stop() {
                self.note_change();
            }
            return;
        };
        if self.routing.is_infeasible(context!(self)) || !self.may_leave_place() {
            return;
        }
        let Some(waypoint) = self.first_waypoint(goal) else { return };
        self.negotiation.navigation_mut().turn_to(waypoint);
        let problem = self.motion_problem(waypoint);
        let segment = Segment { from: self.body.position(), to: self.solve(&problem).target };
        if segment.length() > LEAST_MOVE * self.site.settings.step_radius
            && (self.has_strayed() || self.site.free_space.sees(segment.from, segment.to))
        {
            self.negotiation.propose(segment, problem);
        }
    }

    /// Where the robot goes next. If it finds itself outside of its constraints, because its last move or
    /// its measurement is off, it goes where they hold if the way to its goal is shorter from there, and
    /// stays otherwise.
    fn solve(&self, problem: &MotionProblem) -> Motion {
        if !self.site.settings.errors.are_none() && !problem.admits(&self.body.position()) {
            let motion = problem.solve_from_outside();
            let way = |from: Point| {
                let goal = self.negotiation.navigation().destination();
                goal.map_or(0.0, |goal| self.site.free_space.distance_to(from, goal))
            };
            return match way(motion.target) < way(self.body.position()) {
                true => motion,
                false => Motion { target: self.body.position(), ..motion },
            };
        }
        match self.site.settings.motion_solver {
            MotionSolver::Exact => problem.solve_exact(),
            MotionSolver::Conic => problem.solve_conic(),
        }
    }

    /// Whether the robot measures itself outside of 𝒲_f, as errors of position and motion may have it.
    pub(super) fn has_strayed(&self) -> bool {
        !self.site.settings.errors.are_none()
            && !self.site.free_space.contains(self.body.position())
    }

    /// By how much the robot is outside of the region that the motion problem has given it at the
    /// last sample: cell, trust region, posts and links; 0 if it stands still.
    pub(super) fn outside(&self) -> f64 {
        self.negotiation.outside(self.body.position())
    }

    /// Where the robot stands or, if it has strayed, the free place nearest to it.
    pub(super) fn free_place(&self) -> Point {
        match self.has_strayed() {
            true => self.site.free_space.nearest(self.body.position()),
            false => self.body.position(),
        }
    }

    /// Problem (21): cell (18), linearised residual (22), trust region, links of the tree.
    pub(super) fn motion_problem(&self, waypoint: Point) -> MotionProblem {
        let step = self.site.settings.step_radius;
        let mut half_planes = self.cell(waypoint, step);
        half_planes.extend(self.sides_of_wrecks());
        half_planes.extend(self.linearised_load());
        let mut discs = vec![Disc { center: self.body.position(), radius: step }];
        discs.extend(self.discs_of_trail());
        discs.extend(self.post_discs());
        discs.extend(self.tree_links().iter().flat_map(|link| self.link_discs(link)));
        MotionProblem { position: self.body.position(), waypoint, half_planes, discs }
    }

    /// The cell (18), with what errors of position and motion add to it.
    fn cell(&self, waypoint: Point, step: f64) -> Vec<HalfPlane> {
        let (site, errors) = (&self.site, self.site.settings.errors);
        let (clearance, kept) = (site.settings.clearance, site.settings.clearance * (1.0 + MARGIN));
        let near = 2.0 * (step + errors.planning_clearance(kept));
        let close: Vec<Point> = self
            .neighbours
            .iter()
            .filter(|n| !n.is_access_point() && n.distance < near)
            .map(Neighbour::position)
            .chain(
                self.neighbours
                    .bodies()
                    .places()
                    .filter(|place| (place - self.body.position()).norm() < near),
            )
            .collect();
        let mut half_planes =
            errors.voronoi_half_planes(self.body.position(), &close, clearance, kept);
        half_planes.extend(match self.has_strayed() {
            true => errors.wall_half_planes(&site.workspace, self.body.position(), step, clearance),
            false => cell::convex_region(&site.free_space, self.body.position(), waypoint, step),
        });
        half_planes
    }

    /// Eq. (22) as a half-plane; none where the load does not depend on x_i. The flows are held, so that c_i
    /// stays as it is: what changes is the load h_i = Σ_j F_ij/R_ij, which has to stay below all the time of
    /// the sender, to first order.
    fn linearised_load(&self) -> Option<HalfPlane> {
        let mut gradient = Vector::zeros();
        for link in self.routing.routes() {
            let Some(receiver) = self.neighbour(link.to) else { continue };
            if receiver.distance > 0.0 {
                let direction = (self.body.position() - receiver.position()) / receiver.distance;
                let slope = -self.site.link.slope(receiver.distance) / link.reliability;
                gradient += direction * (link.share * slope);
            }
        }
        let steepness = gradient.norm();
        if steepness * self.site.settings.step_radius < ROUNDING {
            return None;
        }
        let normal = gradient / steepness;
        let room = (FULL_LOAD - self.routing.load()).max(0.0) / steepness;
        Some(HalfPlane::new(normal, normal.dot(&self.body.position().coords) + room))
    }

    /// The holder of a fixed post stays within δ of it, and of the task serviced from it.
    fn post_discs(&self) -> impl Iterator<Item = Disc> {
        let station = self.duty.station().filter(|station| station.post.is_fixed());
        let task = station.and_then(|station| self.task_at(&station.post));
        let (radius, motion) =
            (self.site.settings.leash_radius(), self.site.settings.errors.motion);
        station.map(|station| station.reference).into_iter().chain(task).map(move |center| Disc {
            center,
            radius: radius.max((center - self.body.position()).norm() - motion),
        })
    }

    /// The discs in which the robot keeps a link of the tree within its limit, with the other end where it is now: around
    /// that, and around each corner of the way to it. A link that errors have made longer becomes shorter with each
    /// move, by as much as the move may be off, so that it truly gets no longer.
    fn link_discs(&self, link: &TreeLink) -> impl Iterator<Item = Disc> {
        let neighbour = self.neighbour(link.to);
        let path = neighbour
            .and_then(|node| self.site.free_space.geodesic(self.body.position(), node.position()));
        let reached = ROUNDING * self.site.workspace.extent();
        let (limit, motion) = (link.limit, self.site.settings.errors.motion);
        path.into_iter().flat_map(|path| path.waypoints).filter_map(move |center| {
            let distance = (center - self.body.position()).norm();
            let radius = match distance > limit * (1.0 + ROUNDING) {
                true => distance - motion,
                false => limit.max(distance),
            };
            (distance > reached).then_some(Disc { center, radius })
        })
    }

    /// The robot measures its position at a sample. One that has not moved stays where it has measured
    /// itself before: that is as near to its true place, and what it has told of itself remains true. One
    /// that wants to go on and cannot measures itself anew from time to time: with other errors it may.
    pub(super) fn correct_position(&mut self, position: Point) {
        let tries_again = self.negotiation.navigation().waypoint().is_some()
            && (self.body.still_periods() + 1).is_multiple_of(PERSISTENCE);
        let has_moved = self.body.is_moving() || tries_again;
        let off = (position - self.body.position()).norm();
        if has_moved || off > 2.0 * self.site.settings.errors.position * (1.0 + ROUNDING) {
            self.body.correct(position);
            self.note_change();
        }
    }

    /// The move is certified: eq. (23) until the next sample.
    pub(super) fn set_off(&mut self) {
        let segment = self.own_move();
        let settings = &self.site.settings;
        let leash = (STILL * self.clearance().min(settings.step_radius)).max(self.stray());
        self.body.set_off(segment, leash, settings.period);
        self.membership.set_off(self.schedule.period(), segment.from);
        self.note_period_boundary();
    }

    /// It stays where it is until the next sample, which every certified move allows.
    pub(super) fn stay(&mut self) {
        self.body.stay();
        self.note_change();
    }

    /// A new control period begins.
    pub(super) fn restart_clock(&mut self) {
        self.schedule.begin_period();
        self.note_period_boundary();
        self.duty.begin_period();
        self.body.restart_clock();
    }
}
