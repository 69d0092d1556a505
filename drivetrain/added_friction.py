"""Losses between the air gap and the output beyond what a study states, as a bench has shown them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Values = Any  # a number, or one for each design of a batch


@dataclass(frozen=True)
class AddedFriction:
    """Friction on the rotor and at the output, and what the transmission keeps to itself.

    rotor_coulomb [Nm], rotor_viscous [Nms/rad]: on the rotor
    output_coulomb [N or Nm], output_viscous [Ns/m or Nms/rad]: at the output
    load_loss: share of the effort that does not arrive, dimensionless
    """

    rotor_coulomb: float = 0.0
    rotor_viscous: float = 0.0
    output_coulomb: float = 0.0
    output_viscous: float = 0.0
    load_loss: float = 0.0

    def coulomb(self, ratio: Values) -> Values:
        """Dry friction at the output [N or Nm]; ratio: tau_t [m/rad or 1]."""
        return self.output_coulomb + self.rotor_coulomb / ratio

    def viscous(self, ratio: Values) -> Values:
        """Viscous friction at the output [Ns/m or Nms/rad]; ratio: tau_t [m/rad or 1]."""
        return self.output_viscous + self.rotor_viscous / ratio**2

    def lost(self, speed: Values, ratio: Values) -> Values:
        """Effort that friction takes at an output speed [N or Nm].

        speed: of the output [m/s or rad/s], scalar or array of any shape; ratio: tau_t [m/rad or 1]
        """
        return self.coulomb(ratio) + self.viscous(ratio) * speed

    def left(self, effort: Values, speed: Values, ratio: Values) -> Values:
        """Effort that arrives at the output of one that the machine makes there [N or Nm], not below zero.

        effort: without these losses [N or Nm]; speed: of the output [m/s or rad/s]; ratio: tau_t [m/rad or 1]
        """
        arrives = (1.0 - self.load_loss) * effort - self.lost(speed, ratio)
        return arrives * (arrives > 0)

    def needed(self, effort: Values, speed: Values, ratio: Values) -> Values:
        """Effort that the machine must make so that one arrives at the output [N or Nm].

        effort: asked of the output [N or Nm]; speed: of the output [m/s or rad/s]; ratio: tau_t [m/rad or 1]
        """
        return (effort + self.lost(speed, ratio)) / (1.0 - self.load_loss)


NO_FRICTION = AddedFriction()
