//! The simplex method in exact fractions.
//!
//! The systems of guards are small, and what is asked of them is often a touching case, x ≤ 1 and
//! x ≥ 1, in which rounding decides. So this is the textbook method on dictionaries, which with
//! Bland's rule ends on every input (Chvátal 1983, *Linear Programming*, chapters 2, 3 and 8), and
//! not a solver in floating point.

use num_rational::BigRational as Fraction;
use num_traits::{One, Signed, Zero};

/// Maximise objective · z over all z ≥ 0 with row · z ≤ bound for each row.
pub(super) struct LinearProgram {
    /// One coefficient per unknown.
    pub objective: Vec<Fraction>,
    /// One coefficient per unknown, and the bound.
    pub rows: Vec<(Vec<Fraction>, Fraction)>,
}

/// How a linear program ends. The multipliers, one per row and none negative, are its proof: the
/// rows, multiplied and added, bound the objective by the optimum, or contradict each other.
pub(super) enum Outcome {
    Infeasible { multipliers: Vec<Fraction> },
    Optimal { point: Vec<Fraction>, multipliers: Vec<Fraction> },
    Unbounded,
}

impl LinearProgram {
    pub fn solve(&self) -> Outcome {
        let mut dictionary = Dictionary::new(&self.rows, self.objective.len());
        if !dictionary.make_feasible() {
            return Outcome::Infeasible { multipliers: dictionary.multipliers() };
        }
        dictionary.set_objective(&self.objective);
        if !dictionary.maximise() {
            return Outcome::Unbounded;
        }
        Outcome::Optimal { point: dictionary.point(), multipliers: dictionary.multipliers() }
    }
}

/// Each basic unknown, and the objective, as an affine function of the other unknowns, which are 0.
///
/// Unknowns are numbered: first those of the program, then the slack of each row, and at last the
/// artificial one that makes infeasible programs feasible.
struct Dictionary {
    unknowns: usize,
    slacks: usize,
    basic: Vec<usize>,
    others: Vec<usize>,
    rows: Vec<Affine>,
    objective: Affine,
}

#[derive(Clone)]
struct Affine {
    constant: Fraction,
    coefficients: Vec<Fraction>,
}

impl Dictionary {
    fn new(rows: &[(Vec<Fraction>, Fraction)], unknowns: usize) -> Self {
        let slack = |(row, bound): &(Vec<Fraction>, Fraction)| Affine {
            constant: bound.clone(),
            coefficients: row.iter().map(|coefficient| -coefficient).collect(),
        };
        Dictionary {
            unknowns,
            slacks: rows.len(),
            basic: (unknowns..unknowns + rows.len()).collect(),
            others: (0..unknowns).collect(),
            rows: rows.iter().map(slack).collect(),
            objective: Affine {
                constant: Fraction::zero(),
                coefficients: vec![Fraction::zero(); unknowns],
            },
        }
    }

    /// Makes all constants at least 0, or says that no solution exists.
    fn make_feasible(&mut self) -> bool {
        let constant = |row: &usize| &self.rows[*row].constant;
        let worst = (0..self.rows.len()).min_by(|a, b| constant(a).cmp(constant(b)));
        let Some(worst) = worst.filter(|row| constant(row).is_negative()) else { return true };

        let artificial = self.unknowns + self.slacks;
        self.others.push(artificial);
        for row in &mut self.rows {
            row.coefficients.push(Fraction::one());
        }
        self.objective.coefficients.push(-Fraction::one());
        self.pivot(worst, self.others.len() - 1);
        self.maximise();
        if self.objective.constant.is_negative() {
            return false;
        }
        self.drop_unknown(artificial);
        true
    }

    /// Takes an unknown out that is 0.
    fn drop_unknown(&mut self, unknown: usize) {
        if let Some(row) = self.basic.iter().position(|basic| *basic == unknown) {
            match self.rows[row].coefficients.iter().position(|coefficient| !coefficient.is_zero())
            {
                Some(column) => self.pivot(row, column),
                None => {
                    self.basic.remove(row);
                    self.rows.remove(row);
                }
            }
        }
        if let Some(column) = self.others.iter().position(|other| *other == unknown) {
            self.others.remove(column);
            for affine in self.rows.iter_mut().chain([&mut self.objective]) {
                affine.coefficients.remove(column);
            }
        }
    }

    /// Writes an objective over the unknowns of the program in those that are not basic now.
    fn set_objective(&mut self, objective: &[Fraction]) {
        let mut sum = Affine {
            constant: Fraction::zero(),
            coefficients: vec![Fraction::zero(); self.others.len()],
        };
        for (unknown, factor) in objective.iter().enumerate() {
            if let Some(column) = self.others.iter().position(|other| *other == unknown) {
                sum.coefficients[column] += factor;
            } else if let Some(row) = self.basic.iter().position(|basic| *basic == unknown) {
                sum.add(factor, &self.rows[row]);
            }
        }
        self.objective = sum;
    }

    /// Goes from vertex to vertex while the objective can grow; `false` if it can grow for ever.
    fn maximise(&mut self) -> bool {
        let mut stalled = false;
        while let Some(column) = self.entering(stalled) {
            let leaving = (0..self.rows.len())
                .filter_map(|row| {
                    let Affine { constant, coefficients } = &self.rows[row];
                    let shrinks = coefficients[column].is_negative();
                    shrinks.then(|| (-constant / &coefficients[column], self.basic[row], row))
                })
                .min();
            let Some((step, _, row)) = leaving else { return false };
            stalled = step.is_zero();
            self.pivot(row, column);
        }
        true
    }

    /// The unknown with which the objective grows fastest; but while vertices stay where they are,
    /// of all with which it grows the first (Bland), so that no dictionary comes back.
    fn entering(&self, stalled: bool) -> Option<usize> {
        let gain = |column: &usize| &self.objective.coefficients[*column];
        let growing = (0..self.others.len()).filter(|column| gain(column).is_positive());
        if stalled {
            growing.min_by_key(|column| self.others[*column])
        } else {
            growing.max_by(|a, b| gain(a).cmp(gain(b)))
        }
    }

    /// Exchanges a basic unknown for another one.
    fn pivot(&mut self, row: usize, column: usize) {
        let mut solved = self.rows[row].clone();
        let pivot = -solved.coefficients[column].clone();
        solved.coefficients[column] = -Fraction::one();
        solved.constant /= &pivot;
        for coefficient in &mut solved.coefficients {
            *coefficient /= &pivot;
        }
        for (position, affine) in self.rows.iter_mut().chain([&mut self.objective]).enumerate() {
            if position != row {
                let factor = std::mem::replace(&mut affine.coefficients[column], Fraction::zero());
                affine.add(&factor, &solved);
            }
        }
        self.rows[row] = solved;
        std::mem::swap(&mut self.basic[row], &mut self.others[column]);
    }

    fn point(&self) -> Vec<Fraction> {
        let mut point = vec![Fraction::zero(); self.unknowns];
        for (basic, row) in self.basic.iter().zip(&self.rows) {
            if let Some(value) = point.get_mut(*basic) {
                value.clone_from(&row.constant);
            }
        }
        point
    }

    /// What the objective loses per unit of each slack.
    fn multipliers(&self) -> Vec<Fraction> {
        let mut multipliers = vec![Fraction::zero(); self.slacks];
        for (other, coefficient) in self.others.iter().zip(&self.objective.coefficients) {
            let slack = other.checked_sub(self.unknowns);
            if let Some(multiplier) = slack.and_then(|slack| multipliers.get_mut(slack)) {
                *multiplier = -coefficient;
            }
        }
        multipliers
    }
}

impl Affine {
    fn add(&mut self, factor: &Fraction, other: &Affine) {
        if factor.is_zero() {
            return;
        }
        self.constant += factor * &other.constant;
        for (coefficient, addend) in self.coefficients.iter_mut().zip(&other.coefficients) {
            *coefficient += factor * addend;
        }
    }
}
