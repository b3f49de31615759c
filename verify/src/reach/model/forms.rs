//! Flows and resets from formulas: matrices where all of them are affine.

use pleach_automaton::NewValue;
use pleach_guards::{Expression, Interval};

use super::{Assignments, Dynamics, ModelError};
use crate::reach::affine::AffineFlow;
use crate::reach::vector::{IntervalMatrix, radius};
use crate::reach::zonotope::Zonotope;

/// The coefficients of an affine formula: those of the variables, those of the inputs, the constant.
type Coefficients = (Vec<Interval>, Vec<Interval>, Interval);

fn coefficients(
    formula: &Expression,
    variables: &[String],
    inputs: &[(&str, Interval)],
) -> Option<Coefficients> {
    let number = |value: f64| value.is_finite().then(|| Interval::point(value));
    let form = formula.linear_form_over(&number)?;
    let entry = |name: &str| form.coefficient(name).copied().unwrap_or(Interval::point(0.0));
    let row = variables.iter().map(|name| entry(name)).collect();
    let column = inputs.iter().map(|(name, _)| entry(name)).collect();
    Some((row, column, *form.constant()))
}

/// The coefficients of a new value: those between its two formulas, if it has two.
fn new_coefficients(
    value: &NewValue,
    variables: &[String],
    inputs: &[(&str, Interval)],
) -> Option<Coefficients> {
    let hulls = |one: Vec<Interval>, other: Vec<Interval>| {
        one.into_iter().zip(other).map(|(one, other)| one.hull(other)).collect()
    };
    let mut forms = value.formulas().map(|formula| coefficients(formula, variables, inputs));
    let first = forms.next()??;
    forms.try_fold(first, |(row, column, constant), other| {
        let (other_row, other_column, other_constant) = other?;
        Some((hulls(row, other_row), hulls(column, other_column), constant.hull(other_constant)))
    })
}

/// The first variable of a formula that is none of these.
fn stranger(
    formula: &Expression,
    variables: &[String],
    inputs: &[(&str, Interval)],
) -> Option<String> {
    let is_known = |name: &str| {
        variables.iter().any(|known| known == name)
            || inputs.iter().any(|(known, _)| *known == name)
    };
    formula.variables().into_iter().find(|name| !is_known(name)).map(str::to_owned)
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
        if let Some(variable) = rates.iter().find_map(|rate| stranger(rate, variables, inputs)) {
            return Err(ModelError::Variable { location: location.to_owned(), variable });
        }
        let forms: Option<Vec<_>> =
            rates.iter().map(|rate| coefficients(rate, variables, inputs)).collect();
        let Some(forms) = forms else {
            let read = |name: &str| rates.iter().any(|rate| rate.variables().contains(name));
            return match inputs.iter().find(|(name, _)| read(name)) {
                Some((input, _)) => Err(ModelError::Input {
                    input: (*input).to_owned(),
                    location: location.to_owned(),
                }),
                None => Ok(Dynamics::Formulas(rates)),
            };
        };
        let dimension = variables.len();
        let mut matrix = IntervalMatrix::zero(dimension, dimension);
        let mut center = Vec::new();
        for (row, (entries, column, offset)) in forms.iter().enumerate() {
            for (place, entry) in entries.iter().enumerate() {
                matrix[(row, place)] = *entry;
            }
            let middle = |(entry, (_, values)): (&Interval, &(&str, Interval))| {
                *entry * Interval::point(values.midpoint())
            };
            center
                .push(column.iter().zip(inputs).map(middle).fold(*offset, |sum, term| sum + term));
        }
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
        let location = || location.to_owned();
        let unknown = |value: &NewValue| {
            value.formulas().find_map(|formula| stranger(formula, variables, inputs))
        };
        if let Some(variable) = values.iter().find_map(unknown) {
            return Err(ModelError::Variable { location: location(), variable });
        }
        let forms: Option<Vec<Coefficients>> =
            values.iter().map(|value| new_coefficients(value, variables, inputs)).collect();
        let Some(forms) = forms else {
            let read = |name: &&str| {
                values.iter().flat_map(NewValue::formulas).any(|it| it.variables().contains(*name))
            };
            return match inputs.iter().map(|(name, _)| *name).find(read) {
                Some(input) => {
                    Err(ModelError::Input { input: input.to_owned(), location: location() })
                }
                None => Ok(Assignments::Formulas(values)),
            };
        };
        let dimension = variables.len();
        let mut matrix = IntervalMatrix::zero(dimension, dimension);
        let mut offset = Vec::new();
        for (row, (entries, column, constant)) in forms.iter().enumerate() {
            for (place, entry) in entries.iter().enumerate() {
                matrix[(row, place)] = *entry;
            }
            let terms = column.iter().zip(inputs).map(|(entry, (_, values))| *entry * *values);
            offset.push(terms.fold(*constant, |sum, term| sum + term));
        }
        Ok(Assignments::Affine(matrix, offset))
    }
}
