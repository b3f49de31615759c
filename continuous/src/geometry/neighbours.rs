//! Which of many points are near a place.

use crate::Point;

/// Cells of a grid for each of its points, at most about: more would be empty.
const CELLS_PER_POINT: f64 = 2.0;

/// By how much, relative to the numbers involved, the cells that a query looks into reach beyond
/// its distance: rounding must not hide a point.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Points sorted into the square cells of a grid: those within a distance of a place are found by
/// looking into the cells around it.
///
/// Cells are as wide as the distance that is asked for most, and wider where points are so spread
/// out that most cells would be empty. Building takes O(n) time and memory for n points, whatever
/// their coordinates are; a query takes time in proportion to the points in the cells that it
/// looks into. A point with a coordinate that is not finite is near nothing.
///
/// ```
/// use pleach_continuous::Point;
/// use pleach_continuous::geometry::Neighbours;
///
/// let robots = [(0.0, 0.0), (0.3, 0.0), (0.0, 0.4), (9.0, 9.0)].map(|(x, y)| Point::new(x, y));
/// let neighbours = Neighbours::new(&robots, 0.5);
/// assert_eq!(neighbours.within(robots[1], 0.5), [0, 1, 2]);
/// assert_eq!(neighbours.within(robots[1], 0.49), [0, 1]);
/// ```
#[derive(Debug, Clone)]
pub struct Neighbours {
    grid: Grid,
    /// Where the points of each cell begin in `sorted`, row by row; last, how many there are.
    begins: Vec<usize>,
    /// Points with their indices, cell by cell.
    sorted: Vec<(Point, usize)>,
}

impl Neighbours {
    /// `points`, for questions about distances of about `distance`. The answers are the same with
    /// every number; with a fitting one they come quickly.
    pub fn new(points: &[Point], distance: f64) -> Neighbours {
        let is_finite = |p: &Point| p.iter().all(|coordinate| coordinate.is_finite());
        let finite: Vec<(Point, usize)> =
            points.iter().copied().zip(0..).filter(|(point, _)| is_finite(point)).collect();
        let grid = Grid::around(&finite, distance);
        let cells: Vec<usize> = finite.iter().map(|&(point, _)| grid.cell(point)).collect();
        // Counting sort: how many points each cell has, where it ends, where each point goes.
        let mut begins = vec![0; grid.columns * grid.rows + 1];
        cells.iter().for_each(|&cell| begins[cell] += 1);
        let mut end = 0;
        for begin in &mut begins {
            end += *begin;
            *begin = end;
        }
        let mut sorted = finite.clone();
        for (entry, cell) in finite.into_iter().zip(cells).rev() {
            begins[cell] -= 1;
            sorted[begins[cell]] = entry;
        }
        Neighbours { grid, begins, sorted }
    }

    /// Visits every point within `radius` of `center`, by its index and its distance, in an order
    /// that is the same each time but else of no meaning.
    pub fn for_each_within(&self, center: Point, radius: f64, mut visit: impl FnMut(usize, f64)) {
        let reach = radius.max(0.0) + ROUNDING * (radius.abs() + center.coords.amax());
        let (left, right) =
            (self.grid.column(center.x - reach), self.grid.column(center.x + reach));
        let (below, above) = (self.grid.row(center.y - reach), self.grid.row(center.y + reach));
        for row in below..=above {
            let first = row * self.grid.columns;
            for &(point, index) in
                &self.sorted[self.begins[first + left]..self.begins[first + right + 1]]
            {
                let distance = (point - center).norm();
                if distance <= radius {
                    visit(index, distance);
                }
            }
        }
    }

    /// The points within `radius` of `center`, ascending.
    pub fn within(&self, center: Point, radius: f64) -> Vec<usize> {
        let mut found = Vec::new();
        self.for_each_within(center, radius, |index, _| found.push(index));
        found.sort_unstable();
        found
    }
}

/// Where the cells lie. Places beyond the grid count to its outermost cells.
#[derive(Debug, Clone, Copy)]
struct Grid {
    low: Point,
    width: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// The grid around some finite points, with not many more cells than points.
    fn around(points: &[(Point, usize)], distance: f64) -> Grid {
        let first = points.first().map_or(Point::origin(), |&(point, _)| point);
        let low = points.iter().fold(first, |low, (point, _)| low.inf(point));
        let high = points.iter().fold(first, |high, (point, _)| high.sup(point));
        let sides = high - low;
        let most = CELLS_PER_POINT * points.len() as f64 + 1.0;
        let spread = (sides.x.sqrt() * sides.y.sqrt() / most.sqrt()).max(sides.amax() / most);
        let width = distance.max(spread);
        if width > 0.0 && width.is_finite() {
            let cells = |side: f64| (side / width) as usize + 1;
            Grid { low, width, columns: cells(sides.x), rows: cells(sides.y) }
        } else {
            Grid { low, width: f64::INFINITY, columns: 1, rows: 1 }
        }
    }

    fn cell(&self, place: Point) -> usize {
        self.row(place.y) * self.columns + self.column(place.x)
    }

    /// Converting to an integer takes what is negative, and what is not a number, to 0.
    fn column(&self, x: f64) -> usize {
        (((x - self.low.x) / self.width) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.low.y) / self.width) as usize).min(self.rows - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cell is as wide as the distance, or wider where there would be more than two for each point.
    #[test]
    fn there_are_not_many_more_cells_than_points() {
        let numbered = |places: Vec<Point>| -> Vec<(Point, usize)> {
            places.into_iter().enumerate().map(|(at, place)| (place, at)).collect()
        };
        let row = (0..10).map(|at| Point::new(2.0 + 1.5 * f64::from(at), 3.0)).collect();
        let row = numbered(row);
        let grid = Grid::around(&row, 1.5);
        assert_eq!((grid.width, grid.columns, grid.rows), (1.5, 10, 1));
        assert!(row.iter().map(|&(place, _)| grid.column(place.x)).eq(0..10));
        let square = (0..9).map(|at| Point::new(4.0 * f64::from(at % 3), 4.0 * f64::from(at / 3)));
        let grid = Grid::around(&numbered(square.collect()), 0.1);
        // 8/√19 = 1.84
        assert_eq!((grid.columns, grid.rows), (5, 5));
    }
}
