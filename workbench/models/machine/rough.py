"""The machine at any angle and any current, to ten percent: fields without current and a few with, the rest by
proportion.

    T = T_cogging(angle) + k(I) sum over phases of i_k d psi_k/d angle,    psi = psi_magnets(angle) + L(I) i

k and L fall with the size I of the currents as they do with the current across and along the magnets' axis. Reluctance
torque and changes of the drawing other than turns and remanence are left out: what the columns of a file mean can be
judged by it, effects cannot.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from effects.base import Columns
from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from geometry.winding import WindingLayout
from workbench.models.base import BaseModel
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.spectra import coefficients, evaluated, slope
from workbench.models.machine.surrogate import _projection

ROUGH = MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5)  # cogging of 12/10 to a tenth, flux to 1e-3
AMPERE_TURNS = (200.0, 600.0, 1200.0, 2400.0)  # of a coil, that saturation is taken at
_ORDERS = 118
_STEPS = 7200  # angles of a revolution that are looked up
_AROUND = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)


class RoughSurrogate:
    """What ``fields`` of the drawing say, solved when first asked."""

    def __init__(self, fields: MachineField):
        self.fields, self.nominal = fields, fields.nominal

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

    @lru_cache(maxsize=4)  # noqa: B019  it lives as long as one search for conventions
    def around(self, turns: tuple[float, ...], remanence: float) -> np.ndarray:
        """Torque, phase flux linkages and their slopes per metre at _STEPS angles (7, steps)."""
        design = replace(self.nominal, turns=turns).with_magnet(remanence=remanence)
        spectrum = self.spectrum(design)
        angle = np.arange(_STEPS) * 2 * np.pi / _STEPS
        return np.concatenate([evaluated(spectrum, angle), evaluated(slope(spectrum[1:]), angle)])

    def saturated(self, design: MachineAsBuilt, currents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Share of the torque and inductance [H/m] that currents [A] (3, n) leave (n,) each."""
        levels, share, inductance = self._saturation
        more = design.turns[0] / self.nominal.turns[0]
        size = np.sqrt(2 / 3 * np.sum(currents**2, axis=0)) * more
        return np.interp(size, levels, share), more**2 * np.interp(size, levels, inductance)


@dataclass(frozen=True, eq=False)
class RoughMachine(BaseModel):
    """The machine bench by looking up; ``other`` answers for what no field is needed for."""

    surrogate: RoughSurrogate
    other: BaseModel
    name: str = "machine"

    @property
    def is_expansion(self) -> bool:
        return True

    def respond(self, design: MachineAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns, SI; see ``MachineBench``."""
        if kind not in _LOOKED_UP:
            return self.other.respond(design, kind, conditions)
        around = self.surrogate.around(design.turns, design.magnet.remanence)
        place = np.rint(np.mod(conditions["angle_mech"], 2 * np.pi) * _STEPS / (2 * np.pi)).astype(int) % _STEPS
        kept = 1.0 - design.end_leakage
        found = design.length * np.take(around, place, axis=1) * np.array([kept**2, *[kept] * 6])[:, None]
        return _LOOKED_UP[kind](self.surrogate, design, found, conditions)


def _back_emf(surrogate: RoughSurrogate, design: MachineAsBuilt, found: np.ndarray, at: Columns) -> dict:
    warm = at.get("magnet_T", design.magnet.reference_temperature) - design.magnet.reference_temperature
    voltages = found[4:] * at["speed"] * (1.0 + design.magnet.temperature_coefficient * warm)
    return {f"v_{x}": voltages[k] for k, x in enumerate("abc")}


def _cogging(surrogate: RoughSurrogate, design: MachineAsBuilt, found: np.ndarray, at: Columns) -> dict:
    return {"torque": found[0]}


def _locked_rotor(surrogate: RoughSurrogate, design: MachineAsBuilt, found: np.ndarray, at: Columns) -> dict:
    currents = np.array([at[f"i_{x}"] for x in "abc"])
    share, _ = surrogate.saturated(design, currents)
    return {"torque": found[0] + share * np.sum(currents * found[4:], axis=0)}


def _flux_linkage(surrogate: RoughSurrogate, design: MachineAsBuilt, found: np.ndarray, at: Columns) -> dict:
    currents = np.array([at[f"i_{x}"] for x in "abc"])
    _, inductance = surrogate.saturated(design, currents)
    return {f"dpsi_{x}": design.length * inductance * currents[k] for k, x in enumerate("abc")}


_LOOKED_UP: dict[str, Callable[..., dict[str, np.ndarray]]] = {
    "back_emf": _back_emf, "cogging": _cogging, "locked_rotor": _locked_rotor, "flux_linkage": _flux_linkage,
}  # fmt: skip
