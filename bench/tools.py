"""The tools of the bench: from records to a page, a table and what the workbench takes.

Each tool is one function over records and what is stated beside them; ``TOOLS`` says what a tool needs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from bench import pictures
from bench.analysis import Analysis, CampaignTable, Records, Settings
from bench.constant_speed import SteadyPoint, StraightLine, steady_point, straight_lines
from bench.errors import RecordError
from bench.force_loops import NOMINAL, ForceLoop, LoopMatch, identify_loops
from bench.frequency_response import FrequencyResponse, frequency_response
from bench.identification import Found, Identification
from bench.impedance import ImpedancePoint, sine_impedance, sweep_impedance
from bench.lumped_fit import fit_lumped
from bench.quadrants import Pass, best, passes
from bench.record import Record
from bench.sound import SoundLevels, sound_levels
from electrical.shunted_machine import Bridge, Circuit, Star
from electrical.synchronous_machine import SynchronousMachine
from figures.report import KeyNumber, KeyNumbers, Picture, Remark, Section, Table
from units import FACTORS, MILLIMETRE, MILLIOHM, split_unit
from vehicle.impedance import LumpedActuator
from workbench.data.table import OPEN_CIRCUIT

_MEMORY = 2.0  # readings that say as much as one, from which on the model is called not quite right
_ROUNDING = 1e-4  # relative, of what is never better known
_STRONG = 0.3  # part of a combination of parameters that is named


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


# ---- constant speed ------------------------------------------------------------------------------------------------


def constant_speed(records: Records, settings: Settings) -> Analysis:
    """Damping and conversion efficiency of runs at constant speed over shunts."""
    points = [steady_point(record) for record in records]
    lines = straight_lines(points)
    table = _steady_table(points)
    section = Section(
        "Constant speed over a shunt",
        (
            "One record a point: means of force and velocity, and the power in the shunt over the mechanical power "
            "(thesis eq. 5.1). The lines are polynomials of first degree; their intercept is negative where a "
            "rectifier keeps a voltage to itself, and a slope says nothing about what lies below that.",
            Table(_lines_table(lines), "Straight lines over the points of one shunt."),
            Picture(pictures.steady_points(points, lines), "Force (a) and conversion efficiency (b) over velocity."),
            Table(table, "Every record."),
        ),
    )
    numbers = {"lines": _lines_table(lines).to_dict("records"), "points": table.to_dict("records")}
    return Analysis("Tests at constant speed", (section,), table, numbers, _steady_campaign(points))


def _steady_table(points: Sequence[SteadyPoint]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "record": [p.record for p in points],
            "shunt_mohm": [p.shunt / MILLIOHM for p in points],
            "velocity_m_per_s": [p.velocity for p in points],
            "force_N": [p.force for p in points],
            "force_error_N": [p.force_error for p in points],
            "shunt_power_W": [p.power for p in points],
            "efficiency_percent": [100 * p.efficiency for p in points],
        }
    )


def _lines_table(lines: Sequence[StraightLine]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "shunt_mohm": [line.shunt / MILLIOHM for line in lines],
            "damping_kNs_per_m": [line.damping / 1e3 for line in lines],
            "damping_error_kNs_per_m": [line.damping_error / 1e3 for line in lines],
            "intercept_N": [line.intercept for line in lines],
            "intercept_error_N": [line.intercept_error for line in lines],
            "best_efficiency_percent": [100 * line.best_efficiency for line in lines],
            "most_power_W": [line.most_power for line in lines],
        }
    )


def _steady_campaign(points: Sequence[SteadyPoint]) -> CampaignTable:
    frame = pd.DataFrame(
        {
            "velocity_m_per_s": [p.velocity for p in points],
            "shunt_mohm": [min(p.shunt, OPEN_CIRCUIT) / MILLIOHM for p in points],
            "force_N": [p.force for p in points],
        }
    )
    return CampaignTable("damping_velocity", frame, {"force_N": f"{max(p.force_error for p in points):.2g}"})


# ---- four quadrants ------------------------------------------------------------------------------------------------


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
            f"to the battery. Where both ends lose power (crosses) there is no efficiency.",
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


# ---- impedance -----------------------------------------------------------------------------------------------------


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
            "of its "
            "fundamental: none in a linear device.",
            Picture(pictures.impedance_points(points), "Size (a) and phase (b) with two standard deviations."),
            Table(table[["record", "frequency_Hz", "amplitude_mm", "shunt_mohm", "size_Ns_per_m", "phase_deg",
                         "error_Ns_per_m", "distortion_percent"]], "Every record."),
        ),
    )  # fmt: skip
    campaign = CampaignTable("impedance", frame, dict.fromkeys(("re_Ns_per_m", "im_Ns_per_m"), _uncertainty(points)))
    return Analysis("Mechanical impedance", (section,), table, {"points": table.to_dict("records")}, campaign)


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


def lumped(records: Records, settings: Settings) -> Analysis:
    """Mass, friction and mount from sines, the shunt in star."""
    return _lumped(records, settings, Star(settings.get("rectifier", 0.0)))


def lumped_bridge(records: Records, settings: Settings) -> Analysis:
    """Mass, friction and mount from sines, the shunt behind a diode bridge."""
    return _lumped(records, settings, Bridge(settings.get("diode_drop", 0.0), settings.get("diode", 0.0)))


def _lumped(records: Records, settings: Settings, circuit: Circuit) -> Analysis:
    points = [sine_impedance(record) for record in records]
    device, found = fit_lumped(_stated_actuator(settings, circuit), points)
    table, remarks = _identified_table(found), _identification_remarks(found)
    section = Section(
        "Lumped model",
        (
            "Mass, friction and mount of thesis eq. B.4, fitted to the sizes of all points; the machine is as "
            "stated. Its "
            "electrical pole acts on the electrical speed as well as on the frequency, so the stroke of every point "
            "counts.",
            _weakest(found),
            *map(Remark, remarks),
            Table(table, "Values with their 90 % intervals (thesis table B.1)."),
            Picture(pictures.lumped_model(points, device), "Measured (marks) and lumped model (lines)."),
        ),
    )
    rms = float(np.std(found.residuals[0]))
    numbers = {"parameters": table.to_dict("records"), "log_rms": rms, "natural_frequency_Hz": device.natural_frequency}
    return Analysis("Lumped model of the impedance", (section,), table, numbers, remarks=remarks)


# Where the search begins: thesis table B.1.
_STARTS = {"equivalent_mass": 5.6, "viscous_friction": 250.0, "mount_stiffness": 2e5, "mount_damping": 50.0}


def _stated_actuator(settings: Settings, circuit: Circuit) -> LumpedActuator:
    """Machine and ratio as stated, mass, friction and mount where the search begins."""
    pole_pairs = int(settings.needed("pole_pairs", "pole_pairs=5"))
    psi_m = settings.needed("torque_constant", "torque_constant_mNm_per_A=49.3") / (1.5 * pole_pairs)
    inductance = settings.needed("phase_inductance", "phase_inductance_uH=349")
    resistance = settings.needed("phase_resistance", "phase_resistance_mohm=68.3")
    machine = SynchronousMachine(pole_pairs, psi_m, inductance, inductance, resistance)
    ratio = settings.needed("transmission", "transmission_mm_per_rad=1.317")
    starts = {name: settings.get(name, value) for name, value in _STARTS.items()}
    return LumpedActuator(machine, circuit, ratio, **starts)


def sweep(records: Records, settings: Settings) -> Analysis:
    """Mechanical impedance from one sweep or noise record."""
    record = _only(records)
    found = sweep_impedance(record, settings.needed("segment", "segment_s=1"))
    found = _inside(found, settings)
    return _response_analysis(found, record, "Mechanical impedance from a sweep", "force over velocity", "Ns_per_m")


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
            "falls with little noise, the device is not linear or the segment is "
            "shorter than it rings.",
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


# ---- sound ---------------------------------------------------------------------------------------------------------


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


# ---- identification ------------------------------------------------------------------------------------------------


def loops(records: Records, settings: Settings) -> Analysis:
    """The eight parameters of the actuator's mechanics from force-displacement loops."""
    settled = settings.get("settled", 0.0)
    shown = [_loop(record, settled) for record in records]
    nominal = {name: settings.get(split_unit(name)[0], value) for name, value in NOMINAL.items()}
    ratio = settings.needed("transmission", "transmission_mm_per_rad=1.317")
    found, matches = identify_loops(shown, nominal, ratio, settings.get("noise", 1.0))
    table = _identified_table(found)
    remarks = _identification_remarks(found)
    section = Section(
        "Identified parameters",
        (
            "Nonlinear least squares of all records together (thesis eq. 4.28). Intervals come from what is left "
            "beside the model and hold where the model is right; what is the same in all records, such as the gain "
            "of the load "
            "cell, is not in them.",
            _weakest(found),
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


def _identified_table(found: Identification) -> pd.DataFrame:
    return pd.DataFrame([_identified_row(one) for one in found.found])


def _identified_row(one: Found) -> dict[str, object]:
    quantity, unit = split_unit(one.unknown.name)
    values = [value / FACTORS[unit] for value in (one.unknown.nominal, one.value, *one.interval)]
    return {
        "parameter": quantity.replace("_", " "),
        "unit": unit.replace("_per_", "/"),
        **dict(zip(("nominal", "value", "low90", "high90"), values)),
        "gain": one.gain,
    }


def _identification_remarks(found: Identification) -> tuple[str, ...]:
    lost = [_words(one.unknown.name) for one in found.found if not one.is_identified]
    said = [f"The records do not say the size of: {', '.join(lost)}."] if lost else []
    if found.memory > _MEMORY:
        said.append(
            f"What is left beside the model has a memory: {found.memory:.3g} readings say as much as one independent "
            f"one. "
            "The model is not quite right, and the intervals are widened for the memory, not for what it lacks."
        )
    return tuple(said)


def _weakest(found: Identification) -> str:
    deviation, parts = found.weakest
    strong = " with ".join(_words(name) for name, part in parts.items() if abs(part) > _STRONG)
    return f"What the records say least about is {strong}, known to {100 * deviation:.2g} % (one standard deviation)."


def _words(name: str) -> str:
    return split_unit(name)[0].replace("_", " ")


def _match_table(matches: Sequence[LoopMatch]) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "record": [m.loop.name for m in matches],
            "largest_mismatch_N": [m.largest_mismatch for m in matches],
            "rms_mismatch_N": [m.rms_mismatch for m in matches],
            "energy_error_percent": [100 * m.energy_error for m in matches],
        }
    )


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
    "sweep": Tool(sweep, "mechanical impedance from one sweep", "stroke or velocity, force", _OF_SPECTRA),
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
