//! The documents say what the code says: drawings are regenerated and compared, and what tables
//! name exists.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it documents` writes the generated documents anew.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, io};

use crate::generated::{is_update, read, root};
use pleach::automaton::network::Automata;
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::record::{MissionEvent, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Crash, NodeFaults};
use pleach::automaton::node::MessageFaults;
use pleach::automaton::{Automaton, diagram};
use pleach::discrete::network::Role;
use pleach::discrete::network::activity::rows_between;
use pleach::discrete::{Event, Location};
use pleach::figures::Album;
use pleach::guards::Valuation;
use pleach::mission::{self, Watcher};
use pleach::summary::Summary;
use pleach::verify::network::storm::Storm;
use pleach::{scenario_file, story};

/// The documents that people write, with their links and tables.
const WRITTEN: [&str; 31] = [
    "README.md",
    "CONTRIBUTING.md",
    "docs/SUMMARY.md",
    "docs/classics/README.md",
    "docs/architecture.md",
    "docs/scenarios.md",
    "docs/commands.md",
    "docs/model.md",
    "docs/semantics.md",
    "docs/guarantees.md",
    "docs/reachability.md",
    "docs/automata.md",
    "docs/robot.md",
    "docs/proofs.md",
    "docs/exploration.md",
    "docs/radio.md",
    "docs/missions.md",
    "docs/how-to/batch.md",
    "docs/how-to/controller.md",
    "docs/how-to/link-model.md",
    "docs/how-to/map.md",
    "docs/how-to/medium.md",
    "docs/how-to/model.md",
    "docs/how-to/monitor.md",
    "docs/how-to/trace.md",
    "docs/how-to/mcap.md",
    "docs/how-to/python.md",
    "docs/how-to/errands.md",
    "docs/how-to/teams.md",
    "docs/how-to/processes.md",
    "docs/how-to/real-robots.md",
];

fn keep_up_to_date(path: &str, document: &str) {
    crate::generated::keep_up_to_date(path, document, "documents");
}

// ---- The automata ------------------------------------------------------------------------------

/// The chapters on the automata of all nodes: title, name of the drawing, introduction, automaton.
macro_rules! for_each_automaton {
    ($automata:expr, $act:ident) => {{
        let it: Automata = $automata;
        [
            $act("The duty of a robot", "duty", DUTY, &it.duty),
            $act("The mission in the view of a robot", "mission", MISSION, &it.mission),
            $act("The exchange of duties", "exchange", EXCHANGE, &it.exchange),
            $act("The place of a robot in the tree", "place", PLACE, &it.attachment),
            $act("The control period of a robot", "control", CONTROL, &it.control),
            $act("The service of an access point", "service", SERVICE, &it.service),
            $act("The attendance of a robot", "attendance", ATTENDANCE, &it.attendance),
            $act("The control period of an access point", "rounds", ROUNDS, &it.rounds),
            $act("The user", "request", REQUEST, &it.request),
        ]
    }};
}

#[test]
fn the_drawings_of_the_automata_are_up_to_date() {
    fn draw<L: Location, E: Event, S: Valuation>(
        _: &str,
        name: &str,
        _: &str,
        automaton: &Automaton<L, E, S>,
    ) {
        keep_up_to_date(&format!("docs/pictures/{name}.svg"), &diagram::svg(automaton));
    }
    for_each_automaton!(Automata::new().unwrap(), draw);
}

/// The duty from further away: how many rows lead from each role of the paper to each other one.
#[test]
fn the_drawing_of_the_roles_is_up_to_date() {
    let count = |from: usize, to: usize| rows_between(Role::ALL[from], Role::ALL[to]).count();
    let picture = diagram::overview_svg(&Role::ALL.map(Role::name), count);
    assert!(picture.matches("class=\"arrow\"").count() <= 25);
    keep_up_to_date("docs/pictures/roles.svg", &picture);
}

/// The events by which a robot changes from one role to another, a line a pair of roles. Exchanges are told apart from
/// other events in the text above the table.
fn table_of_roles() -> String {
    let mut table = "| from | to | on |\n| --- | --- | --- |\n".to_owned();
    for (from, to) in Role::ALL.into_iter().flat_map(|from| Role::ALL.map(|to| (from, to))) {
        let events: BTreeSet<_> = rows_between(from, to).map(|row| row.event).collect();
        let events: Vec<&str> = events.into_iter().map(Event::name).collect();
        if from != to && !events.is_empty() {
            let line = format!("| {} | {} | {} |\n", from.name(), to.name(), events.join(", "));
            table.push_str(&line);
        }
    }
    table
}

#[test]
fn the_page_on_the_automata_is_up_to_date() {
    let chapters = for_each_automaton!(Automata::new().unwrap(), chapter).join("\n");
    keep_up_to_date("docs/automata.md", &format!("{INTRODUCTION}\n{chapters}"));
}

const INTRODUCTION: &str = "\
<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test --test it documents -->

# The automata of the network

*For people who read or change the protocol: which automata do robots, access points and the user run?*

Every robot runs the first five of these automata over its own state, every access point the next three (the second of
them once for each robot), and the user the last. The pictures are drawn from the tables that run; select one to enlarge
it. A transition reads `event [guard] / reset (urgency, priority)`. All are taken *at once*; if several are enabled, the
one with the smallest priority number is taken. A location shows its flow, its invariant after \"while\", and what is
chosen there at each sample. A bracket is a [superstate](how-to/model.md#superstates): where the tables declare one
transition from it, the drawing has a dot on each of its locations. `pleach diagram duty --format mermaid` prints an
automaton as text, with every guard, reset and target; [coverage](coverage.md) counts the rows.

A guard combines quantities and propositions that the node measures of its own state. The source defines each name
beside its measurement: those of [robots](../automaton/src/network/robot/facts.rs), of [access
points](../automaton/src/network/access_point/service.rs), of [their record of a
robot](../automaton/src/network/access_point/attendance.rs), and of the [user](../automaton/src/network/user.rs). The
guard of *trapped* in the mission, for example, begins with `first ∧ still ≥ window ∧ ¬slack`: the robot is p₁, the
primary team has stood still for as many control periods as make a stationary point, no member has room to move, and the
leader is not near enough to its task.
";

const DUTY: &str = "\
The duty is what a robot does for the network. Each location owns its data, and a reset maps the data of one location to
the data of the next. The role of the paper follows from the duty: a robot on standby is *redundant*; a relay, a
follower and a robot that shifts along Σ are *nodes*, the first of Σ the *recruit*; junctions, leaves and leaders keep
their names.

[![The roles of a robot](pictures/roles.svg)](pictures/roles.svg)

An arrow stands for all rows of the table on which a robot may change from one role to another; its number says how many
these are. A robot that waits on Σ keeps its role or is the recruit, so some rows count for several arrows. Rows that
keep the role are left out. The table below names the events; those that begin with *takes* are exchanges of duties. The
[drawing of all rows](pictures/duty.svg) has every location, guard and reset.
";

const EXCHANGE: &str = "\
A mover that cannot pass a parked robot exchanges duties with it: it offers its own, the parked robot replies with its
duty, the mover takes that, and the parked robot takes the one offered. Meanwhile neither takes a step of the mission.
Where a transition takes a duty, the duty automaton jumps with it.
";

const MISSION: &str = "\
The phase is the state of the mission as this robot has received it. Transitions of priority 0 follow the newest notice
received. Those of priority 1 follow from the robot's own state, and their resets issue the next notice. While a notice
spreads, robots are in different phases.
";

const PLACE: &str = "\
The parent of a post belongs to the duty, whose rows change it (*attached*, and all rows that give the robot another
post). This automaton follows the parent's messages: the path to an access point.
";

const CONTROL: &str = "\
Time passes in one location only, by the flow of equation (23), while the robot is in the region that the motion problem
(21) has given it. At the sample the robot passes through the other locations, which take no time (Algorithm 5). In each
it waits for its neighbours' messages up to the next tick of its clock; the reset lists its actions in order. Rounds of
beacons, sweeps and the negotiation are counted from 1 (n := 0); a robot with nothing to send or to judge in them does
not tick. Beacons are sent in three rounds, and in three more whenever their content changes.
";

const SERVICE: &str = "\
All access points run this automaton. Transitions of priority 0 follow the newest notice received; those of priority 1
are taken by the access point to which the user sends the tasks.
";

const ATTENDANCE: &str = "\
Access points keep a record of each robot, from which the first one issues a roll in each control period. Robots that
are present may move. Suspended and returning robots may not move, but neighbours still wait for their messages. Robots
that are gone are obstacles. A roll that lets a robot move and a roll that lists it as gone are never valid together.
";

const ROUNDS: &str = "\
Access points forward messages in the same rounds of beacons as robots. They take no part in routes and moves, and rest
until the next sample.
";

const REQUEST: &str = "\
The user sends its tasks to the first access point in every control period until an answer arrives.
";

fn chapter<L: Location, E: Event, S: Valuation>(
    title: &str,
    name: &str,
    text: &str,
    _: &Automaton<L, E, S>,
) -> String {
    let picture = format!("pictures/{name}.svg");
    let drawn = match name {
        "duty" => table_of_roles(),
        _ => format!("[![The {name} automaton]({picture})]({picture})\n"),
    };
    format!("## {title}\n\n{text}\n{drawn}")
}

// ---- The run in the README ---------------------------------------------------------------------

/// How many sentences of the story the README shows.
const SENTENCES: usize = 3;

/// The sentences of the story, as the program shows them.
#[derive(Default)]
struct Story(Vec<String>);

impl Watcher for Story {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        let telling = events.iter().filter(|event| story::is_telling(event));
        let line = |event| format!("k = {:<6} {}", snapshot.step, story::tell(event));
        self.0.extend(telling.map(line));
        Ok(())
    }
}

/// The pictures are drawn anew with everything else, and not compared.
#[test]
fn the_run_in_the_readme_is_up_to_date() {
    let scenario = study();
    let (mut story, mut summary) = (Story::default(), Summary::new(&scenario));
    let mut album = album(&scenario);
    let completed = mission::run(&scenario, &mut [&mut story, &mut summary, &mut album]).unwrap();
    if is_update() {
        let folder = std::env::temp_dir().join(format!("pleach-{}", std::process::id()));
        let figures = album.write(&folder, &completed.end).unwrap();
        keep_picture(&figures, "stationary", 1, "study-1-stuck.svg");
        fs::remove_dir_all(folder).unwrap();
    }
    let summary = summary.completed(completed, Duration::ZERO).to_string();
    let untimed = summary.lines().take_while(|line| !line.starts_with("  time "));
    let (first, last) = (&story.0[..SENTENCES], &story.0[story.0.len() - 1..]);
    let run: Vec<&str> = first
        .iter()
        .map(String::as_str)
        .chain(["…"])
        .chain(last.iter().map(String::as_str))
        .chain([""])
        .chain(untimed)
        .collect();

    let readme = read("README.md");
    let (before, rest) = readme.split_once(BEGIN_OF_RUN).unwrap();
    let (_, after) = rest.split_once(END_OF_RUN).unwrap();
    let run = run.join("\n");
    let refreshed = format!("{before}{BEGIN_OF_RUN}\n```text\n{run}\n```\n{END_OF_RUN}{after}");
    keep_up_to_date("README.md", &refreshed);
}

/// Study I while three of ten messages are lost and the leader stops on its way to the first task, as the
/// page on real robots shows it. The pictures are drawn anew with everything else.
#[test]
fn a_robot_that_is_lost_is_replaced_as_the_page_says() {
    let scenario = study();
    let crash = Crash { time: 200.0, inputs: 0, back: None };
    let storm = Storm {
        seed: 1,
        messages: MessageFaults { loss: 0.3, ..MessageFaults::default() },
        nodes: vec![(12, NodeFaults { crash: Some(crash), ..NodeFaults::default() })],
    };
    let mut album = Album::with_faults(&scenario, storm.faults());
    let (mut story, mut summary) = (Story::default(), Summary::new(&scenario));
    let mut watchers: [&mut dyn Watcher; 3] = [&mut story, &mut summary, &mut album];
    let completed = mission::run_in_storm(&scenario, &storm, &mut watchers).unwrap();
    assert_eq!(completed.end.outcome, Outcome::Serviced);
    let page = read("docs/how-to/real-robots.md");
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let at = |sentence: &str| -> usize {
        let told = story.0.iter().find(|line| line.contains(sentence)).unwrap();
        told.split_whitespace().nth(2).unwrap().parse().unwrap()
    };
    let elected = at("robot 8 is elected to lead to task 0");
    let serviced = at("task 0 is serviced by robot 8");
    let says = |sentence: String| assert!(page.contains(&sentence), "the page lacks: {sentence}");
    says(format!("services the task {} control periods later", serviced - elected));
    says(format!("after {} control periods", summary.periods()));
    if is_update() {
        let folder = std::env::temp_dir().join(format!("pleach-lost-{}", std::process::id()));
        let figures = album.write(&folder, &completed.end).unwrap();
        keep_picture(&figures, &format!("k{elected:05}"), 0, "study-1-robot-lost.svg");
        keep_picture(&figures, "animation", 0, "study-1-robot-lost-plays.svg");
        fs::remove_dir_all(folder).unwrap();
    }
}

const BEGIN_OF_RUN: &str =
    "<!-- begin of the run: PLEACH_UPDATE_DOCS=1 cargo test --test it documents -->";
const END_OF_RUN: &str = "<!-- end of the run -->";

fn album(scenario: &ValidScenario) -> Album {
    Album::new(scenario)
}

/// Copies the picture that is number `which` of those whose name contains `word`.
fn keep_picture(figures: &[PathBuf], word: &str, which: usize, name: &str) {
    let mut named = figures.iter().filter(|path| path.to_string_lossy().contains(word));
    fs::copy(named.nth(which).unwrap(), root().join("docs/pictures").join(name)).unwrap();
}

fn study() -> ValidScenario {
    scenario_file::read(&root().join("scenarios/study-1.toml")).unwrap()
}

// ---- Links and names ---------------------------------------------------------------------------

/// A link in Markdown: its text and its target.
struct Link {
    text: String,
    target: PathBuf,
}

/// The links of a document to files of this project, as paths from its root.
fn links(document: &str) -> Vec<Link> {
    let folder = Path::new(document).parent().unwrap();
    let text = read(document);
    let mut links = Vec::new();
    for (at, _) in text.match_indices("](") {
        let target = text[at + 2..].split(')').next().unwrap();
        if target.contains("://") || target.starts_with('#') {
            continue;
        }
        let name = text[..at].rsplit('[').next().unwrap();
        let target = folder.join(target.split('#').next().unwrap());
        links.push(Link { text: name.to_owned(), target });
    }
    links
}

#[test]
fn every_link_leads_to_a_file() {
    for document in WRITTEN {
        let links = links(document);
        assert!(!links.is_empty(), "{document} has no links");
        for Link { text, target } in links {
            assert!(root().join(&target).exists(), "{document}: [{text}] leads to {target:?}");
        }
    }
}

/// `[`name`](path.rs)` promises that path.rs has something called `name`; for a test the word
/// stands after `fn`.
#[test]
fn every_item_named_in_the_documents_exists() {
    let (mut items, mut missing) = (0, Vec::new());
    for document in WRITTEN {
        for Link { text, target } in links(document) {
            let Some(item) = text.strip_prefix('`').and_then(|text| text.strip_suffix('`')) else {
                continue;
            };
            let is_source = target.extension().is_some_and(|extension| extension == "rs");
            if is_source && item.chars().all(is_part_of_name) {
                let source = fs::read_to_string(root().join(&target)).unwrap();
                items += 1;
                if !declares(&source, item) {
                    missing.push(format!("{document}: {} has no `{item}`", target.display()));
                }
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(items > 100, "only {items} items are named");
}

/// Whether the source has a function, type, constant or module called `name`, or an enum variant or
/// field on a line of its own.
fn declares(source: &str, name: &str) -> bool {
    const KEYWORDS: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "mod", "static"];
    source.lines().map(str::trim_start).any(|line| {
        let words: Vec<&str> = line.split(|c| !is_part_of_name(c)).collect();
        let declared = words.windows(2).any(|pair| KEYWORDS.contains(&pair[0]) && pair[1] == name);
        let member = line.strip_prefix("pub ").unwrap_or(line).strip_prefix(name);
        declared
            || member.is_some_and(|rest| {
                rest.starts_with([',', ':', '(']) || rest == " {" || rest.starts_with(" { ")
            })
    })
}

fn is_part_of_name(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}
