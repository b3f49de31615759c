//! The guards of the service of a user's tasks: of access points and of the user.

use pleach_guards::{Guard, Predicate, proposition, variable};

fn named(name: &str, predicate: Predicate) -> Guard {
    Guard::new(name, predicate)
}

/// It hears of an election that it does not know.
pub(crate) fn election_heard() -> Guard {
    named("election heard", proposition("hears_election"))
}

/// It hears that a path Σ is announced, or that the primary team advances.
pub(crate) fn progress_heard() -> Guard {
    named("progress heard", proposition("hears_progress"))
}

/// It hears that the task is serviced, or has been taken back.
pub(crate) fn service_heard() -> Guard {
    named("service heard", proposition("hears_service"))
}

/// It hears that the mission has ended, has nobody else to ask, and does not go on with other tasks.
pub(crate) fn end_heard() -> Guard {
    let goes_on = may_ask_others() | can_skip();
    let may_go_on = pursues() & proposition("hears_failure") & goes_on;
    named("end heard", proposition("hears_end") & !may_go_on)
}

/// The robots have given up the task that is pursued, there is nobody else to ask, and others may be serviced.
pub(crate) fn gives_up() -> Guard {
    named("gives up", may_skip() & is_abandoned())
}

/// So it is while the election is under way, or nobody bids in it, or it goes unanswered.
pub(crate) fn gives_up_election() -> Guard {
    named("gives up", may_skip() & (is_abandoned() | finds_no_bid() | finds_no_answer()))
}

fn may_skip() -> Predicate {
    pursues() & can_skip()
}

/// Tasks are given up one by one, and no secondary team is on its way: each of its robots is at the post that it holds.
fn can_skip() -> Predicate {
    proposition("skips_tasks") & !proposition("path_announced")
}

fn is_abandoned() -> Predicate {
    proposition("hears_failure") & !may_ask_others()
}

/// The robots that take part now are not those of the elections for its task, or may not be in a while; or it is given up
/// for lack of robots, and some are free that were not, or will be.
fn may_ask_others() -> Predicate {
    let may_be_freed = proposition("hears_want") & may_free_robots();
    proposition("misses_robot") | proposition("has_newcomers") | may_come() | may_be_freed
}

/// Robots have become free since it announced its task, or will.
fn may_free_robots() -> Predicate {
    proposition("awaits_end") | proposition("has_freed")
}

/// It is given up for lack of robots, and those that were not free are.
fn may_ask_freed() -> Predicate {
    let wants_robots = proposition("hears_failure") & proposition("hears_want");
    wants_robots & proposition("has_freed") & !proposition("awaits_retirements")
}

/// Robots may take part in a while that do not now.
fn may_come() -> Predicate {
    proposition("awaits_robots") | proposition("may_return")
}

/// Robots have gathered: their roster has not changed for a while.
fn settled() -> Predicate {
    variable("settled").at_least(variable("settling"))
}

fn first(name: &str, predicate: Predicate) -> Guard {
    named(name, proposition("asked") & settled() & predicate)
}

fn next(name: &str, predicate: Predicate) -> Guard {
    named(name, proposition("asked") & predicate)
}

fn can_announce() -> Predicate {
    proposition("task_left") & has_robots()
}

fn lacks_robots() -> Predicate {
    proposition("task_left") & !has_robots() & !may_come()
}

/// Robots have gathered, and there is a task.
pub(crate) fn announces_first() -> Guard {
    first("announces", can_announce())
}

/// There is another task.
pub(crate) fn announces_next() -> Guard {
    next("announces", can_announce())
}

/// There is a task, and no robot is connected.
pub(crate) fn no_robot_first() -> Guard {
    first("no robot", lacks_robots())
}

/// There is another task, and no robot is connected.
pub(crate) fn no_robot_next() -> Guard {
    next("no robot", lacks_robots())
}

/// There is no task at all.
pub(crate) fn nothing_to_service() -> Guard {
    first("all serviced", nothing_left())
}

/// There is no other task, and those that are serviced have been heard of: no robot that services one has
/// stopped meanwhile.
pub(crate) fn all_serviced() -> Guard {
    next("all serviced", nothing_left() & !proposition("awaits_services"))
}

/// No task is to be announced, none will be asked for, and none is serviced that is to end.
fn nothing_left() -> Predicate {
    !proposition("task_left") & !proposition("task_to_come")
}

/// The task that is pursued has been taken back, and no secondary team is on its way: each of its robots is at
/// the post that it holds.
pub(crate) fn withdraws() -> Guard {
    let in_vain = proposition("pursues_withdrawn") & !proposition("path_announced");
    named("withdraws", pursues() & in_vain)
}

/// A task that is not pursued has been taken back, or has lasted as long as it should.
pub(crate) fn closes() -> Guard {
    next("closes", proposition("task_over"))
}

/// The leader election is over, no robot has bid, and there is nobody else to ask.
pub(crate) fn no_bid() -> Guard {
    named("no bid", pursues() & finds_no_bid() & !proposition("skips_tasks"))
}

fn finds_no_bid() -> Predicate {
    lacks_bid() & !may_ask_others() & !may_find_ways()
}

/// Robots that could not bid for lack of a way to an access point know one now, or may in a while.
fn may_find_ways() -> Predicate {
    variable("waited").less_than(variable("longest_search")) | has_found_way()
}

/// A robot that could not bid for lack of a way to an access point knows one now, and is asked again.
fn has_found_way() -> Predicate {
    proposition("has_found_way") & another_time()
}

fn another_time() -> Predicate {
    variable("unanswered").less_than(variable("attempts"))
}

fn lacks_bid() -> Predicate {
    proposition("election_over") & proposition("leader_wanted") & !proposition("has_bid")
}

/// The election lasts longer than news can take, all who take part have been heard of, and so it has
/// been each time.
pub(crate) fn no_answer() -> Guard {
    named("no answer", pursues() & finds_no_answer() & !proposition("skips_tasks"))
}

fn finds_no_answer() -> Predicate {
    let each_time = variable("unanswered").at_least(variable("attempts"));
    goes_unanswered() & each_time & !proposition("hears_failure")
}

/// A robot that takes part in the elections for the task is gone, and others are left; or they have given the
/// task up, and others take part now.
pub(crate) fn announces_again() -> Guard {
    let others = proposition("hears_failure") & proposition("has_newcomers") | may_ask_freed();
    let again = proposition("misses_robot") | others;
    named("announces again", pursues() & again & has_robots())
}

/// So it is while the election is under way, or nobody bids in it that could go, or it goes unanswered.
pub(crate) fn elects_again() -> Guard {
    let unanswered = goes_unanswered() & another_time();
    let in_vain = proposition("hears_failure") | lacks_bid();
    let others = in_vain & proposition("has_newcomers") | lacks_bid() & has_found_way();
    let again = proposition("misses_robot") | others | may_ask_freed() | unanswered;
    named("announces again", pursues() & again & has_robots())
}

/// All robots that took part are gone.
pub(crate) fn no_robot_left() -> Guard {
    let all_gone = !has_robots() & !proposition("may_return");
    named("no robot left", pursues() & proposition("misses_robot") & all_gone)
}

fn has_robots() -> Predicate {
    variable("robots").at_least(1.0)
}

/// The election lasts longer than news can take, although all who take part have been heard of.
fn goes_unanswered() -> Predicate {
    let overdue = variable("waited").more_than(variable("longest_wait"));
    let all_heard = !proposition("expects_elector") & !proposition("misses_robot");
    // Those who have given up for lack of robots answer no more.
    let have_given_up = proposition("wants_robots") & may_free_robots();
    !proposition("election_over") & overdue & all_heard & !have_given_up
}

/// A task is pursued, and those are known who take part in its elections.
fn pursues() -> Predicate {
    proposition("asked") & proposition("knows_electors")
}

/// The first control period begins.
pub(crate) fn prepared() -> Guard {
    named("prepared", period_over())
}

/// A control period is over.
pub(crate) fn another_period() -> Guard {
    named("period over", period_over())
}

/// A control period is over, and the first access point has been silent for longer than robots move
/// without it.
pub(crate) fn access_point_missed() -> Guard {
    let missed = variable("silence").at_least(variable("patience"));
    named("access point missed", period_over() & missed)
}

fn period_over() -> Predicate {
    variable("clock").at_least(variable("period"))
}

/// The first access point has announced a task.
pub(crate) fn answer_heard() -> Guard {
    named("answer heard", proposition("hears_answer") & !proposition("hears_end"))
}

/// The newest notice says that the mission has ended.
pub(crate) fn request_over() -> Guard {
    named("end heard", proposition("hears_end"))
}
