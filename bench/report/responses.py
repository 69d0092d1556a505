"""Pages of frequency responses: impedance from a sweep, force over current, angle over force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pandas as pd

from bench.analysis import Analysis, Records, Settings
from bench.errors import RecordError
from bench.frequency_response import FrequencyResponse, frequency_response
from bench.impedance import sweep_impedance, sweep_points
from bench.record import Record
from bench.report import pictures
from bench.report.impedance import impedance_campaign
from figures.report import KeyNumber, KeyNumbers, Picture, Section


def sweep(records: Records, settings: Settings) -> Analysis:
    """Mechanical impedance from one sweep or noise record."""
    record = _only(records)
    found = _inside(sweep_impedance(record, settings.needed("segment", "segment_s=1")), settings)
    analysis = _response_analysis(found, record, "Mechanical impedance from a sweep", "force over velocity", "Ns_per_m")
    has_conditions = {"stroke", "shunt"} <= set(record.channels) and found.is_sure.any()
    return replace(analysis, campaign=impedance_campaign(sweep_points(record, found))) if has_conditions else analysis


def response(records: Records, settings: Settings) -> Analysis:
    """Force over current of the driven machine (active mode), with the output held."""
    record = _only(records)
    found = frequency_response(
        record, record.channel("current"), record.channel("force"), settings.needed("segment", "segment_s=1")
    )
    return _response_analysis(_inside(found, settings), record, "Force over current", "force over current", "N_per_A")


def compliance(records: Records, settings: Settings) -> Analysis:
    """Angle of the rotor over the force at the held output (active mode)."""
    record = _only(records)
    found = frequency_response(
        record, record.channel("force"), record.channel("angle"), settings.needed("segment", "segment_s=1")
    )
    return _response_analysis(_inside(found, settings), record, "Angle over force", "angle over force", "rad_per_N")


def _only(records: Records) -> Record:
    if len(records) != 1:
        raise RecordError(f"expected one record, found {len(records)}; analyse one after the other.")
    return records[0]


def _inside(found: FrequencyResponse, settings: Settings) -> FrequencyResponse:
    return found.between(settings.get("lowest", 0.0), settings.get("highest", float(found.frequency[-1])))


def _response_analysis(found: FrequencyResponse, record: Record, title: str, quantity: str, unit: str) -> Analysis:
    words = unit.replace("_per_", "/")
    table = pd.DataFrame(
        {
            "frequency_Hz": found.frequency,
            f"h1_re_{unit}": found.h1.real,
            f"h1_im_{unit}": found.h1.imag,
            f"h1_band_{unit}": found.radius,
            f"h2_size_{unit}": np.abs(found.h2),
            "coherence": found.coherence,
        }
    )
    peak = int(np.argmax(np.where(found.is_sure, np.abs(found.h1), -1.0)))
    section = Section(
        title,
        (
            f"{record.name}: averaged over {found.averages:.3g} independent segments. H₁ takes the noise to be on the "
            "output, H₂ on the input; the truth lies between them where both are noisy. The band holds with 95 % for "
            "stationary noise, and the phase is drawn where it is narrower than the response; where the coherence "
            "falls with little noise, the device is not linear or the segment is shorter than it rings.",
            KeyNumbers(
                (
                    KeyNumber("largest", float(np.abs(found.h1[peak])), words, f"at {found.frequency[peak]:.4g} Hz"),
                    KeyNumber("smallest coherence", float(found.coherence.min())),
                    KeyNumber("frequencies", len(found.frequency)),
                )
            ),
            Picture(pictures.response(found, f"{quantity} / ({words})"), "Size with its 95 % band, phase, coherence."),
        ),
    )  # fmt: skip
    numbers = {"largest": float(np.abs(found.h1[peak])), "at_Hz": float(found.frequency[peak]), "unit": unit}
    return Analysis(title, (section,), table, numbers)
