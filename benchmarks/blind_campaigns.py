"""Writes blind campaigns as files: ``python -m benchmarks.blind_campaigns FOLDER --tune 120``.

    FOLDER/damper/single-10003/campaign.toml, *.csv     what a laboratory hands over
    FOLDER/damper/answers.json                          what was hidden, by the name of the campaign's folder
    FOLDER/hashes.json                                  SHA-256 of every campaign and of every answers.json

so that any version of the diagnosis can be tried on the same campaigns, and the answers can be sealed by their hash.
Tuning campaigns come from other seeds and hide other kinds of outside truths than scored ones.
"""

from __future__ import annotations

import argparse
import hashlib
import json
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path

from benchmarks.virtual_benches.case import GROUPS, Answer, Bench
from benchmarks.virtual_benches.damper_bench import CATALOGUE as DAMPER
from benchmarks.virtual_benches.dq_bench import CATALOGUE as DQ
from benchmarks.virtual_benches.hiding import hide
from pipeline.pools import Processes, TaskWorkers

TUNING_START, SCORED_START = 10000, 0  # first seeds
LUMPED = {"damper": DAMPER, "dq": DQ}
SHARES = {"null": 0.25, "single": 0.30, "pair": 0.08, "several": 0.12, "outside": 0.17, "mistake": 0.08}
ANSWERS, HASHES = "answers.json", "hashes.json"


@dataclass(frozen=True)
class Wanted:
    """One campaign to be made. scored: from the scored seeds and kinds, not from those for tuning"""

    bench: str
    group: str
    number: int
    scored: bool

    @property
    def seed(self) -> int:
        return self.number + (SCORED_START if self.scored else TUNING_START)

    @property
    def name(self) -> str:
        return f"{self.group}-{self.seed}"


def wanted(bench: str, count: int, scored: bool, groups: Iterable[str] = GROUPS) -> list[Wanted]:
    """So many campaigns of a bench, shared among the groups as ``SHARES`` says."""
    groups = list(groups)
    whole = sum(SHARES[group] for group in groups)
    counts = {group: max(round(count * SHARES[group] / whole), 1) for group in groups}
    return [Wanted(bench, group, n, scored) for group in groups for n in range(counts[group])]
