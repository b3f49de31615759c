//! Maps of the ROS map server: a YAML file that names an image.
//!
//! A pixel becomes a cell as in the map server, in its mode `trinary` or `scale`: its channels are
//! averaged, and how dark the average is, from 0 for white to 1 for black, is the occupancy of the
//! cell (`negate` turns this round). Above `occupied_thresh` the cell is occupied, or else below
//! `free_thresh` free, or else unknown. Only free cells are floor.

use super::grid::Grid;
use super::{ImportError, finite};
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
            (Ok(text), _) => finite(text).ok_or_else(|| format!("{key}: {text:?} is not a number")),
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
        let numbers: Option<Vec<f64>> = text.split(',').map(|part| finite(part.trim())).collect();
        (numbers.and_then(|numbers| numbers.try_into().ok()))
            .ok_or_else(|| format!("origin: {text:?} is no list of three numbers [x, y, yaw]"))
    }
}

/// The keys of a YAML file whose values are texts, numbers and lists of numbers; a list is given as its elements with
/// commas between them. Keys stand one a line or together in braces, and lists in brackets or one element a line.
fn keys(text: &str) -> BTreeMap<String, String> {
    let lines: Vec<&str> = text.lines().map(without_comment).collect();
    let text = lines.join("\n");
    let mut keys: BTreeMap<String, String> = BTreeMap::new();
    let mut last = String::new();
    for entry in parts(&text, '\n').into_iter().flat_map(entries) {
        if let Some(element) = entry.trim_start().strip_prefix("- ") {
            let list = keys.entry(last.clone()).or_default();
            let separator = if list.is_empty() { "" } else { "," };
            *list = format!("{list}{separator}{}", bare(element));
        } else if let Some(colon) = find(entry, |depth, _, letter| depth == 0 && letter == ':') {
            last = bare(&entry[..colon]).to_owned();
            keys.insert(last.clone(), bare(&entry[colon + 1..]).to_owned());
        }
    }
    keys
}

/// What a line says, each key by itself.
fn entries(line: &str) -> Vec<&str> {
    match inside(line.trim(), ['{', '}']) {
        Some(entries) => parts(entries, ','),
        None => vec![line],
    }
}

/// A value without quotes, a list without brackets.
fn bare(text: &str) -> &str {
    let text = text.trim();
    let marks = [['"', '"'], ['\'', '\''], ['[', ']']];
    marks.into_iter().find_map(|marks| inside(text, marks)).unwrap_or(text).trim()
}

fn inside(text: &str, [open, close]: [char; 2]) -> Option<&str> {
    text.strip_prefix(open)?.strip_suffix(close)
}

fn without_comment(line: &str) -> &str {
    let start = find(line, |_, before, letter| letter == '#' && before.is_whitespace());
    &line[..start.unwrap_or(line.len())]
}

/// The parts of a text between separators; those in quotes or brackets separate nothing.
fn parts(text: &str, separator: char) -> Vec<&str> {
    let (mut parts, mut rest) = (Vec::new(), text);
    while let Some(end) = find(rest, |depth, _, letter| depth == 0 && letter == separator) {
        parts.push(&rest[..end]);
        rest = &rest[end + separator.len_utf8()..];
    }
    parts.push(rest);
    parts
}

/// Where the first character outside of quotes stands that is wanted; this is asked with the depth in brackets and the
/// character before. Quotes and brackets open where a key or a value starts; within a word they are letters.
fn find(text: &str, is_wanted: impl Fn(usize, char, char) -> bool) -> Option<usize> {
    let (mut quote, mut depth, mut before) = (None, 0_usize, '\n');
    for (at, letter) in text.char_indices() {
        let starts = before.is_whitespace() || ",:[{".contains(before);
        match (quote, letter) {
            (Some(open), _) => quote = quote.filter(|_| letter != open),
            (None, _) if is_wanted(depth, before, letter) => return Some(at),
            (None, '"' | '\'') if starts => quote = Some(letter),
            (None, '[' | '{') if starts => depth += 1,
            (None, ']' | '}') => depth = depth.saturating_sub(1),
            _ => {}
        }
        before = letter;
    }
    None
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

    #[test]
    fn keys_stand_in_lines_or_in_braces_with_quotes_or_without() {
        for text in [
            "---\n\"image\": 'a, b #1.pgm'\t# the picture: of a flat\n'origin':\n- -1\n- 2.5 # up\n- 0\n",
            "{image: \"a, b #1.pgm\", origin: [-1,2.5,0]}",
            "{\"image\":\"a, b #1.pgm\", # the picture\n \"origin\":[-1,\n2.5,0]\n}\n",
            "image: a, b #1.pgm\r\norigin: [-1, 2.5,\r\n 0]\r\n",
        ] {
            let keys = Keys::of(text);
            let image = if text.starts_with("image") { "a, b" } else { "a, b #1.pgm" };
            assert_eq!(keys.text("image"), Ok(image), "{text}");
            assert_eq!(keys.origin(), Ok([-1.0, 2.5, 0.0]), "{text}");
        }
        assert_eq!(keys("image: bob's [1].pgm\nmode: scale\n")["image"], "bob's [1].pgm");
    }
}
