"""Machines whose bench truth NGSolve computes, as its program reads them: drawings, steel, winding, states.

The numbers of a drawing are those of ``[device]``; the angles, signs and coils are those that every campaign of a
machine has (x axis through tooth 0, coil k on tooth k, positive current outwards, north magnet on tooth 0 at angle 0).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import lcm, pi
from pathlib import Path

import numpy as np
from scipy.interpolate import Akima1DInterpolator

PROJECT = Path(__file__).resolve().parent.parent.parent
MILLIMETRE, DEGREE = 1e-3, pi / 180
MU_0 = 4e-7 * pi
HIGHEST = 4.0  # T, end of the table of the steel; beyond it the last line goes on
SAMPLES = 4000  # of the curve, from which the points of the table are taken
LINES = 3e-4  # relative error of the straight lines between them
IDLE_EDGES = 2  # times as many edges of the sliding circle without current: twelve or ten places in a period of cogging


@dataclass(frozen=True, eq=False)
class Drawing:
    """One kind of machine as drawn. device: the table of a campaign;  edges: of the sliding circle, with current

    locked_angles, locked_currents, linkage_angle, linkage_currents: states with current, in degrees and amperes, the
    angles whole edges of the sliding circle
    """

    name: str
    device: Mapping[str, object]
    edges: int
    locked_angles: tuple[float, ...]
    locked_currents: tuple[float, ...]
    linkage_angle: float
    linkage_currents: tuple[float, ...]
    phases: tuple[int, ...]  # of every coil, 0 to 2
    signs: tuple[int, ...]

    @property
    def slots(self) -> int:
        return int(self.device["slots"])

    @property
    def poles(self) -> int:
        return int(self.device["poles"])

    @property
    def idle_edges(self) -> int:
        """Of the sliding circle without current: cogging asks for a finer mesh of the gap, and for more angles."""
        return IDLE_EDGES * self.edges

    def length(self, key: str) -> float:
        """A length of the drawing [m]."""
        return float(self.device[f"{key}_mm"]) * MILLIMETRE

    def states(self) -> list[tuple[float, tuple[float, float, float]]]:
        """(angle as read [deg], currents as read [A]): locked rotor, flux linkage, and that angle without current."""
        rows = [(a, _star(i)) for i in self.locked_currents for a in self.locked_angles]
        rows += [(self.linkage_angle, _star(i)) for i in self.linkage_currents]
        return [*rows, (self.linkage_angle, (0.0, 0.0, 0.0))]


def _star(current: float) -> tuple[float, float, float]:
    """Phase A against the other two."""
    return current, -current / 2, -current / 2


@dataclass(frozen=True)
class AsBuilt:
    """What differs from the drawing in one machine. Relative where nothing else is said.

    turned: of the rotor against the reading of the angle [rad];  current: true over read current, minus one
    """

    remanence: float = 0.0
    airgap: float = 0.0  # of a bore that is ground, the slots stay
    recoil: float = 0.0  # added to the recoil permeability
    turned: float = 0.0
    current: float = 0.0
    current_bend: float = 0.0  # of the true current, at 100 A, in proportion to the current
    stator_shift: tuple[float, float] = (0.0, 0.0)  # m
    rotor_shift: tuple[float, float] = (0.0, 0.0)  # m
    weak: Mapping[int, float] = field(default_factory=dict)  # magnet -> share of its remanence that is gone
    turns_of_magnets: Mapping[int, float] = field(default_factory=dict)  # magnet -> rad
    tilts: Mapping[int, float] = field(default_factory=dict)  # magnet -> rad, of its magnetisation alone
    magnet_arc: float = 0.0  # added to the arc fraction
    slot_opening: float = 0.0  # m, of all slots
    openings: Mapping[int, float] = field(default_factory=dict)  # slot -> m
    plugs: Mapping[int, float] = field(default_factory=dict)  # slot -> permeability of what lies in its opening
    saturation: float = 0.0  # of the steel's polarisation
    field_scale: float = 0.0  # of H at the same polarisation
    stacking: float = 0.0  # added to the stacking factor of 1
    radial_share: float = 0.0
    skew: float = 0.0  # rad
    turns: Mapping[int, float] = field(default_factory=dict)  # coil -> turns that are missing
    phase_turns: Mapping[int, float] = field(default_factory=dict)  # phase -> factor minus one

    @property
    def rotor_is_regular(self) -> bool:
        return not (any(self.rotor_shift) or self.weak or self.turns_of_magnets or self.tilts)

    @property
    def stator_is_regular(self) -> bool:
        return not (any(self.stator_shift) or self.openings or self.plugs)

    def __add__(self, other: AsBuilt) -> AsBuilt:
        """Both at once."""
        merged = {}
        for name in self.__dataclass_fields__:
            one, two = getattr(self, name), getattr(other, name)
            if isinstance(one, Mapping):
                merged[name] = {**one, **two}
            elif isinstance(one, tuple):
                merged[name] = tuple(a + b for a, b in zip(one, two))
            else:
                merged[name] = (1 + one) * (1 + two) - 1 if name in ("remanence", "current") else one + two
        return AsBuilt(**merged)


def window(drawing: Drawing, built: AsBuilt) -> int:
    """Edges without current that the rotor has to turn by until the symmetry of the machine gives the rest."""
    parts = {
        (True, True): lcm(drawing.slots, drawing.poles),
        (True, False): drawing.slots,
        (False, True): drawing.poles,
        (False, False): 1,
    }[built.stator_is_regular, built.rotor_is_regular]
    return drawing.idle_edges // parts


def coil_turns(drawing: Drawing, built: AsBuilt) -> np.ndarray:
    """Of every coil (coils,)."""
    nominal = float(drawing.device["turns_per_coil"])
    per_phase = np.array([1 + built.phase_turns.get(phase, 0.0) for phase in drawing.phases])
    return nominal * per_phase - np.array([built.turns.get(k, 0.0) for k in range(drawing.slots)])


def description(drawing: Drawing, built: AsBuilt, no_load: bool = True) -> dict:
    """The machine for ``ngsolve_machine.py``."""
    d, n, p = drawing.device, drawing.slots, drawing.poles
    gap = drawing.length("airgap")
    b2, nu = steel_table(str(d["steel"]), built)
    return {
        "slots": n,
        "poles": p,
        "edges": drawing.edges,
        "idle_edges": drawing.idle_edges,
        "window": window(drawing, built) if no_load else 0,
        "stator_radius": drawing.length("stator_outer_radius"),
        "rotor_radius": drawing.length("rotor_outer_radius"),
        "back_iron": drawing.length("back_iron_width"),
        "tooth_width": drawing.length("tooth_width"),
        "magnet_length": drawing.length("magnet_length"),
        "drawn_airgap": gap,
        "airgap": gap * (1 + built.airgap),
        "slot_opening": drawing.length("slot_opening") + built.slot_opening,
        "opening_changes": [built.openings.get(k, 0.0) for k in range(n)],
        "opening_mu": [built.plugs.get(k, 1.0) for k in range(n)],
        "shoe_d1": drawing.length("shoe_d1"),
        "shoe_d2": drawing.length("shoe_d2"),
        "shaft_radius": drawing.length("shaft_radius"),
        "magnet_arc": float(d.get("magnet_arc_fraction", 1.0)) + built.magnet_arc,
        "magnet_turns": [built.turns_of_magnets.get(k, 0.0) for k in range(p)],
        "magnet_tilts": [built.tilts.get(k, 0.0) for k in range(p)],
        "strengths": [1 - built.weak.get(k, 0.0) for k in range(p)],
        "radial_share": built.radial_share,
        "remanence": float(d["remanence_T"]) * (1 + built.remanence),
        "recoil": float(d["recoil_permeability"]) + built.recoil,
        "stator_shift": list(built.stator_shift),
        "rotor_shift": list(built.rotor_shift),
        "turned": built.turned,
        "b2": b2.tolist(),
        "nu": nu.tolist(),
        "states": _states(drawing, built),
    }


def _states(drawing: Drawing, built: AsBuilt) -> list[dict]:
    turns, found = coil_turns(drawing, built), []
    for angle, read in drawing.states():
        steps = angle * DEGREE / (2 * pi / drawing.edges)
        if abs(steps - round(steps)) > 1e-6:
            raise ValueError(f"{angle} deg is no whole number of edges of the sliding circle")
        currents = [i * (1 + built.current) * (1 + built.current_bend * abs(i) / 100) for i in read]
        ampere_turns = [s * n * currents[k] for s, n, k in zip(drawing.signs, turns, drawing.phases)]
        found.append({"steps": round(steps), "ampere_turns": ampere_turns, "slices": _slices(built.skew)})
    return found


def _slices(skew: float) -> list[tuple[float, float]]:
    """(angle from the middle [rad], share of the length) along a skewed machine."""
    if not skew:
        return [(0.0, 1.0)]
    nodes, weights = np.polynomial.legendre.leggauss(3)
    return [(float(x * skew / 2), float(w / 2)) for x, w in zip(nodes, weights)]


def steel_table(grade: str, built: AsBuilt) -> tuple[np.ndarray, np.ndarray]:
    """(b2 [T^2], nu [m/H]) of the steel of this machine: Akima's curve through the points in B, H.

    Saturation stretches the curve along its lines of constant permeability; another grade needs more H for the same
    polarisation; a stacked core shares the flux with the air between its sheets.
    """
    path = PROJECT / "materials" / "steels" / f"{grade}_bh.csv"
    rows = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines() if line[:1].isdigit()]
    h, b = np.array(rows, dtype=float).T
    polarisation = (b - MU_0 * h) * (1 + built.saturation)
    h = h * (1 + built.saturation) * (1 + built.field_scale)
    b = (1 + built.stacking) * polarisation + MU_0 * h
    curve = Akima1DInterpolator(b, h, method="makima")
    grid = np.concatenate([np.linspace(0.0, b[-1], SAMPLES), np.linspace(b[-1], HIGHEST, SAMPLES)[1:]])
    field_strength = np.where(grid <= b[-1], curve(np.minimum(grid, b[-1])), h[-1] + (grid - b[-1]) / MU_0)
    nu = np.empty_like(grid)
    nu[1:] = field_strength[1:] / grid[1:]
    nu[0] = nu[1]
    chosen = _lines(grid**2, nu)
    return grid[chosen] ** 2, nu[chosen]


def _lines(at: np.ndarray, values: np.ndarray) -> list[int]:
    """Points between which straight lines keep within ``LINES`` of the values: the fewer, the sooner they are found."""
    chosen = [0]
    while chosen[-1] < len(at) - 1:
        start, reach = chosen[-1], 1
        while start + reach + 1 < len(at) and _holds(at, values, start, start + reach + 1):
            reach += max(reach // 4, 1) if start + reach + 1 + reach // 4 < len(at) else 1
        while reach > 1 and (start + reach >= len(at) or not _holds(at, values, start, start + reach)):
            reach -= 1
        chosen.append(start + reach)
    return chosen


def _holds(at: np.ndarray, values: np.ndarray, start: int, end: int) -> bool:
    part = slice(start, end + 1)
    line = np.interp(at[part], at[[start, end]], values[[start, end]])
    return bool(np.all(np.abs(line - values[part]) <= LINES * values[part]))


def star_of_slots(slots: int, poles: int) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Phase and sign of the coil on every tooth: sectors of 60 electrical degrees, A+ about zero."""
    belts = ((0, 1), (2, -1), (1, 1), (0, -1), (2, 1), (1, -1))
    steps = [(k * poles * 180 + 30 * slots) % (360 * slots) // (60 * slots) for k in range(slots)]
    return tuple(belts[s][0] for s in steps), tuple(belts[s][1] for s in steps)


def _drawing(name: str, device: Mapping[str, object], edges: int, **states) -> Drawing:
    phases, signs = star_of_slots(int(device["slots"]), int(device["poles"]))
    if edges % lcm(int(device["slots"]), int(device["poles"])):
        raise ValueError(f"{name}: {edges} edges are not whole in every slot and every pole")
    return Drawing(name, device, edges, phases=phases, signs=signs, **states)


TWELVE_TEN = _drawing(
    "12-10",
    {
        "slots": 12,
        "poles": 10,
        "stator_outer_radius_mm": 42.5,
        "rotor_outer_radius_mm": 15.7,
        "back_iron_width_mm": 3.3,
        "tooth_width_mm": 5.5,
        "magnet_length_mm": 2.5,
        "airgap_mm": 0.5,
        "slot_opening_mm": 2.0,
        "shoe_d1_mm": 1.43,
        "shoe_d2_mm": 1.43,
        "shaft_radius_mm": 5.0,
        "magnetisation": "parallel",
        "remanence_T": 1.30,
        "remanence_coefficient_percent_per_K": -0.12,
        "recoil_permeability": 1.0,
        "steel": "35PN270",
        "active_length_mm": 41.0,
        "turns_per_coil": 7,
        "phase_resistance_mohm_20degC": 12.6,
    },
    edges=360,
    locked_angles=(6.0, 18.0, 30.0, 42.0, 54.0, 66.0),
    locked_currents=(40.0, 110.0),
    linkage_angle=69.0,
    linkage_currents=(-110.0, -40.0, 40.0, 110.0),
)
NINE_EIGHT = _drawing(
    "9-8",
    {
        "slots": 9,
        "poles": 8,
        "stator_outer_radius_mm": 40.0,
        "rotor_outer_radius_mm": 17.0,
        "back_iron_width_mm": 4.4,
        "tooth_width_mm": 7.4,
        "magnet_length_mm": 3.0,
        "airgap_mm": 0.6,
        "slot_opening_mm": 2.4,
        "shoe_d1_mm": 1.5,
        "shoe_d2_mm": 1.6,
        "shaft_radius_mm": 6.0,
        "magnetisation": "parallel",
        "magnet_arc_fraction": 0.86,
        "remanence_T": 1.22,
        "remanence_coefficient_percent_per_K": -0.11,
        "recoil_permeability": 1.05,
        "steel": "M270-35A",
        "active_length_mm": 36.0,
        "turns_per_coil": 11,
        "phase_resistance_mohm_20degC": 21.0,
    },
    edges=360,
    locked_angles=(4.0, 19.0, 34.0, 49.0, 64.0, 79.0),
    locked_currents=(30.0, 80.0),
    linkage_angle=85.0,
    linkage_currents=(-80.0, -30.0, 30.0, 80.0),
)
DRAWINGS = {drawing.name: drawing for drawing in (TWELVE_TEN, NINE_EIGHT)}


# ---- reading what NGSolve wrote --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Truth:
    """Torque and flux linkages of one machine, per metre.

    spectrum: of torque and phase flux linkages over the reading of the angle (4, orders), n for Re(c_n exp(i n angle))
    torque: what the currents of the states add (states,) [Nm/m];  linkage: of the phases (3, states) [Wb/m]
    """

    spectrum: np.ndarray
    torque: np.ndarray
    linkage: np.ndarray


def revolution(drawing: Drawing, built: AsBuilt, samples: np.ndarray) -> np.ndarray:
    """Samples (1 + coils, window) over the whole revolution (1 + coils, edges), by the symmetry of the machine."""
    n, known = drawing.idle_edges, {k: samples[:, k] for k in range(samples.shape[1])}
    slot, pole = n // drawing.slots, n // drawing.poles
    moves = [(slot, _next_coil)] if built.stator_is_regular else []
    moves += [(pole, _other_sign)] if built.rotor_is_regular else []
    waiting = list(known)
    while waiting:
        k = waiting.pop()
        for steps, change in moves:
            there = (k + steps) % n
            if there not in known:
                known[there] = change(known[k])
                waiting.append(there)
    return np.stack([known[k] for k in range(n)], axis=1)


def _next_coil(sample: np.ndarray) -> np.ndarray:
    return np.append(sample[0], np.roll(sample[1:], 1))


def _other_sign(sample: np.ndarray) -> np.ndarray:
    return np.append(sample[0], -sample[1:])


def phases_of(drawing: Drawing, built: AsBuilt, samples: np.ndarray) -> np.ndarray:
    """Torque and phase flux linkages (4, n) from torque and coil fluxes per turn (1 + coils, n)."""
    turns = coil_turns(drawing, built)
    found = np.zeros((4, samples.shape[1]))
    found[0] = samples[0]
    for k, (phase, sign) in enumerate(zip(drawing.phases, drawing.signs)):
        found[1 + phase] += sign * turns[k] * samples[1 + k]
    return found


def truth_of(drawing: Drawing, built: AsBuilt, arrays: Mapping[str, np.ndarray]) -> Truth:
    """From the arrays of one .npz file; the samples without current begin where the angle reads zero."""
    loaded = phases_of(drawing, built, arrays["loaded"])
    spectrum = spectrum_of(drawing, built, revolution(drawing, built, arrays["no_load"]))
    return Truth(spectrum, loaded[0], loaded[1:])


def spectrum_of(drawing: Drawing, built: AsBuilt, samples: np.ndarray) -> np.ndarray:
    """Of torque and phases (4, orders) from samples of the whole revolution (1 + coils, edges), skewed."""
    spectrum = np.fft.rfft(phases_of(drawing, built, samples), axis=1) / drawing.idle_edges
    spectrum[:, 1:] *= 2
    order = np.arange(spectrum.shape[1])
    return (spectrum * np.sinc(order * built.skew / (2 * np.pi)))[:, :-1]
