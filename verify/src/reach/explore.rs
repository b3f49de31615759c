//! All runs at once: flows from sets, jumps where guards may hold, until nothing new is reached.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::Arc;

use pleach_guards::Interval;

use super::flow::{Exit, FlowPipe, Stretch};
use super::model::{Assignments, Dynamics, Jump, Model, Place};
use super::polytope::{Bound, Polytope, Template};
use super::region::{Conjunction, HalfSpace, Named, Region};
use super::set::StateSet;
use super::settings::{Directions, InvalidSetting, Settings};
use super::vector::{IntervalMatrix, dot};

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
    /// Whoever watched had seen enough.
    Stopped,
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
    /// How long runs have lasted, in seconds.
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

/// What a location needs for sets.
struct Prepared {
    template: Arc<Template>,
    /// What flows stay in, by the invariant: of several alternatives, nothing.
    staying: Vec<HalfSpace>,
    /// What they stay in until a jump has to be taken: the number of the jump, and the half-space.
    waiting: Vec<(usize, HalfSpace)>,
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
    let prepared = (0..model.locations().len()).map(|place| Prepared::new(model, place, settings, extra));
    let prepared = prepared.collect::<Vec<_>>();
    let mut search = Search { model, settings, prepared, visits: Vec::new(), segments: 0, watch };
    let mut open: VecDeque<Entry> = VecDeque::new();
    for (&location, start) in model.initial().iter().flat_map(|at| starts.iter().map(move |s| (at, s))) {
        let elapsed = Interval::point(0.0);
        if let Some(start) = search.inside_invariant(location, start.clone()) {
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

/// The parts of a flow in which a jump's guard may hold, not yet put together.
#[derive(Default)]
struct Crossing {
    parts: Vec<(Interval, Polytope)>,
}

impl Search<'_> {
    /// Whether an earlier visit began with all of this, at a time that leaves it as long.
    fn is_known(&self, entry: &Entry) -> bool {
        let bounds = |start: &StateSet| self.bounds(entry.location, start);
        let new = bounds(&entry.start);
        self.visits.iter().filter(|visit| visit.location == entry.location).any(|visit| {
            let in_time = self.settings.horizon.is_infinite()
                || entry.elapsed.lower() >= visit.elapsed.lower();
            in_time && visit.start.is_its_template() && bounds(&visit.start).contains(&new)
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
        let mut crossings: Vec<Crossing> = place.jumps.iter().map(|_| Crossing::default()).collect();
        let entering = self.bounds(location, &start);
        self.visits.push(Visit { location, from, depth, elapsed, start: start.clone(), segments: Vec::new() });
        let mut next = Vec::new();

        // What enters where a jump has to be taken takes it at once.
        let first = Segment { time: elapsed, set: entering.clone() };
        if (self.watch)(&self.visits[number], &first).is_break() {
            return Outcome::Broken(Completion::Stopped);
        }
        self.visits[number].segments.push(first);
        let Some(flowing) = self.kept_waiting(location, start) else {
            for (jump, crossing) in place.jumps.iter().zip(&mut crossings) {
                self.cross(jump, elapsed, &entering, crossing);
            }
            next.extend(self.landings(location, number, depth, &crossings));
            return Outcome::Ended { next, at_horizon: false };
        };
        for (at, jump) in place.jumps.iter().enumerate() {
            self.cross(jump, elapsed, &entering, &mut crossings[at]);
        }

        let remaining = self.settings.horizon - elapsed.lower();
        let template = self.prepared[location].template.clone();
        let exit = self.timed_exit(location, &flowing);
        let mut pipe = FlowPipe::new(&place.flow, self.model.variables(), &flowing, &template, self.settings, remaining, exit);
        let mut at_horizon = false;
        let is_at_rest = self.settings.horizon.is_infinite() && flowing.is_its_template();
        let origin = self.bounds(location, &flowing);
        'flow: loop {
            let Some(stretches) = pipe.advance() else { return Outcome::Broken(Completion::Diverged) };
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
                if is_at_rest && origin.contains(&Polytope::new(template.clone(), after)) {
                    break 'flow;
                }
            }
        }
        if let (Some(exit), Dynamics::Affine(flow)) = (exit, &place.flow)
            && exit.is_an_instant()
        {
            next.extend(self.timed_landings(location, number, depth, flow, &flowing, exit));
            let is_timed = |jump: &Jump| self.waits_for(location, jump, exit, &flowing);
            for (jump, crossing) in place.jumps.iter().zip(&mut crossings) {
                if is_timed(jump) {
                    crossing.parts.clear();
                }
            }
        }
        next.extend(self.landings(location, number, depth, &crossings));
        Outcome::Ended { next, at_horizon }
    }

    /// The part of a set from which time passes: where no jump has to be taken.
    fn kept_waiting(&self, location: usize, set: StateSet) -> Option<StateSet> {
        let waiting = &self.prepared[location].waiting;
        let bounds = self.bounds(location, &set);
        let half_spaces = waiting.iter().map(|(_, half_space)| half_space.clone()).collect();
        let cut = Conjunction { half_spaces, others: Vec::new() };
        let cut = cut.cut(&bounds, self.model.variables())?;
        if cut == bounds { Some(set) } else { set.cut_to(cut) }
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

    /// Adds what a jump may be taken from.
    fn cross(&self, jump: &Jump, time: Interval, set: &Polytope, crossing: &mut Crossing) {
        for alternative in &jump.guard.alternatives {
            if let Some(cut) = alternative.cut(set, self.model.variables()) {
                crossing.parts.push((time, cut));
            }
        }
    }

    /// The entries that jumps lead to.
    fn landings(&self, location: usize, number: usize, depth: usize, crossings: &[Crossing]) -> Vec<Entry> {
        let place = &self.model.locations()[location];
        let mut entries = Vec::new();
        for (at, (jump, crossing)) in place.jumps.iter().zip(crossings).enumerate() {
            if crossing.parts.is_empty() {
                continue;
            }
            let size = crossing.parts.len().div_ceil(self.settings.clusters);
            for parts in crossing.parts.chunks(size) {
                let elapsed = parts.iter().map(|(time, _)| *time).reduce(Interval::hull);
                let elapsed = elapsed.unwrap_or(Interval::WHOLE);
                if elapsed.lower() > self.settings.horizon {
                    continue;
                }
                let landed = parts.iter().filter_map(|(_, part)| self.landed(jump, part));
                let landed = landed.reduce(|mut one, other| {
                    one.join(&other);
                    one
                });
                let start = landed.and_then(StateSet::from_polytope);
                if let Some(start) = start {
                    let from = Some((number, at));
                    entries.push(Entry { location: jump.target, from, depth: depth + 1, elapsed, start });
                }
            }
        }
        entries
    }

    /// What a reset makes of a set, bounded in the directions of the target and cut to its invariant.
    fn landed(&self, jump: &Jump, part: &Polytope) -> Option<Polytope> {
        let template = self.prepared[jump.target].template.clone();
        let bounds: Vec<f64> = match &jump.reset {
            Assignments::Affine(matrix, offset) => {
                let transposed = matrix.transposed();
                let bound = |direction: &Vec<f64>| {
                    let direction: Vec<Interval> = direction.iter().map(|d| Interval::point(*d)).collect();
                    match part.support(&transposed.apply(&direction)) {
                        Bound::AtMost(bound) => {
                            Some((Interval::point(bound) + dot(&direction, offset)).upper())
                        }
                        Bound::Empty => None,
                    }
                };
                template.directions().iter().map(bound).collect::<Option<_>>()?
            }
            Assignments::Formulas(values) => {
                let sides = part.hull()?;
                let named = Named { names: self.model.variables(), sides: &sides };
                let value = |formula: &pleach_guards::Expression| formula.range(&named).unwrap_or(Interval::WHOLE);
                let values: Vec<Interval> = values.iter().map(value).collect();
                template.directions().iter().map(|d| super::polytope::over_box(d, &values)).collect()
            }
        };
        let landed = Polytope::new(template, bounds);
        self.union_of_cuts(&self.model.locations()[jump.target].invariant, &landed)
    }

    /// When a clock ends the flow: for half-spaces d · x ≤ b that the flow stays in, with d · x rising
    /// at a constant rate.
    fn timed_exit(&self, location: usize, start: &StateSet) -> Option<Exit> {
        let Dynamics::Affine(flow) = &self.model.locations()[location].flow else { return None };
        let prepared = &self.prepared[location];
        let waiting = prepared.waiting.iter().map(|(_, half_space)| half_space);
        let exits = prepared.staying.iter().chain(waiting).filter_map(|half_space| {
            reached(flow.matrix(), flow.inputs(), &half_space.direction, half_space.bound_over(start.hull()), start)
        });
        exits.reduce(|one, other| if other.until.upper() < one.until.upper() { other } else { one })
    }

    /// Whether a jump can be taken only at this instant.
    fn waits_for(&self, location: usize, jump: &Jump, exit: Exit, start: &StateSet) -> bool {
        let Dynamics::Affine(flow) = &self.model.locations()[location].flow else { return false };
        let begins = |conjunction: &Conjunction| {
            conjunction.half_spaces.iter().any(|half_space| {
                let direction: Vec<f64> = half_space.direction.iter().map(|entry| -entry).collect();
                let bound = half_space.opposite().bound_over(start.hull());
                let opens = reached(flow.matrix(), flow.inputs(), &direction, bound, start);
                opens.is_some_and(|opens| opens.until.lower() >= exit.until.lower())
            })
        };
        !jump.guard.alternatives.is_empty() && jump.guard.alternatives.iter().all(begins)
    }

    /// The entries that jumps at an instant lead to: the sets are carried there as zonotopes.
    fn timed_landings(
        &self,
        location: usize,
        number: usize,
        depth: usize,
        flow: &super::affine::AffineFlow,
        start: &StateSet,
        exit: Exit,
    ) -> Vec<Entry> {
        let place = &self.model.locations()[location];
        let elapsed = self.visits[number].elapsed + exit.until;
        let mut entries = Vec::new();
        if elapsed.lower() > self.settings.horizon {
            return entries;
        }
        let generators = self.settings.generators * self.model.variables().len();
        let mut arrived: Option<StateSet> = None;
        for (at, jump) in place.jumps.iter().enumerate() {
            if !self.waits_for(location, jump, exit, start) {
                continue;
            }
            let arrived = arrived.get_or_insert_with(|| {
                StateSet::from_zonotope(flow.after(&start.to_zonotope(), exit.until, generators))
            });
            let bounds = self.bounds(location, arrived);
            let staying = self.staying(location, &bounds);
            let cut = staying.and_then(|staying| self.union_of_cuts(&jump.guard, &staying));
            let Some(cut) = cut else { continue };
            let Some(landed) = self.landed(jump, &cut) else { continue };
            let landed = match (&jump.reset, StateSet::from_polytope(landed)) {
                (Assignments::Affine(matrix, offset), Some(set)) => {
                    let zonotope = arrived.to_zonotope().mapped(matrix, &middles(offset));
                    let mut zonotope = zonotope.reduced(generators);
                    zonotope.widen(&offset.iter().map(|side| super::vector::radius(*side)).collect::<Vec<_>>());
                    Some(set.within(zonotope))
                }
                (_, set) => set,
            };
            if let Some(start) = landed {
                entries.push(Entry { location: jump.target, from: Some((number, at)), depth: depth + 1, elapsed, start });
            }
        }
        entries
    }
}

fn middles(box_sides: &[Interval]) -> Vec<Interval> {
    box_sides.iter().map(|side| Interval::point(side.midpoint())).collect()
}

/// When d · x, which rises at a constant rate, comes to `bound`.
fn reached(
    matrix: &IntervalMatrix,
    inputs: &super::zonotope::Zonotope,
    direction: &[f64],
    bound: f64,
    start: &StateSet,
) -> Option<Exit> {
    // No variable of d · x enters its rate.
    let is_constant = direction.iter().enumerate().filter(|(_, entry)| **entry != 0.0).all(|(row, _)| {
        matrix.row(row).iter().all(|entry| *entry == Interval::point(0.0))
    });
    if !is_constant {
        return None;
    }
    let direction: Vec<Interval> = direction.iter().map(|entry| Interval::point(*entry)).collect();
    let rate = dot(&direction, &inputs.hull());
    let least = -start.support(&direction.iter().map(|entry| -*entry).collect::<Vec<_>>());
    let begin = Interval::new(least, start.support(&direction)).ok()?;
    let left = Interval::point(bound) - begin;
    (rate.lower() > 0.0).then(|| {
        let until = left / rate;
        let until = Interval::new(until.lower().max(0.0), until.upper().max(0.0)).unwrap_or(Interval::WHOLE);
        Exit { until }
    })
}

impl Prepared {
    fn new(model: &Model, number: usize, settings: &Settings, extra: &[Vec<f64>]) -> Self {
        let place = &model.locations()[number];
        let dimension = model.variables().len();
        let mut template = match &settings.directions {
            Directions::Boxes => Template::boxes(dimension),
            Directions::Octagons => Template::octagons(dimension),
            Directions::Listed(listed) => {
                let mut template = Template::boxes(dimension);
                listed.iter().for_each(|direction| template.add_both(direction));
                template
            }
        };
        let add = |template: &mut Template, region: &Region| {
            for conjunction in &region.alternatives {
                conjunction.half_spaces.iter().for_each(|half_space| half_space.add_to(template));
            }
        };
        add(&mut template, &place.invariant);
        for jump in &place.jumps {
            add(&mut template, &jump.guard);
            add(&mut template, &model.locations()[jump.target].invariant);
        }
        extra.iter().for_each(|direction| template.add_both(direction));
        let staying = match &place.invariant.alternatives[..] {
            [only] => only.half_spaces.clone(),
            _ => Vec::new(),
        };
        Prepared { template: Arc::new(template), staying, waiting: Prepared::waiting(place) }
    }

    /// A jump that has to be taken where one affine comparison holds keeps flows out of there.
    fn waiting(place: &Place) -> Vec<(usize, HalfSpace)> {
        let forced = place.jumps.iter().enumerate().filter(|(_, jump)| jump.is_forced);
        let alone = forced.filter_map(|(number, jump)| match &jump.guard.alternatives[..] {
            [Conjunction { half_spaces, others }] if others.is_empty() => match &half_spaces[..] {
                [only] => Some((number, only.opposite())),
                _ => None,
            },
            _ => None,
        });
        alone.collect()
    }
}
