"""A thermal network: places that store heat, conductances between them, and surroundings of a given temperature.

    C_k dT_k/dt = P_k + sum over links of G (T_other - T_k)

Heat capacities C [J/K] and conductances G [W/K] of one moment; whoever has films that change with the temperature, or
a loss that does, is a ``Body`` that gives its network and its heat at the temperatures found so far.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from thermal.errors import NoSteadyState, ThermalError

Temperatures = Mapping[str, float]  # of every node and of the surroundings, by name [degC]
Heat = Mapping[str, float]  # that arises in a node, by name [W]; nothing in those that are not named

_SETTLED = 1e-7  # K between two rounds
_ROUNDS = 500
_TOO_HOT = 1500.0  # degC; no machine has a steady state beyond the melting point of copper


@dataclass(frozen=True)
class Node:
    """A place of one temperature; capacity: heat that it stores [J/K]."""

    name: str
    capacity: float


@dataclass(frozen=True)
class Link:
    """A path between two places, by their names; conductance [W/K]."""

    first: str
    second: str
    conductance: float


@dataclass(frozen=True)
class Network:
    """Nodes and links of one moment; surroundings: given temperatures by name [degC].

    Raises ThermalError where a link leads nowhere, or a node has no way to the surroundings.
    """

    nodes: tuple[Node, ...]
    links: tuple[Link, ...]
    surroundings: Mapping[str, float]

    def __post_init__(self) -> None:
        known = {*self.names, *self.surroundings}
        lost = [end for link in self.links for end in (link.first, link.second) if end not in known]
        if lost:
            raise ThermalError(f"a link leads to {lost[0]}, which is neither a node nor a surrounding; name it as one")
        cut_off = set(self.names) - self._reached()
        if cut_off:
            raise ThermalError(f"{sorted(cut_off)[0]} has no way to the surroundings; give it a link that conducts")

    @property
    def names(self) -> tuple[str, ...]:
        """Of the nodes, in their order."""
        return tuple(node.name for node in self.nodes)

    @property
    def capacities(self) -> np.ndarray:
        """Of the nodes [J/K], (n,)."""
        return np.array([node.capacity for node in self.nodes])

    def equations(self) -> tuple[np.ndarray, np.ndarray]:
        """(M, b) of C dT/dt = P + b - M T: conductances [W/K] (n, n), and heat from the surroundings [W] (n,)."""
        place = {name: k for k, name in enumerate(self.names)}
        matrix, inflow = np.zeros((len(place), len(place))), np.zeros(len(place))
        for link in self.links:
            for here, there in ((link.first, link.second), (link.second, link.first)):
                if here not in place:
                    continue
                matrix[place[here], place[here]] += link.conductance
                if there in place:
                    matrix[place[here], place[there]] -= link.conductance
                else:
                    inflow[place[here]] += link.conductance * self.surroundings[there]
        return matrix, inflow

    def steady(self, heat: Heat) -> dict[str, float]:
        """Temperatures [degC] at which as much heat [W] leaves as arises; one linear solution."""
        matrix, inflow = self.equations()
        return self.named(np.linalg.solve(matrix, self.vector(heat) + inflow))

    def vector(self, values: Mapping[str, float], missing: float = 0.0) -> np.ndarray:
        """values: by name [degC or W]; in the order of the nodes, (n,); missing: of those not named [degC or W]."""
        return np.array([values.get(name, missing) for name in self.names])

    def named(self, temperature: np.ndarray) -> dict[str, float]:
        """By name [degC], the surroundings with them; temperature: of the nodes [degC], (n,)."""
        return {**dict(zip(self.names, temperature.tolist(), strict=True)), **self.surroundings}

    def flows(self, temperature: Temperatures) -> tuple[tuple[Link, float], ...]:
        """Every link with the heat [W] that it carries from its first to its second end."""
        return tuple(
            (link, link.conductance * (temperature[link.first] - temperature[link.second])) for link in self.links
        )

    def delivered(self, temperature: Temperatures) -> float:
        """Heat that leaves into all surroundings together [W]."""
        outwards = ((flow, link.first, link.second) for link, flow in self.flows(temperature))
        return sum(
            (second in self.surroundings) * flow - (first in self.surroundings) * flow
            for flow, first, second in outwards
        )

    def time_constants(self) -> np.ndarray:
        """Of the network left to itself [s], (n,), the longest first: eigenvalues of M^-1 C."""
        matrix, _ = self.equations()
        values = np.linalg.eigvals(np.linalg.solve(matrix, np.diag(self.capacities)))
        return np.sort(values.real)[::-1]

    def _reached(self) -> set[str]:
        """Names that conduct to the surroundings."""
        found, before = set(self.surroundings), -1
        while len(found) > before:
            before = len(found)
            for link in self.links:
                if link.conductance > 0 and {link.first, link.second} & found:
                    found |= {link.first, link.second}
        return found


class Body(Protocol):
    """Something that warms up: its network, and the heat that arises in it, at the temperatures it has."""

    def network(self, temperature: Temperatures) -> Network:
        """Nodes and links; temperature: by name [degC]."""

    def heat(self, temperature: Temperatures) -> Heat:
        """Of the nodes [W]; temperature: by name [degC]."""


def settled(body: Body, start: Temperatures) -> dict[str, float]:
    """The steady state [degC] of a body whose films and losses go with its temperature, from a start [degC].

    Raises NoSteadyState where the loss runs away with the temperature.
    """
    temperature = dict(start)
    for _ in range(_ROUNDS):
        found = body.network(temperature).steady(body.heat(temperature))
        if max(found.values()) > _TOO_HOT:
            break
        if max(abs(found[name] - temperature[name]) for name in found) < _SETTLED:
            return found
        temperature = found
    raise NoSteadyState("no steady state below the melting point of copper: less loss or better cooling is needed")
