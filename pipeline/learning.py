"""From a model file of the workbench to what it means for a design: one table, effect by effect and input by input."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from math import sqrt
from pathlib import Path
from typing import Any

from drivetrain.learned import (
    END_LEAKAGE,
    IRON_LOSS,
    LOAD_LOSS,
    MAGNET_FLUX,
    OUTPUT_FRICTION,
    OUTPUT_VISCOUS,
    RECOIL,
    REMANENCE,
    RESISTANCE,
    ROTOR_FRICTION,
    ROTOR_VISCOUS,
    STACKING,
    STEEL_FIELD,
    STEEL_SATURATION,
    Learned,
    Lesson,
    Quantity,
)
from effects.base import Effect, InstrumentEffect
from effects.library import Library
from effects.parameter import parameters_of
from materials.conductor import COPPER
from materials.magnet import NDFEB_REMANENCE_COEFFICIENT
from study.errors import StudyError
from units import split_unit
from workbench.data.column_units import factor
from workbench.models.device import names

Device = Mapping[str, Any]  # the [device] table of a campaign, drawing units


@dataclass(frozen=True)
class Meaning:
    """What one parameter of an effect is for a design.

    parameter: of the effect;  quantity: that it changes;  value: of the quantity, from parameter [SI] and device
    """

    parameter: str
    quantity: Quantity
    value: Callable[[float, Device], float]

    def lesson(self, effect: Effect, device: Device, uncertainty: float | None) -> Lesson:
        """The lesson of an effect; uncertainty: standard, of the parameter, carried over by the slope."""
        at = float(getattr(effect, self.parameter))
        value = self.value(at, device)
        spread = None if uncertainty is None else abs(self.value(at + uncertainty, device) - value)
        return Lesson(effect.name(), effect.title, self.quantity, value, spread)


def _as_it_is(size: float, device: Device) -> float:
    return size


def _gained(size: float, device: Device) -> float:
    return -size


def _less(share: float, device: Device) -> float:
    return 1.0 - share


def _more(share: float, device: Device) -> float:
    return 1.0 + share


def _half_more(share: float, device: Device) -> float:
    return 1.0 + share / 2


def _warm_magnet(rise: float, device: Device) -> float:
    """Remanence after a rise [K], over that before."""
    percent = device.get("remanence_coefficient_percent_per_K", 100 * NDFEB_REMANENCE_COEFFICIENT)
    return 1.0 + float(percent) / 100 * rise


def _warm_copper(rise: float, device: Device) -> float:
    """Resistance after a rise [K] from 20 degC, over that before."""
    return 1.0 + COPPER.temperature_coefficient * rise


MEANINGS: Mapping[str, tuple[Meaning, ...]] = {
    "magnet_temperature": (Meaning("rise", REMANENCE, _warm_magnet),),
    "weak_magnets": (Meaning("loss", MAGNET_FLUX, _as_it_is),),  # psi_m and K, by the law of the effect itself
    "recoil_permeability": (Meaning("excess", RECOIL, _more),),  # of a permeability near one
    "lamination_stacking": (Meaning("loss", STACKING, _less),),
    "steel_grade": (Meaning("excess", STEEL_FIELD, _more),),
    "steel_saturation": (Meaning("change", STEEL_SATURATION, _more),),
    "press_fit_stress": (Meaning("strain", STEEL_FIELD, _more), Meaning("strain", IRON_LOSS, _half_more)),
    "end_leakage": (Meaning("share", END_LEAKAGE, _as_it_is),),
    "magnet_overhang": (Meaning("share", END_LEAKAGE, _gained),),
    "winding_temperature": (Meaning("rise", RESISTANCE, _warm_copper),),
    "iron_loss": (Meaning("factor", IRON_LOSS, _as_it_is),),
    "iron_loss_excess": (Meaning("excess", IRON_LOSS, _more),),
    "bearing_friction": (Meaning("level", ROTOR_FRICTION, _as_it_is),),
    "bearing_viscous": (Meaning("slope", ROTOR_VISCOUS, _as_it_is),),
    "friction_torque": (Meaning("level", ROTOR_FRICTION, _as_it_is),),
    "viscous_torque": (Meaning("coefficient", ROTOR_VISCOUS, _as_it_is),),
    "coulomb_friction": (Meaning("level", OUTPUT_FRICTION, _as_it_is),),
    "stribeck_friction": (Meaning("level", OUTPUT_FRICTION, _as_it_is),),  # what is left beyond creeping speed
    "excess_viscous": (Meaning("excess", OUTPUT_VISCOUS, _as_it_is),),
    "load_loss": (Meaning("share", LOAD_LOSS, _as_it_is),),
}
# Effects of which the design knows already, or that are of one machine, and what to do about them.
NO_MEANING: Mapping[str, str] = {
    "quadrature_saturation": "the flux map of the design has it already",
    "cross_saturation": "the flux map of the design has it already",
    "force_constant_saturation": "the flux map of the design has it already",
    "direct_inductance": "the flux map of the design has inductances of its own",
    "quadrature_inductance": "the flux map of the design has inductances of its own",
    "copper_drift": "the study states its winding temperature (winding_selection.winding_temperature_degC)",
    "remanence_drift": "the study states the remanence at the magnets' working temperature (materials.remanence_T)",
    "airgap_change": "it is of the machine that was measured; move machine.airgap_mm if all will be built like it",
    "slot_opening": "it is of the machine that was measured; move machine.slot_opening_mm if all will be built like it",
    "magnet_arc": "it is of the machine that was measured; move machine.magnet_arc_fraction if all will be so",
    "iron_loss_resistance": "the iron loss of a design comes from its field; compare with the loss map",
}
# Fitted inputs of the bench models that are the same for every machine of a study; the others are of the specimen.
INPUTS: Mapping[str, Quantity] = {
    "remanence": REMANENCE,
    "magnet.Br": REMANENCE,
    "psi_m": MAGNET_FLUX,
    "force_constant": MAGNET_FLUX,
    "recoil_permeability": RECOIL,
    "resistance": RESISTANCE,
    "phase_resistance": RESISTANCE,
    "internal_resistance": RESISTANCE,
}


def learned_from(path: Path, library: Library) -> Learned:
    """What a model file teaches.

    Raises StudyError where it is no model file, or holds an effect or a parameter that is not known.
    """
    content = _content(path)
    effects = [_effect(entry, library, path) for entry in content.get("effect", [])]
    try:
        device, spreads = content.get("device", {}), _spreads(content)
        inputs, left = _of_inputs(content.get("input", []), device, spreads)
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
        raise StudyError(f"--with {path}: its inputs or their covariance cannot be read ({error!r}).") from None
    lessons = tuple(inputs) + tuple(lesson for effect in effects for lesson in _lessons(effect, device, spreads))
    unused = [_no_meaning(effect) for effect in effects if effect.name() not in MEANINGS]
    return Learned(lessons, tuple(unused + left), path.name)


def _lessons(effect: Effect, device: Device, spreads: Mapping[str, float]) -> Iterator[Lesson]:
    for meaning in MEANINGS.get(effect.name(), ()):
        yield meaning.lesson(effect, device, spreads.get(f"{effect.name()}.{meaning.parameter}"))


def _no_meaning(effect: Effect) -> str:
    """Why an effect changes no input of a design."""
    if isinstance(effect, InstrumentEffect):
        return f"{effect.name()} is an error of an instrument, the machine has nothing of it."
    why = NO_MEANING.get(effect.name(), "it is of the machine that was measured and no input of a design")
    return f"{effect.name()}: {why}."


def _of_inputs(
    entries: list[dict[str, Any]], device: Device, spreads: Mapping[str, float]
) -> tuple[list[Lesson], list[str]]:
    """Lessons of fitted inputs, and one sentence for those that are of the specimen."""
    lessons, others = [], []
    for entry in entries:
        name, scale = str(entry.get("name")), _scale(entry, device)
        quantity = INPUTS.get(name)
        if quantity is None or scale is None:
            others.append(name)
            continue
        spread = spreads.get(name)
        shift, uncertainty = scale * float(entry["shift"]), None if spread is None else scale * spread
        value = -shift if quantity == MAGNET_FLUX else 1.0 + shift  # a share that is lost, or a factor
        lessons.append(Lesson(name, f"fitted {name}", quantity, value, uncertainty))
    return lessons, [f"{', '.join(others)}: of the machine that was measured, not of the design."] if others else []


def _scale(entry: Mapping[str, Any], device: Device) -> float | None:
    """From the shift of an input to a relative one; None where the nominal value is not in the file."""
    if entry.get("relative"):
        return 1.0
    name, known = str(entry.get("name")), names(device)
    key = known.get(name, known.get(split_unit(name)[0]))
    if key is None:
        return None
    unit = split_unit(key)[1]
    return 1.0 / (float(device[key]) * (factor(unit, f"[device] {key}") if unit else 1.0))


def _spreads(content: Mapping[str, Any]) -> dict[str, float]:
    """Standard uncertainty of inputs and of parameters of effects, where the file states a covariance."""
    stated = content.get("covariance", {})
    rows = stated.get("rows", [])
    return {name: sqrt(max(0.0, rows[k][k])) for k, name in enumerate(stated.get("names", []))}


def _content(path: Path) -> dict[str, Any]:
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise StudyError(f"--with {path}: cannot be read as a model file: {error}.") from None
    if not isinstance(content.get("model"), dict) or not isinstance(content.get("effect", []), list):
        raise StudyError(f"--with {path}: is no model file; `airgap add` and `airgap ledger` write one.")
    return content


def _effect(entry: Any, library: Library, path: Path) -> Effect:
    name = entry.get("name") if isinstance(entry, dict) else None
    if name not in library:
        raise StudyError(f"--with {path}: the effect {name!r} is not known; name its file with --effects-from.")
    cls = library[name]
    values = {key: value for key, value in entry.items() if key != "name"}
    for key, p in parameters_of(cls).items():
        value = values.get(key, p.null)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not p.low <= value <= p.high:
            raise StudyError(f"--with {path}: {name}.{key} must be a number from {p.low:g} to {p.high:g}.")
    try:
        return cls(**values)
    except TypeError as error:
        raise StudyError(f"--with {path}: {name} is not as the library knows it ({error}).") from None
