"""A curve in the wrong unit is refused, and the sentence says which column looks wrong."""

import csv
from pathlib import Path

import pytest

from materials.curve_units import wrong_unit
from materials.errors import MaterialError
from materials.library import known_steels, load_steel, read_curve, steel_file

OERSTED = 1000 / (4 * 3.141592653589793)  # A/m


@pytest.fixture(scope="module", params=known_steels())
def curve(request):
    return read_curve(steel_file(request.param))[1:]


def scaled(curve, field=1.0, flux=1.0):
    return [field * h for h in curve[0]], [flux * b for b in curve[1]]


def test_the_shipped_curves_look_right(curve):
    assert wrong_unit(*curve) is None


@pytest.mark.parametrize(
    "field, flux, named",
    [
        (1, 1e3, ["B_T", "looks like mT"]),
        (1, 1e4, ["B_T", "looks like gauss"]),
        (1, 10, ["B_T", "looks like kilogauss"]),
        (1, 0.01, ["B_T", "below 0.2 T"]),
        (1e-3, 1, ["H_A_per_m", "kA/m"]),
        (1e-2, 1, ["H_A_per_m", "A/cm"]),
        (1 / OERSTED, 1, ["H_A_per_m", "oersted"]),
        (1e3, 1, ["H_A_per_m", "mA/m"]),
        (1 / OERSTED, 1e4, ["B_T", "looks like gauss"]),  # a whole table in CGS
    ],
)
def test_a_slip_of_unit_names_its_column(curve, field, flux, named):
    said = wrong_unit(*scaled(curve, field, flux))
    assert said is not None and all(part in said for part in named), said


def test_soft_materials_of_other_kinds_are_accepted():
    ferrite = [0, 5, 10, 20, 50, 200, 1000], [0, 0.02, 0.05, 0.12, 0.28, 0.38, 0.42]
    permalloy = [0, 0.5, 1, 2, 10, 100], [0, 0.2, 0.45, 0.6, 0.72, 0.78]
    powder = [0, 1e3, 3e3, 1e4, 3e4, 1e5, 2e5], [0, 0.09, 0.3, 0.8, 1.3, 1.75, 1.95]
    assert [wrong_unit(*points) for points in (ferrite, permalloy, powder)] == [None] * 3


def test_a_curve_file_in_millitesla_is_refused(curve, tmp_path: Path):
    with open(tmp_path / "mine.csv", "w", newline="") as file:
        csv.writer(file).writerows([("H_A_per_m", "B_T"), *zip(*scaled(curve, flux=1e3))])
    with pytest.raises(MaterialError, match=r"mine\.csv: column B_T looks wrong"):
        load_steel("mine.csv", tmp_path)
