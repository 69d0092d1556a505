"""From a model file of the workbench to what it means for a design: one table, effect by effect and input by input."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

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
from materials.conductor import COPPER
from materials.magnet import NDFEB_REMANENCE_COEFFICIENT
from units import split_unit
from workbench.data.column_units import factor
from workbench.ledger.learned import FittedInput
from workbench.ledger.model_file import read_model
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
    "bridge_width": "it is of the sheets that were measured; move bridge_mm in the machine file if all are so",
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

    Raises WorkbenchError where it is no model file, or holds an effect or a parameter that is not known.
    """
    found = read_model(path, library)
    spreads = dict(zip(found.names, np.sqrt(np.diag(found.covariance)).tolist()))  # none in a file without covariance
    inputs, left = _of_inputs(found.inputs, found.device, spreads)
    lessons = tuple(inputs) + tuple(one for effect in found.effects for one in _lessons(effect, found.device, spreads))
    unused = [_no_meaning(effect) for effect in found.effects if effect.name() not in MEANINGS]
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
    entries: Iterable[FittedInput], device: Device, spreads: Mapping[str, float]
) -> tuple[list[Lesson], list[str]]:
    """Lessons of fitted inputs, and one sentence for those that are of the specimen."""
    lessons, others = [], []
    for entry in entries:
        quantity, scale = INPUTS.get(entry.name), _scale(entry, device)
        if quantity is None or scale is None:
            others.append(entry.name)
            continue
        shift, spread = scale * entry.shift, spreads.get(entry.name)
        value = -shift if quantity == MAGNET_FLUX else 1.0 + shift  # a share that is lost, or a factor
        uncertainty = None if spread is None else scale * spread
        lessons.append(Lesson(entry.name, f"fitted {entry.name}", quantity, value, uncertainty))
    return lessons, [f"{', '.join(others)}: of the machine that was measured, not of the design."] if others else []


def _scale(entry: FittedInput, device: Device) -> float | None:
    """From the shift of an input to a relative one; None where the nominal value is not in the file."""
    if entry.tolerance.relative:
        return 1.0
    known = names(device)
    key = known.get(entry.name, known.get(split_unit(entry.name)[0]))
    if key is None:
        return None
    unit = split_unit(key)[1]
    return 1.0 / (float(device[key]) * (factor(unit, f"[device] {key}") if unit else 1.0))
