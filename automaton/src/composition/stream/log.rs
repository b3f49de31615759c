//! Observers that keep or write what they see.

use std::io::{self, Write};

use pleach_guards::{Expression, Program, variable};

use super::{Composition, Flowing, Jumping, RunObserver};

/// The times 0, `period`, 2 `period`, … that have not come yet.
struct Grid {
    period: f64,
    next: u64,
}

impl Grid {
    fn every(period: f64) -> Self {
        Grid { period: if period > 0.0 { period } else { f64::INFINITY }, next: 0 }
    }

    /// The next of them, if it is not after `until`.
    fn up_to(&mut self, until: f64) -> Option<f64> {
        let time = if self.next == 0 { 0.0 } else { self.next as f64 * self.period };
        (time <= until).then(|| {
            self.next += 1;
            time
        })
    }
}

/// Keeps the values on a grid of times. Where a time is that of a jump, they are those before it, x⁻.
pub struct Samples {
    grid: Grid,
    rows: Vec<(f64, Vec<f64>)>,
}

impl Samples {
    /// At 0, `period` > 0, 2 `period`, … seconds.
    pub fn every(period: f64) -> Self {
        Samples { grid: Grid::every(period), rows: Vec::new() }
    }

    /// The times, each with the values of the variables.
    pub fn rows(&self) -> &[(f64, Vec<f64>)] {
        &self.rows
    }
}

impl RunObserver for Samples {
    fn flows(&mut self, flow: &Flowing<'_>) {
        while let Some(t) = self.grid.up_to(flow.until) {
            self.rows.push((t, flow.values_at(t)));
        }
    }
}

/// Writes a run as CSV: the time t, the number j of jumps, the components and the event of a jump, then
/// variables and signals, all of them or those [of choice](Self::columns). There is a row for each time of a grid, and one
/// for each side of a jump; the second of these has the event.
pub struct CsvLog<W> {
    grid: Grid,
    writer: W,
    /// The variables and signals that are written, if they are chosen.
    chosen: Option<Vec<String>>,
    /// Their formulas, once there is a header.
    columns: Option<Vec<Program>>,
    /// The first that failed.
    fault: Option<io::Error>,
}

impl<W: Write> CsvLog<W> {
    /// With a row every `period` seconds, besides jumps; with an infinite period for jumps alone. Numbers
    /// are written one by one: hand in a buffered writer.
    pub fn every(period: f64, writer: W) -> Self {
        CsvLog { grid: Grid::every(period), writer, chosen: None, columns: None, fault: None }
    }

    /// Writes these variables and signals alone, in this order, after the four columns that every row has.
    #[must_use]
    pub fn columns(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.chosen = Some(names.into_iter().map(Into::into).collect());
        self
    }

    /// The writer, when all is written.
    ///
    /// # Errors
    ///
    /// The first error of the writer, or a chosen column that the composition does not have, with those that it has.
    pub fn finish(mut self) -> io::Result<W> {
        match self.fault.take() {
            Some(fault) => Err(fault),
            None => self.writer.flush().map(|()| self.writer),
        }
    }

    fn begin(&mut self, composition: &Composition) -> io::Result<()> {
        if self.columns.is_some() {
            return Ok(());
        }
        let variables = composition.variables();
        let signals = composition.signals().map(|(name, formula)| (name, formula.clone()));
        let known: Vec<(&str, Expression)> =
            variables.iter().map(|name| (&**name, variable(name))).chain(signals).collect();
        let names: Vec<&str> = match &self.chosen {
            Some(chosen) => chosen.iter().map(String::as_str).collect(),
            None => known.iter().map(|(name, _)| *name).collect(),
        };
        let program = |name: &&str| match known.iter().find(|(known, _)| known == name) {
            Some((_, formula)) => formula.compile(variables).map_err(io::Error::other),
            None => {
                let known: Vec<String> =
                    known.iter().map(|(name, _)| format!("`{name}`")).collect();
                let known = known.join(", ");
                Err(io::Error::other(format!("there is no column `{name}`: there are {known}")))
            }
        };
        self.columns = Some(names.iter().map(program).collect::<io::Result<_>>()?);
        write!(self.writer, "t,j,component,event")?;
        for name in names {
            write!(self.writer, ",{}", quoted(name))?;
        }
        writeln!(self.writer)
    }

    fn row(&mut self, t: f64, j: u32, what: [&str; 2], values: &[f64]) -> io::Result<()> {
        write!(self.writer, "{t},{j},{},{}", quoted(what[0]), quoted(what[1]))?;
        for column in self.columns.iter().flatten() {
            write!(self.writer, ",{}", column.evaluate(values))?;
        }
        writeln!(self.writer)
    }

    fn flow(&mut self, flow: &Flowing<'_>) -> io::Result<()> {
        self.begin(flow.composition())?;
        while let Some(t) = self.grid.up_to(flow.until) {
            self.row(t, flow.from.j, [""; 2], &flow.values_at(t))?;
        }
        Ok(())
    }

    fn jump(&mut self, jump: &Jumping<'_>) -> io::Result<()> {
        self.begin(jump.composition())?;
        let components = jump.components().collect::<Vec<_>>().join("; ");
        self.row(jump.at.t, jump.at.j, [""; 2], jump.before)?;
        let after = jump.at.after_jump();
        self.row(after.t, after.j, [&components, jump.label], jump.after)
    }

    /// Does what can fail, unless something has failed before.
    fn attempt(&mut self, write: impl FnOnce(&mut Self) -> io::Result<()>) {
        if self.fault.is_none() {
            self.fault = write(self).err();
        }
    }
}

impl<W: Write> RunObserver for CsvLog<W> {
    fn flows(&mut self, flow: &Flowing<'_>) {
        self.attempt(|log| log.flow(flow));
    }

    fn jumps(&mut self, jump: &Jumping<'_>) {
        self.attempt(|log| log.jump(jump));
    }
}

/// A field of a row, in quotation marks where it needs them (RFC 4180).
fn quoted(field: &str) -> String {
    match field.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_owned(),
    }
}
