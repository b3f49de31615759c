//! Numbers of nodes and tasks where the same have two: in a fleet, and in the whole scenario.

use super::certificate::{Attempt, Because, Certificate, Hindrance, Other, Standing};
use super::record::{End, MissionEvent};

/// The numbers of nodes and tasks in another numbering, as far as they have one there.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Renumbering {
    /// By number: robots first, then access points.
    nodes: Vec<Option<usize>>,
    tasks: Vec<Option<usize>>,
}

impl Renumbering {
    /// The renumbering of a whole by its parts: the node of part number i is this one of `count`, and likewise the
    /// task. In the part nothing else exists.
    pub(super) fn into_part(
        nodes: &[usize],
        count: usize,
        tasks: &[usize],
        task_count: usize,
    ) -> Self {
        let inverse = |numbers: &[usize], count: usize| {
            let mut inverse = vec![None; count];
            numbers.iter().enumerate().for_each(|(own, &number)| inverse[number] = Some(own));
            inverse
        };
        Renumbering { nodes: inverse(nodes, count), tasks: inverse(tasks, task_count) }
    }

    /// The renumbering of a part in which node number i is this one of the whole, and likewise the task.
    pub(super) fn out_of_part(nodes: &[usize], tasks: &[usize]) -> Self {
        let all = |numbers: &[usize]| numbers.iter().copied().map(Some).collect();
        Renumbering { nodes: all(nodes), tasks: all(tasks) }
    }

    /// The number of a node.
    pub fn node(&self, node: usize) -> Option<usize> {
        self.nodes.get(node).copied().flatten()
    }

    /// The number of a task.
    pub fn task(&self, task: usize) -> Option<usize> {
        self.tasks.get(task).copied().flatten()
    }

    /// The numbers of these nodes; none if one of them has none.
    pub(super) fn nodes(&self, nodes: &[usize]) -> Option<Vec<usize>> {
        nodes.iter().map(|&node| self.node(node)).collect()
    }

    /// Gives all these numbers anew.
    fn apply(&self, Named { nodes, tasks }: Named<'_>) -> Option<()> {
        for node in nodes {
            *node = self.node(*node)?;
        }
        for task in tasks {
            *task = self.task(*task)?;
        }
        Some(())
    }
}

/// The nodes and tasks that something names.
#[derive(Default)]
struct Named<'a> {
    nodes: Vec<&'a mut usize>,
    tasks: Vec<&'a mut usize>,
}

impl<'a> Named<'a> {
    fn nodes(nodes: impl IntoIterator<Item = &'a mut usize>) -> Self {
        Named { nodes: nodes.into_iter().collect(), tasks: Vec::new() }
    }

    fn tasks(tasks: impl IntoIterator<Item = &'a mut usize>) -> Self {
        Named { nodes: Vec::new(), tasks: tasks.into_iter().collect() }
    }

    fn and(mut self, other: Self) -> Self {
        self.nodes.extend(other.nodes);
        self.tasks.extend(other.tasks);
        self
    }
}

impl MissionEvent {
    /// The same event in another numbering; none if it names something that has no number there.
    #[must_use]
    pub fn renumbered(&self, by: &Renumbering) -> Option<Self> {
        let mut event = self.clone();
        by.apply(event.named())?;
        Some(event)
    }

    /// The nodes and the tasks that the event names.
    #[must_use]
    pub fn identities(&self) -> (Vec<usize>, Vec<usize>) {
        let mut event = self.clone();
        let Named { nodes, tasks } = event.named();
        let numbers = |all: Vec<&mut usize>| all.into_iter().map(|number| *number).collect();
        (numbers(nodes), numbers(tasks))
    }

    fn named(&mut self) -> Named<'_> {
        match self {
            MissionEvent::TaskAnnounced { task }
            | MissionEvent::ElectionRepeated { task }
            | MissionEvent::TaskEnded { task }
            | MissionEvent::TaskWithdrawn { task } => Named::tasks([task]),
            MissionEvent::TaskGivenUp { task, certificate, .. } => {
                let claims = certificate.as_mut().map(|it| it.named()).unwrap_or_default();
                Named::tasks([task]).and(claims)
            }
            MissionEvent::LeaderElected { task, robot, .. }
            | MissionEvent::TaskServiced { task, robot } => {
                Named::tasks([task]).and(Named::nodes([robot]))
            }
            MissionEvent::TaskReannounced { task, gone, joined } => {
                Named::tasks([task]).and(Named::nodes(gone.iter_mut().chain(joined)))
            }
            MissionEvent::Stationary { robot, team }
            | MissionEvent::JoinedPrimary { robot, team } => {
                Named::nodes([robot]).and(Named::nodes(team))
            }
            MissionEvent::RecruitElected { robot, path, break_points } => {
                Named::nodes([robot]).and(Named::nodes(path.iter_mut().chain(break_points)))
            }
            MissionEvent::SubgroupStarted { robots, .. }
            | MissionEvent::SubgroupArrived { robots, .. } => Named::nodes(robots),
            MissionEvent::RecruitCalled { robot }
            | MissionEvent::CalledInVain { robot }
            | MissionEvent::LinksStretched { robot }
            | MissionEvent::Released { robot }
            | MissionEvent::RoleChanged { robot, .. }
            | MissionEvent::RouteInfeasible { robot } => Named::nodes([robot]),
            MissionEvent::DutiesExchanged { mover, parked } => Named::nodes([mover, parked]),
            MissionEvent::Reattached { robot, parent } => Named::nodes([robot, parent]),
        }
    }
}

impl Certificate {
    /// The same certificate in another numbering; none if it names something that has no number there.
    #[must_use]
    pub fn renumbered(&self, by: &Renumbering) -> Option<Self> {
        let mut certificate = self.clone();
        by.apply(certificate.named())?;
        Some(certificate)
    }

    fn named(&mut self) -> Named<'_> {
        let all = Named::default();
        match self {
            Certificate::Unreachable(_) | Certificate::Bound(_) => all,
            Certificate::Tried { attempts, team } => {
                let attempts = attempts.iter_mut().map(Attempt::named);
                attempts.chain(team.iter_mut().map(Standing::named)).fold(all, Named::and)
            }
            Certificate::Blocked { team } => {
                team.iter_mut().map(Standing::named).fold(all, Named::and)
            }
        }
    }
}

impl Attempt {
    fn named(&mut self) -> Named<'_> {
        let others = self.others.iter_mut().map(Other::named);
        let own = Named::nodes([&mut self.caller]).and(Named::nodes(&mut self.root));
        others.fold(own, Named::and)
    }
}

impl Other {
    fn named(&mut self) -> Named<'_> {
        let because = match &mut self.because {
            Because::Services { task } => Named::tasks([task]),
            Because::Bears { children } => Named::nodes(children),
            Because::Holds => Named::default(),
            Because::Apart { root } => Named::nodes(root),
        };
        Named::nodes([&mut self.robot]).and(because)
    }
}

impl Standing {
    fn named(&mut self) -> Named<'_> {
        let hindrances = self.hindrances.iter_mut().filter_map(|hindrance| match hindrance {
            Hindrance::Robot { robot: other, .. }
            | Hindrance::Link { to: other, .. }
            | Hindrance::Sender { robot: other, .. } => Some(other),
            Hindrance::Body { .. } | Hindrance::Wall { .. } | Hindrance::Load { .. } => None,
        });
        Named::nodes([&mut self.robot]).and(Named::nodes(hindrances))
    }
}

impl End {
    /// The same end in another numbering; none if it names something that has no number there. Its reason stays as
    /// it is.
    #[must_use]
    pub fn renumbered(&self, by: &Renumbering) -> Option<Self> {
        let mut end = self.clone();
        by.apply(Named::tasks(end.task.iter_mut().chain(&mut end.tasks)))?;
        if let Some(certificate) = &mut end.certificate {
            by.apply(certificate.named())?;
        }
        Some(end)
    }
}
