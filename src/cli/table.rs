//! The records of many runs as a table for people.

use super::record::Record;
use super::terminal;
use pleach::figures::quantity;

const HEADER: [&str; 7] = ["run", "scenario", "outcome", "tasks", "periods", "recruits", "load"];

/// The table, each line cut to the width of the terminal.
pub(super) fn draw(records: &[Record], width: Option<usize>) -> String {
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
pub(super) fn line(record: &Record) -> String {
    let set = record.set.iter().map(|(key, value)| format!(" {key}={}", readable(value)));
    let set: String = set.collect();
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
    cells.extend(record.set.iter().map(|(_, value)| readable(value)));
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

/// Why missions ended with tasks unserviced, each reason once, after the runs that it is true of.
pub(super) fn reasons(records: &[Record]) -> String {
    let mut known: Vec<(&str, Vec<usize>)> = Vec::new();
    for record in records.iter().filter(|record| !record.reason.is_empty()) {
        match known.iter_mut().find(|(reason, _)| *reason == record.reason) {
            Some((_, runs)) => runs.push(record.run),
            None => known.push((&record.reason, vec![record.run])),
        }
    }
    let line = |(reason, runs): &(&str, Vec<usize>)| {
        let noun = if runs.len() == 1 { "run" } else { "runs" };
        format!("{noun} {}: {reason}\n", listed(runs))
    };
    known.iter().map(line).collect()
}

/// Ascending numbers, neighbours taken together: `1–3, 7`.
fn listed(numbers: &[usize]) -> String {
    let groups = numbers.chunk_by(|one, next| one + 1 == *next);
    let written = |group: &[usize]| match group {
        [first, .., last] => format!("{first}–{last}"),
        _ => group[0].to_string(),
    };
    groups.map(written).collect::<Vec<_>>().join(", ")
}

/// A value that was set, rounded for people if it is a number.
fn readable(value: &str) -> String {
    value.parse().map_or_else(|_| value.to_owned(), quantity)
}

/// `step_radius` of `control.step_radius`: what fits over a column.
fn last_name(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_values_are_short() {
        assert_eq!(listed(&[1, 2, 3, 7, 9, 10]), "1–3, 7, 9–10");
        assert_eq!(listed(&[4]), "4");
        assert_eq!(
            ["0.02611111111111", "20000", "dual"].map(readable),
            ["0.02611", "20000", "dual"]
        );
    }
}
