//! How expressions are laid out as text.
//!
//! What is still to be written waits in a list and not on the stack: an expression may be deep.

use std::fmt::{self, Write};

use super::Printer;
use super::notation::Notation;
use crate::expression::{BinaryOperator, Choice, Expression, UnaryOperator};
use crate::predicate::{Comparison, Relation};
use crate::table::Table;

/// How tightly the outermost operator of an expression binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

impl Binding {
    fn of(expression: &Expression) -> Binding {
        match expression {
            Expression::Constant(value) if value.is_sign_negative() => Binding::Sum,
            Expression::Unary(UnaryOperator::Negation, _) => Binding::Sum,
            Expression::Binary(..) if begins_negative(expression) => Binding::Sum,
            Expression::Binary(operator, ..) => match operator {
                BinaryOperator::Sum | BinaryOperator::Difference => Binding::Sum,
                BinaryOperator::Product | BinaryOperator::Quotient => Binding::Product,
                BinaryOperator::Minimum | BinaryOperator::Maximum | BinaryOperator::Angle => {
                    Binding::Atom
                }
            },
            Expression::Power(..) => Binding::Power,
            Expression::Constant(_)
            | Expression::Variable(_)
            | Expression::Unary(..)
            | Expression::Lookup(..)
            | Expression::Choice(_) => Binding::Atom,
        }
    }
}

/// The factor that a product or quotient begins with; of anything else, itself.
fn first_factor(mut expression: &Expression) -> &Expression {
    while let Expression::Binary(BinaryOperator::Product | BinaryOperator::Quotient, left, _) =
        expression
    {
        expression = left;
    }
    expression
}

/// Whether a number, product or quotient begins with a minus that belongs to a number.
fn begins_negative(expression: &Expression) -> bool {
    matches!(first_factor(expression), Expression::Constant(value) if value.is_sign_negative())
}

/// Something to be written.
enum Item<'e> {
    Text(&'static str),
    Number(f64),
    Exponent(f64),
    Name(&'e str),
    Expression(&'e Expression),
}

type Items<'e> = Vec<Item<'e>>;

impl Printer<'_> {
    pub(super) fn expression(&mut self, expression: &Expression) -> fmt::Result {
        let Printer { out, notation } = self;
        let mut waiting = vec![Item::Expression(expression)];
        while let Some(item) = waiting.pop() {
            match item {
                Item::Text(text) => out.write_str(text)?,
                Item::Number(value) => notation.write_number(*out, value)?,
                Item::Exponent(value) => (notation.write_exponent)(*out, value)?,
                Item::Name(name) => (notation.write_name)(*out, name)?,
                Item::Expression(part) => {
                    let known = waiting.len();
                    notation.lay_out(part, &mut waiting);
                    waiting[known..].reverse();
                }
            }
        }
        Ok(())
    }

    pub(super) fn relation(&mut self, relation: Relation) -> fmt::Result {
        self.out.write_str(self.notation.relation(relation))
    }
}

impl Notation {
    fn relation(&self, relation: Relation) -> &'static str {
        match relation {
            Relation::AtMost => self.at_most,
            Relation::LessThan => " < ",
            Relation::AtLeast => self.at_least,
            Relation::MoreThan => " > ",
        }
    }

    /// Adds what the expression consists of, in the order in which it is written.
    fn lay_out<'e>(&self, expression: &'e Expression, items: &mut Items<'e>) {
        match expression {
            Expression::Constant(value) => items.push(Item::Number(*value)),
            Expression::Variable(name) => items.push(Item::Name(name)),
            Expression::Unary(operator, operand) => self.unary(*operator, operand, items),
            Expression::Binary(operator, left, right) => {
                self.binary(*operator, expression, (left, right), items);
            }
            Expression::Power(base, exponent) if *exponent == 0.5 => self.root(base, items),
            Expression::Power(base, exponent) => {
                self.operand(base, Binding::Atom, items);
                items.push(Item::Exponent(*exponent));
            }
            Expression::Lookup(table, place) => self.lookup(table, place, items),
            Expression::Choice(choice) => self.choice(choice, items),
        }
    }

    fn unary<'e>(&self, operator: UnaryOperator, operand: &'e Expression, items: &mut Items<'e>) {
        let (name, brackets) = match operator {
            UnaryOperator::Negation => {
                items.push(Item::Text(self.minus));
                // A minus right before a number is a part of the number.
                let is_number = matches!(first_factor(operand), Expression::Constant(_));
                let is_loose = is_number || Binding::of(operand) < Binding::Product;
                return self.enclosed_if(is_loose, operand, items);
            }
            UnaryOperator::AbsoluteValue => ("", self.bars),
            UnaryOperator::Floor => self.floor,
            UnaryOperator::Sine => (self.sine, self.parentheses),
            UnaryOperator::Cosine => (self.cosine, self.parentheses),
            UnaryOperator::Tangent => (self.tangent, self.parentheses),
            UnaryOperator::HyperbolicTangent => (self.hyperbolic_tangent, self.parentheses),
            UnaryOperator::Exponential => (self.exponential, self.parentheses),
            UnaryOperator::Logarithm => (self.logarithm, self.parentheses),
            UnaryOperator::Sign => (self.sign, self.parentheses),
        };
        items.push(Item::Text(name));
        self.listed([operand], brackets, items);
    }

    fn binary<'e>(
        &self,
        operator: BinaryOperator,
        whole: &'e Expression,
        (left, right): (&'e Expression, &'e Expression),
        items: &mut Items<'e>,
    ) {
        let (symbol, least_left, least_right) = match operator {
            BinaryOperator::Sum => (" + ", Binding::Sum, Binding::Product),
            BinaryOperator::Difference => (self.difference, Binding::Sum, Binding::Product),
            BinaryOperator::Product => (self.product, Binding::Product, Binding::Power),
            BinaryOperator::Quotient => return self.quotient(left, right, items),
            BinaryOperator::Minimum => return self.extremum(self.minimum, whole, items),
            BinaryOperator::Maximum => return self.extremum(self.maximum, whole, items),
            BinaryOperator::Angle => {
                items.push(Item::Text(self.angle));
                return self.listed([left, right], self.parentheses, items);
            }
        };
        self.left_operand(left, least_left, items);
        items.push(Item::Text(symbol));
        self.operand(right, least_right, items);
    }

    /// The smallest or largest of all that is grouped to the left.
    fn extremum<'e>(&self, name: &'static str, mut whole: &'e Expression, items: &mut Items<'e>) {
        let Expression::Binary(operator, ..) = whole else { return };
        let mut operands = Vec::new();
        while let Expression::Binary(another, left, right) = whole
            && another == operator
        {
            operands.push(&**right);
            whole = left;
        }
        items.push(Item::Text(name));
        let operands = [whole].into_iter().chain(operands.into_iter().rev());
        self.listed(operands, self.parentheses, items);
    }

    /// What stands on the left may begin with a negative number.
    fn left_operand<'e>(&self, operand: &'e Expression, least: Binding, items: &mut Items<'e>) {
        let is_loose = Binding::of(operand) < least && !begins_negative(operand);
        self.enclosed_if(is_loose, operand, items);
    }

    fn operand<'e>(&self, operand: &'e Expression, least: Binding, items: &mut Items<'e>) {
        self.enclosed_if(Binding::of(operand) < least, operand, items);
    }

    fn quotient<'e>(&self, left: &'e Expression, right: &'e Expression, items: &mut Items<'e>) {
        match self.quotient {
            Some(symbol) => {
                self.left_operand(left, Binding::Product, items);
                items.push(Item::Text(symbol));
                self.operand(right, Binding::Power, items);
            }
            None => {
                items.push(Item::Text(r"\frac"));
                self.listed([left], ("{", "}"), items);
                self.listed([right], ("{", "}"), items);
            }
        }
    }

    fn root<'e>(&self, base: &'e Expression, items: &mut Items<'e>) {
        match self.root {
            Some(symbol) => {
                items.push(Item::Text(symbol));
                self.operand(base, Binding::Atom, items);
            }
            None => self.listed([base], (r"\sqrt{", "}"), items),
        }
    }

    /// The points of the table, then the place.
    fn lookup<'e>(&self, table: &'e Table, place: &'e Expression, items: &mut Items<'e>) {
        let (open, close) = self.parentheses;
        items.extend([Item::Text(self.table(table.interpolation())), Item::Text(open)]);
        for &(at, value) in table.points() {
            items.extend([Item::Text(open), Item::Number(at), Item::Text(", ")]);
            items.extend([Item::Number(value), Item::Text(close), Item::Text(", ")]);
        }
        items.extend([Item::Expression(place), Item::Text(close)]);
    }

    fn choice<'e>(&self, choice: &'e Choice, items: &mut Items<'e>) {
        let Choice { condition: Comparison { left, relation, right }, then, otherwise } = choice;
        let condition =
            [Item::Expression(left), Item::Text(self.relation(*relation)), Item::Expression(right)];
        let (then, otherwise) = (Item::Expression(then), Item::Expression(otherwise));
        match self.cases {
            None => {
                let (open, close) = self.parentheses;
                items.extend([Item::Text("if"), Item::Text(open)]);
                items.extend(condition);
                items.extend([Item::Text(", "), then, Item::Text(", "), otherwise]);
                items.push(Item::Text(close));
            }
            Some([begin, condition_mark, otherwise_mark, end]) => {
                items.extend([Item::Text(begin), then, Item::Text(condition_mark)]);
                items.extend(condition);
                items.extend([Item::Text(r" \\ "), otherwise, Item::Text(otherwise_mark)]);
                items.push(Item::Text(end));
            }
        }
    }

    fn enclosed_if<'e>(&self, needed: bool, expression: &'e Expression, items: &mut Items<'e>) {
        let brackets = if needed { self.parentheses } else { ("", "") };
        self.listed([expression], brackets, items);
    }

    fn listed<'e>(
        &self,
        operands: impl IntoIterator<Item = &'e Expression>,
        (open, close): (&'static str, &'static str),
        items: &mut Items<'e>,
    ) {
        items.push(Item::Text(open));
        for (position, operand) in operands.into_iter().enumerate() {
            items.extend((position > 0).then_some(Item::Text(", ")));
            items.push(Item::Expression(operand));
        }
        items.push(Item::Text(close));
    }
}
