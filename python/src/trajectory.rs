//! The run of a model as arrays.

use crate::ModelError;
use numpy::ndarray::{Array1, Array2};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, ToPyArray};
use pleach_library::automaton::{self as models, diagram};
use pleach_library::page::{Drawing, TrajectoryPage};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// A run of an automaton or a composition. S samples, V variables, C components.
#[pyclass(frozen, module = "pleach")]
pub struct Trajectory {
    run: models::Trajectory,
    drawings: Vec<Drawing>,
    times: Array1<f64>,
    jumped: Array1<u32>,
    values: Array2<f64>,
    places: Array2<u32>,
}

impl Trajectory {
    /// A run with the drawings of the automata that ran.
    pub fn new(run: models::Trajectory, drawings: Vec<Drawing>) -> Self {
        let (mut times, mut jumped, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut places: Vec<u32> = Vec::new();
        for (number, phase) in (0..).zip(run.intervals()) {
            for sample in &phase.samples {
                times.push(sample.t);
                jumped.push(number);
                values.extend(&sample.values);
                places.extend(phase.locations.iter().map(|&place| place as u32));
            }
        }
        let [samples, variables] = [times.len(), run.variables().len()];
        Self {
            times: Array1::from_vec(times),
            jumped: Array1::from_vec(jumped),
            values: Array2::from_shape_vec((samples, variables), values).unwrap_or_default(),
            places: Array2::from_shape_vec((samples, run.components().len()), places)
                .unwrap_or_default(),
            run,
            drawings,
        }
    }
}

#[pymethods]
impl Trajectory {
    #[getter]
    fn variables(&self) -> Vec<String> {
        self.run.variables().to_vec()
    }

    #[getter]
    fn components<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let components = PyDict::new(py);
        for component in self.run.components() {
            components.set_item(&component.name, &component.locations)?;
        }
        Ok(components)
    }

    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.times.to_pyarray(py)
    }

    #[getter]
    fn jumped<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.jumped.to_pyarray(py)
    }

    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.values.to_pyarray(py)
    }

    #[getter]
    fn locations<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<u32>> {
        self.places.to_pyarray(py)
    }

    #[getter]
    fn jumps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let jumps = PyList::empty(py);
        for record in self.run.jumps() {
            let jump = PyDict::new(py);
            jump.set_item("t", record.at.t)?;
            jump.set_item("label", &record.label)?;
            let moves = record.moves.iter().map(|one| {
                let component = &self.run.components()[one.component];
                let [from, to] =
                    [one.source, one.target].map(|at| component.locations[at].as_str());
                (component.name.as_str(), from, to)
            });
            jump.set_item("moves", moves.collect::<Vec<_>>())?;
            jumps.append(jump)?;
        }
        Ok(jumps)
    }

    #[getter]
    fn end(&self) -> f64 {
        self.run.ending().at.t
    }

    #[getter]
    fn outcome(&self) -> String {
        diagram::outcome(&self.run)
    }

    fn __getitem__<'py>(
        &self,
        py: Python<'py>,
        variable: &str,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let column = self.run.variables().iter().position(|name| name == variable);
        let column = column.ok_or_else(|| {
            let known = self.run.variables().join(", ");
            PyKeyError::new_err(format!("no variable is called {variable:?}: there are {known}"))
        })?;
        Ok(self.values.column(column).to_pyarray(py))
    }

    /// The values at instants, after all jumps there; NaN outside the run.
    fn at<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let variables = self.run.variables().len();
        let times = times.as_array();
        let outside = || vec![f64::NAN; variables];
        let values = times.iter().flat_map(|&t| self.run.values_at(t).unwrap_or_else(outside));
        let values = Array2::from_shape_vec((times.len(), variables), values.collect());
        Ok(values.unwrap_or_default().to_pyarray(py))
    }

    /// The page on which the run plays, an HTML document.
    #[pyo3(signature = (title = "A run"))]
    fn page(&self, title: &str) -> String {
        TrajectoryPage::new(title, &self.run).drawings(self.drawings.iter().cloned()).render()
    }

    /// The plot, an SVG picture.
    fn plot(&self) -> String {
        diagram::plot(&self.run)
    }

    /// The trajectory as JSON.
    fn to_json(&self) -> PyResult<String> {
        let mut text = Vec::new();
        let written = self.run.write(&mut text).map_err(|error| error.to_string());
        let text =
            written.and_then(|()| String::from_utf8(text).map_err(|error| error.to_string()));
        text.map_err(ModelError::new_err)
    }

    fn __len__(&self) -> usize {
        self.times.len()
    }

    fn __repr__(&self) -> String {
        format!("<pleach.Trajectory: {}>", diagram::outcome(&self.run))
    }
}
