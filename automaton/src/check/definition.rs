//! Formulas that have no value in states that a location can be in.
//!
//! A quotient has none where it divides by 0, a power with a broken exponent none of a negative
//! base, a logarithm none of a number that is not positive, and a number that is none has none
//! anywhere. What is infinite counts as no value, too: no flow can follow an infinite rate. Each
//! such place is a question: is there a state in which the formula is evaluated and lacks its value?
//!
//! Rates and guards are evaluated in all states of their location that no forced transition has
//! left, and at the very instant at which one does; resets where their transition is taken,
//! invariants wherever a run may be. Of a choice, each part is evaluated under its condition only.

use pleach_guards::{
    BinaryOperator, Choice, Comparison, Expression, Predicate, UnaryOperator, always, not,
};

use super::inquiry::Inquiry;
use super::reachability::Reach;
use super::report::{FindingPlace, Kind};

impl Inquiry<'_> {
    pub(super) fn report_undefined(&mut self, reach: &Reach) {
        let model = self.model;
        for (location, mode) in model.modes.iter().enumerate() {
            if !reach.is_reached[location] {
                continue;
            }
            let (place, there) = (model.mode_at(location), self.staying(location));
            for (name, rate) in mode.rates() {
                let what = format!("the rate of `{name}`");
                self.report_formula(&place, &there, &what, rate);
            }
            self.report_sides(&place, &always(), "the invariant", &mode.invariant);
        }
        for number in (0..model.transitions.len()).filter(|&one| reach.is_live[one]) {
            let transition = &model.transitions[number];
            let place = model.place_of(&[number]);
            let there = self.staying(transition.source);
            self.report_sides(&place, &there, "the guard", transition.guard.predicate());
            let taken = self.departing(number);
            for (name, value) in transition.assignments() {
                let what = format!("the new value of `{name}`");
                self.report_formula(&place, &taken, &what, value);
            }
            for (name, [lower, upper]) in &transition.intervals {
                let fault = taken.clone() & lower.more_than(upper);
                if let Some(witness) = self.witness(Kind::Undefined, &place, &fault) {
                    let message = format!(
                        "`{name}` has no new value where `[{lower}, {upper}]` is empty: change the \
                         guard or the ends of the interval"
                    );
                    self.warn_with(Kind::Undefined, place.clone(), message, witness);
                }
            }
        }
    }

    /// The states of a location that no forced transition has left.
    fn staying(&self, location: usize) -> Predicate {
        let mode = &self.model.modes[location];
        let forced = mode.leaving.iter().filter(|&&one| self.model.is_forced(one));
        let waiting = forced.map(|&one| self.model.transitions[one].refused());
        Predicate::all([mode.invariant.clone()].into_iter().chain(waiting))
    }

    fn report_sides(
        &mut self,
        place: &FindingPlace,
        there: &Predicate,
        what: &str,
        of: &Predicate,
    ) {
        match of {
            Predicate::Comparison(Comparison { left, right, .. }) => {
                self.report_formula(place, there, what, left);
                self.report_formula(place, there, what, right);
            }
            Predicate::Not(inner) => self.report_sides(place, there, what, inner),
            Predicate::All(parts) | Predicate::Any(parts) => {
                parts.iter().for_each(|part| self.report_sides(place, there, what, part));
            }
            _ => {}
        }
    }

    fn report_formula(
        &mut self,
        place: &FindingPlace,
        there: &Predicate,
        what: &str,
        of: &Expression,
    ) {
        let mut gaps = Vec::new();
        collect(of, always(), &mut gaps);
        for Gap { part, lacks_value } in gaps {
            // A witness must have a verdict itself: the gap is not a part of the question.
            let fault = there.clone() & lacks_value;
            if let Some(witness) = self.witness(Kind::Undefined, place, &fault) {
                let message = format!(
                    "{what}, `{of}`, has no finite value where `{part}` has none: exclude such \
                     states by an invariant or a range, or change the formula"
                );
                self.warn_with(Kind::Undefined, place.clone(), message, witness);
                return;
            }
        }
    }
}

/// A part of a formula, and where it lacks a finite value.
struct Gap {
    part: Expression,
    lacks_value: Predicate,
}

/// Adds the gaps of all parts of a formula that is evaluated where `condition` holds.
fn collect(formula: &Expression, condition: Predicate, gaps: &mut Vec<Gap>) {
    // An expression may be deep: what is still to be looked at waits on the heap.
    let mut open = vec![(formula, condition)];
    while let Some((part, condition)) = open.pop() {
        if let Some(lacks_value) = gap(part) {
            gaps.push(Gap { part: part.clone(), lacks_value: condition.clone() & lacks_value });
        }
        match part {
            Expression::Unary(_, operand)
            | Expression::Power(operand, _)
            | Expression::Lookup(_, operand) => open.push((operand, condition)),
            Expression::Binary(_, left, right) => {
                open.extend([(&**right, condition.clone()), (&**left, condition)]);
            }
            Expression::Choice(choice) => {
                let Choice { condition: chosen, then, otherwise } = &**choice;
                let holds = Predicate::Comparison(chosen.clone());
                open.push((otherwise, condition.clone() & not(holds.clone())));
                open.push((then, condition.clone() & holds));
                open.extend([(&chosen.right, condition.clone()), (&chosen.left, condition)]);
            }
            _ => {}
        }
    }
}

/// Where a part lacks a finite value though its operands have theirs.
fn gap(part: &Expression) -> Option<Predicate> {
    match part {
        Expression::Constant(value) => (!value.is_finite()).then(always),
        Expression::Unary(UnaryOperator::Logarithm, operand) => Some(operand.at_most(0.0)),
        Expression::Binary(BinaryOperator::Quotient, _, divisor) => match &**divisor {
            Expression::Constant(value) => (*value == 0.0).then(always),
            divisor => Some(divisor.at_most(0.0) & divisor.at_least(0.0)),
        },
        Expression::Power(base, exponent) => {
            let negative = base.less_than(0.0);
            let zero = base.at_most(0.0) & base.at_least(0.0);
            match (exponent % 1.0 != 0.0, *exponent < 0.0) {
                (true, true) => Some(base.at_most(0.0)),
                (true, false) => Some(negative),
                (false, true) => Some(zero),
                (false, false) => None,
            }
        }
        _ => None,
    }
}
