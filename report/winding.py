"""The winding for people: the best of each gauge and connection, the full slots of the chosen one, and the reason."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np
import pandas as pd

from drivetrain.matching import MatchOutcome
from electrical.final_length import FinalLength
from electrical.winding_selection import Winding
from electrical.winding_stage import WindingInputs, WindingOutcome
from figures.files import File, table_file
from figures.report import KeyNumber, KeyNumbers, Section, Table
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, drawn, percent

TABLE, ALTERNATIVES = "windings.csv", "winding_alternatives.csv"
_SHOWN = 6  # turns either side of the chosen winding
_CURRENT = ("active_length_mm", "packing", "insulated_fill", "current_rms_A")
_ELECTRICAL = ("current_peak_A", "phase_to_phase_resistance_mOhm", "phase_to_phase_inductance_uH",
               "torque_constant_mNm_per_A", "peak_torque_Nm", "base_speed_rpm", "power_at_base_speed_W")  # fmt: skip
_FIELD_WEAKENING = ("maximum_power_W", "speed_at_maximum_power_rpm")
_COMPARED = ("base_speed_rpm", "power_at_base_speed_W")
_DESIGN = ["wire_mm", "connection", "paths"]


def files(found: WindingOutcome) -> Iterator[File]:
    """Every full slot of the chosen kind, with the maximum power of those near the chosen; the best of each kind."""
    yield table_file(TABLE, windings_table(found))
    yield table_file(ALTERNATIVES, alternatives_table(found))


def section(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> Section:
    """What is wound, of what it was chosen, and the length; match: the length that the match had counted on."""
    alternatives = alternatives_table(found)
    chosen = tuple(k for k, one in enumerate(found.alternatives) if one.winding.design == found.chosen.design)
    near = _near_table(found)
    return Section(
        "Winding",
        (
            _key_numbers(found),
            " ".join((found.reason, f"Decision: {length_reason(found, inputs, match)}", *_left_out(found))),
            Table(alternatives.drop(columns=["insulated_fill"]), _alternatives_caption(inputs), marked=chosen),
            Table(
                near.drop(columns=[*_DESIGN, "chosen"]),
                f"{_kind(found.chosen)}: for each number of turns the most wires that fit, at the length they "
                f"need, valued on the flux map; all numbers of turns are in {TABLE}. The chosen one is marked; the "
                "largest power is given of those near it. Resistances are those at "
                "winding_selection.winding_temperature_degC, on the data sheet at the temperatures that it states.",
                marked=tuple(near.index[near.chosen]),
            ),
        ),
    )


def remarks(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> Iterator[str]:
    """What the run says at once: the choice, and the length that it needs."""
    yield found.reason
    yield length_reason(found, inputs, match)
    yield from _left_out(found)


def length_reason(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> str:
    """Why the active length is what it is, and not that of the match."""
    instead = "" if match is None else f" instead of the {match.chosen.active_length / MILLIMETRE:.2f} mm of the match"
    short = "; the longest that is allowed, too short for it" if found.length.short else ""
    return (
        f"{found.length.length / MILLIMETRE:.1f} mm of active length{instead}, set by "
        f"{found.length.set_by.name}{short}. {' '.join(_others(found.length))} "
        f"The match counts on a packing factor of {inputs.limits.packing_limit:g}, on "
        f"{inputs.nominal_density / AMPERE_PER_SQUARE_MILLIMETRE:g} A/mm² for good and on a ratio that is any number; "
        f"this winding fills {found.chosen.packing:.3f}, the temperatures decide for good, the teeth give "
        "their own ratio, and the torque is that of the flux map at the best current angle, less "
        f"{100 * found.peak_torque_error / found.peak_torque:.2f} % that the mesh may have put on top."
    )


def _others(length: FinalLength) -> Iterator[str]:
    """What the needs ask for that do not set the length."""
    for one in length.needs:
        if one.length == inf:
            yield f"No length gives {one.name}."
        elif one != length.set_by:
            yield f"{one.name.capitalize()} asks for {one.length / MILLIMETRE:.1f} mm."


def windings_table(found: WindingOutcome) -> pd.DataFrame:
    """Every full slot of the chosen gauge and connection in drawing units."""
    near = {one.design: one for one in found.near}
    rows = [near.get(one.design, one) for one in found.table]
    return pd.DataFrame([winding_row(one, one.design == found.chosen.design) for one in rows])


def winding_row(winding: Winding, chosen: bool) -> dict[str, object]:
    """One winding in drawing units."""
    values = drawn(winding, (*_CURRENT, *_ELECTRICAL, *_FIELD_WEAKENING))
    row = {name: np.nan if value is None else value for name, value in values.items()}
    return {**design_row(winding), "chosen": chosen, **row, "circulating_share": winding.circulating_share}


def alternatives_table(found: WindingOutcome) -> pd.DataFrame:
    """The best of each gauge and connection, and what was said of it."""
    return pd.DataFrame([
        {**design_row(one.winding), **drawn(one.winding, (*_CURRENT, *_COMPARED)), "verdict": one.verdict}
        for one in found.alternatives
    ])  # fmt: skip


def design_row(winding: Winding) -> dict[str, object]:
    """Gauge, connection, turns and wires in hand."""
    design = winding.design
    connection = {"connection": design.connection.closing.name, "paths": design.connection.paths}
    wire = {"wire_mm": design.wire.copper_diameter / MILLIMETRE}
    return {**wire, **connection, "turns": design.turns, "strands": design.strands}


def _near_table(found: WindingOutcome) -> pd.DataFrame:
    """Some turns either side of the chosen ones."""
    table = windings_table(found)
    return table[(table.turns - found.chosen.turns).abs() <= _SHOWN].reset_index(drop=True)


def _kind(winding: Winding) -> str:
    design = winding.design
    return f"{design.wire.copper_diameter / MILLIMETRE:g} mm wire, {design.connection}"


def _alternatives_caption(inputs: WindingInputs) -> str:
    limits = inputs.limits
    return (
        "What would be wound of each gauge and connection, and why it was chosen or not; the wires with their enamel "
        f"may fill {limits.insulated_fill:g} of a coil side, and the current round a delta may lose "
        f"{percent(limits.circulating_share)} of the copper loss, at the nominal current density and the base speed "
        f"that is asked for. In {ALTERNATIVES} too."
    )


def _left_out(found: WindingOutcome) -> Iterator[str]:
    """Numbers of parallel paths that the study allows in vain."""
    if found.left_out:
        numbers = " and ".join(str(one) for one in found.left_out)
        yield f"Paths by the number of {numbers} would not be equal by the star of slots and were left out."


def _key_numbers(found: WindingOutcome) -> KeyNumbers:
    return KeyNumbers(
        (
            KeyNumber("turns", found.chosen.turns, "", str(found.chosen.design)),
            KeyNumber("active length", round(found.wound.active_length / MILLIMETRE, 1), "mm"),
            KeyNumber(
                "peak torque",
                found.peak_torque,
                "Nm",
                f"± {found.peak_torque_error:.3f} Nm by the mesh, ripple {found.peak_torque_ripple:.2f} Nm",
            ),
            KeyNumber("peak line current", found.limits.current_peak, "A"),
        )
    )
