"""The loss stage on a flux map in closed form, its table, its report and its picture; fields are not solved."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.contour import QuadContourSet

from electrical.driven_machine import driven_machine
from electrical.winding_stage import winding_stage
from figures.losses import loss_maps
from figures.style import png_bytes
from losses.iron import FrequencyTerms
from losses.map import DIRECT, QUADRATURE, FieldLosses
from losses.stage import LossError, LossInputs, current_losses_stage, loss_law, losses_stage, torques_of
from report.losses import dataset, files, section
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, MATCHED, Saturating, flux_map
from tests.magnetostatics.test_flux_map_stage import CASE

MAP = flux_map(Saturating())
LOSSES = LossInputs("35PN270", "M235-35A", 20.0)


class Computed:
    """Workers whose field losses are given: in proportion to the currents, without a solve."""

    def map(self, what, function, tasks):
        assert what == "current_losses" and len(tasks) == len(DIRECT) * len(QUADRATURE)
        return {name: self.losses(task) for name, task in tasks.items()}

    @staticmethod
    def losses(task):
        size = 1 + np.hypot(task.direct, task.quadrature) / 1000
        return FieldLosses(
            FrequencyTerms(0.5 * size, 1e-3, 0.0), FrequencyTerms(1e-3, 0.0, 0.0), FrequencyTerms(0.0, 1e-4 * size, 0.0)
        )


@pytest.fixture(scope="module")
def winding():
    return winding_stage(MAP, MATCHED, DEMAND, INPUTS, GOOD)


@pytest.fixture(scope="module")
def found(winding):
    solved = current_losses_stage(CASE, MAP, MATCHED, LOSSES, Computed())
    return losses_stage(solved, MAP, driven_machine(winding, INPUTS), LOSSES)


@pytest.mark.parametrize("grade", [None, "", "35PN270"])
def test_a_study_without_loss_data_is_refused_with_its_key(grade):
    with pytest.raises(LossError, match="no losses for steel 35PN270 .materials.loss_grade.*name one of"):
        loss_law(replace(LOSSES, loss_grade=grade))
    assert loss_law(replace(LOSSES, loss_grade="M19")).grade == "M19"


def test_the_map_covers_both_senses(found, winding):
    torque = found.losses.torque[:, 0]
    assert torque[0] == pytest.approx(-winding.peak_torque) and torque[-1] == pytest.approx(winding.peak_torque)
    assert np.isfinite(found.losses.total[0, 1]) and np.isfinite(found.losses.total[-1, 1])


@pytest.mark.parametrize("peak", [1.0, 3.521836161264716])
def test_half_the_map_begins_at_no_torque(peak):
    """Evenly from -3.52... to 3.52..., the middle would be 4e-16, and no map be there for a torque of zero."""
    torque = torques_of(peak)
    assert torque[len(torque) // 2] == 0.0 and np.array_equal(torque, -torque[::-1])
    assert torque[-1] == peak and np.diff(torque) == pytest.approx(peak / (len(torque) // 2))


@pytest.mark.physics
def test_braking_is_easier_on_the_voltage(found):
    """The drop over the resistance helps a generator: it reaches its torque to higher speeds, at the same losses."""
    reached = np.isfinite(found.losses.total)
    assert reached[0].sum() > reached[-1].sum()
    assert not np.any(reached & ~reached[::-1] & (found.losses.torque > 0))
    slow = found.losses.total[:, 1]
    assert slow[::-1] == pytest.approx(slow, rel=1e-6)


@pytest.mark.physics
def test_currents_are_those_of_the_flux_map(found, winding):
    """Copper loss at the peak torque at rest: 3/2 R I^2 of the full current."""
    full = 1.5 * winding.wound.phase_resistance * winding.limits.current_peak**2
    assert found.losses.copper[-1, 0] == pytest.approx(full, rel=1e-6)


def test_best_points_lie_in_their_quadrants(found):
    assert 0.5 < found.generator.efficiency < 1 and 0.5 < found.motor.efficiency < 1
    assert found.motor.torque > 0 > found.generator.torque
    assert found.motor.efficiency == pytest.approx(np.nanmax(found.losses.efficiency[found.losses.torque > 0]))


def test_the_data_of_another_grade_are_said(found):
    assert found.law_is_of_another_grade
    assert "M235-35A, which stand in for 35PN270" in section(found).content[0]


def test_data_set_adds_up(found):
    data = dataset(found)
    parts = data.copper_W + data.stator_iron_W + data.rotor_iron_W + data.magnet_W + data.circulating_W
    assert np.allclose(parts, data.total_W, equal_nan=True)
    assert data.total_W.dims == ("torque_Nm", "speed_rpm")


def test_files(found, winding):
    assert [one.name for one in files(found, winding)] == ["loss_map.nc", "figures/losses.png"]


def test_figure(found):
    figure = loss_maps(found.losses, "7 turns, 22 wires")
    titles = [axis.get_title(loc="left")[:3] for axis in figure.axes[:3]]
    assert titles == ["(a)", "(b)", "(c)"]
    assert "copper, iron and magnets together" in figure.axes[0].get_title(loc="left")
    assert len(png_bytes(figure)) > 30_000


def test_figure_of_a_machine_without_magnets_names_none(found):
    losses = replace(found.losses, magnet=0 * found.losses.magnet)
    assert loss_maps(losses, "").axes[0].get_title(loc="left") == "(a) copper and iron together"


def test_lines_of_efficiency_keep_off_no_torque(found):
    """Where all of them run into each other no label can be read."""
    lines = loss_maps(found.losses, "").axes[1].findobj(QuadContourSet)[1]
    heights = np.concatenate([path.vertices[:, 1] for path in lines.get_paths() if len(path.vertices)])
    assert np.abs(heights).min() > 0.05 * np.abs(found.losses.torque).max()
