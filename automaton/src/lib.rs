//! Hybrid automata as typed values: the graph, the executor, trajectories and diagrams.

pub mod network;
