"""How much of what a campaign holds about its one hidden effect the diagnosis makes use of:
``python -m benchmarks.information_used FOLDER``, a folder that ``blind_campaigns`` wrote.

Who made the campaign knows size, correlation and scatter of the noise, and of the hidden effect

    seen   = chi2 that it adds beyond tolerances, instruments and scatter of mounting (``Answer.visibility``)

The diagnosis has to find all of that in the readings. What it gets is the rise of the penalised likelihood

    gained = 2 (ln L(effect) - ln L(nothing)),  ln L = - misfit(residual) - |x|^2 / 2 - |z|^2 / 2

Noise alone makes it scatter around a mean of ``seen``, with a standard deviation of 2 sqrt(seen). So the mean says what
the likelihood wastes, and the scatter what no likelihood can help: 20 of chi2 are 20 +- 9 in the readings.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks.blind_campaigns import ANSWERS, LUMPED
from benchmarks.tables import write_table
from benchmarks.virtual_benches.case import VISIBLE
from effects.library import library
from processes import Pool, Processes
from workbench.data.campaign import read_campaign
from workbench.explain.hypotheses import Hypothesis
from workbench.explain.search import searched
from workbench.likelihood.bench import bench_of
from workbench.models.bases import nominal_model

BANDS = (VISIBLE, 40.0, 80.0, 160.0, 400.0)  # chi2
RESULT = Path(__file__).resolve().parent.parent / "results/reference/blind_score/lumped/information_used.csv"


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
    return 0.0 if found is None else 2.0 * (_height(found) - _height(search.fitted[frozenset()]))


def _height(hypothesis: Hypothesis) -> float:
    fit = hypothesis.fit
    return -hypothesis.problem.misfit(fit.residual) - 0.5 * float(fit.x @ fit.x + fit.z @ fit.z)


def singles(folder: Path, bench: str) -> Iterator[tuple[dict[str, str], float]]:
    """Tasks of the campaigns of a bench that hide one effect of a visibility in ``BANDS``, with that."""
    answers = json.loads((folder / bench / ANSWERS).read_text(encoding="utf-8"))
    for name, answer in answers.items():
        for effect, seen in answer["visibility"].items():
            if answer["group"] == "single" and BANDS[0] <= seen < BANDS[-1]:
                yield {"folder": str(folder / bench / name), "effect": effect}, seen


def used(folder: Path, benches: Iterable[str], pool: Pool) -> list[Used]:
    """What is used of what the campaigns of a folder hold, by bands of visibility."""
    found = [one for bench in benches for one in singles(folder, bench)]
    answers = [pool.submit(gained, task) for task, _ in found]
    return list(bands(np.array([seen for _, seen in found]), np.array([pool.result(a) for a in answers])))


def main(arguments: list[str] | None = None) -> None:
    """Writes the table."""
    parser = argparse.ArgumentParser(description="what the diagnosis makes of what a campaign holds")
    parser.add_argument("folder", type=Path, help="campaigns that benchmarks.blind_campaigns wrote")
    parser.add_argument("--out", type=Path, default=RESULT)
    chosen = parser.parse_args(arguments)
    pool = Processes()
    try:
        write_table(chosen.out, used(chosen.folder, LUMPED, pool))
    finally:
        pool.end()


if __name__ == "__main__":
    main()
