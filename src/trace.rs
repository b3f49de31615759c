//! The trace of a mission: one JSON object a line, written while the mission runs.
//!
//! Nodes are numbered from 0, robots first, then access points. Lengths are in the scenario's
//! unit, times in seconds. Numbers are written with the fewest digits from which they can be
//! read back exactly, and nothing but the scenario decides what is written: the trace of a
//! scenario by one build is the same to the byte.
//!
//! The first line is the header, `{"type":"header","format":"pleach-trace","version":1,
//! "scenario":…}`, with every default of the scenario filled in; of a mission with faults it also says
//! whether `messages` and `nodes` failed (`"faults":{"messages":true,"nodes":false}`). Then follows, for each control
//! period, a line for each event that led to it and one of type `step` for the instant at which
//! the robots are about to move. The last line, of type `end`, holds the outcome.
//!
//! A `step` holds, in this order: `k`, `t`, `position` `[[x, y], …]` and `role` of every robot,
//! `active` (the robots that may move), `residual` and `multiplier` of every robot, `route`
//! `[[from, to, T, R], …]` where T > 0, `tree` `[[child, parent], …]`, `task` (or null), and
//! what an observer needs to draw the picture: `phase`, `active_team`, `primary_team`, `path`,
//! `serviced` `[[task, robot], …]` and `post`; then of every robot its `location` in the duty
//! automaton and its place in the automaton of the `exchange` of duties, its `known_phase` of the
//! mission, its `target` (or null), and how many messages it has `sent` and `heard` in the period. From when
//! a task is over on, `closed` lists it; while robots or access points do not run or are not heard, `absent` lists
//! them. Where each access point has a team of its own, `fleets` has of each, by `access_point`, its `phase`, `task`,
//! `active_team`, `primary_team` and `path`, and from the control period on at whose beginning its mission is over the
//! number of that period, `ended`. The keys above then hold the robots of all of them, and `phase` and `task` are those
//! of the first whose mission goes on, or of the first. The `end` has in `fleets` how the mission of each ended.

mod line;

use crate::automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use crate::automaton::network::scenario::{Scenario, Strategy, Unreachable};
use crate::mission::Watcher;
use line::{EndLine, Line, LineOut, StepLine};
use serde_json::{Map, Value};
use std::io::{self, BufRead, Write};
use thiserror::Error;

/// What the header calls the format.
pub const FORMAT: &str = "pleach-trace";

/// The version of the format that is written and read.
pub const VERSION: u32 = 1;

/// Writes a trace, line by line, as the mission goes on.
#[derive(Debug)]
pub struct TraceWriter<W: Write> {
    output: W,
}

impl<W: Write> TraceWriter<W> {
    /// Starts a trace of `scenario` with its header. The output should be buffered.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn new(output: W, scenario: &Scenario) -> io::Result<Self> {
        TraceWriter::with_faults(output, scenario, Faults::default())
    }

    /// The same for a mission in which these faults occur: the header says so.
    ///
    /// # Errors
    /// The header cannot be written.
    pub fn with_faults(output: W, scenario: &Scenario, faults: Faults) -> io::Result<Self> {
        let mut writer = Self { output };
        let scenario = &scenario.with_defaults();
        writer.line(&LineOut::Header { format: FORMAT, version: VERSION, scenario, faults })?;
        Ok(writer)
    }

    /// The output, flushed.
    ///
    /// # Errors
    /// What is buffered cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.output.flush()?;
        Ok(self.output)
    }

    fn line(&mut self, line: &LineOut<'_>) -> io::Result<()> {
        serde_json::to_writer(&mut self.output, line)?;
        self.output.write_all(b"\n")
    }
}

impl<W: Write> Watcher for TraceWriter<W> {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        for event in events {
            self.line(&LineOut::Event { k: snapshot.step, event })?;
        }
        self.line(&LineOut::Step(Box::new(StepLine::from(snapshot))))
    }

    fn end(&mut self, end: &End) -> io::Result<()> {
        self.line(&LineOut::End(EndLine::from(end)))?;
        self.output.flush()
    }
}

/// One entry of a trace after its header.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TraceEntry {
    /// Something happened in control period `step`.
    Event {
        /// k.
        step: usize,
        /// What happened.
        event: MissionEvent,
    },
    /// The instant at which the robots are about to move.
    Step(Box<Snapshot>),
    /// How the mission ended. A serviced mission gives no reason.
    End(End),
}

/// Reads a trace: the header at once, then entry by entry as an iterator.
///
/// The trace of a run that was killed breaks off, often within a line. Its entries end before that line.
#[derive(Debug)]
pub struct TraceReader<R> {
    scenario: Scenario,
    faults: Faults,
    input: R,
    number: usize,
}

impl<R: BufRead> TraceReader<R> {
    /// Starts to read a trace.
    ///
    /// # Errors
    /// The first line cannot be read or is not the header of a trace of version [`VERSION`].
    pub fn new(mut input: R) -> Result<Self, TraceError> {
        let first = WrittenLine::read(&mut input, 1)?.ok_or(TraceError::Empty)?;
        match first.parse()? {
            Line::Header { format, version, .. } if format != FORMAT || version != VERSION => {
                Err(TraceError::OtherFormat { format, version })
            }
            Line::Header { scenario, faults, .. } => {
                Ok(Self { scenario: as_traced(*scenario), faults, input, number: 1 })
            }
            _ => Err(TraceError::Misplaced { line: 1, wanted: "the header" }),
        }
    }

    /// The scenario of the mission, every default filled in.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// What failed in the mission.
    pub const fn faults(&self) -> Faults {
        self.faults
    }
}

impl<R: BufRead> Iterator for TraceReader<R> {
    type Item = Result<TraceEntry, TraceError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.number += 1;
        let line = match WrittenLine::read(&mut self.input, self.number) {
            Ok(line) => line?,
            Err(error) => return Some(Err(error)),
        };
        match line.parse() {
            Err(error) if line.breaks_off(&error) => None,
            parsed => Some(parsed.and_then(|parsed| entry(self.number, parsed))),
        }
    }
}

/// What a line after the header says.
fn entry(number: usize, line: Line) -> Result<TraceEntry, TraceError> {
    match line {
        Line::Event { k, event } => Ok(TraceEntry::Event { step: k, event }),
        Line::Step(step) => (Snapshot::try_from(*step))
            .map(|snapshot| TraceEntry::Step(Box::new(snapshot)))
            .map_err(|wrong| TraceError::Uneven { line: number, wrong }),
        Line::End(end) => Ok(TraceEntry::End(end.into())),
        Line::Header { .. } => {
            Err(TraceError::Misplaced { line: number, wanted: "a step, event or end" })
        }
    }
}

/// The scenario of a header as its mission was run. Headers state every default; but where the strategy was that of
/// the paper, earlier builds left it out, as it was their default. In a scenario file it is `eager` that is left out.
/// Headers without `[mission]` come from builds in which a task that no robot could service ended the mission.
fn as_traced(mut scenario: Scenario) -> Scenario {
    scenario.control.strategy.get_or_insert(Strategy::Paper);
    scenario.mission.unreachable.get_or_insert(Unreachable::End);
    scenario
}

/// The line of a step as an object: what [`TraceWriter`] writes, for other ways to show it.
pub(crate) fn step_line(snapshot: &Snapshot) -> serde_json::Result<Map<String, Value>> {
    match serde_json::to_value(StepLine::from(snapshot))? {
        Value::Object(line) => Ok(line),
        _ => Ok(Map::new()),
    }
}

/// A line as it stands in the trace.
struct WrittenLine {
    number: usize,
    text: Vec<u8>,
}

impl WrittenLine {
    /// The next line, if there is one.
    fn read(input: &mut impl BufRead, number: usize) -> Result<Option<Self>, TraceError> {
        let mut text = Vec::new();
        let length = input.read_until(b'\n', &mut text);
        let length = length.map_err(|source| TraceError::Unreadable { line: number, source })?;
        Ok((length > 0).then_some(Self { number, text }))
    }

    fn parse(&self) -> Result<Line, TraceError> {
        let text = self.text.strip_suffix(b"\n").unwrap_or(&self.text);
        Line::read(text).map_err(|source| match self.number {
            1 if !source.is_eof() => TraceError::NotATrace { source },
            line => TraceError::NotALine { line, source },
        })
    }

    /// Whether the trace breaks off within this line.
    fn breaks_off(&self, error: &TraceError) -> bool {
        !self.text.ends_with(b"\n")
            && matches!(error, TraceError::NotALine { source, .. } if source.is_eof())
    }
}

/// Why a text is not a trace. Lines are counted from 1.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the fields are what the sentences show
#[non_exhaustive]
pub enum TraceError {
    /// There is no line at all.
    #[error("the trace is empty: its first line must be the header")]
    Empty,
    /// The text cannot be read further.
    #[error("line {line}: cannot be read: {source}")]
    Unreadable { line: usize, source: io::Error },
    /// The first line is none of a trace.
    #[error(
        "line 1: not the header of a trace, which `pleach run --trace FILE` writes first: {}",
        within_line(source)
    )]
    NotATrace { source: serde_json::Error },
    /// Not one of the four kinds of line.
    #[error("line {line}: not a line of a trace: {}", within_line(source))]
    NotALine { line: usize, source: serde_json::Error },
    /// Another format or another version.
    #[error(
        "the header says {format:?} version {version}; this reads {FORMAT:?} version {VERSION}"
    )]
    OtherFormat { format: String, version: u32 },
    /// A line where it does not belong.
    #[error("line {line}: expected {wanted} here")]
    Misplaced { line: usize, wanted: &'static str },
    /// A step whose lists do not fit together.
    #[error("line {line}: {wrong}")]
    Uneven { line: usize, wrong: String },
}

/// What is wrong in a line that was read alone.
fn within_line(error: &serde_json::Error) -> String {
    error.to_string().replace(" at line 1 column ", " in column ")
}
