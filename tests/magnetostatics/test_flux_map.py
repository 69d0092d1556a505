"""The flux map of the reference machine: published values, two routes to the torque, symmetry, inductances."""

from math import pi

import numpy as np
import pytest

from geometry.cross_section import mesh_cross_section
from geometry.machine import hanselman_machine
from geometry.winding import star_of_slots
from magnetostatics.flux_linkage import park
from magnetostatics.flux_map import (
    CurrentGrid,
    FluxMapError,
    _blend,
    _order,
    dq_current,
    flux_and_torque,
    flux_map,
    flux_torque_and_inductances,
    incremental_inductances,
    map_angles,
    mirrored,
    operating_point,
)
from magnetostatics.model import FieldModel, MachineMaterials, OperatingPoint
from magnetostatics.newton import NewtonSettings
from materials.library import load_steel
from materials.magnet import Magnet
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE

# Design document "field-model": two independent codes, uncertainty 0.05 %; the default mesh adds up to 0.15 %.
TOLERANCE = 2e-3
OVERLOAD = 28.28  # A/mm^2, amplitude
NOMINAL_SHARE = 8.485 / OVERLOAD
PACKING = 0.3


def reference_model(tolerance=1e-4):
    lengths = {"stator_outer_radius": 42.5, "rotor_outer_radius": 15.7, "back_iron_width": 3.3, "magnet_length": 2.5}
    lengths |= {"airgap": 0.5, "slot_opening": 2.0, "shaft_radius": 5.0}
    in_metres = {name: value * MILLIMETRE for name, value in lengths.items()}
    machine = hanselman_machine(slots=12, pole_pairs=5, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0, **in_metres)
    steel = load_steel("35PN270")
    section = mesh_cross_section(machine, star_of_slots(12, 5))
    return FieldModel(section, MachineMaterials(steel, steel, Magnet(1.3, 1.0)), NewtonSettings(tolerance=tolerance))


@pytest.fixture(scope="module")
def model():
    return reference_model()


@pytest.fixture(scope="module")
def exact():
    """The same machine, solved to the end."""
    return reference_model(1e-11)


@pytest.fixture(scope="module")
def overload(model):
    """Ampere-turns of the overload."""
    return dq_current(model, OperatingPoint(0.0, OVERLOAD * AMPERE_PER_SQUARE_MILLIMETRE, 0.0, PACKING))[1]


@pytest.fixture(scope="module")
def data(model, overload):
    shares = np.array([[-1.0, -0.5, 0.0, 0.25], [0.0, NOMINAL_SHARE, 0.65, 1.0]])
    return flux_map(model, CurrentGrid(*(overload * shares)), map_angles(model, 6))


def at(data, i_d, i_q):
    return data.mean("angle").sel(id=i_d, iq=i_q, method="nearest")


# ---- conversion -----------------------------------------------------------------------------------------------------


def test_current_density_and_angle_come_back(model):
    point = OperatingPoint(-0.3, 1.2e7, 0.4, PACKING)
    back = operating_point(model, -0.3, *dq_current(model, point), PACKING)
    assert (back.current_density, back.current_angle) == pytest.approx((1.2e7, 0.4), rel=1e-12)


def test_ampere_turns_are_those_of_the_park_transform(model):
    """The phase currents of an operating point, transformed like flux linkages, are the currents of the map."""
    point = operating_point(model, -0.21, -120.0, 340.0, PACKING)
    machine, axis = model.section.machine, model.section.layout.phase_axis
    phases = point.phase_densities(machine.pole_pairs, axis) * PACKING * model.section.half_slot_area
    assert park(phases, machine.pole_pairs * point.angle, axis) == pytest.approx([-120.0, 340.0], rel=1e-12)


def test_the_packing_factor_does_not_change_the_load(model):
    sparse, full = (operating_point(model, 0.1, -200.0, 300.0, packing) for packing in (0.3, 1.0))
    assert model.load(sparse) == pytest.approx(model.load(full), abs=1e-9)


def test_weakening_current_lies_on_the_negative_d_axis(model):
    assert operating_point(model, 0.0, -100.0, 0.0).current_angle == pytest.approx(pi / 2)


# ---- published values -----------------------------------------------------------------------------------------------


@pytest.mark.reference
def test_no_load_flux_linkage(data):
    assert at(data, 0.0, 0.0).psi_d == pytest.approx(0.029508, rel=TOLERANCE)
    assert abs(at(data, 0.0, 0.0).psi_q) < 1e-3 * 0.029508


@pytest.mark.reference
def test_mean_torque(data, overload):
    assert at(data, 0.0, NOMINAL_SHARE * overload).torque == pytest.approx(55.66, rel=TOLERANCE)
    assert at(data, 0.0, overload).torque == pytest.approx(145.6, rel=TOLERANCE)


@pytest.mark.reference
def test_apparent_inductance_at_the_overload(data, overload):
    assert at(data, 0.0, overload).psi_q / overload == pytest.approx(4.33e-5, rel=5e-3)  # printed with three digits


@pytest.mark.reference
def test_no_load_inductances(model):
    """L_d falls steeply through zero current (3 % in 10 A); the step of the published one is not stated: bracketed."""
    values = [[inductances_at(model, angle, i_d) for i_d in (-5.0, 0.0, 5.0)] for angle in map_angles(model, 3)]
    l_d, l_q = np.mean(values, axis=0).T
    assert l_d[2] < 5.22e-5 < l_d[0] < 1.05 * l_d[2]
    assert l_q[1] == pytest.approx(5.84e-5, rel=5e-3)  # printed with three digits


def inductances_at(model, angle, i_d):
    return np.diag(incremental_inductances(model.solve(operating_point(model, angle, i_d, 0.0))))


# ---- physics --------------------------------------------------------------------------------------------------------


@pytest.mark.physics
def test_torque_from_flux_linkages_is_the_ring_average(data):
    """T = 1.5 p (psi_d i_q - psi_q i_d) in the mean over the rotor angle, to 0.1 % of the largest torque."""
    from_flux = 1.5 * data.pole_pairs * (data.psi_d * data.iq - data.psi_q * data.id)
    mean = data.torque.mean("angle")
    assert float(np.abs(from_flux.mean("angle") - mean).max()) < 1e-3 * float(mean.max())


@pytest.mark.physics
def test_everything_repeats_after_sixty_electrical_degrees(exact):
    angle = map_angles(exact, 7)[3]
    read = [flux_and_torque(exact.solve(operating_point(exact, a, -300.0, 500.0))) for a in (angle, angle + pi / 3 / 5)]
    for name in ("psi_d", "psi_q", "torque"):
        assert read[0][name] == pytest.approx(read[1][name], rel=1e-6)


@pytest.mark.physics
def test_the_mirrored_half_is_what_the_field_says(model, data):
    whole = mirrored(data)
    assert list(whole.iq.values) == [*-data.iq.values[:0:-1], *data.iq.values]
    for k in (0, 1, 4):
        point = operating_point(model, whole.angle.values[k], whole.id.values[1], whole.iq.values[1])
        read = flux_and_torque(model.solve(point))
        for name in ("psi_d", "psi_q", "torque"):
            assert float(whole[name][k, 1, 1]) == pytest.approx(read[name], rel=2e-3)


@pytest.mark.physics
def test_incremental_inductances_are_the_slopes_of_the_flux_linkages(exact):
    """Back-substitution with the converged tangent against central differences, in deep cross-saturation."""
    angle, current, step = -0.37, np.array([-250.0, 650.0]), 0.2
    inductances = incremental_inductances(exact.solve(operating_point(exact, angle, *current)))
    for column, direction in enumerate(np.eye(2)):
        points = [operating_point(exact, angle, *(current + s * direction)) for s in (step, -step)]
        ends = [flux_and_torque(exact.solve(point)) for point in points]
        slope = [(ends[0][name] - ends[1][name]) / (2 * step) for name in ("psi_d", "psi_q")]
        assert inductances[:, column] == pytest.approx(slope, rel=1e-4, abs=1e-4 * inductances[0, 0])


@pytest.mark.physics
def test_incremental_inductances_are_reciprocal_and_positive(model):
    inductances = incremental_inductances(model.solve(operating_point(model, -0.3, -200.0, 800.0)))
    assert inductances[0, 1] == pytest.approx(inductances[1, 0], rel=1e-9)
    assert abs(inductances[0, 1]) > 0.02 * inductances[0, 0]  # cross-saturation is there
    assert np.all(np.linalg.eigvalsh(inductances) > 0)


# ---- the grid -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("shape", [(1, 1), (2, 3), (4, 7), (11, 11)])
def test_every_current_is_solved_once_and_starts_from_solved_ones(shape):
    axes = [np.linspace(-1.0, 2.0, count) for count in shape]
    done = set()
    for index, sources, weights in _order(*axes):
        assert index not in done and set(sources) <= done and len(sources) == len(weights)
        assert not sources or weights.sum() == pytest.approx(1.0)
        done.add(index)
    assert len(done) == shape[0] * shape[1]


def test_starts_are_exact_for_a_parabola():
    x, y = np.linspace(-1.0, 2.0, 9), np.linspace(0.0, 1.0, 6)
    value = 1.0 + 2.0 * x[:, None] - 3.0 * x[:, None] ** 2 + y * x[:, None] + 4.0 * y**2
    starts = [(index, sources, weights) for index, sources, weights in _order(x, y) if len(sources) > 2]
    misses = [value[index] - weights @ [value[s] for s in sources] for index, sources, weights in starts]
    assert len(misses) > 20 and np.abs(misses).max() < 1e-12


def test_a_blend_of_a_solution_with_itself_is_that_solution(model):
    solution = model.solve(OperatingPoint(0.0))
    assert _blend([solution, solution], np.array([-0.5, 1.5])).a == pytest.approx(solution.a, abs=1e-12)
    assert _blend([solution], np.ones(1)) is None  # one alone may be far away


def test_the_map_does_not_depend_on_its_starts(exact, data):
    """One current of the map, solved from scratch and to the end."""
    k, i_d, i_q = 2, data.id.values[1], data.iq.values[2]
    alone = flux_and_torque(exact.solve(operating_point(exact, data.angle.values[k], i_d, i_q)))
    for name in ("psi_d", "psi_q", "torque"):
        assert float(data[name][k, 1, 2]) == pytest.approx(alone[name], rel=5e-4)


def test_labels_and_units(data):
    assert dict(data.sizes) == {"angle": 6, "id": 4, "iq": 4}
    assert [data[name].units for name in ("psi_d", "torque", "id", "angle")] == ["Wb/m", "N m/m", "A", "rad"]
    assert data.pole_pairs == 5


def test_another_reader_adds_inductances(model):
    grid = CurrentGrid(np.array([0.0, 50.0]), np.array([0.0, 50.0]))
    small = flux_map(model, grid, map_angles(model, 1), flux_torque_and_inductances)
    assert small.l_qq.units == "H/m" and small.l_qq.shape == (1, 2, 2)


def test_a_map_that_cannot_be_mirrored_is_refused(data):
    with pytest.raises(FluxMapError, match="starts at i_q = 0"):
        mirrored(data.isel(iq=slice(1, None)))
    with pytest.raises(FluxMapError, match="mirror image"):
        mirrored(data.isel(angle=slice(0, 4)))
