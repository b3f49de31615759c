//! Writing the trajectory while a simulation runs.

use pleach_continuous::flow::Piece;

use super::flight::Flight;
use super::group::Group;
use super::settings::Settings;
use super::simulation::{Failure, Taken};
use super::{Component, Composition};
use crate::executor::Ending;
use crate::moment::Moment;
use crate::time::HybridTime;
use crate::trajectory::{Doubt, JumpRecord, Participant, Strand, Stretch, Trajectory, Why};

/// A trajectory in the making.
pub(super) struct Record {
    strands: Vec<Strand>,
    jumps: Vec<JumpRecord>,
    doubts: Vec<Doubt>,
    /// Whether doubts alone are kept.
    is_of_doubts: bool,
    /// About how large it is, in numbers.
    numbers: u64,
}

/// What a jump and a stretch take besides values, in numbers: names, lists and the like.
const OVERHEAD: u64 = 32;

impl Record {
    /// The record of a composition in its initial state.
    pub(super) fn of(composition: &Composition) -> Record {
        let strands = composition.groups.iter().map(|group| {
            let first = values_of(group, &composition.initial);
            let (slots, components) = (group.slots.clone(), group.components.clone());
            let stretch = Stretch::at(HybridTime::START, Moment::default(), first);
            Strand { slots, components, stretches: vec![stretch] }
        });
        let strands = strands.collect();
        let (jumps, doubts) = (Vec::new(), Vec::new());
        Record { strands, jumps, doubts, is_of_doubts: false, numbers: 0 }
    }

    /// One that keeps doubts alone.
    pub(super) fn of_doubts(composition: &Composition) -> Record {
        Record { is_of_doubts: true, ..Record::of(composition) }
    }

    pub(super) fn into_doubts(self) -> Vec<Doubt> {
        self.doubts
    }

    /// About how large it is, in bytes.
    pub(super) fn size(&self) -> u64 {
        8 * self.numbers
    }

    /// The group has flown.
    pub(super) fn flown(&mut self, number: usize, flight: Flight) {
        let Strand { stretches, components, .. } = &mut self.strands[number];
        let mut doubt = |from: f64, to: f64, why: Why| {
            Doubt { components: components.clone(), from, to, why }.note(&mut self.doubts);
        };
        let at = |time: f64| (flight.since + Moment::from(time)).seconds();
        for one in &flight.doubts {
            doubt(at(one.from), at(one.to), one.why.into());
        }
        for one in &flight.grazes {
            doubt(at(one.from), at(one.to), Why::Graze);
        }
        for &why in &flight.unknowns {
            doubt(flight.since.seconds(), flight.due().seconds(), why);
        }
        if self.is_of_doubts {
            return;
        }
        let Some(mut stretch) = stretches.pop() else { return };
        if !stretch.pieces.is_empty() {
            // Nothing was taken at the end of the flow before.
            let at = HybridTime { t: flight.since.seconds(), ..stretch.begin };
            let next = Stretch::at(at, flight.since, stretch.last.clone());
            stretches.push(std::mem::replace(&mut stretch, next));
        }
        let pieces = flight.pieces.iter().map(Piece::numbers).sum::<usize>();
        self.numbers += (pieces + flight.landing.len()) as u64 + OVERHEAD;
        stretch.until = (flight.since + flight.duration).seconds();
        stretch.since = flight.since;
        stretch.pieces = flight.pieces;
        stretch.last = flight.landing;
        stretches.push(stretch);
    }

    /// The group has jumped at hybrid time `at`, and the state is now this.
    pub(super) fn jumped(
        &mut self,
        at: HybridTime,
        number: usize,
        taken: &Taken,
        composition: &Composition,
        values: &[f64],
    ) {
        if self.is_of_doubts {
            return;
        }
        let first = values_of(&composition.groups[number], values);
        self.numbers += first.len() as u64 + OVERHEAD;
        let since = Moment::from(at.t);
        self.strands[number].stretches.push(Stretch::at(at.after_jump(), since, first));
        let (label, moves) = (taken.label.clone(), taken.moves.clone());
        let mut by = String::new();
        if composition.components.len() > 1 {
            for name in composition.names_of(&moves) {
                let comma = if by.is_empty() { "" } else { ", " };
                by.extend([comma, name]);
            }
        }
        self.jumps.push(JumpRecord { at, label, by, moves });
    }

    pub(super) fn into_trajectory(
        self,
        composition: &Composition,
        settings: Settings,
        horizon: f64,
        ending: Ending<Failure>,
    ) -> Trajectory {
        let participant = |(index, component): (usize, &Component)| Participant {
            name: component.name.clone(),
            locations: composition.locations(index).map(str::to_owned).collect(),
        };
        let components = &composition.components;
        Trajectory {
            variables: composition.variables.clone(),
            signals: composition.signals.clone(),
            components: components.iter().enumerate().map(participant).collect(),
            initial: components.iter().map(|component| component.blueprint.initial).collect(),
            settings,
            horizon,
            strands: self.strands,
            jumps: self.jumps,
            doubts: self.doubts,
            ending,
        }
    }
}

fn values_of(group: &Group, values: &[f64]) -> Vec<f64> {
    group.slots.iter().map(|&slot| values[slot]).collect()
}

#[cfg(test)]
mod tests {
    use pleach_continuous::flow::{Doubt as Span, Piece, Uncertainty};
    use pleach_guards::constant;

    use super::*;
    use crate::composition::field::tests::plane;

    /// A flow that begins after 8 s and takes 2.
    fn flight(pieces: usize, numbers: usize) -> Flight {
        let piece = |number: usize| {
            let start = 2.0 * number as f64 / pieces as f64;
            let mut piece = Piece::new(start, start + 2.0 / pieces as f64, 0.0, 1.0);
            piece.push((0..numbers).map(|_| 1.0), 0.0);
            piece
        };
        Flight {
            since: Moment::from(8.0),
            duration: Moment::from(2.0),
            pieces: (0..pieces).map(piece).collect(),
            landing: vec![0.0; numbers],
            lines: Vec::new(),
            doubts: vec![Span { from: 0.25, to: 0.5, why: Uncertainty::Touch }],
            grazes: vec![Span { from: 1.25, to: 1.5, why: Uncertainty::Touch }],
            unknowns: vec![Why::Field],
            must_leave: false,
            halt: None,
        }
    }

    /// Eight bytes for each number, and a little more.
    #[test]
    fn the_size_of_a_record_is_that_of_its_numbers() {
        let plane = plane([constant(0.0), constant(0.0)]);
        let mut record = Record::of(&plane);
        assert_eq!(record.size(), 0);
        let mut numbers = 0;
        for (pieces, terms) in [(1, 1000), (3, 500), (100, 10)] {
            record.flown(0, flight(pieces, terms));
            numbers += (pieces + 1) * terms;
            let more = record.size() / 8 - numbers as u64;
            assert!((1..1000).contains(&more), "{more}");
        }
        let before = record.size();
        let taken = Taken { label: "never".to_owned(), moves: Vec::new(), changes: Vec::new() };
        record.jumped(HybridTime { t: 10.0, j: 0 }, 0, &taken, &plane, &[0.0; 2]);
        assert!((1..100).contains(&((record.size() - before) / 8)));
    }

    /// Where nothing is taken at the end of a flow, the next begins at the same place and at its own time.
    #[test]
    fn a_flow_that_follows_another_begins_where_that_has_ended() {
        let plane = plane([constant(0.0), constant(0.0)]);
        let mut record = Record::of(&plane);
        for since in [8.0, 10.0, 12.0] {
            record.flown(0, Flight { since: Moment::from(since), ..flight(1, 2) });
        }
        let stretches = &record.strands[0].stretches;
        let begins: Vec<_> = stretches.iter().map(|one| (one.begin.t, one.begin.j)).collect();
        assert_eq!(begins, [(0.0, 0), (10.0, 0), (12.0, 0)]);
        let spans = stretches.iter().map(|one| (one.since.seconds(), one.until));
        assert!(spans.eq([(8.0, 10.0), (10.0, 12.0), (12.0, 14.0)]));
        assert!(stretches.windows(2).all(|pair| pair[1].first == pair[0].last));
    }

    #[test]
    fn doubts_of_a_flow_are_told_in_the_time_of_the_run() {
        let plane = plane([constant(0.0), constant(0.0)]);
        let mut record = Record::of(&plane);
        record.flown(0, flight(1, 2));
        let found = record.doubts.iter().map(|doubt| (doubt.from, doubt.to, doubt.why));
        let found: Vec<_> = found.collect();
        assert!(found.contains(&(8.25, 8.5, Why::Touch)), "{found:?}");
        assert!(found.contains(&(9.25, 9.5, Why::Graze)), "{found:?}");
        assert!(found.contains(&(8.0, 10.0, Why::Field)), "{found:?}");
        let stretch = record.strands[0].stretches.last().expect("there is one");
        assert_eq!((stretch.since, stretch.until), (Moment::from(8.0), 10.0));
    }
}
