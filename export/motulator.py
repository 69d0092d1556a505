"""The machine for drive simulation: parameters by the names that motulator gives them, SI, peak phase values.

motulator (Aalto University) models a synchronous machine in rotor coordinates with peak-valued space vectors,
psi_d = L_d i_d + psi_f, psi_q = L_q i_q, which are this project's d, q and amplitudes.
"""

from __future__ import annotations

import json

from electrical.synchronous_machine import SynchronousMachine

_UNITS = {
    "n_p": "pole pairs",
    "R_s": "ohm, one phase of the equivalent star, direct current at the temperature of the winding in the study",
    "L_d": "H, phase of the equivalent star",
    "L_q": "H, phase of the equivalent star",
    "psi_f": "Vs, peak flux linkage of one phase of the equivalent star by the magnets",
}
_KEYWORDS = "keywords of motulator's SynchronousMachinePars: SynchronousMachinePars(**parameters['full_current'])"


def parameters(machine: SynchronousMachine) -> dict[str, float]:
    """Keywords of ``SynchronousMachinePars``: n_p, R_s [ohm], L_d, L_q [H], psi_f [Vs]."""
    return {
        "n_p": machine.pole_pairs,
        "R_s": float(machine.resistance),
        "L_d": float(machine.inductance_d),
        "L_q": float(machine.inductance_q),
        "psi_f": float(machine.psi_m),
    }


def parameter_text(full_current: SynchronousMachine, unsaturated: SynchronousMachine, connection: str) -> str:
    """JSON of the saturated machine (torque right at full current) and of the unsaturated one (back-EMF right).

    connection: of the winding, in words; the parameters are those of its equivalent star
    """
    content = {
        "about": _KEYWORDS,
        "connection": connection,
        "units": _UNITS,
        "full_current": parameters(full_current),
        "no_current": parameters(unsaturated),
    }
    return json.dumps(content, indent=2) + "\n"
