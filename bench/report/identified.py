"""Identified parameters for people."""

from __future__ import annotations

import pandas as pd

from bench.identification import Found, Identification
from units import FACTORS, split_unit

_MEMORY = 2.0  # readings that say as much as one, from which on the model is called not quite right
_STRONG = 0.3  # part of a combination of parameters that is named


def identified_table(found: Identification) -> pd.DataFrame:
    """One parameter a row, in the unit of its name."""
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


def identification_remarks(found: Identification) -> tuple[str, ...]:
    """What must not be overlooked: parameters without a size, and residuals with a memory."""
    lost = [_words(one.unknown.name) for one in found.found if not one.is_identified]
    said = [f"The records do not say the size of: {', '.join(lost)}."] if lost else []
    if found.memory > _MEMORY:
        said.append(
            f"What is left beside the model has a memory: {found.memory:.3g} readings say as much as one independent "
            "one. The model is not quite right, and the intervals are widened for the memory, not for what it lacks."
        )
    return tuple(said)


def weakest_words(found: Identification) -> str:
    """The combination of parameters that the records say least about, as a sentence."""
    deviation, parts = found.weakest
    strong = " with ".join(_words(name) for name, part in parts.items() if abs(part) > _STRONG)
    return f"What the records say least about is {strong}, known to {100 * deviation:.2g} % (one standard deviation)."


def _words(name: str) -> str:
    return split_unit(name)[0].replace("_", " ")
