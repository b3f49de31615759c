//! A large hall with pillars, full of robots that each hear twelve others.
//!
//! The robots stand on a grid, in square blocks around an access point each; the hall has as many
//! blocks as it needs, so that nothing but its size grows with the number of robots. Along the
//! right wall an aisle is left empty, and the tasks lie there.

use pleach::automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
    WorkspaceOutline,
};

/// Distance between robots next to each other. With the range of 0.5 a robot hears the twelve
/// within two rows, columns or one diagonal of it.
const SPACING: f64 = 0.24;
/// Robots along the side of a block: 49 share an access point.
const SIDE: usize = 7;
/// The length of a block's side.
const BLOCK: f64 = SIDE as f64 * SPACING;
/// Width of the aisle, which the robots can cross with one recruit or two.
const AISLE: f64 = 1.2;
/// Half the side of a pillar: it leaves room for a robot between it and those around it.
const PILLAR: f64 = 0.04;
/// Where the pillars of a block stand, in units of the spacing: between four robots.
const PILLARS: [[f64; 2]; 4] = [[2.0, 2.0], [5.0, 2.0], [2.0, 5.0], [5.0, 5.0]];
/// Where the access point of a block stands, in the same units.
const ACCESS_POINT: [f64; 2] = [3.0, 4.0];
/// So small that the robots next to an access point can carry what comes from behind them.
const RATE: f64 = 0.005;

/// A hall with `robots` ≥ 1 robots and `tasks` ≥ 0 tasks.
pub fn hall(robots: usize, tasks: usize) -> ValidScenario {
    let blocks = robots.div_ceil(SIDE * SIDE);
    let rows = (blocks as f64).sqrt().ceil() as usize;
    let columns = blocks.div_ceil(rows);
    let (width, height) = (columns as f64 * BLOCK + AISLE, rows as f64 * BLOCK);
    // Blocks fill the hall from the aisle on, column by column.
    let corners: Vec<[f64; 2]> = (0..blocks)
        .map(|block| (columns - 1 - block / rows, block % rows))
        .map(|(column, row)| [column as f64 * BLOCK, row as f64 * BLOCK])
        .collect();
    let within =
        |corner: [f64; 2], [x, y]: [f64; 2]| [corner[0] + x * SPACING, corner[1] + y * SPACING];
    let cells = cells_around_access_point();
    let place = |robot: usize| within(corners[robot / cells.len()], cells[robot % cells.len()]);
    let pillar = |[x, y]: [f64; 2]| {
        [[-PILLAR, -PILLAR], [PILLAR, -PILLAR], [PILLAR, PILLAR], [-PILLAR, PILLAR]]
            .map(|[right, up]| [x + right, y + up])
            .to_vec()
    };
    let scenario = Scenario {
        name: format!("hall-{robots}"),
        description: None,
        workspace: WorkspaceOutline {
            boundary: vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]],
            holes: corners
                .iter()
                .flat_map(|&corner| PILLARS.map(|at| pillar(within(corner, at))))
                .collect(),
        },
        link: LinkRanges::new(0.4, 0.5),
        control: Control { routing_reserve: Some(RATE), ..Control::default() },
        mission: Agenda::default(),
        access_point: corners
            .iter()
            .map(|&corner| AccessPoint { position: within(corner, ACCESS_POINT) })
            .collect(),
        robot: (0..robots).map(|robot| RobotStart::at(place(robot), RATE)).collect(),
        task: (0..tasks)
            .map(|task| (task as f64 + 0.5) / tasks as f64 * height)
            .map(|y| Task::at([width - 0.1, y]))
            .collect(),
    };
    ValidScenario::new(scenario).expect("a hall is a valid scenario")
}

/// The places of a block's robots, the nearest to the access point first: a block that is not full
/// is connected.
fn cells_around_access_point() -> Vec<[f64; 2]> {
    let mut cells: Vec<[f64; 2]> = (0..SIDE * SIDE)
        .map(|cell| [(cell % SIDE) as f64 + 0.5, (cell / SIDE) as f64 + 0.5])
        .collect();
    let distance = |[x, y]: [f64; 2]| f64::hypot(x - ACCESS_POINT[0], y - ACCESS_POINT[1]);
    cells.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    cells
}
