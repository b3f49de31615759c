//! Which robots take part: the state of a robot as an access point knows it, and the table.
//!
//! A robot moves only by a roll that is valid and does not name it. A robot that others take to be
//! gone is one that may not move any more: between the last roll that lets it move and the first
//! that calls it gone there is one that suspends it, for as long as a roll is valid: a failure detector with leases.

use crate::{TransitionTable, from, transitions, vocabulary};

vocabulary! {
    /// What an access point knows of a robot.
    pub enum Attendance: Location {
        /// It takes part, or has never been heard of.
        Present = "present",
        /// It has not been heard of for a while: it may not move any more, and others still expect
        /// to hear it before they move.
        Suspended = "suspended",
        /// It may not move by any roll: others go round the place where it was heard last.
        Gone = "gone",
        /// It has been heard of again: it may not move yet, and others expect to hear it.
        Returning = "returning",
    }

    /// What changes it.
    pub enum AttendanceEvent: Event {
        /// It has not been heard of for too long.
        Missed = "missed",
        /// It is heard of again.
        HeardAgain = "heard again",
        /// No roll is valid any more that let it move.
        RollsExpired = "rolls expired",
        /// No roll is valid any more that called it gone.
        Readmitted = "readmitted",
    }
}

/// The table of a robot's attendance.
pub const ATTENDANCE: TransitionTable<Attendance, AttendanceEvent> = {
    use Attendance::{Gone, Present, Returning, Suspended};
    use AttendanceEvent as On;
    transitions![Attendance, AttendanceEvent;
        from(Present).on(On::Missed).to(Suspended),
        from(Suspended).on(On::HeardAgain).to(Present),
        from(Suspended).on(On::RollsExpired).to(Gone),
        from(Gone).on(On::HeardAgain).to(Returning),
        from(Returning).on(On::Missed).to(Gone),
        from(Returning).on(On::Readmitted).to(Present),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Location, Row};

    #[test]
    fn the_table_is_deterministic_and_every_location_is_reached_and_left() {
        assert!(ATTENDANCE.is_deterministic());
        assert_eq!(ATTENDANCE.unreachable_from(Attendance::Present), vec![]);
        for &attendance in Attendance::ALL {
            let mut reached = [false; Attendance::ALL.len()];
            ATTENDANCE.mark_reachable(attendance, &mut reached);
            assert!(reached[Attendance::Present as usize], "{attendance:?} never ends");
        }
    }

    /// A robot that may move is never called gone by the next roll, nor the other way round.
    #[test]
    fn a_robot_is_suspended_between_present_and_gone() {
        use Attendance::{Gone, Present};
        let joins = |row: &&Row<Attendance, AttendanceEvent>| {
            [(Present, Gone), (Gone, Present)].contains(&(row.source, row.target))
        };
        assert!(!ATTENDANCE.rows().iter().any(|row| joins(&row)));
    }
}
