//! What the rates ask of the tree: the less robots send, the longer its links are and the fewer robots it
//! takes.

use crate::generated::keep_up_to_date;
use missions::{Mission, run, shipped};
use pleach::automaton::network::record::{MissionEvent, Outcome};
use pleach::automaton::network::scenario::Scenario;
use pleach::discrete::network::Role;
use pleach_drawing::style::{GRID, INK, QUIET, WORDS};
use pleach_drawing::svg::node::element::Group;
use pleach_drawing::{Axis, disc, layer, line, polyline, sheet, text};
use rayon::prelude::*;

/// A radio in Study I by its l, and how its curve is drawn. u is 0.5.
struct Radio {
    full_range: f64,
    colour: &'static str,
}

/// The one of the paper, and one whose reliability falls off slowly.
const RADIOS: [Radio; 2] =
    [Radio { full_range: 0.4, colour: "#1f6fb4" }, Radio { full_range: 0.2, colour: "#c2571a" }];

/// The rate of every robot.
const RATES: [f64; 11] =
    [0.005, 0.015, 0.025, 0.035, 0.045, 0.055, 0.065, 0.075, 0.085, 0.095, 0.105];

/// What a mission took.
struct Effort {
    rate: f64,
    recruits: usize,
    /// Of the links of the tree that bear tasks, at the end.
    mean_length: f64,
    outcome: Outcome,
}

fn study(full_range: f64, rate: f64) -> Scenario {
    let mut scenario = shipped("study-1");
    scenario.link.full_range = full_range;
    scenario.robot.iter_mut().for_each(|robot| robot.rate = rate);
    scenario
}

fn effort(full_range: f64, rate: f64) -> Effort {
    let mission = run(study(full_range, rate));
    let is_recruit =
        |(_, event): &(usize, &MissionEvent)| matches!(event, MissionEvent::RecruitElected { .. });
    Effort {
        rate,
        recruits: mission.events().filter(is_recruit).count(),
        mean_length: mean_length(&mission),
        outcome: mission.end.outcome,
    }
}

fn mean_length(mission: &Mission) -> f64 {
    let last = &mission.periods.last().unwrap().snapshot;
    let access = mission.scenario.access_point.iter().map(|it| it.position.into());
    let places: Vec<_> = last.positions.iter().copied().chain(access).collect();
    let links = last.tree.iter().filter(|(child, _)| last.roles[*child] != Role::Redundant);
    let lengths: Vec<f64> =
        links.map(|&(child, parent)| (places[child] - places[parent]).norm()).collect();
    lengths.iter().sum::<f64>() / lengths.len() as f64
}

fn efforts() -> Vec<Vec<Effort>> {
    let of_radio =
        |radio: &Radio| RATES.par_iter().map(|&rate| effort(radio.full_range, rate)).collect();
    RADIOS.iter().map(of_radio).collect()
}

#[test]
fn the_lower_the_rates_the_fewer_the_recruits() {
    let efforts = efforts();
    for of_radio in &efforts {
        let mut serviced = of_radio.iter().filter(|it| it.outcome == Outcome::Serviced);
        assert!(serviced.clone().is_sorted_by_key(|it| it.recruits));
        let (first, last) = (serviced.next().unwrap(), serviced.next_back().unwrap());
        assert!(first.recruits < last.recruits && first.mean_length > last.mean_length);
        let ended = of_radio.iter().filter(|it| it.outcome != Outcome::Serviced);
        ended.for_each(|it| assert_eq!(it.outcome, Outcome::Blocked, "at {}", it.rate));
    }
    keep_up_to_date("../../docs/pictures/rates.svg", &picture(&efforts), "rates::");
}

/// Thirteen robots are too few at this rate for links that carry it in any case.
#[test]
fn a_team_without_a_recruit_stretches_its_links() {
    let mission = run(study(0.2, 0.07));
    mission.assert_serviced();
    let stretched =
        |(_, event): &(usize, &MissionEvent)| matches!(event, MissionEvent::LinksStretched { .. });
    assert_eq!(mission.events().filter(stretched).count(), 1);

    let mut scenario = study(0.2, 0.07);
    scenario.control.tree_reliability = Some(0.8);
    assert_eq!(run(scenario).end.outcome, Outcome::InsufficientRobots);
}

const SIZE: [f64; 2] = [760.0, 520.0];
const LEFT: f64 = 70.0;
const RIGHT: f64 = 740.0;
/// Top and bottom of the two plots.
const PLOTS: [[f64; 2]; 2] = [[60.0, 245.0], [290.0, 475.0]];
const TEXT_SIZE: f64 = 12.0;

/// Recruits and lengths of links against the rate.
fn picture(efforts: &[Vec<Effort>]) -> String {
    let across = Axis::from_zero(RATES, LEFT, RIGHT);
    let all = || efforts.iter().flatten();
    let recruits = Axis::from_zero(all().map(|it| it.recruits as f64), PLOTS[0][1], PLOTS[0][0]);
    let lengths = Axis::roomy(all().map(|it| it.mean_length), PLOTS[1][1], PLOTS[1][0]);
    let of_recruits = curves(efforts, &across, &recruits, |it| it.recruits as f64);
    let of_lengths = curves(efforts, &across, &lengths, |it| it.mean_length);
    sheet([0.0, 0.0], SIZE)
        .set("font-family", WORDS.families)
        .set("font-size", TEXT_SIZE)
        .set("fill", INK)
        .add(legend())
        .add(grid(&across, &recruits, PLOTS[0], "recruits"))
        .add(of_recruits)
        .add(grid(&across, &lengths, PLOTS[1], "mean length of links at the end"))
        .add(of_lengths)
        .add(text("rate of each robot", [LEFT, SIZE[1] - 8.0]))
        .to_string()
}

fn curves(
    efforts: &[Vec<Effort>],
    across: &Axis,
    up: &Axis,
    value: impl Fn(&Effort) -> f64,
) -> Group {
    RADIOS.iter().zip(efforts).fold(layer("curves"), |group, (radio, efforts)| {
        let spot = |it: &Effort| [across.place(it.rate), up.place(value(it))];
        let stroke = polyline(efforts.iter().map(spot)).set("stroke", radio.colour);
        efforts.iter().fold(group.add(stroke.set("stroke-width", 1.5)), |group, it| {
            group.add(mark(spot(it), radio, it.outcome == Outcome::Serviced))
        })
    })
}

fn mark(spot: [f64; 2], radio: &Radio, is_serviced: bool) -> impl pleach_drawing::svg::Node {
    let filling = if is_serviced { radio.colour } else { "#ffffff" };
    disc(spot, 4.5).set("fill", filling).set("stroke", radio.colour).set("stroke-width", 1.5)
}

fn grid(across: &Axis, up: &Axis, [top, bottom]: [f64; 2], name: &str) -> Group {
    let mut group = layer("grid").add(text(name, [LEFT, top - 12.0]).set("font-weight", "600"));
    for tick in up.ticks(6.0).0 {
        let rule = line([LEFT, tick.place], [RIGHT, tick.place]).set("stroke", GRID);
        let number = text(tick.text, [LEFT - 8.0, tick.place + 4.0]).set("text-anchor", "end");
        group = group.add(rule).add(number.set("fill", QUIET));
    }
    for tick in across.ticks(6.0).0 {
        let rule = line([tick.place, top], [tick.place, bottom]).set("stroke", GRID);
        let number = text(tick.text, [tick.place, bottom + 16.0]).set("text-anchor", "middle");
        group = group.add(rule).add(number.set("fill", QUIET));
    }
    group
}

fn legend() -> Group {
    let mut group = layer("legend");
    let mut left = LEFT;
    for radio in &RADIOS {
        let words = format!("l = {}, u = 0.5", radio.full_range);
        group = group.add(mark([left + 5.0, 20.0], radio, true));
        group = group.add(text(&words, [left + 15.0, 24.0]));
        left += 130.0;
    }
    let ended = Radio { full_range: 0.0, colour: QUIET };
    group = group.add(mark([left + 5.0, 20.0], &ended, false));
    group.add(text("ends: links carry no more", [left + 15.0, 24.0]))
}
