"""A load against what it may be: one check of the rotor, its shaft or its bearings."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class LoadCheck:
    """Safety factor of a part: limit over load.

    part: what it is, in words; wanted: factor, dimensionless; load, limit: [unit of both, SI]
    unit: to show them in, a key of ``units.FACTORS``, empty for a pure number
    helps: what to change where it does not hold, with the keys of the study
    """

    part: str
    wanted: float
    load: float
    limit: float
    unit: str
    helps: str

    @property
    def reached(self) -> float:
        """The factor, dimensionless; infinite without a load."""
        return self.limit / self.load if self.load else inf

    @property
    def margin(self) -> float:
        """Relative; negative where the factor is not reached."""
        return self.reached / self.wanted - 1

    @property
    def holds(self) -> bool:
        return self.reached >= self.wanted
