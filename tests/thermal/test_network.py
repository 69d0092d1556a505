"""Networks against closed forms: two nodes by hand, a matrix exponential, balances, and a loss that runs away."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.linalg import expm

from thermal.course import course
from thermal.errors import NoSteadyState, ThermalError
from thermal.network import Link, Network, Node, settled

AIR, G_1, G_2, C_1, C_2, P = 20.0, 2.0, 0.5, 100.0, 900.0, 30.0  # degC, W/K, W/K, J/K, J/K, W


def two_nodes(film=G_2):
    nodes = (Node("inside", C_1), Node("outside", C_2))
    return Network(nodes, (Link("inside", "outside", G_1), Link("outside", "air", film)), {"air": AIR})


@dataclass(frozen=True)
class Warmed:
    """Two nodes; the film grows with its temperature and the loss of the inner one with its own, where asked for."""

    of_film: float = 0.0  # 1/K
    of_loss: float = 0.0  # 1/K

    def network(self, temperature):
        return two_nodes(G_2 * (1 + self.of_film * (temperature["outside"] - AIR)))

    def heat(self, temperature):
        return {"inside": P * (1 + self.of_loss * (temperature["inside"] - AIR))}


COLD = {"inside": AIR, "outside": AIR, "air": AIR}


def test_two_nodes_in_a_row_by_hand():
    found = two_nodes().steady({"inside": P})
    assert found["outside"] == pytest.approx(AIR + P / G_2)
    assert found["inside"] == pytest.approx(AIR + P / G_2 + P / G_1)
    assert found["air"] == AIR


def test_time_constants_are_the_roots_of_the_quadratic():
    """C_1 C_2 s^2 - (C_1 (G_1 + G_2) + C_2 G_1) s + G_1 G_2 = 0 with s = 1 / tau."""
    a, b, c = C_1 * C_2, C_1 * (G_1 + G_2) + C_2 * G_1, G_1 * G_2
    rates = (b + np.array([-1, 1]) * np.sqrt(b * b - 4 * a * c)) / (2 * a)
    assert two_nodes().time_constants() == pytest.approx(1 / rates)


def test_a_warming_is_that_of_the_matrix_exponential():
    found = course(Warmed(), COLD, 1500.0)
    matrix = np.array([[G_1, -G_1], [-G_1, G_1 + G_2]]) / np.array([[C_1], [C_2]])
    rest = np.array([two_nodes().steady({"inside": P})[name] for name in ("inside", "outside")])
    exact = np.array([rest + expm(-matrix * t) @ (AIR - rest) for t in found.time]).T
    assert found.temperature == pytest.approx(exact, abs=0.02)
    assert np.ptp(exact, axis=1).min() > 20.0, "else this shows nothing"


def test_what_arises_is_stored_or_delivered():
    found = course(Warmed(of_film=0.01, of_loss=0.004), COLD, 3000.0)
    assert found.stored[1:] + found.delivered[1:] == pytest.approx(found.produced[1:], rel=1e-4)
    assert found.delivered[-1] > found.stored[-1] > 0.1 * found.produced[-1], "both must count"


def test_a_loss_that_rises_with_the_temperature_settles_where_it_is_balanced():
    """R = 1/G_1 + 1/G_2: dT = R P (1 + a dT), so dT = R P / (1 - a R P)."""
    found = settled(Warmed(of_loss=0.004), COLD)
    rise = (1 / G_1 + 1 / G_2) * P
    assert found["inside"] - AIR == pytest.approx(rise / (1 - 0.004 * rise), rel=1e-6)


def test_a_loss_that_runs_away_has_no_steady_state():
    with pytest.raises(NoSteadyState):
        settled(Warmed(of_loss=0.02), COLD)


def test_a_course_ends_where_its_condition_is_met():
    found = course(Warmed(), COLD, 1e6, until=lambda temperature: temperature["inside"] - 50.0)
    assert found.stopped and found.of("inside")[-1] == pytest.approx(50.0, abs=1e-3)
    assert not course(Warmed(), COLD, 10.0, until=lambda temperature: temperature["inside"] - 50.0).stopped


def test_flows_and_delivery_are_those_of_the_temperatures():
    network = two_nodes()
    found = network.steady({"inside": P})
    assert [flow for _, flow in network.flows(found)] == pytest.approx([P, P])
    assert network.delivered(found) == pytest.approx(P)
    turned = Network(network.nodes, (Link("outside", "inside", G_1), Link("air", "outside", G_2)), {"air": AIR})
    assert turned.delivered(turned.steady({"inside": P})) == pytest.approx(P)


def test_a_link_to_nowhere_and_a_node_without_a_way_are_refused():
    with pytest.raises(ThermalError, match="sink"):
        Network((Node("a", 1.0),), (Link("a", "sink", 1.0),), {"air": AIR})
    with pytest.raises(ThermalError, match="b has no way"):
        Network((Node("a", 1.0), Node("b", 1.0)), (Link("a", "air", 1.0), Link("a", "b", 0.0)), {"air": AIR})
