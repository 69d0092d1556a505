"""The draft of a bench campaign of a designed machine: ``[device]`` from the design, tables to be filled in by a lab.

What is drafted is what the design counts on: the magnets' remanence as the study states it, solid steel (the stacking
factor of a study counts in masses only), no end leakage. What differs on the bench is for the bench to say.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from drivetrain.outcome import Outcome
from electrical.flux_map_machine import FluxMapMachine
from electrical.winding_connection import SERIES_STAR
from electrical.winding_stage import WindingOutcome
from gearbox.stage import GearboxOutcome
from geometry.magnetisation import PATTERNS
from magnetostatics.flux_map_stage import FluxMap
from materials.conductor import Conductor
from study.errors import StudyError
from study.inputs_drive import friction_at
from study.inputs_electrical import winding_resistivity
from study.magnet_choice import design_magnet
from study.schema import Study
from units import DEGREE, MILLIMETRE, RPM
from vehicle.designed import driven_parts
from workbench.data.column_units import factor, split_unit
from workbench.models.actuator.design import OnBench, written

REFERENCE = 20.0  # degC, at which resistances are given
REPEATS = 2
DIGITS = 6  # of numbers in a draft
_SPEEDS = 8
_CURRENT_STEPS = 6
_FINE, _COARSE = 1.5 * DEGREE, 6.0 * DEGREE  # between readings of cogging and of voltage; between loaded positions

Columns = Mapping[str, np.ndarray]


@dataclass(frozen=True, eq=False)
class Designed:
    """A design as its stages left it; gears: None for a direct drive"""

    study: Study
    winding: WindingOutcome
    flux_map: FluxMap
    outcome: Outcome
    gears: GearboxOutcome | None

    @property
    def machine(self) -> FluxMapMachine:
        """The wound machine on its flux map."""
        return self.winding.wound.on_map(self.flux_map.data)

    @property
    def resistance(self) -> float:
        """Of a phase at ``REFERENCE`` [ohm]."""
        materials = self.study.materials.si
        copper = Conductor(
            materials.copper_resistivity,
            materials.copper_temperature_coefficient,
            materials.copper_reference_temperature,
        )
        return (
            self.winding.wound.phase_resistance * float(copper.resistivity(REFERENCE)) / winding_resistivity(self.study)
        )

    @property
    def continuous_current(self) -> float:
        """Peak phase current at the nominal current density [A]."""
        return self.winding.wound.current_peak(self.study.sweep.si.j_nominal_rms)

    @property
    def is_shaft(self) -> bool:
        """Whether the output is a shaft and not a wheel."""
        return self.study.drive is not None


@dataclass(frozen=True)
class Entry:
    """A key of a section with its value as TOML writes it, and why."""

    key: str
    value: str
    why: str = ""

    @property
    def line(self) -> str:
        """Of the file."""
        return f"{self.key} = {self.value}" + (f"  # {self.why}" if self.why else "")


@dataclass(frozen=True, eq=False)
class TableDraft:
    """A table to be measured.

    conditions: headings -> values in the units of the headings (n,);  responses: heading -> standard uncertainty of a
    reading, in its unit
    """

    name: str
    kind: str
    conditions: Columns
    responses: Mapping[str, float]

    @property
    def text(self) -> str:
        """Of the CSV file: operating points, responses empty."""
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(["repeat", *self.conditions, *self.responses])
        rows = list(zip(*self.conditions.values(), strict=True))
        for repeat in range(REPEATS):
            writer.writerows(
                [repeat, *(f"{value:.{DIGITS}g}" for value in row), *[""] * len(self.responses)] for row in rows
            )
        return out.getvalue()

    @property
    def entry(self) -> str:
        """Of the campaign file."""
        random = ", ".join(f"{name} = {size:.2g}" for name, size in self.responses.items())
        return f'[[table]]\nfile = "{self.name}.csv"\nkind = "{self.kind}"\nu_random = {{ {random} }}\n'


@dataclass(frozen=True, eq=False)
class Draft:
    """A whole campaign before it is measured."""

    device: tuple[Entry, ...]
    tolerances: tuple[Entry, ...]
    systematics: tuple[Entry, ...]
    tables: tuple[TableDraft, ...] = field(default=())

    def text(self, name: str, source: str) -> str:
        """Of ``campaign.toml``; name: of the campaign; source: the design that it is of."""
        head = (
            f"# Draft of a bench campaign of {source}.\n"
            "# The operating points stand in the CSV files, the readings are to be filled in. Correct every tolerance\n"
            "# and uncertainty that your workshop and bench know better.\n"
            f'[campaign]\nid = "{name}"\nrepeats = {REPEATS}\nholdout = {{ rule = "last repeat of every table" }}\n'
        )
        parts = (("device", self.device), ("tolerance", self.tolerances), ("systematic", self.systematics))
        sections = [f"[{title}]\n" + "".join(f"{entry.line}\n" for entry in entries) for title, entries in parts]
        return "\n".join([head, *sections, *(table.entry for table in self.tables)])


class Bench:
    """On which bench the design is to be measured; one for each base model of the workbench."""

    name: str

    def draft(self, designed: Designed) -> Draft:
        """The campaign of a design. Raises StudyError where this bench cannot hold it."""
        raise NotImplementedError


class MachineBench(Bench):
    """The cross-section with its winding, answered by the field solution."""

    name = "machine"

    def draft(self, designed: Designed) -> Draft:
        wound = designed.winding.wound
        tooth_coils = wound.coil_pitch == 1 and 3 * wound.coils_in_series == wound.dimensions.slots
        if not tooth_coils or wound.design.connection != SERIES_STAR:
            raise StudyError(
                "the machine bench knows a coil on every tooth, all of a phase in series and in star; this is "
                f"{wound.design}: use --dq."
            )
        tolerances = (
            _tolerance("remanence", "sigma_rel = 0.01", "supplier's certificate, +-2 %"),
            _tolerance("airgap_mm", "sigma = 0.02", "ground rotor and bore, +-0.04 mm"),
            _tolerance("active_length_mm", "sigma = 0.1", "stack of sheets, +-0.2 mm"),
            _tolerance("phase_resistance", "sigma_rel = 0.01", "diameter of the wire and length of the end turns"),
        )
        systematics = (*_GAINS, _offset("torque_offset_Nm", 0.001 * designed.winding.peak_torque), _ENCODER)
        return Draft(_machine_device(designed), tolerances, systematics, _machine_tables(designed))


class DqBench(Bench):
    """The machine at its terminals and its shaft, answered by constant parameters of its flux map."""

    name = "dq"

    def draft(self, designed: Designed) -> Draft:
        p = designed.machine.constant_parameters(designed.continuous_current)
        device = (
            Entry("model", '"dq"'),
            Entry("pole_pairs", str(p.pole_pairs)),
            _number("psi_m_mVs", float(p.psi_m) / 1e-3, "flux map without current"),
            _number("inductance_d_uH", float(p.inductance_d) / 1e-6, "flux map at the continuous current"),
            _number("inductance_q_uH", float(p.inductance_q) / 1e-6, "flux map at the continuous current"),
            _number("resistance_mohm", designed.resistance / 1e-3, "of one phase"),
            _number("reference_T_degC", REFERENCE, "at which the resistance holds"),
            _number("copper_coefficient_per_K", designed.study.materials.copper_temperature_coefficient_per_K, "study"),
        )
        tolerances = (
            _tolerance("psi_m_mVs", "sigma_rel = 0.015", "remanence +-2 %, air gap +-0.04 mm"),
            _tolerance("inductance_d", "sigma_rel = 0.05", "air gap, end turns, saturation"),
            _tolerance("inductance_q", "sigma_rel = 0.05", "air gap, end turns, saturation"),
            _tolerance("resistance", "sigma_rel = 0.02", "diameter of the wire and length of the end turns"),
        )
        return Draft(device, tolerances, _GAINS, _dq_tables(designed))


class ActuatorBench(Bench):
    """Machine, gears and linkage together, measured at the wheel or at the output shaft."""

    name = "actuator"

    def draft(self, designed: Designed) -> Draft:
        tolerances = (
            _tolerance("psi_m_mVs", "sigma_rel = 0.015", "remanence +-2 %, air gap +-0.04 mm"),
            _tolerance("phase_resistance", "sigma_rel = 0.02", "diameter of the wire and length of the end turns"),
            _tolerance("inductance", "sigma_rel = 0.1", "air gap, end turns, saturation"),
            _tolerance("saturation", "sigma_rel = 0.2", "a parabola in the place of the flux map"),
            _tolerance("equivalent_mass", "sigma_rel = 0.03", "drawn parts, bearings not counted"),
            *(() if designed.gears is None else (
                _tolerance("efficiency_driven", "sigma_rel = 0.01", "friction coefficient of the meshes, +-30 %"),
                _tolerance("efficiency_driving", "sigma_rel = 0.01", "friction coefficient of the meshes, +-30 %"),
            )),
            *(_tolerance(key, "sigma_rel = 0.3", "seals and grease scatter") for key in _friction_keys(designed)),
        )  # fmt: skip
        effort = "torque" if designed.is_shaft else "force"
        gains = tuple(Entry(f"{name}_gain", _GAIN) for name in (effort, "voltage", "current"))
        return Draft(_actuator_device(designed), tolerances, gains, _actuator_tables(designed))


BENCHES: Mapping[str, Bench] = {bench.name: bench for bench in (MachineBench(), DqBench(), ActuatorBench())}


# ---- entries --------------------------------------------------------------------------------------------------------


def _number(key: str, value: float, why: str = "") -> Entry:
    return Entry(key, f"{value:.{DIGITS + 1}g}", why)


def _tolerance(key: str, sigma: str, source: str) -> Entry:
    return Entry(key, f'{{ {sigma}, source = "{source}" }}')


def _offset(key: str, sigma: float) -> Entry:
    return Entry(key, f'{{ sigma = {sigma:.2g}, kind = "offset" }}')


_GAIN = '{ sigma = 0.003, kind = "gain" }'
_GAINS = tuple(Entry(f"{name}_gain", _GAIN) for name in ("voltage", "torque", "current"))
_ENCODER = Entry("encoder_zero_deg", '{ sigma = 0.25, kind = "offset" }')


# ---- devices --------------------------------------------------------------------------------------------------------

_DIMENSIONS = (
    "stator_outer_radius", "rotor_outer_radius", "back_iron_width", "tooth_width", "magnet_length", "airgap",
    "slot_opening", "shoe_d1", "shoe_d2", "shaft_radius",
)  # fmt: skip


def _machine_device(designed: Designed) -> tuple[Entry, ...]:
    wound, magnet = designed.winding.wound, design_magnet(designed.study)
    machine = wound.dimensions
    pattern = next(name for name, one in PATTERNS.items() if one == machine.magnetisation)
    return (
        Entry("model", '"machine"'),
        Entry("slots", str(machine.slots)),
        Entry("poles", str(machine.poles)),
        *(_number(f"{name}_mm", getattr(machine, name) / MILLIMETRE) for name in _DIMENSIONS),
        _number("magnet_arc_fraction", machine.magnet_arc_fraction),
        Entry("magnetisation", f'"{pattern}"'),
        _number("remanence_T", magnet.remanence, "as the study counts on, at the magnets' working temperature"),
        _number("recoil_permeability", magnet.recoil_permeability),
        Entry("steel", f'"{designed.study.materials.steel}"'),
        _number("stacking_factor", 1.0, "the field of the design counts on solid steel"),
        _number("active_length_mm", wound.active_length / MILLIMETRE),
        Entry("turns_per_coil", str(wound.design.turns)),
        Entry("coils_in_series_per_phase", str(wound.coils_in_series)),
        _number("phase_resistance_mohm_20degC", designed.resistance / 1e-3),
    )


def _actuator_device(designed: Designed) -> tuple[Entry, ...]:
    output = Entry("output", '"shaft"' if designed.is_shaft else '"wheel"')
    headings = _SHAFT_HEADINGS if designed.is_shaft else _WHEEL_HEADINGS
    numbers = [_device_number(name, value, headings) for name, value in written(on_bench(designed)).items()]
    return (Entry("model", '"actuator"'), output, *numbers)


def on_bench(designed: Designed) -> OnBench:
    """What is designed as it lies on the bench, by the description that simulation and exported unit take."""
    machine = designed.machine.constant_parameters(designed.continuous_current)
    actuator = driven_parts(designed.outcome, designed.gears)
    return OnBench(actuator, machine.with_resistance(designed.resistance), REFERENCE, _saturation(designed))


_HEADINGS = {"psi_m": "psi_m_mVs", "inductance": "inductance_uH", "phase_resistance": "phase_resistance_mohm",
             "reference_T": "reference_T_degC"}  # fmt: skip
_WHEEL_HEADINGS = _HEADINGS | {
    "transmission_ratio": "transmission_ratio_mm_per_rad", "equivalent_mass": "equivalent_mass_kg",
    "viscous_friction": "viscous_friction_Ns_per_m", "coulomb_friction": "coulomb_friction_N",
}  # fmt: skip
_SHAFT_HEADINGS = _HEADINGS | {
    "equivalent_mass": "equivalent_mass_kg_m2", "viscous_friction": "viscous_friction_Nms_per_rad",
    "coulomb_friction": "coulomb_friction_Nm",
}  # fmt: skip
_WHY = {
    "psi_m": "flux map without current", "inductance": "flux map", "reference_T": "at which the resistance holds",
    "saturation": "1/A^2, K = K_0/(1 + s 3/2 i^2) at the peak current of the map",
    "transmission_ratio": "output over rotor, teeth as they are, nominal position",
    "equivalent_mass": "rotor and gears at the output", "efficiency_driven": "meshes alone",
    "efficiency_driving": "meshes alone", "viscous_friction": "study", "coulomb_friction": "study",
}  # fmt: skip


def _device_number(name: str, value: float, headings: Mapping[str, str]) -> Entry:
    """A number of ``written`` [SI] in the unit of its heading."""
    heading = headings.get(name, name)
    unit = split_unit(heading)[1]
    same = not unit or unit == "degC"
    return _number(heading, value if same else value / factor(unit, heading), _WHY.get(name, ""))


def _saturation(designed: Designed) -> float:
    """s [1/A^2] with which the torque on the q axis at the peak current is that of the flux map."""
    machine, current = designed.machine, designed.winding.limits.current_peak
    straight = 1.5 * machine.pole_pairs * float(machine.flux_linkage(0.0, 0.0)[0]) * current
    return max(0.0, straight / float(machine.torque(0.0, current)) - 1.0) / (1.5 * current**2)


def _friction_keys(designed: Designed) -> tuple[str, ...]:
    """The frictions that the study states; one of zero has no relative tolerance."""
    friction = friction_at(designed.study)
    stated = {"viscous_friction": friction.viscous, "coulomb_friction": friction.coulomb}
    return tuple(key for key, value in stated.items() if value)


# ---- tables ---------------------------------------------------------------------------------------------------------

_SMALL = 0.002  # of the largest reading: what a usual transducer scatters by


def _both_ways(largest: float, count: int = _SPEEDS) -> np.ndarray:
    """Speeds in both directions, without standstill."""
    rising = np.linspace(largest / count, largest, count)
    return np.concatenate([rising, -rising])


def _dq_tables(designed: Designed) -> tuple[TableDraft, ...]:
    machine, torque = designed.machine, designed.winding.peak_torque
    fastest = designed.study.winding_selection.si.speed_max
    flux = float(machine.flux_linkage(0.0, 0.0)[0])
    volts = machine.pole_pairs * fastest * flux
    speeds = np.linspace(fastest / _SPEEDS, fastest, _SPEEDS)
    currents = np.linspace(0.0, designed.continuous_current, _CURRENT_STEPS)  # beyond, constants do not hold
    slow = np.full(2 * _CURRENT_STEPS, fastest / 4)
    i_q = np.concatenate([currents, -currents])
    operation = {"i_d_A": 0 * i_q, "i_q_A": i_q, "speed_rpm": slow / RPM}
    loaded = {"v_d_V": _SMALL * volts, "v_q_V": _SMALL * volts, "torque_Nm": _SMALL * torque}
    return (
        TableDraft("back_emf", "back_emf", {"speed_rpm": speeds / RPM}, {"v_ll_V": _SMALL * volts}),
        TableDraft("operation", "dq_operation", operation, loaded),
        TableDraft("drag", "drag", {"speed_rpm": _both_ways(fastest) / RPM}, {"torque_Nm": _SMALL * torque}),
        _resistance_table("resistance_mohm", designed),
    )


def _resistance_table(heading: str, designed: Designed) -> TableDraft:
    warm = {"winding_T_degC": np.array([20.0, 40.0, 60.0, 80.0])}
    return TableDraft("phase_resistance", "phase_resistance", warm, {heading: _SMALL * designed.resistance / 1e-3})


def _actuator_tables(designed: Designed) -> tuple[TableDraft, ...]:
    shaft, features = designed.is_shaft, designed.outcome.features
    motion, effort = ("speed_rpm", "torque_Nm") if shaft else ("velocity_m_per_s", "force_N")
    unit = RPM if shaft else 1.0
    fastest = designed.study.winding_selection.si.speed_max * features.transmission_ratio
    volts = float(designed.machine.flux_linkage(0.0, 0.0)[0]) * designed.machine.pole_pairs * fastest
    volts /= features.transmission_ratio
    currents = np.linspace(0.0, designed.winding.limits.current_peak, _CURRENT_STEPS + 1)[1:]
    held = {"current_A": np.tile(currents, 2), "direction": np.repeat([1.0, -1.0], len(currents))}
    shunts = designed.resistance * np.array([0.0, 1.0, 3.0, 10.0])
    speeds = _both_ways(fastest)
    damped = {motion: np.tile(speeds, len(shunts)) / unit, "shunt_ohm": np.repeat(shunts, len(speeds))}
    random = {effort: _SMALL * features.effort_peak}
    return (
        TableDraft("locked_force", "locked_force", held, random),
        TableDraft("back_emf", "back_emf", {motion: speeds[:_SPEEDS] / unit}, {"v_ll_V": _SMALL * volts}),
        TableDraft("damping_velocity", "damping_velocity", damped, random),
        TableDraft("drag", "drag", {motion: speeds / unit}, random),
        _resistance_table("resistance_mohm", designed),
    )


def _machine_tables(designed: Designed) -> tuple[TableDraft, ...]:
    machine, torque = designed.machine, designed.winding.peak_torque
    fast = designed.study.winding_selection.si.speed_max / 2
    volts = machine.pole_pairs * fast * float(machine.flux_linkage(0.0, 0.0)[0])
    turn = np.arange(0.0, 2 * np.pi - _FINE / 2, 2 * _FINE)
    voltage = {"angle_mech_deg": turn / DEGREE, "speed_rpm": np.full(len(turn), fast / RPM)}
    fine = np.arange(0.0, 2 * np.pi - _FINE / 2, _FINE)
    scan = np.concatenate([fine, fine[::-1]])
    cogging = {"angle_mech_deg": scan / DEGREE, "direction": np.repeat([1.0, -1.0], len(fine))}
    phases = [f"r_{x}_mohm" for x in "abc"]
    warm = {"winding_T_degC": np.array([20.0, 40.0, 60.0, 80.0])}
    speeds = _both_ways(2 * fast)
    return (
        TableDraft("back_emf", "back_emf", voltage, {f"v_{x}_V": _SMALL * volts for x in "abc"}),
        TableDraft("cogging", "cogging", cogging, {"torque_Nm": _SMALL * torque / 4}),
        TableDraft("locked_rotor", "locked_rotor", _locked_points(designed), {"torque_Nm": _SMALL * torque}),
        TableDraft("drag", "drag", {"speed_rpm": speeds / RPM}, {"torque_Nm": _SMALL * torque / 4}),
        TableDraft("phase_resistance", "phase_resistance", warm,
                   {name: _SMALL * designed.resistance / 1e-3 for name in phases}),
    )  # fmt: skip


def _locked_points(designed: Designed) -> Columns:
    """Direct current into A and out of B and C, turned by hand over an electrical period, at three sizes."""
    peak, pole_pairs = designed.winding.limits.current_peak, designed.machine.pole_pairs
    angles = np.arange(0.0, 2 * np.pi / pole_pairs - _COARSE / 2, _COARSE)
    sizes = np.repeat(peak * np.array([1 / 3, 2 / 3, 1.0]), len(angles))
    return {
        "angle_mech_deg": np.tile(angles, 3) / DEGREE,
        "i_a_A": sizes,
        "i_b_A": -sizes / 2,
        "i_c_A": -sizes / 2,
    }
