//! # The navigation benchmark
//!
//! A body moves over a grid of unit cells. The map gives each cell a desired direction, i for an
//! angle of i π/4 clockwise from north, and the velocity v tends towards v_d = (sin i π/4, cos i
//! π/4) by v̇ = A (v − v_d). The body should reach the cell marked A and avoid the cell marked B; in
//! both it comes to rest. Outside the grid the closest cell gives the direction.
//!
//! The benchmark, with the matrix A and the map of its Figure 1, is from Fehnker and Ivančić,
//! *Benchmarks for hybrid systems verification* (2004),
//! [doi:10.1007/978-3-540-24743-2_22](https://doi.org/10.1007/978-3-540-24743-2_22).
//!
//! Within a cell the flow is linear, so the answer is a matrix exponential, with the instants of the
//! crossings by bisection.

mod exhibit;
mod oracle;

use exhibit::{Exhibit, Shown, instants};
use oracle::Affine;
use pleach::prelude::*;
use std::error::Error;
use std::f64::consts::FRAC_PI_4;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// The cells as they lie on the map.
    enum Cell: Location {
        NorthWest = "north-west", North  = "north",  NorthEast = "north-east",
        West      = "west",       Middle = "middle", East      = "east",
        SouthWest = "south-west", South  = "south",  SouthEast = "south-east",
    }
    /// The side on which a cell is left.
    enum Side: Event {
        West = "westwards", East = "eastwards", South = "southwards", North = "northwards",
    }
}

coordinates! {
    /// Eastwards and northwards from the south-western corner, in cells and cells a second.
    struct Body { x, y, vx = "v₁", vy = "v₂" }
}

const MAP: &str = "
    B 2 4
    4 3 4
    2 2 A
";

const A: [[f64; 2]; 2] = [[-1.2, 0.1], [0.1, -1.2]];

/// The south-western corner of a cell.
fn corner(cell: Cell) -> (f64, f64) {
    let number = cell as u8;
    (f64::from(number % 3), f64::from(2 - number / 3))
}

/// The cell in which a point lies, or the closest one.
fn cell_at(x: f64, y: f64) -> Cell {
    let (west, south) = (x.floor().clamp(0.0, 2.0), y.floor().clamp(0.0, 2.0));
    let found = Cell::ALL.iter().find(|&&cell| corner(cell) == (west, south));
    *found.unwrap_or(&Cell::Middle)
}

/// The velocity that the map asks for; none in A and B.
fn desired(map: &str, cell: Cell) -> Option<(f64, f64)> {
    let direction: u8 = map.split_whitespace().nth(cell as usize)?.parse().ok()?;
    Some((FRAC_PI_4 * f64::from(direction)).sin_cos())
}

fn navigation(map: &str, start: Body) -> Result<Automaton<Cell, Side, Body>, BuildError> {
    let Body { x, y, vx, vy } = Body::coordinates();
    let mut grid = Automaton::starting_in(cell_at(start.x, start.y)).initially(start);
    for &cell in Cell::ALL {
        let Some((east, north)) = desired(map, cell) else { continue };
        let (dx, dy) = (&vx - east, &vy - north);
        let steering = |row: [f64; 2]| row[0] * &dx + row[1] * &dy;
        let flow = [x.rate(&vx), y.rate(&vy), vx.rate(steering(A[0])), vy.rate(steering(A[1]))];
        grid = grid.flow(cell, flow);

        let (west, south) = corner(cell);
        let sides = [
            (Side::West, cell_at(west - 1.0, south), x.at_most(west) & vx.less_than(0.0)),
            (Side::East, cell_at(west + 1.0, south), x.at_least(west + 1.0) & vx.more_than(0.0)),
            (Side::South, cell_at(west, south - 1.0), y.at_most(south) & vy.less_than(0.0)),
            (Side::North, cell_at(west, south + 1.0), y.at_least(south + 1.0) & vy.more_than(0.0)),
        ];
        // At a corner two sides are crossed together: the first goes first.
        for (order, (side, neighbour, crossed)) in (0..).zip(sides) {
            if neighbour != cell {
                let crossing = from(cell).on(side).to(neighbour).must(crossed);
                grid = grid.transition(crossing.priority(order));
            }
        }
    }
    grid.build()
}

// ---- The answer --------------------------------------------------------------------------------

/// The cells that a body enters, and when.
fn route(map: &str, start: Body) -> Vec<(f64, Cell)> {
    let (mut now, mut cell, mut state) = (0.0, cell_at(start.x, start.y), start.to_values());
    let mut entries = Vec::new();
    while let Some((east, north)) = desired(map, cell) {
        let flow = Affine::new(4, |state| {
            let (dx, dy) = (state[2] - east, state[3] - north);
            let steering = |row: [f64; 2]| row[0] * dx + row[1] * dy;
            vec![state[2], state[3], steering(A[0]), steering(A[1])]
        });
        let is_elsewhere = |state: &[f64]| cell_at(state[0], state[1]) != cell;
        let Some(duration) = flow.time_until(&state, HORIZON - now, is_elsewhere) else { break };
        state = flow.after(&state, duration);
        (now, cell) = (now + duration, cell_at(state[0], state[1]));
        entries.push((now, cell));
    }
    entries
}

const HORIZON: f64 = 10.0;

/// From the cell in the north-east, once by detours to A and once into B.
const STARTS: [(&str, Body); 3] = [
    ("South-westwards", Body { x: 2.5, y: 2.5, vx: -2.0, vy: -1.0 }),
    ("Out of the grid and back", Body { x: 2.5, y: 2.5, vx: -1.0, vy: 2.0 }),
    ("Too fast westwards", Body { x: 2.5, y: 2.5, vx: -4.0, vy: 0.0 }),
];

/// Three bodies on the published map.
pub fn exhibit() -> Shown {
    let mut exhibit = Exhibit::new("navigation", include_str!("navigation.rs"))
        .automaton("grid", &navigation(MAP, STARTS[0].1)?);
    for (title, start) in STARTS {
        let trajectory = navigation(MAP, start)?.run(HORIZON)?;
        let crossings = route(MAP, start).into_iter().map(|(time, _)| time);
        exhibit = exhibit
            .compare_all("crossings, in s", instants(&trajectory), crossings, 1e-12)
            .run(title, trajectory);
    }
    Ok(exhibit)
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crossings_are_where_the_matrix_exponential_is_at_a_side() {
        let exhibit = exhibit().expect("the bodies move");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn bodies_enter_the_cells_of_their_route_and_rest_in_the_last() {
        for ((_, start), last) in STARTS.into_iter().zip(['A', 'A', 'B']) {
            let trajectory = navigation(MAP, start).expect("sound").run(HORIZON).expect("it runs");
            let entered: Vec<usize> =
                trajectory.jumps().iter().map(|jump| jump.moves[0].target).collect();
            let expected = route(MAP, start).into_iter().map(|(_, cell)| cell as usize);
            assert!(entered.iter().copied().eq(expected), "{entered:?}");
            let mark = MAP.split_whitespace().nth(entered[entered.len() - 1]);
            assert_eq!(mark, Some(&*last.to_string()));
        }
    }
}
