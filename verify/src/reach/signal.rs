//! Bounds on a quantity over time, for all runs at once: piecewise constant, on a fixed grid.
//!
//! The grid cuts time into cells: instants t₀ < t₁ < … < tₘ, and the open intervals after each of
//! them, of which the last has no end. What is bounded at an instant t is, for every run, a number
//! between the bounds of the cell that t is in.

use pleach_guards::Interval;

use crate::temporal::Window;

/// The grid.
pub(super) struct Grid {
    instants: Vec<f64>,
}

/// Bounds for each cell.
pub(super) type Signal = Vec<Interval>;

impl Grid {
    /// The grid of these instants.
    pub(super) fn new(mut instants: Vec<f64>) -> Self {
        instants.push(0.0);
        instants.retain(|t| t.is_finite() && *t >= 0.0);
        instants.sort_by(f64::total_cmp);
        instants.dedup();
        Grid { instants }
    }

    /// How many cells there are.
    pub(super) fn len(&self) -> usize {
        2 * self.instants.len()
    }

    /// The number of the cell that is the instant t, which is on the grid.
    pub(super) fn at(&self, t: f64) -> usize {
        2 * self.instants.partition_point(|known| *known < t)
    }

    /// The ends of a cell.
    pub(super) fn ends(&self, cell: usize) -> (f64, f64) {
        let start = self.instants[cell / 2];
        let end = match cell % 2 {
            0 => start,
            _ => self.instants.get(cell / 2 + 1).copied().unwrap_or(f64::INFINITY),
        };
        (start, end)
    }

    /// The first and the last cell that have instants from `start` to `end`, both included.
    fn meeting(&self, start: f64, end: f64) -> (usize, usize) {
        let before = self.instants.partition_point(|t| *t < start);
        let first = match self.instants.get(before) {
            Some(t) if *t == start => 2 * before,
            _ => (2 * before).saturating_sub(1),
        };
        let upto = self.instants.partition_point(|t| *t <= end);
        let last = match upto.checked_sub(1) {
            Some(place) if self.instants[place] == end => 2 * place,
            Some(place) => 2 * place + 1,
            None => 0,
        };
        (first, last.max(first))
    }

    /// The cells in which the window from an instant of `cell` can have instants.
    fn reached(&self, cell: usize, window: Window) -> (usize, usize) {
        let (start, end) = self.ends(cell);
        let shifted = |t: f64, by: f64| if by == 0.0 { t } else { t + by };
        let first = shifted(start, window.start());
        let last = shifted(end, window.end());
        let first = if window.start() == 0.0 { first } else { first.next_down() };
        let last = if window.end() == 0.0 { last } else { last.next_up() };
        let (first, last) = self.meeting(first, last);
        // An open interval has no instants of its ends.
        if cell % 2 == 1 && window.start() == 0.0 { (first.max(cell), last) } else { (first, last) }
    }

    /// The cells in which the window from every instant of `cell` has instants.
    fn certain(&self, cell: usize, window: Window) -> Option<(usize, usize)> {
        let (start, end) = self.ends(cell);
        let first = if window.start() == 0.0 { end } else { (end + window.start()).next_up() };
        let last = if window.end() == 0.0 { start } else { (start + window.end()).next_down() };
        // The window from any instant of a cell has that instant if it begins at once.
        let own = (window.start() == 0.0).then_some((cell, cell));
        let beyond = (first <= last && first.is_finite()).then(|| self.meeting(first, last));
        match (own, beyond) {
            (Some((from, _)), Some((_, to))) => Some((from, to)),
            (own, beyond) => own.or(beyond),
        }
    }

    /// □: the infimum over the window.
    pub(super) fn always(&self, window: Window, inner: &Signal) -> Signal {
        let bounds = |cell| {
            let (first, last) = self.reached(cell, window);
            let reached = &inner[first..=last];
            let lower = reached.iter().map(Interval::lower).fold(f64::INFINITY, f64::min);
            let upper = match self.certain(cell, window) {
                Some((first, last)) => {
                    inner[first..=last].iter().map(Interval::upper).fold(f64::INFINITY, f64::min)
                }
                None => reached.iter().map(Interval::upper).fold(f64::NEG_INFINITY, f64::max),
            };
            between(lower, upper)
        };
        (0..self.len()).map(bounds).collect()
    }

    /// 𝒰: the supremum over the window of the goal, with what holds until then.
    pub(super) fn until(&self, window: Window, holds: &Signal, goal: &Signal) -> Signal {
        let bounds = |cell| {
            let (first, last) = self.reached(cell, window);
            // Up to a cell: what holds in all of it, and what holds in all before it.
            let (mut through, mut before) = (f64::INFINITY, f64::INFINITY);
            let (mut least, mut best) = (f64::INFINITY, f64::NEG_INFINITY);
            let mut upper = f64::NEG_INFINITY;
            let certain = self.certain(cell, window);
            for at in cell..=last {
                through = through.min(holds[at].lower());
                if at >= first {
                    let reached = goal[at].lower().min(through);
                    least = least.min(reached);
                    if certain.is_some_and(|(from, to)| (from..=to).contains(&at)) {
                        best = best.max(reached);
                    }
                    upper = upper.max(goal[at].upper().min(before));
                }
                before = before.min(holds[at].upper());
            }
            between(if certain.is_some() { best } else { least }, upper)
        };
        (0..self.len()).map(bounds).collect()
    }
}

/// From one to the other; everything where they are no bounds.
fn between(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap_or(Interval::WHOLE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::temporal::within;

    fn signal(grid: &Grid, values: impl Fn(f64) -> (f64, f64)) -> Signal {
        let value = |cell: usize| {
            let (start, end) = grid.ends(cell);
            let (lower, upper) = values(if end.is_finite() { 0.5 * (start + end) } else { start });
            Interval::new(lower, upper).unwrap()
        };
        (0..grid.len()).map(value).collect()
    }

    /// An instant and the begin or end of a window add up to what is no number.
    #[test]
    fn windows_are_rounded_to_the_safe_side() {
        // 0.1 + 0.2 is rounded up, and 0.1 + 0.7 down.
        let (above, below) = (0.1 + 0.2, 0.1 + 0.7);
        let grid = Grid::new(vec![0.1, above, below, 2.0]);
        let [start, at_above, at_below] = [0.1, above, below].map(|t| grid.at(t));
        let window = |start, end| within(start, end).unwrap();
        // It begins before the number that the sum is rounded to, and ends after it.
        assert_eq!(grid.reached(start, window(0.2, 1.0)).0, at_above - 1);
        assert_eq!(grid.reached(start, window(0.1, 0.7)).1, at_below + 1);
        // From no instant of the cell it surely has what is not in it from one.
        assert_eq!(grid.certain(start, window(0.7, 1.0)).unwrap().0, at_below + 1);
        assert_eq!(grid.certain(start, window(0.0, 0.2)).unwrap().1, at_above - 1);
    }

    /// What is −1 up to 1 s and rises to 1 by 2 s: the goal is reached from 2 s on.
    #[test]
    fn windows_take_the_least_and_the_most() {
        let grid = Grid::new(vec![1.0, 2.0, 3.0, 4.0]);
        let rising = signal(&grid, |t| match t {
            t if t < 1.0 => (-1.0, -1.0),
            t if t < 2.0 => (-1.0, 1.0),
            _ => (1.0, 1.0),
        });
        let first = |signal: Signal| (signal[0].lower(), signal[0].upper());
        assert_eq!(first(grid.always(within(0.0, 1.5).unwrap(), &rising)), (-1.0, -1.0));
        assert_eq!(first(grid.always(within(1.5, 1.6).unwrap(), &rising)), (-1.0, 1.0));
        assert_eq!(first(grid.always(within(2.0, 3.0).unwrap(), &rising)), (-1.0, 1.0));
        assert_eq!(first(grid.always(within(2.1, 3.0).unwrap(), &rising)), (1.0, 1.0));
        let whole = signal(&grid, |_| (f64::INFINITY, f64::INFINITY));
        assert_eq!(first(grid.until(within(0.0, 3.0).unwrap(), &whole, &rising)), (1.0, 1.0));
        assert_eq!(first(grid.until(within(0.0, 1.5).unwrap(), &whole, &rising)), (-1.0, 1.0));
        // The goal comes at 2 s, and what has to hold until then ends at 1 s.
        let ends = signal(&grid, |t| if t < 1.0 { (2.0, 2.0) } else { (-3.0, -3.0) });
        let late = signal(&grid, |t| if t < 2.0 { (-1.0, -1.0) } else { (1.0, 1.0) });
        assert_eq!(first(grid.until(within(0.0, 3.0).unwrap(), &ends, &late)), (-1.0, -1.0));
        // At 1 s itself the goal may have come, and the other held until then.
        assert_eq!(first(grid.until(within(0.0, 3.0).unwrap(), &ends, &rising)), (-1.0, 1.0));
    }
}
