//! What the network owes to its user, as an abstract machine: no robot, no message, no place.
//!
//! A mission is a sequence of notices. The user announces a task; the network elects a leader, the
//! primary team advances, calls for recruits, and services the task; then the user announces the
//! next one. [`Word::may_follow`] is the whole of it. What the network does next is its own
//! choice, so the machine cannot be run ahead of it: it follows, notice by notice, and refuses what
//! it does not allow.

use std::collections::BTreeMap;

use pleach_automaton::network::RobotView;
use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::duty::Duty;
use pleach_automaton::network::record::Outcome;
use pleach_discrete::network::NodeId;
use pleach_exploration::network::properties::duties;
use pleach_exploration::network::{Protocol, State};

/// The content of a notice on the mission, without issuer and place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Word {
    Quiet,
    Task,
    Call,
    Path,
    Advance,
    Serviced,
    Ended,
}

impl Word {
    const ALL: [Word; 7] = [
        Word::Quiet,
        Word::Task,
        Word::Call,
        Word::Path,
        Word::Advance,
        Word::Serviced,
        Word::Ended,
    ];

    fn of(notice: &Notice) -> Self {
        match notice {
            Notice::Quiet => Word::Quiet,
            Notice::Task(_) => Word::Task,
            Notice::Call { .. } => Word::Call,
            Notice::Path(_) => Word::Path,
            Notice::Advance { .. } => Word::Advance,
            Notice::Serviced { .. } => Word::Serviced,
            Notice::Ended { .. } => Word::Ended,
            other => panic!("no word for {other:?}"),
        }
    }

    fn may_follow(self, before: Word) -> bool {
        match before {
            Word::Quiet => matches!(self, Word::Task | Word::Ended),
            // A leader with past duties calls for a robot that takes them over.
            Word::Task => matches!(self, Word::Call | Word::Advance | Word::Ended),
            // Where the trees of two access points do not meet, the other one's robots may try. Where nobody can
            // come, the team goes on with the longest links once.
            Word::Call => matches!(self, Word::Path | Word::Task | Word::Advance | Word::Ended),
            Word::Path => matches!(self, Word::Advance | Word::Ended),
            Word::Advance => matches!(self, Word::Call | Word::Serviced | Word::Ended),
            Word::Serviced => matches!(self, Word::Task | Word::Ended),
            Word::Ended => false,
        }
    }

    /// The same with `between` notices in between: a robot may issue two at once, and no node
    /// hears the first of them.
    fn may_follow_after(self, between: u32, before: Word) -> bool {
        match between {
            0 => self.may_follow(before),
            _ => Word::ALL
                .into_iter()
                .any(|next| next.may_follow(before) && self.may_follow_after(between - 1, next)),
        }
    }
}

/// The mission as the user sees it, and what must not be taken back.
#[derive(Clone, Debug)]
pub struct Mission {
    /// How many tasks the user has.
    tasks: usize,
    /// How many of them are announced, in their order.
    announced: usize,
    /// How many of them are serviced, in their order.
    serviced: usize,
    /// What was said, by number.
    words: BTreeMap<u32, Notice>,
    /// The number of the newest notice that each node knows.
    known: Vec<u32>,
    /// The winner of each election.
    winners: BTreeMap<u32, Option<NodeId>>,
    /// Whether a robot could have come when a recruit was called for last.
    has_reserve: bool,
}

impl Mission {
    /// Nothing is announced yet.
    pub fn new(tasks: usize) -> Self {
        Mission {
            tasks,
            announced: 0,
            serviced: 0,
            words: BTreeMap::from([(0, Notice::Quiet)]),
            known: Vec::new(),
            winners: BTreeMap::new(),
            has_reserve: false,
        }
    }

    /// How the mission has ended, if it has.
    pub fn outcome(&self) -> Option<Outcome> {
        match self.words.values().next_back()? {
            Notice::Ended { outcome, .. } => Some(*outcome),
            _ => None,
        }
    }

    /// Follows the network to a state, or says which promise is broken.
    pub fn follow(&mut self, protocol: &Protocol, state: &State) -> Result<(), String> {
        self.hear_words(protocol, state)?;
        self.hear_elections(protocol, state)?;
        self.visit_tasks(protocol, state)
    }

    /// One notice at a time, each with its own number, and every node comes to know newer ones only.
    fn hear_words(&mut self, protocol: &Protocol, state: &State) -> Result<(), String> {
        let mut spoken: Vec<_> = protocol
            .locals(state)
            .map(|local| &protocol.nodes().beacon(local.beacon).bulletin)
            .map(|bulletin| (bulletin.number(), &**bulletin.notice()))
            .collect();
        let known: Vec<u32> = spoken.iter().map(|&(number, _)| number).collect();
        let before = std::mem::replace(&mut self.known, known);
        let went_back = |(was, is): (&u32, &u32)| was > is;
        if let Some(node) = before.iter().zip(&self.known).position(went_back) {
            let (was, is) = (before[node], self.known[node]);
            return Err(format!("{node} knew notice {was} and goes back to notice {is}"));
        }
        spoken.sort_by_key(|&(number, _)| number);
        let last = self.newest_word();
        spoken.into_iter().try_for_each(|(number, notice)| self.hear(number, notice))?;
        if self.newest_word() == Word::Call && last != Word::Call {
            let is_bare = |id| protocol.robots(state).all(|other| other.tree_parent() != Some(id));
            let mut robots = protocol.robots(state).enumerate();
            self.has_reserve = robots.any(|(id, r)| r.duty().is_redundant() && is_bare(id));
        }
        Ok(())
    }

    fn newest_word(&self) -> Word {
        self.words.values().next_back().map_or(Word::Quiet, Word::of)
    }

    fn hear(&mut self, number: u32, notice: &Notice) -> Result<(), String> {
        if let Some(known) = self.words.get(&number) {
            // Several robots of a subgroup may give up at once; each names itself.
            let are_both_the_end =
                Word::of(known) == Word::Ended && Word::of(notice) == Word::Ended;
            return match known == notice || are_both_the_end {
                true => Ok(()),
                false => Err(format!("two notices have number {number}: {known:?} and {notice:?}")),
            };
        }
        let last = self.words.keys().next_back().copied().unwrap_or_default();
        let (before, word) = (self.newest_word(), Word::of(notice));
        if number < last || !word.may_follow_after(number - last - 1, before) {
            return Err(format!("{word:?}, notice {number}, follows {before:?}, notice {last}"));
        }
        let is_due = self.count(notice, before);
        self.words.insert(number, notice.clone());
        match is_due {
            true => Ok(()),
            false => Err(format!(
                "{notice:?} when {} of {} tasks are announced and {} serviced",
                self.announced, self.tasks, self.serviced
            )),
        }
    }

    /// Counts the tasks; returns whether it is time for this notice.
    fn count(&mut self, notice: &Notice, before: Word) -> bool {
        match notice {
            Notice::Task(announcement) => {
                // After a call in vain the same task is announced to robots of another tree.
                self.announced += usize::from(before != Word::Call);
                announcement.task == self.serviced && self.announced == self.serviced + 1
            }
            Notice::Serviced { task } => {
                self.serviced += 1;
                *task + 1 == self.serviced && self.serviced == self.announced
            }
            Notice::Ended { outcome: Outcome::Serviced, .. } => self.serviced == self.tasks,
            Notice::Ended { reason, task, .. } => {
                !reason.is_empty() && *task == Some(self.serviced) && self.serviced < self.tasks
            }
            _ => true,
        }
    }

    /// An election is held on a notice that calls for one, and its winner stays the winner.
    fn hear_elections(&mut self, protocol: &Protocol, state: &State) -> Result<(), String> {
        for (id, best) in protocol.robots(state).filter_map(RobotView::concluded_election) {
            let number = id.number;
            let winner = best.map(|(_, robot)| robot);
            let first = *self.winners.entry(number).or_insert(winner);
            if first != winner {
                return Err(format!("election {number} is won by {first:?}, then by {winner:?}"));
            }
            if !matches!(self.words.get(&number), Some(Notice::Task(_) | Notice::Call { .. })) {
                return Err(format!("no notice has called for election {number}"));
            }
        }
        Ok(())
    }

    /// At each task that has been serviced a robot stands.
    fn visit_tasks(&self, protocol: &Protocol, state: &State) -> Result<(), String> {
        let places = &protocol.configuration().places;
        let robots: Vec<_> =
            (0..places.robots()).map(|robot| protocol.place_of(state, robot)).collect();
        let positions = places.task_positions().into_iter().take(self.serviced);
        let left = positions.enumerate().find(|(_, at)| !robots.contains(&places.place_at(*at)));
        match left {
            Some((task, _)) => Err(format!("task {task} was serviced, and no robot is there")),
            None => Ok(()),
        }
    }

    /// What is owed at the end: each serviced task is one robot's. Where the tree has one root,
    /// robots are missing only if none could come.
    pub fn conclude(&self, protocol: &Protocol, state: &State) -> Result<(), String> {
        let duties = duties(protocol, state);
        let has_one_root = protocol.locals(state).filter(|l| l.robot().is_none()).count() == 1;
        let holders = |task| {
            let posts = duties.iter().filter_map(Duty::post);
            posts.filter(|post| post.task == Some(task)).count()
        };
        match self.outcome() {
            None => Err("the mission has not ended".into()),
            Some(Outcome::Serviced) => match (0..self.serviced).find(|&task| holders(task) != 1) {
                Some(task) => Err(format!("{} robots hold task {task}", holders(task))),
                None => Ok(()),
            },
            Some(Outcome::InsufficientRobots) if has_one_root && self.has_reserve => {
                Err("robots are missing, and one could have come".into())
            }
            Some(Outcome::InsufficientRobots | Outcome::Blocked) => Ok(()),
            Some(other) => Err(format!("the mission ends: {}", other.name())),
        }
    }
}
