"""Reading the ``[device]`` table of a lumped device and moving one of its inputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

from workbench.data.column_units import factor, split_unit
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError


def names(table: Mapping[str, object]) -> dict[str, str]:
    """Key of the table by the name of its quantity: {"moving_mass": "moving_mass_kg"}."""
    return {split_unit(key)[0]: key for key in table}


# No input of a machine or a damper is larger or smaller than these in SI units, zero apart: such a number is a slip,
# and what is worked out from it would overflow.
LARGEST, SMALLEST = 1e12, 1e-15


def numbers(table: Mapping[str, object], required: tuple[str, ...], optional: tuple[str, ...]) -> dict[str, float]:
    """Numbers of the table by the fields of the design, SI. Texts are for people and are not looked at.

    Raises:
        WorkbenchError: a key is missing, said twice, unknown or no finite number of a possible size; a quantity that is
            no temperature and no coefficient is negative.
    """
    keys = names(table)
    _refuse_doubles(table, keys)
    missing = [name for name in required if name not in keys]
    known = required + optional
    if missing:
        slips = [
            f"{key} is no input of it" for name, key in keys.items() if get_close_matches(name, missing, cutoff=0.8)
        ]
        more = "".join(f"; {words}" for words in slips)
        raise WorkbenchError(f"[device] lacks {', '.join(missing)}; give them in campaign.toml, unit at the end{more}")
    unknown = [key for name, key in keys.items() if name not in known and not isinstance(table[key], str)]
    if unknown:
        raise WorkbenchError(
            f"[device] has {', '.join(unknown)}, which this model does not use; it uses {', '.join(known)}"
        )
    return {name: _number(keys[name], table[keys[name]]) for name in known if name in keys}


def without_unit_traps(device: Mapping[str, object]) -> dict[str, object]:
    """The table of a machine with the names of its quantities, where their ends look like other units."""
    renamed = {
        "remanence_T": "remanence",
        "remanence_reference_degC": "remanence_reference",
        "phase_resistance_mohm_20degC": "phase_resistance_mohm",
        "magnet_temperature_degC": "magnet_temperature",
    }
    return {renamed.get(key, key): value for key, value in device.items()}


def _refuse_doubles(table: Mapping[str, object], keys: Mapping[str, str]) -> None:
    for key in table:
        name = split_unit(key)[0]
        if keys[name] != key:
            raise WorkbenchError(f"[device] says {name} twice, as {key} and as {keys[name]}: keep one")


def require_positive(values: Mapping[str, float], *fields: str) -> None:
    """Raises WorkbenchError for a field that is not positive."""
    for name in fields:
        if not values[name] > 0:
            raise WorkbenchError(f"[device] {name} must be positive, found {values[name]:g}: correct campaign.toml")


def require_whole(values: Mapping[str, float], *fields: str) -> None:
    """Raises WorkbenchError for a field that is no whole number."""
    for name in fields:
        if values[name] != round(values[name]):
            raise WorkbenchError(
                f"[device] {name} must be a whole number, found {values[name]:g}: correct campaign.toml"
            )


def moved(design: Any, tolerance: Tolerance, z: float, fields: tuple[str, ...]) -> Any:
    """The design with the toleranced field moved by z sigma; the tolerance names it with or without its unit."""
    values = moved_number({name: getattr(design, name) for name in fields}, tolerance, z)
    return replace(design, **values)


def moved_number(values: Mapping[str, float], tolerance: Tolerance, z: float) -> dict[str, float]:
    """Numbers with the toleranced one moved by z sigma; the tolerance names it with or without its unit."""
    name = tolerance.name if tolerance.name in values else split_unit(tolerance.name)[0]
    if name not in values:
        raise WorkbenchError(f"[tolerance] {tolerance.name} is no input of this model: use one of {', '.join(values)}")
    sigma = tolerance.sigma * (abs(values[name]) if tolerance.relative else 1.0)
    return {**values, name: values[name] + sigma * z}


def _number(key: str, value: object) -> float:
    """A number of the table in SI."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise WorkbenchError(f"[device] {key} must be a number, found {_short(value)}: correct campaign.toml")
    name, unit = split_unit(key)
    found = value * (factor(unit, f"[device] {key}") if unit else 1.0) if abs(value) < 1e300 else value
    if not abs(found) <= LARGEST:
        raise WorkbenchError(
            f"[device] {key} = {_short(value)} is not finite or larger than any such input: correct it, or leave the "
            "key out where the model can do without"
        )
    if 0 < abs(found) < SMALLEST:
        raise WorkbenchError(f"[device] {key} = {_short(value)} is smaller than any such input: correct campaign.toml")
    if found < 0 and not name.endswith(MAY_BE_NEGATIVE):
        raise WorkbenchError(
            f"[device] {name} must be a positive number or zero, found {_short(value)}: correct campaign.toml"
        )
    return float(found)


# Ends of names of quantities.
MAY_BE_NEGATIVE = ("_T", "_temperature", "_coefficient", "_reference", "_zero", "_offset", "_angle")


def _short(value: object) -> str:
    text = "a number of many digits" if isinstance(value, int) and abs(value) >= 10**20 else repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


# Inductance over resistance of windings [s]: ironless ones of motors as thin as a pencil have microseconds, those of
# direct-drive wind generators about one second.
QUICKEST, SLOWEST = 1e-6, 5.0


def doubts_of_winding(inductance: float, resistance: float) -> tuple[str, ...]:
    """A sentence where no winding has such an inductance [H] at such a resistance [ohm]; nothing where one is zero."""
    if not (inductance and resistance) or QUICKEST < inductance / resistance < SLOWEST:
        return ()
    return (
        f"[device]: {inductance:.3g} H over {resistance:.3g} ohm are {inductance / resistance:.2g} s, windings have "
        "microseconds to a second: check the units of both",
    )
