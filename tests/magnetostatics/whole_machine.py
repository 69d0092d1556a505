"""Whole machines on coarse meshes, for what breaks the symmetry."""

from __future__ import annotations

from functools import cache

from geometry.defects import deformed
from geometry.half_cell import MeshDensity
from magnetostatics.model import FieldModel
from magnetostatics.newton import NewtonSettings
from tests.magnetostatics.reference_machine import MATERIALS, model_of, reference_machine

COARSE = MeshDensity(gap_edges=120, longest_gap_edge=2.0, gap_layers=2, across_iron=1.0)
CLOSE = NewtonSettings(tolerance=1e-10)
NINE_SLOTS = dict(slots=9, pole_pairs=4, back_iron_width=3.1e-3)
TWELVE_EIGHT = dict(slots=12, pole_pairs=4)


@cache
def whole_model(density: MeshDensity = COARSE, **changes) -> FieldModel:
    return model_of(reference_machine(**changes), density, whole=True, materials=MATERIALS, settings=CLOSE)


def with_defects(model: FieldModel, *defects) -> FieldModel:
    return model.like(deformed(model.section, *defects))
