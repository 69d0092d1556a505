"""Round enamelled copper wire by the diameters that are sold, with what its enamel adds.

Largest overall diameters of grade 1 and grade 2, IEC 60317-0-1 (2013); nominal diameters are its R 20 series. All 54
numbers are those that OpenMagnetics states for wires of this standard (github.com/OpenMagnetics/MAS, data/wires.ndjson,
up to 0.5 mm of the maker Elektrisola). The build grows with the diameter and falls against it, which the tests hold
every row to.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from materials.errors import MaterialError
from units import MILLIMETRE

GRADES = (1, 2)
_SAME = 1e-9  # relative; a diameter this close to one of the table is that one
# mm: bare, overall grade 1, overall grade 2
_TABLE = (
    (0.100, 0.117, 0.125), (0.112, 0.130, 0.139), (0.125, 0.144, 0.154), (0.140, 0.160, 0.171), (0.160, 0.182, 0.194),
    (0.180, 0.204, 0.217), (0.200, 0.226, 0.239), (0.224, 0.252, 0.266), (0.250, 0.281, 0.297), (0.280, 0.312, 0.329),
    (0.315, 0.349, 0.367), (0.355, 0.392, 0.411), (0.400, 0.439, 0.459), (0.450, 0.491, 0.513), (0.500, 0.544, 0.566),
    (0.560, 0.606, 0.630), (0.630, 0.679, 0.704), (0.710, 0.762, 0.789), (0.800, 0.855, 0.884), (0.900, 0.959, 0.989),
    (1.000, 1.062, 1.094), (1.120, 1.184, 1.217), (1.250, 1.316, 1.349), (1.400, 1.468, 1.502), (1.600, 1.670, 1.706),
    (1.800, 1.872, 1.909), (2.000, 2.074, 2.112),
)  # fmt: skip
DIAMETERS = tuple(bare * MILLIMETRE for bare, _, _ in _TABLE)  # m, of the bare copper, rising


@dataclass(frozen=True)
class Gauge:
    """One size of wire: bare copper and largest overall diameter [m]."""

    copper_diameter: float
    outer_diameter: float


def gauge(copper_diameter: float, grade: int) -> Gauge:
    """The wire of a bare diameter [m] with enamel of a grade, 1 or 2.

    Raises MaterialError for a diameter or a grade that is not in the table.
    """
    if grade not in GRADES:
        raise MaterialError(f"the grade of an enamel is 1 or 2 (IEC 60317-0-1); found {grade}")
    for bare, *overall in _TABLE:
        if abs(copper_diameter / (bare * MILLIMETRE) - 1) < _SAME:
            return Gauge(copper_diameter, overall[grade - 1] * MILLIMETRE)
    near = sorted(DIAMETERS, key=lambda one: abs(one - copper_diameter))[:2]
    sold = " or ".join(f"{one / MILLIMETRE:g}" for one in sorted(near))
    raise MaterialError(
        f"no wire of {copper_diameter / MILLIMETRE:g} mm is in the table of IEC 60317-0-1, 0.1 to 2 mm; take {sold} mm"
    )


def any_gauge(copper_diameter: float, grade: int) -> Gauge:
    """The wire of a bare diameter [m] of a machine that is there, enamel between that of its neighbours in the table.

    Raises MaterialError outside the table.
    """
    overall = tuple(gauge(one, grade).outer_diameter for one in DIAMETERS)
    if not DIAMETERS[0] <= copper_diameter <= DIAMETERS[-1]:
        return gauge(copper_diameter, grade)  # says what there is
    return Gauge(copper_diameter, float(np.interp(copper_diameter, DIAMETERS, overall)))
