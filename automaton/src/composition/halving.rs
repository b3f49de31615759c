//! Halving a span of time again and again, down to neighbouring numbers.

/// The middle of a span, if there is a number between its ends.
pub(super) fn middle(from: f64, to: f64) -> Option<f64> {
    let middle = from + 0.5 * (to - from);
    (from < middle && middle < to).then_some(middle)
}

#[cfg(test)]
mod tests {
    use super::middle;

    #[test]
    fn the_middle_lies_between_numbers_that_are_no_neighbours() {
        assert_eq!(middle(1.0, 4.0), Some(2.5));
        assert_eq!(middle(-1.0, 0.5), Some(-0.25));
        let next = 3.0_f64.next_up();
        assert_eq!(middle(3.0, next.next_up()), Some(next));
        assert_eq!(middle(0.0, f64::MIN_POSITIVE), Some(0.5 * f64::MIN_POSITIVE));
    }

    #[test]
    fn neighbours_and_what_is_no_span_have_none() {
        for from in [0.0, 1.0, 1.0_f64.next_up(), 1.0_f64.next_down(), 1e6, 1e-300] {
            assert_eq!(middle(from, from.next_up()), None, "{from}");
            assert_eq!(middle(from, from), None, "{from}");
            assert_eq!(middle(from + 1.0, from), None, "{from}");
        }
    }

    /// By halving one comes to the first number with a property, from either side.
    #[test]
    fn halving_ends_at_neighbours() {
        for bound in [0.1, 1.0, 1e3] {
            let (mut before, mut after) = (0.0, 2e3);
            while let Some(middle) = middle(before, after) {
                if middle >= bound { after = middle } else { before = middle }
            }
            assert_eq!([before, after], [bound.next_down(), bound]);
        }
    }
}
