//! The roll: the list of the robots that take part, which the first access point issues once a control period.
//!
//! Every beacon carries the newest roll that its sender knows. A robot moves only by a roll that is
//! valid and does not name it, so that robots which others take to be gone do not move.

use std::cmp::Ordering;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::network::acceptance::Segment;
use pleach_discrete::network::{Attendance, IdSet, NodeId};
use serde::{Deserialize, Serialize};

use super::{phrase, wire};

/// A roll.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Roll {
    /// The control period in which it is called. All robots take part by the roll of period 0.
    pub called: u32,
    /// The robots that do not take part.
    #[serde(with = "wire")]
    pub absent: Arc<Absent>,
}

/// Robots that do not take part, as far as the first access point knows.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Absent {
    /// They may not move, and others expect to hear them before they move.
    pub suspended: IdSet,
    /// They may not move by any roll that is valid, and others do not expect to hear them.
    pub gone: IdSet,
}

/// The body of a robot that does not take part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wreck {
    /// The robot.
    pub robot: NodeId,
    /// Where it was when it was heard last.
    #[serde(with = "wire")]
    pub place: Point,
    /// The control period in which that was.
    pub heard_in: u32,
    /// How far the move leads that it intended afterwards, if it told of one.
    #[serde(with = "wire")]
    pub astray: f64,
}

impl Wreck {
    /// A robot that is heard.
    pub(super) const fn heard(robot: NodeId, place: Point, heard_in: u32) -> Self {
        Wreck { robot, place, heard_in, astray: 0.0 }
    }

    /// A robot that tells of its next move.
    pub(super) fn setting_off(robot: NodeId, segment: Segment, heard_in: u32) -> Self {
        Wreck { astray: segment.length(), ..Wreck::heard(robot, segment.from, heard_in) }
    }

    /// The order in which more is known of the same robot.
    fn by_news(&self, other: &Wreck) -> Ordering {
        self.heard_in.cmp(&other.heard_in).then(self.astray.total_cmp(&other.astray))
    }
}

/// Where robots were when they were last heard, or heard of, by number.
#[derive(Clone, Debug, Default)]
pub(super) struct Sightings(Vec<Wreck>);

impl Sightings {
    /// A robot was heard, or heard of.
    pub(super) fn note(&mut self, seen: Wreck) {
        match self.0.binary_search_by_key(&seen.robot, |known| known.robot) {
            Ok(at) if self.0[at].by_news(&seen).is_gt() => {}
            Ok(at) => self.0[at] = seen,
            Err(at) => self.0.insert(at, seen),
        }
    }

    /// Only these are still of interest.
    pub(super) fn retain(&mut self, is_of_interest: impl FnMut(&Wreck) -> bool) {
        self.0.retain(is_of_interest);
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Wreck> {
        self.0.iter().copied()
    }
}

impl Absent {
    /// Whether all robots take part.
    pub(super) fn is_empty(&self) -> bool {
        self.suspended.is_empty() && self.gone.is_empty()
    }

    /// Brings up to date where each robot that does not take part was heard last, by number: of what is
    /// known and of what has been seen. One that nobody has heard of is where it starts.
    pub(super) fn locate(
        &self,
        known: &mut Arc<Vec<Wreck>>,
        seen: impl IntoIterator<Item = Wreck>,
        start_of: impl Fn(NodeId) -> Option<Point>,
    ) {
        if self.is_empty() && known.is_empty() {
            return;
        }
        let unheard = |robot| Some(Wreck::heard(robot, start_of(robot)?, 0));
        let absent = self.suspended.iter().chain(self.gone.iter());
        let mut wrecks: Vec<Wreck> = absent.filter_map(unheard).collect();
        wrecks.extend(known.iter().copied().chain(seen));
        wrecks.retain(|wreck| self.contains(wreck.robot));
        wrecks.sort_by(|one, other| one.robot.cmp(&other.robot).then(other.by_news(one)));
        wrecks.dedup_by_key(|wreck| wreck.robot);
        if **known != wrecks {
            *known = Arc::new(wrecks);
        }
    }

    /// Whether `robot` takes part, or how it stands; one that returns is suspended by the roll.
    pub(super) fn standing_of(&self, robot: NodeId) -> Attendance {
        match (self.gone.contains(robot), self.suspended.contains(robot)) {
            (true, _) => Attendance::Gone,
            (false, true) => Attendance::Suspended,
            (false, false) => Attendance::Present,
        }
    }

    /// Whether `robot` does not take part.
    pub(super) fn contains(&self, robot: NodeId) -> bool {
        self.suspended.contains(robot) || self.gone.contains(robot)
    }
}

impl Roll {
    /// Takes over `heard` if it was called later; returns whether other robots are absent now.
    #[inline]
    pub(super) fn merge(&mut self, heard: &Roll) -> bool {
        if heard.called <= self.called {
            return false;
        }
        self.called = heard.called;
        let differs = self.absent != heard.absent;
        if differs {
            self.absent = Arc::clone(&heard.absent);
        }
        differs
    }

    /// Whether this roll is valid in control period `period`, if rolls are for `validity` periods.
    pub(super) const fn is_valid(&self, period: u32, validity: u32) -> bool {
        period <= self.called.saturating_add(validity)
    }

    /// Whether `robot` may move in control period `period` by this roll, if rolls are valid for
    /// `validity` periods.
    pub(super) fn lets_move(&self, robot: NodeId, period: u32, validity: u32) -> bool {
        self.is_valid(period, validity) && !self.absent.contains(robot)
    }

    /// Whether `robot` is called gone.
    pub(super) fn calls_gone(&self, robot: NodeId) -> bool {
        self.absent.gone.contains(robot)
    }
}

/// Why a mission goes on, or ends, without these robots.
pub(super) fn why_absent(robots: &[NodeId]) -> String {
    let them = if robots.len() < 2 { "it" } else { "them" };
    format!(
        "{} stopped, or no access point hears of {them}",
        phrase::robots(robots, ["has", "have"])
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lemma `roll.smt2`, for all rolls of the first periods: where two that let a robot move and call
    /// it gone are more than the validity apart, no period is one of both, and where they are not, one is.
    #[test]
    fn rolls_are_valid_as_the_lemma_says() {
        let gone = Absent { gone: IdSet::singleton(1), ..Absent::default() };
        let absent = [Arc::default(), Arc::new(gone)];
        for (validity, called, other) in (1..4_u32)
            .flat_map(|validity| (0..9).map(move |called| (validity, called)))
            .flat_map(|(validity, called)| (0..9).map(move |other| (validity, called, other)))
        {
            let moves = Roll { called, absent: Arc::clone(&absent[0]) };
            let calls_gone = Roll { called: other, absent: Arc::clone(&absent[1]) };
            let is_unsafe = |period: u32| {
                let is_known = called <= period && other <= period;
                is_known
                    && moves.lets_move(1, period, validity)
                    && calls_gone.lets_move(0, period, validity)
                    && calls_gone.calls_gone(1)
            };
            assert!(!moves.calls_gone(1) && !calls_gone.lets_move(1, other, validity));
            assert_eq!((0..20).any(is_unsafe), called.abs_diff(other) <= validity);
        }
    }
}
