//! Text read as expressions and predicates: what [`mod@crate::print`] writes, and spellings in
//! ASCII.
//!
//! Reading undoes printing: of every expression and predicate that is data, the text reads back
//! as that same structure and those same numbers. Nothing is simplified on the way, and
//! parentheses are structure: `(a ≤ 1 ∧ b ≤ 1) ∧ c ≤ 1` is a conjunction inside another.
//!
//! ```
//! use pleach_guards::{Predicate, variable};
//!
//! let guard: Predicate = "distance <= δ && not (still < 8)".parse()?;
//! assert_eq!(guard.to_string(), "distance ≤ δ ∧ ¬(still < 8)");
//!
//! let near = variable("distance").at_most(variable("δ"));
//! assert_eq!(guard, near.and(!variable("still").less_than(8.0)));
//! # Ok::<(), pleach_guards::ParseError>(())
//! ```
//!
//! # The grammar
//!
//! ```text
//! disjunction = conjunction { or conjunction }
//! conjunction = clause { and clause }
//! clause      = sum relation sum | statement
//! statement   = not statement | "always" | "never" | "(" disjunction ")" | name
//! sum         = term { ( "+" | minus ) term }
//! term        = minus term | factor { ( times | over ) factor }
//! factor      = minus factor | power
//! power       = atom [ raised digits | "^" exponent ] | "√" atom
//! exponent    = [ minus ] number | "(" [ minus ] number ")"
//! atom        = number | name | "(" sum ")" | "|" sum "|" | function "(" sum { "," sum } ")"
//!             | "if" "(" sum relation sum "," sum "," sum ")"
//!             | table "(" point "," { point "," } sum ")"
//! point       = "(" [ minus ] number "," [ minus ] number ")"
//! relation    = "≤" | "<=" | "<" | "≥" | ">=" | ">"
//! ```
//!
//! *or* is `∨`, `||` or `or`; *and* is `∧`, `&&` or `and`; *not* is `¬`, `!` or `not`; *minus* is
//! `−` or `-`; *times* is `·`, `×` or `*`; *over* is `÷` or `/`. The functions of one operand are
//! `abs`, `sqrt`, `sin`, `cos`, `tan`, `tanh`, `exp`, `ln`, `sign` and `floor`; `atan2` has two, and
//! `min` and `max` have two or more. A [table](crate::Table) is `linear` or `steps` (`flat` is the
//! slope of steps). A number is decimal, as `0.5` or `1e-3`, or `∞` (`infinity`) or `NaN`. A minus before a number that stands
//! alone belongs to the number.
//!
//! Text that nests more than 100 levels, or in which more than 1000 operations build on one another,
//! is refused, so that no text exhausts the stack; a longer sum is to be grouped by parentheses.
//!
//! A name begins with a letter or an underscore; letters, digits, subscripts, underscores, dots,
//! primes and accents follow. Any other name, and one that is a word of the language such as
//! `not`, stands between backticks, and a backtick in it stands twice.

mod arithmetic;
mod error;
mod tokens;

use std::borrow::Cow;
use std::str::FromStr;

use crate::expression::Expression;
use crate::predicate::{Comparison, Predicate, Relation, always, never, not, proposition};
pub use error::ParseError;
use tokens::{Located, Token, tokens};

/// How many parentheses, bars, roots and signs may stand inside one another, so that no text
/// exhausts the stack of the reader.
const NESTING_LIMIT: usize = 100;

const RELATION: &str = "`≤`, `<`, `≥` or `>` (for equality, compare |a − b| with a tolerance)";
const STATEMENT: &str = "`(`, `¬`, `always`, `never` or the name of a proposition";
const TRAILER: &str = "an operator or the end";

impl FromStr for Expression {
    type Err = ParseError;

    /// Reads the expression that `text` holds, in the [grammar](crate::parse) of a sum.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let mut reader = Reader::new(text)?;
        let sum = reader.sum()?;
        reader.expect(Token::End, TRAILER)?;
        Ok(sum.expression)
    }
}

impl FromStr for Predicate {
    type Err = ParseError;

    /// Reads the predicate that `text` holds, in the [grammar](crate::parse) of a disjunction.
    ///
    /// A [function](Predicate::function) cannot be read: its text holds no more than its name.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let mut reader = Reader::new(text)?;
        let disjunction = reader.disjunction()?;
        reader.expect(Token::End, TRAILER)?;
        Ok(disjunction)
    }
}

/// A reader by recursive descent, one method for each rule of the grammar.
struct Reader<'a> {
    tokens: Vec<Located<'a>>,
    position: usize,
    nesting: usize,
}

/// The rules of predicates.
impl Reader<'_> {
    fn disjunction(&mut self) -> Result<Predicate, ParseError> {
        let mut parts = vec![self.conjunction()?];
        while self.take_or() {
            parts.push(self.conjunction()?);
        }
        Ok(only(parts).unwrap_or_else(|parts| Predicate::Any(parts.into())))
    }

    fn conjunction(&mut self) -> Result<Predicate, ParseError> {
        let mut parts = vec![self.clause()?];
        while self.take(Token::And) {
            parts.push(self.clause()?);
        }
        Ok(only(parts).unwrap_or_else(|parts| Predicate::All(parts.into())))
    }

    fn clause(&mut self) -> Result<Predicate, ParseError> {
        self.refuse_function()?;
        let begins_statement = match self.token() {
            Token::Not | Token::Always | Token::Never => true,
            Token::Open => self.encloses_predicate(),
            Token::Word(_) | Token::Quoted(_) => self.is_proposition(),
            _ => false,
        };
        if begins_statement { self.statement() } else { self.comparison() }
    }

    fn statement(&mut self) -> Result<Predicate, ParseError> {
        if self.take(Token::Always) {
            Ok(always())
        } else if self.take(Token::Never) {
            Ok(never())
        } else if self.take(Token::Not) {
            self.nested(Self::statement).map(not)
        } else if let Token::Word(name) | Token::Quoted(name) = self.token()
            && self.is_proposition()
        {
            let named = proposition(name);
            self.position += 1;
            Ok(named)
        } else {
            self.expect(Token::Open, STATEMENT)?;
            let inner = self.nested(Self::disjunction)?;
            self.expect(Token::Close, "an operator or `)`")?;
            Ok(inner)
        }
    }

    fn comparison(&mut self) -> Result<Predicate, ParseError> {
        let left = self.sum()?.expression;
        let relation = self.relation()?;
        let right = self.sum()?.expression;
        Ok(Predicate::Comparison(Comparison { left, relation, right }))
    }

    fn relation(&mut self) -> Result<Relation, ParseError> {
        let relation = match self.token() {
            Token::AtMost => Relation::AtMost,
            Token::LessThan => Relation::LessThan,
            Token::AtLeast => Relation::AtLeast,
            Token::MoreThan => Relation::MoreThan,
            _ => return Err(self.expected(RELATION)),
        };
        self.position += 1;
        Ok(relation)
    }

    /// Takes an *or*. In its ASCII spelling it is two bars, but only here, after an operand, where
    /// no bar can open or close an absolute value.
    fn take_or(&mut self) -> bool {
        let are_bars = self.is_or_of_bars(0);
        if are_bars {
            self.position += 2;
        }
        are_bars || self.take(Token::Or)
    }

    /// Whether an *or* follows the tokens that are skipped, in the spelling of two bars.
    fn is_or_of_bars(&self, skipped: usize) -> bool {
        let at = self.position + skipped;
        self.follow(skipped, &[Token::Bar, Token::Bar])
            && self.tokens[at].column + 1 == self.tokens[at + 1].column
    }

    /// Whether the name here is a statement by itself: what follows ends it.
    fn is_proposition(&self) -> bool {
        let ends = [Token::And, Token::Or, Token::Close, Token::End];
        self.follow(1, &[Token::Bar, Token::Bar])
            || self.tokens.get(self.position + 1).is_some_and(|next| ends.contains(&next.token))
    }

    /// Whether the parentheses here begin with a name that is a statement by itself: what follows it ends it, behind
    /// parentheses that are closed.
    fn opens_with_proposition(&self) -> bool {
        let run = |skipped: usize, wanted: Token| {
            let following = self.tokens[self.position..].iter().skip(skipped);
            following.take_while(|located| located.token == wanted).count()
        };
        let name = run(0, Token::Open);
        let named = self.tokens.get(self.position + name).map(|located| &located.token);
        let next = name + 1 + run(name + 1, Token::Close);
        let ends = |end: Token| self.follow(next, &[end]);
        matches!(named, Some(Token::Word(_) | Token::Quoted(_)))
            && (self.is_or_of_bars(next)
                || [Token::And, Token::Or, Token::End].into_iter().any(ends))
    }

    /// Whether anything up to the matching parenthesis belongs to a predicate.
    fn encloses_predicate(&self) -> bool {
        if self.opens_with_proposition() {
            return true;
        }
        let mut open = 0;
        // How many of the parentheses around are those of a choice, whose condition is its own.
        let mut choices = Vec::new();
        let mut before = &Token::End;
        for Located { token, .. } in &self.tokens[self.position..] {
            let is_inside = !choices.is_empty();
            let is_choice = matches!(before, Token::Word(word) if word == "if");
            before = token;
            match token {
                Token::Open => {
                    open += 1;
                    choices.extend(is_choice.then_some(open));
                }
                Token::Close => {
                    choices.pop_if(|choice| *choice == open);
                    open -= 1;
                }
                _ if is_inside => {}
                Token::AtMost | Token::LessThan | Token::AtLeast | Token::MoreThan => return true,
                Token::Equality | Token::Ellipsis => return true,
                Token::Not | Token::And | Token::Or | Token::Always | Token::Never => return true,
                _ => {}
            }
            if open == 0 {
                return false;
            }
        }
        false
    }

    fn refuse_function(&self) -> Result<(), ParseError> {
        let is_name = matches!(self.token(), Token::Word(_) | Token::Quoted(_));
        if is_name && self.follow(1, &[Token::Open, Token::Ellipsis]) {
            return Err(self.expected("a comparison (a function can be given by code only)"));
        }
        Ok(())
    }
}

/// How tokens are read.
impl<'a> Reader<'a> {
    fn new(text: &'a str) -> Result<Self, ParseError> {
        Ok(Reader { tokens: tokens(text)?, position: 0, nesting: 0 })
    }

    /// The next token; no rule reads past the end.
    fn token(&self) -> &Token {
        &self.tokens[self.position].token
    }

    /// The next tokens.
    fn ahead<const N: usize>(&self) -> [Option<&Token>; N] {
        std::array::from_fn(|skipped| {
            self.tokens.get(self.position + skipped).map(|located| &located.token)
        })
    }

    /// Whether the `wanted` tokens follow after the next `skipped`.
    fn follow(&self, skipped: usize, wanted: &[Token]) -> bool {
        let following = self.tokens[self.position..].iter().skip(skipped);
        following.map(|located| &located.token).take(wanted.len()).eq(wanted)
    }

    fn take(&mut self, wanted: Token) -> bool {
        let found = *self.token() == wanted;
        if found {
            self.position += 1;
        }
        found
    }

    fn expect(&mut self, wanted: Token, expected: &'static str) -> Result<(), ParseError> {
        if self.take(wanted) { Ok(()) } else { Err(self.expected(expected)) }
    }

    fn expected(&self, expected: impl Into<Cow<'static, str>>) -> ParseError {
        let Located { column, text, .. } = self.tokens[self.position];
        ParseError::new(column, expected, text)
    }

    fn nested<T>(
        &mut self,
        rule: impl FnOnce(&mut Self) -> Result<T, ParseError>,
    ) -> Result<T, ParseError> {
        if self.nesting == NESTING_LIMIT {
            return Err(self.expected(format!("at most {NESTING_LIMIT} levels of nesting")));
        }
        self.nesting += 1;
        let inner = rule(self)?;
        self.nesting -= 1;
        Ok(inner)
    }
}

/// The one predicate of which `parts` consists, or else the parts themselves.
fn only(parts: Vec<Predicate>) -> Result<Predicate, Vec<Predicate>> {
    <[Predicate; 1]>::try_from(parts).map(|[only]| only)
}
