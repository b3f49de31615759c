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
//! | kind | severity | asked by |
//! | --- | --- | --- |
//! | [`Blocked`](Kind::Blocked), [`EmptyInvariant`](Kind::EmptyInvariant) | error, warning | where the flow leaves the invariant, does a guard hold? |
//! | [`LandsOutside`](Kind::LandsOutside), [`LeavesRange`](Kind::LeavesRange) | error, warning | where do resets lead? |
//! | [`TimelessCycle`](Kind::TimelessCycle) | error, note | do forced transitions follow each other for ever? |
//! | [`Overlap`](Kind::Overlap), [`Choice`](Kind::Choice), [`Shadowed`](Kind::Shadowed) | warning, note, warning | which transitions can be due together? |
//! | [`NeverFires`](Kind::NeverFires), [`Unreachable`](Kind::Unreachable) | warning | what can ever happen? |
//! | [`StartsOutside`](Kind::StartsOutside), [`StartsOutOfRange`](Kind::StartsOutOfRange), [`NoInitialState`](Kind::NoInitialState) | error, warning, warning | can a run begin? |
//! | [`NothingMoves`](Kind::NothingMoves) | warning | does what a location waits for change there? |
//! | [`Unchecked`](Kind::Unchecked) | note | what is a function? |
//! | [`RefusedLabel`](Kind::RefusedLabel), [`BlockedLabel`](Kind::BlockedLabel), [`LonelyLabel`](Kind::LonelyLabel) | error, error, warning | can the components of a label take it together? |
//! | [`Deadlock`](Kind::Deadlock) | warning | does a component wait for labels for ever? |
//! | [`UnreadInput`](Kind::UnreadInput) | warning | is what is connected read? |
//!
//! Most of these are questions whether some predicate holds in some state within the declared
//! [ranges](crate::Builder::range): [`decision`](crate::decision) finds a witness, or proves that
//! there is none, or says that it does not know, which becomes a note. Whatever is not reached is
//! not looked at any further.
//!
//! # What a finding means
//!
//! A *witness* is a state that the formulas of one location, or of one jump, admit. Whether a run
//! comes to it is another question, which reachability analysis answers and this does not: a
//! witness that cannot come up says that the model does not say so; an invariant or a range will.
//! That a transition never fires, on the other hand, is proven, for all runs that begin in the
//! initial location.
//!
//! An automaton that is a part of a composition is best checked there: alone it knows neither who
//! takes its events together with it, nor what moves the variables that it reads.

mod blocking;
mod cycle;
mod inquiry;
mod labels;
mod landing;
pub(crate) mod model;
mod overlap;
mod product;
mod reachability;
mod report;
mod structure;

pub use report::{Exclusion, Finding, Kind, Place, Report, Severity};

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use crate::automaton::Automaton;
use crate::composition::Composition;
use crate::decision::Effort;
use inquiry::Inquiry;
use model::Model;
use reachability::Reach;

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// What is wrong with the automaton, as far as that can be told before it runs; see
    /// [`check`](crate::check).
    pub fn check(&self) -> Report {
        self.check_with(Effort::default())
    }

    /// As [`check`](Self::check), with as much work for each question as `effort` says.
    pub fn check_with(&self, effort: Effort) -> Report {
        let model = Model::of(self);
        let (inquiry, _) = examined(&model, effort);
        inquiry.report.sorted()
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
        labels::report_inputs(&models, &mut report);
        report.sorted()
    }
}

/// All that is asked of one automaton.
fn examined(model: &Model, effort: Effort) -> (Inquiry<'_>, Reach) {
    let mut inquiry = Inquiry::new(model, effort);
    let reach = inquiry.reach();
    inquiry.report_start();
    inquiry.report_blocking(&reach);
    inquiry.report_landings(&reach);
    inquiry.report_cycles(&reach);
    inquiry.report_overlaps(&reach);
    let shadowed = inquiry.report_shadowed(&reach);
    inquiry.report_unreached(&reach, &shadowed);
    inquiry.report_rest(&reach);
    inquiry.report_functions();
    (inquiry, reach)
}
