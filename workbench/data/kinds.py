"""Registered kinds of measurement: which columns answer and which ask."""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatch

from workbench.errors import WorkbenchError


@dataclass(frozen=True)
class Kind:
    """responses: patterns of response columns, of which a table has any;  axes: patterns of its natural conditions
    cost: of measuring once more;  says: what was done and what the columns mean, for a manual
    needs: axes without which it was another kind;  besides: conditions that are mostly the same in all rows
    """

    responses: tuple[str, ...]
    axes: tuple[str, ...] = ()
    cost: float = 1.0
    says: str = ""
    needs: tuple[str, ...] = ()
    besides: tuple[str, ...] = ()

    def is_response(self, column: str) -> bool:
        return any(fnmatch(column, pattern) for pattern in self.responses)


_METERS = ("power", "current", "v_ll", "power_factor", "efficiency", "loss")
_METERS_SAY = (
    "power: electrical, into the machine; current: RMS of a line; v_ll: RMS between lines, of the fundamental; "
    "power_factor; efficiency: 0 to 1, shaft over electrical power of a motor, the other way round of a generator; "
    "loss: electrical less shaft power."
)

# Angles are mechanical, temperatures (names in _T) in degrees Celsius. Phase quantities (v_a, i_a, r_a, ...) are of the
# instant where the table has an angle; without one, voltages and currents are RMS, and i_d, i_q, v_d, v_q peak.
KINDS: dict[str, Kind] = {
    "back_emf": Kind(
        ("v_?", "v_??", "voltage"),
        ("angle_mech", "speed", "velocity"),
        says="Driven with open terminals. v_a, v_b, v_c: phase voltages over angle_mech; v_ll: RMS between lines over "
        "speed; voltage: of a damper over velocity. Optional: magnet_T.",
    ),
    "cogging": Kind(
        ("torque",),
        ("angle_mech",),
        says="Turned slowly without current. torque on the rotor; direction +1 and -1 tells friction from cogging.",
    ),
    "locked_rotor": Kind(
        ("torque",),
        ("angle_mech", "i_?"),
        says="Constant currents i_a, i_b, i_c, rotor held or turned by hand. torque on the rotor.",
    ),
    "flux_linkage": Kind(
        ("dpsi_?", "psi_?"),
        ("i_?", "angle_mech"),
        says="Flux linkages of the phases at constant currents: dpsi_a the change against no current, psi_a the whole. "
        "As the integral of the voltage it shares voltage_gain; a meter of its own declares its gain in u_sys.",
    ),
    "inductance": Kind(
        ("l_?", "l_??"),
        ("i_?", "angle_mech"),
        says="l_a: change of the flux linkage of a phase over its own current. Of a drawn machine over angle_mech, at "
        "a current or a small one: l_a, l_m (of B by A), l_ab, l_bc, l_ca between two lines, the third open.",
    ),
    "holding_current": Kind(
        ("current",),
        ("angle_mech",),
        says="A driver holds the rotor of a drawn machine against its cogging. current: the peak along the q axis that "
        "it needs, positive where it drives counter-clockwise; direction +1 and -1 where the rotor creeps.",
    ),
    "phase_resistance": Kind(
        ("r_?", "r_??", "resistance"),
        ("winding_T",),
        cost=0.3,
        says="Of a phase between its terminals, d.c. r_ab, r_bc, r_ca of a drawn machine: between two lines.",
    ),
    "drag": Kind(
        ("torque", "force", "power"),
        ("speed", "velocity"),
        says="Driven with open terminals, the mean over the angle. torque of a machine from fields is that on its "
        "rotor, negative at positive speed; of a dq machine what brakes it, positive.",
    ),
    "short_circuit": Kind(
        ("torque", "force", "current", "i_?"),
        ("speed", "velocity"),
        cost=1.5,
        says="Driven with joined terminals. torque as in drag; current: RMS, mean square of the phases; i_a: RMS.",
    ),
    "damping_velocity": Kind(
        ("force", "torque"), ("velocity", "shunt"), says="Driven at constant velocity over a shunt."
    ),
    "locked_force": Kind(
        ("force", "torque"),
        ("current", "direction"),
        says="Output held, or moved slowly in a direction +1 or -1, at a current (RMS of a line).",
    ),
    "damping_shunt": Kind(("damping",), ("shunt",), says="Damping over the resistance of the shunt."),
    "impedance": Kind(
        ("re", "im"),
        ("frequency", "amplitude", "shunt"),
        cost=2.0,
        says="Driven by a sine; re, im: fundamental of the force over that of the velocity.",
    ),
    "force_loop": Kind(
        ("force", "torque"),
        ("displacement", "velocity"),
        cost=2.0,
        says="Force over a driven motion. Of a damper at frequency, amplitude, shunt and phase, x = A sin(phase), or "
        "displacement and velocity for the phase.",
        besides=("frequency", "amplitude", "shunt"),
    ),
    "dq_operation": Kind(
        ("v_d", "v_q", "torque"),
        ("i_d", "i_q", "speed"),
        says="Fed with currents i_d, i_q at a speed. v_d, v_q: peak, as the currents; torque at the shaft.",
    ),
    "dq_supply": Kind(
        ("current", "power"),
        ("torque", "v_ll", "speed"),
        says="Fed by a stiff sine v_ll, RMS between lines. current: RMS of a line; power: electrical, into it.",
        needs=("v_ll",),
    ),
    "dyno_map": Kind(
        _METERS,
        ("speed", "torque"),
        cost=3.0,
        says="Fed by an inverter that takes the smallest current for torque at speed; v_dc, optional, limits its "
        "voltage. Or at i_d and i_q (peak), with torque declared as a response. Optional: winding_T, magnet_T. "
        + _METERS_SAY,
    ),
    "no_load": Kind(
        ("current", "power", "power_factor", "loss"),
        ("speed", "v_ll"),
        says="Nothing at the shaft. With v_ll: fed by a sine of it at speed, power is electrical. Without: driven with "
        "open terminals, power is that of the drive. " + _METERS_SAY,
    ),
    "generic": Kind((), says="Anything: the columns named in u_random are responses."),
}


def kind_of(name: str, where: str) -> Kind:
    """The registered kind.

    Raises:
        WorkbenchError: no such kind.
    """
    if name not in KINDS:
        raise WorkbenchError(f"{where}: the measurement kind {name!r} is not known; use one of {', '.join(KINDS)}.")
    return KINDS[name]
