//! The program as a person or another program starts it.

use pleach::automaton::network::record::Outcome;
use pleach::summary::Summary;
use pleach::trace::{TraceEntry, TraceReader};
use pleach::verify::network::Extremes;
use pleach::{mission, scenario_file};
use std::path::Path;
use std::process::{Command, Output};

pub fn pleach(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pleach")).args(arguments).output().expect("the program starts")
}

#[test]
fn a_faulty_scenario_ends_with_status_2_and_says_where() {
    let output = pleach(&["run", "tests/scenarios/faulty/not-a-number.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("faulty/not-a-number.toml:21:18: robot[1].position[1]"), "{said}");
}

#[test]
fn wrong_usage_ends_with_status_2() {
    for arguments in [&["run"][..], &["walk"], &["run", "a.toml", "--speed", "3"], &[]] {
        assert_eq!(pleach(arguments).status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn help_is_worth_reading() {
    let help = |arguments: &[&str]| {
        let output = pleach(arguments);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap()
    };
    insta::assert_snapshot!("help", help(&["--help"]));
    insta::assert_snapshot!("help-run", help(&["run", "--help"]));
    insta::assert_snapshot!("help-check", help(&["check", "--help"]));
    insta::assert_snapshot!("help-diagram", help(&["diagram", "--help"]));
}

#[test]
fn faults_are_asked_for_and_checked() {
    let stop = |stop: &str| {
        let output = pleach(&["run", "scenarios/too-few.toml", "--stop", stop, "--no-figures"]);
        (output.status.code(), said(&output.stderr))
    };
    let (status, told) = stop("5@10");
    assert_eq!(status, Some(2));
    assert!(told.contains("--stop names robot 5: those of too-few go from 0 to 4"), "{told}");
    assert_eq!(stop("1@20..10").0, Some(2));
    let trace = Path::new(env!("CARGO_TARGET_TMPDIR")).join("lossy.jsonl");
    let trace = trace.to_str().unwrap();
    let arguments = ["run", "scenarios/redundant-node.toml", "--quiet", "--no-figures"];
    let faults = ["--loss", "0.3", "--stop", "3@30..60", "--trace", trace];
    assert_eq!(pleach(&[&arguments[..], &faults].concat()).status.code(), Some(0));
    let judged = pleach(&["judge", trace]);
    assert_eq!(judged.status.code(), Some(0));
    let judged = said(&judged.stdout);
    assert!(judged.contains("judged by what must hold under any fault"), "{judged}");
}

#[test]
fn a_stop_after_the_end_is_told() {
    let mission = "scenarios/redundant-node.toml";
    let output =
        pleach(&["run", mission, "--no-figures", "--stop", "0@40..60", "--stop", "1@5000"]);
    assert_eq!(output.status.code(), Some(0));
    let told = said(&output.stderr);
    assert!(told.contains("robot 1 has not stopped: the mission ends before control period 5000"));
    assert!(!told.contains("robot 0 has not stopped"), "{told}");
}

#[test]
fn a_trace_that_cannot_be_written_ends_with_status_2() {
    let output = pleach(&["run", "scenarios/study-1.toml", "--trace", "no/such/folder/t.jsonl"]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no/such/folder/t.jsonl: cannot be created"), "{said}");
}

/// One file by two names, before it is there.
#[test]
fn two_outputs_do_not_go_to_one_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("one-place");
    std::fs::create_dir_all(&folder).unwrap();
    let table = folder.join("table.csv");
    let again = folder.join("../one-place/table.csv");
    let [table, again] = [&table, &again].map(|path| path.to_str().unwrap());
    let _ = std::fs::remove_file(table);
    let run = ["run", "scenarios/too-few.toml", "--no-figures", "-q", "--csv", table, "--json"];
    let output = pleach(&[&run[..], &[again]].concat());
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(said(&output.stderr).contains("would take the place of another file"), "{output:?}");
}

#[test]
fn a_task_out_of_reach_ends_with_status_3_and_the_same_trace_every_time() {
    let run = |trace: &Path| {
        let trace = trace.to_str().unwrap();
        pleach(&["run", "scenarios/unreachable.toml", "--no-figures", "--trace", trace])
    };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let (first, second) = (folder.join("first.jsonl"), folder.join("second.jsonl"));
    let output = run(&first);
    assert_eq!(output.status.code(), Some(3));
    assert_eq!(run(&second).status.code(), Some(3));

    let summary = String::from_utf8(output.stdout).unwrap();
    assert!(summary.starts_with("unreachable: 1 of 2 tasks serviced"), "{summary}");
    assert_eq!(
        summary.matches("no robot can come").count(),
        1,
        "the reason stands once: {summary}"
    );
    let story = String::from_utf8(output.stderr).unwrap();
    assert!(story.contains("task 0 is serviced by robot"), "{story}");
    let trace = std::fs::read(&first).unwrap();
    assert_eq!(trace, std::fs::read(&second).unwrap());
    let last = TraceReader::new(trace.as_slice()).unwrap().last().unwrap().unwrap();
    assert!(matches!(last, TraceEntry::End(end) if end.outcome == Outcome::UnreachableTask));
}

#[test]
fn a_quiet_run_says_nothing_but_the_summary() {
    let output = pleach(&["run", "scenarios/unreachable.toml", "--no-figures", "--quiet"]);
    assert!(output.stderr.is_empty());
    assert!(!output.stdout.is_empty());
}

// ---- Judging -----------------------------------------------------------------------------------

#[test]
fn a_trace_is_judged_from_its_file() {
    let trace = Path::new(env!("CARGO_TARGET_TMPDIR")).join("judged.jsonl");
    let path = trace.to_str().unwrap();
    pleach(&["run", "scenarios/too-few.toml", "--no-figures", "--quiet", "--trace", path]);
    let sound = pleach(&["judge", path]);
    assert_eq!(sound.status.code(), Some(0));
    let verdict =
        format!("{path}: sound, 307 control periods; the outcome is: insufficient robots");
    assert!(said(&sound.stdout).starts_with(&verdict), "{}", said(&sound.stdout));

    let text = std::fs::read_to_string(&trace).unwrap();
    let spoiled = text.replacen("\"event\":\"task_serviced\"", "\"event\":\"task_announced\"", 1);
    std::fs::write(&trace, spoiled).unwrap();
    let violated = pleach(&["judge", path]);
    assert_eq!(violated.status.code(), Some(4));
    assert!(said(&violated.stdout).contains("events is violated in step"), "{violated:?}");

    let half = &text[..text.len() / 2];
    let [within_a_line, after_a_line] = [half, &half[..=half.rfind('\n').unwrap()]].map(|killed| {
        std::fs::write(&trace, killed).unwrap();
        let verdict = pleach(&["judge", path]);
        assert_eq!(verdict.status.code(), Some(4), "{verdict:?}");
        said(&verdict.stdout)
    });
    assert!(within_a_line.contains("the trace breaks off"), "{within_a_line}");
    assert_eq!(within_a_line, after_a_line);
    std::fs::write(&trace, format!("{half}\n")).unwrap();
    let spoiled = pleach(&["judge", path]);
    assert_eq!(spoiled.status.code(), Some(2));
    assert!(said(&spoiled.stderr).contains("no property is violated before it"), "{spoiled:?}");
    std::fs::write(&trace, &text[..10]).unwrap();
    let headless = pleach(&["judge", path]);
    assert_eq!(headless.status.code(), Some(2));
    assert!(said(&headless.stderr).contains("nothing was judged"), "{headless:?}");
    assert_eq!(pleach(&["judge", "no/such/trace.jsonl"]).status.code(), Some(2));
}

// ---- Many runs ---------------------------------------------------------------------------------

fn said(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// A recording on the standard output is the one that a file gets, and no file is called `-`.
#[cfg(feature = "mcap")]
#[test]
fn recordings_go_to_the_standard_output() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("recordings");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let [trace, file] = ["few.jsonl", "few.mcap"].map(|name| folder.join(name));
    let run = ["run", "scenarios/too-few.toml", "--no-figures", "-q", "--trace"];
    pleach(&[&run[..], &[trace.to_str().unwrap()]].concat());
    let export = |recording: &str| {
        let program = Command::new(env!("CARGO_BIN_EXE_pleach"))
            .current_dir(&folder)
            .args(["export", "few.jsonl", recording])
            .output()
            .expect("the program starts");
        assert_eq!(program.status.code(), Some(0), "{}", said(&program.stderr));
        program.stdout
    };
    assert!(String::from_utf8_lossy(&export("few.mcap")).starts_with("few.mcap: "));
    assert!(export("-") == std::fs::read(file).unwrap());
    assert!(!folder.join("-").exists());
}

/// The rows of comma-separated values, none of which has a comma in it.
fn rows(csv: &str) -> Vec<Vec<&str>> {
    csv.lines().map(|line| line.split(',').collect()).collect()
}

#[test]
fn a_sweep_gives_a_table_and_the_worst_status() {
    let sweep = ["--set", "control.max_steps=20..40:3", "--set", "robot[*].rate=0.07"];
    let outputs = ["--csv", "-", "--jobs", "2", "--quiet"];
    let arguments = [&["run", "scenarios/too-few.toml"][..], &sweep, &outputs].concat();
    let output = pleach(&arguments);
    assert_eq!(output.status.code(), Some(3));
    let csv = said(&output.stdout);
    let rows = rows(&csv);
    assert_eq!(rows[0][..5], ["run", "source", "scenario", "control.max_steps", "robot[*].rate"]);
    assert_eq!(rows.len(), 4);
    for (row, steps) in rows[1..].iter().zip(["20", "30", "40"]) {
        assert_eq!((row[3], row[6], row[10]), (steps, "step_limit", steps));
    }
    assert_eq!(pleach(&arguments).stdout, output.stdout, "the same on any number of threads");
    assert!(said(&output.stderr).contains("step limit"), "the table for people goes elsewhere");
}

/// A run that comes to nothing leaves the tables of those before it.
#[test]
fn tables_are_kept_until_there_are_others() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [csv, json] = ["kept.csv", "kept-table.json"].map(|name| folder.join(name));
    let tables = ["--csv", csv.to_str().unwrap(), "--json", json.to_str().unwrap()];
    for table in [&csv, &json] {
        std::fs::write(table, "of before").unwrap();
    }
    let run = ["run", "scenarios/too-few.toml", "--no-figures", "-q"];
    let broken = ["--trace", "no/such/folder/t.jsonl"];
    assert_eq!(pleach(&[&run[..], &tables, &broken].concat()).status.code(), Some(2));
    for table in [&csv, &json] {
        assert_eq!(std::fs::read_to_string(table).unwrap(), "of before");
    }
    pleach(&[&run[..], &tables].concat());
    assert!(std::fs::read_to_string(&csv).unwrap().starts_with("run,source,scenario"));
    assert!(std::fs::read_to_string(&json).unwrap().starts_with('['));

    let nowhere = pleach(&[&run[..], &["--csv", "no/such/folder/t.csv"]].concat());
    assert_eq!(nowhere.status.code(), Some(2));
    assert!(said(&nowhere.stderr).contains("t.csv: cannot be created"), "{nowhere:?}");
}

/// Each column of the table holds what the run itself says.
#[test]
fn tables_hold_what_the_runs_are() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let [csv, json] = ["runs.csv", "runs.json"].map(|name| folder.join(name));
    let scenarios = ["scenarios/leaf-leader.toml", "scenarios/unreachable.toml"];
    let tables = ["--csv", csv.to_str().unwrap(), "--json", json.to_str().unwrap(), "--quiet"];
    let output = pleach(&[&["run"][..], &scenarios, &tables].concat());
    assert_eq!(output.status.code(), Some(3));
    let rows: Vec<serde_json::Value> =
        serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
    for (row, path) in rows.iter().zip(scenarios) {
        let scenario = scenario_file::read(Path::new(path)).unwrap();
        let mut summary = Summary::new(&scenario);
        let completed = mission::run(&scenario, &mut [&mut summary]).unwrap();
        assert_eq!(row["outcome"], completed.end.outcome.name());
        let counts = [
            ("tasks", scenario.task.len()),
            ("serviced", summary.serviced()),
            ("periods", summary.periods()),
            ("recruits", summary.recruits()),
            ("stationary_points", summary.stationary_points()),
            ("tree_links", summary.links().last().links),
            ("links_through_walls", summary.links().last().through_walls),
        ];
        for (name, count) in counts {
            assert_eq!(row[name].as_u64(), Some(count as u64), "{name} of {path}");
        }
        let Extremes { pair_distance, clearance, residual, load } = completed.extremes;
        let extremes = [
            ("smallest_distance", pair_distance),
            ("smallest_clearance", clearance),
            ("smallest_residual", residual),
            ("largest_load", load),
        ];
        for (name, extreme) in extremes {
            assert_eq!(row[name].as_f64(), extreme.map(|one| one.value), "{name} of {path}");
        }
    }

    let mut table = csv::Reader::from_path(&csv).unwrap();
    let names: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    for (record, row) in table.records().map(Result::unwrap).zip(&rows) {
        for (name, cell) in names.iter().zip(&record) {
            let same = match &row[name] {
                serde_json::Value::String(text) => cell == text,
                serde_json::Value::Null => cell.is_empty(),
                number => cell.parse().ok() == number.as_f64(),
            };
            assert!(same, "{name}: {cell} is not {}", row[name]);
        }
    }
}

#[test]
fn repeats_start_at_random_places() {
    let repeat =
        ["run", "tests/scenarios/room.toml", "--repeat", "3", "--seed", "7", "--json", "-"];
    let limit = ["--set", "control.max_steps=5", "--quiet"];
    let output = pleach(&[&repeat[..], &limit].concat());
    assert_eq!(output.status.code(), Some(3));
    let table: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = table.as_array().unwrap();
    assert_eq!(rows.iter().map(|row| row["seed"].as_u64().unwrap()).collect::<Vec<_>>(), [7, 8, 9]);
    assert_eq!(rows[0]["set"]["control.max_steps"], 5);
    let distances: Vec<_> = rows.iter().map(|row| row["smallest_distance"].as_f64()).collect();
    assert!(distances.iter().all(|distance| distance.unwrap() >= 0.02));
    assert!(distances[0] != distances[1] && distances[1] != distances[2]);
}

#[test]
fn a_folder_and_a_mistake_run_nothing() {
    let output = pleach(&["run", "tests/scenarios/faulty", "scenarios/study-1.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let said = said(&output.stderr);
    assert!(said.contains("faulty/clearance-zero.toml:12:13"), "{said}");
    assert!(said.contains("faulty/unknown-key.toml:"), "{said}");
    assert!(said.contains("faulty/not-utf-8.toml: cannot be read: it is not UTF-8 text"), "{said}");
}

#[test]
fn a_scenario_comes_from_the_standard_input_and_a_trace_goes_to_the_standard_output() {
    let input = std::fs::File::open("scenarios/too-few.toml").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_pleach"))
        .args(["run", "-", "--trace", "-", "--no-figures", "--set", "control.max_steps=30"])
        .stdin(input)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3));
    let entries = TraceReader::new(output.stdout.as_slice()).unwrap();
    let steps = entries.filter(|entry| matches!(entry, Ok(TraceEntry::Step(_)))).count();
    assert_eq!(steps, 30);
    assert!(said(&output.stderr).contains("outcome             step limit"));
}

/// A run that a signal ends: the trace is complete, and so are summary and figures.
#[cfg(unix)]
#[test]
fn an_interrupted_run_ends_in_order() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("interrupted");
    let trace = folder.join("hall.jsonl");
    std::fs::create_dir_all(&folder).unwrap();
    let _ = std::fs::remove_file(&trace);
    let run = Command::new(env!("CARGO_BIN_EXE_pleach"))
        .args(["run", "scenarios/hall.toml", "--quiet"])
        .arg("--trace")
        .arg(&trace)
        .arg("--figures")
        .arg(&folder)
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let has_begun = || std::fs::metadata(&trace).is_ok_and(|file| file.len() > 10_000);
    while !has_begun() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let process = run.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &process]).status().unwrap().success());
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let summary = said(&output.stdout);
    assert!(summary.contains("interrupted: the run was ended by SIGTERM at k = "), "{summary}");
    assert!(folder.join("index.html").exists());
    let file = std::io::BufReader::new(std::fs::File::open(&trace).unwrap());
    let entries: Vec<_> = TraceReader::new(file).unwrap().map(Result::unwrap).collect();
    let Some(TraceEntry::End(end)) = entries.last() else { panic!("the trace has no end") };
    assert_eq!(end.outcome, Outcome::Interrupted);
}

// ---- Maps --------------------------------------------------------------------------------------

/// Every option of `pleach import` is heeded.
#[test]
fn a_map_becomes_the_scenario_that_is_asked_for() {
    let import = |options: &[&str]| {
        let output = pleach(&[&["import", "tests/maps/cellar.map"][..], options].concat());
        assert_eq!(output.status.code(), Some(0), "{}", said(&output.stderr));
        scenario_file::parse(&said(&output.stdout), Path::new("cellar.toml")).unwrap()
    };
    let plain = import(&[]);
    assert_eq!((&*plain.name, plain.robot.len(), plain.task.len()), ("cellar", 8, 1));
    assert!(plain.workspace.boundary.contains(&[1.0, 1.0]), "corners stay");

    let chosen = import(&[
        "--tolerance",
        "0",
        "--scale",
        "2",
        "--name",
        "vault",
        "--robots",
        "3",
        "--far-tasks",
        "2",
        "--full-range",
        "14",
        "--max-range",
        "18",
        "--clearance",
        "0.25",
    ]);
    assert_eq!((&*chosen.name, chosen.robot.len(), chosen.task.len()), ("vault", 3, 2));
    assert!(chosen.workspace.boundary.contains(&[2.0, 2.0]), "{:?}", chosen.workspace.boundary);
    assert_eq!((chosen.link.full_range, chosen.link.max_range), (14.0, 18.0));
    assert_eq!(chosen.control.clearance, Some(0.25));

    let place = |position: [f64; 2]| format!("{},{}", position[0], position[1]);
    let [access_point, task] = [plain.task[0].position, plain.access_point[0].position];
    let placed = import(&["--access-point", &place(access_point), "--task", &place(task)]);
    assert_eq!(placed.access_point[0].position, access_point);
    assert_eq!(placed.task[0].position, task);
}

#[test]
fn a_map_with_a_long_name_gives_a_name_that_a_scenario_may_have() {
    let name = format!("a{}", "ü".repeat(60));
    let map = Path::new(env!("CARGO_TARGET_TMPDIR")).join(&name).with_extension("map");
    std::fs::copy("tests/maps/cellar.map", &map).unwrap();
    let output = pleach(&["import", map.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output.stderr));
    let shortened = format!("name = \"a{}\"", "ü".repeat(49));
    assert!(said(&output.stdout).contains(&shortened), "{}", said(&output.stdout));
}

#[test]
fn a_scenario_takes_the_place_of_no_file_of_its_map() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("places");
    std::fs::create_dir_all(&folder).unwrap();
    let [map, image] = ["flat.yaml", "flat.pgm"].map(|name| {
        std::fs::copy(Path::new("tests/maps").join(name), folder.join(name)).unwrap();
        folder.join(name).to_str().unwrap().to_owned()
    });
    for file in [&map, &image] {
        let before = std::fs::read(file).unwrap();
        let output = pleach(&["import", &map, "-o", file]);
        assert_eq!(output.status.code(), Some(2), "{file}");
        assert!(said(&output.stderr).contains("choose another path"), "{output:?}");
        assert_eq!(std::fs::read(file).unwrap(), before, "{file}");
    }
}

// ---- Checks ------------------------------------------------------------------------------------

#[test]
fn a_check_counts_links_through_walls_and_draws_the_start() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("check");
    let figures = ["--figures", folder.to_str().unwrap()];
    let output = pleach(&[&["check", "scenarios/office.toml"][..], &figures].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output.stderr));
    let report = said(&output.stdout).replace(folder.to_str().unwrap(), "FOLDER");
    insta::assert_snapshot!("check", report);
    assert!(std::fs::read_to_string(folder.join("start.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn a_check_names_tasks_that_no_robot_can_service() {
    let output = pleach(&["check", "scenarios/unreachable.toml", "--no-figures"]);
    assert_eq!(output.status.code(), Some(3));
    let report = said(&output.stdout);
    assert!(report.contains("task[1].position: no robot can service it: no way leads"), "{report}");
    let task = ["--set", "task[0].position=[9, 9]", "--no-figures"];
    let output = pleach(&[&["check", "tests/scenarios/room.toml"][..], &task].concat());
    assert!(said(&output.stdout).contains("beyond the boundary or in a hole"));
    let output = pleach(&["check", "tests/scenarios/faulty/robot-in-hole.toml", "--no-figures"]);
    assert_eq!(output.status.code(), Some(2));
}

/// The task lies in a pillar. A robot may stand beside it, which is no reason for another status.
#[test]
fn a_check_says_from_where_a_task_in_a_wall_is_serviced() {
    let check = |place: &str| {
        let task = format!("task[0].position={place}");
        let radius = "control.service_radius=0.07";
        let scenario = "tests/scenarios/pillar.toml";
        pleach(&["check", scenario, "--no-figures", "--set", &task, "--set", radius])
    };
    let output = check("[0.55, 0.15]");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let report = said(&output.stdout);
    let place = "robots service it from (0.610001, 0.150000), 0.060001 away, through the wall";
    assert!(report.contains(place), "{report}");
    assert!(!said(&check("[0.62, 0.15]").stdout).contains("through the wall\n"));
}

#[test]
fn shells_and_man_know_the_commands() {
    for arguments in [&["completions", "bash"][..], &["completions", "fish"], &["man"]] {
        let output = pleach(arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        let said = said(&output.stdout);
        assert!(said.contains("completions") && said.contains("check"), "{said}");
    }
}

/// The tasks of the room, among them one that no robot can service, come from a table.
#[test]
fn tasks_come_from_a_table() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("task-table");
    std::fs::create_dir_all(&folder).unwrap();
    let table = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let room = "tests/scenarios/room.toml";
    let near = table("near.csv", "y,x,lasts\n0.5,0.9,20\n0.6,0.8,\n");
    let run = pleach(&["run", room, "--tasks", &near, "--no-figures", "--quiet"]);
    assert_eq!(run.status.code(), Some(0), "{run:?}");
    let told = said(&run.stdout);
    assert!(told.starts_with("room: 2 of 2 tasks serviced"), "{told}");
    assert!(told.contains("(0.9, 0.5)") && told.contains("(0.8, 0.6)"), "{told}");

    let check = |tasks: &str, more: &[&str]| {
        let arguments = ["check", room, "--no-figures", "--tasks", tasks];
        let output = pleach(&[&arguments[..], more].concat());
        (output.status.code(), said(&output.stdout), said(&output.stderr))
    };
    let walled = table("walled.csv", "x,y\n0.9,0.5\n1.1,0.5\n");
    let (status, told, _) = check(&walled, &[]);
    assert_eq!(status, Some(3), "{told}");
    assert!(told.contains("task[1].position: no robot can service it"), "{told}");
    assert_eq!(check(&walled, &["--set", "task[1].position=[0.8,0.6]"]).0, Some(0));

    let late = table("late.csv", "x,y,announced\n0.9,0.5,7\n0.8,0.6,3\n");
    let (status, _, told) = check(&late, &[]);
    assert_eq!(status, Some(2));
    assert!(told.contains("late.csv:3: task[1].announced: "), "{told}");
    let wrong = table("wrong.csv", "x,y\n0.9,half\n");
    let (status, _, told) = check(&wrong, &[]);
    assert_eq!(status, Some(2));
    assert!(told.contains("wrong.csv:2: column y: \"half\" stands where a number"), "{told}");
}
