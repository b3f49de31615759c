//! The pages in a browser: they load without complaints, play, seek, and say what the trace says.
//!
//! `tests/browser/check` runs these tests; they need Chromium.

mod chromium;
mod classics;
mod maps;
mod missions;
