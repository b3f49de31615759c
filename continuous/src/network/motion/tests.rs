use super::*;
use proptest::prelude::*;

const TRUST_RADIUS: f64 = 0.07;

/// A robot somewhere in a workspace of size 10, with constraints that its position meets; some
/// touch it, and some come in opposite pairs so that the feasible set has no interior.
fn problems() -> impl Strategy<Value = MotionProblem> {
    let margin = || prop_oneof![Just(0.0), 0.0..0.1f64, 0.0..1.0f64];
    let line = || (0.0..std::f64::consts::TAU, margin(), prop::bool::weighted(0.15));
    let circle = || (0.0..std::f64::consts::TAU, 0.05..3.0f64, margin());
    (
        (0.0..10.0f64, 0.0..10.0f64),
        (0.0..std::f64::consts::TAU, 0.0..1.0f64),
        prop::collection::vec(line(), 0..15),
        prop::collection::vec(circle(), 0..5),
    )
        .prop_map(|((x, y), (heading, distance), lines, circles)| {
            let position = Point::new(x, y);
            let towards = |angle: f64| Vector::new(angle.cos(), angle.sin());
            let mut half_planes = Vec::new();
            for (angle, margin, opposed) in lines {
                let normal = towards(angle);
                let offset = normal.dot(&position.coords) + margin;
                half_planes.push(HalfPlane::new(normal, offset));
                if opposed {
                    half_planes.push(HalfPlane::new(-normal, -normal.dot(&position.coords)));
                }
            }
            let mut discs = vec![Disc { center: position, radius: TRUST_RADIUS }];
            for (angle, distance, margin) in circles {
                let center = position + towards(angle) * distance;
                discs.push(Disc { center, radius: (position - center).norm() + margin });
            }
            let waypoint = position + towards(heading) * distance;
            MotionProblem { position, waypoint, half_planes, discs }
        })
}

/// Whether −∇‖y − a₁‖² lies in the cone of the outward normals of the constraints active at y: the
/// optimality condition of a projection onto a convex set, tested by enumerating pairs of normals.
fn is_optimal(problem: &MotionProblem, target: Point, active_within: f64) -> bool {
    let pull = problem.waypoint - target;
    let allowed = 1e-6 * (1.0 + pull.norm());
    if pull.norm() <= allowed {
        return true;
    }
    let lines = problem
        .half_planes
        .iter()
        .filter(|line| line.margin(target) <= active_within)
        .map(|line| line.normal.into_inner());
    let circles = problem
        .discs
        .iter()
        .filter(|disc| disc.margin(target) <= active_within)
        .map(|disc| (target - disc.center).normalize());
    let normals: Vec<Vector> = lines.chain(circles).collect();
    let along = |normal: &Vector| (pull - normal * pull.dot(normal).max(0.0)).norm() <= allowed;
    normals.iter().any(along)
        || normals.iter().any(|a| {
            normals.iter().any(|b| {
                let determinant = a.perp(b);
                let (s, t) = (pull.perp(b) / determinant, a.perp(&pull) / determinant);
                determinant.abs() > 1e-12 && s >= -allowed && t >= -allowed
            })
        })
}

proptest! {
    #![proptest_config(cases::usually(500))]

    #[test]
    fn the_exact_answer_is_feasible_and_optimal(problem in problems()) {
        let motion = problem.solve_exact();
        prop_assert_eq!(motion.outcome, MotionOutcome::Optimal);
        prop_assert!(problem.admits(&motion.target));
        prop_assert!(is_optimal(&problem, motion.target, 1e-9), "{:?}", motion);
    }

    #[test]
    fn shrinking_ends_inside_on_the_segment(problem in problems()) {
        let inside = problem.shrink_to_feasible(problem.waypoint);
        prop_assert!(problem.admits(&inside));
        let whole = problem.waypoint - problem.position;
        let part = inside - problem.position;
        prop_assert!(whole.perp(&part).abs() < 1e-12);
        // A little farther along the segment some constraint is broken.
        if inside != problem.waypoint {
            let farther = problem.position + part + whole.normalize() * 1e-5;
            prop_assert!(problem.smallest_margin(&farther) < -1e-12);
        }
    }
}

proptest! {
    #![proptest_config(cases::usually(200))]

    #[test]
    fn the_conic_answer_is_feasible_and_close_to_the_exact_one(problem in problems()) {
        let (exact, conic) = (problem.solve_exact(), problem.solve_conic());
        prop_assert!(problem.admits(&conic.target));
        let distance = |motion: &Motion| (motion.target - problem.waypoint).norm();
        prop_assert!(distance(&exact) <= distance(&conic) + 1e-9);
        if conic.outcome == MotionOutcome::Optimal {
            prop_assert!(distance(&conic) <= distance(&exact) + 1e-3 * TRUST_RADIUS);
        }
    }
}

fn at_origin(half_planes: Vec<HalfPlane>, waypoint: Point) -> MotionProblem {
    let position = Point::origin();
    let discs = vec![Disc { center: position, radius: 0.1 }];
    MotionProblem { position, waypoint, half_planes, discs }
}

#[test]
fn slides_along_a_segment_without_interior() {
    let up = Vector::new(0.0, 1.0);
    let walls = vec![HalfPlane::new(up, 0.0), HalfPlane::new(-up, 0.0)];
    let problem = at_origin(walls, Point::new(1.0, 1.0));
    for motion in [problem.solve_exact(), problem.solve_conic()] {
        assert!((motion.target - Point::new(0.1, 0.0)).norm() < 1e-4, "{motion:?}");
    }
}

/// A corner of 0.03 rad whose tip is the robot: the solver ends 2e-11 outside, and a step that is
/// only shortened until it is inside keeps a fiftieth of its length.
#[test]
fn leaves_the_tip_of_a_narrow_corner() {
    let center = Point::new(0.8062128723683496, -0.040648359062349496);
    let wall = HalfPlane::new(Vector::new(0.9996937825831466, -0.024745526153239206), 0.0);
    let mut problem = at_origin(vec![wall], Point::new(0.7990026798572888, -0.349129470759933));
    problem.discs.push(Disc { center, radius: center.coords.norm() });
    let (exact, conic) = (problem.solve_exact(), problem.solve_conic());
    assert!((exact.target - problem.position).norm() > 0.04, "{exact:?}");
    assert!((conic.target - exact.target).norm() < 1e-4, "{conic:?}");
}

#[test]
fn an_infeasible_position_or_waypoint_without_place_means_stay() {
    let wall = HalfPlane::new(Vector::new(1.0, 0.0), -0.01);
    let problem = at_origin(vec![wall], Point::new(1.0, 0.0));
    let motion = problem.solve_exact();
    assert_eq!((motion.target, motion.outcome), (Point::origin(), MotionOutcome::Infeasible));
    assert_eq!(problem.solve_conic().outcome, MotionOutcome::Infeasible);
    let lost = at_origin(vec![], Point::new(f64::NAN, 0.0));
    assert_eq!(lost.solve_exact().outcome, MotionOutcome::Undecided);
    assert_eq!(lost.solve_conic().target, Point::origin());
}

#[test]
fn the_linearised_residual_is_a_half_plane() {
    let mut problem = at_origin(vec![], Point::new(1.0, 0.0));
    problem.keep_residual(0.02, Vector::new(-0.5, 0.0), 0.0);
    assert!((problem.solve_exact().target - Point::new(0.04, 0.0)).norm() < 1e-12);
    problem.keep_residual(-0.01, Vector::zeros(), 0.0);
    assert_eq!(problem.solve_exact().outcome, MotionOutcome::Infeasible);
}

#[test]
fn a_long_slide_along_a_wall_does_not_wear_through_it() {
    let normal = Vector::new(0.6, 0.8);
    let wall = HalfPlane::new(normal, 7.0 / 3.0);
    let mut position = Point::from(normal * wall.offset);
    for _ in 0..20_000 {
        let discs = vec![Disc { center: position, radius: 0.01 }];
        let waypoint = Point::new(900.0, -100.0);
        let problem = MotionProblem { position, waypoint, half_planes: vec![wall], discs };
        let motion = problem.solve_exact();
        assert!((motion.target - position).norm() > 0.0099, "{motion:?} from {position}");
        position = motion.target;
    }
    assert!(wall.margin(position) >= -FEASIBILITY_TOLERANCE);
}
