//! Figures as PDF, for papers.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use svg2pdf::usvg::{self, Options, Tree, fontdb::Database};
use svg2pdf::{ConversionError, ConversionOptions, PageOptions};
use thiserror::Error;

/// The fonts that figures ask for, and what stands in for them, the best first.
const FONTS: [&str; 5] = ["DejaVu Sans", "Liberation Sans", "Noto Sans", "Helvetica", "Arial"];

/// Turns SVG pictures into PDF files of one page, with text that can be searched.
///
/// Fonts are those of the system, and embedded.
#[derive(Debug)]
pub struct Printer {
    options: Options<'static>,
}

/// Why a picture does not become a PDF.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PdfError {
    /// The system has none of the fonts.
    #[error("no font was found for the texts of figures: install one of {}", FONTS.join(", "))]
    NoFont,
    /// The text is no SVG picture.
    #[error("not an SVG picture: {0}")]
    Picture(#[from] usvg::Error),
    /// The picture holds what a PDF cannot.
    #[error("the picture cannot be written as PDF: {0}")]
    Conversion(ConversionError),
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

impl Printer {
    /// A printer with the fonts of the system.
    ///
    /// # Errors
    /// When there is none that fits.
    pub fn new() -> Result<Printer, PdfError> {
        let mut fonts = Database::new();
        fonts.load_system_fonts();
        let known = |family: &&str| {
            let families = || fonts.faces().flat_map(|face| &face.families);
            families().any(|(name, _)| name == *family)
        };
        let family = FONTS.iter().copied().find(known).ok_or(PdfError::NoFont)?;
        fonts.set_sans_serif_family(family);
        let options =
            Options { fontdb: Arc::new(fonts), font_family: family.into(), ..Options::default() };
        Ok(Printer { options })
    }

    /// The picture as PDF. What moves in it stands still.
    ///
    /// # Errors
    /// When the text is no SVG picture.
    pub fn print(&self, svg: &str) -> Result<Vec<u8>, PdfError> {
        let tree = Tree::from_str(svg, &self.options)?;
        svg2pdf::to_pdf(&tree, ConversionOptions::default(), PageOptions::default())
            .map_err(PdfError::Conversion)
    }

    /// Writes a PDF beside the picture in a file, and returns its path.
    ///
    /// # Errors
    /// When the file cannot be read or is no SVG picture, or the PDF cannot be written.
    pub fn print_beside(&self, picture: &Path) -> Result<PathBuf, PdfError> {
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| PdfError::File { path, source }
        };
        let svg = fs::read_to_string(picture).map_err(failed(picture))?;
        let path = picture.with_extension("pdf");
        fs::write(&path, self.print(&svg)?).map_err(failed(&path))?;
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 60 by 40 pixels with a text.
    const PICTURE: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='60' height='40' \
        font-family='Nowhere, sans-serif'><rect width='60' height='40' fill='#fff'/>\
        <text x='5' y='20'>λ₁ = 2</text></svg>";

    #[test]
    fn a_picture_becomes_a_page_of_its_size_with_its_font() {
        let page = Printer::new().unwrap().print(PICTURE).unwrap();
        assert!(page.starts_with(b"%PDF-"));
        let text = String::from_utf8_lossy(&page);
        assert!(text.contains("/MediaBox [0 0 60 40]"), "{text}");
        assert!(text.contains("/FontFile") && text.contains("/ToUnicode"), "{text}");
        assert_eq!(page, Printer::new().unwrap().print(PICTURE).unwrap());
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        let error = Printer::new().unwrap().print("hello").unwrap_err();
        assert!(error.to_string().starts_with("not an SVG picture"), "{error}");
    }
}
