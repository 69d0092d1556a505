"""The flux-map machine: an analytic saturating map, the linear limit, brute force, and the files for other programs."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import xarray as xr
from scipy.io import loadmat

from electrical import dq
from electrical.dq import DriveLimits
from electrical.flux_map_export import flux_tables, write_mat, write_npz
from electrical.flux_map_machine import FluxMapMachine, FluxMapMachineError
from electrical.synchronous_machine import SynchronousMachine
from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from magnetostatics.flux_map import CurrentGrid, flux_map, map_angles
from magnetostatics.flux_map_stage import CURRENTS
from magnetostatics.model import FieldModel
from study.machine_file import read_machine
from units import DEGREE

PLAIN = SynchronousMachine(5, 7.5e-3, 85e-6, 95e-6, 14e-3)  # a small surface-magnet machine, R counted
BURIED = SynchronousMachine(4, 0.05, 0.4e-3, 1.1e-3, 0.05)
INVERSE = SynchronousMachine(4, 0.05, 0.9e-3, 0.5e-3, 0.05)  # L_d > L_q
STRONG = DriveLimits(150.0, 60.0)
LINEAR_CASES = [(PLAIN, DriveLimits(120.0, 27.7)), (BURIED, STRONG), (INVERSE, STRONG)]


def sampled(flux_linkage, pole_pairs, resistance, current, points=15):
    """The flux-map machine of a function (i_d, i_q) -> psi_d, psi_q."""
    i_d = np.linspace(-1.1 * current, 0.8 * current, points)
    i_q = np.linspace(-1.1 * current, 1.1 * current, 2 * points - 1)
    return FluxMapMachine(pole_pairs, i_d, i_q, *flux_linkage(*np.meshgrid(i_d, i_q, indexing="ij")), resistance)


def linear(machine, current):
    return sampled(machine.flux_linkage, machine.pole_pairs, machine.resistance, current)


CURRENT = 120.0
LEAKAGE, SWING, KNEE, MAGNET = 30e-6, 6e-3, 70.0, 60.0  # H, Wb, A, A: the magnet acts like 60 A on the d axis


def saturating(i_d, i_q):
    """psi = grad of L |i|^2 / 2 + Psi I_k sqrt(1 + ((i_d + I_m)^2 + i_q^2) / I_k^2): convex, reciprocal."""
    root = np.sqrt(1 + ((i_d + MAGNET) ** 2 + i_q**2) / KNEE**2)
    return LEAKAGE * i_d + SWING * (i_d + MAGNET) / KNEE / root + 2e-3, LEAKAGE * i_q + SWING * i_q / KNEE / root


MACHINE = sampled(saturating, 5, 14e-3, CURRENT)
LIMITS = DriveLimits(CURRENT, 20.0)
SPEEDS = np.linspace(0.0, 1600.0, 33)


@pytest.fixture(scope="module")
def envelope():
    return dq.torque_speed_envelope(MACHINE, LIMITS, SPEEDS)


def fine_currents(points=41):
    i_d, i_q = np.linspace(-CURRENT, 0.7 * CURRENT, points), np.linspace(-CURRENT, CURRENT, points)
    return np.meshgrid(i_d, i_q, indexing="ij")


# ---- map and inverse ------------------------------------------------------------------------------------------------


def test_the_spline_follows_the_map_between_its_points():
    i_d, i_q = fine_currents()
    exact = np.array(saturating(i_d, i_q))
    assert MACHINE.flux_linkage(i_d, i_q) == pytest.approx(exact, abs=2e-4 * MACHINE.psi_d.max())


def test_a_flat_optimum_hides_what_the_spline_does_to_the_best_angle():
    """Buried magnets; a map of every second current against all of it."""
    found = read_machine("prius_2004")
    section = mesh_cross_section(found.machine, found.layout, MeshDensity(gap_edges=96, gap_layers=1, across_iron=1.0))
    model, reach = FieldModel(section, found.materials), 1000.0
    fine = flux_map(model, CurrentGrid.motoring(reach, 2 * CURRENTS - 1), map_angles(model, 2))
    every_second = fine.isel(id=slice(None, None, 2), iq=slice(None, None, 2))
    all_of_it, stage = (
        FluxMapMachine.from_per_turn(one, turns=1.0, active_length=1.0, resistance=0.0) for one in (fine, every_second)
    )
    current = np.linspace(0.2, 1.0, 41) * reach
    best, currents = (dq.mtpa_currents(machine, current) for machine in (all_of_it, stage))
    off = np.arctan2(-currents[0], currents[1]) - np.arctan2(-best[0], best[1])
    assert 0.05 * DEGREE < np.abs(off).max() < 0.25 * DEGREE
    assert np.all(all_of_it.torque(*currents) > (1 - 3e-5) * all_of_it.torque(*best))
    assert stage.torque(*currents) == pytest.approx(all_of_it.torque(*best), rel=5e-3)
    assert stage.torque(*currents)[-1] == pytest.approx(all_of_it.torque(*best)[-1], rel=3e-4)


def test_one_call_gives_flux_linkages_and_torque():
    psi_d, psi_q, torque = MACHINE(-40.0, 90.0)
    assert torque == pytest.approx(7.5 * (psi_d * 90.0 + psi_q * 40.0), rel=1e-14)
    assert (psi_d, psi_q) == tuple(MACHINE.flux_linkage(-40.0, 90.0))


def test_the_inverse_returns_the_currents():
    i_d, i_q = fine_currents(61)
    back = MACHINE.currents(*MACHINE.flux_linkage(i_d, i_q))
    assert np.abs(np.array(back) - [i_d, i_q]).max() < 1e-9 * CURRENT


def test_corners_of_the_map_can_be_inverted():
    i_d, i_q = np.meshgrid(MACHINE.i_d[[0, -1]], MACHINE.i_q[[0, -1]], indexing="ij")
    back = MACHINE.currents(*MACHINE.flux_linkage(i_d, i_q))
    assert np.abs(np.array(back) - [i_d, i_q]).max() < 1e-9 * CURRENT


def test_the_map_goes_on_beyond_its_edge_and_says_so():
    edge = np.array(MACHINE.flux_linkage(MACHINE.i_d[-1], 50.0))
    i_d, i_q, inside = MACHINE.continued_currents(edge[0] + np.array([-1e-5, 0.0, 1e-5, 1e-4]), edge[1])
    assert inside.tolist() == [True, True, False, False]
    assert np.all(np.diff(i_d) > 0)
    with pytest.raises(FluxMapMachineError, match="outside the map"):
        MACHINE.currents(edge[0] + 1e-4, edge[1])


def test_currents_outside_are_refused():
    with pytest.raises(FluxMapMachineError, match="outside the map"):
        MACHINE.flux_linkage(0.0, 1.2 * CURRENT)


def test_a_map_that_is_not_monotone_is_refused():
    with pytest.raises(FluxMapMachineError, match="not monotone"):
        replace(MACHINE, psi_q=-MACHINE.psi_q)
    with pytest.raises(FluxMapMachineError, match="not monotone"):
        replace(MACHINE, psi_d=MACHINE.psi_q, psi_q=MACHINE.psi_d)


def test_a_map_with_a_hole_or_transposed_axes_is_refused():
    with pytest.raises(FluxMapMachineError, match="one value per"):
        replace(MACHINE, psi_d=MACHINE.psi_d.T)
    with pytest.raises(FluxMapMachineError, match="increasing"):
        replace(MACHINE, i_d=MACHINE.i_d[::-1])


# ---- inductances ----------------------------------------------------------------------------------------------------


def test_incremental_inductances_are_slopes():
    step, at = 1e-3, (-35.0, 62.0)
    inductances = MACHINE.incremental_inductances(*at)
    for column, (d, q) in enumerate(((step, 0.0), (0.0, step))):
        ends = [np.array(MACHINE.flux_linkage(at[0] + s * d, at[1] + s * q)) for s in (1, -1)]
        assert inductances[:, column] == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-6)


@pytest.mark.physics
def test_reciprocity():
    """L_dq = L_qd everywhere, as far as the splines follow a map that has a co-energy."""
    (l_dd, l_dq), (l_qd, _) = MACHINE.incremental_inductances(*fine_currents())
    assert np.abs(l_dq - l_qd).max() < 5e-3 * l_dd.max()
    assert np.abs(l_dq).max() > 0.1 * l_dd.max()  # there is cross-saturation to be reciprocal


@pytest.mark.physics
def test_no_energy_comes_out_of_a_round_trip():
    """The closed integral of psi_d di_d + psi_q di_q vanishes."""
    angle = np.linspace(0.0, 2 * pi, 2001)
    i_d, i_q = -10.0 + 70.0 * np.cos(angle), 20.0 + 80.0 * np.sin(angle)
    psi_d, psi_q = MACHINE.flux_linkage(i_d, i_q)
    work = np.trapezoid(psi_d, i_d) + np.trapezoid(psi_q, i_q)
    assert abs(work) < 1e-5 * np.trapezoid(np.abs(psi_d), angle) * 70.0


def test_apparent_inductances_of_a_linear_map():
    assert linear(BURIED, 150.0).apparent_inductances(-40.0, 90.0) == pytest.approx((0.4e-3, 1.1e-3), rel=1e-9)
    with pytest.raises(FluxMapMachineError, match="zero current"):
        MACHINE.apparent_inductances(0.0, 10.0)


def test_apparent_exceeds_incremental_inductance_in_saturation():
    apparent = MACHINE.apparent_inductances(-1.0, 110.0)[1]
    incremental = MACHINE.incremental_inductances(-1.0, 110.0)[1, 1]
    assert apparent > 1.1 * incremental


# ---- limits ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("machine, limits", LINEAR_CASES)
def test_linear_limit(machine, limits):
    """A linear map is the constant-parameter machine: MTPA, base speed, envelope."""
    mapped = linear(machine, limits.current_peak)
    base = dq.base_speed(machine, limits)
    speed = np.linspace(0.0, 4.0, 17) * base
    ours = dq.torque_speed_envelope(mapped, limits, speed)
    theirs = dq.torque_speed_envelope(machine, limits, speed)
    assert ours.torque == pytest.approx(theirs.torque, rel=1e-6, nan_ok=True)
    assert ours.i_d == pytest.approx(theirs.i_d, abs=2e-4 * limits.current_peak, nan_ok=True)
    assert dq.base_speed(mapped, limits) == pytest.approx(base, rel=1e-6)
    mtpa = dq.mtpa_currents(machine, 90.0)
    assert dq.mtpa_currents(mapped, 90.0) == pytest.approx(mtpa, abs=1e-3)


def test_constant_parameters_of_a_linear_map():
    found = linear(BURIED, 150.0).constant_parameters(100.0)
    for name in ("psi_m", "inductance_d", "inductance_q", "resistance"):
        assert getattr(found, name) == pytest.approx(getattr(BURIED, name), rel=1e-9)


def test_envelope_against_brute_force(envelope):
    """Every current of a fine polar grid under both limits: none gives more torque, the best one hardly less."""
    radius, gamma = np.meshgrid(np.linspace(0, 1, 201) * CURRENT, np.linspace(-0.3, pi / 2, 301))
    i_d, i_q = -radius * np.sin(gamma), radius * np.cos(gamma)
    torque = MACHINE.torque(i_d, i_q)
    for speed, found in zip(SPEEDS[::4], envelope.torque[::4], strict=True):
        allowed = np.hypot(*MACHINE.voltage(i_d, i_q, speed)) <= LIMITS.voltage_peak
        best = np.max(torque, where=allowed, initial=-np.inf)
        assert best * (1 - 1e-9) <= found <= best * 1.02  # the grid's own step


def test_envelope_keeps_both_limits(envelope):
    assert np.all(envelope.current_peak <= CURRENT * (1 + 1e-9))
    assert np.all(envelope.voltage_peak <= LIMITS.voltage_peak * (1 + 1e-6))
    assert np.all(np.diff(envelope.torque) <= 1e-9)


def test_constant_torque_ends_at_the_base_speed():
    base = dq.base_speed(MACHINE, LIMITS)
    full = MACHINE.torque(*dq.mtpa_currents(MACHINE, CURRENT))
    below, above = dq.torque_speed_envelope(MACHINE, LIMITS, base * np.array([0.999, 1.01])).torque
    assert below == pytest.approx(full, rel=1e-9)
    assert above < full * (1 - 1e-5)


def test_mtpa_is_where_the_torque_has_no_slope_along_the_circle():
    i_d, i_q = dq.mtpa_currents(MACHINE, np.array([30.0, 80.0, CURRENT]))
    assert np.hypot(i_d, i_q) == pytest.approx([30.0, 80.0, CURRENT])
    for turn in (-0.01, 0.01):
        c, s = np.cos(turn), np.sin(turn)
        assert np.all(MACHINE.torque(c * i_d - s * i_q, s * i_d + c * i_q) < MACHINE.torque(i_d, i_q))


@pytest.mark.physics
def test_mtpv_without_resistance_has_torque_stationary_along_the_flux_circle():
    lossless = replace(MACHINE, resistance=0.0)
    i_d, i_q = dq.mtpv_currents(lossless, LIMITS.voltage_peak, np.array([1200.0, 1500.0]), lossless.reach)
    assert np.all(np.isfinite(i_d))
    psi = np.array(lossless.flux_linkage(i_d, i_q))
    assert np.hypot(*psi) == pytest.approx(LIMITS.voltage_peak / (5 * np.array([1200.0, 1500.0])), rel=1e-6)
    for turn in (-0.02, 0.02):
        c, s = np.cos(turn), np.sin(turn)
        turned = lossless.currents(c * psi[0] - s * psi[1], s * psi[0] + c * psi[1])
        assert np.all(lossless.torque(*turned) < lossless.torque(i_d, i_q))


def test_power_balance_has_no_loss_but_copper(envelope):
    i_d, i_q, speed = envelope.i_d, envelope.i_q, envelope.speed
    v_d, v_q = MACHINE.voltage(i_d, i_q, speed)
    copper = 1.5 * MACHINE.resistance * (i_d**2 + i_q**2)
    assert 1.5 * (v_d * i_d + v_q * i_q) == pytest.approx(envelope.power + copper, rel=1e-9)


def test_a_limit_beyond_the_map_is_refused():
    with pytest.raises(FluxMapMachineError, match="current limit of .* leaves the map"):
        dq.torque_speed_envelope(MACHINE, DriveLimits(2 * CURRENT, 20.0), SPEEDS)
    with pytest.raises(FluxMapMachineError, match="current limit of .* leaves the map"):
        dq.mtpa_currents(MACHINE, 2 * CURRENT)


# ---- winding --------------------------------------------------------------------------------------------------------


@pytest.fixture
def per_turn():
    """A map per turn and metre with a ripple over the angle that has no mean."""
    angle, i_d, i_q = np.arange(6) * 0.03, np.linspace(-900.0, 300.0, 7), np.linspace(0.0, 900.0, 6)
    d, q = np.meshgrid(i_d, i_q, indexing="ij")
    ripple = 1e-4 * np.cos(2 * pi * np.arange(6) / 6)[:, None, None]
    variables = {"psi_d": 0.0295 + 5e-5 * d + ripple, "psi_q": 6e-5 * q + ripple}
    return xr.Dataset(
        {name: (("angle", "id", "iq"), value) for name, value in variables.items()},
        {"angle": angle, "id": i_d, "iq": i_q},
        {"pole_pairs": 5},
    )


def test_turns_and_length(per_turn):
    """Twice the turns: twice the flux linkage at half the current, four times the inductance, the same torque."""
    one, two = (FluxMapMachine.from_per_turn(per_turn, turns=n, active_length=0.04, resistance=0.01) for n in (4, 8))
    assert one.flux_linkage(0.0, 0.0) == pytest.approx((4 * 0.04 * 0.0295, 0.0), abs=1e-12)
    assert two.incremental_inductances(-10.0, 50.0) == pytest.approx(4 * one.incremental_inductances(-20.0, 100.0))
    assert two.torque(-10.0, 50.0) == pytest.approx(one.torque(-20.0, 100.0))
    assert one.torque(0.0, 100.0) == pytest.approx(7.5 * 0.04 * 0.0295 * 400.0)


# ---- files ----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def tables():
    return flux_tables(MACHINE, 21)


def test_tables_of_currents_invert_those_of_flux_linkages(tables):
    """At every solved point of the current table the machine has the flux linkage of the breakpoints."""
    solved = tables.inside == 1
    assert 0.5 < solved.mean() < 1.0
    psi = MACHINE.flux_linkage(tables.id[solved], tables.iq[solved])
    wanted = np.meshgrid(tables.flux_d, tables.flux_q, indexing="ij")
    assert np.array(psi) == pytest.approx(np.array([table[solved] for table in wanted]), abs=1e-12)
    assert np.all(np.diff(tables.id, axis=0) > 0) and np.all(np.diff(tables.iq, axis=1) > 0)


def test_first_index_runs_along_d(tables):
    assert tables.lambda_d[:, 0] == pytest.approx(MACHINE.flux_linkage(tables.id_index, tables.iq_index[0])[0])


def test_matlab_file(tables, tmp_path):
    write_mat(tmp_path / "map.mat", tables)
    read = loadmat(tmp_path / "map.mat", squeeze_me=True)
    for name in ("id_index", "lambda_q", "torque", "flux_d", "id", "i_s_dq", "psi_s_dq"):
        assert read[name] == pytest.approx(tables.fields[name])
    assert read["pole_pairs"] == 5


def test_syre_axes(tables, tmp_path):
    """Read as SyR-e's reader in motulator does: i_d = -Iq, i_q = Id, psi_d = -Fq, psi_q = Fd, turned by -90 degrees."""
    write_mat(tmp_path / "map.mat", tables)
    syre = loadmat(tmp_path / "map.mat")["motorModel"][0, 0]["FluxMap_dq"][0, 0]
    axes = ((-1, "Iq"), (1, "Id"), (-1, "Fq"), (1, "Fd"))
    i_d, i_q, psi_d, psi_q = (sign * np.rot90(syre[name], -1) for sign, name in axes)
    assert np.all(np.diff(i_d, axis=1) > 0) and np.all(np.diff(i_q, axis=0) > 0) and i_q.min() == 0.0
    found = np.array([psi_d, psi_q, np.rot90(syre["T"], -1)])
    assert found == pytest.approx(np.array(MACHINE(i_d, i_q)), abs=1e-12)


def test_numpy_file(tables, tmp_path):
    write_npz(tmp_path / "map.npz", tables)
    with np.load(tmp_path / "map.npz") as read:
        torque = 1.5 * read["pole_pairs"] * np.imag(read["i_s_dq"] * np.conj(read["psi_s_dq"]))
        assert torque == pytest.approx(read["tau_M"], abs=1e-12)
