//! Models from data: automata whose locations, events and coordinates Python names, and
//! compositions of them.

use crate::ModelError;
use crate::data::{self, entries};
use crate::trajectory::Trajectory;
use pleach_library::automaton::check::Report;
use pleach_library::automaton::{
    self as models, Builder, Coordinate, Name, Record, Settings, diagram, from,
};
use pleach_library::guards::{Expression, ParseError, Predicate};
use pleach_library::page::Drawing;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use serde_json::Value;
use std::fmt::Display;
use std::mem;

type Model = models::Automaton<Name, Name, Record>;

/// A hybrid automaton that is put together part by part.
#[pyclass(module = "pleach")]
pub struct Automaton {
    initial: Name,
    state: Record,
    builder: Builder<Name, Name, Record>,
}

#[pymethods]
impl Automaton {
    #[new]
    #[pyo3(signature = (initial, state, *, parameters = None))]
    fn new(
        initial: &str,
        state: &Bound<'_, PyMapping>,
        parameters: Option<&Bound<'_, PyMapping>>,
    ) -> PyResult<Self> {
        let initial = Name::new(initial);
        let state = Record::new(numbers(state)?).map_err(refused)?;
        let builder = Model::starting_in(initial).initially(state.clone());
        let parameters = parameters.map(numbers).transpose()?.unwrap_or_default();
        let builder = (parameters.iter())
            .fold(builder, |builder, (name, value)| builder.parameter(name, *value));
        Ok(Self { initial, state, builder })
    }

    /// Say how coordinates change in a location; others rest.
    fn flow<'py>(
        mut slf: PyRefMut<'py, Self>,
        location: &str,
        rates: &Bound<'py, PyMapping>,
    ) -> PyResult<PyRefMut<'py, Self>> {
        let rates: Vec<_> = slf.formulas(rates, |coordinate, rate| coordinate.rate(rate))?;
        slf.change(|builder| builder.flow(Name::new(location), rates));
        Ok(slf)
    }

    /// Say while what time may pass in a location.
    fn invariant<'py>(
        mut slf: PyRefMut<'py, Self>,
        location: &str,
        predicate: &str,
    ) -> PyResult<PyRefMut<'py, Self>> {
        let predicate = read_predicate(predicate)?;
        slf.change(|builder| builder.invariant(Name::new(location), predicate));
        Ok(slf)
    }

    /// Add a transition with one guard: `must`, `may` or `at_once`.
    #[pyo3(signature = (
        source, event, target, *,
        must = None, may = None, at_once = None, then = None, priority = 0
    ))]
    #[allow(clippy::too_many_arguments)] // Python gives them by name
    fn transition<'py>(
        mut slf: PyRefMut<'py, Self>,
        source: &str,
        event: &str,
        target: &str,
        must: Option<&str>,
        may: Option<&str>,
        at_once: Option<&str>,
        then: Option<&Bound<'py, PyMapping>>,
        priority: u8,
    ) -> PyResult<PyRefMut<'py, Self>> {
        let arrow = from(Name::new(source)).on(Name::new(event)).to(Name::new(target));
        let edge = match (must, may, at_once) {
            (Some(guard), None, None) => arrow.must(read_predicate(guard)?),
            (None, Some(guard), None) => arrow.may(read_predicate(guard)?),
            (None, None, Some(guard)) => arrow.at_once(read_predicate(guard)?),
            _ => {
                let wanted = "give it exactly one guard: must, may or at_once";
                return Err(refused(format!("the transition on {event:?}: {wanted}")));
            }
        };
        let then =
            then.map(|then| slf.formulas(then, |coordinate, value| coordinate.becomes(value)));
        let edge = match then.transpose()? {
            Some(assignments) => edge.then(assignments),
            None => edge,
        };
        slf.change(|builder| builder.transition(edge.priority(priority)));
        Ok(slf)
    }

    /// What is wrong with the model or could be, the worst first.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let model = self.build()?;
        Ok(told(&py.detach(|| model.check())))
    }

    /// The drawing as `mermaid`, `dot` or `svg`.
    #[pyo3(signature = (format = "mermaid"))]
    fn diagram(&self, format: &str) -> PyResult<String> {
        let model = self.build()?;
        match format {
            "mermaid" => Ok(diagram::mermaid(&model)),
            "dot" => Ok(diagram::dot(&model)),
            "svg" => Ok(diagram::svg(&model)),
            other => {
                let message = format!("no format is called {other:?}: mermaid, dot or svg");
                Err(refused(message))
            }
        }
    }

    /// Run the automaton by itself.
    #[pyo3(signature = (horizon, **settings))]
    fn run(
        &self,
        py: Python<'_>,
        horizon: f64,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Trajectory> {
        let (model, settings) = (self.build()?, read_settings(settings)?);
        let run = py.detach(|| model.run_with(settings, horizon)).map_err(refused)?;
        Ok(Trajectory::new(run, vec![Drawing::of(&model)]))
    }
}

impl Automaton {
    fn build(&self) -> PyResult<Model> {
        self.builder.clone().build().map_err(refused)
    }

    /// Adds a part. It has been read, so that nothing fails while the builder is out of its place.
    fn change(
        &mut self,
        step: impl FnOnce(Builder<Name, Name, Record>) -> Builder<Name, Name, Record>,
    ) {
        let before = mem::replace(&mut self.builder, Model::starting_in(self.initial));
        self.builder = step(before);
    }

    /// A formula for each coordinate that is named.
    fn formulas<T>(
        &self,
        formulas: &Bound<'_, PyMapping>,
        made: impl Fn(&Coordinate<Record>, Expression) -> T,
    ) -> PyResult<Vec<T>> {
        let formula = |(name, formula): (String, Bound<'_, PyAny>)| {
            let coordinate = self.state.coordinate(&name);
            let coordinate = coordinate
                .ok_or_else(|| refused(format!("the state has no coordinate called {name:?}")))?;
            let formula = read_formula(&formula);
            let formula = formula.map_err(|error| refused(format!("{name}: {error}")))?;
            Ok(made(&coordinate, formula))
        };
        entries(formulas)?.into_iter().map(formula).collect()
    }
}

/// Automata side by side.
#[pyclass(frozen, module = "pleach")]
pub struct Composition {
    composition: models::Composition,
    drawings: Vec<Drawing>,
}

#[pymethods]
impl Composition {
    #[new]
    #[pyo3(signature = (components, *, connect = None, labels = Vec::new()))]
    fn new(
        components: &Bound<'_, PyMapping>,
        connect: Option<&Bound<'_, PyMapping>>,
        labels: Vec<String>,
    ) -> PyResult<Self> {
        let mut builder = models::Composition::builder();
        let mut drawings: Vec<Drawing> = Vec::new();
        for (name, component) in entries(components)? {
            let model = component.cast::<Automaton>()?.borrow().build()?;
            builder = builder.add(&name, &model);
            let drawing = Drawing::of(&model);
            if !drawings.contains(&drawing) {
                drawings.push(drawing);
            }
        }
        for (input, output) in connect.map(entries).transpose()?.unwrap_or_default() {
            builder = builder.connect(&output.extract::<String>()?, &input);
        }
        builder = labels.iter().fold(builder, |builder, label| builder.label(label));
        Ok(Self { composition: builder.build().map_err(refused)?, drawings })
    }

    /// What is wrong with the model or could be, the worst first.
    fn check(&self, py: Python<'_>) -> Vec<String> {
        told(&py.detach(|| self.composition.check()))
    }

    /// Run the composition.
    #[pyo3(signature = (horizon, **settings))]
    fn run(
        &self,
        py: Python<'_>,
        horizon: f64,
        settings: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Trajectory> {
        let settings = read_settings(settings)?;
        let run = py.detach(|| self.composition.run_with(settings, horizon)).map_err(refused)?;
        Ok(Trajectory::new(run, self.drawings.clone()))
    }
}

fn told(report: &Report) -> Vec<String> {
    report.findings().iter().map(|finding| finding.to_string()).collect()
}

fn numbers(mapping: &Bound<'_, PyMapping>) -> PyResult<Vec<(String, f64)>> {
    entries(mapping)?.into_iter().map(|(name, value)| Ok((name, value.extract()?))).collect()
}

fn read_predicate(text: &str) -> PyResult<Predicate> {
    text.parse().map_err(|error| refused(format!("{text:?}: {error}")))
}

/// A text is a formula, and a number is a constant.
fn read_formula(formula: &Bound<'_, PyAny>) -> Result<Expression, String> {
    if let Ok(text) = formula.extract::<String>() {
        return text.parse().map_err(|error: ParseError| error.to_string());
    }
    let number = formula.extract::<f64>().map_err(|_| {
        format!("{formula:?} is neither a formula nor a number: write one, as \"-0.8 * v\" or 0.5")
    });
    number.map(Expression::from)
}

/// The settings that are named, the others at their defaults.
fn read_settings(given: Option<&Bound<'_, PyDict>>) -> PyResult<Settings> {
    let mut settings = Settings::default();
    for (name, value) in given.into_iter().flatten() {
        settings = with_setting(settings, &name.extract::<String>()?, &value)?;
    }
    Ok(settings)
}

/// The settings with `value` for the one called `name`.
fn with_setting(settings: Settings, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Settings> {
    let wrong = |error: String| refused(format!("the setting {name}: {error}"));
    let mut settings = serde_json::to_value(settings).map_err(refused)?;
    let setting = settings
        .get_mut(name)
        .ok_or_else(|| PyKeyError::new_err(format!("no setting is called {name:?}")))?;
    *setting = match setting {
        Value::Null => read_unbounded(value),
        _ => data::read(value),
    }
    .map_err(wrong)?;
    serde_json::from_value(settings).map_err(|error| wrong(error.to_string()))
}

/// A number that may be ∞, for which null stands, since JSON has no infinity; `None` is the same.
fn read_unbounded(value: &Bound<'_, PyAny>) -> Result<Value, String> {
    let infinite = |number: f64| number == f64::INFINITY;
    if value.is_none() || value.extract().is_ok_and(infinite) {
        return Ok(Value::Null);
    }
    data::read(value).map_err(|error| format!("{error}, or infinity"))
}

fn refused(error: impl Display) -> PyErr {
    ModelError::new_err(error.to_string())
}
