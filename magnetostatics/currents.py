"""Operating states with currents of their own in every phase, or in every coil."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geometry.cross_section import CrossSection
from geometry.errors import GeometryError
from magnetostatics.model import FieldModel, OperatingPoint


@dataclass(frozen=True)
class PhaseCurrents:
    """Rotor angle and any three phase currents, balanced or not: a locked rotor, direct current, an open phase.

    angle: mechanical rotor angle, magnet 0 on the x axis at zero [rad]
    currents: of phases A, B, C, positive as in ``WindingLayout`` [A]
    turns: of every coil, in series; with 1 the currents are the ampere-turns of a coil
    """

    angle: float
    currents: tuple[float, float, float]
    turns: float = 1.0

    def ampere_turns(self, section: CrossSection) -> np.ndarray:
        """Of one coil, as designed, of phases A, B, C [A], (3,)."""
        return self.turns * np.array(self.currents)

    def current_load(self, model: FieldModel) -> np.ndarray:
        """Right-hand side [A], (n,)."""
        return self.ampere_turns(model.section) @ model.phase_loads


@dataclass(frozen=True)
class CoilCurrents:
    """Rotor angle and the ampere-turns of every single coil, for example with a current of their own in shorted turns.

    angle: mechanical rotor angle, magnet 0 on the x axis at zero [rad]
    coil_ampere_turns: [A], (coils,), in the order of ``WindingLayout.coils``; positive in +z where the coil goes
    """

    angle: float
    coil_ampere_turns: tuple[float, ...]

    def current_load(self, model: FieldModel) -> np.ndarray:
        """Right-hand side (n,) [A]. Raises GeometryError for a sector, or when the number of coils is another one."""
        coils = len(model.section.layout.coils)
        if model.section.sectors > 1:
            raise GeometryError("currents of single coils need the whole machine: mesh_cross_section(..., whole=True)")
        if len(self.coil_ampere_turns) != coils:
            raise GeometryError(f"the winding has {coils} coils, found the currents of {len(self.coil_ampere_turns)}")
        return np.array(self.coil_ampere_turns) @ model.coil_loads


def coil_currents(point: OperatingPoint | PhaseCurrents, section: CrossSection) -> CoilCurrents:
    """The same currents as in ``point`` (``OperatingPoint`` or ``PhaseCurrents``), coil by coil."""
    phases = point.ampere_turns(section)
    coils = tuple(float(coil.sign * coil.turns * phases[coil.phase]) for coil in section.layout.coils)
    return CoilCurrents(point.angle, coils)
