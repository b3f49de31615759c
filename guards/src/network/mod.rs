//! The guards of the robot network.
