"""The gearbox stage: ratios and loads from the demand, histories and normal loads, a direct drive, what is refused."""

import json
import re
from dataclasses import replace
from math import inf, pi

import numpy as np
import pytest
import xarray as xr

from gearbox.bodies import Construction
from gearbox.errors import GearError, TooWeakError
from gearbox.flank import Lubrication
from gearbox.load_factors import Quality
from gearbox.material import CASE_HARDENED_ME
from gearbox.rating import Rules
from gearbox.search import Safety
from gearbox.stage import (
    GearboxOutcome,
    GearCost,
    GearDemand,
    GearInputs,
    NormalLoads,
    RecordedLoads,
    StatedGears,
    gearbox_stage,
    stage_load,
)
from gearbox.train import DirectDrive
from pipeline.codec import decoded, digest, encoded
from study.sentences import section_class
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE
DEMAND = GearDemand(ratio=76.0, envelope_diameter=85 * MM, linkage_ratio=0.170, linkage_ratio_max=0.175,
                    effort_peak=2614.0, speed_at_effort_peak=1.6)  # fmt: skip
LOADS = NormalLoads(effort_rms=300.0, speed_rms=0.1, swing=7.6 * DEGREE)


@pytest.fixture(scope="module")
def inputs(printed):
    return GearInputs(
        rules=Rules(CASE_HARDENED_ME, Quality(), Lubrication(100e-6, 4.8e-6, 20e-6)),
        safety=Safety(flank=1.0, root=1.1, static_flank=0.0, static_root=1.1),
        construction=Construction(bore_fraction=0.45, flange_fraction=0.25, least_flange=1.5 * MM, axial_gap=0.5 * MM),
        cost=GearCost(mass=4.0, equivalent_mass=15.0, weight=0.5),
        stage_count=2,
        ratio_tolerance=0.03,
        planets=3,
        friction=0.06,
        torque_class_width=10.0,
        life=750 * 3600.0,
        swing=7.6 * DEGREE,
        stated=StatedGears(printed.plain, (12 * MM, 4.5 * MM)),
    )


@pytest.fixture(scope="module")
def found(inputs):
    return gearbox_stage(DEMAND, LOADS, inputs)


def test_the_least_cost_is_the_choice(found):
    costs = [one.cost for one in found.search.best]
    assert costs == sorted(costs) and found.train == found.search.best[0].train
    assert abs(found.train.ratio / DEMAND.ratio - 1) <= 0.03
    assert found.transmission_ratio == pytest.approx(0.170 / found.train.ratio)
    assert found.equivalent_mass == pytest.approx(found.train.inertia_at_slow_shaft / 0.170**2)


def test_only_what_is_asked_for_is_checked(found):
    assert [one.kind for one in found.checks] == ["flank", "root", "static_root"]
    assert all(one.holds and one.reached == getattr(found.search.best[0], one.kind) for one in found.checks)
    weak = replace(found.checks[0], reached=0.99 * found.checks[0].wanted)
    assert not weak.holds and weak.margin == pytest.approx(-0.01)


def test_the_stated_gears_stand_in_the_same_construction(found):
    assert found.search.stated.ratio == pytest.approx(77.19, abs=0.01)
    assert found.search.stated.envelope_diameter == found.train.envelope_diameter


def test_torques_come_with_the_largest_ratio_and_angles_with_the_nominal_one(inputs):
    time = np.linspace(0, 2, 4001)
    stroke = np.array([0.02, 0.03])[:, None] * np.sin(2 * pi * time)
    velocity = np.gradient(stroke, time, axis=1)
    over = ("seed", "time")
    history = xr.Dataset({"force": (over, 5000 * velocity), "velocity": (over, velocity), "stroke": (over, stroke)})
    load = stage_load(DEMAND, RecordedLoads(history), inputs)
    assert load.peak_torque == pytest.approx(2614 * 0.175) and load.peak_speed == pytest.approx(1.6 / 0.175)
    assert load.spectrum.swing == pytest.approx(2 * 0.03 / 0.170, rel=1e-4)
    largest = 5000 * 0.03 * 2 * pi * 0.175
    assert largest <= load.spectrum.torque[-1] < largest + inputs.torque_class_width
    assert load.spectrum.speed @ load.spectrum.share == pytest.approx(np.abs(velocity).mean() / 0.175)


def test_a_normal_load_keeps_its_rms_values(inputs):
    load = stage_load(DEMAND, LOADS, replace(inputs, torque_class_width=0.5))
    assert load.spectrum.rms_torque == pytest.approx(300 * 0.175, rel=0.01)
    assert load.spectrum.swing == pytest.approx(7.6 * DEGREE)


def test_a_shaft_that_turns_on_has_gears(inputs):
    """A load on the slow shaft itself: torque and speed, linkage ratio 1."""
    demand = GearDemand(36.0, 85 * MM, 1.0, 1.0, effort_peak=60.0, speed_at_effort_peak=5.0)
    cost = GearCost(mass=4.0, equivalent_mass=0.02, weight=0.5)
    found = gearbox_stage(demand, NormalLoads(20.0, 10.0, inf), replace(inputs, cost=cost, stated=None))
    assert found.search.load.spectrum.swing == inf and found.search.stated is None
    assert found.equivalent_mass == pytest.approx(found.train.inertia_at_slow_shaft)


def test_a_direct_drive_neither_weighs_nor_breaks():
    found = GearboxOutcome(DirectDrive(), 1.0)
    assert found.search is None and found.checks == ()
    assert found.transmission_ratio == 1.0 and found.equivalent_mass == 0
    assert found.train.mass == found.train.length == found.train.inertia_at_fast_shaft == 0
    assert found.train.efficiency == (1.0, 1.0) and found.train.rate(None, None) == ()


def test_what_is_too_weak_is_said_and_the_nearest_is_shown(inputs):
    found = gearbox_stage(DEMAND, replace(LOADS, effort_rms=480.0), inputs)
    assert "too weak" in found.search.weakness and not all(one.holds for one in found.checks)


@pytest.mark.parametrize(
    ("changes", "error", "key"),
    [
        ({"stage_count": 1}, GearError, "match.gearbox_stages = 2"),
        ({"stage_count": 7}, GearError, "match.gearbox_stages = 6"),
        ({"ratio_tolerance": 1e-7}, GearError, "gearbox.ratio_tolerance"),
        ({"planets": 5}, GearError, "gearbox.planets"),
        ({"safety": Safety(9.0, 9.0, 9.0, 9.0)}, TooWeakError, "gearbox.safety_"),
    ],
)
def test_a_gearbox_that_cannot_be_names_a_key_of_the_study(inputs, changes, error, key):
    with pytest.raises(error) as refusal:
        gearbox_stage(DEMAND, LOADS, replace(inputs, **changes))
    assert key in str(refusal.value)
    for section, name in re.findall(r"\b(match|gearbox|sweep)\.(\w+)", str(refusal.value)):
        assert name in section_class(section).model_fields


def test_the_outcome_is_written_and_read_again(found):
    again = decoded(json.loads(json.dumps(encoded(found))))
    assert digest(again) == digest(found)
    assert again.train.ratio == found.train.ratio and again.search.load.spectrum.rms_torque > 0
