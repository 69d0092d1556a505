"""Kinds of rotors against what NGSolve found on meshes of its own (``python -m benchmarks.other_kinds``)."""

import csv
from collections import Counter
from math import pi

import numpy as np
import pytest

from benchmarks.drawn_kinds import halbach, own
from benchmarks.ngsolve_own_mesh import poles
from benchmarks.own_meshes import FULL, NONE, TABLE, ampere_turns, machines, position, solved, usual_section
from benchmarks.whole_outline import GAP, NOTHING, OUTER, RIM, whole_outline
from geometry.areas import part_areas
from geometry.kinds import ROTORS
from magnetostatics.currents import PhaseCurrents

MACHINES = tuple(machines())
NAMES = [f"{type(found.machine.rotor).__name__} of {name}" for name, found in MACHINES]
WITHIN = 2e-3  # of the torque at full current, and of the largest linkage
PEERS_OWN = 1e-3  # by what the peer's torque may move between its two meshes
ANGLE = 0.05  # rad
ROUNDED = 1e-6  # relative, as the coordinates of outlines in files are
EVERY = pytest.mark.parametrize(("name", "found"), MACHINES, ids=NAMES)


def table():
    with open(TABLE, encoding="utf-8", newline="") as file:
        return {(row["kind"], row["machine"], row["state"]): row for row in csv.DictReader(file)}


def test_kinds_were_compared_with_current_and_without():
    """Those without magnets with current alone, and a rotor of one's own."""
    kinds = {kind.__name__ for kind in ROTORS.known.values()} | {type(own()[1].machine.rotor).__name__}
    magnets = {type(found.machine.rotor).__name__ for _, found in MACHINES if found.machine.rotor.magnets_per_pitch}
    found = table()
    assert {kind for kind, _, which in found if which == FULL} == kinds
    assert {kind for kind, _, which in found if which == NONE} == magnets
    assert halbach()[0] in {machine for _, machine, _ in found}


def test_both_codes_agree():
    for row in table().values():
        assert max(float(row[name]) for name in ("ring_difference", "fluxes_difference", "flux_difference")) < WITHIN
        assert float(row["peer_change"]) < PEERS_OWN


@EVERY
def test_torque_is_still_that_of_the_other_code(name, found):
    """By both routes on the usual mesh, with current and without."""
    states = ampere_turns(found)
    rows = [table()[type(found.machine.rotor).__name__, name, state] for state in states]
    points = [PhaseCurrents(position(found), currents) for currents in states.values()]
    scale = abs(float(rows[0]["torque_Nm_per_m"]))
    for row, ours in zip(rows, solved(found, usual_section(found), points), strict=True):
        assert [ours.ring, ours.fluxes] == pytest.approx([float(row["torque_Nm_per_m"])] * 2, abs=WITHIN * scale)
        assert 1e3 * np.abs(ours.flux_linkage).max() == pytest.approx(float(row["flux_mWb_per_m"]), rel=WITHIN)


def swept(points, start, end, pole, is_arc):
    """Twice the area that the ray from the axis sweeps along a curve; of an arc by its chord and its segment."""
    (x, y), (u, v) = points[start], points[end]
    chord = x * v - y * u
    if not is_arc:
        return chord
    half, height = np.hypot(u - x, v - y) / 2, np.hypot(*(pole - (points[start] + points[end]) / 2))
    opening = 2 * np.arctan2(height, half)
    radius = half / np.sin(opening / 2)
    side = np.sign((u - x) * (pole[1] - y) - (v - y) * (pole[0] - x))
    return chord - side * radius**2 * (opening - np.sin(opening))


@EVERY
def test_what_the_peer_is_told_encloses_the_parts_as_drawn(name, found):
    """Areas by Green's theorem around the regions on either side of the curves; all of them close."""
    outline, areas = whole_outline(found.machine, ANGLE), Counter()
    ends = Counter()
    for (start, end), pole, arc, left, right in zip(
        outline.ends, poles(outline), outline.is_arc, outline.left, outline.right, strict=True
    ):
        area = swept(outline.points, start, end, pole, arc) / 2
        areas[left] += area
        areas[right] -= area
        ends.update((region, point) for region in (left, right) for point in (start, end))
    assert all(count % 2 == 0 for count in ends.values())
    drawn, m = part_areas(found.machine), found.machine
    assert areas["stator_iron"] == pytest.approx(drawn.stator_laminations, rel=ROUNDED)
    assert areas["rotor_iron"] == pytest.approx(drawn.rotor_laminations, rel=ROUNDED)
    assert sum(a for one, a in areas.items() if one.startswith("magnet")) == pytest.approx(drawn.magnets, rel=ROUNDED)
    assert sum(a for one, a in areas.items() if one.startswith("slot")) == pytest.approx(
        2 * m.slots * drawn.half_slot, rel=ROUNDED
    )
    assert areas[GAP] == pytest.approx(pi * abs(m.stator.rim_radius**2 - m.rotor.rim_radius**2), rel=ROUNDED)


@EVERY
def test_boundaries_lie_where_the_parts_say(name, found):
    outline, machine = whole_outline(found.machine, ANGLE), found.machine
    radius = np.hypot(*outline.points[outline.middle].T)
    grounded = [r for r in (machine.stator.grounded_radius, machine.rotor.grounded_radius) if r is not None]
    names = np.array(outline.boundary)
    assert set(names) <= {NOTHING, OUTER, RIM}
    assert radius[names == RIM] == pytest.approx(machine.rotor.rim_radius, rel=1e-9)
    assert np.abs(radius[names == OUTER][:, None] - grounded).min(axis=1).max() < 1e-9
