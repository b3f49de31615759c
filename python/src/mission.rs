//! A mission as arrays.

use numpy::ndarray::{Array, Array1, Array2, Array3, Dimension, StrideShape};
use numpy::{PyArray1, PyArray2, PyArray3, ToPyArray};
use pleach_library::automaton::network::record::{End, MissionEvent, Snapshot};
use pleach_library::automaton::network::scenario::ValidScenario;
use pleach_library::discrete::Location;
use pleach_library::discrete::network::{Activity, Role};
use pleach_library::mission::Watcher;
use pyo3::prelude::*;
use std::io;

/// Collects what a mission shows.
pub struct Recorder {
    name: String,
    scenario: String,
    robots: usize,
    times: Vec<f64>,
    positions: Vec<f64>,
    residuals: Vec<f64>,
    multipliers: Vec<f64>,
    roles: Vec<u8>,
    locations: Vec<u8>,
    targets: Vec<f64>,
    messages: Vec<u64>,
    routes: Vec<f64>,
    tree: Vec<i64>,
    events: Vec<String>,
    interrupted: bool,
}

impl Recorder {
    /// A recorder of a mission that has not begun.
    pub fn new(scenario: &ValidScenario) -> Self {
        Self {
            name: scenario.name.clone(),
            scenario: serde_json::to_string(&scenario.with_defaults()).unwrap_or_default(),
            robots: scenario.robot.len(),
            times: Vec::new(),
            positions: Vec::new(),
            residuals: Vec::new(),
            multipliers: Vec::new(),
            roles: Vec::new(),
            locations: Vec::new(),
            targets: Vec::new(),
            messages: Vec::new(),
            routes: Vec::new(),
            tree: Vec::new(),
            events: Vec::new(),
            interrupted: false,
        }
    }

    /// The mission, which has ended.
    pub fn finish(self, end: End) -> Mission {
        let (periods, robots) = (self.times.len(), self.robots);
        let table = |values: Vec<f64>| shaped(values, (periods, robots));
        Mission {
            outcome: end.outcome.name().into(),
            reason: end.reason,
            task: end.task,
            given_up: end.tasks,
            name: self.name,
            scenario: self.scenario,
            times: Array1::from_vec(self.times),
            positions: shaped(self.positions, (periods, robots, 2)),
            targets: shaped(self.targets, (periods, robots, 2)),
            messages: shaped(self.messages, (periods, robots, 2)),
            locations: shaped(self.locations, (periods, robots)),
            residuals: table(self.residuals),
            multipliers: table(self.multipliers),
            roles: shaped(self.roles, (periods, robots)),
            routes: shaped_rows(self.routes, 5),
            tree: shaped_rows(self.tree, 3),
            events: self.events,
        }
    }
}

fn shaped<T: Clone + Default, D: Dimension>(
    values: Vec<T>,
    shape: impl Into<StrideShape<D>>,
) -> Array<T, D> {
    Array::from_shape_vec(shape, values).unwrap_or_default()
}

fn shaped_rows<T: Clone + Default>(values: Vec<T>, columns: usize) -> Array2<T> {
    let rows = values.len() / columns;
    shaped(values, (rows, columns))
}

impl Watcher for Recorder {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.times.push(snapshot.time);
        self.positions.extend(snapshot.positions.iter().flat_map(|place| [place.x, place.y]));
        self.residuals.extend(&snapshot.residuals);
        self.multipliers.extend(&snapshot.multipliers);
        let index = |role: &Role| Role::ALL.iter().position(|other| other == role);
        self.roles.extend(snapshot.roles.iter().filter_map(index).map(|index| index as u8));
        for robot in &snapshot.robots {
            let location = Activity::ALL.iter().position(|other| *other == robot.activity);
            self.locations.extend(location.map(|location| location as u8));
            let target = robot.target.map_or([f64::NAN; 2], |target| [target.x, target.y]);
            self.targets.extend(target);
            self.messages.extend([robot.sent, robot.heard]);
        }
        for route in &snapshot.routes {
            let [k, from, to] = [snapshot.step, route.from, route.to].map(|number| number as f64);
            self.routes.extend([k, from, to, route.share, route.reliability]);
        }
        for &(child, parent) in &snapshot.tree {
            self.tree.extend([snapshot.step, child, parent].map(|number| number as i64));
        }
        for event in events {
            let mut event = serde_json::to_value(event)?;
            event["k"] = snapshot.step.into();
            self.events.push(event.to_string());
        }
        self.interrupted = Python::attach(|py| py.check_signals()).is_err();
        Ok(())
    }

    fn interruption(&self) -> Option<String> {
        self.interrupted.then(|| "the run was ended by a signal".into())
    }
}

/// A mission that has ended.
#[pyclass(frozen, module = "pleach")]
pub struct Mission {
    #[pyo3(get)]
    name: String,
    #[pyo3(get)]
    outcome: String,
    #[pyo3(get)]
    reason: String,
    #[pyo3(get)]
    task: Option<usize>,
    #[pyo3(get)]
    given_up: Vec<usize>,
    scenario: String,
    times: Array1<f64>,
    positions: Array3<f64>,
    residuals: Array2<f64>,
    multipliers: Array2<f64>,
    roles: Array2<u8>,
    locations: Array2<u8>,
    targets: Array3<f64>,
    messages: Array3<u64>,
    routes: Array2<f64>,
    tree: Array2<i64>,
    events: Vec<String>,
}

#[pymethods]
impl Mission {
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.times.to_pyarray(py)
    }

    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f64>> {
        self.positions.to_pyarray(py)
    }

    #[getter]
    fn residuals<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.residuals.to_pyarray(py)
    }

    #[getter]
    fn multipliers<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.multipliers.to_pyarray(py)
    }

    #[getter]
    fn roles<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u8>> {
        self.roles.to_pyarray(py)
    }

    #[getter]
    fn locations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u8>> {
        self.locations.to_pyarray(py)
    }

    #[getter]
    fn targets<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<f64>> {
        self.targets.to_pyarray(py)
    }

    #[getter]
    fn messages<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray3<u64>> {
        self.messages.to_pyarray(py)
    }

    #[getter]
    fn routes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.routes.to_pyarray(py)
    }

    #[getter]
    fn tree<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<i64>> {
        self.tree.to_pyarray(py)
    }

    #[getter]
    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, &format!("[{}]", self.events.join(",")))
    }

    #[getter]
    fn scenario<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, &self.scenario)
    }

    fn __repr__(&self) -> String {
        let (periods, robots) = self.residuals.dim();
        let Self { name, outcome, .. } = self;
        format!("<pleach.Mission {name:?}: {outcome}, {periods} periods, {robots} robots>")
    }
}

/// JSON as Python's own parser reads it.
fn parsed<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}
