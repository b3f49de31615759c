//! The rules of expressions.

use std::sync::Arc;

use super::Reader;
use super::error::ParseError;
use super::tokens::{Located, Token};
use crate::expression::{BinaryOperator, Choice, Expression, UnaryOperator, constant};
use crate::predicate::Comparison;
use crate::table::{Interpolation, Table};

/// How many operations may build on one another in an expression, such as the additions of a long
/// sum, so that no text makes an expression too deep to be evaluated, printed or dropped.
const HEIGHT_LIMIT: usize = 1000;

const OPERAND: &str = "a number, a name, `(`, `|`, `√` or `−`";
const CLOSING: &str = "an operator or `)`";
const SEPARATOR: &str = "an operator or `,`";
const FUNCTION: &str = "a function: abs, sqrt, sin, cos, tan, tanh, atan2, exp, ln, sign, floor, \
                        min, max, if, linear or steps";

/// An expression and how many operations in it build on one another.
pub(super) struct Tree {
    pub expression: Expression,
    height: usize,
}

impl Tree {
    fn leaf(expression: Expression) -> Self {
        Tree { expression, height: 0 }
    }
}

/// The rules of the grammar.
impl Reader<'_> {
    pub(super) fn sum(&mut self) -> Result<Tree, ParseError> {
        let mut sum = self.term()?;
        loop {
            let operator = match self.token() {
                Token::Plus => BinaryOperator::Sum,
                Token::Minus => BinaryOperator::Difference,
                _ => return Ok(sum),
            };
            self.position += 1;
            let term = self.term()?;
            sum = self.binary(operator, sum, term)?;
        }
    }

    /// A minus before a product belongs to all of it, but before a number to the number.
    fn term(&mut self) -> Result<Tree, ParseError> {
        let mut product = match self.negative_number() {
            Some(number) => number,
            None if self.take(Token::Minus) => return self.negation(Self::term),
            None => self.factor()?,
        };
        loop {
            let operator = match self.token() {
                Token::Times => BinaryOperator::Product,
                Token::Divide => BinaryOperator::Quotient,
                _ => return Ok(product),
            };
            self.position += 1;
            let factor = self.factor()?;
            product = self.binary(operator, product, factor)?;
        }
    }

    /// Takes a minus and a number, unless the number is raised to a power.
    fn negative_number(&mut self) -> Option<Tree> {
        let [minus, number, next] = self.ahead();
        match (minus, number, next) {
            (Some(Token::Minus), Some(Token::Number(_)), Some(Token::Raised(_) | Token::Caret)) => {
                None
            }
            (Some(Token::Minus), Some(&Token::Number(value)), _) => {
                self.position += 2;
                Some(Tree::leaf(constant(-value)))
            }
            _ => None,
        }
    }

    fn factor(&mut self) -> Result<Tree, ParseError> {
        if self.take(Token::Minus) { self.negation(Self::factor) } else { self.power() }
    }

    /// The negation of what `rule` reads; of a number that stands alone, the negative number.
    fn negation(
        &mut self,
        rule: fn(&mut Self) -> Result<Tree, ParseError>,
    ) -> Result<Tree, ParseError> {
        let start = self.position;
        let operand = self.nested(rule)?;
        match &operand.expression {
            Expression::Constant(value) if self.position == start + 1 => {
                Ok(Tree::leaf(constant(-value)))
            }
            _ => self.unary(UnaryOperator::Negation, operand),
        }
    }

    fn power(&mut self) -> Result<Tree, ParseError> {
        if self.take(Token::Root) {
            let base = self.nested(Self::atom)?;
            if matches!(self.token(), Token::Raised(_) | Token::Caret) {
                return Err(self.expected("parentheses that say which is first, root or power"));
            }
            return self.raise(base, 0.5);
        }
        let base = self.atom()?;
        if let Token::Raised(exponent) = *self.token() {
            self.position += 1;
            self.raise(base, exponent)
        } else if self.take(Token::Caret) {
            let exponent = self.exponent()?;
            self.raise(base, exponent)
        } else {
            Ok(base)
        }
    }

    fn exponent(&mut self) -> Result<f64, ParseError> {
        let is_enclosed = self.take(Token::Open);
        let is_negative = self.take(Token::Minus);
        let Token::Number(value) = *self.token() else {
            return Err(self.expected("a number as the exponent"));
        };
        self.position += 1;
        if is_enclosed {
            self.expect(Token::Close, "`)` after the exponent")?;
        }
        Ok(if is_negative { -value } else { value })
    }

    fn atom(&mut self) -> Result<Tree, ParseError> {
        let atom = match self.token() {
            Token::Number(value) => constant(*value),
            Token::Word(_) if self.follow(1, &[Token::Open]) => return self.function(),
            Token::Word(name) | Token::Quoted(name) => Expression::Variable(name.as_str().into()),
            Token::Open => return self.enclosed(Token::Close, CLOSING),
            Token::Bar => {
                let operand = self.enclosed(Token::Bar, "an operator or `|`")?;
                return self.unary(UnaryOperator::AbsoluteValue, operand);
            }
            _ => return Err(self.expected(OPERAND)),
        };
        self.position += 1;
        Ok(Tree::leaf(atom))
    }

    fn function(&mut self) -> Result<Tree, ParseError> {
        match self.tokens[self.position].text {
            "abs" => self.function_of_one(UnaryOperator::AbsoluteValue),
            "sin" => self.function_of_one(UnaryOperator::Sine),
            "cos" => self.function_of_one(UnaryOperator::Cosine),
            "tan" => self.function_of_one(UnaryOperator::Tangent),
            "tanh" => self.function_of_one(UnaryOperator::HyperbolicTangent),
            "exp" => self.function_of_one(UnaryOperator::Exponential),
            "ln" => self.function_of_one(UnaryOperator::Logarithm),
            "sign" => self.function_of_one(UnaryOperator::Sign),
            "floor" => self.function_of_one(UnaryOperator::Floor),
            "sqrt" => {
                self.position += 1;
                let base = self.enclosed(Token::Close, CLOSING)?;
                self.raise(base, 0.5)
            }
            "atan2" => self.angle(),
            "min" => self.extremum(BinaryOperator::Minimum),
            "max" => self.extremum(BinaryOperator::Maximum),
            "if" => self.choice(),
            "linear" => self.lookup(Interpolation::Linear),
            "steps" => self.lookup(Interpolation::Steps),
            "flat" => self.lookup(Interpolation::Flat),
            _ => Err(self.expected(FUNCTION)),
        }
    }

    fn function_of_one(&mut self, operator: UnaryOperator) -> Result<Tree, ParseError> {
        self.position += 1;
        let operand = self.enclosed(Token::Close, CLOSING)?;
        self.unary(operator, operand)
    }

    fn angle(&mut self) -> Result<Tree, ParseError> {
        self.position += 2;
        let left = self.nested(Self::sum)?;
        self.expect(Token::Comma, SEPARATOR)?;
        let right = self.nested(Self::sum)?;
        self.expect(Token::Close, CLOSING)?;
        self.binary(BinaryOperator::Angle, left, right)
    }

    /// Of two operands or more, grouped to the left.
    fn extremum(&mut self, operator: BinaryOperator) -> Result<Tree, ParseError> {
        self.position += 2;
        let mut extremum = self.nested(Self::sum)?;
        self.expect(Token::Comma, SEPARATOR)?;
        loop {
            let operand = self.nested(Self::sum)?;
            extremum = self.binary(operator, extremum, operand)?;
            if !self.take(Token::Comma) {
                break;
            }
        }
        self.expect(Token::Close, CLOSING)?;
        Ok(extremum)
    }

    fn choice(&mut self) -> Result<Tree, ParseError> {
        self.position += 2;
        let left = self.nested(Self::sum)?;
        let relation = self.relation()?;
        let right = self.nested(Self::sum)?;
        self.expect(Token::Comma, SEPARATOR)?;
        let then = self.nested(Self::sum)?;
        self.expect(Token::Comma, SEPARATOR)?;
        let otherwise = self.nested(Self::sum)?;
        self.expect(Token::Close, CLOSING)?;
        let parts = [left, right, then, otherwise];
        let below = parts.iter().map(|part| part.height).max().unwrap_or(0);
        let [left, right, then, otherwise] = parts.map(|part| part.expression);
        let condition = Comparison { left, relation, right };
        self.grown(Expression::Choice(Arc::new(Choice { condition, then, otherwise })), below)
    }

    /// The points of a table, then the place.
    fn lookup(&mut self, interpolation: Interpolation) -> Result<Tree, ParseError> {
        let start = self.position;
        self.position += 2;
        let mut points = Vec::new();
        while let Some(point) = self.point() {
            points.push(point);
            self.expect(Token::Comma, "`,` after a point of the table")?;
        }
        let table = Table::new(interpolation, points).map_err(|fault| {
            let Located { column, text, .. } = self.tokens[start];
            ParseError::new(column, format!("a table of points `(place, value)` ({fault})"), text)
        })?;
        let place = self.nested(Self::sum)?;
        self.expect(Token::Close, CLOSING)?;
        self.grown(Expression::Lookup(table, Arc::new(place.expression)), place.height)
    }

    /// Takes two numbers between parentheses, if they follow.
    fn point(&mut self) -> Option<(f64, f64)> {
        let start = self.position;
        let number = |reader: &mut Self| {
            let is_negative = reader.take(Token::Minus);
            let Token::Number(value) = *reader.token() else { return None };
            reader.position += 1;
            Some(if is_negative { -value } else { value })
        };
        let point = |reader: &mut Self| {
            let place = reader.take(Token::Open).then(|| number(reader))??;
            let value = reader.take(Token::Comma).then(|| number(reader))??;
            reader.take(Token::Close).then_some((place, value))
        };
        let point = point(self);
        if point.is_none() {
            self.position = start;
        }
        point
    }

    /// The sum between the token that opens here and the one that closes.
    fn enclosed(&mut self, close: Token, expected: &'static str) -> Result<Tree, ParseError> {
        self.position += 1;
        let inner = self.nested(Self::sum)?;
        self.expect(close, expected)?;
        Ok(inner)
    }
}

/// How trees grow.
impl Reader<'_> {
    fn unary(&self, operator: UnaryOperator, operand: Tree) -> Result<Tree, ParseError> {
        let expression = Expression::Unary(operator, Arc::new(operand.expression));
        self.grown(expression, operand.height)
    }

    fn binary(
        &self,
        operator: BinaryOperator,
        left: Tree,
        right: Tree,
    ) -> Result<Tree, ParseError> {
        let (left_operand, right_operand) = (Arc::new(left.expression), Arc::new(right.expression));
        let expression = Expression::Binary(operator, left_operand, right_operand);
        self.grown(expression, left.height.max(right.height))
    }

    fn raise(&self, base: Tree, exponent: f64) -> Result<Tree, ParseError> {
        self.grown(Expression::Power(Arc::new(base.expression), exponent), base.height)
    }

    fn grown(&self, expression: Expression, below: usize) -> Result<Tree, ParseError> {
        if below == HEIGHT_LIMIT {
            let limit = format!("at most {HEIGHT_LIMIT} operations that build on one another");
            return Err(self.expected(limit));
        }
        Ok(Tree { expression, height: below + 1 })
    }
}
