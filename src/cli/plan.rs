//! Which runs are asked for: scenarios, times values that are set, times random starts.

use super::arguments::RunArguments;
use super::source::Source;
use super::status::Failure;
use super::sweep::Sweep;
use pleach::automaton::network::record::Faults;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::scenario_file::Setting;
use pleach::starts;
use pleach::task_list;
use pleach::verify::network::storm::Storm;

/// The most runs of one call.
const MOST_RUNS: usize = 100_000;

/// How many runs a call asks for; an error if there are too many.
pub(super) fn count_runs(
    scenarios: usize,
    sweeps: &[Sweep],
    repeats: usize,
) -> Result<usize, Failure> {
    let count = scenarios.saturating_mul(Sweep::count(sweeps)).saturating_mul(repeats);
    match count > MOST_RUNS {
        true => Err(Failure::TooManyRuns { count, most: MOST_RUNS }),
        false => Ok(count),
    }
}

/// A run that is going to happen.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The number of the run, from 1.
    pub number: usize,
    /// The file that the scenario comes from.
    pub source: String,
    /// The scenario, settings and starts included.
    pub scenario: ValidScenario,
    /// What was set, one value for each key.
    pub settings: Vec<Setting>,
    /// The seed of the random starts.
    pub seed: Option<u64>,
    /// What fails in it, if it is simulated.
    pub storm: Option<Storm>,
    /// What fails, as far as that decides on what must hold.
    pub faults: Faults,
}

/// Every run that the arguments ask for. All scenarios are read before any of them runs, and all
/// mistakes in them are told.
pub fn plan(arguments: &RunArguments) -> Result<Vec<Planned>, Failure> {
    let (sources, mut mistakes) = Source::all(&arguments.scenarios)?;
    let repeats = arguments.repeat.map_or(1, |it| usize::try_from(it).unwrap_or(usize::MAX));
    let count = count_runs(sources.len(), &arguments.set, repeats)?;
    let combinations = Sweep::combinations(&arguments.set);
    let seeds: Vec<Option<u64>> = match arguments.repeat {
        None => vec![None],
        Some(repeats) => (0..repeats).map(|run| Some(arguments.seed.wrapping_add(run))).collect(),
    };
    let tasks = arguments.tasks.as_deref().map(task_list::read).transpose()?;
    let mut runs = Vec::with_capacity(count);
    for source in &sources {
        for settings in &combinations {
            let scenario = match source.parse(settings, tasks.as_deref()) {
                Ok(scenario) => scenario,
                Err(error) => {
                    mistakes.push(error);
                    continue;
                }
            };
            for &seed in &seeds {
                let scenario = match seed {
                    None => scenario.clone(),
                    Some(seed) => starts::draw(&scenario, seed)?,
                };
                let storm = arguments.faults.storm(&scenario)?;
                runs.push(Planned {
                    number: runs.len() + 1,
                    source: source.name.display().to_string(),
                    faults: storm.as_ref().map_or_else(Faults::default, Storm::faults),
                    scenario,
                    settings: settings.clone(),
                    seed,
                    storm,
                });
            }
        }
    }
    if mistakes.is_empty() { Ok(runs) } else { Err(Failure::Scenarios(mistakes)) }
}

impl Planned {
    /// A single run of a scenario as it stands, without faults.
    pub fn once(source: String, scenario: ValidScenario) -> Self {
        Planned {
            number: 1,
            source,
            scenario,
            settings: Vec::new(),
            seed: None,
            storm: None,
            faults: Faults::default(),
        }
    }

    /// A name for the files of this run, one of `count`.
    pub(super) fn file_name(&self, count: usize) -> String {
        let digits = count.to_string().len();
        match count {
            1 => self.scenario.name.clone(),
            _ => format!("{:0digits$}-{}", self.number, self.scenario.name),
        }
    }
}
