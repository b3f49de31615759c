//! Maps of the ROS map server: a YAML file that names an image.

use super::ImportError;
use super::grid::Grid;
use image::ImageReader;
use std::collections::BTreeMap;
use std::path::Path;

/// Reads the map that the YAML text at `path` describes.
///
/// A pixel is free if it is lighter than `free_thresh` demands; occupied and unknown ones are
/// walls.
pub(super) fn read(path: &Path, text: &str) -> Result<Grid, ImportError> {
    let malformed = |problem| ImportError::Malformed { path: path.into(), problem };
    let keys = keys(text);
    let number = |key: &str, default: Option<f64>| match (keys.get(key), default) {
        (Some(text), _) => text
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
            .ok_or_else(|| malformed(format!("{key}: {text:?} is not a number"))),
        (None, Some(default)) => Ok(default),
        (None, None) => Err(malformed(format!("{key} is missing"))),
    };
    let image = keys.get("image").ok_or_else(|| malformed("image is missing".into()))?;
    let cell = number("resolution", None)?;
    if cell <= 0.0 {
        return Err(malformed(format!("resolution: {cell} is not positive")));
    }
    let free_below = number("free_thresh", Some(0.196))?;
    let is_negated = number("negate", Some(0.0))? != 0.0;
    if keys.get("mode").is_some_and(|mode| mode == "raw") {
        return Err(malformed("mode: raw maps are not read; trinary and scale are".into()));
    }
    let origin = keys.get("origin").map_or(Ok(vec![0.0; 3]), |text| {
        let numbers: Result<Vec<f64>, _> =
            text.split(',').map(|part| part.trim().parse()).collect();
        numbers.ok().filter(|numbers| numbers.len() == 3).ok_or_else(|| {
            malformed(format!("origin: {text:?} is no list of three numbers [x, y, yaw]"))
        })
    })?;

    let file = path.parent().unwrap_or_else(|| Path::new("")).join(image);
    let unreadable = |source| ImportError::Unreadable { path: file.clone(), source };
    let pixels = ImageReader::open(&file)
        .map_err(unreadable)?
        .with_guessed_format()
        .map_err(unreadable)?
        .decode()
        .map_err(|error| ImportError::Malformed {
            path: file.clone(),
            problem: format!("no image that can be read: {error}"),
        })?
        .to_luma8();
    let occupied = |shade: u8| {
        let light = f64::from(shade) / 255.0;
        if is_negated { light } else { 1.0 - light }
    };
    let free: Vec<bool> = pixels.pixels().map(|pixel| occupied(pixel.0[0]) < free_below).collect();
    let grid = Grid::new(pixels.width() as usize, pixels.height() as usize, free);
    let mut grid = grid.map_err(malformed)?;
    (grid.cell, grid.origin, grid.yaw) = (cell, [origin[0], origin[1]], origin[2]);
    Ok(grid)
}

/// The keys of a flat YAML file; a list is given as its elements with commas between them.
fn keys(text: &str) -> BTreeMap<String, String> {
    let mut keys: BTreeMap<String, String> = BTreeMap::new();
    let mut last = String::new();
    for line in text.lines() {
        let line = line.split(" #").next().unwrap_or_default();
        let bare = |text: &str| text.trim().trim_matches(['[', ']', '"', '\'']).trim().to_owned();
        if let Some(element) = line.trim_start().strip_prefix("- ") {
            let list = keys.entry(last.clone()).or_default();
            let separator = if list.is_empty() { "" } else { "," };
            *list = format!("{list}{separator}{}", bare(element));
        } else if let Some((key, value)) = line.split_once(':') {
            last = key.trim().to_owned();
            keys.insert(last.clone(), bare(value));
        }
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_stand_on_one_line_or_on_several() {
        let text = "image: \"a.pgm\"  # the picture\norigin: [-1, 2.5, 0]\nother:\n- 1\n- 2\n";
        let keys = keys(text);
        assert_eq!(keys["image"], "a.pgm");
        assert_eq!(keys["origin"], "-1, 2.5, 0");
        assert_eq!(keys["other"], "1,2");
    }
}
