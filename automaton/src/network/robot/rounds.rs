//! Rounds of beacons, of iterations, of sweeps, of the reservation and of the negotiation: the discrete
//! clock of a robot.
//!
//! All have a fixed number of rounds, which all robots count alike. Where a robot has nothing to do
//! until it hears something, it lets rounds pass; its count goes on, as τ does while time passes.

use pleach_discrete::network::Stage;

use super::Robot;
use super::context::context;
use super::hearing::ROUNDS_TO_BE_HEARD;

/// Sweeps until the routes are feasible: with each, overloaded robots are relieved of what does
/// not come over the tree, and a tree that can carry the rates needs few.
const SWEEPS: usize = 6;
/// Rounds of a reservation: requests and grants cross a tree of up to a third as many levels.
const RESERVATION: usize = 96;
/// Rounds after which a request that has not been answered is made again.
const ROUNDS_FOR_AN_ANSWER: usize = 8;
/// How often proposals are judged and halved; a mover that still meets an objection the time after
/// them gives its move up.
const ATTEMPTS: usize = 8;

/// The rounds of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SweepRound {
    /// Demands go up the tree.
    Demands,
    /// Flows are told to their receivers.
    Flows,
    /// Shortages are told from robot to robot.
    Shortages,
    /// Flows are taken back from robots that cannot pass them on.
    Reliefs,
}

/// The number of the round of beacons, of iterations, of sweeps, of the reservation or of the negotiation
/// that is over at this tick, from 1; 0 before the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Rounds(usize);

impl Rounds {
    const PER_SWEEP: usize = 4;
    /// The flows of the last sweep are heard.
    const LAST_OF_SWEEPS: usize = Self::PER_SWEEP * (SWEEPS - 1) + 2;
    /// The last objections are heard: proposals and objections alternate.
    const LAST_OF_NEGOTIATION: usize = 2 * (ATTEMPTS + 1);

    /// Rounds are counted anew.
    pub(super) const fn restart(&mut self) {
        *self = Rounds(0);
    }

    /// Further rounds pass.
    pub(super) const fn pass(&mut self, rounds: usize) {
        self.0 += rounds;
    }

    pub(super) const fn count(self) -> usize {
        self.0
    }

    /// Multipliers and flows alternate.
    pub(super) const fn is_for_multipliers(self) -> bool {
        self.0 % 2 == 1
    }

    /// Whether the flows of the last of these iterations are heard.
    pub(super) const fn is_last_of(self, iterations: usize) -> bool {
        self.0 >= Self::of_iterations(iterations)
    }

    const fn of_iterations(iterations: usize) -> usize {
        2 * iterations
    }

    pub(super) const fn of_sweep(self) -> SweepRound {
        match self.0 % Self::PER_SWEEP {
            1 => SweepRound::Demands,
            2 => SweepRound::Flows,
            3 => SweepRound::Shortages,
            _ => SweepRound::Reliefs,
        }
    }

    pub(super) const fn is_last_sweep(self) -> bool {
        self.0 >= Self::LAST_OF_SWEEPS
    }

    /// Whether requests that have not been answered are made again, and circles are looked for.
    pub(super) const fn is_for_asking_again(self) -> bool {
        self.0.is_multiple_of(ROUNDS_FOR_AN_ANSWER)
    }

    /// How often requests that have not been answered have been made again.
    pub(super) const fn times_asked_again(self) -> usize {
        self.0 / ROUNDS_FOR_AN_ANSWER
    }

    /// Whether more may be granted: its sender hears of it, and can still give back what it has no room
    /// for.
    pub(super) const fn is_for_grants(self) -> bool {
        self.0 + 2 <= RESERVATION
    }

    /// Whether the reservation is over.
    pub(super) const fn is_last_of_reservation(self) -> bool {
        self.0 >= RESERVATION
    }

    pub(super) const fn is_for_proposals(self) -> bool {
        self.0 % 2 == 1
    }

    pub(super) const fn is_last_attempt(self) -> bool {
        self.0 >= Self::LAST_OF_NEGOTIATION
    }

    /// Whether an objection that is heard from now on is the last of this negotiation.
    pub(super) const fn is_last_chance(self) -> bool {
        self.0 >= 2 * ATTEMPTS
    }
}

impl Robot {
    /// Rounds that the robot lets pass before its next tick, counted from its last one: up to the
    /// last of its stage while it has nothing to tell or to judge.
    ///
    /// For beacons and the negotiation this leaves out work that would change nothing. For iterations, sweeps and the
    /// reservation it is part of the protocol: with a tick in every round, other messages are sent, in sweeps only where
    /// messages are lost.
    pub(super) fn rounds_to_pass(&self) -> usize {
        let settings = &self.site.settings;
        let is_derived = matches!(self.stage(), Stage::Beacons | Stage::Negotiation);
        if is_derived && !self.caches() {
            return 0;
        }
        let (has_nothing_to_do, last) = match self.stage() {
            Stage::Beacons => (self.needs_no_round(), settings.rounds_per_period),
            Stage::Iterations => {
                (self.routing.is_at_rest(), Rounds::of_iterations(settings.routing_iterations))
            }
            Stage::Sweeps => (self.routing.routes_stand(context!(self)), Rounds::LAST_OF_SWEEPS),
            Stage::Reserving => (!self.reservation.has_news(), self.next_of_reservation()),
            Stage::Negotiation => {
                (self.negotiation.has_nothing_to_judge(), Rounds::LAST_OF_NEGOTIATION)
            }
            _ => return 0,
        };
        if has_nothing_to_do { last.saturating_sub(self.schedule.rounds().count() + 1) } else { 0 }
    }

    /// The round of the reservation in which the robot asks or looks for circles again, or the last one.
    fn next_of_reservation(&self) -> usize {
        if !self.reservation.asks_again() {
            return RESERVATION;
        }
        let asked = self.schedule.rounds().times_asked_again();
        ((asked + 1) * ROUNDS_FOR_AN_ANSWER).min(RESERVATION)
    }

    /// Whether it has heard nothing new, told its beacon often enough, and counts no rounds: of
    /// silence or of an election.
    fn needs_no_round(&self) -> bool {
        let counts_silence = self.schedule.rounds().count() < ROUNDS_TO_BE_HEARD;
        !self.changes.are_news()
            && self.outbox.is_sent()
            && !counts_silence
            && !self.counts_rounds()
    }
}
