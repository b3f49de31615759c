//! Points sorted into square cells, so that the near ones are found without looking at all.

use std::collections::BTreeMap;

use pleach_continuous::Point;

/// Numbered points in square cells of one width.
pub(in crate::network) struct Buckets {
    width: f64,
    cells: BTreeMap<(i64, i64), Vec<(usize, Point)>>,
}

impl Buckets {
    /// No points yet; `width` is the largest distance that will be asked about.
    pub fn new(width: f64) -> Self {
        Self { width, cells: BTreeMap::new() }
    }

    /// All of `points`, each with its index.
    pub fn of(points: &[Point], width: f64) -> Self {
        let mut buckets = Self::new(width);
        points.iter().enumerate().for_each(|(number, &point)| buckets.insert(number, point));
        buckets
    }

    pub fn insert(&mut self, number: usize, point: Point) {
        self.cells.entry(self.cell(point)).or_default().push((number, point));
    }

    /// The points at most one width away from `place`, in no particular order.
    pub fn near(&self, place: Point) -> impl Iterator<Item = (usize, Point)> {
        let width = self.width;
        (self.around(place).flatten().copied())
            .filter(move |(_, point)| (point - place).norm() <= width)
    }

    /// Takes out the points at most one width away from `place` that `wanted` asks for.
    pub fn take(
        &mut self,
        place: Point,
        mut wanted: impl FnMut(Point) -> bool,
    ) -> Vec<(usize, Point)> {
        let mut taken = Vec::new();
        let (column, row) = self.cell(place);
        for x in column - 1..=column + 1 {
            for (_, points) in self.cells.range_mut((x, row - 1)..=(x, row + 1)) {
                points.retain(|&(number, point)| {
                    let is_taken = (point - place).norm() <= self.width && wanted(point);
                    if is_taken {
                        taken.push((number, point));
                    }
                    !is_taken
                });
            }
        }
        taken
    }

    fn around(&self, place: Point) -> impl Iterator<Item = &Vec<(usize, Point)>> {
        let (column, row) = self.cell(place);
        (column - 1..=column + 1)
            .flat_map(move |x| self.cells.range((x, row - 1)..=(x, row + 1)))
            .map(|(_, points)| points)
    }

    fn cell(&self, place: Point) -> (i64, i64) {
        ((place.x / self.width).floor() as i64, (place.y / self.width).floor() as i64)
    }
}
