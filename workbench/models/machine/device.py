"""Reading the ``[device]`` table of a machine and moving one of its inputs.

Keys carry their unit at the end. Needed: slots, poles, the dimensions of ``geometry.machine.Machine`` (stator_outer_
radius_mm, rotor_outer_radius_mm over the magnets, back_iron_width_mm, tooth_width_mm, magnet_length_mm, airgap_mm,
slot_opening_mm, shoe_d1_mm, shoe_d2_mm, shaft_radius_mm), remanence_T, active_length_mm, turns_per_coil, steel.

If known:
    magnet_arc_fraction           of the pole pitch (1)
    magnetisation                 "parallel", "radial" or "halbach" ("parallel")
    remanence_reference_degC      at which the remanence is stated (22)
    remanence_coefficient_percent_per_K   (-0.11)
    magnet_temperature_degC       of the magnets on the bench where no column magnet_T_degC says it (the reference)
    recoil_permeability           (1.05)
    stacking_factor               (1)
    coils_in_series_per_phase     slots/3: a coil on every tooth, those of a phase in series
    phase_resistance_mohm         of a phase at 20 degC, without leads
    end_winding_inductance_uH     of a phase; without it zero, uncertain by what half circles have
    iron_loss_grade               whose loss data count, a name in ``materials.iron_loss.LAWS``; without it no iron loss
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import pi

from effects.machine_design import MachineAsBuilt
from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.machine import Machine
from geometry.magnetisation import PATTERNS
from materials.errors import MaterialError
from materials.iron_loss import iron_loss_law
from materials.library import load_steel
from materials.magnet import Magnet
from units import MU_0
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.device import numbers, require_positive, require_whole, without_unit_traps

LABORATORY = 22.0  # degC, at which a device table states its remanence when it does not say
_DIMENSIONS = (
    "stator_outer_radius",
    "rotor_outer_radius",
    "back_iron_width",
    "tooth_width",
    "magnet_length",
    "airgap",
    "slot_opening",
    "shoe_d1",
    "shoe_d2",
    "shaft_radius",
)
_REQUIRED = ("slots", "poles", *_DIMENSIONS, "remanence", "active_length", "turns_per_coil")
_OPTIONAL = (
    "magnet_arc_fraction",
    "remanence_coefficient",
    "remanence_reference",
    "recoil_permeability",
    "stacking_factor",
    "coils_in_series_per_phase",
    "phase_resistance",
    "magnet_temperature",
    "end_winding_inductance",
)


def machine_of_device(device: Mapping[str, object]) -> MachineAsBuilt:
    """The machine as drawn. Raises WorkbenchError when the table lacks something or the machine cannot be built."""
    values = numbers(without_unit_traps(device), _REQUIRED, _OPTIONAL)
    require_positive(values, *_REQUIRED)
    require_whole(values, "slots", "poles")
    try:
        machine = _machine_of(values, device)
        check_machine(machine)
        return _as_drawn(machine, values, device)
    except (GeometryError, MaterialError) as error:
        raise WorkbenchError(f"[device]: {error}") from None


def _machine_of(values: Mapping[str, float], device: Mapping[str, object]) -> Machine:
    pattern = str(device.get("magnetisation", "parallel"))
    if pattern not in PATTERNS:
        raise WorkbenchError(f"[device] magnetisation must be one of {', '.join(PATTERNS)}, found {pattern!r}")
    return Machine(
        slots=int(values["slots"]),
        pole_pairs=int(values["poles"]) // 2,
        magnet_arc_fraction=values.get("magnet_arc_fraction", 1.0),
        magnetisation=PATTERNS[pattern],
        **{name: values[name] for name in _DIMENSIONS},
    )


def _as_drawn(machine: Machine, values: Mapping[str, float], device: Mapping[str, object]) -> MachineAsBuilt:
    in_series = values.get("coils_in_series_per_phase", machine.slots / 3)
    if in_series * 3 != machine.slots:
        raise WorkbenchError(
            "[device] coils_in_series_per_phase must be slots / 3 (a coil on every tooth, those of a phase in series), "
            f"here {machine.slots / 3:g}; found {in_series:g}"
        )
    steel = str(device.get("steel", ""))
    load_steel(steel)  # an unknown grade is said here, with the known ones
    resistance = values.get("phase_resistance", 0.0)
    drawn = MachineAsBuilt.drawn(
        machine, steel, _magnet_of(values), values["active_length"], values["turns_per_coil"], resistance
    )
    return replace(
        drawn,
        stacking_factor=values.get("stacking_factor", 1.0),
        end_winding_inductance=values.get("end_winding_inductance", 0.0),
        iron_loss=iron_loss_law(str(device["iron_loss_grade"])) if "iron_loss_grade" in device else None,
    )


def _magnet_of(values: Mapping[str, float]) -> Magnet:
    magnet = Magnet(
        values["remanence"],
        values.get("recoil_permeability", 1.05),
        values.get("remanence_coefficient", -0.0011),
        values.get("remanence_reference", LABORATORY),
    )
    return magnet.at(values["magnet_temperature"]) if "magnet_temperature" in values else magnet


# ---- inputs that are uncertain ---------------------------------------------------------------------------------------

_ALIASES = {"magnet.Br": "remanence", "length": "active_length"}
_OF_THE_MAGNET = ("remanence", "recoil_permeability")
_OWN_FIELDS = {"active_length": "length"} | {
    name: name
    for name in ("cogging_of_mesh", "end_winding_inductance", "iron_loss_factor", "recorder_loss", "rise_beyond_table")
}
_PHASES = {"resistance_a": 0, "resistance_b": 1, "resistance_c": 2}
_SCATTER_OF_A_PHASE = 0.004  # relative, of windings of one make beside each other: length of wire and of its ends
# Beside what the difference of two meshes tells, see ``numerical.py``. Of 12 slots and 10 poles cogging is 48.1 mNm on
# 480 edges, 49.0 on 1,080, 49.4 on 2,880 and 49.3 by NGSolve on 1,440, of third order; of 9 slots and 8 poles 5.04,
# 4.84, 4.80 on 1,440, and 4.64 by NGSolve.
_COGGING_OF_MESH = 0.017
# Tables of twelve grades, cut at 1.8 T: up to their own ends at 2 T they rise 1.05 to 2.2 times as expected from there.
_RISE_BEYOND_TABLE = 0.6
_RECORDER_LOSS = 0.5  # recorders pass all or nothing there, and both is common
_BUILDING_FACTOR = 0.3  # relative: loss of stacks over the data of their sheet, and of two regions over all elements
_END_PERMEANCE = 0.3  # of an end turn over mu_0 and its length; 0.2 to 0.5 of concentrated windings


def with_tolerance(design: MachineAsBuilt, tolerance: Tolerance, z: float) -> MachineAsBuilt:
    """The design with a toleranced input moved by z standard deviations.

    Raises WorkbenchError when it is no input of this model.
    """
    name = _ALIASES.get(tolerance.name, tolerance.name)
    now = _value(design, name)
    return _moved(design, name, now, now + tolerance.sigma * z * (abs(now) if tolerance.relative else 1.0))


def _value(design: MachineAsBuilt, name: str) -> float:
    if name in (*_DIMENSIONS, "magnet_arc_fraction"):
        return getattr(design.machine, name)
    if name in _OF_THE_MAGNET:
        return getattr(design.magnet, name)
    if name in _OWN_FIELDS:
        return getattr(design, _OWN_FIELDS[name])
    others = {"magnet_temperature": design.magnet.reference_temperature, "phase_resistance": design.phase_resistance[0]}
    others |= {phase: design.phase_resistance[k] for phase, k in _PHASES.items()}
    if name not in others:
        known = ", ".join((*_DIMENSIONS, "magnet_arc_fraction", *_OF_THE_MAGNET, *_OWN_FIELDS, *others))
        raise WorkbenchError(f"[tolerance] {name} is no input of this model: use one of {known}")
    return others[name]


def _moved(design: MachineAsBuilt, name: str, now: float, value: float) -> MachineAsBuilt:
    if name in _OF_THE_MAGNET:
        return design.with_magnet(**{name: value})
    if name in _OWN_FIELDS:
        return replace(design, **{_OWN_FIELDS[name]: value})
    if name in _PHASES:
        return design.with_one("phase_resistance", _PHASES[name], value)
    if name == "phase_resistance":
        factor = value / now if now else 1.0
        return replace(design, phase_resistance=tuple(r * factor for r in design.phase_resistance))
    if name == "magnet_temperature":
        return replace(design, magnet=design.magnet.at(value))
    return design.with_machine(**{name: value})


def own_tolerances(design: MachineAsBuilt) -> tuple[Tolerance, ...]:
    """What is uncertain in every machine and in the model itself, whatever a campaign declares."""
    ends = "half circles of the mean width of a coil, 0.3 mu_0 a metre" if not design.end_winding_inductance else "30 %"
    loss = () if design.iron_loss is None else (_relative("iron_loss_factor", _BUILDING_FACTOR, "building factors"),)
    return (
        _relative("cogging_of_mesh", _COGGING_OF_MESH, "cogging of one mesh against finer ones and other codes"),
        *(_relative(name, _SCATTER_OF_A_PHASE, "phases wound alike, some tenths of a per cent") for name in _PHASES),
        Tolerance("end_winding_inductance", _end_uncertainty(design), relative=False, source=ends),
        _relative("rise_beyond_table", _RISE_BEYOND_TABLE, "tables of steel cut at 1.8 T, continued and compared"),
        Tolerance("recorder_loss", _RECORDER_LOSS, relative=False, source="filters against aliasing, or none"),
        *loss,
    )


def _relative(name: str, sigma: float, source: str) -> Tolerance:
    return Tolerance(name, sigma, relative=True, source=source)


def _end_uncertainty(design: MachineAsBuilt) -> float:
    """Of the end winding [H]: L = coils n^2 mu_0 0.3 l, two half circles of length l around a tooth for every coil."""
    if design.end_winding_inductance:
        return 0.3 * design.end_winding_inductance
    m = design.machine
    width = (m.slot_pitch * (m.stator_inner_radius + m.slot_bottom_radius) / 2 + m.tooth_width) / 2
    return sum(n**2 for n in design.turns) / 3 * MU_0 * _END_PERMEANCE * pi * width
