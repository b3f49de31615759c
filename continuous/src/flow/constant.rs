//! The flow ẋ = c.

use super::{Curve, InvalidFlow, Piece};

/// A state that moves in a straight line at constant speed: x(t) = x₀ + c t, exactly.
///
/// ```
/// use pleach_continuous::flow::{ConstantFlow, Curve};
///
/// let drive = ConstantFlow::new(&[1.0, -2.0], &[10.0, 10.0], 5.0)?;
/// let mut state = [0.0; 2];
/// drive.state_at(4.0, &mut state);
/// assert_eq!(state, [14.0, 2.0]);
/// # Ok::<(), pleach_continuous::flow::InvalidFlow>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ConstantFlow {
    rates: Vec<f64>,
    state: Vec<f64>,
    duration: f64,
}

impl ConstantFlow {
    /// The flow that is in `state` at time 0 and moves by `rates` per second, for `duration`
    /// seconds; infinity is allowed.
    ///
    /// # Errors
    ///
    /// [`InvalidFlow`] unless both slices have one length and the duration is not negative.
    pub fn new(rates: &[f64], state: &[f64], duration: f64) -> Result<Self, InvalidFlow> {
        InvalidFlow::check_length("rates", rates.len(), state.len())?;
        if duration.is_nan() || duration < 0.0 {
            return Err(InvalidFlow::Duration { duration });
        }
        Ok(ConstantFlow { rates: rates.to_vec(), state: state.to_vec(), duration })
    }
}

impl Curve for ConstantFlow {
    fn start(&self) -> f64 {
        0.0
    }

    fn end(&self) -> f64 {
        self.duration
    }

    fn dimension(&self) -> usize {
        self.state.len()
    }

    fn state_at(&self, time: f64, state: &mut [f64]) {
        let time = time.clamp(0.0, self.duration);
        for ((x, rate), first) in state.iter_mut().zip(&self.rates).zip(&self.state) {
            *x = first + rate * time;
        }
    }

    fn time_scale(&self, _time: f64) -> f64 {
        f64::INFINITY
    }

    fn piece(&self, _time: f64) -> Option<Piece> {
        let mut piece = Piece::new(0.0, self.duration, 0.0, 1.0);
        for (first, rate) in self.state.iter().zip(&self.rates) {
            piece.push([*first, *rate], 0.0);
        }
        Some(piece)
    }
}
