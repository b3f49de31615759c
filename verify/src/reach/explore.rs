//! All runs at once: flows from sets, jumps where guards may hold, until nothing new is reached.

mod landing;
mod prepared;

use std::collections::VecDeque;
use std::fmt;
use std::ops::ControlFlow;

use pleach_guards::Interval;

use super::flow::{FlowPipe, Stretch};
use super::model::{Dynamics, Jump, Model};
use super::polytope::Polytope;
use super::region::{Conjunction, Region};
use super::set::StateSet;
use super::settings::{InvalidSetting, Settings};
use landing::Crossing;
use prepared::Prepared;

/// An enclosure of all states that runs come to.
#[derive(Clone, Debug)]
pub struct Enclosure {
    /// The visits of locations, in the order in which they were found.
    pub visits: Vec<Visit>,
    /// How it ended.
    pub ending: Completion,
}

/// How an enclosure ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Completion {
    /// It holds all states that are reached up to the horizon.
    Horizon,
    /// It holds all states that are ever reached: flows end, return to where they began, or lead
    /// to sets that were visited.
    Everything,
    /// More jumps followed each other than the settings allow.
    JumpLimit,
    /// There were more segments than the settings allow.
    SegmentLimit,
    /// A flow could not be enclosed any farther.
    Diverged,
    /// The observer has stopped the search.
    Stopped,
}

impl fmt::Display for Completion {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Completion::Horizon => "all states up to the horizon are enclosed",
            Completion::Everything => "all states at all times are enclosed",
            Completion::JumpLimit => "more jumps follow each other than `jump_limit` allows",
            Completion::SegmentLimit => "there are more sets than `segment_limit` allows",
            Completion::Diverged => {
                "a flow grows without bounds, or cannot be enclosed any farther"
            }
            Completion::Stopped => "the search was stopped",
        })
    }
}

/// A set enters a location and flows.
#[derive(Clone, Debug)]
pub struct Visit {
    /// The number of the location.
    pub location: usize,
    /// The number of the visit that it comes from, and of the jump in that visit's location.
    pub from: Option<(usize, usize)>,
    /// How many jumps came before.
    pub depth: usize,
    /// How long runs have lasted on entry, in seconds.
    pub elapsed: Interval,
    /// What enters.
    pub start: StateSet,
    /// What flows on, piece by piece.
    pub segments: Vec<Segment>,
}

/// The states of one stretch of time of a flow.
#[derive(Clone, Debug)]
pub struct Segment {
    /// How long runs have lasted, in seconds. Without a horizon, where flows and visits that were seen
    /// before are not followed again, it is how long the first ones have.
    pub time: Interval,
    /// Where they are.
    pub set: Polytope,
}

/// An entry that is still to be followed.
struct Entry {
    location: usize,
    from: Option<(usize, usize)>,
    depth: usize,
    elapsed: Interval,
    start: StateSet,
}

/// Encloses all runs of `model` that begin in one of `starts`, in any of its initial locations.
///
/// `watch` sees each segment as it is found, with the visit that it belongs to (whose own list it is
/// not in yet), and may end the search. `extra` are directions in which segments are bounded too.
///
/// # Errors
///
/// [`InvalidSetting`] if a setting makes no sense.
pub fn explore(
    model: &Model,
    starts: &[StateSet],
    settings: &Settings,
    extra: &[Vec<f64>],
    watch: &mut dyn FnMut(&Visit, &Segment) -> ControlFlow<()>,
) -> Result<Enclosure, InvalidSetting> {
    settings.check(model.variables().len())?;
    let prepared =
        (0..model.locations().len()).map(|place| Prepared::new(model, place, settings, extra));
    let prepared = prepared.collect::<Vec<_>>();
    let mut search = Search { model, settings, prepared, visits: Vec::new(), segments: 0, watch };
    let mut open: VecDeque<Entry> = VecDeque::new();
    for (&location, start) in
        model.initial().iter().flat_map(|at| starts.iter().map(move |s| (at, s)))
    {
        let elapsed = Interval::point(0.0);
        if let Some(start) = search.entering(location, start.clone()) {
            open.push_back(Entry { location, from: None, depth: 0, elapsed, start });
        }
    }
    let (mut reached_horizon, mut limit) = (false, None);
    while let Some(entry) = open.pop_front() {
        if search.is_known(&entry) {
            continue;
        }
        if entry.depth > settings.jump_limit {
            limit = Some(Completion::JumpLimit);
            continue;
        }
        match search.follow(entry) {
            Outcome::Ended { next, at_horizon } => {
                reached_horizon |= at_horizon;
                open.extend(next);
            }
            Outcome::Broken(completion) => {
                let visits = search.visits;
                return Ok(Enclosure { visits, ending: completion });
            }
        }
    }
    let complete = if reached_horizon { Completion::Horizon } else { Completion::Everything };
    Ok(Enclosure { visits: search.visits, ending: limit.unwrap_or(complete) })
}

struct Search<'a> {
    model: &'a Model,
    settings: &'a Settings,
    prepared: Vec<Prepared>,
    visits: Vec<Visit>,
    segments: usize,
    watch: &'a mut dyn FnMut(&Visit, &Segment) -> ControlFlow<()>,
}

enum Outcome {
    Ended { next: Vec<Entry>, at_horizon: bool },
    Broken(Completion),
}

impl Search<'_> {
    /// Whether an earlier visit began with all of this; up to a horizon also at the same time, so that
    /// segments say when their states are reached.
    fn is_known(&self, entry: &Entry) -> bool {
        self.visits.iter().filter(|visit| visit.location == entry.location).any(|visit| {
            let in_time = self.settings.horizon.is_infinite()
                || visit.elapsed.lower() <= entry.elapsed.lower()
                    && entry.elapsed.upper() <= visit.elapsed.upper();
            in_time && visit.start.contains(&entry.start)
        })
    }

    /// The set bounded in the directions of a location.
    fn bounds(&self, location: usize, set: &StateSet) -> Polytope {
        let template = &self.prepared[location].template;
        let bound = |direction: &Vec<f64>| {
            let direction: Vec<Interval> = direction.iter().map(|d| Interval::point(*d)).collect();
            set.support(&direction)
        };
        Polytope::new(template.clone(), template.directions().iter().map(bound).collect())
    }

    /// The part of a set that can enter a location.
    fn entering(&self, location: usize, set: StateSet) -> Option<StateSet> {
        if self.settings.enters_invariants {
            self.inside_invariant(location, set)
        } else {
            Some(set)
        }
    }

    /// The part of a set that is in the invariant of a location, and cut only where need be.
    fn inside_invariant(&self, location: usize, set: StateSet) -> Option<StateSet> {
        let bounds = self.bounds(location, &set);
        let invariant = &self.model.locations()[location].invariant;
        let cut = self.union_of_cuts(invariant, &bounds)?;
        if cut == bounds { Some(set) } else { set.cut_to(cut) }
    }

    /// The smallest polytope of the template around the part of `set` in `region`.
    fn union_of_cuts(&self, region: &Region, set: &Polytope) -> Option<Polytope> {
        let cuts = region.alternatives.iter();
        let cuts = cuts.filter_map(|alternative| alternative.cut(set, self.model.variables()));
        cuts.reduce(|mut one, other| {
            one.join(&other);
            one
        })
    }

    /// Follows the flow of an entry, and says where it jumps.
    fn follow(&mut self, entry: Entry) -> Outcome {
        let place = &self.model.locations()[entry.location];
        let Entry { location, from, depth, elapsed, start } = entry;
        let number = self.visits.len();
        self.segments += 1;
        if self.segments > self.settings.segment_limit {
            return Outcome::Broken(Completion::SegmentLimit);
        }
        let entering = self.bounds(location, &start);
        self.visits.push(Visit {
            location,
            from,
            depth,
            elapsed,
            start: start.clone(),
            segments: Vec::new(),
        });
        let mut next = Vec::new();

        // What enters outside the invariant, or where a jump has to be taken, does not flow.
        let first = Segment { time: elapsed, set: entering.clone() };
        if (self.watch)(&self.visits[number], &first).is_break() {
            return Outcome::Broken(Completion::Stopped);
        }
        self.visits[number].segments.push(first);
        let mut crossings: Vec<Crossing> =
            place.jumps.iter().map(|_| Crossing::default()).collect();
        for (jump, crossing) in place.jumps.iter().zip(&mut crossings) {
            self.cross(jump, elapsed, &entering, crossing);
        }
        let within = self.inside_invariant(location, start);
        let waiting = within.and_then(|set| self.kept_waiting(location, set));
        let Some(flowing) = waiting.filter(|set| !self.ends_at_once(location, set)) else {
            next.extend(self.landings(location, number, depth, &crossings));
            return Outcome::Ended { next, at_horizon: false };
        };
        let on_entry: Vec<usize> = crossings.iter().map(|crossing| crossing.parts.len()).collect();

        let remaining = self.settings.time_left(elapsed);
        let template = self.prepared[location].template.clone();
        let exit = self.timed_exit(location, &flowing);
        let mut pipe = FlowPipe::new(
            &place.flow,
            self.model.variables(),
            &flowing,
            &template,
            self.settings,
            remaining,
            exit,
        );
        let mut at_horizon = false;
        let is_endless = self.settings.horizon.is_infinite();
        'flow: loop {
            let Some(stretches) = pipe.advance() else {
                return Outcome::Broken(Completion::Diverged);
            };
            if stretches.is_empty() {
                at_horizon = pipe.is_at(remaining);
                break;
            }
            for Stretch { from, to, during, after } in stretches {
                self.segments += 1;
                if self.segments > self.settings.segment_limit {
                    return Outcome::Broken(Completion::SegmentLimit);
                }
                let flown = Interval::new(from, to).unwrap_or(Interval::WHOLE);
                let time = elapsed + flown;
                let whole = Polytope::new(template.clone(), during);
                let Some(set) = self.staying(location, &whole) else { break 'flow };
                for (at, jump) in place.jumps.iter().enumerate() {
                    self.cross(jump, time, &set, &mut crossings[at]);
                }
                let segment = Segment { time, set };
                if (self.watch)(&self.visits[number], &segment).is_break() {
                    return Outcome::Broken(Completion::Stopped);
                }
                self.visits[number].segments.push(segment);
                // All states are back where they began: what follows is what there was.
                if is_endless && flowing.contains_polytope(&Polytope::new(template.clone(), after))
                {
                    break 'flow;
                }
            }
        }
        if let (Some(exit), Dynamics::Affine(flow)) = (exit, &place.flow)
            && exit.is_an_instant()
        {
            next.extend(self.timed_landings(location, number, depth, flow, &flowing, exit));
            let is_timed = |jump: &Jump| self.waits_for(location, jump, exit, &flowing);
            for ((jump, crossing), on_entry) in place.jumps.iter().zip(&mut crossings).zip(on_entry)
            {
                if is_timed(jump) {
                    crossing.parts.truncate(on_entry);
                }
            }
        }
        next.extend(self.landings(location, number, depth, &crossings));
        Outcome::Ended { next, at_horizon }
    }

    /// The part of a set from which time passes: where no jump has to be taken.
    fn kept_waiting(&self, location: usize, set: StateSet) -> Option<StateSet> {
        let Prepared { waiting, is_urgent, .. } = &self.prepared[location];
        if *is_urgent {
            return None;
        }
        let bounds = self.bounds(location, &set);
        let half_spaces = waiting.iter().map(|(_, half_space)| half_space.clone()).collect();
        let cut = Conjunction { half_spaces, others: Vec::new() };
        let cut = cut.cut(&bounds, self.model.variables())?;
        if cut == bounds { Some(set) } else { set.cut_to(cut) }
    }

    /// Whether all states of a set are where the flow leaves a half-space that it has to stay in, so no time passes.
    fn ends_at_once(&self, location: usize, set: &StateSet) -> bool {
        let flow = &self.model.locations()[location].flow;
        let Prepared { staying, waiting, .. } = &self.prepared[location];
        let waiting = waiting.iter().map(|(_, half_space)| half_space);
        staying.iter().chain(waiting).any(|half_space| {
            let (opposite, bound) = (half_space.opposite(), half_space.bound_over(set.hull()));
            let inwards: Vec<Interval> =
                opposite.direction.iter().map(|entry| Interval::point(*entry)).collect();
            -set.support(&inwards) >= bound && {
                let rates = flow.rates(self.model.variables(), set.hull());
                half_space.rate(&rates).lower() > 0.0
            }
        })
    }

    /// The part of a stretch that flows come to.
    fn staying(&self, location: usize, whole: &Polytope) -> Option<Polytope> {
        let prepared = &self.prepared[location];
        let waiting = prepared.waiting.iter().map(|(_, half_space)| half_space);
        let half_spaces = prepared.staying.iter().chain(waiting).cloned().collect();
        let cut = Conjunction { half_spaces, others: Vec::new() };
        let cut = cut.cut(whole, self.model.variables())?;
        let invariant = &self.model.locations()[location].invariant;
        if invariant.alternatives.len() == 1 && invariant.alternatives[0].others.is_empty() {
            return Some(cut);
        }
        self.union_of_cuts(invariant, &cut)
    }
}
