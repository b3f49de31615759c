//! The service of a user's tasks: its locations for access points and for the user, with the data
//! that each of them needs.

use std::sync::Arc;

use pleach_discrete::network::{IdSet, Request, Round, Service};

crate::places_of! {
    /// Where the service of the tasks stands for an access point: a [`Service`] with its data.
    pub(super) enum Serving: Service {
        /// No task has been announced.
        Gathering(Gathering),
        /// A leader or a recruit is being elected.
        Electing(Electing),
        /// The leader pursues its task, or a recruit is on its way to it.
        UnderWay(UnderWay),
        /// The task announced last is done: serviced, or taken back.
        Done(Done),
        /// The mission has ended.
        Over(Over),
    }
}

/// The data of [`Service::Gathering`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Gathering;

/// A task with those who elect its leader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Announced {
    /// Its number.
    pub task: usize,
    /// The robots that take part in elections for it.
    pub roster: Arc<IdSet>,
    /// Those of them that knew no way to an access point when it was announced: they cannot bid.
    pub wayless: Arc<IdSet>,
    /// How many elections for it have been in vain: not answered by all of them, or not by those without a way.
    pub unanswered: u32,
}

/// The data of [`Service::Electing`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Electing {
    /// The task announced last, if this access point has heard of its announcement.
    pub announced: Option<Announced>,
}

/// The data of [`Service::UnderWay`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnderWay {
    /// The task announced last, if this access point has heard of its announcement.
    pub announced: Option<Announced>,
}

/// The data of [`Service::Done`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Done {
    /// The task.
    pub task: usize,
}

/// The data of [`Service::Over`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Over;

crate::places_of! {
    /// The stage of an access point in its control period: a [`Round`] with its data.
    #[derive(Copy)]
    pub(super) enum Rounds: Round {
        /// It waits for the next sample.
        Resting(Resting),
        /// It waits for beacons.
        Listening(Listening),
    }
}

/// The data of [`Round::Resting`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Resting;

/// The data of [`Round::Listening`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Listening {
    /// The round of beacons, from 1.
    pub round: usize,
}

crate::places_of! {
    /// Where a user stands with its request: a [`Request`]; none of them has data.
    #[derive(Copy)]
    pub(super) enum Asked: Request {
        /// The first control period has not begun.
        Preparing(Preparing),
        /// It asks for its tasks.
        Asking(Asking),
        /// It waits for news.
        Waiting(Waiting),
        /// It knows that the mission has ended.
        Informed(Informed),
        /// The first access point counts as stopped.
        Deserted(Deserted),
    }
}

/// The data of [`Request::Preparing`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Preparing;

/// The data of [`Request::Asking`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Asking;

/// The data of [`Request::Waiting`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Waiting;

/// The data of [`Request::Informed`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Informed;

/// The data of [`Request::Deserted`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Deserted;
