"""A machine on a mesh of NGSolve's own: what is told of it is its drawing, materials and ampere-turns.

Netgen meshes the whole machine, circles as circles; elements of order three; another route to the torque. No node, no
symmetry and no sliding circle of this project is in it.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.ngsolve_run import PYTHON
from benchmarks.processes import PeerError, run
from benchmarks.reference_case import sampled_law, turning_remanence
from benchmarks.whole_outline import GAP, WholeOutline, whole_outline
from geometry.cross_section import CrossSection
from magnetostatics.model import MachineMaterials
from units import MU_0

_WORKER = Path(__file__).parent / "ngsolve_own_worker.py"
_ORDER, _QUADRATURE = 3, 6
_RESIDUAL = 1e-8  # relative to the load
_ACROSS_TOOTH = 2.0  # edges
_AROUND_GAP, _FEW_SLOTS, _AROUND_GAP_OF_FEW = 400, 12, 600  # edges; a small machine is cheap
_LAW = 1e-4  # relative, of the straight lines between points of the steel's law


@dataclass(frozen=True)
class Peer:
    """NGSolve's answer to one state: torque [Nm/m], linkage of the phases (3,) [Wb/m per turn], size of the mesh."""

    torque: float
    flux_linkage: np.ndarray
    triangles: int


@dataclass(frozen=True)
class Fineness:
    """By which edges are divided, and those at corners of the drawing once more, dimensionless."""

    edges: float = 1.0
    corners: float = 1.0


def solve_on_own_mesh(
    section: CrossSection,
    materials: MachineMaterials,
    angle: float,
    states: Sequence[np.ndarray],
    fineness: Fineness = Fineness(),
) -> tuple[Peer, ...]:
    """A machine at some ampere-turns of a coil of phases A, B, C, each (3,) [A], on one mesh.

    angle: of the rotor [rad]
    Raises ValueError where stator and rotor are of two steels.
    """
    if materials.stator_steel is not materials.rotor_steel:
        raise ValueError("the comparison holds for one steel in stator and rotor")
    outline = whole_outline(section.machine, angle)
    with TemporaryDirectory() as name:
        folder = Path(name)
        case = _description(section, materials, outline, angle, fineness) | {"states": [s.tolist() for s in states]}
        (folder / "case.json").write_text(json.dumps(case))
        np.savez(folder / "outline.npz", **_arrays(outline))
        run([str(PYTHON), str(_WORKER), name], folder)
        found = json.loads((folder / "result.json").read_text())
    return tuple(_peer(one) for one in found)


def _peer(found: dict) -> Peer:
    if found["residuals"][-1] > _RESIDUAL:
        raise PeerError(f"NGSolve did not converge: relative residuals {found['residuals']}")
    return Peer(found["torque"], np.array(found["flux_linkage"]), found["triangles"])


def _description(
    section: CrossSection, materials: MachineMaterials, outline: WholeOutline, angle: float, fineness: Fineness
) -> dict:
    finer = fineness.edges
    regions = sorted({*outline.left, *outline.right} - {""})
    b2, nu = sampled_law(materials.stator_steel, _LAW)
    return {
        "order": _ORDER,
        "points": _QUADRATURE,
        "tolerance": _RESIDUAL,
        "regions": regions,
        "iron": ["stator_iron", "rotor_iron"],
        "remanences": _remanences(section, materials, angle),
        "recoil_permeability": materials.magnet.recoil_permeability,
        "coil_sides": {f"slot_{slot}_{side}": section.layout.coil_side(slot, side)
                       for slot in range(section.machine.slots) for side in "RL"},
        "edge_lengths": {name: length / finer for name, length in _edge_lengths(section, regions).items()},
        "corner": _in_gap(section) / finer / fineness.corners,
        "largest": section.machine.slot_pitch * section.machine.mid_gap_radius / finer,
        "gap": (section.machine.rotor.rim_radius, section.machine.stator.rim_radius),
        "sectors": 1,
        "sign": 1,
        "centre": [],
        "mu_0": MU_0,
        "b2": b2.tolist(),
        "nu": nu.tolist(),
    }  # fmt: skip


def _remanences(section: CrossSection, materials: MachineMaterials, angle: float) -> dict[str, tuple[float, ...]]:
    """Of every magnet of the whole machine."""
    numbers = range(section.machine.repeats * section.machine.rotor.magnets_per_pitch)
    return {f"magnet_{m}": turning_remanence(section, materials, m, angle) for m in numbers}


def _edge_lengths(section: CrossSection, regions: Sequence[str]) -> dict[str, float]:
    """Longest in each region [m]; towards the gap they fall by themselves."""
    coarse = section.machine.stator.probed_tooth_width / _ACROSS_TOOTH
    return {name: _in_gap(section) if name == GAP else coarse for name in regions}


def _in_gap(section: CrossSection) -> float:
    """Longest in the gap and at corners [m]."""
    machine = section.machine
    around = _AROUND_GAP_OF_FEW if machine.slots <= _FEW_SLOTS else _AROUND_GAP
    return min(machine.airgap, 2 * np.pi * machine.mid_gap_radius / around)


def _arrays(outline: WholeOutline) -> dict[str, np.ndarray]:
    names = {side: np.array(getattr(outline, side)) for side in ("left", "right", "boundary")}
    arrays = {"points": outline.points, "ends": outline.ends, "is_arc": outline.is_arc, "poles": poles(outline)}
    return arrays | names


def poles(outline: WholeOutline) -> np.ndarray:
    """Where the tangents at both ends of an arc meet (k, 2) [m]; of a line its middle."""
    first, last = outline.points[outline.ends].transpose(1, 0, 2)
    chord, rise = (first + last) / 2, outline.points[outline.middle] - (first + last) / 2
    half, height = np.linalg.norm(last - first, axis=1) / 2, np.linalg.norm(rise, axis=1)
    share = np.divide(height, half)
    return chord + rise * np.where(outline.is_arc, 2 / (1 - share**2), 0.0)[:, None]
