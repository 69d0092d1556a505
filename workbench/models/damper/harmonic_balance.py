"""Periodic answer of a damper to a sine at its driving point: harmonic balance with the laws evaluated over time.

Every row is a sine x_d = A sin(theta), v_d = omega A cos(theta). A rigid mount without inductance needs no solution:
the laws are evaluated along the known motion. Otherwise the coefficients of odd harmonics of mass velocity and current
are found by Newton's method (alternating frequency and time, Cameron and Griffin 1989), all rows at once.

Validity: half-wave symmetric motion (odd harmonics); even ones and a standing offset are left out of the unknowns.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isinf

import numpy as np

from effects.damper_design import Damper
from workbench.errors import WorkbenchError
from workbench.models.damper.steady_circuit import circuit_current, coupling_factor, voltage_left

STEPS = 64  # of a period; the fundamental of a square wave is right to 4e-4
HARMONICS = np.array([1, 3, 5, 7])
MOST_ITERATIONS = 40
CLOSE = 1e-7  # residual force and current, of their scale, at which the balance holds
ENOUGH = 0.7  # share of the residual that a step at such a corner still leaves; then it is not worth another
ACCEPTABLE = 2e-3  # the same where Newton stalls at a corner of a law; of the order of the truncated harmonics


@dataclass(frozen=True, eq=False)
class Drive:
    """Sines at the driving point: frequency [Hz], amplitude [m] and shunt [ohm], each (n,).

    viscous_factor: viscous damping in each row over that of the design [1]
    """

    frequency: np.ndarray
    amplitude: np.ndarray
    shunt: np.ndarray
    viscous_factor: np.ndarray | float = 1.0

    @property
    def omega(self) -> np.ndarray:
        """Angular frequency [rad/s], a column (n, 1)."""
        return (2 * np.pi * self.frequency)[:, None]

    @property
    def top_velocity(self) -> np.ndarray:
        """omega A [m/s], a column (n, 1)."""
        return self.omega * self.amplitude[:, None]

    def columns(self) -> np.ndarray:
        """Its fields as rows of one array (fields, n)."""
        rows = (self.frequency, self.amplitude, self.shunt, self.viscous_factor)
        return np.stack(np.broadcast_arrays(*rows))

    def viscous(self, design: Damper) -> np.ndarray:
        """c [N s/m], a column (n, 1)."""
        return (design.viscous_damping * np.broadcast_to(self.viscous_factor, self.frequency.shape))[:, None]


def fundamental(design: Damper, drive: Drive) -> np.ndarray:
    """Fundamental of the driving force over that of the velocity [N s/m], complex (n,)."""
    theta = _angles(STEPS)
    force = force_over_a_period(design, drive, STEPS)
    return 2.0 / STEPS * (force @ np.exp(-1j * theta)) / drive.top_velocity[:, 0]


def force_over_a_period(design: Damper, drive: Drive, steps: int) -> np.ndarray:
    """Driving force at ``steps`` equal steps of the period, the first half a step after theta = 0 [N], (n, steps)."""
    if isinf(design.mount_stiffness) and not design.inductance:
        return _imposed_motion(design, drive, steps)
    balance = _Balance(design, drive, steps)
    return balance.driving_force(balance.solved())


def _angles(steps: int) -> np.ndarray:
    return 2 * np.pi * (np.arange(steps) + 0.5) / steps


def _imposed_motion(design: Damper, drive: Drive, steps: int) -> np.ndarray:
    theta, omega, top = _angles(steps), drive.omega, drive.top_velocity
    position, velocity = top / omega * np.sin(theta), top * np.cos(theta)
    current = circuit_current(design, position, velocity, drive.shunt[:, None])
    inertia = -design.moving_mass * omega * top * np.sin(theta)
    return inertia + drive.viscous(design) * velocity + _force_of_laws(design, position, velocity, current)


def _force_of_laws(design: Damper, position: np.ndarray, velocity: np.ndarray, current: np.ndarray) -> np.ndarray:
    """Force laws + K g i [N]."""
    force = design.force_constant * coupling_factor(design, position, current) * current
    for law in design.forces:
        force = force + law.force(position, velocity)
    return force


class _Balance:
    """Unknowns q: cosine and sine coefficients of the mass velocity, if the mount gives, then of the current, if L > 0.

    A signal over time is T q + s0 with T (n, steps, unknowns). The two equations, projected on the harmonics:
        m dv/dt + F(x, v, i) - F_mount(x_d - x, v_d - v) = 0
        i - left(K g v - L di/dt) / (R + R_shunt) = 0
    """

    def __init__(self, design: Damper, drive: Drive, steps: int):
        self.design, self.drive, self.steps = design, drive, steps
        theta, k = _angles(steps), HARMONICS
        self.cosines, self.sines = np.cos(np.outer(theta, k)), np.sin(np.outer(theta, k))
        self.basis = np.hstack([self.cosines, self.sines])
        self.project = 2.0 / steps * self.basis.T
        self.gives, self.inductive = not isinf(design.mount_stiffness), design.inductance > 0
        self.x_d = drive.amplitude[:, None] * np.sin(theta)
        self.v_d = drive.top_velocity * np.cos(theta)
        self.resistance = design.internal_resistance + drive.shunt[:, None]
        self.viscous = drive.viscous(design)
        self._lay_out()

    def _lay_out(self) -> None:
        """T of position, velocity, acceleration, current and its rate; zero where the signal is not unknown."""
        n, size = len(self.drive.frequency), 2 * len(HARMONICS)
        count = size * (self.gives + self.inductive)
        omega, k = self.drive.omega[:, :, None], HARMONICS
        rate = omega * np.hstack([-k * self.sines, k * self.cosines])
        integral = np.hstack([self.sines / k, -self.cosines / k]) / omega
        self.T = {name: np.zeros((n, self.steps, count)) for name in ("x", "v", "a", "i", "di")}
        if self.gives:
            motion = slice(0, size)
            self.T["x"][:, :, motion], self.T["v"][:, :, motion] = integral, self.basis
            self.T["a"][:, :, motion] = rate
        if self.inductive:
            circuit = slice(count - size, count)
            self.T["i"][:, :, circuit], self.T["di"][:, :, circuit] = self.basis, rate

    def solved(self) -> np.ndarray:
        """Coefficients of the periodic answer (n, unknowns); raises WorkbenchError where there is none to be found."""
        q = self._linear_answer()
        residual, jacobian = self._residual(q), None
        norm = self._norm(residual)
        for _ in range(MOST_ITERATIONS):
            if norm.max() < CLOSE:
                return q
            jacobian = self._jacobian(q)
            change = -np.linalg.solve(jacobian, residual[:, :, None])[:, :, 0]
            before = norm.max()
            q, residual, norm, moved = self._line_search(q, change, norm, residual)
            if not moved or ENOUGH * before < norm.max() < ACCEPTABLE:
                break
        if norm.max() > ACCEPTABLE:
            worst = int(np.argmax(norm))
            raise WorkbenchError(
                f"no periodic motion found at {self.drive.frequency[worst]:g} Hz, "
                f"{self.drive.amplitude[worst]:g} m, shunt {self.drive.shunt[worst]:g} ohm: check the effects' sizes"
            )
        return q

    def _line_search(self, q, change, norm, residual):
        """The longest of the steps 1, 1/2, 1/4 ... that lowers the residual, each row for itself."""
        moved = False
        length = np.ones((len(q), 1))
        open_rows = np.ones(len(q), bool)
        best_q, best_residual, best_norm = q, residual, norm
        for _ in range(7):
            trial = q + length * change
            trial_residual = self._residual(trial)
            trial_norm = self._norm(trial_residual)
            better = open_rows & (trial_norm < (1 - 1e-3) * norm)
            best_q = np.where(better[:, None], trial, best_q)
            best_residual = np.where(better[:, None], trial_residual, best_residual)
            best_norm = np.where(better, trial_norm, best_norm)
            open_rows &= ~better & (norm > CLOSE)
            moved |= bool(better.any())
            if not open_rows.any():
                break
            length = np.where(open_rows[:, None], 0.5 * length, length)
        return best_q, best_residual, best_norm, moved

    def driving_force(self, q: np.ndarray) -> np.ndarray:
        """Force at the driving point over time [N], (n, steps)."""
        s = self._signals(q)
        if self.gives:
            return self._mount(s["x"], s["v"])
        return self._on_mass(**{name: s[name] for name in ("x", "v", "a", "i")})

    def _linear_answer(self) -> np.ndarray:
        """Answer of the constants alone: mass velocity and current of eq. B.4."""
        d, s = self.design, 1j * self.drive.omega[:, 0]
        circuit = self.resistance[:, 0] + s * d.inductance
        inner = s * d.moving_mass + self.viscous[:, 0] + d.force_constant**2 / circuit
        mount = d.mount_damping + d.mount_stiffness / s if self.gives else 1.0
        v = self.drive.top_velocity[:, 0] * (mount / (mount + inner) if self.gives else 1.0)
        phasors = [v] * self.gives + [d.force_constant * v / circuit] * self.inductive
        return np.hstack([self._coefficients(p) for p in phasors])

    def _coefficients(self, phasor: np.ndarray) -> np.ndarray:
        q = np.zeros((len(phasor), 2 * len(HARMONICS)))
        q[:, 0], q[:, len(HARMONICS)] = phasor.real, -phasor.imag
        return q

    def _signals(self, q: np.ndarray) -> dict[str, np.ndarray]:
        s = {name: np.matmul(T, q[:, :, None])[:, :, 0] for name, T in self.T.items()}
        if not self.gives:
            s["x"], s["v"] = self.x_d, self.v_d
            s["a"] = -(self.drive.omega**2) * self.x_d
        if not self.inductive:
            s["i"] = circuit_current(self.design, s["x"], s["v"], self.drive.shunt[:, None])
        return s

    def _mount(self, x, v):
        return self.design.mount_stiffness * (self.x_d - x) + self.design.mount_damping * (self.v_d - v)

    def _force_error(self, x, v, a, i):
        return self._on_mass(x, v, a, i) - self._mount(x, v)

    def _on_mass(self, x, v, a, i):
        return self.design.moving_mass * a + self.viscous * v + _force_of_laws(self.design, x, v, i)

    def _current_error(self, x, v, i, di):
        d = self.design
        emf = d.force_constant * coupling_factor(d, x, i) * v
        return i - voltage_left(d, emf - d.inductance * di, self.resistance) / self.resistance

    def _errors(self, s: dict[str, np.ndarray]) -> list[np.ndarray]:
        force = [self._force_error(s["x"], s["v"], s["a"], s["i"])] if self.gives else []
        current = [self._current_error(s["x"], s["v"], s["i"], s["di"])] if self.inductive else []
        return [error / scale for error, scale in zip(force + current, self._scales())]

    def _scales(self) -> list[np.ndarray]:
        """A force and a current of each row, to judge residuals by."""
        d, top = self.design, self.drive.top_velocity
        current = d.force_constant * top / self.resistance
        force = d.force_constant * current + (self.viscous + self.drive.omega * d.moving_mass) * top
        return [force] * self.gives + [current] * self.inductive

    def _residual(self, q: np.ndarray) -> np.ndarray:
        return np.hstack([error @ self.project.T for error in self._errors(self._signals(q))])

    def _norm(self, residual: np.ndarray) -> np.ndarray:
        return np.sqrt((residual**2).sum(axis=1))

    def _jacobian(self, q: np.ndarray) -> np.ndarray:
        """d residual / d q, from the slopes of the laws at every instant."""
        s = self._signals(q)
        here = self._errors(s)
        rows = [np.zeros(q.shape + (self.project.shape[0],)) for _ in here]
        for name, T in self.T.items():
            if not T.any():
                continue
            size = np.abs(s[name]).max(axis=1, keepdims=True)
            step = 1e-6 * size + 1e-15
            moved = dict(s, **{name: s[name] + step})
            if not self.inductive and name in ("x", "v"):
                moved["i"] = circuit_current(self.design, moved["x"], moved["v"], self.drive.shunt[:, None])
            for k, there in enumerate(self._errors(moved)):
                slope = (there - here[k]) / step
                rows[k] += np.matmul((slope[:, :, None] * T).transpose(0, 2, 1), self.project.T)
        return np.concatenate([row.transpose(0, 2, 1) for row in rows], axis=1)
