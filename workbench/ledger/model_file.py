"""A model on disk: TOML with the device, the effects and the fitted inputs with their covariance, in SI. Data, never
executed."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import MISSING, fields
from pathlib import Path

import numpy as np

from disk import write_atomically
from effects.base import Effect
from effects.parameter import parameters_of
from workbench.data.table import Systematic, Tolerance
from workbench.errors import WorkbenchError
from workbench.ledger.learned import FittedCalibration, FittedInput, Learned, LearnedRange, Source, device_hash
from workbench.ledger.model_schema import CovarianceSection, FileSchema, LearnedSection, RangeSection, content_of
from workbench.models.model import Model

NAME = "model.toml"
DIGITS = 9  # of an entry of the covariance
ROUNDING = 1e-6  # of a correlation matrix written with so many digits
_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


# ---- writing --------------------------------------------------------------------------------------------------------


def write_model(path: Path, learned: Learned) -> None:
    """Writes a model file, whole or not at all."""
    text = learned_text(learned)
    write_atomically(path, lambda part: part.write_text(text, encoding="utf-8"))


def learned_text(learned: Learned) -> str:
    """The text of a model file."""
    lines = ["# What was learned about a device: base model, effects and fitted inputs, in SI. A shift is from the"]
    lines.append("# drawing, relative or SI; `airgap validate` applies all of it to other data.")
    lines += _section("model", {"base": learned.base})
    lines += _section("device", learned.device) if learned.device else []
    lines += _source(learned.source) if learned.source else []
    lines += _effects(learned.effects)
    for x in learned.inputs:
        t = x.tolerance
        values = {"name": t.name, "shift": x.shift, "sigma": t.sigma, "relative": t.relative, "source": t.source}
        lines += _section("input", values, repeated=True)
    for c in learned.calibrations:
        s = c.systematic
        values = {"name": s.name, "kind": s.kind, "shift": c.shift, "sigma": s.sigma}
        lines += _section("calibration", values, repeated=True)
    lines += _section("numerical_error", {"weights": learned.weights}) if learned.weights else []
    return "\n".join(lines + _covariance(learned)) + "\n"


def model_text(model: Model) -> str:
    """The text of a model without fitted inputs: the base and the effects."""
    return "\n".join(_section("model", {"base": model.base.name}) + _effects(model.effects)) + "\n"


def model_hash(model: Model) -> str:
    """SHA-256 of the base, the design and the effects of a model."""
    return hashlib.sha256(f"{model.design!r}\n{model_text(model)}".encode()).hexdigest()


def _section(name: str, values: Mapping[str, object], repeated: bool = False) -> list[str]:
    head = f"[[{name}]]" if repeated else f"[{name}]"
    return ["", head, *(f"{_key(key)} = {_toml(value)}" for key, value in values.items())]


def _effects(effects: Iterable[Effect]) -> list[str]:
    return [
        line
        for effect in effects
        for line in _section(
            "effect", {"name": effect.name(), **{f.name: getattr(effect, f.name) for f in fields(effect)}}, True
        )
    ]


def _source(source: Source) -> list[str]:
    head = {"campaign": source.campaign, "device_sha256": source.device_sha256, "data_sha256": source.data_sha256}
    lines = _section("learned", head)
    for r in source.ranges:
        values = {"kind": r.kind, "response": r.response, "rows": r.rows, "chi2_per_n": r.chi2_per_n,
                  "unexplained": r.unexplained}  # fmt: skip
        lines += _section("learned.range", {**values, "conditions": r.conditions}, repeated=True)
    return lines


def _covariance(learned: Learned) -> list[str]:
    if not learned.names or learned.source is None:
        return []
    rows = ("  [" + ", ".join(f"{value:.{DIGITS}g}" for value in row) + "]," for row in learned.covariance)
    return [*_section("covariance", {"names": learned.names}), "rows = [", *rows, "]"]


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _text(key)


def _text(value: str) -> str:
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(str(k))} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_toml, value)) + "]"
    raise WorkbenchError(f"a model file holds numbers, texts, lists and tables only, found {value!r}.")


# ---- reading --------------------------------------------------------------------------------------------------------


def read_model(path: str | Path, library: Mapping[str, type[Effect]]) -> Learned:
    """What a model file holds; files with effects only are read too.

    Raises:
        WorkbenchError: one sentence, what is wrong in the file.
    """
    path = Path(path)
    content = content_of(path)
    learned = Learned(
        base=content.model.base,
        device=content.device,
        effects=_effects_of(content, library, path),
        inputs=tuple(FittedInput(Tolerance(x.name, x.sigma, x.relative, x.source), x.shift) for x in content.input),
        calibrations=tuple(
            FittedCalibration(Systematic(c.name, c.kind, c.sigma), c.shift) for c in content.calibration
        ),
        weights=tuple(content.numerical_error.weights) if content.numerical_error else (),
        source=_source_of(content.learned, content.device, path),
    )
    if learned.source is None:
        return learned
    return Learned(**{**vars(learned), "covariance": _covariance_of(content.covariance, learned.names, path)})


def with_effects_of(path: str | Path, nominal: Model, library: Mapping[str, type[Effect]]) -> Model:
    """The nominal model with the effects of a model file; a fit starts from them and finds the inputs anew.

    Raises:
        WorkbenchError: as ``read_model``, or another base model.
    """
    return with_effects(read_model(path, library), nominal, path)


def with_effects(learned: Learned, nominal: Model, path: str | Path) -> Model:
    """The nominal model with what was learned about effects. path: of the file, for its sentence

    Raises:
        WorkbenchError: another base model.
    """
    if learned.base != nominal.base.name:
        raise WorkbenchError(f"{path}: is of base model {learned.base!r}, the campaign needs {nominal.base.name!r}.")
    model = nominal
    for effect in learned.effects:
        model = model + effect
    return model


def _effects_of(content: FileSchema, library: Mapping[str, type[Effect]], path: Path) -> tuple[Effect, ...]:
    effects = tuple(_effect(entry, library, path) for entry in content.effect)
    names = [effect.name() for effect in effects]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise WorkbenchError(f"{path}: the effect {twice[0]!r} stands there twice; keep one.")
    return effects


def _require_a_form(cls: type[Effect], values: Mapping[str, object], path: Path) -> None:
    """What is no parameter is of the type that the effect has it with: the number of a magnet, the name of a phase."""
    for f in (f for f in fields(cls) if f.name in values and f.name not in parameters_of(cls)):
        if f.default is not MISSING and type(values[f.name]) is not type(f.default):
            raise WorkbenchError(
                f"{path}: {cls.name()}.{f.name} must be of the kind of {f.default!r}, found {values[f.name]!r}."
            )


def _effect(entry: Mapping[str, object], library: Mapping[str, type[Effect]], path: Path) -> Effect:
    name = entry.get("name")
    if name not in library:
        raise WorkbenchError(f"{path}: the effect {name!r} is not known; name the file it is in with --effects-from.")
    cls, values = library[name], {key: value for key, value in entry.items() if key != "name"}
    unknown = set(values) - {f.name for f in fields(cls)}
    if unknown:
        known = ", ".join(f.name for f in fields(cls))
        raise WorkbenchError(f"{path}: {name} has no parameter {sorted(unknown)[0]!r}; it has {known}.")
    _require_a_form(cls, values, path)
    effect = cls(**values)
    for key, p in parameters_of(cls).items():
        value = getattr(effect, key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not p.low <= value <= p.high:
            raise WorkbenchError(
                f"{path}: {name}.{key} must be a number from {p.low:g} to {p.high:g}, found {value!r}."
            )
    return effect


def _source_of(section: LearnedSection | None, device: Mapping[str, object], path: Path) -> Source | None:
    if section is None:
        return None
    if section.device_sha256 != device_hash(device):
        raise WorkbenchError(
            f"{path}: [device] is not the one that the numbers were learned with; take the file as it was written."
        )
    ranges = tuple(
        LearnedRange(r.kind, r.response, r.rows, r.chi2_per_n, r.unexplained, _spans_of(r)) for r in section.range
    )
    return Source(section.campaign, section.device_sha256, section.data_sha256, ranges)


def _spans_of(section: RangeSection) -> dict[str, tuple[float, float]]:
    return {name: (low, high) for name, (low, high) in section.conditions.items()}


def _covariance_of(section: CovarianceSection | None, names: tuple[str, ...], path: Path) -> np.ndarray:
    """Checked: of these names, symmetric, no variance below zero."""
    if section is None and not names:
        return np.zeros((0, 0))
    if section is None:
        raise WorkbenchError(f"{path}: [covariance] is missing, so that the numbers have no uncertainty.")
    if tuple(section.names) != names:
        raise WorkbenchError(
            f"{path}: [covariance] names must be {', '.join(names)}; found {', '.join(section.names)}."
        )
    if [len(row) for row in section.rows] != [len(names)] * len(names):
        raise WorkbenchError(f"{path}: [covariance] rows must be {len(names)} rows of {len(names)} numbers.")
    covariance = np.array(section.rows)
    if not _is_covariance(covariance):
        raise WorkbenchError(f"{path}: [covariance] rows are no covariance: not symmetric, or a variance below zero.")
    return covariance


def _is_covariance(matrix: np.ndarray) -> bool:
    variance = np.diag(matrix)
    if (variance < 0).any():
        return False
    sd = np.sqrt(np.where(variance > 0, variance, 1.0))
    correlation = matrix / np.outer(sd, sd)
    symmetric = np.allclose(correlation, correlation.T, rtol=0, atol=ROUNDING)
    return symmetric and bool(np.linalg.eigvalsh(correlation).min() > -ROUNDING)
