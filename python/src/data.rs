//! Values of Python as data that files hold.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyMapping, PySequence, PyString};
use serde_json::{Number, Value};

/// How many lists and tables may stand inside one another, so that one that holds itself is refused.
const NESTING_LIMIT: usize = 50;

/// The truth value, number, text, list or table that `value` is; arrays and numbers of numpy are
/// lists and numbers.
///
/// # Errors
///
/// What is wrong with the value, or with one inside it, and what would be right.
pub fn read(value: &Bound<'_, PyAny>) -> Result<Value, String> {
    read_nested(value, 0)
}

fn read_nested(value: &Bound<'_, PyAny>, depth: usize) -> Result<Value, String> {
    if depth > NESTING_LIMIT {
        let limit = "lists and tables stand inside one another at most";
        return Err(format!("{limit} {NESTING_LIMIT} deep: does one hold itself?"));
    }
    let inner = |value: &Bound<'_, PyAny>| read_nested(value, depth + 1);
    let told = |error: PyErr| error.value(value.py()).to_string();
    if let Ok(without_numpy) = value.call_method0("tolist") {
        inner(&without_numpy)
    } else if let Ok(text) = value.cast::<PyString>() {
        text.to_str().map(Value::from).map_err(told)
    } else if let Ok(table) = value.cast::<PyMapping>() {
        let entries = entries(table).map_err(told)?;
        entries.into_iter().map(|(key, value)| Ok((key, inner(&value)?))).collect()
    } else if let Ok(list) = value.cast::<PySequence>() {
        let items = list.to_list().map_err(told)?;
        items.iter().map(|item| inner(&item)).collect()
    } else {
        read_scalar(value)
    }
}

fn read_scalar(value: &Bound<'_, PyAny>) -> Result<Value, String> {
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(truth.is_true().into());
    }
    if let Ok(whole) = value.extract::<i64>() {
        return Ok(whole.into());
    }
    if let Ok(whole) = value.extract::<u64>() {
        return Ok(whole.into());
    }
    let number: f64 = value.extract().map_err(|_| {
        format!("{value:?} is no value: write a truth value, a number, a text, a list or a table")
    })?;
    Number::from_f64(number)
        .map(Value::Number)
        .ok_or_else(|| format!("{number} is not a finite number: write one, such as 0.5"))
}

/// The entries of a mapping in its order.
pub fn entries<'py>(mapping: &Bound<'py, PyMapping>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
    let entry = |entry: Bound<'py, PyAny>| {
        let (key, value): (Bound<'py, PyAny>, _) = entry.extract()?;
        let wrong = |_| PyTypeError::new_err(format!("the key {key:?} is no text: write a text"));
        Ok((key.extract().map_err(wrong)?, value))
    };
    mapping.items()?.iter().map(entry).collect()
}
