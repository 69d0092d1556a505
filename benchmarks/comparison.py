"""Agreement and cost of the codes on identical meshes, as rows of tables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from statistics import median

import numpy as np

from benchmarks.airgap_run import COLD, PREPARED, solve_cold, solve_prepared
from benchmarks.getdp_run import AS_INSTALLED, FASTEST, solve_getdp
from benchmarks.ngsolve_run import solve_ngsolve
from benchmarks.reference_case import FieldCase
from benchmarks.result import CodeResult
from benchmarks.weak_form_run import SCIKIT_FEM, solve_weak_form

EXACT = 1e-9  # relative residual at which codes are compared
USUAL = 1e-4  # relative residual at which they are timed, the solver's default
MANY_POINTS = 7  # of the quadrature in a triangle, where three are the rule

# What a code is timed over, by its name in the tables.
TIMED = {
    COLD: "from the mesh in memory to torque and flux linkage, nothing prepared",
    PREPARED: "the same with numbering and pattern there, from zero field",
    SCIKIT_FEM: "the weak form of this project, from the mesh in memory to torque and flux linkage, nothing prepared",
    "NGSolve": "Newton's method alone, mesh, space and forms there",
    FASTEST.name: "whole process, quickest linear solver",
    AS_INSTALLED.name: "whole process, linear solver as installed",
}


@dataclass(frozen=True)
class Agreement:
    """A peer's solution of a case against this project's, both converged; differences are relative.

    flux_difference: largest of the three phases over the largest flux linkage; potential_difference: likewise at nodes
    fine_torque_difference: the peer with MANY_POINTS in a triangle instead of three
    """

    extent: str
    order: str
    state: str
    code: str
    torque: float
    airgap_torque: float
    torque_difference: float
    flux_difference: float
    potential_difference: float
    fine_torque_difference: float


@dataclass(frozen=True)
class Timing:
    """CPU and wall times [s] of one code on one case, one entry a round."""

    extent: str
    order: str
    state: str
    code: str
    unknowns: int
    iterations: int
    torque: float  # at the usual residual [Nm/m]
    cpu: tuple[float, ...]
    wall: tuple[float, ...]

    @property
    def cpu_median(self) -> float:
        return median(self.cpu)

    @property
    def wall_median(self) -> float:
        return median(self.wall)


def compare(case: FieldCase) -> list[Agreement]:
    """This project's converged solution against those of its weak form in scikit-fem, of GetDP and of NGSolve."""
    ours = solve_cold(case, EXACT)
    getdp = solve_getdp(case, EXACT, with_potential=True), solve_getdp(case, EXACT, points=MANY_POINTS)
    ngsolve = solve_ngsolve(case, EXACT), solve_ngsolve(case, EXACT, points=MANY_POINTS)
    scikit_fem = solve_weak_form(case, EXACT), solve_weak_form(case, EXACT, points=MANY_POINTS)
    return [_agreement(case, ours, *peer) for peer in (scikit_fem, getdp, ngsolve)]


def _agreement(case: FieldCase, ours: CodeResult, peer: CodeResult, fine: CodeResult) -> Agreement:
    return Agreement(
        case.extent,
        case.order_name,
        case.state.name,
        peer.code.split(",")[0],
        peer.torque,
        ours.torque,
        relative(ours.torque, peer.torque),
        relative(ours.flux_linkage, peer.flux_linkage),
        relative(ours.potential, peer.potential),
        relative(ours.torque, fine.torque),
    )


def relative(ours, peers) -> float:
    """Largest difference over the largest value of the peer."""
    return float(np.max(np.abs(np.subtract(ours, peers))) / np.max(np.abs(peers)))


def time_codes(case: FieldCase, rounds: int) -> list[Timing]:
    """Every code once a round, so that other load on the machine meets all of them alike."""
    codes: tuple[Callable[[], CodeResult], ...] = (
        lambda: _second_of(lambda: solve_cold(case, USUAL)),
        lambda: solve_prepared(case, USUAL),
        lambda: _second_of(lambda: solve_weak_form(case, USUAL)),
        lambda: solve_ngsolve(case, USUAL),
        lambda: solve_getdp(case, USUAL, FASTEST),
        lambda: solve_getdp(case, USUAL, AS_INSTALLED),
    )
    results = [[code() for code in codes] for _ in range(rounds)]
    unknowns = int(results[0][0].others["unknowns"])
    return [_timing(case, unknowns, column) for column in zip(*results)]


def _second_of(solve: Callable[[], CodeResult]) -> CodeResult:
    """The first one finds the processor's caches filled by another program."""
    solve()
    return solve()


def _timing(case: FieldCase, unknowns: int, results: tuple[CodeResult, ...]) -> Timing:
    costs = [result.cost for result in results]
    return Timing(
        case.extent,
        case.order_name,
        case.state.name,
        results[0].code,
        unknowns,
        results[0].iterations,
        results[0].torque,
        tuple(cost.cpu for cost in costs),
        tuple(cost.wall for cost in costs),
    )


def ratio(timings: list[Timing], code: str, other: str, extent: str, order: str) -> float:
    """Median CPU time of another code over that of a code, on the same case."""
    found = {t.code: t.cpu_median for t in timings if (t.extent, t.order) == (extent, order)}
    return found[other] / found[code]
