"""Builds the surrogate of a machine from field solutions; on disk every loaded state is kept apart."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

import geometry
import magnetostatics
import materials
from disk import write_atomically
from effects.machine_design import MachineAsBuilt
from geometry.half_cell import MeshDensity
from materials.library import load_steel
from materials.reluctivity import Reluctivity
from units import DEGREE
from workbench.models.machine.expansion import Changes, loaded_changes, no_load_changes, steps_of_work
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.surrogate import LoadedSamples, Surrogate, coefficients

_ANGLE_STEP = 0.6 * DEGREE  # to both sides of a loaded state, for two derivatives; cogging turns over in 3 degrees
_SCALE_STEP = 0.04  # of its currents
_ORDERS = 240  # of the functions over the revolution

Tick = Callable[[], None]


@dataclass(frozen=True)
class MeshPlan:
    """base: of the values themselves;  idle, loaded: of what is added to them, without and with current.

    With the defaults the base holds cogging to 1 %, torque to 3e-4 and flux linkage to 3e-4 of their largest values
    (12 slots, 10 poles, against four times as many elements).
    """

    base: MeshDensity = MeshDensity(gap_edges=720, gap_layers=3, across_iron=3.0)
    idle: MeshDensity = MeshDensity(gap_edges=360)
    loaded: MeshDensity = MeshDensity(gap_edges=240)


class SurrogateBuilder:
    """Makes surrogates of one nominal machine.

    cache: folder for what has been solved; None keeps nothing;  steel: from the grade's name to its law
    """

    def __init__(
        self,
        nominal: MachineAsBuilt,
        plan: MeshPlan = MeshPlan(),
        cache: Path | None = None,
        steel: Callable[[str], Reluctivity] = load_steel,
    ):
        self.nominal, self.plan = nominal, plan
        meshes = (plan.base, plan.idle, plan.loaded)
        self.base, self.idle, self.loaded = (MachineField(nominal, density, steel) for density in meshes)
        self._about: tuple | None = None
        self.folder = cache / f"machine-{_key(nominal, plan, steel)}" if cache else None

    def build(self, states: Sequence[LoadedState], progress: Callable[[str], None] | None = None) -> Surrogate:
        """The surrogate with the given loaded states; solves what is not on disk yet."""
        known = {state: found for state in states if (found := self._load(_state_name(state))) is not None}
        missing = [state for state in states if state not in known]
        idle = self._load("no_load")
        tick = _ticker(progress, steps_of_work(len(missing), self.nominal) if idle is None or missing else 0)
        if idle is None:
            idle = self._save("no_load", self._solve_idle(tick))
        for state, found in self._solve_states(missing, tick).items():
            known[state] = self._save(_state_name(state), found)
        return self._joined(idle, [known[state] for state in states], states)

    def _solve_idle(self, tick: Tick) -> dict[str, np.ndarray]:
        changes = no_load_changes(self.idle, tick)
        fine = coefficients(self.base.no_load(self.nominal), _ORDERS)
        self._forget()
        return {"fine": fine} | _flat(changes, lambda rows: coefficients(rows, _ORDERS))

    def _solve_states(self, states: Sequence[LoadedState], tick: Tick) -> dict[LoadedState, dict[str, np.ndarray]]:
        if not states:
            return {}
        changes = _flat(loaded_changes(self.loaded, states, tick))
        changes["fine"] = self.base.loaded(self.nominal, states)
        changes["angle"] = self._derivatives(states, _ANGLE_STEP, _turned)
        changes["scale"] = self._derivatives(states, _SCALE_STEP, _scaled)
        self._forget()
        return {state: {name: rows[k] for name, rows in changes.items()} for k, state in enumerate(states)}

    def _forget(self) -> None:
        """Give the factorisations of all rotor positions back."""
        for fields in (self.base, self.idle, self.loaded):
            fields.forget()

    def _derivatives(self, states: Sequence[LoadedState], step: float, moved) -> np.ndarray:
        """First and second derivative (states, 2, 1 + coils)."""
        forward, here, back = (
            self.loaded.loaded(self.nominal, [moved(s, sign * step) for s in states]) for sign in (1, 0, -1)
        )
        return np.stack([(forward - back) / (2 * step), (forward - 2 * here + back) / step**2], axis=1)

    def _joined(self, idle: Mapping, found: list[Mapping], states: Sequence[LoadedState]) -> Surrogate:
        if not states:
            return Surrogate(self.nominal, idle["fine"], _changes(idle), None, None)
        rows = {name: np.array([one[name] for one in found]) for name in found[0]}
        changes = _changes(rows)
        coils = np.stack([changes.linear[f"coil[{k}]"] for k in range(rows["fine"].shape[1] - 1)], axis=1)
        places = np.array([(state.angle, *state.currents) for state in states])
        samples = LoadedSamples(places, rows["fine"], rows["angle"].swapaxes(0, 1), rows["scale"].swapaxes(0, 1), coils)
        return Surrogate(self.nominal, idle["fine"], _changes(idle), changes, samples)

    def about(self, surrogate: Surrogate, design: MachineAsBuilt) -> Surrogate:
        """The surrogate moved to another design by field solutions: exact there, with the old derivatives."""
        if self._about is None or self._about[0] != (id(surrogate), design):
            self._about = (id(surrogate), design), self._moved(surrogate, design)
        return self._about[1]

    def _moved(self, surrogate: Surrogate, design: MachineAsBuilt) -> Surrogate:
        idle = coefficients(self.idle.no_load(design), _ORDERS) - surrogate.idle.base
        no_load = surrogate.no_load.copy()
        no_load[:, : idle.shape[1]] += idle
        samples = surrogate.states
        if samples is not None:
            states = [LoadedState(row[0], tuple(row[1:])) for row in samples.states.tolist()]
            samples = replace(samples, base=samples.base + self.loaded.loaded(design, states) - surrogate.loaded.base)
        return replace(surrogate, origin=design, no_load=no_load, states=samples)

    # ---- on disk ------------------------------------------------------------------------------------------------

    def _load(self, name: str) -> dict[str, np.ndarray] | None:
        """What was kept; None where nothing was, or where it cannot be read."""
        if self.folder is None:
            return None
        try:
            with np.load(self.folder / f"{name}.npz", allow_pickle=False) as data:
                return dict(data)
        except (OSError, ValueError, EOFError, KeyError, BadZipFile):
            return None

    def _save(self, name: str, found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        if self.folder is not None:
            write_atomically(self.folder / f"{name}.npz", lambda path: np.savez(path, **found))
        return found


def _turned(state: LoadedState, change: float) -> LoadedState:
    return LoadedState(state.angle + change, state.currents)


def _scaled(state: LoadedState, change: float) -> LoadedState:
    a, b, c = (current * (1 + change) for current in state.currents)
    return LoadedState(state.angle, (a, b, c))


def _flat(changes: Changes, each: Callable[[np.ndarray], np.ndarray] = lambda rows: rows) -> dict[str, np.ndarray]:
    """One flat dictionary of arrays, as a file holds them."""
    parts = {"base": changes.base}
    parts |= {f"linear {name}": rows for name, rows in changes.linear.items()}
    parts |= {f"secant {name}": rows for name, rows in changes.secant.items()}
    return {name: each(rows) for name, rows in parts.items()}


def _changes(parts: Mapping[str, np.ndarray]) -> Changes:
    def of(kind: str) -> dict[str, np.ndarray]:
        return {name.removeprefix(kind + " "): rows for name, rows in parts.items() if name.startswith(kind + " ")}

    return Changes(parts["base"], of("linear"), of("secant"))


def _state_name(state: LoadedState) -> str:
    currents = "_".join(f"{current:.4f}" for current in state.currents)
    return f"state_{state.angle / DEGREE:.4f}_{currents}"


def _key(nominal: MachineAsBuilt, plan: MeshPlan, steel: Callable) -> str:
    """Of the machine, the meshes and every line of code and every material curve that the solutions depend on."""
    digest = hashlib.sha256(json.dumps([repr(nominal), repr(plan), steel.__module__ + steel.__name__]).encode())
    folders = [Path(package.__file__).parent for package in (geometry, magnetostatics, materials)]
    files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.suffix in (".py", ".csv")]
    here = Path(__file__).parent
    own = [here / f"{part}.py" for part in ("field", "coordinates", "expansion", "build")]
    for path in files + own:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def _ticker(progress: Callable[[str], None] | None, total: int) -> Tick:
    done = [0]

    def tick() -> None:
        done[0] += 1
        if progress is not None:
            progress(f"field solutions: step {done[0]} of {total}")

    return tick
