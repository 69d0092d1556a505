"""Mount, drive and force loop of a study: what is stated counts, everything else is the prototype's."""

from pathlib import Path

import pytest

from study.errors import StudyError
from study.inputs_actuator import actuator_inputs
from study.read import read_study
from tests.actuator.thesis import FORCE_LOOP, TORQUE_LAG, prototype

STUDIES = Path(__file__).resolve().parents[2] / "studies"


def test_without_a_section_the_prototype_counts():
    found = actuator_inputs(read_study(STUDIES / "motorcycle.toml"))
    assert found.loop == FORCE_LOOP and found.torque_lag == TORQUE_LAG
    for name, value in vars(prototype().mount).items():
        assert getattr(found.mount, name) == pytest.approx(value, rel=1e-12)


def test_what_is_stated_counts_in_si(tmp_path):
    text = (STUDIES / "motorcycle.toml").read_text(encoding="utf-8")
    own = "[actuator]\nmount_play_um = 20.0\nloop_derivative_ms = 4.0\ntorque_lag_ms = 2.0\n"
    path = tmp_path / "own.toml"
    path.write_text(f"{text}\n{own}", encoding="utf-8")
    found = actuator_inputs(read_study(path))
    assert (found.mount.play, found.loop.derivative, found.torque_lag) == pytest.approx((2e-5, 4e-3, 2e-3))
    assert found.mount.stiffness == pytest.approx(676e3) and found.loop.proportional == 7.4


def test_a_negative_mount_stiffness_is_one_sentence(tmp_path):
    text = (STUDIES / "motorcycle.toml").read_text(encoding="utf-8")
    path = tmp_path / "soft.toml"
    path.write_text(f"{text}\n[actuator]\nmount_stiffness_kN_per_m = -500.0\n", encoding="utf-8")
    with pytest.raises(StudyError, match="mount_stiffness_kN_per_m = -500.0 is outside the allowed range; give 1 to"):
        read_study(path)
