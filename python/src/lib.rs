//! The Python module `pleach`: missions and models, their runs as numpy arrays. `pleach.pyi`
//! describes it for Python.

mod mission;
mod model;
mod trajectory;

use mission::{Mission, Recorder};
use model::{Automaton, Composition};
use pleach_library::automaton::network::scenario::ValidScenario;
use pleach_library::discrete::Location;
use pleach_library::discrete::network::{Activity, Role};
use pleach_library::scenario_file::{self, Setting};
use pleach_library::{mission as missions, starts};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyMapping, PyTuple};
use std::path::{Path, PathBuf};
use trajectory::Trajectory;

pyo3::create_exception!(pleach, ScenarioError, PyValueError);
pyo3::create_exception!(pleach, ModelError, PyValueError);

/// Run the mission of a scenario file.
#[pyfunction]
#[pyo3(signature = (scenario, settings = None, *, seed = None))]
fn run(
    py: Python<'_>,
    scenario: PathBuf,
    settings: Option<&Bound<'_, PyMapping>>,
    seed: Option<u64>,
) -> PyResult<Mission> {
    let text = std::fs::read_to_string(&scenario)?;
    carry_out(py, &read(&text, &scenario, settings)?, seed)
}

/// Run the mission of a scenario that is given as TOML.
#[pyfunction]
#[pyo3(signature = (text, settings = None, *, seed = None))]
fn run_text(
    py: Python<'_>,
    text: &str,
    settings: Option<&Bound<'_, PyMapping>>,
    seed: Option<u64>,
) -> PyResult<Mission> {
    carry_out(py, &read(text, Path::new("<text>"), settings)?, seed)
}

/// Remarks on a scenario from which a mission can start.
#[pyfunction]
#[pyo3(signature = (scenario, settings = None))]
fn check(scenario: PathBuf, settings: Option<&Bound<'_, PyMapping>>) -> PyResult<Vec<String>> {
    let text = std::fs::read_to_string(&scenario)?;
    let remarks = read(&text, &scenario, settings)?.remarks();
    Ok(remarks.iter().map(|remark| format!("{}: {remark}", remark.key())).collect())
}

fn read(
    text: &str,
    path: &Path,
    settings: Option<&Bound<'_, PyMapping>>,
) -> PyResult<ValidScenario> {
    let mut set = Vec::new();
    for (key, value) in settings.map(entries).transpose()?.unwrap_or_default() {
        let value = written(&value)?;
        let setting: Result<Setting, _> = format!("{key}={value}").parse();
        set.push(setting.map_err(|error| ScenarioError::new_err(error.to_string()))?);
    }
    scenario_file::parse_with(text, path, &set)
        .map_err(|error| ScenarioError::new_err(error.to_string()))
}

/// The entries of a mapping in its order.
fn entries<'py>(mapping: &Bound<'py, PyMapping>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    mapping.items()?.iter().map(|entry| entry.extract()).collect()
}

/// A value as TOML writes it.
fn written(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_instance_of::<PyBool>() {
        return Ok(value.is_truthy()?.to_string());
    }
    let text = value.str()?.to_string();
    Ok(match value.is_instance_of::<PyTuple>() {
        true => text.replace('(', "[").replace(')', "]"),
        false => text,
    })
}

fn carry_out(py: Python<'_>, scenario: &ValidScenario, seed: Option<u64>) -> PyResult<Mission> {
    let drawn = seed.map(|seed| starts::draw(scenario, seed)).transpose();
    let drawn = drawn.map_err(|error| ScenarioError::new_err(error.to_string()))?;
    let scenario = drawn.as_ref().unwrap_or(scenario);
    let mut recorder = Recorder::new(scenario);
    let completed = py.detach(|| missions::run(scenario, &mut [&mut recorder]));
    let completed = completed.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    Ok(recorder.finish(completed.end))
}

#[pymodule]
fn pleach(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("ROLES", PyTuple::new(py, Role::ALL.map(|role| role.name()))?)?;
    let locations = Activity::ALL.iter().map(|activity| activity.name());
    module.add("LOCATIONS", PyTuple::new(py, locations)?)?;
    module.add("ScenarioError", py.get_type::<ScenarioError>())?;
    module.add("ModelError", py.get_type::<ModelError>())?;
    module.add_class::<Mission>()?;
    module.add_class::<Automaton>()?;
    module.add_class::<Composition>()?;
    module.add_class::<Trajectory>()?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(run_text, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)
}
