//! Rates with kinks: a solver follows smooth rates, each on the side of every kink that is held, up to
//! where the state passes a kink. Kinks on curves are searched for; of those on lines, such as the points
//! of a table over time, the instants are known.

use std::cell::{Cell, RefCell};
use std::convert::Infallible;

use pleach_continuous::flow::{
    Curve, Doubt, EventSearch, Onset, Piece, Uncertainty, Watch, isolate,
};
use pleach_guards::{Course, Enclosure, EvaluationError, Expression, Sides, Tracker, Verdict};

use super::Component;
use super::blueprint::{Mode, ModeMotion};
use super::field::Row;
use super::kinks::{Kinks, Motion};

/// The sides of kinks in the field of a group.
pub(super) struct Hold<'a> {
    /// By moving component: what is held of it.
    parts: Vec<Option<Part<'a>>>,
    /// A state of the group, and the sides of all parts behind it.
    values: RefCell<Vec<f64>>,
    is_active: Cell<bool>,
}

/// What is held of a component.
struct Part<'a> {
    sides: &'a Sides,
    /// Where all its kinks are on lines: these. Sides are then chosen right behind an instant, and are held
    /// whatever else is.
    known: Option<Vec<&'a Kinks>>,
    /// Where its coordinates are among the values, and where its sides are.
    slots: Vec<usize>,
    /// Where its rates go.
    targets: Vec<usize>,
    /// Room for its coordinates and sides, the places of its tape and its rates.
    room: RefCell<[Vec<f64>; 3]>,
}

/// It cannot be said where a kink is passed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unclear;

/// How many spans of a step are looked at for kinks.
const MOST_SPANS: u64 = 100_000;

impl<'a> Hold<'a> {
    /// What has to be held of these components: rates with kinks that are not known beforehand, and rates
    /// that jump.
    pub(super) fn of(moving: &[(&'a Component, &'a Mode)], rows: &[Row]) -> Option<Box<Self>> {
        let mut count = rows.len();
        let mut part = |(component, mode): &(&'a Component, &'a Mode)| {
            let (Some(sides), ModeMotion::Rates(rates)) = (&mode.sides, &mode.motion) else {
                return None;
            };
            let is_line = |place: usize| matches!(rows[component.places[place]], Row::Line(_));
            let known = rates.iter().flat_map(|rate| &rate.kinks);
            let known: Vec<_> = known.filter(|kinks| kinks.are_known(is_line)).collect();
            let known = (known.len() == sides.kinks()).then_some(known);
            if known.as_ref().is_some_and(|known| !known.iter().any(|kinks| kinks.are_jumps())) {
                return None;
            }
            let own = count..count + sides.count();
            count = own.end;
            let mut places = sides.smooth().places();
            places.shrink_to_fit();
            Some(Part {
                sides,
                known,
                slots: component.places.iter().copied().chain(own).collect(),
                targets: rates.iter().map(|rate| component.places[rate.coordinate]).collect(),
                room: RefCell::new([Vec::new(), places, vec![0.0; rates.len()]]),
            })
        };
        let has_any = moving.iter().any(|(_, mode)| mode.sides.is_some());
        let parts: Vec<_> =
            if has_any { moving.iter().map(&mut part).collect() } else { Vec::new() };
        if parts.iter().all(Option::is_none) {
            return None;
        }
        let (values, is_active) = (RefCell::new(vec![f64::NAN; count]), Cell::new(false));
        Some(Box::new(Hold { parts, values, is_active }))
    }

    /// Whether kinks of this moving component are searched for.
    pub(super) fn searches(&self, number: usize) -> bool {
        self.parts[number].as_ref().is_some_and(Part::is_searched)
    }

    /// The parts of which kinks are searched for.
    fn searched(&self) -> impl Iterator<Item = &Part<'a>> {
        self.parts.iter().flatten().filter(|part| part.is_searched())
    }

    /// Whether rates are those of the sides that are held, and not as they are.
    pub(super) fn is_active(&self) -> bool {
        self.is_active.get()
    }

    /// Holds the sides that hold at a time, in the state there: the first formula with a kink that is on
    /// another side than before, if there is one. `line` says of variables how they move along lines.
    pub(super) fn choose(
        &self,
        time: f64,
        state: &[f64],
        line: Motion<'_>,
    ) -> Option<&'a Expression> {
        self.is_active.set(true);
        let values = &mut *self.values.borrow_mut();
        values[..state.len()].copy_from_slice(state);
        let mut changed = None;
        for part in self.parts.iter().flatten() {
            let [own, ..] = &mut *part.room.borrow_mut();
            let behind = part.behind(time, line);
            let moved = |slot: usize| {
                let (first, rate) = line(slot)?;
                Some(first + rate * behind?)
            };
            own.clear();
            own.extend(part.slots.iter().map(|&slot| moved(slot).unwrap_or(values[slot])));
            changed = changed.or(part.sides.choose(own));
            part.slots.iter().zip(own).for_each(|(&slot, value)| values[slot] = *value);
        }
        changed
    }

    /// Lets rates be as they are.
    pub(super) fn release(&self) {
        self.is_active.set(false);
    }

    /// Writes the rates of a moving component on the sides that are held, if any are.
    pub(super) fn add_rates(&self, number: usize, state: &[f64], rates: &mut [f64]) -> bool {
        let is_held = |part: &&Part<'a>| self.is_active.get() || !part.is_searched();
        let Some(part) = self.parts[number].as_ref().filter(is_held) else { return false };
        let (values, dimension) = (self.values.borrow(), state.len());
        let [own, places, change] = &mut *part.room.borrow_mut();
        own.clear();
        let value = |&slot: &usize| if slot < dimension { state[slot] } else { values[slot] };
        own.extend(part.slots.iter().map(value));
        part.sides.smooth().evaluate(own, places, change);
        part.targets.iter().zip(change).for_each(|(&target, change)| rates[target] = *change);
        true
    }

    /// Where on a piece of the solution the state first is beyond a kink.
    ///
    /// # Errors
    ///
    /// [`Unclear`] if this cannot be said: a formula has no value, or there are too many kinks.
    pub(super) fn passed(&self, piece: &Piece) -> Result<Option<Onset>, Unclear> {
        if self.searched().next().is_none() {
            return Ok(None);
        }
        let piece = piece.clone().without_errors();
        let mut passage = Passage { hold: self, states: Vec::new() };
        let (search, mut spans) = (EventSearch::default(), MOST_SPANS);
        let found = isolate(&piece, piece.start(), piece.end(), &search, &mut passage, &mut spans);
        found.onset.map_err(|_| Unclear)
    }

    /// The spans of a piece of the solution in which its error hides whether the state passes a jump of
    /// the rates: it comes to one and turns.
    pub(super) fn grazes(&self, piece: &Piece) -> Vec<Doubt> {
        if self.searched().all(|part| part.sides.jumps().is_none()) {
            return Vec::new();
        }
        let mut graze = Graze { hold: self, states: Vec::new() };
        let (search, mut spans) = (EventSearch::default(), MOST_SPANS);
        let found = isolate(piece, piece.start(), piece.end(), &search, &mut graze, &mut spans);
        let throughout = Doubt { from: piece.start(), to: piece.end(), why: Uncertainty::Touch };
        if found.onset.is_ok() { found.doubts } else { vec![throughout] }
    }

    /// What is known of something about the sides of all parts, of which one is enough.
    fn course(
        &self,
        states: &[Enclosure],
        room: &mut Vec<Enclosure>,
        half_width: f64,
        of: impl Fn(&'a Sides) -> Option<&'a Tracker>,
    ) -> Course {
        let values = self.values.borrow();
        room.clear();
        room.extend_from_slice(states);
        room.extend(values[states.len()..].iter().map(|side| Enclosure::constant(*side)));
        self.searched().fold(Course::Never, |course, part| match of(part.sides) {
            Some(tracker) => {
                course.or(tracker.course(room, &part.slots, half_width, 0.0, &|_| None))
            }
            None => course,
        })
    }
}

impl Part<'_> {
    fn is_searched(&self) -> bool {
        self.known.is_none()
    }

    /// A time so soon after this one that no instant lies between them, if all instants are known. What
    /// is within rounding of the time is over.
    fn behind(&self, time: f64, line: Motion<'_>) -> Option<f64> {
        let motion = |coordinate: usize| line(self.slots[coordinate]);
        let rounding = |kinks: &&Kinks| kinks.rounding(time, &motion);
        let largest = self.known.as_ref()?.iter().map(rounding).fold(0.0, f64::max);
        Some(time + 2.0 * largest)
    }
}

/// Whether a kink is passed, followed over time.
struct Passage<'h, 'a> {
    hold: &'h Hold<'a>,
    states: Vec<Enclosure>,
}

impl<'a> Watch for Passage<'_, 'a> {
    type Error = EvaluationError;

    fn verdict(&mut self, state: &[f64]) -> Result<Verdict, EvaluationError> {
        let values = &mut *self.hold.values.borrow_mut();
        values[..state.len()].copy_from_slice(state);
        self.hold.searched().try_fold(Verdict::NEVER, |verdict, part| {
            Ok(verdict.or(part.sides.passed().evaluate_at(values, &part.slots)?))
        })
    }

    fn course(&mut self, states: &[Enclosure], half_width: f64) -> Course {
        let passed = |sides: &'a Sides| Some(sides.tracker());
        self.hold.course(states, &mut self.states, half_width, passed)
    }
}

/// Whether it can be told, from the course alone, when a jump of the rates is passed.
struct Graze<'h, 'a> {
    hold: &'h Hold<'a>,
    states: Vec<Enclosure>,
}

impl Watch for Graze<'_, '_> {
    type Error = Infallible;

    /// Nothing is looked for: what is left in doubt is what counts.
    fn verdict(&mut self, _state: &[f64]) -> Result<Verdict, Infallible> {
        Ok(Verdict::NEVER)
    }

    fn course(&mut self, states: &[Enclosure], half_width: f64) -> Course {
        match self.hold.course(states, &mut self.states, half_width, Sides::jumps) {
            course @ (Course::Open | Course::Blurred) => course,
            _ => Course::Never,
        }
    }
}
