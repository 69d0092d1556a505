"""The winding for people: every pair of turns and wires as a table, and why one was chosen."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from drivetrain.matching import MatchOutcome
from electrical.winding_selection import Winding
from electrical.winding_stage import WindingInputs, WindingOutcome
from figures.files import File, table_file
from figures.report import KeyNumber, KeyNumbers, Section, Table
from units import MILLIMETRE, drawn

TABLE = "windings.csv"
_SHOWN = 6  # turns either side of the chosen winding
_ELECTRICAL = ("current_rms_A", "current_peak_A", "phase_to_phase_resistance_mOhm", "phase_to_phase_inductance_uH",
               "torque_constant_mNm_per_A", "peak_torque_Nm", "base_speed_rpm", "power_at_base_speed_W",
               "maximum_power_W", "speed_at_maximum_power_rpm")  # fmt: skip


def files(found: WindingOutcome) -> Iterator[File]:
    """Every pair that fits, the chosen one marked; the maximum power of those near it."""
    yield table_file(TABLE, windings_table(found))


def section(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> Section:
    """Turns, wires in hand and the length that they need; match: the length that the match had counted on."""
    table = windings_table(found)
    fullest = table[table.fullest & ((table.turns - found.wound.turns).abs() <= _SHOWN)].reset_index(drop=True)
    caption = (
        "For each number of turns the most wires that fit, valued on the flux map; all pairs are in "
        f"{TABLE}. The chosen one is marked; the largest power is given of those near it."
    )
    return Section(
        "Winding",
        (
            _key_numbers(found),
            f"{found.reason} Decision: {length_reason(found, inputs, match)}",
            Table(fullest.drop(columns=["fullest", "chosen"]), caption, marked=tuple(fullest.index[fullest.chosen])),
        ),
    )


def remarks(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> Iterator[str]:
    """What the run says at once: the choice, and the length that it needs."""
    yield found.reason
    yield length_reason(found, inputs, match)


def length_reason(found: WindingOutcome, inputs: WindingInputs, match: MatchOutcome | None) -> str:
    """Why the active length is what it is, and not that of the match."""
    instead = "" if match is None else f" instead of the {match.chosen.active_length / MILLIMETRE:.2f} mm of the match"
    short = "; the longest that is allowed, too short for it" if found.length.short else ""
    return (
        f"{found.length.length / MILLIMETRE:.1f} mm of active length{instead}, set by "
        f"{found.length.set_by.name}{short}. "
        f"The match counts on a packing factor of {inputs.limits.packing_limit:g} and on a ratio that is any number; "
        f"{found.wound.turns} turns of {found.wound.strands} wires fill {found.chosen.packing:.3f}, the teeth give "
        "their own ratio, and the torque is that of the flux map at the best current angle, less "
        f"{100 * found.peak_torque_error / found.peak_torque:.2f} % that the mesh may have put on top."
    )


def windings_table(found: WindingOutcome) -> pd.DataFrame:
    """Every pair that fits in drawing units."""
    near = {(one.turns, one.strands): one for one in found.near}
    rows = [near.get((one.turns, one.strands), one) for one in found.table]
    return pd.DataFrame([winding_row(one, one == found.chosen) for one in rows])


def winding_row(winding: Winding, chosen: bool) -> dict[str, object]:
    """One winding in drawing units."""
    names = {"turns": winding.turns, "strands": winding.strands, "chosen": chosen, "fullest": winding.fullest}
    values = drawn(winding, ("packing", *_ELECTRICAL))
    return names | {name: np.nan if value is None else value for name, value in values.items()}


def _key_numbers(found: WindingOutcome) -> KeyNumbers:
    return KeyNumbers(
        (
            KeyNumber("turns", found.wound.turns, "", f"{found.wound.strands} wires in hand"),
            KeyNumber("active length", round(found.wound.active_length / MILLIMETRE, 1), "mm"),
            KeyNumber(
                "peak torque",
                found.peak_torque,
                "Nm",
                f"± {found.peak_torque_error:.3f} Nm by the mesh, ripple {found.peak_torque_ripple:.2f} Nm",
            ),
            KeyNumber("peak phase current", found.limits.current_peak, "A"),
        )
    )
