//! Zenoh: how packets, hellos and reports go from process to process.
//!
//! All processes are peers: each connects to those of which it learns, and no broker is between
//! them. Keys are `pleach/SESSION/DIGEST/KIND/NODE`, where DIGEST is that of the scenario: processes
//! with another scenario or session do not hear each other. Only hellos are without a digest, so that
//! a process with another scenario is told by name.

#[cfg(test)]
use crate::arguments::Seconds;
use crate::arguments::{NetworkArguments, Session};
use crate::packet::{LONGEST_PACKET, Refusal, Refusals};
use crate::repeats;
use crate::report::LONGEST_REPORT;
use pleach::automaton::network::scenario::Scenario;
use pleach::automaton::node::NodeId;
use pleach::cli::status::Failure;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;
use zenoh::Wait;
use zenoh::liveliness::LivelinessToken;
use zenoh::pubsub::{Publisher, Subscriber};
use zenoh::qos::{CongestionControl, Priority};
use zenoh::sample::{Locality, Sample, SampleKind};

/// The most bytes of a hello: a name has at most a hundred.
const LONGEST_HELLO: usize = 1 << 10;
/// The most that waits to be read.
pub const LONGEST_QUEUE: usize = 1 << 14;

/// How many batches wait for a receiver that is slow.
const QUEUED_BATCHES: u32 = 16;

/// Microseconds after which a packet is dropped for which there is no room.
const BEFORE_DROP: u32 = 20_000;

/// The most bytes that Zenoh puts together to one message.
const LONGEST_MESSAGE: u32 = 1 << 20;

/// What a process says of itself, until it runs and then from time to time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hello {
    /// What people call the node.
    pub name: String,
    /// The name of the scenario.
    pub scenario: String,
    /// Its digest.
    pub digest: String,
    /// When the process was started, in nanoseconds since 1970: another process has another number.
    pub started: u64,
    /// Whether it hears all nodes of the scenario, so that they receive what it sends.
    pub hears_all: bool,
    /// Whether it takes part in the mission, and waits for nobody any more.
    pub is_running: bool,
}

#[cfg(test)]
impl Hello {
    /// The hello of a process that waits for others and has heard nobody.
    pub fn of(name: &str, scenario: &str, digest: &str) -> Self {
        let [name, scenario, digest] = [name, scenario, digest].map(str::to_owned);
        Hello { name, scenario, digest, started: 1, hears_all: false, is_running: false }
    }
}

/// What arrives.
#[derive(Clone, Debug)]
pub enum Arrival {
    /// A packet, not yet read.
    Packet(NodeId, Vec<u8>),
    /// A hello.
    Hello(NodeId, Hello),
    /// A report, not yet read.
    Report(NodeId, Vec<u8>),
    /// The process of a node has come or gone, as Zenoh sees it.
    Alive(NodeId, bool),
    /// Something that is refused at once.
    Refused(Refusal),
}

/// What a process listens to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interest {
    /// What nodes send each other.
    Packets,
    /// What they report to observers.
    Reports,
}

/// The digest of a scenario with all its defaults: FNV-1a of its JSON, 64 bits. It tells scenarios
/// apart, and protects nothing.
pub fn digest(scenario: &Scenario) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string(&scenario.with_defaults())?;
    Ok(format!("{:016x}", repeats::digest(text.as_bytes())))
}

/// The connection of a process to the others.
pub struct Transport {
    session: zenoh::Session,
    keys: Keys,
    arrivals: Receiver<Arrival>,
    overflow: Arc<AtomicU64>,
    _subscribers: Vec<Subscriber<()>>,
    _tokens: Vec<LivelinessToken>,
}

/// What a node sends with.
pub struct Sender {
    packets: Publisher<'static>,
    hellos: Publisher<'static>,
    reports: Publisher<'static>,
}

#[derive(Clone, Debug)]
struct Keys {
    session: String,
    digest: String,
}

impl Keys {
    fn of(&self, kind: &str, node: impl std::fmt::Display) -> String {
        format!("pleach/{}/{}/{kind}/{node}", self.session, self.digest)
    }

    fn hello(&self, node: impl std::fmt::Display) -> String {
        format!("pleach/{}/hello/{node}", self.session)
    }
}

/// The endpoints of a process where the arguments name none.
#[derive(Clone, Copy, Debug)]
pub struct Endpoints<'a> {
    /// Where it listens.
    pub listen: &'a str,
    /// Where it connects to.
    pub connect: Option<&'a str>,
}

impl Transport {
    /// Connects to the session of a scenario with this digest.
    ///
    /// # Errors
    /// Zenoh does not take the configuration, or the port is taken.
    pub fn open(
        arguments: &NetworkArguments,
        defaults: Endpoints<'_>,
        digest: &str,
        interest: Interest,
    ) -> Result<Self, Failure> {
        let Session(session) = &arguments.session;
        let keys = Keys { session: session.clone(), digest: digest.to_owned() };
        let listen = endpoints(&arguments.listen, Some(defaults.listen));
        let failed = |error: zenoh::Error| {
            let remedy = "is another process there? Choose others with --listen and --connect";
            Failure::Usage(format!("cannot listen at {}: {error}; {remedy}", listen.join(", ")))
        };
        let session = zenoh::open(configuration(arguments, defaults, &listen)?).wait();
        let session = session.map_err(failed)?;
        let (sender, arrivals) = sync_channel(LONGEST_QUEUE);
        let overflow = Arc::new(AtomicU64::new(0));
        let listener = Listener { sender, overflow: Arc::clone(&overflow) };
        let mut subscribers = vec![listener.to(&session, keys.hello("*"), Kind::Hello)?];
        match interest {
            Interest::Packets => {
                subscribers.push(listener.to(&session, keys.of("packet", "*"), Kind::Packet)?);
            }
            Interest::Reports => {
                subscribers.push(listener.to(&session, keys.of("report", "*"), Kind::Report)?);
                subscribers.push(listener.to_tokens(&session, keys.of("alive", "*"))?);
            }
        }
        Ok(Transport {
            session,
            keys,
            arrivals,
            overflow,
            _subscribers: subscribers,
            _tokens: Vec::new(),
        })
    }

    /// A process to which these things come, and that is connected to nobody.
    #[cfg(test)]
    pub fn of(arrivals: Receiver<Arrival>) -> Self {
        let arguments = NetworkArguments {
            session: Session("test".into()),
            listen: Vec::new(),
            connect: Vec::new(),
            multicast: false,
            zenoh: None,
            wait: Seconds(Duration::from_secs(1)),
        };
        let alone = Endpoints { listen: "tcp/127.0.0.1:0", connect: None };
        let transport = Transport::open(&arguments, alone, "test", Interest::Packets);
        Transport { arrivals, ..transport.unwrap() }
    }

    /// What a node sends with. Observers see that it is there.
    ///
    /// # Errors
    /// Zenoh does not take a key.
    pub fn sender(&mut self, node: NodeId) -> Result<Sender, Failure> {
        let token = self.session.liveliness().declare_token(self.keys.of("alive", node));
        self._tokens.push(token.wait().map_err(internal)?);
        // A packet that cannot be sent at once is worth nothing later.
        let publisher = |key: String, priority| {
            let publisher = self.session.declare_publisher(key).express(true).priority(priority);
            publisher.congestion_control(CongestionControl::Drop).wait().map_err(internal)
        };
        Ok(Sender {
            packets: publisher(self.keys.of("packet", node), Priority::InteractiveHigh)?,
            hellos: publisher(self.keys.hello(node), Priority::Data)?,
            reports: publisher(self.keys.of("report", node), Priority::Data)?,
        })
    }

    /// The next thing that arrives within a time.
    pub fn next_within(&self, time: Duration) -> Option<Arrival> {
        self.arrivals.recv_timeout(time).ok()
    }

    /// Counts what came in greater number than could be kept.
    pub fn count_overflow(&self, refusals: &mut Refusals) {
        (0..self.overflow.swap(0, Ordering::Relaxed))
            .for_each(|_| refusals.count(Refusal::TooMany));
    }
}

impl Sender {
    /// Sends a packet to all processes.
    pub fn send(&self, packet: Vec<u8>) {
        // A packet that is not sent is a packet lost.
        let _ = self.packets.put(packet).wait();
    }

    /// Says hello.
    pub fn say_hello(&self, hello: &Hello) {
        if let Ok(text) = serde_json::to_vec(hello) {
            let _ = self.hellos.put(text).wait();
        }
    }

    /// Reports to observers.
    pub fn report(&self, report: Vec<u8>) {
        let _ = self.reports.put(report).wait();
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Packet,
    Hello,
    Report,
}

/// Passes on what arrives, and drops what is more than the queue can keep.
struct Listener {
    sender: SyncSender<Arrival>,
    overflow: Arc<AtomicU64>,
}

impl Listener {
    fn to(
        &self,
        session: &zenoh::Session,
        key: String,
        kind: Kind,
    ) -> Result<Subscriber<()>, Failure> {
        let pass_on = self.pass_on();
        let subscriber = session.declare_subscriber(key).allowed_origin(Locality::Remote);
        subscriber.callback(move |sample| pass_on(arrival(&sample, kind))).wait().map_err(internal)
    }

    fn to_tokens(&self, session: &zenoh::Session, key: String) -> Result<Subscriber<()>, Failure> {
        let pass_on = self.pass_on();
        let subscriber = session.liveliness().declare_subscriber(key).history(true);
        let change = move |sample: Sample| {
            pass_on(match sender_of(&sample) {
                Some(node) => Arrival::Alive(node, sample.kind() == SampleKind::Put),
                None => Arrival::Refused(Refusal::NoSuchNode),
            });
        };
        subscriber.callback(change).wait().map_err(internal)
    }

    fn pass_on(&self) -> impl Fn(Arrival) + Send + Sync + 'static {
        let (sender, overflow) = (self.sender.clone(), Arc::clone(&self.overflow));
        move |arrival| {
            if sender.try_send(arrival).is_err() {
                overflow.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}

/// The number at the end of a key.
fn sender_of(sample: &Sample) -> Option<NodeId> {
    sample.key_expr().as_str().rsplit('/').next()?.parse().ok()
}

fn arrival(sample: &Sample, kind: Kind) -> Arrival {
    let Some(from) = sender_of(sample) else { return Arrival::Refused(Refusal::NoSuchNode) };
    let longest = match kind {
        Kind::Packet => LONGEST_PACKET,
        Kind::Report => LONGEST_REPORT,
        Kind::Hello => LONGEST_HELLO,
    };
    if sample.payload().len() > longest {
        return Arrival::Refused(Refusal::TooLong);
    }
    let bytes = sample.payload().to_bytes();
    match kind {
        Kind::Packet => Arrival::Packet(from, bytes.into_owned()),
        Kind::Report => Arrival::Report(from, bytes.into_owned()),
        Kind::Hello => serde_json::from_slice(&bytes)
            .map_or(Arrival::Refused(Refusal::Malformed), |hello| Arrival::Hello(from, hello)),
    }
}

fn internal(error: zenoh::Error) -> Failure {
    Failure::Internal(format!("Zenoh: {error}"))
}

fn endpoints(named: &[String], default: Option<&str>) -> Vec<String> {
    if named.is_empty() { default.into_iter().map(str::to_owned).collect() } else { named.to_vec() }
}

fn configuration(
    arguments: &NetworkArguments,
    defaults: Endpoints<'_>,
    listen: &[String],
) -> Result<zenoh::Config, Failure> {
    let mut config = match &arguments.zenoh {
        None => zenoh::Config::default(),
        Some(path) => zenoh::Config::from_file(path).map_err(|error| {
            Failure::Usage(format!("{}: no configuration of Zenoh: {error}", path.display()))
        })?,
    };
    let connect = endpoints(&arguments.connect, defaults.connect);
    let mut set = |key: &str, value: serde_json::Value| {
        let set = config.insert_json5(key, &value.to_string());
        set.map_err(|error| Failure::Usage(format!("Zenoh does not take {key} = {value}: {error}")))
    };
    set("mode", "peer".into())?;
    // What the file says of endpoints holds where the arguments say nothing.
    if arguments.zenoh.is_none() || !arguments.listen.is_empty() {
        set("listen/endpoints", listen.into())?;
    }
    if arguments.zenoh.is_none() || !arguments.connect.is_empty() {
        set("connect/endpoints", connect.into())?;
    }
    if arguments.zenoh.is_none() || arguments.multicast {
        set("scouting/multicast/enabled", arguments.multicast.into())?;
    }
    set("scouting/gossip/enabled", true.into())?;
    // A packet is dropped when a receiver takes nothing for a while, not when it is not scheduled in
    // time.
    let queue = "transport/link/tx/queue";
    for priority in ["interactive_high", "data"] {
        set(&format!("{queue}/size/{priority}"), QUEUED_BATCHES.into())?;
    }
    set(&format!("{queue}/congestion_control/drop/wait_before_drop"), BEFORE_DROP.into())?;
    // Processes are started in any order.
    set(
        "connect/retry",
        json!({"period_init_ms": 100, "period_max_ms": 500, "period_increase_factor": 2}),
    )?;
    set("transport/link/rx/max_message_size", LONGEST_MESSAGE.into())?;
    Ok(config)
}
