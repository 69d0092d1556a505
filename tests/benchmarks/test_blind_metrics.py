"""The metrics of a blind score: exact bounds, what counts as naming, what every printed probability claims."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

from benchmarks.blind_metrics import (
    abstains,
    all_true,
    bins_of,
    bounds,
    calibration_error,
    confusion,
    least_error,
    printed,
    right,
    score,
    statements,
)
from benchmarks.blind_score import Code, Some, case_of, cases_of, table_of
from processes import Processes


# The design's table of exact binomial tests: the claim holds when so many cases of so many are right.
@pytest.mark.parametrize(("claim", "n", "passes"), [(0.80, 82, 72), (0.90, 76, 73), (0.90, 179, 168), (0.95, 234, 228)])
def test_lower_bounds_are_exact(claim, n, passes):
    assert bounds(passes, n)[0] >= claim > bounds(passes - 1, n)[0]


@pytest.mark.parametrize(("claim", "n", "passes"), [(0.10, 179, 11), (0.05, 234, 6), (0.05, 124, 2), (0.02, 386, 3)])
def test_upper_bounds_are_exact(claim, n, passes):
    assert bounds(passes, n)[1] <= claim < bounds(passes + 1, n)[1]


@pytest.mark.parametrize(("hits", "n"), [(1, 10), (7, 9), (20, 40)])
def test_a_bound_is_where_the_tail_is_five_percent(hits, n):
    low, high = bounds(hits, n)
    assert binom.sf(hits - 1, n, low) == pytest.approx(0.05)
    assert binom.cdf(hits, n, high) == pytest.approx(0.05)


def case(group="single", effects=None, verdict="effect", names=("coulomb_friction",), chi2=100.0, **more):
    effects = {"coulomb_friction": 1.0} if effects is None else effects
    outside = more.pop("outside", "something" if group == "outside" else "")
    hidden = [*effects, *([outside] if outside else [])]
    values = dict(bench="damper", campaign="x", probability=0.97, ranking={}, intervals={}, alternatives={}, wall_s=1.0)
    values |= dict(p_nothing_missing=0.02, p_none_of_these=0.01, p_remains=0.1, ambient=(), mistake=(), error="")
    return {"group": group, "effects": effects, "outside": outside, "verdict": verdict, "names": list(names), **values,
            "visibility": dict.fromkeys(hidden, chi2), **more}  # fmt: skip


PAIR = {"coulomb_friction": 1.0, "weak_magnets": 0.1}


def test_every_name_that_is_printed_counts():
    assert all_true(case()) and not all_true(case(names=("eddy_drag",)))
    assert all_true(case(verdict="group", names=("eddy_drag", "coulomb_friction"))), "one of a group is meant"
    assert not all_true(case(verdict="partial", names=("coulomb_friction", "eddy_drag"))), "partial is naming"
    assert not all_true(case(verdict="pair", names=("coulomb_friction", "weak_magnets")))
    assert all_true(case("pair", PAIR, "pair", tuple(PAIR)))
    assert all_true(case(names=("coulomb_friction",), verdict="none_of_these")), "none of these prints no effect"
    other = case("pair", PAIR, "pair", ("hysteresis_drag", "weak_magnets"))
    assert not all_true(other)
    assert all_true({**other, "alternatives": {"hysteresis_drag": ["coulomb_friction"]}})
    assert not all_true({**other, "alternatives": {"weak_magnets": ["coulomb_friction"]}}), "one truth counts once"
    apart = case(alternatives={"eddy_drag": ["hysteresis_drag"]})
    assert len(printed(apart)) == 2 and not all_true(apart), "what is said apart from the names is printed too"
    assert all_true(case(effects={"winding_temperature": 9.0}, names=("contact_resistance",))), "one law"


def test_abstaining_prints_nothing_false():
    foreign = lambda **said: case("outside", {}, **said)  # noqa: E731
    assert abstains(foreign(verdict="none_of_these", names=())) and not abstains(foreign(verdict="effect"))
    assert not abstains(foreign(verdict="partial")) and not abstains(foreign(verdict="nothing_missing", names=()))
    friction = dict(effects={"bearing_friction": 0.01}, ambient=("bearing_friction",), names=("bearing_friction",))
    assert abstains(case("outside", verdict="partial", **friction)), "what is there may be named beside"
    assert not abstains(case("outside", verdict="effect", **friction))
    assert abstains(case("outside", verdict="effect", **friction, p_remains=0.8))


def test_what_counts_as_right():
    assert right(case()) and not right(case(names=("eddy_drag",)))
    assert right(case("null", {}, "nothing_missing", ())) and not right(case("null", {}, "effect"))
    assert right(case(verdict="nothing_missing", names=(), chi2=3.0)), "too small to be seen"
    assert right(case("pair", PAIR, "pair", tuple(PAIR))) and not right(case("pair", PAIR))
    wrong_unit = dict(mistake=("unit_factor",))
    assert right(case("mistake", {}, "convention", ("unit_factor",), **wrong_unit))
    assert not right(case("mistake", {}, "effect", **wrong_unit))


def test_every_printed_probability_has_its_own_claim():
    told = {kind: so for kind, _, so in statements(case(ranking={"coulomb_friction": 0.9}))}
    assert told == {"verdict": True, "effect": True, "nothing": False, "none of these": False, "remains": False}
    told = {kind: so for kind, _, so in statements(case("outside", {}, "none_of_these", ()))}
    assert told == {"verdict": True, "nothing": False, "none of these": True, "remains": True}
    small = {kind: so for kind, _, so in statements(case(verdict="nothing_missing", names=(), chi2=1.0))}
    assert small["verdict"] and not small["nothing"], "nothing that is plain; but something is there"
    assert not statements(case(verdict="error", names=(), probability=None, p_remains=None))[0][0] == "verdict"


def test_a_score_holds_all_cases():
    cases = [case()] * 9 + [case(names=("eddy_drag",))] + [case(verdict="nothing_missing", names=(), chi2=2.0)]
    cases += [case("several", {**PAIR, "backlash": 1e-5}, "several", (*PAIR, "backlash"))]
    metrics = {metric.name: metric for metric in score(cases)}
    assert metrics["every printed name true"].value == pytest.approx(10 / 11)
    assert metrics["every printed name true"].passed is False
    assert metrics["visible effect in the printed set"].n == 10
    assert metrics["three or four at once: all found"].value == 1.0
    assert metrics["calibration error, verdict"].n == 12
    assert metrics["abstains outside the library, nothing false"].passed is None, "no case"
    assert "9 of 10" in table_of({"all": list(metrics.values())})


def test_intervals_are_judged_where_the_name_is_true():
    held = case(intervals={"coulomb_friction": (0.5, 2.0)})
    missed = case(intervals={"coulomb_friction": (2.0, 3.0)})
    other = case(names=("eddy_drag",), intervals={"eddy_drag": (0.0, 9.0)})
    metric = next(m for m in score([held] * 9 + [missed, other]) if m.name.startswith("90 %"))
    assert (metric.value, metric.n, metric.passed) == (0.9, 10, True)


def test_calibration_error_is_a_weighted_gap():
    stated = np.repeat([0.2, 0.9], [50, 150])
    hit = np.concatenate([np.arange(50) < 20, np.arange(150) < 135])
    assert calibration_error(stated, hit) == pytest.approx(0.25 * 0.2)
    assert [len(rows) for rows in bins_of(np.array([0.05] * 39 + [0.95] * 60))] == [99], "few cases are no bin"
    assert 0.0 < least_error(stated, np.random.default_rng(1)) < 0.06


def test_confusion_shares_add_to_one():
    grouped = case(verdict="group", names=("coulomb_friction", "eddy_drag"))
    truths, verdicts, table = confusion([case(), grouped, case("null", {}, "nothing_missing", ())])
    assert table.sum(axis=1) == pytest.approx(1.0)
    row = [truth.startswith("coulomb") for truth in truths].index(True)
    assert table[row, verdicts.index("coulomb_friction")] == 0.75


def test_confusion_counts_what_is_said_apart_and_not_what_every_bench_has():
    """Friction of every bench and one of two: the friction stands in no row but where nothing else is said."""
    effects = {"coulomb_friction": 1.0, "eddy_drag": 1.0}
    one = {"names": ("coulomb_friction",), "alternatives": {"eddy_drag": ("viscous_damping",)}, "verdict": "partial"}
    some = case(effects=effects, **one) | {"ambient": ("coulomb_friction",)}
    none = case("null", {"coulomb_friction": 1.0}, "effect", ("coulomb_friction",)) | {"ambient": ("coulomb_friction",)}
    _, verdicts, (seen, nothing) = confusion([some, none])
    assert seen[verdicts.index("eddy_drag")] == seen[verdicts.index("viscous_damping")] == 0.5
    assert nothing[verdicts.index("coulomb_friction")] == 1.0


RANKED = {"name": "a", "probability": 0.9, "parameters": {"size": {"low90": 1.0, "high90": None}}}
SAID = {"verdict": "effect", "names": ["a"], "probability": 0.9, "wall_s": 2.0, "ranking": [RANKED]}


def test_a_case_is_read_from_what_is_written():
    answer = {"bench": "damper", "group": "null", "effects": {}, "visibility": {}}
    read = case_of("damper", "null-1", answer, SAID)
    assert read["ranking"] == {"a": 0.9} and read["intervals"] == {"a": (1.0, np.inf)}
    failed = case_of("damper", "null-1", answer, {"error": "no", "wall_s": 1.0})
    assert failed["verdict"] == "error" and failed["error"] == "no" and failed["probability"] is None


def test_any_checkout_is_asked_in_a_process_of_its_own(tmp_path):
    """A checkout of a few lines stands for the project: it is handed the folder of the campaign, and no answer."""
    code, campaigns = tmp_path / "code", tmp_path / "campaigns"
    _write_checkout(code)
    _write_campaign(campaigns)
    found = cases_of(campaigns, Code(code, "none"), tmp_path / "done.jsonl", Processes(1))
    assert [(c["campaign"], c["verdict"], c["names"]) for c in found] == [
        ("null-1", "effect", ['holdout = { rule = "none" }'])
    ]


def test_only_what_is_asked_for_is_diagnosed(tmp_path):
    groups = {"null-1": "null", "null-2": "null", "single-1": "single"}
    for bench in ("damper", "dq"):
        (tmp_path / bench).mkdir()
        (tmp_path / bench / "answers.json").write_text(json.dumps({n: {"group": g} for n, g in groups.items()}))
    assert list(Some(benches=("dq",)).of(tmp_path)) == ["dq/null-1", "dq/null-2", "dq/single-1"]
    assert list(Some(groups=("null",), most=1).of(tmp_path)) == ["damper/null-1", "dq/null-1"]


def _write_campaign(folder: Path) -> None:
    (folder / "damper" / "null-1").mkdir(parents=True)
    (folder / "damper" / "null-1" / "campaign.toml").write_text("[campaign]\n")
    answer = {"bench": "damper", "group": "null", "seed": 1, "effects": {}, "visibility": {}}
    (folder / "damper" / "answers.json").write_text(json.dumps({"null-1": answer}))


def _write_checkout(folder: Path) -> None:
    says = f"import json\nsaid = {SAID!r}\ndiagnosis_json = lambda c: json.dumps(said | {{'names': [c]}})"
    modules = {
        "effects/library.py": "library = lambda: {}",
        "workbench/data/campaign.py": "read_campaign = lambda f: open(f + '/campaign.toml').read().splitlines()[1]",
        "workbench/errors.py": "class WorkbenchError(Exception): pass",
        "workbench/explain/diagnosis.py": "diagnose = lambda model, campaign, library, seed: campaign",
        "workbench/models/bases.py": "nominal_model = lambda campaign: None",
        "workbench/report/as_json.py": says,
    }
    for name, text in modules.items():
        place = folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        for package in (place.parent, *place.parent.parents):
            if package.is_relative_to(folder) and package != folder:
                (package / "__init__.py").touch()
        place.write_text(text)
