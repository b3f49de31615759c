//! Changes that the judge lets pass, at some control periods at least, with the reason.

/// By name: why the record is lawful where the change passes.
pub const REASONS: &[(&str, &str)] = &[
    (
        "positions: a robot of the active team is shifted by 10⁻⁴",
        "a moving robot may be anywhere in its trust region; with links of R = 1 nothing else changes",
    ),
    (
        "the outcome is “interrupted”",
        "a run may be interrupted after the last task is serviced, while robots come to rest",
    ),
    ("phase: it is that of the period before", "observers may receive a step of the mission late"),
    ("phase: it is the next one", "robots may be on Σ before the event that reports it"),
    ("task: none is pursued", "observers may receive the announcement late"),
    ("active team: it is emptied", "observers may receive late that the team is active"),
    (
        "active team: the last is dropped",
        "the team has one member; observers may receive late that it is active",
    ),
    ("multipliers: one is shifted by 0.1", ITERATE),
    ("multipliers: two are swapped", ITERATE),
    (
        "routes: a share is shifted by 10⁻³, and the residual with it",
        "a robot chooses how much of its spare time it sends",
    ),
    (
        "tree: the edge of a redundant robot is dropped",
        "a redundant robot without children may be without a parent",
    ),
    (
        "posts: one is dropped",
        "its holder was in the primary team lately, whose posts change when it forms or dissolves",
    ),
    ("posts: one is a junction", BRANCHES),
    ("active team: two teams at once", EARLY),
    ("path: the primary team is on it", EARLY),
    ("posts: a junction is none", BRANCHES),
    ("subgroup started: it is reported five periods later", "observers may receive the start late"),
    (
        "subgroup arrived: it is reported five periods later",
        "robots may act on an arrival before the event that reports it",
    ),
    ("reattached: it is dropped", SHOWN),
    ("reattached: it is reported twice", SHOWN),
    ("reattached: it is reported five periods later", SHOWN),
    ("false: p₁ attaches to the node that it is attached to", SHOWN),
];

const BRANCHES: &str =
    "junctions are compared only while no subgroup moves and no recent event is still spreading";
const EARLY: &str =
    "robots may be on Σ before it is reported, while a recruit is called to release the leader";
const ITERATE: &str = "λ is the state of an iteration; properties constrain only its sign";
const SHOWN: &str = "the tree already shows the parent of a robot";

/// Why a change may pass, if it may.
pub fn reason(name: &str) -> Option<&'static str> {
    REASONS.iter().find(|(lawful, _)| *lawful == name).map(|(_, reason)| *reason)
}
