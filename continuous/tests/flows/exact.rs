//! Constant and linear flows against closed forms and nalgebra's exponential.

use nalgebra::{DMatrix, DVector, dmatrix};
use pleach_continuous::flow::{ConstantFlow, Curve, InvalidFlow, LinearFlow};
use proptest::prelude::*;

use super::support::{distance, state};

#[test]
fn bodies_in_free_flight_follow_their_parabola_exactly() {
    let matrix = dmatrix![0.0, 1.0; 0.0, 0.0];
    let flight = LinearFlow::new(&matrix, &[0.0, -8.0], &[3.0, 5.0], 100.0).unwrap();
    for time in [0.0, 0.25, 1.0, 17.5, 100.0] {
        assert_eq!(state(&flight, time), [3.0 + time * (5.0 - 4.0 * time), 5.0 - 8.0 * time]);
    }
    assert_eq!(flight.time_scale(0.0), f64::INFINITY);
}

#[test]
fn tiny_entries_do_not_pass_for_zero() {
    // The square of the entry vanishes in rounding, but the growth is there in the long run.
    let flow = LinearFlow::new(&dmatrix![1e-200], &[0.0], &[1.0], 1e200).unwrap();
    assert!((state(&flow, 1e200)[0] - 1f64.exp()).abs() < 1e-14);
}

#[test]
fn oscillations_keep_their_phase() {
    let matrix = dmatrix![0.0, 20.0; -20.0, 0.0];
    let flow = LinearFlow::new(&matrix, &[0.0, 0.0], &[0.0, 1.0], 1e3).unwrap();
    for time in [0.001, 0.3, 1.0, 10.0, 999.9] {
        let angle: f64 = 20.0 * time;
        let error = distance(&state(&flow, time), &[angle.sin(), angle.cos()]);
        assert!(error < 1e-15 * (10.0 + angle), "{error:e} at {time} s");
    }
}

#[test]
fn a_large_offset_costs_no_accuracy() {
    // ẋ = −x + 10⁹ from 0 is 10⁹ (1 − e⁻ᵗ).
    let flow = LinearFlow::new(&dmatrix![-1.0], &[1e9], &[0.0], 10.0).unwrap();
    for time in [1e-3, 0.1, 1.0, 10.0_f64] {
        let exact = -1e9 * (-time).exp_m1();
        assert!((state(&flow, time)[0] / exact - 1.0).abs() < 1e-14, "at {time} s");
    }
    // One that is larger than its rate by more than any number: ẋ = b − a x hardly decays.
    for (decay, offset) in [(1e-20, 1e290), (1e-300, 1e10), (1e-300, 1e300), (1e-310, 1.0)] {
        let flow = LinearFlow::new(&dmatrix![-decay], &[offset], &[0.0], 10.0).unwrap();
        let found = state(&flow, 10.0)[0];
        assert!((found / (10.0 * offset) - 1.0).abs() < 1e-14, "{found} of {offset}");
    }
}

/// ẋ = k (y − x) beside ẏ = −y, up to k = 10¹⁵: in the powers of the exponential the slow mode is by so much
/// smaller than the fast one, and keeps its digits.
#[test]
fn a_slow_mode_keeps_its_digits_beside_a_fast_one() {
    for fast in [1e3, 1e6, 1e9, 1e12, 1e15] {
        let matrix = dmatrix![-fast, fast; 0.0, -1.0];
        let flow = LinearFlow::new(&matrix, &[0.0, 0.0], &[2.0, 1.0], 5.0).unwrap();
        for time in [0.1, 1.0, 2.5, 5.0_f64] {
            let slow = (-time).exp();
            let exact = [slow * fast / (fast - 1.0), slow];
            let error = distance(&state(&flow, time), &exact);
            assert!(error < 1e-14 * slow, "{error:e} at {time} s beside {fast:e}");
        }
        let mut time = 0.0;
        while time < 5.0 {
            let piece = flow.piece(time).unwrap();
            time = piece.end();
            let (slow, share) = ((-time).exp(), fast / (fast - 1.0));
            let exact = [share * slow + (2.0 - share) * (-fast * time).exp(), slow];
            for (component, exact) in exact.into_iter().enumerate() {
                let found = piece.value(component, time);
                assert!((found - exact).abs() < 1e-13, "{found} at {time} s beside {fast:e}");
            }
        }
    }
}

#[test]
fn fast_modes_set_the_time_scale_until_they_have_faded() {
    // Alone, it is followed until nothing is left of it; where it moves with slow ones, it is lost in
    // their rounding before.
    for (coupling, faded) in [(0.0, 2.0), (1.0, 0.05)] {
        let matrix = dmatrix![-1000.0, coupling, 0.0; 0.0, 0.0, 1.0; 0.0, -1.0, 0.0];
        let flow = LinearFlow::new(&matrix, &[0.0; 3], &[1.0; 3], 10.0).unwrap();
        assert!(flow.time_scale(0.5 * faded) < 0.004);
        assert!((flow.time_scale(faded) - std::f64::consts::PI).abs() < 1e-12);
    }
}

#[test]
fn outside_their_duration_flows_stand_still() {
    let constant = ConstantFlow::new(&[2.0], &[1.0], 3.0).unwrap();
    let linear = LinearFlow::new(&dmatrix![0.0], &[2.0], &[1.0], 3.0).unwrap();
    let curves: [&dyn Curve; 2] = [&constant, &linear];
    for curve in curves {
        assert_eq!((curve.start(), curve.end(), curve.dimension()), (0.0, 3.0, 1));
        for (time, expected) in [(-1.0, 1.0), (0.0, 1.0), (1.5, 4.0), (3.0, 7.0), (4.0, 7.0)] {
            assert_eq!(state(curve, time), [expected]);
        }
    }
}

#[test]
fn flows_of_no_dimension_exist() {
    let flow = LinearFlow::new(&DMatrix::zeros(0, 0), &[], &[], 1.0).unwrap();
    assert!(state(&flow, 0.5).is_empty());
}

#[test]
fn mistakes_are_named() {
    let mistake = |matrix, offset: &[f64], start: &[f64], duration| {
        LinearFlow::new(&matrix, offset, start, duration).unwrap_err().to_string()
    };
    let square = || DMatrix::zeros(2, 2);
    assert_eq!(
        [
            mistake(DMatrix::zeros(2, 3), &[0.0; 2], &[0.0; 2], 1.0),
            mistake(square(), &[0.0], &[0.0; 2], 1.0),
            mistake(square(), &[0.0, f64::NAN], &[0.0; 2], 1.0),
            mistake(square(), &[0.0; 2], &[0.0; 2], -1.0),
        ],
        [
            "columns of the matrix: length 3, but the state has dimension 2",
            "offset: length 1, but the state has dimension 2",
            "entry 1 of the offset is NaN: it must be finite",
            "a flow cannot last -1 s",
        ],
    );
    assert!(matches!(
        ConstantFlow::new(&[1.0], &[0.0], f64::NAN),
        Err(InvalidFlow::Duration { .. })
    ));
}

/// The solution by one exponential of the extended matrix.
fn by_one_exponential(matrix: &DMatrix<f64>, offset: &[f64], start: &[f64], t: f64) -> Vec<f64> {
    let dimension = start.len();
    let mut extended = matrix.clone().resize(dimension + 1, dimension + 1, 0.0);
    extended.view_mut((0, dimension), (dimension, 1)).copy_from_slice(offset);
    let moved = (extended * t).exp() * DVector::from_column_slice(start).push(1.0);
    moved.as_slice()[..dimension].to_vec()
}

proptest! {
    #![proptest_config(cases::usually(128))]

    #[test]
    fn linear_flows_agree_with_the_exponential(
        dimension in 1..7_usize,
        entries in proptest::collection::vec(-2.0..2.0, 49),
        present in proptest::collection::vec(any::<bool>(), 36),
        time in 0.0..4.0,
    ) {
        let matrix = DMatrix::from_fn(dimension, dimension, |row, column| {
            if present[row * 6 + column] { entries[row * 7 + column] } else { 0.0 }
        });
        let (offset, start) = (&entries[30..30 + dimension], &entries[42..42 + dimension]);
        let flow = LinearFlow::new(&matrix, offset, start, 4.0).unwrap();
        let expected = by_one_exponential(&matrix, offset, start, time);
        // Errors grow with the exponential of the norm, in both computations.
        let size = (&matrix * time).exp().norm() * (1.0 + matrix.norm() * time);
        let error = distance(&state(&flow, time), &expected);
        prop_assert!(error < 1e-14 * 10.0 * size, "error {error:e}, size {size:e}");
    }

    #[test]
    fn linear_flows_compose(angle in -3.0..3.0_f64, decay in -1.0..0.5_f64, first in 0.0..5.0,
                            second in 0.0..5.0) {
        let matrix = dmatrix![decay, angle; -angle, decay];
        let offset = [0.3, -0.2];
        let flow = |from: &[f64]| LinearFlow::new(&matrix, &offset, from, 10.0).unwrap();
        let whole = state(&flow(&[1.0, 2.0]), first + second);
        let parts = state(&flow(&state(&flow(&[1.0, 2.0]), first)), second);
        let size = 1.0 + whole[0].hypot(whole[1]);
        prop_assert!(distance(&whole, &parts) < 1e-13 * size * 10.0);
    }
}
