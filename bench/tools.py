"""The tools of the bench by name, and what each needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from bench.analysis import Analysis, Records, Settings
from bench.report.constant_speed import constant_speed
from bench.report.impedance import impedance
from bench.report.loops import loops
from bench.report.lumped import lumped, lumped_bridge
from bench.report.quadrants import quadrants
from bench.report.responses import compliance, response, sweep
from bench.report.sound import sound


@dataclass(frozen=True)
class Tool:
    """One way to analyse records.

    run: from records to results; help: one line; channels: that a record must have, in words; values: what may be
    stated with --value, in words
    """

    run: Callable[[Records, Settings], Analysis]
    help: str
    channels: str
    values: str


_MACHINE = "torque_constant_mNm_per_A, phase_resistance_mohm, phase_inductance_uH, pole_pairs, transmission_mm_per_rad"
_OF_SPECTRA = "segment_s, lowest_Hz, highest_Hz"
TOOLS = {
    "constant-speed": Tool(
        constant_speed,
        "damping and efficiency at constant speed over shunts (5.1)",
        "velocity or stroke, force, shunt, and shunt_voltage where the shunt is a resistance",
        "shunt_mohm",
    ),
    "quadrants": Tool(
        quadrants,
        "efficiency in four quadrants from saw-tooth strokes",
        "stroke, force, dc_voltage, dc_current",
        "window_mm",
    ),
    "impedance": Tool(
        impedance, "mechanical impedance from sines, one record a frequency (B.1)", "stroke, force, shunt", "shunt_mohm"
    ),
    "lumped": Tool(
        lumped,
        "mass, friction and mount from sines, shunt in star (B.4)",
        "stroke, force, shunt",
        f"{_MACHINE}, rectifier_mohm",
    ),
    "lumped-bridge": Tool(
        lumped_bridge,
        "the same with the shunt behind a diode bridge",
        "stroke, force, shunt",
        f"{_MACHINE}, diode_drop_V, diode_mohm",
    ),
    "sweep": Tool(
        sweep,
        "mechanical impedance from one sweep",
        "stroke or velocity, force; stroke and shunt for a campaign",
        _OF_SPECTRA,
    ),
    "response": Tool(
        response, "force over current with the output held, with coherence", "current, force", _OF_SPECTRA
    ),
    "compliance": Tool(
        compliance, "angle over force with the output held, with coherence", "angle, force", _OF_SPECTRA
    ),
    "sound": Tool(sound, "A-weighted sound pressure levels (5.3)", "pressure", ""),
    "loops": Tool(
        loops,
        "eight parameters of the actuator from force-displacement loops (table 4.2)",
        "stroke, force, current, and velocity if it was measured",
        "transmission_mm_per_rad, settled_s, noise_N, and nominal values such as equivalent_mass_kg",
    ),
}
