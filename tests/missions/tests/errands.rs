//! Tasks with times: asked for late, serviced for a while, taken back. How such a mission goes, also where
//! messages are lost, and what the judge says of records in which tasks are dropped or closed for no reason.

use missions::{Mission, Period, run, run_by, shipped, used, valid};
use pleach::automaton::network::record::{MissionEvent as Event, Outcome, Snapshot};
use pleach::automaton::network::scenario::{Scenario, Strategy, Task};
use pleach::automaton::network::{Crash, NodeFaults};
use pleach::automaton::node::MessageFaults;
use pleach::discrete::network::activity::may_follow;
use pleach::discrete::network::{Activity, Role};
use pleach::mission::{Watcher, run_in_storm};
use pleach::story;
use pleach::summary::{Closing, Summary};
use pleach::trace::TraceWriter;
use pleach::verify::network::storm::{Kind, Storm, draw};
use pleach::verify::network::{Judge, Property, Violation};
use std::sync::OnceLock;

fn errands() -> &'static Mission {
    static MISSION: OnceLock<Mission> = OnceLock::new();
    MISSION.get_or_init(|| run(shipped("errands")))
}

/// When an event happens, if it does.
fn when(mission: &Mission, event: &Event) -> Option<usize> {
    mission.events().find(|(_, it)| *it == event).map(|(step, _)| step)
}

/// When a task is serviced, and by which robot.
fn service_of(mission: &Mission, task: usize) -> (usize, usize) {
    let service = |(step, event): (usize, &Event)| match *event {
        Event::TaskServiced { task: it, robot } if it == task => Some((step, robot)),
        _ => None,
    };
    mission.events().find_map(service).unwrap()
}

#[test]
fn tasks_are_announced_closed_and_taken_back_in_their_time() {
    let mission = errands();
    assert_eq!(mission.end.outcome, Outcome::Serviced, "{}", mission.end.reason);
    let tasks = &mission.scenario.task;
    for task in [0, 3] {
        let ended = when(mission, &Event::TaskEnded { task }).unwrap();
        let lasted = ended - service_of(mission, task).0;
        assert!((tasks[task].lasts.unwrap() as usize..).take(3).any(|it| it == lasted), "{lasted}");
    }
    for task in [2, 3] {
        let announced = when(mission, &Event::TaskAnnounced { task });
        assert_eq!(announced, tasks[task].announced.map(|it| it as usize), "nothing is in its way");
    }
    for task in [1, 2] {
        let withdrawn = when(mission, &Event::TaskWithdrawn { task });
        assert_eq!(withdrawn, tasks[task].withdrawn.map(|it| it as usize));
    }
    assert!(!mission.events().any(|(_, it)| matches!(it, Event::TaskServiced { task: 2, .. })));
}

/// The robots of a branch that services nothing are redundant again, one after the other.
#[test]
fn robots_of_tasks_that_are_over_are_free() {
    let mission = errands();
    let roles = |step: usize| &mission.periods[step].snapshot.roles;
    let (serviced, robot) = service_of(mission, 0);
    assert_eq!(roles(serviced)[robot], Role::Leaf);
    let ended = when(mission, &Event::TaskEnded { task: 0 }).unwrap();
    assert_eq!(roles(ended + 60)[robot], Role::Redundant);
    // Two tasks are taken back, one of them while it is pursued: nobody is of any use then.
    let idle = when(mission, &Event::TaskAnnounced { task: 3 }).unwrap() - 1;
    assert!(used(&mission.periods[idle].snapshot) <= 2, "{:?}", roles(idle));
    assert!(mission.periods[idle].snapshot.serviced.is_empty());
    assert!(mission.last().serviced.is_empty());
}

/// What a user is told: story, summary and the reason of the end.
#[test]
fn a_user_is_told_what_became_of_each_task() {
    let mission = errands();
    let told: Vec<String> = mission.events().map(|(_, event)| story::tell(event)).collect();
    assert!(told.iter().any(|it| it == "task 2 is taken back"), "{told:?}");
    assert!(told.iter().any(|it| it.starts_with("task 0 has ended")), "{told:?}");
    assert_eq!(
        mission.end.reason,
        "of 4 tasks 0 are serviced, and 4 have ended or been taken back"
    );
    let mut summary = Summary::new(&valid(mission.scenario.clone()));
    for Period { snapshot, events } in &mission.periods {
        summary.observe(snapshot, events).unwrap();
    }
    assert_eq!(summary.serviced(), 3);
    let closed = summary.tasks().iter().map(|task| task.closed.clone().unwrap().1);
    use Closing::{Ended, Withdrawn};
    assert!(closed.eq([Ended, Withdrawn, Withdrawn, Ended]));
    let text = summary.to_string();
    assert!(text.contains("(1.8, 0.35)    taken back at k = 360\n"), "{text}");
    assert!(text.contains("by robot 5, ended at k = "), "{text}");
}

/// A request that is lost is repeated, and a robot that hears late that its task is over stays until then.
#[test]
fn so_it_goes_where_messages_are_lost() {
    let scenario = valid(shipped("errands"));
    for (loss, seed) in [(0.3, 1), (0.3, 2), (0.5, 1), (0.5, 2)] {
        let messages = MessageFaults { loss, ..MessageFaults::default() };
        let storm = Storm { seed, messages, nodes: Vec::new() };
        let mut summary = Summary::new(&scenario);
        let completed = run_in_storm(&scenario, &storm, &mut [&mut summary]).unwrap();
        assert_eq!(completed.end.outcome, Outcome::Serviced, "{loss}: {:?}", completed.end);
        assert!(summary.tasks().iter().all(|task| task.closed.is_some()), "{loss}, seed {seed}");
        assert!(summary.serviced() >= 2, "{loss}, seed {seed}");
    }
}

/// p₁ calls for a recruit in the very round in which the leader reaches the task, and its notice is the newer one.
#[test]
fn a_task_that_is_serviced_is_pursued_no_longer() {
    let scenario = valid(shipped("errands"));
    let stops = |time: f64, back: Option<f64>| {
        let crash = Crash { time, inputs: 0, back };
        NodeFaults { crash: Some(crash), ..NodeFaults::default() }
    };
    let messages = MessageFaults { loss: 0.3, ..MessageFaults::default() };
    let nodes = vec![(5, stops(150.0, Some(170.0))), (7, stops(300.0, None))];
    let storm = Storm { seed: 0, messages, nodes };
    let end = run_in_storm(&scenario, &storm, &mut []).unwrap().end;
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// Whatever else fails, nothing is broken that must hold under any fault.
#[test]
fn no_storm_closes_a_task_before_its_time() {
    let mut scenario = shipped("errands");
    scenario.control.max_steps = Some(900);
    let scenario = valid(scenario);
    let nodes = [Kind::Partition, Kind::Crash, Kind::Restart, Kind::Late, Kind::AccessPoint];
    for kind in nodes.into_iter().chain([Kind::Copies]) {
        for seed in 0..3 {
            let storm = draw(kind, seed, &scenario, 600.0);
            let end = run_in_storm(&scenario, &storm, &mut []).unwrap().end;
            assert_ne!(end.outcome, Outcome::InvariantViolated, "{}: {}", kind.name(), end.reason);
        }
    }
}

/// A task may be taken back whatever its robots are doing: the monitor watches.
#[test]
fn a_task_may_be_taken_back_at_any_time() {
    let in_papers_order = (250..490).step_by(24).map(|withdrawn| (Strategy::Paper, withdrawn));
    let ahead = (170..350).step_by(18).map(|withdrawn| (Strategy::Eager, withdrawn));
    for (strategy, withdrawn) in in_papers_order.chain(ahead) {
        let mut scenario = shipped("leaf-leader");
        scenario.task[2].withdrawn = Some(withdrawn);
        scenario.task.push(Task { announced: Some(withdrawn), ..Task::at([0.85, 1.2]) });
        let mission = run_by(strategy, scenario);
        let said = format!("{strategy:?}, {withdrawn}: {}", mission.end.reason);
        assert_eq!(mission.end.outcome, Outcome::Serviced, "{said}");
        assert_eq!(mission.last().serviced.len(), 3, "{said}");
    }
}

/// And it may end whatever they are doing.
#[test]
fn a_task_may_end_at_any_time() {
    for lasts in (5..385).step_by(38) {
        let mut scenario = shipped("leaf-leader");
        scenario.task[0].lasts = Some(lasts);
        scenario.task[1].lasts = Some(lasts / 2 + 1);
        let mission = run(scenario);
        assert_eq!(mission.end.outcome, Outcome::Serviced, "{lasts}: {}", mission.end.reason);
        assert_eq!(mission.last().serviced.len(), 1, "{lasts}");
    }
}

/// A snapshot shows which tasks are over from when robots hear so; where there are none, nothing is written.
#[test]
fn what_is_over_is_shown() {
    let mission = errands();
    let shown = |step: usize, task: usize| mission.periods[step].snapshot.closed.contains(&task);
    for (step, event) in mission.events() {
        if let Event::TaskEnded { task } | Event::TaskWithdrawn { task } = *event {
            let after = (step + 1).min(mission.periods.len() - 1);
            assert!(!shown(step - 1, task) && shown(after, task), "task {task} at k = {step}");
        }
    }
    let written = |closed: Vec<usize>| {
        let last = Snapshot { closed, ..mission.last().clone() };
        let mut writer = TraceWriter::new(Vec::new(), &mission.scenario).unwrap();
        writer.observe(&last, &[]).unwrap();
        String::from_utf8(writer.finish().unwrap()).unwrap()
    };
    assert!(written(vec![0, 2]).contains(r#","closed":[0,2]"#));
    assert!(!written(Vec::new()).contains("closed"));
}

/// A robot may join the primary team in the very control period in which the task is taken back.
#[test]
fn a_team_that_is_dissolved_is_told_to_have_no_leader() {
    let is_join = |(_, event): &(usize, &Event)| matches!(event, Event::JoinedPrimary { .. });
    let (step, _) = errands().events().find(is_join).unwrap();
    let mut scenario = shipped("errands");
    scenario.task[0].withdrawn = Some(step as u32);
    let mission = run(scenario);
    let told: Vec<String> = mission.events().map(|(_, event)| story::tell(event)).collect();
    let dissolved = "joins the primary team, which has no leader at the end of the control period";
    assert!(told.iter().any(|it| it.contains(dissolved)), "{told:?}");
    assert!(told.iter().all(|it| !it.contains("[]")), "{told:?}");
}

/// Two tasks at one place: the leader to the second stands there when it is released from the first, so that it
/// announces the advance of the team and the service in one control period. No other task follows.
#[test]
fn a_leader_may_be_at_its_task_when_it_is_released() {
    for strategy in [Strategy::Paper, Strategy::Eager] {
        let mut scenario = shipped("errands");
        let place = [0.7, 1.0];
        scenario.task = vec![Task::at(place), Task { lasts: Some(30), ..Task::at(place) }];
        let mission = run_by(strategy, scenario);
        assert_eq!(mission.end.outcome, Outcome::Serviced, "{}", mission.end.reason);
        let (released, robot) = mission
            .events()
            .find_map(|(step, event)| match *event {
                Event::Released { robot } => Some((step, robot)),
                _ => None,
            })
            .unwrap();
        assert_eq!(service_of(&mission, 1), (released, robot), "{strategy:?}");
    }
}

/// A task of which nothing is asked but its place is written as it always was.
#[test]
fn tasks_without_times_are_written_without_them() {
    let header = |scenario: &Scenario| {
        let bytes = TraceWriter::new(Vec::new(), scenario).unwrap().finish().unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let plain = header(&shipped("redundant-node"));
    assert!(plain.contains(r#""task":[{"position":["#) && !plain.contains("lasts"), "{plain}");
    let timed = header(&shipped("errands"));
    assert!(timed.contains(r#"{"position":[0.7,1.0],"announced":480,"lasts":40}"#), "{timed}");
}

// ---- Spoiled records -------------------------------------------------------------------------

fn judged(mission: &Mission) -> Result<(), Violation> {
    let scenario = valid(mission.scenario.clone());
    let mut judge = Judge::new(&scenario, may_follow);
    for Period { snapshot, events } in &mission.periods {
        judge.observe(snapshot, events)?;
    }
    judge.conclude(&mission.end)
}

/// What the judge says of the mission after a change.
fn complaint(change: impl Fn(&mut Mission)) -> (Property, String) {
    let mut spoiled = errands().clone();
    change(&mut spoiled);
    let violation = judged(&spoiled).unwrap_err();
    (violation.property, violation.to_string())
}

fn drop_event(mission: &mut Mission, event: &Event) {
    mission.periods.iter_mut().for_each(|period| period.events.retain(|it| it != event));
}

fn tell(mission: &mut Mission, step: usize, event: Event) {
    mission.periods[step].events.push(event);
}

#[test]
fn a_record_in_which_nothing_is_changed_is_sound() {
    assert_eq!(judged(errands()), Ok(()));
}

/// Without the event the robots have dropped what they serviced or pursued.
#[test]
fn a_task_that_is_dropped_is_none_that_has_ended_or_was_taken_back() {
    for (event, property) in [
        (Event::TaskEnded { task: 0 }, Property::Duties),
        (Event::TaskWithdrawn { task: 1 }, Property::Duties),
        (Event::TaskWithdrawn { task: 2 }, Property::Stage),
        (Event::TaskEnded { task: 3 }, Property::Outcome),
    ] {
        let (found, sentence) = complaint(|mission| drop_event(mission, &event));
        assert!(found == property || found == Property::Duties, "{event:?}: {sentence}");
    }
}

#[test]
fn tasks_are_closed_only_as_the_user_wants_it() {
    let (serviced, _) = service_of(errands(), 1);
    let closed = |step: usize, event: Event, expected: &str| {
        let (property, sentence) = complaint(|mission| {
            drop_event(mission, &event);
            tell(mission, step, event.clone());
        });
        assert_eq!(property, Property::Events, "{sentence}");
        assert!(sentence.contains(expected), "{sentence}");
    };
    closed(
        serviced + 9,
        Event::TaskEnded { task: 1 },
        "task 1 ends, and the scenario states no `lasts` for it",
    );
    closed(160, Event::TaskEnded { task: 0 }, "task 0 ends, and it is to end at k = 185");
    closed(300, Event::TaskWithdrawn { task: 0 }, "and the scenario states no `withdrawn` for it");
    closed(350, Event::TaskWithdrawn { task: 2 }, "and it is taken back at k = 360");
    closed(479, Event::TaskAnnounced { task: 3 }, "and it is asked for at k = 480");
    let (property, sentence) =
        complaint(|mission| tell(mission, 200, Event::TaskEnded { task: 0 }));
    assert!(property == Property::Events && sentence.contains("task 0 ends"), "{sentence}");
}

#[test]
fn no_task_is_shown_as_over_that_is_not() {
    let (property, sentence) = complaint(|mission| mission.periods[150].snapshot.closed = vec![1]);
    assert_eq!(property, Property::Duties);
    assert!(sentence.contains("task 1 is shown as over, and it has neither ended"), "{sentence}");
    let (property, sentence) = complaint(|mission| mission.periods[350].snapshot.closed.clear());
    assert_eq!(property, Property::Duties);
    assert!(sentence.contains("task 0 is over, and is not shown so any more"), "{sentence}");
    let (property, sentence) = complaint(|mission| mission.periods[150].snapshot.closed = vec![9]);
    assert_eq!(property, Property::Record, "{sentence}");
}

/// Also while robots may not have heard yet that the task is taken back that they pursue.
#[test]
fn a_task_is_taken_back_once() {
    let (withdrawn, task) = (360, 2);
    for step in [withdrawn, withdrawn + 1, withdrawn + 100] {
        let copy = Event::TaskWithdrawn { task };
        let (property, sentence) = complaint(|mission| tell(mission, step, copy.clone()));
        assert_eq!(property, Property::Events, "{sentence}");
        assert!(sentence.contains("task 2 is taken back, and it is over already"), "{sentence}");
    }
}

/// Robots that go on with a task that is over are told.
#[test]
fn a_robot_that_never_hears_that_its_task_is_over_is_told() {
    let ended = when(errands(), &Event::TaskEnded { task: 0 }).unwrap();
    let robot = service_of(errands(), 0).1;
    let held = &errands().periods[ended - 1].snapshot.posts;
    let post = *held.iter().find(|post| post.holder == robot).unwrap();
    let (property, sentence) = complaint(|mission| {
        for period in &mut mission.periods[ended..] {
            let is_its = |event: &Event| matches!(event, Event::RoleChanged { robot: it, .. } if *it == robot);
            period.events.retain(|event| !is_its(event));
            let now = &mut period.snapshot;
            now.roles[robot] = Role::Leaf;
            now.robots[robot].activity = Activity::Leaf;
            now.serviced.retain(|(task, _)| *task != 0);
            now.serviced.insert(0, (0, robot));
            now.posts.retain(|it| it.holder != robot);
            now.posts.push(post);
        }
    });
    assert!(
        property == Property::Duties && sentence.contains("answers for task 0, and that is over"),
        "{property:?}: {sentence}"
    );
}
