"""A case solved by NGSolve. Runs in an environment of its own: python ngsolve_worker.py FOLDER.

Reads FOLDER/case.json and FOLDER/mesh.npz (written by ``ngsolve_run``), writes FOLDER/result.json and potential.npy.
The clock runs over Newton's method only: mesh, space and forms are there, and one solution has been computed before.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import netgen.meshing
import ngsolve
import numpy as np
from ngsolve import (
    H1,
    TRIG,
    BaseVector,
    BilinearForm,
    BitArray,
    BSpline,
    GridFunction,
    InnerProduct,
    Integrate,
    IntegrationRule,
    LinearForm,
    Mesh,
    Norm,
    OuterProduct,
    Periodic,
    Projector,
    atan2,
    cos,
    dx,
    grad,
    sin,
    sqrt,
    x,
    y,
)

MOST_STEPS = 40
TURNED = 0.1  # of the slope of the energy along a step, by which it may have turned at its end
LEAST_SHARE = 1e-3
MANY_POINTS = 6  # order of the quadrature that shows what three points leave out
# Inside the triangle, exact to degree two; NGSolve's own three points lie on the edges.
THREE_POINTS = IntegrationRule(points=[(1 / 6, 1 / 6), (2 / 3, 1 / 6), (1 / 6, 2 / 3)], weights=[1 / 6] * 3)


class Problem:
    """Space, forms and load of a case."""

    def __init__(self, case: dict, mesh: Mesh):
        self.case, self.mesh = case, mesh
        self.space = space_of(self.mesh, case)
        self.free = free_unknowns(self.space, case)
        self.rule = {"intrules": {TRIG: THREE_POINTS if case["points"] == 3 else IntegrationRule(TRIG, MANY_POINTS)}}
        self.form, self.load = self.field_form(), self.source_form()

    def over(self, *names: str):
        """Integral over the named regions."""
        return dx("|".join(names), **self.rule)

    def field_form(self) -> BilinearForm:
        """integral nu(|grad a|^2) grad a . grad v; NGSolve derives the tangent itself."""
        a, v = self.space.TnT()
        iron = self.case["iron"]
        others = [name for name in self.case["regions"] if name not in iron]
        law = piecewise_linear(self.case["b2"], self.case["nu"])
        form = BilinearForm(self.space, symmetric=True)
        form += (self.nu_beside_iron() * grad(a) * grad(v)).Compile() * self.over(*others)
        form += (law(InnerProduct(grad(a), grad(a))) * grad(a) * grad(v)).Compile() * self.over(*iron)
        return form

    def source_form(self) -> LinearForm:
        """integral j v + integral nu (B_rx dv/dy - B_ry dv/dx), assembled."""
        v, case = self.space.TestFunction(), self.case
        j = self.mesh.MaterialCF(case["current_densities"], default=0)
        b_r = self.mesh.MaterialCF({name: remanence(*b) for name, b in case["remanences"].items()}, default=(0, 0))
        form = LinearForm(self.space)
        form += j * v * self.over(*case["current_densities"])
        if case["remanences"]:
            turned = b_r[0] * grad(v)[1] - b_r[1] * grad(v)[0]
            form += self.nu_beside_iron() * turned * self.over(*case["remanences"])
        return form.Assemble()

    def nu_beside_iron(self):
        """1/mu_0 [m/H], in magnets over their recoil permeability."""
        recoil = dict.fromkeys(self.case["remanences"], self.case["recoil_permeability"])
        return 1 / (self.case["mu_0"] * self.mesh.MaterialCF(recoil, default=1))

    def newton(self) -> tuple[GridFunction, list[float]]:
        """Newton's method from zero field, and the relative residual after each step."""
        a, on_free = GridFunction(self.space), Projector(self.free, True)
        residual, step = a.vec.CreateVector(), a.vec.CreateVector()
        residual.data = on_free * self.load.vec
        scale, residuals = Norm(residual), []
        while not residuals or (residuals[-1] > self.case["tolerance"] and len(residuals) < MOST_STEPS):
            self.form.AssembleLinearization(a.vec)
            step.data = self.form.mat.Inverse(self.free, inverse="sparsecholesky") * residual
            a.vec.data += self.share(a, step, residual) * step
            self.form.Apply(a.vec, step)
            residual.data = on_free * (self.load.vec - step)
            residuals.append(Norm(residual) / scale)
        return a, residuals

    def share(self, a: GridFunction, step: BaseVector, residual: BaseVector) -> float:
        """What is taken of a Newton step: all of it."""
        return 1.0

    def ring_torque(self, a: GridFunction) -> float:
        """Ring average of the stress over the stator half of the gap; on a rotor outside with the other sign."""
        inner, outer = self.case["ring"]
        r_b_r, r_b_phi = x * grad(a)[1] - y * grad(a)[0], -(x * grad(a)[0] + y * grad(a)[1])
        moment = Integrate(r_b_r * r_b_phi / sqrt(x * x + y * y) * self.over("stator_gap"), self.mesh)
        return self.case["sectors"] * moment / (self.case["mu_0"] * (outer - inner))

    def weighted_torque(self, a: GridFunction) -> float:
        """Virtual work of the stress tensor while a piecewise linear weight turns the rotor and holds the stator."""
        rotor, stator = self.case["gap"]
        weight = GridFunction(H1(self.mesh, order=1))
        weight.Set((stator - sqrt(x * x + y * y)) / (stator - rotor))
        clip(weight.vec.FV().NumPy())
        b = ngsolve.CF((grad(a)[1], -grad(a)[0]))
        stress = (OuterProduct(b, b) - 0.5 * InnerProduct(b, b) * ngsolve.Id(2)) / self.case["mu_0"]
        work = InnerProduct(stress * ngsolve.CF((-y, x)), grad(weight))
        return -self.case["sectors"] * Integrate(work * self.over("stator_gap", "rotor_gap"), self.mesh)

    def flux_linkage(self, a: GridFunction, phase: int) -> float:
        """Sum over the coils of the mean potential on the + side minus that on the - side."""
        sides = {name: sign if number == phase else 0 for name, (number, sign) in self.case["coil_sides"].items()}
        turns = self.mesh.MaterialCF(sides, default=0)
        return self.case["sectors"] / self.case["side_area"] * Integrate(turns * a * self.over(*sides), self.mesh)


class Damped(Problem):
    """Newton's steps halved where they overshoot: whole ones circle round saturated bridges.

    The solution has the least energy W(a), which is convex, and the residual is -dW/da. A step s leads down,
    residual . s > 0, and is too long where that slope has turned at its end, residual(a + s) . s < 0.
    """

    def share(self, a: GridFunction, step: BaseVector, residual: BaseVector) -> float:
        """The largest of 1, 1/2, 1/4, ... at which the slope has not turned by more than a tenth."""
        share, slope = 1.0, InnerProduct(residual, step)
        while share > LEAST_SHARE and self.slope(a.vec, share, step) < -TURNED * slope:
            share /= 2
        return share

    def slope(self, a: BaseVector, share: float, step: BaseVector) -> float:
        """Of minus the energy along a step [J/m], where a share of it is taken."""
        there, force = a.CreateVector(), a.CreateVector()
        there.data = a + share * step
        self.form.Apply(there, force)
        return InnerProduct(self.load.vec, step) - InnerProduct(force, step)


def remanence(strength: float, axis: float, direction: float, turn: float) -> tuple:
    """Of a magnet as a function of the place [T]: from the axis on its direction turns by so much per angle [rad]."""
    off = atan2(y * np.cos(axis) - x * np.sin(axis), x * np.cos(axis) + y * np.sin(axis))
    return strength * cos(direction + turn * off), strength * sin(direction + turn * off)


def clip(values: np.ndarray) -> None:
    """Hold nodal values between 0 and 1, in place; interpolation leaves them a rounding away from either."""
    values[:] = np.clip(np.round(values, 9), 0.0, 1.0)


def netgen_mesh(case: dict, arrays: dict) -> netgen.meshing.Mesh:
    """The triangles with their regions, boundary and identified nodes."""
    mesh = netgen.meshing.Mesh(dim=2)
    mesh.AddPoints(np.column_stack([arrays["points"], np.zeros(len(arrays["points"]))]))
    for index, name in enumerate(case["regions"]):
        add_elements(mesh, 2, name, arrays["triangles"][arrays["region"] == index])
    for name in ("outer", "first_side", "second_side"):
        add_elements(mesh, 1, name, arrays[name])
    for first, second in arrays["pairs"].tolist():
        mesh.AddPointIdentification(netgen.meshing.PointId(first + 1), netgen.meshing.PointId(second + 1), 1)
    return mesh


def add_elements(mesh: netgen.meshing.Mesh, dimension: int, name: str, nodes: np.ndarray) -> None:
    """Add the elements of one region or one piece of the boundary."""
    if len(nodes):
        number = mesh.AddRegion(name, dim=dimension)
        mesh.AddElements(dim=dimension, index=number, data=np.ascontiguousarray(nodes, dtype=np.int32), base=0)


def space_of(mesh: Mesh, case: dict):
    """Continuous functions, zero on the outer boundary, with the sign change from side to side of a sector."""
    space = H1(mesh, order=case["order"], dirichlet="outer")
    return space if case["sectors"] == 1 else Periodic(space, phase=[float(case["sign"])])


def free_unknowns(space, case: dict) -> BitArray:
    """Unknowns without the boundary and, in an antiperiodic sector, without the node on the axis."""
    free = BitArray(space.FreeDofs())
    for node in case["centre"]:
        free.Clear(node)
    return free


def piecewise_linear(positions: list[float], values: list[float]) -> BSpline:
    """Straight lines through points: a B-spline of order two."""
    return BSpline(2, [positions[0], *positions], values)


def corner_potential(a: GridFunction, problem: Problem, pairs: np.ndarray) -> np.ndarray:
    """Potential at the corners; those on the second side of a sector follow from the first."""
    values = a.vec.FV().NumPy()[: problem.mesh.nv].copy()
    values[pairs[:, 1]] = problem.case["sign"] * values[pairs[:, 0]]
    return values


def main(folder: Path) -> None:
    ngsolve.SetNumThreads(1)
    arrays = dict(np.load(folder / "mesh.npz"))
    case = json.loads((folder / "case.json").read_text())
    problem = (Damped if case["damped"] else Problem)(case, Mesh(netgen_mesh(case, arrays)))
    problem.newton()
    began = time.process_time(), time.perf_counter()
    a, residuals = problem.newton()
    cost = time.process_time() - began[0], time.perf_counter() - began[1]
    result = {
        "torque": problem.ring_torque(a),
        "torque_by_weight": problem.weighted_torque(a),
        "flux_linkage": [problem.flux_linkage(a, phase) for phase in range(3)],
        "residuals": residuals,
        "cpu": cost[0],
        "wall": cost[1],
    }
    (folder / "result.json").write_text(json.dumps(result))
    np.save(folder / "potential.npy", corner_potential(a, problem, arrays["pairs"]))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
