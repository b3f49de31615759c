//! Every mistake that a scenario can hold is told with file, line, column, key and what would be
//! right. Each file in `tests/scenarios/faulty` holds one, but for the one that holds several.

use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::Remark;
use pleach::scenario_file::{ScenarioError, Setting, parse, parse_with, read};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn scenarios_in(folder: &str) -> Vec<PathBuf> {
    let mut paths: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    paths
}

#[test]
fn every_faulty_scenario_is_refused_with_a_clear_message() {
    for path in scenarios_in("tests/scenarios/faulty") {
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let error = read(&path).expect_err(&stem);
        insta::assert_snapshot!(stem, error);
    }
}

/// Bounds that are worked out are told as a person writes them.
#[test]
fn bounds_are_told_without_rounding() {
    let text = std::fs::read_to_string("scenarios/too-few.toml").unwrap();
    let told = |setting: &str| {
        let setting: Setting = setting.parse().unwrap();
        parse_with(&text, Path::new("it.toml"), &[setting]).unwrap_err().to_string()
    };
    let far = told("link.max_range=1e31");
    assert!(far.contains("1e31 is out of range: it must lie from 1e-30 to 1e30"), "{far}");
}

/// What touches is no mistake: it is told how it is taken, and the mission is run on it.
#[test]
fn scenarios_whose_polygons_touch_are_taken_with_a_note() {
    for path in scenarios_in("tests/scenarios/touching") {
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let scenario = read(&path).unwrap_or_else(|error| panic!("{error}"));
        let remarks = scenario.remarks();
        let lines = remarks.iter().map(|remark| format!("{}: {remark}\n", remark.key()));
        insta::assert_snapshot!(format!("touching-{stem}"), lines.collect::<String>());
        let completed = pleach::mission::run(&scenario, &mut []).unwrap();
        let expected = match stem.as_str() {
            "cut-in-two" => Outcome::UnreachableTask,
            _ => Outcome::Serviced,
        };
        assert_eq!(completed.end.outcome, expected, "{stem}: {}", completed.end.reason);
    }
}

#[test]
fn the_scenario_without_the_mistake_is_read() {
    let scenario = read(Path::new("tests/scenarios/room.toml")).unwrap();
    assert_eq!(scenario.name, "room");
    assert_eq!(scenario.robot[1].position, [0.6, 0.5]);
    assert_eq!(scenario.robot[1].rate, 0.075);
}

/// A value that is set does not stand in the text, and nothing in the text is wrong.
#[test]
fn a_number_that_is_too_large_is_told_with_its_place() {
    let text = std::fs::read_to_string("tests/scenarios/room.toml").unwrap();
    let error = |setting: &str| {
        let setting: Setting = setting.parse().unwrap();
        parse_with(&text, Path::new("room.toml"), &[setting]).unwrap_err().to_string()
    };
    for (setting, said) in [
        ("control.period=1e400", "control.period: the number 1e400 is too large: "),
        ("task[0].position=[-1e999, 0]", "task[0].position[0]: the number -1e999 is too large: "),
        ("link.max_range=9223372036854775808", "link.max_range: the whole number 92233"),
    ] {
        let error = error(setting);
        assert!(error.starts_with(&format!("room.toml with {setting}: {said}")), "{error}");
    }
    let replaced = text.replacen("max_range = ", "max_range = 1e400 # ", 1);
    let line = 1 + replaced.lines().position(|line| line.contains("1e400")).unwrap();
    let error = parse(&replaced, Path::new("room.toml")).unwrap_err().to_string();
    assert!(error.starts_with(&format!("room.toml:{line}:13: link.max_range: ")), "{error}");
}

/// TOML has four bases.
#[test]
fn whole_numbers_may_be_written_in_any_base() {
    let text = std::fs::read_to_string("tests/scenarios/room.toml").unwrap();
    for count in ["100", "1_00", "+100", "0x64", "0o144", "0b1100100"] {
        let setting: Setting = format!("control.max_steps={count}").parse().unwrap();
        let scenario = parse_with(&text, Path::new("room.toml"), &[setting]).unwrap();
        assert_eq!(scenario.settings().max_steps, 100, "{count}");
    }
}

/// No number of a scenario may be anything but finite, wherever it stands.
#[test]
fn every_number_of_a_scenario_must_be_finite() {
    let text = std::fs::read_to_string("scenarios/redundant-node.toml").unwrap();
    let is_number = |word: &&str| word.parse::<f64>().is_ok();
    let statements = text.split_once("[workspace]").unwrap().1;
    let numbers = statements.split([' ', ',', '[', ']', '\n']).filter(is_number);
    let mut count = 0;
    for number in numbers {
        let at = number.as_ptr() as usize - text.as_ptr() as usize;
        for odd in ["nan", "-nan", "inf", "-inf"] {
            let faulty = format!("{}{odd}{}", &text[..at], &text[at + number.len()..]);
            let error = pleach::scenario_file::parse(&faulty, Path::new("odd.toml")).unwrap_err();
            let line = 1 + text[..at].matches('\n').count();
            assert!(error.to_string().starts_with(&format!("odd.toml:{line}:")), "{error}");
        }
        count += 1;
    }
    assert!(count > 30);
}

/// A period of fewer rounds than an exchange takes, or beacons are repeated in, is lawful, and worth a remark.
#[test]
fn few_rounds_are_remarked() {
    let text = std::fs::read_to_string("tests/scenarios/room.toml").unwrap();
    for (rounds, remarks) in [(1, 2), (2, 2), (3, 1), (4, 1), (5, 0)] {
        let settings: [Setting; 1] =
            [format!("control.rounds_per_period={rounds}").parse().unwrap()];
        let scenario = parse_with(&text, Path::new("room.toml"), &settings).unwrap();
        let keys: Vec<String> = scenario.remarks().iter().map(|it| it.key().to_string()).collect();
        let told = keys.iter().filter(|key| *key == "control.rounds_per_period").count();
        assert_eq!(told, remarks, "{rounds}: {keys:?}");
    }
}

/// A move that may miss its end by as much as it is long is lawful, and worth a remark.
#[test]
fn moves_shorter_than_their_error_are_remarked() {
    let text = std::fs::read_to_string("tests/scenarios/room.toml").unwrap();
    let remarks = |step: f64| {
        let settings =
            ["control.motion_error=0.005".to_owned(), format!("control.step_radius={step}")]
                .map(|setting| setting.parse::<Setting>().unwrap());
        let scenario = parse_with(&text, Path::new("room.toml"), &settings).unwrap();
        let keys = scenario.remarks().into_iter().map(|remark| remark.key().to_string());
        keys.filter(|key| key == "control.step_radius").count()
    };
    assert_eq!((remarks(0.005), remarks(0.0051)), (1, 0));
}

/// What comes when the mission has ended does not keep it from starting.
#[test]
fn what_a_user_does_too_late_is_remarked() {
    let text = std::fs::read_to_string("scenarios/errands.toml").unwrap();
    let remarks = |max_steps: usize| -> Vec<String> {
        let settings: [Setting; 1] = [format!("control.max_steps={max_steps}").parse().unwrap()];
        let scenario = parse_with(&text, Path::new("errands.toml"), &settings).unwrap();
        let late = scenario.remarks().into_iter().filter(|it| matches!(it, Remark::TooLate { .. }));
        late.map(|remark| format!("{}: {remark}", remark.key())).collect()
    };
    assert_eq!(remarks(481), Vec::<String>::new());
    let never = |what: &str, period: u32| {
        format!(
            "the user never {what}: the mission ends before control period {period}, since max_steps is 450"
        )
    };
    let expected = [
        format!("task[1].withdrawn: {}", never("takes it back", 450)),
        format!("task[3].announced: {}", never("asks for it", 480)),
    ];
    assert_eq!(remarks(450), expected);
}

/// A count is told with its range wherever it is too large, also where it fits no number of the machine.
#[test]
fn a_count_that_is_too_large_is_told_with_its_range() {
    let text = std::fs::read_to_string("scenarios/errands.toml").unwrap();
    let mut cases = Vec::new();
    for value in ["1000000001", "5000000000", "18446744073709551615"] {
        let times = [("announced", 0), ("withdrawn", 1), ("lasts", 1)];
        cases.extend(
            times.map(|(key, least)| (format!("task[3].{key}"), value, least, 1_000_000_000)),
        );
        cases.push(("control.max_steps".to_owned(), value, 1, 1_000_000_000));
        cases.push(("control.routing_iterations".to_owned(), value, 1, 10_000));
    }
    for (key, value, least, most) in cases {
        let setting: Setting = format!("{key}={value}").parse().unwrap();
        let error =
            parse_with(&text, Path::new("errands.toml"), &[setting]).unwrap_err().to_string();
        let expected = format!(
            "{key}: the whole number {value} stands where a whole number from {least} to {most} belongs"
        );
        assert!(error.contains(&expected), "{error}");
    }
}

#[test]
fn a_missing_file_is_named() {
    let error = read(Path::new("tests/scenarios/nowhere.toml")).unwrap_err();
    assert!(matches!(error, ScenarioError::Unreadable { .. }));
    assert!(error.to_string().starts_with("tests/scenarios/nowhere.toml: cannot be read"));
}

#[test]
fn every_shipped_scenario_is_valid_and_explains_itself() {
    let shipped = scenarios_in("scenarios");
    assert!(shipped.len() >= 13);
    for path in shipped {
        let scenario = read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(Some(scenario.name.as_str()), path.file_stem().unwrap().to_str());
        assert!(scenario.description.is_some(), "{} has no description", path.display());
        assert!(!scenario.task.is_empty());
    }
}

#[test]
fn a_scenario_with_every_default_written_out_reads_as_itself() {
    let scenario = read(Path::new("tests/scenarios/room.toml")).unwrap().with_defaults();
    let text = toml::to_string(&scenario).unwrap();
    let again = pleach::scenario_file::parse(&text, Path::new("room.toml")).unwrap();
    assert_eq!(*again, scenario);
}

#[test]
fn settings_replace_values_and_mistakes_in_them_are_told_as_such() {
    let text = std::fs::read_to_string("tests/scenarios/room.toml").unwrap();
    let parse = |settings: &[&str]| {
        let settings: Vec<_> = settings.iter().map(|setting| setting.parse().unwrap()).collect();
        parse_with(&text, Path::new("room.toml"), &settings)
    };
    let set = ["control.period=0.5", "robot[*].rate=0.01", "control.routing_method=dual"];
    let scenario = parse(&set).unwrap();
    assert_eq!(scenario.settings().period, 0.5);
    assert!(scenario.robot.iter().all(|robot| robot.rate == 0.01));

    let said = |setting: &str| parse(&[setting]).unwrap_err().to_string();
    insta::assert_snapshot!(
        "settings",
        [
            "control.period=-1",
            "control.clearence=1",
            "robot[7].rate=0.1",
            "robot.rate=0.1",
            "link.model=square",
            "robot[0].position=[1e19, 0]",
        ]
        .map(said)
        .join("\n")
    );
}

#[test]
fn a_setting_without_key_or_value_is_refused() {
    for text in ["control.period", "=3", "control..period=1", "robot[x].rate=1", "robot[1=2"] {
        assert!(text.parse::<Setting>().is_err(), "{text}");
    }
}

/// Many robots in a large room: reading looks at near ones only.
#[test]
fn a_hundred_thousand_robots_are_read_in_a_moment() {
    let side = 317;
    let robots: String = (0..100_000)
        .map(|robot| [robot % side, robot / side].map(|place| 0.1 + 0.1 * f64::from(place)))
        .map(|[x, y]| format!("[[robot]]\nposition = [{x}, {y}]\nrate = 1e-6\n"))
        .collect();
    let text = format!(
        "name = \"crowd\"\n[workspace]\nboundary = [[0, 0], [40, 0], [40, 40], [0, 40]]\n\
         [link]\nfull_range = 0.4\nmax_range = 0.5\n[[access_point]]\nposition = [20, 20]\n{robots}"
    );
    let start = Instant::now();
    let scenario = parse(&text, Path::new("crowd.toml")).unwrap();
    assert_eq!(scenario.robot.len(), 100_000);
    println!("read in {:?}", start.elapsed());
    assert!(start.elapsed() < Duration::from_secs(10), "{:?}", start.elapsed());
}
