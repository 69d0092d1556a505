"""Parameters of a model from records: nonlinear least squares on gains (thesis eqs 4.28, 4.29), and how sure they are.

    min_x sum_k sum_i ((measured_ki - model_ki(p)) / sigma_k)^2,   p_j = p_nominal,j exp(x_j)

The logarithm of the gain is what is free: parameters stay above zero, and an interval is one of relative size. The
covariance is that of the linearised fit,

    C = s^2 (J^T J)^-1,   s^2 = g sum r^2 / (n - m),   g = 1 + 2 sum of the autocorrelation of r (first positive run)

g widens it where residuals follow each other, as they do when the model is not quite right (standard textbook formulas:
Seber and Wild, Nonlinear Regression, ch. 2 and 6). It says nothing about an error that is the same in all records.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import exp

import numpy as np
from scipy.optimize import least_squares
from scipy.special import ndtri

from bench.errors import RecordError
from bench.memory import memory_of

Model = Callable[[Mapping[str, float]], Sequence[np.ndarray]]  # values by name -> answer to every record

NINETY = float(ndtri(0.95))  # standard deviations of a 90 % interval
NOT_IDENTIFIED = 0.5  # relative standard deviation beyond which the records do not say a parameter's size
_STEP = 1e-4  # of a logarithm, for derivatives: between the rounding of an integrator and the curvature of the model
_AT_BOUND = 1e-3  # distance of a logarithm from its bound
_LARGEST_GAIN = 50.0


@dataclass(frozen=True)
class Unknown:
    """A parameter to be found.

    name: with its unit at the end as the tables show it; nominal: where the search begins [SI]
    smallest, largest: bounds of the gain, dimensionless
    """

    name: str
    nominal: float
    smallest: float = 1 / _LARGEST_GAIN
    largest: float = _LARGEST_GAIN

    def __post_init__(self) -> None:
        if not (self.nominal > 0 and 0 < self.smallest < 1 < self.largest):
            raise RecordError(
                f"{self.name}: expected a nominal value above zero and bounds of the gain on both sides of 1, found "
                f"{self.nominal:g}, {self.smallest:g} and {self.largest:g}; state them so."
            )


@dataclass(frozen=True)
class Found:
    """An identified parameter.

    unknown: what was looked for; value: found [SI]; deviation: relative standard deviation
    at_bound: whether the search ended at a bound of the gain
    """

    unknown: Unknown
    value: float
    deviation: float
    at_bound: bool

    @property
    def gain(self) -> float:
        """Value over nominal value, dimensionless (thesis 4.29)."""
        return self.value / self.unknown.nominal

    @property
    def interval(self) -> tuple[float, float]:
        """90 % interval [SI]."""
        factor = exp(NINETY * self.deviation)
        return self.value / factor, self.value * factor

    @property
    def is_identified(self) -> bool:
        """Whether the records say its size."""
        return not self.at_bound and self.deviation < NOT_IDENTIFIED


@dataclass(frozen=True, eq=False)
class Identification:
    """What a fit has found.

    found: the parameters; correlation: of their logarithms, dimensionless (m, m)
    answers: of the identified model to every record [SI], (n_k,); residuals: measured less answer [SI], (n_k,)
    memory: g, by how much the residuals' memory widens the squares of the deviations, dimensionless
    evaluations: number of runs of the model
    """

    found: tuple[Found, ...]
    correlation: np.ndarray
    answers: tuple[np.ndarray, ...]
    residuals: tuple[np.ndarray, ...]
    memory: float
    evaluations: int

    @property
    def values(self) -> dict[str, float]:
        """Identified values by name [SI]."""
        return {one.unknown.name: one.value for one in self.found}

    @property
    def weakest(self) -> tuple[float, dict[str, float]]:
        """The combination of logarithms that the records say least about: its standard deviation and its parts,
        dimensionless."""
        deviations = np.array([one.deviation for one in self.found])
        sizes, directions = np.linalg.eigh(self.correlation * np.outer(deviations, deviations))
        parts = directions[:, -1] * np.sign(directions[np.argmax(np.abs(directions[:, -1])), -1])
        return float(np.sqrt(sizes[-1])), dict(zip((one.unknown.name for one in self.found), parts.tolist()))


def identify(
    model: Model, unknowns: Sequence[Unknown], measured: Sequence[np.ndarray], noise: Sequence[float]
) -> Identification:
    """Fit a model to records.

    model: answers every record for values by name; measured: readings of every record [SI], each (n_k,)
    noise: standard deviation of a reading of each record [SI]; only their ratios weigh
    Raises:
        RecordError: fewer readings than unknowns, or the readings do not depend on one of them.
    """
    readings = sum(len(one) for one in measured)
    if readings <= len(unknowns):
        raise RecordError(
            f"identification: expected more readings than the {len(unknowns)} unknowns, found {readings}; record "
            "longer or state some of them."
        )
    weights = np.concatenate([np.full(len(one), 1 / sigma) for one, sigma in zip(measured, noise, strict=True)])
    target = np.concatenate(list(measured))

    def missing(logarithms: np.ndarray) -> np.ndarray:
        """Weighted residuals of all records at these logarithms of the unknowns, dimensionless, (readings,)."""
        return (target - np.concatenate(list(model(_values(unknowns, logarithms))))) * weights

    bounds = np.log([[u.smallest for u in unknowns], [u.largest for u in unknowns]])
    solved = least_squares(
        missing, np.zeros(len(unknowns)), bounds=bounds, x_scale="jac", diff_step=_STEP, xtol=1e-7, ftol=1e-9
    )
    covariance, memory = _covariance(solved.jac, solved.fun, [len(one) for one in measured], unknowns)
    deviations = np.sqrt(np.diag(covariance))
    at_bound = np.min(np.abs(solved.x - bounds), axis=0) < _AT_BOUND
    values = _values(unknowns, solved.x)
    answers = tuple(np.asarray(one) for one in model(values))
    return Identification(
        tuple(Found(u, values[u.name], float(s), bool(b)) for u, s, b in zip(unknowns, deviations, at_bound)),
        covariance / np.outer(deviations, deviations),
        answers,
        tuple(m - a for m, a in zip(measured, answers)),
        memory,
        int(solved.nfev + solved.njev * len(unknowns)),
    )


def _values(unknowns: Sequence[Unknown], logarithms: np.ndarray) -> dict[str, float]:
    return {u.name: u.nominal * float(np.exp(x)) for u, x in zip(unknowns, logarithms)}


def _covariance(
    jacobian: np.ndarray, residual: np.ndarray, lengths: Sequence[int], unknowns: Sequence[Unknown]
) -> tuple[np.ndarray, float]:
    """Covariance of the logarithms, and g."""
    sizes = np.linalg.norm(jacobian, axis=0)
    if not sizes.all():
        silent = unknowns[int(np.argmin(sizes))].name
        raise RecordError(f"identification: no reading depends on {silent}; state it or record what shows it.")
    scaled = jacobian / sizes
    memory = float(np.mean([memory_of(one) for one in np.split(residual, np.cumsum(lengths)[:-1])]))
    variance = memory * float(residual @ residual) / (len(residual) - len(unknowns))
    return variance * np.linalg.pinv(scaled.T @ scaled, hermitian=True) / np.outer(sizes, sizes), memory
