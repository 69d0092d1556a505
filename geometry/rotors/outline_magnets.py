"""A rotor inside its stator with magnets, lamination and magnets cut out of their outlines."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

import numpy as np

from geometry.arrangement import Face, is_inside
from geometry.cut_out_rotor import CutOutRotor
from geometry.errors import GeometryError
from geometry.outline import Curve

_ALONG = 1e-9  # rad, of the axis of a pole


@dataclass(frozen=True)
class OutlineMagnets(CutOutRotor):
    """See ``geometry.cut_out_rotor``; the axis is that of an outward pole, whose halves are mirror images.

    magnets: contours of all magnets of the drawing, in holes of the lamination or on it
    magnetised: direction of each magnet of the half pole behind axis, the one nearest to the shaft first, from the axis
    of the pole on [rad]; a single zero where one magnet lies on the axis
    """

    magnets: tuple[Curve, ...] = field(kw_only=True)
    magnetised: Annotated[tuple[float, ...], "deg"] = field(kw_only=True)
    of_any_sign: ClassVar[frozenset[str]] = frozenset({"axis", "magnetised"})

    @property
    def magnets_per_pitch(self) -> int:
        return 1 if self._on_axis else 2 * len(self.magnetised)

    @property
    def _on_axis(self) -> bool:
        return len(self.magnetised) == 1 and abs(self.magnetised[0]) < _ALONG

    @property
    def drawn(self) -> tuple[Curve, ...]:
        return self.outline + self.magnets

    def is_magnet(self, face: Face) -> bool:
        """Inside of a contour of the magnets."""
        return is_inside([curve.turned(-self.axis) for curve in self.magnets], face.inside)

    def direction(self, position_angle: np.ndarray, axis: float, which: int) -> np.ndarray:
        """As stated [rad], of any shape, that of position_angle: [rad], of any shape; axis: [rad].

        which: those of the clockwise half first
        """
        if self._on_axis:
            return 0.0 * position_angle + axis
        side, one = divmod(which, len(self.magnetised))
        return 0.0 * position_angle + axis + (self.magnetised[one] if side else -self.magnetised[one])

    def check(self) -> None:
        super().check()
        found = [face for name, faces in self.faces().items() for face in faces if name.startswith("magnet")]
        if len(found) != len(self.magnetised):
            raise GeometryError(
                f"half a pole of the outline has {len(found)} magnets and magnetised {len(self.magnetised)} "
                "directions: state one for each, the magnet nearest to the shaft first"
            )
        if self._on_axis != any(face.lies_along(0.0) for face in found):
            raise GeometryError(
                "a magnet on the axis of its pole is the only one of it and magnetised along it, one beside the axis "
                "is not: correct axis or magnetised"
            )
