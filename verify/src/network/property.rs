//! The names and the wording of the properties.

use std::fmt;

/// A property of the robot network that holds at every instant of a mission.
///
/// Each is stated once: as a sentence by [`statement`](Property::statement), and as pure functions, to which, or to
/// whose module, its variant links.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Property {
    /// See [`instant::record`](super::instant::record).
    Record,
    /// See [`period::separation`](super::period::separation).
    Separation,
    /// See [`period::clearance`](super::period::clearance).
    Clearance,
    /// See [`period::step_length`](super::period::step_length).
    StepLength,
    /// See [`period::standstill`](super::period::standstill).
    Standstill,
    /// See [`link::reliability`](super::link::reliability).
    Reliability,
    /// See [`instant::shares`](super::instant::shares).
    Shares,
    /// See [`instant::accounting`](super::instant::accounting).
    Accounting,
    /// See [`link::residuals`](super::link::residuals).
    Residual,
    /// See [`link::load`](super::link::load).
    Load,
    /// See [`tree::mark_connected`](super::tree::mark_connected).
    Connectivity,
    /// See [`tree::parents_of`](super::tree::parents_of).
    SingleParent,
    /// See [`tree::leads_to_access_point`](super::tree::leads_to_access_point).
    RootedTree,
    /// See [`tree::is_member_unless_redundant`](super::tree::is_member_unless_redundant).
    TreeMembership,
    /// See [`period::tree_range`](super::period::tree_range).
    TreeRange,
    /// See [`team::has_at_most_one_leader`](super::team::has_at_most_one_leader).
    SingleLeader,
    /// See [`team::leader_comes_last`](super::team::leader_comes_last).
    LeaderLast,
    /// See [`team::is_one_team`](super::team::is_one_team).
    ActiveTeam,
    /// See [`team::teams_are_disjoint`](super::team::teams_are_disjoint).
    DisjointTeams,
    /// See [`team::subgroups_partition`](super::team::subgroups_partition) and
    /// [`team::break_points_divide`](super::team::break_points_divide).
    Subgroups,
    /// See [`duty::is_reachable`](super::duty::is_reachable).
    RoleTransition,
    /// See [`duty::are_conserved`](super::duty::are_conserved).
    Duties,
    /// See [`period::service`](super::period::service).
    Service,
    /// See [`period::occupancy`](super::period::occupancy).
    Occupancy,
    /// See [`judge`](super::judge).
    Posts,
    /// See [`judge`](super::judge).
    Leash,
    /// See [`judge`](super::judge).
    Multipliers,
    /// See [`judge`](super::judge).
    Events,
    /// See [`judge`](super::judge).
    Stage,
    /// See [`judge`](super::judge).
    Teams,
    /// See [`judge`](super::judge).
    Outcome,
}

impl Property {
    /// Every property, in the order of declaration.
    pub const ALL: [Property; 31] = [
        Property::Record,
        Property::Separation,
        Property::Clearance,
        Property::StepLength,
        Property::Standstill,
        Property::Reliability,
        Property::Shares,
        Property::Accounting,
        Property::Residual,
        Property::Load,
        Property::Connectivity,
        Property::SingleParent,
        Property::RootedTree,
        Property::TreeMembership,
        Property::TreeRange,
        Property::SingleLeader,
        Property::LeaderLast,
        Property::ActiveTeam,
        Property::DisjointTeams,
        Property::Subgroups,
        Property::RoleTransition,
        Property::Duties,
        Property::Service,
        Property::Occupancy,
        Property::Posts,
        Property::Leash,
        Property::Multipliers,
        Property::Events,
        Property::Stage,
        Property::Teams,
        Property::Outcome,
    ];

    /// The name used in messages and documents.
    pub const fn name(self) -> &'static str {
        match self {
            Property::Record => "record",
            Property::Separation => "separation",
            Property::Clearance => "clearance",
            Property::StepLength => "step length",
            Property::Standstill => "standstill",
            Property::Reliability => "reliability",
            Property::Shares => "shares",
            Property::Accounting => "accounting",
            Property::Residual => "residual",
            Property::Load => "load",
            Property::Connectivity => "connectivity",
            Property::SingleParent => "single parent",
            Property::RootedTree => "rooted tree",
            Property::TreeMembership => "tree membership",
            Property::TreeRange => "tree range",
            Property::SingleLeader => "single leader",
            Property::LeaderLast => "leader last",
            Property::ActiveTeam => "active team",
            Property::DisjointTeams => "disjoint teams",
            Property::Subgroups => "subgroups",
            Property::RoleTransition => "role transition",
            Property::Duties => "duties",
            Property::Service => "service",
            Property::Occupancy => "occupancy",
            Property::Posts => "posts",
            Property::Leash => "leash",
            Property::Multipliers => "multipliers",
            Property::Events => "events",
            Property::Stage => "stage",
            Property::Teams => "teams",
            Property::Outcome => "outcome",
        }
    }

    /// What the property says, as one sentence.
    pub const fn statement(self) -> &'static str {
        match self {
            Property::Record => {
                "Every snapshot is well formed: finite numbers, identities that exist, one entry \
                 a robot, consecutive steps, growing time."
            }
            Property::Separation => {
                "At every instant any two robots are at least 2ρ apart, eq. (19)."
            }
            Property::Clearance => {
                "At every instant every robot keeps the distance ρ from the walls."
            }
            Property::StepLength => {
                "No robot travels farther than the trust region σ in one control period, eq. (21)."
            }
            Property::Standstill => {
                "A robot that is not listed as active does not move in that period."
            }
            Property::Reliability => {
                "The reliability of a route is that of eq. (27) for the distance it spans."
            }
            Property::Shares => {
                "Every share of time lies in [0, 1], and those of one robot sum to at most 1."
            }
            Property::Accounting => {
                "The reported residual of a robot is what its routes, those towards it and its \
                 rate amount to, eq. (4)."
            }
            Property::Residual => {
                "From the first announcement of a task on every residual is at least −c_min, eq. (5)."
            }
            Property::Load => {
                "With the flows held during a period, every link in use stays within range, and \
                 every sender needs at most its whole time."
            }
            Property::Connectivity => {
                "From every robot that has packets to send, of its own or of others, a path of links \
                 with T·R > 0 leads to an access point. Until the first task is announced, robots that \
                 are not in the tree yet do not count."
            }
            Property::SingleParent => "Every robot of the tree has exactly one parent.",
            Property::RootedTree => {
                "The tree has no cycle: from parent to parent every member comes to an access \
                 point."
            }
            Property::TreeMembership => "Every robot that is not redundant is in the tree.",
            Property::TreeRange => "At every instant every edge of the tree has R > 0.",
            Property::SingleLeader => "At most one robot is the leader.",
            Property::LeaderLast => {
                "A leader is the last of the primary team, and while that is the active team its \
                 last robot is the leader."
            }
            Property::ActiveTeam => {
                "The active team is the primary team or one subgroup of the path Σ, and its \
                 members may move."
            }
            Property::DisjointTeams => {
                "The path Σ without its last robot has no robot in common with the primary team."
            }
            Property::Subgroups => {
                "The subgroups partition the path Σ before its last break point, each from one \
                 break point up to the next."
            }
            Property::RoleTransition => "A role changes only along the table of transitions.",
            Property::Duties => {
                "A serviced task stays the duty of exactly one robot until it has ended or is taken back: \
                 a hand-over neither loses nor doubles a duty, and what is over is nobody's."
            }
            Property::Service => {
                "At every instant after a task is serviced and before it is over, some robot is within δ \
                 of it, eq. (2)."
            }
            Property::Occupancy => {
                "At every instant the place of a junction, and one from which a task is serviced, \
                 has its holder within δ."
            }
            Property::Posts => {
                "A node, junction or leaf that neither moves with a team nor walks holds one post; \
                 a leaf services a task from it, and at a junction several branches part."
            }
            Property::Leash => {
                "A robot that is not of the active team does not go farther than δ from the place of \
                 its post, once it is there."
            }
            Property::Multipliers => "No multiplier λ_i of a dual method is negative, eq. (9).",
            Property::Events => {
                "Every event is true at its instant, and follows from those before it by \
                 Algorithms 1, 3 and 4."
            }
            Property::Stage => {
                "The task and the phase of the mission are those to which its events have led."
            }
            Property::Teams => {
                "Leader, primary team and path Σ are those that elections and arrivals have made."
            }
            Property::Outcome => "The mission ended as its record shows.",
        }
    }
}

impl fmt::Display for Property {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}
