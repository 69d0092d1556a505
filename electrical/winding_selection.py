"""Turns and wires in hand: every pair that fits the slot, what each would do, and which one to wind.

A given ampere-turn count in a given cross-section makes the same field whatever the turns; more turns only trade
current against voltage. So one field solution, per turn and per metre, values every winding of the machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, pi, sqrt

import numpy as np

from electrical.resistance import phase_resistance
from electrical.synchronous_machine import (
    DriveLimits,
    SynchronousMachine,
    base_speed,
    maximum_power,
    mtpa_currents,
    power_at_base_speed,
)
from units import RPM

FLUX_DISAGREEMENT = 0.05  # overload flux may exceed the no-load flux by this much before the inputs are refused
AMPERE_TURN_REACH = 1.25  # the flux is not extrapolated further beyond the ampere-turns of its field solution


class WindingError(ValueError):
    """No winding can be chosen from these inputs; the message says which number to change."""


@dataclass(frozen=True)
class Wire:
    """One round wire: copper diameter without varnish [m] and resistivity at its temperature [ohm m]."""

    copper_diameter: float
    resistivity: float

    @property
    def area(self) -> float:
        """Copper section A_w [m^2]."""
        return pi * self.copper_diameter**2 / 4


@dataclass(frozen=True)
class PerTurnMachine:
    """A machine of known cross-section and length before its winding is chosen.

    pole_pairs: p
    coils_in_series: coils of one phase, N_c
    half_slot_area: A_s, the section one coil side may fill [m^2]
    active_length, end_turn_length: [m]
    flux_linkage: no-load peak flux linkage of one phase, all its coils in series [Wb per turn and metre]
    inductance_d, inductance_q: phase inductances [H per turn^2 and metre]. The base speed is reached at full current:
        give the apparent values there (they fall with saturation)
    overload_torque: torque on the q axis at ``overload_ampere_turns`` [Nm per metre]
    overload_ampere_turns: peak ampere-turns of one coil to which that torque belongs [A], sqrt(2) J k_cp A_s
    """

    pole_pairs: int
    coils_in_series: int
    half_slot_area: float
    active_length: float
    end_turn_length: float
    flux_linkage: float
    inductance_d: float
    inductance_q: float
    overload_torque: float
    overload_ampere_turns: float

    def __post_init__(self):
        for name, value in vars(self).items():
            if not (isfinite(value) and value > 0):
                raise WindingError(f"{name} must be a positive number; found {value}")
        if self.overload_flux_linkage > (1 + FLUX_DISAGREEMENT) * self.flux_linkage:
            raise WindingError(
                f"the overload torque needs a flux linkage of {self.overload_flux_linkage:.4g} Wb per turn and metre, "
                f"more than the no-load value {self.flux_linkage:.4g}; saturation only lowers it: check peak against "
                "RMS ampere-turns and whether the flux linkage counts all coils in series"
            )

    @property
    def overload_flux_linkage(self) -> float:
        """psi_d that makes the overload torque, T / (1.5 p NI) [Wb per turn and metre]."""
        return self.overload_torque / (1.5 * self.pole_pairs * self.overload_ampere_turns)

    def flux_linkage_at(self, ampere_turns):
        """Direct-axis flux linkage at peak ampere-turns on the q axis [Wb per turn and metre].

        psi(NI) = psi_0 - (psi_0 - psi_oload) (NI / NI_oload)^2

        psi_d cannot know the sign of i_q, so its lowest-order change is quadratic; the two coefficients are the
        no-load flux and the overload torque. Within 1.5 % of the field solution of the 85 mm, 12-slot machine from
        no current to 20 A/mm^2 RMS.
        """
        drop = self.flux_linkage - self.overload_flux_linkage
        return self.flux_linkage - drop * (ampere_turns / self.overload_ampere_turns) ** 2


@dataclass(frozen=True)
class WindingLimits:
    """What workshop, bus, bearings and power electronics allow.

    packing_limit: gross packing factor k_cp aimed at, copper over half-slot area
    packing_tolerance: relative excess over the limit that the workshop still accepts, 0 for none. The windings printed
        in the thesis need one: 7 x 22 and 4 x 39 wires of 0.5 mm fill 0.308 and 0.312 of 98.2 mm^2 (0.301 and 0.305 of
        the 100.45 mm^2 of the drawn half-slot) against a limit of 0.3. A chosen winding that uses it says so.
    overload_current_density: RMS [A/m^2 of copper]
    dc_voltage: [V]
    maximum_speed: mechanical [rad/s], bounds the search for the maximum power
    phase_current_rms: largest RMS phase current of the power electronics [A]; ``math.inf`` for none. A peak value is
        divided by sqrt(2) by the caller.
    """

    packing_limit: float
    packing_tolerance: float
    overload_current_density: float
    dc_voltage: float
    maximum_speed: float
    phase_current_rms: float = inf

    def __post_init__(self):
        if not 0 < self.packing_limit < pi / 4:
            raise WindingError(
                f"the packing limit must lie between 0 and pi/4 (round wires in a square grid); "
                f"found {self.packing_limit}"
            )
        if not 0 <= self.packing_tolerance < 1:
            raise WindingError(f"the packing tolerance must lie between 0 and 1; found {self.packing_tolerance}")
        if not self.phase_current_rms > 0:
            raise WindingError(f"the phase current limit must be positive; found {self.phase_current_rms}")

    @property
    def largest_packing(self) -> float:
        """Packing factor up to which a winding counts as feasible."""
        return self.packing_limit * (1 + self.packing_tolerance)


@dataclass(frozen=True)
class WindingRequirement:
    """What the wound machine must reach: base speed [rad/s, mechanical], power [W], peak torque [Nm]."""

    base_speed: float
    power: float
    torque: float


@dataclass(frozen=True)
class Winding:
    """One pair of turns and wires in hand, valued at the overload current density."""

    turns: int  # N_t of one coil
    strands: int  # N_h, wires in hand
    fullest: bool  # N_h is the largest that fits with this N_t
    packing: float  # copper over half-slot area
    current_rms: float  # A, phase
    current_peak: float  # A, phase
    phase_resistance: float  # ohm
    inductance_d: float  # H, phase
    inductance_q: float  # H, phase
    torque_constant: float  # Nm per peak ampere at the overload current on the q axis
    no_load_torque_constant: float  # Nm per peak ampere at vanishing current
    peak_torque: float  # Nm, MTPA at the overload current
    base_speed: float  # rad/s, mechanical; 0 where the resistance alone uses up the voltage
    power_at_base_speed: float  # W
    maximum_power: float  # W, ideal field weakening up to the maximum speed
    speed_at_maximum_power: float  # rad/s, mechanical

    @property
    def phase_to_phase_resistance(self) -> float:
        """Two phases in series [ohm]."""
        return 2 * self.phase_resistance

    @property
    def phase_to_phase_inductance(self) -> float:
        """Two phases in series, mean over the rotor angle, L_d + L_q [H]."""
        return self.inductance_d + self.inductance_q

    def machine(self, pole_pairs: int) -> SynchronousMachine:
        """The machine with this winding, its flux that of the overload current."""
        psi_m = self.torque_constant / (1.5 * pole_pairs)
        return SynchronousMachine(pole_pairs, psi_m, self.inductance_d, self.inductance_q, self.phase_resistance)

    def satisfies(self, requirement: WindingRequirement) -> bool:
        """Base speed and power at base speed reach the requirement.

        The power at base speed is what the thesis's printed maximum powers amount to; the ideal ``maximum_power``
        is 16 to 17 % above them and does not count.
        """
        return self.base_speed >= requirement.base_speed and self.power_at_base_speed >= requirement.power


@dataclass(frozen=True)
class WindingChoice:
    """The winding to make, why, and everything it was chosen from."""

    chosen: Winding
    reason: str
    unrestricted: Winding | None  # meets the requirement with the lowest current when the current limit is ignored
    fullest: tuple[Winding, ...]  # for every number of turns the most wires that fit
    table: tuple[Winding, ...]  # every pair that fits


def required_base_speed(velocity, transmission_ratio) -> float:
    """Lowest base speed that gives this actuator velocity at full torque, v / tau_t [rad/s] (3.120).

    velocity: actuator velocity at the peak force [m/s]; transmission_ratio: tau_t [m/rad]
    Equation 3.120 prints 60 v/(2 pi) tau_t; the ratio divides (6643 rpm at 1.6 m/s and 2.3 mm/rad).
    """
    return velocity / transmission_ratio


def winding_requirement(*, peak_force, velocity_at_peak_force, peak_power, transmission_ratio) -> WindingRequirement:
    """Requirement at the machine shaft from the actuator's [N, m/s, W] and tau_t [m/rad]; eqs 3.4 and 3.120."""
    return WindingRequirement(
        base_speed=required_base_speed(velocity_at_peak_force, transmission_ratio),
        power=peak_power,
        torque=peak_force * transmission_ratio,
    )


def feasible_pairs(half_slot_area, wire: Wire, limits: WindingLimits) -> tuple[tuple[int, int], ...]:
    """Every (N_t, N_h) with N_t N_h A_w / A_s <= the largest packing (3.119), by turns, then by wires.

    Raises WindingError when not even one wire fits.
    """
    wires = int(limits.largest_packing * half_slot_area / wire.area * (1 + 1e-12))
    if wires < 1:
        raise WindingError(
            f"one wire of {wire.area:.4g} m^2 does not fit: packing {limits.largest_packing:.4g} of "
            f"{half_slot_area:.4g} m^2; take a thinner wire"
        )
    return tuple((turns, strands) for turns in range(1, wires + 1) for strands in range(1, wires // turns + 1))


def evaluate_windings(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, pairs: tuple[tuple[int, int], ...]
) -> tuple[Winding, ...]:
    """Values each (N_t, N_h) pair at the overload current density.

    I_peak = sqrt(2) J A_w N_h (3.77); psi = N_t l psi(N_t I_peak); L = N_t^2 l L_1; R from eq. 3.82; then base speed
    and powers of the constant-parameter machine at V_DC / sqrt(3).
    Raises WindingError when a pair has far more ampere-turns than the field solution it is valued with.
    """
    turns, strands = np.array(pairs, dtype=float).T
    current = sqrt(2) * limits.overload_current_density * wire.area * strands
    _check_reach(machine, turns * current)
    family = _family(machine, wire, turns, strands, turns * current)
    drive = DriveLimits.from_dc_bus(current[:, None], limits.dc_voltage)
    columns = _columns(machine, wire, family, drive, limits, turns, strands)
    fullest = {pair_turns: max(n for t, n in pairs if t == pair_turns) for pair_turns in dict(pairs)}
    return tuple(
        Winding(turns=t, strands=n, fullest=fullest[t] == n, **{name: float(c[k]) for name, c in columns.items()})
        for k, (t, n) in enumerate(pairs)
    )


def select_winding(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, requirement: WindingRequirement
) -> WindingChoice:
    """Chooses turns and wires in hand among the fullest slots.

    1. For every N_t only the largest N_h that fits competes: copper left out is torque left out.
    2. Of those that meet base speed and power within the current limit, the one with the lowest current.
    3. Where none does, the one with the largest base speed within the current limit; the reason says what is relaxed.

    Raises WindingError when no pair fits the slot or none stays within the current limit.
    Source: thesis, "Electric machine windings definition", eqs 3.119-3.120, where the choice was by trial.
    """
    table = evaluate_windings(machine, wire, limits, feasible_pairs(machine.half_slot_area, wire, limits))
    fullest = tuple(winding for winding in table if winding.fullest)
    affordable = _affordable(fullest, limits)
    unrestricted = _lowest_current(fullest, requirement)
    chosen = _lowest_current(affordable, requirement) or max(affordable, key=lambda winding: winding.base_speed)
    reason = _reason(chosen, unrestricted, limits, requirement)
    return WindingChoice(chosen, reason, unrestricted, fullest, table)


def _check_reach(machine, ampere_turns):
    largest = float(np.max(ampere_turns))
    if largest > AMPERE_TURN_REACH * machine.overload_ampere_turns:
        raise WindingError(
            f"the windings reach {largest:.4g} ampere-turns, the overload torque is known at "
            f"{machine.overload_ampere_turns:.4g} only; solve the field at the overload current of these windings"
        )


def _family(machine, wire, turns, strands, ampere_turns):
    """All pairs as one machine with array fields of shape (pairs, 1)."""
    resistance = phase_resistance(
        turns=turns,
        strands=strands,
        wire_area=wire.area,
        active_length=machine.active_length,
        end_turn_length=machine.end_turn_length,
        coils_in_series=machine.coils_in_series,
        resistivity=wire.resistivity,
    )
    return SynchronousMachine(
        pole_pairs=machine.pole_pairs,
        psi_m=(turns * machine.active_length * machine.flux_linkage_at(ampere_turns))[:, None],
        inductance_d=(turns**2 * machine.active_length * machine.inductance_d)[:, None],
        inductance_q=(turns**2 * machine.active_length * machine.inductance_q)[:, None],
        resistance=resistance[:, None],
    )


def _columns(machine, wire, family, drive, limits, turns, strands):
    """The fields of ``Winding`` that are numbers, each an array over the pairs."""
    best = maximum_power(family, drive, limits.maximum_speed)
    current = drive.current_peak[:, 0]
    return {
        "packing": turns * strands * wire.area / machine.half_slot_area,
        "current_rms": current / sqrt(2),
        "current_peak": current,
        "phase_resistance": family.resistance[:, 0],
        "inductance_d": family.inductance_d[:, 0],
        "inductance_q": family.inductance_q[:, 0],
        "torque_constant": family.torque_constant[:, 0],
        "no_load_torque_constant": 1.5 * machine.pole_pairs * turns * machine.active_length * machine.flux_linkage,
        "peak_torque": family.torque(*mtpa_currents(family, drive.current_peak))[:, 0],
        "base_speed": base_speed(family, drive)[:, 0],
        "power_at_base_speed": power_at_base_speed(family, drive)[:, 0],
        "maximum_power": best.power,
        "speed_at_maximum_power": best.speed,
    }


def _affordable(windings, limits):
    """Windings within the current limit, a hair of rounding apart."""
    affordable = tuple(w for w in windings if w.current_rms <= limits.phase_current_rms * (1 + 1e-9))
    if not affordable:
        smallest = min(winding.current_rms for winding in windings)
        raise WindingError(
            f"every winding needs more than {limits.phase_current_rms:.4g} A RMS; the smallest is {smallest:.4g} A "
            "with the slot as full as it gets: raise the current limit or take a thinner wire"
        )
    return affordable


def _lowest_current(windings, requirement):
    """Lowest current among those that meet the requirement; of equals the one with the larger base speed."""
    meeting = [winding for winding in windings if winding.satisfies(requirement)]
    return min(meeting, key=lambda winding: (winding.current_rms, -winding.base_speed), default=None)


def _reason(chosen, unrestricted, limits, requirement):
    if chosen.satisfies(requirement):
        text = _reason_met(chosen, limits, requirement)
    else:
        text = _reason_relaxed(chosen, unrestricted, limits, requirement)
    return " ".join(filter(None, (text, _torque_remark(chosen, requirement), _packing_remark(chosen, limits))))


def _reason_met(chosen, limits, requirement):
    within = "" if limits.phase_current_rms == inf else f" and within the limit of {limits.phase_current_rms:.1f} A RMS"
    return (
        f"{_name(chosen)}: lowest current of all full slots that meet the requirement, {chosen.current_rms:.1f} A RMS "
        f"({chosen.current_peak:.1f} A peak){within}; base speed {chosen.base_speed / RPM:.0f} rpm against "
        f"{requirement.base_speed / RPM:.0f} rpm required, power at base speed {chosen.power_at_base_speed:.0f} W "
        f"against {requirement.power:.0f} W."
    )


def _reason_relaxed(chosen, unrestricted, limits, requirement):
    limit = "" if limits.phase_current_rms == inf else f" within {limits.phase_current_rms:.1f} A RMS of phase current"
    return (
        f"{_name(chosen)}: no full slot meets the requirement{limit}, so the largest base speed there is taken, at "
        f"{chosen.current_rms:.1f} A RMS ({chosen.current_peak:.1f} A peak). Relaxed: {_relaxed(chosen, requirement)}. "
        f"{_without_limit(unrestricted)}"
    )


def _relaxed(chosen, requirement):
    parts = (
        _relaxation("base speed", chosen.base_speed / RPM, requirement.base_speed / RPM, "rpm"),
        _relaxation("power at base speed", chosen.power_at_base_speed, requirement.power, "W"),
    )
    return " and ".join(filter(None, parts))


def _relaxation(what, reached, required, unit):
    if reached >= required:
        return ""
    return f"{what} from {required:.0f} to {reached:.0f} {unit} ({reached / required:.0%} of the requirement)"


def _without_limit(unrestricted):
    if unrestricted is None:
        return "No winding of this machine meets the requirement at any current: its length or voltage has to grow."
    return (
        f"{_name(unrestricted)} would meet it, with {unrestricted.current_rms:.1f} A RMS "
        f"({unrestricted.current_peak:.1f} A peak)."
    )


def _torque_remark(chosen, requirement):
    if chosen.peak_torque >= requirement.torque:
        return ""
    missing = requirement.torque - chosen.peak_torque
    return (
        f"Its peak torque of {chosen.peak_torque:.3f} Nm is {missing:.3f} Nm ({missing / requirement.torque:.1%}) "
        "below the peak force requirement."
    )


def _packing_remark(chosen, limits):
    if chosen.packing <= limits.packing_limit:
        return ""
    return (
        f"Its packing factor {chosen.packing:.4f} exceeds the limit {limits.packing_limit:g} by "
        f"{chosen.packing / limits.packing_limit - 1:.2%}, inside the accepted {limits.packing_tolerance:.2%}."
    )


def _name(winding):
    wires = "wire" if winding.strands == 1 else "wires"
    turns = "turn" if winding.turns == 1 else "turns"
    return f"{winding.turns} {turns} of {winding.strands} {wires} in hand"
