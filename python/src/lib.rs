//! The Python module `pleach`: missions and models, their runs as numpy arrays. `pleach.pyi`
//! describes it for Python.

mod data;
mod mission;
mod model;
mod trajectory;

use data::entries;
use mission::{Mission, Recorder};
use model::{Automaton, Composition};
use pleach_library::automaton::network::scenario::ValidScenario;
use pleach_library::discrete::Location;
use pleach_library::discrete::network::{Activity, Role};
use pleach_library::scenario_file::{self, Setting};
use pleach_library::{mission as missions, starts};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyMapping, PyTuple};
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
        let refused = |error: String| ScenarioError::new_err(format!("{key}: {error}"));
        let value = written(&value).map_err(refused)?;
        let setting: Result<Setting, _> = format!("{key}={value}").parse();
        set.push(setting.map_err(|error| ScenarioError::new_err(error.to_string()))?);
    }
    scenario_file::parse_with(text, path, &set)
        .map_err(|error| ScenarioError::new_err(error.to_string()))
}

/// A value as a setting writes it: text as it is, everything else in TOML.
fn written(value: &Bound<'_, PyAny>) -> Result<String, String> {
    if let Ok(text) = value.extract() {
        return Ok(text);
    }
    let too_large = |_| format!("a whole number is too large: write at most {}", i64::MAX);
    let value = toml::Value::try_from(data::read(value)?).map_err(too_large)?;
    Ok(value.to_string())
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
