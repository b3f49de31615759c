//! The duty automaton: what each transition of [`DUTIES`] carries over, and when (Algorithms 3
//! and 4, Remark 5.6).
//!
//! Resets are functions from the data of one duty to that of the next. They read the robot as it
//! was before the jump and change nothing; any other effect of a jump is a [`DutyEffect`].

use std::sync::Arc;

use pleach_discrete::network::{
    Activity, Anchor, DUTIES, DutyEvent, MissionStep, NodeId, Phase, Post, PostId, PostKind, Role,
};
use pleach_discrete::{Event as _, Location as _, Superstate};
use pleach_guards::{EvaluationError, Guard};

use crate::located::{Current, DataOf, Holds, Place as _};
use crate::network::guards::duty as guards;
use crate::{Automaton, BuildError, Jump, Transfer, TransitionError};

use super::Robot;
use super::hearing::Neighbour;
use super::target::targets;
use crate::network::beacon::Notice;
use crate::network::duty::{
    AwaitingRelease, Bound, Duty, Following, Held, Holder, Hop, Junction, Leading, Leaf, Relay,
    Shifting, Standby, Station, Waiting,
};
use crate::network::mission::Walk;
use crate::network::record::MissionEvent;

/// The automaton of a robot's duty.
pub type DutyAutomaton = Automaton<Activity, DutyEvent, Robot>;

/// What the duty automaton jumps together with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Label {
    /// Nothing: it jumps by itself.
    #[default]
    Alone,
    /// A step of the mission automaton.
    Mission(MissionStep),
    /// The exchange of duties: the duty that the robot takes over, from this partner.
    Exchange(Duty, NodeId),
}

/// The effects of a transition other than another duty.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DutyEffect {
    /// The robot reports to observers.
    Report(MissionEvent),
    /// Its stillness is counted from 0: it begins another path.
    Restart,
    /// It was given its duty by this partner, and its place in the tree is another.
    Exchanged(NodeId),
}

type Effects = Vec<DutyEffect>;

impl Holds<Duty> for Robot {
    type Effects = Effects;

    fn current(&self) -> &Current<Duty> {
        self.duty.current()
    }

    fn current_mut(&mut self) -> &mut Current<Duty> {
        self.duty.current_mut()
    }

    fn carry_out(&mut self, effects: Effects) {
        self.tree.begin_duty();
        self.duty.has_jumped();
        for effect in effects {
            match effect {
                DutyEffect::Report(event) => self.report(event),
                DutyEffect::Restart => self.body.count_still_periods_anew(),
                DutyEffect::Exchanged(partner) => {
                    let progress = self.progress();
                    self.exchanges.conclude(partner, progress);
                    self.tree.displace(true);
                }
            }
        }
    }
}

impl Robot {
    /// Takes at most one transition of the duty automaton, together with what `label` stands for.
    pub(super) fn jump_duty(
        &mut self,
        label: Label,
    ) -> Result<Option<Jump<Activity, DutyEvent>>, TransitionError> {
        let site = Arc::clone(&self.site);
        self.duty.jump_with(label);
        let held = self.duty.post().map(|post| post.id);
        let jump = site.automata.duty.step_in_place::<Duty>(self);
        self.duty.jump_with(Label::Alone);
        if matches!(jump, Ok(Some(_))) {
            self.changes.allow_jump();
            self.note_change();
            if self.duty.post().is_some_and(|post| Some(post.id) != held) {
                // Who held the post before may be one control period ahead.
                let period = self.schedule.newest_period();
                self.tree.take_over_confirmation(period);
            }
            if self.duty.post().is_some_and(|post| post.id == self.new_post().id) {
                self.duty.make_posts(1);
            }
            self.look_after_place()?;
        }
        jump
    }

    /// Takes over the duty of `partner` (Algorithm 4 without the walk).
    pub(super) fn exchange_duty(
        &mut self,
        duty: Duty,
        partner: NodeId,
    ) -> Result<(), TransitionError> {
        let role = self.role();
        let location = self.duty.location().name();
        let taken = self.jump_duty(Label::Exchange(duty, partner))?;
        self.report_role_after(role);
        match taken {
            Some(_) => Ok(()),
            // Half an exchange would leave one duty to two robots, or to none.
            None => Err(TransitionError {
                location,
                event: duty.location().taken_over().name(),
                part: "table".into(),
                source: EvaluationError::MissingData { location: duty.location().name() },
            }),
        }
    }

    /// Reports to observers if the role is no longer `before`.
    pub(super) fn report_role_after(&mut self, before: Role) {
        let now = self.role();
        if now != before {
            self.report(MissionEvent::RoleChanged { robot: self.id, from: before, to: now });
        }
    }

    // ---- What the guards ask -------------------------------------------------------------------

    pub(super) fn takes_step(&self, step: MissionStep) -> bool {
        self.duty.label() == Label::Mission(step)
    }

    /// Whether it takes over a duty of this kind.
    pub(super) fn takes_over(&self, activity: Activity) -> bool {
        matches!(self.duty.label(), Label::Exchange(duty, _) if duty.location() == activity)
    }

    /// Whether it has won the leader election that is over now.
    pub(super) fn wins_now(&self) -> bool {
        self.takes_step(MissionStep::Elected) && self.winner() == Some(self.id)
    }

    /// Whether it has past duties: a fixed post, or robots attached to it that find no other parent.
    pub(super) fn has_past_duties(&self) -> bool {
        !self.duty.is_redundant() || self.children().any(|child| !child.beacon.can_detach)
    }

    /// Whether it leads alone, and a fixed post has been attached to its own: by a robot that had lost its parent,
    /// and had not heard yet that this one is elected.
    pub(super) fn is_burdened(&self) -> bool {
        let bears_fixed = || self.children().filter_map(Neighbour::post).any(Post::is_fixed);
        let leads_alone = matches!(*self.duty, Duty::Leading(_)) && self.is_first();
        leads_alone && bears_fixed() && !self.takes_post_along()
    }

    /// Whether the task that is serviced from its post is over.
    pub(super) fn services_closed_task(&self) -> bool {
        let task = self.duty.post().and_then(|post| post.task);
        task.is_some_and(|task| self.mission.notices().closed().contains(task))
    }

    /// Whether the path Σ that it learns of now passes its post, before or at the last break point.
    pub(super) fn is_on_coming_path(&self) -> bool {
        self.coming_place().is_some()
    }

    fn coming_place(&self) -> Option<usize> {
        let own = self.duty.post()?.id;
        match self.duty.label() {
            Label::Mission(MissionStep::Recruited) => Some(0),
            Label::Mission(MissionStep::PathHeard) => {
                let Notice::Path(path) = self.notice() else { return None };
                let place = path.place_of(own)?;
                (place <= path.last_break_point()).then_some(place)
            }
            _ => None,
        }
    }

    /// Whether Σ is no longer of use.
    pub(super) fn is_called_off(&self) -> bool {
        use MissionStep::{Called, Resumed};
        self.is_dissolved() || self.takes_step(Called) || self.takes_step(Resumed)
    }

    /// Whether Σ is given up before all of its subgroups have arrived. The end of the mission does not give it up: a
    /// robot on its way stays on Σ, and answers for the post that it left, unless the mission goes on.
    fn gives_path_up(&self) -> bool {
        self.is_superseded() || self.takes_step(MissionStep::Serviced)
    }

    /// Whether another task is announced, or its own again.
    pub(super) fn is_superseded(&self) -> bool {
        self.takes_step(MissionStep::Announced) || self.takes_step(MissionStep::Overtaken)
    }

    /// Whether a leader is bound to its post no more: another task is announced, or its own again; or the mission is
    /// given up, and tasks have ended, so that it may go on once their robots are free.
    pub(super) fn is_unbound(&self) -> bool {
        let has_ended = self.phase() == Phase::Ended || self.ends_now();
        self.is_superseded() || has_ended && !self.mission.notices().closed().is_empty()
    }

    /// Whether the primary team is dissolved.
    pub(super) fn is_dissolved(&self) -> bool {
        self.gives_path_up() || self.ends_now()
    }

    /// Whether it learns now that the mission has ended, or ends it.
    fn ends_now(&self) -> bool {
        self.takes_step(MissionStep::Ended) || self.takes_step(MissionStep::Blocked)
    }

    /// Whether it takes the post ahead now: its subgroup has arrived, or the mission goes on.
    pub(super) fn takes_post_ahead(&self) -> bool {
        let in_active_subgroup = || {
            let active = self.active_subgroup();
            self.duty
                .place()
                .is_some_and(|place| active.is_some_and(|active| active.places().contains(&place)))
        };
        matches!(*self.duty, Duty::Shifting(_))
            && self.mission.walk().is_some()
            && (self.takes_step(MissionStep::SubgroupArrived) && in_active_subgroup()
                || self.takes_step(MissionStep::Resumed)
                || self.takes_step(MissionStep::Called)
                || self.gives_path_up())
    }

    /// The post that a robot on its way along Σ takes next, and where that is: the one ahead or, where Σ is given
    /// up before all of its subgroup have arrived, the one that it left.
    ///
    /// The robot behind takes the post that this one left only if this one has reported that it has
    /// arrived. Until then it goes back to it, as links are made for robots at their posts; from then on it
    /// may not.
    pub(super) fn coming_station(&self) -> Option<Station> {
        let Duty::Shifting(Shifting { place, left }) = *self.duty else { return None };
        if !self.gives_path_up() {
            return self.next_hop().map(|hop| self.station_at(hop));
        }
        let Walk { path, active } = self.mission.walk()?;
        let hops = &path.hops;
        let is_taken = left.is_some() && active.is_none_or(|active| active.first == place);
        match self.has_reported(place) {
            false if !is_taken => hops.get(place).map(|hop| match hop.post.is_redundant() {
                true => self.station_here(self.detached_if_far(hop.post)),
                false => Station { post: hop.post, reference: hop.place.reference },
            }),
            true if self.has_reported(place + 1) || self.has_given_up(place + 1) => {
                hops.get(place + 1).map(|hop| self.station_at(hop))
            }
            _ => Some(self.station_here(self.new_post())),
        }
    }

    /// The post of that station.
    pub(super) fn coming_post(&self) -> Option<Post> {
        self.coming_station().map(|station| station.post)
    }

    /// The post of this place of Σ, to which it has come. A robot that queues behind the next member makes
    /// its place where it stands.
    fn station_at(&self, hop: &Hop) -> Station {
        let reference = hop.place.reference;
        match (self.body.position() - reference).norm() <= self.site.settings.arrival_radius() {
            true => Station { post: hop.post, reference },
            false => self.station_here(hop.post),
        }
    }

    /// A post where it stands.
    fn station_here(&self, post: Post) -> Station {
        Station { post, reference: self.free_place() }
    }

    /// This post, which it takes again. A redundant one is attached to nothing where the robot has gone out of
    /// reach of its parent.
    fn detached_if_far(&self, post: Post) -> Post {
        let is_far = post.is_redundant() && !self.reaches_parent(post.parent);
        if is_far { Post { parent: None, ..post } } else { post }
    }

    /// Whether its turn on Σ has come: its subgroup is the active team, and its post is held by
    /// the robot behind unless the whole subgroup sets out, or it is the recruit.
    pub(super) fn may_set_out(&self) -> bool {
        let Duty::Waiting(Waiting { held, place, .. }) = *self.duty else { return false };
        self.active_subgroup().is_some_and(|active| {
            active.places().contains(&place)
                && (place == 0 || place > active.first || self.is_relieved_of(held.station.post.id))
        })
    }

    /// Whether it joins a mission under way: its first post may be that of another robot by now.
    pub(super) fn joins_late(&self) -> bool {
        self.duty.label() == Label::Alone && self.duty.is_late()
    }

    /// Whether it waits on Σ, and has given its post up to the robot behind.
    pub(super) fn is_superfluous(&self) -> bool {
        self.waiting_place().is_some_and(|place| self.has_given_up(place))
    }

    /// Whether another parent has been found to be better.
    pub(super) fn finds_better_parent(&self) -> bool {
        self.tree.desired_parent().is_some_and(|desired| desired != self.anchor())
    }
}

// ---- The resets: from the data of one duty to that of the next -------------------------------

fn with_kind(held: Held, kind: PostKind) -> Held {
    let post = Post { kind, ..held.station.post };
    Held { station: Station { post, ..held.station }, ..held }
}

fn lead(standby: &Standby, _: &Robot, effects: &mut Effects) -> Leading {
    effects.push(DutyEffect::Restart);
    Leading(with_kind(standby.0, PostKind::Primary { follows: None }))
}

/// Where something depends on a redundant robot, its post is one of the tree from now on.
fn bind(duty: &Duty, _: &Robot, effects: &mut Effects) -> Option<Bound> {
    effects.push(DutyEffect::Restart);
    Some(Bound(with_kind(*duty.held()?, PostKind::Fixed)))
}

/// Its own post joins the tree again.
fn bind_again(leading: &Leading, robot: &Robot, effects: &mut Effects) -> Option<Bound> {
    bind(&leading.into_place(), robot, effects)
}

/// The same post as before, held in another way.
fn keep<A: Holder, B: From<Held>>(duty: &A, _: &Robot, _: &mut Effects) -> B {
    B::from(*duty.held())
}

fn join_path(duty: &Duty, robot: &Robot, _: &mut Effects) -> Option<Waiting> {
    let place = robot.coming_place().unwrap_or_default();
    Some(Waiting { held: *duty.held()?, place, role: duty.role() })
}

fn await_release(bound: &Bound, robot: &Robot, _: &mut Effects) -> AwaitingRelease {
    AwaitingRelease { held: bound.0, place: robot.coming_place().unwrap_or_default() }
}

fn leave_path<B: From<Held>>(waiting: &Waiting, _: &Robot, effects: &mut Effects) -> B {
    effects.push(DutyEffect::Restart);
    B::from(waiting.held)
}

fn stand_by(waiting: &Waiting, robot: &Robot, effects: &mut Effects) -> Standby {
    match robot.is_superfluous() {
        true => leave_post(waiting, robot, effects),
        false => leave_path(waiting, robot, effects),
    }
}

/// A new post where the robot stands: the one before is left to the robot that holds it.
fn leave_post<A>(_: &A, robot: &Robot, effects: &mut Effects) -> Standby {
    effects.push(DutyEffect::Restart);
    let station = robot.station_here(robot.new_post());
    Standby(Held { station, left: robot.duty.post().map(|post| post.id) })
}

fn stop_awaiting<B: From<Held>>(waiting: &AwaitingRelease, _: &Robot, effects: &mut Effects) -> B {
    effects.push(DutyEffect::Restart);
    B::from(waiting.held)
}

/// The recruit's own place is given up; every other is taken over by the robot behind.
fn set_out(waiting: &Waiting, robot: &Robot, effects: &mut Effects) -> Shifting {
    let place = waiting.place;
    if let Some(active) = robot.active_subgroup().filter(|active| active.first == place) {
        let (subgroup, robots) = (robot.subgroups_done(), robot.robots_at(active));
        effects.push(DutyEffect::Report(MissionEvent::SubgroupStarted { subgroup, robots }));
    }
    effects.push(DutyEffect::Restart);
    Shifting { place, left: (place > 0).then_some(waiting.held.station.post.id) }
}

/// Eq. (26): the robot holds the post that it has come to, or another one if it turns back.
fn take_post_ahead<B: From<Held>>(
    shifting: &Shifting,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let station = robot.coming_station()?;
    if !robot.takes_step(MissionStep::SubgroupArrived) {
        effects.push(DutyEffect::Restart);
    } else if let Some(active) =
        robot.active_subgroup().filter(|active| active.first == shifting.place)
    {
        let (subgroup, robots) = (robot.subgroups_done(), robot.robots_at(active));
        effects.push(DutyEffect::Report(MissionEvent::SubgroupArrived { subgroup, robots }));
    }
    Some(B::from(Held { station, left: None }))
}

/// The post that the last robot of Σ gets in the primary team. Where the robot ahead is attached to the
/// post before, and no other robot takes that, the post itself joins the team.
fn team_post(held: &Held, robot: &Robot, follows: Option<PostId>) -> Held {
    let joins_at_once = robot.mission.shift().is_none_or(|shift| shift.subgroups.is_empty());
    let before = held.station.post;
    let parent = if joins_at_once { before.parent } else { Some(Anchor::Post(before.id)) };
    let id = match joins_at_once && before.is_fixed() {
        true => before.id,
        false => PostId((robot.site.robots as u32) + robot.mission.notices().bulletin().number()),
    };
    let post = Post { id, kind: PostKind::Primary { follows }, parent, task: None };
    let station = robot.station_here(post);
    Held { station, left: (!joins_at_once).then_some(before.id) }
}

fn join_team(waiting: &Waiting, robot: &Robot, effects: &mut Effects) -> Following {
    let event = MissionEvent::JoinedPrimary { robot: robot.id, team: Vec::new() };
    effects.extend([DutyEffect::Report(event), DutyEffect::Restart]);
    let follows = robot.mission.path().and_then(|path| path.hops.last()).map(|hop| hop.post.id);
    Following(team_post(&waiting.held, robot, follows))
}

fn release(waiting: &AwaitingRelease, robot: &Robot, effects: &mut Effects) -> Leading {
    let event = MissionEvent::Released { robot: robot.id };
    effects.extend([DutyEffect::Report(event), DutyEffect::Restart]);
    Leading(team_post(&waiting.held, robot, None))
}

/// Its post becomes that of the leader: nothing depends on it.
fn leave_unused_post(bound: &Bound, robot: &Robot, effects: &mut Effects) -> Leading {
    let event = MissionEvent::Released { robot: robot.id };
    effects.extend([DutyEffect::Report(event), DutyEffect::Restart]);
    Leading(with_kind(bound.0, PostKind::Primary { follows: None }))
}

fn settle(duty: &Duty, robot: &Robot, _: &mut Effects) -> Option<Relay> {
    Some(Relay(fixed_here(duty.held()?, robot)))
}

fn fixed_here(held: &Held, robot: &Robot) -> Held {
    let mut held = with_kind(*held, PostKind::Fixed);
    held.station.reference = robot.free_place();
    held
}

fn service(leading: &Leading, robot: &Robot, _: &mut Effects) -> Leaf {
    let mut held = fixed_here(&leading.0, robot);
    held.station.post.task = robot.current_task();
    Leaf(held)
}

/// It services its task from the post to which it is bound.
fn service_from_post(bound: &Bound, robot: &Robot, _: &mut Effects) -> Leaf {
    let Held { station, .. } = bound.0;
    let post = Post { task: robot.current_task(), ..station.post };
    Leaf(Held { station: Station { post, ..station }, ..bound.0 })
}

/// Its task is over: the post stays one of the tree as long as branches need it.
fn discharge(leaf: &Leaf, _: &Robot, _: &mut Effects) -> Relay {
    let mut held = leaf.0;
    held.station.post.task = None;
    Relay(held)
}

fn promote(standby: &Standby, _: &Robot, _: &mut Effects) -> Relay {
    Relay(with_kind(standby.0, PostKind::Fixed))
}

fn retire(relay: &Relay, _: &Robot, _: &mut Effects) -> Standby {
    Standby(with_kind(relay.0, PostKind::Redundant))
}

/// Another parent in the tree: for a redundant robot or p₁ (Remark 5.6), where the parent is gone, or where the way is
/// shorter without it.
fn attach<A: Holder + From<Held>>(duty: &A, robot: &Robot, effects: &mut Effects) -> A {
    let mut held = *duty.held();
    if let Some(desired) = robot.tree.desired_parent() {
        held.station.post.parent = desired;
    }
    if let Some(parent) = robot.tree.reattaches_to() {
        let event = MissionEvent::Reattached { robot: robot.id, parent };
        effects.extend([DutyEffect::Report(event), DutyEffect::Restart]);
    }
    A::from(held)
}

/// The duty of the partner of an exchange.
fn take_over<A, B: DataOf<Duty> + Copy>(_: &A, robot: &Robot, effects: &mut Effects) -> Option<B> {
    let Label::Exchange(duty, partner) = robot.duty.label() else { return None };
    let left = robot.duty.post().map(|post| post.id);
    effects.extend([DutyEffect::Exchanged(partner), DutyEffect::Restart]);
    B::of(&duty.taken_over(left)).copied()
}

// ---- The automaton ---------------------------------------------------------------------------

type Row = Transfer<Activity, DutyEvent, Robot>;

/// The robot takes over a duty of this kind from a partner, in exchange for its own.
fn exchange<B: DataOf<Duty> + Copy>(own: Superstate<Activity>) -> Row {
    let (activity, name) = (B::LOCATION, TAKE_OVER);
    let guard = guards::takes(activity.name());
    let take_over = take_over::<Duty, B>;
    Transfer::from_any_where_known(own, activity.taken_over(), guard, name, take_over)
}

/// The same for one kind of duty of its own.
fn exchange_of<A: DataOf<Duty>, B: DataOf<Duty> + Copy>() -> Row {
    let (activity, name) = (B::LOCATION, TAKE_OVER);
    let guard = guards::takes(activity.name());
    Transfer::where_known(activity.taken_over(), guard, name, take_over::<A, B>)
}

const TAKE_OVER: &str = "take over the partner's duty";

fn reached<B: DataOf<Duty> + From<Held>>(event: DutyEvent, guard: Guard) -> Row {
    Transfer::where_known(event, guard, "take the post ahead", take_post_ahead::<B>)
}

fn kept<B: DataOf<Duty> + From<Held>>(event: DutyEvent, guard: Guard) -> Row {
    Transfer::new(event, guard, "keep the post", leave_path::<B>)
}

fn attached<A: DataOf<Duty> + Holder + From<Held>>() -> Row {
    Transfer::new(
        DutyEvent::Attached,
        guards::attached(),
        "attach to the better parent",
        attach::<A>,
    )
}

/// What a jump takes place together with, a step of the mission or an exchange of duties, is one
/// thing at a time: the propositions about it exclude each other, and `step`, which says
/// something of several steps.
fn labels(step: &'static str) -> [&'static str; 16] {
    [
        step,
        "joins_late",
        "wins",
        "on_coming_path",
        "is_relieved",
        "reaches_task",
        "takes_standby",
        "takes_relay",
        "takes_junction",
        "takes_leaf",
        "takes_bound_leader",
        "takes_waiting_on_the_path",
        "takes_awaiting_release",
        "takes_shifting_along_the_path",
        "takes_following_the_team",
        "takes_leading_the_team",
    ]
}

/// The duty automaton (Algorithms 3 and 4, Remark 5.6).
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn duty_automaton() -> Result<DutyAutomaton, BuildError> {
    use DutyEvent as On;
    Automaton::builder(DUTIES, Activity::Standby)
        .observing()
        .commanding(&targets())
        .at_most_one(&labels("called_off"))
        .at_most_one(&labels("superseded"))
        .at_most_one(&labels("dissolved"))
        .at_most_one(&labels("takes_post_ahead"))
        .carried_out(Transfer::new(
            On::Joined,
            guards::joined(),
            "take a new post",
            leave_post::<Standby>,
        ))
        .carried_out(Transfer::new(On::Elected, guards::elected(), "lead", lead))
        .carried_out(Transfer::from_any_where_known(
            Activity::UNINVOLVED,
            On::Bound,
            guards::bound(),
            "lead, bound to its post",
            bind,
        ))
        .carried_out(Transfer::where_known(
            On::Burdened,
            guards::burdened(),
            "lead, bound to its post",
            bind_again,
        ))
        .carried_out(Transfer::new(
            On::RelayResumed,
            guards::relay_resumed(),
            "keep the post",
            keep::<Bound, Relay>,
        ))
        .carried_out(Transfer::new(
            On::LeafResumed,
            guards::leaf_resumed(),
            "keep the post",
            keep::<Bound, Leaf>,
        ))
        .carried_out(Transfer::new(
            On::TaskReached,
            guards::task_reached(),
            "service the task from its post",
            service_from_post,
        ))
        .carried_out(Transfer::from_any_where_known(
            Activity::UNINVOLVED,
            On::PathJoined,
            guards::path_joined(),
            "wait on Σ",
            join_path,
        ))
        .carried_out(Transfer::new(
            On::PathJoined,
            guards::path_joined(),
            "wait on Σ",
            await_release,
        ))
        .carried_out(Transfer::new(
            On::StandbyKept,
            guards::standby_kept(),
            "keep the post, or take a new one",
            stand_by,
        ))
        .carried_out(kept::<Relay>(On::RelayKept, guards::relay_kept()))
        .carried_out(kept::<Leaf>(On::LeafKept, guards::leaf_kept()))
        .carried_out(Transfer::new(
            On::StandbyKept,
            guards::release_missed(),
            "take a new post",
            leave_post::<AwaitingRelease>,
        ))
        .carried_out(Transfer::new(
            On::BoundKept,
            guards::bound_kept(),
            "keep the post",
            stop_awaiting::<Bound>,
        ))
        .carried_out(Transfer::new(
            On::RelayResumed,
            guards::relay_resumed(),
            "keep the post",
            stop_awaiting::<Relay>,
        ))
        .carried_out(Transfer::new(
            On::LeafResumed,
            guards::leaf_resumed(),
            "keep the post",
            stop_awaiting::<Leaf>,
        ))
        .carried_out(Transfer::new(
            On::TeamJoined,
            guards::team_joined(),
            "follow the robot that was p₁",
            join_team,
        ))
        .carried_out(Transfer::new(On::Released, guards::released(), "lead", release))
        .carried_out(Transfer::new(On::Released, guards::released(), "lead", leave_unused_post))
        .carried_out(reached::<Standby>(On::StandbyReached, guards::standby_reached()))
        .carried_out(reached::<Relay>(On::RelayReached, guards::relay_reached()))
        .carried_out(reached::<Junction>(On::JunctionReached, guards::junction_reached()))
        .carried_out(reached::<Leaf>(On::LeafReached, guards::leaf_reached()))
        .carried_out(Transfer::new(
            On::TaskReached,
            guards::task_reached(),
            "service the task from here",
            service,
        ))
        .carried_out(Transfer::from_any_where_known(
            Activity::IN_TEAM,
            On::Settled,
            guards::dissolved(),
            "make the post a fixed one",
            settle,
        ))
        .carried_out(Transfer::new(On::SetOut, guards::set_out(), "leave the post", set_out))
        .carried_out(attached::<Standby>())
        .carried_out(attached::<Relay>())
        .carried_out(attached::<Junction>())
        .carried_out(attached::<Leaf>())
        .carried_out(attached::<Bound>())
        .carried_out(attached::<Following>())
        .carried_out(attached::<Leading>())
        .carried_out(Transfer::new(
            On::Promoted,
            guards::promoted(),
            "make the post a fixed one",
            promote,
        ))
        .carried_out(Transfer::new(
            On::Discharged,
            guards::discharged(),
            "service nothing any more",
            discharge,
        ))
        .carried_out(Transfer::new(
            On::Branched,
            guards::branched(),
            "keep the post",
            keep::<Relay, Junction>,
        ))
        .carried_out(Transfer::new(
            On::Merged,
            guards::merged(),
            "keep the post",
            keep::<Junction, Relay>,
        ))
        .carried_out(Transfer::new(On::Retired, guards::retired(), "give the post up", retire))
        .carried_out(exchange::<Standby>(Activity::UNDER_WAY))
        .carried_out(exchange::<Relay>(Activity::UNDER_WAY))
        .carried_out(exchange::<Junction>(Activity::UNDER_WAY))
        .carried_out(exchange::<Leaf>(Activity::UNDER_WAY))
        .carried_out(exchange::<Bound>(Activity::UNDER_WAY))
        .carried_out(exchange::<Waiting>(Activity::UNDER_WAY))
        .carried_out(exchange::<AwaitingRelease>(Activity::UNDER_WAY))
        .carried_out(exchange::<Shifting>(Activity::AT_REST))
        .carried_out(exchange::<Following>(Activity::AT_REST))
        .carried_out(exchange::<Leading>(Activity::AT_REST))
        .carried_out(exchange::<Shifting>(Activity::IN_TEAM))
        .carried_out(exchange::<Following>(Activity::UNDER_WAY))
        .carried_out(exchange_of::<Shifting, Leading>())
        .carried_out(exchange_of::<Following, Leading>())
        .build()
}
