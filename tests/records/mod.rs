//! Records of missions as somebody has changed them: the judge says what is wrong, and what it
//! lets pass is lawful for a reason.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it records` writes the table of `docs/proofs.md` anew.

mod change;
mod edits;
mod events;
mod lawful;
mod snapshots;
mod spoils;

use crate::generated::{keep_up_to_date, read};
use change::{Change, Record};
use missions::{Mission, Period, run, run_by, shipped, trace_of};
use pleach::automaton::network::record::{End, Outcome};
use pleach::automaton::network::scenario::Strategy;
use pleach::discrete::network::activity::may_follow;
use pleach::judge::{JudgeError, Verdict, judge};
use pleach::trace::TraceReader;
use pleach::verify::network::{Judge, Property, Violation};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// At how many control periods of a mission each change is tried.
const SITES: usize = 3;

/// Missions in which every kind of event but a repeated election happens: teams stand still only in the paper's order.
const MISSIONS: [(&str, Strategy); 3] = [
    ("corridor", Strategy::Paper),
    ("leaf-leader", Strategy::Paper),
    ("corridor", Strategy::Eager),
];

fn missions() -> &'static [Mission] {
    static MISSION: OnceLock<Vec<Mission>> = OnceLock::new();
    let mission_of = |(name, strategy)| run_by(strategy, shipped(name));
    MISSION.get_or_init(|| MISSIONS.map(mission_of).into())
}

/// The trace of a record as its file holds it.
fn trace(scenario: &pleach::automaton::network::scenario::Scenario, record: &Record) -> Vec<u8> {
    trace_of(scenario, &record.periods, &record.end)
}

/// What the judge says of a record whose periods before `site` are those of the mission;
/// `before` has judged these.
fn verdict(mut before: Judge, record: &Record, site: usize) -> Result<(), Violation> {
    for Period { snapshot, events } in &record.periods[site..] {
        before.observe(snapshot, events)?;
    }
    before.conclude(&record.end)
}

/// The control periods at which a change is tried: some of those at which it changes anything,
/// always the same.
fn sites(mission: &Mission, change: &Change) -> Vec<(usize, Record)> {
    let count = mission.periods.len();
    // 61 is prime to the numbers of periods: each is visited once.
    let visited = (0..count).map(|index| (index * 61 + count / 3) % count);
    let changed = visited.filter(|&site| changes_something(mission, change, site)).map(|site| {
        let mut record = Record::of(mission);
        (change.make)(&mut record, site);
        (site, record)
    });
    changed.take(SITES).collect()
}

/// How far a change reads before and behind its site.
const REACH: usize = 8;

/// Whether a change differs from the record, seen in the periods around its site.
fn changes_something(mission: &Mission, change: &Change, site: usize) -> bool {
    let begin = site.saturating_sub(1);
    let end = mission.periods.len().min(site + REACH);
    let around = Record { periods: mission.periods[begin..end].to_vec(), end: mission.end.clone() };
    let mut changed = around.clone();
    (change.make)(&mut changed, site - begin);
    changed != around
}

/// How a change was judged: at how many sites it was tried, at how many it was noticed, and where it passed.
#[derive(Default)]
struct Fate {
    tried: usize,
    noticed: usize,
    unnoticed: Vec<String>,
}

/// The fate of every change, by its name.
fn fates(changes: &[Change]) -> BTreeMap<&'static str, Fate> {
    let mut fates = BTreeMap::<_, Fate>::new();
    for mission in missions() {
        let scenario = missions::valid(mission.scenario.clone());
        let mut tries: Vec<_> = changes
            .iter()
            .flat_map(|change| {
                sites(mission, change).into_iter().map(|(site, record)| (site, change.name, record))
            })
            .collect();
        tries.sort_by_key(|&(site, ..)| site);
        let mut judge = Judge::new(&scenario, may_follow);
        let mut judged = 0;
        for (site, name, record) in tries {
            for Period { snapshot, events } in &mission.periods[judged..site] {
                judge.observe(snapshot, events).unwrap();
            }
            judged = site;
            let fate = fates.entry(name).or_default();
            fate.tried += 1;
            match verdict(judge.clone(), &record, site) {
                Ok(()) => fate.unnoticed.push(format!(
                    "{}, {:?}, at k = {site}",
                    mission.scenario.name, mission.scenario.control.strategy
                )),
                Err(_) => fate.noticed += 1,
            }
        }
    }
    fates
}

#[test]
fn every_changed_record_is_noticed_or_lawful() {
    let changes: Vec<Change> = [edits::ALL, snapshots::ALL, events::ALL, events::FALSE].concat();
    let names: BTreeSet<_> = changes.iter().map(|change| change.name).collect();
    assert_eq!(names.len(), changes.len(), "a name stands for one change");
    let fates = fates(&changes);
    let mut wrong = Vec::new();
    let (mut tried, mut noticed) = (0, 0);
    let mut passing = BTreeMap::<_, Vec<_>>::new();
    for change in &changes {
        let Some(fate) = fates.get(change.name) else {
            wrong.push(format!("“{}” changes nothing anywhere", change.name));
            continue;
        };
        let reason = lawful::reason(change.name);
        match (fate.unnoticed.is_empty(), reason) {
            (false, None) => {
                wrong.push(format!("“{}” passes: {}", change.name, fate.unnoticed.join(", ")));
            }
            (true, Some(_)) => wrong.push(format!("“{}” is always noticed", change.name)),
            _ => {}
        }
        tried += fate.tried;
        noticed += fate.noticed;
        if let Some(reason) = reason {
            passing.entry(reason).or_default().push(change.name);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let lawful = lawful::REASONS.iter().find(|(name, _)| !names.contains(name));
    assert!(lawful.is_none(), "{lawful:?} is no change");
    let row =
        |(reason, names): (&&str, &Vec<&str>)| format!("| {} | {reason} |\n", names.join("; "));
    let rows: String = passing.iter().map(row).collect();
    keep_table(&format!(
        "{} kinds of change: {noticed} of {tried} instances are noticed.\n\n\
         | changes that may pass | why the record is lawful then |\n\
         | --- | --- |\n{rows}",
        changes.len(),
    ));
}

const BEGIN: &str =
    "<!-- begin of the table: PLEACH_UPDATE_DOCS=1 cargo test --test it records -->";
const END: &str = "<!-- end of the table -->";

fn keep_table(table: &str) {
    let document = read("docs/proofs.md");
    let (before, rest) = document.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let refreshed = format!("{before}{BEGIN}\n\n{table}\n{END}{after}");
    keep_up_to_date("docs/proofs.md", &refreshed, "records");
}

// ---- Spoiled records of Study I -----------------------------------------------------------------

#[test]
fn every_spoiled_record_is_noticed() {
    let mission = run(shipped("study-1"));
    let mut passed = Vec::new();
    for (name, spoil, properties) in spoils::ALL {
        let mut record = Record::of(&mission);
        spoil(&mut record);
        let text = trace(&mission.scenario, &record);
        match judge(TraceReader::new(text.as_slice()).unwrap()).unwrap() {
            Verdict::Sound { .. } => passed.push(format!("{name}: passes")),
            Verdict::Violated(violation) if !properties.contains(&violation.property) => {
                passed.push(format!("{name}: {violation}"));
            }
            Verdict::Violated(_) => {}
        }
    }
    assert!(passed.is_empty(), "{}", passed.join("\n"));
}

// ---- Traces -------------------------------------------------------------------------------------

#[test]
fn a_trace_is_judged_alone() {
    for mission in missions() {
        let record = Record::of(mission);
        let text = trace(&mission.scenario, &record);
        let verdict = judge(TraceReader::new(text.as_slice()).unwrap()).unwrap();
        let run = mission.periods.len();
        assert!(matches!(verdict, Verdict::Sound { periods, .. } if periods == run));
    }
}

/// The lines of a trace, changed, and what the judge says of them.
#[track_caller]
fn expect(property: Property, sentence: &str, change: impl Fn(&mut Vec<String>)) {
    let mission = &missions()[1];
    let text = String::from_utf8(mission.trace()).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    change(&mut lines);
    let text = lines.join("\n");
    match judge(TraceReader::new(text.as_bytes()).unwrap()).unwrap() {
        Verdict::Violated(violation) => {
            assert_eq!(violation.property, property, "{violation}");
            assert!(violation.sentence.contains(sentence), "{violation}");
        }
        Verdict::Sound { .. } => panic!("it passes"),
    }
}

#[test]
fn a_trace_has_one_end() {
    expect(Property::Outcome, "breaks off", |lines| drop(lines.pop()));
    expect(Property::Record, "goes on after its end", |lines| {
        let step = lines[lines.len() - 2].clone();
        lines.push(step);
    });
    expect(Property::Record, "before this step", |lines| {
        let event = lines.iter().position(|line| line.contains("\"reattached\"")).unwrap();
        let step = lines.iter().skip(event).position(|line| line.contains("\"step\"")).unwrap();
        let line = lines.remove(event);
        lines.insert(event + step, line);
    });
    expect(Property::Record, "after the last step", |lines| {
        let event = lines.iter().find(|line| line.contains("\"reattached\"")).unwrap().clone();
        lines.insert(lines.len() - 1, event);
    });
}

#[test]
fn a_trace_that_no_mission_starts_from_is_not_judged() {
    let mission = &missions()[1];
    let text = String::from_utf8(mission.trace()).unwrap();
    let spoiled = text.replacen("\"full_range\":0.4", "\"full_range\":0.6", 1);
    assert_ne!(spoiled, text);
    let error = judge(TraceReader::new(spoiled.as_bytes()).unwrap()).unwrap_err();
    assert!(matches!(error, JudgeError::Scenario(_)), "{error}");
}

/// After the last task is serviced, too, while robots come to rest.
#[test]
fn an_interrupted_mission_is_sound_as_far_as_it_goes() {
    let whole = &missions()[1];
    let reason = "the run was interrupted".to_owned();
    for mission in [whole.up_to(100), whole.clone()] {
        let end = End::new(Outcome::Interrupted, reason.clone(), Some(0));
        let text = trace(&mission.scenario, &Record { end, ..Record::of(&mission) });
        let verdict = judge(TraceReader::new(text.as_slice()).unwrap()).unwrap();
        let periods = mission.periods.len();
        assert!(matches!(verdict, Verdict::Sound { periods: it, .. } if it == periods));
    }
}
