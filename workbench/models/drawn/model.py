"""Bench of a machine of any kind, drawn in a machine file, by field solutions.

Kinds of measurement and their columns, SI, temperatures in degrees Celsius; those in brackets are optional. Every kind
but the resistance takes ``magnet_T``: the remanence follows it, row by row.

    back_emf          angle_mech, speed                    -> v_a, v_b, v_c           of the phases, open terminals
    back_emf          speed                                -> v_a .., v_ll            RMS; of a phase the fundamental
    cogging           angle_mech [, direction, speed]      -> torque
    locked_rotor      angle_mech, i_a, i_b, i_c [, direction]   -> torque             rotor turned by hand, or fed with
                                                                                      currents that turn: its columns
                                                                                      say which
    flux_linkage      angle_mech, i_a, i_b, i_c            -> dpsi_a .., psi_a ..     change by the current, and whole
    inductance        angle_mech [, current]               -> l_a, l_m, l_ab ..       of a phase fed alone, its mutual
                                                                                      one, and between lines
    holding_current   angle_mech [, direction]             -> current                 peak, on the q axis, of a driver
                                                                                      that holds the rotor
    phase_resistance  [winding_T]                          -> r_a .., r_ab .., resistance   of a phase, between lines
    drag              speed [, direction]                  -> torque, power           open terminals
    dq_supply, dq_operation, dyno_map, no_load             as of the dq model, with the flux linkages of the field

A winding in delta, or of parallel paths, is seen from its terminals: phases are those of the equivalent star, and
``inductance`` has lines alone. Constant currents do not go round a delta; alternating ones do, and at speed they brake,
under load by their third and ninth order (by their sixth, too, where north and south poles are not alike).

Signs are those of the bench of machines with tooth coils (``workbench.models.machine``). All kinds of stators and
rotors of ``geometry`` are taken; defects of single magnets, coils or slots are not, and nothing across the length but
a share of flux that leaks at the ends. ``dq_supply`` and those after it are answered by the fundamentals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from effects.base import Columns
from effects.drawn_design import DrawnAsBuilt
from workbench.data.table import Campaign, Table, Tolerance
from workbench.errors import WorkbenchError
from workbench.models.base import BaseModel, Option, Progress
from workbench.models.drawn.answers import Anchors, Answers
from workbench.models.drawn.copper import doubts_of_resistance
from workbench.models.drawn.device import FILE, machine_of_device, with_tolerance
from workbench.models.drawn.expansion import Expansion
from workbench.models.drawn.field import ROUGH, FieldSamples, Plan
from workbench.models.drawn.kinds import KINDS
from workbench.models.drawn.options import options
from workbench.models.machine.model import CACHE
from workbench.models.magnet_temperature import at_magnet_temperatures


@dataclass(frozen=True, eq=False)
class DrawnBench(BaseModel):
    """The bench model of a drawn machine.

    plan: angles and mesh;  cache: folder for field solutions, None for none
    expansion: that answers, made by ``prepared``;  anchors: currents that it was solved at
    """

    plan: Plan = Plan()
    cache: Path | None = CACHE
    expansion: Expansion | None = None
    anchors: Anchors = field(default_factory=Anchors)
    name: str = field(default="drawn", init=False)

    def accepts(self, device: Mapping[str, object]) -> bool:
        return FILE in device

    def design(self, device: Mapping[str, object]) -> DrawnAsBuilt:
        """The machine as drawn. Raises WorkbenchError where its file or the table cannot be used."""
        return machine_of_device(device)

    def with_tolerance(self, design: DrawnAsBuilt, tolerance: Tolerance, z: float) -> DrawnAsBuilt:
        """An input moved, see ``device``."""
        return with_tolerance(design, tolerance, z)

    def prepared(self, design: DrawnAsBuilt, tables: Sequence[Table], progress: Progress | None = None) -> DrawnBench:
        """The bench about a design, its field solved for the rows of the tables."""
        samples = FieldSamples(design, self.plan, self.cache)
        samples.progress = progress
        made = replace(self, expansion=Expansion(samples), anchors=Anchors())
        for table in tables:
            if table.rows and table.kind in KINDS:
                made.respond(design, table.kind, table.conditions)
        return made

    def respond(self, design: DrawnAsBuilt, kind: str, conditions: Columns) -> dict[str, np.ndarray]:
        """Response columns at true conditions, SI."""
        if self.expansion is None:
            return self.prepared(design, ()).respond(design, kind, conditions)
        if kind not in KINDS:
            raise WorkbenchError(
                f"the bench of a drawn machine has no measurement kind {kind}: use one of {', '.join(KINDS)}"
            )
        expansion, answer = self.expansion, KINDS[kind]
        return dict(
            at_magnet_temperatures(
                lambda warm: answer(Answers(expansion, self.anchors, warm), conditions), design, conditions
            )
        )

    def anywhere(self, design: DrawnAsBuilt) -> DrawnBench:
        """The same on a coarse mesh with few angles, a tenth of the time a solution."""
        return replace(self, plan=ROUGH).prepared(design, ())

    @property
    def is_expansion(self) -> bool:
        return True

    def recentred(self, design: DrawnAsBuilt, tables: Sequence[Table] = ()) -> DrawnBench:
        """The same bench, exact at another design, with the changes as at the drawing."""
        return replace(self, expansion=self.expansion.about(design)) if self.expansion else self

    def options(self, design: Any, campaign: Campaign) -> list[Option]:
        """What could be measured next."""
        return options(design, campaign.tables)

    def doubts(self, design: DrawnAsBuilt) -> tuple[str, ...]:
        """Of the phase resistance against the copper that is drawn."""
        return doubts_of_resistance(design)


BASE = DrawnBench()
