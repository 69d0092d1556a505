"""Copper loss of a winding at its temperature, end turns included.

    P = 3/2 R (i_d^2 + i_q^2)       peak phase currents

Direct-current resistance: skin and proximity effect in the wires are left out (0.5 mm copper at 2 kHz: skin depth
1.5 mm), and so is the difference between the currents of wires in hand.
"""

from __future__ import annotations

from dataclasses import dataclass

from electrical.end_turn import end_turn_length
from electrical.resistance import phase_resistance
from geometry.machine import Machine
from geometry.winding import WindingLayout


@dataclass(frozen=True)
class WoundMachine:
    """A cross-section with its length and winding.

    turns: of one coil; strands: wires in hand; wire_area: copper section of one wire [m^2]; active_length [m]
    """

    machine: Machine
    layout: WindingLayout
    turns: int
    strands: int
    wire_area: float
    active_length: float

    @property
    def end_turn_length(self) -> float:
        """Of one end turn [m], a half-circle over the pitch of the coil (thesis eq. 3.84)."""
        m = self.machine
        return end_turn_length(
            slots=m.slots,
            shoe_top_radius=m.shoe_top_radius,
            slot_bottom_radius=m.slot_bottom_radius,
            tooth_width=m.tooth_width,
            coil_pitch=self.layout.coil_pitch,
        )

    def phase_resistance(self, resistivity: float) -> float:
        """Of one phase [Ohm] at the resistivity of the warm copper [Ohm m], ``copper_resistivity(temperature)``."""
        return phase_resistance(
            turns=self.turns,
            strands=self.strands,
            wire_area=self.wire_area,
            active_length=self.active_length,
            end_turn_length=self.end_turn_length,
            coils_in_series=self.layout.coils_in_series,
            resistivity=resistivity,
        )

    @property
    def end_turn_share(self) -> float:
        """Share of the copper, and of its loss, that lies outside the iron."""
        return self.end_turn_length / (self.end_turn_length + self.active_length)


def copper_loss(resistance, i_d, i_q):
    """3/2 R (i_d^2 + i_q^2) [W]; resistance of one phase [Ohm], peak phase currents [A], arrays that broadcast."""
    return 1.5 * resistance * (i_d**2 + i_q**2)
