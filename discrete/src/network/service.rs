//! The service of a user's tasks, as an access point knows it, and as the user does: locations and
//! tables.

use crate::{Row, TransitionTable, Urgency, vocabulary};

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

const fn row(
    priority: u8,
    source: Service,
    event: ServiceEvent,
    target: Service,
) -> Row<Service, ServiceEvent> {
    Row { source, event, target, urgency: Urgency::AtOnce, priority }
}

/// The table of an access point.
///
/// Priority 0: what others report. Priority 1: the task that is pursued is given up. Priority 2: others are
/// over. Priority 3: what the first access point does by itself. Priority 4: the task that is pursued is given up where
/// nobody else can be asked.
pub const SERVICE: TransitionTable<Service, ServiceEvent> = {
    use Service::*;
    use ServiceEvent as On;
    TransitionTable::new(&[
        row(0, Gathering, On::ElectionHeard, Electing),
        row(0, Gathering, On::ProgressHeard, UnderWay),
        row(0, Gathering, On::ServiceHeard, Done),
        row(0, Gathering, On::EndHeard, Over),
        row(2, Gathering, On::Closes, Gathering),
        row(3, Gathering, On::Announces, Electing),
        row(3, Gathering, On::NoRobot, Over),
        row(3, Gathering, On::AllServiced, Over),
        row(0, Electing, On::ElectionHeard, Electing),
        row(0, Electing, On::ProgressHeard, UnderWay),
        row(0, Electing, On::ServiceHeard, Done),
        row(0, Electing, On::EndHeard, Over),
        row(1, Electing, On::Withdraws, Done),
        row(2, Electing, On::Closes, Electing),
        row(3, Electing, On::AnnouncesAgain, Electing),
        row(4, Electing, On::GivesUp, Done),
        row(3, Electing, On::NoRobot, Over),
        row(3, Electing, On::NoBid, Over),
        row(3, Electing, On::NoAnswer, Over),
        row(0, UnderWay, On::ElectionHeard, Electing),
        row(0, UnderWay, On::ProgressHeard, UnderWay),
        row(0, UnderWay, On::ServiceHeard, Done),
        row(0, UnderWay, On::EndHeard, Over),
        row(1, UnderWay, On::Withdraws, Done),
        row(2, UnderWay, On::Closes, UnderWay),
        row(3, UnderWay, On::AnnouncesAgain, Electing),
        row(4, UnderWay, On::GivesUp, Done),
        row(3, UnderWay, On::NoRobot, Over),
        row(0, Done, On::ElectionHeard, Electing),
        row(0, Done, On::ProgressHeard, UnderWay),
        row(0, Done, On::ServiceHeard, Done),
        row(0, Done, On::EndHeard, Over),
        row(2, Done, On::Closes, Done),
        row(3, Done, On::Announces, Electing),
        row(3, Done, On::NoRobot, Over),
        row(3, Done, On::AllServiced, Over),
        row(0, Over, On::ElectionHeard, Electing),
        row(0, Over, On::ProgressHeard, UnderWay),
        row(0, Over, On::ServiceHeard, Done),
    ])
};

const fn request(
    priority: u8,
    source: Request,
    event: RequestEvent,
    target: Request,
) -> Row<Request, RequestEvent> {
    Row { source, event, target, urgency: Urgency::AtOnce, priority }
}

/// The table of the user.
///
/// Priority 0: what it receives. Priority 1: that it receives nothing. Priority 2: its clock.
pub const REQUESTS: TransitionTable<Request, RequestEvent> = {
    use Request::*;
    use RequestEvent as On;
    TransitionTable::new(&[
        request(2, Preparing, On::Prepared, Asking),
        request(0, Preparing, On::AnswerHeard, Waiting),
        request(0, Preparing, On::EndHeard, Informed),
        request(2, Asking, On::PeriodOver, Asking),
        request(0, Asking, On::AnswerHeard, Waiting),
        request(0, Asking, On::EndHeard, Informed),
        request(1, Asking, On::Missed, Deserted),
        request(2, Waiting, On::PeriodOver, Waiting),
        request(0, Waiting, On::EndHeard, Informed),
        request(1, Waiting, On::Missed, Deserted),
        request(2, Informed, On::PeriodOver, Informed),
        request(0, Informed, On::AnswerHeard, Waiting),
        request(2, Deserted, On::PeriodOver, Deserted),
    ])
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
