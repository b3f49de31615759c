//! The exhibit as a page of the book, in Markdown.

use super::{Comparison, Exhibit, numbers};

/// Between these lines of an example stands its model.
const MODEL: [&str; 2] = ["// ---- The model ", "// ---- The answer "];

impl Exhibit {
    /// The page: what the example's documentation says, its model, the drawings, the runs and the
    /// comparison with the answer. Nothing on it is rounded differently from machine to machine.
    pub fn page(&self) -> String {
        let mut page = format!(
            "<!-- Generated: PLEACH_UPDATE_DOCS=1 cargo test --test it book -->\n\n{}\n\n\
             `cargo run --example {}` runs it.\n\n\
             ## The model\n\n```rust,ignore\n{}\n```\n",
            self.documentation(),
            self.name,
            self.model(),
        );
        for drawing in &self.drawings {
            let (title, picture) = (drawing.title, self.diagram_of(drawing));
            page += &format!("\n![Diagram: {title}](pictures/{picture})\n");
        }
        page += &match &*self.faults {
            [] => "\nThe checks before a run find nothing wrong.\n".to_owned(),
            faults => format!("\nThe checks before a run find: {}\n", faults.join("; ")),
        };
        page += "\n## What happens\n";
        for run in &self.runs {
            let (title, picture, lines) = (run.title, self.plot_of(run), run.story.join("\n"));
            page += &format!("\n### {title}\n\n");
            if run.plot.is_some() {
                page += &format!("![Plot: {title}](pictures/{picture})\n\n");
            }
            page += &format!("```text\n{lines}\n```\n");
        }
        page += "\n## The answer\n\n| quantity | answer | agrees within |\n| --- | --: | --: |\n";
        self.comparisons.iter().for_each(|one| page += &row(one));
        page
    }

    /// The documentation of the example as a whole.
    fn documentation(&self) -> String {
        let lines = self.source.lines().map_while(|line| line.strip_prefix("//!"));
        let text: Vec<&str> = lines.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect();
        text.join("\n")
    }

    /// The part of the source that is the model.
    fn model(&self) -> String {
        let [begin, end] = MODEL;
        let lines = self.source.lines().skip_while(|line| !line.starts_with(begin)).skip(1);
        let lines: Vec<&str> = lines.take_while(|line| !line.starts_with(end)).collect();
        lines.join("\n").trim().to_owned()
    }
}

fn row(one: &Comparison) -> String {
    let tolerance =
        if one.tolerance == 0.0 { "exactly".into() } else { format!("{:e}", one.tolerance) };
    format!("| {} | {} | {tolerance} |\n", one.quantity, numbers(&one.answers))
}
