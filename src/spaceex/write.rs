//! Automata as models and configurations of SpaceEx.

use crate::automaton::{Assignment, Automaton, Coordinates, NewValue};
use crate::discrete::{Event, Location, Urgency};
use crate::guards::{Comparison, Expression, Predicate, Relation};
use crate::verify::reach::{
    Directions, Forbidden, Polytope, Settings, StateSet, Template, Uncertain,
};

use super::Initial;

/// A model and its configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// XML.
    pub model: String,
    /// Lines `key = value`.
    pub configuration: String,
}

/// The automaton and its question in the files of SpaceEx, as one base component called `system`.
///
/// Inputs become numbers that invariants bound, and signals numbers that invariants define. A transition that has to be taken gets
/// `asap="true"`. `shown` are the variables to be shown.
///
/// # Errors
///
/// A sentence that names what has no counterpart there: functions, predicates that are not
/// conjunctions of comparisons, formulas beyond arithmetic, and initial states that are a zonotope.
pub fn write<L: Location, E: Event, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    initial: &[Initial],
    forbidden: &[Forbidden],
    settings: &Settings,
    shown: &[String],
) -> Result<Written, String> {
    let writer = Writer { automaton, uncertain };
    Ok(Written {
        model: writer.model()?,
        configuration: writer.configuration(initial, forbidden, settings, shown)?,
    })
}

struct Writer<'a, L, E, S> {
    automaton: &'a Automaton<L, E, S>,
    uncertain: &'a [Uncertain],
}

impl<L: Location, E: Event, S: Coordinates> Writer<'_, L, E, S> {
    fn model(&self) -> Result<String, String> {
        let mut lines = vec![
            r#"<?xml version="1.0" encoding="utf-8"?>"#.to_owned(),
            r#"<sspaceex xmlns="http://www-verimag.imag.fr/xml-namespaces/sspaceex" version="0.2" math="SpaceEx">"#.to_owned(),
            r#"  <component id="system">"#.to_owned(),
        ];
        let number = |name: &str, dynamics: &str, controlled: bool| {
            format!(
                r#"    <param name="{}" type="real" local="false" d1="1" d2="1" dynamics="{dynamics}" controlled="{controlled}" />"#,
                escaped(name)
            )
        };
        lines.extend(self.automaton.names().iter().map(|name| number(name, "any", true)));
        let varies =
            |name: &str| self.uncertain.iter().any(|one| one.varies && one.parameter == name);
        for (name, _) in self.automaton.parameters() {
            lines.push(if varies(name) {
                number(name, "any", false)
            } else {
                number(name, "const", false)
            });
        }
        lines.extend(self.automaton.signals().map(|(name, _)| number(name, "any", false)));
        for event in self.automaton.events() {
            lines.push(format!(
                r#"    <param name="{}" type="label" local="false" />"#,
                escaped(event.name())
            ));
        }
        for (id, location) in (1..).zip(self.automaton.locations()) {
            lines.extend(self.location(id, *location)?);
        }
        let graph = self.automaton.graph();
        for edge in graph.edge_indices() {
            let Some((source, target)) = graph.edge_endpoints(edge) else { continue };
            let transition = &graph[edge];
            let urgent = if transition.urgency == Urgency::May { "" } else { r#" asap="true""# };
            let assignments = transition.reset.assignments().ok_or_else(|| {
                format!("the reset of event `{}` is a function", transition.event.name())
            })?;
            let assignments = assignments.iter().map(assignment).collect::<Result<Vec<_>, _>>()?;
            let assignments = assignments.join(" & ");
            lines.push(format!(
                r#"    <transition source="{}" target="{}"{urgent}>"#,
                source.index() + 1,
                target.index() + 1
            ));
            lines.push(format!("      <label>{}</label>", escaped(transition.event.name())));
            lines.push(format!(
                "      <guard>{}</guard>",
                escaped(&conjunction(transition.guard.predicate())?)
            ));
            lines.push(format!("      <assignment>{}</assignment>", escaped(&assignments)));
            lines.push("    </transition>".to_owned());
        }
        lines.extend(["  </component>".to_owned(), "</sspaceex>".to_owned(), String::new()]);
        Ok(lines.join("\n"))
    }

    fn location(&self, id: usize, location: L) -> Result<Vec<String>, String> {
        let mode = self.automaton.mode(location);
        let mut kept = Vec::new();
        if let Some(invariant) = mode.and_then(|mode| mode.invariant.as_ref()) {
            kept.push(conjunction(invariant)?);
        }
        let inputs = self.uncertain.iter().filter(|one| one.varies);
        kept.extend(inputs.map(|one| {
            format!(
                "{} <= {} & {} <= {}",
                one.values.lower(),
                one.parameter,
                one.parameter,
                one.values.upper()
            )
        }));
        for (name, formula) in self.automaton.signals() {
            kept.push(format!("{name} == {}", plain(formula)?));
        }
        kept.retain(|part| part != "true");
        let flow = mode.and_then(|mode| mode.flow.as_ref());
        let rates = match flow {
            Some(flow) => flow.rates().ok_or_else(|| {
                format!("the flow of location `{}` is a function", location.name())
            })?,
            None => &[],
        };
        let rate = |name: &&'static str| {
            let listed = rates.iter().find(|rate| rate.coordinate() == *name);
            let rate = listed.map_or(Ok("0".to_owned()), |rate| plain(rate.rate()))?;
            Ok(format!("{name}' == {rate}"))
        };
        let rates = self.automaton.names().iter().map(rate).collect::<Result<Vec<_>, String>>()?;
        Ok(vec![
            format!(r#"    <location id="{id}" name="{}">"#, escaped(location.name())),
            format!("      <invariant>{}</invariant>", escaped(&kept.join(" & "))),
            format!("      <flow>{}</flow>", escaped(&rates.join(" & "))),
            "    </location>".to_owned(),
        ])
    }

    fn configuration(
        &self,
        initial: &[Initial],
        forbidden: &[Forbidden],
        settings: &Settings,
        shown: &[String],
    ) -> Result<String, String> {
        let resting =
            self.uncertain.iter().filter(|one| !one.varies).map(|one| one.parameter.as_str());
        let names: Vec<&str> = self.automaton.names().iter().copied().chain(resting).collect();
        let is_uncertain = |name: &str| self.uncertain.iter().any(|one| one.parameter == name);
        let certain: Vec<String> = self
            .automaton
            .parameters()
            .filter(|(name, _)| !is_uncertain(name))
            .map(|(name, value)| format!("{name} == {value}"))
            .collect();
        let mut begins = Vec::new();
        for one in initial {
            let mut states = set(&one.states, &names)?;
            states.extend(certain.iter().cloned());
            for case in cases(&one.condition)? {
                let held = [states.clone(), case].concat().join(" & ");
                if one.locations.len() == self.automaton.locations().len() {
                    begins.push(held);
                    continue;
                }
                for location in &one.locations {
                    begins.push(format!("{held} & loc(system)=={location}"));
                }
            }
        }
        let mut ends = Vec::new();
        for one in forbidden {
            for case in cases(&one.states)? {
                let case = if case.is_empty() { "true".to_owned() } else { case.join(" & ") };
                ends.push(match &one.location {
                    Some(location) => format!("{case} & loc(system)=={location}"),
                    None => case,
                });
            }
        }
        let directions = match &settings.directions {
            Directions::Boxes => "box".to_owned(),
            Directions::Octagons => "oct".to_owned(),
            Directions::Listed(listed) => {
                let across = listed.iter().map(|direction| across(direction, &names));
                format!("{{{}}}", across.collect::<Vec<_>>().join(" & "))
            }
        };
        // A negative horizon is none.
        let horizon = if settings.horizon.is_finite() { settings.horizon } else { -1.0 };
        Ok(format!(
            "system = \"system\"\ninitially = \"{}\"\nforbidden = \"{}\"\ntime-horizon = {horizon}\n\
             sampling-time = {}\niter-max = {}\ndirections = \"{directions}\"\n\
             output-variables = \"{}\"\n",
            begins.join(" | "),
            ends.join(" | "),
            settings.step,
            settings.jump_limit,
            shown.join(", ")
        ))
    }
}

/// A linear constraint whose boundary a direction is across.
fn across(direction: &[f64], names: &[&str]) -> String {
    at_most(direction, 0.0, names)
}

/// d · x ≤ b.
fn at_most(direction: &[f64], bound: f64, names: &[&str]) -> String {
    let terms = direction.iter().zip(names).filter(|(entry, _)| **entry != 0.0);
    let terms = terms.map(|(entry, name)| format!("{entry} * {name}"));
    format!("{} <= {bound}", terms.collect::<Vec<_>>().join(" + "))
}

/// A set as its sides, and what cuts the box between them.
fn set(states: &StateSet, names: &[&str]) -> Result<Vec<String>, String> {
    if states.has_zonotope() {
        return Err("initial states that are a zonotope cannot be written: give their bounds as a box or a polytope".into());
    }
    let hull = states.hull();
    let sides = names.iter().zip(hull);
    let sides = sides
        .map(|(name, side)| format!("{} <= {name} & {name} <= {}", side.lower(), side.upper()));
    let cuts = states.polytope().into_iter().flat_map(|polytope| {
        let around = Polytope::around(Template::clone(polytope.template()), hull);
        let bounds = polytope.bounds().iter().zip(around.bounds().to_vec());
        let cuts = polytope.template().directions().iter().zip(bounds);
        let cuts = cuts.filter(|(_, (bound, widest))| **bound < *widest);
        cuts.map(|(direction, (bound, _))| at_most(direction, *bound, names)).collect::<Vec<_>>()
    });
    Ok(sides.chain(cuts).collect())
}

/// The alternatives of a predicate, each as comparisons that hold together.
fn cases(predicate: &Predicate) -> Result<Vec<Vec<String>>, String> {
    let form = predicate.disjunctive_form(256).map_err(|error| error.to_string())?;
    form.iter().map(|case| case.iter().map(compared).collect()).collect()
}

/// A conjunction of comparisons, in the spelling of keyboards.
fn conjunction(predicate: &Predicate) -> Result<String, String> {
    match predicate {
        Predicate::Comparison(comparison) => compared(comparison),
        Predicate::All(parts) if parts.is_empty() => Ok("true".to_owned()),
        Predicate::All(parts) => {
            let parts = parts.iter().map(conjunction).collect::<Result<Vec<_>, _>>()?;
            Ok(parts.join(" & "))
        }
        other => Err(format!("`{other}` is no conjunction of comparisons")),
    }
}

fn compared(comparison: &Comparison) -> Result<String, String> {
    let symbol = match comparison.relation {
        Relation::AtMost => "<=",
        Relation::LessThan => "<",
        Relation::AtLeast => ">=",
        Relation::MoreThan => ">",
    };
    Ok(format!("{} {symbol} {}", plain(&comparison.left)?, plain(&comparison.right)?))
}

/// An assignment, of a value or of bounds on it.
fn assignment(assignment: &Assignment) -> Result<String, String> {
    let name = assignment.coordinate();
    Ok(match assignment.value() {
        NewValue::Exactly(value) => format!("{name} := {}", plain(value)?),
        NewValue::Within(lower, upper) => {
            format!("{name}' >= {} & {name}' <= {}", plain(lower)?, plain(upper)?)
        }
    })
}

/// A formula in the spelling of keyboards.
fn plain(formula: &Expression) -> Result<String, String> {
    let text = formula.to_string();
    let mut plain = String::new();
    for character in text.chars() {
        match character {
            '−' => plain.push('-'),
            '·' => plain.push('*'),
            '÷' => plain.push('/'),
            '²' => plain.push_str("^2"),
            '³' => plain.push_str("^3"),
            '√' => return Err(format!("`{text}` has a root, which the format lacks")),
            other => plain.push(other),
        }
    }
    Ok(plain)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
