"""The machine in truth: another mesh, other layers in the gap, another reading of the steel's curve than the model.

Two ways to the readings: an expansion of field solutions on that mesh, fast enough to size hidden effects with, and the
field solutions of the very machine at the very angles and currents.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from materials.library import read_curve, steel_file
from materials.reluctivity import SplineReluctivity
from workbench.models.machine.build import MeshPlan, SurrogateBuilder
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.spectra import averaged, coefficients, evaluated, slope
from workbench.models.machine.surrogate import Surrogate

MESH = MeshDensity(gap_edges=480, gap_layers=3, across_iron=3.0)
PLAN = MeshPlan(
    idle_base=MeshDensity(gap_edges=960, gap_layers=4, across_iron=4.0),
    loaded_base=MeshDensity(gap_edges=960, gap_layers=4, across_iron=4.0),
    idle=MeshDensity(gap_edges=420, gap_layers=3, across_iron=3.0),  # seven angles in a period of cogging
    loaded=MeshDensity(gap_edges=240, gap_layers=3),
)
CHORD_POINTS = 3  # put on every straight piece of the steel's curve
SLICES = np.polynomial.legendre.leggauss(3)  # along a skewed machine
ORDERS = 230


@cache
def chords(grade: str) -> SplineReluctivity:
    """The steel read as straight lines between the points of its table, instead of a smooth curve through them."""
    _, field, flux = read_curve(steel_file(grade))
    share = np.arange(CHORD_POINTS) / CHORD_POINTS
    dense = [np.append((np.array(v)[:-1, None] + share * np.diff(v)[:, None]).ravel(), v[-1]) for v in (field, flux)]
    return SplineReluctivity.from_points(f"{grade} in chords", *dense)


class Expansion:
    """The machine expanded in everything that may be hidden in it, about any machine that is like the drawing.

    cache_folder: for the field solutions about the drawing, None for none
    """

    def __init__(self, nominal: MachineAsBuilt, states: Sequence[LoadedState], cache_folder: Path | None):
        self._builder = SurrogateBuilder(nominal, PLAN, cache_folder, chords)
        self.about_drawing = self._builder.build(states)

    def about(self, design: MachineAsBuilt) -> Surrogate:
        """Solved at a design; what is hidden besides adds what it would add to the drawing."""
        return self._builder.about(self.about_drawing, design)


class FullField:
    """Torque and flux linkages of any machine as built, solved for every state that is asked."""

    def __init__(self, nominal: MachineAsBuilt):
        self.field = MachineField(nominal, MESH, chords)
        self._spectra: dict[MachineAsBuilt, np.ndarray] = {}  # of a whole machine, which takes seconds

    def no_load(self, design: MachineAsBuilt, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Torque [Nm] (n,) and d psi/d angle of the phases [Wb] (3, n) without current, the magnets whole."""
        if design not in self._spectra:
            self._spectra[design] = self._phases(design, coefficients(self.field.no_load(design), ORDERS))
        spectrum = averaged(self._spectra[design], design.skew)
        return design.length * evaluated(spectrum[:1], angle)[0], design.length * evaluated(slope(spectrum[1:]), angle)

    def loaded(self, design: MachineAsBuilt, angle: np.ndarray, currents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Torque [Nm] (n,) and flux linkages [Wb] (3, n) with phase currents (n, 3)."""
        total = 0.0
        for node, weight in zip(*SLICES) if design.skew else ((0.0, 2.0),):
            turned = angle + node * design.skew / 2
            states = [LoadedState(float(a), tuple(map(float, i))) for a, i in zip(turned, currents)]
            total = total + weight / 2 * self._phases(design, self.field.loaded(design, states).T)
        return design.length * total[0], design.length * total[1:]

    def forget(self) -> None:
        self.field.forget()

    def _phases(self, design: MachineAsBuilt, samples: np.ndarray) -> np.ndarray:
        """Torque and phase values (4, n) per metre from coil values (1 + coils, n)."""
        phases = np.zeros((4, samples.shape[1]), dtype=samples.dtype)
        phases[0] = samples[0]
        for k, coil in enumerate(self.field.layout.coils):
            phases[1 + coil.phase] += coil.sign * design.turns[k] * samples[1 + k]
        return phases


def with_strengths(design: MachineAsBuilt, losses: Mapping[int, float]) -> MachineAsBuilt:
    """Some magnets weaker by a share."""
    for number, loss in losses.items():
        design = design.with_one("magnet_strengths", number, design.magnet_strengths[number] * (1 - loss))
    return design
