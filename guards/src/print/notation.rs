//! The two notations: which symbols they use, and how they write names, numbers and exponents.

use std::fmt::{self, Write};

use crate::name::{self, RAISED_DIGITS, RAISED_MINUS};
use crate::table::Interpolation;

/// What differs between text and LaTeX.
pub(super) struct Notation {
    pub always: &'static str,
    pub never: &'static str,
    pub not: &'static str,
    pub and: &'static str,
    pub or: &'static str,
    pub at_most: &'static str,
    pub at_least: &'static str,
    pub minus: &'static str,
    pub difference: &'static str,
    pub product: &'static str,
    /// Between the operands; without it, a quotient is a fraction.
    pub quotient: Option<&'static str>,
    /// Before the operand; without it, a root spans its operand.
    pub root: Option<&'static str>,
    pub minimum: &'static str,
    pub maximum: &'static str,
    pub sine: &'static str,
    pub cosine: &'static str,
    pub tangent: &'static str,
    pub hyperbolic_tangent: &'static str,
    pub angle: &'static str,
    pub sign: &'static str,
    /// Before the operand, and what encloses it.
    pub floor: (&'static str, (&'static str, &'static str)),
    /// The names of tables of lines, of steps, and of the slopes of steps.
    pub tables: [&'static str; 3],
    /// What begins a choice, what stands before its condition and before its other part, and what
    /// ends it; without it, a choice is written as a function.
    pub cases: Option<[&'static str; 4]>,
    pub exponential: &'static str,
    pub logarithm: &'static str,
    pub ellipsis: &'static str,
    pub infinity: &'static str,
    pub parentheses: (&'static str, &'static str),
    pub bars: (&'static str, &'static str),
    pub write_name: fn(&mut dyn Write, &str) -> fmt::Result,
    pub write_exponent: fn(&mut dyn Write, f64) -> fmt::Result,
}

pub(super) static TEXT: Notation = Notation {
    always: "always",
    never: "never",
    not: "¬",
    and: " ∧ ",
    or: " ∨ ",
    at_most: " ≤ ",
    at_least: " ≥ ",
    minus: "−",
    difference: " − ",
    product: " · ",
    quotient: Some(" ÷ "),
    root: Some("√"),
    minimum: "min",
    maximum: "max",
    sine: "sin",
    cosine: "cos",
    tangent: "tan",
    hyperbolic_tangent: "tanh",
    angle: "atan2",
    sign: "sign",
    floor: ("floor", ("(", ")")),
    tables: ["linear", "steps", "flat"],
    cases: None,
    exponential: "exp",
    logarithm: "ln",
    ellipsis: "…",
    infinity: "∞",
    parentheses: ("(", ")"),
    bars: ("|", "|"),
    write_name: name::write,
    write_exponent: write_raised,
};

pub(super) static LATEX: Notation = Notation {
    always: r"\top",
    never: r"\bot",
    not: r"\lnot ",
    and: r" \land ",
    or: r" \lor ",
    at_most: r" \le ",
    at_least: r" \ge ",
    minus: "-",
    difference: " - ",
    product: r" \cdot ",
    quotient: None,
    root: None,
    minimum: r"\min",
    maximum: r"\max",
    sine: r"\sin",
    cosine: r"\cos",
    tangent: r"\tan",
    hyperbolic_tangent: r"\tanh",
    angle: r"\operatorname{atan2}",
    sign: r"\operatorname{sign}",
    floor: ("", (r"\left\lfloor ", r"\right\rfloor ")),
    tables: [r"\operatorname{linear}", r"\operatorname{steps}", r"\operatorname{flat}"],
    cases: Some([r"\begin{cases}", r" & \text{if } ", r" & \text{otherwise}", r"\end{cases}"]),
    exponential: r"\exp",
    logarithm: r"\ln",
    ellipsis: r"\ldots",
    infinity: r"\infty",
    parentheses: (r"\left(", r"\right)"),
    bars: (r"\left|", r"\right|"),
    write_name: write_latex_name,
    write_exponent: |out, exponent| {
        out.write_str("^{")?;
        LATEX.write_number(out, exponent)?;
        out.write_char('}')
    },
};

impl Notation {
    pub(super) fn table(&self, interpolation: Interpolation) -> &'static str {
        let [linear, steps, flat] = self.tables;
        match interpolation {
            Interpolation::Linear => linear,
            Interpolation::Steps => steps,
            Interpolation::Flat => flat,
        }
    }

    /// The shortest decimal that reads back as `value`.
    pub(super) fn write_number(&self, out: &mut dyn Write, value: f64) -> fmt::Result {
        if value.is_sign_negative() {
            out.write_str(self.minus)?;
        }
        if value.is_infinite() {
            out.write_str(self.infinity)
        } else {
            write!(out, "{}", value.abs())
        }
    }
}

/// Whole exponents are raised; others follow a caret.
fn write_raised(out: &mut dyn Write, exponent: f64) -> fmt::Result {
    if exponent.fract() != 0.0 {
        let (open, close) = if exponent.is_sign_negative() { ("^(", ")") } else { ("^", "") };
        out.write_str(open)?;
        TEXT.write_number(out, exponent)?;
        return out.write_str(close);
    }
    for character in exponent.to_string().chars() {
        out.write_char(raised(character))?;
    }
    Ok(())
}

/// The digit or sign as it stands in an exponent.
fn raised(character: char) -> char {
    let digit = character.to_digit(10).and_then(|digit| RAISED_DIGITS.get(digit as usize));
    *digit.unwrap_or(&RAISED_MINUS)
}

/// What follows the first underscore is a subscript.
fn write_latex_name(out: &mut dyn Write, name: &str) -> fmt::Result {
    match name.split_once('_') {
        None => write_latex_word(out, name),
        Some((stem, subscript)) => {
            write_latex_word(out, stem)?;
            out.write_str("_{")?;
            write_latex_word(out, subscript)?;
            out.write_char('}')
        }
    }
}

/// A letter stands by itself, and Greek ones become their commands; words are set as one word.
fn write_latex_word(out: &mut dyn Write, word: &str) -> fmt::Result {
    let mut letters = word.chars();
    match (letters.next(), letters.next()) {
        (Some(letter), None) => match greek(letter) {
            Some(command) => out.write_str(command),
            None => write_latex_letter(out, letter),
        },
        _ if word.bytes().all(|byte| byte.is_ascii_digit()) => out.write_str(word),
        _ => {
            out.write_str(r"\mathit{")?;
            word.chars().try_for_each(|letter| write_latex_letter(out, letter))?;
            out.write_char('}')
        }
    }
}

fn write_latex_letter(out: &mut dyn Write, letter: char) -> fmt::Result {
    match (letter, greek(letter)) {
        (_, Some(command)) => write!(out, "{command} "),
        ('_' | '%' | '&' | '#' | '$' | '{' | '}', None) => write!(out, r"\{letter}"),
        (' ', None) => out.write_str(r"\ "),
        (other, None) => out.write_char(other),
    }
}

fn greek(letter: char) -> Option<&'static str> {
    Some(match letter {
        'α' => r"\alpha",
        'β' => r"\beta",
        'γ' => r"\gamma",
        'δ' => r"\delta",
        'ε' => r"\varepsilon",
        'ζ' => r"\zeta",
        'η' => r"\eta",
        'θ' => r"\theta",
        'κ' => r"\kappa",
        'λ' => r"\lambda",
        'μ' => r"\mu",
        'ν' => r"\nu",
        'ξ' => r"\xi",
        'π' => r"\pi",
        'ρ' => r"\rho",
        'σ' => r"\sigma",
        'τ' => r"\tau",
        'φ' => r"\varphi",
        'χ' => r"\chi",
        'ψ' => r"\psi",
        'ω' => r"\omega",
        'Γ' => r"\Gamma",
        'Δ' => r"\Delta",
        'Θ' => r"\Theta",
        'Λ' => r"\Lambda",
        'Σ' => r"\Sigma",
        'Φ' => r"\Phi",
        'Ψ' => r"\Psi",
        'Ω' => r"\Omega",
        _ => return None,
    })
}
