"""Registered kinds of measurement: which columns answer and which ask."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatch

from workbench.errors import WorkbenchError


@dataclass(frozen=True)
class Kind:
    """responses: patterns of response columns;  axes: patterns of its natural conditions;  cost: of measuring once more
    says: what was done and what the columns mean, for the manual
    """

    responses: tuple[str, ...]
    axes: tuple[str, ...] = ()
    cost: float = 1.0
    says: str = ""

    def is_response(self, column: str) -> bool:
        return any(fnmatch(column, pattern) for pattern in self.responses)


KINDS: dict[str, Kind] = {
    "back_emf": Kind(("v_?", "v_??", "voltage"), ("angle_mech", "speed", "velocity")),
    "cogging": Kind(("torque",), ("angle_mech",)),
    "locked_rotor": Kind(("torque",), ("angle_mech", "i_?")),
    "flux_linkage": Kind(("dpsi_?", "psi_?"), ("i_?", "angle_mech")),
    "inductance": Kind(("l_?", "l_??"), ("i_?", "angle_mech")),
    "phase_resistance": Kind(("r_?", "resistance"), ("winding_T",), cost=0.3),
    "drag": Kind(("torque", "force", "power"), ("speed", "velocity")),
    "short_circuit": Kind(("torque", "force", "current", "i_?"), ("speed", "velocity"), cost=1.5),
    "damping_velocity": Kind(("force", "torque"), ("velocity", "shunt")),
    "locked_force": Kind(("force", "torque"), ("current", "direction")),
    "damping_shunt": Kind(("damping",), ("shunt",)),
    "impedance": Kind(("re", "im"), ("frequency", "amplitude", "shunt"), cost=2.0),
    "force_loop": Kind(("force", "torque"), ("displacement", "velocity"), cost=2.0),
    "dq_operation": Kind(("v_d", "v_q", "torque"), ("i_d", "i_q", "speed")),
    "dq_supply": Kind(("current", "power"), ("torque", "v_ll", "speed")),
    "generic": Kind(()),
}


def kind_of(name: str, where: str) -> Kind:
    """The registered kind.

    Raises:
        WorkbenchError: no such kind.
    """
    if name not in KINDS:
        raise WorkbenchError(f"{where}: the measurement kind {name!r} is not known; use one of {', '.join(KINDS)}.")
    return KINDS[name]
