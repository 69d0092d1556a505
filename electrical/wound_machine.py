"""A cross-section with its winding and its length: the one record of what is wound."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import xarray as xr

from electrical.end_turn import end_turn_length
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from geometry.machine import Machine


@dataclass(frozen=True)
class WoundMachine:
    """See the module.

    coils_in_series: coils of one phase, N_c; coil_pitch: y [slots]
    turns: of one coil, N_t; strands: wires in hand, N_h; wire_area: copper section of one wire, A_w [m^2]
    active_length: l [m]
    resistivity: of the copper at the temperature of the winding [ohm m]
    """

    machine: Machine
    coils_in_series: int
    coil_pitch: int
    turns: int
    strands: int
    wire_area: float
    active_length: float
    resistivity: float

    @property
    def end_turn_length(self) -> float:
        """Of one end turn [m], a half circle over the pitch of the coil (thesis eq. 3.84)."""
        return machine_end_turn(self.machine, self.coil_pitch)

    @property
    def phase_resistance(self) -> float:
        """Of one phase [ohm], direct current."""
        return phase_resistance(
            turns=self.turns,
            strands=self.strands,
            wire_area=self.wire_area,
            active_length=self.active_length,
            end_turn_length=self.end_turn_length,
            coils_in_series=self.coils_in_series,
            resistivity=self.resistivity,
        )

    @property
    def end_turn_share(self) -> float:
        """Share of the copper, and of its loss, that lies outside the iron."""
        return self.end_turn_length / (self.end_turn_length + self.active_length)

    @property
    def copper_area(self) -> float:
        """Copper section of one coil side [m^2]."""
        return self.turns * self.strands * self.wire_area

    def current_peak(self, density: float) -> float:
        """Peak phase current [A] at an RMS current density in the copper [A/m^2]."""
        return sqrt(2) * density * self.wire_area * self.strands

    def on_map(self, data: xr.Dataset) -> FluxMapMachine:
        """The machine in dq from the map of its cross-section per turn and metre (``FluxMap.data``)."""
        return FluxMapMachine.from_per_turn(
            data, turns=self.turns, active_length=self.active_length, resistance=self.phase_resistance
        )


def machine_end_turn(machine: Machine, coil_pitch: int) -> float:
    """Length of one end turn of a machine [m]; coil_pitch [slots]. See ``end_turn_length``."""
    return end_turn_length(
        slots=machine.slots,
        shoe_top_radius=machine.shoe_top_radius,
        slot_bottom_radius=machine.slot_bottom_radius,
        tooth_width=machine.tooth_width,
        coil_pitch=coil_pitch,
    )
