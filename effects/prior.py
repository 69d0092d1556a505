"""What is believed about the size of a parameter before anything is measured, as a map from a standard normal."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, log

from scipy.special import ndtr, ndtri


class Prior:
    """A one-to-one map between a standard normal number z and a value in the parameter's own unit."""

    def value(self, z: float) -> float:
        raise NotImplementedError

    def standard(self, value: float) -> float:
        """z of a value; the inverse of ``value``. Infinite where no z has it."""
        raise NotImplementedError


@dataclass(frozen=True)
class Normal(Prior):
    """Either sign is possible: centre + sd * z."""

    sd: float
    centre: float = 0.0

    def value(self, z: float) -> float:
        return self.centre + self.sd * z

    def standard(self, value: float) -> float:
        return (value - self.centre) / self.sd


@dataclass(frozen=True)
class LogNormal(Prior):
    """A positive quantity whose order of magnitude is known: median * exp(spread * z)."""

    median: float
    spread: float = 0.7

    def value(self, z: float) -> float:
        return self.median * exp(self.spread * z)

    def standard(self, value: float) -> float:
        return log(value / self.median) / self.spread if value > 0 else -inf


@dataclass(frozen=True)
class Uniform(Prior):
    """Anywhere between two bounds alike, for example an angle."""

    low: float
    high: float

    def value(self, z: float) -> float:
        return self.low + (self.high - self.low) * float(ndtr(z))

    def standard(self, value: float) -> float:
        return float(ndtri((value - self.low) / (self.high - self.low)))
