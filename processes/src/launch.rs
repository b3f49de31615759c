//! `pleach launch`: a mission with every node as a process on this machine.

use crate::arguments::{LaunchArguments, NetworkArguments, NodeArguments, Seconds, Session};
use crate::memory::Memory;
use crate::process::digest_of;
use crate::transport::{Endpoints, Interest, Transport};
use crate::watch::{Viewing, planned, show};
use pleach::automaton::network::record::Faults;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::cli::faults::{Stop, check_robots};
use pleach::cli::output::tell;
use pleach::cli::plan::Planned;
use pleach::cli::status::{Failure, Status};
use pleach::continuous::Point;
use std::fs;
use std::io::ErrorKind;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// How long a launched process, and who watches it, waits for the others.
const WAIT: Duration = Duration::from_secs(60);
/// How many names are tried for the folder of a launch.
const MOST_NAMES: usize = 1 << 10;

/// Launches a mission.
///
/// # Errors
/// What keeps it from being launched.
pub fn run(arguments: &LaunchArguments) -> Result<Status, Failure> {
    let is_killed = !arguments.kill.is_empty();
    // Where messages fail, a process may also be slow: whose report comes late counts as absent.
    let fails = is_killed || arguments.node.loss.0 > 0.0;
    let faults = Faults { messages: fails, nodes: fails };
    let planned = Planned { faults, ..planned(&arguments.scenario)? };
    check_robots("--kill", &arguments.kill, &planned.scenario)?;
    let robots = planned.scenario.robot.len();
    let digest = digest_of(&planned.scenario)?;
    let session = format!("launch-{}", std::process::id());
    // Robots and access points learn of each other from the observer. Packets do not go through it.
    let meeting_point = format!("tcp/127.0.0.1:{}", free_port()?);
    let network = NetworkArguments {
        session: Session(session.clone()),
        listen: vec![meeting_point.clone()],
        connect: Vec::new(),
        multicast: false,
        zenoh: None,
        wait: Seconds(WAIT),
    };
    let defaults = Endpoints { listen: &meeting_point, connect: None };
    let transport = Transport::open(&network, defaults, &digest, Interest::Reports)?;
    let folder = Folder::new(&session)?;
    let mut fleet = Fleet {
        program: std::env::current_exe()?,
        scenario: arguments.scenario.clone(),
        session,
        meeting_point,
        options: arguments.node.clone(),
        folder,
        access_points: None,
        robots: Vec::new(),
    };
    fleet.start(robots)?;
    let mut kills = arguments.kill.clone();
    let mut returns = Vec::new();
    let viewing = Viewing { outputs: &arguments.outputs, wait: WAIT };
    show(&planned, viewing, &transport, &mut |step| {
        fleet.check()?;
        let mut bodies = Vec::new();
        for Stop { robot, to, .. } in kills.extract_if(.., |kill| kill.from <= step) {
            bodies.push((robot, fleet.kill(robot, &planned.scenario)?));
            returns.extend(to.map(|to| (to, robot)));
        }
        for (_, robot) in returns.extract_if(.., |(to, _)| *to <= step) {
            fleet.start_robot(robot)?;
        }
        Ok(bodies)
    })
}

/// A port that is free now.
fn free_port() -> Result<u16, Failure> {
    let listener = TcpListener::bind("127.0.0.1:0");
    let port = listener.and_then(|listener| listener.local_addr()).map(|address| address.port());
    port.map_err(|error| Failure::Internal(format!("no port of 127.0.0.1 is free: {error}")))
}

/// A folder that is removed with its value: robots write down their positions in it.
struct Folder(PathBuf);

impl Folder {
    /// A new folder. One that is there was left behind by a launch that was killed, whose number may
    /// come again: robots would begin where that launch has left them.
    fn new(name: &str) -> Result<Self, Failure> {
        let place = std::env::temp_dir();
        let mut number = 1;
        loop {
            let path = place.join(format!("pleach-{name}-{number}"));
            match fs::create_dir(&path).map_err(|error| (error.kind(), error)) {
                Ok(()) => return Ok(Folder(path)),
                Err((ErrorKind::AlreadyExists, _)) if number < MOST_NAMES => number += 1,
                Err((_, source)) => return Err(Failure::Creation { path, source }),
            }
        }
    }

    fn state_of(&self, robot: usize) -> PathBuf {
        self.0.join(format!("robot-{robot}.json"))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// The processes of a mission. They end with this value.
struct Fleet {
    program: PathBuf,
    scenario: PathBuf,
    session: String,
    meeting_point: String,
    options: NodeArguments,
    folder: Folder,
    access_points: Option<Child>,
    robots: Vec<Option<Child>>,
}

impl Fleet {
    fn start(&mut self, robots: usize) -> Result<(), Failure> {
        self.access_points = Some(self.process("access-point", &[])?);
        self.robots.resize_with(robots, || None);
        (0..robots).try_for_each(|robot| self.start_robot(robot))
    }

    fn start_robot(&mut self, robot: usize) -> Result<(), Failure> {
        let (id, state) = (robot.to_string(), self.folder.state_of(robot));
        let process = self.process("robot", &[("--id", Path::new(&id)), ("--state", &state)])?;
        self.robots[robot] = Some(process);
        Ok(())
    }

    fn process(&self, command: &str, more: &[(&str, &Path)]) -> Result<Child, Failure> {
        let NodeArguments { limit, loss, seed, real_time } = &self.options;
        let mut process = Command::new(&self.program);
        process.arg(command).arg(&self.scenario);
        for (name, value) in more {
            process.arg(name).arg(value);
        }
        process.args(["--session", &self.session, "--listen", "tcp/127.0.0.1:0"]);
        process.args(["--connect", &self.meeting_point]);
        process.args(["--wait", &WAIT.as_secs_f64().to_string()]);
        process.args(["--limit", &limit.0.as_secs_f64().to_string()]);
        process.args(["--loss", &loss.0.to_string(), "--seed", &seed.to_string()]);
        process.args(real_time.then_some("--real-time"));
        process.stdin(Stdio::null()).stdout(Stdio::null());
        let failed = |error| {
            let program = self.program.display();
            Failure::Internal(format!("{program} {command} cannot be started: {error}"))
        };
        process.spawn().map_err(failed)
    }

    /// A process that has failed ends the mission.
    fn check(&mut self) -> Result<(), Failure> {
        let robots = self.robots.iter_mut().enumerate();
        let robots = robots.map(|(robot, process)| (Some(robot), process));
        for (robot, process) in robots.chain([(None, &mut self.access_points)]) {
            if let Some(process) = process
                && let Some(status) = process.try_wait()?
                && status.code().is_none_or(|code| !matches!(code, 0 | 3))
            {
                let node =
                    robot.map_or("the access points".into(), |robot| format!("robot {robot}"));
                return Err(Failure::Internal(format!(
                    "the process of {node} has ended with {status}: what it says stands above"
                )));
            }
        }
        Ok(())
    }

    /// Kills the process of a robot, without a warning, and says where its body stands.
    fn kill(&mut self, robot: usize, scenario: &ValidScenario) -> Result<Point, Failure> {
        if let Some(mut process) = self.robots[robot].take() {
            process.kill()?;
            process.wait()?;
            tell(format_args!("the process of robot {robot} is killed"));
        }
        let (file, start) = (self.folder.state_of(robot), scenario.robot[robot].position);
        let memory = Memory::open(&file, &digest_of(scenario)?, robot, start)?;
        Ok(memory.position().into())
    }
}

impl Drop for Fleet {
    fn drop(&mut self) {
        let mut processes: Vec<&mut Child> =
            self.robots.iter_mut().chain([&mut self.access_points]).flatten().collect();
        processes.iter_mut().for_each(|process| drop(process.kill()));
        processes.iter_mut().for_each(|process| drop(process.wait()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_that_was_left_behind_is_not_taken() {
        let name = format!("folder-{}", std::process::id());
        let left_behind = Folder::new(&name).unwrap();
        fs::write(left_behind.state_of(0), "of an earlier launch").unwrap();
        let folder = Folder::new(&name).unwrap();
        assert!(!folder.state_of(0).exists());
        let path = folder.0.clone();
        drop(folder);
        assert!(!path.exists() && left_behind.state_of(0).exists());
    }
}
