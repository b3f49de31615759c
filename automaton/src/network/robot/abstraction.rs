//! The robot without its continuous side, for exhaustive exploration.
//!
//! Between two jumps of the discrete protocol the flow carries a robot somewhere, and time
//! passes. An explorer does not follow the flow. It chooses what may come of it: where the robot
//! stands, and for how long it has made no progress. Everything else is the robot itself.
//! [`Robot::account`] says which robots an explorer need not tell apart.

use std::sync::Arc;

use pleach_discrete::network::{Bid, Confirmation, NodeId, NoticeId, Phase, Subgroup};

use super::super::beacon::Beacon;
use super::super::duty::Path;
use super::facts::STATIONARY_WINDOW;
use super::{Robot, RobotError, RobotView};

/// What an explorer reads from a robot in addition to what observers see.
impl<'a> RobotView<'a> {
    /// The beacon that the robot would send now, without what matters only when time passes.
    pub fn beacon(self) -> Beacon {
        Beacon { strays: Arc::default(), serves: Arc::default(), ..self.robot().public_state() }
    }

    /// The path Σ that was announced last.
    pub fn path(self) -> Option<&'a Path> {
        self.robot().mission.path().map(|path| &**path)
    }

    /// The subgroups that it has computed from the break points.
    pub fn subgroups(self) -> &'a [Subgroup] {
        self.robot().mission.shift().map_or(&[], |shift| &shift.subgroups)
    }

    /// The election that it knows to be over, and the winner with its bid.
    pub fn concluded_election(self) -> Option<(NoticeId, Option<(Bid, NodeId)>)> {
        let election = self.robot().election.as_ref()?;
        self.robot().election_is_over().then(|| (election.id(), election.best()))
    }

    /// The election that it takes part in, or took part in last.
    pub fn election(self) -> Option<NoticeId> {
        self.robot().election.as_ref().map(|election| election.id())
    }

    /// What it has bid itself in this election, if it has taken part in it and in none since.
    pub fn own_bid(self, election: NoticeId) -> Option<Bid> {
        self.robot().bid.filter(|_| self.election() == Some(election))
    }

    /// The number of control periods without progress.
    pub fn still_periods(self) -> u32 {
        self.robot().still_periods
    }

    /// The numbers of control periods without progress at which its guards change, ascending.
    pub fn still_thresholds(self) -> [u32; 3] {
        [STATIONARY_WINDOW, super::partner::LAST_RESORT, self.robot().patience().ceil() as u32]
    }
}

impl Robot {
    /// In place of a round of messages: processes what it has received, without counting a round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn deliberate_now(&mut self) -> Result<(), RobotError> {
        self.end_round();
        self.process_news(false)?;
        self.jump()
    }

    /// Whether what the robot would leave out if nothing new came would change nothing. What it leaves
    /// out is not told by its [`account`](Self::account).
    pub fn leaves_out_nothing(&self) -> bool {
        let (beacon, told) = (self.public_state(), self.last_beacon.get());
        (self.has_news || self.overlooked().is_none())
            && (self.has_unsent_news || told.is_none_or(|told| *told == beacon))
            && (self.is_unmeasured || self.facts_stand())
    }

    /// The next round counts as the first one of a control period, in which all robots send, and
    /// every way to an access point as confirmed anew.
    pub fn count_rounds_anew(&mut self) {
        self.round_count.restart();
        self.confirmation = Confirmation::default();
    }

    /// In place of the last stages of a control period and the beginning of the next: the robot
    /// has made no progress for `still_periods` control periods.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn pass_period(&mut self, still_periods: u32) -> Result<(), RobotError> {
        self.stand_at(self.position, still_periods);
        self.begin_period()?;
        (self.orphaned_periods, self.unfollowed_periods) = (0, 0);
        self.deliberate()?;
        self.jump()
    }

    /// Everything, apart from the beacons that it goes by, that decides what the robot sends and does
    /// from now on: robots with equal accounts that go by the same beacons have the same future, as
    /// long as they are moved alike.
    ///
    /// Left out is what the explorer stands for, routes and motion, and what follows from the rest;
    /// how long a wait has been over does not matter. A field that is neither told nor left out does
    /// not compile.
    pub fn account(&self) -> String {
        let Robot {
            // Told.
            id,
            position,
            still_periods,
            duty,
            mission,
            exchange,
            last_partner,
            answered,
            parent,
            place,
            below,
            can_detach,
            unused_periods,
            bulletin,
            epoch,
            announced,
            election,
            bid,
            waited_rounds,
            route,
            agreement,
            team,
            stretched,
            followed_post,
            neighbours: _, // by their beacons and their silence
            // Constant.
            rate: _,
            site: _,
            // Between two stimuli a robot is at rest and has nothing left to do.
            control: _,
            round_count: _,
            acts: _,
            is_new: _,
            heard_way: _,
            is_displaced: _,
            is_late: _,
            label: _,
            facts: _,
            is_quiet: _,
            has_news: _,
            has_unsent_news: _,
            is_unmeasured: _,
            last_beacon: _,
            beacon_told: _,
            period: _,
            heard_up_to: _,
            desired_parent: _,
            reattaches_to: _,
            // The explorer confirms every way.
            confirmation: _,
            awaits_confirmation: _,
            partner: _,
            taking_over: _,
            log: _,
            // No robot is missed, and no task, where no time passes.
            strays: _,
            serves: _,
            orphaned_periods: _,
            unfollowed_periods: _,
            roll: _,
            out_of_sight: _,
            wrecks: _,
            // Routes and motion.
            velocity: _,
            clock: _,
            routing: _,
            links: _,
            upstream: _,
            expected_link: _,
            inflow: _,
            inflows: _,
            demands: _,
            residual: _,
            reservations: _,
            last_request: _,
            has_flow_news: _,
            has_swept: _,
            demands_passed_on: _,
            has_no_reserve: _,
            has_shortage_news: _,
            has_untold_flows: _,
            is_unsettled: _,
            destination: _,
            target: _, // by the announcement
            waypoint: _,
            proposal: _,
            told_move: _,
            problem: _,
            heard_moves: _,
            must_judge_moves: _,
            consents: _,
            to_answer: _,
            consented: _,
            arrival: _,
            resting_places: _,
        } = self;
        let waited = match self.phase() {
            Phase::RecruitElection => (*waited_rounds).min(2 * self.longest_wait() + 1),
            _ => 0,
        };
        let silences: Vec<u8> = self.audible().map(|(_, silent)| silent).collect();
        format!(
            "{:?}",
            (
                (id, position, still_periods, &**duty, &**mission, unused_periods,),
                (&**exchange, answered, last_partner, parent, &**place, below, can_detach),
                ((bulletin, epoch, announced), election, bid, waited, route),
                (agreement, team, stretched, followed_post, silences),
            )
        )
    }
}
