//! The way of a group from one of its jumps to the next: its flow, up to the first instant at which
//! a transition has to be taken or an invariant ends.

mod landing;
mod search;

use pleach_continuous::flow::{Curve, Doubt, Piece};

use super::field::{Field, Line};
use super::group::Group;
use super::jumps::Standing;
use super::linear::LinearFlows;
use super::settings::{Policy, Settings};
use super::simulation::Halt;
use super::solver::Solver;
use super::tension::{Conditions, Tension};
use crate::moment::Moment;
use crate::trajectory::Why;

use search::{Fault, Search, Stop, flow_failure};

/// By how much a flight may be longer than the last for both to be found in one look.
const MARGIN: f64 = 1.5;

/// A flow that has been looked at in advance. Its times count from its start, in seconds.
pub(super) struct Flight {
    /// When it began.
    pub(super) since: Moment,
    /// How long it takes.
    pub(super) duration: Moment,
    pub(super) pieces: Vec<Piece>,
    /// The state at the end, by variable of the group.
    pub(super) landing: Vec<f64>,
    /// The variables that move along lines, by their place in the group, without those that rest.
    pub(super) lines: Vec<(usize, Line)>,
    /// Where it cannot be said whether something happens.
    pub(super) doubts: Vec<Doubt>,
    /// Where its solution touches a jump of its rates, for all that is known.
    pub(super) grazes: Vec<Doubt>,
    /// Why something may be missed at any time of it.
    pub(super) unknowns: Vec<Why>,
    /// Whether no time can pass at its end, because an invariant ends right after it.
    pub(super) must_leave: bool,
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
    pub(super) start: Vec<Moment>,
    /// How long it takes to the horizon, in seconds.
    pub(super) horizon: f64,
    /// How long it may take, in seconds: a little more, for what happens at the number nearest to the horizon.
    pub(super) limit: f64,
    /// How long the last flight was, in seconds: this one may be as long.
    pub(super) last: f64,
    /// What is known of the linear flows of the group.
    pub(super) linear: &'a mut LinearFlows,
}

impl Plan<'_> {
    /// The flow up to an event; `steps` is how many pieces and spans may still be looked at.
    pub(super) fn fly(self, steps: &mut u64) -> Result<Flight, Halt> {
        let Plan {
            group,
            standing,
            settings,
            policy,
            allowance,
            since,
            start,
            horizon,
            limit,
            last,
            linear,
        } = self;
        let composition = standing.composition;
        let field = Field::of(composition, group, standing.locations, start);
        let conditions = Conditions { standing, group, policy, allowance };
        let rests = |duration| Flight {
            since,
            duration,
            pieces: Vec::new(),
            landing: field.start.clone(),
            lines: field.lines(),
            doubts: Vec::new(),
            grazes: Vec::new(),
            unknowns: Vec::new(),
            must_leave: false,
            halt: None,
        };
        if conditions.tension(&field.start)?.holds {
            return Ok(rests(Moment::default()));
        }
        let failed = |fault: Fault| flow_failure(standing, group, since, fault);
        let locations =
            || group.components.iter().map(|&index| standing.locations[index]).collect();
        let linear = if field.is_straight() { Ok(None) } else { linear.of(locations(), &field) };
        let solver = linear.and_then(|linear| Solver::new(&field, linear, settings, limit));
        let solver = solver.map_err(|fault| failed(fault.to_string().into()))?;
        let mut search = Search {
            tension: Tension::along(conditions, &field),
            solver,
            settings,
            since,
            doubts: Vec::new(),
            steps,
            stride: MARGIN * last,
        };
        let end = match search.run(limit) {
            Ok(end) => end,
            Err(Stop { at, halt }) if since + Moment::from(at) > since => {
                return search.cut_short(at, halt, failed);
            }
            Err(Stop { halt, .. }) => return Err(halt),
        };
        if end.is_after(horizon) && horizon > 0.0 {
            search.doubt_last(horizon).map_err(|stop| stop.halt)?;
        }
        search.land(end, limit, failed)
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
        for (place, line) in &self.lines {
            state[*place] = line.at(Moment::from(time)).seconds();
        }
        state
    }

    /// The flight for `duration` seconds in which lines go on and everything else rests.
    pub(super) fn of_lines(since: Moment, duration: f64, field: &Field<'_>) -> Flight {
        let mut piece = Piece::new(0.0, duration, 0.0, 1.0);
        let mut landing = field.start.clone();
        let lasting = Moment::from(duration);
        for (place, first) in field.start.iter().enumerate() {
            let line = field.line(place);
            piece.push([*first, line.map_or(0.0, |line| line.rate)], 0.0);
            landing[place] = line.map_or(*first, |line| line.at(lasting).seconds());
        }
        Flight {
            since,
            duration: lasting,
            pieces: vec![piece],
            landing,
            lines: field.lines(),
            doubts: Vec::new(),
            grazes: Vec::new(),
            unknowns: Vec::new(),
            must_leave: false,
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
        for doubts in [&mut self.doubts, &mut self.grazes] {
            doubts.retain(|doubt| doubt.from <= time);
            doubts.iter_mut().for_each(|doubt| doubt.to = doubt.to.min(time));
        }
        Flight { duration: Moment::from(time), must_leave: false, ..self }
    }
}

#[cfg(test)]
mod tests {
    use pleach_continuous::flow::Uncertainty;

    use super::*;

    /// x = t up to 1, then 2 t − 1 up to 3, and 10 at the end.
    fn flight() -> Flight {
        let piece = |start: f64, end: f64, row: [f64; 2]| {
            let mut piece = Piece::new(start, end, 0.0, 1.0);
            piece.push(row, 0.0);
            piece
        };
        let doubt = |from: f64, to: f64| Doubt { from, to, why: Uncertainty::Touch };
        Flight {
            since: Moment::from(100.0),
            duration: Moment::from(3.0),
            pieces: vec![piece(0.0, 1.0, [0.0, 1.0]), piece(1.0, 3.0, [-1.0, 2.0])],
            landing: vec![10.0],
            lines: Vec::new(),
            doubts: vec![doubt(0.25, 0.5), doubt(2.0, 3.0)],
            grazes: vec![doubt(0.5, 2.5)],
            unknowns: Vec::new(),
            must_leave: true,
            halt: None,
        }
    }

    #[test]
    fn a_flight_is_on_the_piece_of_its_time_and_lands_at_its_end() {
        assert_eq!(flight().due(), Moment::from(103.0));
        for (time, place) in [(0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (1.5, 2.0), (2.5, 4.0)] {
            assert_eq!(flight().state_at(time), [place], "{time}");
        }
        assert_eq!(flight().state_at(3.0), [10.0]);
        assert_eq!(flight().state_at(7.0), [10.0]);
    }

    #[test]
    fn a_flight_that_is_cut_keeps_what_is_before() {
        for (time, place, ends) in
            [(0.5, 0.5, vec![0.5]), (1.0, 1.0, vec![1.0]), (2.0, 3.0, vec![1.0, 2.0])]
        {
            let cut = flight().cut(time);
            assert_eq!((cut.since, cut.duration), (Moment::from(100.0), Moment::from(time)));
            assert_eq!(cut.landing, [place]);
            assert!(!cut.must_leave, "nothing happens there");
            assert_eq!(cut.pieces.iter().map(Curve::end).collect::<Vec<_>>(), ends);
            assert_eq!(cut.pieces[0].start(), 0.0);
        }
        let spans =
            |doubts: &[Doubt]| doubts.iter().map(|one| [one.from, one.to]).collect::<Vec<_>>();
        let early = flight().cut(0.375);
        assert_eq!(spans(&early.doubts), [[0.25, 0.375]]);
        assert!(early.grazes.is_empty());
        let late = flight().cut(2.25);
        assert_eq!(spans(&late.doubts), [[0.25, 0.5], [2.0, 2.25]]);
        assert_eq!(spans(&late.grazes), [[0.5, 2.25]]);
    }
}
