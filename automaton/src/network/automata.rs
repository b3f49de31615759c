//! The automata that nodes run, each over the state of its node: the tables of the discrete layer
//! with guards and resets, flows, invariants and laws.

use std::fmt;

use pleach_discrete::{Event, Location, Row};

use crate::BuildError;

use super::access_point::{
    AttendanceAutomaton, RoundAutomaton, ServiceAutomaton, attendance_automaton, round_automaton,
    service_automaton,
};
use super::robot::{
    AttachmentAutomaton, ControlAutomaton, DutyAutomaton, ExchangeAutomaton, MissionAutomaton,
    Targets, attachment_automaton, control_automaton, duty_automaton, exchange_automaton,
    mission_automaton, targets,
};
use super::user::{RequestAutomaton, request_automaton};

/// The automata of all nodes; nodes of one kind run the same.
#[derive(Clone, Debug)]
pub struct Automata {
    /// What the robot does.
    pub duty: DutyAutomaton,
    /// Where the robot goes.
    pub targets: Targets,
    /// The mission as the robot knows it.
    pub mission: MissionAutomaton,
    /// The state of the robot in the exchange of duties.
    pub exchange: ExchangeAutomaton,
    /// The robot's place in the tree.
    pub attachment: AttachmentAutomaton,
    /// The stage of the robot in its control period.
    pub control: ControlAutomaton,
    /// The service of the tasks, for an access point.
    pub service: ServiceAutomaton,
    /// Whether a robot takes part, for an access point.
    pub attendance: AttendanceAutomaton,
    /// The stage of an access point in its control period.
    pub rounds: RoundAutomaton,
    /// What the user does.
    pub request: RequestAutomaton,
}

impl Automata {
    /// The automata.
    ///
    /// # Errors
    /// Never with the tables and guards of this crate; they are still checked.
    pub fn new() -> Result<Self, BuildError> {
        Ok(Automata {
            duty: duty_automaton()?,
            targets: targets(),
            mission: mission_automaton()?,
            exchange: exchange_automaton()?,
            attachment: attachment_automaton()?,
            control: control_automaton()?,
            service: service_automaton()?,
            attendance: attendance_automaton()?,
            rounds: round_automaton()?,
            request: request_automaton()?,
        })
    }

    /// The same automata, which count how often their rows are taken by all nodes together.
    #[must_use]
    pub fn counted(self) -> Self {
        Automata {
            duty: self.duty.counted(),
            targets: self.targets,
            mission: self.mission.counted(),
            exchange: self.exchange.counted(),
            attachment: self.attachment.counted(),
            control: self.control.counted(),
            service: self.service.counted(),
            attendance: self.attendance.counted(),
            rounds: self.rounds.counted(),
            request: self.request.counted(),
        }
    }

    /// How often each row of each table has been taken, table by table; nothing unless it is
    /// [counted](Self::counted).
    pub fn taken(&self) -> Vec<(NamedRow, u64)> {
        fn named<L: Location, E: Event>(
            table: &'static str,
            taken: impl Iterator<Item = (Row<L, E>, u64)>,
        ) -> impl Iterator<Item = (NamedRow, u64)> {
            taken.map(move |(row, times)| {
                let [source, target] = [row.source, row.target].map(|location| location.name());
                (NamedRow { table, source, event: row.event.name(), target }, times)
            })
        }
        named("duty", self.duty.taken())
            .chain(named("mission", self.mission.taken()))
            .chain(named("exchange of duties", self.exchange.taken()))
            .chain(named("place in the tree", self.attachment.taken()))
            .chain(named("control period", self.control.taken()))
            .chain(named("service of the tasks", self.service.taken()))
            .chain(named("attendance", self.attendance.taken()))
            .chain(named("control period of an access point", self.rounds.taken()))
            .chain(named("user", self.request.taken()))
            .collect()
    }
}

/// A row of one of the tables, by its names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NamedRow {
    /// The table.
    pub table: &'static str,
    /// The location that it leaves.
    pub source: &'static str,
    /// Its event.
    pub event: &'static str,
    /// The location that it enters.
    pub target: &'static str,
}

impl fmt::Display for NamedRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let NamedRow { table, source, event, target } = self;
        write!(f, "{table}: {source} on {event} to {target}")
    }
}
