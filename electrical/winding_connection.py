"""How the coils of a phase and the three phases are joined, and what that makes of turns, currents and voltages.

A drive sees three terminals. Whatever lies behind them is to it a star of one path: with N_c coils of N_t turns a phase
in ``a`` equal parallel paths,

                        star                delta
    line current        a i_coil            sqrt(3) a i_coil
    line to line        sqrt(3) v_phase     v_phase
    equivalent star     N = N_t / a         N = N_t / (sqrt(3) a)       turns of a coil, all N_c in series

The equivalent star has the power, the copper section and the ampere-turns N i_line = N_t i_coil of the winding, so that
flux linkage, inductance, resistance and the limits of an inverter are those of its turns. All d, q quantities of this
project are the ones of the equivalent star; V_DC / sqrt(3) is its peak voltage, which is V_DC across a phase in delta.

What is lost in it: the equivalent star of a delta lags the winding's phases by 30 electrical degrees, and a delta
carries a current of its own round its triangle (``electrical.circulating``).
Source: star-delta transformation, standard textbook formula.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import ClassVar

import numpy as np

from electrical.dq import Values
from geometry.winding import PHASES


@dataclass(frozen=True)
class Star:
    """The three phases end in one point, which is not led out.

    lag: of the equivalent star behind the phases of the winding, electrical [rad]; circulates: whether a current common
    to all phases has a way
    """

    name: ClassVar[str] = "star"
    line_over_phase_current: ClassVar[float] = 1.0
    lag: ClassVar[float] = 0.0
    circulates: ClassVar[bool] = False

    def terminal_at_end(self, phase: int) -> int | None:
        """The phase at whose terminal a phase ends; None: at the star point."""
        return None


@dataclass(frozen=True)
class Delta:
    """Each phase ends where the next one begins: A between terminals A and B, B between B and C, C between C and A.

    lag: electrical [rad]; circulates: see ``Star``
    """

    name: ClassVar[str] = "delta"
    line_over_phase_current: ClassVar[float] = sqrt(3.0)
    lag: ClassVar[float] = pi / 6
    circulates: ClassVar[bool] = True

    def terminal_at_end(self, phase: int) -> int | None:
        """The phase at whose terminal a phase ends."""
        return (phase + 1) % 3


@dataclass(frozen=True)
class WindingConnection:
    """paths: equal parallel paths of a phase, a, dimensionless; closing: how the phases are joined."""

    paths: int
    closing: Star | Delta

    @property
    def coil_currents(self) -> np.ndarray:
        """Of the coils of A, B and C over those of the lines (3, 3), dimensionless, without what goes round
        a delta. Transposed it makes flux linkages of all coils of a phase in series into those of the equivalent
        star, whose power is the same."""
        lines = np.eye(PHASES)
        if self.closing.circulates:
            lines = (lines - np.roll(lines, 1, axis=1)) / PHASES
        return lines / self.paths

    @property
    def ratio(self) -> float:
        """Line current over the current of one coil, ratio: dimensionless."""
        return self.paths * self.closing.line_over_phase_current

    def equivalent_turns(self, turns: Values) -> Values:
        """Of a coil of the equivalent star, N; turns: of a real coil, N_t."""
        return turns / self.ratio

    def coil_current(self, line_current: Values) -> Values:
        """[A]; line_current: [A], the same measure, RMS or peak."""
        return line_current / self.ratio

    def phase_voltage(self, star_voltage: Values) -> Values:
        """Across a phase of the winding [V]; star_voltage: of the equivalent star [V], the same measure."""
        return star_voltage * self.closing.line_over_phase_current

    def phase_resistance(self, star_resistance: Values) -> Values:
        """Of a phase of the winding [ohm]; star_resistance: of the equivalent star [ohm]. Inductances go likewise."""
        return star_resistance * self.closing.line_over_phase_current**2

    def __str__(self) -> str:
        return self.closing.name if self.paths == 1 else f"{self.closing.name}, {self.paths} parallel paths"


CLOSINGS: dict[str, Star | Delta] = {one.name: one for one in (Star(), Delta())}
SERIES_STAR = WindingConnection(1, Star())
