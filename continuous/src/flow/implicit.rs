//! Steps of the implicit method, for stiff flows.

use super::factorisation::Factorisation;
use super::integrator::{Origin, Trial};
use super::rosenbrock::{EXTENSION, GAMMA, IN_RATES, IN_STATE, NODES, OF_TIME, STAGES};
use super::{Tolerances, VectorField};

/// The stages of a step, and the Jacobian at its start.
#[derive(Debug)]
pub(super) struct Implicit {
    stages: [Vec<f64>; STAGES],
    /// ∂f/∂x at the origin, row by row.
    jacobian: Vec<f64>,
    /// ∂f/∂t at the origin.
    by_time: Vec<f64>,
    /// Whether both are those of the present origin.
    is_known: bool,
    factorisation: Factorisation,
    probe: Vec<f64>,
    probed: Vec<f64>,
    slopes: Vec<f64>,
}

/// How much an error inside a step counts beside one at its end, which later steps carry on.
const INSIDE: f64 = 0.1;

impl Implicit {
    pub(super) fn new(dimension: usize) -> Self {
        let zeros = || vec![0.0; dimension];
        Implicit {
            stages: std::array::from_fn(|_| zeros()),
            jacobian: vec![0.0; dimension * dimension],
            by_time: zeros(),
            is_known: false,
            factorisation: Factorisation::new(dimension),
            probe: zeros(),
            probed: zeros(),
            slopes: zeros(),
        }
    }

    /// The next step begins elsewhere.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Computes all stages of a step and the state at its end, and its error as a fraction of what
    /// is allowed; not finite where a stage is not.
    pub(super) fn attempt<F: VectorField + ?Sized>(
        &mut self,
        field: &F,
        tolerances: &Tolerances,
        origin: &Origin,
        step: f64,
        trial: &mut Trial,
    ) -> f64 {
        if !self.is_known {
            self.differentiate(field, tolerances, origin, trial.time);
        }
        let (n, shift) = (origin.state.len(), 1.0 / (GAMMA * step));
        let jacobian = &self.jacobian;
        let entry = |row: usize, column: usize| {
            let slope = jacobian[row * n + column];
            if row == column { shift - slope } else { -slope }
        };
        if !self.factorisation.factorise(entry) {
            return f64::NAN;
        }
        for stage in 0..STAGES {
            self.compute(stage, field, origin, step, trial.time);
        }
        let last = &self.stages[STAGES - 1];
        for (i, x) in trial.state.iter_mut().enumerate() {
            *x = self.probe[i] + last[i];
        }
        let at_end = largest(tolerances, origin, trial, last);
        if at_end <= 1.0 {
            self.probe_middle(field, origin, step, trial);
            return at_end.max(INSIDE * largest(tolerances, origin, trial, &self.probed));
        }
        at_end
    }

    /// Writes to `probed` by how much the extension is off in the middle of the step: its defect,
    /// as the method itself would turn it into a change of state.
    ///
    /// Where fast motions are damped the ends of steps are right however long the steps are; what
    /// happens inside is not seen there.
    fn probe_middle<F: VectorField + ?Sized>(
        &mut self,
        field: &F,
        origin: &Origin,
        step: f64,
        trial: &Trial,
    ) {
        for (i, slope) in self.slopes.iter_mut().enumerate() {
            let [a, b, c] = extension(&self.stages, i);
            let change = trial.state[i] - origin.state[i];
            // At θ = φ = 1/2.
            self.probe[i] = origin.state[i] + 0.5 * (change + 0.5 * (a + 0.5 * (b + 0.5 * c)));
            // d/dθ of θφ a, θ²φ b and θ³φ c is 0, 1/4 and 1/4.
            *slope = (change + 0.25 * b + 0.25 * c) / step;
        }
        field.rates(origin.time + 0.5 * step, &self.probe, &mut self.probed);
        self.probed.iter_mut().zip(&self.slopes).for_each(|(rate, slope)| *rate -= slope);
        self.factorisation.solve(&mut self.probed);
    }

    /// One stage; the state at which the field was evaluated stays in `probe`.
    fn compute<F: VectorField + ?Sized>(
        &mut self,
        stage: usize,
        field: &F,
        origin: &Origin,
        step: f64,
        end: f64,
    ) {
        let (earlier, later) = self.stages.split_at_mut(stage);
        let right = &mut later[0];
        self.probe.copy_from_slice(&origin.state);
        for (weight, other) in IN_STATE[stage].iter().zip(&*earlier) {
            for (x, y) in self.probe.iter_mut().zip(other) {
                *x += weight * y;
            }
        }
        if stage == 0 {
            right.copy_from_slice(&origin.rates);
        } else {
            let fraction = NODES[stage];
            let time = if fraction == 1.0 { end } else { origin.time + fraction * step };
            field.rates(time, &self.probe, right);
        }
        for (weight, other) in IN_RATES[stage].iter().zip(&*earlier) {
            for (x, y) in right.iter_mut().zip(other) {
                *x += weight / step * y;
            }
        }
        for (x, slope) in right.iter_mut().zip(&self.by_time) {
            *x += OF_TIME[stage] * step * slope;
        }
        self.factorisation.solve(right);
    }

    /// The derivatives at the origin, by differences unless the field knows them.
    fn differentiate<F: VectorField + ?Sized>(
        &mut self,
        field: &F,
        tolerances: &Tolerances,
        origin: &Origin,
        end: f64,
    ) {
        let matters = tolerances.absolute() / tolerances.relative();
        let n = origin.state.len();
        let Origin { time, state, rates } = origin;
        if !field.jacobian(*time, state, &mut self.jacobian) {
            self.probe.copy_from_slice(state);
            for (column, &x) in state.iter().enumerate() {
                self.probe[column] = x + difference(x.abs().max(matters));
                let apart = self.probe[column] - x;
                field.rates(*time, &self.probe, &mut self.probed);
                self.probe[column] = x;
                for (row, rate) in rates.iter().enumerate() {
                    self.jacobian[row * n + column] = (self.probed[row] - rate) / apart;
                }
            }
        }
        let later = (time + difference(time.abs().max(end - time))).min(end);
        field.rates(later, state, &mut self.probed);
        for (row, rate) in rates.iter().enumerate() {
            self.by_time[row] = (self.probed[row] - rate) / (later - time);
        }
        self.is_known = true;
    }

    /// A bound on |h λ| for the motions λ at the start of the step.
    pub(super) fn stiffness(&self, step: f64) -> f64 {
        let n = self.probe.len().max(1);
        let rows = self.jacobian.chunks_exact(n);
        let largest = rows.map(|row| row.iter().map(|slope| slope.abs()).sum::<f64>());
        step * largest.fold(0.0, f64::max)
    }

    /// Writes the terms of the extension from the second power on; says whether they are finite.
    pub(super) fn extend(&self, terms: &mut [Vec<f64>]) -> bool {
        let [second, third, rest @ ..] = terms else { return false };
        for i in 0..second.len() {
            let [a, b, c] = extension(&self.stages, i);
            // K₃ + θ K₄ = K₃ + K₄ − φ K₄.
            second[i] = a;
            third[i] = b + c;
            rest[0][i] = -c;
        }
        second.iter().chain(&*third).chain(&rest[0]).all(|x| x.is_finite())
    }
}

/// The terms K₂, K₃ and K₄ of a component.
fn extension(stages: &[Vec<f64>; STAGES], component: usize) -> [f64; 3] {
    EXTENSION.map(|weights| {
        weights.iter().zip(stages).map(|(weight, stage)| weight * stage[component]).sum()
    })
}

/// The largest error of a component, as a fraction of what is allowed; not finite where a state or
/// an error is not.
fn largest(tolerances: &Tolerances, origin: &Origin, trial: &Trial, errors: &[f64]) -> f64 {
    // `max` ignores NaN; the sum does not.
    let (mut largest, mut sum) = (0.0_f64, 0.0);
    for ((before, after), error) in origin.state.iter().zip(&trial.state).zip(errors) {
        let fraction = error.abs() / tolerances.allowed(before.abs().max(after.abs()));
        largest = largest.max(fraction);
        sum += fraction + 0.0 * after;
    }
    if sum.is_finite() { largest } else { sum }
}

/// How far apart to evaluate a field in order to see its slope, where numbers of this size matter:
/// half their digits.
fn difference(size: f64) -> f64 {
    f64::EPSILON.sqrt() * size
}
