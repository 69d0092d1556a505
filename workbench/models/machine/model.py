"""Bench of a permanent-magnet machine: back-EMF, cogging, locked rotor, flux linkage, resistance, drag, short circuit.

Signs: angles and torques count counter-clockwise, the torque is that on the rotor, positive current makes a coil's flux
outwards, and a voltage is + d(flux linkage)/dt at open terminals, with the sign of the speed. What the rotor turns in
(friction, iron loss) is left to effects: drag is zero.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from pathlib import Path

import numpy as np
from scipy.ndimage import median_filter

from effects.base import Columns
from effects.machine_design import MachineAsBuilt
from geometry.checks import check_machine
from geometry.machine import GeometryError, Machine, ParallelMagnetisation, RadialMagnetisation
from materials.conductor import COPPER
from materials.errors import MaterialError
from materials.library import load_steel
from materials.magnet import Magnet
from pipeline.pools import default_workers
from units import DEGREE
from workbench.data.table import Campaign, Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.models.base import BaseModel, Option
from workbench.models.device import names, numbers
from workbench.models.machine.build import MeshPlan, SurrogateBuilder
from workbench.models.machine.field import LoadedState
from workbench.models.machine.numerical import shapes_of
from workbench.models.machine.options import options
from workbench.models.machine.spectra import averaged, evaluated, slope
from workbench.models.machine.surrogate import Surrogate

CACHE = Path("results") / "cache"
LABORATORY = 22.0  # degC, at which a device table states its remanence when it does not say
_MAGNET_MEMORY = 61  # rows; a magnet warms over minutes, what its reading does from row to row is noise
_ANGLE_GRID = 0.5 * DEGREE  # loaded states are solved on; readings lie up to half of it away
_AROUND = round(2 * np.pi / _ANGLE_GRID)
_REMEMBERED = 24  # answers
_TWO_DIGITS_WITHIN = 0.01  # relative; currents are solved at two digits where that is as near, else at three

_DIMENSIONS = (
    "stator_outer_radius",
    "rotor_outer_radius",
    "back_iron_width",
    "tooth_width",
    "magnet_length",
    "airgap",
    "slot_opening",
    "shoe_d1",
    "shoe_d2",
    "shaft_radius",
)
_REQUIRED = ("slots", "poles", *_DIMENSIONS, "remanence", "active_length", "turns_per_coil")
_OPTIONAL = (
    "magnet_arc_fraction",
    "remanence_coefficient",
    "remanence_reference",
    "recoil_permeability",
    "stacking_factor",
    "coils_in_series_per_phase",
    "phase_resistance",
)
_PATTERNS = {"parallel": ParallelMagnetisation(), "radial": RadialMagnetisation()}
_PHASES = "abc"


@dataclass(frozen=True, eq=False)
class MachineBench(BaseModel):
    """The bench model of a machine. ``prepared`` makes one that answers at once for the rows of some tables.

    plan: meshes;  cache: folder for field solutions, None for none;  workers: processes that solve them
    surrogate: that answers;  about_drawing: where that is about another design, the one that it was made from
    """

    plan: MeshPlan = MeshPlan()
    cache: Path | None = CACHE
    workers: int = field(default_factory=default_workers)
    surrogate: Surrogate | None = None
    builder: SurrogateBuilder | None = None
    about_drawing: Surrogate | None = None
    name: str = field(default="machine", init=False)

    # ---- the device ---------------------------------------------------------------------------------------------

    def accepts(self, device: Mapping[str, object]) -> bool:
        return {"slots", "poles", "airgap"} <= set(names(device))

    def design(self, device: Mapping[str, object]) -> MachineAsBuilt:
        """The machine as drawn. Raises WorkbenchError when the table lacks something or the machine cannot be built."""
        values = numbers(_without_unit_traps(device), _REQUIRED, _OPTIONAL)
        try:
            machine = _machine_of(values, device)
            check_machine(machine)
            return _as_drawn(machine, values, device)
        except (GeometryError, MaterialError) as error:
            raise WorkbenchError(f"[device]: {error}") from None

    def with_tolerance(self, design: MachineAsBuilt, tolerance: Tolerance, z: float) -> MachineAsBuilt:
        """A dimension, remanence, recoil permeability, active length or phase resistance moved."""
        name = _TOLERANCES.get(tolerance.name, tolerance.name)
        current = _toleranced(design, name)
        if current is None:
            known = ", ".join((*_DIMENSIONS, "magnet_arc_fraction", *_OTHER_INPUTS))
            raise WorkbenchError(f"[tolerance] {tolerance.name} is no input of this model: use one of {known}")
        step = tolerance.sigma * z * (abs(current) if tolerance.relative else 1.0)
        return _with_input(design, name, current + step)

    def own_tolerances(self, design: MachineAsBuilt) -> tuple[Tolerance, ...]:
        """What is uncertain in the model itself, fitted as the tolerances of a campaign are."""
        source = "cogging of one mesh against finer ones and other codes"
        return (Tolerance("cogging_of_mesh", _COGGING_OF_MESH, relative=True, source=source),)

    # ---- answers ------------------------------------------------------------------------------------------------

    def prepared(
        self, design: MachineAsBuilt, tables: Sequence[Table], progress: Callable[[str], None] | None = None
    ) -> MachineBench:
        """The same bench with its surrogate about ``design`` for the loaded rows of the tables."""
        builder = SurrogateBuilder(design, self.plan, self.cache, workers=self.workers)
        built = builder.build(loaded_states(tables), progress)
        return replace(self, surrogate=built, builder=builder, about_drawing=built)

    def respond(self, design: MachineAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns at true conditions, SI; from the surrogate."""
        if self.surrogate is None:
            raise WorkbenchError("the machine bench answers after prepare: use prepared(design, tables)")
        if kind not in _KINDS:
            raise WorkbenchError(f"the machine bench has no measurement kind {kind}: use one of {', '.join(_KINDS)}")
        return dict(self._remembered(design, kind, _Asked(conditions)))

    @cached_property
    def _remembered(self) -> Callable[..., dict[str, np.ndarray]]:
        """An error of an instrument leaves the machine as it is: many fits ask the same again."""
        answer = lambda design, kind, asked: _KINDS[kind](_Answers(self.surrogate, design), asked.columns)  # noqa: E731
        return lru_cache(maxsize=_REMEMBERED)(answer)

    def exact(self, design: MachineAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns from field solutions of the design itself; seconds, kept for the next table."""
        return self.recentred(design).respond(design, kind, conditions)

    @property
    def is_expansion(self) -> bool:
        return True

    def recentred(self, design: MachineAsBuilt) -> MachineBench:
        """The same bench, exact at another design by field solutions of it, with the derivatives at the drawing."""
        return replace(self, surrogate=self.builder.about(self.about_drawing, design))

    def options(self, design: MachineAsBuilt, campaign: Campaign) -> list[Option]:
        """What could be measured next, see ``workbench.explain.recommend``."""
        return options(campaign.tables)

    def numerical(self, design: MachineAsBuilt, table: Table) -> tuple[Mapping[str, np.ndarray], ...]:
        """What meshes and the recorder of the voltages leave open, see ``numerical.py``; of the machine as drawn."""
        if self.about_drawing is None:
            return ()
        return shapes_of(self.about_drawing, tuple(_KINDS), table, _drawn_answers)


def _drawn_answers(surrogate: Surrogate, table: Table) -> dict[str, np.ndarray]:
    return _KINDS[table.kind](_Answers(surrogate, surrogate.nominal), table.conditions)


class _Asked:
    """Conditions that are equal when all values in them are."""

    def __init__(self, columns: Columns):
        self.columns = columns
        self.content = tuple((name, np.asarray(values).tobytes()) for name, values in columns.items())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Asked) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


_COGGING_OF_MESH = 0.01  # cogging of good meshes of two codes differs by 0.5 mNm of 49 mNm (12 slots, 10 poles)


@dataclass(frozen=True, eq=False)
class _Answers:
    """Torque and phase flux linkages of one design as a terminal and a torque cell see them."""

    surrogate: Surrogate
    design: MachineAsBuilt

    @cached_property
    def spectrum(self) -> np.ndarray:
        """Of torque and phase flux linkages per metre over the revolution, skewed (4, orders)."""
        found = self.surrogate.spectrum(self.design)
        found[0] += (self.design.cogging_of_mesh - 1.0) * self.surrogate.no_load[0]
        return averaged(found, self.design.skew)

    @property
    def kept(self) -> float:
        """Share of the magnets' flux that goes through the winding."""
        return 1.0 - self.design.end_leakage

    def cogging(self, angle: np.ndarray) -> np.ndarray:
        """Torque without current [Nm]; it goes with the square of the magnets' flux."""
        return self.design.length * self.kept**2 * evaluated(self.spectrum[:1], angle)[0]

    def flux_slopes(self, angle: np.ndarray) -> np.ndarray:
        """d psi / d angle of the phases [Wb] (3, n)."""
        return self.design.length * self.kept * evaluated(slope(self.spectrum[1:]), angle)

    def loaded_torque(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque [Nm]: cogging, and what magnets and currents make together, which goes with the magnets' flux."""
        both = self.design.length * self.surrogate.with_current(self.design, angle, currents)[:, 0]
        alone = self.design.length * evaluated(self.spectrum[:1], angle)[0]
        return self.kept * (both - alone) + self.kept**2 * alone

    def flux_change(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases against those without current [Wb] (n, 3)."""
        loaded = self.surrogate.with_current(self.design, angle, currents)
        return self.design.length * (loaded - self.surrogate.with_current(self.design, angle, 0 * currents))[:, 1:]


# ---- kinds of measurement ------------------------------------------------------------------------------------------


def _back_emf(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    """v = speed * d psi/d angle; the flux follows the remanence in proportion when the magnets warm up."""
    voltages = answers.flux_slopes(at["angle_mech"]) * at["speed"] * _magnet_factor(answers.design.magnet, at)
    return {f"v_{x}": voltages[k] for k, x in enumerate(_PHASES)}


def _magnet_factor(magnet: Magnet, at: Columns) -> np.ndarray | float:
    if "magnet_T" not in at:
        return 1.0
    slow = _slow(np.ascontiguousarray(at["magnet_T"], dtype=float).tobytes())
    return 1.0 + magnet.temperature_coefficient * (slow - magnet.reference_temperature)


@lru_cache(maxsize=16)
def _slow(readings: bytes) -> np.ndarray:
    """Running median of readings, given as the bytes of their array."""
    return median_filter(np.frombuffer(readings), _MAGNET_MEMORY, mode="nearest")


def _cogging(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    return {"torque": answers.cogging(at["angle_mech"])}


def _locked_rotor(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    return {"torque": answers.loaded_torque(at["angle_mech"], _currents(at))}


def _flux_linkage(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    changes = answers.flux_change(at["angle_mech"], _currents(at))
    return {f"dpsi_{x}": changes[:, k] for k, x in enumerate(_PHASES)}


def _phase_resistance(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    """R = R_20 (1 + alpha (T - 20 degC))."""
    warm = 1.0 + COPPER.temperature_coefficient * (at["winding_T"] - COPPER.reference_temperature)
    return {f"r_{x}": r * warm for x, r in zip(_PHASES, answers.design.phase_resistance)}


def _drag(answers: _Answers, at: Columns) -> dict[str, np.ndarray]:
    return {"torque": np.zeros_like(at["speed"])}


_KINDS = {
    "back_emf": _back_emf,
    "cogging": _cogging,
    "locked_rotor": _locked_rotor,
    "flux_linkage": _flux_linkage,
    "phase_resistance": _phase_resistance,
    "drag": _drag,
}


def _currents(at: Columns) -> np.ndarray:
    missing = [f"i_{x}" for x in _PHASES if f"i_{x}" not in at]
    if missing:
        raise WorkbenchError(f"a loaded row needs the currents of all phases: the column {missing[0]} is missing")
    return np.stack([at[f"i_{x}"] for x in _PHASES], axis=1)


# ---- loaded states -------------------------------------------------------------------------------------------------


def loaded_states(tables: Sequence[Table]) -> tuple[LoadedState, ...]:
    """States near all rows with currents, and for flux linkage the ones without, each once."""
    found: dict[LoadedState, None] = {}
    for table in tables:
        if table.kind not in ("locked_rotor", "flux_linkage"):
            continue
        for angle, currents in zip(table.conditions["angle_mech"], _currents(table.conditions)):
            near = round(angle / _ANGLE_GRID) % _AROUND * _ANGLE_GRID
            found[LoadedState(near, tuple(map(_few_digits, currents)))] = None
            if table.kind == "flux_linkage":
                found[LoadedState(near, (0.0, 0.0, 0.0))] = None
    return tuple(found)


def _few_digits(current: float) -> float:
    two = float(f"{current:.1e}")
    return two if abs(two - current) <= _TWO_DIGITS_WITHIN * abs(current) else float(f"{current:.2e}")


# ---- reading the device ----------------------------------------------------------------------------------------------

_TOLERANCES = {"magnet.Br": "remanence", "length": "active_length"}
_OTHER_INPUTS = ("remanence", "recoil_permeability", "active_length", "phase_resistance")


def _toleranced(design: MachineAsBuilt, name: str) -> float | None:
    if name in (*_DIMENSIONS, "magnet_arc_fraction"):
        return getattr(design.machine, name)
    if name in ("remanence", "recoil_permeability"):
        return getattr(design.magnet, name)
    others = {
        "cogging_of_mesh": design.cogging_of_mesh,
        "active_length": design.length,
        "phase_resistance": design.phase_resistance[0],
    }
    return others.get(name)


def _with_input(design: MachineAsBuilt, name: str, value: float) -> MachineAsBuilt:
    if name in ("remanence", "recoil_permeability"):
        return design.with_magnet(**{name: value})
    if name == "active_length":
        return replace(design, length=value)
    if name == "cogging_of_mesh":
        return replace(design, cogging_of_mesh=value)
    if name == "phase_resistance":
        factor = value / design.phase_resistance[0]
        return replace(design, phase_resistance=tuple(r * factor for r in design.phase_resistance))
    return design.with_machine(**{name: value})


def _without_unit_traps(device: Mapping[str, object]) -> dict[str, object]:
    """The table with the names of its quantities as this model has them."""
    renamed = {
        "remanence_T": "remanence",
        "remanence_reference_degC": "remanence_reference",
        "phase_resistance_mohm_20degC": "phase_resistance_mohm",
    }
    table = {renamed.get(key, key): value for key, value in device.items()}
    if "remanence_coefficient_percent_per_K" in table:
        table["remanence_coefficient"] = table.pop("remanence_coefficient_percent_per_K") / 100
    return table


def _machine_of(values: Mapping[str, float], device: Mapping[str, object]) -> Machine:
    pattern = str(device.get("magnetisation", "parallel"))
    if pattern not in _PATTERNS:
        raise WorkbenchError(f"[device] magnetisation must be one of {', '.join(_PATTERNS)}, found {pattern!r}")
    return Machine(
        slots=int(values["slots"]),
        pole_pairs=int(values["poles"]) // 2,
        magnet_arc_fraction=values.get("magnet_arc_fraction", 1.0),
        magnetisation=_PATTERNS[pattern],
        **{name: values[name] for name in _DIMENSIONS},
    )


def _as_drawn(machine: Machine, values: Mapping[str, float], device: Mapping[str, object]) -> MachineAsBuilt:
    in_series = values.get("coils_in_series_per_phase", machine.slots / 3)
    if in_series * 3 != machine.slots:
        raise WorkbenchError(
            "[device] coils_in_series_per_phase must be slots / 3 (a coil on every tooth, those of a phase in series), "
            f"here {machine.slots / 3:g}; found {in_series:g}"
        )
    steel = str(device.get("steel", ""))
    load_steel(steel)  # an unknown grade is said here, with the known ones
    magnet = Magnet(
        values["remanence"],
        values.get("recoil_permeability", 1.05),
        values.get("remanence_coefficient", -0.0011),
        values.get("remanence_reference", LABORATORY),
    )
    resistance = values.get("phase_resistance", 0.0)
    drawn = MachineAsBuilt.drawn(machine, steel, magnet, values["active_length"], values["turns_per_coil"], resistance)
    return replace(drawn, stacking_factor=values.get("stacking_factor", 1.0))


BASE = MachineBench()
