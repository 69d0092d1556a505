"""The machine at any angle and any current, to ten percent: fields without current and a few with, the rest by
proportion.

    T = T_cogging(angle) + k(I) sum over phases of i_k d psi_k/d angle,    psi = psi_magnets(angle) + L(I) i

k and L fall with the size I of the currents as they do with the current across and along the magnets' axis. Reluctance
torque and changes of the drawing other than turns and remanence are left out: what the columns of a file mean can be
judged by it, effects cannot.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from geometry.winding import WindingLayout
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.surrogate import _projection, coefficients, evaluated, slope

ROUGH = MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5)  # cogging of 12/10 to a tenth, flux to 1e-3
AMPERE_TURNS = (200.0, 600.0, 1200.0, 2400.0)  # of a coil, that saturation is taken at
_ORDERS = 118
_AROUND = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)


class RoughSurrogate:
    """Answers what ``Surrogate`` answers, from ``fields`` of the drawing."""

    def __init__(self, fields: MachineField):
        self.fields, self.nominal = fields, fields.nominal
        self.states = None

    @property
    def layout(self) -> WindingLayout:
        return self.fields.layout

    @cached_property
    def no_load(self) -> np.ndarray:
        """Fourier coefficients over the revolution of torque and coil fluxes (1 + coils, orders)."""
        return coefficients(self.fields.no_load(self.nominal), _ORDERS)

    def spectrum(self, design: MachineAsBuilt) -> np.ndarray:
        """Of torque and phase flux linkages per metre (4, orders)."""
        strength = design.magnet.remanence / self.nominal.magnet.remanence
        found = _projection(self.layout, design.turns) @ self.no_load
        found[0] *= strength**2
        found[1:] *= strength
        return found

    @cached_property
    def _saturation(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Currents [A], torque over what the slope of the flux gives, inductance per metre [H/m] (levels,) each."""
        project = _projection(self.layout, self.nominal.turns)
        slopes = evaluated(slope(self.spectrum(self.nominal)[1:2]), _AROUND)[0]
        across, along = float(_AROUND[slopes.argmax()]), float(_AROUND[np.abs(slopes).argmin()])
        currents = np.array(AMPERE_TURNS) / self.nominal.turns[0]
        q, d = (self._loaded(angle, currents) @ project.T for angle in (across, along))
        torque = (q[1:, 0] - q[0, 0]) / (1.5 * currents * slopes.max())
        inductance = 0.5 * ((q[1:, 1] - q[0, 1]) + (d[1:, 1] - d[0, 1])) / currents
        return currents, torque, inductance

    def _loaded(self, angle: float, currents: np.ndarray) -> np.ndarray:
        """Samples without current and at currents i, -i/2, -i/2 (1 + levels, 1 + coils)."""
        states = [LoadedState(angle, (i, -i / 2, -i / 2)) for i in (0.0, *currents.tolist())]
        return self.fields.loaded(self.nominal, states)

    def with_current(self, design: MachineAsBuilt, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque and phase flux linkages per metre (n, 4) at angles [rad] (n,) and phase currents [A] (n, 3)."""
        spectrum = self.spectrum(design)
        slopes, alone = evaluated(slope(spectrum[1:]), angle), evaluated(spectrum, angle)
        levels, share, inductance = self._saturation
        more = design.turns[0] / self.nominal.turns[0]
        size = np.sqrt(2 / 3 * np.sum(currents**2, axis=1)) * more
        torque = alone[0] + np.interp(size, levels, share) * np.einsum("nk,kn->n", currents, slopes)
        henry = more**2 * np.interp(size, levels, inductance)
        return np.column_stack([torque, alone[1:].T + henry[:, None] * currents])
