//! The page of a trajectory: a run of any automaton or composition.

use pleach_automaton::trajectory::{FlowInterval, JumpRecord, Participant};
use pleach_automaton::{Automaton, Reason, Trajectory, diagram};
use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;
use serde_json::{Value, json};

use super::document::{Document, Outcome, Row};

/// Makes the page on which a run of a hybrid automaton or a composition plays: one HTML file that
/// needs no other.
///
/// It shows the locations of each component as a time line, every variable as a curve, the jumps,
/// and the drawings of the automata with the active location lit. Numbers are those of the
/// trajectory, to nine digits; between samples they follow the cubic that has the samples' values
/// and rates.
///
/// ```
/// use pleach::page::TrajectoryPage;
/// use pleach::prelude::*;
///
/// vocabulary! {
///     enum Lamp: Location { Dark = "dark", Lit = "lit" }
///     enum Timer: Event { Elapsed = "elapsed" }
/// }
/// coordinates! { struct Clock { clock } }
/// let Clock { clock } = Clock::coordinates();
/// let lamp = Automaton::starting_in(Lamp::Lit)
///     .initially(Clock { clock: 0.0 })
///     .flow(Lamp::Lit, clock.rate(1.0))
///     .transition(from(Lamp::Lit).on(Timer::Elapsed).to(Lamp::Dark).must(clock.at_least(2.5)))
///     .build()?;
/// let run = lamp.run(4.0)?;
///
/// let page = TrajectoryPage::new("A lamp", &run).drawing(&lamp).render();
/// assert!(page.starts_with("<!DOCTYPE html>") && page.contains("elapsed"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TrajectoryPage<'a> {
    title: String,
    lead: Option<String>,
    trajectory: &'a Trajectory,
    drawings: Vec<Drawing>,
}

/// The drawing of an automaton. It belongs to the components of a run that have these locations.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawing {
    locations: Vec<&'static str>,
    svg: String,
}

impl Drawing {
    /// The drawing of `automaton`.
    pub fn of<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> Drawing {
        let locations = automaton.locations().iter().map(|location| location.name()).collect();
        Drawing { locations, svg: diagram::svg(automaton) }
    }
}

impl<'a> TrajectoryPage<'a> {
    /// The page of a run, without drawings.
    pub fn new(title: impl Into<String>, trajectory: &'a Trajectory) -> Self {
        TrajectoryPage { title: title.into(), lead: None, trajectory, drawings: Vec::new() }
    }

    /// Puts a sentence below the title.
    #[must_use]
    pub fn lead(self, lead: impl Into<String>) -> Self {
        TrajectoryPage { lead: Some(lead.into()), ..self }
    }

    /// Adds the drawing of an automaton that runs, by itself or as a component.
    #[must_use]
    pub fn drawing<L: Location, E: Event, S: Valuation>(
        self,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        self.drawings([Drawing::of(automaton)])
    }

    /// Adds drawings.
    #[must_use]
    pub fn drawings(mut self, drawings: impl IntoIterator<Item = Drawing>) -> Self {
        self.drawings.extend(drawings);
        self
    }

    /// The page, an HTML document.
    #[must_use]
    pub fn render(&self) -> String {
        let document = Document {
            title: &self.title,
            lead: self.lead.as_deref(),
            outcome: self.outcome(),
            summary: self.rows(),
            data: self.data(),
        };
        document.render()
    }

    fn outcome(&self) -> Outcome {
        let (class, headline) = match self.trajectory.ending().reason {
            Reason::Horizon => ("good", "complete"),
            Reason::Zeno(_) => ("doubtful", "Zeno"),
            Reason::Finished(_) => ("bad", "failed"),
            _ => ("doubtful", "ended"),
        };
        let text = diagram::outcome(self.trajectory);
        Outcome { class, headline: headline.to_owned(), text }
    }

    /// From where to where each variable goes, at the samples.
    fn rows(&self) -> Vec<Row> {
        let names = self.trajectory.variables().iter().enumerate();
        let rows = names.map(|(variable, name)| {
            let values = self.trajectory.samples().map(|(_, sample)| sample.values[variable]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(v), high.max(v))
            });
            Row::new(name.as_str(), format!("from {low:.6} to {high:.6}"))
        });
        let jumps = self.trajectory.jumps().len();
        rows.chain([Row::new("jumps", jumps.to_string())]).collect()
    }

    fn data(&self) -> Value {
        let run = self.trajectory;
        let drawing = |component: &Participant| {
            self.drawings.iter().position(|drawing| drawing.locations == component.locations)
        };
        json!({
            "kind": "run",
            "variables": run.variables(),
            "components": run.components().iter().map(|component| json!({
                "name": component.name,
                "locations": component.locations,
                "drawing": drawing(component),
            })).collect::<Vec<_>>(),
            "phases": run.intervals().map(|phase| phase_data(&phase)).collect::<Vec<_>>(),
            "events": run.jumps().iter().map(|jump| self.jump_data(jump)).collect::<Vec<_>>(),
            "end": rounded(run.ending().at.t),
            "drawings": self.drawings.iter().map(|drawing| &drawing.svg).collect::<Vec<_>>(),
        })
    }

    fn jump_data(&self, jump: &JumpRecord) -> Value {
        let components = self.trajectory.components();
        let moves = jump.moves.iter().map(|one| {
            let Participant { name, locations } = &components[one.component];
            let (source, target) = (&locations[one.source], &locations[one.target]);
            let way = match source == target {
                true => format!("in {source}"),
                false => format!("{source} → {target}"),
            };
            if components.len() > 1 { format!("{name}: {way}") } else { way }
        });
        let moves: Vec<String> = moves.collect();
        json!({ "at": rounded(jump.at.t), "text": format!("{}, {}", jump.label, moves.join("; ")) })
    }
}

fn phase_data(phase: &FlowInterval) -> Value {
    let all = |numbers: &[f64]| numbers.iter().map(|&number| rounded(number)).collect::<Vec<_>>();
    json!({
        "locations": phase.locations,
        "t": phase.samples.iter().map(|sample| rounded(sample.t)).collect::<Vec<_>>(),
        "values": phase.samples.iter().map(|sample| all(&sample.values)).collect::<Vec<_>>(),
        "rates": phase.samples.iter().map(|sample| all(&sample.rates)).collect::<Vec<_>>(),
    })
}

/// To nine digits, more than any screen shows.
fn rounded(number: f64) -> f64 {
    format!("{number:.8e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pleach_automaton::{Name, Record, from};

    /// The locations of a model made from data are known to the automaton, not to its type.
    #[test]
    fn a_model_made_from_data_has_its_drawing() {
        let clock = Record::new([("x", 0.0)]).unwrap();
        let x = clock.coordinate("x").unwrap();
        let [on, off] = ["on", "off"].map(Name::new);
        let lamp = Automaton::<Name, Name, Record>::starting_in(on)
            .initially(clock)
            .flow(on, x.rate(1.0))
            .transition(from(on).on(Name::new("out")).to(off).must(x.at_least(1.0)))
            .build()
            .unwrap();
        let run = lamp.run(2.0).unwrap();
        let data = TrajectoryPage::new("A lamp", &run).drawing(&lamp).data();
        assert_eq!(data["components"][0]["drawing"], 0);
    }
}
