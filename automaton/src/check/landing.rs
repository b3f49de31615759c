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
        let outside = not(mode.invariant.clone()).substitute(reset);
        let stuck = self.no_way_out(target).substitute(reset);
        let (entry, invariant) = (&mode.name, &mode.invariant);
        let place = self.model.place_of(&[number]);
        let landing = self.departing(number) & outside;
        let fault = landing.clone() & stuck;
        if let Some(witness) = self.witness(Kind::LandsOutside, &place, &fault) {
            let message = format!(
                "it enters `{entry}` outside its invariant `{invariant}`, where no transition \
                 leads on: change the guard, the reset or the invariant"
            );
            self.error(Kind::LandsOutside, place, message, witness);
            return;
        }
        let message = |way: &str| {
            format!(
                "it enters `{entry}` outside its invariant `{invariant}`, where no time can pass \
                 and {way} leads on: enter it inside, or widen the invariant"
            )
        };
        let unforced = landing.clone() & self.no_forced_way_out(target).substitute(reset);
        if let Some(witness) = self.robust_example(&unforced) {
            let message = message("only what may be taken");
            self.warn_with(Kind::LandsOutside, place, message, witness);
        } else if let Some(witness) = self.robust_example(&landing) {
            let message = message("what has to be taken");
            self.note_with(Kind::LandsOutside, place, message, witness);
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
