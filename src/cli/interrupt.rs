//! Ctrl-C and SIGTERM: the first one ends a run in order, the second one ends the program.

use pleach::automaton::network::record::{MissionEvent, Snapshot};
use pleach::mission::Watcher;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// The status with which a second signal ends the program.
const INTERRUPTED_TWICE: i32 = 1;

/// Whether the user or another program wants the runs to end; a watcher that ends them.
#[derive(Clone, Debug)]
pub struct Interrupt {
    signal: Arc<AtomicUsize>,
    step: usize,
}

impl Interrupt {
    /// Listens to the signals from now on.
    pub fn listen() -> io::Result<Self> {
        let (signal, again) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(false)));
        for number in [SIGINT, SIGTERM] {
            // In this order: the second signal finds the flag that the first one has left.
            flag::register_conditional_shutdown(number, INTERRUPTED_TWICE, Arc::clone(&again))?;
            flag::register(number, Arc::clone(&again))?;
            flag::register_usize(number, Arc::clone(&signal), number.unsigned_abs() as usize)?;
        }
        Ok(Self { signal, step: 0 })
    }

    /// The name of the signal that has come, if one has.
    pub fn signal(&self) -> Option<&'static str> {
        match self.signal.load(Ordering::Relaxed) {
            0 => None,
            number if number == SIGTERM.unsigned_abs() as usize => Some("SIGTERM"),
            _ => Some("Ctrl-C"),
        }
    }
}

impl Watcher for Interrupt {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.step = snapshot.step;
        Ok(())
    }

    fn interruption(&self) -> Option<String> {
        self.signal().map(|name| format!("the run was ended by {name} at k = {}", self.step))
    }
}
