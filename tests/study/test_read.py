"""A right study is read as it stands, and comes out in SI."""

import math
import tomllib
from types import NoneType
from typing import get_args

import pytest

from drivetrain.planetary import NITRIDED_STEEL
from geometry.family import Combination
from geometry.magnetisation import ParallelMagnetisation, RadialMagnetisation
from study.check import summary
from study.errors import StudyError
from study.inputs_electrical import winding_inputs
from study.inputs_field import field_case
from study.inputs_machine import machine_family
from study.inputs_match import match_inputs
from study.inputs_vehicle import stated_requirements
from study.read import STUDIES, read_study
from study.schema import Study
from study.sentences import section_class
from study.usable import check_study


@pytest.fixture(scope="module")
def motorcycle() -> Study:
    return read_study("motorcycle")


@pytest.mark.parametrize("path", sorted(STUDIES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_study_that_is_shipped_is_usable(path):
    check_study(read_study(path))


def test_the_reference_machine_in_metres(motorcycle):
    machine = machine_family(motorcycle.machine).reference
    assert machine.tooth_width == pytest.approx(5.5e-3)  # 2 w_bi / (12/10), eq. 3.53
    assert machine.shoe_d1 == machine.shoe_d2 == pytest.approx(1.43e-3)  # 0.52 w_tb / 2, eqs 3.57 and 3.58
    assert machine.stator_outer_radius == pytest.approx(42.5e-3)
    assert machine.magnetisation == ParallelMagnetisation()


def test_one_design_of_the_sweep_derives_its_teeth_anew(motorcycle):
    machine = machine_family(motorcycle.machine).machine(
        Combination(9, 10), stator_outer_radius=50e-3, back_iron_width=4e-3
    )
    assert machine.tooth_width == pytest.approx(2 * 4e-3 / 0.9)
    assert machine.stator_outer_radius == 50e-3 and machine.airgap == pytest.approx(0.5e-3)


def test_a_stated_tooth_width_holds_against_the_derived_one():
    study = read_study("motorcycle", ["machine.tooth_width_mm=4.5", "machine.shoe_d2_mm=1"])
    machine = machine_family(study.machine).machine(Combination(12, 10), back_iron_width=4e-3)
    assert machine.tooth_width == pytest.approx(4.5e-3) and machine.shoe_d2 == pytest.approx(1e-3)


def test_overrides_take_toml_values_and_bare_words():
    study = read_study("motorcycle", ["machine.magnetisation=radial", "sweep.slots=[12]", "machine.airgap_mm=1"])
    assert machine_family(study.machine).reference.magnetisation == RadialMagnetisation()
    assert study.sweep.slots == (12,) and study.machine.airgap_mm == 1.0


def test_one_machine_may_have_poles_that_the_sweep_cannot_wind():
    study = read_study("motorcycle", ["machine.slots=18", "machine.poles=12", "machine.back_iron_width_mm=3.0"])
    with pytest.raises(StudyError, match="sweep.slots = 12"):
        check_study(study)


def test_supply_and_wire_in_si(motorcycle):
    inputs = winding_inputs(motorcycle)
    limits, (wire,) = inputs.limits, inputs.wires
    assert limits.overload_current_density == 20e6 and limits.dc_voltage == 48.0
    assert limits.maximum_speed == pytest.approx(15000 * 2 * math.pi / 60)
    assert wire.area == pytest.approx(math.pi * 0.25e-3**2) and wire.resistivity == pytest.approx(1.68e-8)
    assert inputs.longest == pytest.approx(70e-3) and inputs.nominal_density == 6e6


def test_match_and_gearbox_in_si(motorcycle):
    inputs = match_inputs(motorcycle)
    assert inputs.gear_laws == NITRIDED_STEEL  # the thesis's gears
    assert inputs.gear_stages == 2 and inputs.planets == 3
    assert stated_requirements(motorcycle).maximum_damping == 40e3
    assert field_case(motorcycle).nominal_density == pytest.approx(math.sqrt(2) * 6e6)
    assert inputs.limits.active_length == pytest.approx(70e-3)
    assert inputs.scales.stator_radius == pytest.approx(50e-3)


def test_a_warm_winding_has_more_resistance():
    study = read_study("motorcycle", ["winding_selection.winding_temperature_degC=120"])
    assert winding_inputs(study).wires[0].resistivity == pytest.approx(1.68e-8 * 1.393)


def test_mesh_keys_that_are_not_stated_leave_the_default():
    usual = field_case(read_study("motorcycle")).density
    finer = field_case(read_study("motorcycle", ["mesh.gap_edges_per_revolution=1440"])).density
    assert finer.gap_edges == 1440 and finer.gap_layers == usual.gap_layers


def test_the_study_cannot_be_changed(motorcycle):
    with pytest.raises(ValueError, match="frozen"):
        motorcycle.machine.airgap_mm = 1.0


def test_the_summary_names_what_will_be_done(motorcycle):
    text = summary(motorcycle)
    assert "12 slots, 10 poles" in text and "slots 9, 12; poles 10; 10 diameters 70 to 115 mm" in text


# ------------------------------------------------------------------------- contracts of the schema


def number_keys():
    for name in Study.model_fields:
        section = section_class(name)
        for key, key_field in section.model_fields.items():
            if {int, float} & set(_leaves(key_field.annotation)):
                yield pytest.param(section, key, id=f"{name}.{key}")


def _leaves(annotation):
    parts = get_args(annotation)
    return [leaf for part in parts for leaf in _leaves(part)] if parts else [annotation]


@pytest.mark.parametrize("section, key", list(number_keys()))
def test_every_number_has_a_meaning_and_a_range(section, key):
    quantity = section.quantity(key)
    assert quantity is not None and quantity.meaning and quantity.low < quantity.high


def test_only_optional_keys_have_a_default():
    for name in Study.model_fields:
        for key, key_field in section_class(name).model_fields.items():
            if not key_field.is_required():
                assert NoneType in _leaves(key_field.annotation), f"{key} has a hidden default"


OF_THE_THESIS_ALONE = (
    "linkage.",
    "printed_machine.",
    "printed_actuator.",
    "gearbox.printed_",
    "match.chosen_",
    "materials.loss_grade",
)


def test_the_template_states_every_key_that_the_motorcycle_states_but_those_of_its_case():
    data = [tomllib.loads((STUDIES / f"{name}.toml").read_text()) for name in ("motorcycle", "template")]
    keys = [{f"{section}.{key}" for section, table in study.items() for key in table} for study in data]
    assert keys[1] <= keys[0] and all(key.startswith(OF_THE_THESIS_ALONE) for key in keys[0] - keys[1])
