"""What the machine bench proposes to measure next."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from effects.machine.bearing_friction import BearingFriction
from effects.machine.bearing_viscous import BearingViscous
from tests.workbench.models.machine_case import STATES, builder, drawn, surrogate
from workbench.data.kinds import KINDS
from workbench.data.table import Response, Table
from workbench.models.machine.model import MachineBench
from workbench.models.machine.options import options
from workbench.models.model import Model

LOADED = STATES[0]


@pytest.fixture(scope="module")
def bench():
    return replace(MachineBench(cache=None), surrogate=surrogate(), builder=builder(), about_drawing=surrogate())


def table(kind: str, conditions: dict, u: dict) -> Table:
    n = len(next(iter(conditions.values())))
    responses = {name: Response(name, np.zeros(n), np.full(n, size), "") for name, size in u.items()}
    return Table(kind, f"{kind}.csv", conditions, responses, np.zeros(n, int), np.zeros(n, int), np.zeros(n, bool))


def currents(rows: int) -> dict[str, np.ndarray]:
    return {f"i_{x}": np.full(rows, i) for x, i in zip("abc", LOADED.currents)}


COGGING = table("cogging", {"angle_mech": np.zeros(4), "direction": np.ones(4)}, {"torque": 1.5e-3})
LOCKED = table("locked_rotor", {"angle_mech": np.full(3, LOADED.angle), **currents(3)}, {"torque": 8e-3})
EMF = table("back_emf", {"angle_mech": np.zeros(4), "speed": np.ones(4)}, {f"v_{x}": 0.012 for x in "abc"})
RESISTANCE = table("phase_resistance", {"winding_T": np.full(2, 20.0)}, {f"r_{x}": 15e-6 for x in "abc"})
ALL = (COGGING, LOCKED, EMF, RESISTANCE)


def by_kind(tables) -> dict:
    return {option.kind: option for option in options(tables)}


def test_the_bench_answers_every_option(bench):
    """All columns that the kind registers, a finite value and an uncertainty for every row."""
    found = by_kind(ALL)
    assert set(found) == {"drag", "cogging", "back_emf", "phase_resistance", "locked_rotor", "short_circuit"}
    for option in found.values():
        answer = bench.respond(drawn(), option.kind, option.conditions)
        assert set(option.random) <= set(answer)
        for name, u in option.random.items():
            assert KINDS[option.kind].is_response(name)
            assert np.all(np.isfinite(answer[name])) and answer[name].shape == u.shape


@pytest.mark.parametrize("kind, u", (("cogging", 1.5e-3), ("locked_rotor", 8e-3), ("drag", 1.5e-3)))
def test_torque_is_read_as_in_the_same_kind_of_table_else_with_the_best_cell(kind, u):
    assert_allclose(by_kind(ALL)[kind].random["torque"], u)


def test_nothing_is_proposed_without_an_instrument_for_it():
    assert set(by_kind((RESISTANCE,))) == {"phase_resistance"}
    assert set(by_kind((EMF,))) == {"back_emf"}
    assert options(()) == []


def test_loaded_points_are_those_that_were_measured_once_each_and_never_without_current():
    at_rest = {"angle_mech": np.zeros(1)} | {f"i_{x}": np.zeros(1) for x in "abc"}
    idle = table("flux_linkage", at_rest, {"dpsi_a": 1e-6})
    found = by_kind((LOCKED, idle))["locked_rotor"].conditions
    assert_allclose(found["angle_mech"], [LOADED.angle])
    assert_allclose([found[f"i_{x}"][0] for x in "abc"], LOADED.currents)
    assert "locked_rotor" not in by_kind((idle, COGGING))


def test_drag_tells_dry_from_viscous_friction_which_cogging_cannot(bench):
    """Cogging at one slow speed sees a level only; over speeds the cosine of both laws is sum v / sqrt(n sum v^2)."""
    model = Model(bench, drawn())
    dry, viscous = BearingFriction(level=0.01), BearingViscous(slope=2e-5)
    change = {}
    for option in (by_kind(ALL)[kind] for kind in ("cogging", "drag")):
        asked = table(option.kind, option.conditions, {"torque": 1.0})
        nothing = model.answers(asked)["torque"]
        change[option.kind] = [(model + effect).answers(asked)["torque"] - nothing for effect in (dry, viscous)]
    assert np.ptp(change["cogging"][0]) == pytest.approx(0.02) and not change["cogging"][1].any()
    first, second = change["drag"]
    cosine = first @ second / np.sqrt((first @ first) * (second @ second))
    speeds = np.array([50, 100, 200, 400, 700, 1000, 1500, 2000])
    assert cosine == pytest.approx(speeds.sum() / np.sqrt(len(speeds) * (speeds**2).sum()))
