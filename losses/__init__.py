"""Where the power goes: loci of B and iron loss, eddy currents in magnets, copper, the map over torque and speed."""
