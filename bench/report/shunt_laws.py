"""Which static law a shunted damper follows, for people: every law beside the points, and what may be concluded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from bench.analysis import Analysis
from bench.report import pictures
from bench.shunt_damping import JudgedLaw, LeftOut, ShuntDevice, ShuntPoints, each_left_out, judged_laws
from figures.report import Picture, Remark, Section, Table
from units import MILLIOHM

_HEADINGS = {"A_Ns_per_m_ohm": "A / (Ω Ns/m)"}
AGREES = 0.05  # largest error at the points with a resistance of a law that is called right
_UNRESOLVED = 1.35  # measured over predicted damping, either way, of a point that the others do not explain


def shunt_analysis(device: ShuntDevice, points: ShuntPoints) -> Analysis:
    """All laws beside the points; the short circuit decides nothing."""
    laws = judged_laws(device, points)
    left_out = each_left_out(device.friction, points)
    remarks = tuple(_conclusions(laws, left_out))
    table = laws_table(laws)
    section = Section(
        "Damping over the shunt",
        (
            "Every law beside the measured slopes of force over velocity. Where a law has free numbers it is fitted "
            "to the logarithm of the damping, to the points with a resistance unless it says otherwise: whether a "
            "short circuit was one of the machine or of what stands behind its rectifier changes the resistance in "
            "the circuit.",
            *map(Remark, remarks),
            Table(_shown(laws), "Predicted damping with its error, and the rms error of the logarithm."),
            Picture(pictures.law_errors(laws), "Errors of the laws; a mark at the edge lies beyond it."),
            Table(_fitted_numbers(laws), "Numbers that were fitted; A is the square of the force constant.", _HEADINGS),
            Table(_left_out_table(left_out), "Every point predicted from the others by friction + A / (R + shunt)."),
        ),
    )  # fmt: skip
    numbers = {"laws": table.to_dict("records"), "left_out": _left_out_table(left_out).to_dict("records")}
    return Analysis("Static laws of a shunted damper", (section,), table, numbers, remarks=remarks)


def laws_table(laws: Sequence[JudgedLaw]) -> pd.DataFrame:
    """One law a row, numbers only but for its name."""
    return pd.DataFrame([_row(law) for law in laws])


def _row(law: JudgedLaw) -> dict[str, object]:
    shunts = [round(float(r / MILLIOHM), 6) for r in law.points.shunt]
    return {
        "law": law.name,
        **{f"damping_at_{r:g}_mohm_Ns_per_m": float(c) for r, c in zip(shunts, law.predicted)},
        **{f"error_at_{r:g}_mohm_percent": float(100 * e) for r, e in zip(shunts, law.error)},
        "log_rms": law.log_rms(),
        "log_rms_with_a_resistance": law.rms_behind_rectifier,
        "fitted_to": law.fitted_to,
        **law.fitted,
    }


def _shown(laws: Sequence[JudgedLaw]) -> pd.DataFrame:
    """One law a row, every point a column with the error in brackets."""
    return pd.DataFrame(
        [
            {
                "law": law.name,
                **_cells(law),
                "rms, all": law.log_rms(),
                "rms, with a resistance": law.rms_behind_rectifier,
            }
            for law in laws
        ]
    )


def _cells(law: JudgedLaw) -> dict[str, str]:
    cells = zip(law.points.shunt, law.predicted, law.error)
    shown = {f"{pictures.shunt_words(r)} / (kNs/m)": f"{c / 1e3:.2f} ({100 * e:+.0f} %)" for r, c, e in cells}
    return {heading: text.replace("-", "\N{MINUS SIGN}") for heading, text in shown.items()}


def _fitted_numbers(laws: Sequence[JudgedLaw]) -> pd.DataFrame:
    rows = [{"law": law.name, "fitted to": law.fitted_to, **law.fitted} for law in laws if law.fitted]
    return pd.DataFrame(rows)


def _left_out_table(left_out: Sequence[LeftOut]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "shunt_mohm": [one.shunt / MILLIOHM for one in left_out],
            "measured_kNs_per_m": [one.measured / 1e3 for one in left_out],
            "predicted_kNs_per_m": [one.predicted / 1e3 for one in left_out],
            "measured over predicted": [one.ratio for one in left_out],
        }
    )


def _conclusions(laws: Sequence[JudgedLaw], left_out: Sequence[LeftOut]) -> list[str]:
    said = [_agreement(laws)]
    for one in left_out:
        if one.shunt == 0 and not 1 / _UNRESOLVED < one.ratio < _UNRESOLVED:
            said.append(_unresolved(one))
    return said


def _agreement(laws: Sequence[JudgedLaw]) -> str:
    """Which laws without a free number reach the points with a resistance."""
    right = [law for law in laws if not law.fitted and _largest_error(law) <= AGREES]
    points = int(laws[0].points.behind_rectifier.sum())
    if not right:
        best = min((law for law in laws if not law.fitted), key=_largest_error)
        return (
            f"No law without a free number reaches the {points} points with a resistance within {100 * AGREES:g} %; "
            f"the best, “{best.name}”, is {100 * _largest_error(best):.2g} % off."
        )
    names = " and ".join(f"“{law.name}” ({100 * _largest_error(law):.2g} %)" for law in right)
    return f"Within {100 * AGREES:g} % of all {points} points with a resistance, with nothing fitted: {names}."


def _largest_error(law: JudgedLaw) -> float:
    return float(np.max(np.abs(law.error[law.points.behind_rectifier])))


def _unresolved(short: LeftOut) -> str:
    return (
        f"The short circuit is reported and not fitted: {short.measured / 1e3:.4g} kNs/m measured, {short.ratio:.2g} "
        f"times what the other points predict ({short.predicted / 1e3:.3g} kNs/m). A law that reaches it as well was "
        "made for it: the points cannot tell where the short circuit was, whether the resistance is of a phase or "
        "between two, or whether the value is wrong. What settles it: force over velocity of the run, the place of "
        "the short circuit, and the wiring of the resistance measurement."
    )
