"""The gearbox: stages one behind the other, from the slow shaft (linkage) to the fast one (rotor)."""

from __future__ import annotations

from dataclasses import dataclass
from math import prod

from gearbox.bodies import Body, Construction, inertia_at_carrier, total_mass
from gearbox.efficiency import stage_efficiency
from gearbox.planetary_set import PlanetarySet
from gearbox.rating import Rules, StageLoad, StageRating, rate_stage


@dataclass(frozen=True)
class Stage:
    """Teeth and face width [m] of one stage."""

    gears: PlanetarySet
    face_width: float


@dataclass(frozen=True)
class GearTrain:
    """Stages in order from the slow shaft, in an envelope diameter [m]; density [kg/m^3], friction coefficient mu."""

    stages: tuple[Stage, ...]
    envelope_diameter: float
    construction: Construction
    density: float
    friction: float

    @property
    def ratio(self) -> float:
        """Fast over slow speed, the product of the stages."""
        return prod(stage.gears.ratio for stage in self.stages)

    @property
    def speed_ratios(self) -> tuple[float, ...]:
        """Speed of the carrier of each stage over the slow shaft."""
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
    def inertia_at_fast_shaft(self) -> float:
        """J over the squared ratio [kg m^2]."""
        return self.inertia_at_slow_shaft / self.ratio**2

    @property
    def length(self) -> float:
        """Axial room of all stages [m]."""
        return sum(self.construction.stage_length(stage.face_width) for stage in self.stages)

    @property
    def efficiency(self) -> tuple[float, float]:
        """(slow drives fast, fast drives slow), meshing losses alone."""
        pairs = [stage_efficiency(stage.gears, self.friction) for stage in self.stages]
        slow_drives, fast_drives = zip(*pairs, strict=True)
        return float(prod(slow_drives)), float(prod(fast_drives))

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
