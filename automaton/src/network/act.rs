//! Acts: the work of a node as data, attached to the rows of a table.

use pleach_discrete::Event;
use pleach_guards::{Guard, Valuation};

use crate::Transfer;
use crate::located::{DataOf, Holds, Place};

/// A part of the work of a node.
pub(super) trait Act: Copy + Send + Sync + 'static {
    /// What drawings call it.
    fn name(self) -> &'static str;
}

/// A row on which a node does `acts`, in their order; drawings show them as its reset. `next`
/// gives the data of the target from that of the source.
pub(super) fn acting<P, A, B, E, S, C>(
    event: E,
    guard: Guard,
    acts: &'static [C],
    next: fn(&A) -> B,
) -> Transfer<P::Location, E, S>
where
    P: Place,
    A: DataOf<P>,
    B: DataOf<P>,
    E: Event,
    S: Holds<P, Effects = &'static [C]> + Valuation + 'static,
    C: Act,
{
    let names: Vec<&str> = acts.iter().map(|act| act.name()).collect();
    Transfer::new(event, guard, &names.join(", "), move |data: &A, _: &S, effects: &mut _| {
        *effects = acts;
        next(data)
    })
}
