"""Turns and wires in hand: every pair that fits the slot, what each would do, and which one to wind.

A given ampere-turn count in a given cross-section makes the same field whatever the turns; more turns only trade
current against voltage. So one machine in dq, of one turn and one metre, values every winding: saturation is in every
number where that machine is a flux map.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, isfinite, pi, sqrt

import numpy as np

from electrical.dq import DqMachine, DriveLimits, corner_speed, maximum_power, mtpa_currents
from electrical.resistance import phase_resistance
from electrical.synchronous_machine import SynchronousMachine
from units import RPM

_WEAKENING = 0.25  # negative d-axis current over the q-axis current, at which the loaded inductance L_d is read
_SAME_CURRENT = 1e-9  # relative; a current this close above its limit meets it


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

    dq: of one turn and one metre: currents are peak ampere-turns of one coil [A], flux linkages of one phase with one
        turn in every coil [Wb/m]; its resistance does not count
    coils_in_series: coils of one phase, N_c
    coil_side_area: A_s, the section one coil side may fill [m^2]
    active_length, end_turn_length: [m]
    """

    dq: DqMachine
    coils_in_series: int
    coil_side_area: float
    active_length: float
    end_turn_length: float

    def __post_init__(self) -> None:
        for name in ("coils_in_series", "coil_side_area", "active_length", "end_turn_length"):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise WindingError(f"{name} must be a positive number; found {value}")


@dataclass(frozen=True)
class WindingLimits:
    """What workshop, bus, bearings and power electronics allow.

    packing_limit: gross packing factor k_cp aimed at, relative, copper over half-slot area
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

    def __post_init__(self) -> None:
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
    """What the wound machine must reach: base_speed [rad/s, mechanical], power [W], peak torque [Nm]."""

    base_speed: float
    power: float
    torque: float


@dataclass(frozen=True)
class Winding:
    """One pair of turns and wires in hand, valued at the overload current density."""

    turns: int  # N_t of one coil
    strands: int  # N_h, wires in hand
    fullest: bool  # N_h is the largest that fits with this N_t
    packing: float  # copper over the area of the coil side
    current_rms: float  # [A], phase
    current_peak: float  # [A], phase
    phase_resistance: float  # ohm
    inductance_d: float  # H, phase, apparent with the overload current on the q axis and a quarter of it against d
    inductance_q: float  # H, phase, apparent at the overload current on the q axis
    torque_constant: float  # [Nm/A], per peak ampere at the overload current on the q axis
    no_load_torque_constant: float  # [Nm/A], per peak ampere at vanishing current
    peak_torque: float  # Nm, MTPA at the overload current, mean over one electrical period
    base_speed: float  # mechanical [rad/s]; 0 where the resistance alone uses up the voltage
    power_at_base_speed: float  # [W]
    maximum_power: float | None = None  # W, ideal field weakening up to the maximum speed; None: not asked for
    speed_at_maximum_power: float | None = None  # mechanical [rad/s]

    @property
    def phase_to_phase_resistance(self) -> float:
        """Two phases in series [ohm]."""
        return 2 * self.phase_resistance

    @property
    def phase_to_phase_inductance(self) -> float:
        """Two phases in series, mean over the rotor angle, L_d + L_q [H]."""
        return self.inductance_d + self.inductance_q

    def constant_parameters(self, pole_pairs: int) -> SynchronousMachine:
        """The machine with this winding as constant parameters, its flux that of the overload current."""
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


def feasible_pairs(coil_side_area: float, wire: Wire, limits: WindingLimits) -> tuple[tuple[int, int], ...]:
    """Every (N_t, N_h) with N_t N_h A_w / A_s <= the largest packing (3.119), by turns, then by wires.

    Raises WindingError when not even one wire fits.
    """
    wires = int(limits.largest_packing * coil_side_area / wire.area * (1 + 1e-12))
    if wires < 1:
        raise WindingError(
            f"one wire of {wire.area:.4g} m^2 does not fit: packing {limits.largest_packing:.4g} of "
            f"{coil_side_area:.4g} m^2; take a thinner wire (winding_selection.wire_diameter_mm)"
        )
    return tuple((turns, strands) for turns in range(1, wires + 1) for strands in range(1, wires // turns + 1))


def evaluate_windings(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, pairs: tuple[tuple[int, int], ...]
) -> tuple[Winding, ...]:
    """Values each (N_t, N_h) pair at the overload current density, without its maximum power.

    I_peak = sqrt(2) J A_w N_h (3.77); the machine of one turn and one metre sees N_t I_peak, V / (N_t l) and
    R / (N_t^2 l), with R from eq. 3.82 and V = V_DC / sqrt(3); torque times l.
    Raises a ValueError when a pair has more ampere-turns than the machine is described for.
    """
    turns, strands = np.array(pairs, dtype=float).T
    columns = _columns(machine, _scaled(machine, wire, limits, turns, strands), wire, limits, turns, strands)
    fullest = {pair_turns: max(n for t, n in pairs if t == pair_turns) for pair_turns in dict(pairs)}
    return tuple(
        Winding(turns=t, strands=n, fullest=fullest[t] == n, **{name: float(c[k]) for name, c in columns.items()})
        for k, (t, n) in enumerate(pairs)
    )


def with_maximum_power(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, windings: tuple[Winding, ...]
) -> tuple[Winding, ...]:
    """The same windings with their maximum power up to the maximum speed."""
    turns, strands = (np.array([[getattr(one, name)] for one in windings], float) for name in ("turns", "strands"))
    scaled = _scaled(machine, wire, limits, turns, strands)
    best = maximum_power(scaled.family, scaled.drive, limits.maximum_speed)
    return tuple(
        replace(one, maximum_power=float(power) * machine.active_length, speed_at_maximum_power=float(speed))
        for one, power, speed in zip(windings, best.power, best.speed, strict=True)
    )


def select_winding(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, requirement: WindingRequirement
) -> WindingChoice:
    """Chooses turns and wires in hand among the fullest slots.

    1. For every N_t only the largest N_h that fits competes: copper left out is torque left out.
    2. Of those that meet base speed and power within the current limit, the one with the lowest current, which is that
       of the fewest wires; of equals the one with the most copper.
    3. Where none does, the one with the largest base speed within the current limit; the reason says what is relaxed.

    Raises WindingError when no pair fits the slot or none stays within the current limit.
    Source: thesis, "Electric machine windings definition", eqs 3.119-3.120, where the choice was by trial.
    """
    table = evaluate_windings(machine, wire, limits, feasible_pairs(machine.coil_side_area, wire, limits))
    fullest = tuple(winding for winding in table if winding.fullest)
    unrestricted = _lowest_current(fullest, requirement)
    chosen = choose_among(fullest, limits, requirement)
    reason = _reason(chosen, unrestricted, limits, requirement)
    return WindingChoice(chosen, reason, unrestricted, fullest, table)


def choose_among(windings: tuple[Winding, ...], limits: WindingLimits, requirement: WindingRequirement) -> Winding:
    """Rules 2 and 3 of ``select_winding``. Raises WindingError when no winding stays within the current limit."""
    affordable = _affordable(windings, limits)
    return _lowest_current(affordable, requirement) or max(affordable, key=lambda winding: winding.base_speed)


@dataclass(frozen=True, eq=False)
class _Scaled:
    """Windings in the coordinates of one turn and one metre: a family of machines with its limits, and R [ohm]."""

    family: DqMachine
    drive: DriveLimits
    resistance: np.ndarray


def _scaled(
    machine: PerTurnMachine, wire: Wire, limits: WindingLimits, turns: np.ndarray, strands: np.ndarray
) -> _Scaled:
    resistance = phase_resistance(
        turns=turns,
        strands=strands,
        wire_area=wire.area,
        active_length=machine.active_length,
        end_turn_length=machine.end_turn_length,
        coils_in_series=machine.coils_in_series,
        resistivity=wire.resistivity,
    )
    current = sqrt(2) * limits.overload_current_density * wire.area * strands
    drive = DriveLimits.from_dc_bus(turns * current, limits.dc_voltage / (turns * machine.active_length))
    family = machine.dq.with_resistance(resistance / (turns**2 * machine.active_length))
    return _Scaled(family, drive, resistance)


def _columns(
    machine: PerTurnMachine, scaled: _Scaled, wire: Wire, limits: WindingLimits, turns: np.ndarray, strands: np.ndarray
) -> dict[str, np.ndarray]:
    """The fields of ``Winding`` that are numbers, each an array over the pairs."""
    family, length, ampere_turns = scaled.family, machine.active_length, scaled.drive.current_peak
    best = mtpa_currents(family, ampere_turns)
    torque, base = length * family.torque(*best), corner_speed(family, scaled.drive, *best)
    psi_d, psi_q = family.flux_linkage(np.zeros_like(ampere_turns), ampere_turns)
    weakened = family.flux_linkage(-_WEAKENING * ampere_turns, ampere_turns)[0]
    no_load = family.flux_linkage(0.0, 0.0)[0]
    constant, inductance = 1.5 * family.pole_pairs * turns * length, turns**2 * length / ampere_turns
    current = ampere_turns / turns
    return {
        "packing": turns * strands * wire.area / machine.coil_side_area,
        "current_rms": current / sqrt(2),
        "current_peak": current,
        "phase_resistance": scaled.resistance,
        "inductance_d": (psi_d - weakened) / _WEAKENING * inductance,
        "inductance_q": psi_q * inductance,
        "torque_constant": constant * psi_d,
        "no_load_torque_constant": constant * no_load,
        "peak_torque": torque,
        "base_speed": base,
        "power_at_base_speed": torque * base,
    }


def _affordable(windings: tuple[Winding, ...], limits: WindingLimits) -> tuple[Winding, ...]:
    """Windings within the current limit, a hair of rounding apart."""
    affordable = tuple(w for w in windings if w.current_rms <= limits.phase_current_rms * (1 + _SAME_CURRENT))
    if not affordable:
        smallest = min(winding.current_rms for winding in windings)
        raise WindingError(
            f"every winding needs more than {limits.phase_current_rms:.4g} A RMS; the smallest is {smallest:.4g} A "
            "with the slot as full as it gets: raise the current limit (winding_selection.phase_current_max_rms_A) or "
            "take a thinner wire (winding_selection.wire_diameter_mm)"
        )
    return affordable


def _lowest_current(windings: tuple[Winding, ...], requirement: WindingRequirement) -> Winding | None:
    """Lowest current among those that meet the requirement, of equals the fullest slot: its length will be shortest."""
    meeting = [winding for winding in windings if winding.satisfies(requirement)]
    return min(meeting, key=lambda winding: (winding.strands, -winding.packing), default=None)


def _reason(
    chosen: Winding, unrestricted: Winding | None, limits: WindingLimits, requirement: WindingRequirement
) -> str:
    if chosen.satisfies(requirement):
        text = _reason_met(chosen, limits, requirement)
    else:
        text = _reason_relaxed(chosen, unrestricted, limits, requirement)
    return " ".join(filter(None, (text, _torque_remark(chosen, requirement), _packing_remark(chosen, limits))))


def _reason_met(chosen: Winding, limits: WindingLimits, requirement: WindingRequirement) -> str:
    within = "" if limits.phase_current_rms == inf else f" and within the limit of {limits.phase_current_rms:.1f} A RMS"
    return (
        f"{_name(chosen)}: lowest current of all full slots that meet the requirement, {chosen.current_rms:.1f} A RMS "
        f"({chosen.current_peak:.1f} A peak){within}; base speed {chosen.base_speed / RPM:.0f} rpm against "
        f"{requirement.base_speed / RPM:.0f} rpm required, power at base speed {chosen.power_at_base_speed:.0f} W "
        f"against {requirement.power:.0f} W."
    )


def _reason_relaxed(
    chosen: Winding, unrestricted: Winding | None, limits: WindingLimits, requirement: WindingRequirement
) -> str:
    limit = "" if limits.phase_current_rms == inf else f" within {limits.phase_current_rms:.1f} A RMS of phase current"
    return (
        f"{_name(chosen)}: no full slot meets the requirement{limit}, so the largest base speed there is taken, at "
        f"{chosen.current_rms:.1f} A RMS ({chosen.current_peak:.1f} A peak). Relaxed: {_relaxed(chosen, requirement)}. "
        f"{_without_limit(unrestricted)}"
    )


def _relaxed(chosen: Winding, requirement: WindingRequirement) -> str:
    parts = (
        _relaxation("base speed", chosen.base_speed / RPM, requirement.base_speed / RPM, "rpm"),
        _relaxation("power at base speed", chosen.power_at_base_speed, requirement.power, "W"),
    )
    return " and ".join(filter(None, parts))


def _relaxation(what: str, reached: float, required: float, unit: str) -> str:
    if reached >= required:
        return ""
    return f"{what} from {required:.0f} to {reached:.0f} {unit} ({reached / required:.0%} of the requirement)"


def _without_limit(unrestricted: Winding | None) -> str:
    if unrestricted is None:
        return "No winding of this machine meets the requirement at any current: its length or voltage has to grow."
    return (
        f"{_name(unrestricted)} would meet it, with {unrestricted.current_rms:.1f} A RMS "
        f"({unrestricted.current_peak:.1f} A peak)."
    )


def _torque_remark(chosen: Winding, requirement: WindingRequirement) -> str:
    if chosen.peak_torque >= requirement.torque:
        return ""
    missing = requirement.torque - chosen.peak_torque
    return (
        f"Its peak torque of {chosen.peak_torque:.3f} Nm is {missing:.3f} Nm ({missing / requirement.torque:.1%}) "
        "below the peak force requirement."
    )


def _packing_remark(chosen: Winding, limits: WindingLimits) -> str:
    if chosen.packing <= limits.packing_limit:
        return ""
    return (
        f"Its packing factor {chosen.packing:.4f} exceeds the limit {limits.packing_limit:g} by "
        f"{chosen.packing / limits.packing_limit - 1:.2%}, inside the accepted {limits.packing_tolerance:.2%}."
    )


def _name(winding: Winding) -> str:
    wires = "wire" if winding.strands == 1 else "wires"
    turns = "turn" if winding.turns == 1 else "turns"
    return f"{winding.turns} {turns} of {winding.strands} {wires} in hand"
