"""A machine solved by NGSolve on Netgen's own mesh: ``python ngsolve_machine.py X.json``, in an environment of its own.

Reads one machine as built and writes X.npz beside it.
Nothing of this file is shared with the field model of the project: the outline is drawn here, the whole machine is
meshed by Netgen, the rotor turns by whole edges of the circle in the middle of the gap, torque is the work of the
stress tensor while a weight turns the rotor, and Newton's tangent is NGSolve's.

A file holds, per metre of length and per turn, torque and the flux of every coil outwards through its tooth:
``no_load`` (1 + coils, window) at successive edges of a fine sliding circle, ``loaded`` (1 + coils, states), of the
torque what the currents add to that of the magnets alone.
"""

from __future__ import annotations

import json
import sys
import time
from itertools import pairwise
from math import asin, cos, pi, sin
from pathlib import Path

import netgen.meshing
import ngsolve
import numpy as np
from netgen.geom2d import SplineGeometry
from ngsolve import (
    H1,
    BilinearForm,
    BSpline,
    GridFunction,
    InnerProduct,
    Integrate,
    LinearForm,
    Mesh,
    Norm,
    atan2,
    grad,
    x,
    y,
)
from ngsolve import dx as over

MU_0 = 4e-7 * pi
IDLE, LOADED = 3, 2  # order of the elements: cogging asks for more than what a current adds
TOLERANCE = 1e-5  # of Newton's residual over the load
MOST_STEPS = 30
SAME_PLACE = 1e-9  # m
ARC_STEP = 1.5 * pi / 180  # longest chord of an arc in iron


# ---- outline ---------------------------------------------------------------------------------------------------------


class Outline:
    """Points and lines of one half of the machine with the domains on their two sides, for Netgen."""

    def __init__(self, move):
        self.geometry, self.move, self.domains = SplineGeometry(), move, {}
        self.points, self.lines = {}, {}

    def domain(self, name: str, size: float) -> int:
        if name not in self.domains:
            self.domains[name] = len(self.domains) + 1
            self.geometry.SetMaterial(self.domains[name], name)
            self.geometry.SetDomainMaxH(self.domains[name], size)
        return self.domains[name]

    def point(self, radius: float, angle: float, moves: bool = True) -> int:
        place = self.move(radius, angle) if moves else (radius * cos(angle), radius * sin(angle))
        key = tuple(round(v, 10) for v in place)
        if key not in self.points:
            self.points[key] = self.geometry.AppendPoint(*place)
        return self.points[key]

    def line(self, start: int, end: int, left: int, right: int, size: float, name: str = "inside") -> None:
        if start == end or (start, end) in self.lines or (end, start) in self.lines:
            return
        self.lines[start, end] = None
        self.geometry.Append(["line", start, end], leftdomain=left, rightdomain=right, bc=name, maxh=size)

    def path(self, points: list[int], left: int, right: int, size: float, name: str = "inside") -> None:
        for start, end in pairwise(points):
            self.line(start, end, left, right, size, name)

    def arc(self, radius, start, end, chord=ARC_STEP, moves=True) -> list[int]:
        count = max(1, round((end - start) / chord))
        return [self.point(radius, start + (end - start) * k / count, moves) for k in range(count + 1)]


def circle(outline: Outline, radius: float, edges: int) -> list[int]:
    """The sliding circle, on which the two halves meet; it never moves."""
    return [outline.point(radius, 2 * pi * k / edges, moves=False) for k in range(edges)] + [
        outline.point(radius, 0.0, moves=False)
    ]


def stator(m: dict) -> Outline:
    """Outline of the stator with its half of the air gap. m: the numbers of the machine, SI"""
    shift = m["stator_shift"]
    o = Outline(lambda r, a: (r * cos(a) + shift[0], r * sin(a) + shift[1]))
    pitch, r_si = 2 * pi / m["slots"], m["rotor_radius"] + m["drawn_airgap"]
    r_bore = m["rotor_radius"] + m["airgap"]  # a ground bore leaves the slots where they are
    r_open, r_shoe = r_si + m["shoe_d1"], r_si + m["shoe_d1"] + m["shoe_d2"]
    r_sb, r_so, half_tooth = m["stator_radius"] - m["back_iron"], m["stator_radius"], m["tooth_width"] / 2
    edge = 2 * pi * (m["rotor_radius"] + m["airgap"] / 2) / m["edges"]
    coarse = m["tooth_width"] / 2.2
    gap, iron = o.domain("stator_gap", 1.2 * edge), o.domain("stator_iron", coarse)
    o.path(circle(o, m["rotor_radius"] + m["drawn_airgap"] / 2, m["edges"]), 0, gap, edge, "sliding")
    for k in range(m["slots"]):
        axis, opening = (k + 0.5) * pitch, m["slot_opening"] + m["opening_changes"][k]
        tip, top = asin(opening / 2 / r_bore), asin(opening / 2 / r_open)
        shoe, flank = pitch / 2 - asin(half_tooth / r_shoe), pitch / 2 - asin(half_tooth / r_sb)
        air = o.domain(f"opening_{k}", 2.5 * edge)
        tooth = o.arc(r_bore, axis - pitch + asin_of(m, k - 1, r_bore), axis - tip, 2 * pi / m["edges"])
        mouth = o.arc(r_bore, axis - tip, axis + tip, 2 * pi / m["edges"])
        o.path(tooth, gap, iron, edge)
        o.path(mouth, gap, air, edge)
        middle_top, middle_bottom = o.point(r_open, axis), o.point(r_sb, axis)
        for sign, side in ((-1, "R"), (1, "L")):
            copper = o.domain(f"slot_{k}_{side}", 2.0 * coarse)
            wall = [o.point(r_bore, axis + sign * tip), o.point(r_open, axis + sign * top)]
            o.path(wall, *((iron, air) if sign > 0 else (air, iron)), 2.5 * edge)
            down = [wall[1], o.point(r_shoe, axis + sign * shoe), o.point(r_sb, axis + sign * flank)]
            o.path(down, *((iron, copper) if sign > 0 else (copper, iron)), coarse)
            floor = o.arc(r_sb, axis - flank, axis) if sign < 0 else o.arc(r_sb, axis, axis + flank)
            o.path(floor, copper, iron, coarse)
            lid = [wall[1], middle_top] if sign < 0 else [middle_top, wall[1]]
            o.path(lid, air, copper, 2.5 * edge)
        names = o.domains[f"slot_{k}_R"], o.domains[f"slot_{k}_L"]
        o.path([middle_top, middle_bottom], names[1], names[0], 2.0 * coarse)
    outside = o.arc(r_so, 0.0, 2 * pi, 3 * pi / 180)
    o.path(outside[:-1] + [outside[0]], iron, 0, coarse, "outer")
    return o


def asin_of(m: dict, slot: int, radius: float) -> float:
    """Half the angle of an opening at a radius."""
    return asin((m["slot_opening"] + m["opening_changes"][slot % m["slots"]]) / 2 / radius)


def rotor(m: dict, turned: float) -> Outline:
    """turned: by which the rotor's parts are ahead of the edges of the circle [rad]."""
    shift = m["rotor_shift"]
    ahead = np.exp(1j * turned)

    def move(r, a):
        place = (r * np.exp(1j * a) + complex(*shift)) * ahead
        return float(place.real), float(place.imag)

    o = Outline(move)
    r_ro, r_core = m["rotor_radius"], m["rotor_radius"] - m["magnet_length"]
    edge, coarse = 2 * pi * (r_ro + m["airgap"] / 2) / m["edges"], m["magnet_length"] / 1.5
    gap, iron = o.domain("rotor_gap", 1.2 * edge), o.domain("rotor_iron", 1.5 * coarse)
    shaft = o.domain("shaft", 2.5 * coarse)
    o.path(circle(o, r_ro + m["drawn_airgap"] / 2, m["edges"]), gap, 0, edge, "sliding")
    borders = magnet_borders(m)
    full = m["magnet_arc"] >= 1.0
    for k, (start, end) in enumerate(borders):
        magnet = o.domain(f"magnet_{k}", coarse)
        following = borders[(k + 1) % m["poles"]][0] + (2 * pi if k == m["poles"] - 1 else 0.0)
        o.path(o.arc(r_ro, start, end, 2 * pi / m["edges"]), magnet, gap, edge)
        o.path(o.arc(r_core, start, end), iron, magnet, coarse)
        if not full:
            air = o.domain(f"between_{k}", coarse)
            o.path(o.arc(r_ro, end, following, 2 * pi / m["edges"]), air, gap, edge)
            o.path(o.arc(r_core, end, following), iron, air, coarse)
            o.path([o.point(r_core, end), o.point(r_ro, end)], air, magnet, coarse)
            after = o.domain(f"magnet_{(k + 1) % m['poles']}", coarse)
            o.path([o.point(r_core, following), o.point(r_ro, following)], after, air, coarse)
        else:
            after = o.domain(f"magnet_{(k + 1) % m['poles']}", coarse)
            o.path([o.point(r_core, end), o.point(r_ro, end)], after, magnet, coarse)
    inner = o.arc(m["shaft_radius"], 0.0, 2 * pi, 10 * pi / 180)
    o.path(inner[:-1] + [inner[0]], shaft, iron, 2.5 * coarse)
    return o


def magnet_borders(m: dict) -> list[tuple[float, float]]:
    """Angles at which every magnet begins and ends; where they touch, a joint lies midway between the two edges."""
    pitch, turns = 2 * pi / m["poles"], m["magnet_turns"]
    half = min(m["magnet_arc"], 1.0) * pitch / 2
    found = [(k * pitch + turns[k] - half, k * pitch + turns[k] + half) for k in range(m["poles"])]
    if m["magnet_arc"] < 1.0:
        return found
    joints = [(k + 0.5) * pitch + 0.5 * (turns[k] + turns[(k + 1) % m["poles"]]) for k in range(m["poles"])]
    return [(joints[k - 1] - (2 * pi if k == 0 else 0.0), joints[k]) for k in range(m["poles"])]


# ---- mesh ------------------------------------------------------------------------------------------------------------


class Half:
    """Netgen's triangles of stator or rotor as arrays. ring: its nodes on the sliding circle, by rising angle."""

    def __init__(self, outline: Outline, radius: float, edges: int):
        mesh = outline.geometry.GenerateMesh(maxh=1.0, grading=0.4)
        self.points = np.array([[p[0], p[1]] for p in mesh.Points()])
        elements = list(mesh.Elements2D())
        self.triangles = np.array([[v.nr - 1 for v in e.vertices] for e in elements])
        names = {number: name for name, number in outline.domains.items()}
        self.region = [names[e.index] for e in elements]
        place = self.points @ np.array([1, 1j])
        ring = np.flatnonzero(np.abs(np.abs(place) - radius) < SAME_PLACE)
        if len(ring) != edges:
            raise ValueError(f"{len(ring)} nodes on the sliding circle where {edges} are wanted")
        self.ring = ring[np.argsort(np.mod(np.angle(place[ring]) + 1e-9, 2 * pi))]


class Meshed:
    """The whole machine with the rotor turned by so many edges."""

    def __init__(self, m: dict, fixed: Half, turning: Half, steps: int):
        self.m = m
        place = turning.points @ np.array([1, 1j]) * np.exp(2j * pi * steps / m["edges"])
        new = np.arange(len(place)) + len(fixed.points)
        new[turning.ring] = np.roll(fixed.ring, -steps)
        keep = np.ones(len(place), bool)
        keep[turning.ring] = False
        number = np.full(len(place), -1)
        number[keep] = len(fixed.points) + np.arange(keep.sum())
        number[turning.ring] = new[turning.ring]
        self.points = np.vstack([fixed.points, np.stack([place.real, place.imag], axis=1)[keep]])
        self.triangles = np.vstack([fixed.triangles, number[turning.triangles]])
        self.region = np.array(fixed.region + turning.region)
        self.mesh = Mesh(self._netgen())

    def _netgen(self) -> netgen.meshing.Mesh:
        mesh = netgen.meshing.Mesh(dim=2)
        mesh.AddPoints(np.column_stack([self.points, np.zeros(len(self.points))]))
        for name in dict.fromkeys(self.region.tolist()):
            index = mesh.AddRegion(name, dim=2)
            nodes = np.ascontiguousarray(self.triangles[self.region == name], dtype=np.int32)
            mesh.AddElements(dim=2, index=index, data=nodes, base=0)
        edges = np.sort(
            np.concatenate([self.triangles[:, [0, 1]], self.triangles[:, [1, 2]], self.triangles[:, [2, 0]]]), axis=1
        )
        distinct, count = np.unique(edges, axis=0, return_counts=True)
        index = mesh.AddRegion("outer", dim=1)
        mesh.AddElements(dim=1, index=index, data=np.ascontiguousarray(distinct[count == 1], dtype=np.int32), base=0)
        return mesh

    def weights(self) -> np.ndarray:
        """1 at the nodes of the rotor, 0 at those of the stator, between them in the gap (n,)."""
        centre = self.points
        value = np.full(len(centre), 0.5)
        radius = np.hypot(*centre.T)
        inner, outer = self.m["rotor_radius"], self.m["rotor_radius"] + self.m["airgap"]
        in_gap = np.char.endswith(self.region, "_gap")
        value = np.clip((outer - radius) / (outer - inner), 0.1, 0.9)
        turns = np.array([name.startswith(("magnet", "rotor_iron", "shaft", "between")) for name in self.region])
        value[np.unique(self.triangles[turns & ~in_gap])] = 1.0
        value[np.unique(self.triangles[~turns & ~in_gap])] = 0.0
        return value


# ---- field -----------------------------------------------------------------------------------------------------------


def smooth(at: np.ndarray, values: np.ndarray) -> BSpline:
    """A cubic spline along the lines through some points; smooth, so that Newton's method ends quickly."""
    knots = np.concatenate([[at[0]] * 3, at, [at[-1]] * 3])
    places = np.array([knots[k + 1 : k + 4].mean() for k in range(len(at) + 2)])
    return BSpline(4, [at[0]] * 3 + at.tolist(), np.interp(places, at, values).tolist())


class Field:
    """Space and forms of one meshed machine."""

    def __init__(self, m: dict, meshed: Meshed, angle: float, order: int):
        self.m, self.mesh = m, meshed.mesh
        self.space = H1(self.mesh, order=order, dirichlet="outer")
        names = list(self.mesh.GetMaterials())
        self.iron = [n for n in names if n.endswith("iron")]
        self.magnets = [n for n in names if n.startswith("magnet")]
        a, v = self.space.TnT()
        mu = {n: m["recoil"] for n in self.magnets}
        mu |= {f"opening_{k}": value for k, value in enumerate(m["opening_mu"])}
        nu = self.mesh.MaterialCF({n: 1 / MU_0 / mu.get(n, 1.0) for n in names if n not in self.iron}, default=0)
        law = smooth(np.array(m["b2"]), np.array(m["nu"]))
        self.form = BilinearForm(self.space, symmetric=True)
        others = "|".join(n for n in names if n not in self.iron)
        self.form += (nu * grad(a) * grad(v)).Compile() * over(others)
        b2 = InnerProduct(grad(a), grad(a))
        self.form += (law(b2) * grad(a) * grad(v)).Compile() * over("|".join(self.iron))
        self.weight = GridFunction(H1(self.mesh, order=1))
        self.weight.vec.FV().NumPy()[:] = meshed.weights()
        self.angle = angle

    def magnetisation(self):
        """Remanence [T] of the magnets with the rotor turned."""
        m, pitch = self.m, 2 * pi / self.m["poles"]
        parts = {}
        for k in range(m["poles"]):
            centre = self.angle + k * pitch + m["magnet_turns"][k]
            size = m["remanence"] * m["strengths"][k] * (1 if k % 2 == 0 else -1)
            off = atan2(y * cos(centre) - x * sin(centre), x * cos(centre) + y * sin(centre))
            direction = centre + m["magnet_tilts"][k] + m["radial_share"] * off
            parts[f"magnet_{k}"] = ngsolve.CF((size * ngsolve.cos(direction), size * ngsolve.sin(direction)))
        return self.mesh.MaterialCF(parts, default=ngsolve.CF((0, 0)))

    def load(self, ampere_turns: np.ndarray) -> LinearForm:
        """ampere_turns: of every coil (coils,) [A]."""
        v = self.space.TestFunction()
        form, b_r = LinearForm(self.space), self.magnetisation()
        form += ((b_r[0] * grad(v)[1] - b_r[1] * grad(v)[0]) / (MU_0 * self.m["recoil"])) * over("|".join(self.magnets))
        density = {}
        for k, current in enumerate(ampere_turns):
            for name, sign in ((f"slot_{k}_R", 1), (f"slot_{(k - 1) % self.m['slots']}_L", -1)):
                density[name] = sign * current / self.area(name)
        if any(density.values()):
            form += self.mesh.MaterialCF(density, default=0) * v * over("|".join(density))
        return form.Assemble()

    def area(self, name: str) -> float:
        if name not in self.m["areas"]:
            self.m["areas"][name] = Integrate(ngsolve.CF(1) * over(name), self.mesh)
        return self.m["areas"][name]

    def solve(self, ampere_turns: np.ndarray, start: np.ndarray | None = None) -> GridFunction:
        a, load = GridFunction(self.space), self.load(ampere_turns)
        residual, step, free = a.vec.CreateVector(), a.vec.CreateVector(), self.space.FreeDofs()
        on_free = ngsolve.Projector(free, True)
        residual.data = on_free * load.vec
        scale = Norm(residual)
        if start is not None:
            a.vec.FV().NumPy()[:] = start
            self.form.Apply(a.vec, step)
            residual.data = on_free * (load.vec - step)
        for _ in range(MOST_STEPS):
            self.form.AssembleLinearization(a.vec)
            step.data = self.form.mat.Inverse(free, inverse="sparsecholesky") * residual
            self.damped(a, step, load, on_free, residual)
            if Norm(residual) < TOLERANCE * scale:  # N
                return a
        raise ValueError(f"Newton's method stopped at {Norm(residual) / scale:.1e}")

    def damped(self, a, step, load, on_free, residual) -> None:
        """A step, shortened while the residual grows."""
        before, trial, share = Norm(residual), a.vec.CreateVector(), 1.0
        old = a.vec.CreateVector()
        old.data = a.vec
        for _ in range(6):
            a.vec.data = old + share * step
            self.form.Apply(a.vec, trial)
            residual.data = on_free * (load.vec - trial)
            if Norm(residual) < before or share < 0.05:
                return
            share *= 0.5

    def numbers(self) -> np.ndarray:
        """Unknowns of every element, in an order that the turning of the rotor leaves (elements, unknowns)."""
        return np.array([self.space.GetDofNrs(element) for element in self.mesh.Elements(ngsolve.VOL)])

    def sample(self, a: GridFunction) -> np.ndarray:
        """Torque and outward flux of every coil, per metre and turn (1 + coils,)."""
        b = ngsolve.CF((grad(a)[1], -grad(a)[0]))
        w, arm = grad(self.weight), ngsolve.CF((-y, x))
        traction = (b * arm) * (b * w) - 0.5 * InnerProduct(b, b) * (arm * w)
        torque = -Integrate(traction / MU_0 * over("stator_gap|rotor_gap"), self.mesh)
        slots = range(self.m["slots"])
        mean = {
            n: Integrate(a * over(n), self.mesh) / self.area(n) for k in slots for n in (f"slot_{k}_R", f"slot_{k}_L")
        }
        flux = [mean[f"slot_{k}_R"] - mean[f"slot_{(k - 1) % self.m['slots']}_L"] for k in slots]
        return np.array([torque, *flux])


# ---- one machine -----------------------------------------------------------------------------------------------------


class Solver:
    """Solutions of one machine, each started from the one before."""

    def __init__(self, m: dict):
        self.m, self.radius = {**m, "areas": {}}, m["rotor_radius"] + m["drawn_airgap"] / 2
        self.fixed = Half(stator(m), self.radius, m["edges"])
        self.rotors: dict[float, Half] = {}
        self.last: dict[tuple[float, int], np.ndarray] = {}
        self.idle: dict[tuple[int, float], np.ndarray] = {}

    def sample(self, steps: int, offset: float, ampere_turns: np.ndarray, order: int) -> np.ndarray:
        """offset: of the rotor against the edges of the sliding circle, beside that of the machine [rad]"""
        turned = self.m["turned"] + offset
        if turned not in self.rotors:
            self.rotors[turned] = Half(rotor(self.m, turned), self.radius, self.m["edges"])
        meshed = Meshed(self.m, self.fixed, self.rotors[turned], steps)
        field = Field(self.m, meshed, steps * 2 * pi / self.m["edges"] + turned, order)
        numbers, start = field.numbers(), np.zeros(field.space.ndof)
        if (turned, order) in self.last:
            start[numbers] = self.last[turned, order]
        a = field.solve(ampere_turns, start)
        self.last[turned, order] = a.vec.FV().NumPy()[numbers]
        return field.sample(a)

    def with_current(self, steps: int, offset: float, ampere_turns: np.ndarray) -> np.ndarray:
        """As ``sample``, of the torque what the currents add."""
        place = steps, offset
        if place not in self.idle:
            self.idle[place] = self.sample(steps, offset, 0 * ampere_turns, LOADED)
        found = self.sample(steps, offset, ampere_turns, LOADED) if any(ampere_turns) else self.idle[place].copy()
        found[0] -= self.idle[place][0]
        return found


def solved(m: dict) -> dict[str, np.ndarray]:
    """The arrays of one machine."""
    began = time.process_time()
    fine, solver, none = Solver({**m, "edges": m["idle_edges"]}), Solver(m), np.zeros(m["slots"])
    idle = [fine.sample(k, 0.0, none, IDLE) for k in range(m["window"])]
    by_angle = sorted(range(len(m["states"])), key=lambda k: (m["states"][k]["steps"], m["states"][k]["ampere_turns"]))
    loaded = np.zeros((len(m["states"]), 1 + m["slots"]))
    for k in by_angle:
        state = m["states"][k]
        for offset, share in state["slices"]:
            loaded[k] += share * solver.with_current(state["steps"], offset, np.array(state["ampere_turns"]))
    return {"no_load": np.array(idle).T, "loaded": loaded.T, "cpu": np.array(time.process_time() - began)}


def main(path: Path) -> None:
    ngsolve.SetNumThreads(1)
    found = solved(json.loads(path.read_text(encoding="utf-8")))
    np.savez_compressed(path.with_suffix(".npz"), **found)
    print(f"{path.stem}: {float(found['cpu']):.1f} s of CPU", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
