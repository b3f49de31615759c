//! Pieces of curves as polynomials in time.

use std::cmp::Ordering;

use pleach_guards::{Enclosure, Interval};
use serde::{Deserialize, Serialize};

use super::Curve;

/// A piece of a curve, every component of it a polynomial in time with a bound on its error.
///
/// Component i at time t is Σₖ cᵢₖ sᵏ, where s = (t − origin) ÷ scale, to within its error. All
/// solutions of flows come in such pieces; so they can be evaluated at every instant, and bounded
/// over every span of time.
///
/// ```
/// use pleach_continuous::flow::{ConstantFlow, Curve};
///
/// let drive = ConstantFlow::new(&[2.0], &[1.0], 10.0)?;
/// let piece = drive.piece(0.0).expect("a line is a polynomial");
/// assert_eq!(piece.coefficients(0), [1.0, 2.0]);
/// assert_eq!((piece.start(), piece.end()), (0.0, 10.0));
/// # Ok::<(), pleach_continuous::flow::InvalidFlow>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Piece {
    start: f64,
    end: f64,
    origin: f64,
    scale: f64,
    coefficients: Vec<f64>,
    /// By component: where its coefficients end.
    ends: Vec<usize>,
    /// By component; nothing if all are 0.
    errors: Vec<f64>,
}

/// The unit in the last place of 1. Roundings are at most half of it, relative to the result; bounds
/// on them below count whole ones, and so cover the rounding of the bounds as well.
const ULP: f64 = f64::EPSILON;

impl Piece {
    /// A piece from `start` to `end` that has no component yet, in powers of
    /// (t − `origin`) ÷ `scale`; all in seconds.
    pub fn new(start: f64, end: f64, origin: f64, scale: f64) -> Self {
        let (coefficients, ends, errors) = (Vec::new(), Vec::new(), Vec::new());
        Piece { start, end, origin, scale, coefficients, ends, errors }
    }

    /// The same piece, with memory for `components` components of `coefficients` coefficients each.
    #[must_use]
    pub fn with_room(mut self, components: usize, coefficients: usize) -> Self {
        self.coefficients.reserve_exact(components * coefficients);
        self.ends.reserve_exact(components);
        self
    }

    /// A piece of components with up to `N` coefficients each, with bounds on their errors.
    pub(super) fn of_rows<const N: usize>(
        [start, end]: [f64; 2],
        origin: f64,
        scale: f64,
        rows: impl Iterator<Item = [f64; N]>,
        errors: Vec<f64>,
    ) -> Self {
        let mut coefficients = vec![0.0; N * errors.len()];
        let (places, _) = coefficients.as_chunks_mut::<N>();
        places.iter_mut().zip(rows).for_each(|(place, row)| *place = row);
        let ends = (1..=errors.len()).map(|rows| N * rows).collect();
        let mut piece = Piece { start, end, origin, scale, coefficients, ends, errors };
        if piece.errors.iter().all(|error| *error == 0.0) {
            piece.errors.clear();
        }
        piece.trim();
        piece
    }

    /// Leaves zeros at the ends of components out.
    fn trim(&mut self) {
        if self.ends.iter().all(|&end| self.coefficients[end - 1] != 0.0) {
            return;
        }
        let mut trimmed = Piece::new(self.start, self.end, self.origin, self.scale);
        for component in 0..self.ends.len() {
            trimmed.push(self.coefficients(component).iter().copied(), self.error(component));
        }
        *self = trimmed;
    }

    /// Adds a component: its coefficients, the constant first, and a bound on its error.
    pub fn push(&mut self, coefficients: impl IntoIterator<Item = f64>, error: f64) {
        let first = self.coefficients.len();
        self.coefficients.extend(coefficients);
        while self.coefficients.len() > first && self.coefficients.last() == Some(&0.0) {
            self.coefficients.pop();
        }
        if error != 0.0 {
            self.errors.reserve_exact(self.ends.capacity().saturating_sub(self.errors.len()));
            self.errors.resize(self.ends.len(), 0.0);
            self.errors.push(error);
        } else if !self.errors.is_empty() {
            self.errors.push(0.0);
        }
        self.ends.push(self.coefficients.len());
    }

    /// The time that the powers count from, in seconds.
    pub fn origin(&self) -> f64 {
        self.origin
    }

    /// The unit of time of the powers, in seconds.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// The coefficients of a component, the constant first; without zeros at the end.
    pub fn coefficients(&self, component: usize) -> &[f64] {
        let first = if component == 0 { 0 } else { self.ends[component - 1] };
        &self.coefficients[first..self.ends[component]]
    }

    /// A bound on the error of a component.
    pub fn error(&self, component: usize) -> f64 {
        self.errors.get(component).copied().unwrap_or(0.0)
    }

    /// The part of it from `from` to `to`, or from and to where it has its own ends.
    #[must_use]
    pub fn within(mut self, from: f64, to: f64) -> Self {
        self.start = self.start.max(from);
        self.end = self.end.min(to).max(self.start);
        self
    }

    /// The same polynomials, taken for exact.
    #[must_use]
    pub fn without_errors(mut self) -> Self {
        self.errors.clear();
        self
    }

    /// The same span of time and powers, without components.
    pub(super) fn emptied(&self) -> Self {
        Piece::new(self.start, self.end, self.origin, self.scale)
    }

    /// The largest magnitude of what is raised to powers.
    pub(super) fn farthest(&self) -> f64 {
        self.place(self.start).abs().max(self.place(self.end).abs())
    }

    /// Whether values and rates of all components are certainly finite: all coefficients together are.
    pub fn is_finite(&self) -> bool {
        let (rows, rest) = self.coefficients.as_chunks::<8>();
        let mut sums = [0.0; 8];
        for row in rows {
            sums.iter_mut().zip(row).for_each(|(sum, coefficient)| *sum += coefficient.abs());
        }
        let rest = rest.iter().chain(&self.errors).map(|number| number.abs());
        let most: f64 = sums.into_iter().chain(rest).sum();
        (most * self.coefficients.len() as f64).is_finite()
    }

    /// The highest power with a coefficient.
    pub fn degree(&self) -> usize {
        let components = 0..self.ends.len();
        let lengths = components.map(|component| self.coefficients(component).len());
        lengths.max().unwrap_or(0).saturating_sub(1)
    }

    /// Whether it is made as it should, after it was read from a file.
    pub fn is_consistent(&self) -> bool {
        let is_whole = self.ends.last().copied().unwrap_or(0) == self.coefficients.len();
        let is_ordered = self.start <= self.end && self.scale != 0.0;
        is_whole && is_ordered && self.ends.is_sorted() && self.errors.len() <= self.ends.len()
    }

    /// How many numbers it is stored in: coefficients, ends and errors.
    pub fn numbers(&self) -> usize {
        self.coefficients.len() + self.ends.len() + self.errors.len()
    }

    /// The value of a component at `time`, also beyond the ends.
    pub fn value(&self, component: usize, time: f64) -> f64 {
        horner(self.coefficients(component), self.place(time))
    }

    /// The rate of a component at `time`, per second.
    pub fn rate(&self, component: usize, time: f64) -> f64 {
        let coefficients = self.coefficients(component).iter().copied();
        Jet::of(coefficients, self.place(time)).slope / self.scale
    }

    /// An interval that contains a component anywhere on the piece: quickly found, and wider than the
    /// values of [`enclose`](Self::enclose).
    pub fn range(&self, component: usize) -> Interval {
        let (first, last) = (self.place(self.start), self.place(self.end));
        let farthest = first.abs().max(last.abs());
        let coefficients = self.coefficients(component);
        let mut value = Extremes::default();
        let (mut near, mut far) = (1.0, 1.0);
        for c in coefficients {
            value.add(*c, near, far);
            far *= farthest;
            // On both sides of the origin a power is between those of the farthest place.
            near = if first >= 0.0 { near * first } else { -far };
        }
        value.interval(noise_of_powers(coefficients.len()), self.error(component))
    }

    /// Encloses all components from `from` to `to`, both within the piece.
    pub fn enclose(&self, from: f64, to: f64, states: &mut Vec<Enclosure>) {
        states.clear();
        let span = Span::of(self, from, to);
        for component in 0..self.ends.len() {
            states.push(span.enclose(self.coefficients(component), self.error(component)));
        }
    }

    fn place(&self, time: f64) -> f64 {
        (time - self.origin) / self.scale
    }
}

impl Curve for Piece {
    fn start(&self) -> f64 {
        self.start
    }

    fn end(&self) -> f64 {
        self.end
    }

    fn dimension(&self) -> usize {
        self.ends.len()
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        let place = self.place(time.clamp(self.start, self.end));
        for (component, x) in state.iter_mut().enumerate() {
            *x = horner(self.coefficients(component), place);
        }
    }

    fn piece(&self, _time: f64) -> Option<Piece> {
        Some(self.clone())
    }
}

fn horner(coefficients: &[f64], place: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * place + c)
}

/// Where a span of time lies in a piece.
struct Span {
    scale: f64,
    /// The ends and the middle, in powers' units.
    first: f64,
    last: f64,
    middle: f64,
    /// At least the distance from the middle to either end.
    reach: f64,
    /// The largest distance from the origin.
    farthest: f64,
}

/// Value and first two derivatives of a polynomial, or of one with all its coefficients positive.
struct Jet {
    value: f64,
    slope: f64,
    bend: f64,
    /// The third derivative.
    twist: f64,
}

impl Jet {
    fn of(coefficients: impl DoubleEndedIterator<Item = f64>, place: f64) -> Jet {
        let (mut value, mut slope, mut bend, mut twist) = (0.0, 0.0, 0.0, 0.0);
        for c in coefficients.rev() {
            twist = twist * place + 3.0 * bend;
            bend = bend * place + 2.0 * slope;
            slope = slope * place + value;
            value = value * place + c;
        }
        Jet { value, slope, bend, twist }
    }
}

impl Span {
    fn of(piece: &Piece, from: f64, to: f64) -> Span {
        let (first, last) = (piece.place(from), piece.place(to));
        let middle = piece.place(from + 0.5 * (to - from));
        let reach = (last - middle).max(middle - first) * (1.0 + 4.0 * ULP);
        Span {
            scale: piece.scale,
            first,
            last,
            middle,
            reach,
            farthest: first.abs().max(last.abs()),
        }
    }

    fn enclose(&self, coefficients: &[f64], error: f64) -> Enclosure {
        match coefficients {
            [] | [_] => {
                let value = around(coefficients.first().copied().unwrap_or(0.0), error);
                Enclosure { middle: value, range: value, rate: Interval::point(0.0) }
            }
            _ => narrowed(self.by_taylor(coefficients, error), self.by_signs(coefficients, error)),
        }
    }

    /// By the Taylor polynomial of degree 2 about the middle, and a bound on the third derivative.
    fn by_taylor(&self, coefficients: &[f64], error: f64) -> Enclosure {
        // Evaluating a polynomial of n coefficients by Horner's rule at a place that is itself
        // rounded is off by at most 4 n + 4 units in the last place of the sum of magnitudes.
        let noise = (4 * coefficients.len() + 4) as f64 * ULP;
        let jet = Jet::of(coefficients.iter().copied(), self.middle);
        let most = Jet::of(coefficients.iter().map(|c| c.abs()), self.farthest);
        let reach = self.reach;
        let value_noise = error + noise * most.value;
        let rest = value_noise
            + reach * (noise * most.slope + reach * (noise * most.bend + reach / 6.0 * most.twist));
        let (lowest, highest) = parabola(jet.slope, 0.5 * jet.bend, reach);
        let rest = rest * (1.0 + 8.0 * ULP) + f64::MIN_POSITIVE;
        let range = ordered(
            ((jet.value + lowest) - rest).next_down(),
            ((jet.value + highest) + rest).next_up(),
        );
        let turn = reach * jet.bend.abs()
            + noise * (most.slope + reach * most.bend)
            + 0.5 * reach * reach * most.twist;
        let turn = turn * (1.0 + 8.0 * ULP) + f64::MIN_POSITIVE;
        let is_line = coefficients.len() == 2;
        let rate = if is_line { Interval::point(jet.slope) } else { around(jet.slope, turn) };
        Enclosure { middle: around(jet.value, value_noise), range, rate: self.per_second(rate) }
    }

    /// By the signs of the coefficients: exact at the origin, where terms vanish.
    fn by_signs(&self, coefficients: &[f64], error: f64) -> Option<(Interval, Interval)> {
        if self.first < 0.0 {
            return None;
        }
        let (mut value, mut slope) = (Extremes::default(), Extremes::default());
        let (mut near, mut far) = (1.0, 1.0);
        for (c, k) in coefficients.iter().zip(0..) {
            if k > 0 {
                slope.add(f64::from(k) * c, near, far);
                (near, far) = (near * self.first, far * self.last);
            }
            value.add(*c, near, far);
        }
        let noise = noise_of_powers(coefficients.len());
        let (range, rate) = (value.interval(noise, error), slope.interval(noise, 0.0));
        let (mut above, mut rising) = (Interval::WHOLE, Interval::WHOLE);
        if self.first == 0.0 {
            match direction_from_origin(coefficients, self.last) {
                Some(Ordering::Greater) => {
                    above = ordered(coefficients[0] - error, f64::INFINITY);
                    rising = ordered(0.0, f64::INFINITY);
                }
                Some(Ordering::Less) => {
                    above = ordered(f64::NEG_INFINITY, coefficients[0] + error);
                    rising = ordered(f64::NEG_INFINITY, 0.0);
                }
                _ => {}
            }
        }
        let range = range.intersection(above).unwrap_or(range);
        Some((range, self.per_second(rate.intersection(rising).unwrap_or(rate))))
    }

    fn per_second(&self, rate: Interval) -> Interval {
        if self.scale == 1.0 { rate } else { rate / Interval::point(self.scale) }
    }
}

/// Whether a polynomial rises or falls from the origin to a place, if its first power says so: that
/// outweighs all higher ones together.
fn direction_from_origin(coefficients: &[f64], place: f64) -> Option<Ordering> {
    let mut powers = (1..).map(f64::from).zip(coefficients.iter().skip(1));
    let (first, leading) = powers.find(|(_, c)| **c != 0.0)?;
    let (mut rest, mut power) = (0.0, place);
    for (k, c) in powers {
        rest += k * c.abs() * power;
        power *= place;
    }
    let outweighs = first * leading.abs() > rest * (1.0 + 1e-12);
    outweighs.then(|| leading.total_cmp(&0.0))
}

/// By how much, as a fraction of their magnitudes, a sum of this many powers is off for rounding.
fn noise_of_powers(coefficients: usize) -> f64 {
    (2 * coefficients + 4) as f64 * ULP
}

/// The lowest and the highest value of a sum of powers of numbers between two that are not
/// negative.
#[derive(Default)]
struct Extremes {
    lowest: f64,
    highest: f64,
    magnitude: f64,
    /// Whether a term may be negative, and whether one may be positive.
    has_negative: bool,
    has_positive: bool,
}

impl Extremes {
    fn add(&mut self, coefficient: f64, near: f64, far: f64) {
        let (one, other) = (coefficient * near, coefficient * far);
        self.lowest += one.min(other);
        self.highest += one.max(other);
        self.magnitude += one.abs().max(other.abs());
        self.has_negative |= one < 0.0 || other < 0.0;
        self.has_positive |= one > 0.0 || other > 0.0;
    }

    fn interval(&self, noise: f64, error: f64) -> Interval {
        // A sum of one term that is no power is exact; so is one of zeros.
        let rest = error + noise * self.magnitude;
        let (mut lower, mut upper) = (self.lowest - rest, self.highest + rest);
        // Whatever is rounded, a sum without negative terms is not negative.
        if !self.has_negative && lower < -error {
            lower = 0.0 - error;
        }
        if !self.has_positive && upper > error {
            upper = error;
        }
        ordered(lower, upper)
    }
}

/// The extremes of b s + c s² for |s| ≤ reach.
fn parabola(slope: f64, bend: f64, reach: f64) -> (f64, f64) {
    let at = |s: f64| s * (slope + bend * s);
    let (one, other) = (at(-reach), at(reach));
    let (mut lowest, mut highest) = (one.min(other).min(0.0), one.max(other).max(0.0));
    let top = -slope / (2.0 * bend);
    if top.abs() < reach {
        // Half an ulp too far inside would be an error of second order; the noise covers it.
        lowest = lowest.min(0.5 * slope * top);
        highest = highest.max(0.5 * slope * top);
    }
    (lowest, highest)
}

fn around(value: f64, radius: f64) -> Interval {
    if radius == 0.0 {
        return Interval::point(value);
    }
    ordered((value - radius).next_down(), (value + radius).next_up())
}

/// Of what is no number, nothing is known.
fn ordered(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap_or(Interval::WHOLE)
}

/// What lies in both bounds.
fn narrowed(enclosure: Enclosure, by: Option<(Interval, Interval)>) -> Enclosure {
    let Some((range, rate)) = by else { return enclosure };
    Enclosure {
        range: enclosure.range.intersection(range).unwrap_or(enclosure.range),
        rate: enclosure.rate.intersection(rate).unwrap_or(enclosure.rate),
        ..enclosure
    }
}
