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

pub use number::number;

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
    trajectory: Trajectory,
}

/// A number that a run gives beside the one that it should give.
struct Comparison {
    quantity: String,
    found: f64,
    answer: f64,
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
    pub fn run(mut self, title: &'static str, trajectory: Trajectory) -> Self {
        self.runs.push(Run { title, trajectory });
        self
    }

    /// Holds a number that was `found` against the `answer`, from which it may differ by
    /// `tolerance`, in its unit.
    pub fn compare(
        mut self,
        quantity: impl Into<String>,
        found: f64,
        answer: f64,
        tolerance: f64,
    ) -> Self {
        self.comparisons.push(Comparison { quantity: quantity.into(), found, answer, tolerance });
        self
    }

    /// Holds the instants of the jumps of a run, in seconds, against the `answers`, one after the
    /// other; there may be more of either.
    pub fn compare_jumps(
        mut self,
        trajectory: &Trajectory,
        answers: impl IntoIterator<Item = f64>,
        tolerance: f64,
    ) -> Self {
        for (number, (jump, answer)) in (1..).zip(trajectory.jumps().iter().zip(answers)) {
            let quantity = format!("jump {number}, {}, in s", jump.label);
            self = self.compare(quantity, jump.at.t, answer, tolerance);
        }
        self
    }

    /// What differs by more than its tolerance, as sentences.
    pub fn disagreements(&self) -> Vec<String> {
        let wrong = |one: &&Comparison| one.error().is_nan() || one.error() > one.tolerance;
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
    fn error(&self) -> f64 {
        (self.found - self.answer).abs()
    }

    fn to_sentence(&self) -> String {
        let Comparison { quantity, found, answer, tolerance } = self;
        format!("{quantity}: {found} differs from {answer} by more than {tolerance:e}")
    }
}
