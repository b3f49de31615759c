//! The body of a robot: where it is, how it moves, and for how long it has made no progress.

use std::collections::VecDeque;

use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::{Point, Vector};

/// A robot that returns to one of this many previous places counts as standing still.
const RESTING_PLACES: usize = 8;

/// The continuous state of a robot: x, with ẋ = u between jumps, and its clock, with τ̇ = 1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Body {
    /// x.
    position: Point,
    /// u.
    velocity: Vector,
    /// Where its move ends.
    arrival: Point,
    /// τ.
    clock: f64,
    /// Where it has been, from the last place on, each off those before.
    resting_places: VecDeque<Point>,
    still_periods: u32,
}

impl Body {
    /// At rest.
    pub(super) fn at(position: Point, clock: f64) -> Self {
        Body {
            position,
            velocity: Vector::zeros(),
            arrival: position,
            clock,
            resting_places: VecDeque::from([position]),
            still_periods: 0,
        }
    }

    /// x.
    pub(super) const fn position(&self) -> Point {
        self.position
    }

    /// τ: seconds since the last sample.
    pub(super) const fn clock(&self) -> f64 {
        self.clock
    }

    /// Control periods without progress.
    pub(super) const fn still_periods(&self) -> u32 {
        self.still_periods
    }

    /// What it waits for has changed.
    pub(super) const fn count_still_periods_anew(&mut self) {
        self.still_periods = 0;
    }

    /// Whether u is not 0.
    pub(super) fn is_moving(&self) -> bool {
        self.velocity != Vector::zeros()
    }

    /// It has measured that it is at `position`.
    pub(super) const fn correct(&mut self, position: Point) {
        (self.position, self.arrival) = (position, position);
    }

    /// It stands at `position`, and has made no progress for this many control periods.
    pub(super) fn stand_at(&mut self, position: Point, still_periods: u32) {
        self.correct(position);
        self.resting_places = VecDeque::from([position]);
        self.still_periods = still_periods;
    }

    /// A control period begins: it moves no more.
    pub(super) fn restart_clock(&mut self) {
        self.velocity = Vector::zeros();
        self.clock = 0.0;
    }

    /// Seconds until its move is over, which takes a control period.
    pub(super) const fn time_to_arrival(&self, period: f64) -> f64 {
        (period - self.clock).max(0.0)
    }

    /// Between jumps: ẋ = u, τ̇ = 1 (eq. 23), integrated exactly; after Δt, a control period, the robot is where
    /// its certified move ends, to the last bit.
    pub(super) fn advance(&mut self, duration: f64, period: f64) {
        self.clock += duration;
        self.position = match self.time_to_arrival(period) > 0.0 {
            true => self.position + self.velocity * duration,
            false => self.arrival,
        };
    }

    /// It moves along a segment in a control period of this many seconds. Moving back and forth between a few places,
    /// each within `leash` of another, counts as standing still, too.
    pub(super) fn set_off(&mut self, segment: Segment, leash: f64, period: f64) {
        if self.resting_places.iter().all(|place| (segment.to - place).norm() > leash) {
            self.resting_places.truncate(RESTING_PLACES - 1);
            self.resting_places.push_front(segment.to);
            self.still_periods = 0;
        } else {
            self.still_periods = self.still_periods.saturating_add(1);
        }
        self.velocity = (segment.to - segment.from) / period;
        self.arrival = segment.to;
    }

    /// It stays where it is until the next sample, which every certified move allows.
    pub(super) fn stay(&mut self) {
        self.velocity = Vector::zeros();
        self.arrival = self.position;
    }
}

#[cfg(test)]
impl Body {
    /// It has been carried to `position`.
    pub(super) fn is_at(&mut self, position: Point) {
        self.correct(position);
    }

    /// It has set off with this velocity.
    pub(super) fn is_moving_by(&mut self, velocity: Vector) {
        (self.clock, self.velocity) = (0.0, velocity);
    }

    /// It has made no progress for this many control periods.
    pub(super) fn waits(&mut self, still_periods: u32) {
        self.still_periods = still_periods;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 0.5;
    const LEASH: f64 = 0.012;

    fn at(x: f64) -> Point {
        Point::new(x, 0.0)
    }

    fn move_to(body: &Body, x: f64) -> Segment {
        Segment { from: body.position(), to: at(x) }
    }

    #[test]
    fn a_body_that_gets_nowhere_counts_the_periods() {
        let mut body = Body::at(at(0.0), PERIOD);
        let little = 1e-6;
        for (x, still_periods) in [
            (LEASH - little, 1),
            (LEASH + little, 0),
            (0.0, 1), // it has been there
            (2.0 * LEASH + 1e-3, 0),
            (3.0 * LEASH + 2e-3, 0),
            (LEASH, 1),
            (-1.5 * LEASH, 0),
            (-1.5 * LEASH, 1),
        ] {
            let segment = move_to(&body, x);
            body.set_off(segment, LEASH, PERIOD);
            body.is_at(segment.to);
            assert_eq!(body.still_periods(), still_periods, "{x}");
        }
    }

    #[test]
    fn the_end_of_a_flow_is_where_the_move_ends() {
        let mut body = Body::at(at(0.1), PERIOD);
        assert!(!body.is_moving());
        body.restart_clock();
        body.set_off(move_to(&body, 0.17), LEASH, PERIOD);
        assert!(body.is_moving());
        body.advance(PERIOD / 2.0, PERIOD);
        assert!((body.position() - at(0.135)).norm() < 1e-12);
        assert_eq!((body.clock(), body.time_to_arrival(PERIOD)), (0.25, 0.25));
        body.advance(PERIOD / 2.0, PERIOD);
        assert_eq!(body.position(), at(0.17));
    }

    #[test]
    fn a_body_that_stays_is_where_it_was() {
        let mut body = Body::at(at(0.0), PERIOD);
        body.restart_clock();
        body.set_off(move_to(&body, 0.1), LEASH, PERIOD);
        body.stay();
        assert!(!body.is_moving());
        body.advance(PERIOD, PERIOD);
        assert_eq!(body.position(), at(0.0));
    }
}
