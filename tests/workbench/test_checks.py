"""Each check that needs no model speaks on data made for it, and is silent on data without the fault."""

from dataclasses import replace

import numpy as np
import pytest

from workbench.data.checks import checks_of
from workbench.data.table import Campaign, Response, Table

RANDOM = np.random.default_rng(4)
ANGLE = np.tile(np.linspace(0, 2 * np.pi, 180, endpoint=False), 2)
DIRECTION = np.repeat([1.0, -1.0], 180)
SPEED = np.linspace(0.1, 0.5, 24)


def table(kind, conditions, responses, u, repeat=None):
    n = len(next(iter(responses.values())))
    noisy = {k: Response(k, v + u * RANDOM.standard_normal(n), np.full(n, u), "") for k, v in responses.items()}
    zero = np.zeros(n, dtype=int)
    return Table(kind, f"{kind}.csv", conditions, noisy, zero, zero if repeat is None else repeat, zero.astype(bool))


def said(*tables, device=None):
    return " ".join(checks_of(Campaign("c", ".", device or {}, tables, (), (), 2, {})))


def cogging(friction=0.0, zero=0.0):
    torque = 0.05 * np.sin(60 * ANGLE) + friction * DIRECTION + zero
    return table("cogging", {"angle_mech": ANGLE, "direction": DIRECTION}, {"torque": torque}, 0.002)


def emf(gain=1.0, offset=0.0):
    waves = {f"v_{x}": np.cos(5 * ANGLE - k * 2 * np.pi / 3) for k, x in enumerate("abc")}
    waves["v_a"] = gain * waves["v_a"] + offset
    return table("back_emf", {"angle_mech": ANGLE}, waves, 0.005)


def resistance(coefficient):
    warm = np.linspace(20, 100, 9)
    return table("phase_resistance", {"winding_T": warm}, {"r_a": 0.012 * (1 + coefficient * (warm - 20))}, 1e-5)


def force(zero=0.0, k=60.0):
    v, shunt = np.tile(SPEED, 2), np.repeat([0.5, 10.0], len(SPEED))
    return table(
        "damping_velocity", {"velocity": v, "shunt": shunt}, {"force": k**2 * v / (1.2 + shunt) + 20 * v + zero}, 0.2
    )


def voltage(k=60.0):
    return table("back_emf", {"velocity": SPEED}, {"voltage": k * SPEED}, 0.01)


DAMPER = {"internal_resistance_ohm": 1.2}


def metered(worked_out):
    """A map of a motor whose power meter shows an efficiency: of its own, or of the same readings."""
    speed, torque = np.repeat([100.0, 200.0, 300.0], 8), np.tile(np.linspace(0.5, 4.0, 8), 3)
    power = (torque * speed + 20.0 + 5.0 * torque**2) * (1 + 0.01 * RANDOM.standard_normal(24))
    shown = torque * speed / power * (1 if worked_out else 1 + 0.01 * RANDOM.standard_normal(24))
    return table(
        "dyno_map", {"speed": speed, "torque": torque}, {"power": power, "efficiency": np.round(shown, 4)}, 1e-9
    )


def without_shunt(one):
    return replace(one, conditions={"velocity": one.conditions["velocity"]})


def quiet(size):
    """Three repeats that scatter by a share of what is declared."""
    values = np.tile(np.linspace(1.0, 2.0, 8), 3)
    exact = table("generic", {"speed": values}, {"torque": values}, 1e-9, np.repeat([0, 1, 2], 8))
    readings = values + 0.01 * size * RANDOM.standard_normal(24)
    return replace(exact, responses={"torque": Response("torque", readings, np.full(24, 0.01), "")})


@pytest.mark.parametrize(
    "wrong, right, words, device",
    [
        ([metered(True)], [metered(False)], "worked out from torque, speed and power", {}),
        ([quiet(0.05)], [quiet(1.0)], "of the declared uncertainty; lower u_random", {}),
        ([cogging(friction=0.01)], [cogging()], "half-difference", {}),
        ([cogging(zero=0.01)], [cogging()], "zero of the torque cell", {}),
        ([emf(gain=1.03)], [emf()], "differ by", {}),
        ([emf(offset=0.02)], [emf()], "has an offset", {}),
        ([resistance(0.0043)], [resistance(0.00393)], "copper by 0.00393", {}),
        ([force(zero=-40.0)], [force()], "give power", DAMPER),
        ([without_shunt(force())], [force()], "so that they count as open", DAMPER),
        ([force(), voltage(66.0)], [force(), voltage()], "force constant from the forces", DAMPER),
    ],
)
def test_a_check_speaks_when_it_should(wrong, right, words, device):
    assert words in said(*wrong, device=device)
    assert words not in said(*right, device=device)


def test_repeats_that_disagree_and_clipping():
    repeat = np.repeat([0, 1], len(SPEED))
    v = np.tile(SPEED, 2)
    shifted = table("damping_velocity", {"velocity": v}, {"force": 20 * v + 8.0 * repeat}, 0.2, repeat)
    assert "disagree by" in said(shifted)
    clipped = table("damping_velocity", {"velocity": v}, {"force": np.minimum(20 * v, 6.0)}, 1e-12)
    stuck = np.minimum(np.round(clipped.responses["force"].values, 6), 6.0)
    clipped.responses["force"] = Response("force", stuck, np.full(len(v), 0.2), "N")
    assert "clipped?" in said(clipped)


def test_a_force_loop_over_nobody_knows_what_shunt_counts_as_open_and_is_said():
    v = np.tile(SPEED, 2)
    loop = table("force_loop", {"velocity": v}, {"force": 20 * v}, 0.2)
    assert "so that they count as open" in said(loop)
    shunted = replace(loop, conditions={"velocity": v, "shunt": np.full(len(v), 2.0)})
    assert "so that they count as open" not in said(shunted)


def test_one_wild_reading_is_no_disagreement_of_the_repeats():
    repeat, v = np.repeat([0, 1], len(SPEED)), np.tile(SPEED, 2)
    wild = table("damping_velocity", {"velocity": v}, {"force": 20 * v + 8.0 * (np.arange(len(v)) == 5)}, 0.2, repeat)
    assert "disagree by" not in said(wild)


def test_a_coarse_converter_is_not_taken_for_a_clipped_reading():
    v = np.tile(SPEED, 2)
    coarse = table("damping_velocity", {"velocity": v}, {"force": np.round(20 * v / 3.0) * 3.0}, 1e-12)
    levels = np.round(coarse.responses["force"].values)
    coarse.responses["force"] = Response("force", levels, np.full(len(v), 0.2), "N")
    assert (levels == levels.max()).mean() > 0.05 and "clipped?" not in said(coarse)


def test_a_negative_real_part_is_no_passive_device():
    f = np.linspace(1, 20, 20)
    wrong = table("impedance", {"frequency": f}, {"re": 30.0 - 3 * f, "im": f}, 0.5)
    assert "negative" in said(wrong)
    assert "negative" not in said(table("impedance", {"frequency": f}, {"re": 30.0 + 0 * f, "im": f}, 0.5))


def impedance(wrong=0.0):
    """A mass, a spring and a damper with an eddy current; ``wrong`` is added to the real part alone, over frequency."""
    f = np.geomspace(1, 40, 16)
    w = 2 * np.pi * f
    z = 80 + 5.6j * w + 2000 / (1j * w) + 300 / (1 + 1j * w / 60)
    return table("impedance", {"frequency": f}, {"re": z.real + wrong * np.sin(6 * np.log(w)), "im": z.imag}, 1.0)


def test_real_and_imaginary_part_belong_to_one_causal_device():
    assert "causal" not in said(impedance())
    assert "causal" in said(impedance(wrong=12.0))


def test_a_loop_takes_work():
    turn = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    place = 0.01 * np.sin(turn)
    forward, backward = (500 * place + sign * 3 * np.cos(turn) for sign in (+1, -1))
    assert "gives" in said(table("force_loop", {"displacement": place}, {"force": backward}, 0.2))
    assert "gives" not in said(table("force_loop", {"displacement": place}, {"force": forward}, 0.2))
