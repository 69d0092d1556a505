"""Where the power goes: B loci and iron loss, eddy currents in the magnets, copper, and the map over torque and speed."""
