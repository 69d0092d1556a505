"""Rotor, shafts and bearings of the designed machine, each load against what it may be, with its margin.

Planets at equal distances push sun and carrier from all sides alike, so that gears load the rotor's bearings by no
radial force; what a direct load adds at the end of the shaft is not known here.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi, prod

import numpy as np

from gearbox.stage import GearboxOutcome
from geometry.machine import Machine
from magnetostatics.gap_stress_stage import GapStress
from materials.strength import (
    ENDURED_SHARE,
    ENDURED_SHARE_CASE_HARDENED,
    STEEL_POISSON_RATIO,
    STEEL_YOUNGS_MODULUS,
    StrengthBySection,
)
from mechanics.bearings import Bearing
from mechanics.checks import LoadCheck
from mechanics.fatigue import (
    FatigueStrength,
    LoadCycles,
    cycles_from_rest,
    recorded_cycles,
    reversed_cycles,
    together,
)
from mechanics.retention import MagnetRing, Retention
from mechanics.rotating_ring import RotatingRing
from mechanics.shaft import BentShaft, equivalent_stress, torsion_stress
from units import GRAVITY

_THICKER_SHAFT = "more machine.shaft_radius_mm"
_SHORTER_SHAFT = "more machine.shaft_radius_mm, or less assembly.bearing_seat_mm"
_SLOWER_ROTOR = "a slower rotor (less match.speed_max_rad_per_s), or a steel of more mechanics.lamination_yield_MPa"
_LARGER_SUN = "a larger sun by more match.gearbox_stages, or a steel of more mechanics.sun_yield_MPa"
_TOUGHER_SUN = "a larger sun by more match.gearbox_stages, or a steel of more mechanics.sun_tensile_MPa"
_TOUGHER_ROTOR = "a slower rotor (less match.speed_max_rad_per_s), or a steel of more mechanics.lamination_tensile_MPa"
_LARGER_BEARING = "more mechanics.bearing_capacity_kN"


@dataclass(frozen=True)
class FatigueInputs:
    """What fatigue is rated by.

    shaft, sun: tensile strength of rotor shaft and sun gears; lamination: of the electrical steel [Pa]
    notch: factor of notch, surface and size; safety: on amplitudes; both dimensionless
    life: operating time [s]; peaks: how often the peak torque comes and goes in it where no history tells
    """

    shaft: StrengthBySection
    sun: StrengthBySection
    lamination: float
    notch: float
    safety: float
    life: float
    peaks: float

    def strength(self, tensile: float, share: float) -> FatigueStrength:
        """Of a part with this tensile strength [Pa] and share of it that is endured, dimensionless."""
        return FatigueStrength(tensile, share, self.notch)


@dataclass(frozen=True)
class MechanicsInputs:
    """What a study says about the strength of its rotor.

    overspeed: over the largest speed of the rotor, dimensionless; retention: of the magnets
    lamination_yield [Pa]; shaft_steel, sun_steel: of rotor shaft and sun gears
    yield_safety: of all yield strengths, dimensionless; critical_speed_factor: least first critical speed over the
        largest speed, dimensionless
    eccentricity: of the rotor in the bore, share of the air gap; bearing: None where its data are not stated
    """

    overspeed: float
    retention: Retention
    lamination_yield: float
    shaft_steel: StrengthBySection
    sun_steel: StrengthBySection
    yield_safety: float
    critical_speed_factor: float
    eccentricity: float
    bearing: Bearing | None
    fatigue: FatigueInputs


@dataclass(frozen=True, eq=False)
class RotorDuty:
    """The rotor as it is built, and what it must do.

    active_length, bearing_span: between the middles of the bearings [m]; mass: of the rotor with its shaft [kg]
    lamination_density, magnet_density [kg/m^3]; stacking: steel over stack length, dimensionless
    speed_max, speed_rms: of the rotor [rad/s]; peak_torque: of the machine [Nm]
    torque [Nm] (n,), speed [rad/s] (n,): of the rotor in service, each for the same time step [s], 0 where no history
        is known
    """

    machine: Machine
    active_length: float
    bearing_span: float
    mass: float
    lamination_density: float
    magnet_density: float
    stacking: float
    speed_max: float
    speed_rms: float
    peak_torque: float
    torque: np.ndarray
    speed: np.ndarray
    step: float

    @property
    def is_recorded(self) -> bool:
        """Whether a history is known."""
        return self.step > 0


@dataclass(frozen=True)
class MechanicsOutcome:
    """How the rotor stands against what acts on it.

    overspeed [rad/s]; magnet_pull: centrifugal, of one magnet [N]
    shaft: with the magnetic stiffness of the whole machine; eccentricity [m]; deflection: of the shaft [m]
    steady_load: weight, and the pull on a rotor in the middle [N]; bearing_load: of either bearing, radial [N]
    bearing_life: L_10 [s], None where no bearing is stated
    recorded: whether fatigue is that of a history, else of so many peaks; life: operating time [s]
    """

    checks: tuple[LoadCheck, ...]
    overspeed: float
    magnet_pull: float
    shaft: BentShaft
    eccentricity: float
    steady_load: float
    deflection: float
    bearing_load: float
    bearing_life: float | None
    recorded: bool
    peaks: float
    life: float


def mechanics_stage(
    stress: GapStress, gears: GearboxOutcome, duty: RotorDuty, inputs: MechanicsInputs
) -> MechanicsOutcome:
    """Check magnets, laminations, shafts, critical speed and bearings.

    The magnetic stiffness is that of the field solution, the larger of no current and overload: saturation, curvature
    and the harmonics of the field are in it, which ``classical_pull`` lacks (12 % less at 12 slots and 10 poles).
    Raises MaterialError where a shaft is thicker than the table of its steel.
    """
    magnets = MagnetRing(
        duty.machine, duty.magnet_density, duty.active_length, inputs.overspeed * duty.speed_max, duty.peak_torque
    )
    shaft = _shaft(stress, duty)
    eccentricity = inputs.eccentricity * duty.machine.airgap
    load = duty.mass * GRAVITY + duty.active_length * float(stress.centred_pull.max())
    bearing_load = shaft.bearing_load(load, eccentricity)
    bending = shaft.bending_stress(load, eccentricity)
    life = inputs.bearing.rating_life(bearing_load, duty.speed_rms) if inputs.bearing else None
    checks = (
        *inputs.retention.checks(magnets),
        _rotor_check(magnets, duty, inputs),
        _shaft_check(bending, duty, inputs),
        *_sun_checks(gears, duty, inputs),
        _critical_speed_check(shaft, duty, inputs),
        *_bearing_check(inputs.bearing, life),
        *_fatigue_checks(gears, duty, inputs, magnets, bending),
    )
    return MechanicsOutcome(
        checks=checks,
        overspeed=magnets.speed,
        magnet_pull=magnets.pull,
        shaft=shaft,
        eccentricity=eccentricity,
        steady_load=load,
        deflection=shaft.deflection(load, eccentricity),
        bearing_load=bearing_load,
        bearing_life=life,
        recorded=duty.is_recorded,
        peaks=inputs.fatigue.peaks,
        life=inputs.fatigue.life,
    )


def _shaft(stress: GapStress, duty: RotorDuty) -> BentShaft:
    return BentShaft(
        diameter=2 * duty.machine.shaft_radius,
        span=duty.bearing_span,
        youngs_modulus=STEEL_YOUNGS_MODULUS,
        rotor_mass=duty.mass,
        magnetic_stiffness=duty.active_length * float(stress.pull_per_shift.max()),
    )


def _rotor_check(magnets: MagnetRing, duty: RotorDuty, inputs: MechanicsInputs) -> LoadCheck:
    """The laminations at their bore; insulation between the sheets carries none of the magnets' pull."""
    part, stress = "laminations of the rotor, at the bore", _bore_stress(magnets, duty, inputs)
    return LoadCheck(part, inputs.yield_safety, stress, inputs.lamination_yield, "MPa", _SLOWER_ROTOR)


def _bore_stress(magnets: MagnetRing, duty: RotorDuty, inputs: MechanicsInputs) -> float:
    """Of the laminations at the speed of the magnets [Pa]."""
    return RotatingRing(
        inner=duty.machine.shaft_radius,
        outer=duty.machine.rotor_core_radius,
        density=duty.lamination_density,
        poisson_ratio=STEEL_POISSON_RATIO,
        speed=magnets.speed,
        rim_pull=inputs.retention.rim_pull(magnets) / duty.stacking,
    ).largest_stress


def _shaft_check(bending: float, duty: RotorDuty, inputs: MechanicsInputs) -> LoadCheck:
    """Under the peak torque and bent by weight and magnetic pull."""
    diameter = 2 * duty.machine.shaft_radius
    stress = equivalent_stress(bending, torsion_stress(duty.peak_torque, diameter))
    strength = inputs.shaft_steel.at(diameter)
    return LoadCheck("rotor shaft", inputs.yield_safety, stress, strength, "MPa", _THICKER_SHAFT)


def _critical_speed_check(shaft: BentShaft, duty: RotorDuty, inputs: MechanicsInputs) -> LoadCheck:
    factor, speed = inputs.critical_speed_factor, shaft.critical_speed
    return LoadCheck("first critical speed", factor, duty.speed_max, speed, "rpm", _SHORTER_SHAFT)


def _sun_checks(gears: GearboxOutcome, duty: RotorDuty, inputs: MechanicsInputs) -> Iterator[LoadCheck]:
    """Where a sun leaves its teeth for its shaft, solid up to the root circle, under the peak torque of the machine.

    The sun of a slower stage turns with the carrier before it and has its torque; lossless, without notch.
    """
    for number, faster, diameter in _suns(gears):
        stress = equivalent_stress(0.0, torsion_stress(duty.peak_torque * faster, diameter))
        part = f"sun of stage {number}, at its root circle"
        yield LoadCheck(part, inputs.yield_safety, stress, inputs.sun_steel.at(diameter), "MPa", _LARGER_SUN)


def _suns(gears: GearboxOutcome) -> Iterator[tuple[int, float, float]]:
    """Number of the stage, torque over that of the machine and root circle [m] of every sun."""
    stages = gears.train.stages
    for number, stage in enumerate(stages):
        faster = prod(float(other.gears.ratio) for other in stages[number + 1 :])
        yield number + 1, faster, 2 * float(stage.gears.sun.root_radius)


def _bearing_check(bearing: Bearing | None, life: float | None) -> Iterator[LoadCheck]:
    """None where no bearing, or no life, is stated."""
    if bearing is not None and bearing.life is not None and life is not None:
        yield LoadCheck("life of the bearings", 1.0, bearing.life, life, "h", _LARGER_BEARING)


# ---- fatigue --------------------------------------------------------------------------------------------------------


def _fatigue_checks(
    gears: GearboxOutcome, duty: RotorDuty, inputs: MechanicsInputs, magnets: MagnetRing, bending: float
) -> Iterator[LoadCheck]:
    """Shaft, suns and laminations over the life; bending: stress of the shaft, reversed with every turn [Pa].

    Teeth are rated with the gears, by ISO 6336 over the spectrum of the same loads.
    """
    fatigue, torque = inputs.fatigue, torque_cycles(duty, inputs.fatigue)
    shaft = fatigue.strength(fatigue.shaft.at(2 * duty.machine.shaft_radius), ENDURED_SHARE)
    yield _tired("rotor shaft", shaft, _shaft_cycles(torque, duty, fatigue, bending), fatigue, _THICKER_SHAFT)
    for number, faster, diameter in _suns(gears):
        sun, stress = fatigue.strength(fatigue.sun.at(diameter), ENDURED_SHARE_CASE_HARDENED), _twist(diameter) * faster
        yield _tired(f"sun of stage {number}", sun, torque.times(stress), fatigue, _TOUGHER_SUN)
    sheet = fatigue.strength(fatigue.lamination, ENDURED_SHARE)
    stress = _bore_stress(magnets, duty, inputs) / magnets.speed**2
    yield _tired(
        "laminations of the rotor", sheet, square_speed_cycles(duty, fatigue).times(stress), fatigue, _TOUGHER_ROTOR
    )


def _tired(part: str, strength: FatigueStrength, stress: LoadCycles, fatigue: FatigueInputs, helps: str) -> LoadCheck:
    """The amplitude that does as much as all cycles against what is endured."""
    return LoadCheck(f"{part}, fatigue", fatigue.safety, strength.acting(stress), strength.endured, "MPa", helps)


def _twist(diameter: float) -> float:
    """Equivalent stress of a torque [Pa/Nm]; diameter [m]."""
    return equivalent_stress(0.0, torsion_stress(1.0, diameter))


def torque_cycles(duty: RotorDuty, fatigue: FatigueInputs) -> LoadCycles:
    """Of the rotor's torque [Nm] over the life: those of its history, else the peak torque, there and back."""
    if duty.is_recorded:
        return recorded_cycles(duty.torque, duty.step, fatigue.life)
    return reversed_cycles(duty.peak_torque, fatigue.peaks)


def square_speed_cycles(duty: RotorDuty, fatigue: FatigueInputs) -> LoadCycles:
    """Of the rotor's squared speed [rad^2/s^2], which the centrifugal stress goes with."""
    if duty.is_recorded:
        return recorded_cycles(duty.speed**2, duty.step, fatigue.life)
    return cycles_from_rest(duty.speed_max**2, fatigue.peaks)


def _shaft_cycles(torque: LoadCycles, duty: RotorDuty, fatigue: FatigueInputs, bending: float) -> LoadCycles:
    """Equivalent stress [Pa]: every cycle of the torque with the bending, and every turn under the mean torque."""
    twist = _twist(2 * duty.machine.shaft_radius)
    turning = reversed_cycles(bending, fatigue.life * duty.speed_rms / (2 * pi))
    mean = twist * float(np.sqrt(np.mean(duty.torque**2)))
    return together((torque.times(twist).with_amplitude(bending), replace(turning, mean=np.array([mean]))))
