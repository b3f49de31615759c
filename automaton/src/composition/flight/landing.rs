//! The end of a flight: on the side of the event on which something can happen.

use pleach_continuous::flow::Onset;

use super::Flight;
use super::search::{End, Fault, Search};
use crate::composition::halving::middle;
use crate::composition::simulation::Halt;
use crate::moment::Moment;

/// An invariant that ends at most this many spacings of the numbers around the present time after the start
/// of a flow ends at its start.
const SPACINGS: f64 = 4.0;

impl Search<'_, '_> {
    /// Ends the flight on the side of the event on which a transition can be taken; if none can and
    /// an invariant ends, on the side on which it still holds.
    pub(super) fn land(
        mut self,
        end: End,
        limit: f64,
        failed: impl Fn(Fault) -> Halt,
    ) -> Result<Flight, Halt> {
        let must_leave = matches!(end, End::Leaving(_));
        let mut known = None;
        let duration = match end {
            End::Leaving(time) => time,
            End::Never => Moment::from(limit),
            End::At(time, state) if self.can_jump_in(&state)? => {
                known = Some(state);
                time
            }
            End::At(time, _) => {
                let before = self.just_before(time.seconds(), &failed)?;
                self.unless_nothing(before, &failed)?
            }
            End::Onset(Onset { before, time }) => {
                let can_jump = self.can_jump(Moment::from(time), &failed)?;
                if can_jump { Moment::from(time) } else { self.unless_nothing(before, &failed)? }
            }
        };
        let lasting = self.noticeable(duration);
        let landing = match known.filter(|_| lasting == duration) {
            Some(state) => state,
            None => self.solver.state_at(lasting).map_err(|reason| failed(reason.into()))?,
        };
        let duration = lasting;
        let unknowns = self.solver.unknowns();
        let grazes = self.solver.grazes(duration.seconds());
        let lines = self.solver.lines();
        let pieces = self.solver.into_pieces(duration.seconds());
        Ok(Flight {
            unknowns,
            since: self.since,
            duration,
            pieces: pieces.map_err(|reason| failed(reason.into()))?,
            landing,
            lines,
            doubts: self.doubts,
            grazes,
            must_leave,
            halt: None,
        })
    }

    /// The duration, or none if nothing changes in it but for rounding: at the very start of a flow
    /// there is nothing before the end of an invariant.
    fn unless_nothing(
        &mut self,
        duration: f64,
        failed: &impl Fn(Fault) -> Halt,
    ) -> Result<Moment, Halt> {
        let moved = self.solver.state_at(Moment::from(duration));
        let moved = moved.map_err(|reason| failed(reason.into()))?;
        let is_rounding = duration <= SPACINGS * f64::EPSILON * self.since.seconds().abs();
        let is_nothing = is_rounding || moved == self.solver.start();
        Ok(if is_nothing { Moment::default() } else { Moment::from(duration) })
    }

    /// A duration that changes the time, if it is more than none.
    fn noticeable(&self, duration: Moment) -> Moment {
        let least = Moment::from(2.0 * self.spacing());
        if duration > Moment::default() && duration < least { least } else { duration }
    }

    /// The smallest change of the time that its two numbers can hold.
    pub(super) fn spacing(&self) -> f64 {
        self.since.seconds().abs() * f64::EPSILON * f64::EPSILON
    }

    fn can_jump(&mut self, time: Moment, failed: &impl Fn(Fault) -> Halt) -> Result<bool, Halt> {
        let state = self.solver.state_at(time).map_err(|reason| failed(reason.into()))?;
        Ok(self.can_jump_in(&state)?)
    }

    /// The last number of seconds before `time` at which time need not stop yet.
    fn just_before(&mut self, time: f64, failed: &impl Fn(Fault) -> Halt) -> Result<f64, Halt> {
        let mut calm = |at: f64| -> Result<bool, Halt> {
            let state = self.solver.state_at(Moment::from(at));
            let state = state.map_err(|reason| failed(reason.into()))?;
            Ok(!self.tension.conditions().tension(&state)?.holds)
        };
        let (mut after, mut step) = (time, time - time.next_down());
        let mut before = loop {
            let earlier = time - step;
            if earlier <= 0.0 {
                return Ok(0.0);
            }
            if calm(earlier)? {
                break earlier;
            }
            after = earlier;
            step *= 2.0;
        };
        while let Some(middle) = middle(before, after) {
            if calm(middle)? { before = middle } else { after = middle }
        }
        Ok(before)
    }

    /// The flow as far as it can be followed.
    pub(super) fn cut_short(
        self,
        at: f64,
        halt: Halt,
        failed: impl Fn(Fault) -> Halt,
    ) -> Result<Flight, Halt> {
        let flight = self.land(End::Never, at, failed)?;
        Ok(Flight { halt: Some(halt), ..flight })
    }
}

#[cfg(test)]
mod tests {
    use pleach_guards::variable;

    use super::super::search::tests::{search, times};
    use super::*;

    fn failed(fault: Fault) -> Halt {
        panic!("{}", fault.text)
    }

    /// The time of a run is a sum of two numbers.
    #[test]
    fn a_flight_takes_no_time_or_enough_to_change_that_of_the_run() {
        let [line, _] = times(&variable("x").at_least(50.0));
        for since in [1.0_f64, 1e6, -3.0] {
            let least = 2.0 * since.abs() * 2f64.powi(-104);
            search(&line, since, |it| {
                assert_eq!(it.spacing(), 0.5 * least);
                let noticeable = |duration: f64| it.noticeable(Moment::from(duration)).seconds();
                assert_eq!(noticeable(0.0), 0.0);
                for brief in [1e-300, 0.5 * least, 0.999 * least] {
                    assert_eq!(noticeable(brief), least);
                }
                for long in [least, 1.001 * least, 1e-6, 3.0] {
                    assert_eq!(noticeable(long), long);
                }
            });
        }
    }

    /// What is as short as a few roundings of the time is none, nor is any time in which nothing moves.
    #[test]
    fn an_end_within_rounding_of_the_start_is_at_the_start() {
        let lasting = |since: f64, duration: f64| {
            times(&variable("x").at_least(50.0)).map(|plane| {
                search(&plane, since, |mut it| {
                    it.unless_nothing(duration, &failed).expect("it has a value").seconds()
                })
            })
        };
        for since in [-2.0_f64, 1.0, 1e6] {
            let rounding = 4.0 * f64::EPSILON * since.abs();
            assert_eq!(lasting(since, 0.5 * rounding), [0.0; 2]);
            assert_eq!(lasting(since, rounding), [0.0; 2]);
            for duration in [1.01 * rounding, 1.5] {
                assert_eq!(lasting(since, duration), [duration; 2]);
            }
        }
        let [line, _] = times(&variable("x").at_least(50.0));
        let found = search(&line, 0.0, |mut it| it.unless_nothing(1e-300, &failed));
        assert_eq!(found.expect("it has a value"), Moment::from(1e-300));
        let still = crate::composition::field::tests::plane([0.0, 0.0].map(Into::into));
        let found = search(&still, 1.0, |mut it| it.unless_nothing(3.0, &failed));
        assert_eq!(found.expect("it has a value"), Moment::default());
    }

    /// x is the time, and has to stay below a bound.
    #[test]
    fn the_last_calm_number_is_found_however_far_it_is() {
        for bound in [0.5, 1.0, 1.7] {
            let [line, _] = times(&variable("x").at_least(bound));
            for time in [bound, bound.next_up(), bound + 1e-9, bound + 1e-3, 1.5 * bound] {
                let found = search(&line, 0.0, |mut it| it.just_before(time, &failed));
                assert_eq!(found.expect("it has a value"), bound.next_down(), "{time}");
            }
        }
        for time in [1e-3, 1.0, 9.0] {
            let [line, _] = times(&variable("x").at_least(0.0));
            let found = search(&line, 0.0, |mut it| it.just_before(time, &failed));
            assert_eq!(found.expect("it has a value"), 0.0, "there is none");
        }
    }
}
