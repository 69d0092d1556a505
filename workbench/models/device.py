"""Reading the ``[device]`` table of a lumped device and moving one of its inputs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from workbench.data.column_units import factor, split_unit
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError


def names(table: Mapping[str, object]) -> dict[str, str]:
    """Key of the table by the name of its quantity: {"moving_mass": "moving_mass_kg"}."""
    return {split_unit(key)[0]: key for key in table}


def numbers(table: Mapping[str, object], required: tuple[str, ...], optional: tuple[str, ...]) -> dict[str, float]:
    """Numbers of the table by the fields of the design, SI. Texts are for people and are not looked at."""
    keys = names(table)
    missing = [name for name in required if name not in keys]
    if missing:
        raise WorkbenchError(f"[device] lacks {', '.join(missing)}; give them in campaign.toml, unit at the end")
    known = required + optional
    unknown = [key for name, key in keys.items() if name not in known and not isinstance(table[key], str)]
    if unknown:
        raise WorkbenchError(
            f"[device] has {', '.join(unknown)}, which this model does not use; it uses {', '.join(known)}"
        )
    return {name: _number(keys[name], table[keys[name]]) for name in known if name in keys}


def require_positive(values: Mapping[str, float], *fields: str) -> None:
    for name in fields:
        if not values[name] > 0:
            raise WorkbenchError(f"[device] {name} must be positive, found {values[name]:g}: correct campaign.toml")


def moved(design: Any, tolerance: Tolerance, z: float, fields: tuple[str, ...]) -> Any:
    """The design with the toleranced field moved by z sigma; the tolerance names it with or without its unit."""
    name = tolerance.name if tolerance.name in fields else split_unit(tolerance.name)[0]
    if name not in fields:
        raise WorkbenchError(f"[tolerance] {tolerance.name} is no input of this model: use one of {', '.join(fields)}")
    nominal = getattr(design, name)
    sigma = tolerance.sigma * (abs(nominal) if tolerance.relative else 1.0)
    return replace(design, **{name: nominal + sigma * z})


def _number(key: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise WorkbenchError(f"[device] {key} must be a number, found {value!r}: correct campaign.toml")
    unit = split_unit(key)[1]
    return float(value) * (factor(unit, f"[device] {key}") if unit else 1.0)
