//! The configuration: lines `key = value`.

use super::SpaceExError;
use super::formula::{self, Clause};

/// A value with its line.
pub(super) type Line<T> = (usize, T);

/// What a configuration says.
#[derive(Debug, Default)]
pub(super) struct Options {
    pub system: Option<Line<String>>,
    /// Alternatives of clauses that hold together.
    pub initially: Line<Vec<Vec<Clause>>>,
    pub forbidden: Line<Vec<Vec<Clause>>>,
    pub horizon: Option<f64>,
    pub step: Option<f64>,
    pub directions: Option<Line<String>>,
    pub jumps: Option<usize>,
    pub shown: Line<Vec<String>>,
}

impl Options {
    pub fn read(text: &str) -> Result<Self, SpaceExError> {
        let mut options = Options { initially: (0, vec![vec![]]), ..Options::default() };
        let mut known: Vec<(&str, usize)> = Vec::new();
        for (line, content) in (1..).zip(text.lines()) {
            let wrong = |problem: String| SpaceExError::Configuration { line, problem };
            let content = content.trim();
            if content.is_empty() || content.starts_with('#') || content.starts_with(';') {
                continue;
            }
            let Some((key, value)) = content.split_once('=') else {
                return Err(wrong(format!("`{content}` is no line `key = value`")));
            };
            let key = key.trim();
            if let Some((_, first)) = known.iter().find(|(one, _)| *one == key) {
                return Err(wrong(format!(
                    "`{key}` stands in line {first} already: leave one out"
                )));
            }
            known.push((key, line));
            let value = unquoted(value).map_err(wrong)?;
            let number = || -> Result<f64, SpaceExError> {
                let number: f64 =
                    value.parse().map_err(|_| wrong(format!("`{value}` is no number")))?;
                if number.is_nan() { Err(wrong("NaN is no number".into())) } else { Ok(number) }
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
                    horizon if horizon >= 0.0 => options.horizon = Some(horizon),
                    _ => return Err(wrong(format!("{value} is no duration: write 0 or more"))),
                },
                "sampling-time" | "flowpipe-tolerance-step" => match number()? {
                    step if step > 0.0 && step.is_finite() => options.step = Some(step),
                    _ => return Err(wrong(format!("{value} is no step: write more than 0"))),
                },
                "directions" => options.directions = Some((line, value.to_owned())),
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
                | "output-format"
                | "output-file"
                | "rel-err"
                | "abs-err"
                | "verbosity"
                | "set-aggregation"
                | "flowpipe-tolerance"
                | "clustering"
                | "output-error"
                | "local-time-horizon"
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
        Ok(options)
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
