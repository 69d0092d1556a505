"""Iron loss from the loci of B, element by element, as three numbers a region that scale with frequency.

    hysteresis  k_h f sum over closed loops (dB/2)^alpha, on the major and on the minor axis of the locus
    eddy        k_c/(2 pi^2) <|dB/dt|^2> (1 + k_s B_ac^2)
    excess      k_e/8.763 <|dB/dt|^1.5>

For a sine along one line these are the law of ``materials/iron_loss.py`` exactly. The derivative holds all harmonics
that the steps resolve. B_ac is the largest distance of the locus from its mean: the peak of an alternating field; a
constant part does not count.

Assumptions: the losses do not act back on the field; a loop costs the same whatever constant field lies under it; both
axes of a rotating field count in full, which is right up to about 1 T and too much towards saturation, where rotational
hysteresis falls; stator and rotor are laminated. Cut edges, stress and stacking are not corrected for.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from electrical.dq import Values
from losses.loci import Loci
from materials.iron_loss import EXCESS_OF_SINE, IronLossLaw


@dataclass(frozen=True)
class FrequencyTerms:
    """Loss as a function of the electrical frequency at one current, P = c_1 f + c_2 f^2 + c_1.5 f^1.5 [W/m].

    hysteresis [W s/m], eddy [W s^2/m], excess [W s^1.5/m]: of the whole machine per metre; scalars or arrays
    """

    hysteresis: Values
    eddy: Values
    excess: Values

    def at(self, frequency: Values) -> Values:
        """Loss [W/m] at an electrical frequency [Hz], p omega_m / 2 pi; without a new field solution."""
        frequency = np.abs(frequency)
        return self.hysteresis * frequency + self.eddy * frequency**2 + self.excess * frequency**1.5

    def __add__(self, other: FrequencyTerms) -> FrequencyTerms:
        return FrequencyTerms(self.hysteresis + other.hysteresis, self.eddy + other.eddy, self.excess + other.excess)


@dataclass(frozen=True, eq=False)
class IronLoss:
    """Loss of one region: terms of every element per kilogram (E,) and their sum over the machine.

    amplitude (E,): B_ac [T]; terms: per element [W/kg]; total: [W/m]
    """

    loci: Loci
    law: IronLossLaw
    amplitude: np.ndarray
    terms: FrequencyTerms

    @property
    def total(self) -> FrequencyTerms:
        """Of the whole machine per metre of its length."""
        mass = self.law.density * self.loci.area * self.loci.sectors
        t = self.terms
        return FrequencyTerms(*(float(mass @ term) for term in (t.hysteresis, t.eddy, t.excess)))

    def share_beyond_data(self, frequency: float) -> float:
        """Share of the loss in elements whose amplitude exceeds the data of the law: extrapolated."""
        loss = self.law.density * self.loci.area * self.terms.at(frequency)
        total = loss.sum()
        return float(loss[self.amplitude > self.law.peaks[1]].sum() / total) if total > 0 else 0.0


def iron_loss(loci: Loci, law: IronLossLaw) -> IronLoss:
    """Loss of the elements of some loci (values in T) by a law."""
    amplitude = np.sqrt(((loci.values - loci.values.mean(0)) ** 2).sum(-1)).max(0)
    rate = np.sqrt((loci.rate() ** 2).sum(-1))
    eddy = law.eddy / (2 * pi**2) * (rate**2).mean(0) * (1 + law.saturation * amplitude**2)
    excess = law.excess / EXCESS_OF_SINE * (rate**1.5).mean(0)
    loops = loop_sum(principal_components(loci.values), law.exponent) / loci.periods
    return IronLoss(loci, law, amplitude, FrequencyTerms(law.hysteresis * loops, eddy, excess))


def principal_components(values: np.ndarray) -> np.ndarray:
    """The values about their mean, along their own major and minor axes.

    values, principal_components: [T], (steps, E, 2)
    """
    centred = values - values.mean(0)
    x, y = centred[..., 0], centred[..., 1]
    angle = 0.5 * np.arctan2(2 * (x * y).mean(0), (x * x).mean(0) - (y * y).mean(0))
    c, s = np.cos(angle), np.sin(angle)
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)


def loop_sum(components: np.ndarray, exponent: float) -> np.ndarray:
    """Sum over all closed loops of (peak-to-peak/2)^exponent, both components together [T^exponent], (E,).

    components: [T], (steps, E, 2), one period; exponent: dimensionless
    Loops are found by the rainflow count from the largest value on, so that nested minor loops
    are split from the major one (as in a Preisach material, whose loops close).
    """
    steps, count, _ = components.shape
    series = components.reshape(steps, -1)
    order = (series.argmax(0) + np.arange(steps + 1)[:, None]) % steps
    return _rainflow(np.take_along_axis(series, order, 0), exponent).reshape(count, 2).sum(1)


def _rainflow(series: np.ndarray, exponent: float) -> np.ndarray:
    """Rainflow sums of many series (n, m) at once; each starts and ends at its largest value."""
    columns = np.arange(series.shape[1])
    stack, depth, total = np.zeros_like(series), np.zeros(len(columns), dtype=int), np.zeros(len(columns))
    for value in series:
        _push(stack, depth, value, columns)
        active = columns[depth >= 3]
        while len(active):
            last, middle, first = (stack[depth[active] - k, active] for k in (1, 2, 3))
            closed = np.abs(last - middle) >= np.abs(middle - first)
            active, loops = active[closed], (np.abs(middle - first) / 2)[closed]
            total[active] += loops**exponent
            stack[depth[active] - 3, active] = last[closed]
            depth[active] -= 2
            active = active[depth[active] >= 3]
    return total


def _push(stack: np.ndarray, depth: np.ndarray, value: np.ndarray, columns: np.ndarray) -> None:
    """Put a value on every stack; a value that goes on in the same direction replaces the last one."""
    below, second = stack[np.maximum(depth - 1, 0), columns], stack[np.maximum(depth - 2, 0), columns]
    onward = (depth >= 2) & ((value - below) * (below - second) >= 0)
    depth += ~onward
    stack[depth - 1, columns] = value
