//! The campaigns that are explored, with the exact counts of each.

use super::campaign::{Campaign, Counts, Graphs};
use super::medium::{Faults, Medium};

/// Rounds in which all messages arrive, and robots move between any two of them.
const ROUNDS: Medium = rounds(Faults::NONE);
/// One message of a whole mission is lost.
const ONE_LOST: Medium = rounds(Faults { losses: 1, ..Faults::NONE });
/// One message of a whole mission is late.
const ONE_LATE: Medium = rounds(Faults { delays: 1, ..Faults::NONE });
/// A copy of one message of a whole mission arrives later.
const ONE_COPIED: Medium = rounds(Faults { duplicates: 1, ..Faults::NONE });

const fn rounds(faults: Faults) -> Medium {
    Medium::Rounds { faults, period: None }
}

/// The same in control periods: robots move after every `rounds` rounds.
const fn periods(faults: Faults) -> Medium {
    Medium::Rounds { faults, period: Some(ROUNDS_OF_A_PERIOD) }
}

/// How many rounds the control periods have in which two faults are explored.
const ROUNDS_OF_A_PERIOD: u32 = 4;

/// On every graph of this many robots and an access point, with one task beside it; all messages
/// arrive, and no robot is in another's way.
const fn robots(robots: usize, expected: Counts) -> Campaign {
    Campaign {
        name: "",
        robots,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        in_a_row: false,
        medium: ROUNDS,
        contacts: 0,
        expected,
    }
}

/// What every test run explores.
pub const QUICK: &[Campaign] = &[
    Campaign {
        name: "two robots, every numbering",
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        contacts: 1,
        ..robots(2, Counts { configurations: 144, states: 27_709, transitions: 36_297 })
    },
    Campaign {
        name: "two robots, nodes in any order",
        medium: Medium::NodesInAnyOrder,
        contacts: 1,
        ..robots(2, Counts { configurations: 9, states: 447_028, transitions: 1_204_941 })
    },
    Campaign {
        name: "three robots",
        steps: &[1, 2],
        contacts: 1,
        ..robots(3, Counts { configurations: 88, states: 66_986, transitions: 89_292 })
    },
    Campaign {
        name: "four robots in a line, three tasks in a row",
        graphs: Graphs::Line,
        tasks: 3,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(4, Counts { configurations: 40, states: 21_226, transitions: 28_152 })
    },
    Campaign {
        name: "three robots, a message lost",
        medium: ONE_LOST,
        ..robots(3, Counts { configurations: 44, states: 78_308, transitions: 154_970 })
    },
    Campaign {
        name: "three robots, a message late",
        medium: ONE_LATE,
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 75_134, transitions: 135_573 })
    },
    Campaign {
        name: "two robots, a message copied",
        steps: &[1, 2],
        medium: ONE_COPIED,
        contacts: 1,
        ..robots(2, Counts { configurations: 18, states: 83_562, transitions: 157_627 })
    },
    Campaign {
        name: "two robots, two access points",
        access_points: 2,
        contacts: 1,
        ..robots(2, Counts { configurations: 92, states: 11_953, transitions: 15_863 })
    },
];

/// What takes minutes.
pub const THOROUGH: &[Campaign] = &[
    Campaign {
        name: "three robots, every numbering, two tasks",
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        contacts: 1,
        ..robots(3, Counts { configurations: 2_432, states: 2_360_851, transitions: 3_133_011 })
    },
    Campaign {
        name: "three robots, a task behind the other",
        tasks: 2,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(3, Counts { configurations: 176, states: 76_042, transitions: 100_240 })
    },
    Campaign {
        name: "three robots, two access points",
        access_points: 2,
        ..robots(3, Counts { configurations: 810, states: 137_200, transitions: 182_302 })
    },
    Campaign {
        name: "four robots",
        steps: &[1, 2],
        contacts: 1,
        ..robots(4, Counts { configurations: 580, states: 903_335, transitions: 1_199_087 })
    },
    Campaign {
        name: "four robots, two tasks",
        tasks: 2,
        ..robots(4, Counts { configurations: 1_450, states: 390_520, transitions: 506_225 })
    },
    Campaign {
        name: "four robots, a task behind the other",
        tasks: 2,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(4, Counts { configurations: 1_160, states: 888_941, transitions: 1_165_396 })
    },
    Campaign {
        name: "five robots",
        ..robots(5, Counts { configurations: 2_442, states: 435_649, transitions: 562_650 })
    },
    Campaign {
        name: "six robots",
        ..robots(6, Counts { configurations: 30_142, states: 5_509_587, transitions: 7_098_990 })
    },
    Campaign {
        name: "six robots in a line",
        graphs: Graphs::Line,
        steps: &[1, 2],
        contacts: 1,
        ..robots(6, Counts { configurations: 14, states: 44_043, transitions: 64_217 })
    },
    Campaign {
        name: "three robots, a message lost, tasks far and near",
        steps: &[1, 2],
        medium: ONE_LOST,
        ..robots(3, Counts { configurations: 88, states: 409_690, transitions: 796_021 })
    },
    Campaign {
        name: "three robots, a message copied",
        medium: ONE_COPIED,
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 500_319, transitions: 918_010 })
    },
    Campaign {
        name: "four robots, a message lost",
        medium: ONE_LOST,
        ..robots(4, Counts { configurations: 290, states: 854_592, transitions: 1_690_905 })
    },
    Campaign {
        name: "four robots, a message late",
        steps: &[1],
        medium: rounds(Faults { delays: 1, ..Faults::NONE }),
        contacts: 1,
        ..robots(4, Counts { configurations: 290, states: 788_793, transitions: 1_386_777 })
    },
    Campaign {
        name: "four robots, a message copied",
        medium: ONE_COPIED,
        ..robots(4, Counts { configurations: 290, states: 2_674_931, transitions: 4_907_757 })
    },
    Campaign {
        name: "five robots, a message lost",
        steps: &[1],
        medium: rounds(Faults { losses: 1, ..Faults::NONE }),
        contacts: 0,
        ..robots(5, Counts { configurations: 2_442, states: 9_925_001, transitions: 19_886_391 })
    },
    Campaign {
        name: "two robots in contact, two messages lost, moves once a period",
        steps: &[1, 2],
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 1,
        ..robots(2, Counts { configurations: 18, states: 67_920, transitions: 186_433 })
    },
    Campaign {
        name: "three robots in contact, a message lost, moves once a period",
        steps: &[1, 2],
        medium: periods(Faults { losses: 1, ..Faults::NONE }),
        contacts: 1,
        ..robots(3, Counts { configurations: 88, states: 433_543, transitions: 787_238 })
    },
    Campaign {
        name: "four robots in contact, a message lost, moves once a period",
        steps: &[1],
        medium: periods(Faults { losses: 1, ..Faults::NONE }),
        contacts: 1,
        ..robots(4, Counts { configurations: 290, states: 1_134_576, transitions: 2_117_454 })
    },
    Campaign {
        name: "three robots, two messages late, moves once a period",
        medium: periods(Faults { delays: 2, ..Faults::NONE }),
        ..robots(3, Counts { configurations: 44, states: 103_328, transitions: 216_713 })
    },
    Campaign {
        name: "three robots in contact, two messages lost, moves once a period",
        steps: &[1],
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 433_620, transitions: 1_408_640 })
    },
    Campaign {
        name: "four robots, two messages lost, moves once a period",
        steps: &[1],
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 0,
        ..robots(4, Counts { configurations: 290, states: 3_146_331, transitions: 11_720_217 })
    },
    Campaign {
        name: "three robots, a message lost and one late, moves once a period",
        medium: periods(Faults { losses: 1, delays: 1, duplicates: 0 }),
        ..robots(3, Counts { configurations: 44, states: 284_759, transitions: 727_202 })
    },
    Campaign {
        name: "three robots, a message lost and one copied, moves once a period",
        medium: periods(Faults { losses: 1, delays: 0, duplicates: 1 }),
        ..robots(3, Counts { configurations: 44, states: 1_638_960, transitions: 4_410_596 })
    },
    Campaign {
        name: "three robots, a message late and one copied, moves once a period",
        medium: periods(Faults { losses: 0, delays: 1, duplicates: 1 }),
        ..robots(3, Counts { configurations: 44, states: 855_559, transitions: 2_027_441 })
    },
];
