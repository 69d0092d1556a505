"""The shorted machine of a study followed over time: ``python -m benchmarks.braking_in_time [STUDY]``.

The stage ``braking`` solves the steady state of the map's mean over the rotor angle. Here the machine is followed over
time on the map of every rotor angle, harmonics in, with the torque of the field (the ring average) in the place of
1.5 p (psi_d i_q - psi_q i_d):

    d psi(angle, i) / dt = -R i + omega J psi

Needs the study's results (``make braking``). Writes results/reference/benchmarks/braking_in_time.csv: speed of the
output, damping by both [Ns/m or Nms/rad] and their relative difference.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from scipy.integrate import solve_ivp
from scipy.interpolate import NdBSpline, make_interp_spline

from electrical.braking import short_circuit
from electrical.flux_map_machine import FluxMapMachine
from electrical.wound_machine import WoundMachine
from magnetostatics.flux_map_stage import FluxMap
from pipeline.modules import PROJECT
from pipeline.results import Results

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "braking_in_time.csv"
SPEEDS = np.geomspace(0.005, 2.0, 9)  # of the output [m/s or rad/s]
SETTLED = 8.0  # time constants L/R, after which the mean is taken
SECTOR = np.pi / 3  # electrical, over which the machine repeats itself
SAMPLES = 200  # of the mean over one sector


@dataclass(frozen=True, eq=False)
class TurningMachine:
    """A wound machine over rotor angle and currents, by the map of its cross-section per turn and metre."""

    wound: WoundMachine
    map: FluxMap

    def rate(self, omega: float):
        """di/dt over the time at electrical speed omega [rad/s], phases shorted."""
        turn = np.array([[0.0, 1.0], [-1.0, 0.0]])

        def of(time: float, i: np.ndarray) -> np.ndarray:
            angle = omega * time
            by_angle = omega * self._psi(angle, i, along=0)
            volts = -self.wound.phase_resistance * i + omega * turn @ self._psi(angle, i) - by_angle
            return np.linalg.solve(np.stack([self._psi(angle, i, along=k) for k in (1, 2)], axis=1), volts)

        return of

    def torque(self, angle: float, i: np.ndarray) -> float:
        """Of the field [Nm]."""
        return self.wound.active_length * float(self._at(angle, i, (0, 0))[0] @ self._harmonics(angle)[0])

    def _psi(self, angle: float, i: np.ndarray, along: int | None = None) -> np.ndarray:
        """(psi_d, psi_q) [Wb], or their slope by angle (0) [Wb/rad], i_d (1) or i_q (2) [H]."""
        order = (int(along == 1), int(along == 2))
        scale = self.wound.equivalent_turns ** (1 + sum(order)) * self.wound.active_length
        return scale * self._at(angle, i, order)[1:] @ self._harmonics(angle)[int(along == 0)]

    def _at(self, angle: float, i: np.ndarray, order: tuple[int, int]) -> np.ndarray:
        """Fourier coefficients over the angle of torque, psi_d and psi_q (3, angles), per turn and metre."""
        found = self._spline(i * self.wound.equivalent_turns, nu=order)
        return found.reshape(3, -1)

    def _harmonics(self, angle: float) -> tuple[np.ndarray, np.ndarray]:
        """Trigonometric basis at an electrical angle (angles,), and its slope [1/rad]."""
        count = len(self.map.data["angle"])
        order = np.arange(1, (count - 1) // 2 + 1) * 2 * np.pi / SECTOR
        start = float(self.map.data["angle"][0]) * self.map.pole_pairs
        phase = order * (angle - start)
        value = np.concatenate([[1.0], np.cos(phase), np.sin(phase)])
        slope = np.concatenate([[0.0], -order * np.sin(phase), order * np.cos(phase)])
        return value, slope

    @cached_property
    def _spline(self) -> NdBSpline:
        """Of those coefficients over i_d and i_q of one turn, cubic."""
        data = self.map.data[["torque", "psi_d", "psi_q"]].transpose("id", "iq", "angle")
        values = np.stack([one.values for one in data.values()], axis=2)
        along_d = make_interp_spline(data["id"].values, _coefficients(values), axis=0)
        along_q = make_interp_spline(data["iq"].values, along_d.c, axis=1)
        return NdBSpline((along_d.t, along_q.t), np.swapaxes(along_q.c, 0, 1), 3)  # whose own axis comes first


def _coefficients(values: np.ndarray) -> np.ndarray:
    """Fourier coefficients of samples over one sector, along the last axis: mean, cosines, sines (..., angles)."""
    count = values.shape[-1]
    found = np.fft.rfft(values, axis=-1) / count
    inner = slice(1, (count - 1) // 2 + 1)
    parts = found[..., :1].real, 2 * found[..., inner].real, -2 * found[..., inner].imag
    return np.concatenate(parts, axis=-1).reshape(*values.shape[:2], -1)


def damping_over_time(machine: TurningMachine, mean: FluxMapMachine, speed: float) -> float:
    """T / omega of the shaft once it is settled [Nms/rad]; speed: of the rotor [rad/s]. It begins at the mean's state,
    from which the harmonics settle."""
    found = short_circuit(mean, np.array([speed]))
    omega = machine.map.pole_pairs * speed
    slowest = mean.constant_parameters(0.5 * mean.reach)
    constant = max(slowest.inductance_d, slowest.inductance_q) / slowest.resistance
    sectors = int(np.ceil(SETTLED * constant * omega / SECTOR)) + 1
    end = sectors * SECTOR / omega
    times = end + np.arange(SAMPLES) / SAMPLES * SECTOR / omega
    start = np.array([found.i_d[0], found.i_q[0]])
    path = solve_ivp(machine.rate(omega), (0.0, times[-1]), start, t_eval=times, method="LSODA", rtol=1e-7, atol=1e-7)
    torque = np.mean([machine.torque(omega * t, i) for t, i in zip(path.t, path.y.T)])
    return -float(torque) / speed


def main(study: str) -> None:
    results = Results(PROJECT / "results" / study)
    flux_map, winding, braking = (results.load(name) for name in ("flux_map", "winding", "braking"))
    machine, mean = TurningMachine(winding.wound, flux_map), winding.wound.on_map(flux_map.data)
    ratio, rows = braking.demand.ratio, []
    for speed in SPEEDS:
        over_time = damping_over_time(machine, mean, speed / ratio) / ratio**2
        steady = float(short_circuit(mean, np.array([speed / ratio])).damping[0]) / ratio**2
        rows.append({"speed": speed, "steady": steady, "over_time": over_time, "difference": steady / over_time - 1})
        print("{speed:.4f}: {steady:.5g} steady, {over_time:.5g} over time, {difference:+.4%}".format(**rows[-1]))
    pd.DataFrame(rows).to_csv(TABLE, index=False, float_format="%.7g")


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "motorcycle")
