//! The friendly competition's list (ARCH-COMP, categories AFF and NLN): which instances are proven
//! here, and how long it takes.
//!
//! ```sh
//! cargo run --release -p pleach-verify --example competition                          # prints the table
//! cargo run --release -p pleach-verify --example competition -- docs/reachability.md  # writes it there
//! ```
//!
//! Times are processor time of one thread. A name instead of a file runs the instances whose names begin
//! with it. A number at the end draws as many simulated runs of each instance and fails if one leaves its
//! enclosure.

mod building;
mod gearbox;
mod heat;
mod nonlinear;
mod platoon;
mod predators;
mod rendezvous;

use std::ops::ControlFlow;
use std::time::Instant;

use pleach_automaton::{Automaton, Name, Record};
use pleach_guards::Interval;
use pleach_verify::reach::{
    Completion, Counterexample, Directions, Effort, Forbidden, Model, Polytope, Proof, Settings,
    Span, StateSet, Uncertain, falsify, prove, runs,
};

use heat::Heat;

type TestResult<T> = Result<T, Box<dyn std::error::Error>>;

/// A question of the list.
enum Task {
    /// Whether an automaton comes to forbidden states.
    Automaton(Box<Instance>),
    /// How hot the middle of a cube becomes.
    Heat(Heat),
}

/// What came of a question.
pub struct Outcome {
    answer: &'static str,
    /// How many sets there are.
    sets: usize,
    /// The smallest distance to what is forbidden.
    away: Option<f64>,
    /// What the list asks to be measured.
    measured: String,
    /// The values of a quantity over time, where nothing else is enclosed.
    spans: Vec<Span>,
}

/// An automaton, where it begins and where it may not come.
pub struct Instance {
    automaton: Automaton<Name, Name, Record>,
    /// Where it begins: in one of these.
    starts: Vec<StateSet>,
    uncertain: Vec<Uncertain>,
    forbidden: Vec<Forbidden>,
    settings: Settings,
    measured: Vec<Measure>,
}

impl Instance {
    /// The instance with its initial set cut into parts.
    fn cut(mut self, parts: &[usize]) -> Self {
        self.starts = self.starts.iter().flat_map(|start| start.parts(parts)).collect();
        self
    }
}

/// What the list asks to be measured of the states during the last step.
#[derive(Clone, Copy)]
pub enum Measure {
    /// The width of a variable.
    Width(&'static str),
    /// The product of the widths of two.
    Area(&'static str, &'static str),
    /// The width of the sum of all.
    Sum,
    /// The largest value of a clock, in seconds.
    Clock(&'static str),
}

/// The lines between which the table stands in a document.
const MARKS: [&str; 2] = ["<!-- begin of the table -->", "<!-- end of the table -->"];

fn main() -> TestResult<()> {
    let argument = std::env::args().nth(1);
    let document = argument.as_ref().filter(|argument| argument.ends_with(".md"));
    let is_name = |argument: &&String| document.is_none() && argument.parse::<usize>().is_err();
    let prefix = argument.as_ref().filter(is_name);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut table = String::from(
        "| instance | answer | time | sets | stays away by | at the end |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    let count: Option<usize> =
        std::env::args().next_back().and_then(|argument| argument.parse().ok());
    for (name, task) in tasks()? {
        if prefix.is_some_and(|prefix| !name.starts_with(prefix.as_str())) {
            continue;
        }
        let answered = pool.install(|| {
            let begin = (Instant::now(), processor_time());
            let answered = answered(&task).map_err(|error| error.to_string())?;
            let seconds = match (begin.1, processor_time()) {
                (Some(begin), Some(end)) => end - begin,
                _ => begin.0.elapsed().as_secs_f64(),
            };
            Ok::<_, String>((answered, seconds))
        });
        let ((outcome, enclosed), seconds) = answered?;
        let line = line(name, &outcome, seconds);
        eprint!("{line}");
        match (&task, enclosed, count) {
            (Task::Automaton(instance), Some((model, proof)), Some(count)) => {
                simulated(name, instance, &model, &proof, count)?;
            }
            (Task::Heat(heat), _, Some(count)) => heat.simulated(name, &outcome, count)?,
            _ => {}
        }
        table.push_str(&line);
    }
    match document {
        None => print!("{table}"),
        Some(path) => {
            let text = std::fs::read_to_string(path)?;
            let (before, rest) = text.split_once(MARKS[0]).ok_or("the document has no table")?;
            let (_, after) = rest.split_once(MARKS[1]).ok_or("the table has no end")?;
            std::fs::write(path, format!("{before}{}\n{table}{}{after}", MARKS[0], MARKS[1]))?;
        }
    }
    Ok(())
}

/// The outcome of a question, and the enclosure of an automaton.
fn answered(task: &Task) -> TestResult<(Outcome, Option<(Model, Proof)>)> {
    match task {
        Task::Heat(heat) => Ok((heat.solve()?, None)),
        Task::Automaton(instance) => {
            let (model, proof) = solved(instance)?;
            Ok((outcome(instance, &model, &proof), Some((model, proof))))
        }
    }
}

/// For how long this thread has been running, in seconds; `None` where the system does not say.
fn processor_time() -> Option<f64> {
    let statistics = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = statistics.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

fn solved(instance: &Instance) -> TestResult<(Model, Proof)> {
    let model = Model::with_uncertain(&instance.automaton, &instance.uncertain)?;
    let go_on = &mut |_| ControlFlow::Continue(());
    let proof = prove(&model, &instance.starts, &instance.forbidden, &instance.settings, go_on)?;
    Ok((model, proof))
}

/// Fails if one of `count` simulated runs leaves the enclosure of all runs.
fn simulated(
    name: &str,
    instance: &Instance,
    model: &Model,
    proof: &Proof,
    count: usize,
) -> TestResult<()> {
    /// The simulator's tolerances of 1e-9 add up to less.
    const ERROR: f64 = 1e-6;
    if !matches!(proof.enclosure.ending, Completion::Horizon | Completion::Everything) {
        return Ok(());
    }
    let Instance { automaton, uncertain, starts, settings, .. } = instance;
    let drawn = runs(automaton, uncertain, &starts[..], settings, count, 1);
    let own = automaton.names().len();
    for run in &drawn {
        let constants = &run.start[own..];
        if let Some(escape) = proof.enclosure.escape(model, &run.trajectory, constants, ERROR) {
            return Err(format!("{name}: a run from {:?} escapes: {escape}", run.start).into());
        }
    }
    eprintln!("    {} simulated runs are inside", drawn.len());
    Ok(())
}

fn outcome(instance: &Instance, model: &Model, proof: &Proof) -> Outcome {
    let found = if proof.holds() { None } else { violation(instance) };
    let answer = match (proof.holds(), instance.forbidden.is_empty(), &found) {
        (true, true, _) => "enclosed",
        (true, false, _) => "holds",
        (false, _, Some(_)) => "violated",
        (false, _, None) => "undecided",
    };
    let sets = proof.enclosure.visits.iter().map(|visit| visit.segments.len()).sum();
    let nearest = proof.clearances.iter().copied().fold(f64::INFINITY, f64::min);
    let away = nearest.is_finite().then_some(nearest);
    let measured = match found {
        Some(found) => format!("a run is beyond by {:.3} at {:.2} s", found.margin, found.at.t),
        None => {
            let measures = instance.measured.iter();
            let texts = measures.filter_map(|measure| measured(*measure, instance, model, proof));
            texts.collect::<Vec<_>>().join(", ")
        }
    };
    Outcome { answer, sets, away, measured, spans: Vec::new() }
}

/// A run that comes to forbidden states.
fn violation(instance: &Instance) -> Option<Counterexample> {
    let Instance { automaton, starts, uncertain, forbidden, settings, .. } = instance;
    let effort = Effort::default();
    let found = falsify(automaton, uncertain, &starts[..], forbidden, settings, &effort)?;
    found.is_violation.then_some(found)
}

/// A line of the table.
fn line(name: &str, outcome: &Outcome, seconds: f64) -> String {
    let Outcome { answer, sets, away, measured, .. } = outcome;
    let away = away.map(|away| match away.abs() {
        small if small > 0.0 && small < 1e-3 => format!("{away:.1e}"),
        _ => format!("{away:.3}"),
    });
    let away = away.unwrap_or_default();
    format!("| {name} | {answer} | {seconds:.2} s | {sets} | {away} | {measured} |\n")
}

/// A measure of the sets that hold the states at the horizon.
fn measured(measure: Measure, instance: &Instance, model: &Model, proof: &Proof) -> Option<String> {
    let segments = proof.enclosure.visits.iter().flat_map(|visit| &visit.segments);
    let horizon = instance.settings.horizon;
    let last: Vec<&Polytope> = segments
        .filter(|segment| segment.time.upper() >= horizon)
        .map(|segment| &segment.set)
        .collect();
    let values = |name: &str| {
        let place = model.variables().iter().position(|variable| variable == name)?;
        let sides = last.iter().filter_map(|set| set.hull()).map(|sides| sides[place]);
        sides.reduce(Interval::hull)
    };
    let width = |name: &str| values(name).map(|side| side.width());
    Some(match measure {
        Measure::Width(name) => format!("width of {name} {:.4}", width(name)?),
        Measure::Area(one, other) => format!("area {:.2e}", width(one)? * width(other)?),
        Measure::Clock(name) => format!("{name} for at most {:.3} s", values(name)?.upper()),
        Measure::Sum => {
            let bound = |sign: f64| {
                let direction = vec![sign; model.variables().len()];
                let bounds = last.iter().map(|set| set.bound(&direction));
                bounds.collect::<Option<Vec<f64>>>()?.into_iter().reduce(f64::max)
            };
            format!("width of the sum {:.1e}", bound(1.0)? + bound(-1.0)?)
        }
    })
}

/// Every instance of the list.
fn tasks() -> TestResult<Vec<(&'static str, Task)>> {
    let automata = automata()?.into_iter();
    let automata = automata.map(|(name, instance)| (name, Task::Automaton(Box::new(instance))));
    // The middle comes to 0.10369 and 0.02966; the list admits 10⁻⁴ more.
    let heat = [
        ("HEAT01", Heat { cells: 5, heated: [3, 2, 2], limit: 0.10369 + 1e-4 }),
        ("HEAT02", Heat { cells: 10, heated: [5, 3, 2], limit: 0.02966 + 1e-4 }),
    ];
    Ok(automata.chain(heat.map(|(name, heat)| (name, Task::Heat(heat)))).collect())
}

/// Every automaton with the settings that are right for it.
fn automata() -> TestResult<Vec<(&'static str, Instance)>> {
    let affine = |horizon, step| Settings { horizon, step, ..Settings::default() };
    let smooth = |horizon, tolerance, order, degree, generators| Settings {
        horizon,
        tolerance,
        order,
        degree,
        generators,
        step: 0.5,
        ..Settings::default()
    };
    // The reports take jumps as SpaceEx does.
    let jumping = |horizon, step| Settings { enters_invariants: true, ..affine(horizon, step) };
    let sharp = Settings { generators: 100, ..affine(20.0, 0.02) };
    let gears = |step| Settings { clusters: 4, ..jumping(0.2, step) };
    let approach = |clusters, step| Settings { clusters, ..jumping(300.0, step) };
    let stiff = |order| Settings {
        directions: Directions::Listed(vec![vec![1.0; 3]]),
        ..smooth(40.0, 1e-13, order, 1, 4)
    };
    let alike = [(1.25, 1.55); 2];
    let crossing = Settings {
        directions: Directions::Octagons,
        clusters: 40,
        step: 0.01,
        ..smooth(3.64, 1e-8, 5, 1, 10)
    };
    Ok(vec![
        ("PLAD01-BND42", platoon::deterministic(42.0, affine(20.0, 0.02))?),
        ("PLAD01-BND30", platoon::deterministic(30.0, sharp)?),
        ("GRBX01", gearbox::shift((0.0001, 0.0001), gears(0.0005))?),
        ("GRBX02", gearbox::shift((0.00005, 0.00015), gears(0.0005))?),
        ("SRNA01", rendezvous::mission(None, approach(1, 0.04))?),
        ("SRA01", rendezvous::mission(Some((120.0, 120.0)), approach(1, 0.04))?),
        ("SRA02", rendezvous::mission(Some((120.0, 125.0)), approach(4, 0.04))?),
        ("SRA03", rendezvous::mission(Some((120.0, 145.0)), approach(4, 0.04))?),
        ("SRA04", rendezvous::mission(Some((240.0, 240.0)), approach(40, 0.02))?),
        ("BLDF01", building::shaken(true, affine(20.0, 0.002))?),
        ("BLDC01", building::shaken(false, affine(20.0, 0.002))?),
        ("VDP, in 16 parts", nonlinear::oscillator(smooth(7.0, 1e-7, 8, 3, 4))?.cut(&[8, 2])),
        (
            "CVDP23, in 64 parts",
            nonlinear::van_der_pol(alike, (1.0, 3.0), 2.75, smooth(7.0, 1e-6, 8, 3, 10))?
                .cut(&[4, 1, 4, 1, 4]),
        ),
        ("LALO20, W = 0.01", nonlinear::laub_loomis(0.01, 4.5, smooth(20.0, 1e-7, 6, 2, 4))?),
        ("LALO20, W = 0.05", nonlinear::laub_loomis(0.05, 4.5, smooth(20.0, 1e-5, 6, 2, 4))?),
        ("LALO20, W = 0.1", nonlinear::laub_loomis(0.1, 5.0, smooth(20.0, 1e-5, 6, 2, 4))?),
        ("LOVO25, in 16 parts", predators::cycle(16, crossing)?),
        ("ROBE25, case 1", nonlinear::robertson(1e2, 1e3, stiff(8))?),
        ("ROBE25, case 2", nonlinear::robertson(1e3, 1e5, stiff(8))?),
        ("ROBE25, case 3", nonlinear::robertson(1e3, 1e7, stiff(8))?),
        ("QUAD, ± 0.1", nonlinear::quadrotor(0.1, smooth(5.0, 1e-7, 6, 2, 4))?),
        ("QUAD, ± 0.4", nonlinear::quadrotor(0.4, smooth(5.0, 1e-7, 6, 2, 4))?),
        ("QUAD, ± 0.8", nonlinear::quadrotor(0.8, smooth(5.0, 1e-6, 6, 3, 4))?),
    ])
}
