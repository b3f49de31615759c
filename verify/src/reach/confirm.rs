//! Whether what checks have found comes up in runs.
//!
//! [`Automaton::check`] says in which states a fault shows that the formulas of one location or jump
//! admit. Here it is asked whether any run comes to such a state.

use std::ops::ControlFlow;

use pleach_automaton::check::{Finding, Report};
use pleach_automaton::{Automaton, Coordinates};
use pleach_discrete::{Event, Location};
use pleach_guards::{Comparison, Interval, Predicate, Relation};

use super::explore::Completion;
use super::falsify::{Counterexample, falsify};
use super::model::{Model, ModelError, Uncertain};
use super::question::{Forbidden, ReachError, prove};
use super::region::{Region, RegionError};
use super::search::Effort;
use super::set::StateSet;
use super::settings::Settings;

/// A finding, and whether a run comes to it.
#[derive(Clone, Debug)]
pub struct Confirmed {
    /// The finding.
    pub finding: Finding,
    /// Whether a run comes to one of its states.
    pub reachability: Reachability,
}

/// Whether a run comes to states.
#[derive(Clone, Debug)]
pub enum Reachability {
    /// This one does.
    Reachable(Box<Counterexample>),
    /// None does, up to the horizon: a proof.
    Unreachable,
    /// Neither was found.
    Undecided,
    /// The question cannot be asked of sets.
    Unasked(RegionError),
}

/// Says of every finding of a report that names states whether a run of the automaton comes to one
/// of them. Runs begin in one of `starts`, or in the initial state if there are none. The boundaries of
/// the states count as states, since a jump lands beside them.
///
/// # Errors
///
/// [`ReachError`] if the automaton cannot be enclosed, or a set or a setting makes no sense.
///
/// ```
/// use pleach_automaton::check::Kind;
/// use pleach_automaton::{Automaton, coordinates, from};
/// use pleach_discrete::vocabulary;
/// use pleach_verify::reach::{Effort, Reachability, Settings, confirm};
///
/// vocabulary! {
///     enum Motion: Location { Turning = "turning", Up = "up", Right = "right" }
///     enum Seen: Event { North = "north", East = "east" }
/// }
/// coordinates! { struct Point { x, y } }
/// let Point { x, y } = Point::coordinates();
/// let turning = Automaton::starting_in(Motion::Turning)
///     .initially(Point { x: 1.0, y: 0.0 })
///     .flow(Motion::Turning, [x.rate(-&y), y.rate(&x)])
///     .transition(from(Motion::Turning).on(Seen::North).to(Motion::Up).must(y.at_least(0.9)))
///     .transition(from(Motion::Turning).on(Seen::East).to(Motion::Right).must(x.at_least(1.5)))
///     .build()?;
///
/// // Both could be due in one state; but no run on the unit circle comes there.
/// let report = turning.check();
/// assert!(report.findings().iter().any(|finding| finding.kind == Kind::Overlap));
/// let answers = confirm(&turning, &report, &[], &[], &Settings::default(), &Effort::default())?;
/// assert!(matches!(answers[0].reachability, Reachability::Unreachable));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn confirm<L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    report: &Report,
    uncertain: &[Uncertain],
    starts: &[StateSet],
    settings: &Settings,
    effort: &Effort,
) -> Result<Vec<Confirmed>, ReachError> {
    let model = Model::with_uncertain(automaton, uncertain)?;
    let initial = automaton.initial_state().ok_or(ModelError::Initial)?.to_values();
    let resting = uncertain.iter().filter(|one| !one.varies).map(|one| one.values);
    let point = initial.into_iter().map(Interval::point).chain(resting).collect();
    let alone = [StateSet::from_box(point)];
    let starts = if starts.is_empty() { &alone } else { starts };

    let asked = report.findings().iter().filter_map(|finding| {
        let states = boundaries_in(&finding.states.as_ref()?.negation_normal_form());
        let location = finding.place.location.map(str::to_owned);
        Some((finding.clone(), Forbidden { location, states }))
    });
    let (can, cannot): (Vec<_>, Vec<_>) = asked
        .map(|(finding, states)| {
            let region = Region::exactly(&states.states, model.variables());
            (finding, states, region.err())
        })
        .partition(|(_, _, error)| error.is_none());
    let forbidden: Vec<Forbidden> = can.iter().map(|(_, states, _)| states.clone()).collect();
    let go_on = &mut |_| ControlFlow::Continue(());
    let proof = prove(&model, starts, &forbidden, settings, go_on)?;
    let is_complete =
        matches!(proof.enclosure.ending, Completion::Horizon | Completion::Everything);
    let answered = can.into_iter().enumerate().map(|(number, (finding, states, _))| {
        let is_met = proof.doubts.iter().any(|doubt| doubt.forbidden == number);
        let search = || {
            let states = std::slice::from_ref(&states);
            falsify(automaton, uncertain, starts, states, settings, effort)
        };
        let reachability = if is_complete && !is_met {
            Reachability::Unreachable
        } else {
            match search() {
                Some(run) if run.is_violation => Reachability::Reachable(Box::new(run)),
                _ => Reachability::Undecided,
            }
        };
        Confirmed { finding, reachability }
    });
    let unasked = cannot.into_iter().filter_map(|(finding, _, error)| {
        Some(Confirmed { finding, reachability: Reachability::Unasked(error?) })
    });
    Ok(answered.chain(unasked).collect())
}

/// The predicate in negation normal form with the boundary of every comparison.
fn boundaries_in(predicate: &Predicate) -> Predicate {
    let each = |parts: &[Predicate]| parts.iter().map(boundaries_in).collect::<Vec<_>>();
    match predicate {
        Predicate::Comparison(comparison) => {
            let relation = match comparison.relation {
                Relation::AtMost | Relation::LessThan => Relation::AtMost,
                Relation::AtLeast | Relation::MoreThan => Relation::AtLeast,
            };
            Predicate::Comparison(Comparison { relation, ..comparison.clone() })
        }
        Predicate::All(parts) => Predicate::all(each(parts)),
        Predicate::Any(parts) => Predicate::any(each(parts)),
        other => other.clone(),
    }
}
