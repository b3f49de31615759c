//! Maps of the ROS map server: a YAML file that names an image.
//!
//! A pixel becomes a cell as in the map server, in its mode `trinary` or `scale`: its channels are
//! averaged, and how dark the average is, from 0 for white to 1 for black, is the occupancy of the
//! cell (`negate` turns this round). Above `occupied_thresh` the cell is occupied, or else below
//! `free_thresh` free, or else unknown. Only free cells are floor.

use super::ImportError;
use super::grid::Grid;
use image::{DynamicImage, GenericImageView, ImageReader, Rgba};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Reads the map that the YAML text at `path` describes.
pub(super) fn read(path: &Path, text: &str) -> Result<Grid, ImportError> {
    let malformed = |problem| ImportError::Malformed { path: path.into(), problem };
    let keys = Keys::of(text);
    let cell = keys.number("resolution", None).map_err(malformed)?;
    if cell <= 0.0 {
        return Err(malformed(format!("resolution: {cell} is not positive")));
    }
    let rule = Rule::of(&keys).map_err(malformed)?;
    let origin = keys.origin().map_err(malformed)?;

    let picture = picture(&image_of(path, text)?)?;
    let free = rule.free_pixels(&picture);
    let grid = Grid::new(picture.width() as usize, picture.height() as usize, free);
    let mut grid = grid.map_err(malformed)?;
    (grid.cell, grid.origin, grid.yaw) = (cell, [origin[0], origin[1]], origin[2]);
    Ok(grid)
}

/// The image that the YAML text at `path` names.
pub(super) fn image_of(path: &Path, text: &str) -> Result<PathBuf, ImportError> {
    let keys = Keys::of(text);
    let image = keys.text("image");
    let image = image.map_err(|problem| ImportError::Malformed { path: path.into(), problem })?;
    Ok(path.parent().unwrap_or_else(|| Path::new("")).join(image))
}

fn picture(file: &Path) -> Result<DynamicImage, ImportError> {
    let unreadable = |source| ImportError::Unreadable { path: file.into(), source };
    let reader = ImageReader::open(file).and_then(ImageReader::with_guessed_format);
    reader.map_err(unreadable)?.decode().map_err(|error| ImportError::Malformed {
        path: file.into(),
        problem: format!("no image that can be read: {error}"),
    })
}

/// What makes a pixel a free cell.
struct Rule {
    occupied_above: f64,
    free_below: f64,
    is_negated: bool,
    alpha: Alpha,
}

/// What the transparency of a pixel means.
enum Alpha {
    /// It is averaged with the colours: mode `trinary`.
    IsAChannel,
    /// A cell of which anything shines through is unknown: mode `scale`.
    HidesTheCell,
}

impl Rule {
    fn of(keys: &Keys) -> Result<Self, String> {
        Ok(Self {
            occupied_above: keys.threshold("occupied_thresh", 0.65)?,
            free_below: keys.threshold("free_thresh", 0.196)?,
            is_negated: keys.number("negate", Some(0.0))? != 0.0,
            alpha: match keys.text("mode").unwrap_or("trinary") {
                "trinary" => Alpha::IsAChannel,
                "scale" => Alpha::HidesTheCell,
                mode => {
                    return Err(format!("mode: {mode} maps are not read; trinary and scale are"));
                }
            },
        })
    }

    /// Whether each pixel is a free cell, in rows from the top.
    fn free_pixels(&self, picture: &DynamicImage) -> Vec<bool> {
        let has_alpha = picture.color().has_alpha();
        picture.pixels().map(|(_, _, pixel)| self.is_free(pixel, has_alpha)).collect()
    }

    fn is_free(&self, Rgba([red, green, blue, alpha]): Rgba<u8>, has_alpha: bool) -> bool {
        let shade = match self.alpha {
            Alpha::IsAChannel if has_alpha => mean([red, green, blue, alpha]),
            Alpha::HidesTheCell if alpha < u8::MAX => return false,
            _ => mean([red, green, blue]),
        };
        let occupancy = if self.is_negated { shade / 255.0 } else { (255.0 - shade) / 255.0 };
        occupancy <= self.occupied_above && occupancy < self.free_below
    }
}

fn mean<const N: usize>(channels: [u8; N]) -> f64 {
    channels.map(f64::from).iter().sum::<f64>() / N as f64
}

/// The keys of a map with their values as text.
struct Keys(BTreeMap<String, String>);

impl Keys {
    fn of(text: &str) -> Self {
        Self(keys(text))
    }

    fn text(&self, key: &str) -> Result<&str, String> {
        self.0.get(key).map(String::as_str).ok_or_else(|| format!("{key} is missing"))
    }

    fn number(&self, key: &str, default: Option<f64>) -> Result<f64, String> {
        match (self.text(key), default) {
            (Ok(text), _) => (text.parse().ok())
                .filter(|number: &f64| number.is_finite())
                .ok_or_else(|| format!("{key}: {text:?} is not a number")),
            (Err(_), Some(default)) => Ok(default),
            (Err(missing), None) => Err(missing),
        }
    }

    fn threshold(&self, key: &str, default: f64) -> Result<f64, String> {
        let threshold = self.number(key, Some(default))?;
        match (0.0..=1.0).contains(&threshold) {
            true => Ok(threshold),
            false => Err(format!(
                "{key} is {threshold}: it must be from 0 to 1, as cells are occupied from 0 (white) \
                 to 1 (black)"
            )),
        }
    }

    /// Where the lower left corner lies, and by how much the map is turned; 0 by default.
    fn origin(&self) -> Result<[f64; 3], String> {
        let Ok(text) = self.text("origin") else { return Ok([0.0; 3]) };
        let numbers: Result<Vec<f64>, _> =
            text.split(',').map(|part| part.trim().parse()).collect();
        (numbers.ok().and_then(|numbers| numbers.try_into().ok()))
            .ok_or_else(|| format!("origin: {text:?} is no list of three numbers [x, y, yaw]"))
    }
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
