//! Changes of the order of a record, of its clock and of its end.

use super::change::{Change, changes};
use pleach::automaton::network::record::Outcome;

pub const ALL: &[Change] = changes! {
    "a control period is dropped" => |record, site| record.periods.remove(site);
    "a control period is duplicated" => |record, site| {
        let period = record.periods[site].clone();
        record.periods.insert(site, period);
    };
    "a control period and the next are swapped" => |record, site| {
        if site + 1 < record.periods.len() {
            record.periods.swap(site, site + 1);
        }
    };
    "the record breaks off" => |record, site| record.periods.truncate(site + 1);
    "the record begins later" => |record, site| {
        if site == 0 {
            record.periods.remove(0);
        }
    };
    "k is one more" => |record, site| record.at(site).step += 1;
    "k is one more from here on" => |record, site| record.from(site).for_each(|now| now.step += 1);
    "t is shifted by a tenth of Δt" => |record, site| record.at(site).time += 0.1;
    "t is scaled by 10⁻⁹ from here on" => |record, site| {
        record.from(site).for_each(|now| now.time *= 1e-9);
    };
    "t runs 1 % fast from here on" => |record, site| {
        record.from(site).for_each(|now| now.time *= 1.01);
    };
    "t is not a number" => |record, site| record.at(site).time = f64::NAN;
    "the outcome is “insufficient_robots”" => |record, _| {
        record.end.outcome = Outcome::InsufficientRobots;
    };
    "the outcome is “unreachable_task”" => |record, _| {
        record.end.outcome = Outcome::UnreachableTask;
    };
    "the outcome is “step_limit”" => |record, _| record.end.outcome = Outcome::StepLimit;
    "the outcome is “blocked”" => |record, _| record.end.outcome = Outcome::Blocked;
    "the outcome is “invariant_violated”" => |record, _| {
        record.end.outcome = Outcome::InvariantViolated;
    };
    "the outcome is “interrupted”" => |record, _| record.end.outcome = Outcome::Interrupted;
    "the outcome is “serviced” before the last task is" => |record, site| {
        record.periods.truncate(site.min(record.periods.len() - 2) + 1);
    };
};
