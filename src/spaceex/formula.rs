//! What stands in invariants, flows, guards, assignments and sets of states.

use crate::guards::{Expression, Predicate};

/// How two sides compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    AtMost,
    LessThan,
    AtLeast,
    MoreThan,
    Equal,
    Assigned,
}

/// A part of a conjunction.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Clause {
    Compare {
        left: Side,
        relation: Relation,
        right: Side,
    },
    /// `loc(component) == location`
    Location {
        component: String,
        location: String,
    },
    Always,
    Never,
}

/// A side of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Side {
    Formula(Expression),
    /// `x'`: the rate of a variable, or its value after a jump.
    Primed(String),
}

impl Side {
    /// The name, if it is a variable and nothing else.
    pub(super) fn name(&self) -> Option<&str> {
        match self {
            Side::Formula(Expression::Variable(name)) => Some(name),
            Side::Formula(_) | Side::Primed(_) => None,
        }
    }
}

/// How many alternatives a condition may have.
const MOST_ALTERNATIVES: usize = 4096;

/// How deep parentheses may stand in each other: as deep as in a formula. The text of each level is read again, so that
/// the limit keeps the time proportional to the length of a condition.
const MOST_NESTED: usize = 100;

/// A condition as alternatives of clauses that hold together.
pub(super) fn alternatives(text: &str) -> Result<Vec<Vec<Clause>>, String> {
    if nesting(text) > MOST_NESTED {
        return Err(format!(
            "a condition has more than {MOST_NESTED} levels of parentheses: leave out those that change nothing"
        ));
    }
    alternatives_within(text)
}

/// How deep parentheses stand in each other.
fn nesting(text: &str) -> usize {
    let (mut depth, mut most) = (0usize, 0);
    for character in text.chars() {
        match character {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        most = most.max(depth);
    }
    most
}

/// The alternatives of a condition that is not nested too deep.
fn alternatives_within(text: &str) -> Result<Vec<Vec<Clause>>, String> {
    let text = stripped(text);
    if text.is_empty() {
        return Ok(vec![vec![]]);
    }
    let parts = split(text, '|');
    if parts.iter().any(|part| part.trim().is_empty()) {
        return Err(format!("`{text}` has an alternative that says nothing: leave out the `|`"));
    }
    if parts.len() > 1 {
        let parts = parts.into_iter().map(alternatives_within);
        return Ok(parts.collect::<Result<Vec<_>, _>>()?.concat());
    }
    let parts = split(text, '&');
    if parts.iter().any(|part| part.trim().is_empty()) {
        return Err(format!("`{text}` has a part that says nothing: leave out the `&`"));
    }
    if parts.len() > 1 {
        return parts.into_iter().try_fold(vec![vec![]], |mut product, part| {
            let factors = alternatives_within(part)?;
            if let [only] = &factors[..] {
                product.iter_mut().for_each(|clauses| clauses.extend_from_slice(only));
                return Ok(product);
            }
            if product.len() * factors.len() > MOST_ALTERNATIVES {
                return Err(format!(
                    "a condition comes to more than {MOST_ALTERNATIVES} alternatives where its parts with `|` are \
                     multiplied out: leave out those that others hold"
                ));
            }
            let pairs = product.iter().flat_map(|left: &Vec<Clause>| {
                factors.iter().map(move |right| [&left[..], right].concat())
            });
            Ok(pairs.collect())
        });
    }
    Ok(vec![comparisons(text)?])
}

/// A condition without alternatives.
pub(super) fn conjunction(text: &str) -> Result<Vec<Clause>, String> {
    match &alternatives(text)?[..] {
        [only] => Ok(only.clone()),
        _ => Err(format!(
            "`{}` has alternatives: make a location or a transition of each",
            text.trim()
        )),
    }
}

/// Without parentheses around all of it.
fn stripped(text: &str) -> &str {
    let text = text.trim();
    let Some(inner) = text.strip_prefix('(').and_then(|inner| inner.strip_suffix(')')) else {
        return text;
    };
    let mut depth = 0;
    for character in inner.chars() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            _ => {}
        }
        if depth < 0 {
            return text;
        }
    }
    // A factor in parentheses is no condition.
    let is_condition = inner.contains(['<', '>', '=', '&', '|']);
    if depth == 0 && is_condition { stripped(inner) } else { text }
}

/// The parts between single or doubled separators outside parentheses.
fn split(text: &str, separator: char) -> Vec<&str> {
    let (mut parts, mut begin, mut depth) = (Vec::new(), 0, 0);
    for (at, character) in text.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            one if one == separator && depth == 0 => {
                parts.push(&text[begin..at]);
                begin = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&text[begin..]);
    // `&&` and `||` leave nothing between their halves.
    let last = parts.len() - 1;
    let is_half = |at: usize, part: &str| part.is_empty() && at > 0 && at < last;
    let parts = parts.into_iter().enumerate();
    parts.filter(|(at, part)| !is_half(*at, part)).map(|(_, part)| part).collect()
}

/// a ≤ b, also in chains a ≤ b ≤ c.
fn comparisons(text: &str) -> Result<Vec<Clause>, String> {
    let text = text.trim();
    match text {
        "true" => return Ok(vec![Clause::Always]),
        "false" => return Ok(vec![Clause::Never]),
        _ => {}
    }
    let (mut sides, mut relations, mut begin, mut at) = (Vec::new(), Vec::new(), 0, 0);
    while at < text.len() {
        let rest = &text[at..];
        let found = [
            ("<=", Relation::AtMost),
            (">=", Relation::AtLeast),
            ("==", Relation::Equal),
            (":=", Relation::Assigned),
            ("<", Relation::LessThan),
            (">", Relation::MoreThan),
            ("=", Relation::Equal),
        ];
        match found.into_iter().find(|(symbol, _)| rest.starts_with(symbol)) {
            Some((symbol, relation)) => {
                sides.push(&text[begin..at]);
                relations.push(relation);
                at += symbol.len();
                begin = at;
            }
            None => at += rest.chars().next().map_or(1, char::len_utf8),
        }
    }
    sides.push(&text[begin..]);
    if relations.is_empty() {
        return Err(format!("`{text}` compares nothing: write it with <=, >=, == or :="));
    }
    if let [only] = &relations[..]
        && *only == Relation::Equal
        && let Some(component) = sides[0].trim().strip_prefix("loc(")
    {
        let Some(component) = component.trim_end().strip_suffix(')') else {
            return Err(format!("`{text}` lacks a parenthesis: write loc(component)==location"));
        };
        let (component, location) = (component.trim().to_owned(), sides[1].trim().to_owned());
        return Ok(vec![Clause::Location { component, location }]);
    }
    let sides = sides.into_iter().map(side).collect::<Result<Vec<_>, _>>()?;
    let clause = |(at, relation): (usize, &Relation)| Clause::Compare {
        left: sides[at].clone(),
        relation: *relation,
        right: sides[at + 1].clone(),
    };
    Ok(relations.iter().enumerate().map(clause).collect())
}

fn side(text: &str) -> Result<Side, String> {
    let text = text.trim();
    if let Some(name) = text.strip_suffix('\'') {
        return Ok(Side::Primed(name.trim().to_owned()));
    }
    let parsed = text.parse::<Expression>();
    parsed.map(Side::Formula).map_err(|error| format!("`{text}`: {error}"))
}

impl Relation {
    /// The same between the sides in the other order.
    pub(super) fn turned(self) -> Self {
        match self {
            Relation::AtMost => Relation::AtLeast,
            Relation::LessThan => Relation::MoreThan,
            Relation::AtLeast => Relation::AtMost,
            Relation::MoreThan => Relation::LessThan,
            Relation::Equal | Relation::Assigned => self,
        }
    }

    /// As a predicate; equality as two comparisons.
    pub(super) fn predicate(self, left: &Expression, right: &Expression) -> Predicate {
        match self {
            Relation::AtMost => left.at_most(right),
            Relation::LessThan => left.less_than(right),
            Relation::AtLeast => left.at_least(right),
            Relation::MoreThan => left.more_than(right),
            Relation::Equal | Relation::Assigned => left.at_most(right) & left.at_least(right),
        }
    }
}
