//! What polynomials can be computed in.

/// What can be added and multiplied, as numbers can. An operation may give up.
///
/// ```
/// use pleach_guards::{Ring, variable};
///
/// /// Numbers modulo 7.
/// #[derive(Clone)]
/// struct Day(u8);
///
/// impl Ring for Day {
///     fn number(value: f64) -> Day {
///         Day(value.rem_euclid(7.0) as u8)
///     }
///     fn plus(&self, other: &Day) -> Option<Day> {
///         Some(Day((self.0 + other.0) % 7))
///     }
///     fn times(&self, other: &Day) -> Option<Day> {
///         Some(Day(self.0 * other.0 % 7))
///     }
/// }
/// // 3 · 25 − 1 = 74 days are ten weeks and four days.
/// let tracker = (3.0 * variable("x").power(2.0)).at_least(1.0).track(&["x"])?;
/// let margin = tracker.comparisons()[0].in_ring(&mut |_| Some(Day(5)));
/// assert_eq!(margin.map(|day| day.0), Some(4));
/// # Ok::<(), pleach_guards::EvaluationError>(())
/// ```
pub trait Ring: Clone {
    /// What stands for a number.
    fn number(value: f64) -> Self;

    /// self + other
    fn plus(&self, other: &Self) -> Option<Self>;

    /// self · other
    fn times(&self, other: &Self) -> Option<Self>;

    /// self − other
    fn minus(&self, other: &Self) -> Option<Self> {
        self.plus(&other.times(&Self::number(-1.0))?)
    }

    /// The product of so many factors `self`.
    fn power(&self, exponent: u32) -> Option<Self> {
        (0..exponent).try_fold(Self::number(1.0), |product, _| product.times(self))
    }
}
