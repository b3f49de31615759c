//! The campaigns that are explored, with the exact counts of each.

use pleach_automaton::network::scenario::Strategy;

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

/// The same in control periods: robots move after every [`ROUNDS_OF_A_PERIOD`] rounds.
const fn periods(faults: Faults) -> Medium {
    Medium::Rounds { faults, period: Some(ROUNDS_OF_A_PERIOD) }
}

/// The same where control periods count, and robots stop.
const fn counted(faults: Faults) -> Medium {
    Medium::Periods { faults, rounds: ROUNDS_OF_A_PERIOD }
}

/// A robot stops.
const ONE_STOPS: Faults = Faults { stops: 1, ..Faults::NONE };
/// A robot stops, and begins again after any time, or never.
const ONE_RESTARTS: Faults = Faults { stops: 1, restarts: 1, ..Faults::NONE };

/// How many rounds a control period has.
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
        strategy: Strategy::Paper,
        expected,
    }
}

/// What every run of the tests of this package explores.
pub const QUICK: &[Campaign] = &[
    Campaign {
        name: "two robots, every numbering",
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        contacts: 1,
        ..robots(2, Counts { configurations: 144, states: 45_489, transitions: 59_855 })
    },
    Campaign {
        name: "two robots, nodes in any order",
        medium: Medium::NodesInAnyOrder,
        contacts: 1,
        ..robots(2, Counts { configurations: 9, states: 547_859, transitions: 1_451_927 })
    },
    Campaign {
        name: "three robots",
        steps: &[1, 2],
        contacts: 1,
        ..robots(3, Counts { configurations: 88, states: 139_553, transitions: 191_855 })
    },
    Campaign {
        name: "four robots in a line, three tasks in a row",
        graphs: Graphs::Line,
        tasks: 3,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(4, Counts { configurations: 40, states: 24_073, transitions: 30_152 })
    },
    Campaign {
        name: "three robots that call ahead",
        steps: &[2],
        strategy: Strategy::Eager,
        ..robots(3, Counts { configurations: 44, states: 134_605, transitions: 212_329 })
    },
    Campaign {
        name: "three robots in a line that call ahead, two tasks, some where robots are",
        graphs: Graphs::Line,
        tasks: 2,
        steps: &[0, 1],
        strategy: Strategy::Eager,
        ..robots(3, Counts { configurations: 64, states: 7_189, transitions: 8_199 })
    },
    Campaign {
        name: "two robots in contact that call ahead",
        graphs: Graphs::Numbered,
        steps: &[1, 2],
        contacts: 1,
        strategy: Strategy::Eager,
        ..robots(2, Counts { configurations: 24, states: 13_683, transitions: 19_030 })
    },
    Campaign {
        name: "three robots, a message lost",
        medium: ONE_LOST,
        ..robots(3, Counts { configurations: 44, states: 81_901, transitions: 161_182 })
    },
    Campaign {
        name: "three robots, a message late",
        medium: ONE_LATE,
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 159_224, transitions: 291_552 })
    },
    Campaign {
        name: "two robots, a message copied",
        steps: &[1, 2],
        medium: ONE_COPIED,
        contacts: 1,
        ..robots(2, Counts { configurations: 18, states: 136_514, transitions: 261_468 })
    },
    Campaign {
        name: "two robots, two access points",
        access_points: 2,
        contacts: 1,
        ..robots(2, Counts { configurations: 92, states: 21_355, transitions: 28_907 })
    },
    Campaign {
        name: "two robots, one stops",
        medium: counted(ONE_STOPS),
        ..robots(2, Counts { configurations: 9, states: 80_799, transitions: 88_408 })
    },
    Campaign {
        name: "two robots, one begins again",
        graphs: Graphs::Line,
        medium: counted(ONE_RESTARTS),
        ..robots(2, Counts { configurations: 3, states: 136_009, transitions: 149_466 })
    },
];

/// What takes fifty minutes together.
pub const THOROUGH: &[Campaign] = &[
    Campaign {
        name: "three robots, every numbering, two tasks",
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        contacts: 1,
        ..robots(3, Counts { configurations: 2_432, states: 3_792_241, transitions: 5_188_609 })
    },
    Campaign {
        name: "three robots in contact that call ahead",
        steps: &[1, 2],
        contacts: 1,
        strategy: Strategy::Eager,
        ..robots(3, Counts { configurations: 88, states: 625_047, transitions: 989_992 })
    },
    Campaign {
        name: "three robots, a task behind the other",
        tasks: 2,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(3, Counts { configurations: 176, states: 72_996, transitions: 95_120 })
    },
    Campaign {
        name: "three robots, two access points",
        access_points: 2,
        ..robots(3, Counts { configurations: 810, states: 155_900, transitions: 206_536 })
    },
    Campaign {
        name: "two robots that call ahead, two access points",
        access_points: 2,
        steps: &[1, 2],
        contacts: 1,
        strategy: Strategy::Eager,
        ..robots(2, Counts { configurations: 184, states: 223_105, transitions: 323_323 })
    },
    Campaign {
        name: "four robots",
        steps: &[1, 2],
        contacts: 1,
        ..robots(4, Counts { configurations: 580, states: 2_402_750, transitions: 3_370_877 })
    },
    Campaign {
        name: "four robots, two tasks",
        tasks: 2,
        ..robots(4, Counts { configurations: 1_450, states: 413_469, transitions: 530_914 })
    },
    Campaign {
        name: "four robots, a task behind the other",
        tasks: 2,
        steps: &[1, 2],
        in_a_row: true,
        ..robots(4, Counts { configurations: 1_160, states: 881_119, transitions: 1_142_743 })
    },
    Campaign {
        name: "five robots",
        ..robots(5, Counts { configurations: 2_442, states: 438_897, transitions: 563_354 })
    },
    Campaign {
        name: "six robots",
        ..robots(6, Counts { configurations: 30_142, states: 5_601_269, transitions: 7_172_149 })
    },
    Campaign {
        name: "six robots in a line",
        graphs: Graphs::Line,
        steps: &[1, 2],
        contacts: 1,
        ..robots(6, Counts { configurations: 14, states: 41_017, transitions: 57_954 })
    },
    Campaign {
        name: "three robots, a message lost, tasks far and near",
        steps: &[1, 2],
        medium: ONE_LOST,
        ..robots(3, Counts { configurations: 88, states: 388_677, transitions: 759_932 })
    },
    Campaign {
        name: "three robots, a message copied",
        medium: ONE_COPIED,
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 878_620, transitions: 1_676_799 })
    },
    Campaign {
        name: "four robots, a message lost",
        medium: ONE_LOST,
        ..robots(4, Counts { configurations: 290, states: 811_355, transitions: 1_628_705 })
    },
    Campaign {
        name: "four robots, a message late",
        medium: ONE_LATE,
        contacts: 1,
        ..robots(4, Counts { configurations: 290, states: 1_679_615, transitions: 3_102_906 })
    },
    Campaign {
        name: "four robots, a message copied",
        medium: ONE_COPIED,
        ..robots(4, Counts { configurations: 290, states: 2_556_059, transitions: 4_717_414 })
    },
    Campaign {
        name: "five robots, a message lost",
        medium: ONE_LOST,
        ..robots(5, Counts { configurations: 2_442, states: 9_455_669, transitions: 19_283_286 })
    },
    Campaign {
        name: "two robots in contact, two messages lost, moves once a period",
        steps: &[1, 2],
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 1,
        ..robots(2, Counts { configurations: 18, states: 104_562, transitions: 291_683 })
    },
    Campaign {
        name: "three robots in contact, a message lost, moves once a period",
        steps: &[1, 2],
        medium: periods(Faults { losses: 1, ..Faults::NONE }),
        contacts: 1,
        ..robots(3, Counts { configurations: 88, states: 934_901, transitions: 1_740_947 })
    },
    Campaign {
        name: "four robots in contact, a message lost, moves once a period",
        medium: periods(Faults { losses: 1, ..Faults::NONE }),
        contacts: 1,
        ..robots(4, Counts { configurations: 290, states: 2_384_675, transitions: 4_563_008 })
    },
    Campaign {
        name: "three robots, two messages late, moves once a period",
        medium: periods(Faults { delays: 2, ..Faults::NONE }),
        ..robots(3, Counts { configurations: 44, states: 92_616, transitions: 198_376 })
    },
    Campaign {
        name: "three robots in contact, two messages lost, moves once a period",
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 1,
        ..robots(3, Counts { configurations: 44, states: 748_241, transitions: 2_661_484 })
    },
    Campaign {
        name: "four robots, two messages lost, moves once a period",
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        ..robots(4, Counts { configurations: 290, states: 2_723_578, transitions: 10_973_819 })
    },
    Campaign {
        name: "three robots, a message lost and one late, moves once a period",
        medium: periods(Faults { losses: 1, delays: 1, ..Faults::NONE }),
        ..robots(3, Counts { configurations: 44, states: 256_525, transitions: 679_170 })
    },
    Campaign {
        name: "three robots, a message lost and one copied, moves once a period",
        medium: periods(Faults { losses: 1, duplicates: 1, ..Faults::NONE }),
        ..robots(3, Counts { configurations: 44, states: 1_555_855, transitions: 4_320_540 })
    },
    Campaign {
        name: "three robots, a message late and one copied, moves once a period",
        medium: periods(Faults { delays: 1, duplicates: 1, ..Faults::NONE }),
        ..robots(3, Counts { configurations: 44, states: 774_986, transitions: 1_897_844 })
    },
    Campaign {
        name: "two robots, two tasks, one stops",
        tasks: 2,
        medium: counted(ONE_STOPS),
        ..robots(2, Counts { configurations: 27, states: 336_453, transitions: 370_567 })
    },
    Campaign {
        name: "two robots, one stops, a message lost",
        medium: counted(Faults { losses: 1, ..ONE_STOPS }),
        ..robots(2, Counts { configurations: 9, states: 472_058, transitions: 676_927 })
    },
    Campaign {
        name: "two robots, one begins again on every graph",
        medium: counted(ONE_RESTARTS),
        ..robots(2, Counts { configurations: 9, states: 263_485, transitions: 294_928 })
    },
    Campaign {
        name: "two robots, one begins again, a message lost",
        medium: counted(Faults { losses: 1, ..ONE_RESTARTS }),
        ..robots(2, Counts { configurations: 9, states: 2_232_344, transitions: 3_418_331 })
    },
    Campaign {
        name: "three robots, one stops",
        medium: counted(ONE_STOPS),
        ..robots(3, Counts { configurations: 44, states: 1_931_445, transitions: 2_109_591 })
    },
    Campaign {
        name: "three robots, one stops, a message lost",
        medium: counted(Faults { losses: 1, ..ONE_STOPS }),
        ..robots(3, Counts { configurations: 44, states: 17_854_211, transitions: 27_118_339 })
    },
    Campaign {
        name: "three robots, one begins again",
        medium: counted(ONE_RESTARTS),
        ..robots(3, Counts { configurations: 44, states: 11_949_704, transitions: 13_273_065 })
    },
    Campaign {
        name: "four robots in a line, one stops",
        graphs: Graphs::Line,
        medium: counted(ONE_STOPS),
        ..robots(4, Counts { configurations: 5, states: 2_307_698, transitions: 2_573_396 })
    },
    Campaign {
        name: "four robots in a line, one begins again",
        graphs: Graphs::Line,
        medium: counted(ONE_RESTARTS),
        ..robots(4, Counts { configurations: 5, states: 11_310_064, transitions: 12_561_802 })
    },
];
