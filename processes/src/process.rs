//! A process with its nodes: it waits for the others, takes part in one control period after another,
//! and ends with the mission.

use crate::arguments::{AccessPointArguments, MEETING_POINT, NodeArguments, RobotArguments};
use crate::local_nodes::LocalNodes;
use crate::lockstep::{Lockstep, after};
use crate::memory::Memory;
use crate::packet::{LONGEST_PACKET, Packet, Refusals, Stamp};
use crate::receiver::Receiver;
use crate::report::{Report, Tally};
use crate::strangers::Strangers;
use crate::transport::{
    Arrival, Endpoints, Hello, Interest, LONGEST_QUEUE, Sender, Transport, digest,
};
use pleach::automaton::network::record::MissionEvent;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::node::NodeId;
use pleach::cli::interrupt::Interrupt;
use pleach::cli::output::tell;
use pleach::cli::status::{Failure, Status};
use pleach::continuous::Point;
use pleach::scenario_file;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// How often a process says hello until it runs, and afterwards.
const HELLO_WHILE_WAITING: Duration = Duration::from_millis(100);
const HELLO_WHILE_RUNNING: Duration = Duration::from_secs(1);
/// How soon a process sees that it is to end.
const GLANCE: Duration = Duration::from_millis(100);
/// More exchanges in one control period are taken for endless.
const MOST_EXCHANGES: usize = 100_000;

/// The scenario in a file, of which all robots are one team.
///
/// # Errors
/// No mission can start from it, or each of its access points has a team of its own.
pub fn scenario_in(path: &Path) -> Result<ValidScenario, Failure> {
    let scenario = scenario_file::read(path)?;
    if scenario.fleets().is_empty() {
        return Ok(scenario);
    }
    let what = "control.teams is \"per_access_point\", and processes run missions of one team: leave it out, or give \
        the team of each access point a scenario of its own";
    Err(Failure::Usage(format!("{}: {what}", path.display())))
}

/// Runs a robot.
///
/// # Errors
/// What keeps it from taking part.
pub fn run_robot(arguments: &RobotArguments) -> Result<Status, Failure> {
    let scenario = scenario_in(&arguments.scenario)?;
    let id = arguments.id;
    let count = scenario.robot.len();
    if id >= count {
        return Err(Failure::Usage(no_such("robot", id, count, &arguments.scenario)));
    }
    let digest = digest_of(&scenario)?;
    let start = scenario.robot[id].position;
    let memory = arguments.state.as_deref();
    let memory = memory.map(|path| Memory::open(path, &digest, id, start)).transpose()?;
    let place = memory.as_ref().map_or(start, Memory::position);
    let nodes = LocalNodes::robot(&scenario, id, place.into());
    let defaults = Endpoints { listen: "tcp/127.0.0.1:0", connect: Some(MEETING_POINT) };
    let transport = Transport::open(&arguments.network, defaults, &digest, Interest::Packets)?;
    let parts = Parts { nodes, memory, transport, digest, wait: arguments.network.wait.0 };
    Process::new(&scenario, parts, &arguments.node)?.run()
}

/// Runs the access points of a scenario, or one of them.
///
/// # Errors
/// What keeps them from taking part.
pub fn run_access_point(arguments: &AccessPointArguments) -> Result<Status, Failure> {
    let scenario = scenario_in(&arguments.scenario)?;
    let count = scenario.access_point.len();
    let numbers = match arguments.id {
        None => 0..count,
        Some(id) if id < count => id..id + 1,
        Some(id) => {
            return Err(Failure::Usage(no_such("access point", id, count, &arguments.scenario)));
        }
    };
    let digest = digest_of(&scenario)?;
    let nodes = LocalNodes::access_points(&scenario, numbers).map_err(internal)?;
    let defaults = match arguments.id {
        None | Some(0) => Endpoints { listen: MEETING_POINT, connect: None },
        _ => Endpoints { listen: "tcp/127.0.0.1:0", connect: Some(MEETING_POINT) },
    };
    let transport = Transport::open(&arguments.network, defaults, &digest, Interest::Packets)?;
    let parts = Parts { nodes, memory: None, transport, digest, wait: arguments.network.wait.0 };
    Process::new(&scenario, parts, &arguments.node)?.run()
}

fn no_such(kind: &str, id: usize, count: usize, scenario: &Path) -> String {
    let last = count.saturating_sub(1);
    format!("{}: there is no {kind} {id}: --id goes from 0 to {last}", scenario.display())
}

/// The digest of a scenario.
///
/// # Errors
/// Never with a scenario that is valid.
pub fn digest_of(scenario: &ValidScenario) -> Result<String, Failure> {
    digest(scenario).map_err(internal)
}

fn internal(error: impl Display) -> Failure {
    Failure::Internal(error.to_string())
}

/// A node as messages for people call it.
pub fn name_of(scenario: &ValidScenario, node: NodeId) -> String {
    let (robots, access_points) = (scenario.robot.len(), scenario.access_point.len());
    match node.checked_sub(robots) {
        None => format!("robot {node}"),
        Some(number) if number < access_points => format!("access point {number}"),
        Some(_) => "the user".into(),
    }
}

/// What a process is made of.
struct Parts {
    nodes: LocalNodes,
    memory: Option<Memory>,
    transport: Transport,
    digest: String,
    wait: Duration,
}

struct Process<'a> {
    scenario: &'a ValidScenario,
    parts: Parts,
    options: &'a NodeArguments,
    ids: Vec<NodeId>,
    senders: Vec<Sender>,
    lockstep: Lockstep,
    receiver: Receiver,
    refusals: Refusals,
    given_up: u64,
    /// What was sent.
    sent: Tally,
    started: u64,
    hears_all: bool,
    is_running: bool,
    last_hello: Option<Instant>,
    strangers: Strangers<'a>,
    events: Vec<Vec<(u32, u32, MissionEvent)>>,
    interrupt: Interrupt,
}

/// How a control period ends for a process.
enum Period {
    /// The next one follows.
    Over,
    /// All nodes know that the mission is over.
    Last,
    /// A signal has come.
    Interrupted,
}

impl<'a> Process<'a> {
    fn new(
        scenario: &'a ValidScenario,
        mut parts: Parts,
        options: &'a NodeArguments,
    ) -> Result<Self, Failure> {
        let ids = parts.nodes.ids();
        let senders = ids.iter().map(|&id| parts.transport.sender(id));
        let senders = senders.collect::<Result<Vec<_>, _>>()?;
        let site = scenario.site();
        let starts = scenario.robot.iter().map(|robot| Point::from(robot.position));
        let user = site.access_points.first().copied();
        let bodies = starts.chain(site.access_points.iter().copied()).chain(user).collect();
        let seed = options.seed.rotate_left(32) ^ ids.first().map_or(0, |id| *id as u64 + 1);
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Ok(Process {
            scenario,
            options,
            senders,
            lockstep: Lockstep::new(ids.iter().copied()),
            receiver: Receiver::new(site, bodies, options.loss.0, seed),
            refusals: Refusals::default(),
            given_up: 0,
            sent: Tally::default(),
            started: since.map_or(0, |since| since.as_nanos() as u64),
            hears_all: false,
            is_running: false,
            last_hello: None,
            strangers: Strangers::to(scenario, &parts.digest),
            events: vec![Vec::new(); ids.len()],
            interrupt: Interrupt::listen()?,
            ids,
            parts,
        })
    }

    fn run(mut self) -> Result<Status, Failure> {
        let Some(mut period) = self.wait_for_others()? else { return Ok(Status::Unserviced) };
        self.is_running = true;
        let status = loop {
            let begin = Instant::now();
            let part = self.take_part_in(period);
            match part.map_err(|failure| self.located(failure, period))? {
                Period::Over => {}
                Period::Last => break Status::Done,
                Period::Interrupted => break Status::Unserviced,
            }
            let moved = self.move_on(begin);
            moved.map_err(|failure| self.located(failure, period))?;
            period += 1;
            if period as usize >= self.scenario.site().settings.max_steps {
                break Status::Done;
            }
        };
        self.parts.transport.count_overflow(&mut self.refusals);
        if self.refusals.total() > 0 {
            tell(format_args!("{}: {}", self.own_name(), self.refusals));
        }
        Ok(status)
    }

    /// The same failure with its node and its control period.
    fn located(&self, failure: Failure, period: u32) -> Failure {
        match failure {
            Failure::Internal(what) => {
                internal(format!("{} at k = {period}: {what}", self.own_name()))
            }
            other => other,
        }
    }

    fn own_name(&self) -> String {
        let first = self.ids.first().copied().unwrap_or_default();
        name_of(self.scenario, first)
    }

    // ---- Before it runs ----------------------------------------------------------------------

    /// Waits until all nodes of the scenario are there, or the mission is seen to go on, and then for its
    /// next control period. Says which control period is the first; none after a signal.
    fn wait_for_others(&mut self) -> Result<Option<u32>, Failure> {
        let mut deadline = Instant::now() + self.parts.wait;
        let count = self.scenario.robot.len() + self.scenario.access_point.len() + 1;
        let own = || self.ids.iter().copied();
        // The nodes that are heard, and those that say that they hear all others.
        let (mut heard, mut ready): (BTreeSet<NodeId>, BTreeSet<NodeId>) =
            (own().collect(), own().collect());
        loop {
            if self.interrupt.signal().is_some() {
                return Ok(None);
            }
            self.say_hello();
            if let Some(arrival) = self.parts.transport.next_within(HELLO_WHILE_WAITING / 4) {
                if let Arrival::Hello(from, hello) = &arrival
                    && !hello.is_running
                    && hello.digest == self.parts.digest
                    && *from < count
                {
                    heard.insert(*from);
                    ready.extend(hello.hears_all.then_some(*from));
                    self.lockstep.expect(*from);
                }
                let latest = self.lockstep.latest();
                self.take(arrival)?;
                if self.lockstep.latest() > latest {
                    deadline = Instant::now() + self.parts.wait;
                }
            }
            if let Some(period) = self.first_period() {
                return Ok(Some(period));
            }
            let is_late = Instant::now() >= deadline;
            let goes_on = self.lockstep.earliest().is_some();
            self.hears_all = heard.len() == count;
            if !goes_on && (ready.len() == count || is_late && heard.len() > self.ids.len()) {
                self.last_hello = None;
                self.say_hello();
                return Ok(Some(0));
            }
            if is_late {
                let what = self.lockstep.latest().map(|latest| self.mission_stands_still(latest));
                return Err(Failure::Usage(what.unwrap_or_else(|| self.nobody_is_heard())));
            }
        }
    }

    /// The control period in which a process can begin that has heard packets: the next one, if the
    /// mission goes on already.
    fn first_period(&self) -> Option<u32> {
        let earliest = self.lockstep.earliest()?;
        let first = Stamp { period: 0, round: 1, answer: 0 };
        if earliest == first { Some(0) } else { self.lockstep.later_period(earliest.period) }
    }

    /// What is said where a mission is heard, but no next control period of it.
    fn mission_stands_still(&self, latest: Stamp) -> String {
        let (own, seconds) = (self.own_name(), self.parts.wait.as_secs_f64());
        let Stamp { period, round, .. } = latest;
        format!(
            "{own} has received the mission in round {round} of k = {period}, and nothing later for \
             {seconds} s, so that it cannot join with the next control period: is the mission over? If \
             a control period takes longer, wait for it with --wait"
        )
    }

    fn nobody_is_heard(&self) -> String {
        let (own, seconds) = (self.own_name(), self.parts.wait.as_secs_f64());
        match (self.strangers.count(), &self.scenario.name) {
            (0, _) => format!(
                "{own} has received no other node within {seconds} s: are they started, with the same \
                 --session, and does --connect name an endpoint at which one listens?"
            ),
            (others, name) => format!(
                "{own} has received no other node with the scenario {name:?} within {seconds} s, and \
                 {others} with another one"
            ),
        }
    }

    fn say_hello(&mut self) {
        let pause = if self.is_running { HELLO_WHILE_RUNNING } else { HELLO_WHILE_WAITING };
        if self.last_hello.is_some_and(|last| last.elapsed() < pause) {
            return;
        }
        self.last_hello = Some(Instant::now());
        for (id, sender) in self.ids.iter().zip(&self.senders) {
            sender.say_hello(&Hello {
                name: name_of(self.scenario, *id),
                scenario: self.scenario.name.clone(),
                digest: self.parts.digest.clone(),
                started: self.started,
                hears_all: self.hears_all,
                is_running: self.is_running,
            });
        }
    }

    // ---- What arrives ------------------------------------------------------------------------

    fn take(&mut self, arrival: Arrival) -> Result<(), Failure> {
        let count = self.scenario.robot.len() + self.scenario.access_point.len() + 1;
        let taken = match arrival {
            Arrival::Packet(from, _) | Arrival::Hello(from, _) if from >= count => {
                Err(crate::packet::Refusal::NoSuchNode)
            }
            Arrival::Packet(from, bytes) => match Packet::decode(&bytes, count) {
                Ok(_) if self.ids.contains(&from) && !self.is_running => {
                    return Err(self.runs_already(from));
                }
                packet => packet.and_then(|packet| self.lockstep.receive(from, packet)),
            },
            Arrival::Hello(from, hello) => return self.take_hello(from, hello),
            Arrival::Refused(refusal) => Err(refusal),
            Arrival::Report(..) | Arrival::Alive(..) => Ok(()),
        };
        if let Err(refusal) = taken {
            self.refusals.count(refusal);
        }
        Ok(())
    }

    fn take_hello(&mut self, from: NodeId, hello: Hello) -> Result<(), Failure> {
        let is_stranger = self.strangers.recognise(from, &hello);
        if !is_stranger && self.ids.contains(&from) && hello.started != self.started {
            // Of two processes that wait, the one that was started later gives way.
            if !self.is_running && (hello.is_running || hello.started < self.started) {
                return Err(self.runs_already(from));
            }
        }
        Ok(())
    }

    fn runs_already(&self, node: NodeId) -> Failure {
        let name = name_of(self.scenario, node);
        let remedy = "end that process, or choose another --session or --id";
        Failure::Usage(format!("{name} of this session has a process already: {remedy}"))
    }

    // ---- A control period --------------------------------------------------------------------

    fn take_part_in(&mut self, period: u32) -> Result<Period, Failure> {
        self.parts.nodes.begin_period();
        self.events.iter_mut().for_each(Vec::clear);
        let mut stamp = Stamp { period, round: 1, answer: 0 };
        let mut heard = Vec::new();
        for _ in 0..MOST_EXCHANGES {
            self.say_hello();
            self.lockstep.go_on_to(stamp);
            self.parts.nodes.hear(&heard).map_err(internal)?;
            if stamp.answer == 0 {
                self.parts.nodes.tick(stamp.round).map_err(internal)?;
            }
            let mut packets = self.send(stamp)?;
            if !self.wait_for_packets(stamp)? {
                return Ok(Period::Interrupted);
            }
            packets.extend(self.lockstep.take());
            packets.sort_by_key(|(from, _)| *from);
            let Some(next) = after(stamp, &packets) else {
                self.report(period)?;
                let is_last = packets.iter().all(|(_, packet)| packet.is_over);
                return Ok(if is_last { Period::Last } else { Period::Over });
            };
            heard = self.receiver.messages(&self.ids, &packets, &mut self.refusals);
            stamp = next;
        }
        Err(internal(format!(
            "control period {period} has not ended in {MOST_EXCHANGES} exchanges"
        )))
    }

    /// Sends the packets of a round, which are returned.
    fn send(&mut self, stamp: Stamp) -> Result<Vec<(NodeId, Packet)>, Failure> {
        let mut packets = Vec::new();
        let nodes = self.parts.nodes.nodes_mut().iter_mut();
        for ((node, sender), events) in nodes.zip(&self.senders).zip(&mut self.events) {
            let told = node.events().into_iter();
            events.extend(told.map(|event| (stamp.round, stamp.answer, event)));
            let (letters, asks) = node.letters().map_err(internal)?;
            let packet = Packet {
                stamp,
                next: node.next_after(stamp.round),
                asks,
                is_over: node.is_over(),
                position: node.body().into(),
                letters,
            };
            let bytes = packet.encode().map_err(internal)?;
            if bytes.len() > LONGEST_PACKET {
                let length = bytes.len();
                return Err(internal(format!(
                    "a packet has {length} bytes, more than {LONGEST_PACKET}"
                )));
            }
            self.sent.packets += 1;
            self.sent.messages += packet.letters.len() as u64;
            self.sent.bytes += bytes.len() as u64;
            sender.send(bytes);
            packets.push((node.id, packet));
        }
        Ok(packets)
    }

    /// Waits until the packets of all others have come, or the time limit has passed. Says whether the
    /// process goes on.
    fn wait_for_packets(&mut self, stamp: Stamp) -> Result<bool, Failure> {
        let deadline = Instant::now() + self.options.limit.0;
        // One that is alone takes as long as it would wait for others: they may come back, and could not follow.
        while (self.is_round_open() || self.lockstep.is_alone())
            && self.interrupt.signal().is_none()
        {
            self.say_hello();
            let rest = deadline.saturating_duration_since(Instant::now());
            if rest.is_zero() {
                self.read_what_has_come()?;
                self.go_on_without_the_missing(stamp);
                break;
            } else if let Some(arrival) = self.parts.transport.next_within(rest.min(GLANCE)) {
                self.take(arrival)?;
            }
        }
        Ok(self.interrupt.signal().is_none())
    }

    /// Whether packets of this round are missing, and others have not gone on without this process.
    fn is_round_open(&self) -> bool {
        self.lockstep.missing().next().is_some() && !self.lockstep.is_overtaken()
    }

    /// Reads what waits to be read: a process that was held up finds the packets of others there. More
    /// may come all the time, and is left for later.
    fn read_what_has_come(&mut self) -> Result<(), Failure> {
        for _ in 0..LONGEST_QUEUE {
            match self.parts.transport.next_within(Duration::ZERO) {
                Some(arrival) => self.take(arrival)?,
                None => break,
            }
        }
        Ok(())
    }

    /// Gives up the nodes whose packet has not come, unless others have gone on without this process.
    fn go_on_without_the_missing(&mut self, stamp: Stamp) {
        if !self.is_round_open() {
            return;
        }
        for node in self.lockstep.give_up() {
            self.given_up += 1;
            let (own, other) = (self.own_name(), name_of(self.scenario, node));
            let period = stamp.period;
            tell(format_args!("k = {period:<6} {own} goes on without {other}"));
        }
    }

    fn report(&mut self, period: u32) -> Result<(), Failure> {
        self.parts.transport.count_overflow(&mut self.refusals);
        let tally = Tally {
            refused: self.refusals.total(),
            late: self.lockstep.late(),
            lost: self.receiver.lost(),
            unknown: self.receiver.unknown(),
            given_up: self.given_up,
            ..self.sent
        };
        let nodes = self.parts.nodes.nodes_mut().iter().zip(&self.senders).zip(&mut self.events);
        for ((node, sender), events) in nodes {
            let report = Report {
                step: period as usize,
                robot: node.robot_report(),
                events: std::mem::take(events),
                end: node.known_end().map(Into::into),
                tally,
            };
            sender.report(serde_json::to_vec(&report).map_err(internal)?);
        }
        Ok(())
    }

    /// The robots move until the next control period begins.
    fn move_on(&mut self, begin: Instant) -> Result<(), Failure> {
        let duration = self.parts.nodes.flow().map_err(internal)?;
        if let (Some(memory), Some(node)) =
            (&mut self.parts.memory, self.parts.nodes.nodes_mut().first())
        {
            memory.write(node.body().into())?;
        }
        if self.options.real_time {
            self.rest_until(begin + Duration::from_secs_f64(duration));
        }
        Ok(())
    }

    /// Rests until then, or until a signal comes. Others may look for this process the while.
    fn rest_until(&mut self, end: Instant) {
        while self.interrupt.signal().is_none() {
            self.say_hello();
            match end.saturating_duration_since(Instant::now()) {
                Duration::ZERO => break,
                rest => thread::sleep(rest.min(GLANCE)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arguments::Seconds;
    use crate::packet::Letter;
    use pleach::cli::faults::Share;
    use std::sync::mpsc::{SyncSender, sync_channel};

    fn scenario() -> ValidScenario {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/too-few.toml");
        scenario_file::read(&path).unwrap()
    }

    const OPTIONS: NodeArguments = NodeArguments {
        limit: Seconds(Duration::from_millis(100)),
        loss: Share(0.0),
        seed: 1,
        real_time: false,
    };

    /// The process of robot 0, which waits half a second, and what sends to it.
    fn robot(scenario: &ValidScenario) -> (Process<'_>, SyncSender<Arrival>) {
        let (sender, arrivals) = sync_channel(LONGEST_QUEUE);
        let parts = Parts {
            nodes: LocalNodes::robot(scenario, 0, scenario.robot[0].position.into()),
            memory: None,
            transport: Transport::of(arrivals),
            digest: "abc".into(),
            wait: Duration::from_millis(500),
        };
        (Process::new(scenario, parts, &OPTIONS).unwrap(), sender)
    }

    fn packet(period: u32, round: u32) -> Arrival {
        packet_with(1, period, round, Vec::new())
    }

    fn packet_with(from: NodeId, period: u32, round: u32, letters: Vec<Letter>) -> Arrival {
        let packet = Packet {
            stamp: Stamp { period, round, answer: 0 },
            next: None,
            asks: false,
            is_over: false,
            position: [0.3, 0.2],
            letters,
        };
        Arrival::Packet(from, packet.encode().unwrap())
    }

    #[test]
    fn who_joins_a_mission_waits_for_its_next_control_period() {
        let scenario = scenario();
        let (mut robot, sender) = robot(&scenario);
        // The rounds of this period take longer than a process waits that hears nothing.
        let mission = thread::spawn(move || {
            for round in 3..10 {
                thread::sleep(Duration::from_millis(100));
                sender.send(packet(4, round)).unwrap();
            }
            sender.send(packet(5, 1)).unwrap();
            sender
        });
        assert_eq!(robot.wait_for_others().unwrap(), Some(5));
        mission.join().unwrap();
    }

    #[test]
    fn a_mission_that_stands_still_is_not_joined() {
        let scenario = scenario();
        let (mut robot, sender) = robot(&scenario);
        sender.send(packet(4, 3)).unwrap();
        let said = robot.wait_for_others().unwrap_err().to_string();
        let begin =
            "robot 0 has received the mission in round 3 of k = 4, and nothing later for 0.5 s";
        assert!(said.starts_with(begin), "{said}");
    }

    const ROUND: Stamp = Stamp { period: 3, round: 1, answer: 0 };

    #[test]
    fn a_round_ends_although_others_send_without_end() {
        let scenario = scenario();
        let (mut robot, sender) = robot(&scenario);
        robot.lockstep.expect(1);
        robot.lockstep.go_on_to(ROUND);
        // Such a packet takes longer to read than to send.
        let letter = Letter { to: None, message: vec![0; 9], beacon: None };
        let Arrival::Packet(_, bytes) = packet_with(2, 4, 1, vec![letter; 100]) else { return };
        let flood = thread::spawn(move || {
            let end = Instant::now() + Duration::from_secs(5);
            while Instant::now() < end && sender.send(Arrival::Packet(2, bytes.clone())).is_ok() {}
        });
        assert!(robot.wait_for_packets(ROUND).unwrap());
        assert!(!flood.is_finished(), "it waits no longer than the limit");
        assert_eq!(robot.given_up, 1);
    }

    #[test]
    fn who_was_held_up_reads_what_has_come_before_it_gives_others_up() {
        let scenario = scenario();
        let (mut robot, sender) = robot(&scenario);
        let options = NodeArguments { limit: Seconds(Duration::ZERO), ..OPTIONS };
        robot.options = &options;
        robot.lockstep.expect(1);
        robot.lockstep.go_on_to(ROUND);
        sender.send(packet(3, 1)).unwrap();
        assert!(robot.wait_for_packets(ROUND).unwrap());
        assert_eq!((robot.given_up, robot.lockstep.expected()), (0, 1));
    }

    #[test]
    fn hello_is_said_every_second_also_in_a_long_control_period() {
        let scenario = scenario();
        let (mut robot, _sender) = robot(&scenario);
        robot.is_running = true;
        let (almost_due, wait) = (HELLO_WHILE_RUNNING - GLANCE, 3 * GLANCE);
        // While it rests until the next control period begins.
        let earlier = Instant::now() - almost_due;
        robot.last_hello = Some(earlier);
        robot.rest_until(Instant::now() + wait);
        assert!(robot.last_hello > Some(earlier));
        // While it waits for packets.
        let earlier = Instant::now() - almost_due;
        robot.last_hello = Some(earlier);
        let options = NodeArguments { limit: Seconds(wait), ..OPTIONS };
        robot.options = &options;
        robot.lockstep.expect(1);
        robot.lockstep.go_on_to(ROUND);
        assert!(robot.wait_for_packets(ROUND).unwrap());
        assert!(robot.last_hello > Some(earlier));
    }
}
