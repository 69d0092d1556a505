"""What the Prius motor must give with its rotor locked: ``python -m benchmarks.locked_torque``.

The voltage of its drawing is 19 % above the measured one. Of the explanations that the voltage leaves, three are
followed to the largest torque over the rotor angle, direct current going into phase A and back through B and C: the
magnets as they are assumed (something beside the machine reads too little then), weaker magnets, and ends that leak,
which takes i . d psi/d angle of the magnets' linkages and no torque of reluctance.
Around each stands what the declared tolerances leave,

    (u/T)^2 = sum of (d ln T/dx u_x)^2 + u_length^2 + u_current^2,    interval T (1 +- 2 u/T)

by the GUM, derivatives as differences of two solutions at the middle current; the prediction is the interval over all
of them. Nothing is fitted but to the voltage. Writes measurements/prius-2004-field/predictions.csv.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import log, sqrt

import numpy as np
import pandas as pd
from scipy.optimize import brentq

from benchmarks.built_machines import (
    BEYOND,
    LOCKED,
    line_voltage,
    locked_torque,
    measured_line_voltage,
    with_remanence,
)
from geometry.cross_section import mesh_cross_section
from geometry.rotors.v_shape import VShape
from magnetostatics.currents import PhaseCurrents
from magnetostatics.flux_linkage import phase_flux_linkage
from magnetostatics.model import FieldModel
from pipeline.modules import PROJECT
from study.machine_file import MachineFile, read_machine
from units import DEGREE, MILLIMETRE

TABLE = PROJECT / "measurements" / "prius-2004-field" / "predictions.csv"
# Standard uncertainties as the campaign declares them: of the value, and of the gap.
REMANENCE, LENGTH, CURRENT, GAP = 0.03, 0.005, 0.005, 0.02 * MILLIMETRE
WITHIN = 0.9, 1.3  # T, where the remanence that gives the voltage lies
STEP = 3 * DEGREE  # electrical, for slopes of a linkage
COVERAGE = 2.0  # about 95 %


@dataclass(frozen=True)
class Explanation:
    """Of the voltage. found: the machine with its magnets; kept: share of their flux that goes through the winding"""

    words: str
    found: MachineFile
    kept: float

    def torque(self, current: float) -> float:
        """Largest over the rotor angle [Nm] at a current of phase A [A]."""
        found = self.found
        model = FieldModel(mesh_cross_section(found.machine, found.layout, found.density), found.materials)

        def at(beyond: float) -> float:
            torque, cogging = (locked_torque(found, model, amperes, beyond) for amperes in (current, 0.0))
            lost = (1 - self.kept) * _of_magnets(found, model, current, beyond) if self.kept < 1 else 0.0
            return abs(torque - lost - (1 - self.kept**2) * cogging)

        return max(at(beyond) for beyond in BEYOND)


def _of_magnets(found: MachineFile, model: FieldModel, current: float, beyond: float) -> float:
    """i . d psi/d angle of the magnets' flux linkages [Nm], by central differences; beyond: see ``locked_torque``"""
    ends = []
    for sign in (-1, 1):
        angle = (found.layout.phase_axis + beyond + sign * STEP) / found.machine.pole_pairs
        ends.append(phase_flux_linkage(model.solve(PhaseCurrents(angle, (0.0, 0.0, 0.0)))))
    slopes = found.turns * found.active_length * (ends[1] - ends[0]) * found.machine.pole_pairs / (2 * STEP)
    return float(slopes @ np.array([current, -current / 2, -current / 2]))


def explanations(found: MachineFile) -> Iterator[Explanation]:
    """As drawn, and those that meet the measured voltage."""
    measured = measured_line_voltage()
    yield Explanation("magnets as assumed, 1.24 T", found, 1.0)
    asked = brentq(lambda b: line_voltage(with_remanence(found, b)) - measured, *WITHIN, xtol=1e-3)
    yield Explanation(f"weaker magnets, {asked:.3f} T", with_remanence(found, float(asked)), 1.0)
    kept = measured / line_voltage(found)
    yield Explanation(f"ends that leak {1 - kept:.0%} of the magnets' flux, 1.24 T", found, kept)


def relative_uncertainty(found: MachineFile) -> float:
    """What tolerances leave of a torque at the middle current, standard, dimensionless."""
    current, remanence = LOCKED[len(LOCKED) // 2], found.materials.magnet.remanence
    weaker, stronger = (with_remanence(found, remanence * (1 + sign * REMANENCE)) for sign in (-1, 1))
    wider, narrower = (_with_gap(found, sign * GAP) for sign in (1, -1))
    parts = [
        log(Explanation("", one, 1.0).torque(current) / Explanation("", other, 1.0).torque(current)) / 2
        for one, other in ((stronger, weaker), (narrower, wider))
    ]
    return sqrt(sum(part**2 for part in parts) + LENGTH**2 + CURRENT**2)


def _with_gap(found: MachineFile, change: float) -> MachineFile:
    """With a rotor that is turned down or left larger; change: of the gap [m]"""
    rotor = found.machine.rotor
    assert isinstance(rotor, VShape)
    turned = replace(rotor, outer_radius=rotor.outer_radius - change)
    return replace(found, machine=replace(found.machine, rotor=turned))


def predictions(found: MachineFile) -> Iterator[Mapping[str, object]]:
    """For each current the interval over all explanations, then a row for each."""
    u, rivals = COVERAGE * relative_uncertainty(found), list(explanations(found))
    for current in LOCKED:
        torques = {one.words: one.torque(current) for one in rivals}
        low, high = min(torques.values()) * (1 - u), max(torques.values()) * (1 + u)
        yield _row(current, "any explanation below", (low + high) / 2, low, high)
        for words, torque in torques.items():
            yield _row(current, words, torque, torque * (1 - u), torque * (1 + u))


def _row(current: float, given: str, value: float, low: float, high: float) -> dict[str, object]:
    return {
        "of": f"rotor locked, {current:g} A in phase A, half of it back through B and through C",
        "quantity": "largest torque over the rotor angle", "unit": "Nm", "value": value, "low": low, "high": high,
        "given": given,
    }  # fmt: skip


def main() -> None:
    table = pd.DataFrame(predictions(read_machine("prius_2004")))
    table.to_csv(TABLE, index=False, float_format="%.1f")
    print(table.to_string(index=False))


if __name__ == "__main__":
    main()
