//! Ways through the states of the protocol, told for a reader.

use std::fmt::Write;

use pleach_automaton::network::RobotView;
use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::duty::Duty;
use pleach_discrete::Location as _;
use pleach_discrete::network::{Anchor, NodeId, PostKind};

use super::node::Local;
use super::protocol::{Action, Protocol, State};
use crate::{StateGraph, StateId};

/// What happens on a shortest way to a state: one line a step, with what it changes.
pub fn story(
    protocol: &Protocol,
    exploration: &StateGraph<State, Action>,
    state: StateId,
) -> String {
    let (begin, way) = exploration.way_to(state);
    let at = |id: StateId| &exploration.states()[id as usize];
    tell(protocol, at(begin), way.into_iter().map(|(action, id)| (action, at(id))))
}

/// What happens from a state on: one line a step, with what it changes.
pub fn tell<'a>(
    protocol: &Protocol,
    begin: &'a State,
    way: impl Iterator<Item = (Action, &'a State)>,
) -> String {
    let mut text = String::from("at first\n");
    let mut before = begin;
    for node in 0..before.locals.len() {
        let _ = writeln!(text, "      {}", situation(protocol, before, node));
    }
    for (number, (action, after)) in way.enumerate() {
        let _ = writeln!(text, "{:4}  {action}", number + 1);
        for node in 0..after.locals.len() {
            let (was, is) = (situation(protocol, before, node), situation(protocol, after, node));
            if was != is {
                let _ = writeln!(text, "      {is}");
            }
        }
        before = after;
    }
    text
}

/// A node in one line.
fn situation(protocol: &Protocol, state: &State, node: NodeId) -> String {
    let local: &Local = protocol.nodes().local(state.locals[node]);
    let word = word(local.notice());
    let Some(robot) = local.robot() else { return format!("access point {node}: {word}") };
    let beacon = robot.beacon();
    let mut text = format!(
        "{node} at {}: {}, {}, {}, parent {}, {word} {}",
        protocol.place_of(state, node),
        robot.role().name(),
        robot.phase().name(),
        duty(robot),
        beacon.parent.map_or("none".into(), |parent| parent.to_string()),
        robot.notice_id().number,
    );
    if let Some(offer) = beacon.offer {
        let _ = write!(text, ", offers {} to {}", duty_text(&offer.duty), offer.to);
    }
    if let Some(reply) = beacon.reply {
        let given = reply.accepted.map_or("a refusal".into(), |duty| duty_text(&duty));
        let _ = write!(text, ", replies {given} to {}", reply.to);
    }
    text
}

fn duty(robot: RobotView<'_>) -> String {
    duty_text(robot.duty())
}

fn duty_text(duty: &Duty) -> String {
    let (verb, post) = match (duty.place(), duty.post()) {
        (Some(place), None) => return format!("has left place {place} of Σ"),
        (None, None) => return "holds nothing".into(),
        (Some(place), Some(post)) => (format!("waits at place {place} of Σ with"), post),
        (None, Some(post)) => ("holds".into(), post),
    };
    let kind = match post.kind {
        PostKind::Redundant => "redundant".into(),
        PostKind::Fixed => "fixed".into(),
        PostKind::Primary { follows: None } => "leading".into(),
        PostKind::Primary { follows: Some(ahead) } => format!("behind {}", ahead.0),
    };
    let parent = match post.parent {
        None => "nothing".into(),
        Some(Anchor::Access(access)) => format!("access point {access}"),
        Some(Anchor::Post(parent)) => format!("post {}", parent.0),
    };
    let task = post.task.map_or(String::new(), |task| format!(" for task {task}"));
    format!("{verb} {kind} post {} on {parent}{task}", post.id.0)
}

fn word(notice: &Notice) -> String {
    match notice {
        Notice::Quiet => "quiet".into(),
        Notice::Task(announcement) => format!("task {} announced", announcement.task),
        Notice::Call { caller, .. } => format!("{caller} calls"),
        Notice::Path(path) => {
            format!("path {:?}", path.hops.iter().map(|hop| hop.robot).collect::<Vec<_>>())
        }
        Notice::Advance { joined } => format!("advance {:?}", joined.map(|(a, b)| (a.0, b.0))),
        Notice::Serviced { task } => format!("task {task} serviced"),
        Notice::Withdrawn { task } => format!("task {task} taken back"),
        Notice::Ended { outcome, reason, .. } => format!("ended, {}: {reason}", outcome.name()),
        other => format!("{other:?}"),
    }
}
