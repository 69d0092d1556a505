"""What may be wrong in the answers of a machine model before anything is wrong with the machine: shapes in the rows of
a table, each with a standard normal weight of its own that all tables and repeats share.

The mesh: the difference of the answers on two meshes of this very machine, times the share of it that the finer mesh
still lacks. One shape a kind of measurement; of the voltage one an order, as large as the difference is in that order
and its neighbours: in one order two meshes may agree by chance (at order 35 of 12 slots and 10 poles to 0.008 of 16.6
mV at 100 rad/s, where another code is 0.10 mV off).

The recorder: it may average over the interval between two readings, which lowers every order n of the voltage to
sinc(n interval / 2). That it may keep back orders far above half the rate of readings is a tolerance, see
``Answers.flux_slopes``: a machine that is not as drawn has orders that the drawing has not, and keeping them back must
not pass for a skew (of 9 slots and 8 poles with one magnet weaker by 16 %, it did by 10 nats; with the tolerance, 3).

What is left open, of every channel by itself: voltage orders near and above what a recorder passes. How much of them it
lets through and how late is unknown, they hang on corners that no drawing shows, and those above half the number of
readings look like lower ones. So each that the symmetry of the drawing leaves may be there in any phase, either way the
rotor turns, as large as the model has it or as the smallest that can be told from none (order 76 of 9 slots and 8 poles
is 1.2e-4 of the fundamental and four times that in another code).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from workbench.data.table import Response, Table
from workbench.models.machine.spectra import half_rate
from workbench.models.machine.surrogate import Surrogate

# Share of the difference between the two meshes that the finer one still lacks. Without current, 1,080 edges against
# 480: 2,160 (of 9 slots and 8 poles 1,728) edges differ from the fine ones by r = 0.20 (0.19) in voltage and by 0.27
# (0.33) in cogging of what the coarse ones do; with it, 720 against 240: 1,440 by 0.12 in torque and 0.35 in flux
# linkage. Going on like that, r + r^2 + ... = r/(1 - r) = 0.25, 0.37 (0.49), 0.14 and 0.54 is still to come. How
# cogging scatters from mesh to mesh besides is a tolerance of its own (``device._COGGING_OF_MESH``).
LEFT = 0.5
NEAR = 0.8  # of the highest order or frequency: filters against aliasing fall off from there
LEAST = 2e-4  # of the largest order of the voltage: smaller ones cannot be told from none
ROUND_OFF = 1e-9  # of the same: orders that the symmetry of the drawing forbids have 3e-15, the least of others 3e-7

Responses = Mapping[str, np.ndarray]
Ask = Callable[[Surrogate, Table], Responses]


def shapes_of(surrogate: Surrogate, kinds: Sequence[str], table: Table, ask: Ask) -> tuple[Responses, ...]:
    """All shapes in the rows of a table, SI, in the same places for every table; those that do not act in it are empty.

    surrogate: about the drawing;  kinds: of all tables that a mesh has a say in;  ask: what a surrogate answers
    """
    others = [kind for kind in kinds if kind != "back_emf"]
    return _mesh(surrogate, others, table, ask) + _orders(surrogate, table, ask) + _recorder(surrogate, table, ask)


def _mesh(surrogate: Surrogate, kinds: Sequence[str], table: Table, ask: Ask) -> tuple[Responses, ...]:
    if table.kind not in kinds:
        return tuple({} for _ in kinds)
    fine, coarse = ask(surrogate, table), ask(surrogate.on_coarse_mesh, table)
    left = {name: LEFT * (fine[name] - coarse[name]) for name in fine}
    return tuple(left if kind == table.kind else {} for kind in kinds)


def _orders(surrogate: Surrogate, table: Table, ask: Ask) -> tuple[Responses, ...]:
    """What the mesh leaves open in each order of the voltage."""
    shares = _left_in_orders(surrogate)
    if table.kind != "back_emf":
        return ({},) * len(shares)
    return tuple(ask(surrogate.in_orders(_only(surrogate, order, share)), table) for order, share in shares.items())


def _left_in_orders(surrogate: Surrogate) -> dict[int, float]:
    """Share of each order of the voltage that the finer mesh may still lack, the fundamental first."""
    orders = np.array(_voltage_orders(surrogate))
    fine, coarse = _voltage(surrogate)[:, orders], _voltage(surrogate.on_coarse_mesh)[:, orders]
    missing = np.square(np.abs(coarse - fine)).sum(0)
    around = [missing[max(k - 1, 0) : k + 2].mean() for k in range(len(orders))]
    return dict(zip(orders.tolist(), LEFT * np.sqrt(around) / np.linalg.norm(fine, axis=0)))


# ---- the recorder ----------------------------------------------------------------------------------------------------


def _recorder(surrogate: Surrogate, table: Table, ask: Ask) -> tuple[Responses, ...]:
    if table.kind != "back_emf":
        return ({},)
    return (ask(surrogate.in_orders(_averaging(surrogate, np.pi / half_rate(table.conditions["angle_mech"]))), table),)


def _averaging(surrogate: Surrogate, interval: float) -> np.ndarray:
    """What the mean over an interval [rad] changes of every order (orders,)."""
    return np.sinc(np.arange(surrogate.no_load.shape[1]) * interval / (2 * np.pi)) - 1.0


def _only(surrogate: Surrogate, order: int, share: complex) -> np.ndarray:
    """A share of one order and nothing of the others (orders,)."""
    return np.where(np.arange(surrogate.no_load.shape[1]) == order, share, 0.0)


def voltage_orders(surrogate: Surrogate) -> tuple[int, ...]:
    """Mechanical orders of the voltage of the machine as drawn beyond the fundamental, which every recorder passes."""
    return _voltage_orders(surrogate)[1:]


def _voltage_orders(surrogate: Surrogate) -> tuple[int, ...]:
    """The fundamental first."""
    return tuple(order for order, size in _sizes(surrogate).items() if size > LEAST)


def _sizes(surrogate: Surrogate) -> dict[int, float]:
    """Every order of the voltage that the drawing has and its part of the fundamental, which comes first."""
    size = np.abs(_voltage(surrogate)).max(0)
    orders = np.flatnonzero(size > ROUND_OFF * size.max())
    return {int(order): float(size[order] / size.max()) for order in orders if order >= size.argmax()}


def _voltage(surrogate: Surrogate) -> np.ndarray:
    """Orders of the voltage per speed of the phases of the machine as drawn (3, orders), but for a quarter period."""
    linkage = surrogate.spectrum(surrogate.nominal)[1:]
    return linkage * np.arange(linkage.shape[1])


# ---- what is left open -----------------------------------------------------------------------------------------------


def left_open(surrogate: Surrogate, table: Table, ask: Ask) -> dict[str, np.ndarray]:
    """Response -> shapes in the rows of a table, SI (n, L), one standard deviation of each; see above."""
    if table.kind != "back_emf":
        return {}
    reach = {name: _reach(response, table) for name, response in table.responses.items()}
    beyond = {order: size for order, size in _sizes(surrogate).items() if order > min(reach.values())}
    found = {n: _of_any_phase(surrogate, n, max(1.0, LEAST / size), table, ask) for n, size in beyond.items()}
    return {
        name: np.hstack([np.zeros((table.rows, 0)), *(shapes[name] for n, shapes in found.items() if n > surely)])
        for name, surely in reach.items()
    }


def _of_any_phase(surrogate: Surrogate, order: int, share: float, table: Table, ask: Ask) -> Responses:
    """A share of one order in phase and a quarter period behind, and where the rotor turns both ways the same with
    opposite signs (n, 2) or (n, 4)."""
    answers = [ask(surrogate.in_orders(_only(surrogate, order, turn * share)), table) for turn in (1.0, 1j)]
    sense = np.sign(table.conditions["speed"])
    ways = [sense] if np.ptp(sense) == 0 else [sense, np.ones(table.rows)]
    return {name: np.column_stack([a[name] * way for way in ways for a in answers]) for name in answers[0]}


def _reach(response: Response, table: Table) -> float:
    """Highest order that surely passes: of the bandwidth where one is declared, else of the spacing of the angles."""
    if response.bandwidth is not None:
        return NEAR * response.bandwidth * 2 * np.pi / float(np.median(np.abs(table.conditions["speed"])))
    return NEAR * half_rate(table.conditions["angle_mech"])
