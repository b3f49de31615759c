//! Lines of text for a reader who may have seen enough: one who closes the pipe ends the program in order.

use std::fmt::Arguments;
use std::io::{self, Write as _};

/// Prints a line, as `println!` does.
macro_rules! say {
    ($($text:tt)*) => {
        crate::say::say(format_args!($($text)*))
    };
}

pub fn say(line: Arguments<'_>) {
    if writeln!(io::stdout(), "{line}").is_err() {
        std::process::exit(0);
    }
}
