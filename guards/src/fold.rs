//! Expressions of any depth: visited, compared and dropped without exhausting the stack.
//!
//! A sum of a hundred thousand terms is an expression as deep as it has terms. Whatever is computed
//! from an expression is therefore a *fold*: a function that, given a part and what was computed
//! from its operands, says what is computed from the part. Down to a fixed depth folds call
//! themselves, which is fast; deeper parts wait on the heap.

use std::fmt;
use std::mem;
use std::sync::{Arc, LazyLock};

use crate::expression::{Choice, Expression};

/// How deep folds call themselves.
const LEVELS: u32 = 128;

/// The operands of a part of an expression, or what was computed from them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Operands<T> {
    None,
    One(T),
    Two(T, T),
    /// Both sides of the condition of a choice, and what it chooses from.
    Four([T; 4]),
}

impl Expression {
    pub(crate) fn operands(&self) -> Operands<&Expression> {
        match self {
            Expression::Constant(_) | Expression::Variable(_) => Operands::None,
            Expression::Unary(_, operand)
            | Expression::Power(operand, _)
            | Expression::Lookup(_, operand) => Operands::One(operand),
            Expression::Binary(_, left, right) => Operands::Two(left, right),
            Expression::Choice(choice) => Operands::Four(choice.parts()),
        }
    }

    /// What `step` computes from the expression, given what it computed from its operands.
    ///
    /// # Errors
    ///
    /// The first of `step`, from left to right.
    pub(crate) fn fold<'e, T, E>(
        &'e self,
        step: &mut impl FnMut(&'e Expression, Operands<T>) -> Result<T, E>,
    ) -> Result<T, E> {
        self.fold_within(LEVELS, step)
    }

    fn fold_within<'e, T, E>(
        &'e self,
        levels: u32,
        step: &mut impl FnMut(&'e Expression, Operands<T>) -> Result<T, E>,
    ) -> Result<T, E> {
        if levels == 0 {
            return self.fold_on_heap(step);
        }
        let mut inner = |operand: &'e Expression| operand.fold_within(levels - 1, step);
        let computed = match self.operands() {
            Operands::None => Operands::None,
            Operands::One(operand) => Operands::One(inner(operand)?),
            Operands::Two(left, right) => Operands::Two(inner(left)?, inner(right)?),
            Operands::Four([left, right, then, otherwise]) => {
                Operands::Four([inner(left)?, inner(right)?, inner(then)?, inner(otherwise)?])
            }
        };
        step(self, computed)
    }

    fn fold_on_heap<'e, T, E>(
        &'e self,
        step: &mut impl FnMut(&'e Expression, Operands<T>) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut visits = vec![Visit::Enter(self)];
        let mut computed: Vec<T> = Vec::new();
        while let Some(visit) = visits.pop() {
            let (part, operands) = match visit {
                Visit::Enter(part) => {
                    visits.push(Visit::Leave(part));
                    part.operands().push_reversed(&mut visits);
                    continue;
                }
                Visit::Leave(part) => (part, part.operands().taken_from(&mut computed)),
            };
            // What was pushed for the operands is there: every part leaves one result.
            let Some(operands) = operands else { break };
            computed.push(step(part, operands)?);
        }
        match computed.pop() {
            Some(result) => Ok(result),
            None => unreachable!("a fold leaves the result of the whole"),
        }
    }

    /// All parts, the whole included, each operation before its operands.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &Expression> {
        let mut open = vec![self];
        std::iter::from_fn(move || {
            let part = open.pop()?;
            open.extend(part.operands().listed().into_iter().flatten().copied());
            Some(part)
        })
    }

    /// The same operation on other operands.
    pub(crate) fn with_operands(&self, operands: Operands<Expression>) -> Expression {
        match (self, operands) {
            (Expression::Unary(operator, _), Operands::One(operand)) => {
                Expression::Unary(*operator, Arc::new(operand))
            }
            (Expression::Power(_, exponent), Operands::One(base)) => {
                Expression::Power(Arc::new(base), *exponent)
            }
            (Expression::Lookup(table, _), Operands::One(place)) => {
                Expression::Lookup(table.clone(), Arc::new(place))
            }
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                Expression::Binary(*operator, Arc::new(left), Arc::new(right))
            }
            (Expression::Choice(choice), Operands::Four(parts)) => {
                Expression::Choice(Arc::new(choice.with(parts)))
            }
            _ => self.clone(),
        }
    }

    /// Whether two parts are the same but for their operands.
    fn is_alike(&self, other: &Expression) -> bool {
        match (self, other) {
            (Expression::Constant(one), Expression::Constant(another)) => one == another,
            (Expression::Variable(one), Expression::Variable(another)) => one == another,
            (Expression::Unary(one, _), Expression::Unary(another, _)) => one == another,
            (Expression::Power(_, one), Expression::Power(_, another)) => one == another,
            (Expression::Lookup(one, _), Expression::Lookup(another, _)) => one == another,
            (Expression::Binary(one, ..), Expression::Binary(another, ..)) => one == another,
            (Expression::Choice(one), Expression::Choice(another)) => {
                one.condition.relation == another.condition.relation
            }
            _ => false,
        }
    }
}

/// A part that is still to be folded, or whose operands have been.
enum Visit<'e> {
    Enter(&'e Expression),
    Leave(&'e Expression),
}

impl<T> Operands<T> {
    pub(crate) fn map<U>(self, mut change: impl FnMut(T) -> U) -> Operands<U> {
        match self {
            Operands::None => Operands::None,
            Operands::One(operand) => Operands::One(change(operand)),
            Operands::Two(left, right) => Operands::Two(change(left), change(right)),
            Operands::Four(parts) => Operands::Four(parts.map(change)),
        }
    }

    pub(crate) fn map_ref<U>(&self, mut change: impl FnMut(&T) -> U) -> Operands<U> {
        match self {
            Operands::None => Operands::None,
            Operands::One(operand) => Operands::One(change(operand)),
            Operands::Two(left, right) => Operands::Two(change(left), change(right)),
            Operands::Four(parts) => Operands::Four(parts.each_ref().map(change)),
        }
    }

    /// In order; those that there are not are `None`.
    pub(crate) fn listed(&self) -> [Option<&T>; 4] {
        match self {
            Operands::None => [None; 4],
            Operands::One(operand) => [Some(operand), None, None, None],
            Operands::Two(left, right) => [Some(left), Some(right), None, None],
            Operands::Four(parts) => parts.each_ref().map(Some),
        }
    }

    /// The first from the left that is `wanted`.
    pub(crate) fn find(&self, wanted: impl Fn(&T) -> bool) -> Option<&T> {
        self.listed().into_iter().flatten().find(|operand| wanted(operand))
    }
}

impl<'e> Operands<&'e Expression> {
    fn push_reversed(self, visits: &mut Vec<Visit<'e>>) {
        match self {
            Operands::None => {}
            Operands::One(operand) => visits.push(Visit::Enter(operand)),
            Operands::Two(left, right) => visits.extend([right, left].map(Visit::Enter)),
            Operands::Four(parts) => visits.extend(parts.into_iter().rev().map(Visit::Enter)),
        }
    }

    /// As many results as there are operands, from the end of `computed`.
    fn taken_from<T>(self, computed: &mut Vec<T>) -> Option<Operands<T>> {
        Some(match self {
            Operands::None => Operands::None,
            Operands::One(_) => Operands::One(computed.pop()?),
            Operands::Two(..) => {
                let (right, left) = (computed.pop()?, computed.pop()?);
                Operands::Two(left, right)
            }
            Operands::Four(_) => {
                let mut next = || computed.pop();
                let (otherwise, then, right, left) = (next()?, next()?, next()?, next()?);
                Operands::Four([left, right, then, otherwise])
            }
        })
    }
}

impl Choice {
    fn parts(&self) -> [&Expression; 4] {
        [&self.condition.left, &self.condition.right, &self.then, &self.otherwise]
    }
}

impl PartialEq for Expression {
    /// Equal structure and equal numbers; NaN equals nothing.
    fn eq(&self, other: &Self) -> bool {
        if !self.is_alike(other) {
            return false;
        }
        let mut open = vec![(self, other)];
        while let Some((one, another)) = open.pop() {
            if !one.is_alike(another) {
                return false;
            }
            let (ones, others) = (one.operands(), another.operands());
            let pairs = ones.listed().into_iter().zip(others.listed());
            open.extend(pairs.filter_map(|(one, another)| Some((*one?, *another?))));
        }
        true
    }
}

impl fmt::Debug for Expression {
    /// The text of the expression, from which different structures can be told apart.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "`{self}`")
    }
}

/// What takes the place of an operand that is dropped by itself.
static NOTHING: LazyLock<Arc<Expression>> = LazyLock::new(|| Arc::new(Expression::Constant(0.0)));

impl Drop for Expression {
    /// Operands that nothing else shares are dropped one by one and not inside one another.
    fn drop(&mut self) {
        let mut open = Vec::new();
        self.give_up_operands(&mut open);
        while let Some(operand) = open.pop() {
            if let Some(mut inner) = Arc::into_inner(operand) {
                inner.give_up_operands(&mut open);
            }
        }
    }
}

impl Expression {
    /// Moves the operands that have operands themselves, and that nothing else shares, to `open`.
    fn give_up_operands(&mut self, open: &mut Vec<Arc<Expression>>) {
        let mut give_up = |operand: &mut Arc<Expression>| {
            let is_deep = |inner: &mut Expression| inner.operands() != Operands::None;
            if Arc::get_mut(operand).is_some_and(is_deep) {
                open.push(mem::replace(operand, NOTHING.clone()));
            }
        };
        match self {
            Expression::Constant(_) | Expression::Variable(_) => {}
            Expression::Unary(_, operand)
            | Expression::Power(operand, _)
            | Expression::Lookup(_, operand) => give_up(operand),
            Expression::Binary(_, left, right) => {
                give_up(left);
                give_up(right);
            }
            Expression::Choice(choice) => {
                if let Some(choice) = Arc::get_mut(choice) {
                    for part in choice.parts_mut() {
                        let part = mem::replace(part, Expression::Constant(0.0));
                        open.push(Arc::new(part));
                    }
                }
            }
        }
    }
}

impl Choice {
    fn parts_mut(&mut self) -> [&mut Expression; 4] {
        let Choice { condition, then, otherwise } = self;
        [&mut condition.left, &mut condition.right, then, otherwise]
    }
}
