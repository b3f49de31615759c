//! Where the numbers of marks stand: the first free place around each mark.

use super::canvas::{Spot, text_width};

/// A box on the paper.
#[derive(Clone, Copy, Debug)]
struct Area {
    low: Spot,
    high: Spot,
}

impl Area {
    fn overlap(&self, other: &Area) -> f64 {
        let along = |axis: usize| {
            (self.high[axis].min(other.high[axis]) - self.low[axis].max(other.low[axis])).max(0.0)
        };
        along(0) * along(1)
    }

    /// Whether a stroke passes through the box (Liang and Barsky, DOI 10.1145/357332.357333).
    fn is_crossed(&self, from: Spot, to: Spot) -> bool {
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        for axis in 0..2 {
            let run = to[axis] - from[axis];
            if run == 0.0 {
                if from[axis] < self.low[axis] || from[axis] > self.high[axis] {
                    return false;
                }
                continue;
            }
            let first = (self.low[axis] - from[axis]) / run;
            let second = (self.high[axis] - from[axis]) / run;
            enter = enter.max(first.min(second));
            leave = leave.min(first.max(second));
        }
        enter <= leave
    }
}

/// Directions in order of preference, as multiples of an eighth turn from the right, upwards.
const DIRECTIONS: [f64; 12] = [1.0, 7.0, 0.0, 2.0, 3.0, 5.0, 4.0, 6.0, 0.5, 7.5, 3.5, 4.5];

/// What a covered mark or label costs against a crossed stroke, per square unit.
const OVERLAP_COST: f64 = 4.0;
/// What leaving the drawing costs.
const OUTSIDE_COST: f64 = 1000.0;
/// What standing on a wall costs, where dark type is hard to read.
const WALL_COST: f64 = 40.0;
/// White at the sides of a label.
const AIR: f64 = 2.5;
/// What a crossed stroke costs.
const STROKE_COST: f64 = 12.0;

/// Finds places for labels, one after the other.
#[derive(Debug)]
pub(super) struct LabelPlaces<'a> {
    frame: Area,
    taken: Vec<Area>,
    strokes: &'a [(Spot, Spot)],
    walls: &'a dyn WallTest,
}

/// Tells whether a spot of the paper lies in a wall.
pub(super) trait WallTest: std::fmt::Debug {
    /// Whether `spot` lies in a wall.
    fn is_wall(&self, spot: Spot) -> bool;
}

impl<'a> LabelPlaces<'a> {
    /// Starts with the discs of all marks taken.
    pub(super) fn new(
        (corner, size): (Spot, [f64; 2]),
        marks: &[(Spot, f64)],
        strokes: &'a [(Spot, Spot)],
        walls: &'a dyn WallTest,
    ) -> Self {
        let frame = Area { low: corner, high: [corner[0] + size[0], corner[1] + size[1]] };
        let taken = marks
            .iter()
            .map(|&([x, y], r)| Area { low: [x - r, y - r], high: [x + r, y + r] })
            .collect();
        LabelPlaces { frame, taken, strokes, walls }
    }

    /// Chooses the place of a label beside a mark, and returns the middle of its base line.
    pub(super) fn place(&mut self, label: &str, size: f64, mark: Spot, radius: f64) -> Spot {
        let half = [text_width(label, size) / 2.0 + AIR, size * 0.42];
        let candidates = [1.5, 6.5].into_iter().flat_map(|gap| {
            DIRECTIONS.iter().enumerate().map(move |(rank, direction)| {
                let angle = direction * std::f64::consts::FRAC_PI_4;
                let towards = [angle.cos(), -angle.sin()];
                let centre = [
                    mark[0] + towards[0] * (radius + gap + half[0]),
                    mark[1] + towards[1] * (radius + gap + half[1]),
                ];
                let area = Area {
                    low: [centre[0] - half[0], centre[1] - half[1]],
                    high: [centre[0] + half[0], centre[1] + half[1]],
                };
                (area, gap + rank as f64 * 0.5)
            })
        });
        let (mut least, mut best) = (f64::INFINITY, None);
        for (area, preference) in candidates {
            // No place costs less than nothing.
            if preference < least {
                let cost = self.cost(&area) + preference;
                if cost < least {
                    (least, best) = (cost, Some(area));
                }
            }
        }
        let Some(area) = best else { return mark };
        self.taken.push(area);
        [(area.low[0] + area.high[0]) / 2.0, area.high[1] - size * 0.08]
    }

    fn cost(&self, area: &Area) -> f64 {
        let covered: f64 = self.taken.iter().map(|other| area.overlap(other)).sum();
        let crossed = self.strokes.iter().filter(|(from, to)| area.is_crossed(*from, *to)).count();
        let whole = (area.high[0] - area.low[0]) * (area.high[1] - area.low[1]);
        let outside = whole - area.overlap(&self.frame) > 1e-9 * whole;
        let ends = [area.low, area.high, [area.low[0], area.high[1]], [area.high[0], area.low[1]]];
        let walls = ends.iter().filter(|end| self.walls.is_wall(**end)).count();
        covered * OVERLAP_COST
            + crossed as f64 * STROKE_COST
            + walls as f64 * WALL_COST / 4.0
            + if outside { OUTSIDE_COST } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug)]
    struct NoWalls;

    impl WallTest for NoWalls {
        fn is_wall(&self, _: Spot) -> bool {
            false
        }
    }

    #[test]
    fn labels_of_neighbours_do_not_cover_each_other() {
        let marks = [([50.0, 50.0], 6.0), ([64.0, 50.0], 6.0), ([57.0, 62.0], 6.0)];
        let mut places = LabelPlaces::new(([0.0, 0.0], [200.0, 200.0]), &marks, &[], &NoWalls);
        for (centre, radius) in marks {
            places.place("12", 10.0, centre, radius);
        }
        let labels = &places.taken[3..];
        for (index, label) in labels.iter().enumerate() {
            for other in places.taken[..3].iter().chain(&labels[..index]) {
                assert_eq!(label.overlap(other), 0.0, "{label:?} covers {other:?}");
            }
        }
    }

    #[test]
    fn a_stroke_is_seen_where_it_crosses_a_box() {
        let area = Area { low: [0.0, 0.0], high: [10.0, 4.0] };
        assert!(area.is_crossed([-5.0, 2.0], [15.0, 2.0]));
        assert!(area.is_crossed([5.0, -3.0], [5.0, 9.0]));
        assert!(!area.is_crossed([-5.0, 5.0], [15.0, 5.0]));
        assert!(!area.is_crossed([-5.0, 2.0], [-1.0, 2.0]));
    }
}
