//! Missions in which messages are lost, nodes stop, and places and moves are off.

use pleach_automaton::network::record::Outcome;
use pleach_verify::network::storm::{Kind, allowing_for, draw, judged_run};

use super::story::story;
use super::{scenario, valid};

/// Seconds for which a mission is taken to last when faults are drawn.
const DURATION: f64 = 150.0;
const PERIODS: usize = 1000;

/// Rides a small mission through storms of this kind. Robots keep what they promise, and in the end decide as
/// they did before.
#[track_caller]
fn survives(name: &str, path: &str, kind: Kind, seeds: u64) {
    for seed in 0..seeds {
        let scenario =
            allowing_for(kind, &valid(scenario(path))).expect("there is room for errors");
        let storm = draw(kind, seed, &scenario, DURATION);
        let verdict = judged_run(&scenario, &storm, PERIODS).expect("nodes go on");
        assert_eq!(verdict.violations, [], "{path}, {}, seed {seed}", kind.name());
        let outcome = verdict.end.map_or(Outcome::StepLimit, |end| end.outcome);
        let told = story(verdict.events.iter().map(|(_, event)| event));
        insta::assert_snapshot!(format!("{name}-{seed}"), format!("{told}\n{}", outcome.name()));
    }
}

#[test]
fn messages_are_lost() {
    survives("loss", "scenarios/redundant-node", Kind::Loss { rate: 0.3, later: true }, 2);
    survives("loss-on-a-path", "scenarios/leaf-leader", Kind::Loss { rate: 0.3, later: false }, 1);
}

#[test]
fn messages_are_late_and_doubled() {
    survives("radio", "scenarios/redundant-node", Kind::Radio, 2);
    survives("copies", "scenarios/leaf-leader", Kind::Copies, 1);
}

#[test]
fn robots_are_cut_off_for_a_while() {
    survives("silence", "scenarios/leaf-leader", Kind::Silence, 1);
    survives("partition", "scenarios/leaf-leader", Kind::Partition, 3);
}

#[test]
fn robots_stop() {
    survives("crash", "scenarios/leaf-leader", Kind::Crash, 4);
}

#[test]
fn robots_restart_and_have_forgotten_everything() {
    survives("restart", "scenarios/leaf-leader", Kind::Restart, 4);
}

#[test]
fn robots_join_late() {
    survives("late", "scenarios/redundant-node", Kind::Late, 2);
    survives("late-on-a-path", "scenarios/leaf-leader", Kind::Late, 1);
}

#[test]
fn clocks_are_not_aligned() {
    survives("clocks", "scenarios/leaf-leader", Kind::Clocks, 2);
}

#[test]
fn places_and_moves_are_off() {
    survives("errors", "scenarios/redundant-node", Kind::Errors(0.25), 1);
    survives("motion", "scenarios/redundant-node", Kind::Motion(0.3), 1);
}

#[test]
fn everything_fails_at_once() {
    survives("everything", "scenarios/leaf-leader", Kind::Everything, 3);
}
