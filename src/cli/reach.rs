//! `pleach reach`: whether any run of a SpaceEx model comes to forbidden states.

use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use pleach::guards::Interval;
use pleach::spaceex::{self, Problem, Solution, Verdict};
use pleach::verify::reach::Effort;
use serde_json::json;

use super::output;
use super::status::{Failure, Status};
use crate::import::counted;

/// The arguments of `pleach reach`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct ReachArguments {
    /// The model, an XML file of SpaceEx
    pub model: PathBuf,
    /// The configuration: where runs begin, where they must not come, and for how long
    #[arg(long, value_name = "FILE")]
    pub cfg: PathBuf,
    /// The time horizon, in place of that of the configuration
    #[arg(long, value_name = "SECONDS")]
    pub horizon: Option<f64>,
    /// The time step of affine flows, in place of that of the configuration
    #[arg(long, value_name = "SECONDS")]
    pub step: Option<f64>,
    /// The most sets that cover the states in which a guard meets a flow
    #[arg(long, value_name = "COUNT")]
    pub clusters: Option<usize>,
    /// Draw the sets, and runs inside, into FILE
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// The two variables or outputs to draw, where `t` is time [default: those of the configuration, or t and the
    /// first]
    #[arg(long, value_name = "X,Y")]
    pub axes: Option<String>,
    /// Draw COUNT runs
    #[arg(long, value_name = "COUNT", default_value_t = 12)]
    pub runs: usize,
    /// Write the result as JSON into FILE, or to the standard output as -
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write neither progress nor the verdict
    #[arg(long, short)]
    pub quiet: bool,
}

/// Reads a model, encloses its runs, and says what it found.
pub(super) fn reach(arguments: &ReachArguments) -> Result<Status, Failure> {
    let inputs = [&arguments.model, &arguments.cfg];
    output::check_places(inputs, arguments.svg.iter().chain(&arguments.json))?;
    let read = |path: &Path| {
        std::fs::read_to_string(path)
            .map_err(|error| Failure::Usage(format!("{}: cannot be read: {error}", path.display())))
    };
    let (model, configuration) = (read(&arguments.model)?, read(&arguments.cfg)?);
    let problem = spaceex::read(&model, &configuration);
    let mut problem = problem.map_err(|error| {
        let file = match error {
            spaceex::SpaceExError::Configuration { .. } => &arguments.cfg,
            _ => &arguments.model,
        };
        Failure::Usage(format!("{}: {error}", file.display()))
    })?;
    problem.settings.horizon = arguments.horizon.unwrap_or(problem.settings.horizon);
    problem.settings.step = arguments.step.unwrap_or(problem.settings.step);
    problem.settings.clusters = arguments.clusters.unwrap_or(problem.settings.clusters);
    let draws = arguments.svg.is_some() || arguments.axes.is_some();
    let axes = draws.then(|| axes(&problem, arguments.axes.as_deref())).transpose()?;
    arguments.svg.iter().chain(&arguments.json).try_for_each(|path| output::check(path))?;
    let begin = Instant::now();
    let solution = solve(&problem, arguments.quiet)?;
    let seconds = begin.elapsed().as_secs_f64();
    for (initial, proof) in problem.initial.iter().zip(&solution.proofs) {
        if proof.enclosure.visits.is_empty() {
            return Err(Failure::Usage(format!(
                "{}: `initially`: no state that it admits satisfies the invariant of `{}`: no run begins there",
                arguments.cfg.display(),
                initial.locations.join("`, `")
            )));
        }
    }
    if let (Some(path), Some(axes)) = (&arguments.svg, axes) {
        let runs = problem.runs(arguments.runs);
        let picture = solution.picture(&problem.system, [&axes[0], &axes[1]], &runs);
        let picture = picture.map_err(Failure::Usage)?.to_svg();
        output::write(path, &picture)?;
    }
    if let Some(path) = &arguments.json {
        output::write(path, &format!("{:#}\n", result(&problem, &solution)))?;
    }
    if !arguments.quiet {
        output::tell(verdict(&problem, &solution, seconds));
    }
    Ok(match solution.verdict() {
        Verdict::Holds => Status::Done,
        Verdict::Undecided => Status::Unserviced,
        Verdict::Violated => Status::InvariantViolated,
    })
}

/// Encloses the runs, with a line that says how far it is.
fn solve(problem: &Problem, is_quiet: bool) -> Result<Solution, Failure> {
    let shows = !is_quiet && io::stderr().is_terminal();
    let mut segments = 0;
    let mut progress = |time: Interval| {
        segments += 1;
        if shows && segments % 256 == 0 {
            let (now, end) = (time.upper(), problem.settings.horizon);
            let _ = write!(io::stderr(), "\r{segments} sets, at {now:.3} of {end} s");
        }
        ControlFlow::Continue(())
    };
    let solution = problem.solve(&Effort::default(), &mut progress);
    if shows {
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
    solution.map_err(|error| Failure::Usage(error.to_string()))
}

/// The coordinates, and the constants that are only known to lie in intervals.
fn variables(problem: &Problem) -> Vec<String> {
    let names = problem.automata.iter().take(1).flat_map(|automaton| automaton.names());
    let constants = problem.uncertain.iter().filter(|one| !one.varies);
    names.map(|name| (*name).to_owned()).chain(constants.map(|one| one.parameter.clone())).collect()
}

/// The quantities that are drawn.
fn axes(problem: &Problem, asked: Option<&str>) -> Result<[String; 2], Failure> {
    let names: Vec<String> = match asked {
        Some(text) => text.split(',').map(|name| name.trim().to_owned()).collect(),
        None => problem.shown.clone(),
    };
    let signals = problem.automata.iter().take(1).flat_map(|automaton| automaton.signals());
    let mut known = variables(problem);
    known.extend(signals.map(|(name, _)| name.to_owned()));
    let is_known = |name: &String| ["t", "time"].contains(&name.as_str()) || known.contains(name);
    if let Some(stranger) = names.iter().find(|name| !is_known(name)) {
        let known = known.join(", ");
        return Err(Failure::Usage(format!("{stranger:?} cannot be drawn: there are t, {known}")));
    }
    match (&names[..], asked) {
        ([across, up], _) => Ok([across.clone(), up.clone()]),
        ([up], None) => Ok(["t".to_owned(), up.clone()]),
        (_, Some(text)) => Err(Failure::Usage(format!("expected two names as X,Y, not {text:?}"))),
        (_, None) => {
            let first = problem.automata.first().and_then(|automaton| automaton.names().first());
            Ok(["t".to_owned(), first.copied().unwrap_or("t").to_owned()])
        }
    }
}

/// What was found, in a few lines.
fn verdict(problem: &Problem, solution: &Solution, seconds: f64) -> String {
    let sets: usize = visits(solution).map(|visit| visit.segments.len()).sum();
    let mut lines = vec![match solution.verdict() {
        Verdict::Holds if problem.forbidden.is_empty() => {
            format!("{}: all states are enclosed, and none is forbidden", problem.system)
        }
        Verdict::Holds => format!("{}: no run comes to a forbidden state", problem.system),
        Verdict::Violated => format!("{}: a run comes to a forbidden state", problem.system),
        Verdict::Undecided => format!("{}: undecided", problem.system),
    }];
    if let (Verdict::Violated, Some(run)) = (solution.verdict(), &solution.nearest) {
        let names = run.trajectory.variables();
        let listed = |values: &[f64]| {
            let pairs = names.iter().zip(values).map(|(name, value)| format!("{name} = {value}"));
            pairs.collect::<Vec<_>>().join(", ")
        };
        lines.push(format!("  it begins at {}", listed(&run.start)));
        for (name, value) in &run.parameters {
            lines.push(format!("  with {name} = {value}"));
        }
        lines.push(format!("  and is at {} at {} s", listed(&run.state), run.at.t));
    }
    if solution.verdict() == Verdict::Undecided {
        for proof in &solution.proofs {
            lines.push(format!("  {}", proof.enclosure.ending));
            if let Some(doubt) = proof.doubts.first() {
                let place = &solution.model.locations()[doubt.location].name;
                lines.push(format!(
                    "  in location {place}, {} to {} s, it meets what is forbidden; try shorter steps, \
                     octagons or more clusters",
                    doubt.time.lower(), doubt.time.upper()
                ));
            }
        }
    }
    let sets = counted(sets, "set", "sets");
    let visits = counted(visits(solution).count(), "visit", "visits");
    lines.push(format!("  {sets} in {visits}, {seconds:.3} s"));
    lines.join("\n")
}

fn visits(solution: &Solution) -> impl Iterator<Item = &pleach::verify::reach::Visit> {
    solution.proofs.iter().flat_map(|proof| &proof.enclosure.visits)
}

/// The result for other programs: without times, so that equal questions give equal bytes.
fn result(problem: &Problem, solution: &Solution) -> serde_json::Value {
    let ends = |side: &Interval| json!([side.lower(), side.upper()]);
    let segment = |segment: &pleach::verify::reach::Segment| {
        let states: Vec<_> = segment.set.hull().unwrap_or_default().iter().map(ends).collect();
        json!({ "time": ends(&segment.time), "states": states })
    };
    let visits = visits(solution).map(|visit| {
        json!({
            "location": solution.model.locations()[visit.location].name,
            "jumps": visit.depth,
            "entered": ends(&visit.elapsed),
            "segments": visit.segments.iter().map(segment).collect::<Vec<_>>(),
        })
    });
    let proofs = solution.proofs.iter().map(|proof| {
        let doubt = |doubt: &pleach::verify::reach::Doubt| {
            json!({
                "forbidden": doubt.forbidden,
                "location": solution.model.locations()[doubt.location].name,
                "time": ends(&doubt.time),
                "states": doubt.states.iter().map(ends).collect::<Vec<_>>(),
            })
        };
        json!({
            "ending": format!("{:?}", proof.enclosure.ending),
            "clearances": proof.clearances.iter().map(|c| c.is_finite().then_some(*c)).collect::<Vec<_>>(),
            "doubts": proof.doubts.iter().map(doubt).collect::<Vec<_>>(),
        })
    });
    let nearest = solution.nearest.as_ref().map(|run| {
        json!({
            "start": run.start,
            "parameters": run.parameters.iter().map(|(name, value)| json!([name, value])).collect::<Vec<_>>(),
            "forbidden": run.forbidden,
            "time": run.at.t,
            "state": run.state,
            "margin": run.margin,
            "violates": run.is_violation,
        })
    });
    json!({
        "system": problem.system,
        "verdict": match solution.verdict() {
            Verdict::Holds => "holds",
            Verdict::Violated => "violated",
            Verdict::Undecided => "undecided",
        },
        "variables": solution.model.variables(),
        "proofs": proofs.collect::<Vec<_>>(),
        "nearest_run": nearest,
        "visits": visits.collect::<Vec<_>>(),
    })
}
