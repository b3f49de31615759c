//! Coverage in words and numbers.

use std::fmt;

use super::{BoundaryCoverage, ComponentCoverage, Coverage};

impl fmt::Display for BoundaryCoverage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seen = match (self.held > 0, self.failed > 0) {
            (true, true) => "both sides",
            (true, false) => "only true",
            (false, true) => "only false",
            (false, false) => "unseen",
        };
        write!(formatter, "{}: {seen}", self.condition)
    }
}

impl fmt::Display for Coverage {
    /// For each component what is covered in numbers, and then a table of its transitions in
    /// Markdown.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, component) in self.components.iter().enumerate() {
            if number > 0 {
                writeln!(formatter)?;
            }
            write!(formatter, "{component}")?;
        }
        Ok(())
    }
}

impl fmt::Display for ComponentCoverage {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = self.counts().map(|(what, covered, all)| format!("{covered} of {all} {what}"));
        writeln!(formatter, "{}: {}", self.name, counts.join(", "))?;
        let unseen = self.locations.iter().filter(|location| location.entered == 0);
        let unseen: Vec<&str> = unseen.map(|location| location.name).collect();
        if !unseen.is_empty() {
            writeln!(formatter, "never entered: {}", unseen.join(", "))?;
        }
        writeln!(formatter, "\n| transition | event | taken | guard |\n| --- | --- | --- | --- |")?;
        for transition in &self.transitions {
            let name = |location: usize| self.locations[location].name;
            let boundaries: Vec<String> =
                transition.boundaries.iter().map(ToString::to_string).collect();
            writeln!(
                formatter,
                "| {} → {} | {} | {} | {} |",
                name(transition.source),
                name(transition.target),
                transition.event,
                transition.taken,
                or_nothing(boundaries.join("; ").replace('|', r"\|")),
            )?;
        }
        Ok(())
    }
}

fn or_nothing(text: String) -> String {
    if text.is_empty() { "—".to_owned() } else { text }
}
