"""What is asked of an actuator, each demand with how it is read off a design and what it is called."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import ClassVar

import numpy as np

from drivetrain.capability import ActuatorDesign, Values
from drivetrain.output import Output

SLACK = 1e-6  # relative; a capability this close to its requirement is met


@dataclass(frozen=True)
class Requirement:
    """One demand in SI; the concrete ones below say how it is read off a design, and in words what it is.

    needed: a lower bound, an upper one where ``at_most``; needed, reached: [unit of the demand, SI]
    stays: whether no lever moves it
    """

    needed: float
    at_most: ClassVar[bool] = False
    stays: ClassVar[bool] = False

    def reached(self, design: ActuatorDesign) -> Values:
        """What a design reaches [unit of the demand, SI], one value for each of a batch."""
        raise NotImplementedError

    def name(self, output: Output) -> str:
        """In words, for a kind of output."""
        raise NotImplementedError

    def unit(self, output: Output) -> str:
        """Drawing unit, a key of ``units.FACTORS``."""
        raise NotImplementedError

    def met(self, reached: Values) -> Values:
        """Whether a reached value is enough, up to rounding."""
        if self.at_most:
            return reached <= self.needed * (1 + SLACK)
        return reached >= self.needed * (1 - SLACK)

    def margin(self, reached: Values) -> Values:
        """How far a reached value is inside, relative; negative where it is not enough. Of a demand that is not 0."""
        ratio = reached / self.needed - 1
        return -ratio if self.at_most else ratio

    def check(self, design: ActuatorDesign) -> Check:
        """The requirement against one design."""
        return Check(self, float(np.squeeze(self.reached(design))))


@dataclass(frozen=True)
class PeakEffortAtRest(Requirement):
    """Peak force or torque at standstill; needed, reached: [N or Nm]."""

    def reached(self, design: ActuatorDesign) -> Values:
        return design.effort_peak

    def name(self, output: Output) -> str:
        return f"peak {output.effort} at rest"

    def unit(self, output: Output) -> str:
        return output.effort_unit


@dataclass(frozen=True)
class PeakEffort(Requirement):
    """Peak force or torque at the speed [m/s or rad/s] where it is asked for; needed, reached: [N or Nm]."""

    speed: float

    def reached(self, design: ActuatorDesign) -> Values:
        return design.effort_at(self.speed)

    def name(self, output: Output) -> str:
        return f"peak {output.effort} at {output.at_speed(self.speed)}"

    def unit(self, output: Output) -> str:
        return output.effort_unit


@dataclass(frozen=True)
class PeakPower(Requirement):
    """Peak power at the speed [m/s or rad/s] where it is asked for; needed, reached: [W]."""

    speed: float

    def reached(self, design: ActuatorDesign) -> Values:
        return design.effort_at(self.speed) * self.speed

    def name(self, output: Output) -> str:
        return f"peak power at {output.at_speed(self.speed)}"

    def unit(self, output: Output) -> str:
        return "W"


@dataclass(frozen=True)
class ContinuousEffort(Requirement):
    """RMS force or torque that the temperatures allow for ever at the RMS speed; needed, reached: [N or Nm]."""

    def reached(self, design: ActuatorDesign) -> Values:
        return design.effort_continuous

    def name(self, output: Output) -> str:
        return f"continuous {output.effort} by temperature"

    def unit(self, output: Output) -> str:
        return output.effort_unit


@dataclass(frozen=True)
class LowSpeedDamping(Requirement):
    """Regenerative damping of the short-circuited machine far below its electrical pole, as the thesis states it;
    needed, reached: [Ns/m or Nms/rad]."""

    def reached(self, design: ActuatorDesign) -> Values:
        return design.low_speed_damping

    def name(self, output: Output) -> str:
        return "short-circuit damping at low speed"

    def unit(self, output: Output) -> str:
        return output.damping_unit


@dataclass(frozen=True)
class ControlledDamping(Requirement):
    """Largest braking effort over the speed [m/s or rad/s], within current and voltage; needed, reached: [Ns/m or
    Nms/rad]."""

    speed: float

    def reached(self, design: ActuatorDesign) -> Values:
        return design.braking_at(self.speed) / self.speed

    def name(self, output: Output) -> str:
        return f"controlled damping at {output.at_speed(self.speed)}"

    def unit(self, output: Output) -> str:
        return output.damping_unit


@dataclass(frozen=True)
class RotorSpeed(Requirement):
    """Largest speed of the rotor at the peak speed of the output [m/s or rad/s]; needed, reached: [rad/s]."""

    speed: float
    at_most = True

    def reached(self, design: ActuatorDesign) -> Values:
        return self.speed / design.transmission_ratio

    def name(self, output: Output) -> str:
        return "rotor speed"

    def unit(self, output: Output) -> str:
        return "rpm"


@dataclass(frozen=True)
class PhaseCurrent(Requirement):
    """RMS phase current of the overload; needed, reached: [A]."""

    at_most = True

    def reached(self, design: ActuatorDesign) -> Values:
        return design.phase_current_rms

    def name(self, output: Output) -> str:
        return "phase current, RMS"

    def unit(self, output: Output) -> str:
        return "A"


@dataclass(frozen=True)
class ActiveLength(Requirement):
    """Active length; needed, reached: [m]."""

    at_most = True

    def reached(self, design: ActuatorDesign) -> Values:
        return design.active_length

    def name(self, output: Output) -> str:
        return "active length"

    def unit(self, output: Output) -> str:
        return "mm"


@dataclass(frozen=True)
class EquivalentMass(Requirement):
    """Inertia of rotor and gears at the output; needed, reached: [kg or kg m^2]."""

    at_most = True

    def reached(self, design: ActuatorDesign) -> Values:
        return design.equivalent_mass

    def name(self, output: Output) -> str:
        return output.inertia

    def unit(self, output: Output) -> str:
        return output.inertia_unit


@dataclass(frozen=True)
class Diameter(Requirement):
    """Outer diameter of the casing, which no lever moves; needed, reached: [m]."""

    diameter: float
    at_most = True
    stays = True

    def reached(self, design: ActuatorDesign) -> Values:
        return self.diameter

    def name(self, output: Output) -> str:
        return "diameter"

    def unit(self, output: Output) -> str:
        return "mm"


@dataclass(frozen=True)
class LostMagnets(Requirement):
    """Share of the magnets' volume that goes beyond the knee in the worst state, which no lever moves.

    needed, reached, lost: dimensionless
    """

    lost: float
    at_most = True
    stays = True

    def reached(self, design: ActuatorDesign) -> Values:
        return self.lost

    def name(self, output: Output) -> str:
        return "volume of the magnets beyond the knee"

    def unit(self, output: Output) -> str:
        return "percent"


@dataclass(frozen=True)
class Check:
    """A requirement and the value that a design reaches; reached: [unit of the demand, SI]."""

    requirement: Requirement
    reached: float

    @property
    def margin(self) -> float:
        """Relative; negative where the requirement does not hold; infinite where nothing is asked for."""
        if self.requirement.needed == 0:
            return inf if self.holds else -inf
        return float(self.requirement.margin(self.reached))

    @property
    def holds(self) -> bool:
        """Up to rounding."""
        return bool(self.requirement.met(self.reached))
