"""Numbers that the thesis prints for the prototype of its chapter 4 and appendix B, in SI, each with its source."""

from __future__ import annotations

from actuator.drive import Drive, MappedMotor, QuadraticLoss, flat_limit
from actuator.model import Actuator
from actuator.parts import CompliantMount, MechanicalLoss, fixed_ratio
from control.force_loop import ForceLoop

# Table 4.2: mass, bound, contact stiffness and damping, transition, mechanical loss, mount damping, torque constant
NOMINAL = (5.6, 2e-4, 5e5, 100.0, 1.5e-3, 70.0, 500.0, 49.3e-3)  # kg, m, N/m, Ns/m, m, Ns/m, Ns/m, Nm/A
IDENTIFIED_GAINS = (1.100, 0.046, 1.352, 5.452, 2.558, 1.519, 0.590, 0.866)  # of eq. 4.29
NOMINAL_GAINS = (1.0,) * 8
RATIO = 0.115 / 87.3  # m/rad, Table A.1
PEAK_TORQUE = 2.3  # Nm, Table A.1
# Table 4.5, taken as gains from a force at the wheel to a force at the wheel.
FORCE_LOOP = ForceLoop(proportional=7.4, integral=1000.0, derivative=5.9e-3, filter=6283.0)
TORQUE_LAG = 1e-3  # s, "in the order of the millisecond", section 4.2.1
# Stand-in for the loss map of Fig. 4.5, which is a figure only: two numbers chosen so that the four losses of Tables
# 4.6-4.9 come out within 8 %. No other number of chapter 4 is used for it.
LOSS = QuadraticLoss(copper=24.7, iron=1.5e-4)
FASTEST = 2000.0  # rad/s, 2.6 m/s at the wheel; Fig. 4.5 is a figure only


def motor() -> MappedMotor:
    """Electric machine of the prototype: the peak torque at every speed stands in for the curve of Fig. 4.5."""
    return MappedMotor(flat_limit(PEAK_TORQUE, FASTEST), LOSS, TORQUE_LAG)


def prototype(gains: tuple[float, ...] = IDENTIFIED_GAINS, drive: Drive | None = None) -> Actuator:
    """The mechanical subsystem of Table 4.2, nominal values times the gains of eq. 4.29."""
    mass, bound, stiffness, contact, transition, loss, mount, _ = (p * x for p, x in zip(NOMINAL, gains, strict=True))
    return Actuator(
        drive=motor() if drive is None else drive,
        ratio=fixed_ratio(RATIO),
        equivalent_mass=mass,
        mount=CompliantMount(stiffness, mount, bound, contact, transition),
        loss=MechanicalLoss(viscous=loss),
    )


def quasi_ideal() -> Actuator:
    """The same machine rigidly connected to the suspension, without inertia and friction (section 4.3.2)."""
    return Actuator(drive=motor(), ratio=fixed_ratio(RATIO))
