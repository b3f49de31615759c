//! The control settings with every default filled in.

use pleach_continuous::geometry::Errors;

use super::{
    Agenda, Control, LinkRanges, MotionSolver, RoutingMethod, Scenario, Strategy, TaskOrder, Teams,
    Unreachable,
};

/// The settings of the control scheme, none of them left open.
///
/// Each field is the key of the same name in [`Control`] or [`Agenda`], or its default. Lengths are in the
/// scenario's unit, times in seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The radio.
    pub link: LinkRanges,
    /// ρ: distance kept from walls; robots keep 2ρ from each other.
    pub clearance: f64,
    /// δ: how close a robot must be to service a task, eq. (2).
    pub service_radius: f64,
    /// σ: radius of the trust region, eq. (21).
    pub step_radius: f64,
    /// How far places and moves may be off: `position_error` and `motion_error`.
    pub errors: Errors,
    /// c_min: residuals stay ≥ −c_min.
    pub residual_tolerance: f64,
    /// Control periods after which the mission is given up.
    pub max_steps: usize,
    /// Δt in seconds.
    pub period: f64,
    /// Rounds of coordination messages in a control period.
    pub rounds_per_period: usize,
    /// How routes are computed.
    pub routing_method: RoutingMethod,
    /// Iterations of the routing method in a control period.
    pub routing_iterations: usize,
    /// η: the residual that routes aim at.
    pub routing_reserve: f64,
    /// κ: how strongly traffic avoids links whose reliability changes with distance.
    pub slope_aversion: f64,
    /// Reliability of links of the tree when they are made.
    pub build_reliability: f64,
    /// Reliability that a link of the tree never falls below.
    pub tree_reliability: f64,
    /// How the motion problem is solved.
    pub motion_solver: MotionSolver,
    /// When a recruit is called for.
    pub strategy: Strategy,
    /// Which robots pursue tasks together.
    pub teams: Teams,
    /// What a task that no robot can service means for the others.
    pub unreachable: Unreachable,
    /// Which of the tasks is announced next.
    pub order: TaskOrder,
    /// Whether robots keep what they have derived for as long as nothing that it depends on has changed. Without it they
    /// derive everything anew at each tick, with the same results.
    pub caching: bool,
}

impl Settings {
    /// ρ = l/40: in Study I a hundredth of the unit, some 300 times smaller than its workspace.
    const CLEARANCES_PER_FULL_RANGE: f64 = 40.0;
    /// δ = 3ρ: a replacer 2ρ behind the robot it relieves services as well, with room to spare.
    const SERVICE_RADIUS_IN_CLEARANCES: f64 = 3.0;
    /// σ = (u − l)/10: a link changes its reliability by at most 0.3 in one step.
    const STEPS_PER_SLOPE: f64 = 10.0;
    const RESIDUAL_TOLERANCE: f64 = 0.0;
    const MAX_STEPS: usize = 20_000;
    const PERIOD: f64 = 1.0;
    const ROUNDS_PER_PERIOD: usize = 8;
    /// Rounds in which an exchange of duties that begins in a control period ends: the offer, the reply, the two duties
    /// taken, and one in which others hear of it.
    pub const ROUNDS_OF_AN_EXCHANGE: usize = 5;
    const ROUTING_ITERATIONS: usize = 5;
    const ROUTING_RESERVE: f64 = 0.02;
    const SLOPE_AVERSION: f64 = 10.0;
    const TREE_RELIABILITY: f64 = 0.1;
    /// The reliability from which on a shorter link is hardly a better one.
    pub const GOOD_RELIABILITY: f64 = 0.8;

    /// Whether an exchange of duties ends in the control period in which it begins. Otherwise nodes know different
    /// things when the period ends, as they do where messages are late.
    pub const fn has_rounds_for_exchanges(&self) -> bool {
        self.rounds_per_period >= Self::ROUNDS_OF_AN_EXCHANGE
    }

    /// The settings of `scenario`: what its `[control]` states, defaults for the rest.
    pub fn resolve(scenario: &Scenario) -> Self {
        let &Scenario { link, control, mission, .. } = scenario;
        let tree_reliability = control.tree_reliability.unwrap_or(Self::TREE_RELIABILITY);
        let clearance =
            control.clearance.unwrap_or(link.full_range / Self::CLEARANCES_PER_FULL_RANGE);
        let errors = Errors {
            position: control.position_error.unwrap_or(0.0),
            motion: control.motion_error.unwrap_or(0.0),
        };
        Self {
            link,
            clearance,
            service_radius: control
                .service_radius
                .unwrap_or_else(|| Self::usual_service_radius(clearance, &errors)),
            step_radius: control
                .step_radius
                .unwrap_or((link.max_range - link.full_range) / Self::STEPS_PER_SLOPE),
            errors,
            residual_tolerance: control.residual_tolerance.unwrap_or(Self::RESIDUAL_TOLERANCE),
            max_steps: control.max_steps.unwrap_or(Self::MAX_STEPS),
            period: control.period.unwrap_or(Self::PERIOD),
            rounds_per_period: control.rounds_per_period.unwrap_or(Self::ROUNDS_PER_PERIOD),
            routing_method: control.routing_method.unwrap_or_default(),
            routing_iterations: control.routing_iterations.unwrap_or(Self::ROUTING_ITERATIONS),
            routing_reserve: control.routing_reserve.unwrap_or(Self::ROUTING_RESERVE),
            slope_aversion: control.slope_aversion.unwrap_or(Self::SLOPE_AVERSION),
            build_reliability: control
                .build_reliability
                .unwrap_or_else(|| Self::usual_build_reliability(scenario).max(tree_reliability)),
            tree_reliability,
            motion_solver: control.motion_solver.unwrap_or_default(),
            strategy: control.strategy.unwrap_or_default(),
            teams: control.teams.unwrap_or_default(),
            unreachable: mission.unreachable.unwrap_or_default(),
            order: mission.order.unwrap_or_default(),
            caching: true,
        }
    }

    /// Σ_i r_i: such a link carries, in all the time of its sender, what all robots generate together, so
    /// that the tree alone carries the rates wherever it leads. Of rates that one link cannot carry, what
    /// can be is left to the loads.
    fn usual_build_reliability(scenario: &Scenario) -> f64 {
        let rates: f64 = scenario.robot.iter().map(|robot| robot.rate).sum();
        rates.min(Self::GOOD_RELIABILITY)
    }

    /// 3 (ρ + e + m) + e + m: a replacer services as well, wherever the errors lead.
    fn usual_service_radius(clearance: f64, errors: &Errors) -> f64 {
        let kept = Self::SERVICE_RADIUS_IN_CLEARANCES * errors.planning_clearance(clearance);
        kept + errors.position + errors.motion
    }

    /// ρ + e + m: the clearance that robots keep by what they know, so that they truly keep ρ from walls
    /// and 2ρ from each other; see [`errors`](pleach_continuous::geometry::errors).
    pub fn planning_clearance(&self) -> f64 {
        self.errors.planning_clearance(self.clearance)
    }

    /// 2 (ρ + e + m) + 2σ: from how far apart, by what they know, two robots could come into contact in one
    /// control period. With errors, robots that measure this are truly 2ρ + 2 (σ + m) apart.
    pub(crate) fn meeting_distance(&self) -> f64 {
        2.0 * (self.planning_clearance() + self.step_radius)
    }

    /// σ + m: how far a move leads at most.
    pub(crate) fn longest_step(&self) -> f64 {
        self.step_radius + self.errors.motion
    }

    /// (u − 2ρ)/4, and less where there are errors: the largest σ. Two robots that hear each other and may go out of
    /// range in one control period, since they are more than u − 2σ apart, must not be so near that they could come
    /// into contact in one, at 2ρ + 2σ. Otherwise neither can tell a robot that has gone from one whose messages are
    /// lost, and has to wait for it for ever.
    pub fn longest_step_radius(&self) -> f64 {
        let errors = self.link_margin() + 2.0 * self.errors.motion;
        (self.link.max_range - 2.0 * self.planning_clearance() - errors) / 4.0
    }

    /// δ − e: a robot that measures itself within this distance of a place is truly within δ of it.
    pub(crate) fn arrival_radius(&self) -> f64 {
        self.service_radius - self.errors.position
    }

    /// δ − e − m: a move that is to end within this distance of a place ends truly within δ of it.
    pub fn leash_radius(&self) -> f64 {
        self.arrival_radius() - self.errors.motion
    }

    /// m ≥ σ: whether even the longest move may miss its target by its whole length.
    pub(super) fn moves_may_miss(&self) -> bool {
        self.errors.motion >= self.step_radius
    }

    /// 2e: by how much a link may be longer than its ends measure it.
    pub fn link_margin(&self) -> f64 {
        2.0 * self.errors.position
    }

    /// 6e + 4m: by how much a link of the tree may be longer than the length up to which its ends go by
    /// what they know. With both ends of it on the move, it may be measured longer by twice the
    /// [stray](Errors::stray), 4e + 2m; as long as it is not measured longer than that, they may move
    /// without making it longer by what they know, and it may truly be longer by 2e + 2m then.
    pub(super) fn length_margin(&self) -> f64 {
        2.0 * self.errors.stray() + 2.0 * (self.errors.position + self.errors.motion)
    }

    /// How long links of the tree may be that are made at the build reliability: d_build and d_hard.
    pub fn usual_links(&self) -> LinkLengths {
        self.link_lengths(self.link.distance_of(self.build_reliability))
    }

    /// How long they may be when no robot is left that can be recruited.
    pub(crate) fn stretched_links(&self) -> LinkLengths {
        self.stretched_link_lengths(self.link.distance_of(self.tree_reliability))
    }

    /// As [`link_lengths`](Self::link_lengths), for links that are made as long as they may ever be, but for a clearance:
    /// robots that come to their ends later stand nearer to their posts.
    pub(crate) fn stretched_link_lengths(&self, longest: f64) -> LinkLengths {
        let LinkLengths { build, hard } = self.link_lengths(longest);
        LinkLengths { build: build.max(hard - self.planning_clearance()), hard }
    }

    /// How long links may be, as their ends measure them, whose true lengths are at most `longest`.
    pub(crate) fn link_lengths(&self, longest: f64) -> LinkLengths {
        let hard = longest - self.length_margin();
        LinkLengths { build: hard - self.service_radius, hard }
    }
}

/// How long links of the tree may be as their ends measure them, along geodesics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkLengths {
    /// d_build: up to which length a link may be made. Both its robots may still come to stand δ away from
    /// their posts without passing d_hard.
    pub build: f64,
    /// d_hard: the length that links never exceed, less what errors add.
    pub hard: f64,
}

impl From<Settings> for Control {
    fn from(settings: Settings) -> Self {
        Self {
            clearance: Some(settings.clearance),
            service_radius: Some(settings.service_radius),
            step_radius: Some(settings.step_radius),
            position_error: stated_if_any(settings.errors.position),
            motion_error: stated_if_any(settings.errors.motion),
            residual_tolerance: Some(settings.residual_tolerance),
            max_steps: Some(settings.max_steps),
            period: Some(settings.period),
            rounds_per_period: Some(settings.rounds_per_period),
            routing_method: Some(settings.routing_method),
            routing_iterations: Some(settings.routing_iterations),
            routing_reserve: Some(settings.routing_reserve),
            slope_aversion: Some(settings.slope_aversion),
            build_reliability: Some(settings.build_reliability),
            tree_reliability: Some(settings.tree_reliability),
            motion_solver: Some(settings.motion_solver),
            strategy: Some(settings.strategy),
            teams: (!settings.teams.is_one()).then_some(settings.teams),
        }
    }
}

impl From<Settings> for Agenda {
    fn from(settings: Settings) -> Self {
        Agenda { unreachable: Some(settings.unreachable), order: Some(settings.order) }
    }
}

/// An error that is 0 is left out.
fn stated_if_any(error: f64) -> Option<f64> {
    (error != 0.0).then_some(error)
}

impl Scenario {
    /// The same scenario with every default of its radio, control and mission settings written out, but that there is one team,
    /// and but for `build_reliability` where each team has a default of its own.
    #[must_use]
    pub fn with_defaults(&self) -> Self {
        let settings = Settings::resolve(self);
        let mut control: Control = settings.into();
        if control.teams.is_some() {
            control.build_reliability = self.control.build_reliability;
        }
        Self { link: self.link.with_defaults(), control, mission: settings.into(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::scenario::{AccessPoint, RobotStart, WorkspaceOutline};

    fn scenario(control: Control) -> Scenario {
        Scenario {
            name: "room".into(),
            description: None,
            workspace: WorkspaceOutline {
                boundary: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
                holes: vec![],
            },
            link: LinkRanges::new(0.4, 0.5),
            control,
            mission: Agenda::default(),
            access_point: vec![AccessPoint { position: [0.5, 0.2] }],
            robot: vec![RobotStart::at([0.6, 0.2], 0.075); 13],
            task: vec![],
        }
    }

    #[test]
    fn defaults_are_those_of_study_one() {
        let settings = Settings::resolve(&scenario(Control::default()));
        assert_eq!(settings.clearance, 0.01);
        assert_eq!(settings.service_radius, 0.03);
        assert!((settings.step_radius - 0.01).abs() < 1e-15);
        assert_eq!(settings.residual_tolerance, 0.0);
        assert!((settings.usual_links().hard - 0.4287).abs() < 1e-4);
        assert!((settings.usual_links().build - 0.3987).abs() < 1e-4);
    }

    /// Thirteen rates, up to 0.8 and from the floor on that is stated.
    #[test]
    fn links_are_made_for_what_all_robots_send() {
        let built = |rate: f64, control: Control| {
            let mut scenario = scenario(control);
            scenario.robot.iter_mut().for_each(|robot| robot.rate = rate);
            Settings::resolve(&scenario).build_reliability
        };
        let reliabilities = [0.001, 0.03, 0.2].map(|rate| built(rate, Control::default()));
        assert_eq!(reliabilities[0], 0.1);
        assert!((reliabilities[1] - 0.39).abs() < 1e-12);
        assert_eq!(reliabilities[2], 0.8);
        let stated = |tree, build| Control {
            tree_reliability: tree,
            build_reliability: build,
            ..Control::default()
        };
        assert_eq!(built(0.03, stated(Some(0.9), None)), 0.9);
        assert_eq!(built(0.03, stated(None, Some(0.2))), 0.2);
    }

    #[test]
    fn what_the_file_states_is_kept() {
        let control = Control {
            clearance: Some(0.02),
            motion_solver: Some(MotionSolver::Conic),
            ..Control::default()
        };
        let settings = Settings::resolve(&scenario(control));
        assert_eq!(settings.clearance, 0.02);
        assert_eq!(settings.service_radius, 0.06);
        assert_eq!(settings.motion_solver, MotionSolver::Conic);
    }

    #[test]
    fn defaults_written_out_resolve_to_themselves() {
        let scenario = scenario(Control::default());
        let complete = scenario.with_defaults();
        assert_ne!(complete, scenario);
        assert_eq!(Settings::resolve(&complete), Settings::resolve(&scenario));
        assert_eq!(complete.with_defaults(), complete);
    }
}
