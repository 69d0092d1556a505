"""From a cross-section to a winding: end turns, resistance, the dq machine and its limits, turns and wires."""
