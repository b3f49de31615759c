//! Whether a flow is stiff, as far as the steps up to now show.

use super::explicit::Motion;

/// What the steps of one method say about the flow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Suspicion {
    /// How many steps have spoken for the other method, and how many since then have not.
    objections: u32,
    calm: u32,
    /// How many explicit steps in a row have spent most of their accuracy on a decay.
    decays: u32,
    /// How many of them have to, before it is tried whether implicit steps would be longer.
    patience: u32,
}

/// What steps say should be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Advice {
    Stay,
    /// Turn to the other method if its steps would be much longer.
    Try,
    Turn,
}

/// |h λ| near the boundary of the region in which the explicit method is stable, which is at 6.1.
const STABLE: f64 = 5.0;
/// This many steps near the boundary make a flow stiff, and this many others in a row clear it of the
/// suspicion: Hairer and Wanner's numbers.
const STIFF_STEPS: u32 = 15;
const CALM_STEPS: u32 = 6;
/// Implicit steps with |h λ| below this are as long as explicit ones would be.
const HARMLESS: f64 = 1.0;
/// The number of these in a row after which steps are explicit again.
const HARMLESS_STEPS: u32 = 25;
/// An explicit step with a decay of |h λ| from here on follows what has faded, or what is about to:
/// where the solution itself is slow, implicit steps would be longer.
const FAST: f64 = 0.5;
/// The least part of a motion that is decay if it is no oscillation.
const MOSTLY: f64 = 0.8;
/// The steps after which it is first tried, and by how much they become more at every vain trial.
const FIRST_PATIENCE: u32 = 15;
const GROWTH: u32 = 2;

impl Default for Suspicion {
    fn default() -> Self {
        Suspicion { objections: 0, calm: 0, decays: 0, patience: FIRST_PATIENCE }
    }
}

impl Suspicion {
    /// Takes note of an explicit step.
    pub(super) fn after_explicit(&mut self, motion: Motion) -> Advice {
        self.note(motion.speed > STABLE, CALM_STEPS);
        if self.objections >= STIFF_STEPS {
            return Advice::Turn;
        }
        let is_decay = motion.speed > FAST && motion.decay > MOSTLY * motion.speed;
        self.decays = if is_decay { self.decays + 1 } else { 0 };
        if self.decays < self.patience {
            return Advice::Stay;
        }
        self.decays = 0;
        self.patience = self.patience.saturating_mul(GROWTH);
        Advice::Try
    }

    /// Takes note of an implicit step with this bound on |h λ|.
    pub(super) fn after_implicit(&mut self, speed: f64) -> Advice {
        self.note(speed < HARMLESS, 1);
        if self.objections >= HARMLESS_STEPS { Advice::Turn } else { Advice::Stay }
    }

    fn note(&mut self, objects: bool, calm: u32) {
        if objects {
            self.objections += 1;
            self.calm = 0;
            return;
        }
        self.calm += 1;
        if self.calm >= calm {
            self.objections = 0;
        }
    }
}
