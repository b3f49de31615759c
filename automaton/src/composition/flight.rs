//! The way of a group from one of its jumps to the next: its flow, up to the first instant at which
//! a transition has to be taken or an invariant ends.

use pleach_continuous::flow::{Curve, Doubt, Finding, Lost, Onset, Piece, Uncertainty, isolate};
use pleach_guards::Course;

use super::field::{Field, Row};
use super::group::Group;
use super::jumps::Standing;
use super::settings::{Policy, Settings};
use super::simulation::{Failure, Halt};
use super::solver::Solver;
use super::tension::{Conditions, Readiness, Tension};
use crate::executor::Limit;
use crate::moment::Moment;
use crate::trajectory::Why;

/// An invariant that ends at most this many spacings of the numbers around the present time after the start
/// of a flow ends at its start.
const SPACINGS: f64 = 4.0;

/// A flow that has been looked at in advance. Its times count from its start, in seconds.
pub(super) struct Flight {
    /// When it began.
    pub(super) since: Moment,
    /// How long it takes.
    pub(super) duration: Moment,
    pub(super) pieces: Vec<Piece>,
    /// The state at the end, by variable of the group.
    pub(super) landing: Vec<f64>,
    /// Where it cannot be said whether something happens.
    pub(super) doubts: Vec<Doubt>,
    /// Why something may be missed at any time of it.
    pub(super) unknowns: Vec<Why>,
    /// Why it cannot go on at its end.
    pub(super) halt: Option<Halt>,
}

/// What a flight is planned with.
pub(super) struct Plan<'a> {
    pub(super) group: &'a Group,
    pub(super) standing: Standing<'a>,
    pub(super) settings: &'a Settings,
    /// When transitions are taken that only may be.
    pub(super) policy: Policy,
    pub(super) allowance: f64,
    /// When it begins.
    pub(super) since: Moment,
    /// The state there, by variable of the group.
    pub(super) start: Vec<f64>,
    /// How long it may take, in seconds.
    pub(super) limit: f64,
}

/// Where a flight ends.
enum End {
    /// Something has to happen, exactly at this time.
    At(Moment),
    /// Something begins to have to happen.
    Onset(Onset),
    /// Nothing happens.
    Never,
}

/// Why a flight ends early: how far it goes, and why.
struct Stop {
    at: f64,
    halt: Halt,
}

impl Plan<'_> {
    /// The flow up to an event; `steps` is how many pieces and spans may still be looked at.
    pub(super) fn fly(self, steps: &mut u64) -> Result<Flight, Halt> {
        let Plan { group, standing, settings, policy, allowance, since, start, limit } = self;
        let composition = standing.composition;
        let field = Field::of(composition, group, standing.locations, start);
        let conditions = Conditions { standing, group, policy, allowance };
        let rests = |duration| Flight {
            since,
            duration,
            pieces: Vec::new(),
            landing: field.start.clone(),
            doubts: Vec::new(),
            unknowns: Vec::new(),
            halt: None,
        };
        if conditions.tension(&field.start)?.holds {
            return Ok(rests(Moment::default()));
        }
        let failed = |fault: Fault| flow_failure(standing, group, since, fault);
        let solver =
            Solver::new(&field, settings, limit).map_err(|reason| failed(reason.into()))?;
        let mut search = Search {
            tension: Tension::along(conditions, &field),
            solver,
            settings,
            since,
            doubts: Vec::new(),
            steps,
        };
        let end = match search.run(limit) {
            Ok(end) => end,
            Err(Stop { at, halt }) if at > 0.0 && (since + Moment::from(at)) > since => {
                return search.cut_short(at, halt, failed);
            }
            Err(Stop { halt, .. }) => return Err(halt),
        };
        search.land(end, limit, failed)
    }
}

fn flow_failure(standing: Standing<'_>, group: &Group, since: Moment, reason: Fault) -> Halt {
    let (from, to) = (since.seconds(), reason.at.map(|at| (since + Moment::from(at)).seconds()));
    let reason = match to {
        Some(to) => format!("{} at {to} s", reason.text),
        None => format!("{} in the flow that begins at {from} s", reason.text),
    };
    Failure::Flow { locations: standing.names(&group.components), reason }.into()
}

/// Why a flow cannot be followed, and up to when it can.
struct Fault {
    text: String,
    at: Option<f64>,
}

impl From<String> for Fault {
    fn from(text: String) -> Fault {
        Fault { text, at: None }
    }
}

/// A flight that is being looked for.
struct Search<'a, 'f> {
    tension: Tension<'a>,
    solver: Solver<'f>,
    settings: &'a Settings,
    since: Moment,
    doubts: Vec<Doubt>,
    steps: &'a mut u64,
}

impl<'a> Search<'a, '_> {
    /// Where the flight ends: at a time at which something switches, or between two of them.
    fn run(&mut self, limit: f64) -> Result<End, Stop> {
        let zero = Moment::default();
        let last = Moment::from(limit);
        let switches = self.tension.switches();
        let mut from = zero;
        for to in switches.into_iter().filter(|time| *time <= last).chain([last]) {
            if to > from {
                self.tension.set_window(from, to);
                match self.tension.known_course() {
                    Course::Never => {}
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
                return Ok(End::At(to));
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
            let end = piece.end().min(to);
            let search = self.settings.search();
            let found = isolate(piece, from, end, &search, &mut self.tension, self.steps);
            let Finding { onset, doubts } = found.map_err(|lost| self.lost(lost))?;
            doubts.into_iter().for_each(|doubt| self.doubt(doubt));
            if onset.is_some() || end <= from {
                return Ok(onset);
            }
            from = end;
        }
        Ok(None)
    }

    /// The first number of seconds after `from` at which floating-point numbers say, too, that
    /// something has to happen; a strict guard is left on its boundary.
    fn right_after(&mut self, from: Moment, to: Moment) -> Result<Option<Onset>, Stop> {
        let start = from.seconds();
        let mut before = start;
        let least = self.spacing().max(f64::MIN_POSITIVE);
        let mut step = (start.next_up() - start).max(least);
        let mut after = loop {
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
        loop {
            let middle = before + 0.5 * (after - before);
            if after - before <= 2.0 * least || middle <= before || middle >= after {
                return Ok(Some(Onset { before, time: after }));
            }
            if self.holds_at(middle)? { after = middle } else { before = middle }
        }
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

    fn lost(&mut self, lost: Lost<Failure>) -> Stop {
        match lost {
            Lost::Endless { at } => {
                Stop { at, halt: Halt::Limit(Limit::Steps(self.settings.step_limit)) }
            }
            Lost::Undefined { after, at, error } => {
                Stop { at: self.last_defined(after, at), halt: error.into() }
            }
        }
    }

    /// The last time, from `defined` on, at which every formula has a value.
    fn last_defined(&mut self, mut defined: f64, mut undefined: f64) -> f64 {
        loop {
            let middle = defined + 0.5 * (undefined - defined);
            if middle <= defined || middle >= undefined {
                return defined;
            }
            match self.holds_at(middle) {
                Ok(_) => defined = middle,
                Err(_) => undefined = middle,
            }
        }
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

    /// Ends the flight on the side of the event on which a transition can be taken; if none can and
    /// an invariant ends, on the side on which it still holds.
    fn land(
        mut self,
        end: End,
        limit: f64,
        failed: impl Fn(Fault) -> Halt,
    ) -> Result<Flight, Halt> {
        let duration = match end {
            End::Never => Moment::from(limit),
            End::At(time) if self.can_jump(time, &failed)? => time,
            End::At(time) => {
                let before = self.just_before(time.seconds(), &failed)?;
                self.unless_nothing(before, &failed)?
            }
            End::Onset(Onset { before, time }) => {
                let can_jump = self.can_jump(Moment::from(time), &failed)?;
                if can_jump { Moment::from(time) } else { self.unless_nothing(before, &failed)? }
            }
        };
        let duration = self.noticeable(duration);
        let landing = self.solver.state_at(duration).map_err(|reason| failed(reason.into()))?;
        let unknowns = self.solver.unknowns();
        let pieces = self.solver.into_pieces(duration.seconds());
        Ok(Flight {
            unknowns,
            since: self.since,
            duration,
            pieces: pieces.map_err(|reason| failed(reason.into()))?,
            landing,
            doubts: self.doubts,
            halt: None,
        })
    }

    /// The duration, or none if nothing changes in it but for rounding: at the very start of a flow
    /// there is nothing before the end of an invariant.
    fn unless_nothing(
        &mut self,
        duration: f64,
        failed: &impl Fn(Fault) -> Halt,
    ) -> Result<Moment, Halt> {
        let moved = self.solver.state_at(Moment::from(duration));
        let moved = moved.map_err(|reason| failed(reason.into()))?;
        let is_rounding = duration <= SPACINGS * f64::EPSILON * self.since.seconds().abs();
        let is_nothing = is_rounding || moved == self.solver.start();
        Ok(if is_nothing { Moment::default() } else { Moment::from(duration) })
    }

    /// A duration that changes the time, if it is more than none.
    fn noticeable(&self, duration: Moment) -> Moment {
        let least = Moment::from(2.0 * self.spacing());
        if duration > Moment::default() && duration < least { least } else { duration }
    }

    /// The smallest change of the time that its two numbers can hold.
    fn spacing(&self) -> f64 {
        self.since.seconds().abs() * f64::EPSILON * f64::EPSILON
    }

    fn can_jump(&mut self, time: Moment, failed: &impl Fn(Fault) -> Halt) -> Result<bool, Halt> {
        let state = self.solver.state_at(time).map_err(|reason| failed(reason.into()))?;
        let conditions = self.tension.conditions();
        Ok(conditions.any_transition(&state, Readiness::Possible)?.holds)
    }

    /// The last number of seconds before `time` at which time need not stop yet.
    fn just_before(&mut self, time: f64, failed: &impl Fn(Fault) -> Halt) -> Result<f64, Halt> {
        let mut calm = |at: f64| -> Result<bool, Halt> {
            let state = self.solver.state_at(Moment::from(at));
            let state = state.map_err(|reason| failed(reason.into()))?;
            Ok(!self.tension.conditions().tension(&state)?.holds)
        };
        let (mut after, mut step) = (time, time - time.next_down());
        let mut before = loop {
            let earlier = time - step;
            if earlier <= 0.0 {
                return Ok(0.0);
            }
            if calm(earlier)? {
                break earlier;
            }
            after = earlier;
            step *= 2.0;
        };
        loop {
            let middle = before + 0.5 * (after - before);
            if middle <= before || middle >= after {
                return Ok(before);
            }
            if calm(middle)? { before = middle } else { after = middle }
        }
    }

    /// The flow as far as it can be followed.
    fn cut_short(
        self,
        at: f64,
        halt: Halt,
        failed: impl Fn(Fault) -> Halt,
    ) -> Result<Flight, Halt> {
        let flight = self.land(End::Never, at, failed)?;
        Ok(Flight { halt: Some(halt), ..flight })
    }
}

impl Flight {
    /// When it ends.
    pub(super) fn due(&self) -> Moment {
        self.since + self.duration
    }

    /// The state `time` seconds after the start.
    pub(super) fn state_at(&self, time: f64) -> Vec<f64> {
        if time >= self.duration.seconds() {
            return self.landing.clone();
        }
        let number = self.pieces.partition_point(|piece| piece.end() <= time);
        let mut state = self.landing.clone();
        if let Some(piece) = self.pieces.get(number) {
            piece.state_at(time, &mut state);
        }
        state
    }

    /// The flight for `duration` seconds in which lines go on and everything else rests.
    pub(super) fn of_lines(since: Moment, duration: f64, field: &Field<'_>) -> Flight {
        let mut piece = Piece::new(0.0, duration, 0.0, 1.0);
        for (first, row) in field.start.iter().zip(&field.rows) {
            let rate = if let Row::Line(rate) = row { *rate } else { 0.0 };
            piece.push([*first, rate], 0.0);
        }
        let mut landing = field.start.clone();
        piece.state_at(duration, &mut landing);
        Flight {
            since,
            duration: Moment::from(duration),
            pieces: vec![piece],
            landing,
            doubts: Vec::new(),
            unknowns: Vec::new(),
            halt: None,
        }
    }

    /// The flight up to `time` seconds after the start, at which nothing happens.
    pub(super) fn cut(mut self, time: f64) -> Flight {
        self.landing = self.state_at(time);
        self.pieces.retain(|piece| piece.start() < time);
        if let Some(last) = self.pieces.pop() {
            self.pieces.push(last.within(0.0, time));
        }
        self.doubts.retain(|doubt| doubt.from <= time);
        Flight { duration: Moment::from(time), ..self }
    }
}
