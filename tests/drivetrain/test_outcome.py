"""The outcome of a small machine: numbers that agree with each other, behind gears and as a direct drive."""

import json
from dataclasses import replace
from math import pi
from types import SimpleNamespace

import numpy as np
import pytest

from drivetrain.asked import ContinuousEffort
from drivetrain.heat_views import built_machine, stated_duty
from drivetrain.masses import PartMaterials
from drivetrain.outcome import (
    Features,
    OutcomeInputs,
    StatedActuator,
    active_masses,
    actuator_limits,
    outcome_stage,
)
from drivetrain.output import Shaft, Wheel
from drivetrain.requirements import Linkage, Requirements
from electrical.winding_stage import WindingOutcome
from electrical.wound_machine import WoundMachine
from gearbox.bodies import Construction
from gearbox.layout import Housing
from gearbox.planetary_set import planetary_set
from gearbox.stage import GearboxOutcome, SafetyCheck
from gearbox.train import DirectDrive, GearTrain, Stage
from geometry.machine import hanselman_machine
from magnetostatics.flux_map_stage import FluxMap
from pipeline.codec import decoded, digest, encoded
from report.outcome import (
    checks_table,
    features_table,
    files,
    masses_table,
    nearest_in_words,
    remarks,
    remedies_table,
    section,
)
from tests.drivetrain.linear_machine import AREA, LENGTH, POLES, RHO, STRANDS, TURNS, flux_map
from tests.electrical.wires import series_star, wire_of
from tests.mechanics.a_rotor import strength
from thermal.rating import COPPER_LIMIT, Rating
from thermal.stage import HeatOutcome

MM = 1e-3
BUILD = Construction(bore_fraction=0.45, flange_fraction=0.25, least_flange=1.5 * MM, axial_gap=0.5 * MM)
NOTHING = Requirements(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
ASKED = Requirements(40e3, 300.0, 0.1, 30.0, 3.4, 2600.0, 1.6, 4250.0, 1340.0, 3.2)


@pytest.fixture(scope="module")
def wound():
    machine = hanselman_machine(
        slots=12, pole_pairs=POLES, stator_outer_radius=42.5 * MM, rotor_outer_radius=15.7 * MM,
        back_iron_width=3.3 * MM, magnet_length=2.5 * MM, airgap=0.5 * MM, slot_opening=2 * MM,
        shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, shaft_radius=5 * MM,
    )  # fmt: skip
    return WoundMachine(machine, 4, 1, series_star(TURNS, STRANDS, wire_of(AREA, RHO)), LENGTH)


@pytest.fixture(scope="module")
def field():
    return FluxMap(flux_map(), POLES, 4, 1, 1e-4, 1000.0, 0.0)


@pytest.fixture(scope="module")
def winding(wound, field):
    """Only what the outcome reads of it."""
    torque = float(wound.on_map(field.data).torque(0.0, wound.current_peak(20e6)))
    rest = {name: None for name in WindingOutcome.__dataclass_fields__} | {"wound": wound, "peak_torque": torque}
    return WindingOutcome(**rest)


@pytest.fixture(scope="module")
def heat(winding):
    """Only what the outcome reads of it: 30 % of the peak torque for ever."""
    rating = Rating(45.0, 1.0, 0.3 * winding.peak_torque, COPPER_LIMIT, None)
    return HeatOutcome(**{name: None for name in HeatOutcome.__dataclass_fields__} | {"at_speed": rating})


@pytest.fixture(scope="module")
def inputs():
    return OutcomeInputs(
        overload_density=20e6, dc_voltage=48.0, phase_current_max=90.0, rotor_speed_max=2618.0,
        active_length_max=70 * MM, equivalent_mass_max=15.0,
        housing=Housing(wall=12.5 * MM, lever_side=55 * MM, bearing_seat=14 * MM, sensor_cover=25 * MM),
        casing_mass=2.4, materials=PartMaterials(7650.0, 7500.0, 8960.0, 7800.0, 0.95),
        viscous_friction=250.0, coulomb_friction=3.0,
        stated=StatedActuator("thesis", Features(2700.0, 459.0, 6.0, 4.9, 2.2e-3, 76.9, 0.17, 4.5, 0.11, 0.197)),
    )  # fmt: skip


@pytest.fixture(scope="module")
def gears():
    teeth = planetary_set((14, 46, -109), (0.483, 0.076), 0.75 * MM)
    train = GearTrain((Stage(teeth, 12 * MM), Stage(teeth, 4.5 * MM)), 85 * MM, BUILD, 7800.0, 0.06)
    return GearboxOutcome(train, 0.170, (SafetyCheck("static_root", 1.1, 1.0),))


@pytest.fixture(scope="module")
def found(winding, field, heat, gears, inputs):
    linkage, weak = Linkage(0.170, 0.175, 60 * MM), strength(peak_torque=12.0)
    return outcome_stage(winding, field, heat, gears, ASKED, linkage, inputs, None, weak)


def test_the_features_agree_with_each_other(found, winding, wound, gears, inputs):
    one = found.features
    assert one.machine_torque == pytest.approx(winding.peak_torque)
    assert one.effort_peak == pytest.approx(one.machine_torque / one.transmission_ratio)
    assert one.slow_shaft_torque == pytest.approx(one.machine_torque * one.gear_ratio)
    masses = active_masses(wound, inputs.materials)
    assert one.mass == pytest.approx(masses.total + gears.train.mass + 2.4)
    rotor = masses.rotor_inertia / one.transmission_ratio**2
    assert one.equivalent_mass == pytest.approx(rotor + gears.train.inertia_at_slow_shaft / 0.170**2)
    assert one.diameter == pytest.approx(110 * MM) and one.length == found.layout.length


def test_end_windings_stand_beside_the_stack(found, wound):
    stack = next(part for part in found.layout.parts if part.kind == "stator")
    end = next(part for part in found.layout.parts if part.kind == "winding")
    assert stack.length == LENGTH and end.length == pytest.approx(wound.end_turn_length / pi)


def test_the_limits_are_the_envelope_at_the_wheel(found):
    limits = actuator_limits(found)
    assert limits.force[0] == pytest.approx(found.features.effort_peak, rel=1e-6)
    assert limits.speed[-1] == pytest.approx(2618 * found.features.transmission_ratio)
    assert np.all(np.diff(limits.force) <= 1e-6) and limits.viscous_friction == 250.0


def test_a_check_at_speed_is_on_the_limits(found):
    check = found.checks[1]
    assert check.reached == pytest.approx(np.interp(1.6, found.limits.speed, found.limits.force), rel=0.01)


def test_nothing_asked_for_holds(winding, field, heat, gears, inputs):
    found = outcome_stage(winding, field, heat, gears, NOTHING, Linkage(0.170, 0.175), inputs, None, None)
    assert all(one.holds for one in found.checks[:6]) and len(found.checks) == 9
    table = checks_table(found, Wheel())
    assert list(table.margin_percent[:5]) == [np.inf] * 5
    assert section(found, Wheel(), None).title == "Outcome"


def test_controlled_damping_asks_for_no_more_than_the_peak_effort(found):
    table = checks_table(found, Wheel()).set_index("requirement")
    (name,) = [name for name in table.index if name.startswith("controlled damping at")]
    most = ASKED.force_peak / ASKED.velocity_rms
    assert most < ASKED.maximum_damping, "else this shows nothing"
    assert table.loc[name].needed == pytest.approx(most / 1e3)


@pytest.mark.parametrize("lost, holds", [(0.004, "yes"), (0.04, "NO")])
def test_magnets_that_are_lost_are_a_requirement(winding, field, heat, gears, inputs, lost, holds):
    magnets = SimpleNamespace(inputs=SimpleNamespace(lost_max=0.01), lost=lost)
    found = outcome_stage(winding, field, heat, gears, NOTHING, Linkage(0.170, 0.175), inputs, magnets, None)
    row = checks_table(found, Wheel()).set_index("requirement").loc["volume of the magnets beyond the knee"]
    assert (row.needed, row.reached, row.unit, row.sense, row.holds) == (1.0, 100 * lost, "%", "at most", holds)


def test_tables_are_in_drawing_units(found):
    table = checks_table(found, Wheel()).set_index("requirement")
    damping = table.loc["short-circuit damping at low speed"]
    assert (damping.needed, damping.unit) == (40.0, "kNs/m")
    assert table.loc["diameter"].needed == 120.0 and table.loc["rotor speed"].unit == "rpm"
    assert table.loc["gears, safety static root"].holds == "NO"
    assert table.loc["sun of stage 1, at its root circle, safety factor"].holds == "NO"
    assert table.loc["first critical speed, safety factor"].needed == 1.25
    features = features_table(found, Wheel()).set_index("feature")
    assert features.loc["overall transmission ratio / (mm/rad)"].stated == pytest.approx(2.2)
    assert features.loc["diameter of the envelope / mm"].ours == pytest.approx(110)
    whole = masses_table(found).set_index("part").mass_kg
    inertia = masses_table(found).set_index("part").inertia_kg_mm2["whole"]
    assert inertia == pytest.approx(1e6 * (found.masses.rotor_inertia + found.gearbox_inertia))
    assert whole.whole == pytest.approx(whole["active parts"] + whole.gears + whole["casing, bearings, shafts"])
    remedies = remedies_table(found, Wheel())
    assert set(remedies.requirement) == {one.requirement.name(Wheel()) for one in found.checks if not one.holds}


def test_a_failing_requirement_is_a_remark(found):
    said = [part.text for part in section(found, Wheel(), None).content if type(part).__name__ == "Remark"]
    assert len(said) == sum(not one.holds for one in (*found.checks, *found.gear_checks, *found.strength_checks))
    assert all("does not hold" in text for text in said)


def test_a_direct_drive_speaks_of_no_wheel(winding, field, heat, inputs):
    """A torque of the machine itself, no gears, a load on the shaft."""
    drive = Requirements(0.0, 1.0, 100.0, 100.0, 300.0, 4.0, 100.0, 500.0, 2.0, 250.0)
    plain = OutcomeInputs(**{**vars(inputs), "stated": None, "load_inertia": 1e-3, "equivalent_mass_max": 1e-2})
    gears = GearboxOutcome(DirectDrive(), 1.0)
    found = outcome_stage(winding, field, heat, gears, drive, Linkage(1.0, 1.0), plain, None, None)
    assert found.features.effort_peak == pytest.approx(winding.peak_torque)
    assert found.load_inertia_ratio == pytest.approx(1e-3 / found.features.equivalent_mass)
    words = repr([part if isinstance(part, str) else part.frame.to_string() if hasattr(part, "frame") else part
                  for part in section(found, Shaft(), None).content])  # fmt: skip
    for absent in ("wheel", "lever", "force", "m/s", "linkage", "gears"):
        assert absent not in words
    assert "peak torque" in words and "rpm" in words and "kg m²" in words


def test_the_continuous_effort_is_what_the_temperatures_allow(found, heat):
    (check,) = [one for one in found.checks if isinstance(one.requirement, ContinuousEffort)]
    assert check.reached == pytest.approx(heat.at_speed.torque / found.features.transmission_ratio)


def test_the_machine_is_cooled_by_the_casing_of_the_whole(found, winding, gears, inputs):
    built = built_machine(winding, gears, inputs)
    assert built.casing.diameter == pytest.approx(found.features.diameter)
    assert built.casing.length == pytest.approx(found.features.length) and built.casing.mass == 2.4
    assert built.weights.copper == found.masses.copper and built.weights.magnets == found.masses.magnets
    assert built.friction(np.array([0.1, -0.3])) == pytest.approx(250.0 * (0.01 + 0.09) / 2 + 3.0 * 0.2)
    assert stated_duty(ASKED).speed_rms == ASKED.velocity_rms and stated_duty(ASKED).effort == [ASKED.force_rms]


def test_every_requirement_is_said_with_its_verdict(found):
    table, said = checks_table(found, Wheel()), list(remarks(found, Wheel()))
    assert "peak force at rest: " in said[0] and " N needed: " in said[0]
    assert [one.endswith("DOES NOT HOLD") for one in said[: len(table)]] == [holds == "NO" for holds in table.holds]


def test_what_holds_everything_together_is_said(found):
    """By the last sentence of the run, by the section and by a table of its own."""
    (said,) = list(remarks(found, Wheel()))[len(checks_table(found, Wheel())) :]
    assert said == nearest_in_words(found.nearest, Wheel()) and said in section(found, Wheel(), None).content
    assert said.startswith("Nearest design" if found.nearest.holds else "No design")
    assert "outcome_nearest.csv" in [file.name for file in files(found, Wheel())]
    assert [move.now for move in found.nearest.moves][:2] == [found.active_length, found.features.transmission_ratio]


def test_gears_that_do_not_hold_are_said_beside_the_nearest_design(found):
    """The nearest design is searched by what the inputs move; gears are not among that."""

    def said(outcome):
        parts = section(outcome, Wheel(), None).content
        return [part for part in parts if isinstance(part, str) and "not looked at again" in part]

    strong = [replace(one, reached=2 * one.wanted) for one in found.gear_checks]
    weak = [replace(strong[0], reached=0.5 * strong[0].wanted), *strong[1:]]
    assert said(replace(found, gear_checks=tuple(strong), strength_checks=())) == []
    (line,) = said(replace(found, gear_checks=tuple(weak), strength_checks=()))
    assert line.endswith(f"do not hold: gears, safety {weak[0].kind.replace('_', ' ')}.")


def test_the_outcome_is_written_and_read_again(found):
    again = decoded(json.loads(json.dumps(encoded(found))))
    assert digest(again) == digest(found) and again.checks == found.checks and again.remedies == found.remedies


def test_files_are_written_in_both_kinds_of_words(found, tmp_path):
    for output in (Wheel(), Shaft()):
        names = [file.name for file in files(found, output)]
        assert "outcome_requirements.csv" in names and "figures/axial_section.png" in names
    for file in files(found, Wheel()):
        target = tmp_path / file.name
        target.parent.mkdir(exist_ok=True)
        file.write(target)
        assert target.stat().st_size > 0
