//! Link reliability, routing and the motion controller of the robot network.
