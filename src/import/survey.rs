//! One floor from the features of a map, and a table of what was recognised as what.

use super::features::{Feature, Role, Shape};
use super::levels::Levels;
use super::outline::{Sketch, oriented};
use super::stroke::{Door, Stroke};
use super::{MapPlaces, Plan, Reading, counted};
use crate::figures::quantity;
use std::collections::BTreeMap;

/// How wide walls drawn as lines are where nothing is stated, in metres.
const WALL_WIDTH: f64 = 0.1;
/// How wide a door is that is a point without a width, in metres.
const DOOR_WIDTH: f64 = 1.0;
/// The most points whose names are listed.
const NAMES_LISTED: usize = 20;

/// A property that makes features walls or floor must be one that some feature has.
fn refuse_unmatched(features: &[Feature], reading: &Reading) -> Result<(), String> {
    for (option, chosen) in [("--wall", &reading.walls), ("--floor", &reading.floors)] {
        let is_met = |(key, value): &&(String, String)| {
            features.iter().any(|feature| feature.properties.get(key) == Some(value))
        };
        if let Some((key, value)) = chosen.iter().find(|property| !is_met(property)) {
            return Err(format!("{option} {key}={value}: no feature of the map has that property"));
        }
    }
    Ok(())
}

/// The floor that features show on one level, with the places that they name.
pub(super) fn plan(features: Vec<Feature>, reading: &Reading) -> Result<Plan, String> {
    refuse_unmatched(&features, reading)?;
    let (features, mut notes) = Levels::of(&features).choose(features, reading.level.as_deref())?;
    let wall_width = reading.wall_width.unwrap_or(WALL_WIDTH);
    let (mut table, mut survey) = (Table::default(), Survey::default());
    for feature in &features {
        let (stated, role) = feature.role(reading);
        let taken = survey.take(feature, role, wall_width);
        table.add(feature, stated, role, taken);
    }
    let Survey { mut sketch, rooms, doors, places } = survey;
    let has_doors = !doors.is_empty() || !sketch.doors.is_empty();
    if has_doors {
        sketch.lines.extend(rooms);
    } else if !rooms.is_empty() {
        notes.push("no doors are on this map: rooms have no walls around them".into());
    }
    sketch.lines = sketch.lines.iter().flat_map(|line| line.beside(&doors)).collect();
    notes.extend(table.rows());
    if !sketch.lines.is_empty() {
        let width = quantity(wall_width);
        notes.push(format!(
            "walls drawn as lines are {width} wide unless they state a width (--wall-width)"
        ));
    }
    notes.extend(names(&places));
    let (workspace, account) = sketch.floor().map_err(|problem| {
        let rows: Vec<String> = table.rows().collect();
        if rows.is_empty() { problem } else { format!("{problem}; it has: {}", rows.join("; ")) }
    })?;
    let account = account.accepted(reading.accepted_loss)?;
    notes.insert(0, account.to_string());
    Ok(Plan { workspace, places, account, picture: None, lines: sketch.drawn(), notes })
}

/// What is to be said about points with a name.
fn names(places: &MapPlaces) -> Option<String> {
    let names: Vec<&str> = places.named.iter().map(|(name, _)| name.as_str()).collect();
    let listed = names[..names.len().min(NAMES_LISTED)].join(", ");
    let points = counted(names.len(), "point has a name", "points have names");
    let more = if names.len() > NAMES_LISTED { ", …" } else { "" };
    (!names.is_empty())
        .then(|| format!("{points}, which --access-point, --near and --task take: {listed}{more}"))
}

/// What features show.
#[derive(Default)]
struct Survey {
    sketch: Sketch,
    /// The walls around rooms.
    rooms: Vec<Stroke>,
    doors: Vec<Door>,
    places: MapPlaces,
}

impl Survey {
    /// Takes a feature in a role; as what it was taken, if it was.
    fn take(&mut self, feature: &Feature, role: Option<Role>, wall_width: f64) -> Option<Role> {
        let width = feature.width().unwrap_or(wall_width);
        match (&feature.shape, role) {
            (&Shape::Point(place), role) => return self.take_point(feature, place, role),
            (Shape::Polygon(rings), Some(Role::Wall)) => {
                self.sketch.walls.extend(oriented(rings.clone()))
            }
            (Shape::Polygon(rings), Some(Role::Door)) => {
                self.sketch.doors.extend(oriented(rings.clone()))
            }
            (Shape::Polygon(rings), role) => {
                self.sketch.floors.extend(oriented(rings.clone()));
                if role == Some(Role::Room) {
                    let wall = |corners| Stroke { corners, is_closed: true, width };
                    self.rooms.extend(rings.iter().cloned().map(wall));
                    return role;
                }
                return Some(Role::Floor);
            }
            (Shape::Line(corners), Some(Role::Wall)) => {
                self.sketch.lines.push(Stroke::along(corners.clone(), width));
            }
            (Shape::Line(corners), Some(Role::Door)) => {
                self.sketch.doors.extend(Stroke::along(corners.clone(), 2.0 * width).outline());
            }
            (Shape::Line(corners), Some(Role::Floor | Role::Room)) => {
                let Stroke { corners, is_closed: true, .. } = Stroke::along(corners.clone(), width)
                else {
                    return None;
                };
                let shape = Shape::Polygon(vec![corners]);
                return self.take(&Feature { shape, ..feature.clone() }, role, wall_width);
            }
            (Shape::Line(_), _) => return None,
        }
        role
    }

    fn take_point(&mut self, feature: &Feature, at: [f64; 2], role: Option<Role>) -> Option<Role> {
        let name = feature.properties.get("name").filter(|name| !name.is_empty());
        self.places.named.extend(name.map(|name| (name.clone(), at)));
        match role? {
            Role::AccessPoint => self.places.access_points.push(at),
            Role::Robot => self.places.robots.push(at),
            Role::Task => self.places.tasks.push(at),
            Role::Door => {
                self.doors.push(Door { at, width: feature.width().unwrap_or(DOOR_WIDTH) })
            }
            Role::Floor | Role::Room | Role::Wall => return None,
        }
        role
    }
}

/// What was recognised as what, and how often.
#[derive(Default)]
struct Table(BTreeMap<[String; 2], usize>);

impl Table {
    fn add(
        &mut self,
        feature: &Feature,
        stated: Option<(&str, &str)>,
        role: Option<Role>,
        taken: Option<Role>,
    ) {
        let shape = match feature.shape {
            Shape::Polygon(_) => "polygons",
            Shape::Line(_) => "lines",
            Shape::Point(_) if taken.is_none() && feature.properties.contains_key("name") => return,
            Shape::Point(_) => "points",
        };
        let by = stated.map_or("no kind".to_owned(), |(key, value)| format!("{key}={value}"));
        let taken =
            taken.map_or("left out".to_owned(), |role| format!("taken as {}", role.plural()));
        let hint = match stated {
            Some((key, value)) if role.is_none() && shape != "points" => {
                format!(" (--wall {key}={value}: walls)")
            }
            _ => String::new(),
        };
        let row = [format!("{shape} with {by}"), format!("{taken}{hint}")];
        *self.0.entry(row).or_default() += 1;
    }

    fn rows(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|([which, what], count)| format!("{which}: {count} {what}"))
    }
}
