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

use pleach::automaton::{Automaton, Trajectory, diagram};
use pleach::discrete::{Event, Location};
use pleach::guards::Valuation;

pub use number::{number, numbers};

/// What a classic makes: an exhibit, or whatever kept it from running.
pub type Shown = Result<Exhibit, Box<dyn Error>>;

/// A model with its drawings, its runs, and what they are compared with.
pub struct Exhibit {
    /// What the example is called.
    name: &'static str,
    /// The text of the example.
    source: &'static str,
    drawings: Vec<Drawing>,
    runs: Vec<Run>,
    comparisons: Vec<Comparison>,
}

struct Drawing {
    title: &'static str,
    diagram: String,
    table: String,
}

struct Run {
    title: &'static str,
    story: Vec<String>,
}

/// Numbers that a run gives beside those that it should give.
struct Comparison {
    quantity: &'static str,
    found: Vec<f64>,
    answers: Vec<f64>,
    tolerance: f64,
}

impl Exhibit {
    /// Begins the exhibit of the example called `name`, whose file is `source`.
    pub fn new(name: &'static str, source: &'static str) -> Self {
        Exhibit { name, source, drawings: Vec::new(), runs: Vec::new(), comparisons: Vec::new() }
    }

    /// Shows an automaton, as a diagram and as tables.
    pub fn automaton<L: Location, E: Event, S: Valuation>(
        mut self,
        title: &'static str,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        let (diagram, table) = (diagram::svg(automaton), diagram::table(automaton));
        self.drawings.push(Drawing { title, diagram, table });
        self
    }

    /// Shows a run: its jumps and its ending.
    pub fn run(self, title: &'static str, trajectory: Trajectory) -> Self {
        self.story(title, show::story(&trajectory))
    }

    /// Shows what happens where no time passes: a line for each jump.
    pub fn story(mut self, title: &'static str, story: Vec<String>) -> Self {
        self.runs.push(Run { title, story });
        self
    }

    /// Holds a number that was `found` against the `answer`, from which it may differ by
    /// `tolerance`, in its unit.
    pub fn compare(self, quantity: &'static str, found: f64, answer: f64, tolerance: f64) -> Self {
        self.compare_all(quantity, [found], [answer], tolerance)
    }

    /// Holds numbers against as many answers, one after the other.
    pub fn compare_all(
        mut self,
        quantity: &'static str,
        found: impl IntoIterator<Item = f64>,
        answers: impl IntoIterator<Item = f64>,
        tolerance: f64,
    ) -> Self {
        let (found, answers) = (found.into_iter().collect(), answers.into_iter().collect());
        self.comparisons.push(Comparison { quantity, found, answers, tolerance });
        self
    }

    /// What differs by more than its tolerance, as sentences.
    pub fn disagreements(&self) -> Vec<String> {
        let wrong = |one: &&Comparison| {
            let agrees = one.error().is_some_and(|error| error <= one.tolerance);
            !agrees
        };
        self.comparisons.iter().filter(wrong).map(Comparison::to_sentence).collect()
    }

    /// The pictures: the name of a file, and an SVG document.
    pub fn pictures(&self) -> impl Iterator<Item = (String, &str)> {
        self.drawings.iter().map(|drawing| (self.picture_of(drawing), &*drawing.diagram))
    }

    fn picture_of(&self, drawing: &Drawing) -> String {
        format!("{}-{}.svg", self.name, drawing.title.replace(' ', "-"))
    }
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

/// The instants of the first `count` jumps of a run, in seconds.
pub fn instants(run: &Trajectory, count: usize) -> impl Iterator<Item = f64> {
    run.jumps().iter().take(count).map(|jump| jump.at.t)
}
