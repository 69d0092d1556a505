"""Which of two readings is wild is asked again of a model that holds what was found to be missing."""

import numpy as np
import pytest

import workbench.explain.tried as tried_module
from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.explain.search import searched
from workbench.likelihood.bench import bench_of, reweighed
from workbench.models.model import Model

ROWS, WILD, U = 40, 5, 0.05  # readings of a repeat, number of the wild one, declared uncertainty [N]
PARTNER = ROWS + WILD


def bench_with(folder, wild):
    """An even part of 3 N that the model lacks, and one reading of the first of two fitted repeats off [N]."""
    path = written(folder, n=ROWS, repeats=3, extra=lambda x: 3.0 * (x / 0.01) ** 2) / "pull.csv"
    lines = path.read_text(encoding="utf-8").splitlines()
    head, force = lines[1 + WILD].rsplit(",", 1)
    lines[1 + WILD] = f"{head},{float(force) + wild:.6f}"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    campaign = read_campaign(folder)
    return bench_of(Model(SpringModel(), SpringModel().design(campaign.device)), campaign, LIBRARY)


@pytest.mark.parametrize("wild", (-20 * U, 20 * U))
def test_the_wild_reading_is_told_by_a_model_that_explains_the_others(tmp_path, wild):
    """One that lies towards the model, which lacks more than that, makes its partner look the wilder one."""
    bench = bench_with(tmp_path, wild)
    looks_wild, looks_good = (PARTNER, WILD) if wild < 0 else (WILD, PARTNER)
    assert bench.noise.inflation[looks_wild] > 3 > bench.noise.inflation[looks_good]
    search = searched(bench, LIBRARY)
    assert search.bench.noise.inflation[WILD] > 3 and search.bench.noise.inflation[PARTNER] < 1.5
    (said,) = (words for words in search.bench.complaints if "counts less" in words)
    assert f"pull.csv: force in line {WILD + 2}, repeat 0 (" in said
    assert search.ranked[0] == frozenset(("bump",)) and search.posterior.remains < 0.2


def test_a_search_that_begins_anew_takes_along_where_its_fits_ended(tmp_path, monkeypatch):
    begun, fitted_from = [], tried_module.fitted_from

    def noted(bench, effects, x, z, slopes=None):
        begun.append((bench.noise, frozenset(effect.name() for effect in effects), z))
        return fitted_from(bench, effects, x, z, slopes)

    monkeypatch.setattr(tried_module, "fitted_from", noted)
    search, bump = searched(bench_with(tmp_path, -20 * U), LIBRARY), frozenset(("bump",))
    first = next(z for noise, names, z in begun if noise is search.bench.noise and names == bump)
    assert np.array_equal(first, search.before[bump].z)
    assert search.signatures.white is search.bench.fit.white, "what effects do is held against the noise as it is now"


def test_where_no_reading_changes_sides_the_bench_stays(tmp_path):
    bench = bench_with(tmp_path, 0.0)
    assert reweighed(bench, bench.fit.predictor.on(bench.stack).predict(bench.null.x)) is bench
    search = searched(bench, LIBRARY)
    assert search.bench is bench and not search.before
