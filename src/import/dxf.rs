//! Drawings in DXF: lines, polylines, arcs and circles by their layers, those of inserted blocks included.

use super::features::{Feature, Shape};
use super::outline::Ring;
use super::{Plan, Reading, survey};
use dxf::Drawing;
use dxf::entities::{Arc, Entity, EntityType, Insert};
use dxf::enums::Units;
use kurbo::{Affine, PathEl, Point, Shape as _};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Chords deviate from arcs by this share of the radius.
const CHORDS: f64 = 1e-3;
/// The deepest that blocks may stand in one another.
const DEEPEST: usize = 16;

/// Reads the entities of the model space by their layers.
pub(super) fn read(path: &Path, reading: &Reading) -> Result<Plan, String> {
    let drawing = Drawing::load_file(path)
        .map_err(|error| format!("no drawing that can be read: {error}"))?;
    let (unit, note) = unit(&drawing);
    let mut found = Found { drawing: &drawing, features: Vec::new(), others: BTreeSet::new() };
    let model = drawing.entities().filter(|entity| !entity.common.is_in_paper_space);
    found.add_all(model, Affine::scale(unit * reading.scale), 0)?;
    let Found { features, others, .. } = found;
    let mut plan = survey::plan(features, reading)?;
    plan.notes.extend(note);
    if !others.is_empty() {
        let others: Vec<String> = others.into_iter().collect();
        plan.notes.push(format!("left out: entities that are no lines ({})", others.join(", ")));
    }
    Ok(plan)
}

/// The length of a unit of the drawing in metres.
fn unit(drawing: &Drawing) -> (f64, Option<String>) {
    let units = drawing.header.default_drawing_units;
    let metres = match units {
        Units::Millimeters => 1e-3,
        Units::Centimeters => 1e-2,
        Units::Decimeters => 0.1,
        Units::Meters => 1.0,
        Units::Inches => 0.0254,
        Units::Feet => 0.3048,
        Units::Yards => 0.9144,
        _ => return (1.0, Some("the drawing states no unit that is read: lengths are taken as they are; --scale changes them".into())),
    };
    (metres, Some(format!("the unit of the drawing is {metres} m")))
}

struct Found<'a> {
    drawing: &'a Drawing,
    features: Vec<Feature>,
    /// The kinds of entities that are left out.
    others: BTreeSet<String>,
}

impl<'a> Found<'a> {
    fn add_all(
        &mut self,
        entities: impl Iterator<Item = &'a Entity>,
        transform: Affine,
        depth: usize,
    ) -> Result<(), String> {
        for entity in entities {
            match &entity.specific {
                EntityType::Insert(insert) => self.add_block(insert, transform, depth)?,
                specific => match outline(specific) {
                    Some(corners) => self.add(&entity.common.layer, transform, corners),
                    None => {
                        self.others.insert(name(specific));
                    }
                },
            }
        }
        Ok(())
    }

    fn add(&mut self, layer: &str, transform: Affine, corners: Ring) {
        let place = |[x, y]: [f64; 2]| {
            let Point { x, y } = transform * Point::new(x, y);
            [x, y]
        };
        let properties = BTreeMap::from([("layer".to_owned(), layer.to_owned())]);
        let shape = Shape::Line(corners.into_iter().map(place).collect());
        self.features.push(Feature { properties, shape });
    }

    fn add_block(&mut self, insert: &Insert, outer: Affine, depth: usize) -> Result<(), String> {
        let wrong = |problem: &str| format!("block {:?}: {problem}", insert.name);
        if depth == DEEPEST {
            return Err(wrong(
                "it stands in itself, or blocks are more than 16 deep in one another",
            ));
        }
        let drawing = self.drawing;
        let block = drawing.blocks().find(|block| block.name == insert.name);
        let block = block.ok_or_else(|| wrong("it is inserted and not there"))?;
        let (rows, columns) = (insert.row_count.max(1), insert.column_count.max(1));
        for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)))
        {
            let step =
                (f64::from(column) * insert.column_spacing, f64::from(row) * insert.row_spacing);
            let transform = outer
                * Affine::translate((insert.location.x, insert.location.y))
                * Affine::rotate(insert.rotation.to_radians())
                * Affine::translate(step)
                * Affine::scale_non_uniform(insert.x_scale_factor, insert.y_scale_factor)
                * Affine::translate((-block.base_point.x, -block.base_point.y));
            self.add_all(block.entities.iter(), transform, depth + 1)?;
        }
        Ok(())
    }
}

/// The line that an entity draws, ended where it starts if it is closed.
fn outline(entity: &EntityType) -> Option<Ring> {
    match entity {
        EntityType::Line(line) => Some(vec![[line.p1.x, line.p1.y], [line.p2.x, line.p2.y]]),
        EntityType::LwPolyline(line) => {
            let corners = line.vertices.iter().map(|corner| ([corner.x, corner.y], corner.bulge));
            Some(polyline(corners.collect(), line.is_closed()))
        }
        EntityType::Polyline(line) => {
            let corners = line
                .vertices()
                .map(|corner| ([corner.location.x, corner.location.y], corner.bulge));
            Some(polyline(corners.collect(), line.is_closed()))
        }
        EntityType::Arc(Arc { center, radius, start_angle, end_angle, .. }) => {
            let sweep = (end_angle - start_angle).rem_euclid(360.0).to_radians();
            Some(arc([center.x, center.y], *radius, start_angle.to_radians(), sweep))
        }
        EntityType::Circle(circle) => {
            let mut corners =
                arc([circle.center.x, circle.center.y], circle.radius, 0.0, std::f64::consts::TAU);
            // The end is the start but for rounding.
            corners.pop();
            corners.extend(corners.first().copied());
            Some(corners)
        }
        _ => None,
    }
}

/// Corners with chords in place of the arcs that bulge between them.
fn polyline(corners: Vec<([f64; 2], f64)>, is_closed: bool) -> Ring {
    let count = corners.len();
    let mut line = Ring::new();
    for (index, &(from, bulge)) in corners.iter().enumerate() {
        line.push(from);
        if bulge == 0.0 || index + 1 == count && !is_closed {
            continue;
        }
        let to = corners[(index + 1) % count].0;
        let [across, up] = [to[0] - from[0], to[1] - from[1]];
        // The bulge is the tangent of a quarter of the angle that the arc sweeps.
        let aside = (1.0 - bulge * bulge) / (4.0 * bulge);
        let center = [from[0] + across / 2.0 - aside * up, from[1] + up / 2.0 + aside * across];
        let [x, y] = [from[0] - center[0], from[1] - center[1]];
        let chords = arc(center, x.hypot(y), y.atan2(x), 4.0 * bulge.atan());
        line.extend(&chords[1..chords.len().max(2) - 1]);
    }
    if is_closed {
        line.extend(line.first().copied());
    }
    line
}

fn arc(center: [f64; 2], radius: f64, start: f64, sweep: f64) -> Ring {
    let arc = kurbo::Arc::new((center[0], center[1]), (radius, radius), start, sweep, 0.0);
    let mut corners = Ring::new();
    kurbo::flatten(arc.path_elements(CHORDS * radius), CHORDS * radius, |element| match element {
        PathEl::MoveTo(corner) | PathEl::LineTo(corner) => corners.push([corner.x, corner.y]),
        _ => {}
    });
    corners
}

/// The name of a kind of entities.
fn name(entity: &EntityType) -> String {
    let debug = format!("{entity:?}");
    debug.split('(').next().unwrap_or_default().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two rooms with a door between them: the outer walls and those beside the door, all 0.1 wide.
    #[test]
    fn what_the_layers_of_walls_enclose_is_floor() {
        let plan = read("tests/maps/office.dxf".as_ref(), &Reading::default()).unwrap();
        let area = 11.9 * 7.9 - 0.1 * (2.95 + 2.95);
        assert!((plan.account.stated - area).abs() < 1e-3, "{:?}", plan.account);
        assert_eq!((plan.account.lost(), plan.workspace.boundary.len()), (0.0, 12));
        let note = "lines with layer=FURNITURE: 1 left out (--wall layer=FURNITURE: walls)";
        assert!(plan.notes.iter().any(|it| it == note), "{:?}", plan.notes);
    }

    /// A bulge of 1 is a half circle, to the right of the way.
    #[test]
    fn bulges_are_arcs() {
        let line = polyline(vec![([0.0, 0.0], 1.0), ([2.0, 0.0], 0.0)], false);
        let lowest = line.iter().map(|corner| corner[1]).fold(0.0, f64::min);
        assert!((lowest + 1.0).abs() < 2e-3, "{line:?}");
        assert_eq!((line[0], line[line.len() - 1]), ([0.0, 0.0], [2.0, 0.0]));
    }
}
