//! The page of a trajectory: a run of any automaton or composition.

use pleach_automaton::trajectory::{FlowInterval, JumpRecord, Participant, Sample};
use pleach_automaton::{Automaton, Reason, Trajectory, diagram};
use pleach_discrete::{Event, Location};
use pleach_guards::{EvaluationError, Program, Valuation};
use serde_json::{Value, json};

use super::document::{Document, Outcome, Row};

/// Makes the page on which a run of a hybrid automaton or a composition plays: one HTML file that
/// needs no other.
///
/// It shows the locations of each component as a time line, every variable and signal as a curve, the jumps,
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

    /// From where to where each variable and signal goes, at the samples.
    fn rows(&self) -> Vec<Row> {
        let curves = Curves::of(self.trajectory);
        let names = curves.names.iter().enumerate();
        let rows = names.map(|(place, name)| {
            let samples = self.trajectory.samples();
            let values = samples.map(|(_, sample)| curves.extended(sample).values[place]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                (low.min(v), high.max(v))
            });
            Row::new(*name, format!("from {low:.6} to {high:.6}"))
        });
        let jumps = self.trajectory.jumps().len();
        rows.chain([Row::new("jumps", jumps.to_string())]).collect()
    }

    fn data(&self) -> Value {
        let run = self.trajectory;
        let curves = Curves::of(run);
        let drawing = |component: &Participant| {
            self.drawings.iter().position(|drawing| drawing.locations == component.locations)
        };
        json!({
            "kind": "run",
            "variables": curves.names,
            "components": run.components().iter().map(|component| json!({
                "name": component.name,
                "locations": component.locations,
                "drawing": drawing(component),
            })).collect::<Vec<_>>(),
            "phases": run.intervals().map(|phase| phase_data(phase, &curves)).collect::<Vec<_>>(),
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

/// What curves show: the variables, and after them the signals.
struct Curves<'a> {
    names: Vec<&'a str>,
    /// The formula of each signal, and its derivatives by variables.
    signals: Vec<(Program, Vec<(usize, Program)>)>,
}

impl<'a> Curves<'a> {
    fn of(run: &'a Trajectory) -> Self {
        let variables = run.variables();
        let mut names: Vec<&str> = variables.iter().map(String::as_str).collect();
        let mut signals = Vec::new();
        for (name, formula) in run.signals() {
            let read = variables.iter().enumerate();
            let read = read.filter(|(_, variable)| formula.variables().contains(variable.as_str()));
            let slope = |(place, variable): (usize, &String)| {
                Ok((place, formula.derivative(variable).compile(variables)?))
            };
            let slopes = read.map(slope).collect::<Result<_, EvaluationError>>();
            if let (Ok(formula), Ok(slopes)) = (formula.compile(variables), slopes) {
                names.push(name);
                signals.push((formula, slopes));
            }
        }
        Curves { names, signals }
    }

    /// The sample with values and rates of signals; at a kink, where one has no rate, with 0 as its rate.
    fn extended(&self, sample: Sample) -> Sample {
        let Sample { t, mut values, mut rates } = sample;
        for (formula, slopes) in &self.signals {
            let rate = slopes.iter().map(|(place, slope)| slope.evaluate(&values) * rates[*place]);
            let rate: f64 = rate.sum();
            rates.push(if rate.is_finite() { rate } else { 0.0 });
            values.push(formula.evaluate(&values));
        }
        Sample { t, values, rates }
    }
}

fn phase_data(phase: FlowInterval, curves: &Curves<'_>) -> Value {
    let FlowInterval { locations, samples } = phase;
    let samples: Vec<Sample> = samples.into_iter().map(|one| curves.extended(one)).collect();
    let all = |numbers: &[f64]| numbers.iter().map(|&number| rounded(number)).collect::<Vec<_>>();
    json!({
        "locations": locations,
        "t": samples.iter().map(|sample| rounded(sample.t)).collect::<Vec<_>>(),
        "values": samples.iter().map(|sample| all(&sample.values)).collect::<Vec<_>>(),
        "rates": samples.iter().map(|sample| all(&sample.rates)).collect::<Vec<_>>(),
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
