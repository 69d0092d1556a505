"""Which tolerance to buy: what each one does to torque, losses and cogging, for people."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

import numpy as np
import pandas as pd

from drivetrain.output import amount, in_unit
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Remark, Section, Table
from figures.tolerances import SHOWN, cogging_of_many, tolerance_bars
from uncertainty.deviations import Deviation, MagnetScatter
from uncertainty.scatter import peak_to_peak
from uncertainty.tolerance_stage import Sensitivity, ToleranceOutcome
from uncertainty.wound_slopes import QUANTITIES
from units import DEGREE, MILLIMETRE, RPM, written

TABLE, BARS, COGGING = "tolerances.csv", "tolerances", "cogging_of_many"
_PERCENT = 100.0
_METHOD = (
    "Each tolerance of ± a is taken as uniform, so that its standard uncertainty is a/√3 (GUM, type B). Changes are "
    "first derivatives of the field solution on a moved mesh, at the phase currents as they are; the copper loss is "
    "that of the same torque. The air gap is what bore and rotor leave, and a thicker magnet narrows it. A tolerance "
    "of half the width has a quarter of the variance. The iron loss by the stacking factor is that of the flux "
    "density alone."
)
_TOUCHING = (
    "The magnets are drawn to touch, so that they can only be narrower: their arc lies between the drawn one and one "
    "narrower by twice its half width, and its derivative is that of a machine in the middle."
)
_NOT_COVERED = (
    "Slots and teeth that differ from each other, a tilted rotor, parts that are oval and magnets that differ in "
    "thickness are not covered."
)


def files(found: ToleranceOutcome) -> Iterator[File]:
    """Every tolerance with what it does to every quantity, and the figures."""
    yield table_file(TABLE, whole_table(found))
    yield figure_file(BARS, tolerance_bars(found, by_share(found)))
    yield figure_file(COGGING, cogging_of_many(found))


def section(found: ToleranceOutcome) -> Section:
    """The table that says where money buys certainty, and the cogging of machines that are not all alike."""
    return Section(
        "Which tolerance to buy",
        (
            *(Remark(line) for line in remarks(found)),
            Table(tolerance_table(found), _caption(found)),
            Picture(
                picture_name(BARS),
                "Relative change by each tolerance, by its largest share of a variance: at its end, and its standard "
                "uncertainty. Axes differ.",
            ),
            _METHOD,
            *((_TOUCHING,) if _touching(found) else ()),
            _scatter_text(found),
            Table(scatter_table(found), "Cogging from peak to peak on the mesh of the sweep, and its new orders."),
            Picture(
                picture_name(COGGING),
                "Cogging of machines drawn by lot within the scatter of their magnets, and amplitudes of the orders "
                "that the machine as drawn does not have.",
            ),
            _NOT_COVERED,
        ),
    )


def remarks(found: ToleranceOutcome) -> Iterator[str]:
    """What the run says at once: the tolerance to buy, and what magnets that differ do."""
    first = by_share(found)[0]
    name = max(_spoken_of(found), key=lambda one: found.variance_share(first, one))
    rest = ", ".join(
        f"{SHOWN[one]} {_PERCENT * found.standard(one):.2g} % by all, most of it by the "
        f"{found.worst_first(one)[0].deviation.name}"
        for one in _spoken_of(found)
    )
    yield (
        f"The tolerance to buy first is that of the {first.deviation.name}: {half_width(first.deviation)} make "
        f"{_PERCENT * found.variance_share(first, name):.0f} % of the variance of the {SHOWN[name]}. Standard "
        f"uncertainties: {rest}."
    )
    machines, drawn = found.scatter.machines(found.tolerances.scatter), float(peak_to_peak(found.scatter.drawn))
    alone = {words: found.scatter.machines(one).mean() / drawn - 1 for words, one in _scatters(found).items()}
    worse = max(alone, key=lambda words: alone[words])
    yield (
        f"Magnets that differ from each other raise the cogging by {_PERCENT * (machines.mean() / drawn - 1):.0f} % in "
        f"the mean of many machines, {_PERCENT * (np.percentile(machines, 95) / drawn - 1):.0f} % in one of twenty; "
        f"most of it by {worse}."
    )


def by_share(found: ToleranceOutcome) -> tuple[Sensitivity, ...]:
    """By the largest share that a tolerance has in the variance of torque, losses or cogging."""
    return tuple(sorted(found.sensitivities, key=lambda one: -_largest_share(found, one)))


def tolerance_table(found: ToleranceOutcome) -> pd.DataFrame:
    """One tolerance a row, by ``by_share``, then all of them together."""
    rows = [_row(found, one) for one in by_share(found)]
    together: dict[str, object] = {"tolerance": "all", "half width": "", "largest_share_percent": np.nan}
    for name in _spoken_of(found):
        together[f"{name}_standard_percent"] = _PERCENT * found.standard(name)
        together[f"{name}_worst_percent"] = _PERCENT * found.worst(name)
    return pd.DataFrame([*rows, together])


def whole_table(found: ToleranceOutcome) -> pd.DataFrame:
    """One tolerance a row with every quantity: standard uncertainty with the sign of the derivative, and the most."""
    return pd.DataFrame([_whole_row(one) for one in by_share(found)])


def scatter_table(found: ToleranceOutcome) -> pd.DataFrame:
    """One way of not being as drawn a row."""
    scatter = found.scatter
    rows: list[tuple[str, np.ndarray, dict[int, float]]] = [("as drawn", peak_to_peak(scatter.drawn[None]), {})]
    both = {**_scatters(found), "both": found.tolerances.scatter}
    rows += [(words, scatter.machines(one), scatter.orders_of_magnets(one)) for words, one in both.items()]
    shift = f"off centre by {amount(scatter.eccentricity, 'mm')}"
    rows += [
        (f"stator {shift}", peak_to_peak(scatter.static[None]), scatter.orders_of_static),
        (f"rotor {shift}", peak_to_peak(scatter.dynamic[None]), scatter.orders_of_dynamic),
    ]
    return pd.DataFrame([_scatter_row(*one) for one in rows])


def half_width(deviation: Deviation) -> str:
    """``± 0.05 mm``, unbroken."""
    return f"± {amount(deviation.half_width, deviation.unit)}".replace(" ", "\N{NO-BREAK SPACE}")


def _scatter_row(words: str, cogging: np.ndarray, orders: dict[int, float]) -> dict[str, object]:
    largest = list(orders.items())[:4]
    return {
        "magnets and rotor": words,
        "cogging_mean_Nm_per_m": float(cogging.mean()),
        "cogging_of_19_in_20_below_Nm_per_m": float(np.percentile(cogging, 95)),
        "largest new orders / (Nm/m)": ", ".join(f"{order}: {size:.2g}" for order, size in largest),
    }


def _row(found: ToleranceOutcome, one: Sensitivity) -> dict[str, object]:
    row: dict[str, object] = {
        "tolerance": one.deviation.name,
        "half width": half_width(one.deviation),
        "largest_share_percent": _PERCENT * _largest_share(found, one),
    }
    for name in _spoken_of(found):
        row[f"{name}_standard_percent"] = _PERCENT * abs(one.standard(name))
        row[f"{name}_worst_percent"] = _PERCENT * one.worst(name)
    return row


def _whole_row(one: Sensitivity) -> dict[str, object]:
    deviation = one.deviation
    row: dict[str, object] = {
        "tolerance": deviation.name,
        "half_width": in_unit(deviation.half_width, deviation.unit),
        "unit": written(deviation.unit),
    }
    for name in QUANTITIES:
        row[f"{name}_standard_percent"] = _PERCENT * one.standard(name)
        row[f"{name}_worst_percent"] = _PERCENT * one.worst(name)
    return row


def _largest_share(found: ToleranceOutcome, one: Sensitivity) -> float:
    return max(found.variance_share(one, name) for name in _spoken_of(found))


def _spoken_of(found: ToleranceOutcome) -> list[str]:
    """Quantities of the table; the iron loss where it is known."""
    return [name for name in SHOWN if isfinite(getattr(found.values, name))]


def _caption(found: ToleranceOutcome) -> str:
    return (
        "Relative changes by each tolerance: standard uncertainty, and at its end. The last row adds the first as "
        "independent and the second as they come. Largest share: of the variance of one of these quantities. Iron loss "
        f"at the continuous torque and {found.rated_speed / RPM:.0f} rpm. All quantities are in {TABLE}."
    )


def _scatters(found: ToleranceOutcome) -> dict[str, MagnetScatter]:
    """Each kind of difference between magnets alone, in words."""
    both, radius = found.tolerances.scatter, found.scatter.machine.rotor_core_radius
    place = f"their place, ± {both.position * radius / MILLIMETRE:.2g} mm or {both.position / DEGREE:.2g}°"
    return {
        f"their remanence, ± {both.remanence:.2g} T": MagnetScatter(both.remanence, 0.0),
        place: MagnetScatter(0.0, both.position),
    }


def _scatter_text(found: ToleranceOutcome) -> str:
    machine = found.scatter.machine
    return (
        f"All of these keep the symmetry of {machine.slots} slots and {machine.poles} poles. Magnets that differ do "
        f"not: each adds orders of {machine.slots} and its multiples to the cogging. Their waveforms are solved to "
        f"first order and {len(found.scatter.machines(found.tolerances.scatter))} machines drawn from them by lot. "
        "Eccentricities are solved at their size."
    )


def _touching(found: ToleranceOutcome) -> bool:
    return found.scatter.machine.magnet_arc_fraction >= 1
