//! Pixels as cells, as the ROS map server reads them.
//!
//! The channels of a pixel are averaged, and how dark the average is, from 0 for white to 1 for black, is the occupancy
//! of the cell (`negate` turns this round). Above `occupied_thresh` the cell is occupied, or else below `free_thresh`
//! free, or else unknown. Only free cells are floor.

use super::grid::Grid;
use super::{ImportError, Reading};
use image::{DynamicImage, GenericImageView, ImageReader, Rgba};
use std::path::Path;

/// The largest group of cells that mapping programs leave on the floor.
const SPECKS: usize = 2;

/// What makes a pixel a free cell.
pub(super) struct Rule {
    pub occupied_above: f64,
    pub free_below: f64,
    pub is_negated: bool,
    pub alpha: Alpha,
}

/// What the transparency of a pixel means.
pub(super) enum Alpha {
    /// It is averaged with the colours: mode `trinary`.
    IsAChannel,
    /// A cell of which anything shines through is unknown: mode `scale`.
    HidesTheCell,
}

impl Default for Rule {
    fn default() -> Self {
        Self {
            occupied_above: 0.65,
            free_below: 0.196,
            is_negated: false,
            alpha: Alpha::IsAChannel,
        }
    }
}

/// Reads an image alone, whose pixels have the side that the reading states.
pub(super) fn read(path: &Path, reading: &Reading) -> Result<Grid, ImportError> {
    let malformed = |problem: String| ImportError::Malformed { path: path.into(), problem };
    let mut grid = grid(path, &Rule::default())?;
    grid.cell = match reading.resolution {
        Some(side) if side.is_finite() && side > 0.0 => side,
        Some(side) => {
            return Err(malformed(format!("the resolution is {side}: it must be positive")));
        }
        None => {
            return Err(malformed(
                "an image alone states no lengths: give --resolution LENGTH, the side of a pixel in metres".into(),
            ));
        }
    };
    Ok(grid)
}

/// The cells of an image, of side 1.
pub(super) fn grid(path: &Path, rule: &Rule) -> Result<Grid, ImportError> {
    let picture = picture(path)?;
    let free = rule.free_pixels(&picture);
    let grid = Grid::new(picture.width() as usize, picture.height() as usize, free);
    let mut grid = grid.map_err(|problem| ImportError::Malformed { path: path.into(), problem })?;
    grid.specks = SPECKS;
    grid.shades = picture.into_luma8().into_raw();
    Ok(grid)
}

fn picture(file: &Path) -> Result<DynamicImage, ImportError> {
    let unreadable = |source| ImportError::Unreadable { path: file.into(), source };
    let reader = ImageReader::open(file).and_then(ImageReader::with_guessed_format);
    reader.map_err(unreadable)?.decode().map_err(|error| ImportError::Malformed {
        path: file.into(),
        problem: format!("no image that can be read: {error}"),
    })
}

impl Rule {
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
