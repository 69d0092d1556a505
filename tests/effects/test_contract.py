"""Every effect of the package keeps the contract, and every check of the contract catches an effect that does not."""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parent))

import contract  # noqa: E402

from effects.base import DesignEffect, InstrumentEffect  # noqa: E402
from effects.damper_design import Damper  # noqa: E402
from effects.law_effects import ForceEffect  # noqa: E402
from effects.library import package_effects  # noqa: E402
from effects.parameter import parameter  # noqa: E402
from effects.prior import LogNormal, Normal  # noqa: E402
from effects.signature import Touches  # noqa: E402

EFFECTS = package_effects()


@pytest.mark.parametrize("name", EFFECTS)
@pytest.mark.parametrize("check", contract.CHECKS, ids=lambda check: check.__name__)
def test_every_effect_keeps_the_contract(name, check):
    check(EFFECTS[name])


def test_there_are_enough_effects_of_every_kind():
    folders = [cls.__module__.split(".")[1] for cls in EFFECTS.values()]
    assert len(EFFECTS) >= 30
    assert min(folders.count(folder) for folder in ("machine", "electrical", "mechanical", "instrument")) >= 10


def test_each_effect_is_one_file_named_after_it():
    for name, cls in EFFECTS.items():
        assert cls.__module__.split(".")[-1] == name


def mass(**changes):
    declared = dict(prior=LogNormal(0.5), low=0.0, high=5.0, source="a test")
    return parameter(0.0, "kg", **{**declared, **changes})


@dataclass(frozen=True)
class Good(DesignEffect):
    """A mass more: m = m_declared + mass, which moves the imaginary part of the impedance."""

    title = "more mass"
    signature = (Touches("impedance.im"),)
    looks_like = "more inertia"
    remedy = ("weigh it",)
    designs = (Damper,)

    mass: float = mass()

    def on_design(self, design):
        return replace(design, moving_mass=design.moving_mass + self.mass)


@dataclass(frozen=True)
class WithoutTitle(Good):
    title = ""


@dataclass(frozen=True)
class WithoutLaw(Good):
    mass: float = mass()


@dataclass(frozen=True)
class WithoutSource(Good):
    """A law = 1."""

    mass: float = mass(source="")


@dataclass(frozen=True)
class NullOutOfBounds(Good):
    """A law = 1."""

    mass: float = mass(low=0.1)


@dataclass
class Thawed(DesignEffect):
    mass: float = mass()


@dataclass(frozen=True)
class NullThatActs(Good):
    def on_design(self, design):
        return replace(design, moving_mass=(design.moving_mass + self.mass) * (1 + 1e-15))


@dataclass(frozen=True)
class Remembers(InstrumentEffect):
    """Leaves a trace in the arrays it is handed, which are those of the table."""

    title, looks_like, remedy = "a trace", "a trace", ("none",)
    gain: float = parameter(0.0, "1", prior=Normal(0.02), low=-1.0, high=1.0, source="a test")

    def on_condition(self, conditions, kind):
        for values in conditions.values():
            values *= 1.0 + self.gain
        return conditions


@dataclass(frozen=True)
class Idle(Good):
    def on_design(self, design):
        return design


@dataclass(frozen=True)
class Rough(Good):
    def on_design(self, design):
        return replace(design, moving_mass=design.moving_mass + round(self.mass * 2e4) / 2e4)


@dataclass(frozen=True)
class Kinked(ForceEffect):
    title, looks_like, remedy = "a kink", "a kink", ("none",)
    level: float = parameter(0.0, "N", prior=LogNormal(1.0), low=0.0, high=9.0, source="a test")

    def force(self, position, velocity):
        return np.abs(self.level - contract.sized(Kinked()).level) * np.sign(velocity) * 5.0


@dataclass(frozen=True)
class JumpsAtNull(Good):
    def on_design(self, design):
        return replace(design, moving_mass=design.moving_mass + (self.mass > 0) + self.mass)


@pytest.mark.parametrize("check", contract.CHECKS, ids=lambda check: check.__name__)
def test_a_good_effect_passes(check):
    check(Good)


@pytest.mark.parametrize(
    ("wrong", "check", "words"),
    [
        (WithoutTitle, contract.check_declared, "title"),
        (WithoutLaw, contract.check_declared, "law"),
        (WithoutSource, contract.check_declared, "source"),
        (NullOutOfBounds, contract.check_declared, "bounds"),
        (Thawed, contract.check_frozen, "frozen"),
        (NullThatActs, contract.check_null, "bit for bit"),
        (Remembers, contract.check_restores, "trace"),
        (Idle, contract.check_acts, "nothing"),
        (Rough, contract.check_smooth, "smooth"),
        (Kinked, contract.check_smooth, "smooth"),
        (JumpsAtNull, contract.check_smooth, "jumps"),
    ],
)
def test_a_wrong_effect_is_caught(wrong, check, words):
    with pytest.raises(AssertionError, match=words):
        check(wrong)
