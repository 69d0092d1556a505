"""Control loops: the force loop of an actuator, its design for a bandwidth and a phase margin, frequency responses."""
