"""Artefacts as text and back: one codec for results, checkpoints and hashes.

Frozen dataclasses of plain values become JSON that says which class stood there; arrays become lists with their type;
an ``xarray.Dataset`` stands beside the text, by its number, or in it where nothing can stand beside. Only dataclasses
of the project's own rooms are built again, so that a file of results can be read but never executed.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from importlib import import_module
from math import isfinite
from typing import Any, Protocol

import numpy as np

from geometry.own_kinds import is_loaded
from labelled import xr
from pipeline.modules import module_file

_PLAIN = (str, int, bool, type(None))


class CodecError(ValueError):
    """A value that cannot be written, or a text that is not one that was written."""


class Datasets(Protocol):
    """The datasets that stand beside a text, by number."""

    def __getitem__(self, number: int, /) -> xr.Dataset:
        """The dataset of a number; IndexError or OSError where there is none."""


def encoded(value: Any, datasets: list[xr.Dataset] | None = None) -> Any:
    """What ``json.dumps`` takes for a value; datasets met on the way are appended, and written out where None.

    Raises CodecError for a value that is neither plain nor a dataclass of such.
    """
    if isinstance(value, (float, np.floating)):
        return float(value) if isfinite(value) else {"float": repr(float(value))}
    if isinstance(value, (np.integer, np.bool_)):
        return value.item()
    if isinstance(value, _PLAIN):
        return value
    if is_dataclass(value) and not isinstance(value, type):
        return _encoded_record(value, datasets)
    if isinstance(value, xr.Dataset) and datasets is not None:
        datasets.append(value)
        return {"dataset": len(datasets) - 1}
    if isinstance(value, xr.Dataset):
        return {"whole dataset": encoded(value.to_dict(data="array"))}
    return _encoded_container(value, datasets)


def _encoded_record(value: Any, datasets: list[xr.Dataset] | None) -> dict[str, Any]:
    kind = type(value)
    content = {f.name: encoded(getattr(value, f.name), datasets) for f in fields(value) if f.init}
    return {"dataclass": f"{kind.__module__}:{kind.__qualname__}", "fields": content}


def _encoded_container(value: Any, datasets: list[xr.Dataset] | None) -> Any:
    if isinstance(value, complex):
        return {"complex": [value.real, value.imag]}
    if isinstance(value, np.ndarray):
        return {"array": encoded(value.tolist()), "dtype": value.dtype.str}
    if isinstance(value, tuple):
        return {"tuple": [encoded(one, datasets) for one in value]}
    if isinstance(value, list):
        return [encoded(one, datasets) for one in value]
    if isinstance(value, dict):
        return {"dict": [[encoded(key), encoded(one, datasets)] for key, one in value.items()]}
    raise CodecError(
        f"a value of type {type(value).__name__} cannot be written; use numbers, texts, tuples, arrays or frozen "
        "dataclasses of these"
    )


def decoded(content: Any, datasets: Datasets | None = None) -> Any:
    """The value that ``encoded`` made this of. Raises CodecError for anything else."""
    if isinstance(content, list):
        return [decoded(one, datasets) for one in content]
    if not isinstance(content, dict):
        return content
    kind = next(iter(content), None)
    reader = _READERS.get(kind) if isinstance(kind, str) else None
    if reader is None:
        raise CodecError(f"found {str(content)[:60]}, which no artefact is written as")
    try:
        return reader(content, datasets)
    except (KeyError, TypeError, ValueError, IndexError, AttributeError, ImportError) as error:
        raise CodecError(f"{str(content)[:60]} does not hold what it says ({error})") from error


def _decoded_record(content: dict[str, Any], datasets: Datasets | None) -> Any:
    module, _, name = content["dataclass"].partition(":")
    found: Any = import_module(_own(module))
    for part in name.split("."):
        found = getattr(found, part)
    if not (isinstance(found, type) and is_dataclass(found)):
        raise CodecError(f"{content['dataclass']} is no dataclass")
    return found(**{key: decoded(value, datasets) for key, value in content["fields"].items()})


def _own(module: str) -> str:
    """The name of a module, refused where it is not of the project, its tests or a user's file that was named."""
    if module_file(module) is None and not is_loaded(module):
        raise CodecError(f"{module} is not a module of this project")
    return module


def _decoded_dataset(content: dict[str, Any], datasets: Datasets | None) -> xr.Dataset:
    if datasets is None:
        raise CodecError("a dataset is named where none is stored")
    return datasets[content["dataset"]]


_READERS: dict[str, Callable[[dict[str, Any], Datasets | None], Any]] = {
    "float": lambda content, _: float(content["float"]),
    "complex": lambda content, _: complex(*content["complex"]),
    "array": lambda content, _: np.array(decoded(content["array"]), dtype=np.dtype(content["dtype"])),
    "tuple": lambda content, datasets: tuple(decoded(one, datasets) for one in content["tuple"]),
    "dict": lambda content, datasets: {decoded(key): decoded(one, datasets) for key, one in content["dict"]},
    "dataclass": _decoded_record,
    "dataset": _decoded_dataset,
    "whole dataset": lambda content, _: xr.Dataset.from_dict(decoded(content["whole dataset"])),
}


def digest(value: Any) -> str:
    """SHA-256 of a value; equal values have equal ones, whatever process they are in."""
    datasets: list[xr.Dataset] = []
    text = json.dumps(encoded(value, datasets), separators=(",", ":"), allow_nan=False)
    total = hashlib.sha256(text.encode())
    for data in datasets:
        for name in sorted(str(key) for key in data.variables):
            total.update(name.encode() + np.ascontiguousarray(data[name].values).tobytes())
        total.update(json.dumps(data.attrs, sort_keys=True, default=str).encode())
    return total.hexdigest()
