"""What could be measured next on the bench of a drawn machine, with the instruments it has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from effects.drawn_design import DrawnAsBuilt
from units import RPM
from workbench.data.table import Table
from workbench.models.base import Option
from workbench.models.proposals import proposal

_SPEEDS = np.array([500.0, 1000.0, 2000.0]) * RPM
_PEAKS = np.array([0.25, 0.5, 0.75, 1.0])  # of the largest current
_TORQUE_CELL = 0.01  # of the largest torque: a cell of 0.2 to 0.5 % class at a part of its range
_WARM = np.array([20.0, 50.0, 80.0])  # degC


def options(design: DrawnAsBuilt, tables: Sequence[Table]) -> list[Option]:
    """Voltage with warm magnets, and torque against the current angle at several currents with the rotor locked."""
    found = []
    if design.magnet.remanence:
        warm = {"speed": np.repeat(_SPEEDS, 3), "magnet_T": np.tile(_WARM, 3)}
        words = "back-EMF at 500 to 2000 rpm with the magnets at 20, 50 and 80 degC"
        found.append(proposal("back_emf", words, warm, ("v_ll",), tables))
    if design.largest_current:
        found.append(_locked(design))
    return [option for option in found if option is not None]


def _locked(design: DrawnAsBuilt) -> Option:
    """Phases fed as i, -i/2, -i/2 at four currents and eight angles over half an electrical period."""
    angle = (np.arange(8) + 0.5) * np.pi / (8 * design.machine.pole_pairs)
    current, angles = (v.ravel() for v in np.meshgrid(_PEAKS * design.largest_current, angle, indexing="ij"))
    at = {"angle_mech": angles, "i_a": current, "i_b": -current / 2, "i_c": -current / 2}
    torque = 1.5 * design.machine.pole_pairs * design.largest_current * design.turns * design.length
    size = np.full(len(angles), _TORQUE_CELL * max(torque, 1e-3))
    words = "locked-rotor torque over half an electrical period at a quarter to all of the largest current"
    return Option("locked_rotor", words, at, {"torque": size}, 1.5)
