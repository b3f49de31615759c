//! Which names stand in text as they are, and which between backticks.

use std::fmt::{self, Write};

/// The words of the language that no name may be mistaken for.
///
/// The names of functions, such as `min`, are not among them: only an opening parenthesis makes a
/// word a function, and none ever follows a variable.
pub(crate) const RESERVED: [&str; 7] = ["always", "never", "and", "or", "not", "infinity", "NaN"];

/// The digits of an exponent, each at the place of its value.
pub(crate) const RAISED_DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// The sign of a negative exponent.
pub(crate) const RAISED_MINUS: char = '⁻';

/// What encloses a name that is not plain; in such a name it stands twice.
pub(crate) const QUOTE: char = '`';

/// Whether a plain name may begin with `letter`.
pub(crate) fn begins(letter: char) -> bool {
    letter.is_alphabetic() || letter == '_'
}

/// Whether `letter` may stand in a plain name: letters and digits of all scripts, subscripts,
/// underscores, dots, primes and accents, as in `heater.temperature`, `δ_0`, `x₁`, `x′` and `τ̇`.
pub(crate) fn continues(letter: char) -> bool {
    let accents = '\u{300}'..='\u{36f}';
    let is_sign = matches!(letter, '_' | '.' | '\'' | '′' | '″') || accents.contains(&letter);
    is_sign || letter.is_alphanumeric() && !RAISED_DIGITS.contains(&letter)
}

/// Writes `name`, between backticks unless it is plain.
pub(crate) fn write(out: &mut dyn Write, name: &str) -> fmt::Result {
    if is_plain(name) {
        return out.write_str(name);
    }
    out.write_char(QUOTE)?;
    for letter in name.chars() {
        if letter == QUOTE {
            out.write_char(QUOTE)?;
        }
        out.write_char(letter)?;
    }
    out.write_char(QUOTE)
}

fn is_plain(name: &str) -> bool {
    name.starts_with(begins) && name.chars().all(continues) && !RESERVED.contains(&name)
}
