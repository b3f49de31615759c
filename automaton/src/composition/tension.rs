//! What makes time stop in a group: a transition that is due, or an invariant that ends.

use pleach_continuous::flow::{Curve, Piece, Watch};
use pleach_guards::{Affine, Course, Enclosure, Tracked, Tracker, Verdict};

use super::blueprint::{Condition, Leaving};
use super::field::Field;
use super::group::Group;
use super::jumps::Standing;
use super::settings::Policy;
use super::simulation::Failure;
use crate::moment::Moment;

/// By how much more than at an instant a margin may be unknown as a polynomial in time, so that shorter
/// spans are not worth looking at.
const COARSER: f64 = 64.0;

/// Which transitions count.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Readiness {
    /// Those that have to be taken.
    Forced,
    /// All.
    Possible,
}

/// The conditions of a group in its locations.
#[derive(Clone, Copy)]
pub(super) struct Conditions<'a> {
    pub(super) standing: Standing<'a>,
    pub(super) group: &'a Group,
    pub(super) policy: Policy,
    /// How far, in margins, invariants may be violated.
    pub(super) allowance: f64,
}

impl<'a> Conditions<'a> {
    /// Holds where time has to stop.
    pub(super) fn tension(&self, state: &[f64]) -> Result<Verdict, Failure> {
        let forced = self.any_transition(state, Readiness::Forced)?;
        Ok(forced.or(self.invariants(state)?.opposite()))
    }

    /// Holds where all components are within their invariants, but for what is allowed.
    pub(super) fn invariants(&self, state: &[f64]) -> Result<Verdict, Failure> {
        let mut verdict = Verdict::ALWAYS;
        for &index in &self.group.components {
            let location = self.standing.locations[index];
            if let Some(invariant) = self.invariant(index) {
                let part = || format!("the invariant `{invariant}`");
                let own = invariant
                    .evaluate_at(state, self.standing.slots(index))
                    .map_err(|fault| self.standing.formula(index, location, part(), &fault))?;
                verdict = verdict.and(own);
            }
        }
        let margin = verdict.margin + self.allowance;
        let holds = verdict.holds || (self.allowance > 0.0 && margin >= 0.0);
        Ok(Verdict { margin, holds })
    }

    /// Holds where a transition of this readiness can be taken.
    pub(super) fn any_transition(
        &self,
        state: &[f64],
        readiness: Readiness,
    ) -> Result<Verdict, Failure> {
        let mut verdict = Verdict::NEVER;
        for (index, leaving) in self.own_transitions() {
            if self.is_wanted(leaving, readiness) {
                verdict = verdict.or(self.standing.allows(index, leaving, state)?);
            }
        }
        for &label in &self.group.labels {
            verdict = verdict.or(self.label(label, state, readiness)?);
        }
        Ok(verdict)
    }

    /// Whether a transition is among those that are looked for.
    pub(super) fn is_wanted(&self, leaving: &Leaving, readiness: Readiness) -> bool {
        leaving.urgency.is_forced()
            || readiness == Readiness::Possible
            || self.policy == Policy::Early
    }

    /// Holds where the label can be taken, if any participant wants it.
    fn label(&self, label: usize, state: &[f64], readiness: Readiness) -> Result<Verdict, Failure> {
        let mut all = Verdict::ALWAYS;
        // Which part of the participants makes the label forced, depends on the state, too.
        let mut wanted = Verdict::NEVER;
        for &(index, event) in &self.standing.composition.labels[label].participants {
            let mut any = Verdict::NEVER;
            for leaving in self.standing.on_event(index, event) {
                let allowed = self.standing.allows(index, leaving, state)?;
                any = any.or(allowed);
                if self.is_wanted(leaving, readiness) {
                    wanted = wanted.or(allowed);
                }
            }
            all = all.and(any);
        }
        Ok(all.and(wanted))
    }

    fn invariant(&self, component: usize) -> Option<&'a Condition> {
        let location = self.standing.locations[component];
        self.standing.composition.components[component].mode(location).invariant.as_ref()
    }

    /// The transitions that components take by themselves.
    fn own_transitions(&self) -> impl Iterator<Item = (usize, &'a Leaving)> {
        let standing = self.standing;
        self.group.components.iter().flat_map(move |&index| {
            let labels = &standing.composition.components[index].labels;
            let is_own = |leaving: &&Leaving| labels[leaving.event].is_none();
            standing.leaving(index).iter().filter(is_own).map(move |leaving| (index, leaving))
        })
    }
}

/// The tension of a group along its flow.
pub(super) struct Tension<'a> {
    conditions: Conditions<'a>,
    /// By component of the group: what is known of its invariant, then of its transitions.
    known: Vec<Vec<Box<[Knowledge]>>>,
    /// Where the span of time begins that is looked at, up to the next switch; since the start of the flow.
    window: Moment,
    /// The margins that are polynomials, on the piece of the flow that was looked at last.
    margins: Option<Margins>,
    /// The span of time of that piece in which they are looked at now.
    span: Option<[f64; 2]>,
}

/// Margins as polynomials in time, on a piece of a flow.
struct Margins {
    piece: [f64; 2],
    /// By component and condition as what is known: of each comparison its margin, if it is one.
    polynomials: Vec<Vec<Box<[Option<Piece>]>>>,
}

/// What is known of a comparison during a flow.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Knowledge {
    /// Nothing beforehand.
    Nothing,
    /// Whether it holds, throughout.
    Fixed(bool),
    /// It changes at this time, to this.
    Switch(Moment, bool),
}

impl<'a> Tension<'a> {
    /// The tension along the flow of a field. What depends on lines alone is solved at once.
    pub(super) fn along(conditions: Conditions<'a>, field: &Field<'_>) -> Self {
        let knowledge = |index: usize, condition: &Condition, slack: f64| {
            let places = conditions.standing.slots(index);
            let comparisons = condition.tracker.comparisons().iter();
            comparisons
                .map(|comparison| match comparison.form() {
                    Some(form) => Knowledge::of(form, comparison.is_strict(), places, slack, field),
                    None => Knowledge::Nothing,
                })
                .collect()
        };
        let known = conditions.group.components.iter().map(|&index| {
            let invariant = conditions.invariant(index);
            let first = invariant.map_or_else(Box::default, |invariant| {
                knowledge(index, invariant, conditions.allowance)
            });
            let transitions = conditions.standing.leaving(index).iter();
            let others = transitions.map(|leaving| knowledge(index, &leaving.guard, 0.0));
            std::iter::once(first).chain(others).collect()
        });
        let window = Moment::default();
        Tension { conditions, known: known.collect(), window, margins: None, span: None }
    }

    /// The times in order at which something changes that depends on lines alone.
    pub(super) fn switches(&self) -> Vec<Moment> {
        let mut switches: Vec<Moment> = Vec::new();
        for knowledge in self.known.iter().flatten().flatten() {
            if let Knowledge::Switch(time, _) = knowledge {
                switches.push(*time);
            }
        }
        switches.sort_by(|one, other| one.partial_cmp(other).unwrap_or(std::cmp::Ordering::Equal));
        switches.dedup();
        switches
    }

    /// Looks at the open span from this time up to the next switch from now on.
    pub(super) fn set_window(&mut self, from: Moment) {
        self.window = from;
    }

    /// What is known of the tension in the window without following any curve.
    pub(super) fn known_course(&self) -> Course {
        self.course_of(&[], 0.0)
    }

    /// Whether an invariant is known to be violated throughout the window, without following any curve.
    pub(super) fn is_outside(&self) -> bool {
        self.outside(&[], 0.0) == Course::Always
    }

    /// The conditions that it is made of.
    pub(super) fn conditions(&self) -> &Conditions<'a> {
        &self.conditions
    }

    fn course_of(&self, states: &[Enclosure], half_width: f64) -> Course {
        let Conditions { standing, group, .. } = self.conditions;
        let mut course = self.outside(states, half_width);
        for (number, &index) in group.components.iter().enumerate() {
            let labels = &standing.composition.components[index].labels;
            for (transition, leaving) in standing.leaving(index).iter().enumerate() {
                let is_own = labels[leaving.event].is_none();
                if is_own && self.conditions.is_wanted(leaving, Readiness::Forced) {
                    let context = Follow { states, half_width, slack: 0.0 };
                    let place = (number, index, 1 + transition);
                    course = course.or(self.follow(&leaving.guard.tracker, place, &context));
                }
            }
        }
        group
            .labels
            .iter()
            .fold(course, |course, &label| course.or(self.label_course(label, states, half_width)))
    }

    /// The course of being outside an invariant.
    fn outside(&self, states: &[Enclosure], half_width: f64) -> Course {
        let Conditions { group, allowance, .. } = self.conditions;
        let mut course = Course::Never;
        for (number, &index) in group.components.iter().enumerate() {
            if let Some(invariant) = self.conditions.invariant(index) {
                let context = Follow { states, half_width, slack: allowance };
                let own = self.follow(&invariant.tracker, (number, index, 0), &context);
                course = course.or(own.opposite());
            }
        }
        course
    }

    fn label_course(&self, label: usize, states: &[Enclosure], half_width: f64) -> Course {
        let Conditions { standing, group, .. } = self.conditions;
        let (mut all, mut wanted) = (Course::Always, Course::Never);
        for &(index, event) in &standing.composition.labels[label].participants {
            let number = group.components.partition_point(|one| *one < index);
            let mut any = Course::Never;
            for (transition, leaving) in standing.leaving(index).iter().enumerate() {
                if leaving.event == event {
                    let context = Follow { states, half_width, slack: 0.0 };
                    let place = (number, index, 1 + transition);
                    let own = self.follow(&leaving.guard.tracker, place, &context);
                    any = any.or(own);
                    if self.conditions.is_wanted(leaving, Readiness::Forced) {
                        wanted = wanted.or(own);
                    }
                }
            }
            all = all.and(any);
        }
        all.and(wanted)
    }

    fn follow(
        &self,
        tracker: &Tracker,
        (number, component, condition): (usize, usize, usize),
        context: &Follow<'_>,
    ) -> Course {
        let known = &self.known[number][condition];
        let slots = self.conditions.standing.slots(component);
        let course = |comparison: usize| match known.get(comparison)? {
            Knowledge::Nothing if context.slack == 0.0 => {
                let comparisons = &self.margins.as_ref()?.polynomials[number][condition];
                let margin = comparisons.get(comparison)?.as_ref()?;
                context.course_of(&tracker.comparisons()[comparison], slots, margin, self.span?)
            }
            Knowledge::Nothing => None,
            Knowledge::Fixed(holds) => Some((*holds).into()),
            // Nothing switches within the window.
            Knowledge::Switch(time, after) => Some((*after == (*time <= self.window)).into()),
        };
        tracker.course(context.states, slots, context.half_width, context.slack, &course)
    }
}

/// What a condition is followed with.
struct Follow<'a> {
    states: &'a [Enclosure],
    half_width: f64,
    slack: f64,
}

impl Margins {
    /// The margins of all conditions of a group that are polynomials on a piece.
    fn on(conditions: &Conditions<'_>, piece: &Piece) -> Margins {
        let polynomials = conditions.group.components.iter().map(|&index| {
            let places = conditions.standing.slots(index);
            let of = |condition: &Condition| {
                let comparisons = condition.tracker.comparisons().iter();
                let margins = comparisons.map(|comparison| {
                    let margin = comparison
                        .in_ring(&mut |place| Some(piece.polynomial(*places.get(place)?)))?;
                    Some(piece.composed(&margin))
                });
                margins.collect()
            };
            let first = conditions.invariant(index).map_or_else(Box::default, of);
            let leaving = conditions.standing.leaving(index).iter();
            std::iter::once(first).chain(leaving.map(|leaving| of(&leaving.guard))).collect()
        });
        let polynomials = polynomials.collect();
        Margins { piece: [piece.start(), piece.end()], polynomials }
    }
}

impl Follow<'_> {
    /// What its margin as a polynomial tells of a comparison in a span: that it holds throughout or
    /// nowhere, or that rounding alone decides, which shorter spans do not change.
    fn course_of(
        &self,
        comparison: &Tracked,
        slots: &[usize],
        margin: &Piece,
        span: [f64; 2],
    ) -> Option<Course> {
        let mut enclosures = Vec::with_capacity(1);
        margin.enclose(span[0], span[1], &mut enclosures);
        let as_whole = enclosures.first()?;
        match comparison.course_of(as_whole) {
            course @ (Course::Always | Course::Never) => Some(course),
            Course::Blurred | Course::FaintlyRising | Course::FaintlyFalling => {
                // Powers of time may be blurred by more than the values at an instant are.
                let (_, margin) = comparison.follow(self.states, slots, self.half_width);
                let is_blurred = as_whole.middle.width() <= COARSER * margin.middle.width();
                is_blurred.then_some(Course::Blurred)
            }
            Course::Rising | Course::Falling | Course::Open | Course::Opaque => None,
        }
    }
}

impl Watch for Tension<'_> {
    type Error = Failure;

    fn verdict(&mut self, state: &[f64]) -> Result<Verdict, Failure> {
        self.conditions.tension(state)
    }

    fn course(&mut self, states: &[Enclosure], half_width: f64) -> Course {
        self.course_of(states, half_width)
    }

    fn course_on(
        &mut self,
        piece: &Piece,
        span: [f64; 2],
        states: &[Enclosure],
        half_width: f64,
    ) -> Course {
        let ends = [piece.start(), piece.end()];
        if self.margins.as_ref().is_none_or(|known| known.piece != ends) {
            self.margins = Some(Margins::on(&self.conditions, piece));
        }
        self.span = Some(span);
        let course = self.course_of(states, half_width);
        self.span = None;
        course
    }
}

impl Knowledge {
    /// The margin a₁ x₁ + … + b along lines xᵢ = xᵢ₀ + cᵢ t, solved for the time at which it is 0.
    fn of(
        form: &Affine,
        is_strict: bool,
        places: &[usize],
        slack: f64,
        field: &Field<'_>,
    ) -> Knowledge {
        let zero = Moment::default();
        let mut margin = Moment::from(form.constant);
        let mut slope = Moment::default();
        for &(variable, coefficient) in &form.coefficients {
            let place = places[variable];
            let Some(line) = field.line(place) else { return Knowledge::Nothing };
            margin = margin + Moment::from(coefficient) * line.start;
            slope = slope + Moment::product(coefficient, line.rate);
        }
        // Slack is for a start on the wrong side; elsewhere it would only put off the instant.
        let slack = if margin > zero { 0.0 } else { slack };
        margin = margin + Moment::from(slack);
        if !(margin.seconds().is_finite() && slope.seconds().is_finite()) {
            return Knowledge::Nothing;
        }
        if slope == zero {
            let is_strict = is_strict && slack == 0.0;
            return Knowledge::Fixed(if is_strict { margin > zero } else { margin >= zero });
        }
        let (time, rises) = (-margin / slope, slope > zero);
        if !time.seconds().is_finite() {
            return Knowledge::Nothing;
        }
        if time <= zero { Knowledge::Fixed(rises) } else { Knowledge::Switch(time, rises) }
    }
}

#[cfg(test)]
mod tests {
    use pleach_guards::{constant, variable};

    use super::*;
    use crate::composition::field::tests::{field, plane};

    /// What is known of 2 x + y ÷ 2 − 3 ≥ 0, or > 0, with this slack, where x and y begin at `start` and
    /// have these rates.
    fn known(start: [f64; 2], rates: [f64; 2], is_strict: bool, slack: f64) -> Knowledge {
        let plane = plane(rates.map(constant));
        let form = Affine { coefficients: [(0, 2.0), (1, 0.5)].into(), constant: -3.0 };
        Knowledge::of(&form, is_strict, &[0, 1], slack, &field(&plane, start))
    }

    fn switch(time: f64, after: bool) -> Knowledge {
        Knowledge::Switch(Moment::from(time), after)
    }

    #[test]
    fn a_comparison_along_lines_changes_where_they_cross_its_bound() {
        for is_strict in [false, true] {
            // The margin begins at −2 and rises by 2.5 − 2 in a second.
            assert_eq!(known([0.25, 1.0], [1.25, -4.0], is_strict, 0.0), switch(4.0, true));
            // It begins at 2 and falls.
            assert_eq!(known([2.0, 2.0], [-1.0, 3.0], is_strict, 0.0), switch(4.0, false));
            // It moves away from 0.
            assert_eq!(known([2.0, 2.0], [1.0, 3.0], is_strict, 0.0), Knowledge::Fixed(true));
            assert_eq!(known([0.0, 2.0], [-1.0, 3.0], is_strict, 0.0), Knowledge::Fixed(false));
            // From 0 it goes to either side at once.
            assert_eq!(known([1.0, 2.0], [1.0, 0.0], is_strict, 0.0), Knowledge::Fixed(true));
            assert_eq!(known([1.0, 2.0], [-1.0, 0.0], is_strict, 0.0), Knowledge::Fixed(false));
        }
    }

    #[test]
    fn a_margin_that_rests_at_zero_is_enough_where_equality_is() {
        for (start, is_met) in
            [([1.0, 2.0], [true, false]), ([2.0, 2.0], [true; 2]), ([0.0; 2], [false; 2])]
        {
            for rates in [[0.0, 0.0], [1.0, -4.0]] {
                let found = [false, true].map(|is_strict| known(start, rates, is_strict, 0.0));
                assert_eq!(found, is_met.map(Knowledge::Fixed), "{start:?}");
            }
        }
    }

    /// What begins beyond the bound by less than the slack holds until it is beyond it by more; what does
    /// not begin beyond has none.
    #[test]
    fn slack_is_for_a_start_on_the_wrong_side() {
        for is_strict in [false, true] {
            // A margin of −0.5.
            let [x, y] = [0.75, 2.0];
            assert_eq!(known([x, y], [0.0, 0.0], is_strict, 0.5), Knowledge::Fixed(true));
            assert_eq!(known([x, y], [0.0, 0.0], is_strict, 0.25), Knowledge::Fixed(false));
            assert_eq!(known([x, y], [-0.5, 0.0], is_strict, 2.5), switch(2.0, false));
            assert_eq!(known([x, y], [0.5, 0.0], is_strict, 0.25), switch(0.25, true));
            // A margin of 0 is not above it.
            assert_eq!(known([1.0, 2.0], [-0.5, 0.0], is_strict, 2.0), switch(2.0, false));
            // A margin of 0.5.
            assert_eq!(known([1.25, y], [-0.5, 0.0], is_strict, 2.0), switch(0.5, false));
        }
    }

    #[test]
    fn nothing_is_known_of_curves_and_of_what_is_not_finite() {
        let [x, y] = ["x", "y"].map(variable);
        let form = Affine { coefficients: [(1, 1.0)].into(), constant: -3.0 };
        let known_of = |rate: pleach_guards::Expression, start: f64| {
            let plane = plane([constant(1.0), rate]);
            Knowledge::of(&form, false, &[0, 1], 0.0, &field(&plane, [0.0, start]))
        };
        assert_eq!(known_of(constant(2.0), 1.0), switch(1.0, true));
        assert_eq!(known_of(&x + &y, 1.0), Knowledge::Nothing);
        assert_eq!(known_of(constant(2.0), f64::INFINITY), Knowledge::Nothing);
        assert_eq!(known_of(constant(f64::INFINITY), 1.0), Knowledge::Nothing);
        // The time is beyond all numbers.
        assert_eq!(known_of(constant(1e-300), -1e300), Knowledge::Nothing);
    }
}
