//! An automaton without its types: what a composition of different automata runs.

use std::fmt;
use std::sync::Arc;

use pleach_discrete::{Event, Location, Urgency, first_mentions};
use pleach_guards::{
    BinaryOperator, CompiledPredicate, EvaluationError, Expression, LinearForm, Predicate, Program,
    Sides, Substitution, Tape, Tracker, UnaryOperator, Verdict,
};

use super::kinks::Kinks;
use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::diagram::sketch::Sketch;
use crate::flow::{self, Flow, Rate};
use crate::named::kept;
use crate::outline::{Motion, Outline, Transition};
use crate::reset::{Assignment, NewValue, Reset};
use crate::signals::Signal;

/// Locations and events are numbers here, in the order of `ALL`, and formulas are compiled against
/// the coordinates of the automaton's own state.
pub(crate) struct Blueprint {
    pub(crate) modes: Vec<Mode>,
    pub(crate) events: Vec<&'static str>,
    pub(crate) coordinates: Vec<&'static str>,
    pub(crate) initial: usize,
    /// The coordinates of which no other component may say how they move.
    pub(crate) own: Vec<&'static str>,
    /// For pictures.
    pub(crate) sketch: Sketch,
}

/// A location.
pub(crate) struct Mode {
    pub(crate) name: &'static str,
    pub(crate) motion: ModeMotion,
    /// The rates that are formulas, all together and in their order.
    pub(crate) rates: Tape,
    /// The same as smooth formulas, if some have kinks.
    pub(crate) sides: Option<Sides>,
    /// Whether they are those of all coordinates, in the order of these.
    pub(crate) is_whole: bool,
    pub(crate) invariant: Option<Condition>,
    /// In their total order.
    pub(crate) leaving: Vec<Leaving>,
}

/// A transition.
pub(crate) struct Leaving {
    pub(crate) event: usize,
    pub(crate) target: usize,
    pub(crate) urgency: Urgency,
    pub(crate) guard: Condition,
    pub(crate) change: Change,
}

/// A flow.
pub(crate) enum ModeMotion {
    Rates(Vec<RateProgram>),
    Field(Arc<FieldFunction>),
    Exact(Arc<Solution>),
}

/// A predicate ready to be evaluated in a state, and to be followed over time.
pub(crate) struct Condition {
    predicate: CompiledPredicate,
    pub(crate) tracker: Tracker,
}

/// The rate of a coordinate.
pub(crate) struct RateProgram {
    pub(crate) coordinate: usize,
    /// Where it is one.
    pub(crate) form: Option<LinearForm>,
    /// Follows the rate, where it could grow without bound.
    pub(crate) tracker: Option<Tracker>,
    /// Follow what its roots are taken of: where that is negative, it has no value.
    pub(super) radicands: Box<[Tracker]>,
    /// Where it has kinks or jumps.
    pub(super) kinks: Box<[Kinks]>,
}

/// A reset.
pub(crate) enum Change {
    Assignments(Vec<(usize, Assigned)>),
    Function(Arc<ResetFunction>),
}

/// What a coordinate becomes.
pub(crate) enum Assigned {
    Value(Program),
    /// Any number between these.
    Interval([Program; 2]),
}

/// From the coordinates to their rates.
pub(crate) type FieldFunction = dyn Fn(&[f64], &mut [f64]) + Send + Sync;
/// Carries the coordinates over a duration in seconds.
pub(crate) type Solution = dyn Fn(&mut [f64], f64) + Send + Sync;
/// Turns x⁻ into x⁺.
pub(crate) type ResetFunction = dyn Fn(&mut [f64]) -> Result<(), EvaluationError> + Send + Sync;

/// What of an automaton is functions, on slices of its coordinates.
struct Functions {
    /// By location.
    flows: Vec<Option<ModeMotion>>,
    /// By transition.
    resets: Vec<Option<Change>>,
}

/// The formulas that a component reads in the place of some of its coordinates, by their names.
pub(crate) type Wiring = [Signal];

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// The variables of the wiring become coordinates, after those that it does not replace.
    ///
    /// # Errors
    ///
    /// The first variable that is none of the coordinates; [`Builder::build`](crate::Builder::build)
    /// refuses them for automata that begin with their coordinates.
    pub(crate) fn blueprint(&self, wiring: &Wiring) -> Result<Blueprint, EvaluationError> {
        let shape = self.initial_state();
        let mut functions = Functions { flows: Vec::new(), resets: Vec::new() };
        for mode in &self.modes {
            functions.flows.push(mode.flow.as_ref().and_then(|flow| motion(flow, shape)));
        }
        for transition in self.graph.edge_weights() {
            functions.resets.push(change(&transition.reset, shape));
        }
        let is_replaced = |name: &str| wiring.iter().any(|(replaced, _)| replaced == name);
        let own = self.names().iter().copied().filter(|name| !is_replaced(name));
        let read = wiring.iter().flat_map(|(_, formula)| formula.variables());
        Blueprint::of(
            &self.outline(),
            &first_mentions(own.chain(read.map(kept))),
            wiring,
            functions,
        )
    }
}

impl Blueprint {
    fn of(
        automaton: &Outline<'_>,
        names: &[&'static str],
        wiring: &Wiring,
        mut functions: Functions,
    ) -> Result<Blueprint, EvaluationError> {
        let formulas = automaton.formulas(wiring);
        let compiler = Compiler { names, formulas };
        let mut modes = Vec::with_capacity(automaton.modes.len());
        for (mode, function) in automaton.modes.iter().zip(&mut functions.flows) {
            let mut leaving = Vec::with_capacity(mode.leaving.len());
            for edge in mode.leaving {
                let transition = &automaton.transitions[edge.index()];
                let function = functions.resets[edge.index()].take();
                leaving.push(compiler.leaving(transition, function)?);
            }
            let rates = compiler.rates(mode.flow.and_then(Motion::rates).unwrap_or_default())?;
            let formulas = || rates.iter().map(|(_, rate)| rate);
            let motion = match function.take() {
                Some(function) => function,
                None => {
                    let program = |(place, rate): &_| RateProgram::of(*place, rate, names);
                    ModeMotion::Rates(rates.iter().map(program).collect::<Result<_, _>>()?)
                }
            };
            modes.push(Mode {
                name: mode.name,
                rates: Tape::compile(formulas(), names)?,
                sides: Sides::compile(formulas(), names)?,
                is_whole: motion.is_whole(names.len()),
                motion,
                invariant: mode.invariant.map(|it| compiler.condition(it)).transpose()?,
                leaving,
            });
        }
        Ok(Blueprint {
            modes,
            events: automaton.events.clone(),
            coordinates: names.to_vec(),
            initial: automaton.initial,
            own: automaton.own.to_vec(),
            sketch: Sketch::of(automaton),
        })
    }
}

/// Compiles formulas over coordinates, with numbers in the place of parameters.
struct Compiler<'a> {
    names: &'a [&'static str],
    /// What stands for parameters and for coordinates that are wired.
    formulas: Option<Substitution>,
}

impl Compiler<'_> {
    fn leaving(
        &self,
        transition: &Transition<'_>,
        function: Option<Change>,
    ) -> Result<Leaving, EvaluationError> {
        let assignments = transition.effect.assignments().unwrap_or_default();
        let change = match function {
            Some(function) => function,
            None => {
                let assigned = assignments.iter().map(|one| self.assigned(one));
                Change::Assignments(assigned.collect::<Result<_, _>>()?)
            }
        };
        Ok(Leaving {
            event: transition.event,
            target: transition.target,
            urgency: transition.urgency,
            guard: self.condition(transition.guard.predicate())?,
            change,
        })
    }

    fn condition(&self, predicate: &Predicate) -> Result<Condition, EvaluationError> {
        Condition::of(&self.resolved(predicate, Predicate::substitute), self.names)
    }

    fn resolved<T: Clone>(&self, formula: &T, substitute: fn(&T, &Substitution) -> T) -> T {
        match &self.formulas {
            Some(formulas) => substitute(formula, formulas),
            None => formula.clone(),
        }
    }

    /// The coordinates by their places, with their rates.
    fn rates(&self, rates: &[Rate]) -> Result<Vec<(usize, Expression)>, EvaluationError> {
        let rate = |one: &Rate| {
            Ok((
                self.place_of(one.coordinate())?,
                self.resolved(one.rate(), Expression::substitute),
            ))
        };
        rates.iter().map(rate).collect()
    }

    fn assigned(&self, assignment: &Assignment) -> Result<(usize, Assigned), EvaluationError> {
        let assigned = match self.resolved(assignment.value(), NewValue::substitute) {
            NewValue::Exactly(value) => Assigned::Value(value.compile(self.names)?),
            NewValue::Within(lower, upper) => {
                Assigned::Interval([lower.compile(self.names)?, upper.compile(self.names)?])
            }
        };
        Ok((self.place_of(assignment.coordinate())?, assigned))
    }

    fn place_of(&self, name: &str) -> Result<usize, EvaluationError> {
        let unknown = || EvaluationError::UnknownVariable { variable: name.to_owned() };
        self.names.iter().position(|listed| *listed == name).ok_or_else(unknown)
    }
}

impl Mode {
    /// Its rates, if they are formulas.
    pub(super) fn formulas(&self) -> &[RateProgram] {
        match &self.motion {
            ModeMotion::Rates(rates) => rates,
            ModeMotion::Field(_) | ModeMotion::Exact(_) => &[],
        }
    }
}

impl ModeMotion {
    /// Whether it gives the rates of this many coordinates in their order.
    fn is_whole(&self, coordinates: usize) -> bool {
        let ModeMotion::Rates(rates) = self else { return false };
        let places = rates.iter().map(|rate| rate.coordinate);
        rates.len() == coordinates && places.eq(0..coordinates)
    }
}

impl Condition {
    fn of(predicate: &Predicate, names: &[&str]) -> Result<Condition, EvaluationError> {
        Ok(Condition { predicate: predicate.compile(names)?, tracker: predicate.track(names)? })
    }

    pub(crate) fn predicate(&self) -> &Predicate {
        self.predicate.predicate()
    }

    pub(crate) fn evaluate_at(
        &self,
        values: &[f64],
        slots: &[usize],
    ) -> Result<Verdict, EvaluationError> {
        self.predicate.evaluate_at(values, slots)
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.predicate.fmt(formatter)
    }
}

impl RateProgram {
    fn of(
        coordinate: usize,
        rate: &Expression,
        names: &[&str],
    ) -> Result<RateProgram, EvaluationError> {
        let form = rate.linear_form();
        let tracker =
            may_be_unbounded(rate).then(|| rate.at_least(0.0).track(names)).transpose()?;
        let radicands = radicands(rate).into_iter();
        let radicands = radicands.map(|radicand| radicand.at_least(0.0).track(names));
        let radicands = radicands.collect::<Result<_, _>>()?;
        Ok(RateProgram { coordinate, form, tracker, radicands, kinks: Kinks::of(rate, names)? })
    }
}

/// What a formula takes roots and other broken powers of, whatever its cases: none within a case.
fn radicands(formula: &Expression) -> Vec<&Expression> {
    let (mut found, mut parts) = (Vec::new(), vec![formula]);
    while let Some(part) = parts.pop() {
        match part {
            Expression::Power(base, exponent) => {
                parts.push(base);
                found.extend((exponent.fract() != 0.0).then_some(&**base));
            }
            Expression::Unary(_, operand) | Expression::Lookup(_, operand) => parts.push(operand),
            Expression::Binary(_, left, right) => parts.extend([&**left, &**right]),
            Expression::Choice(choice) => {
                parts.extend([&choice.condition.left, &choice.condition.right]);
            }
            _ => {}
        }
    }
    found
}

/// Whether the expression may grow without bound where its variables do not.
fn may_be_unbounded(expression: &Expression) -> bool {
    let mut parts = vec![expression];
    while let Some(part) = parts.pop() {
        match part {
            Expression::Constant(_) | Expression::Variable(_) => {}
            Expression::Unary(UnaryOperator::Logarithm | UnaryOperator::Tangent, _) => return true,
            Expression::Unary(_, operand) => parts.push(operand),
            Expression::Power(base, exponent) if *exponent >= 0.0 => parts.push(base),
            Expression::Binary(BinaryOperator::Quotient, dividend, divisor) => match &**divisor {
                Expression::Constant(value) if *value != 0.0 => parts.push(dividend),
                _ => return true,
            },
            Expression::Binary(_, left, right) => parts.extend([&**left, &**right]),
            Expression::Choice(choice) => parts.extend([&choice.then, &choice.otherwise]),
            Expression::Lookup(..) => {}
            _ => return true,
        }
    }
    false
}

/// A state of the automaton with these coordinates.
fn state_of<S: Coordinates>(shape: Option<&S>, values: &[f64]) -> S {
    shape.map_or_else(|| S::from_values(values), |shape| shape.like(values))
}

/// A flow that is a function.
fn motion<S: Coordinates>(flow: &Flow<S>, shape: Option<&S>) -> Option<ModeMotion> {
    let shape = shape.cloned();
    match flow.motion() {
        flow::Motion::Rates(_) => None,
        flow::Motion::Field(_, field) => {
            let field = field.clone();
            Some(ModeMotion::Field(Arc::new(move |values: &[f64], rates: &mut [f64]| {
                field(&state_of(shape.as_ref(), values)).write(rates);
            })))
        }
        flow::Motion::Exact(_, advance) => {
            let advance = advance.clone();
            Some(ModeMotion::Exact(Arc::new(move |values: &mut [f64], duration: f64| {
                let mut state = state_of(shape.as_ref(), values);
                advance(&mut state, duration);
                state.write(values);
            })))
        }
    }
}

/// A reset that is a function.
fn change<S: Coordinates>(reset: &Reset<S>, shape: Option<&S>) -> Option<Change> {
    if reset.assignments().is_some() {
        return None;
    }
    let (reset, shape) = (reset.clone(), shape.cloned());
    Some(Change::Function(Arc::new(move |values: &mut [f64]| {
        let mut state = state_of(shape.as_ref(), values);
        reset.apply(&mut state)?;
        state.write(values);
        Ok(())
    })))
}

#[cfg(test)]
mod tests {
    use pleach_guards::{Table, constant, piecewise, variable};

    use super::*;

    /// A root is one wherever it stands, but for the cases of a formula: which of them counts is another matter.
    #[test]
    fn roots_are_found_in_all_parts_of_a_formula() {
        let [x, y] = ["x", "y"].map(variable);
        let table = Table::linear([(0.0, 1.0), (1.0, 2.0)]).expect("its points are in order");
        for root in [x.power(0.5), x.square_root(), x.power(-1.5)] {
            let around = [
                root.clone(),
                root.sin(),
                -&root,
                root.power(3.0),
                table.at(root.clone()),
                &y - &root,
                &root / &y,
                root.min(&y),
                piecewise([(root.at_most(2.0), y.clone())], &y).expect("there is a comparison"),
                piecewise([(y.at_most(root.clone()), y.clone())], &y).expect("it is another"),
            ];
            for formula in &around {
                assert_eq!(radicands(formula), [&x], "{formula}");
            }
        }
        let nested = (x.square_root() - &y).square_root();
        assert_eq!(radicands(&nested).len(), 2);
        let case = piecewise([(y.at_most(2.0), x.square_root())], &y).expect("a comparison");
        for formula in [x.power(2.0), x.power(-1.0), x.sin() / &y, table.at(&x), case] {
            assert!(radicands(&formula).is_empty(), "{formula}");
        }
    }

    #[test]
    fn what_may_grow_without_bound_are_logarithms_tangents_and_quotients() {
        let [x, y] = ["x", "y"].map(variable);
        let table = Table::linear([(0.0, 1.0), (1.0, 2.0)]).expect("its points are in order");
        let cases = |then: Expression, otherwise: &Expression| {
            piecewise([(x.at_most(0.0), then)], otherwise).expect("there is a comparison")
        };
        let bounded = [
            constant(1.0),
            x.sin() * y.exp() - x.min(&y),
            x.power(2.0) + x.power(0.5) + x.power(0.0),
            &x / 2.0,
            table.at(1.0 / &x),
            cases(y.power(3.0), &x),
        ];
        let unbounded = [x.ln(), x.tan(), 1.0 / &x, &x / 0.0, x.power(-1.0)];
        assert!(!bounded.iter().any(may_be_unbounded));
        for formula in &unbounded {
            let around = [
                formula.clone(),
                formula.sin(),
                formula.power(2.0),
                formula / 2.0,
                &x + formula,
                formula * &x,
                cases(formula.clone(), &x),
                cases(x.clone(), formula),
            ];
            assert!(around.iter().all(may_be_unbounded), "{formula}");
        }
    }
}
