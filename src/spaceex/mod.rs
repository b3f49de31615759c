//! Models and questions of SpaceEx, read and written.
//!
//! A model is an XML file of components, a configuration a text file that says where runs begin,
//! where they must not come, and for how long. A network of components becomes one automaton over
//! [names](crate::automaton::Name), whose locations are tuples of those of the components
//! (G. Frehse et al., *SpaceEx: scalable verification of hybrid systems*, CAV 2011).
//!
//! | in the file | in the automaton |
//! | --- | --- |
//! | a number with a flow | a coordinate |
//! | a number without a flow, bounded by invariants | an input, which varies within the bounds; what is enclosed has the ends of strict ones, too. Where its bounds depend on the location, the input is its share of the way from their middle, `u_share` |
//! | a number that every location's invariant says is a formula, `y == x1 + 2*x2` | a [signal](crate::automaton::Builder::signal) |
//! | a constant that is bound, or given by `initially` | a parameter, uncertain where an interval is given |
//! | a transition | one that may be taken; with `asap="true"`, has to be |
//! | `x' >= a & x' <= b` in an assignment | any value within the bounds |
//! | flow `false` | the state rests |
//! | no `loc(…)` in `initially` | every location is initial |
//! | `component.x` in the configuration | what `x` of an inner component is bound to, or else its own number |
//! | `directions = "{x + y <= 0 & …}"` | bounds across these constraints, and on every variable |
//! | `time-horizon` | how long runs last, with all their jumps; of SpaceEx each flow. Below 0: for ever |
//!
//! What is not supported is refused with its line: inclusions of rates, vectors and matrices as
//! parameters, equalities with alternatives in invariants and guards.

mod answer;
mod configuration;
mod document;
mod formula;
mod network;
mod product;
mod write;

use thiserror::Error;

use crate::automaton::{Automaton, Name, Record};
use crate::guards::Predicate;
use crate::verify::reach::{Forbidden, Settings, Starts, StateSet, Uncertain};

pub use answer::{Solution, Verdict};
pub use write::{Written, write};

/// A model with its question.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The name of the system.
    pub system: String,
    /// The automaton, once for each location in which runs begin.
    pub automata: Vec<Automaton<Name, Name, Record>>,
    /// Inputs and parameters that are only known to lie in intervals.
    pub uncertain: Vec<Uncertain>,
    /// Where runs begin.
    pub initial: Vec<Initial>,
    /// Where they must not come.
    pub forbidden: Vec<Forbidden>,
    /// Horizon, step, directions and jumps, as the configuration says them.
    pub settings: Settings,
    /// The variables to be shown, if the configuration names some.
    pub shown: Vec<String>,
}

/// Where runs begin.
#[derive(Clone, Debug, PartialEq)]
pub struct Initial {
    /// The names of the locations.
    pub locations: Vec<String>,
    /// The states, over the coordinates and the parameters that do not vary.
    pub states: StateSet,
    /// What holds where runs begin and the states cannot express: strict comparisons, whose boundary they include;
    /// comparisons that are not affine; and bounds on inputs, each of which has one value in a run that is tried.
    pub condition: Predicate,
}

impl Initial {
    /// Where runs that are searched for begin.
    fn starts(&self) -> Starts<'_> {
        Starts { sets: std::slice::from_ref(&self.states), condition: Some(&self.condition) }
    }
}

/// Why a model cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SpaceExError {
    /// The model is malformed or not supported.
    #[error("line {line} of the model: {problem}")]
    Model {
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// The configuration is malformed or not supported.
    #[error("line {line} of the configuration: {problem}")]
    Configuration {
        /// The line, from 1; 0 where a line is missing.
        line: usize,
        /// What is wrong.
        problem: String,
    },
}

/// Reads a model and its configuration, both given as text.
///
/// # Errors
///
/// [`SpaceExError`] with the line and what would be right.
pub fn read(model: &str, configuration: &str) -> Result<Problem, SpaceExError> {
    let components = document::read(model)?;
    let options = configuration::Options::read(configuration)?;
    product::problem(&components, options)
}
