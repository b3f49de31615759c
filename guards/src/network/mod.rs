//! The guards of the robot network, over the facts that a robot measures of itself.
//!
//! Yes-or-no facts are 0 or 1, so `is(fact)` is `fact ≥ 1`. The guards of the role automaton
//! exclude one another; those of the mission automaton are ordered by its table.

use crate::{Guard, Predicate, variable};

fn is(fact: &str) -> Predicate {
    variable(fact).at_least(1.0)
}

fn is_not(fact: &str) -> Predicate {
    variable(fact).less_than(1.0)
}

/// The guards of the role automaton (Algorithm 4, Remark 5.6).
pub mod role {
    use super::{Guard, is, is_not};
    use crate::variable;

    /// It heads the network's effort.
    pub fn elected() -> Guard {
        Guard::new("elected", is("leads"))
    }

    /// It is the recruit on its way, and what it held before is held by another.
    pub fn recruited() -> Guard {
        Guard::new("recruited", is_not("leads").and(is("recruited")).and(is("replaced")))
    }

    /// It services a task.
    pub fn entrusted() -> Guard {
        Guard::new("entrusted", is_not("leads").and(is_not("recruited")).and(is("serves")))
    }

    /// Several branches part from its fixed post.
    pub fn parted() -> Guard {
        let post = is("fixed").and(is_not("serves")).and(variable("branches").at_least(2.0));
        Guard::new("parted", is_not("leads").and(is_not("recruited")).and(post))
    }

    /// It holds a fixed post on one branch.
    pub fn posted() -> Guard {
        let post = is("fixed").and(is_not("serves")).and(variable("branches").less_than(2.0));
        Guard::new("posted", is_not("leads").and(is_not("recruited")).and(post))
    }

    /// It moves with a team, and what it held before is held by another.
    pub fn relieved() -> Guard {
        let way = is("underway").and(is("replaced"));
        Guard::new("relieved", is_not("leads").and(is_not("recruited")).and(way))
    }

    /// Nothing depends on it.
    pub fn retired() -> Guard {
        Guard::new("retired", is_not("leads").and(is_not("recruited")).and(is("free")))
    }
}

/// The guards of the mission automaton (Algorithms 1, 3 and 5).
pub mod mission {
    use super::{Guard, is, is_not};
    use crate::{Predicate, variable};

    /// A step that a robot takes only while it is not exchanging duties: what two robots have
    /// offered each other stays as it is until both have taken it.
    fn disengaged(name: &'static str, predicate: Predicate) -> Guard {
        Guard::new(name, predicate.and(is_not("engaged")))
    }

    /// The mission is said to have ended.
    pub fn ended() -> Guard {
        disengaged("ended", is("end_announced"))
    }

    /// A task is announced.
    pub fn announced() -> Guard {
        disengaged("announced", is("announced"))
    }

    /// Every token is known: line 1 of Algorithm 1.
    pub fn elected() -> Guard {
        disengaged("elected", is("election_over"))
    }

    /// The elected leader has past duties: L_b = 1.
    pub fn bound() -> Guard {
        disengaged("bound", is("bound"))
    }

    /// A local stationary point (Sec. V-A2): the whole primary team has stood still for a while,
    /// and every link is at its limit or every robot bunched behind the next.
    pub fn trapped() -> Guard {
        let at_rest = variable("still").at_least(variable("window"));
        let stuck = is_not("slack").and(is_not("pending"));
        disengaged("trapped", is("first").and(at_rest).and(stuck).and(is_not("bound")))
    }

    /// The team, or a robot on Σ, has not moved for long, and no recruit could help.
    pub fn blocked() -> Guard {
        Guard::new("blocked", variable("stalled").at_least(variable("patience")))
    }

    /// A recruit is called for.
    pub fn called() -> Guard {
        disengaged("called", is("called"))
    }

    /// This robot won the recruit election.
    pub fn recruited() -> Guard {
        disengaged("recruited", is("won"))
    }

    /// This robot called, and no recruit can come.
    pub fn unaided() -> Guard {
        Guard::new("unaided", is("unaided"))
    }

    /// The path Σ is announced.
    pub fn path_heard() -> Guard {
        disengaged("path heard", is("path_announced"))
    }

    /// Every place of Σ has said whether it is a break point.
    pub fn points_agreed() -> Guard {
        Guard::new("points agreed", is("points_agreed"))
    }

    /// Every member of the active subgroup has arrived, eq. (26).
    pub fn subgroup_arrived() -> Guard {
        disengaged("subgroup arrived", is("subgroup_arrived"))
    }

    /// Another robot holds the post of the last robot that Σ relieves.
    pub fn relieved() -> Guard {
        disengaged("relieved", is("relieved"))
    }

    /// The primary team is said to be the active team.
    pub fn resumed() -> Guard {
        disengaged("resumed", is("resumed"))
    }

    /// The leader is near enough to its task, eq. (2): near enough for a replacer behind it to
    /// service it as well or, where it cannot get as near as that although its link is slack,
    /// within δ.
    pub fn reached() -> Guard {
        let near = variable("distance").at_most(variable("reach"));
        let stuck = variable("still").at_least(variable("window"));
        let within = variable("distance").at_most(variable("radius")).and(stuck).and(is("slack"));
        disengaged("reached", is("leads").and(is_not("bound")).and(near.or(within)))
    }

    /// The task is said to be serviced.
    pub fn serviced() -> Guard {
        disengaged("serviced", is("service_announced"))
    }
}
