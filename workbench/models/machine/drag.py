"""What brakes a rotor without current at its terminals: bearings, air, iron, and turns shorted among themselves.

Iron loss by the law of the sheet (``materials.iron_loss``) in two regions of the stator, teeth and yoke, each with one
flux density: that of the surrogate's flux of a tooth, over the width of the steel. The law's time form counts all
harmonics that a tooth sees at no load:

    T = m [k_h p B^alpha/(2 pi) + k_c/(2 pi^2) <B'^2>(1 + k_s B^2) speed + k_e/8.763 <|B'|^1.5> sqrt(speed)]

B: half of peak to peak; B' = dB/d angle; m: mass of the region. Rotor, tooth tips, and that teeth of a faulty machine
are unlike are left out. ``losses`` takes the loci of every element instead, of a design without defects: on the machine
with 12 slots and 10 poles these are within 2 % (hysteresis), 6 % (eddies) and 4 % (excess) of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi

import numpy as np

from effects.base import Columns
from effects.machine_design import MachineAsBuilt
from geometry.machine import Machine
from materials.iron_loss import EXCESS_OF_SINE, LAWS, IronLossLaw
from units import MU_0
from workbench.errors import WorkbenchError
from workbench.models.machine.answers import Answers

USUAL_SHEET = LAWS["M235-35A"]  # 0.35 mm; a factor holds what another grade and its punching make of it
_SAMPLES = 4096  # of the flux density over a revolution


def lost_torque(answers: Answers, at: Columns) -> np.ndarray:
    """Torque on the rotor against its motion [Nm] (n,), zero where neither speed nor direction is known.

    Where only a column ``direction`` is known (+1, -1) the rotor creeps: dry friction and hysteresis alone.
    """
    d, (sign, size) = answers.design, _motion(at)
    level, slope, root = iron_torques(answers)
    level, slope = level + d.dry_friction, slope + d.viscous_friction
    brake = level + slope * size + root * np.sqrt(size) + d.windage * size**2
    return -sign * (brake + shorted_turns_torque(answers, size, at))


def _motion(at: Columns) -> tuple[np.ndarray, np.ndarray]:
    """Sign and speed [rad/s] of the motion (n,); a creeping rotor has a sign only."""
    speed = at.get("speed", np.zeros(len(next(iter(at.values())))))
    return np.sign(at.get("direction", speed)), np.abs(speed)


def iron_torques(answers: Answers) -> tuple[float, float, float]:
    """Hysteresis [Nm], eddies [Nms/rad] and excess [Nm sqrt(s/rad)] of the stator."""
    d = answers.design
    declared = d.iron_loss is not None
    law, size = (d.iron_loss, d.iron_loss_factor) if declared else (USUAL_SHEET, _undeclared(d))
    if not size:
        return 0.0, 0.0, 0.0
    m = d.cross_section
    tooth, yoke = _swings(answers.surrogate.no_load[1].tobytes(), m.slot_pitch)
    flux = answers.tooth_flux / d.length / d.stacking_factor
    swings = tooth.times(flux / m.tooth_width), yoke.times(flux / m.back_iron_width)
    regions = zip(_masses(m, d.length * d.stacking_factor * law.density), swings)
    hysteresis, eddy, excess = (
        size * sum(terms) for terms in zip(*(_torques(law, mass, one, d.machine.pole_pairs) for mass, one in regions))
    )
    return hysteresis, eddy, excess


def _undeclared(design: MachineAsBuilt) -> float:
    return design.iron_loss_factor * design.undeclared_iron_loss


@dataclass(frozen=True)
class Swing:
    """What a sheet feels of a flux density B over a revolution.

    peak: half of peak to peak [T];  square: mean of (dB/d angle)^2 [T^2];  power: mean of |dB/d angle|^1.5 [T^1.5]
    """

    peak: float
    square: float
    power: float

    @classmethod
    def of(cls, wave: np.ndarray) -> Swing:
        """Of complex amplitudes [T] (orders,)."""
        values, rates = _over_a_turn(wave), _over_a_turn(1j * np.arange(len(wave)) * wave)
        return cls(float(np.ptp(values)) / 2, float((rates**2).mean()), float((np.abs(rates) ** 1.5).mean()))

    def times(self, factor: float) -> Swing:
        """The same of a flux density ``factor`` times as large."""
        return Swing(factor * self.peak, factor**2 * self.square, factor**1.5 * self.power)


@lru_cache(maxsize=32)
def _swings(flux: bytes, slot_pitch: float) -> tuple[Swing, Swing]:
    """Of the flux through a tooth, given as the bytes of its amplitudes, and through the yoke: fits change its size
    alone."""
    tooth = np.frombuffer(flux, dtype=complex)
    return Swing.of(tooth), Swing.of(yoke_wave(tooth, slot_pitch))


def yoke_wave(tooth: np.ndarray, slot_pitch: float) -> np.ndarray:
    """Complex amplitudes of the flux through the yoke, of that through a tooth (orders,): the difference of that of the
    yoke to its both sides, each as the one before a pitch later."""
    between = 1.0 - np.exp(1j * np.arange(len(tooth)) * slot_pitch)
    passes = np.abs(between) > 1e-9  # orders that are multiples of the slots stay in the gap
    return np.where(passes, tooth / np.where(passes, between, 1.0), 0.0)


def _masses(m: Machine, depth: float) -> tuple[float, float]:
    """Of all teeth and of the yoke [kg]; depth: mass behind a square metre of the cross-section [kg/m^2]."""
    teeth = m.slots * m.tooth_width * (m.slot_bottom_radius - m.stator_inner_radius)
    return teeth * depth, pi * (m.stator_outer_radius**2 - m.slot_bottom_radius**2) * depth


def _torques(law: IronLossLaw, mass: float, swing: Swing, pole_pairs: int) -> tuple[float, float, float]:
    """Hysteresis, eddy and excess terms of a region, see the module."""
    hysteresis = law.hysteresis * pole_pairs * swing.peak**law.exponent / (2 * pi)
    eddy = law.eddy / (2 * pi**2) * swing.square * (1 + law.saturation * swing.peak**2)
    return mass * hysteresis, mass * eddy, mass * law.excess / EXCESS_OF_SINE * swing.power


def _over_a_turn(wave: np.ndarray) -> np.ndarray:
    """Values of Re sum c_m exp(i m angle) at equal angles (_SAMPLES,)."""
    full = np.zeros(_SAMPLES // 2 + 1, dtype=complex)
    full[: len(wave)] = wave * (_SAMPLES / 2)
    full[0] *= 2
    return np.fft.irfft(full, _SAMPLES)


def shorted_turns_torque(answers: Answers, speed: np.ndarray, at: Columns) -> np.ndarray:
    """Braking torque [Nm] of turns closed on themselves at speeds [rad/s] of any sign, (n,):

    T = sum over orders m of (m psi_m)^2/2 R speed/(R^2 + (m speed L)^2), of their own flux linkage, resistance and
    inductance.
    """
    d = answers.design
    if not d.shorted_turns:
        return np.zeros_like(speed)
    resistance, inductance = _of_shorted_turns(answers, at)
    order = np.arange(answers.spectrum.shape[1])
    linkage = d.shorted_turns * np.abs(answers.tooth_wave(d.shorted_coil))
    reactance = inductance * order * np.abs(speed)[:, None]
    share = resistance[:, None] / (resistance[:, None] ** 2 + reactance**2)
    return np.abs(speed) * (share @ (order * linkage) ** 2) / 2


def _of_shorted_turns(answers: Answers, at: Columns) -> tuple[np.ndarray, float]:
    """Resistance (n,) [ohm] and inductance [H]: their share of what is left of the phase; the gap over their tooth."""
    d, layout = answers.design, answers.surrogate.layout
    phase = layout.coils[d.shorted_coil].phase
    turns = d.turns_of_phases[phase]
    if not (d.phase_resistance[phase] and turns):
        raise WorkbenchError("shorted turns brake by their resistance: give phase_resistance in [device]")
    winding = answers.resistances(at)[:, phase] - d.lead_resistance[phase]
    m = d.cross_section
    gap = m.airgap + m.magnet_length / d.magnet.recoil_permeability
    permeance = MU_0 * d.length * m.slot_pitch * m.mid_gap_radius / gap
    return winding * d.shorted_turns / turns, permeance * d.shorted_turns**2
