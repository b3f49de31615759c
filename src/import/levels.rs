//! Levels of a building: one of them is imported.

use super::counted;
use super::features::Feature;
use std::collections::BTreeSet;

/// The properties that state on which levels a feature is.
const KEYS: [&str; 4] = ["level", "levels", "storey", "level_id"];
/// The most levels that "0-40" stands for.
const MOST: i32 = 1000;

/// The levels that features state, in order.
pub(super) struct Levels(Vec<String>);

impl Levels {
    pub(super) fn of(features: &[Feature]) -> Self {
        let levels: BTreeSet<String> = features.iter().filter_map(stated).flatten().collect();
        let mut levels: Vec<String> = levels.into_iter().collect();
        let number = |level: &String| level.parse().unwrap_or(f64::INFINITY);
        levels.sort_by(|one, other| number(one).total_cmp(&number(other)));
        Self(levels)
    }

    /// The features of a level, and of none in particular; of several levels one must be chosen.
    pub(super) fn choose(
        self,
        features: Vec<Feature>,
        chosen: Option<&str>,
    ) -> Result<(Vec<Feature>, Vec<String>), String> {
        let listed = self.0.join(", ");
        let chosen = match (chosen.map(normal), self.0.as_slice()) {
            (None, []) => return Ok((features, Vec::new())),
            (None, [only]) => only.clone(),
            (None, _) => {
                return Err(format!("the map has the levels {listed}: choose one with --level"));
            }
            (Some(level), levels) if levels.contains(&level) => level,
            (Some(level), []) => {
                return Err(format!("the map states no levels, and --level {level} asks for one"));
            }
            (Some(level), _) => {
                return Err(format!("the map has no level {level}: it has {listed}"));
            }
        };
        let count = features.len();
        let is_there =
            |feature: &Feature| stated(feature).is_none_or(|levels| levels.contains(&chosen));
        let features: Vec<Feature> = features.into_iter().filter(is_there).collect();
        let note = match count - features.len() {
            0 => None,
            others => Some(format!(
                "level {chosen} of {listed}: {} on other levels only",
                counted(others, "feature is", "features are")
            )),
        };
        Ok((features, note.into_iter().collect()))
    }
}

/// The levels that a feature states: one, several between semicolons, or from one to another.
fn stated(feature: &Feature) -> Option<Vec<String>> {
    let text = KEYS
        .iter()
        .find_map(|key| feature.properties.get(*key))
        .filter(|text| !text.trim().is_empty())?;
    Some(text.split(';').flat_map(levels).collect())
}

fn levels(text: &str) -> Vec<String> {
    // The hyphen of "-2--1" that separates is the one after a digit.
    let hyphens = text.char_indices().skip(1).filter(|(_, letter)| *letter == '-');
    let mut ranges = hyphens.filter_map(|(at, _)| {
        let [from, to] = [&text[..at], &text[at + 1..]].map(|end| end.trim().parse::<i32>().ok());
        Some((from?, to?)).filter(|(from, to)| from <= to && to.saturating_sub(*from) < MOST)
    });
    match ranges.next() {
        Some((from, to)) => (from..=to).map(|level| level.to_string()).collect(),
        None => vec![normal(text)],
    }
}

/// A level as it is compared: 1.0 is 1.
fn normal(text: &str) -> String {
    text.trim().parse().map_or_else(|_| text.trim().to_owned(), |number: f64| number.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_stand_alone_in_lists_and_in_ranges() {
        assert_eq!(levels("1.0"), ["1"]);
        assert_eq!(levels("-2--1"), ["-2", "-1"]);
        assert_eq!(levels("0-2"), ["0", "1", "2"]);
        assert_eq!(levels("L1-east"), ["L1-east"]);
    }
}
