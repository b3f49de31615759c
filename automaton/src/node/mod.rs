//! Nodes: components that change by what they hear, sense and time for themselves.
//!
//! A [`Node`] does no input or output. [`step`](Node::step) is its only discrete change: it takes
//! one input (a message heard, something sensed, a tick of its own clock) and leaves outputs
//! (messages, and reports for observers). Between steps its state [flows](Node::flow). These are
//! the hybrid I/O automata of Lynch, Segala and Vaandrager (2003,
//! [doi:10.1016/S0890-5401(03)00067-1](https://doi.org/10.1016/S0890-5401(03)00067-1)): messages
//! are their input and output actions, [bodies](Node::body) their external variables.
//!
//! An [`Ensemble`] composes nodes with a [`Medium`] that carries every message, and is a
//! [`System`](crate::System) for the [`Executor`](crate::Executor). The same node runs in a
//! simulation, under an explorer, or in a process of its own: its driver does nothing but
//! hand it inputs and carry its outputs.
//!
//! Nothing but messages goes from node to node. What a person wants to know of a node is its
//! [view](Observed), and nodes cannot ask each other for it.

mod chunks;
mod ensemble;
mod mail;
mod medium;
mod outputs;
mod unreliable;

pub use ensemble::{Ensemble, NodeJump, Traffic};
pub use mail::Mail;
pub use medium::{Delivery, FullMesh, Medium};
pub use outputs::{Destination, Envelope, Outputs};
pub use unreliable::{MessageFaults, Partition, Unreliable};

/// The number of a node in its ensemble, from 0.
pub type NodeId = usize;

/// What happens to a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input<'a, M, S> {
    /// A message arrives.
    Heard {
        /// Its sender.
        from: NodeId,
        /// The message.
        message: &'a M,
    },
    /// The node senses something, or a person asks it for something.
    Sensed(S),
    /// The node's own clock calls: [`time_to_tick`](Node::time_to_tick) is 0.
    Tick {
        /// Rounds of ticks at this instant that the node has let pass since its last one.
        passed: usize,
    },
}

/// A component of an [`Ensemble`]. Nodes may take their steps of a round on several threads.
pub trait Node: Send {
    /// What nodes tell each other.
    type Message: Send + Sync;
    /// What the node senses, or what a person asks of it.
    type Sense;
    /// What the node tells observers; no node reads it.
    type Report: Send;
    /// What the physical world knows of the node, such as its position.
    type Body;
    /// What can go wrong.
    type Error: Send;

    /// Takes one input; what the node has to say goes to `outputs`.
    ///
    /// # Errors
    ///
    /// Whatever keeps the node from going on.
    fn step(
        &mut self,
        input: Input<'_, Self::Message, Self::Sense>,
        outputs: &mut Outputs<Self::Message, Self::Report>,
    ) -> Result<(), Self::Error>;

    /// Seconds until the node's clock calls for the next [tick](Input::Tick): 0 if it is due now,
    /// `None` if no tick will come by itself.
    fn time_to_tick(&self) -> Option<f64>;

    /// Where several rounds of ticks follow at one instant: how many the node lets pass before its
    /// next tick, counted from its last one; none unless the node says otherwise. What it hears in
    /// the meantime may change its answer.
    fn rounds_to_pass(&self) -> usize {
        0
    }

    /// Lets `duration` > 0 seconds pass, at most [`time_to_tick`](Self::time_to_tick). If it is
    /// exactly that, the tick is due afterwards, whatever rounding does.
    fn flow(&mut self, duration: f64);

    /// Whether what must hold while time passes holds now; nothing must unless the node says so.
    /// It is asked after each flow, before anything else happens.
    ///
    /// # Errors
    ///
    /// What does not hold.
    fn check_invariant(&self) -> Result<(), Self::Error> {
        Ok(())
    }

    /// What the physical world knows of the node now.
    fn body(&self) -> Self::Body;
}

/// A node that observers can look at.
pub trait Observed {
    /// What they see.
    type View<'a>
    where
        Self: 'a;

    /// The node as it is now.
    fn view(&self) -> Self::View<'_>;
}
