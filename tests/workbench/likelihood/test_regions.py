"""Blocks are operating conditions: never a repeat, never a piece of a revolution; the sealed region is an edge."""

from pathlib import Path

import numpy as np
import pytest

from workbench.data.campaign import read_campaign
from workbench.data.table import Response, Table
from workbench.likelihood.regions import blocks_of, conditions_of, sealed_region

PRIUS = Path(__file__).resolve().parents[3] / "measurements" / "prius-2004"


def table(kind="generic", repeat=None, **conditions):
    rows = len(next(iter(conditions.values())))
    repeat = np.zeros(rows, dtype=int) if repeat is None else repeat
    response = Response("force", np.zeros(rows), np.ones(rows), "N")
    columns = {name: np.asarray(values, dtype=float) for name, values in conditions.items()}
    return Table(kind, f"{kind}.csv", columns, {"force": response}, repeat, repeat, np.zeros(rows, dtype=bool))


def scattered(values, repeats, seed=0, size=0.002):
    """Settings read in several repeats, each reading a little different."""
    random = np.random.default_rng(seed)
    values = np.tile(values, repeats) * (1 + size * random.standard_normal(len(values) * repeats))
    return values, np.repeat(np.arange(repeats), len(values) // repeats)


def damper():
    """Eight speeds both ways at five shunts, two repeats, and an open circuit test of ten speeds."""
    speeds = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5])
    grid = [(s * way, shunt) for shunt in (0.5, 1, 3, 10, 1e6) for s in speeds for way in (1, -1)]
    velocity, repeat = scattered([v for v, _ in grid], 2)
    shunt = np.tile([shunt for _, shunt in grid], 2)
    force = table("damping_velocity", repeat, velocity=velocity, shunt=shunt)
    open_velocity, open_repeat = scattered(np.linspace(0.03, 0.4, 10), 2, 1)
    return force, table("back_emf", open_repeat, velocity=open_velocity)


def machine():
    """A back-EMF at one speed both ways over the angle, and torque at three currents over the angle."""
    angle, repeat = np.tile(np.linspace(0, 6, 40), 3), np.repeat([0, 1, 2], 40)
    speed = 104.7 * (1 + 1e-3 * np.random.default_rng(2).standard_normal(120)) * np.where(repeat == 1, -1, 1)
    emf = table("back_emf", repeat, angle_mech=angle, speed=speed, magnet_T=22 + np.sin(angle))
    level = np.repeat([30.0, 60.0, 120.0], 40)
    torque = table("locked_rotor", repeat * 0, angle_mech=angle, i_a=level, i_b=-level / 2, i_c=-level / 2)
    return emf, torque


def test_blocks_are_ranges_of_the_dominating_condition():
    force, _ = damper()
    blocks, speed = blocks_of(force), np.abs(force.conditions["velocity"])
    assert sorted(set(blocks)) == [0, 1, 2, 3, 4]
    assert all(speed[blocks == k].max() < speed[blocks == k + 1].min() for k in range(4))
    assert np.bincount(blocks).max() <= 2.5 * np.bincount(blocks).min()


def test_both_directions_and_all_repeats_of_a_station_are_in_one_block():
    for one in damper():
        blocks = blocks_of(one)
        settings = np.round(np.abs(one.conditions["velocity"]), 2)
        assert all(len(set(blocks[settings == s])) == 1 for s in np.unique(settings))


def test_repeats_of_a_swept_condition_stay_together():
    x = np.linspace(0.0, 1.0, 83)
    value, repeat = scattered(x, 3, size=0.0)
    jitter = value + 0.003 * np.random.default_rng(3).standard_normal(len(value))
    blocks = blocks_of(table(displacement=jitter, repeat=repeat)).reshape(3, -1)
    assert (blocks == blocks[0]).all() and blocks.max() == 4


def test_pieces_of_a_revolution_are_no_blocks():
    emf, torque = machine()
    assert conditions_of(emf) == () and not blocks_of(emf).any()
    assert np.bincount(blocks_of(torque)).tolist() == [40, 40, 40], "three currents"


def test_a_current_vector_that_only_turns_is_one_condition():
    phase = np.linspace(0, 6, 60)
    turned = table("locked_rotor", **{f"i_{x}": 50 * np.cos(phase - k * 2 * np.pi / 3) for k, x in enumerate("abc")})
    assert not blocks_of(turned).any()


def test_a_zero_that_scatters_is_no_setting():
    i_d = 0.05 * np.random.default_rng(4).standard_normal(20)
    found = conditions_of(table("dq_operation", i_d=i_d, i_q=np.repeat([10.0, 20.0, 40.0, 80.0], 5)))
    assert [(c.name, c.count) for c in found] == [("i_q", 4)]


def test_temperatures_are_compared_in_kelvin():
    logged = table("phase_resistance", winding_T=[0.1, 1.0, 0.5, 0.2])
    heated = table("phase_resistance", winding_T=[0.0, 40.0, 80.0, 40.5])
    assert conditions_of(logged) == () and conditions_of(heated)[0].count == 3


def test_the_edge_that_is_sealed():
    force, opened = damper()
    region = sealed_region((force, opened))
    assert region.words == "velocity above 0.4 m/s either way" or "velocity above" in region.words
    for one, mask in zip((force, opened), region.masks):
        speed = np.abs(one.conditions["velocity"])
        assert mask.any() and speed[mask].min() > speed[~mask].max()
    share = sum(m.sum() for m in region.masks) / (force.rows + opened.rows)
    assert 0.05 < share <= 0.2
    assert all((a == b).all() for a, b in zip(region.masks, sealed_region((force, opened)).masks))


def test_the_bound_in_words_lies_between_what_is_fitted_and_what_is_sealed():
    force, _ = damper()
    region = sealed_region((force,))
    bound, speed = float(region.words.split()[2]), np.abs(force.conditions["velocity"])
    assert speed[~region.masks[0]].max() < bound < speed[region.masks[0]].min()


def test_two_settings_are_left_in_every_table():
    emf, torque = machine()
    region = sealed_region((emf, torque))
    assert region.words == "current above 90 A"
    assert not region.masks[0].any() and region.masks[1].sum() == 40


@pytest.mark.parametrize("speeds", [[1.0] * 9, [1.0, 2.0] * 5, [1.0] + [2.0] + [3.0] * 9])
def test_where_settings_do_not_allow_it_nothing_is_sealed(speeds):
    region = sealed_region((table("drag", speed=speeds),))
    assert region.words == "" and not region.masks[0].any()


def test_the_measured_motor():
    campaign = read_campaign(PRIUS)
    emf, cold, warm = campaign.tables
    assert [conditions_of(t)[0].name for t in campaign.tables] == ["speed", "torque", "torque"]
    region = sealed_region(campaign.tables)
    assert region.words == "torque above 135 Nm"
    assert [int(mask.sum()) for mask in region.masks] == [0, 4, 1]
    assert np.bincount(blocks_of(cold)).tolist() == [4, 3, 4, 3, 4]
