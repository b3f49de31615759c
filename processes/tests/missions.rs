//! Missions with every node as a process, over the loopback interface.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};
use zenoh::Wait;

/// One mission at a time: each has a process for every node.
static ONE_AT_A_TIME: std::sync::Mutex<()> = std::sync::Mutex::new(());

fn alone() -> std::sync::MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn scenario(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenarios/{name}.toml"))
}

fn pleach() -> Command {
    Command::new(env!("CARGO_BIN_EXE_pleach"))
}

/// A folder of this test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(output: &Output) -> String {
    let [said, told] = [&output.stdout, &output.stderr].map(|it| String::from_utf8_lossy(it));
    format!("{said}{told}")
}

/// Launches a mission and returns its exit status, what it said and its trace.
fn launch(name: &str, more: &[&str]) -> (Option<i32>, String, PathBuf) {
    let trace = folder(&format!("{name}{}", more.concat())).join("trace.jsonl");
    let mut command = pleach();
    command.arg("launch").arg(scenario(name)).args(["--no-figures", "--trace"]).arg(&trace);
    let output = command.args(more).output().unwrap();
    (output.status.code(), text(&output), trace)
}

/// What the independent reader of traces says.
fn judge(trace: &Path) -> (Option<i32>, String) {
    let output = pleach().arg("judge").arg(trace).output().unwrap();
    (output.status.code(), text(&output))
}

/// The trace of the same mission, simulated.
fn simulated(name: &str) -> String {
    let trace = folder(&format!("{name}-simulated")).join("trace.jsonl");
    let mut command = pleach();
    command.arg("run").arg(scenario(name)).args(["--no-figures", "--quiet", "--trace"]).arg(&trace);
    assert!(command.output().unwrap().status.success());
    fs::read_to_string(trace).unwrap()
}

/// Whether no packet was late and no node was given up: then processes take the same steps as a
/// simulation. On a machine that is busy with other things some are.
fn was_undisturbed(said: &str) -> bool {
    said.contains(" 0 late") && said.contains("given up 0 times")
}

#[test]
fn a_mission_by_processes_is_the_one_that_is_simulated() {
    let _alone = alone();
    let (status, said, trace) = launch("redundant-node", &[]);
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
    if was_undisturbed(&said) {
        let is_same = fs::read_to_string(trace).unwrap() == simulated("redundant-node");
        assert!(is_same, "the traces differ; see tests/missions.rs\n{said}");
    } else {
        println!("disturbed, so traces are not compared: {said}");
    }
}

#[test]
fn study_one_is_serviced() {
    let _alone = alone();
    let (status, said, trace) = launch("study-1", &[]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("3 of 3 tasks serviced"), "{said}");
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
    if was_undisturbed(&said) {
        assert!(fs::read_to_string(trace).unwrap() == simulated("study-1"), "the traces differ");
    }
}

#[test]
fn a_mission_that_ends_unserviced_says_why() {
    let _alone = alone();
    let (status, said, trace) = launch("too-few", &[]);
    assert_eq!(status, Some(3), "{said}");
    assert!(said.contains("insufficient robots"), "{said}");
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
}

/// What must hold under any fault is checked while the mission goes on; its end would have exit status 4.
#[test]
fn a_robot_is_killed_and_started_again_while_messages_are_lost() {
    let _alone = alone();
    let (status, said, trace) = launch("redundant-node", &["--loss", "0.1", "--kill", "0@20..40"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("the process of robot 0 is killed"), "{said}");
    assert!(said.contains("the process of robot 0 is there again"), "{said}");
    assert!(!said.contains("; 0 messages lost"), "{said}");
    assert!(fs::read_to_string(&trace).unwrap().contains(r#""outcome":"serviced""#));
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
}

#[test]
#[ignore = "it takes minutes"]
fn study_one_is_serviced_although_messages_are_lost_and_a_robot_is_killed() {
    let _alone = alone();
    let (status, said, trace) = launch("study-1", &["--loss", "0.1", "--kill", "5@250..320"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(said.contains("3 of 3 tasks serviced"), "{said}");
    assert!(said.contains("the process of robot 5 is there again"), "{said}");
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
}

// ---- Processes by hand -------------------------------------------------------------------------

/// A session of this test, with the port where its access points listen.
struct Session {
    name: String,
    meeting_point: String,
    scenario: PathBuf,
    processes: Vec<Child>,
}

impl Session {
    fn new(test: &str, name: &str) -> Self {
        let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        Session {
            name: format!("{test}-{}", std::process::id()),
            meeting_point: format!("tcp/127.0.0.1:{port}"),
            scenario: scenario(name),
            processes: Vec::new(),
        }
    }

    fn command(&self, what: &str) -> Command {
        let mut command = pleach();
        command.arg(what).arg(&self.scenario).args(["--session", &self.name]);
        command.args(match what {
            "access-point" => ["--listen", &self.meeting_point],
            _ => ["--connect", &self.meeting_point],
        });
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn start(&mut self, mut command: Command) {
        self.processes.push(command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
    }

    fn start_robots(&mut self, ids: std::ops::Range<usize>) {
        for id in ids {
            let mut robot = self.command("robot");
            robot.args(["--id", &id.to_string()]);
            self.start(robot);
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        for process in &mut self.processes {
            let _ = process.kill();
            let _ = process.wait();
        }
    }
}

fn robots_of(name: &str) -> usize {
    pleach::scenario_file::read(&scenario(name)).unwrap().robot.len()
}

/// Another peer of the session sends rubbish under every key, as fast as it can; it takes no part, and
/// nothing comes of it but that it is counted.
#[test]
fn rubbish_is_refused_and_counted() {
    let _alone = alone();
    let mut session = Session::new("rubbish", "redundant-node");
    let access_points = session.command("access-point");
    session.start(access_points);
    let mut watch = session.command("watch");
    let trace = folder("rubbish").join("trace.jsonl");
    let watch = watch.args(["--no-figures", "--quiet", "--trace"]).arg(&trace).spawn().unwrap();
    thread::sleep(Duration::from_secs(2));
    let rogue = peer(&session.meeting_point);
    session.start_robots(0..robots_of("redundant-node"));
    let digest = pleach_processes::transport::digest(
        &pleach::scenario_file::read(&session.scenario).unwrap(),
    )
    .unwrap();
    let root = format!("pleach/{}", session.name);
    let finish = thread::spawn(move || watch.wait_with_output().unwrap());
    let mut noise = 1u64;
    while !finish.is_finished() {
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let node = noise >> 40;
        let length = if node.is_multiple_of(31) { 1 << 19 } else { (noise >> 33) as usize % 300 };
        let bytes = vec![(noise >> 56) as u8; length];
        for key in ["packet", "report"] {
            let key = format!(
                "{root}/{digest}/{key}/{}",
                if node.is_multiple_of(2) { 99 } else { node % 9 }
            );
            rogue.put(key, bytes.clone()).wait().unwrap();
        }
        rogue.put(format!("{root}/hello/{}", node % 9), bytes).wait().unwrap();
        thread::sleep(Duration::from_millis(20));
    }
    let output = finish.join().unwrap();
    let said = text(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(!said.contains(" 0 refused"), "{said}");
    assert!(said.contains("observer"), "{said}");
    assert_eq!(judge(&trace).0, Some(0), "{:?}", judge(&trace));
}

fn peer(meeting_point: &str) -> zenoh::Session {
    let mut config = zenoh::Config::default();
    config.insert_json5("mode", "\"peer\"").unwrap();
    config.insert_json5("scouting/multicast/enabled", "false").unwrap();
    config.insert_json5("listen/endpoints", "[\"tcp/127.0.0.1:0\"]").unwrap();
    config.insert_json5("connect/endpoints", &format!("[{meeting_point:?}]")).unwrap();
    zenoh::open(config).wait().unwrap()
}

// ---- What is wrong is named --------------------------------------------------------------------

fn refused(mut command: Command) -> String {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
    text(&output)
}

fn assert_says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "{part:?} is not in: {said}");
    }
}

#[test]
fn there_is_no_such_node() {
    let session = Session::new("no-such", "too-few");
    let mut robot = session.command("robot");
    robot.args(["--id", "5"]);
    assert_says(&refused(robot), &["too-few.toml", "no robot 5", "from 0 to 4"]);
    let mut access_point = session.command("access-point");
    access_point.args(["--id", "1"]);
    assert_says(&refused(access_point), &["no access point 1", "from 0 to 0"]);
    let launch = pleach().arg("launch").arg(&session.scenario).args(["--kill", "9@1"]).output();
    assert_says(&text(&launch.unwrap()), &["--kill names robot 9"]);
}

#[test]
fn nobody_is_heard() {
    let session = Session::new("nobody", "too-few");
    let mut robot = session.command("robot");
    robot.args(["--id", "0", "--wait", "1"]);
    assert_says(
        &refused(robot),
        &["robot 0 has received no other node", "within 1 s", "--connect"],
    );
    let mut watch = session.command("watch");
    watch.args(["--wait", "1", "--no-figures"]);
    assert_says(&refused(watch), &["nobody reports for 1 s", "--session"]);
}

#[test]
fn another_scenario_is_told_by_name() {
    let mut session = Session::new("other", "too-few");
    let mut access_points = session.command("access-point");
    access_points.args(["--wait", "10"]);
    session.start(access_points);
    session.scenario = scenario("study-1");
    let mut robot = session.command("robot");
    robot.args(["--id", "0", "--wait", "4"]);
    assert_says(
        &refused(robot),
        &["access point 0", "\"too-few\"", "study-1", "same file", "with another one"],
    );
    let mut watch = session.command("watch");
    watch.args(["--wait", "2", "--no-figures"]);
    assert_says(
        &refused(watch),
        &["access point 0", "\"too-few\"", "same file", "nobody with the scenario \"study-1\""],
    );
}

#[test]
fn a_port_that_is_taken_is_named() {
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let session = Session::new("port", "too-few");
    let mut access_point = pleach();
    access_point.arg("access-point").arg(&session.scenario);
    access_point.args(["--listen", &format!("tcp/127.0.0.1:{port}")]);
    assert_says(&refused(access_point), &["cannot listen at", &port.to_string(), "--listen"]);
}

#[test]
fn a_robot_has_one_process() {
    let mut session = Session::new("twice", "too-few");
    let access_points = session.command("access-point");
    session.start(access_points);
    session.start_robots(0..1);
    thread::sleep(Duration::from_secs(2));
    let mut robot = session.command("robot");
    robot.args(["--id", "0", "--wait", "10"]);
    let begin = Instant::now();
    assert_says(&refused(robot), &["robot 0 of this session has a process already", "--session"]);
    assert!(begin.elapsed() < Duration::from_secs(9), "it is told at once");
}
