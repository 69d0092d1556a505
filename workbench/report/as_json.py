"""Findings as JSON: plain numbers, NaN and infinity as null, keys as agreed with those who read the files."""

from __future__ import annotations

import json
from dataclasses import is_dataclass
from math import isfinite
from typing import Any

import numpy as np

from workbench.findings import Comparison, Diagnosis, Validation
from workbench.report.sentences import comparison_sentence, readings, verdict_sentence
from workbench.report.validation import chi2, share, validation_sentence, warnings


def comparison_json(comparison: Comparison) -> str:
    """The text of ``comparison.json``."""
    whole = plain(comparison)
    views = ("regimes", "orders", "scalings", "parities", "sequences", "whiteness", "signatures")
    content = {
        "campaign": comparison.campaign,
        "model": {"base": comparison.model, "effects": list(comparison.effects)},
        "failing": comparison.failing,
        "chi2_per_n": comparison.chi2_per_n,
        "held_out_chi2_per_n": comparison.held_out_chi2_per_n,
        "channels": whole["scoreboard"],
        "tolerance_pulls": whole["pulls"],
        "views": [plain(reading) for reading in readings(comparison)],
        "numbers": {name: whole[name] for name in views},
        "checks": whole["checks"],
        "complaints": whole["complaints"],
        "sentence": comparison_sentence(comparison),
        "provenance": whole["provenance"],
    }
    return _text(content)


def diagnosis_json(diagnosis: Diagnosis) -> str:
    """The text of ``diagnosis.json``."""
    whole = plain(diagnosis)
    power = dict(diagnosis.abstention_power)
    keep = ("before", "after", "posteriors", "abstention_power", "wall_s")
    content = {
        **{name: value for name, value in whole.items() if name not in keep},
        "abstention_power": power[max(power)] if power else None,
        "abstention_power_by_size": {f"{size:g}": share for size, share in power.items()},
        "sentence": verdict_sentence(diagnosis),
        "wall_s": diagnosis.wall_s,
    }
    return _text(content)


def validation_json(validation: Validation) -> str:
    """The text of ``validation.json``; ``channels`` are those of the corrected model."""
    whole = plain(validation)
    parts = {"corrected": validation.corrected, "base": validation.base}
    content = {
        "campaign": validation.campaign,
        "model": {
            "base": validation.model,
            "effects": list(validation.effects),
            "learned_from": validation.learned_from,
        },
        "channels": whole["corrected"],
        **{
            name: {"channels": whole[name], "chi2_per_n": chi2(channels), "share_in_90": share(channels)}
            for name, channels in parts.items()
        },
        "calibrations": whole["calibrations"],
        "base_calibrations": whole["base_calibrations"],
        "range_left": whole["range_left"],
        "sentence": validation_sentence(validation),
        "warnings": warnings(validation),
        "complaints": whole["complaints"],
        "provenance": whole["provenance"],
    }
    return _text(content)


def plain(value: Any) -> Any:
    """Dataclasses, arrays and mappings as what JSON knows."""
    if is_dataclass(value) and not isinstance(value, type):
        return {name: plain(getattr(value, name)) for name in value.__dataclass_fields__}
    if isinstance(value, dict):
        return {str(key): plain(v) for key, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, (np.generic,)):
        return plain(value.item())
    if isinstance(value, float) and not isfinite(value):
        return None
    return value


def _text(content: dict[str, Any]) -> str:
    return json.dumps(plain(content), indent=2, allow_nan=False) + "\n"
