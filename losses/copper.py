"""Copper loss of a winding at its temperature, end turns included.

    P = 3/2 R (i_d^2 + i_q^2)       peak phase currents

Direct-current resistance: what the wires lose in each other's field is an estimate of its own, ``proximity_ratio``; the
skin effect (0.5 mm copper at 2 kHz: skin depth 1.5 mm) and the difference between the currents of wires in hand are
left out.
"""

from __future__ import annotations

from math import pi

from electrical.dq import Values
from electrical.wound_machine import WoundMachine
from geometry.areas import part_areas
from units import MU_0


def copper_loss(resistance: Values, i_d: Values, i_q: Values) -> Values:
    """3/2 R (i_d^2 + i_q^2) [W]; resistance of one phase [ohm], peak phase currents [A], arrays that broadcast."""
    return 1.5 * resistance * (i_d**2 + i_q**2)


def proximity_ratio(wound: WoundMachine) -> float:
    """Share [s^2/rad^2] of what wires lose in the leakage field of their slot, of their direct-current loss.

        P_prox / (P_dc w^2) = pi^2 mu_0^2 d^6 n^2 / (768 rho^2 b^2)

    from P = pi d^4 w^2 B^2 / (128 rho) a metre of wire across a field of amplitude B, with B rising from the bottom of
    the slot to mu_0 n i / b: n wires of a slot that all carry i, diameter d, slot width b, electrical speed w. Of the
    part in the slot alone, at the resistivity of ``wound``; falls with its square.

    An estimate: both coil sides of a slot count as one phase, which is up to 60 % too much; the field of the rotor in
    the slot opening and currents that circulate between wires in hand are not in it, and may be more.
    Validity: wires thin against the skin depth. Source: the low-frequency limit of Dowell, Proc. IEE 113(8) (1966)
    1387, for round wires; Ferreira, IEEE Trans. Power Electron. 9(1) (1994) 127.
    """
    machine = wound.machine
    width = 2 * part_areas(machine).half_slot / machine.stator.slot_depth
    wires = wound.design.turns * wound.design.strands * 6 * wound.coils_in_series / machine.slots
    wire = wound.design.wire
    return pi**2 * MU_0**2 * wire.copper_diameter**6 * wires**2 / (768 * wire.resistivity**2 * width**2)
