"""What is unknown in the answers of the machine bench: means over an interval by quadrature, orders by their size."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.effects.contract import table
from tests.effects.machine_bench import TURN, bench
from tests.workbench.models.machine_case import surrogate
from workbench.models.machine.answers import Answers
from workbench.models.machine.numerical import LEAST, LEFT, voltage_orders

PHASES = ("v_a", "v_b", "v_c")
TURNS = [np.arange(0, 20 * np.pi, 2 * np.pi / n) for n in (100.3, 60.3)]  # no order looks like another one
SPEED = 100.0  # rad/s
AT = {"angle_mech": TURN, "speed": np.full(len(TURN), SPEED)}


def shapes(found=None, kind="back_emf", responses=PHASES, **conditions):
    asked = bench() if found is None else replace(bench(), surrogate=found, about_drawing=found)
    return asked.numerical(surrogate().nominal, table(kind, responses, **(conditions or AT)))


def order_of(shape):
    """The one order of the revolution that a shape has."""
    size = np.abs(np.fft.rfft(shape["v_a"]))
    assert np.sort(size)[-2] < 1e-6 * size.max()
    return int(size.argmax())


def test_a_recorder_may_average_over_the_interval_between_readings():
    interval = TURN[1] - TURN[0]
    offsets = (np.arange(200) + 0.5) / 200 * interval - interval / 2
    inside = bench().respond(surrogate().nominal, "back_emf", {
        "angle_mech": (TURN[:, None] + offsets).ravel(), "speed": np.full(len(TURN) * 200, SPEED)
    })  # fmt: skip
    drawn = bench().respond(surrogate().nominal, "back_emf", AT)
    change = {name: inside[name].reshape(-1, 200).mean(axis=1) - drawn[name] for name in PHASES}
    size = np.abs(change["v_a"]).max()
    assert any(
        all(np.abs(shape[name] - change[name]).max() < 1e-3 * size for name in PHASES) for shape in shapes() if shape
    )


def test_what_a_mesh_lacks_in_one_order_its_neighbours_may_lack():
    """Two meshes that differ by 1 % in the order 25 alone."""
    same = surrogate()
    coarse = same.no_load.copy()
    coarse[:, 25] *= 1.01
    found = [s for s in shapes(replace(same, coarse=coarse)) if s and np.ptp(s["v_a"]) > 0]
    before = [s for s in shapes(replace(same, coarse=same.no_load)) if s and np.ptp(s["v_a"]) > 0]
    drawn = np.abs(np.fft.rfft(bench().respond(same.nominal, "back_emf", AT)["v_a"]))
    new = [s for s in found if not any(np.array_equal(s["v_a"], other["v_a"]) for other in before)]
    orders = {order_of(s): np.abs(np.fft.rfft(s["v_a"])).max() for s in new}
    at = [5, *voltage_orders(same)].index(25)
    near = [5, *voltage_orders(same)][at - 1 : at + 2]
    assert set(orders) == set(near)
    assert list(orders.values()) == pytest.approx([LEFT * 0.01 * drawn[25] / np.sqrt(3)] * 3, rel=1e-6)


HIGHEST = 0.8 * 120  # order that 240 readings a turn surely show


def left_out(columns, wave):
    """Share of a wave that no sum of columns is."""
    return np.linalg.norm(wave - columns @ np.linalg.lstsq(columns, wave, rcond=None)[0]) / np.linalg.norm(wave)


def opened(speed, bandwidth=None, model=None):
    asked = table("back_emf", PHASES, angle_mech=TURN, speed=speed)
    responses = {name: replace(r, bandwidth=bandwidth) for name, r in asked.responses.items()}
    return (model or bench()).left_open(surrogate().nominal, replace(asked, responses=responses))


def test_orders_that_no_recorder_surely_passes_are_open_in_any_phase():
    columns = opened(AT["speed"])["v_b"]
    orders = [5, *voltage_orders(surrogate())]
    assert min(orders) < HIGHEST < max(orders)
    for order in orders:
        missed = left_out(columns, np.cos(order * TURN + 1.0))
        assert missed < 1e-4 if order > HIGHEST else missed > 0.9


def test_they_are_open_each_way_by_itself_where_the_rotor_turns_both():
    both = np.where(np.arange(len(TURN)) % 2, 1.0, -1.0) * SPEED
    order = max(voltage_orders(surrogate()))
    one_way = np.cos(order * TURN + 1.0) * (both > 0)
    assert left_out(opened(both)["v_a"], one_way) < 1e-4
    assert opened(both)["v_a"].shape[1] == 2 * opened(AT["speed"])["v_a"].shape[1]


def test_an_order_smaller_than_can_be_told_is_open_as_the_smallest_that_can():
    """Order 115, the highest that is kept, made a thousand times smaller."""
    drawn = surrogate()
    weak = drawn.no_load.copy()
    weak[:, 115] *= 1e-3
    of_weak = replace(bench(), surrogate=(found := replace(drawn, no_load=weak)), about_drawing=found)
    columns = opened(AT["speed"], model=of_weak)["v_b"]
    fundamental = np.abs(np.fft.rfft(bench().respond(drawn.nominal, "back_emf", AT)["v_b"])[5]) * 2 / len(TURN)
    least = LEAST * fundamental * np.sqrt(len(TURN) / 2)
    assert np.linalg.norm(columns, axis=0).min() == pytest.approx(least, rel=1e-3)


def test_a_declared_bandwidth_settles_what_passes():
    wide, narrow = (opened(AT["speed"], order * SPEED / (2 * np.pi) / 0.8) for order in (300, 30))
    assert wide["v_a"].shape[1] == 0 and narrow["v_a"].shape[1] > opened(AT["speed"])["v_a"].shape[1]


def test_every_table_has_its_shapes_in_the_same_places():
    voltage, cogging = shapes(), shapes(None, "cogging", ("torque",), angle_mech=TURN, direction=np.ones(len(TURN)))
    assert len(voltage) == len(cogging) and not any(a and b for a, b in zip(voltage, cogging))


def test_a_recorder_may_keep_back_what_lies_far_above_half_the_rate_of_readings():
    """1 - loss x^6 / (1 + x^6) of the order x times half the readings a revolution."""
    orders = np.array([5, *voltage_orders(surrogate())])
    lossy, drawn = (
        [Answers(surrogate(), replace(surrogate().nominal, recorder_loss=loss)).flux_slopes(at)[0] for at in TURNS]
        for loss in (0.8, 0.0)
    )
    for at, less, full in zip(TURNS, lossy, drawn):
        waves = np.cos(np.outer(at, orders)), np.sin(np.outer(at, orders))
        amplitudes = [np.hypot(*np.split(np.linalg.lstsq(np.hstack(waves), v, rcond=None)[0], 2)) for v in (less, full)]
        x = (orders * (at[1] - at[0]) / np.pi) ** 6
        seen = amplitudes[1] > 1e-3 * amplitudes[1].max()
        assert_allclose((amplitudes[0] / amplitudes[1])[seen], (1 - 0.8 * x / (1 + x))[seen], rtol=0.02)
