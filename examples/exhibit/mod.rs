//! What all classics do: they show a model, run it, and hold the run against a known answer.
//!
//! A classic fills an [`Exhibit`]. Its program [shows](Exhibit::show) the exhibit, its test asks
//! for [disagreements](Exhibit::disagreements), and its [page](Exhibit::page) in the book is
//! written from the same value; so program, test and book cannot tell three different stories.

#![allow(dead_code)] // a classic uses a part of it, the book another

mod number;
mod page;
mod show;

use std::error::Error;

use pleach::automaton::check::{Report, Severity};
use pleach::automaton::{Automaton, Composition, Coordinates, Reason, Trajectory, diagram};
use pleach::discrete::{Event, Location};
use pleach::page::{self as pages, TrajectoryPage};

pub use number::{number, numbers};

/// What a classic makes: an exhibit, or whatever kept it from running.
pub type Shown = Result<Exhibit, Box<dyn Error>>;

/// A model with its drawings, its runs, and what they are compared with.
pub struct Exhibit {
    /// What the example is called.
    name: &'static str,
    /// The text of the example.
    source: &'static str,
    /// What the checks before the run have found wrong.
    faults: Vec<String>,
    drawings: Vec<Drawing>,
    runs: Vec<Run>,
    comparisons: Vec<Comparison>,
}

/// An automaton or a composition.
struct Drawing {
    title: &'static str,
    diagram: String,
    /// What the pages of runs show of an automaton.
    automaton: Option<pages::Drawing>,
}

struct Run {
    title: &'static str,
    story: Vec<String>,
    plot: Option<String>,
    trajectory: Option<Trajectory>,
}

/// Numbers that a run gives beside those that it should give.
struct Comparison {
    quantity: String,
    found: Vec<f64>,
    answers: Vec<f64>,
    tolerance: f64,
}

impl Exhibit {
    /// Begins the exhibit of the example called `name`, whose file is `source`.
    pub fn new(name: &'static str, source: &'static str) -> Self {
        let (drawings, runs, comparisons) = (Vec::new(), Vec::new(), Vec::new());
        Exhibit { name, source, faults: Vec::new(), drawings, runs, comparisons }
    }

    /// Shows an automaton that runs by itself, and keeps what its check has found.
    pub fn automaton<L: Location, E: Event, S: Coordinates>(
        self,
        title: &'static str,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        self.component(title, automaton).checked(&automaton.check())
    }

    /// Shows an automaton that is a part of a composition.
    pub fn component<L: Location, E: Event, S: Coordinates>(
        mut self,
        title: &'static str,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        let (diagram, automaton) = (diagram::svg(automaton), Some(pages::Drawing::of(automaton)));
        self.drawings.push(Drawing { title, diagram, automaton });
        self
    }

    /// Keeps what a check has found wrong; in an exhibit nothing should be.
    pub fn checked(mut self, report: &Report) -> Self {
        let findings = report.findings().iter();
        let wrong = findings.filter(|finding| finding.severity != Severity::Note);
        self.faults.extend(wrong.map(|finding| finding.message.clone()));
        self
    }

    /// Shows a composition: what joins its components.
    pub fn composition(mut self, title: &'static str, composition: &Composition) -> Self {
        let diagram = diagram::composition_svg(composition);
        self.drawings.push(Drawing { title, diagram, automaton: None });
        self.checked(&composition.check())
    }

    /// Shows a run: its plot, its jumps and its ending.
    pub fn run(mut self, title: &'static str, trajectory: Trajectory) -> Self {
        let (story, plot) = (show::story(&trajectory), Some(diagram::plot(&trajectory)));
        self.runs.push(Run { title, story, plot, trajectory: Some(trajectory) });
        self
    }

    /// Shows what happens where no time passes: a line for each jump.
    pub fn story(mut self, title: &'static str, story: Vec<String>) -> Self {
        self.runs.push(Run { title, story, plot: None, trajectory: None });
        self
    }

    /// Holds a number that was `found` against the `answer`, from which it may differ by
    /// `tolerance`, in its unit.
    pub fn compare(
        self,
        quantity: impl Into<String>,
        found: f64,
        answer: f64,
        tolerance: f64,
    ) -> Self {
        self.compare_all(quantity, [found], [answer], tolerance)
    }

    /// Holds numbers against as many answers, one after the other.
    pub fn compare_all(
        mut self,
        quantity: impl Into<String>,
        found: impl IntoIterator<Item = f64>,
        answers: impl IntoIterator<Item = f64>,
        tolerance: f64,
    ) -> Self {
        let (found, answers) = (found.into_iter().collect(), answers.into_iter().collect());
        let quantity = quantity.into();
        self.comparisons.push(Comparison { quantity, found, answers, tolerance });
        self
    }

    /// Holds the instants of the jumps of a run, in seconds, against the `answers`, which ascend: all
    /// of them if the run lasts to its horizon, and else as many as there are answers.
    pub fn compare_jumps(
        self,
        run: &Trajectory,
        answers: impl IntoIterator<Item = f64>,
        tolerance: f64,
    ) -> Self {
        let lasts = run.ending().reason == Reason::Horizon;
        let end = if lasts { run.ending().at.t } else { f64::INFINITY };
        let answers: Vec<f64> = answers.into_iter().take_while(|answer| *answer <= end).collect();
        let count = if lasts { usize::MAX } else { answers.len() };
        let found: Vec<f64> = instants(run).take(count).collect();
        self.compare_all("jumps in s", found, answers, tolerance)
    }

    /// What the checks have found, and what differs by more than its tolerance, as sentences.
    pub fn disagreements(&self) -> Vec<String> {
        let wrong = |one: &&Comparison| {
            let agrees = one.error().is_some_and(|error| error <= one.tolerance);
            !agrees
        };
        let differences = self.comparisons.iter().filter(wrong).map(Comparison::to_sentence);
        self.faults.iter().cloned().chain(differences).collect()
    }

    /// The diagrams: the name of a file, and an SVG document.
    pub fn diagrams(&self) -> impl Iterator<Item = (String, &str)> {
        self.drawings.iter().map(|drawing| (self.diagram_of(drawing), &*drawing.diagram))
    }

    /// The plots of the runs: the name of a file, and an SVG document.
    pub fn plots(&self) -> impl Iterator<Item = (String, &str)> {
        self.runs.iter().filter_map(|run| Some((self.plot_of(run), run.plot.as_deref()?)))
    }

    /// The pages on which the runs play: the name of a file, and an HTML document.
    pub fn pages(&self) -> impl Iterator<Item = (String, String)> {
        let drawings = || self.drawings.iter().filter_map(|drawing| drawing.automaton.clone());
        self.runs.iter().filter_map(move |run| {
            let page = TrajectoryPage::new(run.title, run.trajectory.as_ref()?)
                .lead(format!("A run of the classic {}.", self.name.replace('_', " ")))
                .drawings(drawings());
            Some((format!("{}.html", file_name(run.title)), page.render()))
        })
    }

    fn diagram_of(&self, drawing: &Drawing) -> String {
        format!("{}-{}.svg", self.name, file_name(drawing.title))
    }

    fn plot_of(&self, run: &Run) -> String {
        format!("{}-{}.svg", self.name, file_name(run.title))
    }
}

/// The title in small letters, with hyphens for all else.
fn file_name(title: &str) -> String {
    let words = title.split(|letter: char| !letter.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-").to_ascii_lowercase()
}

impl Comparison {
    /// The largest difference; `None` if there are not as many numbers as answers, or one of them
    /// is no number.
    fn error(&self) -> Option<f64> {
        let pairs = self.found.iter().zip(&self.answers);
        let mut errors = pairs.map(|(found, answer)| (found - answer).abs());
        let largest = errors
            .try_fold(0.0, |largest: f64, error| (!error.is_nan()).then(|| largest.max(error)));
        largest.filter(|_| self.found.len() == self.answers.len())
    }

    fn to_sentence(&self) -> String {
        let Comparison { quantity, found, answers, tolerance } = self;
        format!("{quantity}: {found:?} are not within {tolerance:e} of {answers:?}")
    }
}

/// The instants of the jumps of a run, in seconds.
pub fn instants(run: &Trajectory) -> impl Iterator<Item = f64> {
    run.jumps().iter().map(|jump| jump.at.t)
}

/// Where the jumps of a run accumulate, in seconds; NaN if it is not Zeno.
pub fn accumulation(run: &Trajectory) -> f64 {
    match run.ending().reason {
        Reason::Zeno(zeno) => zeno.accumulation,
        _ => f64::NAN,
    }
}
