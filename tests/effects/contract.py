"""What every effect promises, as checks that raise AssertionError; and benches on which effects are tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import FrozenInstanceError, dataclass, fields, is_dataclass, replace
from fnmatch import fnmatch
from functools import cache
from typing import Any

import numpy as np

from effects.base import DesignEffect, Effect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameters_of
from effects.signature import NOTHING, names
from geometry.machine import Machine
from materials.magnet import Magnet
from workbench.believed import NAMED
from workbench.data.table import Response, Table
from workbench.models.damper.model import DamperModel
from workbench.models.dq.model import DqModel
from workbench.models.drawn.model import DrawnBench
from workbench.models.model import Model

SMALL = 1e-3  # share of a typical size at which an effect counts as vanishing


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

    def places(self, effect: Effect | None = None) -> dict[str, np.ndarray]:
        """Readings by "kind.column", tables of one kind one after the other."""
        model, found = self.model if effect is None else self.model + effect, {}
        for table in self.tables:
            for column, values in model.answers(table).items():
                found.setdefault(f"{table.kind}.{column}", []).append(values)
        return {place: np.concatenate(values) for place, values in found.items()}

    def conditions(self, place: str) -> dict[str, np.ndarray]:
        """Conditions of the rows of a place, and their order."""
        mine = [table for table in self.tables if table.kind == place.split(".")[0]]
        columns = [{**table.conditions, "order": table.order} for table in mine]
        return {name: np.concatenate([each[name] for each in columns]) for name in columns[0]}


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

    def respond(self, design, kind, at):
        phases = {x: at.get("angle_mech", 0.0) * 5 - 2 * np.pi / 3 * k for k, x in enumerate("abc")}
        if kind == "back_emf":
            return {f"v_{x}": 0.1 * at["speed"] * np.sin(phase) for x, phase in phases.items()}
        if kind == "cogging":
            return {"torque": 0.02 * np.sin(12 * at["angle_mech"])}
        if kind == "drag":
            return {"torque": np.zeros_like(at["speed"])}
        if kind == "locked_rotor":
            return {"torque": sum(2.0 * at[f"i_{x}"] * np.cos(phase) for x, phase in phases.items())}
        if kind == "flux_linkage":
            return {f"dpsi_{x}": 1e-3 * at[f"i_{x}"] * (1 + 0.1 * np.cos(2 * phase)) for x, phase in phases.items()}
        warm = 1 + 0.00393 * (at["winding_T"] - 20.0)
        both = zip("abc", design.phase_resistance, design.lead_resistance)
        return {f"r_{x}": r * warm + lead for x, r, lead in both}


def table(kind: str, responses: tuple[str, ...], **conditions) -> Table:
    rows = len(next(iter(conditions.values())))
    nothing = np.zeros(rows)
    conditions = {name: np.asarray(values, dtype=float) for name, values in conditions.items()}
    read = {name: Response(name, nothing, np.ones(rows), "1") for name in responses}
    return Table(kind, kind, conditions, read, nothing.astype(int), nothing.astype(int), nothing.astype(bool))


def grid(**axes) -> dict[str, np.ndarray]:
    """Columns of every combination of the values of the axes, the last changing fastest."""
    columns = np.meshgrid(*(np.asarray(values, dtype=float) for values in axes.values()), indexing="ij")
    return {name: column.ravel() for name, column in zip(axes, columns)}


@cache
def damper_case() -> Case:
    both = np.array([-0.4, -0.2, -0.1, -0.05, 0.05, 0.1, 0.2, 0.4])
    tables = (
        table("damping_velocity", ("force",), **grid(shunt=[0.5, 2.0, 1e6], velocity=both, damper_T=[60.0])),
        table("back_emf", ("voltage",), velocity=both),
        table("damping_shunt", ("damping",), **grid(shunt=[0.5, 2.0, 10.0], velocity=[0.3])),
        table("impedance", ("re", "im"), **grid(shunt=[1.0], amplitude=[1e-3, 4e-3], frequency=[2, 5, 10, 20.0])),
        table("impedance", ("re", "im"), **grid(shunt=[1e6], amplitude=[1e-3, 4e-3], frequency=[2, 5, 10, 20.0])),
    )
    return Case(Model(DamperModel(), Damper(60.0, 1.2, 2.0, 20.0)), tables)


@cache
def dq_case() -> Case:
    currents = dict(i_d=[-8.0, -4.0, 4.0, 8.0], i_q=[-16.0, -8.0, 8.0, 16.0])
    warm = dict(winding_T=[100.0], magnet_T=[80.0])
    supply = dict(v_ll=[88.0, 80, 85, 95], torque=[1.0, 2, 3, 4], speed=[150.0] * 4)
    hot = {name: values * 4 for name, values in warm.items()}
    speeds = np.array([50.0, 100, 200, 300])
    tables = (
        table("dq_operation", ("v_d", "v_q", "torque"), **grid(speed=[-200, 50, 200.0], **currents, **warm)),
        table("back_emf", ("v_ll",), **grid(speed=speeds, magnet_T=[80.0])),
        table("short_circuit", ("torque", "current"), **grid(speed=speeds, **warm)),
        table("drag", ("torque",), speed=np.concatenate([-speeds, speeds])),
        table("dq_supply", ("current", "power"), **supply, **hot),
        table("phase_resistance", ("resistance",), winding_T=[20.0, 60.0, 100.0]),
    )
    return Case(Model(DqModel(), DqMachine(4, 0.1, 3e-3, 4e-3, 0.5)), tables)


@cache
def waveform_case() -> Case:
    angle = np.linspace(0, 2 * np.pi, 72, endpoint=False)
    same = np.ones_like(angle)
    currents = dict(i_a=3.0 * same, i_b=-1.0 * same, i_c=-2.0 * same)
    phases = {letter: tuple(f"{letter}_{x}" for x in "abc") for letter in ("v", "dpsi", "r")}
    tables = (
        table("back_emf", phases["v"], angle_mech=angle, speed=100 * same),
        table("cogging", ("torque",), angle_mech=angle, direction=same),
        table("drag", ("torque",), speed=[-200.0, -100.0, 100.0, 200.0]),
        table("locked_rotor", ("torque",), angle_mech=angle, **currents),
        table("flux_linkage", phases["dpsi"], angle_mech=angle, **currents),
        table("phase_resistance", phases["r"], winding_T=[20.0, 60.0, 100.0]),
    )
    return Case(Model(Waveforms(), machine_case().model.design), tables)


@cache
def machine_case() -> Case:
    mm = 1e-3
    drawn = Machine(
        12, 5, 42.5 * mm, 15.7 * mm, 3.3 * mm, 5.5 * mm, 2.5 * mm, 0.5 * mm, 2 * mm, 1.43 * mm, 1.43 * mm, 5 * mm
    )
    design = MachineAsBuilt.drawn(drawn, "35PN270", Magnet(1.3, 1.0, -0.0012, 22.0), 41 * mm, 7, 12.6e-3)
    return Case(Model(None, design), ())


@cache
def drawn_case() -> Case:
    """A machine with bridges, of which only the design is asked."""
    return Case(Model(None, DrawnBench().design({"machine_file": "prius_2004", "phase_resistance_mohm": 69.0})), ())


def cases_of(cls: type[Effect]) -> list[Case]:
    """The benches on which an effect can be tried; of the machine only its design, which needs no field solution."""
    cases = [damper_case(), dq_case(), waveform_case()]
    if issubclass(cls, DesignEffect):
        cases += [machine_case(), drawn_case()]
    return [case for case in cases if cls.can_act_on(case.model.design)]


def vanishing(effect: Effect, share: float) -> Effect:
    """The effect with every parameter brought near its null."""
    values = {name: (p.null, getattr(effect, name)) for name, p in parameters_of(effect).items()}
    return replace(effect, **{name: null + share * (value - null) for name, (null, value) in values.items()})


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
    assert 0.0 < cls.base_rate < NAMED and cls.base_rate_source, "a base rate that names nothing, and its source"
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
        whole = _distance(case.seen(effect), case.seen(null))
        assert _distance(case.seen(vanishing(effect, 1e-5)), case.seen(null)) <= 0.03 * whole + 1e-12, (
            "the effect jumps at its null"
        )


def _check_slopes(case: Case, effect: Effect, name: str, step: float) -> None:
    def at(shift):
        return case.seen(replace(effect, **{name: getattr(effect, name) + shift}))

    below, here, above = at(-step), at(0.0), at(step)
    scale = np.abs(here).max() * 1e-11
    assert _distance(above - here, here - below) <= 0.1 * _distance(above, below) + scale, f"not smooth in {name}"


def _distance(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max()) if a.size else 0.0


def check_signature(cls: type[Effect]) -> None:
    """At a typical size readings change at the places of its claims and at no other; its claims hold as it vanishes."""
    cases = [case for case in cases_of(cls) if case.tables]
    if not cases or _needs_a_field(cls):
        return  # held against the surrogate of a machine: test_machine_signatures
    assert cls.signature, "an effect claims what it does to readings"
    for case in cases:
        base, effect = case.places(), sized(first(cls, case))
        seen, small = case.places(effect), case.places(vanishing(effect, SMALL))
        for place, readings in base.items():
            touched = np.abs(seen[place] - readings).max() > NOTHING * np.abs(readings).max()
            assert touched == names(cls.signature, place), f"{place} changes: {touched}, claimed otherwise"
        for claim in cls.signature:
            for place in base:
                if fnmatch(place, claim.place):
                    error = claim.error(case.conditions(place), small[place] - base[place])
                    assert error <= claim.within, f"{claim} at {place} is off by {error:.3g}"
    unseen = [claim for claim in cls.signature if not any(names((claim,), p) for case in cases for p in case.places())]
    assert not unseen, f"no bench here can tell {unseen[0]}"


def _needs_a_field(cls: type[Effect]) -> bool:
    return cls.__module__.startswith("effects.machine.")


CHECKS: tuple[Callable[[type[Effect]], None], ...] = (
    check_declared,
    check_frozen,
    check_null,
    check_restores,
    check_acts,
    check_smooth,
    check_signature,
)
