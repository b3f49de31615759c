//! What of a drawing is seen, and where.

use super::elements::{Element, elements};
use super::shapes;
use crate::import::counted;
use kurbo::{Affine, BezPath, Point};
use std::collections::{BTreeMap, BTreeSet};
use svgtypes::{Align, AspectRatio, ViewBox};

/// Elements that draw nothing where they stand.
const NOT_DRAWN: [&str; 6] = ["clipPath", "defs", "marker", "mask", "pattern", "symbol"];
/// Elements that draw something that has no outline here.
const NO_SHAPES: [&str; 3] = ["foreignObject", "image", "text"];
/// The deepest that one `use` may draw another.
const DEEPEST_USE: usize = 32;
/// The most elements that are drawn by `use`, each as often as it is.
const MOST_USED: usize = 1_000_000;

/// A shape that is seen, in the units of the outermost `svg`.
pub(super) struct Drawn {
    pub outline: BezPath,
    /// How wide its outline is drawn, if it is.
    pub stroke: Option<f64>,
}

/// The shapes of a drawing, and what is to be said about it.
pub(super) fn shapes(text: &str) -> Result<(Vec<Drawn>, Vec<String>), String> {
    let elements = elements(text)?;
    let mut seen = Seen::default();
    if let Some(root) = elements.first() {
        if root.name != "svg" {
            return Err(root.wrong(&format!("the outermost element is {}, not svg", root.name)));
        }
        let ids = elements.iter().enumerate();
        let ids = ids.filter_map(|(index, element)| Some((element.attribute("id")?, index)));
        // Of elements of the same name the first is meant.
        let drawing = Drawing { elements: &elements, ids: ids.rev().collect() };
        drawing.draw(0, &root.as_group(), Surroundings::default(), &mut seen)?;
    }
    let notes = seen.notes();
    Ok((seen.shapes, notes))
}

/// What was come across where it is seen.
#[derive(Default)]
struct Seen {
    shapes: Vec<Drawn>,
    /// How many elements were drawn by `use`.
    used: usize,
    clipped: usize,
    without_outline: usize,
    /// Their names.
    kinds: BTreeSet<&'static str>,
    has_style_sheet: bool,
}

impl Seen {
    fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.without_outline > 0 {
            let many = counted(self.without_outline, "element that is", "elements that are");
            let kinds: Vec<_> = self.kinds.iter().copied().collect();
            notes.push(format!("left out: {many} no shape ({})", kinds.join(", ")));
        }
        if self.clipped > 0 {
            let many = counted(self.clipped, "element is", "elements are");
            notes.push(format!("clip paths and masks are not read: {many} taken whole"));
        }
        if self.has_style_sheet {
            notes.push(
                "style sheets are not read: what they hide or move is taken as it stands".into(),
            );
        }
        notes
    }
}

/// How what an element holds is drawn.
#[derive(Clone, Copy)]
struct Surroundings {
    transform: Affine,
    is_drawn: bool,
    is_visible: bool,
    is_stroked: bool,
    stroke_width: f64,
    /// How many `use` draw it, one within the other.
    uses: usize,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self {
            transform: Affine::IDENTITY,
            is_drawn: true,
            is_visible: true,
            is_stroked: false,
            stroke_width: 1.0,
            uses: 0,
        }
    }
}

impl Surroundings {
    fn within(self, element: &Element) -> Result<Self, String> {
        let is_drawn = !NOT_DRAWN.contains(&element.name.as_str())
            && element.property("display") != Some("none");
        let mut within = Self {
            transform: self.transform * element.transform()?,
            is_drawn: self.is_drawn && is_drawn,
            is_visible: match element.property("visibility") {
                Some("hidden" | "collapse") => false,
                Some("visible") => true,
                _ => self.is_visible,
            },
            is_stroked: element
                .property("stroke")
                .map_or(self.is_stroked, |stroke| stroke != "none"),
            stroke_width: element.stroke_width()?.unwrap_or(self.stroke_width),
            uses: self.uses,
        };
        if within.is_drawn && element.name == "svg" {
            within.transform *= viewport(element)?;
        }
        Ok(within)
    }
}

/// A drawing with the elements that have a name.
struct Drawing<'a> {
    elements: &'a [Element],
    ids: BTreeMap<&'a str, usize>,
}

impl Drawing<'_> {
    /// Draws an element, which is taken as `top`, and all that it holds.
    fn draw(
        &self,
        index: usize,
        top: &Element,
        outer: Surroundings,
        seen: &mut Seen,
    ) -> Result<(), String> {
        let mut around = vec![(top.end, outer)];
        for inner in index..top.end {
            let element = if inner == index { top } else { &self.elements[inner] };
            while around.last().is_some_and(|(end, _)| *end <= inner) {
                around.pop();
            }
            let outer = around.last().map_or(outer, |(_, surroundings)| *surroundings);
            let within = outer.within(element).map_err(|problem| element.wrong(&problem))?;
            around.push((element.end, within));
            if within.is_drawn && element.name == "use" {
                self.draw_used(element, within, seen)?;
            } else {
                seen.add(element, within).map_err(|problem| element.wrong(&problem))?;
            }
        }
        Ok(())
    }

    /// Draws what a `use` names.
    fn draw_used(
        &self,
        user: &Element,
        within: Surroundings,
        seen: &mut Seen,
    ) -> Result<(), String> {
        let wrong = |problem: String| user.wrong(&problem);
        let uses = within.uses + 1;
        if uses > DEEPEST_USE {
            return Err(wrong(format!(
                "use draws itself, or more than {DEEPEST_USE} draw one another"
            )));
        }
        let index = self.target(user).map_err(wrong)?;
        let corner = user.point(["x", "y"]).map_err(wrong)?;
        let transform = within.transform * Affine::translate(corner.to_vec2());
        let top = self.elements[index].used_by(user);
        self.draw(index, &top, Surroundings { transform, uses, ..within }, seen)
    }

    /// The index of the element that a `use` names.
    fn target(&self, user: &Element) -> Result<usize, String> {
        let reference = user.attribute("href").or(user.attribute("xlink:href"));
        let reference = reference.ok_or("use has no href")?;
        let id = reference.trim().strip_prefix('#').ok_or_else(|| {
            format!("use of {reference:?}: only elements of the same drawing, as #name, are read")
        })?;
        let index = self.ids.get(id).copied();
        index.ok_or_else(|| format!("use of {reference:?}: no element has this id"))
    }
}

impl Seen {
    fn add(&mut self, element: &Element, surroundings: Surroundings) -> Result<(), String> {
        self.used += usize::from(surroundings.uses > 0);
        if self.used > MOST_USED {
            return Err(format!("all use together draw more than {MOST_USED} elements"));
        }
        self.has_style_sheet |= element.name == "style";
        if !surroundings.is_drawn {
            return Ok(());
        }
        let is_clipped = |name| element.property(name).is_some_and(|value| value != "none");
        self.clipped += usize::from(is_clipped("clip-path") || is_clipped("mask"));
        if !surroundings.is_visible {
            return Ok(());
        }
        if let Some(kind) = NO_SHAPES.into_iter().find(|kind| element.name == *kind) {
            self.without_outline += 1;
            self.kinds.insert(kind);
        }
        let Surroundings { transform, is_stroked, stroke_width, .. } = surroundings;
        let stroke = is_stroked.then(|| stroke_width * transform.determinant().abs().sqrt());
        let outline = shapes::outline(element)?;
        self.shapes.extend(outline.map(|outline| Drawn { outline: transform * outline, stroke }));
        Ok(())
    }
}

/// Where a drawing in a drawing stands, and how it is fitted into its place.
fn viewport(svg: &Element) -> Result<Affine, String> {
    let corner = svg.point(["x", "y"])?;
    let Some(text) = svg.attribute("viewBox") else {
        return Ok(Affine::translate(corner.to_vec2()));
    };
    let ViewBox { x, y, w, h } =
        text.parse().map_err(|error| format!("viewBox {text:?}: {error}"))?;
    let [width, height] = [svg.length("width")?, svg.length("height")?];
    let ratio = svg.attribute("preserveAspectRatio").unwrap_or("xMidYMid");
    let ratio: AspectRatio =
        ratio.parse().map_err(|error| format!("preserveAspectRatio {ratio:?}: {error}"))?;
    let [across, down] = [width / w, height / h];
    let [across, down] = match (ratio.align, ratio.slice) {
        (Align::None, _) => [across, down],
        (_, false) => [across.min(down); 2],
        (_, true) => [across.max(down); 2],
    };
    let [left, above] = shares_before(ratio.align);
    let corner =
        Point::new(corner.x + left * (width - across * w), corner.y + above * (height - down * h));
    Ok(Affine::translate(corner.to_vec2())
        * Affine::scale_non_uniform(across, down)
        * Affine::translate((-x, -y)))
}

/// The shares of the room that a drawing leaves in its place that come before it.
fn shares_before(align: Align) -> [f64; 2] {
    match align {
        Align::None | Align::XMinYMin => [0.0, 0.0],
        Align::XMidYMin => [0.5, 0.0],
        Align::XMaxYMin => [1.0, 0.0],
        Align::XMinYMid => [0.0, 0.5],
        Align::XMidYMid => [0.5, 0.5],
        Align::XMaxYMid => [1.0, 0.5],
        Align::XMinYMax => [0.0, 1.0],
        Align::XMidYMax => [0.5, 1.0],
        Align::XMaxYMax => [1.0, 1.0],
    }
}
