//! The summary says what happened, between the instants too.

use crate::common::{end, reports, room, show};
use pleach::automaton::network::KernelTimes;
use pleach::mission::{Completed, Watcher};
use pleach::summary::Summary;
use pleach::verify::network::{Extreme, Extremes, Instant};
use std::time::Duration;

fn summary() -> Summary {
    let mut summary = Summary::new(&room());
    show(&mut summary);
    let extreme = |value, robots: &[usize]| {
        Some(Extreme { value, instant: Instant { step: 1, time: 1.0 }, robots: robots.to_vec() })
    };
    let completed = Completed {
        end: end(),
        extremes: Extremes {
            pair_distance: extreme(0.0894, &[0, 1]),
            clearance: extreme(0.3, &[1]),
            residual: extreme(0.018, &[1]),
            load: extreme(0.4, &[0]),
        },
        times: KernelTimes {
            routing: Duration::from_millis(300),
            motion: Duration::from_millis(600),
            ..KernelTimes::default()
        },
    };
    summary.completed(completed, Duration::from_millis(1500))
}

#[test]
fn events_are_counted() {
    let summary = summary();
    assert_eq!(summary.recruits(), 1);
    assert_eq!(summary.stationary_points(), 1);
    assert_eq!(summary.tasks()[0].serviced, Some((2, 1)));
}

/// The robot that has serviced the task stops after the last report.
#[test]
fn a_task_whose_robot_has_stopped_does_not_count() {
    let mut summary = Summary::new(&room());
    show(&mut summary);
    assert_eq!(summary.serviced(), 1);
    let last = reports().pop().expect("there are reports").snapshot;
    let robot = summary.tasks()[0].holder.expect("it is held");
    summary.observe(&last.without(vec![robot]), &[]).expect("it writes nothing");
    assert_eq!((summary.serviced(), summary.tasks()[0].holder), (0, None));
    assert!(summary.to_string().contains("by robot 1, held by none at the end"), "{summary}");
}

#[test]
fn the_text_can_be_judged() {
    insta::assert_snapshot!(summary());
}
