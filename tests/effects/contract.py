"""What every effect promises, as checks that raise AssertionError; and benches on which effects are tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass, fields, is_dataclass, replace
from typing import Any

import numpy as np

from effects.base import DesignEffect, Effect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameters_of
from geometry.machine import Machine
from materials.magnet import Magnet
from workbench.data.table import Response, Table
from workbench.models.damper.model import DamperModel
from workbench.models.dq.model import DqModel
from workbench.models.model import Model


@dataclass(frozen=True, eq=False)
class Case:
    """A model without effects and tables to ask it about; without tables only the design is looked at."""

    model: Model
    tables: tuple[Table, ...]

    def seen(self, effect: Effect | None = None) -> np.ndarray:
        """All readings, or all numbers of the design, with the effect, one after the other."""
        model = self.model if effect is None else self.model + effect
        if not self.tables:
            return numbers(model.design_as_built)
        answers = [model.answers(table) for table in self.tables]
        return np.concatenate([values for answer in answers for values in answer.values()])


def numbers(value: Any) -> np.ndarray:
    """Every number in a nest of dataclasses and tuples."""
    if is_dataclass(value):
        value = [getattr(value, f.name) for f in fields(value)]
    if isinstance(value, (tuple, list)):
        return np.concatenate([numbers(entry) for entry in value]) if value else np.empty(0)
    return np.array([float(value)]) if isinstance(value, (int, float)) else np.empty(0)


class Waveforms:
    """A base model of readings over angle, current and speed for effects that only instruments see."""

    name = "waveforms"

    def respond(self, design, kind, conditions):
        angle, speed, current = conditions["angle_mech"], conditions["speed"], conditions["i_a"]
        return {"v_a": 0.1 * speed * np.sin(5 * angle), "torque": 2.0 * current * np.cos(5 * angle)}


def table(kind: str, responses: tuple[str, ...], **conditions) -> Table:
    rows = len(next(iter(conditions.values())))
    nothing = np.zeros(rows)
    conditions = {name: np.asarray(values, dtype=float) for name, values in conditions.items()}
    read = {name: Response(name, nothing, np.ones(rows), "1") for name in responses}
    return Table(kind, kind, conditions, read, nothing.astype(int), nothing.astype(int), nothing.astype(bool))


def damper_case() -> Case:
    both = np.array([-0.4, -0.1, 0.05, 0.2, 0.3])
    frequency = np.geomspace(1, 40, 5)
    same = np.ones(5)
    tables = (
        table("damping_velocity", ("force",), velocity=both, shunt=same),
        table("back_emf", ("voltage",), velocity=both),
        table("impedance", ("re", "im"), frequency=frequency, amplitude=2e-3 * same, shunt=same),
        table("impedance", ("re", "im"), frequency=frequency, amplitude=5e-4 * same, shunt=1e6 * same),
    )
    return Case(Model(DamperModel(), Damper(60.0, 1.2, 2.0, 20.0)), tables)


def dq_case() -> Case:
    speed = np.array([-200.0, 50.0, 150.0, 300.0])
    warm = {"winding_T": np.array([20.0, 60, 90, 120]), "magnet_T": np.array([20.0, 40, 60, 80])}
    i_d, i_q = np.array([-8.0, 0, 5, -3]), np.array([10.0, -16, 8, 24])
    tables = (
        table("dq_operation", ("v_d", "v_q", "torque"), i_d=i_d, i_q=i_q, speed=speed, **warm),
        table("back_emf", ("v_ll",), speed=np.abs(speed), magnet_T=warm["magnet_T"]),
        table("short_circuit", ("torque", "current"), speed=np.abs(speed)),
        table("drag", ("torque",), speed=speed),
        table("dq_supply", ("current", "power"), v_ll=[88.0, 80, 85, 95], torque=[1.0, 2, 3, 4], speed=[150.0] * 4),
    )
    return Case(Model(DqModel(), DqMachine(4, 0.1, 3e-3, 4e-3, 0.5)), tables)


def waveform_case() -> Case:
    angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    waves = table("waves", ("v_a", "torque"), angle_mech=angle, speed=100 + 0 * angle, i_a=3 + 0 * angle)
    return Case(Model(Waveforms(), None), (waves,))


def machine_case() -> Case:
    mm = 1e-3
    drawn = Machine(
        12, 5, 42.5 * mm, 15.7 * mm, 3.3 * mm, 5.5 * mm, 2.5 * mm, 0.5 * mm, 2 * mm, 1.43 * mm, 1.43 * mm, 5 * mm
    )
    design = MachineAsBuilt.drawn(drawn, "35PN270", Magnet(1.3, 1.0, -0.0012, 22.0), 41 * mm, 7, 12.6e-3)
    return Case(Model(None, design), ())


def cases_of(cls: type[Effect]) -> list[Case]:
    """The benches on which an effect can be tried; of the machine only its design, which needs no field solution."""
    cases = [damper_case(), dq_case(), waveform_case()]
    if issubclass(cls, DesignEffect):
        cases.append(machine_case())
    return [case for case in cases if cls.can_act_on(case.model.design)]


def first(cls: type[Effect], case: Case) -> Effect:
    return cls.variants(case.model.design)[0]


def sized(effect: Effect, z: float = 0.6) -> Effect:
    """The effect at a typical size, every parameter alike."""
    return effect.at(np.full(len(parameters_of(effect)), z))


def check_declared(cls: type[Effect]) -> None:
    assert cls.title and cls.looks_like and cls.remedy, "a title, what it looks like and a remedy are needed"
    assert not cls.__doc__.startswith(f"{cls.__name__}("), "the docstring states the law"
    parameters = parameters_of(cls)
    assert parameters, "an effect without a parameter has no null"
    for name, p in parameters.items():
        assert p.unit and p.source, f"{name} lacks its unit or source"
        assert p.low <= p.null <= p.high, f"the null of {name} is outside its bounds"
        for z in (-1.5, 0.0, 1.5):
            assert abs(p.prior.standard(p.prior.value(z)) - z) < 1e-9, f"the prior of {name} is not one to one"
        assert p.low <= p.prior.value(0.0) <= p.high, f"the middle of the prior of {name} is outside its bounds"


def check_frozen(cls: type[Effect]) -> None:
    effect = cls()
    try:
        setattr(effect, next(iter(parameters_of(cls))), 1.0)
    except FrozenInstanceError:
        return
    raise AssertionError("an effect is a frozen dataclass")


def check_null(cls: type[Effect]) -> None:
    for case in cases_of(cls):
        for null in cls.variants(case.model.design):
            assert null.is_null, "variants are nulls"
            assert np.array_equal(case.seen(null), case.seen()), "at its null an effect changes nothing, bit for bit"


def check_restores(cls: type[Effect]) -> None:
    for case in cases_of(cls):
        before = case.seen()
        with_it = case.model + sized(first(cls, case))
        Case(with_it, case.tables).seen()
        after = with_it.without(cls.name())
        assert after == case.model, "taking an effect out leaves another model"
        assert np.array_equal(Case(after, case.tables).seen(), before), "adding and removing an effect leaves a trace"


def check_acts(cls: type[Effect]) -> None:
    if all(not case.tables for case in cases_of(cls)) and not issubclass(cls, DesignEffect):
        return  # needs field solutions: tested with its bench
    changes = [np.any(case.seen(sized(first(cls, case))) != case.seen()) for case in cases_of(cls)]
    assert any(changes) or not changes, "the effect changes nothing anywhere"


def check_smooth(cls: type[Effect]) -> None:
    """Slopes to both sides of a typical size agree, and a vanishing size has a vanishing effect."""
    for case in cases_of(cls):
        effect, null = sized(first(cls, case)), first(cls, case)
        for name, p in parameters_of(cls).items():
            size = max(abs(getattr(effect, name) - p.null), 1e-6 * (p.high - p.low))
            _check_slopes(case, effect, name, 1e-4 * size)
        nulls = {name: p.null for name, p in parameters_of(cls).items()}
        vanishing = replace(
            effect, **{name: null + 1e-5 * (getattr(effect, name) - null) for name, null in nulls.items()}
        )
        whole = _distance(case.seen(effect), case.seen(null))
        assert _distance(case.seen(vanishing), case.seen(null)) <= 0.03 * whole + 1e-12, "the effect jumps at its null"


def _check_slopes(case: Case, effect: Effect, name: str, step: float) -> None:
    def at(shift):
        return case.seen(replace(effect, **{name: getattr(effect, name) + shift}))

    below, here, above = at(-step), at(0.0), at(step)
    scale = np.abs(here).max() * 1e-11
    assert _distance(above - here, here - below) <= 0.1 * _distance(above, below) + scale, f"not smooth in {name}"


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max()) if a.size else 0.0


CHECKS: tuple[Callable[[type[Effect]], None], ...] = (
    check_declared,
    check_frozen,
    check_null,
    check_restores,
    check_acts,
    check_smooth,
)
