"""Reading the ``[device]`` table of a drawn machine and moving one of its inputs.

Needed: machine_file, in quotes: a name in ``machines/`` or the path of a file like those. If known:

    phase_resistance_mohm         of a phase of the equivalent star at 20 degC, half of that between two terminals
    phase_resistance_a_mohm       and _b_, _c_: of each phase in its place, where they are not alike
    largest_current_A             of a phase, peak, that is on the bench: flux linkages are mapped up to it
    slots, poles                  of the file once more, where angles are to be checked
    remanence_T                   of the magnets where it is not that of the file
    stacking_factor               of steel over the length (1)
    remanence_reference_degC      at which the remanence of the file is stated (20)
    remanence_coefficient_percent_per_K   (-0.11)
    magnet_temperature_degC       of the magnets where no column magnet_T_degC says it (the reference)
    end_winding_inductance_uH     of a phase (0)
    wire_diameter_mm              bare, wires_in_hand: parallel ones (1), for a check of the resistance
    iron_loss_grade               whose loss data count, a name in ``materials.iron_loss.LAWS``; without it no iron loss
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import pi

from effects.drawn_design import Drawing, DrawnAsBuilt
from geometry.errors import GeometryError
from materials.errors import MaterialError
from materials.iron_loss import iron_loss_law
from materials.magnet import Magnet
from study.errors import StudyError
from study.machine_file import MachineFile, read_machine
from workbench.data.column_units import split_unit
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.device import numbers, without_unit_traps

FILE = "machine_file"
_COUNTS = ("slots", "poles")
_PHASES = ("phase_resistance_a", "phase_resistance_b", "phase_resistance_c")
_OPTIONAL = (
    *_COUNTS, "remanence", "phase_resistance", "largest_current", "stacking_factor", "remanence_reference",
    "remanence_coefficient", "magnet_temperature", "end_winding_inductance", "wire_diameter", "wires_in_hand",
    *_PHASES,
)  # fmt: skip
_ROOM = 20.0  # degC, where makers state a remanence


def machine_of_device(device: Mapping[str, object]) -> DrawnAsBuilt:
    """The machine as drawn. Raises WorkbenchError where file or table cannot be used."""
    if FILE not in device:
        raise WorkbenchError(f"[device] lacks {FILE}; give it in campaign.toml, a name in machines/ or a path")
    try:
        found = read_machine(str(device[FILE]))
        values = numbers(without_unit_traps(device), (), _OPTIONAL)
        law = iron_loss_law(str(device["iron_loss_grade"])) if "iron_loss_grade" in device else None
    except (StudyError, GeometryError, MaterialError) as error:
        raise WorkbenchError(f"[device]: {error}") from None
    _check_counts(found, values)
    closing = found.connection.closing
    drawing = Drawing(
        found.machine,
        found.layout,
        found.materials.stator_steel,  # type: ignore[arg-type]
        found.materials.rotor_steel,  # type: ignore[arg-type]
        found.density,
        found.end_turn_length,
        found.connection.coil_currents,
        closing.lag,
        closing.circulates,
    )
    made = DrawnAsBuilt(
        drawing,
        found.machine,
        found.turns,
        magnet=_magnet(found, values),
        length=found.active_length,
        phase_resistance=values.get("phase_resistance", 0.0),
        end_winding_inductance=values.get("end_winding_inductance", 0.0),
        stacking_factor=values.get("stacking_factor", 1.0),
        iron_loss=law,
        largest_current=values.get("largest_current", 0.0),
        copper_area=_copper(values),
    )
    return _with_phases(made, values)


def _with_phases(design: DrawnAsBuilt, values: Mapping[str, float]) -> DrawnAsBuilt:
    stated = [name for name in _PHASES if name in values]
    if not stated:
        return design
    if len(stated) < len(_PHASES) or "phase_resistance" in values:
        raise WorkbenchError(
            f"[device] gives {stated[0]}: give all of {', '.join(_PHASES)}, and no phase_resistance beside them"
        )
    return design.with_phase_resistances(*(values[name] for name in _PHASES))


def _check_counts(found: MachineFile, values: Mapping[str, float]) -> None:
    for name in _COUNTS:
        if name in values and values[name] != (drawn := getattr(found.machine, name)):
            raise WorkbenchError(f"[device] {name} = {values[name]:g}, but {found.title!r} has {drawn}: correct one")


def _copper(values: Mapping[str, float]) -> float:
    """Cross-section of a turn [m^2], zero where no wire is declared."""
    return pi / 4 * values.get("wire_diameter", 0.0) ** 2 * values.get("wires_in_hand", 1.0)


def _magnet(found: MachineFile, values: Mapping[str, float]) -> Magnet:
    magnet = replace(
        found.materials.magnet,
        remanence=values.get("remanence", found.materials.magnet.remanence),
        temperature_coefficient=values.get("remanence_coefficient", -0.0011),
        reference_temperature=values.get("remanence_reference", _ROOM),
    )
    return magnet.at(values["magnet_temperature"]) if "magnet_temperature" in values else magnet


# ---- inputs that are uncertain ---------------------------------------------------------------------------------------

_ALIASES = {"active_length": "length", "turns_per_coil": "turns"}
_OF_THE_MAGNET = ("remanence", "recoil_permeability")
_OWN = (
    "length", "turns", "phase_resistance", "end_winding_inductance", "stacking_factor", "field_scale",
    "saturation_scale", "end_leakage", "iron_loss_factor",
)  # fmt: skip


def with_tolerance(design: DrawnAsBuilt, tolerance: Tolerance, z: float) -> DrawnAsBuilt:
    """The design with a toleranced input moved by z standard deviations: airgap, remanence, a dimension of the machine
    file with "stator." or "rotor." before it where both have it, active_length, turns_per_coil, ...

    Raises WorkbenchError when it is no input of this model.
    """
    name = _known(design, tolerance.name)

    def moved(now: float) -> float:
        return now + tolerance.sigma * z * (abs(now) if tolerance.relative else 1.0)

    if name == "airgap":
        return design.with_airgap(moved(design.machine.airgap) - design.machine.airgap)
    if name == "magnet_temperature":
        return replace(design, magnet=design.magnet.at(moved(design.magnet.reference_temperature)))
    if name in _OF_THE_MAGNET:
        return design.with_magnet(**{name: moved(getattr(design.magnet, name))})
    if name == "stacking_factor":  # no more steel than the length; a fit that would have more stops there
        return replace(design, stacking_factor=min(moved(design.stacking_factor), 1.0))
    if name in _PHASES:
        each = list(design.phase_resistances)
        each[_PHASES.index(name)] = moved(each[_PHASES.index(name)])
        return design.with_phase_resistances(*each)
    if name in _OWN:
        return replace(design, **{name: moved(getattr(design, name))})
    part, dimension = name.split(".")
    return design.with_dimension(part, dimension, moved(getattr(getattr(design.machine, part), dimension)))


def _known(design: DrawnAsBuilt, written: str) -> str:
    known = [*_OWN, *_PHASES, *_ALIASES, *_OF_THE_MAGNET, "airgap", "magnet_temperature", *_dimensions(design)]
    for name in (written, split_unit(written)[0]):
        if name in known:
            return _ALIASES.get(name, name)
        ends = [one for one in known if one.endswith(f".{name}")]
        if len(ends) == 1:
            return ends[0]
    raise WorkbenchError(f"[tolerance] {written} is no input of this model: use one of {', '.join(known)}")


def _dimensions(design: DrawnAsBuilt) -> list[str]:
    parts = (("stator", design.machine.stator), ("rotor", design.machine.rotor))
    return [f"{part}.{name}" for part, drawn in parts for name, v in vars(drawn).items() if isinstance(v, float)]
