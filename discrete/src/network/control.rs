//! The stages of a robot's control period, and the table between them (Algorithm 5).
//!
//! Control is sampled. Time passes in one location only, [`Stage::Moving`]; at the sample the robot
//! goes through the others, which take no time. In each it waits for what its neighbours send, up to
//! the next tick of its clock; then it processes what it has received, and sends. Iterations, sweeps, reservation
//! and negotiation have a fixed number of rounds, in which a robot with nothing to do does not tick.

use crate::{TransitionTable, from, transitions, vocabulary};

vocabulary! {
    /// The stage of a robot in its control period: what it waits for.
    pub enum Stage: Location {
        /// The next sample, while it moves.
        Moving = "moving",
        /// Beacons.
        Beacons = "beacons",
        /// The flows of the period before, over the links as they are now; for ADAL.
        OldFlows = "old flows",
        /// In turn, multipliers and flows.
        Iterations = "iterations",
        /// In turn, demands of its children in the tree, flows, shortages and flows taken back.
        Sweeps = "sweeps",
        /// Grants of the flows that it plans.
        Reserving = "reserving",
        /// In turn, proposals of moves and objections to its own.
        Negotiation = "negotiation",
    }

    /// What takes a robot from one stage of its control period to another.
    pub enum StageEvent: Event {
        /// τ = Δt, or another node has begun the next control period.
        SampleDue = "sample due",
        /// A round of beacons is over, and another one follows.
        NextRound = "next round",
        /// The last round of beacons is over.
        RoutesDue = "routes due",
        /// The last round of beacons is over, and ADAL needs the flows of the period before.
        OldFlowsDue = "old flows due",
        /// Every neighbour has sent the flows of the period before.
        OldFlowsHeard = "old flows heard",
        /// Every neighbour has sent its multiplier.
        MultipliersHeard = "multipliers heard",
        /// Every neighbour has sent its flows, and another iteration follows.
        NextIteration = "next iteration",
        /// Every neighbour has sent its flows of the last iteration.
        SweepDue = "sweep due",
        /// Demands have gone up the tree.
        DemandsHeard = "demands heard",
        /// A sweep is over, and another one may be needed.
        SweepOver = "sweep over",
        /// The last sweep is over.
        SweepsOver = "sweeps over",
        /// Shortages have been forwarded from robot to robot.
        ShortagesHeard = "shortages heard",
        /// Every neighbour has sent the flows that it has taken back.
        ReliefsHeard = "reliefs heard",
        /// Requests have been answered, or are made again.
        GrantsHeard = "grants heard",
        /// No flow changes any more in this period, so that a move is due.
        RoutesDone = "routes done",
        /// Every neighbour has sent its proposal.
        ProposalsHeard = "proposals heard",
        /// Every neighbour has objected that has to, and moves are judged once more.
        NextAttempt = "next attempt",
        /// The last objections are heard: what is left of the moves is certified.
        MoveCertified = "move certified",
    }

    /// The stage of an access point in its control period.
    pub enum Round: Location {
        /// It waits for the next sample.
        Resting = "resting",
        /// It has sent its beacon, and waits for those of others.
        Listening = "listening",
    }

    /// What takes an access point from round to round.
    pub enum RoundEvent: Event {
        /// τ = Δt, or another node has begun the next control period.
        SampleDue = "sample due",
        /// A round of beacons is over, and another one follows.
        NextRound = "next round",
        /// The last round of beacons is over.
        RoundsOver = "rounds over",
    }
}

/// The table of the control period.
pub const CONTROL: TransitionTable<Stage, StageEvent> = {
    use Stage::*;
    use StageEvent as On;
    transitions![Stage, StageEvent;
        from(Moving).on(On::SampleDue).to(Beacons),
        from(Beacons).on(On::NextRound).to(Beacons),
        from(Beacons).on(On::RoutesDue).to(Iterations),
        from(Beacons).on(On::OldFlowsDue).to(OldFlows),
        from(OldFlows).on(On::OldFlowsHeard).to(Iterations),
        from(Iterations).on(On::MultipliersHeard).to(Iterations),
        from(Iterations).on(On::NextIteration).to(Iterations),
        from(Iterations).on(On::SweepDue).to(Sweeps),
        from(Sweeps).on(On::DemandsHeard).to(Sweeps),
        from(Sweeps).on(On::SweepOver).to(Sweeps),
        from(Sweeps).on(On::SweepsOver).to(Reserving),
        from(Sweeps).on(On::ShortagesHeard).to(Sweeps),
        from(Sweeps).on(On::ReliefsHeard).to(Sweeps),
        from(Reserving).on(On::GrantsHeard).to(Reserving),
        from(Reserving).on(On::RoutesDone).to(Negotiation),
        from(Negotiation).on(On::ProposalsHeard).to(Negotiation),
        from(Negotiation).on(On::NextAttempt).to(Negotiation),
        from(Negotiation).on(On::MoveCertified).to(Moving),
    ]
};

/// The table of an access point's control period.
pub const ROUNDS: TransitionTable<Round, RoundEvent> = transitions![Round, RoundEvent;
    from(Round::Resting).on(RoundEvent::SampleDue).to(Round::Listening),
    from(Round::Listening).on(RoundEvent::NextRound).to(Round::Listening),
    from(Round::Listening).on(RoundEvent::RoundsOver).to(Round::Resting),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Event, Location, Row};

    #[test]
    fn the_table_is_deterministic_and_every_stage_is_reached() {
        assert!(CONTROL.is_deterministic());
        assert_eq!(CONTROL.unreachable_from(Stage::Moving), vec![]);
        let named = |event: &&StageEvent| CONTROL.rows().iter().any(|row| row.event == **event);
        assert!(StageEvent::ALL.iter().all(|event| named(&event)));
    }

    /// From every stage there is a way on to the next sample, and routes come before moves.
    #[test]
    fn every_stage_leads_to_the_next_sample() {
        for &stage in Stage::ALL {
            assert!(!CONTROL.unreachable_from(stage).contains(&Stage::Moving), "{stage:?}");
        }
        let leads_to_moves =
            |row: &&Row<_, _>| row.target == Stage::Negotiation && row.source != Stage::Negotiation;
        let into_negotiation = CONTROL.rows().iter().filter(leads_to_moves);
        assert!(into_negotiation.map(|row| row.event).eq([StageEvent::RoutesDone]));
    }
}
