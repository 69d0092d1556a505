"""The lumped model of an actuator from its measured impedance: mass, friction and mount of thesis table B.1.

The machine is known (thesis: from an impedance meter), the rest is fitted to ln |Z| of all points, sizes only, as the
thesis does; ``bench.identification`` says how sure each value is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import pi

import numpy as np

from bench.identification import Identification, Unknown, identify
from bench.impedance import ImpedancePoint
from vehicle.impedance import LumpedActuator
from workbench.data.table import OPEN_CIRCUIT

MASS, FRICTION = "equivalent_mass_kg", "viscous_friction_Ns_per_m"
STIFFNESS, DAMPING = "mount_stiffness_kN_per_m", "mount_damping_Ns_per_m"
_RELATIVE = 0.02  # spread of ln |Z| from point to point; only what it is relative to itself weighs


def fit_lumped(start: LumpedActuator, points: Sequence[ImpedancePoint]) -> tuple[LumpedActuator, Identification]:
    """The lumped actuator that fits the sizes of the points best, and what the fit says of it.

    start: machine and circuit as they are, mass, friction and mount where the search begins, all above zero
    """
    frequency, amplitude, shunt = np.array([(p.frequency, p.amplitude, p.shunt) for p in points]).T
    shunt = np.minimum(shunt, OPEN_CIRCUIT)
    nominal = dict(
        zip(_NAMES, (start.equivalent_mass, start.viscous_friction, start.mount_stiffness, start.mount_damping))
    )

    def answers(values: Mapping[str, float]) -> list[np.ndarray]:
        """Logarithms of the impedances with these parameters, of Ns/m, (points,)."""
        device = lumped_with(start, values)
        return [np.log(np.abs(device.impedance(frequency, shunt, 2 * pi * frequency * amplitude)))]

    measured = [np.log(np.abs([p.impedance for p in points]))]
    found = identify(answers, [Unknown(name, nominal[name]) for name in _NAMES], measured, [_RELATIVE])
    return lumped_with(start, found.values), found


_NAMES = (MASS, FRICTION, STIFFNESS, DAMPING)


def lumped_with(device: LumpedActuator, values: Mapping[str, float]) -> LumpedActuator:
    """The same machine with other mechanical values [SI], under the names of this module."""
    return replace(
        device,
        equivalent_mass=values[MASS],
        viscous_friction=values[FRICTION],
        mount_stiffness=values[STIFFNESS],
        mount_damping=values[DAMPING],
    )
