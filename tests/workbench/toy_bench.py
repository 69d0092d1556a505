"""A device so simple that everything about it can be worked out by hand, and campaigns of it written to a folder.

force = stiffness * displacement,   displacement in millimetres in the file
"""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from effects.base import DesignEffect, InstrumentEffect, ResponseEffect
from effects.parameter import parameter
from effects.prior import LogNormal, Normal
from workbench.models.base import BaseModel

RATE = 0.1  # base rate of each of the few things that so simple a device may have


@dataclass(frozen=True)
class Spring:
    stiffness: float  # N/m


class SpringModel(BaseModel):
    name = "spring"

    def accepts(self, device):
        return "stiffness_N_per_m" in device

    def design(self, device):
        return Spring(float(device["stiffness_N_per_m"]))

    def with_tolerance(self, design, tolerance, z):
        return replace(design, stiffness=design.stiffness * (1 + tolerance.sigma * z))

    def respond(self, design, kind, conditions):
        return {"force": design.stiffness * conditions["displacement"]}


@dataclass(frozen=True)
class Hardening(ResponseEffect):
    """A cubic part of the spring's force: F = k x + cubic x^3."""

    title: ClassVar[str] = "hardening spring"
    looks_like: ClassVar[str] = "a force that grows with the cube of the displacement"
    designs: ClassVar[tuple[type, ...]] = (Spring,)
    base_rate: ClassVar[float] = RATE
    cubic: float = parameter(0.0, "N/m^3", prior=LogNormal(3e5, 1.0), low=0.0, high=1e9, source="made up")

    def on_response(self, response, conditions, kind, design):
        return {**response, "force": response["force"] + self.cubic * conditions["displacement"] ** 3}


@dataclass(frozen=True)
class Bump(ResponseEffect):
    """An even part: F = k x + size (x / 10 mm)^2."""

    title: ClassVar[str] = "even part"
    looks_like: ClassVar[str] = "a force that does not change sign"
    designs: ClassVar[tuple[type, ...]] = (Spring,)
    base_rate: ClassVar[float] = RATE
    size: float = parameter(0.0, "N", prior=Normal(0.3), low=-100.0, high=100.0, source="made up")

    def on_response(self, response, conditions, kind, design):
        return {**response, "force": response["force"] + self.size * (conditions["displacement"] / 0.01) ** 2}


@dataclass(frozen=True)
class SoftSpring(DesignEffect):
    """The spring is softer than declared: k = k_drawn (1 - loss); a twin of its own tolerance."""

    title: ClassVar[str] = "softer spring"
    looks_like: ClassVar[str] = "a smaller force"
    designs: ClassVar[tuple[type, ...]] = (Spring,)
    base_rate: ClassVar[float] = RATE
    loss: float = parameter(0.0, "1", prior=LogNormal(0.05, 0.7), low=0.0, high=0.9, source="made up")

    def on_design(self, design):
        return design if self.is_null else replace(design, stiffness=design.stiffness * (1 - self.loss))


@dataclass(frozen=True)
class ForceOffset(InstrumentEffect):
    """Zero of the force cell: reading = force + offset."""

    title: ClassVar[str] = "zero of the force cell"
    looks_like: ClassVar[str] = "the same force everywhere"
    base_rate: ClassVar[float] = RATE
    offset: float = parameter(0.0, "N", prior=Normal(0.2), low=-100.0, high=100.0, source="made up")

    def on_reading(self, response, conditions, kind):
        return {**response, "force": response["force"] + self.offset}


LIBRARY = {cls.name(): cls for cls in (Bump, ForceOffset, Hardening, SoftSpring)}

TOML = """
[campaign]
id = "spring"
repeats = {repeats}
holdout = {holdout}
[device]
stiffness_N_per_m = 1000.0
[tolerance]
stiffness_N_per_m = {{ sigma_rel = 0.01, source = "drawing" }}
[systematic]
force_offset_N = {{ sigma = 0.02, kind = "offset" }}
[[table]]
file = "pull.csv"
kind = "generic"
u_random = {{ force_N = "0.05 + 0.0*abs(y)" }}
"""
LAST_REPEAT = '{ rule = "last repeat of every table" }'


def spring_force(x, extra=lambda x: 0 * x, stiffness=1000.0):
    return stiffness * x + extra(x)


def written(
    folder, extra=lambda x: 0 * x, seed=0, n=60, repeats=2, scale=1.0, rho=0.0, stiffness=1003.0, holdout=LAST_REPEAT
):
    """A campaign of the spring in a folder; extra: hidden force over the displacement in metres."""
    random = np.random.default_rng(seed)
    x = np.linspace(-0.01, 0.01, n)
    lines = ["repeat,displacement_mm,force_N"]
    for repeat in range(repeats):
        error = random.standard_normal(n)
        for k in range(1, n):
            error[k] = rho * error[k - 1] + np.sqrt(1 - rho**2) * error[k]
        force = spring_force(x, extra, stiffness) + 0.01 + 0.05 * scale * error
        lines += [f"{repeat},{1e3 * a:.6f},{f:.6f}" for a, f in zip(x, force)]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "pull.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(TOML.format(repeats=repeats, holdout=holdout), encoding="utf-8")
    return folder
