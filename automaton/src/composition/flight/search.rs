//! The search for the end of a flight: the first instant at which something has to happen.

use pleach_continuous::flow::{Curve, Doubt, Finding, Lost, Onset, Uncertainty, Watch, isolate};
use pleach_guards::Course;

use crate::composition::group::Group;
use crate::composition::halving::middle;
use crate::composition::jumps::Standing;
use crate::composition::settings::Settings;
use crate::composition::simulation::{Failure, Halt};
use crate::composition::solver::Solver;
use crate::composition::tension::{Conditions, Readiness, Tension};
use crate::executor::Limit;
use crate::moment::Moment;

/// Where a flight ends.
pub(super) enum End {
    /// Something has to happen, exactly at this time and in this state.
    At(Moment, Vec<f64>),
    /// Something begins to have to happen.
    Onset(Onset),
    /// An invariant ends right after this time, at which something can be taken.
    Leaving(Moment),
    /// Nothing happens.
    Never,
}

impl End {
    /// Whether nothing happens up to this time.
    pub(super) fn is_after(&self, time: f64) -> bool {
        match self {
            End::At(end, _) | End::Leaving(end) => *end > Moment::from(time),
            End::Onset(onset) => onset.time > time,
            End::Never => true,
        }
    }
}

/// Whether what a piece says holds of the state, too.
enum Confirmation {
    /// It begins to hold here.
    Onset(Onset),
    /// It does not, and up to this time, which is later, the piece says otherwise.
    Until(f64),
}

/// Why a flight ends early: how far it goes, and why.
pub(super) struct Stop {
    pub(super) at: f64,
    pub(super) halt: Halt,
}

/// Why a flow cannot be followed, and up to when it can.
pub(super) struct Fault {
    pub(super) text: String,
    pub(super) at: Option<f64>,
}

impl From<String> for Fault {
    fn from(text: String) -> Fault {
        Fault { text, at: None }
    }
}

pub(super) fn flow_failure(
    standing: Standing<'_>,
    group: &Group,
    since: Moment,
    reason: Fault,
) -> Halt {
    let (from, to) = (since.seconds(), reason.at.map(|at| (since + Moment::from(at)).seconds()));
    let reason = match to {
        Some(to) => format!("at {to} s, {}", reason.text),
        None => format!("in the flow that begins at {from} s, {}", reason.text),
    };
    Failure::Flow { locations: standing.names(&group.components), reason }.into()
}

/// A flight that is being looked for.
pub(super) struct Search<'a, 'f> {
    pub(super) tension: Tension<'a>,
    pub(super) solver: Solver<'f>,
    pub(super) settings: &'a Settings,
    pub(super) since: Moment,
    pub(super) doubts: Vec<Doubt>,
    pub(super) steps: &'a mut u64,
    /// How much time is looked at first, in seconds: about as long as the flight may take. It does not
    /// change what is found.
    pub(super) stride: f64,
}

/// By how much more time is looked at after each stride without an event.
const LENGTHENING: f64 = 4.0;

impl<'a> Search<'a, '_> {
    /// Where the flight ends: at a time at which something switches, or between two of them.
    pub(super) fn run(&mut self, limit: f64) -> Result<End, Stop> {
        let zero = Moment::default();
        let last = Moment::from(limit);
        let switches = self.tension.switches();
        let mut from = zero;
        for to in switches.into_iter().filter(|time| *time <= last).chain([last]) {
            if to > from {
                self.tension.set_window(from);
                match self.tension.known_course() {
                    Course::Never => {}
                    // No time can pass: what can be taken is taken at this very instant.
                    Course::Always if self.tension.is_outside() && self.can_jump_at(from)? => {
                        return Ok(End::Leaving(from));
                    }
                    Course::Always => {
                        if let Some(onset) = self.right_after(from, to)? {
                            return Ok(End::Onset(onset));
                        }
                    }
                    _ => {
                        if let Some(onset) = self.follow(from.seconds(), to.seconds())? {
                            return Ok(End::Onset(onset));
                        }
                    }
                }
            }
            // At the end that was asked for something happens only if it does by itself.
            let state = self.state_at(to)?;
            if self.holds(&state, to.seconds())? {
                return Ok(End::At(to, state));
            }
            from = to;
        }
        Ok(End::Never)
    }

    /// Follows the flow from one time to another, piece by piece.
    fn follow(&mut self, from: f64, to: f64) -> Result<Option<Onset>, Stop> {
        let mut from = from;
        while from < to {
            self.spend(from)?;
            let piece = match self.solver.piece_at(from, to) {
                Ok(piece) => piece,
                Err(reason) => return Err(self.lost_flow(reason)),
            };
            let (end, look) = (piece.end().min(to), from + self.stride);
            let end = if look > from { end.min(look) } else { end };
            self.stride *= LENGTHENING;
            let search = self.settings.search();
            let found = isolate(piece, from, end, &search, &mut self.tension, self.steps);
            let Finding { onset, doubts } = found;
            doubts.into_iter().for_each(|doubt| self.doubt(doubt));
            from = match onset.or_else(|lost| self.at_last_value(lost))? {
                Some(onset) => match self.confirmed(onset, end)? {
                    Confirmation::Onset(onset) => return Ok(Some(onset)),
                    Confirmation::Until(time) => time,
                },
                None if end <= from => return Ok(None),
                None => end,
            };
        }
        Ok(None)
    }

    /// The onset as the state has it, of which the polynomials of a piece differ by rounding, and by the
    /// errors of those through the values of a function. While they alone say that something has to happen,
    /// it is in doubt.
    fn confirmed(&mut self, onset: Onset, end: f64) -> Result<Confirmation, Stop> {
        if self.holds_at(onset.time)? {
            return Ok(Confirmation::Onset(onset));
        }
        let (mut before, mut step) = (onset.time, onset.time.next_up() - onset.time);
        loop {
            let time = before + step;
            if time < end && self.holds_at(time)? {
                return self.narrowed(before, time, 0.0).map(Confirmation::Onset);
            }
            if time >= end || !self.holds_on_piece(time, end)? {
                let time = time.min(end);
                self.doubt(Doubt { from: onset.time, to: time, why: Uncertainty::Touch });
                return Ok(Confirmation::Until(time));
            }
            (before, step) = (time, 2.0 * step);
        }
    }

    fn holds_on_piece(&mut self, time: f64, end: f64) -> Result<bool, Stop> {
        let mut state = self.solver.start().to_vec();
        match self.solver.piece_at(time, end) {
            Ok(piece) => piece.state_at(time, &mut state),
            Err(reason) => return Err(self.lost_flow(reason)),
        }
        self.holds(&state, time)
    }

    /// The first number of seconds after `from` at which floating-point numbers say, too, that
    /// something has to happen; a strict guard is left on its boundary.
    fn right_after(&mut self, from: Moment, to: Moment) -> Result<Option<Onset>, Stop> {
        let start = from.seconds();
        let mut before = start;
        let least = self.spacing().max(f64::MIN_POSITIVE);
        let mut step = (start.next_up() - start).max(least);
        let after = loop {
            let time = start + step;
            if time >= to.seconds() {
                return Ok(None);
            }
            if self.holds_at(time)? {
                break time;
            }
            before = time;
            step *= 2.0;
        };
        self.narrowed(before, after, 2.0 * least).map(Some)
    }

    /// Where something begins to have to happen, between a time at which nothing has to and one at which
    /// something does.
    fn narrowed(&mut self, before: f64, after: f64, tolerance: f64) -> Result<Onset, Stop> {
        let (mut before, mut after) = (before, after);
        while let Some(middle) = middle(before, after).filter(|_| after - before > tolerance) {
            if self.holds_at(middle)? { after = middle } else { before = middle }
        }
        Ok(Onset { before, time: after })
    }

    fn can_jump_at(&mut self, time: Moment) -> Result<bool, Stop> {
        let is_start = time == Moment::default();
        let state = if is_start { self.solver.start().to_vec() } else { self.state_at(time)? };
        let failed = |fault: Failure| Stop { at: time.seconds(), halt: fault.into() };
        self.can_jump_in(&state).map_err(failed)
    }

    /// Whether a transition can be taken in this state.
    pub(super) fn can_jump_in(&self, state: &[f64]) -> Result<bool, Failure> {
        let verdict = self.tension.conditions().any_transition(state, Readiness::Possible)?;
        Ok(verdict.holds)
    }

    fn holds_at(&mut self, time: f64) -> Result<bool, Stop> {
        let state = self.state_at(Moment::from(time))?;
        self.holds(&state, time)
    }

    fn holds(&mut self, state: &[f64], at: f64) -> Result<bool, Stop> {
        let verdict = self.tension.conditions().tension(state);
        verdict.map(|verdict| verdict.holds).map_err(|fault| Stop { at, halt: fault.into() })
    }

    fn state_at(&mut self, time: Moment) -> Result<Vec<f64>, Stop> {
        while !self.solver.is_straight() && self.solver.reached() < time.seconds() {
            let reached = self.solver.reached();
            self.spend(reached)?;
            if let Err(reason) = self.solver.piece_at(reached, time.seconds()) {
                return Err(self.lost_flow(reason));
            }
        }
        let state = self.solver.state_at(time);
        state.map_err(|reason| self.lost_flow(reason))
    }

    fn spend(&mut self, at: f64) -> Result<(), Stop> {
        let limit = Limit::Steps(self.settings.step_limit);
        match self.steps.checked_sub(1) {
            Some(left) => *self.steps = left,
            None => return Err(Stop { at, halt: Halt::Limit(limit) }),
        }
        let memory = self.settings.memory_limit;
        if 8 * self.solver.size() as u64 > memory {
            return Err(Stop { at, halt: Halt::Limit(Limit::Memory(memory)) });
        }
        Ok(())
    }

    fn lost_flow(&self, reason: String) -> Stop {
        let Conditions { standing, group, .. } = *self.tension.conditions();
        let at = self.solver.reached();
        let fault = Fault { text: reason, at: Some(at) };
        Stop { at, halt: flow_failure(standing, group, self.since, fault) }
    }

    /// What happens at the last time at which every formula has a value, as √h ≤ 0 does where h comes to 0.
    fn at_last_value(&mut self, lost: Lost<Failure>) -> Result<Option<Onset>, Stop> {
        match lost {
            Lost::Endless { at } => {
                Err(Stop { at, halt: Halt::Limit(Limit::Steps(self.settings.step_limit)) })
            }
            Lost::Undefined { after, at, error } => {
                let last = self.last_defined(after, at);
                if last > after && self.holds_at(last)? {
                    return self.narrowed(after, last, 0.0).map(Some);
                }
                Err(Stop { at: last, halt: error.into() })
            }
        }
    }

    /// Takes note of it if, at the time at which the run ends, it is undecided whether something happens.
    pub(super) fn doubt_last(&mut self, time: f64) -> Result<(), Stop> {
        self.tension.set_window(Moment::from(time));
        if self.tension.known_course() == Course::Never {
            return Ok(());
        }
        let mut enclosures = Vec::new();
        match self.solver.piece_at(time.next_down(), time) {
            Ok(piece) => piece.enclose(time, time, &mut enclosures),
            Err(reason) => return Err(self.lost_flow(reason)),
        }
        // What is a function is in doubt as a whole.
        if !matches!(self.tension.course(&enclosures, 0.0), Course::Never | Course::Opaque) {
            self.doubt(Doubt { from: time, to: time, why: Uncertainty::Touch });
        }
        Ok(())
    }

    /// The last time, from `defined` on, at which every formula has a value.
    fn last_defined(&mut self, mut defined: f64, mut undefined: f64) -> f64 {
        while let Some(middle) = middle(defined, undefined) {
            match self.holds_at(middle) {
                Ok(_) => defined = middle,
                Err(_) => undefined = middle,
            }
        }
        defined
    }

    /// Takes note of a doubt, together with one of the same kind just before it.
    fn doubt(&mut self, doubt: Doubt) {
        match self.doubts.last_mut() {
            Some(last) if last.why == doubt.why && last.to >= doubt.from => last.to = doubt.to,
            // A function is in doubt throughout; where is no news.
            Some(last) if last.why == Uncertainty::Function && doubt.why == last.why => {
                last.to = doubt.to;
            }
            _ => self.doubts.push(doubt),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use pleach_guards::{Expression, Predicate, constant, variable};

    use super::*;
    use crate::composition::field::tests::{field, guarded};
    use crate::composition::{Composition, Policy};

    /// Has a search look at the flow of x and y from 0 on, which begins at a time of the run.
    pub(in crate::composition::flight) fn search<T>(
        plane: &Composition,
        since: f64,
        look: impl FnOnce(Search<'_, '_>) -> T,
    ) -> T {
        let (settings, mut steps) = (Settings::default(), 1000);
        let field = field(plane, [0.0, 0.0]);
        let standing = Standing::new(plane, &[0]);
        let group = &plane.groups[0];
        let conditions = Conditions { standing, group, policy: Policy::Late, allowance: 0.0 };
        let linear = field.linear().expect("its numbers are finite");
        let solver = Solver::new(&field, linear, &settings, 100.0).expect("it can be solved");
        look(Search {
            tension: Tension::along(conditions, &field),
            solver,
            settings: &settings,
            since: Moment::from(since),
            doubts: Vec::new(),
            steps: &mut steps,
            stride: f64::INFINITY,
        })
    }

    /// x is the time, along a line and as a curve.
    pub(in crate::composition::flight) fn times(guard: &Predicate) -> [Composition; 2] {
        let bent = 1.0 + 0.0 * variable("y").power(2.0);
        [constant(1.0), bent].map(|rate: Expression| guarded([rate, constant(0.0)], guard))
    }

    fn is_late(time: f64) -> [Composition; 2] {
        times(&variable("x").at_least(time))
    }

    fn found<T>(found: Result<T, Stop>) -> T {
        found.unwrap_or_else(|stop| panic!("{} at {}", stop.halt, stop.at))
    }

    #[test]
    fn nothing_happens_up_to_an_earlier_time() {
        let onset = End::Onset(Onset { before: 0.5, time: 2.0 });
        for end in [End::At(Moment::from(2.0), Vec::new()), End::Leaving(Moment::from(2.0)), onset]
        {
            assert!(end.is_after(1.0) && end.is_after(2f64.next_down()));
            assert!(!end.is_after(2.0) && !end.is_after(3.0));
        }
        assert!(End::Never.is_after(1e300));
    }

    #[test]
    fn an_onset_lies_between_neighbours_or_as_near_as_is_asked() {
        for bound in [0.1, 1.1, 1.7] {
            for plane in is_late(bound) {
                let onset = search(&plane, 0.0, |mut it| found(it.narrowed(0.0, 4.0, 0.0)));
                assert!((onset.time - bound).abs() < 1e-14, "{bound}: {}", onset.time);
                assert_eq!(onset.before, onset.time.next_down());
                let onset = search(&plane, 0.0, |mut it| found(it.narrowed(0.0, 4.0, 0.125)));
                assert!(onset.before < bound && bound <= onset.time);
                assert_eq!(onset.time - onset.before, 0.125);
            }
        }
    }

    /// Behind a strict bound it is the next number; right at the start the next time that the run can tell.
    #[test]
    fn what_begins_after_an_instant_begins_at_the_next_number() {
        let later = |bound: f64, since: f64, to: f64| {
            let [line, _] = times(&variable("x").more_than(bound));
            let (from, to) = (Moment::from(bound), Moment::from(to));
            search(&line, since, |mut it| found(it.right_after(from, to)))
        };
        for bound in [0.5, 3.0, 7.0] {
            let onset = later(bound, 0.0, 10.0).expect("it begins");
            assert_eq!([onset.before, onset.time], [bound, bound.next_up()]);
            assert!(later(bound, 0.0, bound.next_up()).is_none(), "that is the end");
        }
        for since in [1.0, 1e6] {
            let onset = later(0.0, since, 10.0).expect("it begins");
            let least = since * f64::EPSILON * f64::EPSILON;
            assert!(onset.before == 0.0 && 0.0 < onset.time && onset.time <= 2.0 * least);
            assert!(least <= onset.time, "{}", onset.time);
        }
        assert!(later(0.0, 0.0, 10.0).expect("it begins").time < 1e-300);
        // Of what begins later the last number before is told, too.
        let [line, _] = is_late(1.5);
        let (from, to) = (Moment::from(1.0), Moment::from(10.0));
        let onset = search(&line, 0.0, |mut it| found(it.right_after(from, to)));
        let onset = onset.expect("it begins");
        assert_eq!([onset.before, onset.time], [1.5f64.next_down(), 1.5]);
    }

    /// √(b − x) has a value up to b.
    #[test]
    fn the_last_number_with_a_value_is_found() {
        let x = variable("x");
        for bound in [0.25, 1.0, 1.7] {
            let [line, _] = times(&(bound - &x).square_root().at_most(-1.0));
            assert_eq!(search(&line, 0.0, |mut it| it.last_defined(0.0, 4.0)), bound);
            assert_eq!(search(&line, 0.0, |mut it| it.last_defined(0.125, bound.next_up())), bound);
        }
    }

    #[test]
    fn doubts_of_one_kind_join_where_they_touch_and_those_of_functions_anyway() {
        use Uncertainty::{Function, Touch};
        let [line, _] = is_late(1.0);
        let noted = |spans: &[(f64, f64, Uncertainty)]| {
            search(&line, 0.0, |mut it| {
                spans.iter().for_each(|&(from, to, why)| it.doubt(Doubt { from, to, why }));
                it.doubts.iter().map(|one| (one.from, one.to, one.why)).collect::<Vec<_>>()
            })
        };
        assert_eq!(noted(&[(1.0, 2.0, Touch), (2.0, 3.0, Touch)]), [(1.0, 3.0, Touch)]);
        assert_eq!(noted(&[(1.0, 2.0, Touch), (1.5, 3.0, Touch)]), [(1.0, 3.0, Touch)]);
        let apart = [(1.0, 2.0, Touch), (2.5, 3.0, Touch)];
        assert_eq!(noted(&apart), apart);
        assert_eq!(noted(&[(1.0, 2.0, Function), (2.5, 3.0, Function)]), [(1.0, 3.0, Function)]);
        for pair in [[Touch, Function], [Function, Touch]] {
            for begin in [2.0, 2.5] {
                let apart = [(1.0, 2.0, pair[0]), (begin, 3.0, pair[1])];
                assert_eq!(noted(&apart), apart);
            }
        }
    }

    #[test]
    fn steps_are_counted_down_and_room_is_limited() {
        let [_, curve] = is_late(1.0);
        search(&curve, 0.0, |mut it| {
            found(it.spend(0.0));
            found(it.spend(0.0));
            assert_eq!(*it.steps, 998);
            *it.steps = 0;
            let stop = it.spend(0.5).expect_err("there is none left");
            assert!(matches!(stop.halt, Halt::Limit(Limit::Steps(_))) && stop.at == 0.5);
        });
        for (spare, is_enough) in [(0, true), (1, false)] {
            search(&curve, 0.0, |mut it| {
                it.solver.piece_at(1.0, 2.0).expect("it can be followed");
                let memory_limit = 8 * it.solver.size() as u64 - spare;
                let settings = Settings { memory_limit, ..Settings::default() };
                let Search { tension, solver, since, doubts, steps, stride, .. } = it;
                let settings = &settings;
                let mut it = Search { tension, solver, settings, since, doubts, steps, stride };
                assert_eq!(it.spend(0.0).is_ok(), is_enough, "{memory_limit}");
            });
        }
    }
}
