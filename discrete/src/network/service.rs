//! The service of a user's tasks, as an access point knows it, and as the user does: locations and
//! tables.

use crate::{Location as _, Superstate, TransitionTable, from, from_any, transitions, vocabulary};

vocabulary! {
    /// Where the service of the tasks stands for an access point.
    pub enum Service: Location {
        /// No task has been announced; robots gather at the access points.
        Gathering = "gathering",
        /// A leader or a recruit is being elected (Algorithm 1, Remark 5.4).
        Electing = "electing",
        /// The leader pursues its task, or a recruit is on its way to it.
        UnderWay = "under way",
        /// The task announced last is done, serviced, taken back or given up: none is pursued.
        Done = "done",
        /// The mission has ended.
        Over = "over",
    }

    /// What changes it.
    pub enum ServiceEvent: Event {
        /// It hears of an election that it does not know.
        ElectionHeard = "election heard",
        /// It hears that a path Σ is announced, or that the primary team advances.
        ProgressHeard = "progress heard",
        /// It hears that the task is serviced, or has been taken back.
        ServiceHeard = "service heard",
        /// It hears that the mission has ended.
        EndHeard = "end heard",
        /// It announces the next task.
        Announces = "announces",
        /// A robot that takes part in its elections is gone, or one has joined since and the others have given
        /// up: it announces the task again.
        AnnouncesAgain = "announces again",
        /// The user has taken back the task that is pursued.
        Withdraws = "withdraws",
        /// No robot can service the task that is pursued: it gives that up, and goes on with the others.
        GivesUp = "gives up",
        /// A task that is not pursued is over: it has lasted as long as it should, or the user has taken it
        /// back.
        Closes = "closes",
        /// There is no robot to announce the next task to.
        NoRobot = "no robot",
        /// There is no task left.
        AllServiced = "all serviced",
        /// No robot bids for the task.
        NoBid = "no bid",
        /// Robots that take part in the election do not answer.
        NoAnswer = "no answer",
    }

    /// What a user does.
    pub enum Request: Location {
        /// The first control period has not begun.
        Preparing = "preparing",
        /// It asks for its tasks in every control period.
        Asking = "asking",
        /// Its request has been heard: it waits for news.
        Waiting = "waiting",
        /// It knows that the mission has ended.
        Informed = "informed",
        /// The first access point has been silent for so long that it counts as stopped.
        Deserted = "deserted",
    }

    /// What changes it.
    pub enum RequestEvent: Event {
        /// The first control period begins: the network has it to connect.
        Prepared = "prepared",
        /// A control period is over without an answer.
        PeriodOver = "period over",
        /// The first access point has announced a task.
        AnswerHeard = "answer heard",
        /// The newest notice says that the mission has ended.
        EndHeard = "end heard",
        /// A control period is over, and the first access point is missed.
        Missed = "missed",
    }
}

impl Service {
    /// A task is pursued.
    pub const PURSUING: Superstate<Service> =
        Superstate::new("pursuing", &[Service::Electing, Service::UnderWay]);

    /// The mission has not ended.
    pub const OPEN: Superstate<Service> = Superstate::new(
        "open",
        &[Service::Gathering, Service::Electing, Service::UnderWay, Service::Done],
    );

    /// Any of them.
    pub const ANY: Superstate<Service> = Superstate::new("any", Service::ALL);
}

impl Request {
    /// The user waits for an answer, or for news.
    pub const PENDING: Superstate<Request> =
        Superstate::new("pending", &[Request::Asking, Request::Waiting]);
}

/// The table of an access point.
///
/// Priority 0: what others report. Priority 1: the task that is pursued is given up. Priority 2: others are
/// over. Priority 3: what the first access point does by itself. Priority 4: the task that is pursued is given up where
/// nobody else can be asked.
pub const SERVICE: TransitionTable<Service, ServiceEvent> = {
    use Service::*;
    use ServiceEvent as On;
    transitions![Service, ServiceEvent;
        from_any(Service::ANY).on(On::ElectionHeard).to(Electing),
        from_any(Service::ANY).on(On::ProgressHeard).to(UnderWay),
        from_any(Service::ANY).on(On::ServiceHeard).to(Done),
        from_any(Service::OPEN).on(On::EndHeard).to(Over),
        from_any(Service::PURSUING).on(On::Withdraws).to(Done).priority(1),
        from_any(Service::OPEN).on(On::Closes).stay().priority(2),
        from(Gathering).on(On::Announces).to(Electing).priority(3),
        from(Done).on(On::Announces).to(Electing).priority(3),
        from_any(Service::PURSUING).on(On::AnnouncesAgain).to(Electing).priority(3),
        from_any(Service::OPEN).on(On::NoRobot).to(Over).priority(3),
        from(Gathering).on(On::AllServiced).to(Over).priority(3),
        from(Done).on(On::AllServiced).to(Over).priority(3),
        from(Electing).on(On::NoBid).to(Over).priority(3),
        from(Electing).on(On::NoAnswer).to(Over).priority(3),
        from_any(Service::PURSUING).on(On::GivesUp).to(Done).priority(4),
    ]
};

/// The table of the user.
///
/// Priority 0: what it receives. Priority 1: that it receives nothing. Priority 2: its clock.
pub const REQUESTS: TransitionTable<Request, RequestEvent> = {
    use Request::*;
    use RequestEvent as On;
    transitions![Request, RequestEvent;
        from(Preparing).on(On::Prepared).to(Asking).priority(2),
        from(Preparing).on(On::AnswerHeard).to(Waiting),
        from(Preparing).on(On::EndHeard).to(Informed),
        from(Asking).on(On::AnswerHeard).to(Waiting),
        from(Asking).on(On::EndHeard).to(Informed),
        from_any(Request::PENDING).on(On::Missed).to(Deserted).priority(1),
        from_any(Request::PENDING).on(On::PeriodOver).stay().priority(2),
        from(Waiting).on(On::EndHeard).to(Informed),
        from(Informed).on(On::PeriodOver).to(Informed).priority(2),
        from(Informed).on(On::AnswerHeard).to(Waiting),
        from(Deserted).on(On::PeriodOver).to(Deserted).priority(2),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Event, Location};

    fn is_complete<L: Location, E: Event>(table: &TransitionTable<'_, L, E>, initial: L) {
        assert!(table.is_deterministic());
        assert_eq!(table.unreachable_from(initial), vec![]);
        let named = |event: &&E| table.rows().iter().any(|row| row.event == **event);
        assert!(E::ALL.iter().all(|event| named(&event)));
    }

    #[test]
    fn the_tables_are_deterministic_and_every_location_is_reached() {
        is_complete(&SERVICE, Service::Gathering);
        is_complete(&REQUESTS, Request::Preparing);
    }

    #[test]
    fn an_access_point_and_a_user_take_up_what_follows_an_end_unless_it_is_a_silence() {
        let follows = SERVICE.enabled(Service::Over).all(|row| {
            SERVICE.next(Service::Gathering, row.event) == Ok(row.target) && row.priority == 0
        });
        assert!(follows && SERVICE.next(Service::Over, ServiceEvent::EndHeard).is_err());
        let targets = |source| REQUESTS.enabled(source).map(|row| row.target);
        assert!(targets(Request::Informed).any(|target| target == Request::Waiting));
        assert!(targets(Request::Deserted).all(|target| target == Request::Deserted));
    }
}
