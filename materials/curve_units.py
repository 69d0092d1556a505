"""Is a magnetisation curve stated in other units than its columns say? Two numbers of it give that away.

The polarisation at saturation belongs to the alloy, and so does the largest permeability; both are known for every soft
magnetic material within narrow bounds, while the usual slips of unit are factors of 80 to 10 000. One slip is not seen:
fields in oersted of a steel whose relative permeability never exceeds some 2500, such as cast steel; they look like
A/m of a grain-oriented sheet.
"""

from __future__ import annotations

from collections.abc import Sequence

from units import FACTORS, MU_0

# Soft ferrites saturate from 0.3 T (makers' data), iron-cobalt at 2.45 T (Bozorth, Ferromagnetism, 1951).
_POLARISATIONS = 0.2, 2.5  # T
# Above 1.2 T saturate irons, silicon irons and their kin. Among these grain-oriented sheet has the largest relative
# permeability, some 1e5 (Bozorth); pressed iron powder the smallest, from 50 up (makers' data).
_STRONG = 1.2  # T
_PERMEABILITIES = 20.0, 2e5
_FLUX_UNITS = {"mT": FACTORS["mT"], "gauss": FACTORS["G"], "kilogauss": FACTORS["kG"]}  # T


def wrong_unit(fields: Sequence[float], fluxes: Sequence[float]) -> str | None:
    """What is said about a curve whose column looks wrong, None where both look right.

    fields: H as stated, [A/m] by its column; fluxes: B as stated, [T] by its column; both (n,), rising, from zero
    """
    points = [(h, b) for h, b in zip(fields, fluxes) if h > 0 and b > 0]
    if not points:
        return None
    polarisation = max(b - MU_0 * h for h, b in points)
    lowest, highest = _POLARISATIONS
    if polarisation > highest:
        return _flux_too_large(points, polarisation)
    if max(b for _, b in points) < lowest:
        return (
            f"column B_T looks wrong: it ends at {points[-1][1]:g} T, below {lowest:g} T, where every soft magnetic "
            "material goes further; give B in tesla up to saturation"
        )
    return _field_wrong(points, polarisation)


def _flux_too_large(points: list[tuple[float, float]], polarisation: float) -> str | None:
    """The unit in which the largest flux density would be that of a metal: 1 to 2.5 T."""
    likely = [unit for unit, factor in _FLUX_UNITS.items() if 1.0 <= polarisation * factor <= _POLARISATIONS[1]]
    if not likely:
        return None
    return (
        f"column B_T looks wrong: a polarisation of {polarisation:.4g} T is more than any material has "
        f"({_POLARISATIONS[1]:g} T), it looks like {likely[0]}; give B in tesla"
    )


def _field_wrong(points: list[tuple[float, float]], polarisation: float) -> str | None:
    """A strong material that is magnetised far too easily, or hardly at all."""
    permeability = max(b / h for h, b in points) / MU_0
    hard, easy = _PERMEABILITIES
    if polarisation > _STRONG and permeability > easy:
        return (
            f"column H_A_per_m looks wrong: a relative permeability of {permeability:.2g} is more than any steel has "
            f"({easy:.0e}), the fields look like kA/m, A/cm or oersted; give H in A/m"
        )
    if permeability < hard:
        return (
            f"column H_A_per_m looks wrong: a relative permeability of {permeability:.2g} at most is less than any "
            f"magnetic core has ({hard:g}), the fields look like mA/m, or the columns are exchanged; give H in A/m"
        )
    return None
