//! The properties of the robot network.
