"""Where changes of a machine show on its bench: claims that many effects share."""

from __future__ import annotations

from effects.signature import Claim, Touches

SHORT_CIRCUIT: tuple[Claim, ...] = (Touches("short_circuit.*"),)
MAGNETS: tuple[Claim, ...] = (Touches("back_emf.v_?"), Touches("cogging.torque"), Touches("locked_rotor.torque"))
# A field with the magnets in it: what they do alone, with current, and how far they saturate the way of the current.
FIELD: tuple[Claim, ...] = (*MAGNETS, Touches("flux_linkage.*psi_?"), *SHORT_CIRCUIT)
LEAKAGE: tuple[Claim, ...] = (*MAGNETS, Touches("flux_linkage.psi_?"), *SHORT_CIRCUIT)  # no change of flux by current
PHASE_A: tuple[Claim, ...] = (
    Touches("back_emf.v_a"),
    Touches("locked_rotor.torque"),
    Touches("flux_linkage.*psi_?"),
    Touches("phase_resistance.r_a"),
    *SHORT_CIRCUIT,
)
SPEED: tuple[Claim, ...] = (Touches("drag.torque"), Touches("short_circuit.torque"))
CREEP: tuple[Claim, ...] = (Touches("cogging.torque"), Touches("locked_rotor.torque"))
