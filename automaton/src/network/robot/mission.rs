//! The robot's part in the mission: what it hears of it, and what it makes known.
//!
//! The mission automaton decides *when* each step is taken; its table and guards are in
//! [`crate::network::automata`]. What its transitions do stands in the chapters that follow: the
//! election of a leader (`leader`) and of a recruit (`recruit`), the path Σ and its subgroups
//! (`path`), and the primary team (`team`).

use pleach_discrete::network::Phase;

use super::super::beacon::Notice;
use super::super::shared::Shared;
use super::Robot;

impl Robot {
    /// Takes the maximum of what it knows of the mission and what its neighbours say.
    pub fn hear_word(&mut self) {
        let newest = self
            .neighbours
            .iter()
            .map(|neighbour| &neighbour.beacon.bulletin)
            .max_by_key(|bulletin| bulletin.sequence());
        if let Some(newest) = newest
            && newest.sequence() > self.bulletin.sequence()
        {
            self.bulletin = newest.clone();
        }
        for neighbour in &self.neighbours {
            if let (Some(own), Some(heard)) = (&mut self.election, &neighbour.beacon.election) {
                own.merge(heard);
            }
            if let (Some(own), Some(heard)) = (&mut self.agreement, &neighbour.beacon.agreement) {
                own.merge(heard);
            }
        }
        match self.phase {
            Phase::RecruitElection => self.answer_call(),
            Phase::Shift => self.report_arrival(),
            _ => {}
        }
        self.review_team();
    }

    /// The next word on the mission, which this robot is the one to say.
    pub(super) fn issue(&mut self, notice: Notice) {
        self.bulletin = Shared::new(self.bulletin.next(notice));
    }
}
