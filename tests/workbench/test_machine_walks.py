"""The walk of a user on machine benches: compare finds the failing channel, diagnose names the effect, add ends at the
noise.

The truth is the field of the very machine, solved at every angle and current that is read, on another mesh and with
another reading of the steel's curve than the model has.
"""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from benchmarks.virtual_benches.machine_bench import Grid, MachineBench
from effects.library import library
from geometry.half_cell import MeshDensity
from units import DEGREE
from workbench.campaign import read_campaign
from workbench.comparison import compare
from workbench.diagnosis import diagnose
from workbench.findings import Comparison, Diagnosis
from workbench.ledger import ACCEPTED
from workbench.model import Model
from workbench.models.machine import MachineBench as BenchModel
from workbench.models.machine_build import MeshPlan
from workbench.walk import Added, add_effect
from benchmarks.virtual_benches.machine_bench import measured_in_full_field

GRID = Grid(6.0, 4.5, (6.0, 30.0, 54.0), (60.0,), 69.0, (-60.0, 60.0))
# What is added to the fine base comes from coarse meshes; the leading effects are solved again at their size.
PLAN = MeshPlan(
    idle=MeshDensity(gap_edges=240, gap_layers=1, across_iron=1.5),
    loaded=MeshDensity(gap_edges=120, longest_gap_edge=2.5, gap_layers=1, across_iron=1.5),
)
NAMES = (
    "magnet_temperature", "end_leakage", "weak_magnet", "static_eccentricity", "slot_opening", "lost_turns",
    "phase_imbalance", "steel_saturation", "voltage_gain", "torque_gain", "torque_offset", "current_gain",
    "encoder_zero",
)  # fmt: skip
LIBRARY = {name: cls for name, cls in library().items() if name in NAMES}
