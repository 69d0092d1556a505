"""What an optimum may choose beside back iron and rotor radius, and what it must leave buildable."""

from __future__ import annotations

from dataclasses import dataclass

from geometry.variables import SWEPT, Variable
from optimisation.build_rules import BuildRule


@dataclass(frozen=True)
class Freedom:
    """further: variables with their bounds, beside ``SWEPT``; rules: that a machine must hold"""

    further: tuple[Variable, ...] = ()
    rules: tuple[BuildRule, ...] = ()

    @property
    def variables(self) -> tuple[Variable, ...]:
        """All that the optimum may choose, back iron and rotor radius first."""
        return (*SWEPT, *self.further)


AS_SWEPT = Freedom()
