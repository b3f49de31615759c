//! The families of floor plans, in units of the full range l.

use super::brief::{Brief, Crowd, Rates, Target};
use super::dice::Dice;
use super::outline::{Floor, Rectangle};
use pleach::automaton::network::scenario::{MotionSolver, RoutingMethod};

/// Default clearance ρ in units of l.
const CLEARANCE: f64 = 1.0 / 40.0;
/// Thickness of inner walls.
const WALL: f64 = 0.12;

/// A kind of mission.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// A corridor with rooms on both sides, one door each.
    Office,
    /// Ring corridors: shortest paths are not unique.
    Ring,
    /// Rooms behind each other, with doors 6ρ wide.
    Doors,
    /// Sixty robots in a hall with pillars.
    Hall,
    /// Two access points far apart, with a cluster of robots each.
    TwoClusters,
    /// Robots that are large compared with their radio's range.
    Discs,
    /// Corridors in which no robot can pass another.
    Corridors,
    /// Rectangles with random walls and convex pillars.
    Clutter,
    /// Tasks close to walls and in corners.
    Corners,
    /// Five to ten tasks.
    ManyTasks,
    /// Redundant robots in doorways and corridors.
    Parked,
    /// Starts in which most robots reach the access point over several hops.
    Chains,
    /// Other units, ranges, radii, rounds, methods.
    Settings,
    /// The rate of the studies, which a single gateway hardly carries.
    Rates,
    /// Corridors between the cells of a grid, with few loops.
    Maze,
    /// A corridor that winds inwards, with the access point at either end.
    Spiral,
    /// Chambers of all sizes that open into each other.
    Caves,
    /// Jagged obstacles in the open: many ways, none of them straight.
    Islands,
    /// Three access points among obstacles, with a cluster of robots each.
    Clusters,
}

impl Family {
    /// All but the hall, whose missions take too long for every day.
    pub fn of_every_day() -> impl Iterator<Item = Family> {
        Family::ALL.into_iter().filter(|&family| family != Family::Hall)
    }

    /// Floors on which ways are long and wind round many corners, or on which there are many.
    pub const WINDING: [Family; 5] =
        [Family::Maze, Family::Spiral, Family::Caves, Family::Islands, Family::Clusters];

    /// All families but those of [`WINDING`](Self::WINDING).
    pub const ALL: [Family; 14] = [
        Family::Office,
        Family::Ring,
        Family::Doors,
        Family::Hall,
        Family::TwoClusters,
        Family::Discs,
        Family::Corridors,
        Family::Clutter,
        Family::Corners,
        Family::ManyTasks,
        Family::Parked,
        Family::Chains,
        Family::Settings,
        Family::Rates,
    ];

    /// Its name, as in the names of its scenarios.
    pub fn name(self) -> &'static str {
        match self {
            Family::Office => "office",
            Family::Ring => "ring",
            Family::Doors => "doors",
            Family::Hall => "hall",
            Family::TwoClusters => "two-clusters",
            Family::Discs => "discs",
            Family::Corridors => "corridors",
            Family::Clutter => "clutter",
            Family::Corners => "corners",
            Family::ManyTasks => "many-tasks",
            Family::Parked => "parked",
            Family::Chains => "chains",
            Family::Settings => "settings",
            Family::Rates => "rates",
            Family::Maze => "maze",
            Family::Spiral => "spiral",
            Family::Caves => "caves",
            Family::Islands => "islands",
            Family::Clusters => "clusters",
        }
    }

    pub(super) fn brief(self, dice: &mut Dice) -> Brief {
        let mut brief = match self {
            Family::Office => office(dice),
            Family::Ring => ring(dice),
            Family::Doors => suite(6.0 * CLEARANCE, dice),
            Family::Hall => hall(dice),
            Family::TwoClusters => two_clusters(dice),
            Family::Discs => discs(dice),
            Family::Corridors => corridors(dice),
            Family::Clutter => clutter(dice),
            Family::Corners | Family::ManyTasks | Family::Chains => any_plan(dice),
            Family::Parked => parked(dice),
            Family::Settings => settings(dice),
            Family::Rates => Brief { rates: Rates::Default, spare: 2, ..any_plan(dice) },
            Family::Maze => maze(dice),
            Family::Spiral => spiral(dice),
            Family::Caves => caves(dice),
            Family::Islands => islands(dice),
            Family::Clusters => clusters(dice),
        };
        match self {
            Family::Corners => {
                let near = [Target::AtWalls, Target::InCorners];
                brief.targets = (0..dice.count(2, 4)).map(|_| dice.pick(&near)).collect();
            }
            Family::ManyTasks => brief.targets = vec![Target::Anywhere; dice.count(5, 10)],
            Family::Chains => brief.crowd = Crowd::Chains,
            Family::Rates => brief.targets.truncate(2),
            _ => {}
        }
        if dice.chance(0.3) {
            brief.turn = dice.between(0.0, 6.3);
        }
        brief
    }
}

fn any_plan(dice: &mut Dice) -> Brief {
    let plan: fn(&mut Dice) -> Brief = dice.pick(&[
        office as fn(&mut Dice) -> Brief,
        ring,
        |dice| suite(6.0 * CLEARANCE, dice),
        corridors,
        clutter,
        clutter,
        two_clusters,
        parked,
    ]);
    plan(dice)
}

/// Three to four rooms on each side of a corridor; the access point is in the corridor or a room.
fn office(dice: &mut Dice) -> Brief {
    let rooms = dice.count(2, 5);
    let depth = dice.between(0.9, 2.4);
    let corridor = dice.between(0.25, 0.7);
    let mut right = 0.0;
    let mut floor = Floor::default();
    let mut doorways = Vec::new();
    for _ in 0..rooms {
        let left = right;
        right = left + dice.between(0.8, 2.2);
        for side in [1.0, -1.0] {
            let door = dice.between(6.0 * CLEARANCE, 0.5);
            let at = dice.between(left + 0.1, right - WALL - 0.1 - door);
            let y = |distance: f64| side * (corridor / 2.0 + distance);
            let room = |near: f64, far: f64, left: f64, right: f64| {
                Rectangle::new(left, y(near).min(y(far)), right, y(near).max(y(far)))
            };
            floor.rooms.push(room(WALL, WALL + depth, left, right - WALL));
            floor.rooms.push(room(0.0, WALL, at, at + door));
            doorways.push([at + door / 2.0, y(WALL / 2.0)]);
        }
    }
    floor.rooms.push(Rectangle::new(0.0, -corridor / 2.0, right - WALL, corridor / 2.0));
    let home = match dice.chance(0.5) {
        true => [dice.between(0.1, right - 0.3), 0.0],
        false => dice.pick(&floor.rooms[..]).center(),
    };
    let mut brief = Brief::new(floor, home);
    brief.parked = (doorways.iter().copied()).filter(|_| dice.chance(0.1)).collect();
    brief
}

/// One or two rings; a task may lie exactly opposite the access point.
fn ring(dice: &mut Dice) -> Brief {
    let width = dice.between(0.2, 0.6);
    let (wide, high) = (dice.scale(1.6, 6.0), dice.scale(1.4, 5.0));
    let rings = dice.count(1, 2);
    let total = rings as f64 * (wide - width) + width;
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, total, high)]);
    for ring in 0..rings {
        let left = ring as f64 * (wide - width) + width;
        floor.walls.push(Rectangle::new(left, width, left + wide - 2.0 * width, high - width));
    }
    let mut brief = Brief::new(floor, [total / 2.0, width / 2.0]);
    if dice.chance(0.5) {
        let opposite = [total / 2.0, high - width / 2.0];
        brief.targets = vec![Target::At(opposite), Target::Anywhere];
    }
    brief
}

/// Rooms behind each other with doors of this width between them.
fn suite(door: f64, dice: &mut Dice) -> Brief {
    let rooms = dice.count(2, 4);
    let height = dice.between(0.8, 2.4);
    let mut right = 0.0;
    let mut floor = Floor::default();
    for room in 0..rooms {
        let left = right;
        right = left + dice.between(0.7, 2.4);
        if room > 0 {
            let bottom = dice.between(0.1, height - 0.1 - door);
            floor.rooms.push(Rectangle::new(left - WALL, bottom, left, bottom + door));
        }
        floor.rooms.push(Rectangle::new(left, 0.0, right, height));
        right += WALL;
    }
    let home = floor.rooms[0].center();
    Brief::new(floor, home)
}

fn hall(dice: &mut Dice) -> Brief {
    let (wide, high) = (dice.between(5.0, 7.5), dice.between(4.0, 6.0));
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, wide, high)]);
    let pitch = dice.between(1.0, 1.6);
    let thickness = dice.between(0.15, 0.4);
    let (columns, rows) = ((wide / pitch) as usize, (high / pitch) as usize);
    for column in 1..columns {
        for row in 1..rows {
            let (x, y) = (column as f64 * pitch, row as f64 * pitch);
            floor.walls.push(Rectangle::new(x, y, x + thickness, y + thickness));
        }
    }
    let home = [dice.between(0.5, wide - 0.5), dice.between(0.5, high - 0.5)];
    let mut brief = Brief::new(floor, home);
    brief.least_robots = 60;
    brief.targets = vec![Target::Anywhere; dice.count(3, 6)];
    brief
}

/// Clusters at the ends of a long floor: a hall, a corridor between two rooms, or a suite.
fn two_clusters(dice: &mut Dice) -> Brief {
    let long = dice.between(4.0, 9.0);
    let high = dice.between(1.0, 2.0);
    let mut floor = match dice.chance(0.5) {
        true => Floor::of(vec![Rectangle::new(0.0, 0.0, long, high)]),
        false => Floor::of(vec![
            Rectangle::new(0.0, 0.0, 1.5, high),
            Rectangle::new(1.5, high / 2.0 - 0.2, long - 1.5, high / 2.0 + 0.2),
            Rectangle::new(long - 1.5, 0.0, long, high),
        ]),
    };
    if floor.rooms.len() == 1 {
        pillars(&mut floor, 3, dice);
    }
    let mut brief = Brief::new(floor, [0.6, high / 2.0]);
    brief.access_points.push([long - 0.6, high / 2.0]);
    brief.targets.truncate(dice.count(2, 3));
    brief.spare = 4;
    brief
}

fn discs(dice: &mut Dice) -> Brief {
    let clearance = dice.between(0.06, 0.13);
    let mut brief = match dice.count(0, 3) {
        0 => suite(dice.between(5.0, 8.0) * clearance, dice),
        1 => ring(dice),
        2 => clutter(dice),
        _ => two_clusters(dice),
    };
    brief.control.clearance = Some(clearance);
    brief.control.service_radius = Some(clearance * dice.between(2.3, 3.0));
    brief.control.step_radius = Some(0.03);
    brief.max_range = dice.between(1.3, 1.6);
    brief.targets.truncate(2);
    brief
}

/// Two rooms and a side room, with corridors 2.3ρ to 4ρ wide between them.
fn corridors(dice: &mut Dice) -> Brief {
    let width = CLEARANCE * dice.between(2.3, 4.0);
    let (wide, high) = (dice.between(0.9, 1.6), dice.between(0.8, 1.4));
    let long = dice.between(0.3, 2.5);
    let floor_at = dice.between(0.1, high - 0.2);
    let mut floor = Floor::of(vec![
        Rectangle::new(0.0, 0.0, wide, high),
        Rectangle::new(wide, floor_at, wide + long, floor_at + width),
        Rectangle::new(wide + long, 0.0, wide + long + dice.between(0.4, 1.2), high),
    ]);
    if dice.chance(0.6) {
        let at = dice.between(0.1, wide - 0.2);
        let length = dice.between(0.2, 0.8);
        floor.rooms.push(Rectangle::new(at, high, at + width, high + length));
        floor.rooms.push(Rectangle::new(0.0, high + length, wide, high + length + 0.7));
    }
    if dice.chance(0.4) {
        let branch = wide + long * dice.between(0.2, 0.7);
        floor.rooms.push(Rectangle::new(branch, floor_at - 1.0, branch + width, floor_at));
    }
    let home = floor.rooms[0].center();
    let mut brief = Brief::new(floor, home);
    if dice.chance(0.3) {
        let along = wide + dice.between(0.1, 0.9) * long.min(0.6);
        brief.parked.push([along, floor_at + width / 2.0]);
    }
    brief
}

fn clutter(dice: &mut Dice) -> Brief {
    let (wide, high) = (dice.scale(2.0, 8.0), dice.scale(1.8, 6.0));
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, wide, high)]);
    for _ in 0..dice.count(1, 8) {
        let (x, y) = (dice.between(0.3, wide - 0.3), dice.between(0.3, high - 0.3));
        let length = dice.between(0.4, 1.4);
        floor.walls.push(match dice.chance(0.5) {
            true => Rectangle::new(x, y, x + WALL, (y + length).min(high)),
            false => Rectangle::new(x, y, (x + length).min(wide), y + WALL),
        });
    }
    let count = dice.count(0, 8);
    pillars(&mut floor, count, dice);
    let home = [dice.between(0.3, wide - 0.3), dice.between(0.3, high - 0.3)];
    let mut brief = Brief::new(floor, home);
    brief.targets = vec![Target::Anywhere; dice.count(1, 4)];
    brief
}

/// A random spanning tree of the cells of a grid, each a square, with passages between them.
fn maze(dice: &mut Dice) -> Brief {
    let (columns, rows) = (dice.count(3, 5), dice.count(2, 4));
    let width = dice.between(0.25, 0.7);
    let pitch = width + WALL;
    let corner = |cell: usize| ((cell % columns) as f64 * pitch, (cell / columns) as f64 * pitch);
    let cell_at = |cell: usize| {
        let (left, bottom) = corner(cell);
        Rectangle::new(left, bottom, left + width, bottom + width)
    };
    let cells = columns * rows;
    let mut floor = Floor::of((0..cells).map(cell_at).collect());
    let mut passages: Vec<(usize, usize)> = (0..cells)
        .flat_map(|cell| {
            let right = (cell % columns + 1 < columns).then_some((cell, cell + 1));
            right.into_iter().chain((cell + columns < cells).then_some((cell, cell + columns)))
        })
        .collect();
    let mut piece: Vec<usize> = (0..cells).collect();
    while !passages.is_empty() {
        let (one, other) = passages.swap_remove(dice.count(0, passages.len() - 1));
        let (joined, apart) = (piece[one], piece[other]);
        if joined != apart || dice.chance(0.1) {
            piece.iter_mut().filter(|it| **it == apart).for_each(|it| *it = joined);
            let (left, bottom) = corner(one);
            let (right, top) = (cell_at(other).right, cell_at(other).top);
            floor.rooms.push(Rectangle::new(left, bottom, right, top));
        }
    }
    let home = floor.rooms[dice.count(0, cells - 1)].center();
    let mut brief = Brief::new(floor, home);
    brief.targets.truncate(dice.count(1, 2));
    brief
}

/// Each arm of the corridor is laid round those before it.
fn spiral(dice: &mut Dice) -> Brief {
    let width = dice.between(0.25, 0.6);
    let pitch = width + WALL;
    let arms = dice.count(4, 8);
    let mut rooms = Vec::new();
    let mut at = [0.0, 0.0];
    for arm in 0..arms {
        let long = pitch * (1 + arm / 2) as f64 + if arm < 2 { pitch } else { 0.0 };
        let [dx, dy] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][arm % 4];
        let to = [at[0] + dx * long, at[1] + dy * long];
        rooms.push(Rectangle::new(
            at[0].min(to[0]),
            at[1].min(to[1]),
            at[0].max(to[0]) + width,
            at[1].max(to[1]) + width,
        ));
        at = to;
    }
    let middle = |[left, bottom]: [f64; 2]| [left + width / 2.0, bottom + width / 2.0];
    let ends = [middle([0.0, 0.0]), middle(at)];
    let from_inside = dice.chance(0.5);
    let (home, goal) = if from_inside { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
    let mut brief = Brief::new(Floor::of(rooms), home);
    brief.targets = vec![Target::At(goal)];
    if dice.chance(0.5) {
        brief.targets.insert(dice.count(0, 1), Target::Anywhere);
    }
    brief
}

fn caves(dice: &mut Dice) -> Brief {
    let mut rooms: Vec<Rectangle> = Vec::new();
    let mut at = [0.0, 0.0];
    for _ in 0..dice.count(6, 14) {
        let (wide, high) = (dice.scale(0.25, 1.2), dice.scale(0.25, 1.2));
        let (left, bottom) = (at[0] - wide / 2.0, at[1] - high / 2.0);
        rooms.push(Rectangle::new(left, bottom, left + wide, bottom + high));
        let base = rooms[dice.count(rooms.len().saturating_sub(3), rooms.len() - 1)];
        at = [dice.between(base.left, base.right), dice.between(base.bottom, base.top)];
        // The next chamber opens from a side of this one.
        match dice.count(0, 3) {
            0 => at[0] = base.left,
            1 => at[0] = base.right,
            2 => at[1] = base.bottom,
            _ => at[1] = base.top,
        }
    }
    let home = rooms[0].center();
    let mut brief = Brief::new(Floor::of(rooms), home);
    brief.targets = vec![Target::Anywhere; dice.count(1, 3)];
    brief
}

fn islands(dice: &mut Dice) -> Brief {
    let (wide, high) = (dice.between(2.5, 7.0), dice.between(2.0, 5.0));
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, wide, high)]);
    let count = dice.count(3, 12);
    stars(&mut floor, count, dice);
    let home = [dice.between(0.3, wide - 0.3), dice.between(0.3, high - 0.3)];
    let mut brief = Brief::new(floor, home);
    brief.targets = vec![Target::Anywhere; dice.count(1, 3)];
    brief
}

/// Star-shaped polygons that are far from convex.
fn stars(floor: &mut Floor, count: usize, dice: &mut Dice) {
    let hull = floor.hull();
    for _ in 0..count {
        let center = [
            dice.between(hull.left + 0.5, hull.right - 0.5),
            dice.between(hull.bottom + 0.5, hull.top - 0.5),
        ];
        let corners = dice.count(6, 12);
        let size = dice.between(0.2, 0.6);
        floor.pillars.push(
            (0..corners)
                .map(|corner| {
                    let angle = std::f64::consts::TAU * corner as f64 / corners as f64;
                    let radius = size * dice.between(0.25, 1.0);
                    [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
                })
                .collect(),
        );
    }
}

fn clusters(dice: &mut Dice) -> Brief {
    let (wide, high) = (dice.between(5.0, 8.0), dice.between(1.5, 4.0));
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, wide, high)]);
    let count = dice.count(2, 6);
    stars(&mut floor, count, dice);
    let mut brief = Brief::new(floor, [0.5, dice.between(0.4, high - 0.4)]);
    brief.access_points.push([wide / 2.0, dice.between(0.4, high - 0.4)]);
    brief.access_points.push([wide - 0.5, dice.between(0.4, high - 0.4)]);
    brief.targets.truncate(dice.count(1, 3));
    brief.spare = 6;
    brief
}

/// Convex polygons, where they fit.
fn pillars(floor: &mut Floor, count: usize, dice: &mut Dice) {
    let hull = floor.hull();
    for _ in 0..count {
        let center = [
            dice.between(hull.left + 0.4, hull.right - 0.4),
            dice.between(hull.bottom + 0.4, hull.top - 0.4),
        ];
        let (corners, radius) = (dice.count(3, 7), dice.between(0.1, 0.35));
        let start = dice.between(0.0, 6.3);
        floor.pillars.push(
            (0..corners)
                .map(|corner| {
                    let angle = start + std::f64::consts::TAU * corner as f64 / corners as f64;
                    [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
                })
                .collect(),
        );
    }
}

/// Robots in every doorway and all along the corridor of an office, or in narrow corridors.
fn parked(dice: &mut Dice) -> Brief {
    let mut brief = if dice.chance(0.5) { office(dice) } else { corridors(dice) };
    let narrow = |room: &&Rectangle| (room.right - room.left).min(room.top - room.bottom) < 0.75;
    let narrow: Vec<Rectangle> = brief.floor.rooms.iter().filter(narrow).copied().collect();
    for room in narrow {
        for _ in 0..dice.count(0, 3) {
            let along = dice.between(0.05, 0.95);
            let [x, y] = room.center();
            brief.parked.push(match room.right - room.left > room.top - room.bottom {
                true => [room.left + along * (room.right - room.left), y],
                false => [x, room.bottom + along * (room.top - room.bottom)],
            });
        }
    }
    brief
}

fn settings(dice: &mut Dice) -> Brief {
    let mut brief = any_plan(dice);
    brief.unit = dice.scale(0.4, 400.0);
    brief.max_range = 1.0 + dice.scale(0.1, 1.0);
    let clearance = CLEARANCE * dice.scale(0.6, 1.0);
    let slope = brief.max_range - 1.0;
    brief.control.clearance = Some(clearance);
    brief.control.service_radius = Some(clearance * dice.between(2.3, 6.0));
    brief.control.step_radius = Some((slope * dice.scale(0.04, 0.3)).min(0.1));
    brief.control.rounds_per_period = Some(dice.pick(&[1, 1, 2, 8, 50]));
    brief.control.routing_iterations = Some(dice.pick(&[1, 5, 20]));
    brief.control.build_reliability = Some(dice.between(0.6, 0.95));
    brief.control.max_steps = Some(60_000);
    if dice.chance(0.2) {
        brief.control.routing_method = Some(RoutingMethod::Adal);
    }
    if dice.chance(0.2) {
        brief.control.motion_solver = Some(MotionSolver::Conic);
    }
    if dice.chance(0.3) {
        brief.rates = Rates::Mixed;
    }
    brief
}
