//! Predicates over states, with a signed margin.
