//! Changes of what a snapshot shows: each list of it is spoiled in every way that makes sense.

use super::change::{Change, changes};
use nalgebra::vector;
use pleach::automaton::network::record::{Route, Snapshot};
use pleach::discrete::Location as _;
use pleach::discrete::network::{Activity, Phase, Role};

/// A robot with this role that may not move.
fn still(now: &Snapshot, role: Role) -> Option<usize> {
    (0..now.roles.len()).find(|robot| now.roles[*robot] == role && !now.active.contains(robot))
}

/// A list with its members in the reverse order, which is another one.
fn reverse(list: &mut [usize]) {
    list.reverse();
}

/// The first member becomes the first robot that is not in the list.
fn rename(list: &mut [usize], robots: usize) {
    if let Some(stranger) = (0..robots).find(|robot| !list.contains(robot))
        && let Some(first) = list.first_mut()
    {
        *first = stranger;
    }
}

fn swap_ends<T>(list: &mut [T]) {
    if list.len() > 1 {
        let last = list.len() - 1;
        list.swap(0, last);
    }
}

fn duplicate_first<T: Clone>(list: &mut Vec<T>) {
    if let Some(first) = list.first().cloned() {
        list.insert(0, first);
    }
}

/// A share of a robot that sends to one node only, all the way down to an access point: the flow
/// grows there, and residuals stay what routes amount to.
fn shift_share(now: &mut Snapshot, by: f64) {
    let robots = now.roles.len();
    let lone = |from: usize| now.routes.iter().filter(|route| route.from == from).count() == 1;
    let found = now.routes.iter().position(|it| it.to >= robots && lone(it.from));
    if let Some(route) = found.and_then(|at| now.routes.get_mut(at)) {
        route.share += by;
        now.residuals[route.from] += by * route.reliability;
    }
}

pub const ALL: &[Change] = changes! {
    "location: a relay is shown as leading the team" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Node) {
            now.robots[robot].activity = Activity::Leading;
        }
    };
    "positions: a robot that stands is shifted by 10⁻⁴" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Redundant) {
            now.positions[robot] += vector![1e-4, 0.0];
        }
    };
    "positions: a robot of the active team is shifted by 10⁻⁴" => |record, site| {
        let now = record.at(site);
        if let Some(&robot) = now.active_team.last() {
            now.positions[robot] += vector![1e-4, 0.0];
        }
    };
    "positions: a robot is shifted by ten steps" => |record, site| {
        record.at(site).positions[0] += vector![0.1, 0.0];
    };
    "positions: two are swapped" => |record, site| record.at(site).positions.swap(0, 1);
    "positions: one is that of another robot" => |record, site| {
        let now = record.at(site);
        now.positions[0] = now.positions[1];
    };
    "positions: one is dropped" => |record, site| record.at(site).positions.pop();
    "positions: one is not a number" => |record, site| record.at(site).positions[0].x = f64::NAN;
    "roles: a redundant robot is a node" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Redundant) {
            now.roles[robot] = Role::Node;
        }
    };
    "roles: a node is a junction" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Node) {
            now.roles[robot] = Role::Junction;
        }
    };
    "roles: a leaf is a node" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Leaf) {
            now.roles[robot] = Role::Node;
        }
    };
    "roles: two are swapped" => |record, site| {
        let roles = &mut record.at(site).roles;
        if let Some(other) = roles.iter().position(|role| *role != roles[0]) {
            roles.swap(0, other);
        }
    };
    "roles: everybody is redundant from here on" => |record, site| {
        record.from(site).for_each(|now| now.roles.fill(Role::Redundant));
    };
    "roles: one is dropped" => |record, site| record.at(site).roles.pop();
    "phase: it is the next one" => |record, site| {
        let now = record.at(site);
        let at = Phase::ALL.iter().position(|phase| *phase == now.phase).unwrap();
        now.phase = Phase::ALL[(at + 1) % Phase::ALL.len()];
    };
    "phase: it is that of the period before" => |record, site| {
        if site > 0 {
            record.at(site).phase = record.periods[site - 1].snapshot.phase;
        }
    };
    "phase: it is “ended” for one period" => |record, site| record.at(site).phase = Phase::Ended;
    "task: none is pursued" => |record, site| record.at(site).task = None;
    "task: it is the next one" => |record, site| {
        let now = record.at(site);
        now.task = now.task.map(|task| task + 1);
    };
    "task: it is the first one from here on" => |record, site| {
        record.from(site).for_each(|now| now.task = now.task.map(|_| 0));
    };
    "active: everybody may move" => |record, site| {
        let now = record.at(site);
        now.active = (0..now.roles.len()).collect();
    };
    "active: no robot may move" => |record, site| record.at(site).active.clear();
    "active: the first is dropped" => |record, site| {
        let now = record.at(site);
        if !now.active.is_empty() {
            now.active.remove(0);
        }
    };
    "active: one is duplicated" => |record, site| duplicate_first(&mut record.at(site).active);
    "active: the first is another robot" => |record, site| {
        let now = record.at(site);
        rename(&mut now.active, now.roles.len());
        now.active.sort_unstable();
    };
    "active: it is in another order" => |record, site| reverse(&mut record.at(site).active);
    "active team: it is emptied" => |record, site| record.at(site).active_team.clear();
    "active team: the last is dropped" => |record, site| {
        record.at(site).active_team.pop();
    };
    "active team: it is in another order" => |record, site| {
        reverse(&mut record.at(site).active_team);
    };
    "active team: the first is another robot" => |record, site| {
        let now = record.at(site);
        rename(&mut now.active_team, now.roles.len());
    };
    "active team: two teams at once" => |record, site| {
        let now = record.at(site);
        if now.active_team != now.primary_team {
            now.active_team.extend(&now.primary_team);
            now.active.extend(&now.primary_team);
            now.active.sort_unstable();
            now.active.dedup();
        }
    };
    "active team: the primary team instead of a subgroup" => |record, site| {
        let now = record.at(site);
        if !now.active_team.is_empty() && now.active_team != now.primary_team {
            now.active.retain(|robot| !now.active_team.contains(robot));
            now.active.extend(&now.primary_team);
            now.active.sort_unstable();
            now.active_team = now.primary_team.clone();
        }
    };
    "primary team: it is emptied" => |record, site| record.at(site).primary_team.clear();
    "primary team: the first is dropped" => |record, site| {
        let now = record.at(site);
        if now.primary_team.len() > 1 {
            now.primary_team.remove(0);
        }
    };
    "primary team: it is in another order" => |record, site| {
        reverse(&mut record.at(site).primary_team);
    };
    "primary team: the first is another robot" => |record, site| {
        let now = record.at(site);
        rename(&mut now.primary_team, now.roles.len());
    };
    "primary team: one is duplicated" => |record, site| {
        duplicate_first(&mut record.at(site).primary_team);
    };
    "path: it is emptied" => |record, site| record.at(site).path.clear();
    "path: the last is dropped" => |record, site| record.at(site).path.pop();
    "path: it is in another order" => |record, site| reverse(&mut record.at(site).path);
    "path: the first is another robot" => |record, site| {
        let now = record.at(site);
        rename(&mut now.path, now.roles.len());
    };
    "path: another robot is on it" => |record, site| {
        let now = record.at(site);
        if let Some(robot) = still(now, Role::Redundant) {
            now.path.push(robot);
        }
    };
    "path: the primary team is on it" => |record, site| {
        let now = record.at(site);
        now.path.extend(&now.primary_team);
    };
    "residuals: one is shifted by 10⁻³" => |record, site| record.at(site).residuals[0] += 1e-3;
    "residuals: one is negative" => |record, site| record.at(site).residuals[0] *= -1.0;
    "residuals: one is dropped" => |record, site| record.at(site).residuals.pop();
    "multipliers: one is negative" => |record, site| record.at(site).multipliers[0] = -0.1;
    "multipliers: one is not a number" => |record, site| {
        record.at(site).multipliers[0] = f64::NAN;
    };
    "multipliers: one is dropped" => |record, site| record.at(site).multipliers.pop();
    "multipliers: one is shifted by 0.1" => |record, site| record.at(site).multipliers[0] += 0.1;
    "multipliers: two are swapped" => |record, site| swap_ends(&mut record.at(site).multipliers);
    "routes: one is dropped" => |record, site| record.at(site).routes.remove(0);
    "routes: all are dropped" => |record, site| record.at(site).routes.clear();
    "routes: one is duplicated" => |record, site| duplicate_first(&mut record.at(site).routes);
    "routes: a share is shifted by 10⁻³" => |record, site| {
        record.at(site).routes[0].share += 1e-3;
    };
    "routes: a share is shifted by 10⁻³, and the residual with it" => |record, site| {
        shift_share(record.at(site), 1e-3);
    };
    "routes: a share grows to two, and the residual with it" => |record, site| {
        shift_share(record.at(site), 2.0);
    };
    "routes: a share is negative" => |record, site| record.at(site).routes[0].share *= -1.0;
    "routes: one goes to another node" => |record, site| {
        let now = record.at(site);
        let Route { from, to, .. } = now.routes[0];
        now.routes[0].to = (0..now.roles.len()).find(|node| ![from, to].contains(node)).unwrap();
    };
    "routes: one goes the other way" => |record, site| {
        let robots = record.at(site).roles.len();
        if let Some(route) = record.at(site).routes.iter_mut().find(|route| route.to < robots) {
            std::mem::swap(&mut route.from, &mut route.to);
        }
    };
    "routes: a reliability is shifted by 10⁻³" => |record, site| {
        record.at(site).routes[0].reliability -= 1e-3;
    };
    "routes: two shares are swapped" => |record, site| {
        let routes = &mut record.at(site).routes;
        let (one, other) = (routes[0].share, routes[routes.len() - 1].share);
        let last = routes.len() - 1;
        (routes[0].share, routes[last].share) = (other, one);
    };
    "tree: the edge of a robot with a duty is dropped" => |record, site| {
        let now = record.at(site);
        let roles = now.roles.clone();
        if let Some(at) = now.tree.iter().position(|&(child, _)| roles[child] != Role::Redundant) {
            now.tree.remove(at);
        }
    };
    "tree: the edge of a redundant robot is dropped" => |record, site| {
        let now = record.at(site);
        let roles = now.roles.clone();
        let parents: Vec<usize> = now.tree.iter().map(|&(_, parent)| parent).collect();
        let idle = |child: usize| roles[child] == Role::Redundant && !parents.contains(&child);
        if let Some(at) = now.tree.iter().position(|&(child, _)| idle(child)) {
            now.tree.remove(at);
        }
    };
    "tree: an edge is duplicated" => |record, site| duplicate_first(&mut record.at(site).tree);
    "tree: an edge goes the other way" => |record, site| {
        let now = record.at(site);
        let robots = now.roles.len();
        if let Some(edge) = now.tree.iter_mut().find(|(_, parent)| *parent < robots) {
            *edge = (edge.1, edge.0);
        }
    };
    "tree: a robot is attached to itself through its child" => |record, site| {
        let now = record.at(site);
        let robots = now.roles.len();
        if let Some(&(child, parent)) = now.tree.iter().find(|(_, parent)| *parent < robots) {
            now.tree.retain(|&(robot, _)| robot != parent);
            now.tree.push((parent, child));
        }
    };
    "tree: a robot is attached to one out of range" => |record, site| {
        let now = record.at(site);
        let places = now.positions.clone();
        let far = |&(child, _): &(usize, usize)| {
            (0..places.len()).find(|&node| (places[child] - places[node]).norm() > 0.6)
        };
        if let Some(at) = now.tree.iter().position(|edge| far(edge).is_some()) {
            now.tree[at].1 = far(&now.tree[at]).unwrap();
        }
    };
    "tree: it is emptied" => |record, site| record.at(site).tree.clear();
    "tree: it is emptied and everybody redundant, from here on" => |record, site| {
        for now in record.from(site) {
            now.tree.clear();
            now.roles.fill(Role::Redundant);
        }
    };
    "serviced: it is emptied" => |record, site| record.at(site).serviced.clear();
    "serviced: a task is dropped from here on" => |record, site| {
        record.from(site).for_each(|now| { now.serviced.pop(); });
    };
    "serviced: a task is duplicated" => |record, site| {
        duplicate_first(&mut record.at(site).serviced);
    };
    "serviced: another robot answers for a task" => |record, site| {
        let now = record.at(site);
        let robots = now.roles.len();
        if let Some((_, robot)) = now.serviced.first_mut() {
            *robot = (*robot + 1) % robots;
        }
    };
    "serviced: the holders of two tasks are swapped" => |record, site| {
        if let [(_, one), .., (_, other)] = &mut record.at(site).serviced[..] {
            std::mem::swap(one, other);
        }
    };
    "serviced: a task is too early" => |record, site| {
        let now = record.at(site);
        if let (Some(task), Some(&leader)) = (now.task, now.primary_team.last()) {
            now.serviced.push((task, leader));
        }
    };
    "posts: all are dropped" => |record, site| record.at(site).posts.clear();
    "posts: all are dropped from here on" => |record, site| {
        record.from(site).for_each(|now| now.posts.clear());
    };
    "posts: those of junctions are dropped" => |record, site| {
        record.at(site).posts.retain(|post| !post.junction);
    };
    "posts: one is dropped" => |record, site| record.at(site).posts.pop();
    "posts: one is duplicated" => |record, site| duplicate_first(&mut record.at(site).posts);
    "posts: one is held by a redundant robot" => |record, site| {
        let now = record.at(site);
        if let (Some(robot), true) = (still(now, Role::Redundant), !now.posts.is_empty()) {
            now.posts[0].holder = robot;
        }
    };
    "posts: the holders of two are swapped" => |record, site| {
        if let [one, .., other] = &mut record.at(site).posts[..] {
            std::mem::swap(&mut one.holder, &mut other.holder);
        }
    };
    "posts: one is somewhere else" => |record, site| {
        if let Some(post) = record.at(site).posts.first_mut() {
            post.reference += vector![0.1, 0.0];
        }
    };
    "posts: one is shifted by 10⁻³" => |record, site| {
        if let Some(post) = record.at(site).posts.first_mut() {
            post.reference += vector![1e-3, 0.0];
        }
    };
    "posts: a task is dropped" => |record, site| {
        if let Some(post) = record.at(site).posts.iter_mut().find(|post| post.task.is_some()) {
            post.task = None;
        }
    };
    "posts: one is for a task" => |record, site| {
        if let Some(post) = record.at(site).posts.iter_mut().find(|post| post.task.is_none()) {
            post.task = Some(0);
        }
    };
    "posts: one is for another task" => |record, site| {
        if let Some(post) = record.at(site).posts.iter_mut().find(|post| post.task.is_some()) {
            post.task = post.task.map(|task| usize::from(task == 0));
        }
    };
    "posts: one is a junction" => |record, site| {
        if let Some(post) = record.at(site).posts.iter_mut().find(|post| !post.junction) {
            post.junction = true;
        }
    };
    "posts: a junction is none" => |record, site| {
        if let Some(post) = record.at(site).posts.iter_mut().find(|post| post.junction) {
            post.junction = false;
        }
    };
};
