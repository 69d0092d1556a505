"""What a machine gives over speed, as powers of its flux linkage, inductances and resistance under load.

Beyond the base speed no closed formula says how torque and power go with what a tolerance moves. So the flux map is
moved, each time by the part of it that one constant of the loaded machine stands for,

    psi_d = psi_m + L_d i_d,  psi_q = L_q i_q:    F -> psi_d + e F,    L_d -> psi_d + e L_d i_d,    L_q -> (1 + e) psi_q

and what is asked is found again on it: d ln y = sum p_k d ln x_k. Exact for constant parameters; on a saturating map
the moved parts are those of the overload current on the q axis wherever the machine then works.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from electrical.braking import strongest_braking
from electrical.dq import DriveLimits, maximum_power, torque_speed_envelope
from electrical.flux_map_machine import FluxMapMachine
from uncertainty.powers import LITTLE, power
from uncertainty.wound_slopes import Quantities

Reading = Callable[[FluxMapMachine], float]
Powers = dict[str, float]  # p_k by the names of x_k in ``Quantities``, dimensionless


@dataclass(frozen=True, eq=False)
class OverSpeed:
    """A wound machine within its limits.

    machine: on its flux map; limits: of its drive; fastest: largest speed of its rotor [rad/s]
    loaded: its constants, the values of ``ToleranceOutcome``
    """

    machine: FluxMapMachine
    limits: DriveLimits
    fastest: float
    loaded: Quantities

    def largest_power(self) -> Powers:
        """Of the largest power up to the largest speed."""
        return self.powers(lambda machine: float(maximum_power(machine, self.limits, self.fastest).power))

    def torque(self, speed: float) -> Powers:
        """Of the largest torque at a speed of the rotor [rad/s]."""
        return self.powers(lambda machine: float(torque_speed_envelope(machine, self.limits, np.array(speed)).torque))

    def braking(self, speed: float) -> Powers:
        """Of the largest torque against the motion at a speed of the rotor [rad/s]."""
        return self.powers(lambda machine: float(strongest_braking(machine, self.limits, speed).torque))

    def powers(self, read: Reading) -> Powers:
        """p_k of what is read of a machine, a positive number [any unit]."""
        return {name: power(read(more), read(less)) for name, more, less in self._moved()}

    def _moved(self) -> Iterator[tuple[str, FluxMapMachine, FluxMapMachine]]:
        """One constant after the other a little larger and a little smaller."""
        for name, change in (
            ("loaded_flux", self._with_flux),
            ("loaded_inductance_d", self._with_inductance_d),
            ("loaded_inductance_q", self._with_inductance_q),
            ("resistance", self._with_resistance),
        ):
            yield name, change(LITTLE), change(-LITTLE)

    def _with_flux(self, change: float) -> FluxMapMachine:
        return replace(self.machine, psi_d=self.machine.psi_d + change * self.loaded.loaded_flux)

    def _with_inductance_d(self, change: float) -> FluxMapMachine:
        moved = change * self.loaded.loaded_inductance_d * self.machine.i_d[:, None]
        return replace(self.machine, psi_d=self.machine.psi_d + moved)

    def _with_inductance_q(self, change: float) -> FluxMapMachine:
        return replace(self.machine, psi_q=self.machine.psi_q * (1 + change))

    def _with_resistance(self, change: float) -> FluxMapMachine:
        return self.machine.with_resistance(self.machine.resistance * (1 + change))
