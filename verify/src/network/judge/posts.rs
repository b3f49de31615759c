//! Whether posts are those that roles, tasks and the tree give.

use pleach_automaton::network::record::{PostView, Snapshot};
use pleach_discrete::network::Role;

use super::ledger::Ledger;
use super::{Dispute, Scene, task_or_none};
use crate::network::property::Property;

/// A robot that answers for a task is in the tree, and a leaf or the leader that is not yet
/// released.
pub(super) fn holders_hold(snapshot: &Snapshot) -> Result<(), Dispute> {
    for &(task, robot) in &snapshot.serviced {
        let role = snapshot.roles[robot];
        let is_in_tree = snapshot.tree.iter().any(|&(child, _)| child == robot);
        if !is_in_tree || !matches!(role, Role::Leaf | Role::Leader) {
            let sentence = format!(
                "robot {robot} answers for task {task}, and it is a {} {} the tree",
                role.name(),
                if is_in_tree { "in" } else { "outside of" }
            );
            return Err(Dispute::of(Property::Duties, &[robot], sentence));
        }
    }
    Ok(())
}

/// Part of [`Property::Posts`]: a robot that is not `under_way` keeps the post that it holds, at its
/// place and with its task.
pub(super) fn stay(
    previous: &Snapshot,
    snapshot: &Snapshot,
    under_way: impl Fn(usize) -> bool,
) -> Result<(), Dispute> {
    for before in previous.posts.iter().filter(|post| !under_way(post.holder)) {
        let robot = before.holder;
        let place = before.reference;
        let clause = match post_of(robot, snapshot) {
            None => "is gone".to_owned(),
            Some(now) if now.reference != place => {
                format!("is now at ({:.6}, {:.6})", now.reference.x, now.reference.y)
            }
            Some(now) if now.task != before.task => {
                let [was, is] = [before.task, now.task].map(task_or_none);
                format!("was for {was} and is now for {is}")
            }
            Some(_) => continue,
        };
        let sentence = format!(
            "the post ({:.6}, {:.6}) of robot {robot}, which is not on its way, {clause}",
            place.x, place.y
        );
        return Err(Dispute::of(Property::Posts, &[robot], sentence));
    }
    Ok(())
}

fn post_of(robot: usize, snapshot: &Snapshot) -> Option<&PostView> {
    snapshot.posts.iter().find(|post| post.holder == robot)
}

/// Part of [`Property::Posts`]: a post is for the task that its holder answers for. While two robots
/// exchange duties both hold a post for it, and observers name one of them.
pub(super) fn tasks_agree(snapshot: &Snapshot) -> Result<(), Dispute> {
    for post in &snapshot.posts {
        let robot = post.holder;
        let held = snapshot.serviced.iter().find(|(_, it)| *it == robot).map(|(task, _)| *task);
        let is_known = |task: usize| snapshot.serviced.iter().any(|&(it, _)| it == task);
        let agrees = match (held, post.task) {
            (None, Some(task)) => is_known(task),
            (held, task) => held == task,
        };
        if !agrees {
            let sentence = format!(
                "the post of robot {robot} is for {}, and the robot answers for {}",
                task_or_none(post.task),
                task_or_none(held)
            );
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
    }
    Ok(())
}

/// Part of [`Property::Posts`]: a node, junction or leaf that neither moves with the primary team nor
/// walks holds one post, and redundant robots hold none.
pub(super) fn are_held(
    in_team: impl Fn(usize) -> bool,
    snapshot: &Snapshot,
) -> Result<(), Dispute> {
    for (robot, role) in snapshot.roles.iter().enumerate() {
        let posts = snapshot.posts.iter().filter(|post| post.holder == robot).count();
        let moves = in_team(robot) || snapshot.path.contains(&robot);
        let (least, most) = match role {
            Role::Redundant => (0, 0),
            Role::Recruit | Role::Leader => (0, 1),
            Role::Node | Role::Junction | Role::Leaf if moves => (0, 1),
            Role::Node | Role::Junction | Role::Leaf => (1, 1),
        };
        if posts < least || posts > most {
            let sentence = format!("robot {robot}, a {}, holds {posts} posts", role.name());
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
        if *role == Role::Recruit && !snapshot.path.contains(&robot) {
            let sentence = format!("robot {robot} is a recruit, and not on the path");
            return Err(Dispute::of(Property::Teams, &[robot], sentence));
        }
    }
    Ok(())
}

/// Part of [`Property::Duties`]: no robot but a leader that awaits its release answers for a task that is over.
pub(super) fn serve_what_is_open(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    let is_over = |&&(task, robot): &&(usize, usize)| {
        ledger.closed.contains(&task) && snapshot.roles[robot] != Role::Leader
    };
    match snapshot.serviced.iter().find(is_over) {
        None => Ok(()),
        Some(&(task, robot)) => {
            let sentence = format!("robot {robot} answers for task {task}, and that is over");
            Err(Dispute::of(Property::Duties, &[robot], sentence))
        }
    }
}

/// Part of [`Property::Duties`]: no task is shown as over that has not ended or been taken back, and none that was
/// shown so is open again.
pub(super) fn closings_are_told(ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
    let closed = &scene.snapshot.closed;
    if let Some(task) = closed.iter().find(|task| !ledger.closed.contains(task)) {
        let sentence = format!(
            "task {task} is shown as over, and it has neither ended nor been taken back: no event says so"
        );
        return Err(Dispute::of(Property::Duties, &[], sentence));
    }
    let before = scene.previous.map_or(&[][..], |previous| &previous.closed);
    match before.iter().find(|task| !closed.contains(task)) {
        None => Ok(()),
        Some(task) => {
            let sentence = format!("task {task} is over, and is not shown so any more");
            Err(Dispute::of(Property::Duties, &[], sentence))
        }
    }
}

/// Part of [`Property::Posts`]: the task of a post is the one that its holder answers for, a leaf
/// has one, and a post is a junction if more than one branch parts there. The primary team is one branch,
/// also while a member of it has yet to attach to the newcomer.
pub(super) fn are_those(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    let answers_for =
        |robot: usize| snapshot.serviced.iter().find(|(_, it)| *it == robot).map(|(task, _)| *task);
    for post in &snapshot.posts {
        let (robot, task) = (post.holder, answers_for(post.holder));
        if post.task != task {
            let sentence = format!(
                "the post of robot {robot} is for {}, and the robot answers for {}",
                task_or_none(post.task),
                task_or_none(task)
            );
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
        let attached = snapshot.tree.iter().filter(|&&(_, parent)| parent == robot);
        let (team, fixed): (Vec<usize>, Vec<usize>) = attached
            .map(|&(child, _)| child)
            .partition(|child| ledger.primary_team.contains(child));
        let fixed = fixed.into_iter().filter(|&child| post_of(child, snapshot).is_some()).count();
        let branches = fixed + usize::from(!team.is_empty());
        let role = snapshot.roles[robot];
        let is_junction = branches > 1;
        let fits = match role {
            Role::Junction => is_junction,
            Role::Node => !is_junction,
            _ => true,
        };
        if post.junction != is_junction || !fits {
            let sentence = format!(
                "{branches} branches part at robot {robot}, a {}, whose post is {}a junction",
                role.name(),
                if post.junction { "" } else { "not " }
            );
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
    }
    match snapshot
        .roles
        .iter()
        .enumerate()
        .find(|&(robot, role)| *role == Role::Leaf && answers_for(robot).is_none())
    {
        None => Ok(()),
        Some((robot, _)) => {
            let sentence = format!("robot {robot} is a leaf, and answers for no task");
            Err(Dispute::of(Property::Posts, &[robot], sentence))
        }
    }
}
