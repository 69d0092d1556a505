"""A cross-section with its winding and its length: the one record of what is wound."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from electrical.circulating import ZeroSequence
from electrical.dq import Values
from electrical.end_turn import CoilSeat, EndTurn, coil_seat, usual_end_turn
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from electrical.winding_design import WindingDesign
from geometry.machine import Machine, dimensions_of
from geometry.parts import DrawnMachine
from geometry.winding import WindingLayout
from labelled import xr


@dataclass(frozen=True)
class WoundMachine:
    """See the module. Currents, resistance and flux linkages are those of the equivalent star
    (``electrical.winding_connection``); the design says what one coil and one wire carry of them.

    coils_in_series: coils of one phase, N_c, in series in the equivalent star; coil_pitch: y [slots]
    design: turns, wires in hand, wire and connection
    active_length: l [m]
    stated_end_turn: how the coils go round the ends, None for what is usual for their pitch
    """

    machine: DrawnMachine
    coils_in_series: int
    coil_pitch: int
    design: WindingDesign
    active_length: float
    stated_end_turn: EndTurn | None = None

    @property
    def dimensions(self) -> Machine:
        """See ``geometry.machine.dimensions_of``."""
        return dimensions_of(self.machine)

    @property
    def equivalent_turns(self) -> float:
        """Turns of a coil of the equivalent star: ampere-turns over line current."""
        return self.design.equivalent_turns

    @property
    def end_turn_length(self) -> float:
        """Of one end turn [m]."""
        return self.end_turn.length(self._seat)

    @property
    def end_turn(self) -> EndTurn:
        """How the coils go round the ends."""
        return usual_end_turn(self.coil_pitch) if self.stated_end_turn is None else self.stated_end_turn

    @property
    def end_turn_inductance(self) -> float:
        """Leakage of the end turns of one phase [H], which no plane field has; ValueError where it is not known."""
        return self.end_turn.inductance(self._seat, self.equivalent_turns, self.coils_in_series, self.copper_area)

    @property
    def _seat(self) -> CoilSeat:
        layers = 2 * WindingLayout.phases * self.coils_in_series // self.machine.slots
        return coil_seat(self.machine, self.coil_pitch, layers)

    @property
    def phase_resistance(self) -> float:
        """Of one phase [ohm], direct current; half of what is measured between two terminals."""
        return phase_resistance(
            turns=self.equivalent_turns,
            strands=1,
            wire_area=self.copper_area / self.equivalent_turns,
            active_length=self.active_length,
            end_turn_length=self.end_turn_length,
            coils_in_series=self.coils_in_series,
            resistivity=self.design.wire.resistivity,
        )

    @property
    def end_turn_share(self) -> float:
        """Share of the copper, and of its loss, that lies outside the iron."""
        return self.end_turn_length / (self.end_turn_length + self.active_length)

    @property
    def copper_area(self) -> float:
        """Copper section of one coil side [m^2]."""
        return self.design.copper_area

    def ampere_turns(self, i_d: Values, i_q: Values) -> tuple[Values, Values]:
        """Of one coil (d, q), peak [A], as maps per turn take them; i_d, i_q: peak line currents [A]."""
        return self.equivalent_turns * i_d, self.equivalent_turns * i_q

    def current_peak(self, density: float) -> float:
        """Peak line current [A] at an RMS current density in the copper [A/m^2]."""
        return sqrt(2) * density * self.copper_area / self.equivalent_turns

    def circulating_loss(self, data: xr.Dataset, i_d: Values, i_q: Values, speed: Values) -> np.ndarray:
        """Loss by the current round the triangle of a delta [W], none in a star; of the shape of the arguments, which
        broadcast.

        data: map of its cross-section per turn and metre (``FluxMap.data``); i_d, i_q: peak line currents [A]; speed:
        mechanical [rad/s]
        """
        if not self.design.connection.closing.circulates:
            return np.zeros(np.broadcast_shapes(np.shape(i_d), np.shape(i_q), np.shape(speed)))
        per_turn = self.phase_resistance / (self.equivalent_turns**2 * self.active_length)
        electrical = self.machine.pole_pairs * np.asarray(speed)
        zero = ZeroSequence.from_per_turn(data)
        return self.active_length * zero.loss(*self.ampere_turns(i_d, i_q), electrical, per_turn)

    def on_map(self, data: xr.Dataset) -> FluxMapMachine:
        """The machine in dq from the map of its cross-section per turn and metre (``FluxMap.data``)."""
        return FluxMapMachine.from_per_turn(
            data, turns=self.equivalent_turns, active_length=self.active_length, resistance=self.phase_resistance
        )


def machine_end_turn(machine: DrawnMachine, coil_pitch: int) -> float:
    """Length of one end turn of a machine [m], as is usual for the coil pitch [slots]."""
    return usual_end_turn(coil_pitch).length(coil_seat(machine, coil_pitch))
