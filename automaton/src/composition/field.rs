//! The vector field of a group: the flows of its components in their locations, as one.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use nalgebra::DMatrix;
use pleach_continuous::flow::{InvalidFlow, LinearField, Piece, Tolerances, VectorField};
use pleach_guards::{Expression, Interval, Tape};

use super::blueprint::{Mode, ModeMotion, RateProgram, Solution};
use super::group::Group;
use super::hold::Hold;
use super::linear::LinearPart;
use super::{Component, Composition};
use crate::moment::Moment;

/// The most moving variables for which the matrix exponential is cheaper than an integrator.
const LARGEST_LINEAR: usize = 16;
/// The same, with those that rest and are read.
const LARGEST_MATRIX: usize = 64;

/// How a variable moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Row {
    /// At this rate, also 0: x = x₀ + c t.
    Line(f64),
    /// By a rate that depends on variables.
    Curved,
    /// By a component that solves its flow itself.
    Solved,
}

/// A variable that moves along a line, to twice the precision of a number.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) start: Moment,
    /// Per second.
    pub(super) rate: f64,
}

/// The part of a sum below which its rest is rounding of the sum.
const ROUNDING: f64 = f64::EPSILON * f64::EPSILON * 16.0;

impl Line {
    /// Where it is `time` after the start. A rest that may be rounding is none, so that a variable that comes to a
    /// bound is exactly there.
    pub(super) fn at(self, time: Moment) -> Moment {
        let end = self.start + Moment::from(self.rate) * time;
        let size = self.start.seconds().abs() + end.seconds().abs();
        if end.rest().abs() > ROUNDING * size { end } else { Moment::from(end.seconds()) }
    }

    /// The number nearest to where it begins, and its rate.
    fn rounded(self) -> (f64, f64) {
        (self.start.seconds(), self.rate)
    }
}

/// The flow of a group in its locations, from a state on.
pub(super) struct Field<'a> {
    /// Those that neither move along lines alone nor solve their flow themselves, each with its mode.
    moving: Vec<(&'a Component, &'a Mode)>,
    solved: Vec<(&'a Component, &'a Solution)>,
    /// The rates of all variables, if one component says how all of them move and none has a kink to hold.
    whole: Option<&'a Tape>,
    /// By variable of the group.
    pub(super) rows: Vec<Row>,
    pub(super) start: Vec<f64>,
    /// The start to twice the precision.
    exact_start: Vec<Moment>,
    /// See [`integrated`](Self::integrated).
    integrated: OnceCell<Box<[usize]>>,
    /// A state of all variables and their rates, where not all are integrated.
    completed: RefCell<[Vec<f64>; 2]>,
    /// Room for the coordinates of a component and their rates, and for a state.
    scratch: RefCell<[Vec<f64>; 3]>,
    /// By moving component: the places of its tape, once they are needed.
    places: RefCell<Vec<Vec<f64>>>,
    /// Room for the ranges of coordinates, what is computed from them, and those of rates.
    ranges: RefCell<[Vec<Interval>; 3]>,
    /// Where rates have kinks that are not known beforehand, or jump.
    hold: Option<Box<Hold<'a>>>,
}

/// How rates vary over a span of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Strain {
    /// Whether they may vary by more than an integrator sees.
    pub(super) is_strained: bool,
    /// By how much this moves variables at most, in units of what the tolerances allow.
    pub(super) shift: f64,
}

/// A coefficient of a linear rate: its row, its column and its value.
type Entry = (usize, usize, f64);

impl<'a> Field<'a> {
    pub(super) fn of(
        composition: &'a Composition,
        group: &Group,
        locations: &[usize],
        start: Vec<Moment>,
    ) -> Self {
        let (mut moving, mut solved) = (Vec::new(), Vec::new());
        let mut rows = vec![Row::Line(0.0); start.len()];
        for &index in &group.components {
            let component = &composition.components[index];
            let mode = component.mode(locations[index]);
            match &mode.motion {
                ModeMotion::Exact(advance) => {
                    component.owned_places().for_each(|place| rows[place] = Row::Solved);
                    solved.push((component, &**advance));
                }
                ModeMotion::Rates(rates) => {
                    let mut is_curved = false;
                    for rate in rates {
                        let row = rate.row();
                        is_curved |= row == Row::Curved;
                        rows[component.places[rate.coordinate]] = row;
                    }
                    if is_curved {
                        moving.push((component, mode));
                    }
                }
                ModeMotion::Field(_) => {
                    component.owned_places().for_each(|place| rows[place] = Row::Curved);
                    moving.push((component, mode));
                }
            }
        }
        let hold = Hold::of(&moving, &rows);
        let whole = match &moving[..] {
            [(component, mode)] if mode.is_whole && hold.is_none() => {
                let is_all = component.window == Some(0) && component.places.len() == rows.len();
                is_all.then_some(&mode.rates)
            }
            _ => None,
        };
        Field {
            moving,
            solved,
            whole,
            rows,
            start: start.iter().copied().map(Moment::seconds).collect(),
            exact_start: start,
            hold,
            integrated: OnceCell::new(),
            completed: RefCell::default(),
            places: RefCell::default(),
            scratch: RefCell::default(),
            ranges: RefCell::default(),
        }
    }

    /// Whether all variables move along lines, or are solved by themselves.
    pub(super) fn is_straight(&self) -> bool {
        !self.rows.contains(&Row::Curved)
    }

    /// The variables that an integrator follows: those with curved rows, and those on lines that the
    /// components of these may read. Rates read others as they are at the start.
    pub(super) fn integrated(&self) -> &[usize] {
        self.integrated.get_or_init(|| {
            let moves = |place: usize| !matches!(self.rows[place], Row::Line(0.0) | Row::Solved);
            let mut belongs = vec![false; self.rows.len()];
            for (component, _) in &self.moving {
                component.places.iter().for_each(|&place| belongs[place] |= moves(place));
            }
            (0..belongs.len()).filter(|&place| belongs[place]).collect()
        })
    }

    /// Of a state of all variables those that are integrated.
    pub(super) fn integrated_of(&self, state: &[f64]) -> Vec<f64> {
        self.integrated().iter().map(|&place| state[place]).collect()
    }

    /// Whether a component solves its flow itself.
    pub(super) fn has_solutions(&self) -> bool {
        !self.solved.is_empty()
    }

    /// Whether the rates of a component are a function.
    pub(super) fn has_functions(&self) -> bool {
        self.moving.iter().any(|(_, mode)| matches!(mode.motion, ModeMotion::Field(_)))
    }

    /// The variables with curved rows and what they read, if all their rates are linear and they
    /// are few. It depends on the locations alone, and not on the state.
    ///
    /// # Errors
    ///
    /// If a coefficient is not finite.
    pub(super) fn linear(&self) -> Result<Option<LinearPart>, InvalidFlow> {
        let Some((offsets, entries)) = self.entries() else { return Ok(None) };
        let mut belongs: Vec<bool> = self.rows.iter().map(|row| *row == Row::Curved).collect();
        entries.iter().for_each(|(_, column, _)| belongs[*column] = true);
        let variables: Arc<[usize]> = (0..belongs.len()).filter(|&place| belongs[place]).collect();
        let moving = variables.iter().filter(|&&place| self.rows[place] != Row::Line(0.0));
        if moving.count() > LARGEST_LINEAR || variables.len() > LARGEST_MATRIX {
            return Ok(None);
        }
        let number = |place: usize| variables.partition_point(|one| *one < place);
        let mut matrix = DMatrix::zeros(variables.len(), variables.len());
        for (row, column, coefficient) in entries {
            // Several inputs may read one coordinate.
            matrix[(number(row), number(column))] += coefficient;
        }
        let offset: Vec<f64> = variables.iter().map(|&place| offsets[place]).collect();
        let field = Arc::new(LinearField::new(&matrix, &offset)?);
        Ok(Some(LinearPart { variables, field }))
    }

    /// What the rates of the group are if all are linear: their constants, and the coefficients.
    fn entries(&self) -> Option<(Vec<f64>, Vec<Entry>)> {
        let (mut offsets, mut entries) = (self.rates_of_lines(), Vec::new());
        for (component, mode) in &self.moving {
            let ModeMotion::Rates(rates) = &mode.motion else { return None };
            for rate in rates {
                let (form, row) = (rate.form.as_ref()?, component.places[rate.coordinate]);
                offsets[row] = *form.constant();
                for (name, coefficient) in form.coefficients() {
                    let names = &component.blueprint.coordinates;
                    let column = component.places[names.iter().position(|one| *one == name)?];
                    if self.rows[column] == Row::Solved {
                        // It changes in a way that no matrix knows.
                        return None;
                    }
                    entries.push((row, column, *coefficient));
                }
            }
        }
        Some((offsets, entries))
    }

    /// The rates of what moves along lines, and 0 for others.
    fn rates_of_lines(&self) -> Vec<f64> {
        let rate = |row: &Row| if let Row::Line(rate) = row { *rate } else { 0.0 };
        self.rows.iter().map(rate).collect()
    }

    /// The rates of all variables at the start; 0 of what is solved by itself.
    pub(super) fn first_rates(&self) -> Vec<f64> {
        let mut rates = self.rates_of_lines();
        self.curve(0.0, &self.start, &mut rates);
        rates
    }

    /// Writes the rates of what curves. What is solved by itself is seen where it is at `time`.
    fn curve(&self, time: f64, state: &[f64], rates: &mut [f64]) {
        if let Some(tape) = self.whole {
            let mut tapes = self.places.borrow_mut();
            if tapes.is_empty() {
                tapes.push(tape.places());
            }
            return tape.evaluate(state, &mut tapes[0], rates);
        }
        if self.solved.is_empty() {
            return self.add_rates(state, rates);
        }
        let mut overlaid = std::mem::take(&mut self.scratch.borrow_mut()[2]);
        overlaid.clear();
        overlaid.extend_from_slice(state);
        self.overlay(time, &mut overlaid);
        self.add_rates(&overlaid, rates);
        self.scratch.borrow_mut()[2] = overlaid;
    }

    fn add_rates(&self, state: &[f64], rates: &mut [f64]) {
        let mut tapes = self.places.borrow_mut();
        tapes.resize(self.moving.len(), Vec::new());
        for (number, (component, mode)) in self.moving.iter().enumerate() {
            let places = &mut tapes[number];
            match &mode.motion {
                ModeMotion::Rates(_) if self.hold_of(number, state, rates) => {}
                ModeMotion::Rates(formulas) => {
                    if places.is_empty() {
                        *places = mode.rates.places();
                    }
                    if let Some(first) = component.window.filter(|_| mode.is_whole) {
                        let window = first..first + component.places.len();
                        mode.rates.evaluate(&state[window.clone()], places, &mut rates[window]);
                        continue;
                    }
                    let [own, change, _] = &mut *self.scratch.borrow_mut();
                    component.gather(state, &component.places, own);
                    change.resize(formulas.len(), 0.0);
                    mode.rates.evaluate(own, places, change);
                    for (rate, change) in formulas.iter().zip(change) {
                        rates[component.places[rate.coordinate]] = *change;
                    }
                }
                ModeMotion::Field(field) => {
                    let [own, change, _] = &mut *self.scratch.borrow_mut();
                    component.gather(state, &component.places, own);
                    change.resize(own.len(), 0.0);
                    field(own, change);
                    component.scatter(change, &component.places, rates);
                }
                ModeMotion::Exact(_) => {}
            }
        }
    }

    /// Writes the rates of a component on the sides of their kinks that are held, if any are.
    #[inline]
    fn hold_of(&self, number: usize, state: &[f64], rates: &mut [f64]) -> bool {
        self.hold.as_ref().is_some_and(|hold| hold.add_rates(number, state, rates))
    }

    /// The sides of kinks that have to be held, where these are not known beforehand.
    pub(super) fn hold(&self) -> Option<&Hold<'a>> {
        self.hold.as_deref()
    }

    /// Puts what is solved by itself where it is at `time`.
    pub(super) fn overlay(&self, time: f64, state: &mut [f64]) {
        for (component, advance) in &self.solved {
            let [own, ..] = &mut *self.scratch.borrow_mut();
            component.gather(&self.start, &component.places, own);
            advance(own, time);
            component.scatter(own, &component.places, state);
        }
    }

    /// Whether ranges alone show that no rate grows without bound on a piece of the solution.
    pub(super) fn bounds_rates(&self, piece: &Piece) -> bool {
        let [own, places, results] = &mut *self.ranges.borrow_mut();
        self.moving.iter().all(|(component, mode)| {
            let ModeMotion::Rates(rates) = &mode.motion else { return true };
            if rates.iter().all(|rate| rate.tracker.is_none()) {
                return true;
            }
            own.clear();
            own.extend(component.places.iter().map(|&place| piece.range(place)));
            mode.rates.ranges(own, places, results);
            let is_bounded =
                |range: &Interval| range.lower().is_finite() && range.upper().is_finite();
            rates
                .iter()
                .zip(results.iter())
                .all(|(rate, range)| rate.tracker.is_none() || is_bounded(range))
        })
    }

    /// Whether rates may act too briefly for an integrator to see, anywhere at all.
    pub(super) fn is_sharp(&self) -> bool {
        self.moving.iter().any(|(_, mode)| mode.rates.is_sharp())
    }

    /// Whether rates may vary by more than an integrator sees on a piece of the solution, by ranges alone.
    pub(super) fn is_strained(&self, piece: &Piece) -> bool {
        let [own, places, results] = &mut *self.ranges.borrow_mut();
        self.moving.iter().any(|(component, mode)| {
            own.clear();
            own.extend(component.places.iter().map(|&place| piece.range(place)));
            mode.rates.ranges(own, places, results);
            mode.rates.is_strained(places)
        })
    }

    /// How rates vary from one time of a piece to another.
    pub(super) fn strain(&self, piece: &Piece, span: [f64; 2], tolerances: Tolerances) -> Strain {
        let [own, places, results] = &mut *self.ranges.borrow_mut();
        let mut enclosures = Vec::new();
        piece.enclose(span[0], span[1], &mut enclosures);
        let mut strain = Strain { is_strained: false, shift: 0.0 };
        for (component, mode) in &self.moving {
            let ModeMotion::Rates(rates) = &mode.motion else { continue };
            own.clear();
            own.extend(component.places.iter().map(|&place| enclosures[place].range));
            mode.rates.ranges(own, places, results);
            strain.is_strained |= mode.rates.is_strained(places);
            for (rate, range) in rates.iter().zip(results.iter()) {
                let variable = enclosures[component.places[rate.coordinate]].range.abs();
                let allowed = tolerances.absolute() + tolerances.relative() * variable.upper();
                let shift = range.width() * (span[1] - span[0]) / allowed;
                strain.shift = strain.shift.max(shift);
            }
        }
        strain
    }

    /// The first instant after `settled` at which a rate is known to have a kink or a jump, unless kinks of its
    /// component are searched for.
    pub(super) fn next_kink(&self, settled: f64) -> Option<f64> {
        let is_searched =
            |number: usize| self.hold.as_ref().is_some_and(|hold| hold.searches(number));
        let known = self.moving.iter().enumerate().filter(|&(number, _)| !is_searched(number));
        let kinks = known.flat_map(|(_, (component, mode))| {
            let motion =
                |coordinate: usize| self.line(component.places[coordinate]).map(Line::rounded);
            let kinks = mode.formulas().iter().flat_map(|rate| &rate.kinks);
            kinks.filter_map(move |kinks| kinks.next(settled, &motion))
        });
        kinks.reduce(f64::min)
    }

    /// Holds the sides of kinks that hold at a time, in the state there: the first formula that is on another side
    /// than before.
    pub(super) fn choose_sides(&self, time: f64, state: &[f64]) -> Option<&'a Expression> {
        self.hold.as_ref()?.choose(time, state, &|place| self.line(place).map(Line::rounded))
    }

    /// How a variable moves, if it moves along a line.
    pub(super) fn line(&self, place: usize) -> Option<Line> {
        let Row::Line(rate) = *self.rows.get(place)? else { return None };
        Some(Line { start: self.exact_start[place], rate })
    }

    /// The variables that move along lines, by their place, without those that rest.
    pub(super) fn lines(&self) -> Vec<(usize, Line)> {
        let moves = |row: &Row| !matches!(row, Row::Line(0.0) | Row::Curved | Row::Solved);
        let places = (0..self.rows.len()).filter(|&place| moves(&self.rows[place]));
        places.filter_map(|place| Some((place, self.line(place)?))).collect()
    }

    /// Rates that could grow without bound, with where their variables are.
    pub(super) fn unbounded_rates(&self) -> impl Iterator<Item = (&'a Component, &'a RateProgram)> {
        self.formulas().filter(|(_, rate)| rate.tracker.is_some())
    }

    /// The rates that are formulas, with where their variables are.
    pub(super) fn formulas(&self) -> impl Iterator<Item = (&'a Component, &'a RateProgram)> {
        let of_each = |&(component, mode): &(&'a Component, &'a Mode)| {
            mode.formulas().iter().map(move |rate| (component, rate))
        };
        self.moving.iter().flat_map(of_each)
    }
}

impl VectorField for Field<'_> {
    /// The rates of the variables that are integrated.
    fn rates(&self, time: f64, state: &[f64], rates: &mut [f64]) {
        let integrated = self.integrated();
        if integrated.len() == self.rows.len() {
            let lines = if self.whole.is_some() { &[] } else { &self.rows[..] };
            for (rate, row) in rates.iter_mut().zip(lines) {
                if let Row::Line(line) = row {
                    *rate = *line;
                }
            }
            return self.curve(time, state, rates);
        }
        let [all, changes] = &mut *self.completed.borrow_mut();
        if all.is_empty() {
            all.clone_from(&self.start);
            *changes = self.rates_of_lines();
        }
        integrated.iter().zip(state).for_each(|(&place, value)| all[place] = *value);
        self.curve(time, all, changes);
        rates.iter_mut().zip(integrated).for_each(|(rate, &place)| *rate = changes[place]);
    }
}

impl RateProgram {
    fn row(&self) -> Row {
        match &self.form {
            Some(form) if form.coefficients().next().is_none() => Row::Line(*form.constant()),
            _ => Row::Curved,
        }
    }
}

impl Component {
    /// Where the coordinates are that belong to it, among those of its group.
    fn owned_places(&self) -> impl Iterator<Item = usize> {
        let places = self.places.iter().zip(&self.owned);
        places.filter(|(_, owned)| **owned).map(|(place, _)| *place)
    }
}

impl Composition {
    /// The name of what changes while time passes, if anything does: a variable that has a rate,
    /// or a component that solves its flow itself.
    pub(super) fn mover(&self, locations: &[usize], values: &[f64]) -> Option<String> {
        self.groups.iter().find_map(|group| {
            let start = group.slots.iter().map(|&slot| values[slot].into()).collect();
            let field = Field::of(self, group, locations, start);
            let moving = field.first_rates().iter().position(|rate| *rate != 0.0);
            let variable = moving.map(|place| self.variables[group.slots[place]].clone());
            variable.or_else(|| field.solved.first().map(|(component, _)| component.name.clone()))
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use pleach_discrete::vocabulary;
    use pleach_guards::{Expression, Predicate, constant, never, variable};

    use super::*;
    use crate::{Automaton, Coordinate, Flow, Name, Record, coordinates, from};

    vocabulary! {
        enum Only: Location { Flowing = "flowing" }
        enum Nothing: Event { Never = "never" }
    }
    coordinates! {
        struct Plane { x, y }
    }
    use Only::Flowing;

    /// x and y at these rates.
    pub(in crate::composition) fn plane(rates: [Expression; 2]) -> Composition {
        guarded(rates, &never())
    }

    /// x and y at these rates, up to where a guard holds.
    pub(in crate::composition) fn guarded(
        rates: [Expression; 2],
        guard: &Predicate,
    ) -> Composition {
        let Plane { x, y } = Plane::coordinates();
        let [right, up] = rates;
        let automaton = Automaton::<Only, Nothing, Plane>::starting_in(Flowing)
            .initially(Plane { x: 0.0, y: 0.0 })
            .flow(Flowing, [x.rate(right), y.rate(up)])
            .transition(from(Flowing).on(Nothing::Never).to(Flowing).must(guard.clone()))
            .build()
            .expect("it is sound");
        Composition::builder().add("plane", &automaton).build().expect("it is sound")
    }

    /// x = t and y = `size` sin(`frequency` t), by a function.
    pub(in crate::composition) fn wave(frequency: f64, size: f64) -> Composition {
        let flow = Flow::exact("a wave", move |plane: &mut Plane, time| {
            plane.x += time;
            plane.y = size * (frequency * plane.x).sin();
        });
        let automaton = Automaton::<Only, Nothing, Plane>::starting_in(Flowing)
            .initially(Plane { x: 0.0, y: 0.0 })
            .flow(Flowing, flow)
            .build()
            .expect("it is sound");
        Composition::builder().add("plane", &automaton).build().expect("it is sound")
    }

    /// Its flow from a state on.
    pub(in crate::composition) fn field(plane: &Composition, start: [f64; 2]) -> Field<'_> {
        Field::of(plane, &plane.groups[0], &[0], start.map(Moment::from).to_vec())
    }

    /// x and y as polynomials in time, without errors.
    pub(in crate::composition) fn piece(end: f64, rows: [&[f64]; 2]) -> Piece {
        let mut piece = Piece::new(0.0, end, 0.0, 1.0);
        rows.iter().for_each(|row| piece.push(row.iter().copied(), 0.0));
        piece
    }

    /// x = 2 + 4 t and y = −1 − 8 t: from 0.5 to 0.75 x is between 4 and 5, and y between −7 and −5.
    #[test]
    fn strain_moves_variables_by_what_rates_vary_in_units_of_the_tolerance() {
        let [x, y] = ["x", "y"].map(variable);
        let tolerances = Tolerances::new(0.5, 0.25).expect("they make sense");
        let piece = piece(2.0, [&[2.0, 4.0], &[-1.0, -8.0]]);
        let strain = |rates: [Expression; 2]| {
            let plane = plane(rates);
            field(&plane, [2.0, -1.0]).strain(&piece, [0.5, 0.75], tolerances)
        };
        let still = || constant(3.0);
        for (rates, shift) in [
            ([3.0 * &y, still()], 6.0 * 0.25 / (0.25 + 0.5 * 5.0)),
            ([still(), 3.0 * &x], 3.0 * 0.25 / (0.25 + 0.5 * 7.0)),
            ([&x * &x, 3.0 * &x], 9.0 * 0.25 / (0.25 + 0.5 * 5.0)),
            ([still(), still()], 0.0),
        ] {
            let found = strain(rates);
            assert!((found.shift - shift).abs() < 1e-9, "{found:?} is not {shift}");
            assert!(!found.is_strained);
        }
        assert!(strain([(1000.0 * &x).exp(), still()]).is_strained);
        assert!(strain([still(), (1000.0 * &x).exp()]).is_strained);
    }

    /// Only rates that could grow without bound are looked at, and from both sides.
    #[test]
    fn ranges_bound_rates_that_could_have_none() {
        let [x, y] = ["x", "y"].map(variable);
        // x from 0 to 1, y from 1 to 2001.
        let piece = piece(1.0, [&[0.0, 1.0], &[1.0, 2000.0]]);
        let is_bounded = |rates: [Expression; 2]| {
            let plane = plane(rates);
            field(&plane, [0.0, 1.0]).bounds_rates(&piece)
        };
        assert!(is_bounded([y.ln(), y.power(-2.0)]));
        assert!(is_bounded([y.ln(), y.exp()]), "an exponential is bounded where its exponent is");
        assert!(is_bounded([y.exp(), &x * &y]));
        assert!(!is_bounded([x.ln(), constant(0.0)]), "it comes from below every number");
        assert!(!is_bounded([y.ln(), -x.ln()]), "it comes from above every number");
        assert!(!is_bounded([1.0 / &x, y.exp()]));
    }

    /// x₁ to xₘ decay towards the sum of others, of which some move along lines.
    fn linear_part(decaying: usize, moving: usize, resting: usize) -> Option<usize> {
        let all: Vec<String> =
            (0..decaying + moving + resting).map(|number| format!("x{number}")).collect();
        let (own, others) = all.split_at(decaying);
        let sum =
            || others.iter().map(|name| variable(name)).fold(constant(0.0), |sum, one| sum + one);
        let state = Record::new(all.iter().map(|name| (name, 1.0))).expect("the names differ");
        let coordinate = |name: &String| Coordinate::<Record>::new(crate::named::kept(name));
        let mut rates: Vec<_> =
            own.iter().map(|name| coordinate(name).rate(sum() - variable(name))).collect();
        rates.extend(others[..moving].iter().map(|name| coordinate(name).rate(2.0)));
        let only = Name::new("only");
        let automaton = Automaton::<Name, Name, Record>::starting_in(only)
            .initially(state)
            .flow(only, rates)
            .build()
            .expect("it is sound");
        let composition = Composition::builder().add("decays", &automaton).build();
        let composition = composition.expect("it is sound");
        let start = composition.initial.iter().copied().map(Moment::from).collect();
        let field = Field::of(&composition, &composition.groups[0], &[0], start);
        let part = field.linear().expect("its numbers are finite");
        part.map(|part| part.variables.len())
    }

    #[test]
    fn few_variables_that_move_and_not_too_many_others_make_a_matrix() {
        assert_eq!(linear_part(3, 2, 1), Some(6));
        assert_eq!(linear_part(LARGEST_LINEAR, 0, 0), Some(LARGEST_LINEAR));
        assert_eq!(linear_part(LARGEST_LINEAR + 1, 0, 0), None);
        assert_eq!(linear_part(LARGEST_LINEAR + 2, 0, 0), None);
        assert_eq!(linear_part(LARGEST_LINEAR - 2, 2, 3), Some(LARGEST_LINEAR + 3));
        assert_eq!(linear_part(LARGEST_LINEAR - 2, 3, 0), None);
        assert_eq!(linear_part(1, 0, LARGEST_MATRIX - 1), Some(LARGEST_MATRIX));
        assert_eq!(linear_part(1, 0, LARGEST_MATRIX), None);
        assert_eq!(linear_part(2, 0, LARGEST_MATRIX), None);
    }

    #[test]
    fn what_moves_is_the_variable_whose_rate_is_not_zero() {
        let moves = plane([constant(0.0), variable("x") + 1.0]);
        assert_eq!(moves.mover(&[0], &[0.0, 0.0]), Some("y".to_owned()));
        assert_eq!(moves.mover(&[0], &[-1.0, 0.0]), None);
    }
}
