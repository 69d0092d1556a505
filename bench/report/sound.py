"""The page of sound pressure levels."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from bench.analysis import Analysis, Records, Settings
from bench.report import pictures
from bench.sound import SoundLevels, sound_levels
from figures.report import Picture, Section, Table


def sound(records: Records, settings: Settings) -> Analysis:
    """A-weighted sound pressure levels."""
    found = [sound_levels(record) for record in records]
    table = _levels_table(found)
    section = Section(
        "Sound pressure levels",
        (
            "A-weighting of IEC 61672-1; the equivalent level is that of the root mean square over the record, the "
            "largest fast level that of the exponential mean over 125 ms.",
            Table(table, "Levels re 20 µPa."),
            Picture(pictures.levels(found), "Fast level over time."),
        ),
    )
    return Analysis("Sound pressure levels", (section,), table, {"levels": table.to_dict("records")})


def _levels_table(found: Sequence[SoundLevels]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "record": [one.record for one in found],
            "equivalent_dBA": [one.equivalent for one in found],
            "largest_fast_dBA": [one.loudest for one in found],
            "unweighted_dB": [one.unweighted for one in found],
        }
    )
