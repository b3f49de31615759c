//! Mistakes of shape that do not compile. What the compiler says about each, in a line, is in the
//! `.stderr` file beside it; after a change of wording,
//! `PLEACH_UPDATE_DOCS=1 cargo test -p pleach-automaton --test it compile_fail` writes them anew.
//!
//! The compiler is given the libraries that these tests are linked with: nothing is built for it.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::SystemTime;

const FOLDER: &str = "tests/compile_fail";

/// The folder with the libraries that this program was linked from: its own.
fn libraries() -> PathBuf {
    let program = env::current_exe().expect("a program knows where it is");
    program.parent().expect("it is in a folder").to_owned()
}

/// The library of a crate. After a change of features there are several, of the same sources; the
/// latest is as good as any, and names the libraries that it was built with.
fn library(name: &str) -> PathBuf {
    let prefix = format!("lib{name}-");
    let entries = fs::read_dir(libraries()).expect("the folder can be read");
    let paths = entries.map(|entry| entry.expect("an entry can be read").path());
    let is_library = |path: &PathBuf| {
        let stem = path.file_stem().and_then(OsStr::to_str).unwrap_or_default();
        stem.starts_with(&prefix) && path.extension() == Some(OsStr::new("rlib"))
    };
    let age = |path: &PathBuf| path.metadata().and_then(|data| data.modified());
    let latest =
        paths.filter(is_library).max_by_key(|it| age(it).unwrap_or(SystemTime::UNIX_EPOCH));
    latest.unwrap_or_else(|| panic!("no library {prefix}*.rlib in {}", libraries().display()))
}

/// What the compiler says about a program, one line for each error or warning; `None` if it
/// compiles.
fn complaint(program: &Path) -> Option<String> {
    let name = "pleach_automaton";
    let metadata = env::temp_dir().join(format!("pleach-{}.rmeta", std::process::id()));
    let output = Command::new(env::var_os("RUSTC").unwrap_or("rustc".into()))
        .args(["--edition=2024", "--crate-type=bin", "--error-format=short"])
        .arg(format!("--emit=metadata={}", metadata.display()))
        .arg(format!("-Ldependency={}", libraries().display()))
        .arg(format!("--extern={name}={}", library(name).display()))
        .arg(program)
        .output()
        .expect("the compiler starts");
    let _ = fs::remove_file(metadata);
    let said = String::from_utf8(output.stderr).expect("the compiler writes UTF-8");
    let lines = said.lines().filter(|line| line.contains(FOLDER));
    (!output.status.success()).then(|| lines.map(|line| format!("{line}\n")).collect())
}

#[test]
fn mistakes_of_shape_do_not_compile() {
    let entries = fs::read_dir(FOLDER).expect("the folder can be read");
    let mut programs: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry can be read").path())
        .filter(|path| path.extension() == Some(OsStr::new("rs")))
        .collect();
    programs.sort();
    assert!(programs.len() >= 8, "the programs are not where they are looked for");
    for program in programs {
        let complaint = complaint(&program);
        let complaint = complaint.unwrap_or_else(|| panic!("{} compiles", program.display()));
        let expected = program.with_extension("stderr");
        if env::var_os("PLEACH_UPDATE_DOCS").is_some() {
            fs::write(&expected, &complaint).expect("the expectation can be written");
        }
        let expected = fs::read_to_string(expected).unwrap_or_default();
        assert_eq!(complaint, expected, "{}", program.display());
    }
}
