//! Faults as arguments: what is lost, and which robots stop.

use super::status::Failure;
use clap::Args;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Crash, NodeFaults};
use pleach::automaton::node::MessageFaults;
use pleach::verify::network::storm::Storm;
use std::num::IntErrorKind;
use std::str::FromStr;

/// What fails in a mission.
#[derive(Clone, Debug, Args)]
pub struct FaultArguments {
    /// The probability that a message over the radio is lost
    #[arg(long, value_name = "SHARE", default_value = "0", allow_negative_numbers = true)]
    pub loss: Share,
    /// The seed that decides which messages are lost
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "loss")]
    pub loss_seed: u64,
    /// Stop a robot from control period FROM on: ROBOT@FROM for good, ROBOT@FROM..TO until period TO, when it
    /// restarts having forgotten everything; repeat the option for other robots, each of which stops once
    #[arg(long, value_name = "ROBOT@FROM[..TO]")]
    pub stop: Vec<Stop>,
}

impl FaultArguments {
    /// The storm that the arguments ask for; none if nothing fails.
    ///
    /// # Errors
    /// A robot is to stop that is not in the scenario.
    pub(super) fn storm(&self, scenario: &ValidScenario) -> Result<Option<Storm>, Failure> {
        if self.loss.0 == 0.0 && self.stop.is_empty() {
            return Ok(None);
        }
        check_robots("--stop", &self.stop, scenario)?;
        let period = scenario.settings().period;
        Ok(Some(Storm {
            seed: self.loss_seed,
            messages: MessageFaults { loss: self.loss.0, ..MessageFaults::default() },
            nodes: self.stop.iter().map(|stop| stop.faults(period)).collect(),
        }))
    }
}

/// Whether the robots that an option names are in the scenario, each once.
///
/// # Errors
/// The first that is not.
pub fn check_robots(option: &str, stops: &[Stop], scenario: &ValidScenario) -> Result<(), Failure> {
    let robots = scenario.robot.len();
    for (place, Stop { robot, .. }) in stops.iter().enumerate() {
        let what = if *robot >= robots {
            format!("those of {} go from 0 to {}", scenario.name, robots.saturating_sub(1))
        } else if stops[..place].iter().any(|other| other.robot == *robot) {
            "it can be named once".to_owned()
        } else {
            continue;
        };
        return Err(Failure::Usage(format!("{option} names robot {robot}: {what}")));
    }
    Ok(())
}

/// A probability below 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share(pub f64);

impl FromStr for Share {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let share = text.parse().ok().filter(|share| (0.0..1.0).contains(share));
        share.map(Share).ok_or_else(|| "write a probability from 0 to below 1, such as 0.1".into())
    }
}

/// A robot that stops, and when it restarts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    /// The robot.
    pub robot: usize,
    /// The control period in which it stops.
    pub from: usize,
    /// The control period in which it restarts, if ever.
    pub to: Option<usize>,
}

impl Stop {
    /// What the node has, where control periods take `period` seconds.
    fn faults(&self, period: f64) -> (usize, NodeFaults) {
        let time = |step: usize| step as f64 * period;
        let crash = Crash { time: time(self.from), inputs: 0, back: self.to.map(time) };
        (self.robot, NodeFaults { crash: Some(crash), ..NodeFaults::default() })
    }
}

impl FromStr for Stop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "{text:?} names no stop: write ROBOT@FROM, such as 3@40, or ROBOT@FROM..TO, such as 3@40..60"
            )
        };
        let number = |number: &str| {
            number.parse::<usize>().map_err(|error| match error.kind() {
                IntErrorKind::PosOverflow => format!("{text:?}: {number} is too large"),
                _ => wrong(),
            })
        };
        let (robot, periods) = text.split_once('@').ok_or_else(wrong)?;
        let (from, to) = match periods.split_once("..") {
            Some((from, to)) => (number(from)?, Some(number(to)?)),
            None => (number(periods)?, None),
        };
        if to.is_some_and(|to| to <= from) {
            return Err(format!(
                "{text:?}: a robot restarts after it has stopped, so TO is at least {}",
                from.saturating_add(1)
            ));
        }
        Ok(Stop { robot: number(robot)?, from, to })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_names_a_robot_and_one_or_two_periods() {
        let read = |text: &str| text.parse::<Stop>();
        assert_eq!(read("3@40..60"), Ok(Stop { robot: 3, from: 40, to: Some(60) }));
        assert_eq!(read("0@7"), Ok(Stop { robot: 0, from: 7, to: None }));
        for wrong in ["", "3", "3@", "@4", "3@9..9", "3@9..4", "x@1", "3@1..x"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_share_is_a_probability_below_one() {
        assert_eq!("0.3".parse(), Ok(Share(0.3)));
        for wrong in ["1", "-0.1", "NaN", "a third"] {
            assert!(wrong.parse::<Share>().is_err(), "{wrong}");
        }
    }
}
