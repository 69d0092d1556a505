"""A force loop for a stated bandwidth and phase margin."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees, pi

import numpy as np

from control.errors import ControlError
from control.force_loop import ForceLoop
from control.transfer import TransferFunction, bandwidth, margins

# Of the crossover, from where on down the integral acts. The first that serves is taken: a late integral costs little
# phase, an early one holds up the gain below the crossover where the plant has none of its own.
_RESTS = (0.1, 0.2, 0.4, 0.8, 1.6, 3.2)
_FILTER = 10.0  # of the crossover, where the derivative ends
_CROSSOVERS = np.geomspace(0.1, 3.0, 120)  # of the wanted bandwidth
_CLOSE = 2e-3  # of the bandwidth that is reached


def loop_for(plant: TransferFunction, wanted_bandwidth: float, phase_margin: float) -> ForceLoop:
    """The PID whose closed loop first falls 3 dB at the wanted bandwidth, with a phase margin at its crossover.

    At the crossover w_c the loop C G is 1 at -pi + margin. With I = r w_c P and N = 10 w_c this gives P and D linearly;
    w_c follows from the bandwidth, r is the least that serves.
    wanted_bandwidth [Hz]; phase_margin [rad]; plant: motor force to force at the suspension
    Raises ControlError where no such loop is.
    """
    for rest in _RESTS:
        for low, high in _brackets(plant, wanted_bandwidth, phase_margin, rest):
            loop = _between(plant, low, high, wanted_bandwidth, phase_margin, rest)
            if loop is not None and _serves(plant, loop, wanted_bandwidth, phase_margin):
                return loop
    raise ControlError(
        f"no loop has a bandwidth of {wanted_bandwidth:g} Hz with {degrees(phase_margin):.3g} degrees of phase margin "
        "on this plant; ask for another bandwidth or for less margin"
    )


def _brackets(plant: TransferFunction, wanted: float, margin: float, rest: float) -> Iterator[tuple[float, float]]:
    """Pairs of crossovers [Hz] between which the bandwidth passes the wanted one [Hz]."""
    reached = [(one * wanted, _reached(plant, one * wanted, margin, rest)) for one in _CROSSOVERS]
    for (low, below), (high, above) in zip(reached, reached[1:], strict=False):
        if below is not None and above is not None and below < wanted <= above:
            yield low, high


def _between(
    plant: TransferFunction, low: float, high: float, wanted: float, margin: float, rest: float
) -> ForceLoop | None:
    """By halving, since the bandwidth may jump."""
    for _ in range(20):
        middle = (low + high) / 2
        found = _reached(plant, middle, margin, rest)
        if found is None:
            return None
        low, high = (low, middle) if found >= wanted else (middle, high)
    return _through(plant, high, margin, rest)


def _reached(plant: TransferFunction, crossover: float, margin: float, rest: float) -> float | None:
    loop = _through(plant, crossover, margin, rest)
    return None if loop is None else bandwidth(plant.times(loop.transfer).closed)


def _serves(plant: TransferFunction, loop: ForceLoop, wanted: float, margin: float) -> bool:
    open_loop = plant.times(loop.transfer)
    close = abs(bandwidth(open_loop.closed) / wanted - 1) < _CLOSE
    return close and open_loop.closed.is_stable and abs(margins(open_loop).phase - margin) < _CLOSE


def _through(plant: TransferFunction, crossover: float, margin: float, rest: float) -> ForceLoop | None:
    """The loop with this crossover [Hz] and margin [rad]; None where P or D would be negative."""
    omega = 2 * pi * crossover
    target = np.exp(1j * (margin - pi)) / complex(plant.at(crossover))
    columns = np.array([1 - 1j * rest, 1j * omega / (1j / _FILTER + 1)])
    proportional, derivative = np.linalg.solve(np.array([columns.real, columns.imag]), [target.real, target.imag])
    if proportional < 0 or derivative < 0:
        return None
    return ForceLoop(float(proportional), float(rest * omega * proportional), float(derivative), float(_FILTER * omega))
