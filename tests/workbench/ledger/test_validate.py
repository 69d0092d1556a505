"""A model file on other data: nothing of the device moves, the band holds what it promises, what is outside is said."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import pytest

from tests.workbench.toy_bench import LIBRARY, Hardening, Spring, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.data.table import Response, Systematic, Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.ledger.applied import Known, predicted
from workbench.ledger.learned import FittedInput, learned_from
from workbench.ledger.model_file import read_model, write_model
from workbench.ledger.validate import HALF_90, validate
from workbench.likelihood.bench import bench_of
from workbench.likelihood.nuisance import DeclaredError
from workbench.models.model import Model
from workbench.report.validation import validation_sentence, warnings

NOMINAL = Model(SpringModel(), Spring(1000.0))
TRUE = {"extra": lambda x: 3e5 * x**3, "stiffness": 1012.0}


@pytest.fixture(scope="module")
def learned(tmp_path_factory):
    campaign = read_campaign(written(tmp_path_factory.mktemp("c") / "learned", n=200, **TRUE))
    return learned_from(bench_of(NOMINAL + Hardening(2e5), campaign, LIBRARY))


def other(folder, edit=lambda text: text, **truth):
    written(folder, seed=7, **{**TRUE, **truth})
    toml = folder / "campaign.toml"
    toml.write_text(edit(toml.read_text()))
    return read_campaign(folder)


def test_other_data_of_the_device_are_predicted(learned, tmp_path):
    found = validate(learned, other(tmp_path / "n"), LIBRARY, nominal=NOMINAL)
    (right,), (drawn,) = found.corrected, found.base
    assert right.chi2_per_n == pytest.approx(1.0, abs=0.3) and drawn.chi2_per_n > 5
    assert 0.82 < right.share_in_90 < 0.97 and right.rms_error < 0.5 * drawn.rms_error
    assert right.n == 120 and right.unit == "N" and right.outside_range == 0.0 and found.range_left == ()


def test_columns_that_look_like_another_convention_are_said_to(learned, tmp_path):
    """Forces in kN under N: a gain of the instrument would take it up."""
    campaign = other(tmp_path / "kn")
    (table,) = campaign.tables
    force = table.responses["force"]
    small = replace(table, responses={"force": replace(force, values=force.values / 1000)})
    found = validate(learned, replace(campaign, tables=(small,)), LIBRARY, nominal=NOMINAL)
    assert "force looks 1000 times too small" in found.complaints[0]
    assert any("`airgap diagnose` of" in words for words in found.complaints)
    assert not any("look" in words for words in validate(learned, campaign, LIBRARY, nominal=NOMINAL).complaints)


def test_only_the_calibration_of_the_new_instruments_moves(learned, tmp_path):
    """A new zero of the force cell is found; a stiffness that has changed is not, and shows as an error."""
    there = other(tmp_path / "a", n=240, extra=lambda x: 3e5 * x**3 + 0.06)
    shifted = validate(learned, there, LIBRARY, nominal=NOMINAL)
    (pull,) = shifted.calibrations
    assert (pull.name, pull.sigma) == ("force_offset", 0.02)
    assert pull.pull * pull.sigma == pytest.approx(0.07, abs=0.015) and abs(shifted.corrected[0].bias) < 0.01
    softer = validate(learned, other(tmp_path / "b", stiffness=950.0), LIBRARY, nominal=NOMINAL)
    assert softer.corrected[0].chi2_per_n > 10 and softer.corrected[0].share_in_90 < 0.5


def test_a_device_that_is_right_only_with_wrong_instruments_is_said_to_be(learned, tmp_path):
    """A force offset of half a newton, declared as 20 mN, would make the drawing right."""
    found = validate(learned, other(tmp_path / "n"), LIBRARY, nominal=NOMINAL)
    assert [pull.name for pull in found.base_calibrations] == ["force_offset"]
    far = replace(found, base_calibrations=(replace(found.base_calibrations[0], pull=25.0),), corrected=found.base)
    worse = replace(far, corrected=tuple(replace(c, rms_error=2 * c.rms_error) for c in found.base))
    assert "further off than they are declared" in validation_sentence(far)
    assert validation_sentence(far).startswith("Without anything")
    moved = replace(far, calibrations=far.base_calibrations)
    assert "declared, force offset by +25 sigma: is it the same device? Without" in validation_sentence(moved)
    said = "calibration of the device as drawn moves further than its declaration allows: force offset by +25 sigma."
    assert warnings(far)[-1] == f"The {said}"
    assert not any("worse than the device as drawn" in words for words in warnings(worse))
    assert any("worse than the device as drawn" in words for words in warnings(replace(worse, base_calibrations=())))


def test_rows_that_are_held_out_are_predicted_too(learned, tmp_path):
    campaign = other(tmp_path / "n")
    sealed = replace(campaign, tables=tuple(replace(t, held_out=np.ones(t.rows, bool)) for t in campaign.tables))
    assert validate(learned, sealed, LIBRARY, nominal=NOMINAL).corrected[0].n == 120


def test_a_table_wholly_held_out_can_be_fitted_beside_others(tmp_path):
    campaign = other(tmp_path / "n")
    (table,) = campaign.tables
    hidden = replace(table, file="more.csv", held_out=np.ones(table.rows, bool))
    bench = bench_of(NOMINAL, replace(campaign, tables=(table, hidden)), LIBRARY)
    assert [c.size for c in bench.fit.stack.channels] == [60, 0]
    assert [c.size for c in bench.held_out.stack.channels] == [60, 120]


def test_where_the_learned_range_is_left(learned, tmp_path):
    campaign = other(tmp_path / "n")
    (table,) = campaign.tables
    wide = replace(table, conditions={"displacement": 2 * table.conditions["displacement"]})
    found = validate(learned, replace(campaign, tables=(wide,)), LIBRARY, nominal=NOMINAL)
    (channel,) = found.corrected
    assert channel.outside_range == pytest.approx(0.5, abs=0.05)
    assert channel.outside_rms_error > channel.rms_error
    assert "learned at -0.01 to 0.01 m" in found.range_left[0] and "of 120 rows lie beyond" in found.range_left[0]


def test_a_kind_and_a_condition_that_were_not_learned_are_said(learned, tmp_path):
    campaign = other(tmp_path / "n")
    (table,) = campaign.tables
    new = replace(table, kind="force_loop", conditions={**table.conditions, "humidity": np.zeros(table.rows)})
    found = validate(learned, replace(campaign, tables=(new,)), LIBRARY, nominal=NOMINAL)
    assert "no table of kind force_loop was learned from, only generic" in found.range_left[0]
    assert "humidity" in found.range_left[1] and "did not have it" in found.range_left[1]
    assert found.corrected[0].outside_range == 0.0, "the displacement is where it was learned"
    same = validate(learned, replace(campaign, tables=(replace(new, kind="generic"),)), LIBRARY, nominal=NOMINAL)
    assert same.corrected[0].outside_range == 1.0 and len(same.range_left) == 1


def test_the_device_of_the_file_is_used_and_another_one_is_said(learned, tmp_path):
    without = other(tmp_path / "a", lambda t: t.replace("[device]\nstiffness_N_per_m = 1000.0\n", ""))
    stiffer = other(tmp_path / "b", lambda t: t.replace("= 1000.0", "= 1100.0"))
    here, there = (validate(learned, c, LIBRARY, nominal=NOMINAL) for c in (without, stiffer))
    assert here.corrected == there.corrected and not any("[device]" in words for words in here.complaints)
    assert any("stiffness_N_per_m 1100.0 instead of 1000.0" in words for words in there.complaints)


def test_the_file_that_it_was_learned_from_is_no_test(learned, tmp_path):
    campaign = read_campaign(written(tmp_path / "learned", n=200, **TRUE))
    found = validate(learned, campaign, LIBRARY, nominal=NOMINAL)
    assert any("learned from this very file" in words for words in found.complaints)


def test_a_file_without_fitted_inputs_is_refused(learned, tmp_path):
    with pytest.raises(WorkbenchError, match="no fitted inputs"):
        validate(replace(learned, source=None), other(tmp_path / "n"), LIBRARY, nominal=NOMINAL)


class Breaking(SpringModel):
    """A spring that breaks beyond 8 mm: the model has no answer there."""

    def respond(self, design, kind, conditions):
        if (np.abs(conditions["displacement"]) > 0.008).any():
            raise WorkbenchError("row 3: the spring is broken")
        return super().respond(design, kind, conditions)


def test_rows_without_an_answer_count_as_missed(learned, tmp_path):
    broken = Model(Breaking(), NOMINAL.design)
    (channel,) = validate(learned, other(tmp_path / "n"), LIBRARY, nominal=broken).corrected
    assert channel.no_answer == 24 and channel.n == 120
    assert 0.6 < channel.share_in_90 <= 96 / 120 and np.isfinite(channel.rms_error)


def test_a_table_that_the_model_cannot_answer_is_said_in_its_words(learned, tmp_path):
    campaign = other(tmp_path / "n")
    (table,) = campaign.tables
    far = replace(table, conditions={"displacement": np.full(table.rows, 0.02)})
    with pytest.raises(WorkbenchError, match="the spring is broken"):
        validate(learned, replace(campaign, tables=(far,)), LIBRARY, nominal=Model(Breaking(), NOMINAL.design))


class Rough(SpringModel):
    """A spring on a mesh so coarse that the force may have an even part of 0.3 N at the ends."""

    def numerical(self, design, table):
        return ({"force": 0.3 * (table.conditions["displacement"] / 0.01) ** 2},)


def test_the_error_of_the_model_itself_is_learned_and_kept(tmp_path):
    """It is the same in every campaign, so what one says of it helps the next."""
    rough = Model(Rough(), NOMINAL.design)
    even = lambda x: 0.45 * (x / 0.01) ** 2  # noqa: E731
    campaign = read_campaign(written(tmp_path / "c", even, n=200, stiffness=1005.0))
    learned = learned_from(bench_of(rough, campaign, LIBRARY))
    assert learned.names[-1] == "numerical_error_0" and learned.weights[0] == pytest.approx(1.5, abs=0.1)
    write_model(tmp_path / "m.toml", learned)
    kept = read_model(tmp_path / "m.toml", LIBRARY)
    found = validate(kept, other(tmp_path / "n", extra=even, stiffness=1005.0), LIBRARY, nominal=rough)
    assert found.corrected[0].chi2_per_n == pytest.approx(1.0, abs=0.3) and found.base[0].chi2_per_n > 5
    assert found.base[0].share_in_90 > 0.8, "as drawn the weight is unknown, and the band says so"


def test_what_scans_are_off_by_as_a_whole_is_not_left_unexplained(tmp_path):
    """It is in the noise of a reading already, and would be counted twice in a band."""
    folder = written(tmp_path / "c", n=100, repeats=6)
    table = pd.read_csv(folder / "pull.csv")
    table.force_N += np.array([0.5, -0.4, 0.3, -0.3, 0.2, -0.3])[table["repeat"]]
    table.to_csv(folder / "pull.csv", index=False)
    (where,) = learned_from(bench_of(NOMINAL, read_campaign(folder), LIBRARY)).source.ranges
    assert where.unexplained < 0.1


def test_what_was_left_unexplained_is_in_the_band(tmp_path):
    """A ripple that nothing explains stays in other data, and the model is not surer than it was right."""
    ripple = lambda x: 0.4 * np.sin(3e3 * x)  # noqa: E731
    campaign = read_campaign(written(tmp_path / "c", ripple, n=200))
    learned = learned_from(bench_of(NOMINAL, campaign, LIBRARY))
    (where,) = learned.source.ranges
    assert where.unexplained == pytest.approx(0.4 / np.sqrt(2), rel=0.15) and where.chi2_per_n > 5
    (channel,) = validate(
        learned, other(tmp_path / "n", extra=ripple, stiffness=1003.0), LIBRARY, nominal=NOMINAL
    ).corrected
    assert channel.share_in_90 > 0.85 and channel.chi2_per_n > 5


# ---- the band -------------------------------------------------------------------------------------------------------


NOISE = 0.1  # N


@dataclass(frozen=True)
class _Truth:
    known: Known
    gain: DeclaredError
    table: Table


@pytest.fixture(scope="module")
def truth():
    """A stiffness known to 3 %, correlated with the cubic part, and a gain of the cell to 2 %: nearly one shape."""
    tolerance = Tolerance("stiffness", 0.01, True)
    covariance = np.array([[0.03**2, -0.8 * 0.03 * 4e4], [-0.8 * 0.03 * 4e4, 4e4**2]])
    known = Known(NOMINAL, (FittedInput(tolerance, 0.02),), (Hardening(2e5),), np.zeros(0), covariance)
    x = np.linspace(-0.01, 0.01, 15)
    force = Response("force", np.zeros(15), np.full(15, NOISE), "N")
    zeros = np.zeros(15, dtype=int)
    table = Table("generic", "pull.csv", {"displacement": x}, {"force": force}, zeros, zeros, zeros.astype(bool))
    return _Truth(known, DeclaredError(Systematic("force_gain", "gain", 0.02), ("force",)), table)


def drawn(truth, random):
    """Readings of a device and an instrument as uncertain as they are said to be, and the same without noise."""
    step = random.multivariate_normal(np.zeros(2), truth.known.covariance)
    model = truth.known.model_at(step)
    model = replace(model, effects=(*model.effects, truth.gain.at(random.standard_normal())))
    exact = model.answers(truth.table)["force"]
    response = replace(truth.table.responses["force"], values=exact + NOISE * random.standard_normal(len(exact)))
    return replace(truth.table, responses={"force": response}), exact


def test_the_band_is_as_wide_as_predictions_err(truth):
    """The instrument is calibrated on one reading of the device and judged on another: the errors of 300 devices have
    the predicted size, and 90 % of them lie in the band."""
    random = np.random.default_rng(1)
    errors = []
    for _ in range(300):
        table, exact = drawn(truth, random)
        found = predicted(truth.known, (truth.gain,), (table,))
        errors.append((exact + NOISE * random.standard_normal(len(exact)) - found.reading) / found.sd)
    assert np.std(errors) == pytest.approx(1.0, abs=0.06)
    assert np.mean(np.abs(errors) <= HALF_90) == pytest.approx(0.90, abs=0.02)


def test_without_calibrations_the_band_is_that_of_what_is_known(truth):
    found = predicted(truth.known, (), (truth.table,))
    x = truth.table.conditions["displacement"]
    slopes = np.column_stack([1000.0 * x, x**3])
    expected = np.sqrt(np.einsum("ij,jk,ik->i", slopes, truth.known.covariance, slopes) + NOISE**2)
    assert found.sd == pytest.approx(expected, rel=1e-6) and found.calibration.size == 0


class Rule(Hardening):
    """A rule of thumb, good to a fifth."""

    model_error = 0.2


def test_the_band_holds_what_the_law_of_an_effect_may_be_wrong_by(truth):
    known, rule = (replace(truth.known, effects=(kind(2e5),)) for kind in (Hardening, Rule))
    before, found = (predicted(one, (), (truth.table,)) for one in (known, rule))
    wrong = 0.2 * 2e5 * truth.table.conditions["displacement"] ** 3
    assert found.sd == pytest.approx(np.hypot(before.sd, wrong), rel=1e-6)
    assert np.array_equal(found.whitened, before.whitened), "the error over the noise alone is as it was"


def test_the_uncertainty_of_a_condition_counts_once(truth):
    """u^2 = noise^2 + (dF/dx u_x)^2"""
    table = replace(truth.table, condition_random={"displacement": np.full(15, 2e-4)})
    found = predicted(replace(truth.known, covariance=np.zeros((2, 2))), (), (table,))
    slope = 1020.0 + 3 * 2e5 * table.conditions["displacement"] ** 2
    assert found.sd == pytest.approx(np.hypot(NOISE, slope * 2e-4), rel=1e-3)
