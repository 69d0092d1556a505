"""The page of parameters from force-displacement loops."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from bench.analysis import Analysis, Records, Settings
from bench.force_loops import NOMINAL, ForceLoop, LoopMatch, identify_loops
from bench.record import Record
from bench.report import pictures
from bench.report.identified import identification_remarks, identified_table, weakest_words
from figures.report import Picture, Remark, Section, Table
from units import split_unit


def loops(records: Records, settings: Settings) -> Analysis:
    """The eight parameters of the actuator's mechanics from force-displacement loops."""
    settled = settings.get("settled", 0.0)
    shown = [_loop(record, settled) for record in records]
    nominal = {name: settings.get(split_unit(name)[0], value) for name, value in NOMINAL.items()}
    ratio = settings.needed("transmission", "transmission_mm_per_rad=1.317")
    found, matches = identify_loops(shown, nominal, ratio, settings.get("noise", 1.0))
    table = identified_table(found)
    remarks = identification_remarks(found)
    section = Section(
        "Identified parameters",
        (
            "Nonlinear least squares of all records together (thesis eq. 4.28). Intervals come from what is left "
            "beside the model and hold where the model is right; what is the same in all records, such as the gain "
            "of the load cell, is not in them.",
            weakest_words(found),
            *map(Remark, remarks),
            Table(table, "Values with their 90 % intervals; the gain is over the nominal value (thesis eq. 4.29)."),
            Picture(
                pictures.identifiability(found), "How well each parameter is known (a), and which go together (b)."
            ),
            Table(_match_table(matches), "The identified model beside every record (thesis table 4.3)."),
            Picture(pictures.loops(matches), "Force over stroke, measured and identified."),
        ),
    )
    numbers = {"parameters": table.to_dict("records"), "records": _match_table(matches).to_dict("records"),
               "weakest": {"relative_deviation": found.weakest[0], "direction": found.weakest[1]}}  # fmt: skip
    return Analysis("Identification from loops", (section,), table, numbers, remarks=remarks)


def _loop(record: Record, settled: float) -> ForceLoop:
    channels = (record.channel("stroke"), record.velocity(), record.channel("current"), record.channel("force"))
    return ForceLoop(record.name, record.time, *channels, settled)


def _match_table(matches: Sequence[LoopMatch]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "record": [m.loop.name for m in matches],
            "largest_mismatch_N": [m.largest_mismatch for m in matches],
            "rms_mismatch_N": [m.rms_mismatch for m in matches],
            "energy_error_percent": [100 * m.energy_error for m in matches],
        }
    )
