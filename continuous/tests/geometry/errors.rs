use pleach_continuous::geometry::{Disc, Errors, HalfPlane, Workspace};
use pleach_continuous::network::motion::MotionProblem;
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;

use super::environments::{environment, place};

/// Distances kept are larger than required by this share.
const MORE: f64 = 1e-4;
/// Rounding of lengths of order one.
const ROUNDING: f64 = 1e-9;

fn polar(angle: f64, length: f64) -> Vector {
    Vector::new(angle.cos(), angle.sin()) * length
}

/// Errors in shares of the clearance, as large as scenarios may state them, or none.
fn errors() -> impl Strategy<Value = Errors> {
    let share = || prop_oneof![Just(0.0), 0.0..0.5_f64, Just(0.5)];
    (share(), share()).prop_map(|(position, motion)| Errors { position, motion })
}

/// A direction and a share of how far it may be: at the worst, often.
fn stray() -> impl Strategy<Value = (f64, f64)> {
    (0.0..std::f64::consts::TAU, prop_oneof![Just(1.0), 0.0..1.0_f64])
}

/// Where a robot goes from `position` to come near to `waypoint`.
fn step(position: Point, waypoint: Point, half_planes: Vec<HalfPlane>, radius: f64) -> Vector {
    let discs = vec![Disc { center: position, radius }];
    let problem = MotionProblem { position, waypoint, half_planes, discs };
    problem.solve_from_outside().target - position
}

proptest! {
    /// Wherever two robots measure themselves, whichever of them moves, at whatever pace, and however
    /// their moves stray: they keep their distance.
    #[test]
    fn robots_with_errors_keep_their_distance(
        errors in errors(),
        gap in prop_oneof![Just(0.0), 0.0..2.0_f64],
        measured in [stray(), stray()],
        waypoints in [stray(), stray()],
        strayed in [stray(), stray()],
        radius in 0.1..2.0_f64,
    ) {
        let places = [Point::origin(), Point::new(2.0 + gap, 0.0)];
        let believed = [0, 1].map(|own: usize| {
            places[own] + polar(measured[own].0, errors.position * measured[own].1)
        });
        let moves = [0, 1].map(|own: usize| {
            let (here, other) = (believed[own], believed[1 - own]);
            let half_planes = errors.voronoi_half_planes(here, &[other], 1.0, 1.0 + MORE);
            step(here, here + polar(waypoints[own].0, 4.0), half_planes, radius)
        });
        // At the worst, they stray towards each other.
        let strays = [0, 1].map(|own: usize| {
            let worst = Vector::new(if own == 0 { 1.0 } else { -1.0 }, 0.0) * errors.motion;
            [worst, polar(strayed[own].0, errors.motion * strayed[own].1)]
        });
        let displacement = |own: usize, stray: usize| {
            let is_moving = moves[own] != Vector::zeros();
            if is_moving { moves[own] + strays[own][stray] } else { Vector::zeros() }
        };
        for stray in 0..2 {
            let shares = (0..=8).map(|share| f64::from(share) / 8.0);
            for (s, t) in shares.clone().flat_map(|s| shares.clone().map(move |t| (s, t))) {
                let one = places[0] + displacement(0, stray) * s;
                let other = places[1] + displacement(1, stray) * t;
                prop_assert!((one - other).norm() >= 2.0 - ROUNDING, "{moves:?}, {s} {t}");
            }
        }
    }

    /// Nearer than allowed, as far as they know, robots may stay or go apart.
    #[test]
    fn robots_with_errors_never_come_nearer_by_little_and_little(
        errors in errors(),
        nearness in 0.0..1.0_f64,
        angle in 0.0..6.3_f64,
        waypoint in place(),
    ) {
        let apart = 2.0 * errors.planning_clearance(1.0) * (0.5 + 0.5 * nearness);
        let (here, other) = (Point::origin(), Point::origin() + polar(angle, apart));
        let half_planes = errors.voronoi_half_planes(here, &[other], 1.0, 1.0 + MORE);
        let step = step(here, waypoint, half_planes, 2.0);
        let is_staying = step == Vector::zeros();
        prop_assert!(is_staying || (other - here - step).norm() >= apart - ROUNDING);
    }

    /// Wherever a robot that has stopped may be, and whatever errors do: another one keeps its distance, or
    /// stays.
    #[test]
    fn robots_keep_their_distance_from_one_that_may_be_elsewhere(
        errors in errors(),
        gap in prop_oneof![Just(0.0), 0.0..1.0_f64],
        astray in 0.0..3.0_f64,
        elsewhere in stray(),
        measured in [stray(), stray()],
        waypoint in 0.0..std::f64::consts::TAU,
        strayed in stray(),
        radius in 0.1..2.0_f64,
    ) {
        let (here, wreck) = (Point::origin(), Point::new(2.0 + gap, 0.0));
        let error = |(angle, share): (f64, f64)| polar(angle, errors.position * share);
        let believed = here + error(measured[0]);
        let heard = wreck + polar(elsewhere.0, astray * elsewhere.1) + error(measured[1]);
        let sides = errors.half_planes_beside(believed, (heard, astray), 1.0, 1.0 + MORE);
        let step = step(believed, believed + polar(waypoint, 4.0), sides, radius);
        if step.norm() > ROUNDING {
            let worst = Vector::new(errors.motion, 0.0);
            for stray in [worst, polar(strayed.0, errors.motion * strayed.1)] {
                for share in (0..=8).map(|share| f64::from(share) / 8.0) {
                    let apart = (wreck - here - (step + stray) * share).norm();
                    prop_assert!(apart >= 2.0 - ROUNDING, "{apart} at {share} of {step:?}");
                }
            }
        }
    }

    /// A robot that keeps its clearance, and measures itself where it would not, keeps it on its way
    /// back.
    #[test]
    fn robots_that_have_strayed_keep_off_walls(
        environment in environment(),
        at in place(),
        shares in (0.0..0.5_f64, 0.0..0.5_f64),
        measured in stray(),
        waypoint in place(),
        strayed in stray(),
        radius in 0.01..0.3_f64,
    ) {
        let workspace = &environment.workspace;
        // As near to a wall as may be.
        let clearance = workspace.clearance(at).min(0.2);
        prop_assume!(workspace.contains(at) && clearance > 0.0);
        let errors = Errors { position: shares.0 * clearance, motion: shares.1 * clearance };
        let believed = at + polar(measured.0, measured.1 * errors.position);
        let half_planes = errors.wall_half_planes(workspace, believed, radius, clearance);
        let step = step(believed, waypoint, half_planes, radius);
        if step != Vector::zeros() {
            for stray in [strayed.0, strayed.0 + 2.0, strayed.0 + 4.0] {
                let end = at + step + polar(stray, strayed.1 * errors.motion);
                prop_assert!(workspace.segment_clearance(at, end) >= clearance - ROUNDING);
            }
        }
    }
}

/// Without errors the half-planes are those of (17), to the bit.
#[test]
fn without_errors_nothing_changes() {
    use pleach_continuous::geometry::voronoi_half_planes;
    let kept = 0.01 * (1.0 + MORE);
    for number in 0..2_000 {
        let angle = f64::from(number) * 0.77;
        let apart = 0.02 * (1.0 + (f64::from(number % 40) - 10.0) * 1e-5);
        let here = Point::new(0.3 + angle.sin(), 0.7);
        let others = [here + polar(angle, apart), here + polar(angle + 2.0, 0.05)];
        let plain = voronoi_half_planes(here, &others, kept);
        assert_eq!(Errors::default().voronoi_half_planes(here, &others, 0.01, kept), plain);
    }
}

/// Nearer than allowed: away by m from each direction in which the other one may be.
#[test]
fn robots_that_are_too_near_go_away_from_wherever_the_other_may_be() {
    for (position, motion, apart) in [(0.3, 0.2, 2.1), (0.5, 0.0, 2.9), (0.1, 0.5, 0.5)] {
        let (errors, towards) = (Errors { position, motion }, polar(0.7, 1.0));
        let (here, other) = (Point::new(0.4, -0.2), Point::new(0.4, -0.2) + towards * apart);
        let away = errors.voronoi_half_planes(here, &[other], 1.0, 1.0 + MORE);
        let sines = away.iter().map(|half_plane| towards.perp(&half_plane.normal));
        let sine: f64 = 2.0 * position / apart;
        for (found, expected) in sines.zip([sine, -sine]) {
            assert!((found - expected).abs() < ROUNDING, "{found} is not {expected}");
        }
        for half_plane in &away {
            assert!((half_plane.normal.norm() - 1.0).abs() < ROUNDING);
            assert!(half_plane.normal.dot(&towards) > 0.0);
            let needed = half_plane.normal.dot(&here.coords) - half_plane.offset;
            assert!((needed - motion).abs() < ROUNDING, "away by {needed}");
        }
        assert_eq!(away.len(), 2);
    }
}

#[test]
fn errors_of_places_and_of_moves_add_up() {
    let errors = |position, motion| Errors { position, motion };
    assert!(errors(0.0, 0.0).are_none());
    assert!(!errors(0.1, 0.0).are_none() && !errors(0.0, 0.1).are_none());
    assert_eq!(errors(0.25, 0.125).stray(), 0.625);
    assert_eq!(errors(0.25, 0.125).planning_clearance(1.0), 1.375);
}

/// A robot may come as near to a wall as ρ + e + m by what it knows.
#[test]
fn a_wall_leaves_the_room_in_front_of_it() {
    let [a, b, c, d] =
        [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)].map(|(x, y)| Point::new(x, y));
    let room = Workspace::new(vec![a, b, c, d], Vec::new()).unwrap();
    let errors = Errors { position: 0.02, motion: 0.03 };
    let here = Point::new(2.0, 3.5);
    let walls = errors.wall_half_planes(&room, here, 1.0, 0.1);
    assert_eq!(walls.len(), 1, "the others are too far");
    assert!((walls[0].margin(here) - (0.5 - 0.15)).abs() < ROUNDING);
    assert!((walls[0].margin(here + Vector::new(1.0, 0.2)) - (0.3 - 0.15)).abs() < ROUNDING);
}
