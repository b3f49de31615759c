//! The solution of a group's flow, piece by piece.

use std::sync::Arc;

use pleach_continuous::flow::{
    Curve, Doubt, IntegrationFailure, Integrator, InvalidFlow, LinearFlow, Onset, Piece, Tolerances,
};
use pleach_guards::{Enclosure, Expression, Interval, Tracker};

use super::Component;
use super::field::{Field, Line, Row};
use super::halving::middle;
use super::hold::{Hold, Unclear};
use super::linear::LinearPart;
use super::settings::Settings;
use crate::moment::Moment;
use crate::trajectory::Why;

/// Steps of fewer spacings of the numbers around the present time are crawling.
const CRAWLING: f64 = 1024.0 * f64::EPSILON;
/// A flow that crawls for this many steps in a row has met a singularity.
const MOST_CRAWLING: u32 = 100;
/// A part of a step beside its ends, where its inside is as exact as they are.
const BESIDE: f64 = 0.01;
/// The largest error, relative to its size, with which the polynomial of a function stands for it.
const FITTING: f64 = 1e-12;
/// How many parts of a step are looked at for what it does not see.
const MOST_GLANCES: u32 = 200;
/// How many spans of a step are examined for where a number is negative.
const MOST_DIPS: usize = 200;
/// How often the time of a function is halved for such a polynomial.
const HALVINGS: u32 = 20;

/// A flow that is being solved; its time counts from its start, in seconds.
pub(super) struct Solver<'a> {
    field: &'a Field<'a>,
    method: Method<'a>,
    pieces: Vec<Piece>,
    /// How many numbers they hold.
    size: usize,
    /// How far it is solved.
    reached: f64,
    crawled: u32,
    /// The time up to which kinks at known instants are passed.
    settled: f64,
    /// The formula with the kink at which the last piece ends, if it ends at one.
    kink: Option<&'a Expression>,
    /// Where the solution touches a jump of its rates, for all that is known.
    grazes: Vec<Doubt>,
    enclosures: Vec<Enclosure>,
    /// The span of the last piece that they are of.
    enclosed: Option<[f64; 2]>,
    /// Whether the integrator itself solves for all variables.
    is_complete: bool,
    /// What steps must not pass over unseen, where rates are such that they could.
    seen_to: Option<Tolerances>,
}

enum Method<'a> {
    /// All variables move along lines.
    Lines,
    /// The curved ones by the matrix exponential.
    Linear(LinearFlow, Arc<[usize]>),
    Steps(Box<Integrator<'a, Field<'a>>>),
}

impl<'a> Solver<'a> {
    /// The solution for at most `limit` seconds, where `linear` is the linear part of the field, if
    /// it has one.
    pub(super) fn new(
        field: &'a Field<'a>,
        linear: Option<LinearPart>,
        settings: &Settings,
        limit: f64,
    ) -> Result<Self, InvalidFlow> {
        let method = match linear {
            _ if field.is_straight() => Method::Lines,
            Some(LinearPart { variables, field: linear }) => {
                let start: Vec<f64> = variables.iter().map(|&place| field.start[place]).collect();
                Method::Linear(LinearFlow::of(&linear, &start, limit)?, variables)
            }
            None => {
                field.choose_sides(0.0, &field.start);
                let start = field.integrated_of(&field.start);
                let integrator = Integrator::new(field, 0.0, &start, settings.tolerances());
                Method::Steps(Box::new(integrator.with_method(settings.method)))
            }
        };
        let seen_to = field.is_sharp().then(|| settings.tolerances());
        let is_complete =
            matches!(method, Method::Steps(_)) && field.rows.iter().all(|row| *row == Row::Curved);
        Ok(Solver {
            field,
            method,
            pieces: Vec::new(),
            size: 0,
            reached: 0.0,
            crawled: 0,
            settled: 0.0,
            kink: None,
            grazes: Vec::new(),
            enclosures: Vec::new(),
            enclosed: None,
            is_complete,
            seen_to,
        })
    }

    /// Whether all variables move along lines, so that nothing needs to be solved.
    pub(super) fn is_straight(&self) -> bool {
        matches!(self.method, Method::Lines)
    }

    /// Why something may be missed, where flows are functions of which values alone are known.
    pub(super) fn unknowns(&self) -> Vec<Why> {
        let solution = self.field.has_solutions().then_some(Why::Solution);
        let field = self.field.has_functions().then_some(Why::Field);
        solution.into_iter().chain(field).collect()
    }

    /// Where the solution, up to this time, touches a jump of its rates within its error.
    pub(super) fn grazes(&mut self, time: f64) -> Vec<Doubt> {
        let mut grazes = std::mem::take(&mut self.grazes);
        grazes.retain(|graze| graze.from < time);
        grazes
    }

    /// The state at the start.
    pub(super) fn start(&self) -> &[f64] {
        &self.field.start
    }

    /// The variables that move along lines, by their place, without those that rest.
    pub(super) fn lines(&self) -> Vec<(usize, Line)> {
        self.field.lines()
    }

    /// How far the flow is solved.
    pub(super) fn reached(&self) -> f64 {
        self.reached
    }

    /// The piece that holds `time`, solving the flow as far as it takes, but not beyond `limit`.
    ///
    /// # Errors
    ///
    /// Why the flow cannot be followed up to there; it is solved as far as it can.
    pub(super) fn piece_at(&mut self, time: f64, limit: f64) -> Result<&Piece, String> {
        while self.reached <= time && self.reached < limit || self.pieces.is_empty() {
            self.extend(limit)?;
        }
        let last = self.pieces.len() - 1;
        if self.pieces[last].start() <= time {
            return Ok(&self.pieces[last]);
        }
        let number = self.pieces.partition_point(|piece| piece.end() <= time);
        Ok(&self.pieces[number.min(last)])
    }

    /// How many numbers the pieces hold.
    pub(super) fn size(&self) -> usize {
        self.size
    }

    /// The solution up to `time`.
    pub(super) fn into_pieces(mut self, time: f64) -> Result<Vec<Piece>, String> {
        if time > 0.0 {
            self.piece_at(time.next_down(), time)?;
        }
        self.pieces.retain(|piece| piece.start() < time);
        if let Some(last) = self.pieces.pop() {
            self.pieces.push(last.within(0.0, time));
        }
        // A record keeps them, of each of very many flights.
        self.pieces.shrink_to_fit();
        Ok(self.pieces)
    }

    /// The state at `time`, what moves along lines and what is solved by itself exactly.
    ///
    /// # Errors
    ///
    /// As for [`piece_at`](Self::piece_at).
    pub(super) fn state_at(&mut self, time: Moment) -> Result<Vec<f64>, String> {
        let (field, is_complete) = (self.field, self.is_complete);
        let (mut state, at) = (field.start.clone(), time.seconds());
        let piece = if self.is_straight() { None } else { Some(self.piece_at(at, at)?) };
        if let Some(piece) = piece.filter(|_| is_complete) {
            piece.state_at(at, &mut state);
            return Ok(state);
        }
        let at = piece.map_or(at, |piece| at.clamp(piece.start(), piece.end()));
        for (place, (row, value)) in field.rows.iter().zip(&mut state).enumerate() {
            match (*row, piece) {
                // Over infinite rates nothing is exact.
                (Row::Line(0.0), _) | (Row::Curved | Row::Solved, None) => {}
                (Row::Line(_), _) => {
                    *value = field.line(place).map_or(*value, |line| line.at(time).seconds());
                }
                (Row::Curved | Row::Solved, Some(piece)) => *value = piece.value(place, at),
            }
        }
        field.overlay(time.seconds(), &mut state);
        Ok(state)
    }

    /// Adds the next piece.
    fn extend(&mut self, limit: f64) -> Result<(), String> {
        let start = self.reached;
        let piece = match self.field.hold() {
            Some(hold) => self.held(hold, limit)?,
            None => self.next_piece(limit)?,
        };
        if self.overflows(&piece) {
            return Err("the state grows beyond the largest number".to_owned());
        }
        self.enclosed = None;
        let bounded = self.check_rates(&piece).and_then(|()| self.check_radicands(&piece));
        let end = bounded.as_ref().err().map_or(piece.end(), |(singularity, _)| *singularity);
        let progress = self.check_progress(&piece);
        if self.field.next_kink(self.settled) == Some(piece.end()) {
            self.begin_sides(&piece, piece.end());
        }
        if end > start {
            self.reached = end;
            self.size += piece.numbers();
            self.pieces.push(piece.within(start, end));
        }
        bounded.map_err(|(_, reason)| reason)?;
        progress
    }

    /// The solution from where it is solved to on, of one step at most.
    fn next_piece(&mut self, limit: f64) -> Result<Piece, String> {
        let start = self.reached;
        let curved = match &mut self.method {
            Method::Lines => Piece::new(start, limit, 0.0, 1.0),
            Method::Linear(flow, _) => flow.piece_up_to(start, limit).within(start, limit),
            Method::Steps(integrator) => {
                let limit =
                    self.field.next_kink(self.settled).map_or(limit, |kink| limit.min(kink));
                let step = integrator.step(limit).map_err(|fault| without_time(&fault))?;
                step.piece(start).ok_or("the flow has no solution")?
            }
        };
        let piece = self.complete(curved);
        let piece = match self.unseen(&piece) {
            Some(time) => self.shortened(time)?,
            None => piece,
        };
        Ok(if self.field.has_solutions() { self.fitted(&piece) } else { piece })
    }

    /// A time in a step, after which, or up to which if the step begins with it, a rate may act so briefly
    /// that the step does not see it.
    fn unseen(&self, piece: &Piece) -> Option<f64> {
        let tolerances = self.seen_to.filter(|_| matches!(self.method, Method::Steps(_)))?;
        if !self.field.is_strained(piece) {
            return None;
        }
        let whole = [piece.start(), piece.end()];
        let mut spans = vec![whole];
        for left in (0..MOST_GLANCES).rev() {
            let [from, to] = spans.pop()?;
            let strain = self.field.strain(piece, [from, to], tolerances);
            if strain.shift <= 1.0 {
                continue;
            }
            match middle(from, to).filter(|_| strain.is_strained && left > 0) {
                Some(middle) => spans.extend([[middle, to], [from, middle]]),
                None if [from, to] == whole => return None,
                None => return Some(if from > piece.start() { from } else { to }),
            }
        }
        None
    }

    /// The last step once more, up to this time.
    fn shortened(&mut self, time: f64) -> Result<Piece, String> {
        let start = self.reached;
        let Some(integrator) = self.integrator() else { return Err("no step to undo".to_owned()) };
        integrator.undo();
        let step = integrator.step(time).map_err(|fault| without_time(&fault))?;
        let curved = step.piece(start).ok_or("the flow has no solution")?;
        Ok(self.complete(curved))
    }

    /// The same with rates that have kinks: on one side of each, and up to where the state passes one.
    fn held(&mut self, hold: &Hold<'a>, limit: f64) -> Result<Piece, String> {
        self.kink = None;
        if hold.is_active() {
            if let Some(piece) = self.up_to_kink(hold, limit) {
                return Ok(piece);
            }
            self.release(hold);
        }
        let piece = self.next_piece(limit)?;
        // Beyond the kink, sides can be held again.
        if self.begin_sides(&piece, piece.end()).is_none() {
            hold.release();
        }
        Ok(piece)
    }

    /// A piece on the sides that are held, up to the first kink; none if the rates on these sides have
    /// no value beyond a kink.
    fn up_to_kink(&mut self, hold: &Hold<'a>, limit: f64) -> Option<Piece> {
        let mut piece = self.next_piece(limit).ok()?;
        let mut passed = hold.passed(&piece);
        if let Ok(Some(onset)) = passed {
            let share = (onset.time - piece.start()) / (piece.end() - piece.start());
            if (BESIDE..1.0 - BESIDE).contains(&share) {
                // A step that ends at the kink is more exact than one beyond it is inside.
                self.integrator()?.undo();
                piece = self.next_piece(onset.time).ok()?;
                passed = hold.passed(&piece);
            }
        }
        let grazes = match passed {
            Ok(None) => hold.grazes(&piece),
            Ok(Some(Onset { time, .. })) => {
                let up_to = piece.clone().within(0.0, time);
                let grazes = hold.grazes(&up_to);
                let kink = self.begin_sides(&piece, time);
                if kink.is_none() {
                    self.integrator()?.undo();
                    return None;
                }
                self.kink = kink;
                piece = up_to;
                grazes
            }
            Err(Unclear) => {
                self.integrator()?.undo();
                return None;
            }
        };
        self.grazes.extend(grazes);
        Some(piece)
    }

    /// Goes on from a time of a piece with the sides that hold there: the first kink that was passed.
    fn begin_sides(&mut self, piece: &Piece, time: f64) -> Option<&'a Expression> {
        self.settled = time;
        let mut state = self.field.start.clone();
        piece.state_at(time, &mut state);
        let kink = self.field.choose_sides(time, &state)?;
        let state = self.field.integrated_of(&state);
        self.integrator()?.restart(time, &state);
        Some(kink)
    }

    /// Goes on with the rates as they are.
    fn release(&mut self, hold: &Hold<'a>) {
        hold.release();
        if let Some(integrator) = self.integrator() {
            let (time, state) = (integrator.time(), integrator.state().to_vec());
            integrator.restart(time, &state);
        }
    }

    fn integrator(&mut self) -> Option<&mut Integrator<'a, Field<'a>>> {
        match &mut self.method {
            Method::Steps(integrator) => Some(integrator),
            _ => None,
        }
    }

    /// Whether a variable that began with a finite value, or its rate, may have none in the piece.
    fn overflows(&self, piece: &Piece) -> bool {
        if piece.is_finite() {
            return false;
        }
        let size = |(power, coefficient): (usize, &f64)| (power + 1) as f64 * coefficient.abs();
        let is_finite = |place: usize| {
            let sizes = piece.coefficients(place).iter().enumerate().map(size);
            sizes.sum::<f64>().is_finite() && piece.error(place).is_finite()
        };
        (0..piece.dimension()).any(|place| self.field.start[place].is_finite() && !is_finite(place))
    }

    /// The piece with all variables, given that of the curved ones.
    fn complete(&self, curved: Piece) -> Piece {
        if self.is_complete {
            return curved;
        }
        let (origin, scale) = (curved.origin(), curved.scale());
        let mut piece = Piece::new(curved.start(), curved.end(), origin, scale)
            .with_room(self.field.rows.len(), curved.degree().max(1) + 1);
        let variables = match &self.method {
            Method::Lines => &[],
            Method::Linear(_, variables) => &**variables,
            Method::Steps(_) => self.field.integrated(),
        };
        let mut next = 0;
        for (place, row) in self.field.rows.iter().enumerate() {
            let own = (variables.get(next) == Some(&place)).then_some(next);
            next += usize::from(own.is_some());
            match (row, own) {
                (Row::Curved, Some(own)) => {
                    piece.push(curved.coefficients(own).iter().copied(), curved.error(own));
                }
                (Row::Line(rate), _) => {
                    let first = self.field.start[place];
                    piece.push([rate.mul_add(origin, first), rate * scale], 0.0);
                }
                _ => piece.push([self.field.start[place]], 0.0),
            }
        }
        piece
    }

    /// The piece with what is solved by itself as polynomials through its values.
    fn fitted(&self, piece: &Piece) -> Piece {
        let (start, mut length) = (piece.start(), piece.end() - piece.start());
        for _ in 0..HALVINGS {
            let fit = self.fit(piece, start, length);
            let is_close = |component: usize| {
                let size = fit.coefficients(component).iter().map(|c| c.abs()).sum::<f64>();
                fit.error(component) <= piece.error(component) + FITTING * size
            };
            if (0..fit.dimension()).all(is_close) {
                return fit;
            }
            length *= 0.5;
        }
        self.fit(piece, start, length)
    }

    fn fit(&self, piece: &Piece, start: f64, length: f64) -> Piece {
        Piece::through(start, length, piece.dimension(), |time, state| {
            piece.state_at(time, state);
            self.field.overlay(time, state);
        })
    }

    /// No rate grows without bound in the piece. Where one may, its surroundings are halved until
    /// it does not, or until nothing is left to halve: then the rate is bounded up to there alone.
    fn check_rates(&mut self, piece: &Piece) -> Result<(), (f64, String)> {
        let field = self.field;
        if field.bounds_rates(piece) {
            return Ok(());
        }
        for (component, rate) in field.unbounded_rates() {
            let Some(tracker) = &rate.tracker else { continue };
            let mut spans = vec![(piece.start(), piece.end())];
            while let Some((from, to)) = spans.pop() {
                let range = self.range(tracker, component, piece, [from, to]);
                if range.lower().is_finite() && range.upper().is_finite() {
                    continue;
                }
                let Some(middle) = middle(from, to).filter(|_| !is_crawling(from, to)) else {
                    let name = component.blueprint.coordinates[rate.coordinate];
                    let reason = format!(
                        "within the error of the solution, the rate of `{name}` may grow without bound \
                         or have no value"
                    );
                    return Err((from, reason));
                };
                spans.extend([(middle, to), (from, middle)]);
            }
        }
        Ok(())
    }

    /// What the margin of a condition of a component can be in a span of a piece.
    fn range(
        &mut self,
        condition: &Tracker,
        component: &Component,
        piece: &Piece,
        [from, to]: [f64; 2],
    ) -> Interval {
        if self.enclosed != Some([from, to]) {
            piece.enclose(from, to, &mut self.enclosures);
            self.enclosed = Some([from, to]);
        }
        let half = 0.5 * (to - from) * (1.0 + 4.0 * f64::EPSILON);
        let margins = condition.comparisons().iter();
        let ranges = margins.map(|it| it.margin(&self.enclosures, &component.places, half).range);
        ranges.reduce(Interval::hull).unwrap_or(Interval::WHOLE)
    }

    /// No root is taken of a negative number in the piece. A number that only comes to zero, as the level of a tank
    /// does, is not negative anywhere.
    fn check_radicands(&mut self, piece: &Piece) -> Result<(), (f64, String)> {
        let whole = [piece.start(), piece.end()];
        for (component, rate) in self.field.formulas() {
            for radicand in &rate.radicands {
                let mut range = |span| self.range(radicand, component, piece, span);
                let Some(end) = end_before_negative(whole, &mut range) else { continue };
                let name = component.blueprint.coordinates[rate.coordinate];
                let reason = format!("a root in the rate of `{name}` has no value any more");
                return Err((end, reason));
            }
        }
        Ok(())
    }

    fn check_progress(&mut self, piece: &Piece) -> Result<(), String> {
        let crawls = is_crawling(piece.start(), piece.end());
        self.crawled = if crawls { self.crawled + 1 } else { 0 };
        if self.crawled <= MOST_CRAWLING {
            return Ok(());
        }
        if let Some(kink) = self.kink {
            return Err(format!(
                "no solution leaves the kink of `{kink}`, to which the flow leads from both sides (it \
                 slides: make each side a location, and see `Automaton::with_sliding`)"
            ));
        }
        Err("the flow is singular: steps are too short to go on".to_owned())
    }
}

/// The time up to which a number is not known to be negative, if it is negative somewhere in a span of time. `range`
/// bounds the number over a span.
fn end_before_negative(
    whole: [f64; 2],
    range: &mut dyn FnMut([f64; 2]) -> Interval,
) -> Option<f64> {
    let (mut before, mut after) = (whole[0], time_of_negative(whole, range)?);
    while let Some(time) = middle(before, after).filter(|_| !is_crawling(before, after)) {
        match range([time, after]).upper() < 0.0 {
            true => after = time,
            false => before = time,
        }
    }
    Some(before)
}

/// A time at which the number is negative. The span in which the number may be lowest is halved, at most
/// [`MOST_DIPS`] times.
fn time_of_negative(whole: [f64; 2], range: &mut dyn FnMut([f64; 2]) -> Interval) -> Option<f64> {
    let mut spans = vec![(range(whole), whole)];
    for _ in 0..MOST_DIPS {
        let lower = |at: usize| spans[at].0.lower();
        let lowest = (0..spans.len()).min_by(|&one, &other| lower(one).total_cmp(&lower(other)))?;
        let (bounds, [from, to]) = spans.swap_remove(lowest);
        if bounds.lower() >= 0.0 {
            return None;
        }
        if bounds.upper() < 0.0 {
            return Some(from);
        }
        let middle = middle(from, to)?;
        spans.extend([[from, middle], [middle, to]].map(|span| (range(span), span)));
    }
    None
}

/// Whether a span of time is hardly longer than rounding.
fn is_crawling(from: f64, to: f64) -> bool {
    to - from <= CRAWLING * to.abs()
}

/// What is wrong, without the time, which counts from the start of the flow.
fn without_time(fault: &IntegrationFailure) -> String {
    match fault {
        IntegrationFailure::StepTooSmall { .. } => {
            "no step is accurate enough, however short: the solution runs off to infinity, or its \
             rates jump"
                .to_owned()
        }
        IntegrationFailure::Undefined { .. } => "the rates are not finite numbers".to_owned(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use pleach_guards::{constant, variable};

    use super::super::field::tests::{field, piece, plane, wave};
    use super::*;

    fn solver<'a>(field: &'a Field<'a>, limit: f64) -> Solver<'a> {
        let linear = field.linear().expect("its numbers are finite");
        Solver::new(field, linear, &Settings::default(), limit).expect("it can be solved")
    }

    /// A value counts with its rate, each variable by itself, and only where it began as a number.
    #[test]
    fn what_began_finite_overflows_with_its_value_its_rate_or_its_error() {
        let plane = plane([constant(0.0), constant(0.0)]);
        let most = f64::MAX;
        let overflows = |start: [f64; 2], rows: [&[f64]; 2], error: f64| {
            let mut piece = Piece::new(0.0, 1.0, 0.0, 1.0);
            piece.push(rows[0].iter().copied(), error);
            piece.push(rows[1].iter().copied(), 0.0);
            solver(&field(&plane, start), 1.0).overflows(&piece)
        };
        let still = [0.0; 2];
        assert!(!overflows(still, [&[1.0, 2.0], &[3.0]], 0.0));
        assert!(!overflows(still, [&[0.9 * most], &[0.9 * most]], 0.0));
        assert!(overflows(still, [&[0.5 * most, 0.5 * most], &[0.0]], 0.0));
        assert!(overflows(still, [&[0.0], &[0.0, 0.0, 0.4 * most]], 0.0));
        assert!(!overflows(still, [&[0.0], &[0.0, 0.0, 0.3 * most]], 0.0));
        assert!(overflows(still, [&[f64::INFINITY], &[0.0]], 0.0));
        assert!(!overflows([f64::INFINITY, 0.0], [&[f64::INFINITY], &[0.0]], 0.0));
        assert!(overflows(still, [&[1.0], &[0.0]], f64::INFINITY));
    }

    /// As closely as the digits of its values allow, in pieces of one number whatever their unit is.
    #[test]
    fn polynomials_stand_for_functions_up_to_rounding() {
        let pieces = |frequency: f64, size: f64| {
            let wave = wave(frequency, size);
            let field = field(&wave, [0.0, 0.0]);
            let mut solver = solver(&field, 8.0);
            while solver.reached() < 8.0 {
                let reached = solver.reached();
                let piece = solver.piece_at(reached, 8.0).expect("it has a solution");
                assert!(piece.start() == reached && piece.end() > reached);
                for part in 0..=32 {
                    let length = piece.end() - piece.start();
                    let time = piece.start() + length * f64::from(part) / 32.0;
                    let exact = size * (frequency * time).sin();
                    assert!((piece.value(1, time) - exact).abs() < 1e-11 * size, "{time}");
                }
                assert!(solver.pieces.len() < 1000, "pieces are short");
            }
            assert_eq!(solver.reached(), 8.0);
            solver.into_pieces(8.0).expect("it is solved").len()
        };
        let (slow, fast) = (pieces(1.0, 1.0), pieces(16.0, 1.0));
        assert!(slow <= 32 && fast <= 40 * slow, "{slow}, {fast}");
        for exponent in [-40, -3, 3, 40] {
            assert_eq!(pieces(1.0, 2f64.powi(exponent)), slow, "{exponent}");
        }
    }

    /// y′ is e^−((x − c) ÷ w)² ÷ w and x is the time: the step has to end before the spike, or where it is over
    /// if it begins with it.
    #[test]
    fn a_step_ends_before_what_it_does_not_see() {
        let [x, _] = ["x", "y"].map(variable);
        let ends = |centre: f64, width: f64, height: f64, steps: [f64; 2]| {
            let spike = height / width * (-((&x - centre) / width).power(2.0)).exp();
            let plane = plane([constant(1.0), spike]);
            let field = field(&plane, [0.0, 0.0]);
            let mut step = Piece::new(steps[0], steps[1], 0.0, 1.0);
            step.push([0.0, 1.0], 0.0);
            step.push([0.0], 0.0);
            solver(&field, 100.0).unseen(&step)
        };
        for width in [1e-2, 1e-3, 1e-4] {
            for centre in [3.0, 10.0, 47.0, 99.9] {
                for end in [100.0, 128.0] {
                    let found = ends(centre, width, 1.0, [0.0, end]).expect("there is a spike");
                    assert!(centre - 50.0 * width < found && found < centre, "{found}: {centre}");
                }
                assert_eq!(ends(centre, width, 1e-14, [0.0, 100.0]), None, "it is small");
                let [before, after] = [centre - 100.0 * width, centre + 100.0 * width];
                assert_eq!(ends(centre, width, 1.0, [0.0, before]), None, "it comes later");
                assert_eq!(ends(centre, width, 1.0, [after, 200.0]), None, "it is over");
            }
            // From the middle of the spike on.
            let found = ends(5.0, width, 1.0, [5.0, 105.0]).expect("there is a spike");
            assert!(5.0 < found && found < 5.0 + 50.0 * width, "{found}");
        }
    }

    /// A number is negative where its bounds are; one that may be zero everywhere is not known to be.
    #[test]
    fn a_number_is_negative_from_where_its_upper_bound_is() {
        let never = |bounds: fn([f64; 2]) -> [f64; 2]| {
            let mut range = |span| {
                let [lower, upper] = bounds(span);
                Interval::new(lower, upper).expect("it is one")
            };
            end_before_negative([0.0, 4.0], &mut range).is_none()
        };
        assert!(never(|_| [0.0, 1.0]) && never(|_| [0.0, 0.0]));
        assert!(never(|_| [-1.0, 0.0]) && never(|_| [-1e-300, 1.0]));
        assert!(never(|[from, to]| [1.0 - 0.25 * to, 1.0 - 0.25 * from]));
        assert!(!never(|_| [-1.0, -1e-300]));
        // It falls, and its bounds are exact, or as loose as those of polynomials.
        let end = |bound: f64, slack: f64| {
            let mut range = |[from, to]: [f64; 2]| {
                let loose = slack * (to - from).powi(2);
                Interval::new(bound - to - loose, bound - from + loose).expect("it is one")
            };
            end_before_negative([0.0, 4.0], &mut range).expect("it is negative")
        };
        for bound in [0.1, 1.0, 3.9] {
            assert!((end(bound, 0.0) - bound).abs() < 1e-12, "{bound}");
            let late = end(bound, 0.5);
            assert!(bound - 1e-12 < late && late < 4.0, "{late}: {bound}");
        }
    }

    /// Bounds of a margin hold what it is, and hardly more where spans are short.
    #[test]
    fn the_range_of_a_margin_holds_its_values_closely() {
        type Exactly = fn(f64) -> f64;
        let [x, y] = ["x", "y"].map(variable);
        let margins: [(Expression, Exactly); 3] = [
            (1.0 / &x, |t| 1.0 / (1.0 + t)),
            (&x * &y - 2.0, |t| (1.0 + t) * (3.0 - t * t) - 2.0),
            (y.exp() + &x, |t| (3.0 - t * t).exp() + 1.0 + t),
        ];
        let plane = plane([constant(1.0), constant(0.0)]);
        let field = field(&plane, [1.0, 3.0]);
        let piece = piece(8.0, [&[1.0, 1.0], &[3.0, 0.0, -1.0]]);
        for (margin, value) in margins {
            let tracker = margin.at_least(0.0).track(&["x", "y"]).expect("it is of x and y");
            for width in [1e-3, 1e-2, 0.1] {
                for from in [0.0, 0.3, 1.5] {
                    let to = from + width;
                    let mut solver = solver(&field, 8.0);
                    let found = solver.range(&tracker, &plane.components[0], &piece, [from, to]);
                    let all = (0..=64).map(|part| value(from + width * f64::from(part) / 64.0));
                    let lower = all.clone().fold(f64::INFINITY, f64::min);
                    let upper = all.fold(f64::NEG_INFINITY, f64::max);
                    let room = 1e-12 + 50.0 * width * width;
                    assert!(found.lower() <= lower + 1e-12 && upper - 1e-12 <= found.upper());
                    assert!(lower - found.lower() < room, "{margin}: {found:?}, {lower}");
                    assert!(found.upper() - upper < room, "{margin}: {found:?}, {upper}");
                }
            }
        }
    }

    /// 1 ÷ x where x = 1 − t, and other rates that have no bound at x = 0.
    #[test]
    fn rates_are_bounded_up_to_where_they_are_not() {
        let [x, y] = ["x", "y"].map(variable);
        for rate in [1.0 / &x, -1.0 / &x, x.ln(), -x.ln(), x.power(-0.5), &y / x.power(2.0)] {
            let sides = [("x", [rate.clone(), y.ln()]), ("y", [y.ln(), rate.clone()])];
            for (name, rates) in sides {
                let plane = plane(rates);
                let field = field(&plane, [1.0, 1.0]);
                let mut solver = solver(&field, 10.0);
                let mut checked =
                    |end: f64| solver.check_rates(&piece(end, [&[1.0, -1.0], &[1.0, 1.0]]));
                assert_eq!(checked(0.5), Ok(()));
                assert_eq!(checked(1.0 - 1e-9), Ok(()), "{rate}");
                for end in [1.0, 1.5, 1000.0] {
                    let (last, reason) = checked(end).expect_err("there is a pole");
                    assert!(1.0 - 1e-12 < last && last <= 1.0, "{rate}: {last}");
                    assert!(reason.contains(&format!("`{name}`")), "{reason}");
                }
            }
        }
    }

    /// What is kept ends where it is asked to, and begins at the start.
    #[test]
    fn pieces_are_kept_up_to_the_end_of_a_flight() {
        let [x, y] = ["x", "y"].map(variable);
        let plane = plane([y.clone(), -&x + 0.0 * y.power(2.0)]);
        let field = field(&plane, [0.0, 1.0]);
        let mut whole = solver(&field, 10.0);
        while whole.reached() < 10.0 {
            whole.piece_at(whole.reached(), 10.0).expect("it can be followed");
        }
        let ends: Vec<f64> = whole.pieces.iter().map(Curve::end).collect();
        assert!(ends.len() > 10);
        for (number, &end) in ends.iter().enumerate().take(10) {
            let begin = if number == 0 { 0.0 } else { ends[number - 1] };
            for time in [end, 0.5 * (begin + end)] {
                let mut solver = solver(&field, 10.0);
                solver.piece_at(9.9, 10.0).expect("it can be followed");
                let pieces = solver.into_pieces(time).expect("it can be followed");
                assert_eq!(pieces.len(), number + 1);
                assert!(pieces.windows(2).all(|pair| pair[0].end() == pair[1].start()));
                assert_eq!((pieces[0].start(), pieces[number].end()), (0.0, time));
            }
            let middle = 0.5 * (begin + end);
            let found = whole.piece_at(middle, 10.0).expect("it is solved");
            assert_eq!((found.start(), found.end()), (begin, end));
        }
        assert_eq!(solver(&field, 10.0).into_pieces(0.0).expect("there is none").len(), 0);
    }

    /// Of a step that ends at a kink all is kept, up to rounding, unless hardly any of it is: it is a step of its
    /// own, and as exact as any other.
    #[test]
    fn a_step_ends_at_a_kink_and_not_beyond_it() {
        let [x, y] = ["x", "y"].map(variable);
        for stiffness in [1.0, 4.0, 37.0] {
            let plane = plane([y.clone(), stiffness * (1.5 * x.abs() - 2.5 * &x)]);
            let field = field(&plane, [1.0, 0.5]);
            let (mut solver, mut kinks) = (solver(&field, 100.0), 0);
            while solver.reached() < 100.0 {
                let reached = solver.reached();
                let piece = solver.piece_at(reached, 100.0).expect("it can be followed").clone();
                if solver.kink.is_some() {
                    let share = (piece.end() - piece.start()) / piece.scale();
                    let is_kept = !(1.01 * BESIDE..1.0 - 1.01 * BESIDE).contains(&share);
                    assert!(is_kept, "{share} of a step at {reached}");
                    assert!(piece.value(0, piece.end()).abs() < 1e-6, "there is the kink");
                    kinks += 1;
                }
            }
            assert!(kinks > 20, "{kinks}");
        }
    }

    /// Near 0 numbers are as close as anywhere, in proportion.
    #[test]
    fn spans_of_a_thousand_roundings_crawl() {
        for time in [1e-9, 1.0, 3.0, 1e9] {
            for spacings in [0.0, 1.0, 900.0] {
                assert!(is_crawling(time, time * (1.0 + spacings * f64::EPSILON)));
            }
            for spacings in [1100.0, 1e6, 1e15] {
                assert!(!is_crawling(time, time * (1.0 + spacings * f64::EPSILON)));
            }
            assert!(!is_crawling(0.0, time) && !is_crawling(0.5 * time, time));
        }
    }
}
