//! The picture of a large automaton from further away: boxes in a ring, each for several locations or for a part of
//! their data, and one arrow for all transitions from one box to another.

use std::f64::consts::TAU;

use super::canvas::{Canvas, LINE_HEIGHT, MARGIN, Pixel, Size, text_width};
use pleach_drawing::number;

/// Between a text and the border of its box, in pixels.
const PADDING: f64 = 12.0;
/// Half the width and half the height of the ring on which the boxes stand, in pixels.
const RING: [f64; 2] = [290.0, 230.0];
/// How far an arrow bends to its right, as a share of its length: opposite arrows stay apart.
const BEND: f64 = 0.09;
/// The radius of the ground of a number, in pixels.
const GROUND: f64 = 9.0;
/// Places along an arrow at which other arrows are avoided; numbers stand at those of the second and third quarter.
const PLACES: usize = 24;

/// Boxes with these names in a ring, clockwise from the top, and an arrow from one to another where `transitions` is not
/// 0, labelled with it. What leads from a box back to itself is left out.
///
/// ```
/// use pleach_automaton::diagram;
///
/// let counts = [[3, 2, 0], [1, 0, 0], [1, 1, 0]];
/// let picture = diagram::overview_svg(&["idle", "busy", "failed"], |from, to| counts[from][to]);
/// assert_eq!(picture.matches("class=\"arrow\"").count(), 4);
/// ```
pub fn overview_svg(names: &[&str], transitions: impl Fn(usize, usize) -> usize) -> String {
    let widest = names.iter().map(|name| text_width(name)).fold(0.0, f64::max);
    let size = Size { width: widest + 2.0 * PADDING, height: LINE_HEIGHT + PADDING };
    let [across, down] =
        [RING[0] + size.width / 2.0, RING[1] + size.height / 2.0].map(|it| it + MARGIN);
    let places: Vec<Pixel> = (0..names.len())
        .map(|number| {
            let angle = number as f64 / names.len() as f64 * TAU;
            Pixel { x: across + RING[0] * angle.sin(), y: down - RING[1] * angle.cos() }
        })
        .collect();

    let pairs = (0..names.len()).flat_map(|from| (0..names.len()).map(move |to| (from, to)));
    let drawn = pairs.filter(|(from, to)| from != to && transitions(*from, *to) > 0);
    let arrows: Vec<(Arrow, usize)> = drawn
        .map(|(from, to)| (Arrow::between(places[from], places[to], size), transitions(from, to)))
        .collect();

    let mut canvas = Canvas::new();
    for (arrow, _) in &arrows {
        canvas.path(&arrow.path(), "arrow", true);
    }
    for (number, (arrow, count)) in arrows.iter().enumerate() {
        let others = arrows.iter().enumerate().filter(|(other, _)| *other != number);
        let others: Vec<Pixel> = others.flat_map(|(_, (arrow, _))| arrow.places()).collect();
        let place = arrow.freest_place(&others);
        canvas.ground(place, GROUND);
        canvas.label(place, &count.to_string(), "middle");
    }
    for (name, &Pixel { x, y }) in names.iter().zip(&places) {
        let corner = Pixel { x: x - size.width / 2.0, y: y - size.height / 2.0 };
        canvas.location(corner, size, name, false);
        canvas.label(Pixel { x, y }, name, "name middle");
    }
    canvas.finish(Size { width: 2.0 * across, height: 2.0 * down })
}

/// A quadratic Bézier curve from box to box.
struct Arrow {
    begin: Pixel,
    bend: Pixel,
    end: Pixel,
}

impl Arrow {
    fn between(source: Pixel, target: Pixel, size: Size) -> Arrow {
        let way = [target.x - source.x, target.y - source.y];
        let bend = Pixel {
            x: source.x + way[0] / 2.0 - 2.0 * BEND * way[1],
            y: source.y + way[1] / 2.0 + 2.0 * BEND * way[0],
        };
        Arrow { begin: border(source, bend, size), bend, end: border(target, bend, size) }
    }

    fn path(&self) -> String {
        let Arrow { begin, bend, end } = self;
        let [x, y, bx, by, tx, ty] = [begin.x, begin.y, bend.x, bend.y, end.x, end.y].map(number);
        format!("M {x} {y} Q {bx} {by} {tx} {ty}")
    }

    /// Places along the arrow, the ends included.
    fn places(&self) -> impl Iterator<Item = Pixel> {
        let Arrow { begin, bend, end } = self;
        (0..PLACES).map(move |place| {
            let t = place as f64 / (PLACES - 1) as f64;
            let [from, over, to] = [(1.0 - t) * (1.0 - t), 2.0 * t * (1.0 - t), t * t];
            Pixel {
                x: from * begin.x + over * bend.x + to * end.x,
                y: from * begin.y + over * bend.y + to * end.y,
            }
        })
    }

    /// The place between the first and the last quarter that is farthest from all of the others.
    fn freest_place(&self, others: &[Pixel]) -> Pixel {
        let room = |at: Pixel| {
            let away = others.iter().map(|other| (at.x - other.x).hypot(at.y - other.y));
            away.fold(f64::INFINITY, f64::min)
        };
        let inner = self.places().take(PLACES * 3 / 4).skip(PLACES / 4);
        let free = inner.map(|place| (room(place), place));
        free.max_by(|one, other| one.0.total_cmp(&other.0)).map_or(self.bend, |(_, place)| place)
    }
}

/// Where the way from the middle of a box towards a place leaves the box.
fn border(middle: Pixel, towards: Pixel, size: Size) -> Pixel {
    let way = [towards.x - middle.x, towards.y - middle.y];
    let share = (size.width / 2.0 / way[0].abs()).min(size.height / 2.0 / way[1].abs());
    Pixel { x: middle.x + share * way[0], y: middle.y + share * way[1] }
}
