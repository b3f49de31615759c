//! The simplex method in exact fractions.
//!
//! The systems of guards are small, and what is asked of them is often a touching case, x ≤ 1 and
//! x ≥ 1, in which rounding decides. So this is the textbook method on dictionaries, which with
//! Bland's rule ends on every input (Chvátal 1983, *Linear Programming*, chapters 2, 3 and 8), and
//! not a solver in floating point.
//!
//! The dictionaries hold whole numbers over one common denominator. A pivot multiplies crosswise
//! and divides by the last denominator, which leaves no remainder, for all entries are determinants of
//! parts of the input (Edmonds 1967, *Systems of distinct representatives and linear algebra*); so
//! the numbers stay as short as they can be without looking for common factors.

use num_bigint::BigInt;
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
    pub(super) fn solve(&self) -> Outcome {
        let mut dictionary = Dictionary::new(&self.rows, self.objective.len());
        if !dictionary.make_feasible() {
            return Outcome::Infeasible { multipliers: dictionary.multipliers() };
        }
        dictionary.set_objective(&whole(&self.objective).0);
        if !dictionary.maximise() {
            return Outcome::Unbounded;
        }
        Outcome::Optimal { point: dictionary.point(), multipliers: dictionary.multipliers() }
    }
}

/// Fractions times a number that makes them whole, and that number.
fn whole(fractions: &[Fraction]) -> (Vec<BigInt>, BigInt) {
    let scale = fractions.iter().fold(BigInt::one(), |scale, fraction| {
        let scaled = fraction * &scale;
        scale * scaled.denom()
    });
    (fractions.iter().map(|fraction| (fraction * &scale).to_integer()).collect(), scale)
}

/// Each basic unknown, and the objective, as an affine function of the other unknowns, which are 0;
/// all over one positive denominator.
///
/// Unknowns are numbered: first those of the program, then the slack of each row, and at last the
/// artificial one that makes infeasible programs feasible.
struct Dictionary {
    unknowns: usize,
    /// By how much each row was multiplied to make it whole.
    scales: Vec<BigInt>,
    denominator: BigInt,
    basic: Vec<usize>,
    others: Vec<usize>,
    rows: Vec<Affine>,
    objective: Affine,
}

#[derive(Clone)]
struct Affine {
    constant: BigInt,
    coefficients: Vec<BigInt>,
}

impl Dictionary {
    fn new(rows: &[(Vec<Fraction>, Fraction)], unknowns: usize) -> Self {
        let slack = |(row, bound): &(Vec<Fraction>, Fraction)| {
            let (mut numbers, scale) = whole(&[&**row, &[-bound]].concat());
            let constant = -numbers.pop().unwrap_or_default();
            let coefficients = numbers.into_iter().map(|coefficient| -coefficient).collect();
            (Affine { constant, coefficients }, scale)
        };
        let (affine, scales): (Vec<_>, Vec<_>) = rows.iter().map(slack).unzip();
        Dictionary {
            unknowns,
            scales,
            denominator: BigInt::one(),
            basic: (unknowns..unknowns + rows.len()).collect(),
            others: (0..unknowns).collect(),
            rows: affine,
            objective: Affine::zero(unknowns),
        }
    }

    /// Makes all constants at least 0, or says that no solution exists.
    fn make_feasible(&mut self) -> bool {
        let constant = |row: &usize| &self.rows[*row].constant;
        let worst = (0..self.rows.len()).min_by(|a, b| constant(a).cmp(constant(b)));
        let Some(worst) = worst.filter(|row| constant(row).is_negative()) else { return true };

        let artificial = self.unknowns + self.scales.len();
        self.others.push(artificial);
        for row in &mut self.rows {
            row.coefficients.push(BigInt::one());
        }
        self.objective.coefficients.push(-BigInt::one());
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
    fn set_objective(&mut self, objective: &[BigInt]) {
        let mut sum = Affine::zero(self.others.len());
        for (unknown, factor) in objective.iter().enumerate() {
            if let Some(column) = self.others.iter().position(|other| *other == unknown) {
                sum.coefficients[column] += factor * &self.denominator;
            } else if let Some(row) = self.basic.iter().position(|basic| *basic == unknown) {
                let row = &self.rows[row];
                sum.constant += factor * &row.constant;
                for (coefficient, addend) in sum.coefficients.iter_mut().zip(&row.coefficients) {
                    *coefficient += factor * addend;
                }
            }
        }
        self.objective = sum;
    }

    /// Goes from vertex to vertex while the objective can grow; `false` if it can grow forever.
    fn maximise(&mut self) -> bool {
        let mut stalled = false;
        while let Some(column) = self.entering(stalled) {
            let Some(row) = self.leaving(column) else { return false };
            stalled = self.rows[row].constant.is_zero();
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

    /// The basic unknown that becomes 0 first when the one in `column` grows, and of several the
    /// first.
    fn leaving(&self, column: usize) -> Option<usize> {
        let rate = |row: usize| &self.rows[row].coefficients[column];
        let shrinking = (0..self.rows.len()).filter(|row| rate(*row).is_negative());
        shrinking.min_by(|&a, &b| {
            // constant ÷ −rate of both, multiplied crosswise
            let left = &self.rows[b].constant * rate(a);
            let right = &self.rows[a].constant * rate(b);
            left.cmp(&right).then(self.basic[a].cmp(&self.basic[b]))
        })
    }

    /// Exchanges a basic unknown for another one.
    fn pivot(&mut self, row: usize, column: usize) {
        let mut solved = self.rows[row].clone();
        let denominator = solved.coefficients[column].abs();
        let positive = solved.coefficients[column].is_positive();
        solved.coefficients[column] = -self.denominator.clone();
        if positive {
            solved.negate();
        }
        for (position, affine) in self.rows.iter_mut().chain([&mut self.objective]).enumerate() {
            if position != row {
                let factor = std::mem::take(&mut affine.coefficients[column]);
                let entries = affine.coefficients.iter_mut().chain([&mut affine.constant]);
                let addends = solved.coefficients.iter().chain([&solved.constant]);
                for (entry, addend) in entries.zip(addends) {
                    *entry = (&*entry * &denominator + &factor * addend) / &self.denominator;
                }
            }
        }
        self.rows[row] = solved;
        self.denominator = denominator;
        std::mem::swap(&mut self.basic[row], &mut self.others[column]);
    }

    fn point(&self) -> Vec<Fraction> {
        let mut point = vec![Fraction::zero(); self.unknowns];
        for (basic, row) in self.basic.iter().zip(&self.rows) {
            if let Some(value) = point.get_mut(*basic) {
                *value = Fraction::new(row.constant.clone(), self.denominator.clone());
            }
        }
        point
    }

    /// What the objective loses per unit of each slack, up to a factor that all have in common.
    fn multipliers(&self) -> Vec<Fraction> {
        let mut multipliers = vec![Fraction::zero(); self.scales.len()];
        for (other, coefficient) in self.others.iter().zip(&self.objective.coefficients) {
            let slack = other.checked_sub(self.unknowns).filter(|slack| *slack < multipliers.len());
            if let Some(slack) = slack {
                multipliers[slack] = Fraction::from_integer(-coefficient * &self.scales[slack]);
            }
        }
        multipliers
    }
}

impl Affine {
    fn zero(unknowns: usize) -> Self {
        Affine { constant: BigInt::zero(), coefficients: vec![BigInt::zero(); unknowns] }
    }

    fn negate(&mut self) {
        for entry in self.coefficients.iter_mut().chain([&mut self.constant]) {
            *entry = -std::mem::take(entry);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fractions(numbers: &[f64]) -> Vec<Fraction> {
        numbers.iter().filter_map(|number| Fraction::from_float(*number)).collect()
    }

    fn solved(objective: &[f64], rows: &[(&[f64], f64)]) -> Outcome {
        let rows = rows.iter().map(|(row, bound)| (fractions(row), fractions(&[*bound]).remove(0)));
        LinearProgram { objective: fractions(objective), rows: rows.collect() }.solve()
    }

    fn optimum(objective: &[f64], rows: &[(&[f64], f64)]) -> Option<Vec<Fraction>> {
        match solved(objective, rows) {
            Outcome::Optimal { point, .. } => Some(point),
            _ => None,
        }
    }

    #[test]
    fn the_first_example_of_the_textbook() {
        let rows: [(&[f64], f64); 3] =
            [(&[2.0, 3.0, 1.0], 5.0), (&[4.0, 1.0, 2.0], 11.0), (&[3.0, 4.0, 2.0], 8.0)];
        assert_eq!(optimum(&[5.0, 4.0, 3.0], &rows), Some(fractions(&[2.0, 0.0, 1.0])));
    }

    /// Beale's program, on which the greedy rule alone goes round forever.
    #[test]
    fn vertices_that_stay_do_not_come_back() {
        let rows: [(&[f64], f64); 3] = [
            (&[0.25, -8.0, -1.0, 9.0], 0.0),
            (&[0.5, -12.0, -0.5, 3.0], 0.0),
            (&[0.0, 0.0, 1.0, 0.0], 1.0),
        ];
        let objective = [0.75, -20.0, 0.5, -6.0];
        assert_eq!(optimum(&objective, &rows), Some(fractions(&[1.0, 0.0, 1.0, 0.0])));
    }

    #[test]
    fn bounds_below_zero_need_a_first_phase() {
        let rows: [(&[f64], f64); 3] =
            [(&[-1.0, -1.0], -3.0), (&[1.0, 0.0], 2.0), (&[0.0, 1.0], 4.0)];
        assert_eq!(optimum(&[-1.0, -2.0], &rows), Some(fractions(&[2.0, 1.0])));
        assert!(matches!(solved(&[1.0, 1.0], &rows[..2]), Outcome::Unbounded));
    }

    #[test]
    fn contradictions_come_with_their_multipliers() {
        let rows: [(&[f64], f64); 2] = [(&[0.5, 1.0], 1.0), (&[-1.0, -2.0], -3.0)];
        match solved(&[1.0, 0.0], &rows) {
            Outcome::Infeasible { multipliers } => {
                assert_eq!(&multipliers[0], &(&multipliers[1] * Fraction::from_integer(2.into())));
                assert!(multipliers[1].is_positive());
            }
            _ => panic!("twice the first row and the second add up to 0 ≤ −1"),
        }
    }
}
