//! The arguments of the commands for processes.

use clap::{Args, Subcommand};
use pleach::cli::faults::{Share, Stop};
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

/// Where the access points of a scenario listen unless told otherwise, and where the others look for
/// them.
pub const MEETING_POINT: &str = "tcp/127.0.0.1:7447";

/// The commands for processes.
#[derive(Debug, Subcommand)]
pub enum ProcessCommand {
    /// Run one robot of a scenario as a process
    ///
    /// It waits for the other nodes of the scenario, and takes part in the mission until it is over.
    /// One that is started while the mission goes on joins it. Exit status: 0 when the mission is
    /// over, 1 if the program failed, 2 if the scenario or the arguments are wrong or nobody is
    /// heard, 3 after Ctrl-C or SIGTERM.
    Robot(RobotArguments),
    /// Run the access points of a scenario, or one of them, as a process
    ///
    /// The user, who asks for the tasks of the scenario, is in the process of the first access
    /// point.
    AccessPoint(AccessPointArguments),
    /// Show a mission of processes: progress, summary, trace and figures from what they report
    ///
    /// It is started before the robots: what it reads is judged from the first control period on.
    /// The exit status is that of `pleach run`.
    Watch(WatchArguments),
    /// Run a mission with every node as a process on this machine
    ///
    /// Starts access points and robots, watches them, and ends them with the mission. The exit
    /// status is that of `pleach run`.
    Launch(LaunchArguments),
}

/// How a process reaches the others.
#[derive(Clone, Debug, Args)]
pub struct NetworkArguments {
    /// The name of the session: processes of other sessions are not received
    #[arg(long, value_name = "NAME", default_value = "pleach")]
    pub session: Session,
    /// Listen at this endpoint of Zenoh, such as tcp/0.0.0.0:7447 [default: tcp/127.0.0.1:7447 for
    /// access points, any free port of 127.0.0.1 for others]
    #[arg(long, value_name = "ENDPOINT")]
    pub listen: Vec<String>,
    /// Connect to this endpoint, from which the others become known [default: none for access points,
    /// tcp/127.0.0.1:7447 for others]
    #[arg(long, value_name = "ENDPOINT")]
    pub connect: Vec<String>,
    /// Find other processes by multicast, too
    #[arg(long)]
    pub multicast: bool,
    /// A configuration file of Zenoh (JSON5), for TLS and access control; --listen and --connect go
    /// before what it says
    #[arg(long, value_name = "FILE")]
    pub zenoh: Option<PathBuf>,
    /// Seconds after which a process that receives no other gives up
    #[arg(long, value_name = "SECONDS", default_value = "20")]
    pub wait: Seconds,
}

/// How a process takes part in control periods.
#[derive(Clone, Debug, Args)]
pub struct NodeArguments {
    /// Seconds after which a round goes on without the nodes that have not sent their packet
    #[arg(long, value_name = "SECONDS", default_value = "1")]
    pub limit: Seconds,
    /// The probability that a message over the radio is lost, for tests
    #[arg(long, value_name = "SHARE", default_value = "0")]
    pub loss: Share,
    /// The seed of the losses
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Let control periods take the time that the scenario says, and not less
    #[arg(long)]
    pub real_time: bool,
}

/// The arguments of `pleach robot`.
#[derive(Clone, Debug, Args)]
pub struct RobotArguments {
    /// The scenario: a TOML file, the same for all processes
    pub scenario: PathBuf,
    /// Which robot, from 0
    #[arg(long, value_name = "NUMBER")]
    pub id: usize,
    /// Where the robot writes down its position; if the file is there, it begins at that place
    #[arg(long, value_name = "FILE")]
    pub state: Option<PathBuf>,
    /// How it reaches the others.
    #[command(flatten)]
    pub network: NetworkArguments,
    /// How it takes part.
    #[command(flatten)]
    pub node: NodeArguments,
}

/// The arguments of `pleach access-point`.
#[derive(Clone, Debug, Args)]
pub struct AccessPointArguments {
    /// The scenario: a TOML file, the same for all processes
    pub scenario: PathBuf,
    /// Which access point, from 0 [default: all of them]
    #[arg(long, value_name = "NUMBER")]
    pub id: Option<usize>,
    /// How it reaches the others.
    #[command(flatten)]
    pub network: NetworkArguments,
    /// How it takes part.
    #[command(flatten)]
    pub node: NodeArguments,
}

/// What is written of a mission.
#[derive(Clone, Debug, Args)]
pub struct OutputArguments {
    /// Write what happens to FILE, one JSON object per line
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Write figures (SVG) into FOLDER [default: figures/<name of the scenario>]
    #[arg(long, value_name = "FOLDER", conflicts_with = "no_figures")]
    pub figures: Option<PathBuf>,
    /// Write no figures
    #[arg(long)]
    pub no_figures: bool,
    /// Show no progress, only the summary
    #[arg(long, short)]
    pub quiet: bool,
}

/// The arguments of `pleach watch`.
#[derive(Clone, Debug, Args)]
pub struct WatchArguments {
    /// The scenario: a TOML file, the same for all processes
    pub scenario: PathBuf,
    /// Messages are lost or processes killed: check only what must hold under any fault
    #[arg(long)]
    pub faults: bool,
    /// What it writes.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// How it reaches the others.
    #[command(flatten)]
    pub network: NetworkArguments,
}

/// The arguments of `pleach launch`.
#[derive(Clone, Debug, Args)]
pub struct LaunchArguments {
    /// The scenario, a TOML file
    pub scenario: PathBuf,
    /// What is written of the mission.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// How the processes take part.
    #[command(flatten)]
    pub node: NodeArguments,
    /// Kill the process of a robot (SIGKILL) in control period FROM, and start it again in period TO:
    /// ROBOT@FROM..TO, or ROBOT@FROM for good
    #[arg(long, value_name = "ROBOT@FROM..TO")]
    pub kill: Vec<Stop>,
}

/// A name of a session: one part of a key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Session(pub String);

impl FromStr for Session {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "-_.".contains(letter);
        if !text.is_empty() && text.chars().all(is_plain) {
            Ok(Session(text.into()))
        } else {
            Err("a session is named with letters, digits, '-', '_' and '.'".into())
        }
    }
}

/// A time in seconds, above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seconds(pub Duration);

impl FromStr for Seconds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds = text.parse().ok().filter(|seconds| (1e-3..1e6).contains(seconds));
        let seconds = seconds.ok_or("write seconds from 0.001 to 1000000, such as 0.5")?;
        Ok(Seconds(Duration::from_secs_f64(seconds)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_is_one_part_of_a_key() {
        assert!("hall-2.a".parse::<Session>().is_ok());
        for wrong in ["", "a/b", "*", "a b", "$*", "#"] {
            assert!(wrong.parse::<Session>().is_err(), "{wrong}");
        }
    }
}
