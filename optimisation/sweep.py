"""Map of torque and flux densities over back-iron width and rotor radius, for every slot-pole combination and
stator radius."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from itertools import product
from math import nan

import numpy as np

from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.machine import Machine
from labelled import xr
from magnetostatics.case import FamilyCase
from magnetostatics.newton import NewtonSettings
from optimisation.design import Design, DesignSolver, Judge
from optimisation.design_map import DesignMap
from optimisation.states import SaturationReading
from optimisation.torque import QuickMeanTorque
from tasks import Workers
from units import MILLIMETRE

_RADII_TOGETHER = 5  # rotor radii of a task; of a fine sweep one mesh reaches about so many
# Torque is within 0.04 % of the converged one at 12 slots, RMS 0.01 % (56 designs), within 0.15 % at 9, RMS 0.04 %.
_QUICK = NewtonSettings(tolerance=1e-3)
# What the map holds of a ``Design``.
VARIABLES = ("torque", "torque_null", "tooth_aligned", "tooth_worst", "back_iron_worst", "limited")
_DIMENSIONS = ("combination", "stator_outer_radius", "back_iron", "rotor_radius")


@dataclass(frozen=True)
class SaturationLimit:
    """The limit on the flux density of the stator.

    reading: in which probes and states it is read; limit [T]; compared: limits whose optima are compared [T]
    """

    reading: SaturationReading
    limit: float
    compared: tuple[float, ...] = ()

    @property
    def words(self) -> str:
        """The limit as a sentence names it."""
        return f"{self.limit:g} T read as {self.reading.name}"


@dataclass(frozen=True)
class SweepGrid:
    """What the cross-section optimisation varies.

    stator_outer_radii [m]; back_iron_fractions, rotor_radius_fractions: smallest and largest share of the stator radius
    """

    combinations: tuple[Combination, ...]
    stator_outer_radii: tuple[float, ...]
    back_iron_fractions: tuple[float, float]
    back_iron_steps: int
    rotor_radius_fractions: tuple[float, float]
    rotor_radius_steps: int

    @property
    def back_iron(self) -> np.ndarray:
        """Back-iron widths as shares of the stator radius (n,)."""
        return np.linspace(*self.back_iron_fractions, self.back_iron_steps)

    @property
    def rotor(self) -> np.ndarray:
        """Rotor radii as shares of the stator radius (m,)."""
        return np.linspace(*self.rotor_radius_fractions, self.rotor_radius_steps)

    def widths(self, stator_outer_radius: float) -> np.ndarray:
        """Back-iron widths (n,) [m]."""
        return stator_outer_radius * self.back_iron

    def radii(self, stator_outer_radius: float) -> np.ndarray:
        """Rotor radii (m,) [m]."""
        return stator_outer_radius * self.rotor

    @property
    def sections(self) -> tuple[tuple[Combination, float], ...]:
        """Every slot-pole combination with every stator radius [m]."""
        return tuple(product(self.combinations, self.stator_outer_radii))


@dataclass(frozen=True, eq=False)
class DesignMaps:
    """Designs on the grid at the nominal current density; NaN where a machine cannot be built.

    data: ``VARIABLES`` of ``Design`` in SI over combination, stator_outer_radius, back_iron, rotor_radius,
        with ``slots`` and ``poles`` of a combination, ``back_iron_width`` and ``rotor_outer_radius`` [m]; torque by
        ``QuickMeanTorque``
    """

    grid: SweepGrid
    limit: SaturationLimit
    data: xr.Dataset

    def one(self, combination: Combination) -> xr.Dataset:
        """``data`` of one slot-pole combination."""
        return self.data.isel(combination=self.grid.combinations.index(combination))

    def map(self, combination: Combination, stator_outer_radius: float) -> DesignMap:
        """Torque and limited flux density of one combination and stator radius [m]."""
        one = self.one(combination).sel(stator_outer_radius=stator_outer_radius)
        order = ("back_iron", "rotor_radius")
        torque, limited = (one[name].transpose(*order).values for name in ("torque", "limited"))
        return DesignMap(one.back_iron_width.values, one.rotor_outer_radius.values, torque, limited)

    @property
    def designs(self) -> int:
        """Designs of the grid."""
        return int(self.data.torque.size)

    @property
    def unbuildable(self) -> int:
        """Designs that cannot be built."""
        return int(self.data.torque.isnull().sum())


@dataclass(frozen=True)
class SweepBlock:
    """All back_iron_widths [m] at some rotor_outer_radii [m] of one combination and stator radius [m]."""

    case: FamilyCase
    reading: SaturationReading
    combination: Combination
    stator_outer_radius: float
    back_iron_widths: tuple[float, ...]
    rotor_outer_radii: tuple[float, ...]

    @property
    def judge(self) -> Judge:
        return Judge(self.case, self.reading, self.case.nominal_density, QuickMeanTorque(), _QUICK)

    def machine(self, rotor_outer_radius: float, back_iron_width: float) -> Machine:
        """One design. Raises GeometryError where it cannot even be drawn."""
        return self.case.family.machine(
            self.combination,
            stator_outer_radius=self.stator_outer_radius,
            back_iron_width=back_iron_width,
            rotor_outer_radius=rotor_outer_radius,
        )


def sweep_stage(case: FamilyCase, grid: SweepGrid, limit: SaturationLimit, workers: Workers) -> DesignMaps:
    """Solve every design of the grid at the nominal current density."""
    solved = workers.map("sweep", solve_block, blocks_of(case, grid, limit.reading))
    return DesignMaps(grid, limit, _dataset(grid, list(solved.values())))


def solve_block(block: SweepBlock) -> np.ndarray:
    """``VARIABLES`` of a block's designs [Nm/m, T], (radii, widths, variables), NaN where no machine can be built."""
    machines = {}
    for place in product(block.rotor_outer_radii, block.back_iron_widths):
        with suppress(GeometryError):
            machines[place] = block.machine(*place)
    designs = dict(zip(machines, DesignSolver(block.judge).designs(list(machines.values()))))
    rows = [_row(designs.get(place)) for place in product(block.rotor_outer_radii, block.back_iron_widths)]
    return np.array(rows).reshape(len(block.rotor_outer_radii), len(block.back_iron_widths), len(VARIABLES))


def _row(design: Design | None) -> list[float]:
    return [nan if design is None else getattr(design, name) for name in VARIABLES]


def blocks_of(case: FamilyCase, grid: SweepGrid, reading: SaturationReading) -> dict[str, SweepBlock]:
    """The tasks of a sweep by name: some rotor radii together, because they share a mesh."""
    blocks = {}
    for combination, outer in grid.sections:
        widths, radii = (tuple(lengths.tolist()) for lengths in (grid.widths(outer), grid.radii(outer)))
        for first in range(0, len(radii), _RADII_TOGETHER):
            some = radii[first : first + _RADII_TOGETHER]
            name = f"{combination.words}, {2 * outer / MILLIMETRE:g} mm, radii from {first}"
            blocks[name] = SweepBlock(case, reading, combination, outer, widths, some)
    return blocks


def _dataset(grid: SweepGrid, blocks: list[np.ndarray]) -> xr.Dataset:
    """The labelled map from the blocks of ``blocks_of``, in their order."""
    outer = np.array(grid.stator_outer_radii)
    shape = len(grid.combinations), len(outer), grid.rotor_radius_steps, grid.back_iron_steps, len(VARIABLES)
    values = np.concatenate(blocks).reshape(shape).swapaxes(2, 3)
    data: dict[str, object] = {name: (_DIMENSIONS, values[..., k]) for k, name in enumerate(VARIABLES)}
    data |= {
        "back_iron_width": (_DIMENSIONS[1:3], np.outer(outer, grid.back_iron)),
        "rotor_outer_radius": ((_DIMENSIONS[1], _DIMENSIONS[3]), np.outer(outer, grid.rotor)),
    }
    shares = {
        "back_iron_fraction": ("back_iron", grid.back_iron),
        "rotor_radius_fraction": ("rotor_radius", grid.rotor),
    }
    counts = {name: ("combination", [getattr(one, name) for one in grid.combinations]) for name in ("slots", "poles")}
    return xr.Dataset(data, {"stator_outer_radius": outer, **counts, **shares})
