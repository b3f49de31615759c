//! Flows and resets from formulas: matrices where all of them are affine.

use pleach_automaton::NewValue;
use pleach_guards::{Expression, Interval};

use super::{Assignments, Dynamics, ModelError};
use crate::reach::affine::AffineFlow;
use crate::reach::vector::{IntervalMatrix, radius};
use crate::reach::zonotope::Zonotope;

/// The coefficients of an affine formula: those of the variables, those of the inputs, the constant.
type Coefficients = (Vec<Interval>, Vec<Interval>, Interval);

/// What the formulas of a location may read.
struct Scope<'a> {
    location: &'a str,
    variables: &'a [String],
    inputs: &'a [(&'a str, Interval)],
}

impl Scope<'_> {
    /// The coefficients of some values by `form`, where all are affine. Values that are not may read
    /// no input. `formulas` are those of all values.
    fn coefficients<V>(
        &self,
        values: &[V],
        formulas: &[&Expression],
        form: impl Fn(&V) -> Option<Coefficients>,
    ) -> Result<Option<Vec<Coefficients>>, ModelError> {
        let location = || self.location.to_owned();
        if let Some(variable) = formulas.iter().find_map(|formula| self.stranger(formula)) {
            return Err(ModelError::Variable { location: location(), variable });
        }
        if let Some(forms) = values.iter().map(form).collect() {
            return Ok(Some(forms));
        }
        let read = |name: &str| formulas.iter().any(|formula| formula.variables().contains(name));
        match self.inputs.iter().find(|(name, _)| read(name)) {
            Some((input, _)) => {
                Err(ModelError::Input { input: (*input).to_owned(), location: location() })
            }
            None => Ok(None),
        }
    }

    /// The coefficients of an affine formula.
    fn of_formula(&self, formula: &Expression) -> Option<Coefficients> {
        let number = |value: f64| value.is_finite().then(|| Interval::point(value));
        let form = formula.linear_form_over(&number)?;
        let entry = |name: &str| form.coefficient(name).copied().unwrap_or(Interval::point(0.0));
        let row = self.variables.iter().map(|name| entry(name)).collect();
        let column = self.inputs.iter().map(|(name, _)| entry(name)).collect();
        Some((row, column, *form.constant()))
    }

    /// The coefficients of a new value: those between its two formulas, if it has two.
    fn of_new_value(&self, value: &NewValue) -> Option<Coefficients> {
        let hulls = |one: Vec<Interval>, other: Vec<Interval>| {
            one.into_iter().zip(other).map(|(one, other)| one.hull(other)).collect()
        };
        let mut forms = value.formulas().map(|formula| self.of_formula(formula));
        let first = forms.next()??;
        forms.try_fold(first, |(row, column, constant), other| {
            let (other_row, other_column, other_constant) = other?;
            let constant = constant.hull(other_constant);
            Some((hulls(row, other_row), hulls(column, other_column), constant))
        })
    }

    /// The first variable of a formula that is none of these.
    fn stranger(&self, formula: &Expression) -> Option<String> {
        let is_known = |name: &str| {
            self.variables.iter().any(|known| known == name)
                || self.inputs.iter().any(|(known, _)| *known == name)
        };
        formula.variables().into_iter().find(|name| !is_known(name)).map(str::to_owned)
    }

    /// The constants, with what every input adds to them by `part` of its values.
    fn offsets(
        &self,
        forms: &[Coefficients],
        part: impl Fn(Interval) -> Interval,
    ) -> Vec<Interval> {
        let offset = |(_, column, constant): &Coefficients| {
            let terms = column.iter().zip(self.inputs);
            terms.fold(*constant, |sum, (entry, (_, values))| sum + *entry * part(*values))
        };
        forms.iter().map(offset).collect()
    }
}

/// The coefficients of the variables.
fn matrix(forms: &[Coefficients], dimension: usize) -> IntervalMatrix {
    let mut matrix = IntervalMatrix::zero(dimension, dimension);
    for (row, (entries, ..)) in forms.iter().enumerate() {
        for (column, entry) in entries.iter().enumerate() {
            matrix[(row, column)] = *entry;
        }
    }
    matrix
}

impl Dynamics {
    /// The flow with these rates.
    ///
    /// # Errors
    ///
    /// [`ModelError`] if a rate reads what is no variable or input, or an input enters otherwise than
    /// added with a factor.
    pub fn of(
        location: &str,
        rates: Vec<Expression>,
        variables: &[String],
        inputs: &[(&str, Interval)],
    ) -> Result<Self, ModelError> {
        let scope = Scope { location, variables, inputs };
        let formulas: Vec<&Expression> = rates.iter().collect();
        let forms = scope.coefficients(&rates, &formulas, |rate| scope.of_formula(rate))?;
        let Some(forms) = forms else { return Ok(Dynamics::Formulas(rates)) };
        let matrix = matrix(&forms, variables.len());
        let center = scope.offsets(&forms, |values| Interval::point(values.midpoint()));
        let generators = inputs.iter().enumerate().map(|(number, (_, values))| {
            let half = Interval::point(radius(*values));
            forms.iter().map(|(_, column, _)| column[number] * half).collect()
        });
        let generators: Vec<Vec<Interval>> = generators.collect();
        Ok(Dynamics::Affine(AffineFlow::new(
            matrix,
            Zonotope::from_intervals(&center, &generators),
        )))
    }
}

impl Assignments {
    /// The reset with these values of the variables, in which inputs can be any of their values.
    ///
    /// A value between two affine ones is a row of coefficients between theirs.
    ///
    /// # Errors
    ///
    /// [`ModelError`] if a formula reads what is no variable or input, or an input stands in one that
    /// is not affine.
    pub fn of(
        location: &str,
        values: Vec<NewValue>,
        variables: &[String],
        inputs: &[(&str, Interval)],
    ) -> Result<Self, ModelError> {
        let scope = Scope { location, variables, inputs };
        let formulas: Vec<&Expression> = values.iter().flat_map(NewValue::formulas).collect();
        let forms = scope.coefficients(&values, &formulas, |value| scope.of_new_value(value))?;
        let Some(forms) = forms else { return Ok(Assignments::Formulas(values)) };
        let offset = scope.offsets(&forms, |values| values);
        Ok(Assignments::Affine(matrix(&forms, variables.len()), offset))
    }
}
