//! Where jumps land: inside the invariant of their target and the declared ranges, or not.

use pleach_guards::{Predicate, Substitution, always, not};

use super::inquiry::Inquiry;
use super::reachability::Reach;
use super::report::Kind;

impl Inquiry<'_> {
    /// Jumps that land where nothing can go on, or outside the declared ranges.
    pub(super) fn report_landings(&mut self, reach: &Reach) {
        for number in (0..self.model.transitions.len()).filter(|&one| reach.is_live[one]) {
            let Some(reset) = self.model.transitions[number].substitution() else { continue };
            self.report_landing_outside(number, &reset);
            self.report_leaving_range(number, &reset);
        }
    }

    fn report_landing_outside(&mut self, number: usize, reset: &Substitution) {
        let target = self.model.transitions[number].target;
        let mode = &self.model.modes[target];
        if mode.invariant == always() {
            return;
        }
        let stuck = not(mode.invariant.clone()) & self.no_way_out(target);
        let fault = self.departing(number) & stuck.substitute(reset);
        let place = self.model.place_of(&[number]);
        if let Some(witness) = self.witness(Kind::LandsOutside, &place, &fault) {
            let message = format!(
                "it enters `{}` outside its invariant `{}`, where no transition leads on: \
                 change the guard, the reset or the invariant",
                mode.name, mode.invariant
            );
            self.error(Kind::LandsOutside, place, message, witness);
        }
    }

    fn report_leaving_range(&mut self, number: usize, reset: &Substitution) {
        let assigned = self.model.transitions[number].assignments();
        let ranges = assigned.iter().map(|(name, _)| self.model.range_of(name));
        let within = Predicate::all(ranges);
        if within == always() {
            return;
        }
        let fault = self.departing(number) & not(within.substitute(reset));
        let place = self.model.place_of(&[number]);
        if let Some(witness) = self.witness(Kind::LeavesRange, &place, &fault) {
            let message = format!(
                "its reset leaves the declared range `{within}`: \
                 change the guard, the reset or the range"
            );
            self.warn_with(Kind::LeavesRange, place, message, witness);
        }
    }
}
