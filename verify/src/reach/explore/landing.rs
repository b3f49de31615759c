//! Where jumps are taken from, and where they lead.

use pleach_automaton::NewValue;
use pleach_guards::Interval;

use super::{Entry, Search};
use crate::reach::affine::AffineFlow;
use crate::reach::exponential::exponential;
use crate::reach::flow::Exit;
use crate::reach::model::{Assignments, Dynamics, Jump};
use crate::reach::polytope::{Bound, Polytope, over_box};
use crate::reach::region::{Conjunction, Named};
use crate::reach::rounding::plus_up;
use crate::reach::set::StateSet;
use crate::reach::vector::{IntervalMatrix, dot, radius};
use crate::reach::zonotope::Zonotope;

/// The parts of a flow in which a jump's guard may hold, not yet merged.
#[derive(Default)]
pub(super) struct Crossing {
    pub parts: Vec<(Interval, Polytope)>,
}

impl Search<'_> {
    /// Adds what a jump may be taken from.
    pub(super) fn cross(
        &self,
        jump: &Jump,
        time: Interval,
        set: &Polytope,
        crossing: &mut Crossing,
    ) {
        for alternative in &jump.guard.alternatives {
            if let Some(cut) = alternative.cut(set, self.model.variables()) {
                crossing.parts.push((time, cut));
            }
        }
    }

    /// The entries that jumps lead to.
    pub(super) fn landings(
        &self,
        location: usize,
        number: usize,
        depth: usize,
        crossings: &[Crossing],
    ) -> Vec<Entry> {
        let place = &self.model.locations()[location];
        let mut entries = Vec::new();
        for (at, (jump, crossing)) in place.jumps.iter().zip(crossings).enumerate() {
            if crossing.parts.is_empty() {
                continue;
            }
            let size = crossing.parts.len().div_ceil(self.settings.clusters);
            for parts in crossing.parts.chunks(size) {
                let elapsed = parts.iter().map(|(time, _)| *time).reduce(Interval::hull);
                let elapsed = elapsed.and_then(|elapsed| self.settings.in_time(elapsed));
                let Some(elapsed) = elapsed else { continue };
                let landed = parts.iter().filter_map(|(_, part)| self.landed(jump, part));
                let landed = landed.reduce(|mut one, other| {
                    one.join(&other);
                    one
                });
                let start = landed.and_then(StateSet::from_polytope);
                if let Some(start) = start {
                    let from = Some((number, at));
                    entries.push(Entry {
                        location: jump.target,
                        from,
                        depth: depth + 1,
                        elapsed,
                        start,
                    });
                }
            }
        }
        entries
    }

    /// What a reset makes of a set, bounded in the directions of the target, as far as it can enter.
    pub(super) fn landed(&self, jump: &Jump, part: &Polytope) -> Option<Polytope> {
        let template = self.prepared[jump.target].template.clone();
        let bounds: Vec<f64> = match &jump.reset {
            Assignments::Affine(matrix, offset) => {
                let transposed = matrix.transposed();
                let bound = |direction: &Vec<f64>| {
                    let direction: Vec<Interval> =
                        direction.iter().map(|d| Interval::point(*d)).collect();
                    match part.support(&transposed.apply(&direction)) {
                        Bound::AtMost(bound) => {
                            Some(plus_up(bound, dot(&direction, offset).upper()))
                        }
                        Bound::Empty => None,
                    }
                };
                template.directions().iter().map(bound).collect::<Option<_>>()?
            }
            Assignments::Formulas(values) => {
                let sides = part.hull()?;
                let named = Named { names: self.model.variables(), sides: &sides };
                let range = |formula: &pleach_guards::Expression| {
                    formula.range(&named).unwrap_or(Interval::WHOLE)
                };
                let value = |value: &NewValue| {
                    let ranges = value.formulas().map(range);
                    ranges.reduce(Interval::hull).unwrap_or(Interval::WHOLE)
                };
                let values: Vec<Interval> = values.iter().map(value).collect();
                template.directions().iter().map(|d| over_box(d, &values)).collect()
            }
        };
        let landed = Polytope::new(template, bounds);
        if !self.settings.enters_invariants {
            return Some(landed);
        }
        self.union_of_cuts(&self.model.locations()[jump.target].invariant, &landed)
    }

    /// When a clock ends the flow: for half-spaces d · x ≤ b that the flow stays in, with d · x rising
    /// at a constant rate.
    pub(super) fn timed_exit(&self, location: usize, start: &StateSet) -> Option<Exit> {
        let Dynamics::Affine(flow) = &self.model.locations()[location].flow else { return None };
        let prepared = &self.prepared[location];
        let waiting = prepared.waiting.iter().map(|(_, half_space)| half_space);
        let exits = prepared.staying.iter().chain(waiting).filter_map(|half_space| {
            reached(
                flow.matrix(),
                flow.inputs(),
                &half_space.direction,
                half_space.bound_over(start.hull()),
                start,
            )
        });
        exits.reduce(|one, other| if other.until.upper() < one.until.upper() { other } else { one })
    }

    /// Whether a jump can be taken only at this instant.
    pub(super) fn waits_for(
        &self,
        location: usize,
        jump: &Jump,
        exit: Exit,
        start: &StateSet,
    ) -> bool {
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

    /// The states at an instant, bounded in the directions of a location by those of a polytope that the
    /// flow brings there: sharper than its zonotope.
    fn moved_bounds(
        &self,
        location: usize,
        flow: &AffineFlow,
        start: &StateSet,
        exit: Exit,
    ) -> Option<Polytope> {
        start.polytope()?;
        let nothing = vec![Interval::point(0.0); start.hull().len()];
        let generators = self.settings.generators * nothing.len();
        let added = flow.after(&Zonotope::from_box(&nothing), exit.until, generators);
        let moved = exponential(&flow.matrix().map(|entry| entry * exit.until)).transposed();
        let template = self.prepared[location].template.clone();
        let bound = |direction: &Vec<f64>| {
            let direction: Vec<Interval> = direction.iter().map(|d| Interval::point(*d)).collect();
            let brought = start.support(&moved.apply(&direction));
            plus_up(brought, added.support(&direction))
        };
        let bounds = template.directions().iter().map(bound).collect();
        Some(Polytope::new(template, bounds))
    }

    /// The entries that jumps at an instant lead to: the sets are carried there as zonotopes.
    pub(super) fn timed_landings(
        &self,
        location: usize,
        number: usize,
        depth: usize,
        flow: &AffineFlow,
        start: &StateSet,
        exit: Exit,
    ) -> Vec<Entry> {
        let place = &self.model.locations()[location];
        let mut entries = Vec::new();
        let elapsed = self.visits[number].elapsed + exit.until;
        let Some(elapsed) = self.settings.in_time(elapsed) else { return entries };
        let generators = self.settings.generators * self.model.variables().len();
        let mut arrived: Option<StateSet> = None;
        for (at, jump) in place.jumps.iter().enumerate() {
            if !self.waits_for(location, jump, exit, start) {
                continue;
            }
            let arrived = arrived.get_or_insert_with(|| {
                StateSet::from_zonotope(flow.after(&start.to_zonotope(), exit.until, generators))
            });
            let mut bounds = self.bounds(location, arrived);
            if let Some(moved) = self.moved_bounds(location, flow, start, exit) {
                bounds = bounds.intersection(&moved);
            }
            let staying = self.staying(location, &bounds);
            let cut = staying.and_then(|staying| self.union_of_cuts(&jump.guard, &staying));
            let Some(cut) = cut else { continue };
            let Some(landed) = self.landed(jump, &cut) else { continue };
            let landed = match (&jump.reset, StateSet::from_polytope(landed)) {
                (Assignments::Affine(matrix, offset), Some(set)) => {
                    let zonotope = arrived.to_zonotope().mapped(matrix, &middles(offset));
                    let mut zonotope = zonotope.reduced(generators);
                    zonotope.widen(&offset.iter().map(|side| radius(*side)).collect::<Vec<_>>());
                    Some(set.within(zonotope))
                }
                (_, set) => set,
            };
            if let Some(start) = landed {
                entries.push(Entry {
                    location: jump.target,
                    from: Some((number, at)),
                    depth: depth + 1,
                    elapsed,
                    start,
                });
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
    inputs: &Zonotope,
    direction: &[f64],
    bound: f64,
    start: &StateSet,
) -> Option<Exit> {
    // No variable of d · x enters its rate.
    let is_constant = direction
        .iter()
        .enumerate()
        .filter(|(_, entry)| **entry != 0.0)
        .all(|(row, _)| matrix.row(row).iter().all(|entry| *entry == Interval::point(0.0)));
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
        let until = Interval::new(until.lower().max(0.0), until.upper().max(0.0))
            .unwrap_or(Interval::WHOLE);
        Exit { until }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{fraction, holds, points};

    /// A clock of rate 3 comes from 0.1 to 1 after an instant that is no number.
    #[test]
    fn the_instant_of_a_clock_is_covered() {
        let matrix = IntervalMatrix::zero(1, 1);
        for rate in [3.0, 0.7] {
            let inputs = Zonotope::from_box(&points(&[rate]));
            let start = StateSet::from_box(points(&[0.1]));
            let exit = reached(&matrix, &inputs, &[1.0], 1.0, &start).expect("it rises");
            let exact = (fraction(1.0) - fraction(0.1)) / fraction(rate);
            assert!(holds(exit.until, &exact), "{}", exit.until);
        }
    }
}
