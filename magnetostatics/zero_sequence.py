"""What a flux map says of the zero sequence: the flux linkage that all three phases share, and their inductance to it.

    psi_0 = (psi_A + psi_B + psi_C) / 3

It turns round after 60 electrical degrees, with which the phases change places and signs, so that it holds the third
harmonic and its odd multiples alone. A star without a neutral cannot carry its current; a closed delta does.
"""

from __future__ import annotations

from math import pi

import numpy as np

from labelled import xr
from magnetostatics.model import FieldSolution

FUNDAMENTAL = 3  # lowest order of psi_0 over the electrical angle


def zero_sequence_inductance(solution: FieldSolution) -> float:
    """L_0 = d psi_0 / d i_0 [H/m per turn^2], i_A = i_B = i_C = i_0, at the saturation of a solution.

    L_0 = n/3 w . K^-1 w with the tangent K of the converged field, the load w of one ampere-turn in every phase and n
    sectors. In the plane of the cross-section: the end windings add to it.
    """
    model = solution.model
    load = np.sum(model.phase_loads, axis=0)
    return float(model.section.sectors / 3 * load @ model.tangent(solution).response(load))


def harmonics_of_half_period(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(orders, amplitudes) of a wave that is ``-samples`` after 60 electrical degrees.

    samples: [any unit], over the first axis, evenly over 60 degrees without the end (n, ...); harmonics_of_half_period:
    orders 3, 9 ... that n samples resolve, dimensionless (m,), and amplitudes [that of the samples] (m, ...)
    """
    orders, amplitudes = harmonics_of_period(np.concatenate([samples, -samples]))
    return orders[::2], amplitudes[::2]


def harmonics_of_period(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The same of a wave that repeats after 120 electrical degrees, evenly over all of them: orders 3, 6, 9, ... (m,),
    dimensionless, and amplitudes (m, ...) [that of the samples (n, ...)]."""
    count = len(samples)
    spectrum = np.fft.rfft(samples, axis=0)[1 : (count + 1) // 2]
    return FUNDAMENTAL * np.arange(1, len(spectrum) + 1), 2 * np.abs(spectrum) / count


def with_zero_sequence(data: xr.Dataset, inductance: float) -> xr.Dataset:
    """A map with psi_0 over the rotor angle turned into its amplitudes over ``order``, and with l_0.

    data: with psi_0 [Wb/m] over angle, id, iq, the angles evenly over its period, of 60 electrical degrees or 120
    inductance: L_0 [H/m per turn^2]
    """
    samples = data["psi_0"].transpose("angle", "id", "iq")
    harmonics = harmonics_of_half_period if data.attrs["period"] < pi / 2 else harmonics_of_period
    orders, amplitudes = harmonics(samples.values)
    attributes = {"units": "Wb/m", "long_name": "amplitude of the zero-sequence flux linkage per turn and metre"}
    found = xr.DataArray(amplitudes, {"order": orders, "id": data.id, "iq": data.iq}, ("order", "id", "iq"))
    described = {"units": "H/m", "long_name": "zero-sequence inductance without current per turn^2 and metre"}
    return data.assign(psi_0=found.assign_attrs(attributes), l_0=xr.DataArray(inductance, attrs=described))
