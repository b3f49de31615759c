//! The arguments that the program understands.

use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

/// Robots grow a network of relays from fixed access points to the places where they are needed.
#[derive(Debug, Parser)]
#[command(name = "pleach", version, after_help = EXIT_STATUS)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_STATUS: &str = "\
Exit status:
  0  all tasks are serviced
  1  the program failed
  2  the scenario or the arguments are wrong, and nothing was run
  3  the mission ended with tasks unserviced, the reason is named
  4  an invariant was violated, and the mission was stopped

Start with: pleach run scenarios/study-1.toml";

/// The things that the program does.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run the mission of a scenario and say how it went
    ///
    /// The robots start where the scenario puts them. Tasks are announced one after another,
    /// and for each the network grows a branch until a robot is close enough to service it.
    /// Progress is shown while the mission runs, then a summary: tasks serviced and when,
    /// recruits used, how close robots came to each other and to walls, the smallest residual
    /// of communication, and the time that each part of the computation took.
    Run(RunArguments),
    /// Judge a finished run from its trace alone
    ///
    /// Everything that the trace says is held against the definitions: motion, communication and
    /// the tree at every instant, each event against the world and the events before it, and
    /// teams, posts and phases against what follows from these. Exit status 0: it is sound; 4: the
    /// first thing that is not is told, with the property, the step and the time; 2: the trace
    /// cannot be read.
    Judge(JudgeArguments),
    /// Draw one of the automata that the robots run
    ///
    /// The drawing is made from the transition table that the robots run, and printed.
    Diagram(DiagramArguments),
    /// Make the page on which a mission plays from its trace
    ///
    /// The page is one HTML file that needs no other: the plan with robots, links and tree at every
    /// control period, curves, the story and a summary. It shows as much as there is of a trace
    /// that was cut off.
    Page(PageArguments),
}

/// The arguments of `pleach run`.
#[derive(Debug, Args)]
#[command(after_help = EXIT_STATUS)]
pub struct RunArguments {
    /// The scenario, a TOML file: workspace, radio, access points, robots and tasks
    pub scenario: PathBuf,
    /// Write what happens to FILE, one JSON object a line
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Write figures (SVG) into FOLDER [default: figures/<name of the scenario>]
    #[arg(long, value_name = "FOLDER", conflicts_with = "no_figures")]
    pub figures: Option<PathBuf>,
    /// Write no figures
    #[arg(long)]
    pub no_figures: bool,
    /// Write figures without titles, for papers with captions of their own
    #[arg(long)]
    pub plain: bool,
    /// Show no progress, only the summary
    #[arg(long, short)]
    pub quiet: bool,
}

/// The arguments of `pleach page`.
#[derive(Debug, Args)]
pub struct PageArguments {
    /// The trace, a file of JSON lines
    pub trace: PathBuf,
    /// Write the page to FILE [default: the trace with the ending .html]
    #[arg(long, short, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The arguments of `pleach judge`.
#[derive(Debug, Args)]
pub struct JudgeArguments {
    /// The trace, as `pleach run --trace FILE` writes it
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
