//! Pages of missions.

use super::chromium::Page;
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::discrete::Location as _;
use pleach::mission::{self, Watcher};
use pleach::page::{self, MissionPage};
use pleach::trace::{TraceEntry, TraceReader, TraceWriter};
use pleach::{scenario_file, story};
use std::path::{Path, PathBuf};

const DESKTOP: [u32; 2] = [1360, 900];
const PHONE: [u32; 2] = [400, 820];
/// How far numbers on the page may be from those of the trace.
const ROUNDING: f64 = 1e-6;

/// A mission that has been run: its trace.
struct Run {
    scenario: ValidScenario,
    trace: String,
}

impl Run {
    fn of(name: &str) -> Run {
        let path = format!("{}/scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scenario = scenario_file::read(Path::new(&path)).unwrap();
        let mut trace = TraceWriter::new(Vec::new(), &scenario).unwrap();
        mission::run(&scenario, &mut [&mut trace]).unwrap();
        let trace = String::from_utf8(trace.finish().unwrap()).unwrap();
        Run { scenario, trace }
    }

    fn snapshots(&self) -> Vec<Snapshot> {
        let entries = TraceReader::new(self.trace.as_bytes()).unwrap();
        let snapshot = |entry| match entry {
            Ok(TraceEntry::Step(snapshot)) => Some(*snapshot),
            _ => None,
        };
        entries.filter_map(snapshot).collect()
    }

    /// The events, each with the control period for which it is recorded.
    fn events(&self) -> Vec<(usize, MissionEvent)> {
        let entries = TraceReader::new(self.trace.as_bytes()).unwrap();
        let event = |entry| match entry {
            Ok(TraceEntry::Event { step, event }) => Some((step, event)),
            _ => None,
        };
        entries.filter_map(event).collect()
    }
}

/// Writes a page where the browser finds it.
pub fn kept(name: &str, page: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("pleach-pages-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.html"));
    std::fs::write(&path, page).unwrap();
    path
}

fn open(name: &str, trace: &str) -> Page {
    let page = page::of_trace(trace.as_bytes()).unwrap();
    Page::open(&kept(name, &page), DESKTOP)
}

fn assert_content(page: &Page) {
    assert!(page.complaints.is_empty(), "{}", page.complaints.join("\n"));
}

/// Numbers on the page at control period `step` are those of the trace.
fn assert_numbers(page: &mut Page, snapshot: &Snapshot) {
    let step = snapshot.step;
    page.value(&format!("pleach.player.seek({step})"));
    assert_eq!(page.number("pleach.player.at"), step as f64);
    let shown = page.value(
        "(({ mission, player }) => ({ \
           position: mission.places(player.at).slice(0, mission.robots), \
           residual: [...Array(mission.robots).keys()].map(i => mission.residual(i, player.at)), \
           multiplier: [...Array(mission.robots).keys()].map(i => mission.multiplier(i, player.at)), \
           role: [...Array(mission.robots).keys()].map(i => mission.role(i, player.at)), \
           location: [...Array(mission.robots).keys()].map(i => mission.named('location', i, player.at)), \
           target: [...Array(mission.robots).keys()].map(i => mission.targetOf(i, player.at)), \
           heard: [...Array(mission.robots).keys()].map(i => mission.numbers.heard.at(i, player.at)), \
           route: mission.linksAt(player.at).map(l => [l.from, l.to, l.share, l.reliability]), \
           tree: mission.value('tree', player.at), \
           task: mission.value('task', player.at) }))(pleach)",
    );
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let close = |one: f64, other: f64| (one - other).abs() <= ROUNDING;
    for (robot, position) in snapshot.positions.iter().enumerate() {
        let place = &shown["position"][robot];
        assert!(close(number(&place[0]), position.x) && close(number(&place[1]), position.y));
        assert!(close(number(&shown["residual"][robot]), snapshot.residuals[robot]));
        assert!(close(number(&shown["multiplier"][robot]), snapshot.multipliers[robot]));
        assert_eq!(shown["role"][robot], snapshot.roles[robot].name());
        let view = snapshot.robots[robot];
        assert_eq!(shown["location"][robot], view.activity.name());
        assert_eq!(shown["heard"][robot].as_u64(), Some(view.heard));
        let target: Option<[f64; 2]> =
            serde_json::from_value(shown["target"][robot].clone()).unwrap();
        assert_eq!(target.is_some(), view.target.is_some());
        if let (Some([x, y]), Some(target)) = (target, view.target) {
            assert!(close(x, target.x) && close(y, target.y));
        }
    }
    let tree: Vec<(usize, usize)> = serde_json::from_value(shown["tree"].clone()).unwrap();
    assert_eq!(tree, snapshot.tree);
    assert_eq!(shown["task"].as_u64(), snapshot.task.map(|task| task as u64));
    let mut routes: Vec<(usize, usize, f64, f64)> =
        serde_json::from_value(shown["route"].clone()).unwrap();
    routes.sort_by_key(|(from, to, ..)| (*from, *to));
    // A share that rounds to 0 is not drawn.
    let visible: Vec<_> = (snapshot.routes.iter()).filter(|route| route.share > ROUNDING).collect();
    assert!(routes.len() >= visible.len());
    for route in visible {
        let found = routes.iter().find(|(from, to, ..)| (*from, *to) == (route.from, route.to));
        let (_, _, share, reliability) = found.unwrap();
        assert!(close(*share, route.share) && close(*reliability, route.reliability));
    }
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn study_one_says_what_its_trace_says() {
    let run = Run::of("study-1");
    let snapshots = run.snapshots();
    let mut page = open("study-1", &run.trace);
    assert_eq!(page.number("pleach.mission.count"), snapshots.len() as f64);
    for snapshot in snapshots.iter().step_by(37).chain(snapshots.last()) {
        assert_numbers(&mut page, snapshot);
    }
    assert_content(&page);
}

/// The story and the time line have the events of the trace, each at its control period.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn events_stand_where_the_trace_has_them() {
    let run = Run::of("study-1");
    let last = run.snapshots().len() - 1;
    let mut page = open("study-1-events", &run.trace);
    let told = page
        .value("[...document.querySelectorAll('#story .told')].map(entry => entry.textContent)");
    let mut expected: Vec<String> = (run.events().iter())
        .map(|(step, event)| format!("k = {step} {}", story::tell(event)))
        .collect();
    expected.push(format!("k = {last} the mission ends: serviced"));
    assert_eq!(told, serde_json::json!(expected));

    // The middles of the marks, and the ends of the line, in pixels.
    let middles = page.value(
        "[...document.querySelectorAll('.line .event')].map(mark => { \
           const { left, width } = mark.getBoundingClientRect(); return left + width / 2; })",
    );
    let middles: Vec<f64> = serde_json::from_value(middles).unwrap();
    let [left, width]: [f64; 2] = serde_json::from_value(page.value(
        "(({ left, width }) => [left, width])(\
         document.getElementById('scrubber').getBoundingClientRect())",
    ))
    .unwrap();
    let moments: Vec<usize> = (run.events().iter())
        .filter(|(_, event)| story::caption(event).is_some())
        .map(|(step, _)| *step)
        .collect();
    assert_eq!(middles.len(), moments.len());
    for (middle, step) in middles.iter().zip(moments) {
        let place = left + width * step as f64 / last as f64;
        assert!((middle - place).abs() < 0.5, "the mark of k = {step} is at {middle}, not {place}");
    }
    // The tasks, each over the stretch in which it is pursued.
    let bands = page.value(
        "[...document.querySelectorAll('.line .band')].map(band => [band.textContent, \
           Math.round((band.getBoundingClientRect().left - document.getElementById('scrubber') \
             .getBoundingClientRect().left) / document.getElementById('scrubber').clientWidth \
             * pleach.player.end)])",
    );
    let begins =
        |task| run.snapshots().iter().position(|snapshot| snapshot.task == Some(task)).unwrap();
    let expected: Vec<_> = (0..3).map(|task| (format!("task {task}"), begins(task))).collect();
    assert_eq!(bands, serde_json::json!(expected));
    assert_content(&page);
}

/// On paper the drawings keep their proportions, and none lies on another one: Chromium prints a
/// canvas with white where nothing is drawn.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn everything_is_seen_on_paper() {
    let run = Run::of("too-few");
    let mut page = open("too-few-paper", &run.trace);
    page.lay_out_for_paper();
    let canvases = page.value(
        "[...document.querySelectorAll('canvas')].map(canvas => { \
           const { left, top, width, height } = canvas.getBoundingClientRect(); \
           return [left, top, width, height, canvas.width, canvas.height]; })",
    );
    let canvases: Vec<[f64; 6]> = serde_json::from_value(canvases).unwrap();
    let shown: Vec<_> = canvases.iter().filter(|[_, _, width, ..]| *width > 0.0).collect();
    assert!(shown.len() >= 13, "the plan, eight marks and four charts: {shown:?}");
    for [_, _, width, height, columns, rows] in &shown {
        assert!((width * rows / columns - height).abs() < 1.0, "{width} by {height} is stretched");
    }
    for (number, [left, top, width, height, ..]) in shown.iter().enumerate() {
        for [x, y, w, h, ..] in &shown[..number] {
            let apart = x + w <= *left || left + width <= *x || y + h <= *top || top + height <= *y;
            assert!(apart, "two drawings lie on each other at ({left}, {top})");
        }
    }
    // The cursor, which is a surface of its own on screens, is drawn too.
    let dark = page.number(
        "(() => { const canvas = document.querySelectorAll('.plot canvas:not(.over)')[1]; \
           const { data } = canvas.getContext('2d') \
             .getImageData(0, canvas.height / 2, canvas.width, 1); \
           let dark = 0; \
           for (let i = 0; i < data.length; i += 4) dark += data[i] + data[i + 1] + data[i + 2] < 200 && data[i + 3] > 100; \
           return dark; })()",
    );
    assert!(dark >= 1.0, "the cursor is missing");
    assert_content(&page);
}

/// In a crowd on a small screen the numbers of robots without duty give way, and no other does.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn labels_do_not_cover_each_other() {
    let run = Run::of("study-1");
    let mut page = open("study-1-labels", &run.trace);
    page.resize(PHONE);
    page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
    for step in [0, 128, 358, 700] {
        let boxes = page.value(&format!(
            "(() => {{ pleach.player.seek({step}); return pleach.plan.places.boxes; }})()"
        ));
        let boxes: Vec<(serde_json::Value, [f64; 4])> = serde_json::from_value(boxes).unwrap();
        let keys: Vec<_> = boxes.iter().map(|(key, _)| key).collect();
        for node in 0..=13 {
            let is_idle =
                page.value(&format!("pleach.mission.markOf({node}, {step}).key === 'redundant'"));
            let is_named = keys.contains(&&serde_json::json!(node));
            assert!(is_named || is_idle == true, "node {node} has no label at k = {step}");
        }
        for (number, (key, one)) in boxes.iter().enumerate() {
            for (other, two) in &boxes[..number] {
                let along =
                    |axis: usize| one[axis + 2].min(two[axis + 2]) - one[axis].max(two[axis]);
                let covered = along(0).max(0.0) * along(1).max(0.0);
                let size = (one[2] - one[0]) * (one[3] - one[1]);
                assert!(covered <= 0.31 * size, "{key} lies on {other} at k = {step}");
            }
        }
    }
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn study_one_is_played_with_pointer_and_keys() {
    let run = Run::of("study-1");
    let mut page = open("study-1-played", &run.trace);
    assert_eq!(page.number("pleach.player.at"), 0.0);

    page.click("#play", None);
    page.value("new Promise(done => setTimeout(done, 700))");
    let played = page.number("pleach.player.at");
    assert!(played > 1.0, "after 0.7 s the run is at {played}");
    page.press(" ");
    assert_eq!(page.value("pleach.player.isPlaying"), false);
    let paused = page.number("pleach.player.at");
    assert_eq!(paused.fract(), 0.0, "a paused run is at a line of the trace");

    page.press("ArrowRight");
    assert_eq!(page.number("pleach.player.at"), paused + 1.0);
    page.press("End");
    assert_eq!(page.number("pleach.player.at"), run.snapshots().len() as f64 - 1.0);
    page.press("Home");
    page.press("ArrowDown");
    let told = page.value("pleach.player.events.find(event => event.moment).at");
    assert_eq!(page.value("pleach.player.at"), told);

    // An event on the time line, and one of the story.
    page.click(".line .event:nth-of-type(5)", None);
    let at = "pleach.player.events[document.querySelectorAll('.line .event')[4].dataset.event].at";
    assert_eq!(page.value("pleach.player.at"), page.value(at));
    let third =
        page.number("pleach.player.events.findIndex(event => event.event === 'stationary')");
    page.click(&format!("#story .told[data-event='{third}']"), None);
    let at = format!("pleach.player.events[{third}].at");
    assert_eq!(page.value("pleach.player.at"), page.value(&at));

    // The middle of the time line, and a row of the summary.
    page.click("#scrubber", None);
    let middle = (run.snapshots().len() as f64 - 1.0) / 2.0;
    assert!((page.number("pleach.player.at") - middle).abs() <= 2.0);
    page.click("#summary button.instant", None);
    let named = page.value("Number(document.querySelector('#summary button.instant').dataset.at)");
    assert_eq!(page.value("pleach.player.at"), named);
    assert_content(&page);
}

/// A page begins to play, but not where the system asks for less motion, nor where the address names an instant. What
/// is selected stays on the screen.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_page_begins_to_play() {
    let run = Run::of("study-1");
    let mut page = open("study-1-begins", &run.trace);
    let wait = "new Promise(done => setTimeout(done, 700))";
    page.value(wait);
    assert_eq!(page.number("pleach.player.at"), 0.0);

    page.prefer("reduced-motion", "no-preference");
    page.reload();
    page.value(wait);
    let played = page.number("pleach.player.at");
    assert!(played > 1.0, "after 0.7 s the run is at {played}");
    page.click("#story .told[data-event='0']", None);
    page.value(wait);
    assert_eq!(page.value("pleach.player.at"), page.value("pleach.player.events[0].at"));

    page.value("location.hash = 'at=0'");
    page.reload();
    page.value(wait);
    assert_eq!(page.number("pleach.player.at"), 0.0);
    assert_content(&page);
}

/// No event in the list is cut, wherever the run stands.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn the_list_of_events_shows_whole_entries() {
    let run = Run::of("study-1");
    let mut page = open("study-1-list", &run.trace);
    for step in [0, 50, 169, 293, 500, 800] {
        let cut = page.value(&format!(
            "(() => {{ pleach.player.seek({step}); \
               const list = document.querySelector('#story .list').getBoundingClientRect(); \
               return [...document.querySelectorAll('#story .told')].filter(entry => {{ \
                 const {{ top, height }} = entry.getBoundingClientRect(), lines = (list.top - top) / 21; \
                 return height && (top < list.top - 0.5 && top + height > list.top + 0.5 \
                   || Math.abs(lines - Math.round(lines)) > 0.03); }}).length; }})()"
        ));
        assert_eq!(cut, 0, "at k = {step}");
    }
    assert_content(&page);
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_robot_under_the_pointer_tells_its_facts() {
    let run = Run::of("study-1");
    let mut page = open("study-1-facts", &run.trace);
    page.value("pleach.player.seek(358)");
    let place: [f64; 2] = serde_json::from_value(page.value("pleach.plan.spots[11]")).unwrap();
    page.point("#plan", Some(place));
    let facts = page.value("document.getElementById('facts').innerText");
    let facts = facts.as_str().unwrap();
    for fact in
        ["Robot 11", "leader", "leading the team", "task 1, at (", "robot 10", "sent", "received"]
    {
        assert!(facts.contains(fact), "{fact} is not in {facts}");
    }
    page.photograph("study-1-facts");
    page.click("#plan", Some(place));
    page.point("h1", None);
    assert_eq!(page.number("pleach.selection.chosen"), 11.0);
    page.press("Escape");
    assert!(page.value("pleach.selection.chosen").is_null());

    // Every layer can be switched, and the plan changes.
    let pixels = "document.getElementById('plan').toDataURL().length";
    page.value("pleach.player.seek(240)");
    for layer in ["links", "tree", "path", "geodesic", "trails", "labels", "free_space", "cells"] {
        let before = page.number(pixels);
        page.click(&format!("[data-layer={layer}]"), None);
        assert_ne!(page.number(pixels), before, "layer {layer} changes nothing");
    }
    assert_content(&page);
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn pages_are_small_and_seek_in_time() {
    for (name, megabytes) in [("study-1", 2), ("hall", 6)] {
        let run = Run::of(name);
        let text = page::of_trace(run.trace.as_bytes()).unwrap();
        assert!(text.len() < megabytes << 20, "{name}: {} bytes", text.len());
        for needed in ["src=\"", "href=\"", "url(", "import ", "fetch("] {
            assert!(!text.contains(needed), "{name} needs something else: {needed}");
        }
        let mut page = Page::open(&kept(name, &text), DESKTOP);
        // Seeks over the whole run, each with everything drawn at once.
        let times = page.value(
            "(() => { const { player } = pleach, times = []; \
             for (let i = 0; i < 60; i++) { \
               const begin = performance.now(); \
               player.seek((i * 31 % 60) / 59 * player.end); \
               times.push(performance.now() - begin); } \
             return times.sort((one, other) => one - other); })()",
        );
        let times: Vec<f64> = serde_json::from_value(times).unwrap();
        let (median, worst) = (times[times.len() / 2], times[times.len() - 1]);
        println!(
            "{name}: {} bytes, a seek takes {median:.1} ms, at most {worst:.1} ms",
            text.len()
        );
        assert!(median < 50.0, "{name}: a seek takes {median} ms");
        for snapshot in run.snapshots().iter().step_by(400) {
            assert_numbers(&mut page, snapshot);
        }
        for scheme in ["light", "dark"] {
            page.prefer("color-scheme", scheme);
            page.value("pleach.player.seek(pleach.player.end * 0.55)");
            page.photograph(&format!("{name}-{scheme}"));
        }
        page.resize([1360, 2300]);
        page.photograph(&format!("{name}-whole"));
        page.resize(PHONE);
        page.value("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
        let width = page.number("document.documentElement.scrollWidth");
        assert!(width <= f64::from(PHONE[0]), "{name} is {width} pixels wide");
        page.photograph(&format!("{name}-narrow"));
        assert!(page.print().starts_with(b"%PDF"));
        assert_content(&page);
    }
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_mission_that_ends_early_is_shown_as_far_as_it_came() {
    let run = Run::of("too-few");
    let mut page = open("too-few", &run.trace);
    let outcome = page.value("document.querySelector('.outcome').innerText");
    assert!(outcome.as_str().unwrap().starts_with("insufficient robots"), "{outcome}");
    assert_content(&page);

    // Killed while it wrote a line.
    let torn = &run.trace[..run.trace.len() * 2 / 3];
    let whole_lines = torn.lines().filter(|line| line.contains("\"type\":\"step\"")).count() - 1;
    let mut page = open("torn", torn);
    let outcome = page.value("document.querySelector('.outcome').innerText");
    assert!(outcome.as_str().unwrap().starts_with("no end"), "{outcome}");
    assert!((page.number("pleach.mission.count") - whole_lines as f64).abs() <= 1.0);
    page.press("End");
    page.photograph("torn");
    assert_content(&page);

    // Not a single control period.
    let mut page = open("empty", run.trace.lines().next().unwrap());
    assert_eq!(page.number("pleach.mission.count"), 0.0);
    page.press(" ");
    page.photograph("empty");
    assert_content(&page);
}

#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_violated_invariant_is_told_and_marked() {
    let run = Run::of("too-few");
    let mut snapshots = run.snapshots();
    snapshots.truncate(40);
    // Robot 0 jumps across the room.
    let other = snapshots[39].positions[1];
    snapshots[39].positions[0] = other + nalgebra::Vector2::new(0.001, 0.0);
    let mut made = MissionPage::new(&run.scenario);
    let events = run.events();
    for snapshot in &snapshots {
        let now = events.iter().filter(|(step, _)| *step == snapshot.step);
        let now: Vec<MissionEvent> = now.map(|(_, event)| event.clone()).collect();
        made.observe(snapshot, &now).unwrap();
    }
    let reason = "two robots touch".to_owned();
    made.end(&End::new(Outcome::InvariantViolated, reason, None)).unwrap();
    let mut page = Page::open(&kept("violated", &made.render()), DESKTOP);
    let outcome = page.value("document.querySelector('.outcome.bad').innerText");
    assert!(outcome.as_str().unwrap().contains("two robots touch"), "{outcome}");
    page.click("#summary tr:last-child button.instant", None);
    let at = page.number("pleach.player.at");
    assert!((38.0..=39.0).contains(&at), "the violation is at {at}");
    page.photograph("violated");
    assert_content(&page);
}

/// Both teams and their tasks are told, and the way to the task is drawn from each leader.
#[test]
#[ignore = "needs Chromium: tests/browser/check"]
fn a_mission_of_two_teams_tells_of_both() {
    let run = Run::of("two-teams");
    let snapshot = &run.snapshots()[80];
    let mut page = open("two-teams", &run.trace);
    page.value("pleach.player.seek(80)");
    let facts = page.value(
        "[...document.querySelectorAll('table.facts tr')].map(row => \
           [...row.children].map(cell => cell.textContent))",
    );
    let told = |name: &str| -> Vec<String> {
        let rows = facts.as_array().unwrap().iter().filter(|row| row[0] == name);
        rows.map(|row| row[1].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(told("access point"), ["AP 0", "AP 1"]);
    let leaders: Vec<usize> =
        snapshot.pursuits().iter().filter_map(|it| it.primary_team.last().copied()).collect();
    assert_eq!(told("leader"), leaders.iter().map(|it| format!("robot {it}")).collect::<Vec<_>>());
    let tasks = snapshot.pursuits().into_iter().map(|it| it.task.unwrap().to_string());
    assert_eq!(told("task pursued"), tasks.collect::<Vec<_>>());
    let ways = page.value("pleach.mission.value('geodesic', 80).map(([leader]) => leader)");
    assert_eq!(ways, serde_json::json!(leaders));
    // The tasks of a team stand side by side, those of the other team below them.
    let bands = page.value(
        "[...document.querySelectorAll('.line .band')].map(band => [band.textContent, \
           band.offsetTop / band.offsetHeight])",
    );
    let lanes = [("task 0", 0), ("task 2", 0), ("task 1", 1), ("task 3", 1)];
    assert_eq!(bands, serde_json::json!(lanes));
    page.photograph("two-teams");
    assert_content(&page);
}
