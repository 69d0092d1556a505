"""Heat out of a slot against finite differences: a unit cell of round wires, and a rectangle that is heated."""

import numpy as np
import pytest
from scipy.sparse import diags
from scipy.sparse.linalg import spsolve

from electrical.wire import Wire
from geometry.areas import part_areas
from tests.thermal.built import MACHINE
from thermal.errors import ThermalError
from thermal.slot import Filling, Liner, half_slot, heated_slices, slot_paths

NO_LINER, LINER = Liner(1e-9, 1.0), Liner(0.25e-3, 0.14)


def laplacian(conductivity, left=None):
    """-div(k grad) of cells (n, m) of width 1, isolated all round; left [W/K]: of the walls of row 0."""
    n, m = conductivity.shape
    index = np.arange(n * m).reshape(n, m)
    k = conductivity
    rows = [(index[:-1], index[1:], 2 / (1 / k[:-1] + 1 / k[1:])),
            (index[:, :-1], index[:, 1:], 2 / (1 / k[:, :-1] + 1 / k[:, 1:]))]  # fmt: skip
    matrix = diags([np.zeros(n * m)], [0], format="lil")
    for a, b, g in rows:
        a, b, g = a.ravel(), b.ravel(), g.ravel()
        for i, j, value in zip(a, b, g):
            matrix[i, i] += value
            matrix[j, j] += value
            matrix[i, j] -= value
            matrix[j, i] -= value
    return matrix, index


def cell_conductivity(share, copper, filler, n=60):
    """Of a square array of round wires, from a quarter of its cell between two walls."""
    x = (np.arange(n) + 0.5) / n
    inside = np.hypot(*np.meshgrid(x, x)) < np.sqrt(4 * share / np.pi)
    k = np.where(inside, copper, filler)
    matrix, index = laplacian(k)
    for wall, edge in ((0, 2 * k[0]), (-1, 2 * k[-1])):
        for i, g in zip(index[wall], edge):
            matrix[i, i] += g
    heat = np.zeros(n * n)
    heat[index[0]] = 2 * k[0]  # wall of one degree
    temperature = spsolve(matrix.tocsc(), heat)
    return float(np.sum(2 * k[-1] * temperature[index[-1]]))


@pytest.mark.parametrize("share", (0.2, 0.4))
def test_round_wires_conduct_as_a_solved_cell_does(share):
    solved = cell_conductivity(share, 393.0, 0.2)
    assert Filling(share, 0.0, 393.0, 0.2).conductivity == pytest.approx(solved, rel=0.03)


@pytest.mark.reference
@pytest.mark.parametrize(("share", "close"), ((0.1, 1e-4), (0.2, 1e-3), (0.4, 0.012)))
def test_round_wires_conduct_as_rayleigh_found(share, close):
    """Square array, k = k_f (1 + 2 v / (1/b - v - 0.3058 b v^4)), b = (k_c - k_f)/(k_c + k_f): Lord Rayleigh, Phil.
    Mag. 34 (1892) 481, to its second term."""
    b = (393.0 - 0.2) / (393.0 + 0.2)
    exact = 0.2 * (1 + 2 * share / (1 / b - share - 0.3058 * b * share**4))
    assert Filling(share, 0.0, 393.0, 0.2).conductivity == pytest.approx(exact, rel=close)


def test_enamel_and_filler_lie_side_by_side():
    assert Filling(0.3, 0.2, 393.0, 0.22).conductivity == pytest.approx(Filling(0.3, 0.0, 393.0, 0.22).conductivity)
    assert Filling(0.3, 0.2, 393.0, 0.03).conductivity > Filling(0.3, 0.0, 393.0, 0.03).conductivity
    wire = Wire(0.5e-3, 0.6e-3, 1.7e-8)
    assert wire.enamel_area / wire.area == pytest.approx(1.2**2 - 1)


def test_more_than_fits_a_slot_is_refused():
    with pytest.raises(ThermalError, match="fill"):
        Filling(0.7, 0.31, 393.0, 0.2)


def heated_rectangle(width, depth, conductivity, liner, n=(40, 60)):
    """(mean, largest) rise over the walls for 1 W/m^3, and the share of the heat through the flank at x = 0; flank and
    bottom are cold behind their liner."""
    dx, dy = width / n[0], depth / n[1]
    matrix = diags([np.zeros(n[0] * n[1])], [0], format="lil")
    index = np.arange(n[0] * n[1]).reshape(n)
    series = [(index[:-1], index[1:], conductivity * dy / dx), (index[:, :-1], index[:, 1:], conductivity * dx / dy)]
    for a, b, g in series:
        for i, j in zip(a.ravel(), b.ravel()):
            matrix[i, i] += g
            matrix[j, j] += g
            matrix[i, j] -= g
            matrix[j, i] -= g
    for wall, area, half in ((index[0], dy, dx / 2), (index[:, 0], dx, dy / 2)):
        for i in wall:
            matrix[i, i] += area / (half / conductivity + liner.thickness / liner.conductivity)
    rise = spsolve(matrix.tocsc(), np.full(n[0] * n[1], dx * dy))
    flank = sum(rise[i] * dy / (dx / 2 / conductivity + liner.thickness / liner.conductivity) for i in index[0])
    return float(rise.mean()), float(rise.max()), float(flank / (width * depth))


def sides(machine):
    depth = machine.slot_bottom_radius - machine.shoe_top_radius
    return part_areas(machine).half_slot / depth, depth


def slices(width, depth, conductivity, liner):
    return heated_slices(np.full(100, width), depth / 100, conductivity, liner)


@pytest.mark.parametrize("liner", (NO_LINER, LINER), ids=("bare", "lined"))
def test_a_deep_slot_is_that_of_finite_differences(liner):
    """Within what the docstring says of a deep and narrow one."""
    mean, hottest, flank = heated_rectangle(0.005, 0.02, 0.4, liner)
    found = slices(0.005, 0.02, 0.4, liner)
    assert mean < found.mean < 1.02 * mean
    assert found.largest == pytest.approx(hottest, rel=0.01)
    assert found.flank_share == pytest.approx(flank, rel=0.015)


@pytest.mark.reference
def test_a_bare_square_is_too_warm_by_what_the_docstring_says():
    """Torsion of a square bar of side 2a is the same membrane (Timoshenko and Goodier, Theory of Elasticity): stiffness
    0.1406 (2a)^4 G and largest stress function 0.5894 G theta a^2, so a mean rise of 0.1406 q a^2/k and a largest of
    0.2947 q a^2/k; the fin has 1/3 (1 - tanh(sqrt 3) / sqrt 3)."""
    found = slices(1.0, 1.0, 1.0, NO_LINER)
    assert found.mean == pytest.approx((1 - np.tanh(3**0.5) / 3**0.5) / 3, rel=1e-3)
    assert 1.05 < found.mean / 0.1406 < 1.10
    assert 1.05 < found.largest / 0.2947 < 1.15


def test_a_slot_sends_all_of_its_heat_to_its_walls():
    """Both conductances, their walls at one temperature, carry the heat at the mean rise of the slices."""
    found, paths = half_slot(MACHINE, 0.4, LINER), slot_paths(MACHINE, 0.05, 0.4, LINER)
    heat = 24 * 0.05 * np.sum(found.area)
    assert heat / (paths.flank + paths.bottom) == pytest.approx(found.mean)
    assert paths.flank / (paths.flank + paths.bottom) == pytest.approx(found.flank_share)
    assert paths.hottest(50.0 + found.mean, 50.0, 50.0) - 50.0 == pytest.approx(found.largest)
    assert np.sum(found.area) == pytest.approx(part_areas(MACHINE).half_slot, rel=0.03), "all but the taper"


def test_the_walls_count_by_their_shares():
    paths = slot_paths(MACHINE, 0.05, 0.4, LINER)
    share = paths.flank / (paths.flank + paths.bottom)
    assert paths.hottest(100.0, 60.0, 40.0) == pytest.approx(
        paths.hottest(100.0, *[60.0 * share + 40.0 * (1 - share)] * 2)
    )
