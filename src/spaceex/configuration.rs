//! The configuration: lines `key = value`.

use super::SpaceExError;
use super::formula::{self, Clause, Side};
use super::network::{Bound, Network};

/// A value with its line.
pub(super) type Line<T> = (usize, T);

/// Directions in which sets are bounded.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Bounded {
    /// Those of the axes.
    Box,
    /// Those between any two axes too.
    Octagon,
    /// Across the boundaries of linear constraints.
    Across(Vec<Clause>),
}

/// What a configuration says.
#[derive(Debug, Default)]
pub(super) struct Options {
    pub system: Option<Line<String>>,
    /// Alternatives of clauses that hold together.
    pub initially: Line<Vec<Vec<Clause>>>,
    pub forbidden: Line<Vec<Vec<Clause>>>,
    pub horizon: Option<f64>,
    pub step: Option<f64>,
    /// What is said of directions; all of it together.
    pub directions: Vec<Line<Bounded>>,
    pub jumps: Option<usize>,
    pub shown: Line<Vec<String>>,
}

/// A line up to the `#` of a comment, which is none between quotation marks.
fn without_comment(line: &str) -> &str {
    let mut is_quoted = false;
    let begins = line.find(|character| {
        is_quoted ^= character == '"';
        character == '#' && !is_quoted
    });
    begins.map_or(line, |at| &line[..at])
}

/// A line, with those after it up to the one that closes its quotation marks, if there is one.
fn to_closing_quote<'t>(
    first: &str,
    lines: &mut (impl Iterator<Item = (usize, &'t str)> + Clone),
) -> String {
    let is_open = |text: &str| without_comment(text).matches('"').count() % 2 == 1;
    let (mut joined, mut ahead) = (first.to_owned(), lines.clone());
    while is_open(&joined) {
        let Some((_, next)) = ahead.next() else { return first.to_owned() };
        joined.push(' ');
        joined.push_str(next);
    }
    *lines = ahead;
    joined
}

impl Options {
    pub(super) fn read(text: &str) -> Result<Self, SpaceExError> {
        let mut options = Options::default();
        let mut known: Vec<(String, usize)> = Vec::new();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut lines = (1..).zip(text.lines());
        while let Some((line, first)) = lines.next() {
            let wrong = |problem: String| SpaceExError::Configuration { line, problem };
            let content = to_closing_quote(first, &mut lines);
            let content = without_comment(&content).trim();
            if content.is_empty() || content.starts_with(';') {
                continue;
            }
            let Some((key, value)) = content.split_once('=') else {
                return Err(wrong(format!("`{content}` is no line `key = value`")));
            };
            let key = key.trim();
            let may_repeat = key == "directions";
            let before = known.iter().find(|(one, _)| one == key && !may_repeat);
            if let Some((_, first)) = before {
                return Err(wrong(format!(
                    "`{key}` stands in line {first} already: leave one out"
                )));
            }
            known.push((key.to_owned(), line));
            let value = unquoted(value).map_err(wrong)?;
            let number = || -> Result<f64, SpaceExError> {
                let number: f64 =
                    value.parse().map_err(|_| wrong(format!("`{value}` is not a number")))?;
                if number.is_nan() { Err(wrong("NaN is not a number".into())) } else { Ok(number) }
            };
            match key {
                "system" => options.system = Some((line, value.to_owned())),
                "initially" => {
                    options.initially = (line, formula::alternatives(value).map_err(wrong)?);
                }
                "forbidden" if value.is_empty() => {}
                "forbidden" => {
                    options.forbidden = (line, formula::alternatives(value).map_err(wrong)?);
                }
                "time-horizon" => match number()? {
                    horizon if horizon < 0.0 => options.horizon = Some(f64::INFINITY),
                    horizon => options.horizon = Some(horizon),
                },
                "sampling-time" | "flowpipe-tolerance-step" => match number()? {
                    step if step > 0.0 && step.is_finite() => options.step = Some(step),
                    _ => return Err(wrong(format!("{value} is no step: write more than 0"))),
                },
                "directions" => {
                    options.directions.push((line, Bounded::read(value).map_err(wrong)?));
                }
                "iter-max" | "max-iterations" => {
                    let limit: i64 = value
                        .parse()
                        .map_err(|_| wrong(format!("`{value}` is no whole number of jumps")))?;
                    // A negative limit is none.
                    options.jumps = usize::try_from(limit).ok();
                }
                "output-variables" => {
                    let shown = value.split(',').map(|name| name.trim().to_owned());
                    options.shown = (line, shown.filter(|name| !name.is_empty()).collect());
                }
                // Of other tools' methods and outputs.
                "scenario"
                | "additional-options"
                | "output-format"
                | "output-file"
                | "rel-err"
                | "abs-err"
                | "verbosity"
                | "set-aggregation"
                | "flowpipe-tolerance"
                | "flowpipe-tolerance-rel"
                | "clustering"
                | "intersection-error"
                | "intersection-error-rel"
                | "intersection-method"
                | "error-model"
                | "output-error"
                | "map-zero-duration-jump-sets"
                | "simu-init-sampling-points" => {}
                other => {
                    return Err(wrong(format!(
                        "`{other}` is no key known here: known are system, initially, forbidden, \
                     time-horizon, sampling-time, iter-max, directions and output-variables"
                    )));
                }
            }
        }
        if options.initially.1.is_empty() {
            let line = text.lines().count().max(1);
            let problem =
                "there is no `initially`: say where runs begin, as in `initially = \"x == 0\"`";
            return Err(SpaceExError::Configuration { line, problem: problem.into() });
        }
        Ok(options)
    }

    /// The same, in names of the whole network in place of those of its inner components.
    pub(super) fn in_names_of(mut self, network: &Network<'_>) -> Self {
        let clauses = [&mut self.initially.1, &mut self.forbidden.1].into_iter().flatten();
        let directions = self.directions.iter_mut().filter_map(|(_, bounded)| match bounded {
            Bounded::Across(clauses) => Some(clauses),
            Bounded::Box | Bounded::Octagon => None,
        });
        for clause in clauses.chain(directions).flatten() {
            let Clause::Compare { left, right, .. } = clause else { continue };
            for side in [left, right] {
                if let Side::Formula(formula) = side {
                    *formula = network.in_names_of_the_whole(formula);
                }
            }
        }
        for name in &mut self.shown.1 {
            if let Some(Bound::Name(global)) = network.inner.get(name) {
                name.clone_from(global);
            }
        }
        self
    }
}

impl Bounded {
    fn read(text: &str) -> Result<Self, String> {
        // Octagons stand in for uniform directions.
        let is_uniform = || {
            let count = text.strip_prefix("uni").and_then(|count| count.trim().parse().ok());
            count.is_some_and(|count: usize| count > 0)
        };
        if let Some(inner) = text.strip_prefix('{') {
            let inner =
                inner.strip_suffix('}').ok_or_else(|| format!("`{text}` lacks its `}}`"))?;
            return formula::conjunction(inner).map(Bounded::Across);
        }
        match text {
            "box" => Ok(Bounded::Box),
            "oct" => Ok(Bounded::Octagon),
            _ if is_uniform() => Ok(Bounded::Octagon),
            _ => Err(format!(
                "directions `{text}` are not known: box, oct, uni with a number, or linear constraints as \
                 {{x + y <= 0 & x <= 0}}"
            )),
        }
    }
}

/// What stands between quotes, or all if there are none.
fn unquoted(text: &str) -> Result<&str, String> {
    let text = text.trim();
    match (text.strip_prefix('"'), text.strip_suffix('"')) {
        (Some(_), Some(_)) if text.len() > 1 => Ok(text[1..text.len() - 1].trim()),
        (None, None) => Ok(text),
        _ => Err(format!("`{text}` has a single quotation mark: add the other")),
    }
}
