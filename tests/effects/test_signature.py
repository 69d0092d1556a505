"""Claims about what an effect does to readings: each holds where it should and fails where it should not."""

import numpy as np
import pytest

from effects.signature import Even, Like, Odd, Orders, Power, Touches, names

VELOCITY = np.array([-0.4, -0.2, -0.1, 0.1, 0.2, 0.4])
GRID = {
    "velocity": np.tile(VELOCITY, 2),
    "shunt": np.repeat([1.0, 5.0], 6),
    "order": np.linspace(0.0, 1.0, 12),
}
TURN = {"angle_mech": np.linspace(0.0, 2 * np.pi, 36, endpoint=False)}


def holds(claim, conditions, change) -> bool:
    return claim.error(conditions, change) <= claim.within


@pytest.mark.parametrize("power", [0.0, 1.0, 2.0])
def test_powers_are_read_within_rows_that_agree_in_everything_else(power):
    change = np.abs(GRID["velocity"]) ** power / GRID["shunt"]
    assert holds(Power("a.b", "velocity", power), GRID, change)
    assert holds(Power("a.b", "shunt", -1.0), GRID, change)
    assert not holds(Power("a.b", "velocity", power + 0.2), GRID, change)


def test_a_power_that_no_row_can_show_does_not_hold():
    assert not holds(Power("a.b", "velocity", 1.0, 7.0, 8.0), GRID, GRID["velocity"])
    assert not holds(Power("a.b", "velocity", 1.0), GRID, 0 * VELOCITY.repeat(2))


def test_a_power_holds_between_its_bounds_alone():
    change = np.where(np.abs(GRID["velocity"]) < 0.3, GRID["velocity"] ** 2, 1.0)
    assert holds(Power("a.b", "velocity", 2.0, 0.0, 0.3), GRID, change)
    assert not holds(Power("a.b", "velocity", 2.0), GRID, change)


def test_parity():
    odd, even = Odd("a.b", ("velocity",)), Even("a.b", ("velocity",))
    assert holds(odd, GRID, GRID["velocity"] ** 3) and not holds(even, GRID, GRID["velocity"] ** 3)
    assert holds(even, GRID, np.abs(GRID["velocity"])) and not holds(odd, GRID, np.abs(GRID["velocity"]))


def test_parity_needs_rows_that_mirror_each_other():
    one_way = {"velocity": np.array([0.1, 0.2]), "shunt": np.ones(2)}
    assert not holds(Odd("a.b", ("velocity",)), one_way, one_way["velocity"])


def test_orders():
    change = 0.3 + np.cos(2 * TURN["angle_mech"] + 0.7)
    assert holds(Orders("a.b", (0, 2)), TURN, change)
    assert not holds(Orders("a.b", (2,)), TURN, change)


def test_a_shape():
    change = 3.0 * GRID["order"] * GRID["velocity"]
    assert holds(Like("a.b", lambda at: at["order"] * at["velocity"]), GRID, change)
    assert not holds(Like("a.b", lambda at: at["order"]), GRID, change)


def test_touching():
    assert holds(Touches("a.b"), GRID, np.eye(12)[3]) and not holds(Touches("a.b"), GRID, np.zeros(12))
    assert names((Touches("back_emf.v_?"),), "back_emf.v_a") and not names((Touches("back_emf.v_?"),), "back_emf.v_ll")
