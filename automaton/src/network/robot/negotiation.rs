//! Negotiation: the move that a robot proposes, what it receives of the moves of others, and who consents (Sec. IV,
//! Algorithm 5).
//!
//! A robot *relies* on those to which it sends and on its parent in the tree: their moves change its
//! load and the length of its link. A robot that receives moves on which its load could depend judges
//! them all together ([`judging`](super::judging)). It objects or consents; a mover that receives an objection halves its
//! move. Shrinking moves never creates a new objection, so that consent to a move is consent to what is left of it.
//!
//! A robot moves only with the consent of all that rely on it, or of a *witness* where nobody does: so there
//! is always a node that knows where a robot is that stops. A message that is lost takes away the
//! right to move and never gives one: a robot whose proposal is not received stays where others take it to
//! be, and a robot that does not know where those are on which it relies consents to nothing and
//! stays.

use pleach_continuous::Point;
use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::network::motion::MotionProblem;
use pleach_discrete::network::NodeId;
use pleach_discrete::network::consent::all_consent;

use super::navigation::Navigation;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

/// The moves of a robot and of its neighbours in the negotiation of a control period.
#[derive(Clone, Debug, Default)]
pub(super) struct Negotiation {
    /// Where the robot goes.
    navigation: Navigation,
    /// The move that the robot intends.
    proposal: Option<Segment>,
    /// Its proposal as it was sent last.
    sent: Option<Segment>,
    /// Problem (21) of the last sample, if the robot was in its region: it moves there.
    problem: Option<MotionProblem>,
    /// The moves that others propose.
    moves: Vec<(NodeId, Segment)>,
    /// Whether moves have changed since they were judged.
    must_judge: bool,
    /// The nodes that consent to its move.
    consents: Vec<NodeId>,
    /// The robots that wait for its own consent.
    to_answer: Vec<NodeId>,
    /// The robots to whose moves it has consented, each with the control period in which it did last.
    consented: Vec<(NodeId, u32)>,
}

impl Negotiation {
    /// A negotiation begins: nothing is proposed, nothing has been received of others, and nobody consents.
    pub(super) fn begin(&mut self) {
        (self.proposal, self.sent, self.problem) = (None, None, None);
        self.moves.clear();
        self.consents.clear();
        self.to_answer.clear();
        self.must_judge = true;
    }

    /// Where the robot goes.
    pub(super) const fn navigation(&self) -> &Navigation {
        &self.navigation
    }

    /// The robot goes elsewhere.
    pub(super) const fn navigation_mut(&mut self) -> &mut Navigation {
        &mut self.navigation
    }

    /// The robot intends this move, to a solution of a problem.
    pub(super) fn propose(&mut self, segment: Segment, problem: MotionProblem) {
        self.proposal = Some(segment);
        self.problem = Some(problem).filter(|problem| problem.admits(&segment.from));
    }

    /// Whether the robot intends a move.
    pub(super) const fn has_proposal(&self) -> bool {
        self.proposal.is_some()
    }

    /// Where the robot would be that is here.
    pub(super) fn own_move(&self, position: Point) -> Segment {
        self.proposal.unwrap_or(Segment::still(position))
    }

    /// By how much a robot here is outside of the region in which it moves; 0 if it stands still.
    pub(super) fn outside(&self, position: Point) -> f64 {
        let margin =
            self.problem.as_ref().map_or(0.0, |problem| problem.smallest_margin(&position));
        (-margin).max(0.0)
    }

    /// Whether the proposed move has to be sent: until all that rely on the robot consent, and whenever it changes.
    pub(super) fn has_to_send(&self, reliant: &[NodeId]) -> bool {
        self.sent != self.proposal || !self.has_consents_of(reliant)
    }

    /// Sends the proposed move, if there is one, with the witness that it needs where nobody relies on the robot.
    pub(super) fn send(&mut self, period: u32, witness: Option<NodeId>, outputs: &mut NodeOutputs) {
        self.sent = self.proposal;
        if let Some(segment) = self.proposal {
            outputs.broadcast(Message::Proposal { period, segment, witness });
        }
    }

    /// A neighbour proposes a move, and waits for the consent of this robot or not.
    pub(super) fn receive_proposal(&mut self, from: NodeId, segment: Segment, waits: bool) {
        if waits && !self.to_answer.contains(&from) {
            self.to_answer.push(from);
        }
        match self.moves.iter_mut().find(|(mover, _)| *mover == from) {
            // Moves only shrink within a control period: a longer one is late.
            Some((_, known)) if known.length() <= segment.length() => return,
            Some((_, known)) => *known = segment,
            None => self.moves.push((from, segment)),
        }
        self.must_judge = true;
    }

    /// The move that a neighbour proposes.
    pub(super) fn move_of(&self, node: NodeId) -> Option<Segment> {
        self.moves.iter().find(|(from, _)| *from == node).map(|&(_, segment)| segment)
    }

    /// The neighbours that propose a move.
    pub(super) fn movers(&self) -> impl Iterator<Item = NodeId> {
        self.moves.iter().map(|&(mover, _)| mover)
    }

    /// A node that relies on the robot, or is its witness, consents to its move.
    pub(super) fn receive_consent(&mut self, from: NodeId) {
        if !self.consents.contains(&from) {
            self.consents.push(from);
        }
    }

    /// Whether all of these consent to the move, and one node at least.
    fn has_consents_of(&self, reliant: &[NodeId]) -> bool {
        !self.consents.is_empty() && all_consent(reliant.iter().copied(), &self.consents)
    }

    /// Without the consent of all that rely on it, and of one node at least, the robot stays.
    pub(super) fn stay_without_consent(&mut self, reliant: &[NodeId]) {
        if !self.has_consents_of(reliant) {
            self.withdraw();
        }
    }

    /// The robot gives its move up.
    pub(super) const fn withdraw(&mut self) {
        self.proposal = None;
    }

    /// A neighbour, or the robot itself, objects to its move: it halves it or, in the last round,
    /// gives it up. A move that leads back into the region from outside is made in whole or not at all: half
    /// of it might not gain what errors may lose.
    pub(super) fn yield_to_objection(&mut self, is_last_chance: bool) {
        self.must_judge |= self.proposal.is_some();
        let may_shrink = self.problem.is_some() && !is_last_chance;
        self.proposal = self.proposal.filter(|_| may_shrink).map(|segment| segment.halved());
    }

    /// Whether the robot neither proposes a move nor has received any.
    pub(super) const fn is_idle(&self) -> bool {
        self.moves.is_empty() && self.proposal.is_none()
    }

    /// Whether the robot neither proposes a move nor has received one that it has not answered.
    pub(super) const fn has_nothing_to_judge(&self) -> bool {
        let is_answered = !self.must_judge && self.to_answer.is_empty();
        self.proposal.is_none() && (self.moves.is_empty() || is_answered)
    }

    /// Whether moves are not as they were when they were accepted.
    pub(super) const fn must_judge(&self) -> bool {
        self.must_judge
    }

    /// All moves are acceptable: consents to those that wait for that.
    pub(super) fn consent(&mut self, period: u32, outputs: &mut NodeOutputs) {
        self.must_judge = false;
        for mover in std::mem::take(&mut self.to_answer) {
            outputs.send(mover, Message::Consent { period });
            self.consented.retain(|&(other, _)| other != mover);
            self.consented.push((mover, period));
        }
    }

    /// Whether the robot has consented to a move of this node in a control period or later.
    pub(super) fn has_consented_since(&self, node: NodeId, period: u32) -> bool {
        self.consented.iter().any(|&(mover, consented)| mover == node && consented >= period)
    }
}

#[cfg(test)]
impl Negotiation {
    /// The robot intends this move instead.
    pub(super) const fn intends(&mut self, segment: Option<Segment>) {
        self.proposal = segment;
    }

    /// The move that the robot intends.
    pub(super) const fn proposal(&self) -> Option<Segment> {
        self.proposal
    }

    /// The region in which it moves.
    pub(super) const fn problem(&self) -> Option<&MotionProblem> {
        self.problem.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: u32 = 50;

    fn to(x: f64) -> Segment {
        Segment { from: Point::origin(), to: Point::new(x, 0.0) }
    }

    /// The problem of a robot that may go anywhere, or nowhere.
    fn problem(admits: bool) -> MotionProblem {
        use pleach_continuous::Vector;
        use pleach_continuous::geometry::HalfPlane;
        let (position, waypoint) = (Point::origin(), Point::new(1.0, 0.0));
        let beyond = HalfPlane::new(Vector::new(1.0, 0.0), -1.0);
        let half_planes = if admits { Vec::new() } else { vec![beyond] };
        MotionProblem { position, waypoint, half_planes, discs: Vec::new() }
    }

    fn proposing(admits: bool) -> Negotiation {
        let mut negotiation = Negotiation::default();
        negotiation.begin();
        negotiation.propose(to(0.1), problem(admits));
        negotiation
    }

    fn sends(negotiation: &mut Negotiation, reliant: &[NodeId]) -> usize {
        let mut outputs = NodeOutputs::of(0);
        if negotiation.has_to_send(reliant) {
            negotiation.send(NOW, None, &mut outputs);
        }
        outputs.drain_sent().count()
    }

    #[test]
    fn a_proposal_is_sent_until_all_have_consented_and_whenever_it_changes() {
        let mut negotiation = proposing(true);
        let reliant = [1];
        assert_eq!([sends(&mut negotiation, &reliant), sends(&mut negotiation, &reliant)], [1, 1]);
        negotiation.receive_consent(1);
        assert_eq!(sends(&mut negotiation, &reliant), 0);
        negotiation.yield_to_objection(false);
        assert_eq!([sends(&mut negotiation, &reliant), sends(&mut negotiation, &reliant)], [1, 0]);
    }

    #[test]
    fn a_robot_moves_with_the_consent_of_all_that_rely_on_it_and_of_one_at_least() {
        let moves = |reliant: &[NodeId], consents: &[NodeId]| {
            let mut negotiation = proposing(true);
            consents.iter().for_each(|&from| negotiation.receive_consent(from));
            negotiation.stay_without_consent(reliant);
            negotiation.proposal().is_some()
        };
        assert!(!moves(&[1], &[]) && !moves(&[1], &[2]) && !moves(&[], &[]));
        assert!(moves(&[1], &[1]) && moves(&[1], &[2, 1, 1]) && moves(&[], &[4]));
    }

    #[test]
    fn an_objection_halves_a_move_and_at_last_ends_it() {
        let mut negotiation = proposing(true);
        negotiation.consent(NOW, &mut NodeOutputs::of(0));
        negotiation.yield_to_objection(false);
        assert_eq!(negotiation.own_move(Point::origin()), to(0.1).halved());
        assert!(negotiation.must_judge(), "its own move has changed");
        negotiation.yield_to_objection(true);
        assert_eq!(negotiation.proposal(), None);
    }

    /// Half of a way back into the region might gain less than errors lose.
    #[test]
    fn a_move_that_begins_outside_of_its_region_is_made_in_whole_or_not_at_all() {
        let mut negotiation = proposing(false);
        assert_eq!(negotiation.outside(Point::origin()), 0.0, "no region is kept to");
        negotiation.yield_to_objection(false);
        assert_eq!(negotiation.proposal(), None);
    }

    #[test]
    fn moves_that_are_received_only_shrink() {
        let mut negotiation = Negotiation::default();
        negotiation.begin();
        negotiation.receive_proposal(5, to(0.08), false);
        negotiation.consent(NOW, &mut NodeOutputs::of(0));
        negotiation.receive_proposal(5, to(0.09), false);
        assert_eq!((negotiation.move_of(5), negotiation.must_judge()), (Some(to(0.08)), false));
        negotiation.receive_proposal(5, to(0.04), false);
        assert_eq!((negotiation.move_of(5), negotiation.must_judge()), (Some(to(0.04)), true));
        assert_eq!(negotiation.movers().collect::<Vec<_>>(), [5]);
    }

    #[test]
    fn a_consent_is_sent_once_and_remembered() {
        let mut negotiation = Negotiation::default();
        negotiation.begin();
        negotiation.receive_proposal(5, to(0.08), true);
        negotiation.receive_proposal(6, to(0.08), false);
        let mut consents = || {
            let mut outputs = NodeOutputs::of(0);
            negotiation.consent(NOW, &mut outputs);
            outputs.drain_sent().count()
        };
        assert_eq!([consents(), consents()], [1, 0]);
        assert!(negotiation.has_nothing_to_judge());
        let has_consented = |node, period| negotiation.has_consented_since(node, period);
        assert!(has_consented(5, NOW) && !has_consented(5, NOW + 1) && !has_consented(6, NOW));
        negotiation.begin();
        assert!(negotiation.has_consented_since(5, NOW) && negotiation.is_idle());
    }
}
