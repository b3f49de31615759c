//! The arguments that the program understands.

// What stands here is read in a terminal.
#![allow(rustdoc::broken_intra_doc_links, rustdoc::invalid_html_tags)]

use super::faults::FaultArguments;
use super::sweep::Sweep;
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use pleach::import::{ACCEPTED_LOSS, Radio, Spot};
use std::path::PathBuf;
use std::thread;

/// Run, check and draw networks of mobile radio relays and other hybrid automata
#[derive(Debug, Parser)]
#[command(name = "pleach", version, after_help = EXIT_STATUS)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_STATUS: &str = "\
Exit status:
  0  every task was serviced, or expired or was withdrawn
  1  the program failed
  2  the scenario or the arguments are wrong, and nothing was run
  3  the mission ended with tasks unserviced, or was interrupted, and the reason is named
  4  an invariant was violated, and the mission was stopped

Start with: pleach run scenarios/study-1.toml
A process for every node: see docs/how-to/processes.md";

/// The commands of the program.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the missions of scenarios and report their outcomes
    ///
    /// The robots start where the scenario puts them. Tasks are announced one after another,
    /// and for each the network grows a branch until a robot is close enough to service it.
    /// Progress is shown while the mission runs, then a summary: tasks serviced and when,
    /// recruits used, how close robots came to each other and to walls, the smallest residual
    /// of communication, and the time that each part of the computation took.
    ///
    /// Several scenarios, values to sweep or repeats give a table with a line for each run, and
    /// the exit status of the worst: 1, then 4, then 3, then 0. Ctrl-C or SIGTERM ends a mission
    /// cleanly: trace, summary and figures cover it up to then, and the exit status is 3.
    ///
    /// --loss drops messages and --stop crashes robots. The run is then checked only against the
    /// safety properties that hold under faults.
    Run(RunArguments),
    /// Check whether missions can start from scenarios, and draw their starts
    ///
    /// Only the first control period is run. Mistakes are reported with file, line, key and what would be right (exit
    /// status 2). Tasks that no robot can service are named (exit status 3). Links at the start
    /// that cross walls, which the model of the radio ignores, are counted.
    Check(CheckArguments),
    /// Make a scenario from a map: images, ROS map server, MovingAI, GeoJSON, OpenStreetMap, Open-RMF, DXF or SVG
    ///
    /// Prints a scenario that is ready to run. Maps of cells are traced and simplified, and walls stay
    /// closed. What was simplified or left out, and passages too narrow for robots,
    /// are reported on the error output.
    Import(ImportArguments),
    /// Judge a finished run from its trace alone
    ///
    /// Everything that the trace says is checked against the definitions: motion, communication and
    /// the tree at every instant, each event against the state and the events before it, and
    /// teams, posts and phases against what follows from these. Exit status 0: it is sound; 4: the
    /// first violation is printed, with the property, the step and the time; 2: the trace
    /// cannot be read. The trace of a mission with faults says so, and is checked against what no
    /// fault may break.
    Judge(JudgeArguments),
    /// Turn a trace into an MCAP recording, which Foxglove plays
    ///
    /// Needs a build with the feature `mcap`.
    Export {
        /// The trace, as `pleach run --trace` writes it, or `-` for the standard input
        trace: PathBuf,
        /// The recording, or `-` for the standard output
        recording: PathBuf,
    },
    /// Draw one of the automata that robots, access points and the user run
    ///
    /// The drawing is made from the transition table that they run, and printed.
    Diagram(DiagramArguments),
    /// Make a page that plays a mission from its trace
    ///
    /// The page is one self-contained HTML file: the plan with robots, links and tree at every
    /// control period, curves, events and a summary. An incomplete trace is shown as far as it
    /// goes. If `pleach judge` finds a violation, it is the headline of the page.
    Page(PageArguments),
    /// Decide whether any run of a SpaceEx model reaches forbidden states
    ///
    /// All runs are enclosed at once, from all initial states and for all inputs, with every rounding
    /// error accounted for. Exit status: 0 if none reaches them, 4 if one does, which is shown, and 3
    /// if it is undecided.
    Reach(super::reach::ReachArguments),
    /// Print a script that completes the arguments of pleach in a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page, or write one for each command into a folder
    Man {
        /// The folder, created if it is missing
        folder: Option<PathBuf>,
    },
}

/// The arguments of `pleach run`.
#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub struct RunArguments {
    /// Scenarios: TOML files, folders of TOML files, or `-` for the standard input
    #[arg(required = true, value_name = "SCENARIO")]
    pub scenarios: Vec<PathBuf>,
    /// Set a value of the scenario, such as control.step_radius=0.02 or robot[*].rate=0.05;
    /// FROM..TO:COUNT runs it with COUNT values, several sweeps with all combinations
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Sweep>,
    /// Take the tasks from a CSV file instead of the scenarios: the first row names the columns x
    /// and y, and any of announced, withdrawn, lasts, priority and access_point
    #[arg(long, value_name = "FILE")]
    pub tasks: Option<PathBuf>,
    /// Run every scenario COUNT times, each time with robots at other random starts
    #[arg(long, value_name = "COUNT", allow_negative_numbers = true,
        value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub repeat: Option<u64>,
    /// The seed of the first random starts; each repeat takes the next one
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "repeat")]
    pub seed: u64,
    /// What fails.
    #[command(flatten)]
    pub faults: FaultArguments,
    /// Run up to COUNT missions at once [default: one for each processor]
    #[arg(long, short, value_name = "COUNT", allow_negative_numbers = true,
        value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Write the trace to FILE as JSON lines; with several runs FILE is a folder
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Write figures (SVG) into FOLDER [default: figures/<name of the scenario>, and none with
    /// several runs]
    #[arg(long, value_name = "FOLDER", conflicts_with = "no_figures")]
    pub figures: Option<PathBuf>,
    /// Write no figures
    #[arg(long)]
    pub no_figures: bool,
    /// Write figures without titles, for papers with captions of their own
    #[arg(long)]
    pub plain: bool,
    /// Also write each figure as PDF; needs a build with the feature `pdf`
    #[arg(long, conflicts_with = "no_figures")]
    pub pdf: bool,
    /// Write a table of the runs to FILE as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Write a table of the runs to FILE as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Show no progress, only the summary
    #[arg(long, short)]
    pub quiet: bool,
}

impl RunArguments {
    /// How many missions run at once.
    pub(super) fn jobs(&self) -> usize {
        let processors = || thread::available_parallelism().map_or(1, |count| count.get());
        self.jobs.map_or_else(processors, usize::from)
    }
}

/// The arguments of `pleach check`.
#[derive(Debug, Args)]
pub struct CheckArguments {
    /// Scenarios: TOML files, folders of TOML files, or `-` for the standard input
    #[arg(required = true, value_name = "SCENARIO")]
    pub scenarios: Vec<PathBuf>,
    /// Set a value of the scenario, such as control.step_radius=0.02
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<Sweep>,
    /// Take the tasks from a CSV file instead of the scenarios
    #[arg(long, value_name = "FILE")]
    pub tasks: Option<PathBuf>,
    /// Draw the start (SVG) into FOLDER [default: figures/<name of the scenario>]
    #[arg(long, value_name = "FOLDER", conflicts_with = "no_figures")]
    pub figures: Option<PathBuf>,
    /// Draw nothing
    #[arg(long)]
    pub no_figures: bool,
}

/// The arguments of `pleach import`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub struct ImportArguments {
    /// The map: .yaml (ROS, Open-RMF), .png, .pgm, .bmp, .jpg, .tif, .map, .geojson, .json, .osm, .dxf or .svg
    pub map: PathBuf,
    /// Write the scenario to FILE [default: the standard output]
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Write a page instead, on which the floor is seen over the map, and places are set by clicking: it prints the
    /// command that makes the scenario, with the other options of this one
    #[arg(long, value_name = "FILE.html")]
    pub look: Option<PathBuf>,
    /// The name of the scenario [default: that of the map]
    #[arg(long)]
    pub name: Option<String>,
    /// The radius of the robots, the clearance that they keep from walls: what they get through stays open [default: a
    /// 240th of the extent, if that leaves the floor whole]
    #[arg(long, value_name = "LENGTH", visible_alias = "clearance")]
    pub robot_radius: Option<f64>,
    /// Accept that so much of the floor is lost, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0 * ACCEPTED_LOSS, value_parser = percent)]
    pub accept_loss: f64,
    /// How far walls may come out of place into the floor [default: one cell, but at most 1 % of the floor is lost by
    /// it; a thousandth of the extent for curves]
    #[arg(long, value_name = "LENGTH")]
    pub tolerance: Option<f64>,
    /// Take groups of at most COUNT occupied cells, with floor all around, as floor [default: 2 in images, 0 otherwise]
    #[arg(long, value_name = "COUNT")]
    pub specks: Option<usize>,
    /// The length of a unit of the map in the scenario
    #[arg(long, value_name = "LENGTH", default_value_t = 1.0)]
    pub scale: f64,
    /// The side of a pixel, for an image alone
    #[arg(long, value_name = "LENGTH")]
    pub resolution: Option<f64>,
    /// Coordinates of GeoJSON are lengths, however small the map is, not degrees
    #[arg(long)]
    pub planar: bool,
    /// The level of the building
    #[arg(long, value_name = "NAME", allow_hyphen_values = true)]
    pub level: Option<String>,
    /// How wide walls drawn as lines are [default: 0.1; in SVG as drawn]
    #[arg(long, value_name = "LENGTH")]
    pub wall_width: Option<f64>,
    /// Take features with this property, such as layer=INNER, as walls; several are possible
    #[arg(long, value_name = "KEY=VALUE", value_parser = property)]
    pub wall: Vec<(String, String)>,
    /// Take features with this property as floor; several are possible
    #[arg(long, value_name = "KEY=VALUE", value_parser = property)]
    pub floor: Vec<(String, String)>,
    /// The radio of the robots, by its usual ranges in buildings: bluetooth (8 m and 10 m), zigbee (15 m and 20 m) or
    /// wifi (25 m and 35 m)
    #[arg(long, value_name = "KIND")]
    pub radio: Option<Radio>,
    /// Links are fully reliable up to here [default: by the radio, or about a sixth of the extent]
    #[arg(long, value_name = "LENGTH")]
    pub full_range: Option<f64>,
    /// Links end here [default: by the radio, or 1.25 times the full range]
    #[arg(long, value_name = "LENGTH")]
    pub max_range: Option<f64>,
    /// Put an access point here, or at a named point of the map; several are possible [default: in the widest place]
    #[arg(long, value_name = "X,Y|NAME", allow_hyphen_values = true, value_parser = spot)]
    pub access_point: Vec<Spot>,
    /// How many robots start around the access points where the map has none
    #[arg(long, value_name = "COUNT", default_value_t = 8)]
    pub robots: u16,
    /// Where the robots start, and with it the access point where none is named
    #[arg(long, value_name = "X,Y|NAME", allow_hyphen_values = true, value_parser = spot)]
    pub near: Option<Spot>,
    /// Put a task here, or at a named point of the map; several are possible [default: far from the access points]
    #[arg(long, value_name = "X,Y|NAME", allow_hyphen_values = true, value_parser = spot)]
    pub task: Vec<Spot>,
    /// Take the tasks from a CSV file, as `pleach run` does
    #[arg(long, value_name = "FILE", conflicts_with = "task")]
    pub tasks: Option<PathBuf>,
    /// How many tasks are put far from the access points where none are named
    #[arg(long, value_name = "COUNT", default_value_t = 1, conflicts_with_all = ["task", "tasks"])]
    pub far_tasks: u16,
}

/// A place, written `X,Y`, or its name.
fn spot(text: &str) -> Result<Spot, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
        Some((Some(x), Some(y))) => Ok(Spot::At([x, y])),
        Some((Some(_), None) | (None, Some(_))) => {
            Err(format!("{text:?} is not a place: write two numbers as X,Y, or a name"))
        }
        _ => Ok(Spot::Named(text.into())),
    }
}

/// A share in percent.
fn percent(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=100.0).contains(share));
    share.ok_or_else(|| format!("{text} is no share in percent, from 0 to 100"))
}

/// A property with its value, written `KEY=VALUE`.
fn property(text: &str) -> Result<(String, String), String> {
    let pair =
        text.split_once('=').ok_or_else(|| format!("{text:?} is no property: write KEY=VALUE"))?;
    Ok((pair.0.into(), pair.1.into()))
}

/// The arguments of `pleach page`.
#[derive(Debug, Args)]
pub struct PageArguments {
    /// The trace, a file of JSON lines, or `-` for the standard input
    pub trace: PathBuf,
    /// Write the page to FILE, `-` for the standard output [default: the name of the trace with the
    /// extension .html]
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The arguments of `pleach judge`.
#[derive(Debug, Args)]
pub struct JudgeArguments {
    /// The trace, as `pleach run --trace FILE` writes it, or `-` for the standard input
    pub trace: PathBuf,
}

/// The arguments of `pleach diagram`.
#[derive(Debug, Args)]
pub struct DiagramArguments {
    /// Which automaton
    pub automaton: Automaton,
    /// The language of the drawing
    #[arg(long, value_enum, default_value_t = DiagramFormat::Mermaid)]
    pub format: DiagramFormat,
}

/// The automata that can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Automaton {
    /// What a robot does for the network, with the roles of the paper
    Duty,
    /// Where a robot stands in the exchange of duties with a robot in its way
    Exchange,
    /// Where the mission stands: elections, advance, shifts of the secondary team
    Mission,
    /// Whether a robot's post belongs to a tree, from its parent's messages
    Place,
    /// The control period of a robot: beacons, routes, the move, and the flow between samples
    Control,
    /// What an access point does for the user: announcements, elections, the end of the mission
    Service,
    /// Whether a robot takes part, in the records of an access point
    Attendance,
    /// The control period of an access point
    Rounds,
    /// What the user does
    Request,
}

/// The languages of drawings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DiagramFormat {
    /// Text that Markdown viewers draw
    Mermaid,
    /// Text for Graphviz
    Dot,
    /// A picture
    Svg,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_arguments_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_folder_for_figures_contradicts_no_figures() {
        let line = ["pleach", "run", "a.toml", "--figures", "out", "--no-figures"];
        assert!(Arguments::try_parse_from(line).is_err());
    }
}
