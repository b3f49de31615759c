//! Grid maps of the MovingAI benchmarks (Sturtevant, 2012).

use super::grid::Grid;

/// Reads a map: `type`, `height`, `width`, `map`, then the rows from the top. `.`, `G` and `S` can
/// be passed.
pub(super) fn read(text: &str) -> Result<Grid, String> {
    let mut lines = text.lines().enumerate().map(|(line, text)| (line + 1, text.trim_end()));
    let (mut width, mut height) = (None, None);
    for (line, text) in lines.by_ref() {
        let mut words = text.split_whitespace();
        let count = |word: Option<&str>| {
            let wrong = || format!("line {line}: {text:?} states no whole number above 0");
            word.and_then(|word| word.parse().ok()).filter(|&count| count > 0).ok_or_else(wrong)
        };
        match words.next() {
            Some("type") | None => {}
            Some("width") => width = Some(count(words.next())?),
            Some("height") => height = Some(count(words.next())?),
            Some("map") => break,
            Some(word) => {
                return Err(format!(
                    "line {line}: {word:?} stands where width, height or map belongs"
                ));
            }
        }
    }
    let (Some(width), Some(height)) = (width, height) else {
        return Err("the map states no width and height before its rows".into());
    };
    let mut free: Vec<bool> = Vec::new();
    for (line, row) in lines.filter(|(_, row)| !row.is_empty()) {
        let cells: Vec<bool> = row.chars().map(|cell| matches!(cell, '.' | 'G' | 'S')).collect();
        if cells.len() != width {
            return Err(format!("line {line}: the row has {} cells, not {width}", cells.len()));
        }
        free.extend(cells);
    }
    if free.len() / width != height {
        return Err(format!("the map has {} rows, not {height}", free.len() / width));
    }
    Grid::new(width, height, free)
}
