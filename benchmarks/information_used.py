"""How much of what a campaign holds about its one hidden effect the diagnosis makes use of:
``python -m benchmarks.information_used FOLDER``, a folder that ``blind_campaigns`` wrote.

Who made the campaign knows size, correlation and scatter of the noise, and of the hidden effect

    seen   = chi2 that it adds beyond tolerances, instruments and scatter of mounting (``Answer.visibility``)

The diagnosis has to find all of that in the readings. What it gets is the rise of the likelihood at the best fit,
tolerances and instruments x at their prior's cost as they are for ``seen``, the size of the effect at none

    gained = 2 (ln L(effect) - ln L(nothing)),  ln L = - misfit(residual) - |x|^2 / 2

Noise of known size makes it scatter by 2 sqrt(seen) around seen + 1, the one for the size that is fitted. So the mean
says what the likelihood wastes, and such a scatter is what no likelihood can help: 20 of chi2 are 20 +- 9 as read.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.blind_campaigns import LUMPED
from benchmarks.blind_score import RESULTS, WORK, Code, Some, workers_on
from benchmarks.tables import write_table
from benchmarks.virtual_benches.case import VISIBLE
from effects.library import library
from pipeline.pools import Interrupted
from processes import Pool, Processes
from workbench.data.campaign import read_campaign
from workbench.explain.search import searched
from workbench.likelihood.bench import bench_of
from workbench.likelihood.fit import Fit, prior_cost
from workbench.models.bases import nominal_model

BANDS = (VISIBLE, 40.0, 80.0, 160.0, 400.0)  # chi2


@dataclass(frozen=True)
class Used:
    """Campaigns with one hidden effect of some visibility. seen, gained: means [chi2]

    share: of the sums, gained over seen
    deviation: root mean square of gained - seen over 2 sqrt(seen), 1 where noise of known size is all that scatters
    """

    chi2_from: float
    chi2_to: float
    campaigns: int
    seen: float
    gained: float
    share: float
    deviation: float


def bands(seen: np.ndarray, gained: np.ndarray) -> Iterator[Used]:
    """One row for each band of visibility that has campaigns. seen, gained: of each campaign (n,) [chi2]"""
    for low, high in zip(BANDS, BANDS[1:]):
        inside = (low <= seen) & (seen < high)
        if not inside.any():
            continue
        s, g = seen[inside], gained[inside]
        deviation = np.sqrt(np.mean((g - s) ** 2 / (4 * s)))
        values = (s.mean(), g.mean(), g.sum() / s.sum(), deviation)
        yield Used(low, high, len(s), *(round(float(value), 3) for value in values))


def gained(task: Mapping[str, str]) -> float:
    """chi2 that the hidden effect alone gains over nothing; 0 where the search did not find it worth a fit.

    task: ``folder`` of the campaign and ``effect``, the name of what is hidden
    """
    campaign, effects = read_campaign(task["folder"]), library()
    search = searched(bench_of(nominal_model(campaign), campaign, effects), effects, lambda words: None)
    found = search.fitted.get(frozenset((task["effect"],)))
    return 0.0 if found is None else 2.0 * (_cost(search.fitted[frozenset()].fit) - _cost(found.fit))


def _cost(fit: Fit) -> float:
    """Minus ln L."""
    return fit.objective - prior_cost(fit.z)


def singles(folder: Path) -> Iterator[tuple[str, str, float]]:
    """Bench/campaign, effect and its visibility where one effect of a visibility in ``BANDS`` is hidden."""
    for key, answer in Some(tuple(LUMPED), ("single",)).of(folder).items():
        ((effect, seen),) = answer["visibility"].items()
        if BANDS[0] <= seen < BANDS[-1]:
            yield key, effect, seen


def used(folder: Path, pool: Pool) -> list[Used]:
    """What is used of what the campaigns of a folder hold, by bands of visibility; each campaign is printed."""
    found = list(singles(folder))
    tasks = {key: {"folder": str(folder / key), "effect": effect} for key, effect, _ in found}
    gains = workers_on(folder, Code(), WORK / "information_used.jsonl", pool).map("information used", gained, tasks)
    for key, effect, seen in found:
        print(f"{key}: {effect} chi2 {seen:.1f}, gained {gains[key]:.1f}")
    return list(bands(np.array([seen for _, _, seen in found]), np.array([gains[key] for key, _, _ in found])))


def main(arguments: list[str] | None = None) -> None:
    """Writes the table."""
    parser = argparse.ArgumentParser(description="what the diagnosis makes of what a campaign holds")
    parser.add_argument("folder", type=Path, help="campaigns that benchmarks.blind_campaigns wrote")
    parser.add_argument("--out", type=Path, default=RESULTS / "information_used.csv")
    chosen = parser.parse_args(arguments)
    try:
        write_table(chosen.out, used(chosen.folder, Processes()))
    except Interrupted as stopped:
        raise SystemExit(str(stopped)) from None


if __name__ == "__main__":
    main()
