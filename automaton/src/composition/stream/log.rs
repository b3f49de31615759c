//! Observers that keep or write what they see.

use std::io::{self, Write};

use pleach_guards::{Expression, Program, variable};

use super::{Composition, Flowing, Jumping, RunObserver};
use crate::composition::sampler::advances;

/// The times 0, `period`, 2 `period`, … that have not come yet.
struct Grid {
    period: f64,
    next: u64,
}

impl Grid {
    fn every(period: f64) -> Self {
        Grid { period, next: 0 }
    }

    /// Whether it advances up to a horizon.
    fn check(&self, horizon: f64) -> Result<(), String> {
        let period = self.period;
        if period.is_nan() || period <= 0.0 {
            return Err(format!("the period of samples is {period} s: it has to be above 0, or ∞"));
        }
        if horizon.is_finite() && !advances(horizon, period) {
            return Err(format!(
                "the period of samples is {period:e} s, which numbers near the horizon, {horizon} s, do not resolve: \
                 choose a longer one"
            ));
        }
        Ok(())
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
    fn begins(&mut self, _composition: &Composition, horizon: f64) -> Result<(), String> {
        self.grid.check(horizon)
    }

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
    /// Their formulas, once a run has begun.
    columns: Option<Vec<Program>>,
    /// The first that failed.
    fault: Option<io::Error>,
}

impl<W: Write> CsvLog<W> {
    /// With a row every `period` > 0 seconds, besides jumps; with an infinite period for jumps alone. Numbers
    /// are written one by one: hand in a buffered writer.
    pub fn every(period: f64, writer: W) -> Self {
        CsvLog { grid: Grid::every(period), writer, chosen: None, columns: None, fault: None }
    }

    /// Writes these variables and signals alone, in this order, after the four columns that every row has. A run does not
    /// begin if the composition lacks one of them.
    #[must_use]
    pub fn columns(mut self, names: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.chosen = Some(names.into_iter().map(Into::into).collect());
        self
    }

    /// The writer, when all is written.
    ///
    /// # Errors
    ///
    /// The first error of the writer.
    pub fn finish(mut self) -> io::Result<W> {
        match self.fault.take() {
            Some(fault) => Err(fault),
            None => self.writer.flush().map(|()| self.writer),
        }
    }

    /// The names of the columns, and their formulas.
    fn chosen_of(&self, composition: &Composition) -> Result<(Vec<String>, Vec<Program>), String> {
        let variables = composition.variables();
        let signals = composition.signals().map(|(name, formula)| (name, formula.clone()));
        let known: Vec<(&str, Expression)> =
            variables.iter().map(|name| (&**name, variable(name))).chain(signals).collect();
        let names: Vec<String> = match &self.chosen {
            Some(chosen) => chosen.clone(),
            None => known.iter().map(|(name, _)| (*name).to_owned()).collect(),
        };
        let program = |name: &String| match known.iter().find(|(known, _)| known == name) {
            Some((_, formula)) => formula.compile(variables).map_err(|fault| fault.to_string()),
            None => Err(match composition.source_of(name) {
                Some(source) => {
                    format!("`{name}` is an input: its values are in the column `{source}`")
                }
                None => {
                    let known = known.iter().map(|(name, _)| format!("`{name}`"));
                    let known = known.collect::<Vec<_>>().join(", ");
                    format!("there is no column `{name}`: there are {known}")
                }
            }),
        };
        let formulas = names.iter().map(program).collect::<Result<_, _>>()?;
        Ok((names, formulas))
    }

    fn header(&mut self, names: &[String]) -> io::Result<()> {
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
        while let Some(t) = self.grid.up_to(flow.until) {
            self.row(t, flow.from.j, [""; 2], &flow.values_at(t))?;
        }
        Ok(())
    }

    fn jump(&mut self, jump: &Jumping<'_>) -> io::Result<()> {
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
    fn begins(&mut self, composition: &Composition, horizon: f64) -> Result<(), String> {
        self.grid.check(horizon)?;
        if self.columns.is_none() {
            let (names, formulas) = self.chosen_of(composition)?;
            self.columns = Some(formulas);
            self.attempt(|log| log.header(&names));
        }
        Ok(())
    }

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
