"""A model on disk: TOML with the name of the base model and its effects in order, parameters in SI. Data, never
executed."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from effects.base import Effect
from effects.parameter import parameters_of
from workbench.errors import WorkbenchError
from workbench.models.model import Model

NAME = "model.toml"


def model_text(model: Model) -> str:
    """The text of a model file."""
    lines = ["# Model of a device: a base model and the effects that were added to it, parameters in SI.", "[model]"]
    lines.append(f'base = "{model.base.name}"')
    for effect in model.effects:
        lines += ["", "[[effect]]", f'name = "{effect.name()}"']
        lines += [f"{f.name} = {_toml(getattr(effect, f.name))}" for f in fields(effect)]
    return "\n".join(lines) + "\n"


def with_effects_of(path: str | Path, nominal: Model, library: Mapping[str, type[Effect]]) -> Model:
    """The nominal model with the effects of a model file.

    Raises:
        WorkbenchError: not TOML, another base model, an effect or parameter that is not known.
    """
    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise WorkbenchError(f"{path}: cannot be read as a model file: {error}.") from None
    base = content.get("model", {}).get("base")
    if base != nominal.base.name:
        raise WorkbenchError(f"{path}: is of base model {base!r}, the campaign needs {nominal.base.name!r}.")
    model = nominal
    for entry in content.get("effect", []):
        model = model + _effect(entry, library, path)
    return model


def model_hash(model: Model) -> str:
    """SHA-256 of the base, the design and the effects of a model."""
    return hashlib.sha256(f"{model.design!r}\n{model_text(model)}".encode()).hexdigest()


def _effect(entry: Mapping[str, object], library: Mapping[str, type[Effect]], path: Path) -> Effect:
    name = entry.get("name")
    if name not in library:
        raise WorkbenchError(f"{path}: the effect {name!r} is not known; name the file it is in with --effects-from.")
    cls, values = library[name], {key: value for key, value in entry.items() if key != "name"}
    unknown = set(values) - {f.name for f in fields(cls)}
    if unknown:
        known = ", ".join(f.name for f in fields(cls))
        raise WorkbenchError(f"{path}: {name} has no parameter {sorted(unknown)[0]!r}; it has {known}.")
    effect = cls(**values)
    for key, p in parameters_of(cls).items():
        value = getattr(effect, key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not p.low <= value <= p.high:
            raise WorkbenchError(
                f"{path}: {name}.{key} must be a number from {p.low:g} to {p.high:g}, found {value!r}."
            )
    return effect


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    raise WorkbenchError(f"a model file holds numbers and texts only, found {value!r}.")
