"""Every check of the stage by hand, with a case that fails it, and what people read of it."""

from __future__ import annotations

import re
from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pandas as pd
import pytest

from figures.report import render_report
from materials.strength import CARBON_SLEEVE, MPA, StrengthBySection
from mechanics.bearings import Bearing
from mechanics.retention import Sleeve
from mechanics.rotating_ring import RotatingRing
from report import mechanics as report
from study.sentences import section_class
from tests.mechanics.a_rotor import DIRECT, GEARS, INPUTS, STRESS, TEETH, strength
from units import FACTORS, GRAVITY

PARTS = (
    "glue of the magnets",
    "laminations of the rotor, at the bore",
    "rotor shaft",
    "sun of stage 1, at its root circle",
    "sun of stage 2, at its root circle",
    "first critical speed",
    "rotor shaft, fatigue",
    "sun of stage 1, fatigue",
    "sun of stage 2, fatigue",
    "laminations of the rotor, fatigue",
)


def check(found, part):
    return next(one for one in found.checks if one.part == part)


def test_every_part_is_checked_and_holds():
    found = strength()
    assert [one.part for one in found.checks] == list(PARTS)
    assert all(one.holds and one.margin > 0 for one in found.checks)
    assert [one.part for one in strength(DIRECT).checks] == [part for part in PARTS if "stage" not in part]


def test_magnets_and_laminations_turn_at_overspeed():
    found = strength()
    assert found.overspeed == pytest.approx(1.2 * 1600)
    ring = RotatingRing(5e-3, 13.2e-3, 7650.0, 0.3, 1920.0, check_pull() / 0.95)
    assert check(found, PARTS[1]).load == pytest.approx(ring.largest_stress)


def check_pull():
    """7500 1920^2 (15.7^3 - 13.2^3)/(3 13.2) mm^2: the magnets on the rim."""
    return 7500 * 1920**2 * (15.7e-3**3 - 13.2e-3**3) / (3 * 13.2e-3)


def test_a_sun_has_the_torque_of_all_faster_stages():
    """The fast one that of the machine, the slow one i times it, at the root circle."""
    slow, fast = (check(strength(), part) for part in PARTS[3:5])
    diameter = 2 * TEETH.sun.root_radius
    assert fast.load == pytest.approx(sqrt(3) * 16 * 4.0 / (pi * diameter**3))
    assert slow.load == pytest.approx(fast.load * TEETH.ratio)
    assert slow.limit == 835 * MPA


def test_the_shaft_bends_towards_the_narrow_gap():
    found = strength()
    stiffness = 16e6 * 40e-3
    assert found.shaft.magnetic_stiffness == stiffness and found.eccentricity == pytest.approx(0.1e-3)
    assert found.steady_load == pytest.approx(0.2 * GRAVITY)
    bent = (found.steady_load + stiffness * 0.1e-3) / (found.shaft.stiffness - stiffness)
    assert found.deflection == pytest.approx(bent)
    assert found.bearing_load == pytest.approx(found.shaft.stiffness * bent / 2)
    stress = 32 * found.bearing_load * 40e-3 / (pi * 10e-3**3)
    torsion = 16 * 4.0 / (pi * 10e-3**3)
    assert check(found, "rotor shaft").load == pytest.approx(sqrt(stress**2 + 3 * torsion**2))


def test_a_pull_in_the_middle_counts_beside_the_weight():
    pulled = replace(STRESS, centred_pull=np.array([100.0, 500.0]))
    assert strength(stress=pulled).steady_load == pytest.approx(0.2 * GRAVITY + 500.0 * 40e-3)


@pytest.mark.parametrize(
    "part, change",
    (
        (PARTS[0], {"speed_max": 5000.0}),
        (PARTS[1], {"speed_max": 10000.0}),
        (PARTS[2], {"peak_torque": 90.0}),
        (PARTS[2], {"bearing_span": 0.6}),
        (PARTS[3], {"peak_torque": 12.0}),
        (PARTS[4], {"peak_torque": 90.0}),
        (PARTS[5], {"bearing_span": 0.3}),
        (PARTS[5], {"mass": 20.0}),
        (PARTS[6], {"bearing_span": 0.6}),
    ),
)
def test_every_check_can_fail(part, change):
    assert check(strength(), part).holds and not check(strength(**change), part).holds


def test_what_would_help_names_keys_of_the_study():
    sleeve = replace(INPUTS, retention=Sleeve(CARBON_SLEEVE, 0.3e-3, 300 * MPA, 1.2), bearing=Bearing(2e3, 3600.0))
    for one in (*strength().checks, *strength(inputs=sleeve).checks):
        keys = re.findall(r"\b([a-z_]+)\.([a-z]\w+)", one.helps)
        assert keys and all(key in section_class(section).model_fields for section, key in keys), one.helps


def test_a_rotor_that_is_pulled_onto_its_stator_fails_in_words(tmp_path):
    """The pull is stiffer than the shaft: no rest, no critical speed, and still a report."""
    (tmp_path / "figures").mkdir()
    found = strength(stress=replace(STRESS, pull_per_shift=np.array([1e10, 0.0])))
    assert not check(found, "rotor shaft").holds and not check(found, "first critical speed").holds
    for one in report.files(found):
        one.write(tmp_path / one.name)
    assert "∞" in render_report((report.section(found, GEARS),), tmp_path, title="", subtitle="")


def test_a_bearing_is_rated_where_it_is_stated():
    plain, hours = strength(), FACTORS["h"]
    assert plain.bearing_life is None
    only_reported = strength(inputs=replace(INPUTS, bearing=Bearing(2e3, None)))
    assert only_reported.bearing_life == pytest.approx((2e3 / plain.bearing_load) ** 3 * 1e6 * 2 * pi / 40)
    assert len(only_reported.checks) == len(PARTS)
    wanted = strength(inputs=replace(INPUTS, bearing=Bearing(2e3, 1000 * hours)))
    assert check(wanted, "life of the bearings").holds
    weak = strength(inputs=replace(INPUTS, bearing=Bearing(100.0, 1000 * hours)))
    assert not check(weak, "life of the bearings").holds


# ---- what people read -----------------------------------------------------------------------------------------------


def test_the_section_says_what_fails_and_what_is_not_counted():
    weak = strength(inputs=replace(INPUTS, sun_steel=StrengthBySection.stated(50 * MPA)))
    slow, fast = report.remarks(weak)
    assert slow.startswith("sun of stage 1, at its root circle does not hold: ") and "50 MPa is the limit" in slow
    assert slow.endswith("what would help: a larger sun by more match.gearbox_stages, or a steel of more "
                         "mechanics.sun_yield_MPa.")  # fmt: skip
    assert "stage 2" in fast and not list(report.remarks(strength(DIRECT)))
    said = report.section(strength(DIRECT), DIRECT).content[-1]
    assert "bearing_capacity_kN is not stated" in said and "load on the shaft" in said
    assert "Planets" in report.section(weak, GEARS).content[-1]


def test_tables_and_figure(tmp_path):
    (tmp_path / "figures").mkdir()
    found = strength(inputs=replace(INPUTS, bearing=Bearing(2e3, 3600.0)))
    for one in report.files(found):
        one.write(tmp_path / one.name)
    table = pd.read_csv(tmp_path / "mechanics.csv").set_index("part")
    assert table.loc["first critical speed", "acts"] == pytest.approx(1600 * 30 / pi)
    assert table.loc["rotor shaft", "may act"] == 900 and table.loc["rotor shaft", "unit"] == "MPa"
    assert (tmp_path / "figures" / "mechanics.png").stat().st_size > 10_000
    numbers = report.numbers_table(found).iloc[0]
    assert numbers.overspeed_rpm == pytest.approx(1920 * 30 / pi) and numbers.bearing_life_h > 1
