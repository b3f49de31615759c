//! Documents that are generated: compared with the files, or written anew.

use std::fs;
use std::path::Path;

const UPDATE: &str = "PLEACH_UPDATE_DOCS";

/// The folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The text of a file of the package.
#[allow(dead_code)] // not every package reads
pub fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap()
}

/// Whether documents are to be written anew.
pub fn is_update() -> bool {
    std::env::var_os(UPDATE).is_some()
}

/// Compares a document, which the test called `test` generates, with the file, or writes the file.
pub fn keep_up_to_date(path: &str, document: &str, test: &str) {
    let file = root().join(path);
    if is_update() {
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(&file, document).unwrap();
    }
    let kept = fs::read_to_string(&file).unwrap_or_default();
    let package = env!("CARGO_PKG_NAME");
    assert!(
        kept == document,
        "{path} is out of date; refresh it with `{UPDATE}=1 cargo test -p {package} --test it {test}`"
    );
}
