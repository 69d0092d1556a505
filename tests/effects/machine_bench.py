"""The machine of the tests with tables of every kind, on which claims of effects are held against its surrogate."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np

from tests.effects.contract import Case, grid, table
from tests.workbench.models.machine_case import LOADED, surrogate
from workbench.models.machine.model import MachineBench
from workbench.models.model import Model

PHASES = "abc"
TURN = np.linspace(0.0, 2 * np.pi, 240, endpoint=False)


@cache
def bench() -> MachineBench:
    return replace(MachineBench(cache=None), surrogate=surrogate(), about_drawing=surrogate())


@cache
def machine_bench_case() -> Case:
    speeds = [-200.0, -100.0, -50.0, 50.0, 100.0, 200.0]
    currents = {f"i_{x}": np.array([i, i]) for x, i in zip(PHASES, LOADED.currents)}
    loaded = {"angle_mech": np.full(2, LOADED.angle), **currents}
    every = {letter: tuple(f"{letter}_{x}" for x in PHASES) for letter in ("v", "dpsi", "r")}
    tables = (
        table("back_emf", every["v"], angle_mech=TURN, speed=np.full(len(TURN), 100.0)),
        table("cogging", ("torque",), angle_mech=TURN, direction=np.ones(len(TURN))),
        table("locked_rotor", ("torque",), **loaded, direction=np.array([1.0, -1.0])),
        table("flux_linkage", every["dpsi"], **loaded),
        table("phase_resistance", every["r"], winding_T=[20.0, 80.0]),
        table("drag", ("torque",), **grid(speed=speeds)),
        table("short_circuit", ("torque", "current"), **grid(speed=speeds)),
    )
    return Case(Model(bench(), surrogate().nominal), tables)
