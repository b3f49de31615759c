//! The guards of the mission automaton (Algorithms 1, 3 and 5).

use pleach_guards::{Guard, Predicate, proposition, variable};

/// A step that may change the duty, which a robot takes only while it is not exchanging duties: what two robots
/// have offered each other stays as it is until both have taken it.
fn disengaged(name: &'static str, predicate: Predicate) -> Guard {
    Guard::new(name, predicate.and(!proposition("engaged")))
}

/// The newest notice says that the mission has ended.
pub(crate) fn ended() -> Guard {
    disengaged("ended", proposition("end_announced"))
}

/// A task is announced.
pub(crate) fn announced() -> Guard {
    disengaged("announced", proposition("announced"))
}

/// Its task has been announced again, and the mission has gone on without it.
pub(crate) fn overtaken() -> Guard {
    disengaged("overtaken", proposition("overtaken"))
}

/// The robots that it hears go by an announcement that it has not received.
pub(crate) fn informed() -> Guard {
    disengaged("informed", proposition("announcement_heard"))
}

/// Every token is known: line 1 of Algorithm 1.
pub(crate) fn elected() -> Guard {
    disengaged("elected", proposition("election_over"))
}

/// The elected leader has past duties, L_b = 1, and cannot service its task from its post. It calls once nodes that
/// the last task has left without a branch have had time to become redundant: they can come then.
pub(crate) fn bound() -> Guard {
    let free_to_call = !proposition("tree_settles") & !proposition("posted_near");
    disengaged("bound", proposition("bound") & free_to_call & !proposition("may_leave_post"))
}

/// Nothing has depended on the post of the elected leader for as long as it takes to give such posts up, or the post
/// moves with it; and it cannot service its task from there.
pub(crate) fn unbound() -> Guard {
    let leads_on = !proposition("tree_settles") & !proposition("posted_near");
    disengaged("unbound", proposition("bound") & proposition("may_leave_post") & leads_on)
}

/// A local stationary point (Sec. V-A2): the whole primary team has stood still for a while,
/// and every link is at its limit or every robot bunched behind the next.
pub(crate) fn trapped() -> Guard {
    let at_rest = variable("still").at_least(variable("window"));
    let stuck = !proposition("slack") & !proposition("pending");
    disengaged("trapped", proposition("first").and(at_rest).and(stuck).and(!proposition("bound")))
}

/// A recruit will be needed: more links than the team has lead from the parent of p₁ to the task.
/// Where recruits are called for ahead of a standstill, that is enough, once p₁ hears no node nearer to
/// the task that it might attach to, the redundant robots that were attached to it have left it, and unless
/// such a call has been in vain.
pub(crate) fn foreseen() -> Guard {
    let needed = variable("links_left").more_than(variable("members"));
    let ready = !proposition("pending")
        & !proposition("bears_leavers")
        & !proposition("hears_nearer_parent");
    let eager = proposition("eager") & !proposition("in_vain");
    let first = proposition("first") & !proposition("bound");
    disengaged("foreseen", first.and(needed).and(ready).and(eager))
}

/// The team, or a robot on Σ, has not moved for long, and no recruit could help.
pub(crate) fn blocked() -> Guard {
    Guard::new("blocked", variable("stalled").at_least(variable("patience")))
}

/// A recruit is called for.
pub(crate) fn called() -> Guard {
    disengaged("called", proposition("called"))
}

/// The next recruit is called for, and the robot has not heard before that the last one has joined.
pub(crate) fn called_again() -> Guard {
    disengaged("called again", proposition("called") & proposition("eager"))
}

/// This robot won the recruit election.
pub(crate) fn recruited() -> Guard {
    disengaged("recruited", proposition("won"))
}

/// This robot called, and no recruit can come.
pub(crate) fn unaided() -> Guard {
    Guard::new("unaided", proposition("unaided"))
}

/// The path Σ is announced.
pub(crate) fn path_heard() -> Guard {
    disengaged("path heard", proposition("path_announced"))
}

/// Every place of Σ has voted whether it is a break point.
pub(crate) fn points_agreed() -> Guard {
    Guard::new("points agreed", proposition("points_agreed"))
}

/// Every member of the active subgroup has arrived, eq. (26).
pub(crate) fn subgroup_arrived() -> Guard {
    disengaged("subgroup arrived", proposition("subgroup_arrived"))
}

/// Another robot holds the post of the last robot that Σ relieves.
pub(crate) fn relieved() -> Guard {
    disengaged("relieved", proposition("relieved"))
}

/// The newest notice says that the primary team is the active team.
pub(crate) fn resumed() -> Guard {
    disengaged("resumed", proposition("resumed"))
}

/// The leader is near enough to its task, eq. (2): near enough for a replacer behind it to
/// service it as well or, where it cannot get as near as that although its link is slack, or no robot is left
/// that could come, within δ. A leader with past duties keeps its post, and services its task from there if
/// it can.
pub(crate) fn reached() -> Guard {
    let near = variable("distance").at_most(variable("reach"));
    let stuck = variable("still").at_least(variable("window"));
    let within =
        variable("distance").at_most(variable("radius")).and(stuck).and(proposition("slack"));
    let free = proposition("leads").and(!proposition("bound")).and(near.or(within));
    disengaged("reached", free.or(proposition("posted_near")))
}

/// The newest notice says that the task is serviced.
pub(crate) fn serviced() -> Guard {
    disengaged("serviced", proposition("service_announced"))
}

/// The newest notice has superseded that of the service, which was issued at the same time.
pub(crate) fn repeated() -> Guard {
    disengaged("repeated", proposition("service_unheard"))
}
