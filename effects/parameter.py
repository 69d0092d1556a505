"""Parameters of an effect: dataclass fields that know unit, null value, bounds, prior and source."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from types import MappingProxyType
from typing import Any

from effects.prior import Prior

_KEY = "parameter"


@dataclass(frozen=True)
class Parameter:
    """unit: SI; null: the value at which the effect does nothing; low, high: outside is impossible or meaningless."""

    unit: str
    null: float
    low: float
    high: float
    prior: Prior
    source: str


def parameter(null: float, unit: str, *, prior: Prior, low: float, high: float, source: str) -> Any:
    """A dataclass field for a parameter of an effect; its default is its null."""
    return field(default=null, metadata={_KEY: Parameter(unit, null, low, high, prior, source)})


def parameters_of(effect: Any) -> Mapping[str, Parameter]:
    """Parameters of an effect (class or instance) by name, in the order of declaration."""
    return _parameters(effect if isinstance(effect, type) else type(effect))


@cache
def _parameters(effect: type) -> Mapping[str, Parameter]:
    found = {f.name: f.metadata[_KEY] for f in fields(effect) if _KEY in f.metadata}
    return MappingProxyType(found)  # every fit asks for them thousands of times
