//! What a table says of a run, and the tables as CSV and JSON.

use super::plan::Planned;
use super::status::Status;
use pleach::automaton::network::scenario::LinkCount;
use pleach::mission::Completed;
use pleach::summary::Summary;
use pleach::verify::network::Extreme;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use std::io::{self, Write};

/// A run that has ended.
#[derive(Clone, Debug, Serialize)]
pub struct Record {
    /// The number of the run, from 1.
    pub run: usize,
    /// The file that the scenario comes from.
    pub source: String,
    /// The name of the scenario.
    pub scenario: String,
    /// What was set, by its key.
    #[serde(serialize_with = "as_map")]
    pub set: Vec<(String, String)>,
    /// The seed of the random starts.
    pub seed: Option<u64>,
    /// How the mission ended, as traces name it; `failed` if the program could not run it.
    pub outcome: String,
    /// The exit status of this run alone.
    pub status: Status,
    /// The number of tasks.
    pub tasks: usize,
    /// The number of tasks serviced.
    pub serviced: usize,
    /// The number of control periods.
    pub periods: usize,
    /// The time that the mission took, in seconds of its own.
    pub seconds: f64,
    /// The number of recruits elected.
    pub recruits: usize,
    /// The number of stationary points of the primary team.
    pub stationary_points: usize,
    /// The number of links of the tree at the end.
    pub tree_links: usize,
    /// How many of these cross walls.
    pub links_through_walls: usize,
    /// The largest number of links of the tree that crossed walls at the same time.
    pub most_links_through_walls: usize,
    /// The smallest distance of two robots.
    pub smallest_distance: Option<f64>,
    /// The smallest distance of a robot from a wall.
    pub smallest_clearance: Option<f64>,
    /// The smallest residual.
    pub smallest_residual: Option<f64>,
    /// The largest load.
    pub largest_load: Option<f64>,
    /// Why the mission ended; empty where all tasks are serviced.
    pub reason: String,
}

/// The columns of the CSV table before and after those of the keys that were set.
const COLUMNS: ([&str; 3], [&str; 17]) = (
    ["run", "source", "scenario"],
    [
        "seed",
        "outcome",
        "status",
        "tasks",
        "serviced",
        "periods",
        "seconds",
        "recruits",
        "stationary_points",
        "tree_links",
        "links_through_walls",
        "most_links_through_walls",
        "smallest_distance",
        "smallest_clearance",
        "smallest_residual",
        "largest_load",
        "reason",
    ],
);

impl Record {
    /// The record of a run that ended by itself.
    pub(super) fn of(run: &Planned, summary: &Summary, completed: &Completed) -> Self {
        let end = &completed.end;
        let status = Status::from(end.outcome);
        let LinkCount { links, through_walls } = summary.links().last();
        let value = |extreme: &Option<Extreme>| extreme.as_ref().map(|extreme| extreme.value);
        Self {
            outcome: end.outcome.name().into(),
            status,
            serviced: summary.serviced(),
            periods: summary.periods(),
            seconds: summary.seconds(),
            recruits: summary.recruits(),
            stationary_points: summary.stationary_points(),
            tree_links: links,
            links_through_walls: through_walls,
            most_links_through_walls: summary
                .links()
                .most()
                .map_or(0, |(most, _)| most.through_walls),
            smallest_distance: value(&completed.extremes.pair_distance),
            smallest_clearance: value(&completed.extremes.clearance),
            smallest_residual: value(&completed.extremes.residual),
            largest_load: value(&completed.extremes.load),
            reason: if status == Status::Done { String::new() } else { end.reason.clone() },
            ..Self::failed(run, String::new())
        }
    }

    /// The record of a run that the program could not do.
    pub(super) fn failed(run: &Planned, reason: String) -> Self {
        let set =
            |setting: &pleach::scenario_file::Setting| (setting.key(), setting.value().into());
        Self {
            run: run.number,
            source: run.source.clone(),
            scenario: run.scenario.name.clone(),
            set: run.settings.iter().map(set).collect(),
            seed: run.seed,
            outcome: "failed".into(),
            status: Status::Failed,
            tasks: run.scenario.task.len(),
            serviced: 0,
            periods: 0,
            seconds: 0.0,
            recruits: 0,
            stationary_points: 0,
            tree_links: 0,
            links_through_walls: 0,
            most_links_through_walls: 0,
            smallest_distance: None,
            smallest_clearance: None,
            smallest_residual: None,
            largest_load: None,
            reason,
        }
    }

    fn cells(&self) -> [String; 17] {
        let optional =
            |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
        [
            self.seed.map_or_else(String::new, |seed| seed.to_string()),
            self.outcome.clone(),
            (self.status as u8).to_string(),
            self.tasks.to_string(),
            self.serviced.to_string(),
            self.periods.to_string(),
            self.seconds.to_string(),
            self.recruits.to_string(),
            self.stationary_points.to_string(),
            self.tree_links.to_string(),
            self.links_through_walls.to_string(),
            self.most_links_through_walls.to_string(),
            optional(self.smallest_distance),
            optional(self.smallest_clearance),
            optional(self.smallest_residual),
            optional(self.largest_load),
            self.reason.clone(),
        ]
    }
}

/// Writes the records as CSV, with a header and a column for each key that was set.
pub(super) fn write_csv(records: &[Record], output: impl Write) -> io::Result<()> {
    let keys: Vec<&str> = records
        .first()
        .map_or_else(Vec::new, |first| first.set.iter().map(|(key, _)| &**key).collect());
    let (before, after) = COLUMNS;
    let mut table = csv::Writer::from_writer(output);
    table.write_record(before.iter().chain(&keys).chain(&after))?;
    for record in records {
        let before = [record.run.to_string(), record.source.clone(), record.scenario.clone()];
        let set = record.set.iter().map(|(_, value)| value.clone());
        table.write_record(before.into_iter().chain(set).chain(record.cells()))?;
    }
    table.flush()
}

/// Writes the records as a JSON array of objects.
pub(super) fn write_json(records: &[Record], mut output: impl Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut output, records)?;
    writeln!(output)?;
    output.flush()
}

/// Settings as an object; numbers as numbers.
fn as_map<S: Serializer>(set: &[(String, String)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(set.len()))?;
    for (key, value) in set {
        match serde_json::from_str::<serde_json::Value>(value) {
            Ok(value) => map.serialize_entry(key, &value)?,
            Err(_) => map.serialize_entry(key, value)?,
        }
    }
    map.end()
}
