//! Heat spreads in a cube from one of its corners (HEAT01, HEAT02).
//!
//! Model and numbers: Z. Han and B. Krogh, *Reachability analysis of large-scale affine systems using
//! low-dimensional polytopes*, HSCC 2006, as S. Bak, H.-D. Tran and T. Johnson, *Numerical verification
//! of affine systems with up to a billion dimensions*, HSCC 2019, cut the cube into cells, in the form
//! of the ARCH-COMP reports (AFF).

use std::time::Instant;

use pleach_guards::Interval;
use pleach_verify::reach::{IntervalMatrix, Span, SparseFlow, dot, exponential};

use crate::{Outcome, TestResult};

const DIFFUSIVITY: f64 = 0.01;
/// Between the face at x = 1 and what is around it, which has temperature 0; other faces insulate.
const HEAT_EXCHANGE: f64 = 0.5;
const HORIZON: f64 = 40.0;
const STEP: f64 = 0.02;

/// A cube of `cells`³ cells, of which `heated` along x, y and z are at 1 ± 0.1 in the beginning.
pub struct Heat {
    pub cells: usize,
    pub heated: [usize; 3],
    /// What the middle stays below.
    pub limit: f64,
}

/// A direction in the cube.
#[derive(Clone, Copy, PartialEq)]
enum Axis {
    /// Along which there is a face that heat leaves through.
    Open,
    /// Between insulating faces.
    Closed,
}

impl Heat {
    /// Encloses the temperature in the middle at all times.
    pub fn solve(&self) -> TestResult<Outcome> {
        let flow = SparseFlow::new(&self.rows())?;
        let mut direction = vec![0.0; flow.dimension()];
        direction[self.place([self.cells / 2; 3])] = 1.0;
        let start = self.start()?;
        let spans = flow.along(&start, &direction, STEP);
        let spans: Vec<Span> = spans.take_while(|span| span.time.lower() < HORIZON).collect();
        let hottest = spans.iter().map(|span| span.values.upper()).fold(0.0, f64::max);
        let answer = if hottest < self.limit { "holds" } else { "undecided" };
        let away = Some(self.limit - hottest);
        Ok(Outcome {
            answer,
            sets: spans.len(),
            away,
            measured: format!("at most {hottest:.5}"),
            spans,
        })
    }

    /// The rows of the matrix: the flow along each axis beside the others.
    fn rows(&self) -> Vec<Vec<(usize, Interval)>> {
        let mut rows = vec![Vec::new(); self.cells.pow(3)];
        for (number, row) in rows.iter_mut().enumerate() {
            let at = self.cell(number);
            for axis in 0..3 {
                let kind = if axis == 0 { Axis::Open } else { Axis::Closed };
                for (other, entry) in self.along_axis(kind, at[axis]) {
                    let mut neighbour = at;
                    neighbour[axis] = other;
                    row.push((self.place(neighbour), entry));
                }
            }
        }
        rows
    }

    /// The row of cell number `at` along an axis.
    fn along_axis(&self, kind: Axis, at: usize) -> Vec<(usize, Interval)> {
        let point = Interval::point;
        let last = self.cells - 1;
        let distance = point(1.0) / point(self.cells as f64 + 1.0);
        let conduction = point(DIFFUSIVITY) / (distance * distance);
        let beyond = match kind {
            Axis::Open => conduction / (point(1.0) + point(HEAT_EXCHANGE) * distance),
            Axis::Closed => conduction,
        };
        let mut diagonal = point(-2.0) * conduction;
        let mut row = Vec::new();
        if at == 0 {
            diagonal = diagonal + conduction
        } else {
            row.push((at - 1, conduction))
        }
        if at == last {
            diagonal = diagonal + beyond
        } else {
            row.push((at + 1, conduction))
        }
        row.push((at, diagonal));
        row
    }

    fn start(&self) -> TestResult<Vec<Interval>> {
        let warm = Interval::new(0.9, 1.1)?;
        let is_heated = |number: usize| {
            self.cell(number).iter().zip(self.heated).all(|(at, count)| *at < count)
        };
        let side = |number| if is_heated(number) { warm } else { Interval::point(0.0) };
        Ok((0..self.cells.pow(3)).map(side).collect())
    }

    /// The number of a cell.
    fn place(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.cells + y) * self.cells + x
    }

    fn cell(&self, place: usize) -> [usize; 3] {
        [place % self.cells, place / self.cells % self.cells, place / self.cells.pow(2)]
    }

    /// Fails if one of `count` flows leaves the enclosure, at times and from temperatures that are drawn.
    /// Heat flows along each axis beside the others, so that a flow is a product of three small ones.
    pub fn simulated(&self, name: &str, outcome: &Outcome, count: usize) -> TestResult<()> {
        const ERROR: f64 = 1e-12;
        let begin = Instant::now();
        let mut draws = 1u64;
        let mut share = || {
            draws = draws.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (draws >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..count {
            let t = HORIZON * share();
            let middle = |kind: Axis| -> Vec<Interval> {
                let mut matrix = IntervalMatrix::zero(self.cells, self.cells);
                for at in 0..self.cells {
                    for (other, entry) in self.along_axis(kind, at) {
                        matrix[(at, other)] = matrix[(at, other)] + entry * Interval::point(t);
                    }
                }
                exponential(&matrix).row(self.cells / 2).to_vec()
            };
            let (open, closed) = (middle(Axis::Open), middle(Axis::Closed));
            let (mut from, mut start) = (Vec::new(), Vec::new());
            for side in self.start()?.iter().enumerate().filter(|(_, side)| side.upper() > 0.0) {
                let [x, y, z] = self.cell(side.0);
                from.push(open[x] * closed[y] * closed[z]);
                start.push(Interval::point(0.9 + 0.2 * share()));
            }
            let exact = dot(&from, &start);
            let holds = |span: &Span| {
                !span.time.contains(t)
                    || span.values.lower() - ERROR <= exact.upper()
                        && exact.lower() <= span.values.upper() + ERROR
            };
            if !outcome.spans.iter().all(holds) {
                return Err(format!("{name}: at {t} s the middle has {exact}").into());
            }
        }
        eprintln!("    {count} flows are inside ({:.1} s)", begin.elapsed().as_secs_f64());
        Ok(())
    }
}
