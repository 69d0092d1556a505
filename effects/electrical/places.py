"""Where changes of a winding show on its bench: claims that several effects share."""

from __future__ import annotations

from effects.signature import Claim, Odd, Power, Touches

# A resistance in series with the winding, whatever makes it.
SERIES_RESISTANCE: tuple[Claim, ...] = (
    Odd("damping_velocity.force", ("velocity",)),
    Power("damping_velocity.force", "velocity", 1.0),
    Touches("damping_shunt.damping"),
    Touches("impedance.re"),
    Touches("short_circuit.*"),
    Touches("dq_supply.*"),
    Touches("phase_resistance.resistance"),
    Power("dq_operation.v_q", "i_q", 1.0),
    Power("dq_operation.v_d", "i_d", 1.0),
)
