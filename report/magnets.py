"""What the magnets stand, for people: every state with its margin to the knee, and the worst as a picture."""

from __future__ import annotations

from collections.abc import Iterator
from math import isinf

import pandas as pd

from electrical.magnets_stage import MagnetsOutcome, MagnetState
from electrical.winding_stage import WindingOutcome
from figures.files import File, figure_file, picture_name, table_file
from figures.magnets import magnets_at_worst
from figures.report import Picture, Remark, Section, Table, number_text
from geometry.cross_section import mesh_cross_section
from magnetostatics.case import FieldCase
from units import DEGREE

TABLE, FIGURE = "magnets.csv", "magnets"
_PERCENT = 100.0


def files(found: MagnetsOutcome, case: FieldCase, winding: WindingOutcome) -> Iterator[File]:
    """The states as a table, and the magnets in the worst of them."""
    yield table_file(TABLE, states_table(found))
    machine = winding.wound.machine
    yield figure_file(FIGURE, magnets_at_worst(found, mesh_cross_section(machine, case.layout(machine))))


def section(found: MagnetsOutcome) -> Section:
    """Which states the magnets stand, and by how much."""
    return Section(
        "Demagnetisation",
        (
            _text(found),
            *(Remark(line) for line in remarks(found)),
            Table(
                states_table(found),
                "Peak currents; flux density along the magnetisation; volume beyond the knee at the worst rotor angle "
                f"and anywhere in a turn; margin of what all but {_PERCENT * found.inputs.lost_max:g} % of the volume "
                "exceeds over the knee.",
                headings={"i_d_A": "i_d / A", "i_q_A": "i_q / A", "least_B_T": "smallest B / T"},
                marked=tuple(k for k, state in enumerate(found.states) if state.lost > found.inputs.lost_max),
            ),
            Picture(
                picture_name(FIGURE),
                f"The worst state ({found.worst.name}): flux density along the magnetisation; what lies on the dark "
                "side of the red line is beyond the knee.",
            ),
        ),
    )


def states_table(found: MagnetsOutcome) -> pd.DataFrame:
    """One state a row, in drawing units."""
    return pd.DataFrame([_row(found, state) for state in found.states])


def _row(found: MagnetsOutcome, state: MagnetState) -> dict[str, object]:
    return {
        "state": state.name,
        "i_d_A": state.i_d,
        "i_q_A": state.i_q,
        "worst_angle_deg": state.angle / DEGREE,
        "least_B_T": state.least,
        "lost_at_worst_angle_percent": _PERCENT * state.lost_at_once,
        "lost_in_a_turn_percent": _PERCENT * state.lost,
        "margin_T": found.margin(state),
    }


def _text(found: MagnetsOutcome) -> str:
    grade, inputs, temperature = found.inputs.grade, found.inputs, found.temperature
    return (
        f"Magnets of {grade.name} ({grade.material}) between {number_text(inputs.cold)} and {inputs.hot:g} °C; they "
        f"stand least at {number_text(temperature)} °C, with {grade.remanence_at(temperature):.3f} T of remanence, "
        f"{grade.coercivity_at(temperature) / 1e3:.0f} kA/m of intrinsic coercivity and a knee at "
        f"{number_text(found.knee)} T, a squareness of {grade.knee_share:g} taken. Currents off the d axis count in "
        "both senses; short circuits are those of the cold winding. The first peak starts from the overload current on "
        "the q axis at full speed; without resistance and saturation i_d = \N{MINUS SIGN}(ψ_m + |ψ_0|)/L_d. The field "
        f"holds up to the knee; what is lost beyond is not fed back. {grade.name}: {grade.source}."
    )


def remarks(found: MagnetsOutcome) -> Iterator[str]:
    """What the run says at once: whether the magnets hold, and at which current they go."""
    allowed = f"{_PERCENT * found.inputs.lost_max:g} %"
    which = f"{found.inputs.grade.name} at {number_text(found.temperature)} °C"
    failing = [state for state in found.states if state.lost > found.inputs.lost_max]
    if failing:
        lost = ", ".join(f"{_PERCENT * state.lost:.3g} % ({state.name})" for state in failing)
        yield (
            f"THE MAGNETS FAIL: of the volume of {which} goes beyond the knee and is lost: {lost}; {allowed} are "
            "allowed. Take a grade with more coercivity (materials.magnet_grade), longer magnets "
            "(machine.magnet_length_mm), or less current."
        )
    else:
        yield (
            f"The magnets ({which}) hold: {_PERCENT * found.lost:.3g} % of their volume goes beyond the knee in the "
            f"worst state ({found.worst.name}), {allowed} are allowed."
        )
    yield f"Demagnetising current, against the magnets: {_demagnetising(found, allowed)}."
    if found.inputs.hot > found.inputs.grade.largest_temperature:
        yield (
            f"{found.inputs.hot:g} °C is more than the {found.inputs.grade.largest_temperature:g} °C up to which "
            f"{found.inputs.grade.name} works: its straight laws over temperature do not hold there."
        )
    if not found.peak_in_map:
        yield (
            "The first peak of the short circuit leaves the flux map; beyond it the smallest inductance of the map is "
            "taken, so that the current is an upper estimate."
        )


def _demagnetising(found: MagnetsOutcome, allowed: str) -> str:
    if isinf(found.demagnetising_current):
        return f"none up to {found.largest_current:.4g} A (peak)"
    if found.demagnetising_current == 0:
        return f"none is needed, {allowed} of the volume are beyond the knee without current"
    return f"{found.demagnetising_current:.4g} A (peak), at which {allowed} of the volume go beyond the knee"
