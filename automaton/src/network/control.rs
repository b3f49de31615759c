//! The stages of a control period with the data that each of them needs: how often it has been
//! taken.

use pleach_discrete::network::Stage;

macro_rules! stages {
    ($($(#[$note:meta])* $name:ident $(($count:ident: $(#[$what:meta])*))?),+ $(,)?) => {
        crate::places_of! {
            /// The stage of a robot in its control period: a [`Stage`] with the data that it owns.
            #[derive(Copy)]
            pub enum Control: Stage { $($(#[$note])* $name($name)),+ }
        }

        $($(#[$note])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name { $($(#[$what])* pub $count: usize)? })+

        impl Control {
            /// Which iteration of the routes this is; 0 in other stages.
            pub const fn count(&self) -> usize {
                match self {
                    $(Control::$name($name { $($count)? }) => stages!(@ $($count)?)),+
                }
            }
        }
    };
    (@) => { 0 };
    (@ $count:ident) => { *$count };
}

stages! {
    /// It moves until the next sample.
    Moving,
    /// It waits for beacons.
    Beacons,
    /// It waits for the flows of the period before.
    OldFlows,
    /// It waits for multipliers.
    Multipliers(iteration: /// The iteration, from 1.
    ),
    /// It waits for flows.
    Flows(iteration: /// The iteration, from 1.
    ),
    /// It waits for demands, flows, shortages and reliefs, in turn.
    Sweeps,
    /// It waits for the answers of those to which it sends.
    Reserving,
    /// It is about to propose a move.
    Planning,
    /// It waits for proposals and objections, in turn.
    Negotiation,
}
