//! Traces as MCAP recordings, which Foxglove and its like play.
//!
//! | topic | schema | holds |
//! | --- | --- | --- |
//! | `/plan` | `foxglove.SceneUpdate` | the walls, access points and tasks, once |
//! | `/network` | `foxglove.SceneUpdate` | robots as discs of radius ρ, in the colours of their marks in figures; the tree; links as wide as their traffic |
//! | `/log` | `foxglove.Log` | each event as a sentence |
//! | `/numbers` | `pleach.Numbers` | residuals, multipliers and the phase, for plots |
//!
//! Messages are JSON, with JSON Schemas for those fields of Foxglove's schemas that are used. Times
//! are those of the mission.

mod scene;

use crate::automaton::network::record::Snapshot;
use crate::discrete::Location as _;
use crate::story;
use crate::trace::{TraceEntry, TraceError, TraceReader};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{McapError, WriteOptions, Writer};
use scene::{Frame, Stamp};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{BufRead, Write};
use thiserror::Error;

/// Why a trace cannot be recorded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The trace cannot be read.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The recording cannot be written.
    #[error("cannot write the recording: {0}")]
    Mcap(#[from] McapError),
    /// A message cannot be written as JSON.
    #[error("cannot write a message of the recording: {0}")]
    Message(#[from] serde_json::Error),
}

/// The numbers of a step, for plots.
#[derive(Serialize)]
struct Numbers<'a> {
    timestamp: Stamp,
    k: usize,
    residual: &'a [f64],
    multiplier: &'a [f64],
    active: usize,
    serviced: usize,
    phase: &'a str,
}

/// An event, as Foxglove's `Log`.
#[derive(Serialize)]
struct Log {
    timestamp: Stamp,
    level: u8,
    message: String,
    name: &'static str,
    file: &'static str,
    line: u32,
}

/// `INFO` of Foxglove's levels.
const INFO: u8 = 2;

/// Writes a trace as a recording, one that breaks off up to there; the number of messages.
///
/// # Errors
/// When the trace cannot be read or the recording cannot be written.
pub fn write<R: BufRead, W: Write>(
    trace: TraceReader<R>,
    output: W,
) -> Result<u64, RecordingError> {
    let scenario = trace.scenario().clone();
    let mut recording = Recording::new(output)?;
    recording.write(Topic::Plan, 0.0, &scene::plan(&scenario))?;
    let mut log: Vec<String> = Vec::new();
    let mut time = 0.0;
    for entry in trace {
        match entry? {
            // Events stand before the step of their instant.
            TraceEntry::Event { event, .. } => log.push(story::tell(&event)),
            TraceEntry::Step(snapshot) => {
                time = snapshot.time;
                recording.log(time, &mut log)?;
                recording.write(Topic::Network, time, &Frame::of(&scenario, &snapshot).scene())?;
                recording.write(Topic::Numbers, time, &numbers(&snapshot))?;
            }
            TraceEntry::End(end) => log.push(format!("{}: {}", end.outcome.name(), end.reason)),
        }
    }
    recording.log(time, &mut log)?;
    recording.finish()
}

fn numbers(snapshot: &Snapshot) -> Numbers<'_> {
    Numbers {
        timestamp: Stamp::of(snapshot.time),
        k: snapshot.step,
        residual: &snapshot.residuals,
        multiplier: &snapshot.multipliers,
        active: snapshot.active.len(),
        serviced: snapshot.serviced.len(),
        phase: snapshot.phase.name(),
    }
}

/// What messages are about.
#[derive(Clone, Copy)]
enum Topic {
    Plan,
    Network,
    Log,
    Numbers,
}

/// A recording under way.
struct Recording<W: Write> {
    /// The output may be a pipe, which cannot seek, so chunks are buffered in memory.
    writer: Writer<NoSeek<W>>,
    channels: [u16; 4],
    messages: u64,
}

impl<W: Write> Recording<W> {
    fn new(output: W) -> Result<Self, RecordingError> {
        let options = WriteOptions::new().compression(None).library("pleach").disable_seeking(true);
        let mut writer = options.create(NoSeek::new(output))?;
        let mut schema =
            |name: &str, text: &str| writer.add_schema(name, "jsonschema", text.as_bytes());
        let scene = schema("foxglove.SceneUpdate", include_str!("recording/scene_update.json"))?;
        let log = schema("foxglove.Log", include_str!("recording/log.json"))?;
        let numbers = schema("pleach.Numbers", include_str!("recording/numbers.json"))?;
        let topics = [(scene, "/plan"), (scene, "/network"), (log, "/log"), (numbers, "/numbers")];
        let mut channels = [0; 4];
        for (channel, (schema, topic)) in channels.iter_mut().zip(topics) {
            *channel = writer.add_channel(schema, topic, "json", &BTreeMap::new())?;
        }
        Ok(Self { writer, channels, messages: 0 })
    }

    fn write(
        &mut self,
        topic: Topic,
        time: f64,
        message: &impl Serialize,
    ) -> Result<(), RecordingError> {
        let nanoseconds = Stamp::of(time).nanoseconds();
        let header = MessageHeader {
            channel_id: self.channels[topic as usize],
            sequence: self.messages as u32,
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        self.messages += 1;
        Ok(self.writer.write_to_known_channel(&header, &serde_json::to_vec(message)?)?)
    }

    /// Writes the sentences, which are then gone.
    fn log(&mut self, time: f64, sentences: &mut Vec<String>) -> Result<(), RecordingError> {
        for message in sentences.drain(..) {
            let timestamp = Stamp::of(time);
            let (name, file, line) = ("pleach", "", 0);
            self.write(
                Topic::Log,
                time,
                &Log { timestamp, level: INFO, message, name, file, line },
            )?;
        }
        Ok(())
    }

    fn finish(mut self) -> Result<u64, RecordingError> {
        self.writer.finish()?;
        Ok(self.messages)
    }
}
