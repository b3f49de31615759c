//! Models of SpaceEx: what is read, written and refused.

use crate::command_line::pleach;
use crate::generated::keep_up_to_date;
use pleach::automaton::diagram::Patch;
use pleach::guards::Interval;
use pleach::spaceex::{self, Initial, Problem, Verdict, Written};
use pleach::verify::reach::{Completion, Directions, Effort, StateSet};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

const BALL: [&str; 2] =
    [include_str!("spaceex/bouncing-ball.xml"), include_str!("spaceex/bouncing-ball.cfg")];
const TIMERS: [&str; 2] =
    [include_str!("spaceex/two-timers.xml"), include_str!("spaceex/two-timers.cfg")];

/// A lamp within a room: networks within each other, numbers of inner components by their names, and
/// directions across constraints.
const RELAY: [&str; 2] = [include_str!("spaceex/relay.xml"), include_str!("spaceex/relay.cfg")];

fn problem([model, configuration]: [&str; 2]) -> Problem {
    spaceex::read(model, configuration).unwrap()
}

fn verdict(problem: &Problem) -> Verdict {
    problem.solve(&Effort::default(), &mut |_| ControlFlow::Continue(())).unwrap().verdict()
}

fn refusal(model: &str, configuration: &str) -> String {
    spaceex::read(model, configuration).unwrap_err().to_string()
}

#[test]
fn a_component_with_bound_constants_is_read_and_answered() {
    let ball = problem(BALL);
    assert_eq!(ball.system, "system");
    let automaton = &ball.automata[0];
    assert_eq!(automaton.names(), ["v", "x"]);
    assert_eq!(automaton.locations().len(), 1);
    assert_eq!(ball.initial[0].locations, ["flying"]);
    assert_eq!(verdict(&ball), Verdict::Holds);
    let low = BALL[1].replace("x >= 10.25", "x >= 10.1 & v > -1");
    assert_eq!(verdict(&problem([BALL[0], &low])), Verdict::Violated);
}

/// Sets at the floor are merged into one, from which a ball of half a metre more or less rises higher than
/// it was dropped: the proof needs finer ones.
#[test]
fn where_merged_sets_decide_nothing_finer_ones_are_tried() {
    let dropped = BALL[1].replace("10 <= x <= 10.2", "1 <= x <= 1.2");
    let dropped = dropped.replace("x >= 10.25", "x >= 1.25");
    for horizon in ["time-horizon = 2", "time-horizon = 3"] {
        let ball = problem([BALL[0], &dropped.replace("time-horizon = 6", horizon)]);
        assert_eq!(verdict(&ball), Verdict::Holds, "{horizon}");
    }
}

/// Runs may jump to and fro at any time and as often as they like: all of what follows is known once both
/// locations have been visited.
#[test]
fn jumps_without_end_lead_to_what_is_known() {
    let model = r#"<sspaceex><component id="switch">
        <param name="x" type="real" d1="1" d2="1" local="false" dynamics="any"/>
        <location id="1" name="off"><flow>x' == 0</flow></location>
        <location id="2" name="on"><flow>x' == 0</flow></location>
        <transition source="1" target="2"/>
        <transition source="2" target="1"/>
    </component></sspaceex>"#;
    let asked = "initially = \"x == 1 & loc()==off\"\nforbidden = \"x >= 2\"\ntime-horizon = 20\nsampling-time = 0.1\n";
    assert_eq!(verdict(&problem([model, asked])), Verdict::Holds);
}

/// Two components that tick together, an input within bounds, a value within bounds after a jump, and
/// no word on where the tank begins: in both of its locations.
#[test]
fn networks_are_products() {
    let timers = problem(TIMERS);
    let names: Vec<&str> = timers.automata[0].locations().iter().map(|one| one.as_str()).collect();
    assert_eq!(names, ["waiting, open", "waiting, shut"]);
    assert_eq!(timers.initial[0].locations, names);
    assert_eq!(timers.automata.len(), 2);
    assert_eq!(timers.automata[0].names(), ["clock", "level"]);
    let uncertain: Vec<(&str, Interval)> =
        timers.uncertain.iter().map(|one| (one.parameter.as_str(), one.values)).collect();
    assert_eq!(uncertain, [("inflow", Interval::new(0.0, 0.5).unwrap())]);
    let solution = timers.solve(&Effort::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(solution.verdict(), Verdict::Holds);
    assert_eq!(solution.proofs[0].enclosure.ending, Completion::Horizon);
    // Shut for a second, the tank rises by up to a half from at most 1.25.
    let full = TIMERS[1].replace("level >= 2.5", "level >= 1.8");
    assert_eq!(verdict(&problem([TIMERS[0], &full])), Verdict::Holds);
    let full = TIMERS[1].replace("level >= 2.5", "level >= 1.6");
    assert_eq!(verdict(&problem([TIMERS[0], &full])), Verdict::Violated);
}

fn write(problem: &Problem) -> Written {
    spaceex::write(
        &problem.automata[0],
        &problem.uncertain,
        &problem.initial,
        &problem.forbidden,
        &problem.settings,
        &problem.shown,
    )
    .unwrap()
}

/// What is written reads back as the same automaton and the same question.
#[test]
fn what_is_written_is_read_back() {
    let tank = [TANK, "initially = \"x == 0\"\nforbidden = \"y >= 6\"\ntime-horizon = 10\n"];
    for files in [BALL, TIMERS, RELAY, tank] {
        let first = problem(files);
        let written = write(&first);
        let second = problem([&written.model, &written.configuration]);
        let names = |problem: &Problem| -> Vec<String> {
            problem.automata[0].locations().iter().map(|one| one.as_str().to_owned()).collect()
        };
        assert_eq!(names(&first), names(&second));
        assert_eq!(first.initial.len(), second.initial.len());
        assert_eq!(verdict(&first), verdict(&second));
        assert_eq!(write(&second), written);
        assert_eq!((&second.settings, &second.shown), (&first.settings, &first.shown));
    }
}

/// Comparisons between variables, strict ones, and curved ones are written with the box of the initial states.
#[test]
fn initial_states_are_written_with_all_that_bounds_them() {
    let begin = "10 <= x & x <= 10.2 & 0 <= v & v <= 0.1 & loc(one)==flying & ";
    let ball = |more: &str, forbidden: &str| {
        let start = BALL[1]
            .replace("10 <= x <= 10.2 & v == 0 & loc(one)==flying", &format!("{begin}{more}"));
        problem([BALL[0], &start.replace("x >= 10.25", forbidden)])
    };
    for more in [
        "x + v <= 10.05",
        "x + 2*v < 10.05",
        "x*x + v*v <= 101",
        "x < 10.05",
        "x - v == 10.05",
        "10.1 > x + v*v",
    ] {
        let first = ball(more, "x >= 10.15");
        let written = write(&first);
        let second = problem([&written.model, &written.configuration]);
        assert_eq!(second.initial, first.initial, "{more}: {}", written.configuration);
        assert_eq!(write(&second), written);
    }
    let first = ball("x + v <= 10.05", "x >= 10.15");
    let written = write(&first);
    let second = problem([&written.model, &written.configuration]);
    assert_eq!((verdict(&first), verdict(&second)), (Verdict::Holds, Verdict::Holds));

    // No list of comparisons says what is in a zonotope.
    let around = Initial {
        states: StateSet::from_zonotope(first.initial[0].states.to_zonotope()),
        ..first.initial[0].clone()
    };
    let error = spaceex::write(&first.automata[0], &[], &[around], &[], &first.settings, &[]);
    assert!(error.unwrap_err().starts_with("initial states that are a zonotope cannot be written"));
}

/// `room.lamp.h` is the heat of the room, `h` of the whole; `room.lamp.age` is the lamp's own; the lamp's
/// `loss` is the number 0.5.
#[test]
fn numbers_of_inner_components_have_names() {
    let relay = problem(RELAY);
    assert_eq!(relay.automata[0].names(), ["h", "room.lamp.age"]);
    assert_eq!(relay.initial[0].locations, ["on"]);
    let sides: Vec<String> =
        relay.initial[0].states.hull().iter().map(|side| side.to_string()).collect();
    assert_eq!(sides, ["[1, 1.5]", "[0, 0]"]);
    assert_eq!(relay.shown, ["room.lamp.age", "h"]);
    assert_eq!(
        relay.settings.directions,
        Directions::Listed(vec![vec![1.0, -2.0], vec![1.0, 0.5]])
    );
    assert_eq!(verdict(&relay), Verdict::Holds);
    let early = RELAY[1].replace("room.lamp.age >= 2.1", "room.lamp.age >= 1.9");
    assert_eq!(verdict(&problem([RELAY[0], &early])), Verdict::Violated);
    // Negative horizons are none, and further directions add up.
    let endless = RELAY[1].replace("time-horizon = 5", "time-horizon = -1") + "directions = oct\n";
    let endless = problem([RELAY[0], &endless]);
    assert_eq!(endless.settings.horizon, f64::INFINITY);
    let Directions::Listed(listed) = &endless.settings.directions else {
        panic!("they are listed")
    };
    assert!(listed.contains(&vec![1.0, 1.0]) && listed.contains(&vec![1.0, -2.0]), "{listed:?}");
}

/// What the configuration says of inner components is refused with its line.
#[test]
fn names_of_inner_components_are_checked() {
    let asked = |from: &str, to: &str| refusal(RELAY[0], &RELAY[1].replace(from, to));
    assert_eq!(
        asked("1 <= room.h", "1 <= room.g"),
        "line 2 of the configuration: `room.g` is no variable or constant of the system"
    );
    assert_eq!(
        asked("\"room.lamp.age, h\"", "\"room.lamp.loss, h\""),
        "line 6 of the configuration: `room.lamp.loss` cannot be shown: there are t, h, room.lamp.age"
    );
    assert_eq!(
        asked("loc(room.lamp)", "loc(lamp)"),
        "line 2 of the configuration: `loc(lamp)`: there is no such component; there are room.lamp"
    );
    assert_eq!(
        asked("h - 2 * room.lamp.age <= 0", "h * room.lamp.age <= 0"),
        "line 5 of the configuration: `h · room.lamp.age − 0` has no direction: a direction is given by a \
         linear constraint as x + y <= 0"
    );
    assert_eq!(
        asked("h - 2 * room.lamp.age <= 0", "q <= 0"),
        "line 5 of the configuration: `q` is no variable or constant of the system"
    );
    assert_eq!(
        asked("<= 0}\"", "<= 0\""),
        "line 5 of the configuration: `{h - 2 * room.lamp.age <= 0 & room.h + 0.5 * room.lamp.age <= 0` \
         lacks its `}`"
    );
}

#[test]
fn what_is_not_supported_is_refused_with_its_line() {
    let [model, configuration] = BALL;
    let changed = |from: &str, to: &str| model.replace(from, to);
    let cases = [
        (
            changed("v' == -g</flow>", "v' &lt;= -g</flow>"),
            "line 12 of the model: the flow of `flying` is to say x' == … for each variable; inclusions of \
             rates are not supported: add an input within bounds",
        ),
        (
            changed("<map key=\"c\">0.75</map>", "<map key=\"c\">d</map>"),
            "line 28 of the model: `c` is bound to `d`, which is neither a number nor a parameter of \
             `system`",
        ),
        (
            changed("name=\"c\" type=\"real\"", "name=\"g\" type=\"real\""),
            "line 7 of the model: component `ball` has two parameters `g`: rename one",
        ),
        (
            changed("x' == v &amp; v' == -g", "v' == -g"),
            "line 21 of the model: `x` has neither a flow nor bounds in location `flying`: give it a flow, or keep it between \
             two numbers in the invariants of every location",
        ),
        (
            changed("v := -c*v", "v := -w*v"),
            "line 17 of the model: `w` is not a parameter of component `ball`",
        ),
        (
            changed("d1=\"1\"", "d1=\"2\""),
            "line 4 of the model: `x` is not a number (d1 is not 1): use one parameter for each entry",
        ),
        (
            changed("dynamics=\"const\"", "dynamics=\"constant\""),
            "line 6 of the model: `g` has the dynamics `constant`: known are any and const",
        ),
        (
            changed("<location id=\"1\"", "<location id=\"1\"></location><location id=\"1\""),
            "line 9 of the model: two locations have the id 1: change one",
        ),
        (
            changed("<map key=\"v\">v", "<map key=\"x\">v"),
            "line 26 of the model: `one` binds `x` twice: leave one out",
        ),
        (
            "<html></html>".to_owned(),
            "line 1 of the model: <html> is no model of SpaceEx: that is a <sspaceex>",
        ),
        (
            "<sspaceex></sspaceex>".to_owned(),
            "line 1 of the model: there is no <component>: this is no model of SpaceEx",
        ),
        (
            changed("invariant>", "invarient>"),
            "line 11 of the model: <invarient> stands in <location>, where there can be invariant, flow, \
             note",
        ),
        (
            changed("<flow>x'", "<flow>v' == 1</flow><flow>x'"),
            "line 12 of the model: the <location> has a <flow> already: join them",
        ),
        (
            model.split("<assignment>").next().unwrap_or_default().to_owned(),
            "line 17 of the model: the file ends within the <transition> of line 14",
        ),
        (
            changed("<label>hop", "<label>hip"),
            "line 15 of the model: `hip` is no label of component `ball`: declare a param of type label",
        ),
        (
            changed("source=\"1\"", "source=\"7\""),
            "line 14 of the model: there is no location with id 7",
        ),
        (
            changed("target=\"1\"", "target=\"7\""),
            "line 14 of the model: there is no location with id 7",
        ),
        (
            changed("<transition ", "<transition asap=\"yes\" "),
            "line 14 of the model: `asap` is `yes`: known are true and false",
        ),
        (
            changed("</bind>", "</bind><bind component=\"ball\" as=\"one\"></bind>"),
            "line 30 of the model: two components are bound as `one`: rename one",
        ),
        (
            changed("v &lt; 0</guard>", "v' &lt; 0</guard>"),
            "line 16 of the model: `v'` cannot stand in a condition",
        ),
        (
            changed("v &lt; 0</guard>", "hop &lt; 0</guard>"),
            "line 16 of the model: `hop` is a label, not a number",
        ),
        (
            changed("v &lt; 0</guard>", "v &lt; 0 &amp;</guard>"),
            "line 16 of the model: `x <= 0 && v < 0 &` has a part that says nothing: leave out the `&`",
        ),
        (
            changed("<map key=\"hop\">hop", "<map key=\"hop\">3"),
            "line 29 of the model: the label `hop` is bound to 3: bind it to a label",
        ),
        (
            changed("key=\"v\"", "key=\"q\""),
            "line 26 of the model: component `ball` has no parameter `q`",
        ),
    ];
    for (model, expected) in cases {
        assert_eq!(refusal(&model, configuration), expected);
    }
    let asked = |from: &str, to: &str| refusal(model, &configuration.replace(from, to));
    assert_eq!(
        asked("loc(one)==flying", "loc(one)==rolling"),
        "line 3 of the configuration: there is no location `rolling`: there are flying"
    );
    assert_eq!(
        asked("10 <= x <= 10.2 &", ""),
        "line 3 of the configuration: `initially` does not bound `x` from both sides, or allows no value \
         of it"
    );
    assert_eq!(
        asked("directions = \"box\"", "directions = \"stars\""),
        "line 7 of the configuration: directions `stars` are not known: box, oct, uni with a number, or \
         linear constraints as {x + y <= 0 & x <= 0}"
    );
    assert_eq!(
        asked("directions = \"box\"", "directions = \"box"),
        "line 7 of the configuration: `\"box` has a single quotation mark: add the other"
    );
    assert_eq!(
        asked("forbidden = \"x", "forbidden = \"z"),
        "line 4 of the configuration: `z` is no variable or constant of the system"
    );
    assert_eq!(
        asked("\"t,x\"", "\"t,q\""),
        "line 8 of the configuration: `q` cannot be shown: there are t, v, x"
    );
    assert_eq!(
        asked("sampling-time = 0.01", "sampling-time = 0"),
        "line 6 of the configuration: 0 is no step: write more than 0"
    );
    assert_eq!(
        asked("sampling-time = 0.01", "time-horizon = 5"),
        "line 6 of the configuration: `time-horizon` stands in line 5 already: leave one out"
    );
    assert_eq!(
        asked("sampling-time = 0.01", "iter-max = 1.5"),
        "line 6 of the configuration: `1.5` is no whole number of jumps"
    );
    assert_eq!(
        asked("directions = \"box\"", "directions = \"unicorn\""),
        "line 7 of the configuration: directions `unicorn` are not known: box, oct, uni with a number, or \
         linear constraints as {x + y <= 0 & x <= 0}"
    );
    assert_eq!(
        asked("v == 0 & loc", "v == 0 & z == 3 & loc"),
        "line 3 of the configuration: `z` is no variable or constant of the system"
    );
    assert_eq!(
        asked("v == 0 & loc", "v' == 0 & loc"),
        "line 3 of the configuration: `v'` cannot stand in a condition"
    );
    assert_eq!(
        asked("loc(one)==flying", "loc(one==flying"),
        "line 3 of the configuration: `loc(one==flying` lacks a parenthesis: write loc(component)==location"
    );
    assert_eq!(
        asked("loc(one)==flying", "loc(two)==flying"),
        "line 3 of the configuration: `loc(two)`: there is no such component; there are one"
    );
    assert_eq!(
        asked("system = \"system\"", "system = \"ball2\""),
        "line 2 of the configuration: there is no component `ball2`: there are ball, system"
    );
}

/// Where no initial state satisfies the invariant there are no runs, and nothing would be shown of any.
#[test]
fn a_question_about_no_run_is_refused() {
    let configuration =
        include_str!("spaceex/bouncing-ball.cfg").replace("10 <= x <= 10.2", "x == -3");
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("below-the-ground.cfg");
    std::fs::write(&file, configuration).expect("it can be written");
    let file = file.to_str().expect("it is text");
    let output = pleach(&["reach", "tests/spaceex/bouncing-ball.xml", "--cfg", file]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("no run begins there"), "{said}");
}

/// An input is within the bounds of all components, in every location the same.
#[test]
fn inputs_have_bounds_in_every_location() {
    let two_locations = |first: &str, second: &str| {
        format!(
            r#"<sspaceex><component id="s"><param name="x" type="real" dynamics="any"/>
            <param name="u" type="real" dynamics="any"/>
            <location id="1" name="A"><invariant>{first} &amp; x&lt;=1</invariant><flow>x'==u</flow></location>
            <location id="2" name="B"><invariant>{second}</invariant><flow>x'==u</flow></location>
            <transition source="1" target="2"><guard>x&gt;=1</guard></transition></component></sspaceex>"#
        )
    };
    let configuration =
        "initially = \"x==0 & loc(s)==A\"\nforbidden = \"x>=1.5\"\ntime-horizon = 2";
    let unit = "0&lt;=u &amp; u&lt;=1";
    assert_eq!(verdict(&problem([&two_locations(unit, unit), configuration])), Verdict::Violated);
    let free = refusal(&two_locations(unit, "x&lt;=9"), configuration);
    assert!(free.contains("nor bounds in location `B`"), "{free}");
    let other = refusal(&two_locations(unit, "5&lt;=u &amp; u&lt;6"), configuration);
    assert!(other.contains("[0, 1] in location `A`, and in [5, 6] in `B`"), "{other}");
}

/// No run has an input at the end of a strict bound, though what is enclosed has it.
#[test]
fn strict_bounds_of_inputs_are_not_reached() {
    let asked = |bounds: &str, forbidden: &str| {
        let model = format!(
            r#"<sspaceex><component id="s"><param name="x" type="real"/><param name="age" type="real"/>
            <param name="u" type="real"/><location id="1" name="A"><invariant>{bounds}</invariant>
            <flow>x'==u-4 &amp; age'==1</flow></location></component></sspaceex>"#
        );
        let question = format!("forbidden = \"{forbidden} & age >= 1\"\ntime-horizon = 2");
        problem([&model, &format!("initially = \"x == 0 & age == 0\"\n{question}")])
    };
    assert_eq!(verdict(&asked("0&lt;=u &amp; u&lt;=4", "x >= 0")), Verdict::Violated);
    for bounds in ["0&lt;=u &amp; u&lt;4", "0&lt;=u &amp; u&lt;=4 &amp; 4&gt;u"] {
        let problem = asked(bounds, "x >= 0");
        assert_eq!(verdict(&problem), Verdict::Undecided, "{bounds}");
        let written = write(&problem);
        let again = self::problem([&written.model, &written.configuration]);
        assert_eq!(again.initial, problem.initial, "{}", written.configuration);
        assert_eq!(verdict(&asked(bounds, "x >= -0.5")), Verdict::Violated, "{bounds}");
    }
}

/// `initially` may bound inputs more narrowly than invariants do.
#[test]
fn bounds_of_inputs_hold_where_runs_begin() {
    let model = r#"<sspaceex><component id="s"><param name="x" type="real"/>
        <param name="u" type="real"/><location id="1" name="A"><invariant>0&lt;=u &amp; u&lt;=4</invariant>
        <flow>x'==u</flow></location></component></sspaceex>"#;
    let verdict = |initially: &str| {
        let question = "forbidden = \"x >= 7.5\"\ntime-horizon = 2";
        verdict(&problem([model, &format!("initially = \"x == 0{initially}\"\n{question}")]))
    };
    assert_eq!(verdict(""), Verdict::Violated);
    // An input that varies may grow later: that is enclosed, and no run that is tried.
    assert_eq!(verdict(" & u <= 3"), Verdict::Undecided);
}

/// A location without transitions, beside others that have some: runs may begin in either.
#[test]
fn runs_may_begin_where_no_transition_leads() {
    let model = r#"<sspaceex><component id="s"><param name="x" type="real" dynamics="any"/>
        <location id="1" name="A"><invariant>x&lt;=1</invariant><flow>x'==1</flow></location>
        <location id="2" name="B"><flow>x'==1</flow></location>
        <location id="3" name="C"><flow>x'==9</flow></location>
        <transition source="2" target="3"><guard>x&gt;=1</guard></transition></component></sspaceex>"#;
    let verdict = |initially: &str| {
        let states = format!("initially = \"{initially}\"");
        let question = format!("{states}\nforbidden = \"x>=4\"\ntime-horizon = 3");
        verdict(&problem([model, &question]))
    };
    assert_eq!(verdict("x==0 & loc(s)==A"), Verdict::Holds);
    assert_eq!(verdict("x==0"), Verdict::Violated);
}

/// What turns round a circle leaves it by rounding alone.
#[test]
fn errors_of_solutions_violate_nothing() {
    let turning = r#"<sspaceex><component id="s"><param name="x" type="real" dynamics="any"/>
        <param name="y" type="real" dynamics="any"/>
        <location id="1" name="A"><flow>x'==y &amp; y'==-x</flow></location></component></sspaceex>"#;
    let inside = "initially = \"x==0 & y==1\"\nforbidden = \"x*x+y*y < 1\"\ntime-horizon = 10";
    assert_eq!(verdict(&problem([turning, inside])), Verdict::Undecided);
}

/// Runs begin and jump only into invariants, and at no boundary that is excluded: where enclosures show that a part of
/// what is forbidden is not reached, no run comes there either.
#[test]
fn runs_that_are_found_are_runs_of_the_model() {
    let model = r#"<sspaceex><component id="s"><param name="x" type="real" dynamics="any"/>
        <param name="z" type="real" dynamics="any"/>
        <location id="1" name="A"><invariant>x&lt;=1</invariant><flow>x'==1 &amp; z'==0</flow></location>
        <location id="2" name="B"><invariant>x&lt;=5</invariant><flow>x'==0 &amp; z'==0</flow></location>
        <transition source="1" target="2"><guard>x&gt;=1</guard><assignment>x:=10</assignment></transition>
        </component></sspaceex>"#;
    let verdict = |initially: &str, forbidden: &str| {
        let states = format!("initially = \"{initially} & 0<=z & loc(s)==A\"");
        let question = format!("{states}\nforbidden = \"{forbidden}\"\ntime-horizon = 3");
        verdict(&problem([model, &question]))
    };
    // The largest value of this is 1.25, which enclosures do not see.
    let never = "z - z*z/5 >= 1.2501";
    for (initially, forbidden) in
        [("x==0 & z<=5", "x>=8"), ("0<=x & x<=4 & z<=5", "2<=x & x<=4"), ("x==0 & z<5", "z>=5")]
    {
        let alone = verdict(initially, forbidden);
        assert_ne!(alone, Verdict::Violated, "{initially}: {forbidden}");
        let both = verdict(initially, &format!("{forbidden} | {never}"));
        assert_eq!(both, Verdict::Undecided, "{initially}: {forbidden}");
    }
    assert_eq!(verdict("0<=x & x<=4 & z<=5", &format!("x>=0.9 | {never}")), Verdict::Violated);
}

#[test]
fn configurations_may_begin_with_a_mark_and_have_comments() {
    let [model, configuration] = BALL;
    let commented: Vec<String> =
        configuration.lines().map(|line| format!("{line} # a \"comment\"")).collect();
    let problem = problem([model, &format!("\u{feff}{}", commented.join("\n"))]);
    assert_eq!(problem.settings, self::problem(BALL).settings);
    assert_eq!(problem.initial, self::problem(BALL).initial);
}

#[test]
fn what_is_too_large_is_refused_and_inputs_are_not_overwritten() {
    let many = (0..30).map(|bound| format!("(x >= 3 | x >= {bound})")).collect::<Vec<_>>();
    let configuration = BALL[1].replace("x >= 10.25", &many.join(" & "));
    let said = refusal(BALL[0], &configuration);
    assert!(said.contains("more than 4096 alternatives"), "{said}");

    let model = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("not-overwritten.xml");
    std::fs::write(&model, BALL[0]).expect("it can be written");
    let model = model.to_str().expect("it is text");
    let output =
        pleach(&["reach", model, "--cfg", "tests/spaceex/bouncing-ball.cfg", "--svg", model]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(model).expect("it is there"), BALL[0]);
}

/// Each level of parentheses is looked through anew, so that they are counted first.
#[test]
fn conditions_are_nested_up_to_a_limit() {
    let nested = |levels: usize| {
        let forbidden = format!("{}x >= 10.25{}", "(".repeat(levels), ")".repeat(levels));
        BALL[1].replace("x >= 10.25", &forbidden)
    };
    assert_eq!(problem([BALL[0], &nested(100)]).forbidden, problem(BALL).forbidden);
    for levels in [101, 20_000] {
        assert_eq!(
            refusal(BALL[0], &nested(levels)),
            "line 4 of the configuration: a condition has more than 100 levels of parentheses: leave out those that \
             change nothing"
        );
    }
}

/// Whichever way `initially` is written, no run begins beyond it: one that did was taken for a counterexample.
#[test]
fn all_comparisons_of_initially_bound_where_runs_begin() {
    let ball = |more: &str, forbidden: &str| {
        let begin = "10 <= x & x <= 10.2 & 0 <= v & v <= 0.1 & ";
        BALL[1]
            .replace("10 <= x <= 10.2 & v == 0 & ", &format!("{begin}{more} & "))
            .replace("x >= 10.25", forbidden)
    };
    for more in
        ["x <= 10.05", "2*x <= 20.1", "x - 10 <= 0.05", "10.05 >= x + v", "5 > 3 & -x >= -10.05"]
    {
        assert_eq!(
            verdict(&problem([BALL[0], &ball(more, "x >= 10.15")])),
            Verdict::Holds,
            "{more}"
        );
        assert_eq!(
            verdict(&problem([BALL[0], &ball(more, "x >= 10.02 & v > -0.5")])),
            Verdict::Violated,
            "{more}"
        );
    }
    // No set of states ends where this does: nothing is proved, and no run begins beyond it.
    let curved = ball("x*x + v*v <= 101", "x >= 10.15");
    assert_eq!(verdict(&problem([BALL[0], &curved])), Verdict::Undecided);
    for none in ["false", "5 <= 3", "2*x <= 19", "x*x <= 99"] {
        let said = refusal(BALL[0], &ball(none, "x >= 10.15"));
        assert!(said.contains("`initially` allows no state"), "{none}: {said}");
    }
}

/// What cannot be written is told before the runs are enclosed, which may take long; numbers below 0 are numbers.
#[test]
fn outputs_are_tried_and_numbers_below_zero_read_before_anything_is_enclosed() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let nowhere = folder.join("no/such/folder/set.svg");
    let nowhere = nowhere.to_str().expect("it is text");
    let ball = ["tests/spaceex/bouncing-ball.xml", "--cfg", "tests/spaceex/bouncing-ball.cfg"];
    let said = |more: &[&str]| {
        let output = pleach(&[&["reach"], &ball[..], more].concat());
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    for option in ["--svg", "--json"] {
        let said = said(&[option, nowhere, "--step", "0"]);
        assert!(said.contains("set.svg: cannot be created"), "{said}");
    }
    let kept = folder.join("kept.json");
    std::fs::write(&kept, "{}").expect("it can be written");
    let said = said(&["--json", kept.to_str().expect("it is text"), "--step", "-1"]);
    assert!(said.contains("`step` is -1, and has to be a duration above 0"), "{said}");
    assert_eq!(std::fs::read_to_string(&kept).expect("it is there"), "{}");
}

/// What other tools and editors write, and what is no matter to the answer.
#[test]
fn small_liberties_of_other_tools_are_taken() {
    let [model, configuration] = BALL;
    let options = format!("{configuration}\nadditional-options = \"\"\n");
    let over_lines = configuration.replace(" & ", "\n  & ");
    assert_ne!(over_lines, configuration);
    let linked =
        model.replace("<map key=\"c\">0.75</map>", "<map key=\"c\">.75<link target=\"1\"/></map>");
    assert_ne!(linked, model);
    for (model, configuration) in
        [(model, &*options), (model, &over_lines), (&*linked, configuration)]
    {
        assert_eq!(verdict(&problem([model, configuration])), Verdict::Holds);
    }
    assert!(refusal(model, &options.replace("\"\"", "\"")).contains("single quotation mark"));
}

/// A variable of an inner component may be named without it where there is no other of the name.
#[test]
fn inner_variables_may_be_named_briefly() {
    let brief = RELAY[1].replace("room.lamp.age", "age");
    assert_ne!(brief, RELAY[1]);
    assert_eq!(verdict(&problem([RELAY[0], &brief])), Verdict::Holds);
}

/// The outputs y and z of a tank.
const TANK: &str = r#"<sspaceex><component id="tank">
        <param name="x" type="real" d1="1" d2="1" local="false" dynamics="any"/>
        <param name="y" type="real" d1="1" d2="1" local="false" dynamics="any" controlled="false"/>
        <param name="z" type="real" d1="1" d2="1" local="false" dynamics="any" controlled="false"/>
        <location id="1" name="filling">
            <invariant>y == 2*x + 1 &amp; z == y - x &amp; y &lt;= 5</invariant>
            <flow>x' == z - x</flow>
        </location>
    </component></sspaceex>"#;

/// An output is what the invariants say, in invariants, guards, flows and questions, and a signal of runs.
#[test]
fn outputs_stand_for_their_formulas() {
    let asked = |forbidden: &str| {
        let configuration = format!(
            "initially = \"x == 0\"\nforbidden = \"{forbidden}\"\noutput-variables = \"x, y\"\ntime-horizon = 10\n"
        );
        problem([TANK, &configuration])
    };
    let tank = asked("y >= 5.1");
    assert!(tank.automata[0].signals().map(|(name, _)| name).eq(["y", "z"]));
    let run = tank.automata[0].run(1.0).unwrap();
    assert!((run.value("y", 1.0).unwrap() - 3.0).abs() < 1e-12);
    // x′ is 1, up to where y is 5.
    assert_eq!(asked("y >= 5.1").automata[0].names(), ["x"]);
    assert_eq!(verdict(&asked("y >= 5.1")), Verdict::Holds);
    assert_eq!(verdict(&asked("x >= 2.1")), Verdict::Holds);
    assert_eq!(verdict(&asked("y >= 4.5")), Verdict::Violated);
    // It can be drawn: 2 x + 1 in every set and along every run.
    assert_eq!(tank.shown, ["x", "y"]);
    let solution = tank.solve(&Effort::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    let picture = solution.picture("tank", ["x", "y"], &tank.runs(2)).unwrap();
    assert!(!picture.patches.is_empty() && !picture.runs.is_empty());
    for Patch { across, up, .. } in &picture.patches {
        assert!(across.iter().zip(up).all(|(x, y)| (2.0 * x + 1.0 - y).abs() < 1e-9));
    }
    for sample in picture.runs.iter().flatten() {
        assert!((2.0 * sample.values[0] + 1.0 - sample.values[1]).abs() < 1e-12);
        assert!((2.0 * sample.rates[0] - sample.rates[1]).abs() < 1e-12);
    }
    assert!(solution.picture("tank", ["t", "q"], &[]).unwrap_err().contains("there are x, y, z"));
    let nowhere = refusal(TANK, "forbidden = \"y >= 5.1\"\ntime-horizon = 10\n");
    assert!(
        nowhere.starts_with("line 2 of the configuration: there is no `initially`"),
        "{nowhere}"
    );
}

/// The input is within ±1 at first, and from the jump at 1 s on between 2 and 3: x is at most 1 + 3, and can
/// be nearly that.
#[test]
fn an_input_may_have_other_bounds_in_other_locations() {
    let model = |bounds: &str| {
        format!(
            r#"<sspaceex><component id="s">
            <param name="x" type="real" d1="1" d2="1" local="false" dynamics="any"/>
            <param name="t" type="real" d1="1" d2="1" local="false" dynamics="any"/>
            <param name="u" type="real" d1="1" d2="1" local="false" dynamics="any" controlled="false"/>
            <param name="y" type="real" d1="1" d2="1" local="false" dynamics="any" controlled="false"/>
            <location id="1" name="slow">
                <invariant>y == x + u &amp; -1 &lt;= u &amp; u {bounds} 1 &amp; t &lt;= 1</invariant>
                <flow>x' == u &amp; t' == 1</flow>
            </location>
            <location id="2" name="fast">
                <invariant>y == x + u &amp; 2 &lt;= u &amp; u &lt;= 3 &amp; t &lt;= 2</invariant>
                <flow>x' == u &amp; t' == 1</flow>
            </location>
            <transition source="1" target="2"><guard>t &gt;= 1</guard></transition>
        </component></sspaceex>"#
        )
    };
    let asked = |forbidden: &str| {
        format!(
            "initially = \"x == 0 & t == 0 & loc()==slow\"\nforbidden = \"{forbidden}\"\ntime-horizon = 3\n"
        )
    };
    let verdict_of = |forbidden: &str| verdict(&problem([&model("&lt;="), &asked(forbidden)]));
    assert_eq!(verdict_of("x >= 4.01"), Verdict::Holds);
    assert_eq!(verdict_of("x <= 0.9 & t >= 2"), Verdict::Holds);
    assert_eq!(verdict_of("x >= 3.9"), Verdict::Violated);
    let said = refusal(&model("&lt;"), &asked("x >= 5"));
    assert!(said.contains("some of its bounds are strict"), "{said}");
    assert!(refusal(&model("&lt;="), &asked("u >= 5")).contains("`u` is an input"));
    // A number of the model may have the name that the place of an input between its bounds would have.
    let names = [
        ("\"t\"", "\"u_share\""),
        (" t ", " u_share "),
        (">t ", ">u_share "),
        (" t'", " u_share'"),
    ];
    let renamed = |model: String, (one, other): (&str, &str)| model.replace(one, other);
    let shared = names.into_iter().fold(model("&lt;="), renamed);
    let asked = asked("x >= 3.9").replace("t == 0", "u_share == 0");
    assert_eq!(verdict(&problem([&shared, &asked])), Verdict::Violated);
}

/// The time to read a model grows with its length, and not with its square.
#[test]
fn a_model_of_many_lines_is_read_in_a_moment() {
    let mut model =
        String::from("<sspaceex><component id=\"s\"><param name=\"x\" type=\"real\"/>\n");
    for id in 0..2000 {
        let flow = "<invariant>x &lt;= 9 &amp; x &gt;= -9</invariant>\n<flow>x' == 1</flow>";
        model += &format!("<location id=\"{id}\" name=\"at {id}\">\n{flow}\n</location>\n");
    }
    for _ in 0..40_000 {
        model += "<note>\n</note>\n";
    }
    let begin = Instant::now();
    let said = refusal(&format!("{model}<other/>"), BALL[1]);
    assert!(said.starts_with("line 88002 of the model: <other> stands in <component>"), "{said}");
    assert!(begin.elapsed() < Duration::from_secs(20), "{:?}", begin.elapsed());
}

/// Locations of one name are told apart by their ids.
#[test]
fn locations_of_one_name_are_told_apart() {
    let model = BALL[0].replace(
        "    <transition source=\"1\" target=\"1\">",
        "    <location id=\"2\" name=\"flying\"><flow>x' == 0 &amp; v' == 0</flow></location>\n    \
         <transition source=\"1\" target=\"2\">",
    );
    let problem = problem([&model, BALL[1]]);
    let names: Vec<&str> = problem.automata[0].locations().iter().map(|one| one.as_str()).collect();
    assert_eq!(names, ["flying#1", "flying#2"]);
    assert_eq!(problem.initial[0].locations, names);
}

/// Of a network without an initial `loc`, every location is initial; one alternative for each `|`.
#[test]
fn alternatives_of_initial_states_are_kept_apart() {
    let [model, configuration] = TIMERS;
    let configuration = configuration.replace(
        "\"clock == 0 & 1 <= level & level <= 1.2 & period == 1\"",
        "\"clock == 0 & period == 1 & (1 <= level <= 1.2 & loc(tank)==open | level == 0.5 & loc(tank)==shut)\"",
    );
    let problem = problem([model, &configuration]);
    let found: Vec<(Vec<String>, String)> = problem
        .initial
        .iter()
        .map(|one| (one.locations.clone(), one.states.hull()[1].to_string()))
        .collect();
    let open = (vec!["waiting, open".to_owned()], "[1, 1.2]".to_owned());
    let shut = (vec!["waiting, shut".to_owned()], "[0.5, 0.5]".to_owned());
    assert_eq!(found, [open, shut]);
}

/// The picture of the book is what the program draws; its runs are curves, and not chords.
#[test]
fn the_picture_of_the_book_is_up_to_date() {
    let ball = problem(BALL);
    let solution = ball.solve(&Effort::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    let picture = solution.picture(&ball.system, ["t", "x"], &ball.runs(12)).unwrap();
    let flights = picture.runs.iter().filter(|phase| phase.len() > 1).count();
    let svg = picture.to_svg();
    assert!(flights >= 12 && svg.matches(" C ").count() >= flights);
    keep_up_to_date("docs/pictures/reach-ball.svg", &svg, "spaceex");
}
