"""A model file of the workbench as what it means for a design; what means nothing is said."""

import numpy as np
import pytest

from drivetrain.learned import END_LEAKAGE, IRON_LOSS, REMANENCE, RESISTANCE, ROTOR_FRICTION
from effects.library import package_effects
from effects.machine.magnet_temperature import MagnetTemperature
from effects.parameter import parameters_of
from pipeline.learning import MEANINGS, NO_MEANING, learned_from
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.ledger.learned import FittedInput, LearnedRange, Source, device_hash
from workbench.ledger.learned import Learned as File
from workbench.ledger.model_file import write_model

LIBRARY = package_effects()
HEAD = '[model]\nbase = "machine"\n'


def taught(tmp_path, *entries, head=HEAD):
    path = tmp_path / "model.toml"
    path.write_text(head + "".join(f"\n{entry}\n" for entry in entries), encoding="utf-8")
    return learned_from(path, LIBRARY)


def test_the_table_names_parameters_that_the_effects_have():
    for name in MEANINGS.keys() & LIBRARY.keys():
        assert all(meaning.parameter in parameters_of(LIBRARY[name]) for meaning in MEANINGS[name]), name
    assert not MEANINGS.keys() & NO_MEANING.keys()
    assert {"magnet_temperature", "weak_magnets", "lamination_stacking", "end_leakage"} <= MEANINGS.keys()


def test_at_its_null_an_effect_teaches_what_the_study_has():
    for name in (MEANINGS.keys() & LIBRARY.keys()) - {"iron_loss"}:  # which is given to a bench without any iron loss
        for meaning in MEANINGS[name]:
            null = parameters_of(LIBRARY[name])[meaning.parameter].null
            assert meaning.value(null, {}) == pytest.approx(meaning.quantity.joined(())), name


def test_effects_become_quantities(tmp_path):
    found = taught(
        tmp_path,
        '[[effect]]\nname = "magnet_temperature"\nrise = 50.0',
        '[[effect]]\nname = "bearing_friction"\nlevel = 0.012',
        '[[effect]]\nname = "end_leakage"\nshare = 0.03',
        '[[effect]]\nname = "winding_temperature"\nrise = 30.0',
    )
    assert found.of(REMANENCE) == pytest.approx(1 - 0.0011 * 50)
    assert found.of(ROTOR_FRICTION) == 0.012 and found.of(END_LEAKAGE) == pytest.approx(0.03)
    assert found.of(RESISTANCE) == pytest.approx(1 + 0.00393 * 30) and found.of(IRON_LOSS) == 1.0
    assert found.unused == () and found.source == "model.toml"


def test_the_coefficient_of_the_device_counts(tmp_path):
    head = HEAD + "[device]\nremanence_coefficient_percent_per_K = -0.12\n"
    found = taught(tmp_path, '[[effect]]\nname = "magnet_temperature"\nrise = 50.0', head=head)
    assert found.of(REMANENCE) == pytest.approx(1 - 0.0012 * 50)


def test_what_means_nothing_for_a_design_is_said(tmp_path):
    found = taught(
        tmp_path,
        '[[effect]]\nname = "torque_gain"\ngain = 0.01',
        '[[effect]]\nname = "airgap_change"\nchange = 1e-4',
        '[[effect]]\nname = "weak_magnet"\nloss = 0.2',
        '[[input]]\nname = "airgap"\nshift = 1e-5\nsigma = 2e-5\nrelative = false',
    )
    assert found.lessons == ()
    assert len(found.unused) == 4 and "error of an instrument" in found.unused[0]
    assert "machine.airgap_mm" in found.unused[1] and found.unused[3].startswith("airgap: of the machine")


def test_fitted_inputs_and_their_covariance_count(tmp_path):
    inputs = (FittedInput(Tolerance("remanence", 0.01, True, "certificate"), -0.02),)
    effects, device = (MagnetTemperature(40.0),), {"slots": 12}
    seen = LearnedRange("back_emf", "v_a", 10, 1.0, 0.0, {"speed": (0.0, 100.0)})
    source = Source("bench", device_hash(device), {}, (seen,))
    covariance = np.diag([1e-6, 4.0])
    file = File("machine", device, effects, inputs, covariance=covariance, source=source)
    write_model(tmp_path / "model.toml", file)
    found = learned_from(tmp_path / "model.toml", LIBRARY)
    assert found.of(REMANENCE) == pytest.approx(0.98 * (1 - 0.044))
    assert [one.uncertainty for one in found.lessons] == pytest.approx([1e-3, 2 * 0.0011])


def test_a_shift_in_si_is_taken_over_the_device(tmp_path):
    head = HEAD + "[device]\nresistance_mohm = 50.0\n"
    entry = '[[input]]\nname = "resistance"\nshift = 0.001\nsigma = 0.001\nrelative = false'
    assert taught(tmp_path, entry, head=head).of(RESISTANCE) == pytest.approx(1.02)


@pytest.mark.parametrize(
    "text, said",
    [
        ("[model", "cannot be read as a model file"),
        ("x = 1", "missing in this model file"),
        (HEAD + '[[effect]]\nname = "ghost"', "'ghost' is not known"),
        (HEAD + '[[effect]]\nname = "end_leakage"\nshare = 7.0', "must be a number from 0 to 0.3"),
        (HEAD + '[[effect]]\nname = "end_leakage"\nslope = 0.1', "has no parameter 'slope'"),
        (HEAD + '[[input]]\nname = "remanence"\nrelative = true', "missing in this model file"),
    ],
)
def test_a_wrong_file_is_one_sentence(tmp_path, text, said):
    (tmp_path / "model.toml").write_text(text, encoding="utf-8")
    with pytest.raises(WorkbenchError, match=said):
        learned_from(tmp_path / "model.toml", LIBRARY)
