"""A permanent-magnet machine on the bench, its truth solved by NGSolve: back-EMF, cogging, locked rotor, flux linkage
and phase resistance, of machines as ``machine_hidden`` draws them.

What the field feels (tolerances, the zero of the encoder, the gain of the current, most effects) is in the solution;
what the instruments do to it is added here. Every such bench has dry friction in its bearings that nobody declares.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from pathlib import Path

import numpy as np

from benchmarks.virtual_benches.case import GROUPS, Answer, Bench, Series
from benchmarks.virtual_benches.hiding import FREE, OUTSIDE, SEVERAL, SMALL, Layout, Setup, log_uniform, measured
from benchmarks.virtual_benches.instruments import Noise, scan_shapes, white
from benchmarks.virtual_benches.machine_hidden import MOVED, SYSTEMATIC, TOLERANCE, Solved, as_toleranced
from benchmarks.virtual_benches.machine_tables import COPPER, SPEED, WINDING, table_layout, there_and_back
from benchmarks.virtual_benches.truths import (
    DEGREE,
    DRAWINGS,
    AsBuilt,
    Drawing,
    Truth,
    coil_turns,
    revolution,
    spectrum_of,
    truth_of,
)

SOLVED = Path(__file__).parent / "solved"
RPM = np.pi / 30
EMF_STEP, COGGING_STEP = 3.0, 2.25  # deg
THERMOMETER = 0.3  # K, scatter of the logged temperature of the winding
VOLTAGE, COGGING, TORQUE, LINKAGE, RESISTANCE = 0.012, 0.0015, 0.008, 6e-6, 0.015  # V, Nm, Nm, Vs, mohm
PHASE_SCATTER = 0.004  # relative, of the resistance of a phase
FRICTION = (0.005, 0.025)  # Nm, of two sealed ball bearings
RECORDER = (60.0, 120.0)  # order of the revolution that half of the recorders pass by half
REPEATS = 3
STEP = 0.1  # standard deviations, of differences
MESH = 0.01  # relative, by which the cogging of good meshes of two codes differs
ENCODER = "encoder_zero_deg"
ZEROS = np.arange(-8.0, 8.1, 0.25)  # standard deviations by which a tolerance may explain a turned encoder


@dataclass(frozen=True)
class Reading:
    """What instruments and rig do. Gains relative, the rest SI; below the line laws that the library does not have."""

    voltage_gain: float = 0.0
    torque_gain: float = 0.0
    torque_offset: float = 0.0
    bearing_friction: float = 0.0
    end_leakage: float = 0.0
    length: float = 0.0  # relative
    resistance: tuple[float, float, float] = (0.0, 0.0, 0.0)  # relative
    recorder: float = np.inf
    mesh: float = 0.0  # cogging that a mesh makes too much, relative; of no machine
    # outside the library
    uneven_friction: float = 0.0  # changing once a revolution [Nm]
    heated: float = 0.0  # the resistance beyond its straight line at 80 K above 20 degC, relative
    voltage_bend: float = 0.0  # share by which 3 V read too much, with its square
    belt: float = 0.0  # torque of a belt that beats three times a revolution [Nm]
    range_step: float = 0.0  # share by which the torque amplifier reads more above 1 Nm
    pressed_friction: float = 0.0  # share of the torque of a locked rotor that sticks in the bearings
    ringing: float = 0.0  # torque of the cell ringing at order 23, opposite both ways [Nm]
    swing: float = 0.0  # of the speed, twice a revolution, relative
    cell_bend: float = 0.0  # share by which 5 Nm read too little, with its square


EFFECTS: Mapping[str, tuple[float, float, bool]] = {  # of ``Reading``: from, to, of either sign
    "voltage_gain": (0.008, 0.06, True),
    "torque_gain": (0.01, 0.06, True),
    "torque_offset": (0.006, 0.05, True),
    "end_leakage": (0.012, 0.1, False),
}
STRANGE: Mapping[str, tuple[str, float]] = {  # words -> field of ``Reading`` and a size to start from
    "friction that changes once a revolution": ("uneven_friction", 2e-3),
    "resistance not straight over temperature": ("heated", 5e-3),
    "voltage channels that bend": ("voltage_bend", 5e-3),
    "belt that beats": ("belt", 2e-3),
    "range switch of the torque amplifier": ("range_step", 1e-2),
    "friction pressed on by the load": ("pressed_friction", 5e-3),
    "ringing of the torque cell": ("ringing", 2e-3),
    "speed that swings": ("swing", 2e-3),
    "torque cell that bends": ("cell_bend", 5e-3),
}
TUNING_STRANGE = frozenset(list(STRANGE)[:4])


# ---- truths on disk --------------------------------------------------------------------------------------------------


@cache
def machines(which: str, folder: Path = SOLVED) -> tuple[Solved, ...]:
    """The machines "tune", "score" or "sense" that are solved, in the order of their names."""
    texts = [path.read_text(encoding="utf-8") for path in sorted(folder.glob(f"{which}-*.json"))]
    return tuple(Solved.from_plain(json.loads(text)) for text in texts)


@cache
def truth(name: str, folder: Path = SOLVED) -> Truth:
    """Torque and flux linkages of a solved machine by its name."""
    machine = next(m for m in machines(name.split("-")[0], folder) if m.name == name)
    with np.load(folder / f"{name}.npz") as arrays:
        return truth_of(DRAWINGS[machine.drawing], machine.built, arrays)


def toleranced(drawing: Drawing, z: Mapping[str, float]) -> Truth:
    """The machine as drawn with tolerances and instruments at so many standard deviations, by the square law through
    three solutions each; a turned encoder shifts what is known of the whole revolution by its angle."""
    base = truth(f"sense-{drawing.name}-drawing")
    spectrum, torque, linkage = base.spectrum, base.torque, base.linkage
    for name, size in MOVED.items():
        up, down = (truth(f"sense-{drawing.name}-{name}-{word}") for word in ("up", "down"))
        share = z.get(name, 0.0) / size
        torque = torque + _square_law(share, base.torque, up.torque, down.torque)
        linkage = linkage + _square_law(share, base.linkage, up.linkage, down.linkage)
        if name != "encoder_zero_deg":
            spectrum = spectrum + _square_law(share, base.spectrum, up.spectrum, down.spectrum)
    order = np.arange(spectrum.shape[1])
    return Truth(spectrum * np.exp(1j * order * as_toleranced(z).turned), torque, linkage)


def _square_law(share: float, here: np.ndarray, up: np.ndarray, down: np.ndarray) -> np.ndarray:
    """The change from ``here`` at a share of the way to ``up``, negative towards ``down``."""
    return share * (up - down) / 2 + share**2 * ((up + down) / 2 - here)


def evaluated(spectrum: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Sum over orders n of Re(c_n exp(i n angle)) of spectra (k, orders) at angles (m,) [rad]: (k, m)."""
    return (spectrum @ np.exp(1j * np.arange(spectrum.shape[1])[:, None] * angle)).real


# ---- readings --------------------------------------------------------------------------------------------------------


def layouts(drawing: Drawing) -> tuple[Layout, ...]:
    """The five tables of a campaign."""
    states = drawing.states()
    locked = len(drawing.locked_angles) * len(drawing.locked_currents)
    emf, cogging = (np.arange(0.0, 360.0, step) for step in (EMF_STEP, COGGING_STEP))
    return (
        table_layout("back_emf", there_and_back(emf, speed=True), {f"v_{x}_V": VOLTAGE for x in "abc"}),
        table_layout("cogging", there_and_back(cogging), {"torque_Nm": COGGING}),
        table_layout("locked_rotor", _with_currents(states[:locked]), {"torque_Nm": TORQUE}),
        table_layout("flux_linkage", _with_currents(states[locked:-1]), {f"dpsi_{x}_Vs": LINKAGE for x in "abc"}),
        table_layout("phase_resistance", {"winding_T_degC": WINDING}, {f"r_{x}_mohm": RESISTANCE for x in "abc"}),
    )


def _with_currents(states: Sequence[tuple[float, tuple[float, float, float]]]) -> dict[str, np.ndarray]:
    currents = np.array([i for _, i in states])
    angles = np.array([a for a, _ in states])
    return {"angle_mech_deg": angles} | {f"i_{x}_A": currents[:, k] for k, x in enumerate("abc")}


def readings_of(drawing: Drawing, built: AsBuilt, found: Truth, reading: Reading) -> list[dict[str, np.ndarray]]:
    """Responses of every table, one repeat, free of random error."""
    length = drawing.length("active_length") * (1 + reading.length)
    kept, locked = 1 - reading.end_leakage, len(drawing.locked_angles) * len(drawing.locked_currents)
    emf, cogging = (layout.conditions for layout in layouts(drawing)[:2])
    alone = evaluated(found.spectrum[:1], np.array(drawing.locked_angles * len(drawing.locked_currents)) * DEGREE)[0]
    torque = kept * found.torque[:locked] + kept**2 * alone
    changes = found.linkage[:, locked:-1] - found.linkage[:, -1:]
    volts = _voltages(found, reading, emf["angle_mech_deg"] * DEGREE, emf["direction"], kept * length)
    idle = _cogging(found, reading, cogging["angle_mech_deg"] * DEGREE, cogging["direction"], kept**2 * length)
    held = torque * length * (1 - reading.pressed_friction)
    return [
        {f"v_{x}_V": volts[k] for k, x in enumerate("abc")},
        {"torque_Nm": _cell(reading, idle)},
        {"torque_Nm": _cell(reading, held)},
        {f"dpsi_{x}_Vs": length * changes[k] * (1 + reading.voltage_gain) for k, x in enumerate("abc")},
        _resistances(drawing, built, reading),
    ]


def _voltages(found: Truth, reading: Reading, angle, direction, length: float) -> np.ndarray:
    """Of the phases (3, n), as the recorder shows them."""
    order = np.arange(found.spectrum.shape[1])
    passed = 1.0 / np.sqrt(1.0 + (order / reading.recorder) ** 8)
    slopes = length * evaluated(1j * order * passed * found.spectrum[1:], angle)
    volts = slopes * direction * SPEED * RPM * (1 + reading.swing * np.cos(2 * angle))
    return volts * (1 + reading.voltage_gain) * (1 + reading.voltage_bend * (volts / 3.0) ** 2)


def _cogging(found: Truth, reading: Reading, angle, direction, length: float) -> np.ndarray:
    torque = length * (1 + reading.mesh) * evaluated(found.spectrum[:1], angle)[0] + reading.belt * np.sin(3 * angle)
    braking = reading.bearing_friction + reading.uneven_friction * np.cos(angle) + reading.ringing * np.sin(23 * angle)
    return torque - direction * braking


def _cell(reading: Reading, torque: np.ndarray) -> np.ndarray:
    more = 1 + reading.range_step * 0.5 * (1 + np.tanh((np.abs(torque) - 1.0) / 0.05))
    bent = torque * more * (1 - reading.cell_bend * (torque / 5.0) ** 2)
    return bent * (1 + reading.torque_gain) + reading.torque_offset


def _resistances(drawing: Drawing, built: AsBuilt, reading: Reading) -> dict[str, np.ndarray]:
    above = WINDING - 20.0
    warm = 1 + COPPER * above + reading.heated * (above / 80.0) ** 2
    nominal, turns = float(drawing.device["phase_resistance_mohm_20degC"]), coil_turns(drawing, built)
    whole = float(drawing.device["turns_per_coil"]) * drawing.slots / 3
    wound = [sum(n for n, phase in zip(turns, drawing.phases) if phase == k) / whole for k in range(3)]
    return {f"r_{x}_mohm": nominal * wound[k] * (1 + reading.resistance[k]) * warm for k, x in enumerate("abc")}


# ---- what can be seen ------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Eye:
    """How far something stands out of noise, tolerances, instruments and scatter of mounting.

    z: where tolerances and instruments of the machine are, in standard deviations
    """

    drawing: Drawing
    noise: Noise
    z: Mapping[str, float] = field(default_factory=dict)

    @property
    def weight(self) -> float:
        """Of the fitted repeats and of the true size of the noise, on a reading over its declared uncertainty."""
        return np.sqrt(REPEATS - 1) / self.noise.scale

    def stacked(self, tables: Sequence[Mapping[str, np.ndarray]]) -> np.ndarray:
        """All responses over their uncertainty, freed of the correlation of their noise."""
        parts = [
            white(values / layout.declared({name: values})[name] * self.weight, self.noise)
            for layout, table in zip(layouts(self.drawing), tables)
            for name, values in table.items()
        ]
        return np.concatenate(parts)

    def plain(self, reading: Reading, moved: Mapping[str, float] | None = None) -> np.ndarray:
        """The machine with nothing in it, read so. moved: further standard deviations of tolerances"""
        return self.stacked(self.tables(reading, moved))

    def tables(self, reading: Reading, moved: Mapping[str, float] | None = None) -> list[dict[str, np.ndarray]]:
        """As ``readings_of``, of the machine with nothing in it."""
        z = {name: self.z.get(name, 0.0) + (moved or {}).get(name, 0.0) for name in MOVED}
        return readings_of(self.drawing, AsBuilt(), toleranced(self.drawing, z), reading)

    @cached_property
    def tolerances(self) -> np.ndarray:
        """One standard deviation of everything declared, of the phases' resistances, of the cogging that a mesh leaves
        uncertain, and of mounting (n, columns)."""
        base = self.plain(Reading())
        in_field = [(self.plain(Reading(), {n: STEP}) - base) / STEP for n in MOVED]
        small = {
            "length": TOLERANCE["active_length_mm"],
            "voltage_gain": SYSTEMATIC["voltage_gain"][1],
            "torque_gain": SYSTEMATIC["torque_gain"][1],
            "torque_offset": SYSTEMATIC["torque_offset_Nm"][1],
            "mesh": MESH,
        }
        read = [self.plain(Reading(**{name: size})) - base for name, size in small.items()]
        scatter = [Reading(resistance=tuple(PHASE_SCATTER * (k == j) for j in range(3))) for k in range(3)]
        phases = [self.plain(reading) - base for reading in scatter]
        return np.stack([*in_field, *read, *phases, *self._mounting()], axis=1)

    @cached_property
    def square_laws(self) -> np.ndarray:
        """What the square law of the tolerances leaves of machines with nothing in them (n, machines): it knows nothing
        of one tolerance beside another, nor of another mesh."""
        sound = [m for which in ("tune", "score") for m in machines(which) if not m.effects and not m.outside]
        found = []
        for machine in (m for m in sound if m.drawing == self.drawing.name):
            read = readings_of(self.drawing, machine.built, truth(machine.name), Reading())
            found.append(self.stacked(read) - Eye(self.drawing, self.noise, machine.z).plain(Reading()))
        return np.stack(found, axis=1)

    def _mounting(self) -> list[np.ndarray]:
        columns = [layout.declared(table) for layout, table in zip(layouts(self.drawing), self.tables(Reading()))]
        sizes = [u for table in columns for u in table.values()]
        found, n, row = [], sum(map(len, sizes)), 0
        for u in sizes if self.noise.remount else ():
            for shape in (scan_shapes(u) / u[:, None] * self.noise.remount / self.noise.scale).T:
                column = np.zeros(n)
                column[row : row + len(u)] = white(shape, self.noise)
                found.append(column)
            row += len(u)
        return found

    @cached_property
    def readable(self) -> np.ndarray:
        """What effects of the instruments and the friction do, of any size (n, columns)."""
        base = self.plain(Reading())
        names = (*EFFECTS, "bearing_friction")
        columns = [self.plain(Reading(**{name: 0.01})) - base for name in names]
        return np.stack([FREE * c / np.linalg.norm(c) for c in columns], axis=1)

    def chi2(self, r: np.ndarray, free: np.ndarray | None = None) -> float:
        """chi2 that is left of a change r (n,) when tolerances, and ``free`` of any size, took what they can."""
        columns = self.tolerances if free is None else np.hstack([self.tolerances, free])
        taken = np.linalg.solve(np.eye(columns.shape[1]) + columns.T @ columns, columns.T @ r)
        return float(r @ (r - columns @ taken))


# ---- one case --------------------------------------------------------------------------------------------------------


def hide(group: str, seed: int, which: str) -> tuple[Bench, Answer]:
    """One blind case of a group. which: "tune" or "score" """
    rng = np.random.default_rng([seed, GROUPS.index(group), sum(b"machine")])
    machine, added, strange = _choice(group, seed, which, rng)
    drawing, noise = DRAWINGS[machine.drawing], Noise.drawn(rng)
    eye, reading = Eye(drawing, noise, machine.z), _instruments(rng)
    sizes = {name: _size(*EFFECTS[name], rng) for name in added}
    for name, size in sizes.items():
        reading = replace(reading, **{name: getattr(reading, name) + size})
    effects = {**machine.effects, **sizes, "bearing_friction": reading.bearing_friction}
    case = _Case(eye, machine, reading)
    seen = {name: case.seen(name, effects) for name in effects}
    outside = next(iter(machine.outside), strange)
    if strange:
        reading, seen[strange] = case.sized(strange, log_uniform(OUTSIDE, rng), eye.readable)
    elif outside:
        seen[outside] = case.strange()
    reading = _Case(eye, machine, reading).with_a_small_one(which, outside, rng)
    bench = _written(eye, machine, reading, f"machine-{group}-{seed}", rng)
    return bench, Answer("machine", group, seed, effects, outside, seen, ("bearing_friction",), about=noise.told)


def _size(low: float, high: float, signed: bool, rng: np.random.Generator) -> float:
    return log_uniform((low, high), rng) * (float(rng.choice([-1.0, 1.0])) if signed else 1.0)


def _instruments(rng: np.random.Generator) -> Reading:
    """Rig and instruments within what is declared, and what is not declared: friction, recorder, resistances."""
    sigma = {name.removesuffix("_Nm"): s for name, (_, s) in SYSTEMATIC.items()}
    return Reading(
        **{
            name: sigma[name] * float(rng.standard_normal())
            for name in ("voltage_gain", "torque_gain", "torque_offset")
        },
        bearing_friction=log_uniform(FRICTION, rng),
        length=TOLERANCE["active_length_mm"] * float(rng.standard_normal()),
        resistance=tuple(float(PHASE_SCATTER * z) for z in rng.standard_normal(3)),
        recorder=log_uniform(RECORDER, rng) if rng.random() < 0.5 else np.inf,
    )


def _choice(group: str, seed: int, which: str, rng: np.random.Generator) -> tuple[Solved, tuple[str, ...], str]:
    """The machine, effects of the instruments to be added, and the strange law of the rig, empty for none."""
    there = machines(which)
    sound = [m for m in there if not m.effects and not m.outside]
    one, two = ([m for m in there if len(m.effects) == n] for n in (1, 2))
    foreign = [m for m in there if m.outside]
    laws = [name for name in STRANGE if (name in TUNING_STRANGE) == (which == "tune")]
    pick = lambda options: options[seed % len(options)]  # noqa: E731
    some = lambda n: tuple(str(name) for name in rng.choice(list(EFFECTS), n, replace=False))  # noqa: E731
    if group in ("null", "mistake"):
        return pick(sound), (), ""
    if group == "outside":
        machine, law = pick(
            [*((m, "") for m in foreign), *((sound[k % len(sound)], law) for k, law in enumerate(laws))]
        )
        return machine, (), law
    if group == "single":
        return pick([*((m, ()) for m in one), *((sound[k % len(sound)], (e,)) for k, e in enumerate(EFFECTS))]) + ("",)
    if group == "pair":
        return (pick(two), (), "") if two and seed % 3 == 0 else (pick(one), some(1), "")
    more = int(rng.choice(SEVERAL))
    return (pick(two), some(more - 2), "") if two and seed % 2 == 0 else (pick(one), some(more - 1), "")


@dataclass(frozen=True, eq=False)
class _Case:
    eye: Eye
    machine: Solved
    reading: Reading

    def read(self, reading: Reading | None = None) -> np.ndarray:
        found = truth(self.machine.name)
        return self.eye.stacked(readings_of(self.eye.drawing, self.machine.built, found, reading or self.reading))

    def in_the_field(self) -> np.ndarray:
        """What the machine does beyond its tolerances."""
        return self.read() - self.eye.plain(self.reading)

    def seen(self, name: str, effects: Mapping[str, float]) -> float:
        """chi2 of one effect beyond everything declared and beyond the others at any size."""
        free = [self._alone(other) for other in effects if other != name]
        columns = [FREE * c / max(np.linalg.norm(c), 1e-9) for c in free]
        if name in self.machine.effects and len(self.machine.effects) == 1:
            return self._beside_square_laws(columns)
        return self.eye.chi2(self._alone(name), np.stack(columns, axis=1) if columns else None)

    def _beside_square_laws(self, free: Sequence[np.ndarray]) -> float:
        """chi2 of the one effect of the field, against a machine without it: tolerances by their square laws, and the
        encoder's zero anywhere, which no straight line follows over half a slot; what the zero costs there counts from
        where it is."""
        at, read = self.eye.z.get(ENCODER, 0.0), self.read()
        columns = np.column_stack([self.eye.square_laws, *free])
        left = [self.eye.chi2(read - self.eye.plain(self.reading, {ENCODER: d}), columns) for d in ZEROS]
        return float(max(0.0, np.min(left + (at + ZEROS) ** 2 - at**2)))

    def _alone(self, name: str) -> np.ndarray:
        """What one effect does, beside the others."""
        if name not in self.machine.effects:
            return self.read() - self.read(replace(self.reading, **{name: 0.0}))
        if len(self.machine.effects) == 1:
            return self.in_the_field()
        other = next(m for m in self._halves() if name not in m.effects)
        return self.read() - _Case(self.eye, other, self.reading).read()

    def _halves(self) -> list[Solved]:
        """The same machine with either of its two effects."""
        return [m for m in machines(self.machine.name.split("-")[0]) if m.name.startswith(f"{self.machine.name}-")]

    def strange(self) -> float:
        """chi2 that the best effect of the library leaves of a strange law of the field: those of the instruments
        together, and each effect of the field wherever it may sit."""
        r = self.in_the_field()
        kept = [self.eye.chi2(r, self.eye.readable)]
        for column in imitations(self.eye):
            free = FREE * column / np.linalg.norm(column)
            rows = column != 0.0  # of the tables that are known of it
            kept.append(
                self.eye.chi2(np.where(rows, r, 0.0), np.hstack([self.eye.readable * rows[:, None], free[:, None]]))
            )
        return min(kept)

    def sized(self, words: str, chi2: float, free: np.ndarray | None = None) -> tuple[Reading, float]:
        """The reading with a strange law of that visibility beside tolerances and ``free`` of any size."""
        name, size = STRANGE[words]
        for _ in range(8):
            changed = replace(self.reading, **{name: size})
            got = max(self.eye.chi2(self.read(changed) - self.read(), free), 1e-9)
            if abs(np.log(got / chi2)) < 0.2:
                break
            size *= float(np.clip(np.sqrt(chi2 / got), 0.02, 50.0))
        return changed, got

    def with_a_small_one(self, which: str, outside: str, rng: np.random.Generator) -> Reading:
        """With one more strange law that is too small to be seen, were it taken for an effect of the library or not."""
        laws = [words for words in STRANGE if (words in TUNING_STRANGE) == (which == "tune") and words != outside]
        changed, got = self.sized(str(rng.choice(laws)), log_uniform(SMALL, rng))
        return changed if got < 2 * SMALL[1] else self.reading


def imitations(eye: Eye) -> Iterator[np.ndarray]:
    """What every solved effect of the field does to back-EMF and cogging, at every magnet or slot where it may sit
    (n,); zero in the other tables."""
    for machine in (*machines("tune"), *machines("score")):
        if machine.drawing == eye.drawing.name and len(machine.effects) == 1:
            its = Eye(eye.drawing, eye.noise, machine.z)
            there = its.tables(Reading())
            for spectrum in elsewhere(machine):
                found = replace(toleranced(eye.drawing, machine.z), spectrum=spectrum)
                idle = readings_of(eye.drawing, machine.built, found, Reading())[:2]
                yield eye.stacked([*idle, *there[2:]]) - eye.stacked(there)


def elsewhere(machine: Solved, folder: Path = SOLVED) -> Iterator[np.ndarray]:
    """Spectra of a machine with what it hides at every other magnet or slot: a rotor k poles on is the same rotor
    turned, with the opposite sign where k is odd; a stator k slots on is the same, its coils counted from there."""
    drawing, built = DRAWINGS[machine.drawing], machine.built
    with np.load(folder / f"{machine.name}.npz") as arrays:
        whole = revolution(drawing, built, arrays["no_load"])
    pole, slot = drawing.idle_edges // drawing.poles, drawing.idle_edges // drawing.slots
    if not built.rotor_is_regular:
        signs = lambda k: np.append(1.0, np.full(drawing.slots, (-1.0) ** k))[:, None]  # noqa: E731
        moved = [signs(k) * np.roll(whole, -k * pole, axis=1) for k in range(drawing.poles)]
    elif not built.stator_is_regular:
        moved = [np.roll(_coils_on(whole, k), k * slot, axis=1) for k in range(drawing.slots)]
    else:
        moved = [whole]
    for samples in moved:
        yield spectrum_of(drawing, built, samples)


def _coils_on(whole: np.ndarray, slots: int) -> np.ndarray:
    return np.vstack([whole[:1], np.roll(whole[1:], slots, axis=0)])


class _Answers:
    """As a catalogue, for ``hiding.measured``."""

    def __init__(self, tables: list[dict[str, np.ndarray]]):
        self.tables = tables

    def simulate(self, setup: Setup, state: object) -> list[dict[str, np.ndarray]]:
        return self.tables

    def drifts(self, state: object) -> dict[str, float]:
        return {}


def _written(eye: Eye, machine: Solved, reading: Reading, name: str, rng: np.random.Generator) -> Bench:
    drawing = eye.drawing
    tables = readings_of(drawing, machine.built, truth(machine.name), reading)
    setup = Setup(drawing.device, TOLERANCE, SYSTEMATIC, layouts(drawing), None, REPEATS)
    bench = measured(_Answers(tables), setup, None, eye.noise, name, rng)
    return replace(bench, tables=tuple(_as_logged(table, rng) for table in bench.tables))


def _as_logged(table: Series, rng: np.random.Generator) -> Series:
    """The winding's temperature as a thermometer shows it, not as it is."""
    if "winding_T_degC" not in table.conditions:
        return table
    warm = np.asarray(table.conditions["winding_T_degC"])
    return replace(
        table, conditions={"winding_T_degC": np.round(warm + THERMOMETER * rng.standard_normal(len(warm)), 2)}
    )
