//! The page as a document: the parts that all pages share, put together into one file.

use serde::Serialize;
use serde_json::Value;

use crate::colours;

const FRAME: &str = include_str!("assets/frame.html");
const BODY: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/style.css");
/// In the order in which they use each other.
const SCRIPTS: [&str; 11] = [
    include_str!("assets/tables.js"),
    include_str!("assets/canvas.js"),
    include_str!("assets/player.js"),
    include_str!("assets/transport.js"),
    include_str!("assets/curves.js"),
    include_str!("assets/strips.js"),
    include_str!("assets/marks.js"),
    include_str!("assets/plan.js"),
    include_str!("assets/mission.js"),
    include_str!("assets/run.js"),
    include_str!("assets/start.js"),
];

/// What a page is made of.
pub(super) struct Document<'a> {
    /// What it is called.
    pub title: &'a str,
    /// What stands below the title.
    pub lead: Option<&'a str>,
    /// How the run ended.
    pub outcome: Outcome,
    /// The table at the end.
    pub summary: Vec<Row>,
    /// What the scripts read.
    pub data: Value,
}

/// How a run ended.
pub(super) struct Outcome {
    /// `good`, `doubtful` or `bad`.
    pub class: &'static str,
    /// One or two words.
    pub headline: String,
    /// A sentence.
    pub text: String,
}

/// A row of the summary.
pub(super) struct Row {
    name: String,
    text: String,
    /// The instant of which it speaks.
    at: Option<usize>,
}

impl Row {
    /// A row that speaks of the whole run.
    pub(super) fn new(name: impl Into<String>, text: String) -> Row {
        Row { name: name.into(), text, at: None }
    }

    /// A row that speaks of control period `step`.
    #[cfg(feature = "network")]
    pub(super) fn at(name: impl Into<String>, text: String, step: usize) -> Row {
        Row { name: name.into(), text, at: Some(step) }
    }

    fn render(&self) -> String {
        let instant = self.at.map_or_else(String::new, |at| {
            format!(" <button class=\"instant\" data-at=\"{at}\">k = {at}</button>")
        });
        let (name, text) = (escaped(&self.name), escaped(&self.text));
        format!("<tr><th scope=\"row\">{name}</th><td>{text}{instant}</td></tr>\n")
    }
}

impl Document<'_> {
    /// The file.
    pub(super) fn render(&self) -> String {
        let rows: Vec<String> = self.summary.iter().map(Row::render).collect();
        let style = format!("{}\n{STYLE}", colours::style_sheet());
        let parts = [
            ("title", escaped(self.title)),
            ("lead", self.lead.map_or_else(String::new, escaped)),
            ("class", self.outcome.class.to_owned()),
            ("headline", escaped(&self.outcome.headline)),
            ("outcome", escaped(&self.outcome.text)),
            ("summary", rows.concat()),
        ];
        render(self.title, &style, &filled(BODY, &parts), &self.data, &SCRIPTS.join("\n"))
    }
}

/// A file that needs no other: a body, the data that its script reads from the element `data`, and the script.
pub(crate) fn render(
    title: &str,
    style: &str,
    body: &str,
    data: &impl Serialize,
    script: &str,
) -> String {
    // Writing numbers and texts as JSON does not fail. Whatever they say, they cannot end the element.
    let data = serde_json::to_string(data).unwrap_or_default().replace('<', "\\u003c");
    let parts = [
        ("title", escaped(title)),
        ("style", style.to_owned()),
        ("body", body.to_owned()),
        ("data", data),
        ("script", script.to_owned()),
    ];
    filled(FRAME, &parts)
}

/// The text with `{{name}}` replaced by the part of this name, and parts left as they are.
pub(crate) fn filled(frame: &str, parts: &[(&str, String)]) -> String {
    let mut pieces = frame.split("{{");
    let mut text = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once("}}").unwrap_or((piece, ""));
        let part = parts.iter().find(|(known, _)| *known == name);
        text.push_str(part.map_or("", |(_, part)| part));
        text.push_str(rest);
    }
    text
}

/// Text as HTML shows it.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
