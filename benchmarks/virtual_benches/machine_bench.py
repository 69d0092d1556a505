"""A permanent-magnet machine on the bench: back-EMF, cogging, locked rotor, flux linkage and phase resistance."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from benchmarks.virtual_benches.case import Answer, Bench
from benchmarks.virtual_benches.hiding import Hidden, Layout, Setup, hide, measured
from benchmarks.virtual_benches.instruments import Noise
from benchmarks.virtual_benches.machine_tables import COPPER, SPEED, WINDING, table_layout, there_and_back
from benchmarks.virtual_benches.machine_truth import Expansion, FullField, with_strengths
from benchmarks.virtual_benches.truths import DRAWINGS
from effects.machine_design import MachineAsBuilt
from units import DEGREE, RPM
from workbench.models.machine.field import LoadedState
from workbench.models.machine.model import MachineBench as Model
from workbench.models.machine.spectra import averaged, evaluated, slope
from workbench.models.machine.surrogate import Surrogate

DEVICE = DRAWINGS["12-10"].device
TOLERANCE = {"remanence": 0.01, "airgap_mm": 0.04, "active_length_mm": 0.0025}
SYSTEMATIC = {
    "voltage_gain": ("gain", 0.002),
    "torque_gain": ("gain", 0.003),
    "torque_offset_Nm": ("offset", 0.0015),
    "current_gain": ("gain", 0.003),
    "encoder_zero_deg": ("offset", 0.25),
}
VOLTAGE, COGGING, TORQUE, LINKAGE, RESISTANCE = 0.012, 0.0015, 0.008, 6e-6, 0.015  # V, Nm, Nm, Vs, mohm


@dataclass(frozen=True)
class Grid:
    """Where a campaign measures: steps over the revolution and angles [deg], currents of phase A [A]."""

    emf_step: float = 3.0
    cogging_step: float = 2.25
    locked_angles: tuple[float, ...] = (6.0, 18.0, 30.0, 42.0, 54.0, 66.0)
    locked_currents: tuple[float, ...] = (40.0, 110.0)
    linkage_angle: float = 69.0
    linkage_currents: tuple[float, ...] = (-110.0, -40.0, 40.0, 110.0)

    @property
    def locked(self) -> int:
        """Rows of the locked rotor."""
        return len(self.locked_angles) * len(self.locked_currents)

    def loaded_points(self) -> tuple[np.ndarray, np.ndarray]:
        """Angles as read [rad] (n,) and phase currents as read [A] (n, 3): locked rotor, then flux linkage."""
        current, angle = (x.ravel() for x in np.meshgrid(self.locked_currents, self.locked_angles, indexing="ij"))
        angle = np.append(angle, np.full(len(self.linkage_currents), self.linkage_angle)) * DEGREE
        current = np.append(current, self.linkage_currents)
        return angle, np.stack([current, -current / 2, -current / 2], axis=1)


@dataclass(frozen=True)
class State:
    """The machine in truth and what its instruments and its rig do. Gains relative, angles in rad, the rest SI.

    places: numbers of the magnet, slot, coil and phase that a defect sits at;  direction: of a shift [rad]
    sound: the machine with its tolerances before anything is hidden in it, None for the one as drawn
    """

    machine: MachineAsBuilt
    places: tuple[int, int, int, int] = (0, 0, 0, 0)
    direction: float = 0.0
    voltage_gain: float = 0.0
    torque_gain: float = 0.0
    torque_offset: float = 0.0
    current_gain: float = 0.0
    encoder_zero: float = 0.0
    friction: float = 0.0
    coupling: float = 0.0  # torque of a coupling out of line, twice a revolution [Nm]
    crosstalk: float = 0.0  # of every voltage channel into the next
    cooling: float = 0.0  # of the magnets over a table: share by which the voltage grows
    shunt_bend: float = 0.0  # of the current reading, relative per 100 A
    uneven_friction: float = 0.0  # changing once a revolution [Nm]
    heated: float = 0.0  # the resistance beyond its straight line at 80 K above 20 degC, relative
    sound: MachineAsBuilt | None = None


def _own(name: str, state: State, size: float) -> State:
    return replace(state, **{name: getattr(state, name) + size})


def _machine(change: Callable[[State, float], MachineAsBuilt], state: State, size: float) -> State:
    return replace(state, machine=change(state, size))


def _hidden(low: float, high: float, change: Callable[[State, float], MachineAsBuilt], **how: bool) -> Hidden:
    return Hidden(low, high, partial(_machine, change), **how)


def _shifted(name: str, state: State, share: float) -> MachineAsBuilt:
    m = state.machine
    amount = share * m.machine.airgap
    return replace(m, **{name: (amount * np.cos(state.direction), amount * np.sin(state.direction))})


def _remanence(state: State, factor: float) -> MachineAsBuilt:
    return state.machine.with_magnet(remanence=state.machine.magnet.remanence * factor)


def _replaced(name: str, change: Callable[[float, float], float], state: State, size: float) -> MachineAsBuilt:
    return replace(state.machine, **{name: change(getattr(state.machine, name), size)})


def _dimension(name: str, sign: float, state: State, size: float) -> MachineAsBuilt:
    return state.machine.with_machine(**{name: getattr(state.machine.machine, name) + sign * size})


def _one(name: str, place: int, state: State, size: float) -> MachineAsBuilt:
    return state.machine.with_one(name, state.places[place], size)


_PLUS, _MINUS = (lambda value, size: value + size), (lambda value, size: value - size)
_TIMES = lambda value, size: value * (1 + size)  # noqa: E731


class MachineBench:
    """See ``hiding.Catalogue``. Sizes in the unit of the first parameter of the library's effect.

    cache: folder for field solutions;  grid: where is measured
    """

    name = "machine"
    effects: Mapping[str, Hidden] = {
        "magnet_temperature": _hidden(8.0, 70.0, lambda s, x: _remanence(s, 1 - 0.0012 * x)),
        "recoil_permeability": _hidden(
            0.01, 0.1, lambda s, x: s.machine.with_magnet(recoil_permeability=s.machine.magnet.recoil_permeability + x)
        ),
        "airgap_change": _hidden(0.03e-3, 0.12e-3, partial(_dimension, "airgap", 1.0)),
        "static_eccentricity": _hidden(0.1, 0.4, partial(_shifted, "stator_shift")),
        "dynamic_eccentricity": _hidden(0.1, 0.4, partial(_shifted, "rotor_shift")),
        "lamination_stacking": _hidden(0.01, 0.08, partial(_replaced, "stacking_factor", _MINUS)),
        "cut_edge_damage": _hidden(0.1, 0.7, partial(_replaced, "edge_damage", _PLUS)),
        "weak_magnet": _hidden(0.02, 0.25, lambda s, x: with_strengths(s.machine, {s.places[0]: x})),
        "magnet_position": _hidden(0.1 * DEGREE, 1.0 * DEGREE, partial(_one, "magnet_turns", 0), signed=True),
        "magnet_arc": _hidden(0.01, 0.1, partial(_dimension, "magnet_arc_fraction", -1.0)),
        "slot_opening": _hidden(0.03e-3, 0.4e-3, partial(_dimension, "slot_opening", 1.0), signed=True),
        "wide_slot": _hidden(0.05e-3, 0.6e-3, partial(_one, "opening_changes", 1), signed=True),
        "rotor_skew": _hidden(0.3 * DEGREE, 4 * DEGREE, partial(_replaced, "skew", _PLUS)),
        "end_leakage": _hidden(0.01, 0.1, partial(_replaced, "end_leakage", _PLUS)),
        "steel_saturation": _hidden(0.01, 0.06, partial(_replaced, "saturation_scale", _TIMES), signed=True),
        "steel_grade": _hidden(0.05, 0.8, partial(_replaced, "field_scale", _TIMES)),
        "lost_turns": _hidden(0.1, 1.5, lambda s, x: s.machine.without_turns(s.places[2], x)),
        "phase_imbalance": _hidden(
            0.003, 0.05, lambda s, x: s.machine.with_phase_turns(s.places[3], 1 + x), signed=True
        ),
        "magnetisation_pattern": _hidden(0.05, 0.5, partial(_replaced, "radial_share", _PLUS), signed=True),
        "bearing_friction": Hidden(1e-3, 0.03, partial(_own, "friction")),
        "voltage_gain": Hidden(0.008, 0.06, partial(_own, "voltage_gain"), signed=True),
        "torque_gain": Hidden(0.01, 0.06, partial(_own, "torque_gain"), signed=True),
        "torque_offset": Hidden(0.006, 0.05, partial(_own, "torque_offset"), signed=True),
        "current_gain": Hidden(0.012, 0.06, partial(_own, "current_gain"), signed=True),
        "encoder_zero": Hidden(1.0 * DEGREE, 2.5 * DEGREE, partial(_own, "encoder_zero"), signed=True),
    }
    outside: Mapping[str, Hidden] = {
        "coupling out of line": Hidden(2e-3, 2e-3, partial(_own, "coupling")),
        "crosstalk of the voltage channels": Hidden(2e-3, 2e-3, partial(_own, "crosstalk")),
        "magnets cool down during a table": Hidden(5e-3, 5e-3, partial(_own, "cooling")),
        "bent current shunt": Hidden(5e-3, 5e-3, partial(_own, "shunt_bend")),
        "friction that changes once a revolution": Hidden(2e-3, 2e-3, partial(_own, "uneven_friction")),
        "resistance not straight over temperature": Hidden(5e-3, 5e-3, partial(_own, "heated")),
    }

    def __init__(self, cache: Path | None = None, grid: Grid = Grid()):
        self.cache, self.grid = cache, grid
        self.last: State | None = None  # that was simulated
        self.solved: dict[State, list[dict[str, np.ndarray]]] = {}  # readings by field solutions instead

    @cached_property
    def drawn(self) -> MachineAsBuilt:
        return Model(cache=None).design(DEVICE)

    @cached_property
    def truth(self) -> Expansion:
        return Expansion(self.drawn, self._states(), self.cache)

    def setup(self, rng: np.random.Generator) -> Setup:
        places = tuple(int(rng.integers(n)) for n in (10, 12, 12, 3))
        state = State(self.drawn, places, float(rng.uniform(-np.pi, np.pi)))
        return Setup(DEVICE, TOLERANCE, SYSTEMATIC, _layouts(self.grid), state, 3)

    def moved(self, setup: Setup, state: State, name: str, z: float) -> State:
        if name in SYSTEMATIC:
            unit = DEGREE if name.endswith("_deg") else 1.0
            return _own(name.removesuffix("_Nm").removesuffix("_deg"), state, SYSTEMATIC[name][1] * unit * z)
        factor = 1 + TOLERANCE[name] * z
        if name == "remanence":
            return replace(state, machine=_remanence(state, factor))
        if name == "airgap_mm":
            return replace(state, machine=state.machine.with_machine(airgap=state.machine.machine.airgap * factor))
        return replace(state, machine=replace(state.machine, length=state.machine.length * factor))

    def settled(self, state: State) -> State:
        """With the tolerances as they are: what is hidden from here on is expanded about this machine."""
        return replace(state, sound=state.machine)

    def simulate(self, setup: Setup, state: State) -> list[dict[str, np.ndarray]]:
        self.last = state
        if state in self.solved:
            return self.solved[state]
        return _readings(state, _Expanded(self._surrogate(state.sound)), self.grid)

    def _surrogate(self, sound: MachineAsBuilt | None) -> Surrogate:
        return self.truth.about_drawing if sound is None else self.truth.about(sound)

    def drifts(self, state: State) -> dict[str, float]:
        return {}

    def _states(self) -> list[LoadedState]:
        angle, currents = self.grid.loaded_points()
        found = {LoadedState(float(a), tuple(map(float, i))): None for a, i in zip(angle, currents)}
        return [*found, LoadedState(self.grid.linkage_angle * DEGREE, (0.0, 0.0, 0.0))]


def hide_in_full_field(
    bench: MachineBench, group: str, seed: int, wanted: tuple[str, ...] = ()
) -> tuple[Bench, Answer]:
    """As ``hide``, with what the instruments see from field solutions of the very machine."""
    hide(bench, group, seed, wanted)
    state = bench.last
    bench.solved[state] = _readings(state, FullField(bench.drawn), bench.grid)
    return hide(bench, group, seed, wanted)


def measured_in_full_field(bench: MachineBench, hidden: Mapping[str, float], seed: int) -> Bench:
    """A campaign of a machine that hides effects of given sizes, by name; tolerances, instruments and noise are drawn.

    All from field solutions of the very machine, which takes seconds; nothing is left out besides.
    """
    rng = np.random.default_rng(seed)
    setup, noise = bench.setup(rng), Noise.drawn(rng)
    state = setup.state
    for name in [*setup.tolerance, *setup.systematic]:
        state = bench.moved(setup, state, name, float(rng.standard_normal()))
    for name, size in hidden.items():
        state = bench.effects[name].apply(state, size)
    bench.solved[state] = _readings(state, FullField(bench.drawn), bench.grid)
    return measured(bench, setup, state, noise, f"{bench.name}-{seed}", rng)


@dataclass(frozen=True, eq=False)
class _Expanded:
    """What ``FullField`` answers, from an expansion."""

    surrogate: Surrogate

    def no_load(self, design: MachineAsBuilt, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        spectrum = averaged(self.surrogate.spectrum(design), design.skew)
        return design.length * evaluated(spectrum[:1], angle)[0], design.length * evaluated(slope(spectrum[1:]), angle)

    def loaded(self, design: MachineAsBuilt, angle: np.ndarray, currents: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        found = design.length * self.surrogate.with_current(design, angle, currents).T
        return found[0], found[1:]


# ---- what the instruments see ---------------------------------------------------------------------------------------


def _readings(state: State, solver, grid: Grid) -> list[dict[str, np.ndarray]]:
    emf, cogging = _layouts(grid)[:2]
    angle, direction = _true_angle(state, emf.conditions["angle_mech_deg"]), emf.conditions["direction"]
    kept = 1 - state.machine.end_leakage
    slopes = kept * solver.no_load(state.machine, angle)[1]
    voltages = slopes * direction * SPEED * RPM * (1 + state.cooling * np.linspace(-0.5, 0.5, len(angle)))
    seen = (voltages + state.crosstalk * np.roll(voltages, 1, axis=0)) * (1 + state.voltage_gain)
    answers = [{f"v_{x}_V": seen[k] for k, x in enumerate("abc")}]
    angle, direction = _true_angle(state, cogging.conditions["angle_mech_deg"]), cogging.conditions["direction"]
    torque = kept**2 * solver.no_load(state.machine, angle)[0] + state.coupling * np.sin(2 * angle)
    torque = torque - direction * (state.friction + state.uneven_friction * np.cos(angle))
    answers.append({"torque_Nm": torque * (1 + state.torque_gain) + state.torque_offset})
    return answers + _loaded_readings(state, solver, kept, grid) + [_resistances(state)]


def _loaded_readings(state: State, solver, kept: float, grid: Grid) -> list[dict[str, np.ndarray]]:
    read, currents = grid.loaded_points()
    angle = read - state.encoder_zero
    true = currents / (1 + state.current_gain) * (1 + state.shunt_bend * np.abs(currents) / 100)
    torque, linkage = solver.loaded(state.machine, angle, true)
    locked = grid.locked
    alone = solver.no_load(state.machine, angle[:locked])[0]
    torque = kept * (torque[:locked] - alone) + kept**2 * alone
    idle = solver.loaded(state.machine, angle[locked:], 0 * true[locked:])[1]
    changes = linkage[:, locked:] - idle
    return [
        {"torque_Nm": torque * (1 + state.torque_gain) + state.torque_offset},
        {f"dpsi_{x}_Vs": changes[k] for k, x in enumerate("abc")},
    ]


def _resistances(state: State) -> dict[str, np.ndarray]:
    above = WINDING - 20.0
    warm = 1 + COPPER * above + state.heated * (above / 80.0) ** 2
    return {f"r_{x}_mohm": 1e3 * state.machine.phase_resistance[k] * warm for k, x in enumerate("abc")}


def _true_angle(state: State, reading: np.ndarray) -> np.ndarray:
    return reading * DEGREE - state.encoder_zero


def _layouts(grid: Grid) -> tuple[Layout, ...]:
    angle, currents = grid.loaded_points()
    parts = slice(grid.locked), slice(grid.locked, None)
    loaded = [_with_currents(angle[part], currents[part]) for part in parts]
    emf, cogging = (np.arange(0.0, 360.0, step) for step in (grid.emf_step, grid.cogging_step))
    return (
        table_layout("back_emf", there_and_back(emf, speed=True), {f"v_{x}_V": VOLTAGE for x in "abc"}),
        table_layout("cogging", there_and_back(cogging), {"torque_Nm": COGGING}),
        table_layout("locked_rotor", loaded[0], {"torque_Nm": TORQUE}),
        table_layout("flux_linkage", loaded[1], {f"dpsi_{x}_Vs": LINKAGE for x in "abc"}),
        table_layout("phase_resistance", {"winding_T_degC": WINDING}, {f"r_{x}_mohm": RESISTANCE for x in "abc"}),
    )


def _with_currents(angle: np.ndarray, currents: np.ndarray) -> dict[str, np.ndarray]:
    return {"angle_mech_deg": angle / DEGREE} | {f"i_{x}_A": currents[:, k] for k, x in enumerate("abc")}
