//! What the program writes: files, which errors name, and the standard streams.

use super::source;
use super::status::Failure;
use std::fmt::Display;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes lines to the error output. If it cannot be written, because it is closed for
/// example, the lines are lost, and the program goes on.
pub fn tell(lines: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{lines}");
}

/// Writes a text to the standard output.
pub fn say(text: &str) -> io::Result<()> {
    let mut output = standard();
    output.write_all(text.as_bytes())?;
    output.flush()
}

/// Writes a text to a file, or for `-` to the standard output.
pub fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let mut output = open(path)?;
    output.write_all(text.as_bytes())?;
    Ok(output.flush()?)
}

/// A new file, or for `-` the standard output.
pub(super) fn open(path: &Path) -> Result<Box<dyn Write>, Failure> {
    match source::is_standard(path) {
        true => Ok(Box::new(standard())),
        false => Ok(Box::new(create_file(path)?)),
    }
}

/// A new file, buffered.
fn create_file(path: &Path) -> Result<BufWriter<Named<File>>, Failure> {
    let name = path.display().to_string();
    let file = File::create(path).map(|output| BufWriter::new(Named { name, output }));
    file.map_err(|source| Failure::Creation { path: path.to_owned(), source })
}

/// A folder, created if it is missing: one that cannot be written is told before a run, not after.
pub(super) fn create_folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|source| Failure::Creation { path: path.to_owned(), source })
}

/// Refuses outputs that would take the place of an input or of each other. Folders and devices hold
/// many.
pub(super) fn check_places<'a>(
    inputs: impl IntoIterator<Item = &'a PathBuf>,
    outputs: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    let inputs = inputs.into_iter().filter(|path| path.is_file());
    let mut taken: Vec<PathBuf> = inputs.map(|path| place_of(path)).collect();
    for output in outputs.into_iter().filter(|path| path.is_file() || !path.exists()) {
        let here = place_of(output);
        if taken.contains(&here) {
            let what = "would take the place of another file of this call; choose another path";
            return Err(Failure::Usage(format!("what goes to {} {what}", output.display())));
        }
        taken.push(here);
    }
    Ok(())
}

/// The place that a path names, by which it is known again: also that of a file that is not there yet.
fn place_of(path: &Path) -> PathBuf {
    let folder = path.parent().map(|folder| if folder == "" { Path::new(".") } else { folder });
    let in_folder = || Some(fs::canonicalize(folder?).ok()?.join(path.file_name()?));
    fs::canonicalize(path).ok().or_else(in_folder).unwrap_or_else(|| path.to_owned())
}

/// Whether a file can be written, or for `-` the standard output: told before what takes long. A file that is there
/// stays what it is, and one that is not there is not left behind.
pub(super) fn check(path: &Path) -> Result<(), Failure> {
    if source::is_standard(path) {
        return Ok(());
    }
    let is_new = !path.exists();
    // A pipe that is opened and closed has ended for its reader.
    if !is_new && !path.is_file() && !path.is_dir() {
        return Ok(());
    }
    let file = File::options().append(true).create(true).open(path);
    let leave = || if is_new { fs::canonicalize(path).and_then(fs::remove_file) } else { Ok(()) };
    file.and_then(|_| leave()).map_err(|source| Failure::Creation { path: path.to_owned(), source })
}

fn standard() -> Named<io::StdoutLock<'static>> {
    Named { name: "the standard output".into(), output: io::stdout().lock() }
}

/// An output whose errors say which it is.
pub(super) struct Named<W> {
    name: String,
    output: W,
}

impl<W> Named<W> {
    fn told(&self, error: io::Error) -> io::Error {
        io::Error::new(error.kind(), format!("{}: {error}", self.name))
    }
}

impl<W: Write> Write for Named<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.output.write(bytes).map_err(|error| self.told(error))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush().map_err(|error| self.told(error))
    }
}
