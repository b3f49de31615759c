//! Locations, events and transition tables: the discrete layer, pure and small.

pub mod network;
