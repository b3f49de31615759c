//! How runs end when a system cannot go on, and errors while they run.

use std::convert::Infallible;

use pleach_automaton::{Ending, Executor, HybridTime, InvalidLimit, Limit, Reason, Round, System};

/// A system of one component that says the same at every instant.
struct Constant {
    jumps: bool,
    time_to_jump: Option<f64>,
}

impl System for Constant {
    type Jump = ();
    type Finish = ();
    type Error = Infallible;

    fn finished(&self) -> Option<()> {
        None
    }

    fn jump(&mut self, round: &mut Round<'_, ()>) -> Result<(), Infallible> {
        if self.jumps {
            round.jumped(0, ());
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, Infallible> {
        Ok(self.time_to_jump)
    }

    fn flow(&mut self, _duration: f64) -> Result<(), Infallible> {
        Ok(())
    }
}

fn ending(jumps: bool, time_to_jump: Option<f64>) -> (HybridTime, Reason<()>) {
    let executor = Executor::new(10.0, 5).expect("limits are valid");
    let mut system = Constant { jumps, time_to_jump };
    let Ok(ending) = executor.run(&mut system, &mut ());
    (ending.at, ending.reason)
}

#[test]
fn without_transitions_time_passes_to_the_horizon() {
    let horizon = HybridTime { t: 10.0, j: 0 };
    assert_eq!(ending(false, None), (horizon, Reason::Horizon));
    assert_eq!(ending(false, Some(3.0)), (horizon, Reason::Horizon));
}

#[test]
fn endings_print_when_and_why() {
    let reasons = [
        (Reason::Horizon, "the horizon is reached"),
        (Reason::Blocked, "neither time can pass nor a transition be taken"),
        (Reason::JumpLimit(None), "there are more rounds of jumps at one instant than allowed"),
        (Reason::Limit(Limit::Jumps(7)), "the run reached its limit of 7 jumps"),
        (Reason::Finished("a formula has no value"), "a formula has no value"),
    ];
    for (reason, text) in reasons {
        let ending = Ending { at: HybridTime { t: 2.5, j: 4 }, reason };
        assert_eq!(ending.to_string(), format!("(2.5 s, 4): {text}"));
    }
}

#[test]
fn a_transition_that_is_due_and_cannot_be_taken_blocks() {
    for due in [0.0, -1.0, f64::NAN] {
        assert_eq!(ending(false, Some(due)), (HybridTime::START, Reason::Blocked));
    }
}

#[test]
fn a_wait_too_short_to_change_the_time_blocks() {
    // From 1 s on, a wait of 1e-20 s is lost in rounding.
    struct Shrinking {
        wait: f64,
    }
    impl System for Shrinking {
        type Jump = ();
        type Finish = ();
        type Error = Infallible;

        fn finished(&self) -> Option<()> {
            None
        }

        fn jump(&mut self, _round: &mut Round<'_, ()>) -> Result<(), Infallible> {
            Ok(())
        }

        fn time_to_jump(&self) -> Result<Option<f64>, Infallible> {
            Ok(Some(self.wait))
        }

        fn flow(&mut self, _duration: f64) -> Result<(), Infallible> {
            self.wait = 1e-20;
            Ok(())
        }
    }
    let executor = Executor::new(10.0, 5).expect("limits are valid");
    let Ok(ending) = executor.run(&mut Shrinking { wait: 1.0 }, &mut ());
    assert_eq!((ending.at.t, ending.reason), (1.0, Reason::Blocked));
}

#[test]
fn jumps_without_end_at_one_instant_are_stopped() {
    let (at, reason) = ending(true, None);
    assert_eq!((at, reason), (HybridTime { t: 0.0, j: 6 }, Reason::JumpLimit(None)));
}

#[test]
fn limits_have_to_make_sense() {
    assert_eq!(Executor::new(-1.0, 5), Err(InvalidLimit::Horizon(-1.0)));
    assert!(Executor::new(f64::INFINITY, 5).is_err());
    assert!(Executor::new(f64::NAN, 5).is_err());
    assert_eq!(Executor::new(1.0, 0), Err(InvalidLimit::NoRound));
}
