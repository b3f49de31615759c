//! The summary says what happened, between the instants too.

#![allow(clippy::unwrap_used)] // a test that panics has failed

mod common;

use common::{PretendedMission, room};
use pleach::mission::watch;
use pleach::summary::{Smallest, Summary};
use std::time::Duration;

fn summary() -> Summary {
    let mut summary = Summary::new(&room()).unwrap();
    watch(&mut PretendedMission::new(), &mut [&mut summary]).unwrap();
    summary.with_times(
        Duration::from_millis(1500),
        vec![("routing", Duration::from_millis(300)), ("motion", Duration::from_millis(600))],
    )
}

#[test]
fn events_are_counted() {
    let summary = summary();
    assert_eq!(summary.recruits(), 1);
    assert_eq!(summary.stationary_points(), 1);
    assert_eq!(summary.tasks()[0].serviced, Some((2, 1)));
}

#[test]
fn the_smallest_distance_is_met_on_the_way() {
    // From (0.6, 0.5) to (0.4, 0.4) robot 1 passes (0.4, 0.5) at 0.1·2/√5, closer than at any
    // instant seen.
    let Smallest { value, who, step } = summary().pair_distance().unwrap();
    assert!((value - 0.2 / 5.0_f64.sqrt()).abs() < 1e-12, "{value}");
    assert_eq!((who, step), ((0, 1), 0));
}

#[test]
fn the_wall_counts_as_well() {
    let Smallest { value, who, step } = summary().wall_clearance().unwrap();
    assert!((value - 0.3).abs() < 1e-12, "{value}");
    assert_eq!((who, step), (1, 1));
}

#[test]
fn the_text_can_be_judged() {
    insta::assert_snapshot!(summary());
}
