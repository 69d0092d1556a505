"""The page of a mechanical impedance from sines."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from bench.analysis import Analysis, CampaignTable, Records, Settings
from bench.impedance import ImpedancePoint, sine_impedance
from bench.report import pictures
from figures.report import Picture, Section, Table
from units import MILLIMETRE, MILLIOHM
from workbench.data.table import OPEN_CIRCUIT

_ROUNDING = 1e-4  # relative, of what is never better known


def impedance(records: Records, settings: Settings) -> Analysis:
    """Mechanical impedance from sines, one record a frequency."""
    points = [sine_impedance(record) for record in records]
    frame = _impedance_frame(points)
    table = frame.assign(
        record=[p.record for p in points],
        size_Ns_per_m=[abs(p.impedance) for p in points],
        phase_deg=[np.degrees(np.angle(p.impedance)) for p in points],
        error_Ns_per_m=[p.error for p in points],
        distortion_percent=[100 * p.distortion for p in points],
    )
    section = Section(
        "Mechanical impedance",
        (
            "Fundamental of the force over that of the velocity (thesis eq. B.1): in phase with the velocity it is a "
            "damper, ahead of it an inertia, behind it a spring. Distortion is what the harmonics of the force are, "
            "of its fundamental: none in a linear device.",
            Picture(pictures.impedance_points(points), "Size (a) and phase (b) with two standard deviations."),
            Table(table[["record", "frequency_Hz", "amplitude_mm", "shunt_mohm", "size_Ns_per_m", "phase_deg",
                         "error_Ns_per_m", "distortion_percent"]], "Every record."),
        ),
    )  # fmt: skip
    numbers = {"points": table.to_dict("records")}
    return Analysis("Mechanical impedance", (section,), table, numbers, impedance_campaign(points))


def impedance_campaign(points: Sequence[ImpedancePoint]) -> CampaignTable:
    """The points as a table of a campaign."""
    responses = ("re_Ns_per_m", "im_Ns_per_m")
    return CampaignTable("impedance", _impedance_frame(points), dict.fromkeys(responses, _uncertainty(points)))


def _uncertainty(points: Sequence[ImpedancePoint]) -> str:
    """The noise of a force over the velocity, and what a number in a file is rounded by; in the units of the frame."""
    noise = max(p.error * p.frequency * p.amplitude / MILLIMETRE for p in points)
    return f"{noise:.2g}/(frequency*amplitude) + {_ROUNDING:g}*z"


def _impedance_frame(points: Sequence[ImpedancePoint]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "frequency_Hz": [p.frequency for p in points],
            "amplitude_mm": [p.amplitude / MILLIMETRE for p in points],
            "shunt_mohm": [min(p.shunt, OPEN_CIRCUIT) / MILLIOHM for p in points],
            "re_Ns_per_m": [p.impedance.real for p in points],
            "im_Ns_per_m": [p.impedance.imag for p in points],
        }
    )
