//! The steps of a mission as tables: what the lines of a trace hold, column by column.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::{Map, Value};

use super::choices::Choices;
use super::table::Table;

/// Fields of numbers, one or a point for each robot, and how many decimals a page keeps of them;
/// those of lengths depend on the scenario.
const MEASURED: [(&str, Option<i32>); 7] = [
    ("position", None),
    ("target", None),
    ("distance", None),
    ("residual", Some(6)),
    ("multiplier", Some(6)),
    ("sent", Some(0)),
    ("heard", Some(0)),
];
/// A field of points, or `null` where there is none.
const OPTIONAL_POINTS: &str = "target";
/// Decimals of T_ij and R_ij.
const LINK_DECIMALS: i32 = 6;
/// The field with the links in use, `[[from, to, T, R], …]`.
const LINKS: &str = "route";
/// Fields with one name for each robot.
const NAMED: [&str; 5] = ["role", "mark", "location", "exchange", "known_phase"];
/// What the place of a line in the tables says already.
const IMPLIED: [&str; 2] = ["k", "t"];

/// The steps of a mission so far. Fields that are not measured are kept as they are, whatever they
/// are called.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Steps {
    /// How many there are.
    count: usize,
    numbers: BTreeMap<&'static str, Table>,
    values: BTreeMap<String, Choices>,
    links: Links,
}

/// Links by the pair of nodes that they join, in the order in which they came into use.
#[derive(Clone, Debug, Serialize)]
struct Links {
    pairs: Vec<(u64, u64)>,
    share: Table,
    reliability: Table,
    #[serde(skip)]
    columns: BTreeMap<(u64, u64), usize>,
    /// R of each pair when it was last in use.
    #[serde(skip)]
    last: Vec<f64>,
}

impl Steps {
    /// No steps; lengths keep `decimals`.
    pub(super) fn new(decimals: i32) -> Steps {
        let measured = MEASURED.map(|(name, fixed)| (name, Table::new(fixed.unwrap_or(decimals))));
        Steps {
            count: 0,
            numbers: measured.into(),
            values: BTreeMap::new(),
            links: Links {
                pairs: Vec::new(),
                share: Table::new(LINK_DECIMALS),
                reliability: Table::new(LINK_DECIMALS),
                columns: BTreeMap::new(),
                last: Vec::new(),
            },
        }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Adds the line of a trace for a step, and `more` fields that only the page has.
    pub(super) fn push(
        &mut self,
        line: Map<String, Value>,
        more: impl IntoIterator<Item = (String, Value)>,
    ) {
        for (name, value) in line.into_iter().chain(more) {
            if let Some(table) = self.numbers.get_mut(&*name) {
                table.push(match name == OPTIONAL_POINTS {
                    true => optional_points(&value),
                    false => numbers(&value),
                });
            } else if name == LINKS {
                self.links.push(&value);
            } else if !IMPLIED.contains(&&*name) {
                self.choose(name, value);
            }
        }
        self.count += 1;
    }

    fn choose(&mut self, name: String, value: Value) {
        let by_robot = NAMED.contains(&&*name);
        let choices = self.values.entry(name).or_insert_with(Choices::new);
        match value {
            Value::Array(names) if by_robot => choices.push(names),
            value => choices.push([value]),
        }
    }
}

impl Links {
    fn push(&mut self, routes: &Value) {
        let mut share = vec![0.0; self.pairs.len()];
        for route in routes.as_array().into_iter().flatten() {
            let end = |at: usize| route.get(at).and_then(Value::as_u64).unwrap_or_default();
            let number = |at: usize| route.get(at).and_then(Value::as_f64).unwrap_or(f64::NAN);
            let pair = (end(0), end(1));
            let next = self.pairs.len();
            let column = *self.columns.entry(pair).or_insert(next);
            if column == next {
                self.pairs.push(pair);
                self.last.push(0.0);
                share.push(0.0);
            }
            (share[column], self.last[column]) = (number(2), number(3));
        }
        self.share.push(share);
        self.reliability.push(self.last.iter().copied());
    }
}

/// The coordinates of a list of points, two that are no numbers for each point that is missing.
fn optional_points(points: &Value) -> Vec<f64> {
    let mut coordinates = Vec::new();
    for point in points.as_array().into_iter().flatten() {
        match point {
            Value::Null => coordinates.extend([f64::NAN; 2]),
            point => gather(point, &mut coordinates),
        }
    }
    coordinates
}

/// The numbers of a list, those of points one after the other.
fn numbers(value: &Value) -> Vec<f64> {
    let mut numbers = Vec::new();
    gather(value, &mut numbers);
    numbers
}

/// JSON writes what is not a number as `null`.
fn gather(value: &Value, numbers: &mut Vec<f64>) {
    match value {
        Value::Array(entries) => entries.iter().for_each(|entry| gather(entry, numbers)),
        other => numbers.push(other.as_f64().unwrap_or(f64::NAN)),
    }
}
