"""How far the expansion of the machine bench is from field solutions, effect by effect, each at its middle size.

    python -m benchmarks.effect_errors [cache]

For every effect that acts through the field: the change of cogging and flux linkage over a revolution, and of torque
and flux linkage with current, by the expansion about the drawing and by field solutions of the changed machine on the
same meshes. Printed: rms of the difference over rms of the change, per channel; one that changes by less than 1e-3 of
itself is left out. ``model_error`` of the effects is the largest of a row.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from benchmarks.virtual_benches.machine_bench import DEVICE
from effects.base import Effect
from effects.library import package_effects
from effects.machine_design import MachineAsBuilt
from effects.parameter import parameters_of
from geometry.half_cell import MeshDensity
from workbench.models.machine.build import MeshPlan, SurrogateBuilder
from workbench.models.machine.device import machine_of_device
from workbench.models.machine.field import LoadedState
from workbench.models.machine.surrogate import Surrogate

MESH = MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5)
STATES = tuple(LoadedState(0.1, (i, -i / 2, -i / 2)) for i in (40.0, 0.0))
SEEN = 1e-3  # of a channel's own size


def middle(cls: type[Effect], design: MachineAsBuilt) -> MachineAsBuilt:
    """The design with an effect whose parameters are half a standard deviation beyond the middle of their priors."""
    effect = cls.variants(design)[0]
    return effect.at(np.full(len(parameters_of(effect)), 0.5)).on_design(design)


def channels(surrogate: Surrogate, design: MachineAsBuilt) -> dict[str, np.ndarray]:
    """Cogging and flux linkage without current, torque and flux linkage with it."""
    spectrum = surrogate.spectrum(design)
    loaded = surrogate.with_current(design, np.array([s.angle for s in STATES]), np.array([s.currents for s in STATES]))
    return {
        "cogging": spectrum[0, 1:],
        "flux": spectrum[1:, 1:].ravel(),
        "torque": loaded[:1, 0],
        "flux with current": (loaded[0] - loaded[1])[1:],
    }


def errors(builder: SurrogateBuilder, surrogate: Surrogate, design: MachineAsBuilt) -> dict[str, float]:
    """Relative error of the expansion's change in each channel that changes."""
    drawn = channels(surrogate, builder.nominal)
    expanded, exact = (channels(s, design) for s in (surrogate, builder.about(surrogate, design)))
    found = {}
    for name, base in drawn.items():
        change = np.linalg.norm(exact[name] - base)
        if change > SEEN * np.linalg.norm(base):
            found[name] = float(np.linalg.norm(expanded[name] - exact[name]) / change)
    return found


def main(cache: Path | None) -> None:
    drawn = machine_of_device(DEVICE)
    builder = SurrogateBuilder(drawn, MeshPlan(MESH, MESH, MESH, MESH), cache)
    surrogate = builder.build(STATES)
    for name, cls in package_effects().items():
        if not (cls.__module__.startswith("effects.machine.") and cls.can_act_on(drawn)):
            continue
        design = middle(cls, drawn)
        if np.any(surrogate.position(design) != surrogate.position(drawn)):
            row = errors(builder, surrogate, design)
            print(f"{name:26s}", "  ".join(f"{channel} {error:.3f}" for channel, error in row.items()), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
