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
        let duration = match end {
            End::Leaving(time) => time,
            End::Never => Moment::from(limit),
            End::At(time) if self.can_jump(time, &failed)? => time,
            End::At(time) => {
                let before = self.just_before(time.seconds(), &failed)?;
                self.unless_nothing(before, &failed)?
            }
            End::Onset(Onset { before, time }) => {
                let can_jump = self.can_jump(Moment::from(time), &failed)?;
                if can_jump { Moment::from(time) } else { self.unless_nothing(before, &failed)? }
            }
        };
        let duration = self.noticeable(duration);
        let landing = self.solver.state_at(duration).map_err(|reason| failed(reason.into()))?;
        let unknowns = self.solver.unknowns();
        let grazes = self.solver.grazes(duration.seconds());
        let pieces = self.solver.into_pieces(duration.seconds());
        Ok(Flight {
            unknowns,
            since: self.since,
            duration,
            pieces: pieces.map_err(|reason| failed(reason.into()))?,
            landing,
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
