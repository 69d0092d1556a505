"""Bench of a permanent-magnet machine as built, by field solutions.

Kinds of measurement and their columns, SI, temperatures in degrees Celsius; those in brackets are optional. Every kind
but the resistance takes ``magnet_T``: the remanence follows it, row by row.

    back_emf          angle_mech, speed                    -> v_a, v_b, v_c           of the phases, open terminals
    cogging           angle_mech [, direction, speed]      -> torque
    locked_rotor      angle_mech, i_a, i_b, i_c [, direction]   -> torque             rotor turned by hand
    flux_linkage      angle_mech, i_a, i_b, i_c            -> dpsi_a ...              change against no current
                                                              psi_a ...               whole, of the winding
    inductance        angle_mech, i_a, i_b, i_c            -> l_a ...                 dpsi over the current of the phase
    phase_resistance  [winding_T]                          -> r_a, r_b, r_c           at the terminals, with leads
    drag              speed [, winding_T]                  -> torque                  open terminals
    short_circuit     speed [, winding_T]                  -> torque, current, i_a .. RMS, terminals joined
    no_load           speed [, v_ll, winding_T]            -> v_ll, current, power    as of the dq model
    dyno_map          speed, torque [, v_dc, winding_T]    -> the meters of the dq model

Signs: angles and torques count counter-clockwise, the torque is that on the rotor, positive current makes a coil's flux
outwards, and a voltage is + d(flux linkage)/dt at open terminals, with the sign of the speed. What brakes the rotor
(``drag``) is negative at positive speed; in a table without speed the column ``direction`` says which way it creeps.
``no_load`` and ``dyno_map`` are answered by the fundamentals, with the flux, inductances, losses and resistance of the
design, without saturation by the current.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial
from pathlib import Path

import numpy as np

from effects.base import Columns
from effects.machine_design import MachineAsBuilt
from processes import default_workers
from workbench.data.table import Campaign, Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.models.base import BaseModel, Option
from workbench.models.device import names
from workbench.models.machine.answers import Answers, with_parts_of
from workbench.models.machine.build import MeshPlan, SurrogateBuilder
from workbench.models.machine.device import machine_of_device, own_tolerances, with_tolerance
from workbench.models.machine.field import MachineField
from workbench.models.machine.kinds import KINDS, Summand, added_up, beyond_states, loaded_states
from workbench.models.machine.numerical import left_open, shapes_of
from workbench.models.machine.options import options
from workbench.models.machine.rough import ROUGH, RoughMachine, RoughSurrogate
from workbench.models.machine.surrogate import Surrogate
from workbench.models.magnet_temperature import at_magnet_temperatures

CACHE = Path("results") / "cache"
_REMEMBERED = 48  # answers
_ON_A_MESH = ("back_emf", "cogging", "locked_rotor", "flux_linkage", "inductance")  # kinds that a mesh has a say in


@dataclass(frozen=True, eq=False)
class MachineBench(BaseModel):
    """The bench model of a machine. ``prepared`` makes one that answers at once for the rows of some tables.

    plan: meshes;  cache: folder for field solutions, None for none;  workers: processes that solve them
    surrogate: that answers;  about_drawing: where that is about another design, the one that it was made from
    """

    plan: MeshPlan = MeshPlan()
    cache: Path | None = CACHE
    workers: int = field(default_factory=default_workers)
    surrogate: Surrogate | RoughSurrogate | None = None
    builder: SurrogateBuilder | None = None
    about_drawing: Surrogate | None = None
    name: str = field(default="machine", init=False)

    # ---- the device ---------------------------------------------------------------------------------------------

    def accepts(self, device: Mapping[str, object]) -> bool:
        return {"slots", "poles", "airgap"} <= set(names(device))

    def design(self, device: Mapping[str, object]) -> MachineAsBuilt:
        """The machine as drawn. Raises WorkbenchError when the table lacks something or the machine cannot be built."""
        return machine_of_device(device)

    def with_tolerance(self, design: MachineAsBuilt, tolerance: Tolerance, z: float) -> MachineAsBuilt:
        """An input of ``device`` moved: a dimension, remanence, a phase's resistance, temperature of the magnets."""
        return with_tolerance(design, tolerance, z)

    def own_tolerances(self, design: MachineAsBuilt) -> tuple[Tolerance, ...]:
        """What is uncertain in every machine and in the model itself, fitted as the tolerances of a campaign are."""
        return own_tolerances(design)

    # ---- answers ------------------------------------------------------------------------------------------------

    def prepared(
        self, design: MachineAsBuilt, tables: Sequence[Table], progress: Callable[[str], None] | None = None
    ) -> MachineBench:
        """The same bench with its surrogate about ``design`` for the loaded rows of the tables."""
        builder = SurrogateBuilder(design, self.plan, self.cache, workers=self.workers)
        built = builder.build(loaded_states(design, tables), progress)
        return replace(self, surrogate=built, builder=builder, about_drawing=built)

    def respond(self, design: MachineAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns at true conditions, SI; from the surrogate."""
        if self.surrogate is None:
            raise WorkbenchError("the machine bench answers after prepare: use prepared(design, tables)")
        if kind not in KINDS:
            raise WorkbenchError(f"the machine bench has no measurement kind {kind}: use one of {', '.join(KINDS)}")
        asked = _Asked(conditions)
        return added_up([self._remembered(self._seen(design, one.unseen), one, asked) for one in KINDS[kind]])

    @cached_property
    def _seen(self) -> Callable[[MachineAsBuilt, tuple[str, ...]], MachineAsBuilt]:
        """A design with what has no say in an answer as drawn; tables ask for one design in turn."""
        drawn = self.surrogate.nominal
        return lru_cache(maxsize=_REMEMBERED)(lambda design, unseen: with_parts_of(drawn, design, unseen))

    @cached_property
    def _remembered(self) -> Callable[..., Mapping[str, np.ndarray]]:
        """An error of an instrument leaves the machine as it is, and friction its field: many fits ask the same
        again."""

        def answer(design: MachineAsBuilt, summand: Summand, asked: _Asked) -> Mapping[str, np.ndarray]:
            return _answered(summand, self._answers, design, asked.columns)

        return lru_cache(maxsize=_REMEMBERED)(answer)

    @cached_property
    def _answers(self) -> Callable[[MachineAsBuilt], Answers]:
        """Tables ask for one design in turn."""
        return lru_cache(maxsize=_REMEMBERED)(partial(Answers, self.surrogate))

    def exact(self, design: MachineAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns from field solutions of the design itself; seconds, kept for the next table."""
        return self.recentred(design).respond(design, kind, conditions)

    def anywhere(self, design: MachineAsBuilt) -> RoughMachine:
        """The machine from a few fields of the drawing, at any angle and current; about a second."""
        rough = RoughSurrogate(MachineField(design, ROUGH))
        return RoughMachine(rough, replace(self, surrogate=rough))

    @property
    def is_expansion(self) -> bool:
        return True

    def recentred(self, design: MachineAsBuilt, tables: Sequence[Table] = ()) -> MachineBench:
        """The same bench, exact at another design by field solutions of it, with the derivatives at the drawing.

        tables: rows at their true angles and currents, near which what currents add is solved
        """
        turn = beyond_states(self.about_drawing, design, tables)
        return replace(self, surrogate=self.builder.about(self.about_drawing, design, turn))

    def is_alike(self, design: MachineAsBuilt, other: MachineAsBuilt) -> bool:
        """Whether the fields of two machines are the same: friction, losses and resistances may differ."""
        return np.array_equal(self.about_drawing.position(design), self.about_drawing.position(other))

    def options(self, design: MachineAsBuilt, campaign: Campaign) -> list[Option]:
        """What could be measured next, see ``workbench.explain.recommend``."""
        return options(campaign.tables)

    def numerical(self, design: MachineAsBuilt, table: Table) -> tuple[Mapping[str, np.ndarray], ...]:
        """What meshes and an averaging recorder make wrong, see ``numerical.py``; of the machine as drawn."""
        if self.about_drawing is None:
            return ()
        known, asked = self.about_drawing.remembered, (table.kind, _Asked(table.conditions))
        if asked not in known:
            known[asked] = shapes_of(self.about_drawing, _ON_A_MESH, table, _drawn_answers)
        return known[asked]

    def left_open(self, design: MachineAsBuilt, table: Table) -> Mapping[str, np.ndarray]:
        """Voltages that neither a recorder nor a drawing tells, see ``numerical.py``; of the machine as drawn."""
        return left_open(self.about_drawing, table, _drawn_answers) if self.about_drawing is not None else {}


def _drawn_answers(surrogate: Surrogate, table: Table) -> Mapping[str, np.ndarray]:
    answers, drawn, at = partial(Answers, surrogate), surrogate.nominal, table.conditions
    return added_up([_answered(summand, answers, drawn, at) for summand in KINDS[table.kind]])


def _answered(
    summand: Summand, answers: Callable[[MachineAsBuilt], Answers], design: MachineAsBuilt, at: Columns
) -> Mapping[str, np.ndarray]:
    return at_magnet_temperatures(lambda warm: summand.answer(answers(warm), at), design, at)


class _Asked:
    """Conditions that are equal when all values in them are."""

    def __init__(self, columns: Columns):
        self.columns = columns
        self.content = tuple((name, np.asarray(values).tobytes()) for name, values in columns.items())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Asked) and self.content == other.content

    def __hash__(self) -> int:
        return hash(self.content)


BASE = MachineBench()
