"""The page of four quadrants."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from bench.analysis import Analysis, Records, Settings
from bench.quadrants import Pass, best, passes
from bench.report import pictures
from figures.report import KeyNumber, KeyNumbers, Picture, Section, Table
from units import MILLIMETRE


def quadrants(records: Records, settings: Settings) -> Analysis:
    """Efficiency map of saw-tooth strokes at constant current."""
    window = settings.needed("window", "window_mm=10")
    found = [one for record in records for one in passes(record, window)]
    table = pd.DataFrame(
        {
            "record": [one.record for one in found],
            "velocity_m_per_s": [one.velocity for one in found],
            "force_N": [one.force for one in found],
            "mechanical_power_W": [one.mechanical for one in found],
            "electrical_power_W": [one.electrical for one in found],
            "efficiency_percent": [100 * one.efficiency for one in found],
        }
    )
    section = Section(
        "Efficiency in four quadrants",
        (
            f"Means over the middle {window / MILLIMETRE:g} mm of every pass; power is positive from the suspension "
            "to the battery. Where both ends lose power (crosses) there is no efficiency.",
            KeyNumbers(
                (
                    KeyNumber("passes", len(found)),
                    KeyNumber("best, suspension gives", 100 * best(found, True), "%"),
                    KeyNumber("best, suspension takes", 100 * best(found, False), "%"),
                )
            ),
            Picture(pictures.quadrant_maps(found), "Electrical power (a), efficiency (b), straight between points."),
            Table(_by_record(found), "Mean of the passes of every record and direction."),
        ),
    )  # fmt: skip
    numbers = {"passes": table.to_dict("records")}
    return Analysis("Efficiency in four quadrants", (section,), table, numbers)


def _by_record(found: Sequence[Pass]) -> pd.DataFrame:
    rows: dict[tuple[str, bool], list[Pass]] = {}
    for one in found:
        rows.setdefault((one.record, one.velocity > 0), []).append(one)
    return pd.DataFrame(
        {
            "record": [name for name, _ in rows],
            "velocity_m_per_s": [np.mean([p.velocity for p in row]) for row in rows.values()],
            "force_N": [np.mean([p.force for p in row]) for row in rows.values()],
            "mechanical_W": [np.mean([p.mechanical for p in row]) for row in rows.values()],
            "electrical_W": [np.mean([p.electrical for p in row]) for row in rows.values()],
            "efficiency_percent": [100 * np.mean([p.efficiency for p in row]) for row in rows.values()],
        }
    )
