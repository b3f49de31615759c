//! What joins components: labels that are never taken, partners that never come, full channels, unread inputs.
//!
//! A label is taken by all components that know its event, together. Whether they ever can is a
//! question about their locations: those that components can be in at the same time are explored,
//! with every transition that is not proven to never fire. Guards are not looked at beyond that, so
//! that a label that is not reported may still be blocked by them; one that is, is.

use super::model::{Effect, Model, Motion};
use super::product::{Product, explore};
use super::reachability::Reach;
use super::report::{Finding, FindingPlace, Kind, Report, Severity};
use crate::composition::Composition;
use crate::composition::channel::{PLACES, Weakness};

/// An event that components take together.
pub(super) struct Label {
    pub(super) name: String,
    /// The components that know it, each with its number of the event.
    pub(super) participants: Vec<(usize, usize)>,
}

impl Label {
    fn all(models: &[Model]) -> Vec<Label> {
        let mut labels: Vec<Label> = Vec::new();
        for (component, model) in models.iter().enumerate() {
            let events = model.events.iter().zip(&model.is_label).enumerate();
            for (event, (name, _)) in events.filter(|(_, (_, is_label))| **is_label) {
                match labels.iter_mut().find(|label| label.name == *name) {
                    Some(label) => label.participants.push((component, event)),
                    None => labels
                        .push(Label { name: name.clone(), participants: vec![(component, event)] }),
                }
            }
        }
        labels
    }
}

pub(super) fn report_labels(models: &[Model], reaches: &[Reach], report: &mut Report) {
    let labels = Label::all(models);
    let mut is_refused = Vec::with_capacity(labels.len());
    for label in &labels {
        report_lonely(label, models, report);
        is_refused.push(report_refusals(label, models, reaches, report));
    }
    if labels.is_empty() {
        return;
    }
    let product = explore(models, reaches, &labels);
    let is_taken = |number: usize| is_refused[number] || product.takes(number);
    let all_taken = (0..labels.len()).all(is_taken);
    if !product.is_complete {
        if !all_taken || models.iter().zip(reaches).any(waits_for_labels) {
            report_unexplored(&product, report);
        }
        return;
    }
    let mut is_dead = is_refused.clone();
    for (number, label) in labels.iter().enumerate() {
        if !is_refused[number] && !product.takes(number) {
            is_dead[number] = true;
            report_blocked(label, models, report);
        }
    }
    report_deadlocks(models, reaches, &labels, &is_dead, &product, report);
}

/// Whether a component may have to wait for others.
fn waits_for_labels((model, reach): (&Model, &Reach)) -> bool {
    (0..model.transitions.len()).any(|number| {
        let is_forced = model.transitions[number].urgency.is_forced();
        reach.is_live[number] && is_forced && !model.is_own(number)
    })
}

fn report_unexplored(product: &Product, report: &mut Report) {
    let message = format!(
        "whether labels block is open: only {} combinations of locations were looked at",
        product.states.len()
    );
    report.add(Finding::new(Kind::Unexplored, Severity::Note, FindingPlace::default(), message));
}

fn report_lonely(label: &Label, models: &[Model], report: &mut Report) {
    if let [(component, _)] = label.participants[..] {
        let place = on_label(Some(&models[component]), label);
        let message = "no other component has an event of this name: rename one, or leave the \
                       label out";
        report.add(Finding::new(Kind::LonelyLabel, Severity::Warning, place, message.into()));
    }
}

/// Whether a component that knows the label can never take it.
fn report_refusals(
    label: &Label,
    models: &[Model],
    reaches: &[Reach],
    report: &mut Report,
) -> bool {
    let mut any = false;
    for &(component, event) in &label.participants {
        let model = &models[component];
        let on_event = |number: &usize| model.transitions[*number].event == event;
        let mut numbers = (0..model.transitions.len()).filter(on_event).peekable();
        let has_any = numbers.peek().is_some();
        if numbers.any(|number| reaches[component].is_live[number]) {
            continue;
        }
        any = true;
        let message = if has_any {
            "it has the label only on transitions that can never be taken, so that no one can \
             take it: see those"
        } else {
            "it has an event of this name and no transition on it, so that no one can ever take \
             the label: add a transition, or rename the event"
        };
        let place = on_label(Some(model), label);
        report.add(Finding::new(Kind::RefusedLabel, Severity::Error, place, message.into()));
    }
    any
}

fn report_blocked(label: &Label, models: &[Model], report: &mut Report) {
    let names = label.participants.iter().map(|(component, _)| named(&models[*component]));
    let message = format!(
        "{} never come together in locations that have it: let one wait for the others",
        names.collect::<Vec<_>>().join(" and ")
    );
    let place = on_label(None, label);
    report.add(Finding::new(Kind::BlockedLabel, Severity::Error, place, message));
}

/// Components that have to take a label, can do nothing else, and never will. One finding for each
/// of their locations.
fn report_deadlocks(
    models: &[Model],
    reaches: &[Reach],
    labels: &[Label],
    is_dead: &[bool],
    product: &Product,
    report: &mut Report,
) {
    for (component, model) in models.iter().enumerate() {
        let goes_on = product.goes_on(component);
        let mut known = Vec::new();
        for (state, locations) in product.states.iter().enumerate() {
            let location = locations[component];
            let waiting = model.modes[location].leaving.iter().copied().filter(|&number| {
                let is_forced = model.transitions[number].urgency.is_forced();
                let name = model.event(number);
                let label = labels.iter().position(|label| label.name == name);
                let is_alive = label.is_some_and(|label| !is_dead[label]);
                reaches[component].is_live[number] && is_forced && is_alive
            });
            let waiting: Vec<usize> = waiting.collect();
            if goes_on[state] || waiting.is_empty() || known.contains(&location) {
                continue;
            }
            known.push(location);
            let others = models.iter().zip(locations).enumerate();
            let others = others.filter(|(other, _)| *other != component);
            let others = others.map(|(_, (other, &location))| {
                format!("{} is in `{}`", named(other), other.modes[location].name)
            });
            let message = format!(
                "it waits for ever once {}: let them answer there, or let it give up",
                others.collect::<Vec<_>>().join(" and ")
            );
            let place = model.place_of(&waiting);
            let finding = if product.is_certain[state] {
                Finding::new(Kind::Deadlock, Severity::Warning, place, message)
            } else {
                let message = format!(
                    "{message}; whether they come there together depends on times and values, and \
                     is open"
                );
                Finding::new(Kind::Deadlock, Severity::Note, place, message)
            };
            report.add(finding);
        }
    }
}

/// Channels that do not carry all messages.
pub(super) fn report_channels(composition: &Composition, report: &mut Report) {
    for component in &composition.components {
        let Some(weakness) = component.weakness else { continue };
        let (kind, message) = match weakness {
            Weakness::Crowded { places, needed, period, longest } => {
                let remedy = match needed <= PLACES {
                    true => format!("let it hold {needed}, with `holding`"),
                    false => format!(
                        "no channel holds more than {PLACES}, so let the period be above {:e} s, or the longest \
                         time below {:e} s",
                        longest / PLACES as f64,
                        period * PLACES as f64
                    ),
                };
                let message = format!(
                    "messages are sent every {period} s and take up to {longest} s, so {needed} can be under way, \
                     and it holds {places}: {remedy}, or messages are lost"
                );
                (Kind::LosesMessages, message)
            }
            Weakness::Untimed => {
                let message = "nothing says when its messages arrive, and by default a run takes no arrival before an \
                               invariant ends: bound their delay with `taking`, as `taking(0.0, 0.0)` for none";
                (Kind::KeepsMessages, message.to_owned())
            }
        };
        let component = Some(component.name.clone());
        let place = FindingPlace { component, ..FindingPlace::default() };
        report.add(Finding::new(kind, Severity::Warning, place, message));
    }
}

/// Inputs that are connected for nothing.
pub(super) fn report_inputs(models: &[Model], report: &mut Report) {
    for model in models.iter().filter(|model| !has_functions(model)) {
        let read = model.variables();
        for input in model.inputs.iter().filter(|input| !read.contains(input)) {
            let place = FindingPlace {
                component: model.component.clone(),
                variable: Some(input.clone()),
                ..FindingPlace::default()
            };
            let message = "it is connected, and no formula reads it: leave the connection out";
            report.add(Finding::new(Kind::UnreadInput, Severity::Warning, place, message.into()));
        }
    }
}

fn has_functions(model: &Model) -> bool {
    let moved = |mode: &super::model::Mode| {
        matches!(mode.motion, Motion::Function(_)) || !mode.invariant.is_data()
    };
    let changed = |transition: &super::model::Transition| {
        matches!(transition.effect, Effect::Function(_)) || !transition.guard.predicate().is_data()
    };
    model.modes.iter().any(moved) || model.transitions.iter().any(changed)
}

fn on_label(model: Option<&Model>, label: &Label) -> FindingPlace {
    let component = model.and_then(|model| model.component.clone());
    FindingPlace { component, events: vec![label.name.clone()], ..FindingPlace::default() }
}

fn named(model: &Model) -> String {
    format!("`{}`", model.component.as_deref().unwrap_or("the automaton"))
}
