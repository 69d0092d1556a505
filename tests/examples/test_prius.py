"""The measured Prius motor: each effect that the tool names lowers the error on rows that no fit has seen."""

import pytest

from effects.dq_design import DqMachine
from effects.library import package_effects
from effects.mechanical.load_loss import LoadLoss
from examples.prius.story import CAMPAIGN, current_error
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.ledger.model_file import model_text, with_effects_of
from workbench.ledger.step import start_step, try_effect
from workbench.likelihood.bench import bench_of
from workbench.models.bases import nominal_model
from workbench.models.model import Model

NAMED = ("copper_drift", "iron_loss_resistance", "quadrature_saturation")  # by the tool, all three at once
COPPER = 0.00393  # 1/K at 20 degC, IEC 60028


@pytest.fixture(scope="module")
def steps():
    """The start and each effect that the tool names, then what a user adds."""
    campaign, library = read_campaign(CAMPAIGN), package_effects()
    model = nominal_model(campaign)
    found = [start_step(bench_of(model, campaign, library))]
    for number, name in enumerate((*NAMED, "remanence_drift", "load_loss"), 1):
        trial = try_effect(model, campaign, library, name, number)
        model = trial.model
        found.append(trial.step)
    return found


def test_the_error_of_conditions_left_out_falls_with_every_effect_that_is_named(steps):
    judged = [step.held_out_chi2_per_n for step in steps[:4]]
    assert all(later < earlier for earlier, later in zip(judged, judged[1:]))
    assert judged[0] > 5 and judged[3] < 2.5
    assert [step.decision for step in steps] == ["start"] + 3 * ["accepted"] + 2 * ["refused"]


def test_the_current_comes_nearer(steps):
    amperes = [current_error(step) for step in steps]
    assert amperes[0] > 0.7 and amperes[3] < 0.6


def test_sizes_are_those_of_the_materials(steps):
    copper, magnets = (step.parameters["coefficient"] for step in (steps[1], steps[4]))
    assert copper.value == pytest.approx(COPPER, rel=0.2)  # alone, before the iron loss is in the model
    assert 0 < magnets.value < 1.3e-3, "NdFeB: up to 0.13 % per kelvin"


def test_the_input_power_is_at_its_noise_and_the_warm_current_is_not(steps):
    last = steps[4]
    for name in ("torque_sweep_35C.power", "torque_sweep_75C.power"):
        assert last.rms_error[name] < last.noise_floor[name]
    assert last.rms_error["torque_sweep_75C.current"] > 1.5 * last.noise_floor["torque_sweep_75C.current"]


def test_a_loss_that_gives_power_is_refused(steps, tmp_path):
    assert all(LoadLoss().at([z]).share >= 0 for z in (-20.0, -3.0, 0.0, 3.0))
    assert steps[5].parameters["share"].low90 >= 0
    model = Model(nominal_model(read_campaign(CAMPAIGN)).base, DqMachine(4, 0.175, 2.5e-3, 5e-3, 0.069))
    (tmp_path / "m.toml").write_text(model_text(model + LoadLoss(0.01)).replace("0.01", "-0.01"), encoding="utf-8")
    with pytest.raises(WorkbenchError, match="must be a number from 0"):
        with_effects_of(tmp_path / "m.toml", model, package_effects())
