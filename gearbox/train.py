"""What lies between the slow shaft (linkage, load) and the rotor: stages one behind the other, or nothing at all."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod

from gearbox.bodies import Body, Construction, inertia_at_carrier, total_mass
from gearbox.efficiency import stage_efficiency
from gearbox.errors import GearError
from gearbox.planetary_set import PlanetarySet
from gearbox.rating import Rules, StageLoad, StageRating, rate_stage


@dataclass(frozen=True)
class Stage:
    """Teeth and face width [m] of one stage."""

    gears: PlanetarySet
    face_width: float


class Gears:
    """A transmission from the slow shaft to the rotor; the concrete ones are below."""

    stages: tuple[Stage, ...]
    envelope_diameter: float

    @property
    def ratio(self) -> float:
        """Fast over slow speed, dimensionless."""
        raise NotImplementedError

    @property
    def mass(self) -> float:
        """[kg]"""
        raise NotImplementedError

    @property
    def inertia_at_slow_shaft(self) -> float:
        """J [kg m^2] of all that turns."""
        raise NotImplementedError

    @property
    def inertia_at_fast_shaft(self) -> float:
        """J over the squared ratio [kg m^2]."""
        return self.inertia_at_slow_shaft / self.ratio**2

    @property
    def stage_lengths(self) -> tuple[float, ...]:
        """Axial room of each stage [m]."""
        raise NotImplementedError

    @property
    def length(self) -> float:
        """Axial room of all stages [m]."""
        return sum(self.stage_lengths)

    @property
    def efficiency(self) -> tuple[float, float]:
        """(slow drives fast, fast drives slow), meshing losses alone."""
        raise NotImplementedError

    def rate(self, load: StageLoad, rules: Rules) -> tuple[StageRating, ...]:
        """Safety factors of each stage when this load acts at the slow shaft."""
        raise NotImplementedError


@dataclass(frozen=True)
class DirectDrive(Gears):
    """The rotor on the slow shaft: ratio 1, nothing that weighs, turns, rubs or breaks."""

    stages: tuple[Stage, ...] = ()
    envelope_diameter: float = 0.0

    def __post_init__(self) -> None:
        if self.stages:
            raise GearError(f"a direct drive has no stages; found {len(self.stages)}")

    @property
    def ratio(self) -> float:
        """1, dimensionless."""
        return 1.0

    @property
    def mass(self) -> float:
        return 0.0

    @property
    def inertia_at_slow_shaft(self) -> float:
        """0 [kg m^2]."""
        return 0.0

    @property
    def stage_lengths(self) -> tuple[float, ...]:
        """Of no stage [m], empty."""
        return ()

    @property
    def efficiency(self) -> tuple[float, float]:
        return 1.0, 1.0

    def rate(self, load: StageLoad, rules: Rules) -> tuple[StageRating, ...]:
        return ()


@dataclass(frozen=True)
class GearTrain(Gears):
    """Stages in order from the slow shaft, in an envelope diameter [m]; density [kg/m^3]; friction: dimensionless."""

    stages: tuple[Stage, ...]
    envelope_diameter: float
    construction: Construction
    density: float
    friction: float

    @property
    def ratio(self) -> float:
        """Fast over slow speed, dimensionless, the product of the stages."""
        return prod(stage.gears.ratio for stage in self.stages)

    @property
    def speed_ratios(self) -> tuple[float, ...]:
        """Speed of the carrier of each stage relative to the slow shaft."""
        return tuple(prod(stage.gears.ratio for stage in self.stages[:k]) for k in range(len(self.stages)))

    @property
    def bodies(self) -> tuple[tuple[Body, ...], ...]:
        """Bodies of each stage."""
        build = self.construction.bodies
        return tuple(build(s.gears, s.face_width, self.envelope_diameter, self.density) for s in self.stages)

    @property
    def mass(self) -> float:
        """Gears, pins and carriers [kg]; casing, bearings, shafts and lever are not counted."""
        return sum(total_mass(bodies) for bodies in self.bodies)

    @property
    def inertia_at_slow_shaft(self) -> float:
        """J [kg m^2]: the sum of the stages, each times its squared speed ratio."""
        pairs = zip(self.bodies, self.speed_ratios, strict=True)
        return sum(inertia_at_carrier(bodies) * speed**2 for bodies, speed in pairs)

    @property
    def stage_lengths(self) -> tuple[float, ...]:
        """Axial room of each stage [m]."""
        return tuple(self.construction.stage_length(stage.face_width) for stage in self.stages)

    @property
    def efficiency(self) -> tuple[float, float]:
        """(slow drives fast, fast drives slow), meshing losses alone."""
        pairs = [stage_efficiency(stage.gears, self.friction) for stage in self.stages]
        step_up, step_down = zip(*pairs, strict=True)
        return float(prod(step_up)), float(prod(step_down))

    def loads(self, load: StageLoad) -> tuple[StageLoad, ...]:
        """Load of each stage when this one acts at the slow shaft."""
        found = [load]
        for stage in self.stages[:-1]:
            found.append(found[-1].behind(stage.gears.ratio))
        return tuple(found)

    def rate(self, load: StageLoad, rules: Rules) -> tuple[StageRating, ...]:
        """Safety factors of each stage."""
        pairs = zip(self.stages, self.loads(load), strict=True)
        return tuple(rate_stage(stage.gears, stage.face_width, one, rules) for stage, one in pairs)
