//! Predicates in normal forms, as analyses take them apart.

use std::convert::Infallible;
use std::error::Error;
use std::fmt;
use std::sync::Arc;

use crate::expression::{BinaryOperator, Expression, UnaryOperator, constant};
use crate::predicate::{Comparison, Predicate, Relation};
use crate::table::Interpolation;

impl Predicate {
    /// The predicate with all negations resolved, except those of named functions.
    ///
    /// Verdict and margin are the same in every state.
    ///
    /// ```
    /// use pleach_guards::{not, variable};
    ///
    /// let (x, y) = (variable("x"), variable("y"));
    /// let outside = not(x.at_least(0.0) & (x.less_than(1.0) | y.at_most(2.0)));
    /// assert_eq!(outside.negation_normal_form().to_string(), "x < 0 ∨ x ≥ 1 ∧ y > 2");
    /// ```
    pub fn negation_normal_form(&self) -> Predicate {
        self.resolved(true)
    }

    /// The normal form of the predicate, or of its opposite if it is not `affirmed`.
    fn resolved(&self, affirmed: bool) -> Predicate {
        let parts = |parts: &[Predicate]| -> Vec<Predicate> {
            parts.iter().map(|part| part.resolved(affirmed)).collect()
        };
        match self {
            Predicate::Comparison(comparison) if affirmed => {
                Predicate::Comparison(comparison.clone())
            }
            Predicate::Comparison(comparison) => Predicate::Comparison(comparison.opposite()),
            Predicate::Not(inner) => inner.resolved(!affirmed),
            Predicate::All(conjuncts) if affirmed => Predicate::all(parts(conjuncts)),
            Predicate::All(conjuncts) => Predicate::any(parts(conjuncts)),
            Predicate::Any(disjuncts) if affirmed => Predicate::any(parts(disjuncts)),
            Predicate::Any(disjuncts) => Predicate::all(parts(disjuncts)),
            Predicate::Proposition(_) | Predicate::Function(_) if affirmed => self.clone(),
            Predicate::Proposition(_) | Predicate::Function(_) => {
                Predicate::Not(Arc::new(self.clone()))
            }
        }
    }

    /// The predicate as conjunctions of comparisons, at least one of which holds wherever the
    /// predicate does.
    ///
    /// # Errors
    ///
    /// [`NoDisjunctiveForm`] if a named function occurs, or if there are more than `limit`
    /// conjunctions, for their number can grow exponentially with the size of the predicate.
    ///
    /// ```
    /// use pleach_guards::variable;
    ///
    /// let (x, y) = (variable("x"), variable("y"));
    /// let corners = (x.at_most(0.0) | x.at_least(1.0)) & (y.at_most(0.0) | y.at_least(1.0));
    /// assert_eq!(corners.disjunctive_form(4)?.len(), 4);
    /// assert!(corners.disjunctive_form(3).is_err());
    /// # Ok::<(), pleach_guards::NoDisjunctiveForm>(())
    /// ```
    pub fn disjunctive_form(
        &self,
        limit: usize,
    ) -> Result<Vec<Vec<Comparison>>, NoDisjunctiveForm> {
        disjuncts(&self.negation_normal_form(), limit)
    }

    /// The predicate without absolute values, signs, minima, maxima, choices and tables: each
    /// comparison with such parts becomes a disjunction of cases in which it is one of what they
    /// can be.
    ///
    /// It holds in the same states, save where a part of a case that does not apply is not a
    /// number, such as √−x in √|x|, or where a piece that is divided by is a zero of the other sign. Its
    /// margin says how far the case is, too.
    ///
    /// # Errors
    ///
    /// [`NoDisjunctiveForm::TooLarge`] if one comparison has more than `limit` cases.
    ///
    /// ```
    /// use pleach_guards::variable;
    ///
    /// let close = variable("x").equals_within(1.0, 0.5);
    /// let text = "x − 1 ≥ 0 ∧ x − 1 ≤ 0.5 ∨ x − 1 < 0 ∧ −(x − 1) ≤ 0.5";
    /// assert_eq!(close.by_cases(2)?.to_string(), text);
    /// # Ok::<(), pleach_guards::NoDisjunctiveForm>(())
    /// ```
    pub fn by_cases(&self, limit: usize) -> Result<Predicate, NoDisjunctiveForm> {
        let parts = |parts: &[Predicate]| -> Result<Arc<[Predicate]>, NoDisjunctiveForm> {
            parts.iter().map(|part| part.by_cases(limit)).collect()
        };
        Ok(match self {
            Predicate::Comparison(comparison) => {
                let mut cases = Vec::new();
                split(Vec::new(), comparison, limit, &mut cases)?;
                Predicate::any(cases)
            }
            Predicate::Not(inner) => Predicate::Not(Arc::new(inner.by_cases(limit)?)),
            Predicate::All(conjuncts) => Predicate::All(parts(conjuncts)?),
            Predicate::Any(disjuncts) => Predicate::Any(parts(disjuncts)?),
            Predicate::Proposition(_) | Predicate::Function(_) => self.clone(),
        })
    }
}

/// Of a predicate in negation normal form.
fn disjuncts(
    predicate: &Predicate,
    limit: usize,
) -> Result<Vec<Vec<Comparison>>, NoDisjunctiveForm> {
    let found = match predicate {
        Predicate::Comparison(comparison) => vec![vec![comparison.clone()]],
        Predicate::All(parts) => parts.iter().try_fold(vec![vec![]], |product, part| {
            let factors = disjuncts(part, limit)?;
            if product.len().saturating_mul(factors.len()) > limit {
                return Err(NoDisjunctiveForm::TooLarge { limit });
            }
            let pairs = product
                .iter()
                .flat_map(|left| factors.iter().map(move |right| [&**left, right].concat()));
            Ok(pairs.collect())
        })?,
        Predicate::Any(parts) => parts.iter().try_fold(vec![], |mut sum, part| {
            sum.extend(disjuncts(part, limit)?);
            Ok(sum)
        })?,
        Predicate::Not(inner) => return disjuncts(inner, limit),
        Predicate::Proposition(name) => {
            return Err(NoDisjunctiveForm::Proposition { name: name.to_string() });
        }
        Predicate::Function(function) => {
            return Err(NoDisjunctiveForm::Function { name: function.name().to_string() });
        }
    };
    if found.len() > limit {
        return Err(NoDisjunctiveForm::TooLarge { limit });
    }
    Ok(found)
}

/// Adds the cases of `comparison`, each together with the conditions under which it stands.
fn split(
    conditions: Vec<Predicate>,
    comparison: &Comparison,
    limit: usize,
    cases: &mut Vec<Predicate>,
) -> Result<(), NoDisjunctiveForm> {
    let piece = comparison.left.first_piece().or_else(|| comparison.right.first_piece());
    let Some((piece, choices)) = piece.and_then(|piece| Some((piece, piece.choices()?))) else {
        if cases.len() == limit {
            return Err(NoDisjunctiveForm::TooLarge { limit });
        }
        let case = conditions.into_iter().chain([Predicate::Comparison(comparison.clone())]);
        cases.push(Predicate::all(case));
        return Ok(());
    };
    for (condition, choice) in choices {
        let conditions = conditions.iter().cloned().chain([condition]).collect();
        let chosen = Comparison {
            left: comparison.left.replace(piece, &choice),
            relation: comparison.relation,
            right: comparison.right.replace(piece, &choice),
        };
        split(conditions, &chosen, limit, cases)?;
    }
    Ok(())
}

impl Expression {
    /// A part that is piecewise and has no other such part in it.
    fn first_piece(&self) -> Option<&Expression> {
        // Operations come before their operands: the last piece has none in it.
        self.parts().filter(|part| part.is_piecewise()).last()
    }

    fn is_piecewise(&self) -> bool {
        match self {
            Expression::Unary(operator, _) => {
                matches!(operator, UnaryOperator::AbsoluteValue | UnaryOperator::Sign)
            }
            Expression::Binary(operator, ..) => {
                matches!(operator, BinaryOperator::Minimum | BinaryOperator::Maximum)
            }
            Expression::Lookup(table, _) => table.interpolation() != Interpolation::Flat,
            Expression::Choice(_) => true,
            Expression::Constant(_) | Expression::Variable(_) | Expression::Power(..) => false,
        }
    }

    /// What a piece can be, each with the condition under which it is that.
    fn choices(&self) -> Option<Vec<(Predicate, Expression)>> {
        Some(match self {
            Expression::Unary(UnaryOperator::AbsoluteValue, operand) => vec![
                (operand.at_least(0.0), (**operand).clone()),
                (operand.less_than(0.0), -&**operand),
            ],
            Expression::Unary(UnaryOperator::Sign, operand) => vec![
                (operand.more_than(0.0), constant(1.0)),
                (operand.less_than(0.0), constant(-1.0)),
                (operand.at_least(0.0) & operand.at_most(0.0), constant(0.0)),
            ],
            Expression::Binary(BinaryOperator::Minimum, left, right) => vec![
                (left.at_most(&**right), (**left).clone()),
                (left.more_than(&**right), (**right).clone()),
            ],
            Expression::Binary(BinaryOperator::Maximum, left, right) => vec![
                (left.at_least(&**right), (**left).clone()),
                (left.less_than(&**right), (**right).clone()),
            ],
            Expression::Lookup(table, place) => table.pieces(place)?,
            Expression::Choice(choice) => vec![
                (Predicate::Comparison(choice.condition.clone()), choice.then.clone()),
                (Predicate::Comparison(choice.condition.opposite()), choice.otherwise.clone()),
            ],
            _ => return None,
        })
    }

    fn replace(&self, part: &Expression, replacement: &Expression) -> Expression {
        let Ok(replaced) = self.fold(&mut |inner, operands| {
            Ok::<_, Infallible>(if inner == part {
                replacement.clone()
            } else {
                inner.with_operands(operands)
            })
        });
        replaced
    }
}

impl Comparison {
    /// The comparison that holds where this one does not.
    pub fn opposite(&self) -> Comparison {
        Comparison { relation: self.relation.opposite(), ..self.clone() }
    }
}

impl Relation {
    /// The relation of the pairs of numbers that are not in this one.
    pub fn opposite(self) -> Relation {
        match self {
            Relation::AtMost => Relation::MoreThan,
            Relation::LessThan => Relation::AtLeast,
            Relation::AtLeast => Relation::LessThan,
            Relation::MoreThan => Relation::AtMost,
        }
    }

    /// Whether equal numbers are not in the relation.
    pub fn is_strict(self) -> bool {
        matches!(self, Relation::LessThan | Relation::MoreThan)
    }
}

/// Why a predicate has no normal form of conjunctions and disjunctions of comparisons.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NoDisjunctiveForm {
    /// A named function is not made of comparisons.
    Function {
        /// Its name.
        name: String,
    },
    /// A proposition is not made of comparisons.
    Proposition {
        /// Its name.
        name: String,
    },
    /// There would be more parts than were allowed.
    TooLarge {
        /// How many were allowed.
        limit: usize,
    },
}

impl fmt::Display for NoDisjunctiveForm {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Function { name } => {
                write!(formatter, "the function `{name}` is not made of comparisons")
            }
            Self::Proposition { name } => {
                write!(formatter, "the proposition `{name}` is not made of comparisons")
            }
            Self::TooLarge { limit } => {
                write!(formatter, "the normal form has more than the {limit} parts allowed")
            }
        }
    }
}

impl Error for NoDisjunctiveForm {}
