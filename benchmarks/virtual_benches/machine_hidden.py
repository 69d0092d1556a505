"""What may be hidden in a machine that NGSolve solves, and which machines are solved: seeds, sizes and names.

A size is that of the first parameter of the library's effect of the name, SI. ``drawn`` says which machines there are
for tuning and which for the score; kinds outside the library that are in one list are in none of the other.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field

import numpy as np

from benchmarks.virtual_benches.truths import DEGREE, DRAWINGS, AsBuilt, Drawing

TOLERANCE = {"remanence": 0.01, "airgap_mm": 0.04, "active_length_mm": 0.0025}  # relative, as declared
SYSTEMATIC = {
    "voltage_gain": ("gain", 0.002),
    "torque_gain": ("gain", 0.003),
    "torque_offset_Nm": ("offset", 0.0015),
    "current_gain": ("gain", 0.003),
    "encoder_zero_deg": ("offset", 0.25),
}
Change = Callable[[float, Drawing, np.random.Generator], AsBuilt]


@dataclass(frozen=True)
class InTheField:
    """Something in the machine or at its currents: its size and what it makes of the machine."""

    low: float
    high: float
    change: Change
    signed: bool = False

    def size(self, rng: np.random.Generator) -> float:
        size = float(np.exp(rng.uniform(np.log(self.low), np.log(self.high))))
        return size * (float(rng.choice([-1.0, 1.0])) if self.signed else 1.0)


def _warm(rise: float, drawing: Drawing, rng: np.random.Generator) -> AsBuilt:
    return AsBuilt(remanence=float(drawing.device["remanence_coefficient_percent_per_K"]) / 100 * rise)


def _gap(change: float, drawing: Drawing, rng: np.random.Generator) -> AsBuilt:
    return AsBuilt(airgap=change / drawing.length("airgap"))


def _shift(name: str) -> Change:
    def shifted(share: float, drawing: Drawing, rng: np.random.Generator) -> AsBuilt:
        direction, amount = rng.uniform(-np.pi, np.pi), share * drawing.length("airgap")
        return AsBuilt(**{name: (float(amount * np.cos(direction)), float(amount * np.sin(direction)))})

    return shifted


def _at(name: str, count: str) -> Change:
    """At one magnet, slot or coil of the machine, whichever comes."""
    return lambda size, drawing, rng: AsBuilt(**{name: {int(rng.integers(drawing.device[count])): size}})


def _all(name: str, sign: float = 1.0) -> Change:
    return lambda size, drawing, rng: AsBuilt(**{name: sign * size})


EFFECTS: Mapping[str, InTheField] = {
    "magnet_temperature": InTheField(8.0, 70.0, _warm),
    "recoil_permeability": InTheField(0.015, 0.1, _all("recoil")),
    "bore_grinding": InTheField(0.04e-3, 0.12e-3, _gap),
    "static_eccentricity": InTheField(0.1, 0.4, _shift("stator_shift")),
    "dynamic_eccentricity": InTheField(0.1, 0.4, _shift("rotor_shift")),
    "lamination_stacking": InTheField(0.01, 0.08, _all("stacking", -1.0)),
    "weak_magnet": InTheField(0.03, 0.25, _at("weak", "poles")),
    "magnet_position": InTheField(0.15 * DEGREE, 1.0 * DEGREE, _at("turns_of_magnets", "poles"), signed=True),
    "magnet_arc": InTheField(0.015, 0.08, _all("magnet_arc", -1.0)),
    "slot_opening": InTheField(0.05e-3, 0.4e-3, _all("slot_opening"), signed=True),
    "wide_slot": InTheField(0.08e-3, 0.6e-3, _at("openings", "slots"), signed=True),
    "rotor_skew": InTheField(0.5 * DEGREE, 4 * DEGREE, _all("skew")),
    "steel_saturation": InTheField(0.01, 0.06, _all("saturation"), signed=True),
    "lost_turns": InTheField(0.15, 1.5, _at("turns", "slots")),
    "phase_imbalance": InTheField(0.005, 0.05, lambda s, d, rng: AsBuilt(phase_turns={int(rng.integers(3)): s}), True),
    "magnetisation_pattern": InTheField(0.08, 0.5, _all("radial_share"), signed=True),
    "current_gain": InTheField(0.012, 0.06, lambda s, d, rng: AsBuilt(current=1 / (1 + s) - 1), signed=True),
    "encoder_zero": InTheField(1.0 * DEGREE, 2.5 * DEGREE, _all("turned", -1.0), signed=True),
}
OUTSIDE: Mapping[str, InTheField] = {  # of laws that no effect of the library has
    "current shunt that bends": InTheField(0.01, 0.03, _all("current_bend"), signed=True),
    "magnet magnetised askew": InTheField(4 * DEGREE, 12 * DEGREE, _at("tilts", "poles"), signed=True),
    "iron in a slot opening": InTheField(4.0, 40.0, _at("plugs", "slots")),
}
TUNING_KINDS = frozenset({"current shunt that bends"})


@dataclass(frozen=True)
class Solved:
    """One machine that is solved. effects: what is in it by name, with sizes;  outside: likewise, not in the library

    z: tolerances and instruments that the field feels, in standard deviations, by name
    """

    name: str
    drawing: str
    built: AsBuilt
    effects: Mapping[str, float] = field(default_factory=dict)
    outside: Mapping[str, float] = field(default_factory=dict)
    z: Mapping[str, float] = field(default_factory=dict)

    def as_plain(self) -> dict:
        return asdict(self)

    @classmethod
    def from_plain(cls, values: Mapping) -> Solved:
        built = {k: _with_numbers(v) for k, v in values["built"].items()}
        return cls(**{**values, "built": AsBuilt(**built)})


def _with_numbers(value: object) -> object:
    """Keys of places as the numbers that JSON makes texts of."""
    if isinstance(value, Mapping):
        return {int(k): v for k, v in value.items()}
    return tuple(value) if isinstance(value, list) else value


def with_tolerances(drawing: Drawing, rng: np.random.Generator) -> tuple[AsBuilt, dict[str, float]]:
    """A machine within its tolerances, read by instruments within theirs."""
    z = {name: float(rng.standard_normal()) for name in ("remanence", "airgap_mm", "current_gain", "encoder_zero_deg")}
    return as_toleranced(z), z


def as_toleranced(z: Mapping[str, float]) -> AsBuilt:
    """The machine with tolerances and instruments at so many standard deviations."""
    return AsBuilt(
        remanence=TOLERANCE["remanence"] * z.get("remanence", 0.0),
        airgap=TOLERANCE["airgap_mm"] * z.get("airgap_mm", 0.0),
        current=1 / (1 + SYSTEMATIC["current_gain"][1] * z.get("current_gain", 0.0)) - 1,
        turned=-SYSTEMATIC["encoder_zero_deg"][1] * DEGREE * z.get("encoder_zero_deg", 0.0),
    )


# ---- which machines are solved ---------------------------------------------------------------------------------------

# Tolerances and instruments that the field feels, with the standard deviations at which the machine as drawn is solved
# on either side; from the three a square law follows.
MOVED = {"remanence": 2.0, "airgap_mm": 2.0, "current_gain": 4.0, "encoder_zero_deg": 4.0}
BASES = {"tune": 2, "score": 5}  # machines with nothing in them, of each drawing
OF_EACH = {"tune": 1, "score": 2}  # machines with each effect; drawings take turns
OUTSIDE_OF_EACH = {"tune": 2, "score": 5}
PAIRS = {"tune": 2, "score": 6}  # machines with two effects of the field


def drawn(which: str) -> list[Solved]:
    """The machines for "tune" or for "score"."""
    seed = {"tune": 10000, "score": 0}[which]
    names = list(DRAWINGS)
    found = [_made(which, names[k % 2], f"base-{k}", (), (), [seed, 1, k]) for k in range(BASES[which] * 2)]
    for n, effect in enumerate(EFFECTS):
        for k in range(OF_EACH[which]):
            found.append(_made(which, names[(n + k) % 2], f"{effect}-{k}", (effect,), (), [seed, 2, n, k]))
    outside = [kind for kind in OUTSIDE if (kind in TUNING_KINDS) == (which == "tune")]
    for n, kind in enumerate(outside):
        for k in range(OUTSIDE_OF_EACH[which]):
            found.append(_made(which, names[(n + k) % 2], f"outside-{n}-{k}", (), (kind,), [seed, 3, n, k]))
    for k in range(PAIRS[which]):
        found += _pair(which, names[k % 2], k, [seed, 4, k])
    return found


def _pair(which: str, drawing: str, number: int, seed: list[int]) -> list[Solved]:
    """A machine with two effects, and the same machine with either of them."""
    rng = np.random.default_rng(seed)
    two = tuple(str(name) for name in rng.choice(list(EFFECTS), 2, replace=False))
    whole = [*seed[:1], 5, number]
    both = _made(which, drawing, f"pair-{number}", two, (), whole)
    return [both, *(_made(which, drawing, f"pair-{number}-{k}", two, (), whole, only=two[k]) for k in range(2))]


def _made(
    which: str, drawing: str, name: str, effects: tuple, outside: tuple, seed: list[int], only: str = ""
) -> Solved:
    """only: the one effect of those drawn that gets into the machine, all where empty"""
    rng = np.random.default_rng(seed)
    built, z = with_tolerances(DRAWINGS[drawing], rng)
    sizes: dict[str, float] = {}
    for kind in (*effects, *outside):
        hidden = {**EFFECTS, **OUTSIDE}[kind]
        size = hidden.size(rng)
        change = hidden.change(size, DRAWINGS[drawing], rng)
        if only in ("", kind):
            sizes[kind], built = size, built + change
    in_it, strange = ({k: sizes[k] for k in kinds if k in sizes} for kinds in (effects, outside))
    return Solved(f"{which}-{drawing}-{name}", drawing, built, in_it, strange, z)


def sensitivities() -> list[Solved]:
    """Machines as drawn, and with one tolerance or instrument moved to either side."""
    found = []
    for drawing in DRAWINGS:
        found.append(Solved(f"sense-{drawing}-drawing", drawing, AsBuilt()))
        for name, size in MOVED.items():
            for word, z in (("up", size), ("down", -size)):
                found.append(Solved(f"sense-{drawing}-{name}-{word}", drawing, as_toleranced({name: z}), z={name: z}))
    return found
