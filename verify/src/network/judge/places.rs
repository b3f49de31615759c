//! Where each robot belongs while it is not on its way, from the posts, and how far it may go
//! from there.

use pleach_automaton::network::record::{MissionEvent, Snapshot};
use pleach_continuous::Point;
use pleach_discrete::network::Role;

use super::{Dispute, Scene};
use crate::network::limits::SLACK;
use crate::network::property::Property;

/// The place of each robot's post: the reference of a fixed post; for a redundant robot, where it
/// was when it came to rest. Any other robot has none, as it moves with a team or along Σ; that it may be without a
/// fixed post is checked with the posts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Places {
    of_robots: Vec<Option<Point>>,
    /// The places of Σ when it was announced, and whether each is that of a fixed post.
    path: Vec<(Point, bool)>,
    /// The robots of Σ as it was announced: events name them by these.
    announced: Vec<usize>,
    /// The robots of Σ, each at its place until it goes on to the next.
    walkers: Vec<usize>,
}

impl Places {
    pub(super) fn new(robots: usize) -> Self {
        Places {
            of_robots: vec![None; robots],
            path: Vec::new(),
            announced: Vec::new(),
            walkers: Vec::new(),
        }
    }

    /// The place of a robot's post.
    pub(super) fn of(&self, robot: usize) -> Option<Point> {
        self.of_robots[robot]
    }

    /// A place of Σ, and whether it is that of a fixed post; otherwise it is where its robot was, or
    /// came to rest.
    pub(super) fn on_path(&self, place: usize) -> Option<(Point, bool)> {
        self.path.get(place).copied()
    }

    /// Robots that exchange duties exchange places; a path is announced from place to place, and a
    /// subgroup that arrives takes the places ahead.
    pub(super) fn enter(&mut self, event: &MissionEvent, snapshot: &Snapshot) {
        match event {
            MissionEvent::DutiesExchanged { mover, parked } => {
                self.of_robots.swap(*mover, *parked);
                for walker in &mut self.walkers {
                    *walker = match *walker {
                        one if one == *mover => *parked,
                        one if one == *parked => *mover,
                        other => other,
                    };
                }
            }
            MissionEvent::SubgroupArrived { robots, .. } => {
                let ahead = self.path.iter().skip(1);
                for ((named, &walker), &(place, _)) in
                    self.announced.iter().zip(&self.walkers).zip(ahead)
                {
                    if robots.contains(named) {
                        self.of_robots[walker] = Some(place);
                    }
                }
            }
            MissionEvent::RecruitElected { path, .. } => {
                let place = |&robot: &usize| {
                    let is_fixed = snapshot.posts.iter().any(|post| post.holder == robot);
                    (self.of_robots[robot].unwrap_or(snapshot.positions[robot]), is_fixed)
                };
                self.path = path.iter().map(place).collect();
                self.announced.clone_from(path);
                self.walkers.clone_from(path);
            }
            _ => {}
        }
    }

    /// The places after the events of a period.
    pub(super) fn update(&mut self, snapshot: &Snapshot) {
        for (robot, place) in self.of_robots.iter_mut().enumerate() {
            if let Some(post) = snapshot.posts.iter().find(|post| post.holder == robot) {
                *place = Some(post.reference);
            } else if snapshot.roles[robot] != Role::Redundant {
                *place = None;
            } else if place.is_none() {
                *place = Some(snapshot.positions[robot]);
            }
        }
    }

    /// [`Property::Leash`].
    pub(super) fn hold(&self, scene: &Scene) -> Result<(), Dispute> {
        let Some(previous) = scene.previous else { return Ok(()) };
        for (robot, place) in self.of_robots.iter().enumerate() {
            let Some(place) = place.filter(|_| !previous.active_team.contains(&robot)) else {
                continue;
            };
            let [before, now] = [previous, scene.snapshot]
                .map(|snapshot| (snapshot.positions[robot] - place).norm());
            // On its way to the very place it goes round what stands between, and from farther away
            // it comes back.
            let bound = scene.limits.service_radius();
            let returns = [previous, scene.snapshot].iter().any(|snapshot| {
                let target = snapshot.robots.get(robot).and_then(|shown| shown.target);
                target.is_some_and(|target| (target - place).norm() <= SLACK)
            });
            if !returns && before <= bound && now > bound + SLACK {
                let sentence = format!(
                    "robot {robot} is not of the active team and goes to a distance of {now:.6} \
                     from its post, more than {bound:.6}"
                );
                let dispute = Dispute::of(Property::Leash, &[robot], sentence);
                return Err(dispute.measuring(now, bound));
            }
        }
        Ok(())
    }
}
