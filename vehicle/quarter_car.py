"""The linear quarter car with an active suspension (thesis eqs 4.6-4.27): state space and control laws.

State x = [z_s - z_u, z_u, z_s', z_u'] (4.19), from static equilibrium; the force of the actuator is F_act = row x and
the suspension pulls the body down with k_s (z_s - z_u) + F_act.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import solve_continuous_are

from units import GRAVITY
from vehicle.comfort import WEIGHTING
from vehicle.commands import Feedback
from vehicle.errors import require_not_negative, require_positive
from vehicle.models import QuarterCar

# From heights and rates z = [z_s, z_u, z_s', z_u'] (the thesis prints z_s twice in 4.8) to x (4.19).
TO_STROKE_STATES = np.array([[1.0, -1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def state_space(car: QuarterCar) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A, B, C, D of z' = A z + B [z_r, F_s], y = C z + D [z_r, F_s] (4.8-4.13).

    state_space: [SI], (4, 4), (4, 2), (7, 4) and (7, 2), with z = [z_s, z_u, z_s', z_u']
    y = [z_s, z_u, z_s', z_u', z_s'', z_u - z_r, z_s - z_u]; F_s = -k_s (z_s - z_u) - F_act (4.6).
    """
    wheel = car.tyre_stiffness / car.unsprung_mass
    a, b, c, d = np.zeros((4, 4)), np.zeros((4, 2)), np.zeros((7, 4)), np.zeros((7, 2))
    a[0, 2] = a[1, 3] = 1.0
    a[3, 1], b[3, 0] = -wheel, wheel
    b[2, 1], b[3, 1] = 1 / car.sprung_mass, -1 / car.unsprung_mass
    c[:4] = np.eye(4)
    c[5, 1] = 1.0
    c[6, :2] = 1.0, -1.0
    d[4, 1], d[5, 0] = 1 / car.sprung_mass, -1.0
    return a, b, c, d


def damping_feedback(damping: float) -> Feedback:
    """F_act = c (z_s' - z_u'); damping: c [Ns/m]."""
    return skyhook(damping, 0.0)


def skyhook(damping: float, skyhook_damping: float) -> Feedback:
    """F_act = c_SH z_s' + c (z_s' - z_u') (4.14); damping: c [Ns/m], skyhook_damping: c_SH [Ns/m]."""
    require_not_negative("skyhook", damping=damping, skyhook_damping=skyhook_damping)
    return Feedback((0.0, 0.0, damping + skyhook_damping, -damping))


def groundhook(damping: float, groundhook_damping: float) -> Feedback:
    """F_act = -c_GH z_u' + c (z_s' - z_u') (4.16); damping: c [Ns/m], groundhook_damping: c_GH [Ns/m]."""
    require_not_negative("groundhook", damping=damping, groundhook_damping=groundhook_damping)
    return Feedback((0.0, 0.0, damping, -damping - groundhook_damping))


def spring_negation(damping: float, stiffness: float) -> Feedback:
    """F_act = -k_SN (z_s - z_u) + c (z_s' - z_u') (4.18); damping: c [Ns/m], stiffness: k_SN [N/m]."""
    require_not_negative("spring negation", damping=damping, stiffness=stiffness)
    return Feedback((-stiffness, 0.0, damping, -damping))


@dataclass(frozen=True)
class LqrWeights:
    """Weights in Q = diag(r_s, r_h, 0, 0) (4.24).

    stroke: r_s, of the squared stroke [kg/s^4]; wheel: r_h, of the squared wheel height [kg/s^4]
    """

    stroke: float
    wheel: float

    def __post_init__(self) -> None:
        require_positive("LQR weights", stroke=self.stroke, wheel=self.wheel)


def lqr_gain(car: QuarterCar, weights: LqrWeights) -> np.ndarray:
    """K of F_s = -K x that minimises the integral of x'Q x + R F_s^2 (4.22-4.24).

    lqr_gain: [N/m, N/m, Ns/m, Ns/m], (4,)

    R = 1 / m_s as printed in 4.24; the gains of eqs 4.25-4.27 follow from it, not from the square that the text to
    4.24 describes.
    """
    a, b, q, r = lqr_problem(car, weights)
    return (b.T @ solve_continuous_are(a, b, q, r) / r)[0]


def lqr_problem(car: QuarterCar, weights: LqrWeights) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """A_x, B_x, Q, R of the Riccati equation (4.20-4.24): [SI], (4, 4), (4, 1), (4, 4) and (1, 1)."""
    a, b, _, _ = state_space(car)
    a_x = TO_STROKE_STATES @ a @ np.linalg.inv(TO_STROKE_STATES)
    b_x = TO_STROKE_STATES @ b[:, 1:]
    return a_x, b_x, np.diag([weights.stroke, weights.wheel, 0.0, 0.0]), np.array([[1 / car.sprung_mass]])


def lqr(car: QuarterCar, weights: LqrWeights) -> Feedback:
    """The optimal law as an actuator force: F_act = K x - k_s (z_s - z_u), from 4.6 and 4.23."""
    stroke, *others = lqr_gain(car, weights).tolist()
    return Feedback((stroke - car.spring_stiffness, *others))


def printed_form(feedback: Feedback) -> dict[str, float]:
    """The four coefficients with which the thesis writes a law, a1, a2 [N/m], a3, a5 [Ns/m].

    F_act = -a1 (z_s - z_u) - a2 z_u + a3 (z_s' - z_u') + a5 z_s'. Eq. 4.25 prints -a4 z_u' where the numbers are
    those of +a4 z_s', so its a4 is a5 here; eq. 4.26 has a3 and a5 exchanged; eqs 4.26 and 4.27 leave a2 out.
    """
    stroke, wheel, body_rate, wheel_rate = (float(value) for value in feedback.row)
    return {"a1": -stroke, "a2": -wheel, "a3": -wheel_rate, "a5": body_rate + wheel_rate}


@dataclass(frozen=True)
class LinearRide:
    """Closed loop on a random road with comfort filter: s' = A s + B w, w white with a density of 0.5 /Hz two-sided.

    s: the four states x, the road height z_r and three states of the comfort filter, (8,)
    a: A [SI], (8, 8); b: B [SI], (8,)
    Outputs are rows (8,) times s: comfort [m/s^2], (8,), road_holding (dimensionless, 4.10), (8,), stroke [m], (8,),
    force [N], (8,), velocity [m/s], (8,)
    """

    a: np.ndarray
    b: np.ndarray
    comfort: np.ndarray
    road_holding: np.ndarray
    stroke: np.ndarray
    force: np.ndarray
    velocity: np.ndarray


def linear_ride(car: QuarterCar, feedback: Feedback, *, cutoff: float, noise_gain: float) -> LinearRide:
    """The quarter car under a control law on the road dz_r/dt = -cutoff z_r + noise_gain w.

    cutoff [rad/s] and noise_gain as ``IsoRoad.cutoff`` and ``IsoRoad.noise_gain`` give them
    The road-holding index divides by g (m_s + m_u), the static load; eq. 4.10 prints a minus.
    """
    a, b = np.zeros((8, 8)), np.zeros(8)
    force = np.array([*feedback.row, 0, 0, 0, 0])
    suspension = force + car.spring_stiffness * _unit(0)
    tyre = car.tyre_stiffness * (_unit(1) - _unit(4))
    a[0], a[1] = _unit(2) - _unit(3), _unit(3)
    a[2] = -suspension / car.sprung_mass
    a[3] = (suspension - tyre) / car.unsprung_mass
    a[4, 4], b[4] = -cutoff, noise_gain
    numerator, denominator = WEIGHTING
    a[5] = a[2]  # the filter in controllable form, fed with the body's acceleration
    a[5, 5:] = -np.array(denominator[1:])
    a[6, 5] = a[7, 6] = 1.0
    comfort = np.array([0.0] * 5 + list(numerator))
    load = (car.sprung_mass + car.unsprung_mass) * GRAVITY
    return LinearRide(a, b, comfort, tyre / load, _unit(0), force, _unit(2) - _unit(3))


def _unit(k: int) -> np.ndarray:
    row = np.zeros(8)
    row[k] = 1.0
    return row
