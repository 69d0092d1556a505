"""The polynomials over the stator radius for people: table, figure and section."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from figures.files import File, figure_file, picture_name, table_file
from figures.fits import fits as fits_figure
from figures.report import Picture, Remark, Section, Table, heading
from geometry.family import Combination
from optimisation.fits import QUANTITIES, CombinationFits, SectionFits
from optimisation.optima import Optima
from optimisation.polynomial_fits import PolynomialFit
from report.sweep import optima_table
from units import FACTORS, MILLIMETRE, written

_UNITS = {"back_iron_width": "mm", "rotor_outer_radius": "mm", "half_slot_area": "mm2"}  # the others are torques
_TORQUE_UNIT = "Nm_per_m"
_ORDER = sorted(QUANTITIES, key=lambda name: not name.startswith("torque"))  # of the table: torques first


def files(fits: SectionFits, optima: Optima) -> Iterator[File]:
    """Coefficients with their quality, and the optima with their curves."""
    table = fits_table(fits)
    yield table_file("fits.csv", table)
    yield figure_file("fits", fits_figure(optima_table(optima), table, _panels(optima)))


def _panels(optima: Optima) -> tuple[tuple[str, str, str], ...]:
    """(column, title, unit) of what was freed."""
    return tuple((one.key, one.words, written(one.unit) or "1") for one in optima.freedom.further)


def section(fits: SectionFits) -> Section:
    """Fits over the stator radius, and which are refused."""
    columns = ["slots", "poles", "quantity", "p2", "p1", "p0", "r_squared", "rms_residual", "largest_residual",
               "held_out"]  # fmt: skip
    table = fits_table(fits)
    shown = table[columns].assign(quantity=table.quantity.map(heading))
    caption = (
        "y = p2 R² + p1 R + p0 with the stator radius R in mm and y in the unit of its name. Held out: root mean "
        "square of what each point is off a curve through all others."
    )
    refused = (Remark(f"{said[:1].upper()}{said[1:]}.") for said in remarks(fits))
    words = "Optima (points) and second-order polynomials (lines) over the stator radius."
    picture = Picture(picture_name("fits"), words)
    return Section(
        "Polynomials over the stator radius", (picture, Table(shown, caption, headings={"r_squared": "R²"}), *refused)
    )


def remarks(fits: SectionFits) -> Iterator[str]:
    """What the run says at once: fits that are refused."""
    for one in fits.each:
        yield from (f"refused: {fit.quantity}: {fit.refused}" for fit in one.every if fit.refused)


def fits_table(fits: SectionFits) -> pd.DataFrame:
    """Coefficients p2, p1, p0 in the unit of the quantity and millimetres of radius, with residuals and range."""
    return pd.DataFrame([_row(one.combination, *named) for one in fits.each for named in _named(one)])


def _named(one: CombinationFits) -> Iterator[tuple[str, str, PolynomialFit]]:
    """(quantity, unit, polynomial): torques first, what was freed last."""
    for quantity in _ORDER:
        yield quantity, _UNITS.get(quantity, _TORQUE_UNIT), one.of(quantity)
    for further in one.further:
        yield further.variable.name, further.variable.unit, further.fit


def _row(combination: Combination, quantity: str, unit: str, fit: PolynomialFit) -> dict[str, object]:
    factor = FACTORS.get(unit, 1.0)
    p2, p1, p0 = (p * MILLIMETRE**power / factor for p, power in zip(fit.powers, (2, 1, 0)))
    return {
        "slots": combination.slots,
        "poles": combination.poles,
        "quantity": f"{quantity}_{unit}" if unit else quantity,
        "p2": p2,
        "p1": p1,
        "p0": p0,
        "r_squared": fit.r_squared,
        "rms_residual": fit.rms_residual / factor,
        "largest_residual": fit.largest_residual / factor,
        "held_out": fit.scatter.held_out / factor,
        "from_mm": fit.x_range[0] / MILLIMETRE,
        "to_mm": fit.x_range[1] / MILLIMETRE,
        "refused": fit.refused or None,
    }
