"""[variables] of a study: bounds in SI, rules, and what is refused by its name."""

import pytest

from optimisation.build_rules import MagnetStands, WireEnters
from optimisation.freedom import AS_SWEPT
from study.errors import StudyError
from study.inputs_variables import freedom
from study.read import read_study


def freed(*overrides):
    return freedom(read_study("motorcycle", overrides))


def test_nothing_stated_is_what_the_sweep_varies():
    assert freed() == AS_SWEPT


def test_bounds_and_rules_in_si():
    found = freed("variables.airgap_mm=[0.4, 0.8]", "variables.magnet_length_mm=[1.5, 3.5]")
    magnet, gap = found.further
    assert (magnet.name, magnet.low, magnet.high) == ("magnet_length", 1.5e-3, 3.5e-3)
    assert (gap.low, gap.high) == pytest.approx((0.4e-3, 0.8e-3))
    wire, stands = found.rules
    assert isinstance(wire, WireEnters) and wire.diameter == pytest.approx(0.544e-3)
    assert isinstance(stands, MagnetStands) and stands.remanence > stands.knee
    assert stands.slot_density == pytest.approx(20e6 * 2**0.5 * 0.3)


REFUSED = {
    "magnets that touch": (["variables.magnet_arc_fraction=[0.6, 1.0]"], ["variables.magnet_arc_fraction", "0.98"]),
    "a wire that is too thick": (["variables.slot_opening_mm=[0.3, 3]"], ["slot_opening_mm", "0.544 mm"]),
    "the wrong order": (["variables.airgap_mm=[0.8, 0.4]"], ["variables.airgap_mm", "smallest value first"]),
    "a gap of nothing": (["variables.airgap_mm=[0.0, 0.4]"], ["variables.airgap_mm", "0.05 to 20 mm"]),
    "an unknown dimension": (["variables.shaft_mm=[1, 2]"], ["variables.shaft_mm", "unknown"]),
    "a sleeve in the gap": (
        ["variables.airgap_mm=[0.4, 0.8]", "mechanics.sleeve_material=carbon", "mechanics.sleeve_thickness_mm=0.45",
         "mechanics.sleeve_prestress_MPa=300"],
        ["variables.airgap_mm", "mechanics.sleeve_thickness_mm = 0.45"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("overrides, named", REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_built_is_refused_by_its_name(overrides, named):
    with pytest.raises(StudyError) as caught:
        freed(*overrides)
    assert all(part in str(caught.value) for part in named), str(caught.value)


def test_a_magnet_length_without_a_grade_is_refused():
    study = read_study("motorcycle", ["variables.magnet_length_mm=[1.5, 3.5]"])
    nameless = study.model_copy(update={"materials": study.materials.model_copy(update={"magnet_grade": None})})
    with pytest.raises(StudyError, match="variables.magnet_length_mm needs materials.magnet_grade"):
        freedom(nameless)
