//! `--set KEY=VALUE` and `--set KEY=FROM..TO:COUNT`: one value of a key, or many.

use pleach::scenario_file::Setting;
use std::str::FromStr;

/// A key with the values that it takes, one run for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    settings: Vec<Setting>,
}

/// The most values of one key.
const MOST_VALUES: usize = 100_000;

impl FromStr for Sweep {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let setting: Setting = text.parse().map_err(|error| format!("{error}"))?;
        let settings = match Range::of(setting.value())? {
            None => vec![setting],
            Some(range) => {
                range.values().into_iter().map(|value| setting.with_value(value)).collect()
            }
        };
        Ok(Self { settings })
    }
}

impl Sweep {
    /// How many combinations there are of a value of each sweep.
    pub(super) fn count(sweeps: &[Sweep]) -> usize {
        sweeps.iter().fold(1, |count, sweep| count.saturating_mul(sweep.settings.len()))
    }

    /// Every combination of a value of each sweep, the values of the last one changing first.
    pub(super) fn combinations(sweeps: &[Sweep]) -> Vec<Vec<Setting>> {
        sweeps.iter().fold(vec![Vec::new()], |combinations, sweep| {
            let extended = |combination: &Vec<Setting>, setting: &Setting| {
                combination.iter().chain([setting]).cloned().collect()
            };
            (combinations.iter())
                .flat_map(|combination| {
                    sweep.settings.iter().map(move |setting| extended(combination, setting))
                })
                .collect()
        })
    }
}

/// `FROM..TO:COUNT`: evenly spaced values, both ends among them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range {
    from: f64,
    to: f64,
    count: usize,
}

impl Range {
    /// The range that a value is, if it looks like one: dots stand before or behind a number.
    fn of(value: &str) -> Result<Option<Self>, String> {
        let Some((from, rest)) = value.split_once("..") else { return Ok(None) };
        let (to, count) = rest.split_once(':').unwrap_or((rest, ""));
        let [from, to, count] = [from, to, count].map(str::trim);
        let number = |text: &str| text.parse::<f64>().ok();
        if number(from).or(number(to)).is_none() {
            return Ok(None);
        }
        let wrong = |part: &str, text: &str, right: &str| {
            let what =
                if text.is_empty() { "is missing".to_owned() } else { format!("is {text:?}") };
            format!(
                "{value:?} is no range FROM..TO:COUNT, such as 0.01..0.03:5: {part} {what}, and must be \
                 {right}"
            )
        };
        let end = |part: &str, text: &str| {
            let finite = number(text).filter(|end| end.is_finite());
            finite.ok_or_else(|| wrong(part, text, "a number"))
        };
        let (from, to) = (end("FROM", from)?, end("TO", to)?);
        let counted = count.parse().ok().filter(|count| (2..=MOST_VALUES).contains(count));
        let right = format!("a whole number from 2 to {MOST_VALUES}");
        let count = counted.ok_or_else(|| wrong("COUNT", count, &right))?;
        Ok(Some(Self { from, to, count }))
    }

    /// The values as they are written, whole numbers without a point.
    fn values(self) -> Vec<String> {
        let Self { from, to, count } = self;
        let share = |index: usize| index as f64 / (count - 1) as f64;
        let value = |index: usize| shortened(from + (to - from) * share(index));
        let written = |value: f64| match value.fract() == 0.0 && value.abs() < 1e15 {
            true => format!("{value:.0}"),
            false => format!("{value:?}"),
        };
        (0..count).map(value).map(written).collect()
    }
}

/// A number without the rounding of its last digits: 0.35 for 0.35000000000000003.
fn shortened(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        let sweep: Sweep = text.parse().unwrap();
        sweep.settings.iter().map(|setting| setting.value().to_owned()).collect()
    }

    #[test]
    fn a_range_holds_both_ends_and_round_numbers() {
        assert_eq!(values("link.full_range=0.3..0.4:3"), ["0.3", "0.35", "0.4"]);
        assert_eq!(values("link.full_range=0.3..0.6:7")[1..3], ["0.35", "0.4"]);
        assert_eq!(values("control.max_steps=100..500:5")[1], "200");
        assert_eq!(values("control.period=-1..1:3"), ["-1", "0", "1"]);
        assert_eq!(values("control.period=5..10:3"), ["5", "7.5", "10"]);
        assert_eq!(values("control.routing_method=dual"), ["dual"]);
        assert_eq!(values("description=a..b: dots"), ["a..b: dots"]);
    }

    #[test]
    fn a_range_that_is_none_is_refused() {
        for (text, wrong) in [
            ("a=1..2", "COUNT is missing, and must be a whole number from 2 to 100000"),
            ("a=1..2:1", "COUNT is \"1\", and must be a whole number"),
            ("a=1..2:-3", "COUNT is \"-3\", and must be a whole number"),
            ("a=1..:3", "TO is missing, and must be a number"),
            ("a=nan..2:3", "FROM is \"nan\", and must be a number"),
            ("a=x..2:3", "FROM is \"x\", and must be a number"),
            ("a", "write KEY=VALUE"),
        ] {
            let said = text.parse::<Sweep>().unwrap_err();
            assert!(said.contains(wrong), "{text}: {said}");
        }
    }

    #[test]
    fn sweeps_are_combined() {
        let sweeps =
            ["a=1..2:2".parse().unwrap(), "b=3".parse().unwrap(), "c=5..6:2".parse().unwrap()];
        let written: Vec<Vec<String>> = Sweep::combinations(&sweeps)
            .iter()
            .map(|combination| combination.iter().map(Setting::to_string).collect())
            .collect();
        assert_eq!(written.len(), 4);
        assert_eq!(written[0], ["a=1", "b=3", "c=5"]);
        assert_eq!(written[1], ["a=1", "b=3", "c=6"]);
        assert_eq!(Sweep::combinations(&[]), [Vec::new()]);
    }
}
