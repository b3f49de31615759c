//! Pictures are well-formed, complete, and nothing in them lies on anything else.

use crate::common::classics::{Ball, ball, gears, house, thermostat};
use pleach_automaton::{Automaton, Composition, Name, Record, Trajectory, diagram, from};
use pleach_discrete::{self as discrete, Location};
use pleach_guards::always;
use proptest::prelude::*;
use quick_xml::Reader;
use quick_xml::events::Event;

/// Every tag is closed, and no number is missing.
fn assert_well_formed(picture: &str) {
    let mut reader = Reader::from_str(picture);
    reader.config_mut().check_end_names = true;
    loop {
        match reader.read_event().expect("the picture is well-formed") {
            Event::Eof => break,
            Event::Text(text) => assert!(!text.contains('&'), "unescaped: {text:?}"),
            _ => {}
        }
    }
    assert!(!picture.contains("NaN") && !picture.contains("inf"), "{picture}");
}

/// The lines of text in a picture, each with its place: x, y and where it is anchored.
fn texts(picture: &str) -> Vec<(String, [f64; 2], String)> {
    let mut texts = Vec::new();
    let mut lines = picture.lines();
    while let Some(line) = lines.next() {
        let Some(tag) = line.trim().strip_prefix("<text ") else { continue };
        let attribute = |name: &str| {
            let start = tag.find(&format!("{name}=\"")).expect("it has one") + name.len() + 2;
            tag[start..].split('"').next().expect("it ends").to_owned()
        };
        let number = |name| attribute(name).parse().expect("it is a number");
        let words = lines.next().expect("a text has words").to_owned();
        texts.push((words, [number("x"), number("y")], attribute("class")));
    }
    texts
}

fn runs() -> [Trajectory; 4] {
    [ball().run(20.0), thermostat().run(60.0), gears().run(60.0), house().run(30.0)]
        .map(|run| run.expect("it can be run"))
}

/// Arrows between all pairs of six boxes: each has its number, and no number lies on another or on a box.
#[test]
fn numbers_in_an_overview_stand_apart() {
    let names = ["idle", "called", "busy", "blocked", "done", "failed"];
    let picture = diagram::overview_svg(&names, |from, to| 10 * from + to);
    assert_well_formed(&picture);
    let texts = texts(&picture);
    let numbers = texts.iter().filter(|(words, ..)| words.parse::<usize>().is_ok());
    assert_eq!(numbers.count(), 30);
    for (index, (words, [x, y], _)) in texts.iter().enumerate() {
        for (others, [u, v], _) in &texts[..index] {
            assert!((x - u).abs() > 16.0 || (y - v).abs() > 13.0, "{words} lies on {others}");
        }
    }
}

#[test]
fn all_pictures_are_well_formed() {
    assert_well_formed(&diagram::svg(&ball()));
    assert_well_formed(&diagram::svg(&thermostat()));
    assert_well_formed(&diagram::svg(&gears()));
    assert_well_formed(&diagram::composition_svg(&house()));
    for run in runs() {
        assert_well_formed(&diagram::plot(&run));
        let [across, .., up] = [&run.variables()[0], &run.variables()[run.variables().len() - 1]];
        assert_well_formed(&diagram::phase_portrait(&run, across, up).expect("variables exist"));
    }
}

#[test]
fn a_textbook_would_show_the_ball_like_this() {
    let picture = diagram::svg(&ball());
    let words: Vec<String> = texts(&picture).into_iter().map(|(words, ..)| words).collect();
    let expected = [
        "falling",
        "ḣ = v",
        "v̇ = −9.81",
        "while h ≥ 0",
        "h = 10",
        "v = 0",
        "bounce",
        "[h ≤ 0 ∧ v &lt; 0]",
        "/ v := −0.8 · v",
        "must",
    ];
    assert_eq!(words, expected);
}

#[test]
fn every_transition_is_an_arrow_with_a_label() {
    let (automaton, picture) = (gears(), diagram::svg(&gears()));
    let transitions = automaton.table().rows().len();
    let (initial, key) = (1, 3);
    assert_eq!(picture.matches("url(#head)").count(), transitions + initial + key);
    let words: Vec<String> = texts(&picture).into_iter().map(|(words, ..)| words).collect();
    for (event, count) in [("up", 3), ("down", 3), ("kick down", 2), ("tick", 2)] {
        assert_eq!(words.iter().filter(|line| *line == event).count(), count, "{event}");
    }
    assert!(words.iter().any(|line| line == "stall (priority 1)"));
}

/// Each text takes a box of about its own size; no two of them meet.
fn assert_legible(picture: &str) {
    const LETTER: f64 = 7.0;
    const LINE: f64 = 16.0;
    let boxes: Vec<_> = texts(picture)
        .into_iter()
        .map(|(words, [x, y], class)| {
            let width = words.replace("&lt;", "<").chars().count() as f64 * LETTER;
            let left = if class.contains("middle") { x - width / 2.0 } else { x };
            (words, [left, left + width], y)
        })
        .collect();
    for (number, (one, [left, right], y)) in boxes.iter().enumerate() {
        for (other, [other_left, other_right], other_y) in &boxes[..number] {
            let beside = right <= other_left || other_right <= left;
            assert!(beside || (y - other_y).abs() >= LINE, "`{one}` lies on `{other}`: {picture}");
        }
    }
}

#[test]
fn no_text_lies_on_another() {
    assert_legible(&diagram::svg(&ball()));
    assert_legible(&diagram::svg(&thermostat()));
    assert_legible(&diagram::svg(&gears()));
}

/// One of four locations, or an event of as many.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Number(usize);

const NUMBERS: [Number; 4] = [Number(0), Number(1), Number(2), Number(3)];
const NAMES: [&str; 4] = ["one", "two", "three", "a fourth one with a long name"];

impl Location for Number {
    const ALL: &'static [Self] = &NUMBERS;

    fn name(self) -> &'static str {
        NAMES[self.0]
    }
}

impl discrete::Event for Number {
    const ALL: &'static [Self] = &NUMBERS;

    fn name(self) -> &'static str {
        NAMES[self.0]
    }
}

proptest! {
    #![proptest_config(cases::usually(200))]

    #[test]
    fn any_small_graph_is_legible(
        targets in prop::collection::btree_map((0..4usize, 0..4usize), 0..4usize, 1..13),
        initial in 0..4usize,
    ) {
        let Ball { height, velocity } = Ball::coordinates();
        let mut builder = Automaton::<Number, Number, Ball>::starting_in(Number(initial))
            .initially(Ball { height: 1.0, velocity: 0.0 })
            .flow(Number(1), [height.rate(&velocity), velocity.rate(-9.81)])
            .transition(from(Number(initial)).on(Number(0)).to(Number(initial)).may(always()));
        for ((source, event), target) in &targets {
            if (*source, *event) == (initial, 0) {
                continue;
            }
            let guard = height.at_most(*target as f64) & velocity.less_than(*event as f64);
            let edge = from(Number(*source)).on(Number(*event)).to(Number(*target));
            let edge = if *event == 1 { edge.at_once(guard) } else { edge.must(guard) };
            builder = builder.transition(if *target == 2 {
                edge.then([velocity.becomes(-0.8 * &velocity), height.becomes(0.0)])
            } else {
                edge
            });
        }
        let automaton = builder.build().expect("the model is sound");
        let picture = diagram::svg(&automaton);
        assert_well_formed(&picture);
        assert_legible(&picture);
        let transitions = automaton.table().rows().len();
        prop_assert!(picture.matches("url(#head)").count() > transitions);
    }
}

#[test]
fn a_composition_shows_its_parts_and_what_joins_them() {
    let expected = "\
flowchart LR
    subgraph c0[\"heater\"]
        c0l0(\"off<br>Ṫ = −0.1 · T\")
        c0l1(\"on<br>Ṫ = 5 − 0.1 · T\")
        c0start(( )) --> c0l0
        c0l0 -- \"turn on<br>[always]<br>(may, 0)\" --> c0l1
        c0l1 -- \"turn off<br>[always]<br>(may, 0)\" --> c0l0
    end
    subgraph c1[\"controller\"]
        c1l0(\"watching\")
        c1start(( )) --> c1l0
        c1l0 -- \"turn on<br>[T ≤ 18]<br>(must, 0)\" --> c1l0
        c1l0 -- \"turn off<br>[T ≥ 22]<br>(must, 0)\" --> c1l0
    end
    label0{{\"turn on\"}}
    label0 -.- c0
    label0 -.- c1
    label1{{\"turn off\"}}
    label1 -.- c0
    label1 -.- c1
    c0 == \"T\" ==> c1
";
    assert_eq!(diagram::composition_mermaid(&house()), expected);
    let picture = diagram::composition_svg(&house());
    assert_eq!(picture.matches("class=\"frame\"").count(), 2);
    assert_eq!(picture.matches("class=\"wire-dot\"").count(), 2 * 2);
    assert_eq!(picture.matches("url(#pipe-head)").count(), 1);
}

#[test]
fn tables_tell_transitions_of_one_event_apart() {
    let table = diagram::table(&gears());
    let rows = "\
| event | transition | holds where | reset |
| --- | --- | --- | --- |
| **up** | first → second | v ≥ 5 | τ := 0 |
| **up** | second → third | v ≥ 10 | τ := 0 |
| **up** | third → fourth | v ≥ 20 | τ := 0 |
";
    assert!(table.contains(rows), "{table}");
    assert!(table.contains("| **stall** | fourth → first | v ≤ 1 ∧ τ ≥ 2 | v := 0, τ := 0 |"));
    assert!(table.contains("| **second** | v̇ = 1.5 − 0.01 · v², τ̇ = 1 | v ≥ 0 ∧ τ ≤ 60 |"));

    let expected = "\
| location | bounce |
| --- | --- |
| **falling** | falling |

| event | holds where | reset |
| --- | --- | --- |
| **bounce** | h ≤ 0 ∧ v < 0 | v := −0.8 · v |

| location | flow | time passes while |
| --- | --- | --- |
| **falling** | ḣ = v, v̇ = −9.81 | h ≥ 0 |
";
    assert_eq!(diagram::table(&ball()), expected);
}

#[test]
fn the_formal_definition_is_complete() {
    let expected = r"\begin{align*}
  H &= (Q, X, \mathrm{Init}, f, \mathrm{Inv}, E, G, R) \\
  Q &= \{\text{falling}\} \\
  X &= \mathbb{R}^{2}, \quad x = \begin{pmatrix} h \\ v \end{pmatrix} \\
  \mathrm{Init} &= \left\{\left(\text{falling}, \begin{pmatrix} 10 \\ 0 \end{pmatrix}\right)\right\} \\
  f(\text{falling}, x) &= \begin{pmatrix} v \\ -9.81 \end{pmatrix} \\
  \mathrm{Inv}(\text{falling}) &= \{x \in X \mid h \ge 0\} \\
  E &= \{e_{1}\} \\
  e_{1} &= (\text{falling}, \text{bounce}, \text{falling}) \quad\text{(must, 0)} \\
  G(e_{1}) &= \{x \in X \mid h \le 0 \land v < 0\} \\
  R(e_{1}, x) &= \begin{pmatrix} h \\ -0.8 \cdot v \end{pmatrix}
\end{align*}
";
    assert_eq!(diagram::latex(&ball()), expected);
    let gears = diagram::latex(&gears());
    for number in 1..=11 {
        assert!(gears.contains(&format!("G(e_{{{number}}}) &= ")), "{gears}");
    }
    let braces = |brace: &str| gears.matches(brace).count();
    assert_eq!(braces("{"), braces("}"));
    assert_eq!(braces(r"\left"), braces(r"\right"));
}

#[test]
fn plots_show_every_variable_and_every_location() {
    for run in runs() {
        let plot = diagram::plot(&run);
        let words: Vec<String> = texts(&plot).into_iter().map(|(words, ..)| words).collect();
        for variable in run.variables() {
            assert!(words.iter().any(|line| line == variable), "{variable} in {words:?}");
        }
        for (number, component) in run.components().iter().enumerate() {
            for phase in run.intervals() {
                let location = &component.locations[phase.locations[number]];
                assert!(words.iter().any(|line| line == location), "{location} in {words:?}");
            }
        }
    }
}

/// The speed of the ball is the only variable that jumps.
#[test]
fn jumps_are_gaps_in_the_curve() {
    let run = ball().run(3.0).expect("it can be run");
    assert_eq!(run.jumps().len(), 1);
    let plot = diagram::plot(&run);
    assert_eq!(plot.matches("class=\"jump\"").count(), 1);
    assert_eq!(plot.matches("class=\"before\"").count(), 1);
    assert_eq!(plot.matches("class=\"after\"").count(), 1);
    let moves = plot.matches(" M ").count() + plot.matches("\"M ").count();
    assert_eq!(moves, 2 * run.intervals().len(), "each curve begins anew after the jump");
}

#[test]
fn portraits_name_what_is_missing() {
    let run = ball().run(1.0).expect("it can be run");
    let error = diagram::phase_portrait(&run, "h", "speed").expect_err("there is no speed");
    assert_eq!(error.to_string(), "the trajectory has no variable `speed`; it has h, v");
}

#[test]
fn pictures_are_the_same_every_time() {
    assert_eq!(diagram::svg(&gears()), diagram::svg(&gears()));
    assert_eq!(diagram::composition_svg(&house()), diagram::composition_svg(&house()));
    for (one, other) in runs().iter().zip(&runs()) {
        assert_eq!(diagram::plot(one), diagram::plot(other));
    }
}

#[test]
fn a_connection_shows_what_its_reader_calls_what_it_reads() {
    let part = |coordinate: &str| {
        let state = Record::new([(coordinate, 0.0)]).expect("there is one");
        let only = Name::new("only");
        let built = Automaton::<Name, Name, Record>::starting_in(only).initially(state).build();
        built.expect("it is sound")
    };
    let read_as = |name: &str| {
        let parts = Composition::builder().add("one", &part("T")).add("other", &part(name));
        let pair = parts.connect("one.T", &format!("other.{name}")).build();
        diagram::composition_mermaid(&pair.expect("the parts fit"))
    };
    assert!(read_as("T").contains("c0 == \"T\" ==> c1"), "{}", read_as("T"));
    assert!(read_as("seen").contains("c0 == \"T → seen\" ==> c1"), "{}", read_as("seen"));
}

/// The numbers in the attribute `name` of all elements of a class, in their order; shapes and paths alike.
fn numbers_of(picture: &str, class: &str, name: &str) -> Vec<Vec<f64>> {
    let tag = format!("class=\"{class}\"");
    let elements = picture.lines().filter(|line| line.contains(&tag));
    let attribute = |line: &str| -> Vec<f64> {
        let start = line.find(&format!(" {name}=\"")).expect("it has one") + name.len() + 3;
        let text = line[start..].split('"').next().expect("it ends");
        text.split_whitespace().filter_map(|word| word.parse().ok()).collect()
    };
    elements.map(attribute).collect()
}

/// One number for each element.
fn number_of(picture: &str, class: &str, name: &str) -> Vec<f64> {
    numbers_of(picture, class, name).concat()
}

/// A label is a line above the frames that goes down to each participant, a connection an arrow below them from
/// the one that is read to the one that reads.
#[test]
fn what_joins_components_ends_at_their_frames() {
    let only = Name::new("reading");
    let state = Record::new([("T", 20.0)]).expect("there is one name");
    let reader = Automaton::<Name, Name, Record>::starting_in(only).initially(state);
    let reader = reader.build().expect("it is sound");
    let house = crate::common::classics::house_parts().add("a thermometer on the wall", &reader);
    let house = house.connect("heater.T", "a thermometer on the wall.T").build();
    let picture = diagram::composition_svg(&house.expect("the parts fit"));

    let [lefts, tops, widths, heights] =
        ["x", "y", "width", "height"].map(|name| number_of(&picture, "frame", name));
    let (top, bottom) = (tops[0], tops[0] + heights[0]);
    assert_eq!((&tops, &heights), (&vec![tops[0]; 3], &vec![heights[0]; 3]), "side by side");
    let rights: Vec<f64> = lefts.iter().zip(&widths).map(|(left, width)| left + width).collect();
    assert!(rights.iter().zip(&lefts[1..]).all(|(right, next)| (next - right - 28.0).abs() < 0.1));
    let root = picture.lines().next().expect("there is a root");
    let sheet = root.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next());
    let sheet: Vec<f64> =
        sheet.expect("it has a size").split(' ').map(|it| it.parse().expect("a number")).collect();
    assert!((sheet[2] - rights[2] - lefts[0]).abs() < 0.1, "as much on the right as on the left");

    let frame_of = |x: f64| (0..3).find(|&at| lefts[at] < x && x < rights[at]).expect("in a frame");
    let is_name =
        |words: &str| ["heater", "controller", "a thermometer on the wall"].contains(&words);
    let names = texts(&picture).into_iter().filter(|(words, ..)| is_name(words));
    let places = names.map(|(_, [x, y], _)| (frame_of(x), top < y && y < top + 32.0));
    assert_eq!(places.collect::<Vec<_>>(), [(0, true), (1, true), (2, true)]);

    // Labels: a line across and a way down to each participant, with a dot.
    let dots: Vec<f64> = number_of(&picture, "wire-dot", "cx");
    assert_eq!(dots.iter().map(|&x| frame_of(x)).collect::<Vec<_>>(), [0, 1, 0, 1]);
    assert!(dots[0] < dots[2] && dots[1] < dots[3], "each in a place of its own");
    assert_eq!(number_of(&picture, "wire-dot", "cy"), [top; 4]);
    let wires = numbers_of(&picture, "wire", "d");
    let [first, second] = [wires[0][1], wires[3][1]];
    assert!(0.0 < first && first + 16.0 < second && second + 8.0 < top, "{first}, {second}, {top}");
    let across =
        |y: f64, from: f64, to: f64| vec![vec![from, y, to], vec![from, y, top], vec![to, y, top]];
    assert_eq!(wires, [across(first, dots[0], dots[1]), across(second, dots[2], dots[3])].concat());

    // Connections: both from the heater, to the others.
    let pipes = numbers_of(&picture, "pipe", "d");
    let ends: Vec<_> = pipes.iter().map(|pipe| [frame_of(pipe[0]), frame_of(pipe[3])]).collect();
    assert_eq!(ends, [[0, 1], [0, 2]]);
    assert!(pipes[0][0] < pipes[1][0], "each in a place of its own");
    assert!(pipes.iter().flat_map(|pipe| [pipe[1], pipe[4]]).all(|y| (y - bottom).abs() < 0.1));
    let [first, second] = [pipes[0][2], pipes[1][2]];
    assert!(bottom + 8.0 < first && first + 16.0 < second && second + 8.0 < sheet[3]);
    for ((words, [x, y], _), pipe) in
        texts(&picture).into_iter().filter(|(_, _, class)| class == "pipe-text").zip(&pipes)
    {
        assert!(pipe[0] < x && x < pipe[3] && y < pipe[2] && pipe[2] < y + 20.0, "{words}");
    }
}
