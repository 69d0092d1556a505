"""Turns, wires in hand, gauge, parallel paths, star or delta: every full slot, what each would do, and which to wind.

A given ampere-turn count in a given cross-section makes the same field whatever the turns; more turns only trade
current against voltage. So one machine in dq, of one turn and one metre, values every winding: saturation is in every
number where that machine is a flux map. Paths and delta count through the turns of the equivalent star
(``electrical.winding_connection``); currents are of a line, resistances and inductances of a phase of that star.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from math import inf, isfinite, pi, sqrt

import numpy as np

from electrical.circulating import ZeroSequence
from electrical.dq import (
    DqMachine,
    DriveLimits,
    Values,
    corner_speed,
    maximum_power,
    mtpa_currents,
    torque_speed_envelope,
)
from electrical.final_length import FinalLength
from electrical.resistance import phase_resistance
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_connection import WindingConnection
from electrical.winding_design import WindingDesign
from electrical.wire import Wire
from units import percent

WEAKENING = 0.25  # negative d-axis current over the q-axis current, at which the loaded inductance L_d is read
_SAME_CURRENT = 1e-9  # relative; currents this close are one, and one this close above its limit meets it
HEXAGONAL = pi / sqrt(12.0)  # share of an area that round wires fill at most
# Relative; lengths this close compete by their current. Estimate: what one wire of a coil with few of them makes.
AS_SHORT = 0.05


class WindingError(ValueError):
    """No winding can be chosen from these inputs; the message says which number to change."""


@dataclass(frozen=True)
class PerTurnMachine:
    """A machine of known cross-section before its winding and its length are chosen.

    dq: of one turn and one metre: currents are peak ampere-turns of one coil [A], flux linkages of one phase with one
        turn in every coil, all in series [Wb/m]; its resistance does not count
    coils_in_series: coils of one phase, N_c
    coil_side_area: A_s, the section one coil side may fill [m^2]
    end_turn_length: [m]
    """

    dq: DqMachine
    coils_in_series: int
    coil_side_area: float
    end_turn_length: float

    def __post_init__(self) -> None:
        for name in ("coils_in_series", "coil_side_area", "end_turn_length"):
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
    insulated_fill: largest share of a coil side that the wires fill with their enamel, dimensionless
    circulating_share: largest loss by the current round a delta over the copper loss, dimensionless
    phase_current_rms: largest RMS line current of the power electronics [A]; ``math.inf`` for none. A peak value is
        divided by sqrt(2) by the caller.
    """

    packing_limit: float
    packing_tolerance: float
    overload_current_density: float
    dc_voltage: float
    maximum_speed: float
    insulated_fill: float
    circulating_share: float
    phase_current_rms: float = inf

    def __post_init__(self) -> None:
        if not 0 < self.packing_limit < pi / 4:
            raise WindingError(
                f"the packing limit must lie between 0 and pi/4 (round wires in a square grid); "
                f"found {self.packing_limit}"
            )
        if not 0 <= self.packing_tolerance < 1:
            raise WindingError(f"the packing tolerance must lie between 0 and 1; found {self.packing_tolerance}")
        if not 0 < self.insulated_fill < HEXAGONAL:
            raise WindingError(
                f"the limit of the insulated fill must lie between 0 and {HEXAGONAL:.3f} (round wires in a hexagonal "
                f"grid); found {self.insulated_fill}"
            )
        if not self.circulating_share >= 0:
            raise WindingError(
                f"the share of the circulating loss must be zero or more; found {self.circulating_share}"
            )
        if not self.phase_current_rms > 0:
            raise WindingError(f"the phase current limit must be positive; found {self.phase_current_rms}")

    @property
    def largest_packing(self) -> float:
        """Packing factor up to which a winding counts as feasible."""
        return self.packing_limit * (1 + self.packing_tolerance)

    def ampere_turns(self, copper: Values, turns: Values) -> Values:
        """Peak of one coil that a winding is valued at [A], sqrt(2) J A (3.77).

        copper: section of a coil side [m^2]; turns: of the equivalent star
        """
        return self.density_ampere_turns(copper)

    def density_ampere_turns(self, copper: Values) -> Values:
        """Peak of one coil that the current density allows [A]; copper: section of a coil side [m^2]."""
        return sqrt(2) * self.overload_current_density * copper


@dataclass(frozen=True)
class LimitsWithDrive(WindingLimits):
    """The same where the drive is given too: a winding that could carry more than its line current carries that."""

    def ampere_turns(self, copper: Values, turns: Values) -> Values:
        """Peak of one coil [A], that of the current density or of the line current, whichever is less.

        copper: section of a coil side [m^2]; turns: of the equivalent star
        """
        return np.minimum(self.density_ampere_turns(copper), sqrt(2) * self.phase_current_rms * turns)


@dataclass(frozen=True)
class WindingRequirement:
    """What the wound machine must reach: base_speed [rad/s, mechanical], power [W], peak torque [Nm]."""

    base_speed: float
    power: float
    torque: float


@dataclass(frozen=True)
class Winding:
    """One design at its active length, valued at the overload current density; phases: of the equivalent star."""

    design: WindingDesign
    active_length: float  # m
    needed_length: float  # m, neither rounded up nor cut to the longest that is allowed
    packing: float  # copper over the area of the coil side
    insulated_fill: float  # wires with their enamel over the area of the coil side, dimensionless
    current_rms: float  # [A], line
    current_peak: float  # [A], line
    phase_resistance: float  # ohm
    inductance_d: float  # H, phase, apparent with the overload current on the q axis and a quarter of it against d,
    # along d where a map has no other side
    inductance_q: float  # H, phase, apparent at the overload current on the q axis
    torque_constant: float  # [Nm/A], per peak ampere at the overload current on the q axis
    no_load_torque_constant: float  # [Nm/A], per peak ampere at vanishing current
    peak_torque: float  # Nm, MTPA at the overload current, mean over one electrical period
    base_speed: float  # mechanical [rad/s]; 0 where the resistance alone uses up the voltage
    power_at_base_speed: float  # [W]
    circulating_share: float = 0.0  # loss by the current round a delta over the copper loss; none in a star
    maximum_power: float | None = None  # W, ideal field weakening up to the maximum speed; None: not asked for
    speed_at_maximum_power: float | None = None  # mechanical [rad/s]

    @property
    def turns(self) -> float:
        """Of one coil, N_t."""
        return self.design.turns

    @property
    def strands(self) -> int:
        """Wires in hand, N_h."""
        return self.design.strands

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
    """The winding to make, and everything it was chosen from.

    chosen: to be made; unrestricted: what would be without the current limit, None where nothing meets the requirement
    table: every design with a full slot; best: of each gauge and connection the one that would be made
    """

    chosen: Winding
    unrestricted: Winding | None
    table: tuple[Winding, ...]
    best: tuple[Winding, ...]


def full_designs(
    coil_side_area: float,
    wires: tuple[Wire, ...],
    connections: tuple[WindingConnection, ...],
    limits: WindingLimits,
) -> tuple[WindingDesign, ...]:
    """For each wire, connection and number of turns the most wires in hand that fit: copper left out is torque lost.

    coil_side_area: A_s [m^2]
    N_t N_h A_w / A_s <= the largest packing (3.119), and the wires with their enamel stay within their share of A_s.
    Raises WindingError when not even one wire of any gauge fits.
    """
    fitting = {wire: _wires_that_fit(coil_side_area, wire, limits) for wire in wires}
    if not any(fitting.values()):
        thinnest = min(wires, key=lambda wire: wire.area)
        raise WindingError(
            f"one wire of {thinnest.area:.4g} m^2 does not fit: packing {limits.largest_packing:.4g}, with enamel "
            f"{limits.insulated_fill:.4g} of {coil_side_area:.4g} m^2; take a thinner wire "
            "(winding_selection.wire_diameters_mm)"
        )
    return tuple(
        WindingDesign(turns, count // turns, wire, connection)
        for (wire, count), connection in product(fitting.items(), connections)
        for turns in range(1, count + 1)
    )


def _wires_that_fit(coil_side_area: float, wire: Wire, limits: WindingLimits) -> int:
    bare = limits.largest_packing * coil_side_area / wire.area
    insulated = limits.insulated_fill * coil_side_area / (wire.area + wire.enamel_area)
    return int(min(bare, insulated) * (1 + 1e-12))


def evaluate_windings(
    machine: PerTurnMachine,
    limits: WindingLimits,
    designs: tuple[WindingDesign, ...],
    lengths: tuple[FinalLength, ...],
) -> tuple[Winding, ...]:
    """Values each design at its length and the ampere-turns that the limits allow it, without its maximum power and
    without what circulates.

    N I_peak = sqrt(2) J A_w N_h N_t (3.77); the machine of one turn and one metre sees N I_peak, V / (N l) and
    R / (N^2 l), with R from eq. 3.82, V = V_DC / sqrt(3) and N the turns of the equivalent star; torque times l.
    Raises a ValueError when a design has more ampere-turns than the machine is described for.
    """
    columns = _columns(machine, _scaled(machine, limits, designs, np.array([one.length for one in lengths])))
    return tuple(
        Winding(design, needed_length=length.set_by.length, **{name: float(c[k]) for name, c in columns.items()})
        for k, (design, length) in enumerate(zip(designs, lengths, strict=True))
    )


def with_maximum_power(
    machine: PerTurnMachine, limits: WindingLimits, windings: tuple[Winding, ...]
) -> tuple[Winding, ...]:
    """The same windings with their maximum power up to the maximum speed."""
    lengths = np.array([one.active_length for one in windings])
    scaled = _scaled(machine, limits, tuple(one.design for one in windings), lengths, families=1)
    best = maximum_power(scaled.family, scaled.drive, limits.maximum_speed)
    return tuple(
        replace(one, maximum_power=float(power) * one.active_length, speed_at_maximum_power=float(speed))
        for one, power, speed in zip(windings, best.power, best.speed, strict=True)
    )


def torque_at_speed(
    machine: PerTurnMachine,
    limits: WindingLimits,
    windings: tuple[Winding, ...],
    speed: Values,
    share: Values = 1.0,
) -> np.ndarray:
    """Largest torque of each winding [Nm] (n,), the field weakened where it must be; 0 where no current is within the
    voltage.

    speed: mechanical [rad/s], one or (n,); share: of the full current of each, dimensionless, one or (n,)
    """
    lengths = np.array([one.active_length for one in windings])
    scaled = _scaled(machine, limits, tuple(one.design for one in windings), lengths)
    drive = replace(scaled.drive, current_peak=share * scaled.drive.current_peak)
    return lengths * np.nan_to_num(torque_speed_envelope(scaled.family, drive, speed).torque)


def speed_at_current(
    machine: PerTurnMachine, limits: WindingLimits, windings: tuple[Winding, ...], ampere_turns: float
) -> np.ndarray:
    """Mechanical speed up to which each winding carries some ampere-turns at their best angle [rad/s] (n,).

    ampere_turns: of one coil, peak [A]
    """
    lengths = np.array([one.active_length for one in windings])
    scaled = _scaled(machine, limits, tuple(one.design for one in windings), lengths)
    return np.asarray(corner_speed(scaled.family, scaled.drive, *mtpa_currents(machine.dq, ampere_turns)))


def with_circulation(
    machine: PerTurnMachine, zero: ZeroSequence, windings: tuple[Winding, ...], density: Values, speed: float
) -> tuple[Winding, ...]:
    """The same windings with the share that the current round the triangle of each adds to its copper loss: deltas.

    At the best current of a density in the copper, RMS [A/m^2], one or (windings,), and a mechanical speed [rad/s].
    """
    ampere_turns = sqrt(2) * density * np.array([one.design.copper_area for one in windings])
    turns, length, resistance = np.array(
        [(one.design.equivalent_turns, one.active_length, one.phase_resistance) for one in windings]
    ).T
    per_turn, electrical = resistance / (turns**2 * length), machine.dq.pole_pairs * speed
    lost = zero.loss(*mtpa_currents(machine.dq, ampere_turns), electrical, per_turn)
    shares = lost / (1.5 * per_turn * ampere_turns**2)
    return tuple(replace(one, circulating_share=float(share)) for one, share in zip(windings, shares, strict=True))


def select_winding(
    windings: tuple[Winding, ...], limits: WindingLimits, requirement: WindingRequirement
) -> WindingChoice:
    """Chooses among full slots, each valued at the length that it needs.

    1. A delta whose circulating current loses more than its share of the copper loss does not compete.
    2. Of those that meet base speed and power within the current limit, the shortest and those up to ``AS_SHORT``
       longer compete; the lowest line current wins, of equal currents the fullest copper, then fewest paths, star
       before delta, fewest wires.
    3. Where none does, the one within the current limit that has the most power at base speed for its length.

    Raises WindingError when no winding stays within the current limit.
    Source: thesis, "Electric machine windings definition", eqs 3.119-3.120, where the choice was by trial.
    """
    groups: dict[tuple[Wire, WindingConnection], list[Winding]] = {}
    for one in windings:
        groups.setdefault((one.design.wire, one.design.connection), []).append(one)
    return WindingChoice(
        choose_among(windings, limits, requirement),
        _best_that_meets(_without_much_circulation(windings, limits), requirement),
        windings,
        tuple(_best_of_a_kind(group, limits, requirement) for group in groups.values()),
    )


def choose_among(windings: tuple[Winding, ...], limits: WindingLimits, requirement: WindingRequirement) -> Winding:
    """The rules of ``select_winding``. Raises WindingError when no winding stays within the current limit."""
    affordable = _affordable(_without_much_circulation(windings, limits), limits)
    return _best_that_meets(affordable, requirement) or max(affordable, key=_power_for_length)


@dataclass(frozen=True, eq=False)
class _Scaled:
    """Windings in the coordinates of one turn and one metre: a family of machines with its limits.

    designs: of the windings (n,); turns: of the equivalent star (n,); length [m] (n,); resistance [ohm] (n,)
    """

    designs: tuple[WindingDesign, ...]
    turns: np.ndarray
    length: np.ndarray
    resistance: np.ndarray
    family: DqMachine
    drive: DriveLimits


def _scaled(
    machine: PerTurnMachine,
    limits: WindingLimits,
    designs: tuple[WindingDesign, ...],
    length: np.ndarray,
    families: int = 0,
) -> _Scaled:
    """families: further axes of the family, over which a search lays its speeds."""
    shape = (len(designs), *[1] * families)
    turns, copper, resistivity = (
        np.array(values, float).reshape(shape)
        for values in zip(*((one.equivalent_turns, one.copper_area, one.wire.resistivity) for one in designs))
    )
    length = np.asarray(length, float).reshape(shape)
    resistance = phase_resistance(
        turns=turns,
        strands=1,
        wire_area=copper / turns,
        active_length=length,
        end_turn_length=machine.end_turn_length,
        coils_in_series=machine.coils_in_series,
        resistivity=resistivity,
    )
    ampere_turns = limits.ampere_turns(copper, turns)
    drive = DriveLimits.from_dc_bus(ampere_turns, limits.dc_voltage / (turns * length))
    family = machine.dq.with_resistance(resistance / (turns**2 * length))
    return _Scaled(designs, turns, length, resistance, family, drive)


def _columns(machine: PerTurnMachine, scaled: _Scaled) -> dict[str, np.ndarray]:
    """The fields of ``Winding`` that are numbers, each an array over the designs."""
    family, turns, length, ampere_turns = scaled.family, scaled.turns, scaled.length, scaled.drive.current_peak
    best = mtpa_currents(family, ampere_turns)
    torque, base = length * family.torque(*best), corner_speed(family, scaled.drive, *best)
    psi_d, psi_q = family.flux_linkage(np.zeros_like(ampere_turns), ampere_turns)
    aside = np.where(family.direct_range(ampere_turns)[0] < 0, -WEAKENING, WEAKENING)  # a map has one side or both
    weakened = family.flux_linkage(aside * ampere_turns, ampere_turns)[0]
    no_load = family.flux_linkage(0.0, 0.0)[0]
    constant, inductance = 1.5 * family.pole_pairs * turns * length, turns**2 * length / ampere_turns
    current = ampere_turns / turns
    copper, insulated = np.array([(one.copper_area, one.insulated_area) for one in scaled.designs]).T
    return {
        "active_length": length,
        "packing": copper / machine.coil_side_area,
        "insulated_fill": insulated / machine.coil_side_area,
        "current_rms": current / sqrt(2),
        "current_peak": current,
        "phase_resistance": scaled.resistance,
        "inductance_d": (weakened - psi_d) / aside * inductance,
        "inductance_q": psi_q * inductance,
        "torque_constant": constant * psi_d,
        "no_load_torque_constant": constant * no_load,
        "peak_torque": torque,
        "base_speed": base,
        "power_at_base_speed": torque * base,
    }


def _without_much_circulation(windings: tuple[Winding, ...], limits: WindingLimits) -> tuple[Winding, ...]:
    quiet = tuple(one for one in windings if one.circulating_share <= limits.circulating_share)
    if not quiet:
        least = min(one.circulating_share for one in windings)
        raise WindingError(
            f"in every winding the current round the delta loses more than {percent(limits.circulating_share, 1)} of "
            f"the copper loss, {percent(least, 1)} at least: allow star (winding_selection.connections)"
        )
    return quiet


def _affordable(windings: tuple[Winding, ...], limits: WindingLimits) -> tuple[Winding, ...]:
    """Windings within the current limit, a hair of rounding apart."""
    affordable = tuple(w for w in windings if w.current_rms <= limits.phase_current_rms * (1 + _SAME_CURRENT))
    if not affordable:
        smallest = min(winding.current_rms for winding in windings)
        raise WindingError(
            f"every winding needs more than {limits.phase_current_rms:.4g} A RMS; the smallest is {smallest:.4g} A "
            "with the slot as full as it gets: raise the current limit (winding_selection.phase_current_max_rms_A) or "
            "take a thinner wire (winding_selection.wire_diameters_mm)"
        )
    return affordable


def _best_that_meets(windings: tuple[Winding, ...], requirement: WindingRequirement) -> Winding | None:
    """Rule 2 of ``select_winding``."""
    meeting = [winding for winding in windings if winding.satisfies(requirement)]
    shortest = min((winding.needed_length for winding in meeting), default=inf)
    competing = [winding for winding in meeting if winding.needed_length <= shortest * (1 + AS_SHORT)]
    return min(competing, key=_merit, default=None)


def _power_for_length(winding: Winding) -> tuple[float, ...]:
    """The larger, the better, where nothing meets the requirement."""
    return (_rounded(winding.power_at_base_speed / winding.needed_length), *(-value for value in _merit(winding)))


def _merit(winding: Winding) -> tuple[float, ...]:
    return merit(winding.design, winding.current_rms)


def merit(design: WindingDesign, current: float) -> tuple[float, ...]:
    """The smaller, the better: current, then the fullest copper, fewest paths, star before delta, fewest wires.

    current: of a line [A], of whatever measure; two are one where only rounding parts them
    """
    connection = design.connection
    ranks = (-design.copper_area, connection.paths, connection.closing.line_over_phase_current)
    return (_rounded(current), *(_rounded(rank) for rank in ranks), design.strands)


def _rounded(value: float) -> float:
    return float(f"{value:.9g}")


def _best_of_a_kind(windings: list[Winding], limits: WindingLimits, requirement: WindingRequirement) -> Winding:
    """What would be wound of one gauge and connection: what meets the requirement within the limit of the current, else
    the fastest within it, else the one with the lowest current."""
    affordable = tuple(w for w in windings if w.current_rms <= limits.phase_current_rms * (1 + _SAME_CURRENT))
    if not affordable:
        return min(windings, key=_merit)
    return _best_that_meets(affordable, requirement) or max(affordable, key=_power_for_length)
