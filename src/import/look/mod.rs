//! A page on which the floor of a map is seen over the map as it is, and places are set by clicking.

use super::gaps::{self, Gap};
use super::{Choices, Picture, Plan, Spot};
use crate::automaton::network::scenario::ValidScenario;
use crate::continuous::Point;
use crate::page::document::{escaped, filled, render};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use image::{GrayImage, ImageFormat};
use serde::Serialize;
use std::io::Cursor;

/// The most passages that are drawn, the widest ones.
const MOST_GAPS: usize = 1000;

/// What the page shows.
#[derive(Serialize)]
struct Data<'a> {
    command: &'a str,
    notes: &'a [String],
    boundary: &'a [[f64; 2]],
    holes: &'a [Vec<[f64; 2]>],
    picture: Option<Shown>,
    lines: &'a [Vec<[f64; 2]>],
    room: Vec<Room>,
    gaps: Vec<Hole>,
    /// How many passages are too narrow.
    narrow: usize,
    clearance: f64,
    access: Vec<[f64; 2]>,
    robots: Vec<[f64; 2]>,
    tasks: Vec<[f64; 2]>,
    named: &'a [(String, [f64; 2])],
    chosen: Chosen,
    count: usize,
}

/// The map as it is.
#[derive(Serialize)]
struct Shown {
    href: String,
    width: u32,
    height: u32,
    placement: [f64; 6],
}

/// A piece of the floor where robots keep their clearance.
#[derive(Serialize)]
struct Room {
    rings: Vec<Vec<[f64; 2]>>,
    reached: bool,
}

#[derive(Serialize)]
struct Hole {
    at: [f64; 2],
    width: f64,
}

/// The places that are set on the command line.
#[derive(Serialize)]
struct Chosen {
    access: Vec<[f64; 2]>,
    near: Option<[f64; 2]>,
    task: Vec<[f64; 2]>,
}

/// A page that needs no other file and no network; the command that it prints begins with `command`.
pub fn page(
    plan: &Plan,
    scenario: &ValidScenario,
    choices: &Choices,
    notes: &[String],
    command: &str,
) -> String {
    let gaps = gaps::narrower_than(&scenario.site().workspace, 2.0 * scenario.settings().clearance);
    let narrow = gaps.len();
    let widest = gaps.into_iter().rev().take(MOST_GAPS).map(|Gap { width, at }| Hole { at, width });
    let data = Data {
        command,
        notes,
        boundary: &scenario.workspace.boundary,
        holes: &scenario.workspace.holes,
        picture: plan.picture.as_ref().and_then(shown),
        lines: &plan.lines,
        room: room(scenario),
        gaps: widest.collect(),
        narrow,
        clearance: scenario.settings().clearance,
        access: scenario.access_point.iter().map(|it| it.position).collect(),
        robots: scenario.robot.iter().map(|it| it.position).collect(),
        tasks: scenario.task.iter().map(|it| it.position).collect(),
        named: &plan.places.named,
        chosen: chosen(plan, choices),
        count: scenario.robot.len(),
    };
    let body = filled(include_str!("look.html"), &[("title", escaped(&scenario.name))]);
    render(&scenario.name, include_str!("look.css"), &body, &data, include_str!("look.js"))
}

fn shown(Picture { width, height, shades, placement }: &Picture) -> Option<Shown> {
    let mut png = Cursor::new(Vec::new());
    GrayImage::from_raw(*width, *height, shades.clone())?
        .write_to(&mut png, ImageFormat::Png)
        .ok()?;
    let href = format!("data:image/png;base64,{}", BASE64_STANDARD.encode(png.into_inner()));
    Some(Shown { href, width: *width, height: *height, placement: *placement })
}

/// The pieces of where robots can be, each with whether a way leads there from an access point.
fn room(scenario: &ValidScenario) -> Vec<Room> {
    let site = scenario.site();
    let space = &site.free_space;
    let region = |place: Point| space.region(space.nearest(place));
    let reached: Vec<_> = site.access_points.iter().filter_map(|&place| region(place)).collect();
    let mut rooms = [true, false].map(|reached| Room { rings: Vec::new(), reached });
    for ring in space.outline() {
        let is_reached =
            ring.first().and_then(|&corner| region(corner)).is_some_and(|it| reached.contains(&it));
        rooms[usize::from(!is_reached)]
            .rings
            .push(ring.iter().map(|&corner| corner.into()).collect());
    }
    rooms.into_iter().filter(|room| !room.rings.is_empty()).collect()
}

fn chosen(plan: &Plan, choices: &Choices) -> Chosen {
    let place = |spot: &Spot| plan.place(spot);
    Chosen {
        access: choices.access_points.iter().filter_map(place).collect(),
        near: choices.near.as_ref().and_then(place),
        task: choices.tasks.iter().filter_map(place).collect(),
    }
}
