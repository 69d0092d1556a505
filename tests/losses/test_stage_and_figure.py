"""The loss stage without its solves, and its picture."""

import numpy as np
import pytest

from electrical.resistance import copper_resistivity
from figures.losses import loss_maps
from figures.style import png_bytes
from losses.map import grid, loss_map
from pipeline.losses import dataset, loss_grade_of, table_from, tasks_of
from pipeline.stage import StageError
from study.read import read_study
from tests.losses.test_map import LARGEST, TABLE, WOUND, plane


@pytest.fixture(scope="module")
def data():
    speed, torque = np.meshgrid(np.linspace(0, 9000, 21), np.linspace(0, 5.5, 19))
    return dataset(loss_map(plane(torque, speed), WOUND, TABLE, WOUND.phase_resistance(copper_resistivity(20.0))))


def test_stage_needs_a_loss_grade():
    study = read_study("motorcycle")
    with pytest.raises(StageError, match="no losses for steel 35PN270.*name one of"):
        loss_grade_of(study, "35PN270")
    assert loss_grade_of(study, "M19") == "M19"


def test_table_survives_json():
    results = [[*one[0], *one[1], *one[2]] for one in TABLE.terms.reshape(-1, 3, 3).tolist()]
    assert np.array_equal(table_from(LARGEST, results).terms, TABLE.terms)
    assert len(tasks_of(read_study("motorcycle"), "M19", LARGEST)) == len(grid(LARGEST)) == len(results)


def test_data_set_adds_up(data):
    parts = data.copper_W + data.stator_iron_W + data.rotor_iron_W + data.magnet_W
    assert np.allclose(parts, data.total_W, equal_nan=True)
    assert data.total_W.dims == ("torque_Nm", "speed_rpm") and data.speed_rpm[-1] == pytest.approx(9000)
    assert np.isnan(data.total_W[-1, -1]) and data.total_W[0, 0] < 1e-12


def test_figure(data):
    figure = loss_maps(data, "7 turns, 22 wires")
    titles = [axis.get_title(loc="left")[:3] for axis in figure.axes[:3]]
    assert titles == ["(a)", "(b)", "(c)"]
    assert len(png_bytes(figure)) > 30_000
