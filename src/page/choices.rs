//! Values of any kind over the steps of a run, each kept once.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::table::Table;

/// Values by step and column; the table holds their numbers in the list.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Choices {
    values: Vec<Value>,
    table: Table,
    /// The number of each value, by its text.
    #[serde(skip)]
    numbers: BTreeMap<String, usize>,
}

impl Choices {
    /// A table without columns.
    pub(super) fn new() -> Choices {
        Choices { values: Vec::new(), table: Table::new(0), numbers: BTreeMap::new() }
    }

    /// Adds a step.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = Value>) {
        let row: Vec<f64> = row.into_iter().map(|value| self.number(value) as f64).collect();
        self.table.push(row);
    }

    fn number(&mut self, value: Value) -> usize {
        let next = self.values.len();
        let number = *self.numbers.entry(value.to_string()).or_insert(next);
        if number == next {
            self.values.push(value);
        }
        number
    }
}
