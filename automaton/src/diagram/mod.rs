//! Pictures and tables of an automaton.
