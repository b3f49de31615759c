//! Inputs and outputs that are not ordinary files: pipes without a reader, devices that are full,
//! paths that are taken.

use pleach::trace::{TraceEntry, TraceReader};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A mission that ends early, with status 3.
const MISSION: [&str; 4] = ["run", "scenarios/too-few.toml", "--no-figures", "--quiet"];

fn pleach(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pleach"));
    command.args(arguments).stdin(Stdio::null());
    command
}

fn outcome(command: &mut Command) -> (Option<i32>, String) {
    let Output { status, stderr, .. } = command.output().unwrap();
    (status.code(), String::from_utf8(stderr).unwrap())
}

/// An empty folder of this test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("streams").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A trace of the mission in the folder.
fn trace(folder: &Path) -> String {
    let path = folder.join("trace.jsonl").to_str().unwrap().to_owned();
    let (status, _) = outcome(&mut pleach(&[&MISSION[..], &["--trace", &path]].concat()));
    assert_eq!(status, Some(3));
    path
}

#[cfg(target_os = "linux")]
fn full() -> File {
    File::options().write(true).open("/dev/full").unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_is_told() {
    let trace = trace(&folder("full"));
    let to_standard: [&[&str]; 8] = [
        &MISSION,
        &["run", "scenarios/too-few.toml", "--quiet", "--repeat", "2"],
        &["check", "scenarios/too-few.toml", "--no-figures"],
        &["diagram", "duty"],
        &["judge", &trace],
        &["page", &trace, "--output", "-"],
        &["import", "tests/maps/cellar.map"],
        &["man"],
    ];
    for arguments in to_standard {
        let (status, said) = outcome(pleach(arguments).stdout(full()));
        assert_eq!(status, Some(1), "{arguments:?}: {said}");
        assert!(said.contains("error: cannot write: the standard output: "), "{said}");
    }
    for option in ["--trace", "--csv", "--json"] {
        let (status, said) = outcome(&mut pleach(&[&MISSION[..], &[option, "/dev/full"]].concat()));
        assert_eq!(status, Some(1), "{option}: {said}");
        assert!(said.contains("cannot write: /dev/full: "), "{option}: {said}");
    }
}

/// What people would have read is lost, and nothing else.
#[cfg(target_os = "linux")]
#[test]
fn a_mission_goes_on_when_its_story_has_no_reader() {
    let folder = folder("unread");
    let path = folder.join("trace.jsonl");
    let arguments = ["run", "scenarios/too-few.toml", "--no-figures", "--trace"];
    let run = |command: &mut Command| command.arg(&path).status().unwrap().code();
    assert_eq!(run(pleach(&arguments).stdout(Stdio::null()).stderr(full())), Some(3));
    let entries = TraceReader::new(std::io::BufReader::new(File::open(&path).unwrap())).unwrap();
    assert!(matches!(entries.last(), Some(Ok(TraceEntry::End(_)))));

    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    assert_eq!(run(pleach(&arguments).stdout(Stdio::null()).stderr(writer)), Some(3));
    let quiet = |arguments: &[&str]| {
        let mut command = pleach(arguments);
        command.stdout(Stdio::null()).stderr(full()).status().unwrap().code()
    };
    assert_eq!(quiet(&["run", "scenarios/too-few.toml", "--repeat", "2"]), Some(3));
    assert_eq!(quiet(&["run", "no/such/scenario.toml"]), Some(2));
    assert_eq!(quiet(&["import", "tests/maps/cellar.map"]), Some(0));
}

#[test]
fn a_trace_comes_from_the_standard_input_and_its_page_goes_to_the_standard_output() {
    let trace = trace(&folder("piped"));
    let piped =
        |arguments: &[&str]| pleach(arguments).stdin(File::open(&trace).unwrap()).output().unwrap();
    let page = piped(&["page", "-"]);
    assert_eq!(page.status.code(), Some(0));
    let made = pleach::page::of_trace(std::io::BufReader::new(File::open(&trace).unwrap()));
    assert_eq!(String::from_utf8(page.stdout).unwrap(), made.unwrap());
    let judged = piped(&["judge", "-"]);
    assert!(String::from_utf8(judged.stdout).unwrap().starts_with("-: sound, 307 control periods"));
}

#[test]
fn outputs_take_no_place_of_inputs_or_of_each_other() {
    let folder = folder("taken");
    let scenario = folder.join("room.toml");
    fs::copy("tests/scenarios/room.toml", &scenario).unwrap();
    let map = folder.join("cellar.map");
    fs::copy("tests/maps/cellar.map", &map).unwrap();
    let trace = folder.join("trace.html");
    fs::copy(self::trace(&folder), &trace).unwrap();
    let [scenario, map, trace] = [scenario, map, trace].map(|path| path.display().to_string());
    let roundabout = format!("{}/./room.toml", folder.display());
    let other = folder.join("other").display().to_string();
    let calls: [&[&str]; 6] = [
        &["run", &scenario, "--no-figures", "--trace", &scenario],
        &["run", &scenario, "--no-figures", "--csv", &roundabout],
        &["run", &scenario, "--no-figures", "--csv", &other, "--json", &other],
        &["run", &scenario, "--no-figures", "--csv", "-", "--json", "-"],
        &["import", &map, "--output", &map],
        &["page", &trace],
    ];
    let texts = || [&scenario, &map, &trace].map(|path| fs::read(path).unwrap());
    let before = texts();
    for arguments in calls {
        let (status, said) = outcome(&mut pleach(arguments));
        assert_eq!(status, Some(2), "{arguments:?}: {said}");
        assert!(said.contains("would take the place of"), "{said}");
    }
    assert_eq!(texts(), before);
}
