//! The page that shows all figures of a mission as one story.

use pleach_automaton::network::record::End;
use pleach_automaton::network::scenario::Scenario;

use super::palette;

/// A figure with its file and what is told above it.
#[derive(Clone, Debug)]
pub(super) struct Figure {
    pub file: String,
    pub narration: Vec<String>,
    pub picture: String,
}

/// Renders a page that holds every picture in itself: no scripts, no other files.
pub(super) fn render(scenario: &Scenario, figures: &[Figure], end: &End) -> String {
    let title = escape(&scenario.name);
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
         <style>\n{}</style>\n</head>\n<body>\n<h1>{title}</h1>\n",
        style()
    );
    if let Some(description) = &scenario.description {
        html.push_str(&paragraph("lead", description));
    }
    let count = |number: usize, noun: &str| match number {
        1 => format!("1 {noun}"),
        _ => format!("{number} {noun}s"),
    };
    let cast = format!(
        "{}, {} and {}. All are numbered from 0, as in the trace; access points follow the robots.",
        count(scenario.robot.len(), "robot"),
        count(scenario.access_point.len(), "access point"),
        count(scenario.task.len(), "task"),
    );
    html.push_str(&paragraph("lead", &cast));
    html.push_str(&paragraph("end", &format!("How it ends: {}", end.reason)));
    for figure in figures {
        let name = escape(&figure.file);
        html.push_str(&format!(
            "<figure id=\"{}\">\n<figcaption>\n",
            name.trim_end_matches(".svg")
        ));
        for sentence in &figure.narration {
            html.push_str(&paragraph("told", sentence));
        }
        html.push_str("</figcaption>\n");
        html.push_str(&figure.picture);
        html.push_str(&format!(
            "\n<p class=\"file\"><a href=\"{name}\">{name}</a></p>\n</figure>\n"
        ));
    }
    html.push_str("</body>\n</html>\n");
    html
}

fn paragraph(class: &str, words: &str) -> String {
    format!("<p class=\"{class}\">{}</p>\n", escape(words))
}

fn style() -> String {
    let (font, ink, quiet, band) = (palette::FONT, palette::INK, palette::QUIET, palette::BAND);
    format!(
        "body {{ font-family: {font}; color: {ink}; background: {band}; margin: 2.5rem auto; \
         max-width: 62rem; padding: 0 1rem; line-height: 1.5; }}\n\
         h1 {{ margin: 0 0 .5rem; }}\n\
         .lead {{ margin: .3rem 0; color: {quiet}; }}\n\
         .end {{ margin: .8rem 0 2rem; font-weight: 600; }}\n\
         figure {{ margin: 0 0 2rem; padding: 1rem; background: #fff; border-radius: 10px; \
         box-shadow: 0 1px 3px #0002; }}\n\
         figcaption {{ margin: 0 0 .5rem 1.2rem; }}\n\
         .told {{ margin: .15rem 0; font-size: .92rem; }}\n\
         .file {{ margin: 0; text-align: right; font-size: .75rem; }}\n\
         .file a {{ color: {quiet}; }}\n\
         svg {{ display: block; width: 100%; height: auto; }}\n"
    )
}

fn escape(words: &str) -> String {
    words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
