//! Every key of a scenario, option, exit status and event is documented.

use pleach::automaton::network::scenario::{
    AGENDA, CONTROL, Control, LinkRanges, RobotStart, Scenario, Task,
};
use serde::Serialize;
use std::fs;

use crate::command_line::pleach;
use crate::generated::{read, root};

const SCENARIOS: &str = "docs/scenarios.md";
const COMMANDS: &str = "docs/commands.md";
const EVENTS: &str = "docs/how-to/trace.md";

/// The row of a table that explains `name`: the name is alone in its first cell, or among others.
fn row<'a>(document: &'a str, name: &str) -> Option<&'a str> {
    let name = format!("`{name}`");
    document.lines().find(|line| {
        line.strip_prefix("| ")
            .and_then(|line| line.split(" | ").next())
            .is_some_and(|cell| cell.contains(&name))
    })
}

#[track_caller]
fn expect_rows<'a>(path: &str, names: impl IntoIterator<Item = &'a str>) {
    let document = read(path);
    let missing: Vec<&str> =
        names.into_iter().filter(|name| row(&document, name).is_none()).collect();
    assert!(missing.is_empty(), "{path} has no row for {missing:?}");
}

fn study() -> Scenario {
    pleach::scenario_file::read(&root().join("scenarios/study-1.toml")).unwrap().into_scenario()
}

/// The keys of a table of a scenario file.
fn keys(table: &impl Serialize) -> Vec<String> {
    toml::Table::try_from(table).unwrap().keys().cloned().collect()
}

#[test]
fn every_key_of_a_scenario_is_documented() {
    let scenario = study();
    let link = LinkRanges { steepness: Some(4.0), ..scenario.link };
    let robot = RobotStart { access_point: Some(0), ..scenario.robot[0] };
    let task = Task {
        announced: Some(1),
        withdrawn: Some(2),
        lasts: Some(1),
        priority: Some(1),
        access_point: Some(0),
        ..scenario.task[0]
    };
    let tables = [
        vec!["name".to_owned(), "description".to_owned()],
        keys(&scenario.workspace),
        keys(&link),
        keys(&scenario.access_point[0]),
        keys(&robot),
        keys(&task),
    ];
    let stated = tables.iter().flatten().map(String::as_str);
    let control = CONTROL.iter().map(|key| key.name);
    let agenda = AGENDA.iter().map(|(name, _)| *name);
    expect_rows(SCENARIOS, stated.chain(control).chain(agenda));
}

/// The defaults that depend on nothing else are documented as they are.
#[test]
fn every_default_is_documented() {
    let document = read(SCENARIOS);
    let settled = Scenario { control: Control::default(), ..study() }.with_defaults().control;
    for (key, value) in toml::Table::try_from(settled).unwrap() {
        if matches!(&*key, "clearance" | "service_radius" | "step_radius" | "build_reliability") {
            continue;
        }
        let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let stated = row(&document, &key).unwrap().split('|').nth(2).unwrap();
        let stated = stated.trim().trim_matches('`').replace(' ', "");
        let same = stated == value || stated.parse::<f64>().ok() == value.parse::<f64>().ok();
        assert!(same, "`{key}` defaults to {value}, {SCENARIOS} says {stated}");
    }
}

#[test]
fn every_shipped_scenario_is_documented() {
    let document = read(SCENARIOS);
    for entry in fs::read_dir(root().join("scenarios")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        assert!(document.contains(&format!("(../scenarios/{name})")), "{SCENARIOS} lacks {name}");
    }
}

fn help(arguments: &[&str]) -> String {
    String::from_utf8(pleach(&[arguments, &["--help"]].concat()).stdout).unwrap()
}

/// The first words of the lines of a section of a help text.
fn section<'a>(help: &'a str, title: &str) -> Vec<&'a str> {
    let lines = help.lines().skip_while(|line| *line != title).skip(1);
    let lines = lines.take_while(|line| line.is_empty() || line.starts_with(' '));
    lines.filter_map(|line| line.split_whitespace().next()).collect()
}

#[test]
fn every_command_option_and_exit_status_is_documented() {
    let (document, help_of_all) = (read(COMMANDS), help(&[]));
    let mut missing = Vec::new();
    let commands = section(&help_of_all, "Commands:");
    assert!(commands.len() > 8, "{help_of_all}");
    for command in commands.into_iter().filter(|&command| command != "help") {
        if !document.contains(&format!("`{command} "))
            && !document.contains(&format!("`pleach {command} "))
        {
            missing.push(command.to_owned());
        }
        let help = help(&[command]);
        let lines = help.lines().map(str::trim_start).filter(|line| line.starts_with('-'));
        let words = lines.flat_map(|line| line.split([' ', ',']));
        let options = words.filter(|word| word.starts_with("--") && *word != "--help");
        missing
            .extend(options.filter(|it| !document.contains(&format!("`{it}"))).map(str::to_owned));
    }
    for status in section(&help_of_all, "Exit status:") {
        if !document.contains(&format!("\n| {status} | ")) {
            missing.push(format!("exit status {status}"));
        }
    }
    assert!(missing.is_empty(), "{COMMANDS} lacks {missing:?}");
}

/// The schema, against which the traces of tests are validated, names every event.
#[test]
fn every_event_is_documented() {
    let schema: serde_json::Value = serde_json::from_str(&read("docs/trace.schema.json")).unwrap();
    let definitions = schema["$defs"].as_object().unwrap();
    let events = definitions.iter().filter(|(_, it)| !it["properties"]["event"].is_null());
    let names: Vec<&str> = events.map(|(name, _)| name.as_str()).collect();
    assert!(names.len() > 20, "{names:?}");
    expect_rows(EVENTS, names);
}
