//! Checks before anything runs: what is wrong with a model, where, and in which state it shows.
//!
//! ```
//! use pleach_automaton::check::{Kind, Severity};
//! use pleach_automaton::{Automaton, coordinates, from};
//! use pleach_discrete::vocabulary;
//!
//! vocabulary! {
//!     enum Heater: Location { Off = "off", On = "on" }
//!     enum Sensed: Event { Cold = "cold", Warm = "warm" }
//! }
//! coordinates! { struct Room { temperature = "T" } }
//! use {Heater::{Off, On}, Sensed::{Cold, Warm}};
//!
//! let Room { temperature } = Room::coordinates();
//! let heater = Automaton::starting_in(Off)
//!     .initially(Room { temperature: 20.0 })
//!     .range(&temperature, -20.0..=40.0)
//!     .flow(Off, temperature.rate(-0.1 * &temperature))
//!     .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
//!     .invariant(On, temperature.at_most(22.0))
//!     .transition(from(Off).on(Cold).to(On).must(temperature.at_most(18.0)))
//!     .transition(from(On).on(Warm).to(Off).must(temperature.at_least(23.0)))
//!     .build()?;
//!
//! let report = heater.check();
//! assert!(!report.is_sound());
//! let blocked = &report.findings()[0];
//! assert_eq!((blocked.severity, blocked.kind), (Severity::Error, Kind::Blocked));
//! assert_eq!(blocked.place.location, Some("on"));
//! assert_eq!(blocked.witness.as_ref().map(|state| state["T"]), Some(22.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is asked
//!
//! | [kind](Kind) | severity | the question |
//! | --- | --- | --- |
//! | blocked | error | where the flow leaves the invariant, does a guard hold? |
//! | empty invariant | warning | does the invariant hold anywhere? |
//! | lands outside | error; warning or note if a transition may or must lead on | do resets lead into the invariant of the target? |
//! | no value | warning | has every formula a finite value where it is evaluated? |
//! | leaves its range | warning | do they stay within the declared ranges? |
//! | timeless cycle | error | do forced transitions follow each other forever? |
//! | overlap | warning | can two forced transitions be due together? |
//! | choice | note | can two transitions be possible together that only may be taken? |
//! | shadowed priority | warning | is there a state in which it is its turn? |
//! | never fires, unreachable | warning | what can ever happen? |
//! | starts outside | error, or warning if a transition leads on | is the initial state within the invariant? |
//! | starts out of range, no initial state | warning | where does a run begin? |
//! | nothing moves | warning | does what a location waits for change there? |
//! | unchecked | note | what is a function? |
//! | refused label | error | does every component of a label ever take it? |
//! | blocked label | error | can they take it together? |
//! | lonely label | warning | does more than one component know it? |
//! | deadlock | warning, or note where it depends on times and values | does a component wait for labels forever? |
//! | loses messages | warning | does a channel hold all messages that a sampled component sends? |
//! | keeps messages | warning | does anything say when the messages of a channel arrive? |
//! | unread input | warning | is what is connected read? |
//! | unexplored | note | was something too large to be looked at? |
//!
//! Most of these are questions whether some predicate holds in some state within the declared
//! [ranges](crate::Builder::range): [`decision`](crate::decision) finds a witness, or proves that
//! there is none, or says that it does not know, which becomes a note. Whatever is not reached is
//! not looked at any further.
//!
//! # What a finding means
//!
//! A *witness* is a state that the formulas of one location, or of one jump, admit. Whether a run
//! comes to it is another question, which reachability answers (`confirm` in `pleach_verify::reach`,
//! from the [states](Finding::states) of a finding) and this does not: a
//! witness that cannot come up says that the model does not say so; an invariant or a range will.
//! That a transition never fires, on the other hand, is proven, for all runs that begin in the
//! initial location.
//!
//! A witness does not rest on rounding, either: numbers of a model are rounded, and what could hold
//! only where their last digits decide is a note.
//!
//! An automaton that is a part of a composition is best checked there: alone it knows neither who
//! takes its events together with it, nor what moves the variables that it reads.

mod blocking;
mod cycle;
mod definition;
mod inquiry;
mod labels;
mod landing;
pub(crate) mod model;
mod overlap;
mod product;
mod reachability;
mod report;
mod robustness;
mod sliding;
mod structure;

pub use report::{Exclusion, Finding, FindingPlace, Kind, Report, Severity};

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use crate::automaton::Automaton;
use crate::composition::Composition;
use crate::decision::Effort;
use inquiry::Inquiry;
use model::Model;
use reachability::Reach;

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// What is wrong with the automaton, as far as this is known before it runs; see
    /// [`check`](crate::check).
    pub fn check(&self) -> Report {
        self.check_with(Effort::default())
    }

    /// As [`check`](Self::check), with as much work for each question as `effort` says.
    pub fn check_with(&self, effort: Effort) -> Report {
        let model = Model::of(&self.outline(), &[]);
        let (inquiry, _) = examined(&model, effort);
        inquiry.report.finished()
    }
}

impl Composition {
    /// What is wrong with the components and with what joins them; see [`check`](crate::check).
    pub fn check(&self) -> Report {
        self.check_with(Effort::default())
    }

    /// As [`check`](Self::check), with as much work for each question as `effort` says.
    pub fn check_with(&self, effort: Effort) -> Report {
        let models = self.models();
        let mut report = Report::default();
        let mut reaches = Vec::with_capacity(models.len());
        for model in &models {
            let (inquiry, reach) = examined(model, effort);
            report.merge(inquiry.report);
            reaches.push(reach);
        }
        labels::report_labels(&models, &reaches, &mut report);
        labels::report_channels(self, &mut report);
        labels::report_inputs(&models, &mut report);
        report.finished()
    }
}

/// All that is asked of one automaton.
fn examined(model: &Model, effort: Effort) -> (Inquiry<'_>, Reach) {
    let mut inquiry = Inquiry::new(model, effort);
    let reach = inquiry.reach();
    inquiry.report_start();
    inquiry.report_blocking(&reach);
    inquiry.report_landings(&reach);
    inquiry.report_undefined(&reach);
    inquiry.report_cycles(&reach);
    inquiry.report_sliding(&reach);
    inquiry.report_overlaps(&reach);
    let shadowed = inquiry.report_shadowed(&reach);
    inquiry.report_unreached(&reach, &shadowed);
    inquiry.report_rest(&reach);
    inquiry.report_functions();
    (inquiry, reach)
}
