//! Runs that slide: they jump to and fro over a boundary to which the flows of both sides lead.

use pleach_guards::{Enclosure, Interval};

use super::{Halt, Move, Simulation};
use crate::composition::blueprint::Condition;
use crate::executor::Sliding;

/// By how much two shares of one mixture of flows may differ, as they are rounded.
const SHARE_TOLERANCE: f64 = 1e-6;
/// After how many jumps in a row to and fro, with no more than rounding between them, a run is known to
/// slide, however long they take.
const CHATTERING: u32 = 64;
/// How many roundings lie between two such jumps at most.
const ROUNDINGS: f64 = 64.0;
/// A margin that is a larger part of the state is looked at no further.
const NEAR: f64 = 1e-6;

/// The margin of a comparison where the state is.
struct Slope {
    margin: f64,
    /// By how much it is rounded.
    rounding: f64,
    /// How fast it rises, per second.
    rate: f64,
}

impl Simulation<'_> {
    /// Counts jumps of a group to and fro over a boundary, with no more than rounding between them.
    pub(super) fn watch_chattering(&mut self, group: usize) -> Result<(), Halt> {
        let is_chattering = self.is_chattering(group);
        let state = &mut self.groups[group];
        state.chattering = if is_chattering { state.chattering + 1 } else { 0 };
        if state.chattering < CHATTERING {
            return Ok(());
        }
        self.sliding(group).map_or(Ok(()), |sliding| Err(Halt::Sliding(sliding)))
    }

    /// Whether the last jump of a group undoes the one before, where the state has not moved away from
    /// the boundary by more than rounding: that of the margin, and that of the instant.
    fn is_chattering(&self, group: usize) -> bool {
        let Some([there, back]) = self.returning(group) else { return false };
        let component = &self.composition.components[there.component];
        let guard = self.guard_of(&there);
        let largest =
            component.slots.iter().map(|&slot| self.values[slot].abs()).fold(1.0, f64::max);
        let margin =
            guard.evaluate_at(&self.values, &component.slots).map(|verdict| verdict.margin);
        if !margin.is_ok_and(|margin| margin.abs() <= NEAR * largest) {
            return false;
        }
        let instant = self.settings.resolution.max(ROUNDINGS * f64::EPSILON * self.now.seconds());
        let sides =
            self.slopes(&there, there.source).into_iter().zip(self.slopes(&there, back.source));
        sides.into_iter().any(|(here, beyond)| {
            let room = ROUNDINGS * here.rounding + (here.rate - beyond.rate) * instant;
            here.rate > 0.0 && beyond.rate < 0.0 && here.margin.abs() <= room
        })
    }

    /// Whether the last two jumps of a group go back and forth over one boundary to which the flows of
    /// both sides lead.
    pub(super) fn sliding(&self, group: usize) -> Option<Sliding> {
        let [there, back] = self.returning(group)?;
        // For each boundary that a jump crosses and both flows lead to: the share of the flow beyond
        // it in the mixture that stays on it.
        let shares = |one: &Move| -> Vec<f64> {
            let sides = self.slopes(one, one.source).into_iter().zip(self.slopes(one, one.target));
            let rates = sides.map(|(here, beyond)| (here.rate, beyond.rate));
            let met = rates.filter(|(here, beyond)| *here > 0.0 && *beyond < 0.0);
            met.map(|(here, beyond)| here / (here - beyond)).collect()
        };
        // Where the jump back crosses another boundary, the mixture that stays on the one leaves the other. Where it
        // crosses none to which both flows lead, only the first counts.
        let returning = shares(&back);
        let is_one = |share: &f64| {
            returning.is_empty()
                || returning.iter().any(|back| (share + back - 1.0).abs() < SHARE_TOLERANCE)
        };
        let share = shares(&there).into_iter().find(is_one)?;
        Some(Sliding { component: there.component, locations: [there.source, there.target], share })
    }

    /// The last two jumps of a group, if the second leads back to where the first began.
    fn returning(&self, group: usize) -> Option<[Move; 2]> {
        let [Some(there), Some(back)] = self.groups[group].latest else { return None };
        let returns = (there.source, there.target) == (back.target, back.source);
        let is_one = there.component == back.component && there.source != there.target;
        (returns && is_one).then_some([there, back])
    }

    fn guard_of(&self, one: &Move) -> &Condition {
        let mode = self.composition.components[one.component].mode(one.source);
        &mode.leaving[one.transition].guard
    }

    /// The margins of the guard of a jump where the state is, as its component moves in a location.
    fn slopes(&self, one: &Move, location: usize) -> Vec<Slope> {
        let component = &self.composition.components[one.component];
        let mut locations = self.locations.clone();
        locations[one.component] = location;
        let field = self.field(component.group, &locations);
        let rates = field.first_rates();
        let point = |(value, rate): (&f64, &f64)| {
            let rounded = Interval::new(value.next_down(), value.next_up());
            let value = rounded.unwrap_or(Interval::point(*value));
            Enclosure { middle: value, range: value, rate: Interval::point(*rate) }
        };
        let states: Vec<Enclosure> = field.start.iter().zip(&rates).map(point).collect();
        let comparisons = self.guard_of(one).tracker.comparisons().iter();
        let margins = comparisons.map(|one| one.margin(&states, &component.places, 0.0));
        margins
            .map(|margin| Slope {
                margin: margin.middle.midpoint(),
                rounding: margin.middle.width(),
                rate: margin.rate.midpoint(),
            })
            .collect()
    }
}
