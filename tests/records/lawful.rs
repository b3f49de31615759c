//! Changes that the judge lets pass, at some control periods at least, with the reason.

/// By name: why the record is lawful where the change passes.
pub const REASONS: &[(&str, &str)] = &[
    (
        "positions: a robot of the active team is shifted by 10⁻⁴",
        "a robot that moves may be anywhere in its trust region; where its links have R = 1, nothing \
         else depends on so little",
    ),
    (
        "the outcome is “interrupted”",
        "a run may be interrupted after the last task is serviced, while robots come to rest",
    ),
    ("phase: it is that of the period before", "observers may receive a step of the mission late"),
    ("phase: it is the next one", "robots may be on Σ before the event that reports its path"),
    (
        "task: none is pursued",
        "it has been announced a few periods before, and observers may receive it late",
    ),
    (
        "active team: it is emptied",
        "the team has become the active one a few periods before, and observers may receive it late",
    ),
    (
        "active team: the last is dropped",
        "this empties a team of one, and observers may receive late that it is the active one",
    ),
    ("multipliers: one is shifted by 0.1", ITERATE),
    ("multipliers: two are swapped", ITERATE),
    (
        "routes: a share is shifted by 10⁻³, and the residual with it",
        "how much of the time left over a robot sends is its own choice",
    ),
    (
        "tree: the edge of a redundant robot is dropped",
        "a redundant robot to which no other is attached may be without a parent",
    ),
    (
        "posts: one is dropped",
        "its holder has been of the primary team a few periods before, whose posts change when it is set up or dissolved",
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

const BRANCHES: &str = "where branches part is compared only while no subgroup is under way and no event \
                        was so recent that its news may be under way";
const EARLY: &str = "a path Σ may be seen before it is reported, while a recruit is called for that is to release the leader";
const ITERATE: &str =
    "λ is what a robot's iteration has come to; no property speaks of it but its sign";
const SHOWN: &str =
    "the tree shows which node a robot is attached to; the event adds nothing to it";

/// Why a change may pass, if it may.
pub fn reason(name: &str) -> Option<&'static str> {
    REASONS.iter().find(|(lawful, _)| *lawful == name).map(|(_, reason)| *reason)
}
