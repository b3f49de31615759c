//! Flows that are not affine, enclosed by Taylor series in time whose coefficients are polynomials in
//! the initial state.
//!
//! One step goes as follows. The state is a vector of polynomials in symbols from −1 to 1, one for
//! each dimension of the initial set and for each error that was made on the way. From them come
//! the Taylor coefficients x₀, …, xₖ₋₁ in time, as Taylor models. A box B and a
//! duration h are found with
//!
//! ```text
//! Σ xⱼ [0, h]ʲ + [0, h]ᵏ f⁽ᵏ⁾(B) ⊆ B,     j < k,
//! ```
//!
//! where f⁽ᵏ⁾(B) is the k-th Taylor coefficient of solutions through B, in intervals. Then every
//! solution stays in B for h seconds, and the left side encloses it at each instant (Nedialkov,
//! Jackson and Pryce 2001, *An effective high-order interval method for validating existence and
//! uniqueness of the solution of an IVP for an ODE*, Reliable Computing 7). At the end of the step the
//! remainders become symbols of their own, so that later steps turn and shrink them with the flow.

mod step;

use std::sync::Arc;

use pleach_guards::{Expression, Interval};

use super::flow::Stretch;
use super::polytope::Template;
use super::series::SeriesProgram;
use super::set::StateSet;
use super::settings::Settings;
use super::taylor_model::{Limits, TaylorModel};
use step::{Step, combined, remainder, share_of_error};

/// How many symbols there can be.
const SYMBOLS: usize = 240;

/// A flow on its way.
pub(super) struct Integration {
    /// `None` where a formula is not smooth.
    program: Option<SeriesProgram>,
    state: Vec<TaylorModel>,
    /// Symbols of the initial set come first and stay.
    first_error: usize,
    /// The symbols in use are those below.
    symbols: usize,
    /// The time that has passed: a sum of floating-point numbers, so an interval.
    time: Interval,
    /// What is tried next, in seconds.
    next_step: f64,
    longest_step: f64,
    order: usize,
    tolerance: f64,
    most_symbols: usize,
}

impl Integration {
    pub(super) fn new(
        rates: &[Expression],
        variables: &[String],
        start: &StateSet,
        settings: &Settings,
    ) -> Self {
        let dimension = variables.len();
        let zonotope = start.to_zonotope().reduced((SYMBOLS / 2).saturating_sub(dimension));
        let slack = zonotope.slack().iter().filter(|slack| **slack > 0.0).count();
        let limits = Limits {
            degree: settings.degree,
            first_error: zonotope.generators().len() + slack,
            least: settings.tolerance * 1e-3,
        };
        let mut symbols = zonotope.generators().len();
        let mut state = Vec::new();
        for axis in 0..dimension {
            let slopes = zonotope.generators().iter().enumerate();
            let slopes = slopes.map(|(number, generator)| (number as u8, generator[axis]));
            let slack = zonotope.slack()[axis];
            let slack = (slack > 0.0).then(|| {
                symbols += 1;
                ((symbols - 1) as u8, slack)
            });
            state.push(TaylorModel::affine(zonotope.center()[axis], slopes.chain(slack), limits));
        }
        let most = symbols + settings.generators.max(1) * dimension;
        let program = SeriesProgram::compile(rates, variables).ok();
        Integration {
            // With more symbols than there are, nothing is enclosed.
            program: program.filter(|_| symbols <= SYMBOLS),
            state,
            first_error: symbols,
            symbols,
            time: Interval::point(0.0),
            next_step: settings.step.min(1e-2),
            longest_step: settings.step,
            order: settings.order,
            tolerance: settings.tolerance,
            most_symbols: most.min(SYMBOLS),
        }
    }

    /// How far it has come, in seconds.
    pub(super) fn time(&self) -> f64 {
        self.time.lower()
    }

    /// The next step, at most up to `until`; `None` where there is no enclosure.
    pub(super) fn step(&mut self, template: &Arc<Template>, until: f64) -> Option<Stretch> {
        // A little beyond the end is no harm, and the clock has to go on.
        let most = (until - self.time.lower()).max(2.0 * f64::EPSILON * self.time.lower());
        let step = self.enclosed(most)?;
        let directions = template.directions();
        let during = directions.iter().map(|direction| step.bound_along(direction));
        let during: Vec<f64> = during.collect();
        let from = self.time.lower();
        self.state = step.end();
        self.time = self.time + Interval::point(step.length);
        self.name_errors();
        let after = directions
            .iter()
            .map(|direction| combined(direction, self.state.iter()).range().upper());
        let after = after.collect();
        Some(Stretch { from, to: self.time.upper(), during, after })
    }

    /// Finds a step of at most `most` seconds.
    fn enclosed(&mut self, most: f64) -> Option<Step> {
        /// The shortest step, as a share of the longest.
        const SHORTEST: f64 = 1e-7;
        let program = self.program.as_ref()?;
        let limits = self.state.first()?.limits();
        let coefficients = program.solve(&self.state, self.order - 1, limits)?;
        let mut length = self.next_step.min(self.longest_step);
        loop {
            length = length.min(most);
            if length.is_nan() || length <= self.time.lower() * f64::EPSILON {
                return None;
            }
            let Some(last) = remainder(program, &coefficients, length, self.order) else {
                length *= 0.5;
                if length < self.longest_step * SHORTEST {
                    return None;
                }
                continue;
            };
            let error = share_of_error(&self.state, &last, length, self.order);
            let factor = (0.5 * self.tolerance / error.max(1e-300)).powf(1.0 / self.order as f64);
            if error > self.tolerance && length > self.longest_step * SHORTEST {
                length *= factor.clamp(0.2, 0.9);
                continue;
            }
            self.next_step =
                length.max(self.next_step.min(self.longest_step) * 0.25) * factor.clamp(0.3, 1.5);
            return Some(Step { length, coefficients, last });
        }
    }

    /// Gives the remainders symbols of their own, and makes room for them where need be; some stay remainders where
    /// there is none.
    fn name_errors(&mut self) {
        let has_errors = |this: &Self| this.symbols > this.first_error;
        while self.symbols + self.state.len() > self.most_symbols && has_errors(self) {
            self.merge_errors();
        }
        for component in &mut self.state {
            if self.symbols < self.most_symbols && component.name_rest(self.symbols as u8) {
                self.symbols += 1;
            }
        }
    }

    /// Moves the smaller half of the symbols of errors into the remainders.
    fn merge_errors(&mut self) {
        let first = self.first_error;
        let mut sizes = vec![0.0f64; self.symbols];
        for (monomial, coefficient) in self.state.iter().flat_map(|component| component.terms()) {
            for symbol in monomial.symbols() {
                sizes[usize::from(symbol)] += coefficient.abs();
            }
        }
        let mut ranked: Vec<usize> = (first..self.symbols).collect();
        ranked.sort_by(|one, other| sizes[*other].total_cmp(&sizes[*one]).then(one.cmp(other)));
        let kept = ranked.len() / 2;
        let mut name: Vec<Option<u8>> = (0..first).map(|symbol| Some(symbol as u8)).collect();
        name.resize(self.symbols, None);
        let mut kept_symbols: Vec<usize> = ranked[..kept].to_vec();
        kept_symbols.sort_unstable();
        for (number, symbol) in kept_symbols.iter().enumerate() {
            name[*symbol] = Some((first + number) as u8);
        }
        for component in &mut self.state {
            component
                .give_up(|monomial, _| monomial.symbols().any(|s| name[usize::from(s)].is_none()));
            component.rename(|symbol| name[usize::from(symbol)].unwrap_or(symbol));
        }
        self.symbols = first + kept;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::{fraction, points};

    fn integration(rate: &str, start: f64, settings: &Settings) -> Integration {
        let rates = [rate.parse::<Expression>().expect("a formula")];
        let start = StateSet::from_box(points(&[start]));
        Integration::new(&rates, &["x".to_owned()], &start, settings)
    }

    fn template() -> Arc<Template> {
        Arc::new(Template::boxes(1))
    }

    /// With this many variables, few symbols are left for errors, none are, or there are fewer symbols than variables.
    #[test]
    fn symbols_of_many_variables_are_no_more_than_there_are() {
        let settings = Settings { step: 0.1, order: 2, ..Settings::default() };
        for (count, is_enclosed) in [(86, true), (130, true), (250, false)] {
            let names: Vec<String> = (0..count).map(|number| format!("x{number}")).collect();
            let rate = |name: &String| format!("-sin({name})").parse::<Expression>();
            let rates: Vec<Expression> =
                names.iter().map(rate).collect::<Result<_, _>>().expect("formulas");
            let side = Interval::new(-0.5, 0.5).expect("an interval");
            let start = StateSet::from_box(vec![side; count]);
            let mut decay = Integration::new(&rates, &names, &start, &settings);
            let template = Arc::new(Template::boxes(count));
            for _ in 0..3 {
                let stretch = decay.step(&template, 1.0);
                assert_eq!(stretch.is_some(), is_enclosed, "of {count}");
                // The widest is that of x = 2 atan(e⁻ᵗ tan ¼).
                let exact = 2.0 * ((-decay.time()).exp() * 0.25f64.tan()).atan();
                assert!(stretch.is_none_or(|it| it.after[0] >= exact), "of {count}");
                assert!(!is_enclosed || decay.symbols <= SYMBOLS, "of {count}");
            }
        }
    }

    /// From x = 1, of ẋ = x²: 1 ÷ (1 − t), which the first terms of its series are far below.
    #[test]
    fn the_last_term_of_the_series_counts() {
        let settings = Settings { order: 2, tolerance: 1.0, step: 0.1, ..Settings::default() };
        let mut growing = integration("x * x", 1.0, &settings);
        growing.next_step = 0.1;
        let bounds = growing.step(&template(), 0.1).expect("it is enclosed");
        let end = 1.0 / (1.0 - 0.1);
        assert!(bounds.after[0] >= end && -bounds.after[1] <= end, "{:?}", bounds.after);
        assert!(bounds.during[0] >= end && -bounds.during[1] <= 1.0, "{:?}", bounds.during);
    }

    /// Squares of the symbol are beyond degree 1: from [0.9, 1.1] the largest solution is above what the
    /// polynomials say.
    #[test]
    fn remainders_count_during_a_step() {
        let settings = Settings { degree: 1, tolerance: 1.0, step: 0.1, ..Settings::default() };
        let rates = ["x * x".parse::<Expression>().expect("a formula")];
        let start = StateSet::from_box(vec![Interval::new(0.9, 1.1).expect("in order")]);
        let mut growing = Integration::new(&rates, &["x".to_owned()], &start, &settings);
        growing.next_step = 0.1;
        let bounds = growing.step(&template(), 0.1).expect("it is enclosed");
        let end = 1.1 / (1.0 - 0.11);
        assert!(
            bounds.during[0] >= end && bounds.after[0] >= end,
            "{bounds:?}",
            bounds = bounds.during
        );
    }

    /// Three steps of the number 0.1 are less than what the sum of these numbers is rounded to.
    #[test]
    fn the_clock_is_rounded_outward() {
        let settings = Settings { step: 0.1, tolerance: 1.0, ..Settings::default() };
        let mut resting = integration("0 * x", 1.0, &settings);
        resting.next_step = 0.1;
        for number in 1..=20 {
            let stretch = resting.step(&template(), 9.0).expect("it is enclosed");
            let end = fraction(0.1) * fraction(f64::from(number));
            assert!(fraction(stretch.to) >= end, "{number}");
            assert!(fraction(stretch.from) <= end - fraction(0.1), "{number}");
        }
    }

    /// The time that is left is covered, though it is no number.
    #[test]
    fn the_end_is_reached() {
        for until in [0.3, 1.0, 2.7, 1e3 + 0.1] {
            let settings = Settings { step: 0.1 * until, tolerance: 1.0, ..Settings::default() };
            let mut resting = integration("0 * x", 1.0, &settings);
            while resting.time() < until {
                resting.step(&template(), until).expect("it is enclosed");
            }
        }
    }
}
