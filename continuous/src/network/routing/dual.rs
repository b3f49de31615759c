//! The dual iteration (14): a robot's multiplier rises while its residual misses the reserve.

#[cfg(any(kani, test))]
mod proofs;

/// Largest multiplier λ, in units of the objective per unit of rate.
///
/// Where no routing reaches the reserve, the dual has no maximum and λ would grow without end. The
/// cap is the exact dual of a soft reserve: robots may miss it by s_i ≥ 0 at a price of
/// `MULTIPLIER_CAP`·s_i. A hop adds 2wT + μ to λ, so that a chain of thirteen at full load with
/// weights of 1 ends below 30. A cap that is too low for a network costs optimality, not
/// feasibility: [`repair`](super::repair) closes the gap.
pub const MULTIPLIER_CAP: f64 = 100.0;

/// Multipliers that differ by less count as the same, in units of the objective per unit of rate.
///
/// Flows then differ by about as little, far less than what the sweep evens out; and where robots stand still, they
/// have nothing more to tell each other after some tens of control periods.
const SAME_MULTIPLIER: f64 = 1e-10;

/// One step of (14) with its sign put right: [λ − ε(c − η)]₊, capped at [`MULTIPLIER_CAP`].
///
/// `step` is ε, see [`safe_step`]; `residual` is c_i, for the shares that answered the present
/// multipliers; `reserve` is η.
pub fn dual_step(multiplier: f64, step: f64, residual: f64, reserve: f64) -> f64 {
    projected(multiplier - step * (residual - reserve))
}

/// The nearest multiplier in [0, [`MULTIPLIER_CAP`]]: [·]₊ of (14), capped.
pub(super) fn projected(multiplier: f64) -> f64 {
    multiplier.clamp(0.0, MULTIPLIER_CAP)
}

/// What a robot knows of one of its links when it chooses its step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkCurvature {
    /// R_ij, the same both ways.
    pub reliability: f64,
    /// w_ij, the same both ways.
    pub weight: f64,
    /// Whether the other end is an access point, whose multiplier stays 0.
    pub to_access_point: bool,
}

/// A step ε_i with which the dual iteration converges, from a robot's own links alone:
///
/// ```text
/// ε_i = 1 / ( Σ_{robots j} R_ij²/w_ij + ½ Σ_{access points j} R_ij²/w_ij ).
/// ```
///
/// The dual of (6) has curvature at most Σ R_ij²/(2w_ij)·(z_i − z_j)² in a direction z, over pairs
/// of robots, since of T_ij and T_ji only the one from the dearer robot is positive, plus
/// R_ij²/(2w_ij)·z_i² for access points; and (z_i − z_j)² ≤ 2z_i² + 2z_j². So diag(1/ε_i) bounds
/// the Hessian, which is what gradient ascent with one step per robot needs. No robot has to know
/// the largest degree of the network. A robot without links gets 0: its multiplier stays.
pub fn safe_step(links: impl IntoIterator<Item = LinkCurvature>) -> f64 {
    let curvature: f64 = links
        .into_iter()
        .map(|link| {
            let share = if link.to_access_point { 0.5 } else { 1.0 };
            share * link.reliability * link.reliability / link.weight
        })
        .sum();
    if curvature > 0.0 { curvature.recip() } else { 0.0 }
}

/// One robot's multiplier under the accelerated dual iteration.
///
/// Nesterov's extrapolation applied to (14): the robot sends the extrapolated multiplier, to which
/// its neighbours answer with shares. Momentum restarts when it points against the step taken
/// (O'Donoghue and Candès, DOI 10.1007/s10208-013-9150-3), here by each robot for itself, so that
/// nothing but the multiplier is ever sent. The restarts also keep the memory short while robots
/// move: with 5 iterations a period the average miss of the reserve was half that of (14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DualState {
    /// λ as sent to the neighbours: extrapolated.
    multiplier: f64,
    /// λ after the last step, before extrapolation.
    previous: f64,
    /// t of the momentum (t_k − 1)/t_{k+1}, at least 1.
    momentum: f64,
}

impl Default for DualState {
    fn default() -> Self {
        Self::new(0.0)
    }
}

impl DualState {
    /// At rest at a multiplier, which is brought into [0, [`MULTIPLIER_CAP`]].
    pub fn new(multiplier: f64) -> Self {
        let multiplier = projected(multiplier);
        Self { multiplier, previous: multiplier, momentum: 1.0 }
    }

    /// λ_i: what the robot sends to its neighbours and uses for its own shares.
    pub fn multiplier(&self) -> f64 {
        self.multiplier
    }

    /// The state after one accelerated step; the arguments are those of [`dual_step`]. Where neither this step nor the
    /// last one changes the multiplier by more than 10⁻¹⁰, the state stays as it is, with its momentum.
    #[must_use]
    pub fn step(self, step: f64, residual: f64, reserve: f64) -> Self {
        let stepped = dual_step(self.multiplier, step, residual, reserve);
        let stays = |value: f64| (value - self.multiplier).abs() <= SAME_MULTIPLIER;
        if stays(stepped) && stays(self.previous) {
            return self;
        }
        let progress = stepped - self.previous;
        let against = (self.multiplier - stepped) * progress > 0.0;
        let momentum = if against { 1.0 } else { self.momentum };
        let next = 0.5 * (1.0 + (1.0 + 4.0 * momentum * momentum).sqrt());
        let extrapolated = stepped + (momentum - 1.0) / next * progress;
        Self { multiplier: projected(extrapolated), previous: stepped, momentum: next }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_residual_below_the_reserve_raises_the_multiplier() {
        assert_eq!(dual_step(1.0, 0.5, -0.5, 0.0), 1.25);
        assert_eq!(dual_step(0.1, 0.5, 0.5, 0.0), 0.0);
        assert_eq!(dual_step(MULTIPLIER_CAP, 1.0, -1.0, 0.0), MULTIPLIER_CAP);
    }

    /// Multipliers of the whole orthant and residuals on both sides of the reserve, all exact in binary.
    #[test]
    fn a_multiplier_rises_while_the_reserve_is_missed() {
        let reserve = 0.25;
        for (multiplier, residual) in (0..=800).flat_map(|it| (-64..=64).map(move |of| (it, of))) {
            let (before, residual) = (f64::from(multiplier) / 8.0, f64::from(residual) / 8.0);
            for step in [0.125, 0.5, 1.0, 8.0] {
                let after = dual_step(before, step, residual, reserve);
                assert!((0.0..=MULTIPLIER_CAP).contains(&after));
                assert_eq!(after > before, residual < reserve && before < MULTIPLIER_CAP);
                assert_eq!(after < before, residual > reserve && before > 0.0);
            }
        }
    }

    #[test]
    fn the_first_accelerated_step_is_a_plain_one() {
        let state = DualState::new(1.0).step(0.5, -0.5, 0.02);
        assert_eq!(state.multiplier(), dual_step(1.0, 0.5, -0.5, 0.02));
    }

    /// Nesterov's sequence: t' = (1 + √(1 + 4t²))/2, from t = 1, and (t − 1)/t' of the progress is added.
    #[test]
    fn further_steps_carry_on_what_the_last_one_gained() {
        let (step, residual) = (0.125, -1.0);
        let first = DualState::new(0.0).step(step, residual, 0.0);
        let second = first.step(step, residual, 0.0);
        let t1 = (1.0 + 5.0_f64.sqrt()) / 2.0;
        let t2 = (1.0 + (1.0 + 4.0 * t1 * t1).sqrt()) / 2.0;
        let expected = 0.25 + (t1 - 1.0) / t2 * 0.125;
        assert!((second.multiplier() - expected).abs() < 1e-12, "{second:?}, not {expected}");
        // A step back begins anew.
        let back = second.step(step, 1.0, 0.0);
        let third = back.step(step, residual, 0.0);
        assert!(third.multiplier() <= back.multiplier() + step + 0.125);
    }

    #[test]
    fn a_step_is_safe_for_the_curvature_of_all_links() {
        let link = |reliability, weight, to_access_point| LinkCurvature {
            reliability,
            weight,
            to_access_point,
        };
        // 0.25/0.5 to a robot and half of 0.0625/0.25 to an access point.
        assert_eq!(safe_step([link(0.5, 0.5, false), link(0.25, 0.25, true)]), 1.0 / 0.625);
    }

    #[test]
    fn without_links_the_multiplier_stays() {
        assert_eq!(safe_step([]), 0.0);
        let link = LinkCurvature { reliability: 1.0, weight: 2.0, to_access_point: true };
        assert_eq!(safe_step([link]), 4.0);
    }
}
