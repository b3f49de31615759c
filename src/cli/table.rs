//! The records of many runs as a table for people.

use super::record::Record;
use super::terminal;

const HEADER: [&str; 7] = ["run", "scenario", "outcome", "tasks", "periods", "recruits", "load"];

/// The table, each line cut to the width of the terminal.
pub fn draw(records: &[Record], width: Option<usize>) -> String {
    let keys = records.first().map_or(&[][..], |first| &first.set);
    let mut header: Vec<String> = vec![HEADER[0].into(), HEADER[1].into()];
    header.extend(keys.iter().map(|(key, _)| last_name(key)));
    if records.iter().any(|record| record.seed.is_some()) {
        header.push("seed".into());
    }
    header.extend(HEADER[2..].iter().map(|&name| name.to_owned()));
    let rows: Vec<Vec<String>> = std::iter::once(header).chain(records.iter().map(cells)).collect();
    let columns = rows[0].len();
    let widths: Vec<usize> = (0..columns)
        .map(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0))
        .collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}"));
        terminal::cut(cells.collect::<Vec<_>>().join("  ").trim_end(), width)
    };
    rows.iter().map(|row| line(row) + "\n").collect()
}

/// One line about a run that has just ended.
pub fn line(record: &Record) -> String {
    let set: String = record.set.iter().map(|(key, value)| format!(" {key}={value}")).collect();
    let seed = record.seed.map_or_else(String::new, |seed| format!(" seed {seed}"));
    format!(
        "run {} {}{set}{seed}: {}, {} of {} tasks serviced in {} periods",
        record.run,
        record.scenario,
        record.outcome.replace('_', " "),
        record.serviced,
        record.tasks,
        record.periods
    )
}

fn cells(record: &Record) -> Vec<String> {
    let mut cells = vec![record.run.to_string(), record.scenario.clone()];
    cells.extend(record.set.iter().map(|(_, value)| value.clone()));
    cells.extend(record.seed.map(|seed| seed.to_string()));
    cells.extend([
        record.outcome.replace('_', " "),
        format!("{}/{}", record.serviced, record.tasks),
        record.periods.to_string(),
        record.recruits.to_string(),
        record.largest_load.map_or_else(|| "–".into(), |load| format!("{load:.3}")),
    ]);
    cells
}

/// `step_radius` of `control.step_radius`: what fits over a column.
fn last_name(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).to_owned()
}
