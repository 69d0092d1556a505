"""Views of a residual that is known: orders of both directions, powers of a circuit, order of acquisition."""

from types import SimpleNamespace

import numpy as np
import pytest

from workbench.compare.views import ChannelView, channel_fit, order_spectra, scalings, sequences
from workbench.data.stack import stacked
from workbench.data.table import OPEN_CIRCUIT, Response, Table

TURN = np.linspace(0, 2 * np.pi, 180, endpoint=False)
RANDOM = np.random.default_rng(11)


def view(kind, conditions, response, residual, u, scan=None, design=None, device=None):
    """A channel whose model answers zero."""
    n = len(residual)
    zero = np.zeros(n, dtype=int)
    columns = {response: Response(response, residual + u * RANDOM.standard_normal(n), np.full(n, u), "")}
    scan = zero if scan is None else scan
    stack = stacked([Table(kind, "t.csv", conditions, columns, scan, zero, zero.astype(bool))])
    white = type("White", (), {"sigma": stack.u, "__call__": lambda self, y: y / stack.u})()
    bench = SimpleNamespace(
        stack=stack, white=white, campaign=SimpleNamespace(device=device or {}), model=SimpleNamespace(design=design)
    )
    return ChannelView(bench, stack.channels[0], np.zeros(n), np.zeros(n))


def turned(even, odd):
    """Cogging both ways: ``even`` is the same both ways, ``odd`` changes its sign with the direction."""
    angle, direction = np.tile(TURN, 4), np.repeat([1.0, -1.0, 1.0, -1.0], len(TURN))
    conditions = {"angle_mech": angle, "direction": direction}
    residual = even(angle) + direction * odd(angle)
    scan = np.repeat(np.arange(4), len(TURN))
    return view("cogging", conditions, "torque", residual, 0.01, scan, device={"slots": 12, "poles": 10})


def above(spectrum):
    return list(spectrum.orders[spectrum.amplitude > 1.5 * spectrum.floor])


def test_orders_that_change_sign_with_the_direction_do_not_cancel():
    same, opposite = order_spectra(turned(lambda a: 0.05 * np.cos(12 * a), lambda a: 0.03 * np.cos(a)))
    assert (same.part, opposite.part) == ("the same both ways", "opposite both ways")
    assert above(same) == [12] and above(opposite) == [1]
    assert same.amplitude[11] == pytest.approx(0.05, rel=0.1)
    assert opposite.amplitude[0] == pytest.approx(0.03, rel=0.1)
    assert same.classes[11] == "rotor" and "opposite both ways" in opposite.title


def test_one_direction_gives_one_spectrum_and_noise_stays_below_its_floor():
    conditions = {"angle_mech": np.tile(TURN, 2)}
    (quiet,) = order_spectra(view("cogging", conditions, "torque", np.zeros(360), 0.01))
    assert quiet.part == "" and above(quiet) == []


@pytest.mark.parametrize("power, words", [(-1, "force constant"), (-2, "resistance in series"), (0, "friction")])
def test_the_power_of_a_shunt_counts_the_internal_resistance(power, words):
    velocity, shunt = (v.ravel() for v in np.meshgrid(np.linspace(0.1, 0.4, 8), [0.2, 0.8, 2.0, 5.0, 12.0]))
    residual = 40.0 * (shunt + 1.2) ** power * np.sign(velocity)
    found = view("damping_velocity", {"velocity": velocity, "shunt": shunt}, "force", residual, 0.02,
                 design=SimpleNamespace(internal_resistance=1.2))  # fmt: skip
    (scaling,) = [s for s in scalings(found) if s.quantity == "shunt"]
    assert scaling.low90 <= power <= scaling.high90 and words in scaling.meaning


def test_a_residual_that_goes_with_temperature_is_seen_over_temperature():
    warm = RANDOM.permutation(np.linspace(20, 80, 40))
    conditions = {"speed": np.linspace(1, 9, 40), "magnet_T": warm}
    over = {s.axis.name: s for s in sequences(view("drag", conditions, "torque", 0.01 * (warm - 50), 0.1))}
    assert over["magnet_T"].p_value < 0.01 < over["sample"].p_value
    assert over["magnet_T"].trend == pytest.approx(6.0, abs=0.8)


def test_an_open_circuit_is_called_so():
    velocity, shunt = (v.ravel() for v in np.meshgrid(np.linspace(0.1, 0.4, 8), [3.0, OPEN_CIRCUIT]))
    found = channel_fit(view("damping_velocity", {"velocity": velocity, "shunt": shunt}, "force", 0 * shunt, 0.1))
    assert set(found.series) == {"shunt 3 ohm", "shunt open"}
