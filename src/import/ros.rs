//! Maps of the ROS map server: a YAML file that names an image.

use super::ImportError;
use super::grid::Grid;
use super::image::{self, Alpha, Rule};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Reads the map that the keys of the file at `path` describe.
pub(super) fn read(path: &Path, keys: &Value) -> Result<Grid, ImportError> {
    let malformed = |problem| ImportError::Malformed { path: path.into(), problem };
    let cell = number(keys, "resolution", None).map_err(malformed)?;
    if cell <= 0.0 {
        return Err(malformed(format!("resolution: {cell} is not positive")));
    }
    let rule = rule(keys).map_err(malformed)?;
    let [x, y, yaw] = origin(keys).map_err(malformed)?;
    let mut grid = image::grid(&image_of(path, keys)?, &rule)?;
    (grid.cell, grid.origin, grid.yaw) = (cell, [x, y], yaw);
    Ok(grid)
}

/// The image that the keys of the file at `path` name.
pub(super) fn image_of(path: &Path, keys: &Value) -> Result<PathBuf, ImportError> {
    let missing =
        || ImportError::Malformed { path: path.into(), problem: "image is missing".into() };
    let image = keys["image"].as_str().ok_or_else(missing)?;
    Ok(path.parent().unwrap_or_else(|| Path::new("")).join(image))
}

fn rule(keys: &Value) -> Result<Rule, String> {
    let default = Rule::default();
    Ok(Rule {
        occupied_above: threshold(keys, "occupied_thresh", default.occupied_above)?,
        free_below: threshold(keys, "free_thresh", default.free_below)?,
        is_negated: keys["negate"] == true || number(keys, "negate", Some(0.0))? != 0.0,
        alpha: match keys["mode"].as_str().unwrap_or("trinary") {
            "trinary" => Alpha::IsAChannel,
            "scale" => Alpha::HidesTheCell,
            mode => return Err(format!("mode: {mode} maps are not read; trinary and scale are")),
        },
    })
}

fn number(keys: &Value, key: &str, default: Option<f64>) -> Result<f64, String> {
    match (&keys[key], default) {
        (Value::Null | Value::Bool(_), Some(default)) => Ok(default),
        (Value::Null, None) => Err(format!("{key} is missing")),
        (value, _) => value.as_f64().ok_or_else(|| format!("{key}: {value} is not a number")),
    }
}

fn threshold(keys: &Value, key: &str, default: f64) -> Result<f64, String> {
    let threshold = number(keys, key, Some(default))?;
    match (0.0..=1.0).contains(&threshold) {
        true => Ok(threshold),
        false => Err(format!(
            "{key} is {threshold}: it must be from 0 to 1, as cells are occupied from 0 (white) \
             to 1 (black)"
        )),
    }
}

/// Where the lower left corner lies, and by how much the map is turned; 0 by default.
fn origin(keys: &Value) -> Result<[f64; 3], String> {
    let origin = &keys["origin"];
    if origin.is_null() {
        return Ok([0.0; 3]);
    }
    let numbers = origin
        .as_array()
        .and_then(|list| list.iter().map(Value::as_f64).collect::<Option<Vec<f64>>>());
    (numbers.and_then(|numbers| numbers.try_into().ok()))
        .ok_or_else(|| format!("origin: {origin} is no list of three numbers [x, y, yaw]"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::yaml;

    #[test]
    fn keys_stand_in_lines_or_in_braces_with_quotes_or_without() {
        for text in [
            "---\n\"image\": 'a, b #1.pgm'\t# the picture: of a flat\n'origin':\n- -1\n- 2.5 # up\n- 0\n",
            "{image: \"a, b #1.pgm\", origin: [-1,2.5,0]}",
            "{\"image\":\"a, b #1.pgm\", # the picture\n \"origin\":[-1,\n2.5,0]\n}\n",
            "image: a, b #1.pgm\r\norigin: [-1, 2.5,\r\n 0]\r\n",
        ] {
            let keys = yaml(text).unwrap();
            let image = if text.starts_with("image") { "a, b" } else { "a, b #1.pgm" };
            assert_eq!(image_of(Path::new(""), &keys).unwrap(), Path::new(image), "{text}");
            assert_eq!(origin(&keys), Ok([-1.0, 2.5, 0.0]), "{text}");
        }
        let keys = yaml("image: bob's [1].pgm\nmode: scale\n").unwrap();
        assert_eq!(image_of(Path::new(""), &keys).unwrap(), Path::new("bob's [1].pgm"));
    }
}
