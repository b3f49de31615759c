//! The stretches of a mission in which tasks are pursued, in a lane for each team.

use pleach_automaton::network::record::Snapshot;

/// From which control period on each team pursues which task.
#[derive(Clone, Debug, Default)]
pub(super) struct Lanes {
    teams: Vec<Vec<(usize, Option<usize>)>>,
}

/// A stretch in which a team pursues a task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Band {
    pub lane: usize,
    /// Which of its lane it is.
    pub rank: usize,
    pub task: usize,
    /// Control periods: from one until another.
    pub from: usize,
    pub until: usize,
}

impl Lanes {
    pub(super) fn observe(&mut self, snapshot: &Snapshot) {
        let pursuits = snapshot.pursuits();
        self.teams.resize(pursuits.len(), Vec::new());
        for (team, pursuit) in self.teams.iter_mut().zip(pursuits) {
            if team.last().is_none_or(|&(_, task)| task != pursuit.task) {
                team.push((snapshot.step, pursuit.task));
            }
        }
    }

    /// How many lanes there are.
    pub(super) fn count(&self) -> usize {
        self.teams.len()
    }

    /// The stretches until `last`, lane by lane.
    pub(super) fn bands(&self, last: usize) -> Vec<Band> {
        let of = |(lane, team): (usize, &Vec<(usize, Option<usize>)>)| -> Vec<Band> {
            let ends = team.iter().skip(1).map(|&(end, _)| end).chain([last]);
            let stretches = team.iter().zip(ends);
            let pursued = stretches.filter_map(|(&(from, task), until)| Some((from, task?, until)));
            let ranked = pursued.enumerate();
            ranked
                .map(|(rank, (from, task, until))| Band { lane, rank, task, from, until })
                .collect()
        };
        self.teams.iter().enumerate().flat_map(of).collect()
    }
}
