"""A small study designed, put on a bench as a draft, and designed again with what was learned."""

from contextlib import contextmanager

import numpy as np
import pandas as pd
import pytest
from small_studies import fitted, here, small

from drivetrain.learned import (
    END_LEAKAGE,
    NOTHING_LEARNED,
    REMANENCE,
    RESISTANCE,
    ROTOR_FRICTION,
    Learned,
    Lesson,
)
from drivetrain.second_design import ALL_TOGETHER, AS_DESIGNED
from pipeline.campaign_command import designed, write_campaign
from pipeline.campaign_draft import BENCHES, on_bench
from pipeline.codec import digest
from pipeline.graph import product
from pipeline.results import Results
from pipeline.run import Run
from pipeline.run_command import first_design
from pipeline.stages import graph_of, graph_of_second_design
from processes import ThisProcess
from study.errors import StudyError
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.models.actuator.design import written
from workbench.models.bases import nominal_model

SEAL, WEAKER, LEAKING = 0.05, 0.9, 0.02
LEARNED = Learned(
    (
        Lesson("weak_magnets", "weaker magnets", REMANENCE, WEAKER, 0.004),
        Lesson("friction_torque", "friction", ROTOR_FRICTION, SEAL),
        Lesson("end_leakage", "end leakage", END_LEAKAGE, LEAKING),
        Lesson("winding_temperature", "warm winding", RESISTANCE, 1.1),
    ),
    ("torque_gain is an error of an instrument.",),
    "model.toml",
)
LEFT_OUT = ("drive", "braking", "gap_stress", "magnets", "mechanics", "losses", "fields", "tolerances", "uncertainty",
            "package")  # fmt: skip


@contextmanager
def quick():
    """Fewer radii in the match."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("drivetrain.matching.RADII", 8)
        yield


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    # one path in star: what the machine bench knows
    return small("pump", tmp_path_factory.mktemp("study"), winding_selection__parallel_paths="[1]",
                 winding_selection__connections='["star"]')  # fmt: skip


@pytest.fixture(scope="module")
def first(study, tmp_path_factory):
    with quick():
        return here(study, tmp_path_factory.mktemp("first"), fitted(study, LEFT_OUT))


@pytest.fixture(scope="module")
def second(study, first, tmp_path_factory):
    graph = graph_of_second_design(study, LEARNED, first_design(first))
    with quick():
        return here(study, tmp_path_factory.mktemp("second"), fitted(study, LEFT_OUT, graph))


def test_nothing_learned_leaves_every_input_as_it_was(study, tmp_path):
    graphs = (graph_of(study), graph_of(study, NOTHING_LEARNED), graph_of(study, LEARNED))
    plain, again, taught = (Run(graph, study, Results(tmp_path), ThisProcess()) for graph in graphs)
    for kind in ("FieldCase", "WindingInputs", "LossInputs", "OutcomeInputs"):
        made = next(k for k in _kinds(plain) if k.__name__ == kind)
        assert digest(plain.value(made)) == digest(again.value(made)), kind
        assert (digest(taught.value(made)) == digest(plain.value(made))) == (kind == "LossInputs"), kind


def _kinds(run):
    return [product(node.function) for node in run.graph.nodes]


def test_each_lesson_costs_what_its_law_says(first, second):
    rows = {row.reason: row for row in second.results.load("lessons").rows}
    plain, outcome = rows[AS_DESIGNED], first.results.load("outcome")
    assert plain.peak_effort == pytest.approx(outcome.features.effort_peak, rel=0.01)
    assert rows["friction_torque"].peak_effort == pytest.approx(plain.peak_effort - SEAL)
    assert rows["end_leakage"].continuous_effort == pytest.approx((1 - LEAKING) * plain.continuous_effort)
    assert rows["winding_temperature"].peak_effort == plain.peak_effort
    weaker = rows["weak_magnets"].peak_effort / plain.peak_effort
    assert WEAKER < weaker < WEAKER + 0.05, "less flux, and steel less saturated"
    together = rows[ALL_TOGETHER]
    assert together.length > max(row.length for name, row in rows.items() if name != ALL_TOGETHER)
    assert together.peak_effort < min(row.peak_effort for name, row in rows.items() if name != ALL_TOGETHER)


def test_the_second_design_holds_with_its_losses_counted(first, second):
    before, after = (run.results.load("outcome") for run in (first, second))
    assert after.active_length > before.active_length
    asked = {type(one.requirement).__name__: one for one in after.checks}
    assert asked["PeakEffortAtRest"].holds
    winding, heat = (second.results.load(name) for name in ("winding", "heat"))
    assert asked["ContinuousEffort"].reached == pytest.approx(heat.effort(heat.at_speed.torque) - SEAL)
    assert asked["PeakEffortAtRest"].reached == pytest.approx(winding.peak_torque - SEAL)
    assert after.limits.coulomb_friction == pytest.approx(before.limits.coulomb_friction + SEAL)
    cold = first.results.load("winding").wound.design.wire.resistivity
    assert winding.wound.design.wire.resistivity == pytest.approx(1.1 * cold)


def test_the_report_begins_with_what_was_learned(second):
    html = (second.results.folder / "report.html").read_text(encoding="utf-8")
    assert html.index("What the bench has taught") < html.index("Outcome")
    assert "remanence of the magnets times 0.9000 ± 0.004" in html
    assert "Not used: torque_gain is an error of an instrument." in html
    table = pd.read_csv(second.results.folder / "lessons.csv")
    assert list(table.lesson) == [AS_DESIGNED, *(one.reason for one in LEARNED.lessons), ALL_TOGETHER]
    assert table.peak_change_percent[0] == 0.0


@pytest.fixture(params=list(BENCHES))
def folder(request, study, first, tmp_path):
    draft = BENCHES[request.param].draft(designed(study, first.results))
    write_campaign(tmp_path / request.param, draft, "a test")
    return tmp_path / request.param


def test_a_draft_says_that_nothing_was_measured(folder):
    with pytest.raises(WorkbenchError, match="no row has a number"):
        read_campaign(folder)


def test_the_model_of_a_draft_answers_as_the_design(folder, study, first):
    for path in folder.glob("*.csv"):
        pd.read_csv(path).fillna(1.0).to_csv(path, index=False)
    campaign = read_campaign(folder)
    model, winding = nominal_model(campaign), first.results.load("winding")
    assert model.base.name == folder.name and len(campaign.tables) >= 4 and campaign.repeats == 2
    for tolerance in campaign.tolerances:
        assert tolerance.source and model.base.with_tolerance(model.design, tolerance, 1.0) != model.design
    if folder.name == "machine":
        drawn, wound = model.design.machine, winding.wound
        names = [name for name in vars(drawn) if name.endswith(("radius", "width", "length", "gap", "d1", "opening"))]
        assert len(names) == 9 and all(
            getattr(drawn, name) == pytest.approx(getattr(wound.machine, name)) for name in names
        )
        assert set(model.design.turns) == {wound.design.turns} and model.design.length == pytest.approx(
            wound.active_length
        )
        return
    field = winding.wound.on_map(first.results.load("flux_map").data)
    volts = 1.5**0.5 * field.pole_pairs * 100.0 * float(field.flux_linkage(0.0, 0.0)[0])
    emf = model.base.respond(model.design, "back_emf", {"speed": np.array([100.0])})["v_ll"]
    assert emf[0] == pytest.approx(volts, rel=1e-5)
    current = winding.limits.current_peak
    if folder.name == "actuator":
        held = model.base.respond(model.design, "locked_force", {"current": np.array([current])})["torque"]
        assert held[0] == pytest.approx(float(field.torque(0.0, current)), rel=1e-4)
        described = written(on_bench(designed(study, first.results)))
        assert written(model.design.drawn) == pytest.approx(described, rel=1e-6)


def test_a_campaign_is_never_overwritten(folder, study, first):
    draft = BENCHES["dq"].draft(designed(study, first.results))
    with pytest.raises(StudyError, match="exists already"):
        write_campaign(folder, draft, "a test")


def test_without_a_design_there_is_no_draft(study, tmp_path):
    with pytest.raises(StudyError, match="no usable result of winding"):
        designed(study, Results(tmp_path))
