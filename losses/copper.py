"""Copper loss of a winding at its temperature, end turns included.

    P = 3/2 R (i_d^2 + i_q^2)       peak phase currents

Direct-current resistance: skin and proximity effect in the wires are left out (0.5 mm copper at 2 kHz: skin depth
1.5 mm), and so is the difference between the currents of wires in hand.
"""

from __future__ import annotations

from electrical.dq import Values


def copper_loss(resistance: Values, i_d: Values, i_q: Values) -> Values:
    """3/2 R (i_d^2 + i_q^2) [W]; resistance of one phase [ohm], peak phase currents [A], arrays that broadcast."""
    return 1.5 * resistance * (i_d**2 + i_q**2)
