//! The automaton of a robot's attendance.
//!
//! Robots that are attached to an access point, at whatever distance, are heard of. One that has not
//! been for some control periods is suspended, and gone when no roll is valid any more that lets it
//! move. A robot that comes back is readmitted when no roll is valid any more that calls it gone. In the terms of
//! distributed systems this is a failure detector with leases.

use pleach_discrete::network::{ATTENDANCE, Attendance, AttendanceEvent};

use crate::automaton::TransitionError;
use crate::located::{Current, DataOf, Holds, Place as _};
use crate::network::guards::attendance as guards;
use crate::{Automaton, BuildError, Transfer};

/// Control periods after which a robot that is not heard of is missed.
pub(in crate::network) const PATIENCE: u32 = 8;

/// The automaton of a robot's attendance.
pub type AttendanceAutomaton = Automaton<Attendance, AttendanceEvent, Attendee>;

crate::places_of! {
    /// Whether a robot takes part: an [`Attendance`]; none of its locations has data.
    #[derive(Copy)]
    pub enum Standing: Attendance {
        /// It takes part.
        Present(Present),
        /// It may not move any more.
        Suspended(Suspended),
        /// It does not move.
        Gone(Gone),
        /// It may not move yet.
        Returning(Returning),
    }
}

macro_rules! without_data {
    ($($name:ident),+) => {
        $(
            #[doc = concat!("The data of [`Attendance::", stringify!($name), "`]: none.")]
            #[derive(Clone, Copy, Debug, PartialEq, Eq)]
            pub struct $name;
        )+
    };
}

without_data!(Present, Suspended, Gone, Returning);

/// A robot as an access point knows it.
#[derive(Clone, Debug)]
pub struct Attendee {
    standing: Current<Standing>,
    /// Whether it has ever been attached to an access point, as far as this one knows.
    known: bool,
    /// Control periods since it was heard of, or since the access point began.
    silence: u32,
    /// Control periods since its standing changed.
    age: u32,
    /// Whether it has been suspended since the access point began, and an earlier roll that is still valid may
    /// call it gone.
    recalled: bool,
    /// Control periods for which a roll is valid.
    validity: u32,
}

crate::observed! {
    impl Observed for Attendee as attendee;
    quantities {
        /// Control periods since the robot was heard of, or since the access point began.
        silence: f64::from(attendee.silence),
        /// Control periods after which it is missed.
        patience: f64::from(PATIENCE),
        /// Control periods since its standing changed.
        age: f64::from(attendee.age),
        /// Control periods for which a roll is valid.
        validity: f64::from(attendee.validity),
    }
    propositions {
        /// It has been suspended since the access point began, and an earlier roll may call it gone.
        recalled: attendee.recalled,
    }
}

impl Holds<Standing> for Attendee {
    type Effects = ();

    fn current(&self) -> &Current<Standing> {
        &self.standing
    }

    fn current_mut(&mut self) -> &mut Current<Standing> {
        &mut self.standing
    }

    fn carry_out(&mut self, (): ()) {
        (self.age, self.recalled) = (0, false);
    }
}

impl Attendee {
    /// A robot that has never been heard of.
    pub(super) fn new(validity: u32) -> Self {
        Attendee {
            standing: Current::new(Standing::Present(Present)),
            known: false,
            silence: 0,
            age: 0,
            recalled: false,
            validity,
        }
    }

    /// A robot that is attached to an access point.
    pub(super) fn attached(validity: u32) -> Self {
        Attendee { known: true, ..Attendee::new(validity) }
    }

    /// A robot that does not take part by the roll that an access point hears when it begins.
    pub(super) fn absent(standing: Standing, validity: u32) -> Self {
        Attendee {
            standing: Current::new(standing),
            known: true,
            silence: PATIENCE,
            ..Attendee::new(validity)
        }
    }

    /// The robot is attached to an access point.
    pub(super) fn attend(&mut self) {
        (self.known, self.silence) = (true, 0);
    }

    /// The robot is heard, and knows no way to an access point.
    pub(super) fn stray(&mut self) {
        self.silence = 0;
    }

    /// Whether it may not have begun yet: it has never been attached, for a short time.
    pub(super) fn may_begin(&self) -> bool {
        !self.known && self.age <= PATIENCE && self.standing.location() == Attendance::Present
    }

    /// It is not waited for any more.
    #[cfg(feature = "abstraction")]
    pub(super) fn has_been_awaited(&mut self) {
        self.age = self.age.max(PATIENCE + 1);
    }

    /// Whether it has been heard of in this control period.
    pub(super) fn is_heard_of(&self) -> bool {
        self.known && self.silence == 0
    }

    /// Whether it has been heard of lately, and takes part.
    pub(super) fn takes_part(&self) -> bool {
        self.known && self.standing.location() == Attendance::Present
    }

    /// Where it stands.
    pub(super) fn location(&self) -> Attendance {
        self.standing.location()
    }

    /// Whether it does not take part, and may in a while.
    pub(super) fn may_return(&self) -> bool {
        matches!(self.standing.location(), Attendance::Suspended | Attendance::Returning)
    }

    /// Whether it has ever been attached to an access point, as far as this one knows.
    pub(super) const fn is_known(&self) -> bool {
        self.known
    }

    /// Whether it is gone.
    pub(super) fn is_gone(&self) -> bool {
        self.standing.location() == Attendance::Gone
    }

    /// What decides on its standing from now on; how long a wait has been over does not matter.
    #[cfg(any(test, feature = "abstraction"))]
    pub(super) fn account(&self) -> (Attendance, bool, bool, u32, u32) {
        let (silence, age) = (self.silence.min(PATIENCE + 1), self.age.min(self.validity + 1));
        (self.standing.location(), self.known, self.recalled, silence, age)
    }

    /// Initialises the robot from the roll that an access point hears first after it has started or restarted. If that
    /// roll is not valid any more, a later one may let the robot move or call it gone: it is suspended.
    pub(super) fn recall(&mut self, called: Attendance, is_valid: bool) {
        let (standing, recalled) = match called {
            Attendance::Gone if is_valid => (Standing::Gone(Gone), false),
            Attendance::Present if is_valid && self.known => return,
            Attendance::Present if is_valid => (Standing::Suspended(Suspended), false),
            _ => (Standing::Suspended(Suspended), true),
        };
        *self = Attendee { recalled, ..Attendee::absent(standing, self.validity) };
    }

    /// Another control period begins.
    pub(super) fn review(
        &mut self,
        automaton: &AttendanceAutomaton,
    ) -> Result<(), TransitionError> {
        self.age = self.age.saturating_add(1);
        self.silence = self.silence.saturating_add(1);
        automaton.step_in_place::<Standing>(self)?;
        Ok(())
    }
}

type Row = Transfer<Attendance, AttendanceEvent, Attendee>;

fn row<A: DataOf<Standing>, B: DataOf<Standing> + Copy>(
    event: AttendanceEvent,
    guard: pleach_guards::Guard,
    name: &'static str,
    next: fn(&A) -> B,
) -> Row {
    Transfer::new(event, guard, name, move |standing: &A, _: &Attendee, (): &mut ()| next(standing))
}

/// The automaton of a robot's attendance.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn attendance_automaton() -> Result<AttendanceAutomaton, BuildError> {
    use AttendanceEvent as On;
    let expect = "others expect to hear it";
    Automaton::builder(ATTENDANCE, Attendance::Present)
        .observing()
        .carried_out(row(On::Missed, guards::missed(), "it may not move", |_: &Present| Suspended))
        .carried_out(row(
            On::HeardAgain,
            guards::heard_in_time(),
            "it may move",
            |_: &Suspended| Present,
        ))
        .carried_out(row(
            On::RollsExpired,
            guards::rolls_expired(),
            "others go round it",
            |_: &Suspended| Gone,
        ))
        .carried_out(row(On::HeardAgain, guards::heard_again(), expect, |_: &Gone| Returning))
        .carried_out(row(On::Missed, guards::missed(), "others go round it", |_: &Returning| Gone))
        .carried_out(row(On::Readmitted, guards::readmitted(), "it may move", |_: &Returning| {
            Present
        }))
        .build()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use pleach_discrete::Location as _;

    use super::*;

    const VALIDITY: u32 = 5;

    /// The standing of a robot in each control period, by whether it is heard of.
    fn standings(periods: u32, is_heard_of: impl Fn(u32) -> bool) -> Vec<Attendance> {
        let automaton = attendance_automaton().expect("it is well formed");
        let mut attendee = Attendee::new(VALIDITY);
        let standing = |period| {
            attendee.review(&automaton).expect("its guards have values");
            if is_heard_of(period) {
                attendee.attend();
            }
            attendee.standing.location()
        };
        (0..periods).map(standing).collect()
    }

    /// Whenever a robot may move by a roll that is valid, no valid roll calls it gone.
    #[test]
    fn a_robot_is_suspended_for_longer_than_a_roll_is_valid() {
        let is_silent = |period| (20..60).contains(&period) || (90..100).contains(&period);
        let standings = standings(160, |period| !is_silent(period));
        assert!(standings.contains(&Attendance::Gone));
        assert!(standings.contains(&Attendance::Returning));
        assert_eq!(standings[159], Attendance::Present);
        for (period, &standing) in standings.iter().enumerate() {
            let valid = &standings[period.saturating_sub(VALIDITY as usize)..=period];
            match standing {
                Attendance::Gone => assert!(!valid.contains(&Attendance::Present), "{period}"),
                Attendance::Present => assert!(!valid.contains(&Attendance::Gone), "{period}"),
                _ => {}
            }
        }
    }

    /// Of any robot, heard of or not in any periods: its standing, what decides on it from now on, and for how
    /// many periods it has not been called present, and gone; more than any roll is valid are the same.
    type Record = ((Attendance, bool, bool, u32, u32), u32, u32);

    fn record_of(attendee: &Attendee, present: u32, gone: u32) -> Record {
        (attendee.account(), present.min(VALIDITY + 1), gone.min(VALIDITY + 1))
    }

    /// The assumption of the lemma `roll.smt2`, exhaustively: between a roll that lets a robot move and one
    /// that calls it gone, in either order, are more periods than a roll is valid. So of two robots that go
    /// by valid rolls none takes the other for gone that may move.
    #[test]
    fn between_rolls_that_let_a_robot_move_and_call_it_gone_no_roll_is_valid() {
        let automaton = attendance_automaton().expect("it is well formed");
        let longer = VALIDITY + 1;
        let first = Attendee::new(VALIDITY);
        let mut known = BTreeSet::from([record_of(&first, longer, longer)]);
        let (mut waiting, mut returned) = (vec![(first, longer, longer)], 0);
        while let Some((attendee, present, gone)) = waiting.pop() {
            for is_heard_of in [false, true] {
                let mut next = attendee.clone();
                if is_heard_of {
                    next.attend();
                }
                next.review(&automaton).expect("its guards have values");
                let (mut present, mut gone) = (present + 1, gone + 1);
                match next.standing.location() {
                    Attendance::Present => {
                        assert!(gone > VALIDITY, "it was gone {gone} periods ago");
                        present = 0;
                    }
                    Attendance::Gone => {
                        assert!(present > VALIDITY, "it was present {present} periods ago");
                        gone = 0;
                    }
                    Attendance::Suspended | Attendance::Returning => returned += 1,
                }
                let record = record_of(&next, present, gone);
                if known.insert(record) {
                    waiting.push((next, record.1, record.2));
                }
            }
        }
        assert!(known.len() > 50 && returned > 10, "{} {returned}", known.len());
    }

    /// The same where the access point begins again at any time, and hears any earlier roll.
    #[test]
    fn an_access_point_that_begins_again_calls_nobody_gone_who_may_move() {
        /// As many as are valid in this control period; all but the first are in the next one.
        type Rolls = [Attendance; VALIDITY as usize + 1];
        let automaton = attendance_automaton().expect("it is well formed");
        let first = (Attendee::new(VALIDITY), [Attendance::Present; VALIDITY as usize + 1]);
        let mut known = BTreeSet::from([(first.0.account(), first.1)]);
        let mut waiting: Vec<(Attendee, Rolls)> = vec![first];
        while let Some((attendee, rolls)) = waiting.pop() {
            let valid = rolls.map(|called| (called, true));
            let expired = Attendance::ALL.iter().map(|&called| (called, false));
            let begun_again = valid.into_iter().chain(expired).flat_map(|(called, is_valid)| {
                [false, true].map(|is_heard_of| {
                    let mut anew = Attendee::new(VALIDITY);
                    if is_heard_of {
                        anew.attend();
                    }
                    anew.recall(called, is_valid);
                    anew
                })
            });
            for mut next in begun_again.chain([attendee.clone()]) {
                for is_heard_of in [false, true] {
                    if is_heard_of {
                        next.attend();
                    }
                    let mut next = next.clone();
                    next.review(&automaton).expect("its guards have values");
                    let standing = next.standing.location();
                    let conflict = match standing {
                        Attendance::Present => Some(Attendance::Gone),
                        Attendance::Gone => Some(Attendance::Present),
                        Attendance::Suspended | Attendance::Returning => None,
                    };
                    assert!(
                        conflict.is_none_or(|it| !rolls[1..].contains(&it)),
                        "{standing:?} after {rolls:?}"
                    );
                    let mut later = rolls;
                    later.rotate_left(1);
                    later[VALIDITY as usize] = standing;
                    if known.insert((next.account(), later)) {
                        waiting.push((next, later));
                    }
                }
            }
        }
        assert!(known.len() > 100, "{}", known.len());
    }

    /// Its body may stand in the way of others.
    #[test]
    fn a_robot_that_was_never_heard_of_is_missed() {
        let standings = standings(90, |_| false);
        let gone = (PATIENCE + VALIDITY) as usize + 2;
        assert_eq!(standings[PATIENCE as usize - 1], Attendance::Present);
        assert_eq!(standings[PATIENCE as usize], Attendance::Suspended);
        assert!(standings[gone..].iter().all(|&known| known == Attendance::Gone));
        assert!(!Attendee::new(VALIDITY).takes_part());
    }
}
