//! One record of several fleets, and each fleet's part of it.

use super::record::{End, FleetEnd, FleetView, Outcome, PostView, Route, Snapshot};
use super::renumbering::Renumbering;
use super::scenario::Fleet;
use pleach_discrete::network::Phase;

/// What is recorded of a fleet at one instant, in its own numbers.
#[derive(Clone, Debug)]
pub struct Part<'a> {
    /// The fleet.
    pub fleet: &'a Fleet,
    /// What observers see of its network.
    pub snapshot: Snapshot,
    /// The control period from whose beginning on its mission is over, if it is.
    pub ended: Option<usize>,
}

impl<'a> Part<'a> {
    /// What a snapshot of several fleets shows of this one; none if it does not show it.
    pub fn of(fleet: &'a Fleet, whole: &Snapshot) -> Option<Self> {
        let view = whole.fleets.iter().find(|view| view.access_point == fleet.access_point())?;
        Some(Part { fleet, snapshot: whole.of_fleet(fleet, view)?, ended: view.ended })
    }

    fn out(&self) -> &Renumbering {
        self.fleet.outward()
    }

    fn view(&self) -> FleetView {
        let Snapshot { phase, task, active_team, primary_team, path, .. } = &self.snapshot;
        let nodes = |nodes: &[usize]| self.out().nodes(nodes).unwrap_or_default();
        FleetView {
            access_point: self.fleet.access_point(),
            phase: *phase,
            task: task.and_then(|task| self.out().task(task)),
            active_team: nodes(active_team),
            primary_team: nodes(primary_team),
            path: nodes(path),
            ended: self.ended,
        }
    }
}

/// The parts of a snapshot side by side.
struct Parts<'a>(&'a [Part<'a>]);

impl Parts<'_> {
    /// What each robot has one of, by its number in the whole.
    fn by_robot<T: Clone>(&self, list: impl Fn(&Snapshot) -> &Vec<T>) -> Vec<T> {
        let of_part = |part: &Part| -> Vec<(usize, T)> {
            part.fleet.robots().iter().copied().zip(list(&part.snapshot).iter().cloned()).collect()
        };
        let mut all: Vec<_> = self.0.iter().flat_map(of_part).collect();
        all.sort_by_key(|(robot, _)| *robot);
        all.into_iter().map(|(_, entry)| entry).collect()
    }

    /// The entries of all lists in the numbers of the whole, in ascending order of what `order` gives.
    fn sorted<T, K: Ord>(
        &self,
        list: impl Fn(&Snapshot) -> &Vec<T>,
        renumbered: impl Fn(&T, &Renumbering) -> Option<T>,
        order: impl Fn(&T) -> K,
    ) -> Vec<T> {
        let of_part = |part: &Part| -> Vec<T> {
            let entries = list(&part.snapshot).iter();
            entries.filter_map(|entry| renumbered(entry, part.out())).collect()
        };
        let mut all: Vec<T> = self.0.iter().flat_map(of_part).collect();
        all.sort_by_key(order);
        all
    }
}

impl Snapshot {
    /// One snapshot of several fleets at the same instant. What there is one of, is that of the first fleet whose
    /// mission goes on, or of the first.
    ///
    /// None if there is no fleet.
    pub fn merged(parts: &[Part]) -> Option<Self> {
        let all = Parts(parts);
        let views: Vec<FleetView> = parts.iter().map(Part::view).collect();
        let shown = views.iter().find(|view| view.phase != Phase::Ended).or(views.first())?;
        let joined =
            |list: fn(&FleetView) -> &Vec<usize>| views.iter().flat_map(list).copied().collect();
        let number = |node: &usize| *node;
        Some(Snapshot {
            step: parts.first()?.snapshot.step,
            time: parts.first()?.snapshot.time,
            positions: all.by_robot(|it| &it.positions),
            roles: all.by_robot(|it| &it.roles),
            phase: shown.phase,
            active: all.sorted(|it| &it.active, node, number),
            active_team: joined(|view| &view.active_team),
            primary_team: joined(|view| &view.primary_team),
            path: joined(|view| &view.path),
            residuals: all.by_robot(|it| &it.residuals),
            multipliers: all.by_robot(|it| &it.multipliers),
            routes: all.sorted(|it| &it.routes, route, |route| route.from),
            tree: all.sorted(|it| &it.tree, edge, |edge| edge.0),
            task: shown.task,
            serviced: all.sorted(|it| &it.serviced, service, |service| service.0),
            closed: all.sorted(|it| &it.closed, task, number),
            posts: all.sorted(|it| &it.posts, post, |post| post.holder),
            robots: all.by_robot(|it| &it.robots),
            absent: all.sorted(|it| &it.absent, node, number),
            fleets: views,
        })
    }

    /// What a snapshot of several fleets shows of this one and its view, in the fleet's own numbers and without the
    /// entries that name anything of another fleet.
    fn of_fleet(&self, fleet: &Fleet, view: &FleetView) -> Option<Self> {
        let by = fleet.inward();
        fn own<T: Clone>(list: &[T], robots: &[usize]) -> Option<Vec<T>> {
            robots.iter().map(|&robot| list.get(robot).cloned()).collect()
        }
        fn part<T>(list: &[T], renumbered: impl Fn(&T) -> Option<T>) -> Vec<T> {
            list.iter().filter_map(renumbered).collect()
        }
        let robots = fleet.robots();
        Some(Snapshot {
            step: self.step,
            time: self.time,
            positions: own(&self.positions, robots)?,
            roles: own(&self.roles, robots)?,
            phase: view.phase,
            active: part(&self.active, |it| node(it, by)),
            active_team: by.nodes(&view.active_team)?,
            primary_team: by.nodes(&view.primary_team)?,
            path: by.nodes(&view.path)?,
            residuals: own(&self.residuals, robots)?,
            multipliers: own(&self.multipliers, robots)?,
            routes: part(&self.routes, |it| route(it, by)),
            tree: part(&self.tree, |it| edge(it, by)),
            task: match view.task {
                Some(pursued) => Some(by.task(pursued)?),
                None => None,
            },
            serviced: part(&self.serviced, |it| service(it, by)),
            closed: part(&self.closed, |it| task(it, by)),
            posts: part(&self.posts, |it| post(it, by)),
            robots: match self.robots.is_empty() {
                true => Vec::new(),
                false => own(&self.robots, robots)?,
            },
            absent: part(&self.absent, |it| node(it, by)),
            fleets: Vec::new(),
        })
    }
}

fn node(node: &usize, by: &Renumbering) -> Option<usize> {
    by.node(*node)
}

fn task(task: &usize, by: &Renumbering) -> Option<usize> {
    by.task(*task)
}

fn edge(&(child, parent): &(usize, usize), by: &Renumbering) -> Option<(usize, usize)> {
    Some((by.node(child)?, by.node(parent)?))
}

fn service(&(task, robot): &(usize, usize), by: &Renumbering) -> Option<(usize, usize)> {
    Some((by.task(task)?, by.node(robot)?))
}

fn route(route: &Route, by: &Renumbering) -> Option<Route> {
    Some(Route { from: by.node(route.from)?, to: by.node(route.to)?, ..*route })
}

fn post(post: &PostView, by: &Renumbering) -> Option<PostView> {
    let task = match post.task {
        Some(task) => Some(by.task(task)?),
        None => None,
    };
    Some(PostView { holder: by.node(post.holder)?, task, ..*post })
}

impl End {
    /// The end of several missions beside each other, by access point: all tasks are serviced if they are in each; if
    /// not, it is that of the first that was interrupted or, where none was, of the first whose tasks are not.
    pub fn of_fleets(fleets: Vec<FleetEnd>) -> Self {
        let is = |outcome: Outcome| move |it: &&FleetEnd| it.end.outcome == outcome;
        let is_unserviced = |it: &&FleetEnd| it.end.outcome != Outcome::Serviced;
        let interrupted = fleets.iter().find(is(Outcome::Interrupted));
        let end = match interrupted.or_else(|| fleets.iter().find(is_unserviced)) {
            Some(FleetEnd { access_point, end }) if end.outcome.is_given_up() => {
                let reason = format!("of access point {access_point}: {}", end.reason);
                End { reason, ..end.clone() }
            }
            Some(FleetEnd { end, .. }) => end.clone(),
            None => End::new(Outcome::Serviced, "all tasks are serviced".to_owned(), None),
        };
        End { fleets, ..end }
    }
}
