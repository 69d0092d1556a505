"""The tools of the bench by name, and what each needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from bench.analysis import Analysis, Records, Settings
from bench.force_loops import NOMINAL
from bench.report.constant_speed import constant_speed
from bench.report.impedance import impedance
from bench.report.loops import loops
from bench.report.lumped import lumped, lumped_bridge
from bench.report.quadrants import quadrants
from bench.report.responses import compliance, response, sweep
from bench.report.sound import sound
from units import split_unit


@dataclass(frozen=True)
class Tool:
    """One way to analyse records.

    run: from records to results; help: one line; channels: that a record must have, in words
    settings: names with unit that may be stated; constants: names with unit of channels that may be stated instead
    """

    run: Callable[[Records, Settings], Analysis]
    help: str
    channels: str
    settings: tuple[str, ...] = ()
    constants: tuple[str, ...] = ()

    @property
    def values(self) -> dict[str, str]:
        """Unit by quantity of all that may be stated."""
        return dict(split_unit(name) for name in (*self.settings, *self.constants, LEVER))


LEVER = "lever_factor"  # of the bench's lever over the device's
_SHUNT = ("shunt_mohm",)
_MACHINE = (
    "torque_constant_mNm_per_A",
    "phase_resistance_mohm",
    "phase_inductance_uH",
    "pole_pairs",
    "transmission_mm_per_rad",
    "equivalent_mass_kg",
    "viscous_friction_Ns_per_m",
    "mount_stiffness_kN_per_m",
    "mount_damping_Ns_per_m",
)
_OF_SPECTRA = ("segment_s", "lowest_Hz", "highest_Hz")
TOOLS = {
    "constant-speed": Tool(
        constant_speed,
        "damping and efficiency at constant speed over shunts (5.1)",
        "velocity or stroke, force, shunt, and shunt_voltage where the shunt is a resistance",
        constants=_SHUNT,
    ),
    "quadrants": Tool(
        quadrants,
        "efficiency in four quadrants from saw-tooth strokes",
        "stroke, force, dc_voltage, dc_current",
        ("window_mm",),
    ),
    "impedance": Tool(
        impedance,
        "mechanical impedance from sines, one record a frequency (B.1)",
        "stroke, force, shunt",
        constants=_SHUNT,
    ),
    "lumped": Tool(
        lumped,
        "mass, friction and mount from sines, shunt in star (B.4)",
        "stroke, force, shunt",
        (*_MACHINE, "rectifier_mohm"),
        _SHUNT,
    ),
    "lumped-bridge": Tool(
        lumped_bridge,
        "the same with the shunt behind a diode bridge",
        "stroke, force, shunt",
        (*_MACHINE, "diode_drop_V", "diode_mohm"),
        _SHUNT,
    ),
    "sweep": Tool(
        sweep,
        "mechanical impedance from one sweep",
        "stroke or velocity, force; stroke and shunt for a campaign",
        _OF_SPECTRA,
        _SHUNT,
    ),
    "response": Tool(
        response, "force over current with the output held, with coherence", "current, force", _OF_SPECTRA
    ),
    "compliance": Tool(
        compliance, "angle over force with the output held, with coherence", "angle, force", _OF_SPECTRA
    ),
    "sound": Tool(sound, "A-weighted sound pressure levels (5.3)", "pressure"),
    "loops": Tool(
        loops,
        "eight parameters of the actuator from force-displacement loops (table 4.2)",
        "stroke, force, current, and velocity if it was measured",
        ("transmission_mm_per_rad", "settled_s", "noise_N", *NOMINAL),
    ),
}
