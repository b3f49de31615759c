//! The words, numbers and signs of which text consists.

use std::iter::Peekable;
use std::str::CharIndices;

use super::error::ParseError;
use crate::name::{self, QUOTE, RAISED_DIGITS, RAISED_MINUS};

/// A word, number or sign, whichever way it is spelled.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token {
    Number(f64),
    /// A whole exponent in raised digits.
    Raised(f64),
    /// A name as it stands, of a variable or of a function.
    Word(String),
    /// A name between backticks.
    Quoted(String),
    Plus,
    Minus,
    Times,
    Divide,
    Caret,
    Root,
    Bar,
    Open,
    Close,
    Comma,
    Ellipsis,
    AtMost,
    LessThan,
    AtLeast,
    MoreThan,
    Equality,
    Not,
    And,
    Or,
    Always,
    Never,
    End,
}

/// A token and where it stands.
#[derive(Clone, Debug)]
pub(super) struct Located<'a> {
    pub token: Token,
    /// The number of its first character, from 1.
    pub column: usize,
    /// How the text spells it.
    pub text: &'a str,
}

/// The tokens of `text`, the end as the last.
pub(super) fn tokens(text: &str) -> Result<Vec<Located<'_>>, ParseError> {
    let mut scanner = Scanner { text, letters: text.char_indices().peekable(), column: 1 };
    let mut tokens = Vec::new();
    loop {
        let located = scanner.next()?;
        let is_end = located.token == Token::End;
        tokens.push(located);
        if is_end {
            return Ok(tokens);
        }
    }
}

struct Scanner<'a> {
    text: &'a str,
    letters: Peekable<CharIndices<'a>>,
    column: usize,
}

impl<'a> Scanner<'a> {
    fn next(&mut self) -> Result<Located<'a>, ParseError> {
        self.take_while(char::is_whitespace);
        let (column, start) = (self.column, self.position());
        let token = self.token();
        let text = &self.text[start..self.position()];
        match token {
            Ok(token) => Ok(Located { token, column, text }),
            Err(expected) => Err(ParseError::new(column, expected, text)),
        }
    }

    /// The next token, or else what should stand in its place.
    fn token(&mut self) -> Result<Token, &'static str> {
        let Some(first) = self.take() else { return Ok(Token::End) };
        Ok(match first {
            '+' => Token::Plus,
            '-' | '−' => Token::Minus,
            '*' | '·' | '×' => Token::Times,
            '/' | '÷' => Token::Divide,
            '^' => Token::Caret,
            '√' => Token::Root,
            '|' => Token::Bar,
            '(' => Token::Open,
            ')' => Token::Close,
            ',' => Token::Comma,
            '…' => Token::Ellipsis,
            '∞' => Token::Number(f64::INFINITY),
            '≤' => Token::AtMost,
            '<' if self.take_if('=') => Token::AtMost,
            '<' => Token::LessThan,
            '≥' => Token::AtLeast,
            '>' if self.take_if('=') => Token::AtLeast,
            '>' => Token::MoreThan,
            '=' => {
                self.take_if('=');
                Token::Equality
            }
            '¬' | '!' => Token::Not,
            '∧' => Token::And,
            '&' if self.take_if('&') => Token::And,
            '&' => return Err("`&&` or `∧`"),
            '∨' => Token::Or,
            QUOTE => Token::Quoted(self.quoted()?),
            RAISED_MINUS => self.raised(String::from("-"))?,
            first if first.is_ascii_digit() || self.begins_fraction(first) => self.number(first)?,
            first if RAISED_DIGITS.contains(&first) => self.raised(raised_digit(first))?,
            first if name::begins(first) => self.word(first),
            _ => return Err("a number, a name, an operator or a parenthesis"),
        })
    }

    /// Whether a dot is followed by digits: `.5` is 0.5.
    fn begins_fraction(&mut self, first: char) -> bool {
        first == '.' && self.letters.peek().is_some_and(|(_, letter)| letter.is_ascii_digit())
    }

    fn number(&mut self, first: char) -> Result<Token, &'static str> {
        let mut digits = String::from(first);
        digits += &self.take_while(|letter| letter.is_ascii_digit());
        if first != '.' && self.take_if('.') {
            digits.push('.');
            digits += &self.take_while(|letter| letter.is_ascii_digit());
        }
        if self.take_if('e') || self.take_if('E') {
            digits.push('e');
            if self.take_if('-') {
                digits.push('-');
            } else {
                self.take_if('+');
            }
            digits += &self.take_while(|letter| letter.is_ascii_digit());
        }
        let value = digits.parse::<f64>().map_err(|_| "a number")?;
        if value.is_infinite() {
            return Err("a number of at most 1.7976931348623157e308, or `∞`");
        }
        Ok(Token::Number(value))
    }

    fn raised(&mut self, mut digits: String) -> Result<Token, &'static str> {
        let rest = self.take_while(|letter| RAISED_DIGITS.contains(&letter));
        rest.chars().for_each(|letter| digits += &raised_digit(letter));
        digits.parse().map(Token::Raised).map_err(|_| "raised digits")
    }

    fn word(&mut self, first: char) -> Token {
        let word = String::from(first) + &self.take_while(name::continues);
        match word.as_str() {
            "always" => Token::Always,
            "never" => Token::Never,
            "and" => Token::And,
            "or" => Token::Or,
            "not" => Token::Not,
            "infinity" => Token::Number(f64::INFINITY),
            "NaN" => Token::Number(f64::NAN),
            _ => Token::Word(word),
        }
    }

    /// The name up to the closing backtick.
    fn quoted(&mut self) -> Result<String, &'static str> {
        let mut name = String::new();
        loop {
            match self.take() {
                Some(QUOTE) if self.take_if(QUOTE) => name.push(QUOTE),
                Some(QUOTE) => return Ok(name),
                Some(letter) => name.push(letter),
                None => return Err("a closing backtick"),
            }
        }
    }

    fn position(&mut self) -> usize {
        self.letters.peek().map_or(self.text.len(), |(position, _)| *position)
    }

    fn take(&mut self) -> Option<char> {
        let (_, letter) = self.letters.next()?;
        self.column += 1;
        Some(letter)
    }

    fn take_if(&mut self, wanted: char) -> bool {
        let found = self.letters.peek().is_some_and(|(_, letter)| *letter == wanted);
        if found {
            self.take();
        }
        found
    }

    fn take_while(&mut self, wanted: impl Fn(char) -> bool) -> String {
        let mut taken = String::new();
        while let Some((_, letter)) = self.letters.next_if(|(_, letter)| wanted(*letter)) {
            self.column += 1;
            taken.push(letter);
        }
        taken
    }
}

/// The digit that `raised` lifts, as text.
fn raised_digit(raised: char) -> String {
    let value = RAISED_DIGITS.iter().position(|digit| *digit == raised);
    value.map(|value| value.to_string()).unwrap_or_default()
}
