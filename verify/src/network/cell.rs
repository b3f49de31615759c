//! One robot's motion in its cell, for all proposals and all errors at once.
//!
//! The certificates of motion say where robots are while they move, by an argument over straight
//! segments. Here the same is asked of the flow: an automaton of one control period, in which the robot
//! goes to any point of its cell within its step radius, and is anywhere within its error of its own
//! estimate of its position. The [enclosure](crate::reach) does not use segments.

use std::f64::consts::TAU;

use pleach_automaton::{Automaton, BuildError, coordinates, from};
use pleach_continuous::Point;
use pleach_continuous::geometry::HalfPlane;
use pleach_discrete::vocabulary;
use pleach_guards::Interval;

use crate::reach::{Forbidden, Polytope, StateSet, Template, dot, dot_numbers};

vocabulary! {
    /// Whether the control period lasts.
    pub enum Stage: Location {
        /// The robot moves.
        Moving = "moving",
        /// The period is over.
        Arrived = "arrived",
    }
    /// What ends it.
    pub enum Clock: Event {
        /// The period is over.
        Over = "over",
    }
}

coordinates! {
    /// A robot in one control period.
    pub struct Mover {
        /// Its own estimate of its position.
        x,
        /// Likewise.
        y,
        /// How fast it goes, which its proposal decides.
        u,
        /// Likewise.
        v,
        /// Its true position minus that estimate.
        e,
        /// Likewise.
        f,
        /// The time that has passed, in seconds.
        tau,
    }
}

/// How many sides the polygons around discs have.
const SIDES: u32 = 16;

/// A control period in which a robot moves within a cell.
#[derive(Clone, Debug)]
pub struct CellMotion {
    /// ẋ = u until the period is over.
    pub automaton: Automaton<Stage, Clock, Mover>,
    /// All proposals in the cell within the step radius, with all errors.
    pub start: StateSet,
}

/// Why there is no such motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CellMotionError {
    /// A length or a duration makes no sense.
    #[error("{what} is {value}, and has to be {expected}")]
    Number {
        /// Which.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What would be right.
        expected: &'static str,
    },
    /// The cell has no points within the step radius.
    #[error("the cell has no points within the step radius: the robot has nowhere to be")]
    Empty,
    /// The automaton cannot be built.
    #[error(transparent)]
    Automaton(#[from] BuildError),
}

impl CellMotion {
    /// The motion from `position`, for `period` > 0 seconds, within a cell of half-planes, by at most
    /// `step_radius`; the robot is within `error` ≥ 0 of its own estimate, which is the error of
    /// its position and that of its motion together.
    ///
    /// # Errors
    ///
    /// [`CellMotionError`] if a number makes no sense or the cell has no points.
    pub fn new(
        position: Point,
        cell: &[HalfPlane],
        period: f64,
        step_radius: f64,
        error: f64,
    ) -> Result<Self, CellMotionError> {
        let lengths = [("the step radius", step_radius), ("the error", error)];
        for (what, value) in lengths {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(CellMotionError::Number { what, value, expected: "a length" });
            }
        }
        if !(period > 0.0 && period.is_finite()) {
            let expected = "a duration above 0";
            return Err(CellMotionError::Number { what: "the period", value: period, expected });
        }
        let Mover { x, y, u, v, tau, .. } = Mover::coordinates();
        let automaton = Automaton::starting_in(Stage::Moving)
            .initially(Mover { x: position.x, y: position.y, ..Mover::default() })
            .flow(Stage::Moving, [x.rate(&u), y.rate(&v), tau.rate(1.0)])
            .transition(
                from(Stage::Moving).on(Clock::Over).to(Stage::Arrived).must(tau.at_least(period)),
            )
            .build()?;
        let start = proposals(position, cell, period, step_radius, error);
        Ok(CellMotion { automaton, start: start.ok_or(CellMotionError::Empty)? })
    }

    /// The states in which the robot itself is farther than `slack` beyond one of these half-planes.
    pub fn beyond(planes: &[HalfPlane], slack: f64) -> Vec<Forbidden> {
        let Mover { x, y, e, f, .. } = Mover::coordinates();
        let beyond = |plane: &HalfPlane| {
            let along = plane.normal.x * (&x + &e) + plane.normal.y * (&y + &f);
            Forbidden::anywhere(along.more_than(plane.offset + slack))
        };
        planes.iter().map(beyond).collect()
    }
}

/// Where the robot is, every velocity that brings it to a point of the cell, and every error. Discs are
/// enclosed by polygons.
fn proposals(
    position: Point,
    cell: &[HalfPlane],
    period: f64,
    step_radius: f64,
    error: f64,
) -> Option<StateSet> {
    let period = Interval::point(period);
    let disc = |radius: Interval| Interval::new(-radius.upper(), radius.upper());
    let fastest = Interval::point(step_radius) / period;
    let (speeds, errors) = (disc(fastest).ok()?, disc(Interval::point(error)).ok()?);
    let [x, y] = [position.x, position.y].map(Interval::point);
    let sides = [x, y, speeds, speeds, errors, errors, Interval::point(0.0)];
    let mut bounds: Vec<(Vec<f64>, f64)> = Vec::new();
    for plane in cell {
        let normal = [plane.normal.x, plane.normal.y];
        let room = Interval::point(plane.offset) - dot_numbers(&[x, y], &normal);
        bounds.push((vec![0.0, 0.0, normal[0], normal[1], 0.0, 0.0, 0.0], (room / period).upper()));
    }
    for side in 0..SIDES {
        let (sine, cosine) = (TAU * f64::from(side) / f64::from(SIDES)).sin_cos();
        // The direction is as long as 1, up to rounding.
        let direction = [cosine, sine].map(Interval::point);
        let length = dot(&direction, &direction).power(0.5).unwrap_or(Interval::WHOLE);
        let within = |radius: f64| (Interval::point(radius) * length).upper();
        bounds.push((vec![0.0, 0.0, cosine, sine, 0.0, 0.0, 0.0], within(fastest.upper())));
        bounds.push((vec![0.0, 0.0, 0.0, 0.0, cosine, sine, 0.0], within(error)));
    }
    let mut template = Template::boxes(sides.len());
    let places: Vec<Option<usize>> =
        bounds.iter().map(|(direction, _)| template.add(direction.clone())).collect();
    let mut start = Polytope::around(template, &sides);
    for (place, (_, bound)) in places.into_iter().zip(bounds) {
        start.cut(place?, bound);
    }
    StateSet::from_polytope(start.tightened()?)
}
