"""Which static law does the damping of a shunted machine follow over the resistance of the shunt?

Every law is a ``LumpedActuator`` in a line (``static_damping``), with no free numbers or with a few, fitted to the
logarithm of the damping. A shunt of zero is a short circuit: whether of the machine's terminals or of what stands
behind its rectifier is rarely written down, so laws are fitted to the other points unless their name says otherwise.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares

from bench.errors import RecordError
from electrical.shunted_machine import Bridge, Circuit, ShortedAtTerminals, Star, seen_in_a_line
from vehicle.impedance import LumpedActuator


@dataclass(frozen=True, eq=False)
class ShuntPoints:
    """Measured slopes of force over velocity: shunt [ohm] and damping [Ns/m], each (n,), finite."""

    shunt: np.ndarray
    damping: np.ndarray

    def __post_init__(self) -> None:
        if len(self.shunt) < 2 or (self.damping <= 0).any():
            raise RecordError(
                f"shunt damping: expected two or more points with damping above zero, found {len(self.shunt)} points, "
                f"smallest damping {np.min(self.damping, initial=np.inf):g} Ns/m; correct the table."
            )

    @property
    def behind_rectifier(self) -> np.ndarray:
        """Whether a resistance was in the circuit (n,)."""
        return self.shunt > 0

    def without(self, left_out: np.ndarray) -> ShuntPoints:
        """The other points; left_out: whether a point is dropped (n,)."""
        return ShuntPoints(self.shunt[~left_out], self.damping[~left_out])


@dataclass(frozen=True)
class ShuntDevice:
    """What is stated of the damper.

    force_constant: K = sqrt(K_t K_e) / tau [N/A]; resistance: of a phase [ohm]; friction: with open terminals [Ns/m]
    low_speed_friction: slope of the same curve at low velocity, where it is steeper [Ns/m]
    constant_factor: force constant identified elsewhere over the stated one, dimensionless
    rectifier: what the rectifier is said to add to the resistance [ohm]
    """

    force_constant: float
    resistance: float
    friction: float
    low_speed_friction: float
    constant_factor: float
    rectifier: float


@dataclass(frozen=True, eq=False)
class JudgedLaw:
    """A law beside the points.

    name: of the law; fitted: values of its free numbers [unit of the name]; fitted_to: in words, empty without any
    points: what was measured; predicted: damping of the law at each [Ns/m], (n,)
    """

    name: str
    points: ShuntPoints
    predicted: np.ndarray
    fitted: dict[str, float] = field(default_factory=dict)
    fitted_to: str = ""

    @property
    def error(self) -> np.ndarray:
        """Predicted over measured damping less one, dimensionless (n,)."""
        return self.predicted / self.points.damping - 1

    def log_rms(self, chosen: np.ndarray | None = None) -> float:
        """RMS of ln(predicted / measured), dimensionless; chosen: whether a point counts (n,), all without it."""
        error = np.log(self.predicted / self.points.damping)
        return float(np.sqrt(np.mean(np.square(error if chosen is None else error[chosen]))))

    @property
    def rms_behind_rectifier(self) -> float:
        """``log_rms`` of the points that have a resistance in the circuit, dimensionless."""
        return self.log_rms(self.points.behind_rectifier)


def judged_laws(device: ShuntDevice, points: ShuntPoints) -> tuple[JudgedLaw, ...]:
    """All laws beside the points: those that follow from what is stated first, then those with fitted numbers."""
    return (*_stated(device, points), *_fitted_laws(device, points))


@dataclass(frozen=True)
class LeftOut:
    """A point predicted from the others: shunt [ohm], measured and predicted damping [Ns/m]."""

    shunt: float
    measured: float
    predicted: float

    @property
    def ratio(self) -> float:
        """Measured over predicted damping, dimensionless."""
        return self.measured / self.predicted


def each_left_out(friction: float, points: ShuntPoints) -> tuple[LeftOut, ...]:
    """Every point predicted by friction + A / (R_0 + R_shunt), A and R_0 fitted to all others; friction: [Ns/m]."""
    found = []
    for k, (shunt, damping) in enumerate(zip(points.shunt, points.damping)):
        others = points.without(np.arange(len(points.shunt)) == k)
        constant, resistance = _fitted(lambda a, r: _series(a, r, friction), (_CONSTANT, _RESISTANCE), others)
        predicted = _series(constant, resistance, friction).static_damping(shunt)
        found.append(LeftOut(float(shunt), float(damping), float(predicted)))
    return tuple(found)


# ---- laws -----------------------------------------------------------------------------------------------------------

# Where a fit begins, of the order of any such damper: A [Ns/m ohm], R [ohm], friction [Ns/m].
_CONSTANT, _RESISTANCE, _FRICTION = 700.0, 0.05, 200.0


def _law(constant: float, resistance: float, friction: float, circuit: Circuit) -> LumpedActuator:
    """constant: K^2 [Ns/m ohm]. Mass and inductance play no part in a steady slope."""
    return LumpedActuator(seen_in_a_line(constant**0.5, resistance, 1.0), circuit, 1.0, 0.0, friction)


def _series(constant: float, resistance: float, friction: float) -> LumpedActuator:
    return _law(constant, resistance, friction, Star())


def _stated(device: ShuntDevice, points: ShuntPoints) -> tuple[JudgedLaw, ...]:
    """Laws without a free number."""
    constant, resistance = device.force_constant**2, device.resistance
    smaller, half = constant * device.constant_factor**2, 0.5 * resistance
    laws = {
        "as stated, no friction": _series(constant, resistance, 0.0),
        "as stated": _series(constant, resistance, device.friction),
        "as stated, friction of low speed": _series(constant, resistance, device.low_speed_friction),
        "rectifier as a resistance": _law(constant, resistance, 0.0, Star(device.rectifier)),
        "identified force constant": _series(smaller, resistance, device.friction),
        "identified constant, half the resistance, rest in the rectifier": _law(
            smaller, half, device.friction, ShortedAtTerminals(Star(resistance - half))
        ),
    }
    return tuple(JudgedLaw(name, points, np.asarray(law.static_damping(points.shunt))) for name, law in laws.items())


@dataclass(frozen=True)
class _FreeLaw:
    """A law with free numbers. start: their names and where the fit begins; to: the points it is fitted to."""

    name: str
    start: dict[str, float]
    to: ShuntPoints
    build: Callable[..., LumpedActuator]

    @property
    def can_be_fitted(self) -> bool:
        """Whether there is a point for each free number."""
        return len(self.start) <= len(self.to.shunt)

    def judged(self, points: ShuntPoints) -> JudgedLaw:
        """The law, fitted to its own points, at these."""
        values = _fitted(self.build, tuple(self.start.values()), self.to)
        predicted = np.asarray(self.build(*values).static_damping(points.shunt))
        words = "all points" if self.to is points else "points with a resistance"
        return JudgedLaw(self.name, points, predicted, dict(zip(self.start, values)), words)


def _fitted_laws(device: ShuntDevice, points: ShuntPoints) -> tuple[JudgedLaw, ...]:
    """Laws with free numbers; those that cannot say where the short circuit was are fitted to the other points."""
    shunted, low, stated = points.without(~points.behind_rectifier), device.low_speed_friction, device.friction
    half = 0.5 * device.resistance
    constant, resistance = {"A_Ns_per_m_ohm": _CONSTANT}, {"R_ohm": _RESISTANCE}
    laws = (
        _FreeLaw("A and R fitted", constant | resistance, shunted, lambda a, r: _series(a, r, 0.0)),
        _FreeLaw("A and R fitted, friction of low speed", constant | resistance, shunted,
                 lambda a, r: _series(a, r, low)),
        _FreeLaw("six-pulse bridge, half the resistance a phase", constant | {"diode_ohm": 1e-3}, shunted,
                 lambda a, diode: _law(a, half, stated, ShortedAtTerminals(Bridge(0.0, diode)))),
        _FreeLaw("A, R and friction fitted, short circuit too",
                 constant | resistance | {"friction_Ns_per_m": _FRICTION}, points, _series),
        _FreeLaw("A, R and rectifier fitted, short circuit of the terminals too",
                 constant | resistance | {"rectifier_ohm": _RESISTANCE}, points,
                 lambda a, r, behind: _law(a, r, stated, ShortedAtTerminals(Star(behind)))),
    )  # fmt: skip
    return tuple(law.judged(points) for law in laws if law.can_be_fitted)


def _fitted(build: Callable[..., LumpedActuator], start: tuple[float, ...], points: ShuntPoints) -> tuple[float, ...]:
    """Least squares of the logarithm; the free numbers are above zero, so their logarithms are what is free."""

    def missing(logarithms: np.ndarray) -> np.ndarray:
        """Logarithms of predicted over measured damping, dimensionless, (points,)."""
        return np.log(build(*np.exp(logarithms)).static_damping(points.shunt) / points.damping)

    return tuple(np.exp(least_squares(missing, np.log(start), xtol=1e-12, ftol=1e-12).x).tolist())
