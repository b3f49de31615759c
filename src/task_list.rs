//! Tasks from a table: a CSV file whose first row names its columns.
//!
//! | column | what it holds |
//! | --- | --- |
//! | `x`, `y` | the position, two numbers |
//! | `announced`, `withdrawn`, `lasts`, `priority`, `access_point` | what the keys of a `[[task]]` hold; a cell may be empty, and the column may be left out |
//!
//! Columns stand in any order, and rows in order of announcement.

use crate::automaton::network::scenario::{MOST_PERIODS, Task};
use crate::scenario_file::{ListedTask, MistakePlace};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::fmt;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use thiserror::Error;

/// Why no tasks can be read from a file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TaskListError {
    /// The file is missing, may not be read or is not UTF-8 text.
    #[error("{}: cannot be read: {source}; give the path of a CSV file of tasks, in UTF-8", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// The file holds mistakes.
    #[error("{}", .0.join("\n"))]
    Mistaken(
        /// The mistakes, at least one: each with file, line, column and what would be right.
        Vec<String>,
    ),
}

/// Reads the tasks in the CSV file at `path`, each with its place there.
///
/// # Errors
/// The file cannot be read, its first row does not name the columns, or a cell does not hold what its column asks for.
pub fn read(path: &Path) -> Result<Vec<ListedTask>, TaskListError> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| TaskListError::Unreadable { path: path.into(), source })?;
    parse(&text, path)
}

/// Reads tasks from the text of a CSV file; `path` is what error messages call it.
///
/// # Errors
/// As [`read`].
///
/// ```
/// let tasks = pleach::task_list::parse("x,y,lasts\n0.9,0.3,80\n", "tasks.csv".as_ref())?;
/// assert_eq!((tasks[0].task.position, tasks[0].task.lasts), ([0.9, 0.3], Some(80)));
///
/// let error = pleach::task_list::parse("x,y\n0.9,north\n", "tasks.csv".as_ref()).unwrap_err();
/// assert_eq!(error.to_string(), "tasks.csv:2: column y: \"north\" stands where a number belongs");
/// # Ok::<(), pleach::task_list::TaskListError>(())
/// ```
pub fn parse(text: &str, path: &Path) -> Result<Vec<ListedTask>, TaskListError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    // The text is UTF-8 and rows may have any length: no row is wrong to the reader.
    let rows: Vec<StringRecord> = reader.records().flatten().filter(is_filled).collect();
    let mut mistakes = Vec::new();
    let mut mistake = |line, what: &dyn fmt::Display| {
        mistakes.push(format!("{}:{line}: {what}", path.display()));
    };
    let columns = match rows.first() {
        None => Err(format!("no row names the columns; {COLUMNS_WANTED}")),
        Some(header) => columns(header),
    };
    let mut tasks = Vec::new();
    match columns {
        Err(what) => mistake(rows.first().map_or(1, |header| line_of(header, text)), &what),
        Ok(_) if rows.len() == 1 => {
            mistake(
                line_of(&rows[0], text),
                &"no row follows the names of the columns: add a row for each task",
            );
        }
        Ok(columns) => {
            for row in &rows[1..] {
                let line = line_of(row, text);
                match task(row, &columns) {
                    Ok(task) => {
                        let place = MistakePlace::Table { path: path.into(), line };
                        tasks.push(ListedTask { task, place });
                    }
                    Err(problems) => problems.iter().for_each(|what| mistake(line, what)),
                }
            }
        }
    }
    if mistakes.is_empty() { Ok(tasks) } else { Err(TaskListError::Mistaken(mistakes)) }
}

/// Whether a row holds more than the separators that spreadsheets leave.
fn is_filled(row: &StringRecord) -> bool {
    row.iter().any(|cell| !cell.is_empty())
}

/// The line in which a row begins: the reader counts it from the end of the row before, blank lines included.
fn line_of(row: &StringRecord, text: &str) -> usize {
    let start = row.position().map_or(0, |position| position.byte() as usize);
    let bytes = text.as_bytes();
    let blank = bytes[start..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
    1 + bytes[..start + blank].iter().filter(|&&byte| byte == b'\n').count()
}

/// A column that a table of tasks may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    X,
    Y,
    Announced,
    Withdrawn,
    Lasts,
    Priority,
    AccessPoint,
}

use Column::{AccessPoint, Announced, Lasts, Priority, Withdrawn, X, Y};

const COLUMNS: [(&str, Column); 7] = [
    ("x", X),
    ("y", Y),
    ("announced", Announced),
    ("withdrawn", Withdrawn),
    ("lasts", Lasts),
    ("priority", Priority),
    ("access_point", AccessPoint),
];

const COLUMNS_WANTED: &str = "the first row names x and y, and any of announced, withdrawn, lasts, priority and \
                              access_point, separated by commas";

/// The columns that the first row names.
fn columns(header: &StringRecord) -> Result<Vec<Column>, String> {
    let mut columns = Vec::new();
    for name in header {
        let known = COLUMNS.iter().find(|(known, _)| *known == name);
        let (_, column) =
            known.ok_or_else(|| format!("column {name:?} is unknown; {COLUMNS_WANTED}"))?;
        if columns.contains(column) {
            return Err(format!("column {name} stands twice; {COLUMNS_WANTED}"));
        }
        columns.push(*column);
    }
    match [("x", X), ("y", Y)].iter().find(|(_, column)| !columns.contains(column)) {
        Some((name, _)) => Err(format!("column {name} is missing; {COLUMNS_WANTED}")),
        None => Ok(columns),
    }
}

/// The task of a row, or all that is wrong with its cells.
fn task(row: &StringRecord, columns: &[Column]) -> Result<Task, Vec<String>> {
    if row.len() != columns.len() {
        let (cells, named) = (row.len(), columns.len());
        return Err(vec![format!(
            "the row has {cells} cells, and the first row names {named} columns; an empty cell still needs its comma"
        )]);
    }
    let mut task = Task::at([0.0; 2]);
    let mut problems = Vec::new();
    for (cell, column) in row.iter().zip(columns) {
        if let Err(wanted) = fill(&mut task, *column, cell) {
            let name = COLUMNS.iter().find(|(_, it)| it == column).map_or("", |(name, _)| name);
            let what = if cell.is_empty() { "nothing".into() } else { format!("{cell:?}") };
            problems.push(format!("column {name}: {what} stands where {wanted} belongs"));
        }
    }
    if problems.is_empty() { Ok(task) } else { Err(problems) }
}

/// Puts what a cell says into the task; otherwise what belongs there.
fn fill(task: &mut Task, column: Column, cell: &str) -> Result<(), String> {
    let coordinate = || cell.parse().map_err(|_| "a number".to_owned());
    match column {
        X => task.position[0] = coordinate()?,
        Y => task.position[1] = coordinate()?,
        Announced => task.announced = whole(cell, 0..=MOST_PERIODS)?,
        Withdrawn => task.withdrawn = whole(cell, 1..=MOST_PERIODS)?,
        Lasts => task.lasts = whole(cell, 1..=MOST_PERIODS)?,
        Priority => task.priority = whole(cell, i32::MIN..=i32::MAX)?,
        AccessPoint => task.access_point = whole(cell, 0..=u32::MAX)?.map(|it| it as usize),
    }
    Ok(())
}

/// The whole number in a cell, none if it is empty.
fn whole<N: FromStr + PartialOrd + fmt::Display>(
    cell: &str,
    range: RangeInclusive<N>,
) -> Result<Option<N>, String> {
    if cell.is_empty() {
        return Ok(None);
    }
    let number = cell.parse().ok().filter(|number| range.contains(number));
    let wanted = || format!("a whole number from {} to {}", range.start(), range.end());
    number.map(Some).ok_or_else(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(Task, usize)> {
        let tasks = parse(text, Path::new("tasks.csv")).unwrap();
        let line = |listed: ListedTask| match listed.place {
            MistakePlace::Table { line, .. } => (listed.task, line),
            other => panic!("{other:?}"),
        };
        tasks.into_iter().map(line).collect()
    }

    fn said(text: &str) -> String {
        parse(text, Path::new("tasks.csv")).unwrap_err().to_string()
    }

    #[test]
    fn columns_stand_in_any_order_and_cells_may_be_empty() {
        let text = "\u{feff}priority, y ,x,lasts,announced,withdrawn,access_point\r\n\
                    -3,0.25,1e1,,,,\r\n\r\n,,,,,,\r\n,\"2\",.5,80,0,9,1\r\n";
        let first = Task { priority: Some(-3), ..Task::at([10.0, 0.25]) };
        let second = Task {
            lasts: Some(80),
            announced: Some(0),
            withdrawn: Some(9),
            access_point: Some(1),
            ..Task::at([0.5, 2.0])
        };
        assert_eq!(read(text), [(first, 2), (second, 5)]);
        assert_eq!(read("x,y\n1,2"), [(Task::at([1.0, 2.0]), 2)]);
    }

    #[test]
    fn every_mistake_is_told_with_line_column_and_what_would_be_right() {
        let text = "x,y,lasts,priority\n1,2,0,0.5\n\n3,,-1,\n4,5\n";
        let periods = format!("a whole number from 1 to {MOST_PERIODS} belongs");
        let expected = [
            format!("tasks.csv:2: column lasts: \"0\" stands where {periods}"),
            "tasks.csv:2: column priority: \"0.5\" stands where a whole number from -2147483648 to \
             2147483647 belongs"
                .into(),
            "tasks.csv:4: column y: nothing stands where a number belongs".into(),
            format!("tasks.csv:4: column lasts: \"-1\" stands where {periods}"),
            "tasks.csv:5: the row has 2 cells, and the first row names 4 columns; an empty cell still \
             needs its comma"
                .into(),
        ];
        assert_eq!(said(text), expected.join("\n"));
    }

    #[test]
    fn a_file_that_is_no_table_of_tasks_is_refused() {
        for (text, problem) in [
            ("", "tasks.csv:1: no row names the columns; the first row names x and y"),
            ("\n0.5,0.5\n", "tasks.csv:2: column \"0.5\" is unknown"),
            (
                "x;y\n1;2\n",
                "tasks.csv:1: column \"x;y\" is unknown; the first row names x and y, and any of announced",
            ),
            ("x,lasts\n", "tasks.csv:1: column y is missing"),
            ("\nx,y\n,\n", "tasks.csv:2: no row follows the names of the columns"),
            ("x,y,x\n", "tasks.csv:1: column x stands twice"),
        ] {
            assert!(said(text).contains(problem), "{text:?}: {}", said(text));
        }
        let missing = super::read(Path::new("no/such/tasks.csv")).unwrap_err().to_string();
        assert!(missing.starts_with("no/such/tasks.csv: cannot be read"), "{missing}");
    }
}
