//! The stages of a control period as places: none of them owns data.

use pleach_discrete::network::Stage;

macro_rules! stages {
    ($($(#[$note:meta])* $name:ident),+ $(,)?) => {
        crate::places_of! {
            /// The stage of a robot in its control period.
            #[derive(Copy)]
            pub enum Control: Stage { $($(#[$note])* $name($name)),+ }
        }

        $($(#[$note])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub struct $name;)+
    };
}

stages! {
    /// It moves until the next sample.
    Moving,
    /// It waits for beacons.
    Beacons,
    /// It waits for the flows of the period before.
    OldFlows,
    /// It waits for multipliers and flows, in turn.
    Iterations,
    /// It waits for demands, flows, shortages and reliefs, in turn.
    Sweeps,
    /// It waits for the answers of those to which it sends.
    Reserving,
    /// It waits for proposals and objections, in turn.
    Negotiation,
}
