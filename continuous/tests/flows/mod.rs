//! Flows against closed forms and against the exponential of nalgebra.

mod events;
mod exact;
mod integration;
mod isolation;
mod stiff;
mod support;
