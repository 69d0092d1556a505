"""Star, delta and parallel paths against phase quantities written out by hand."""

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest

from electrical.braking import short_circuit
from electrical.winding_connection import SERIES_STAR, Delta, Star, WindingConnection
from electrical.winding_selection import WindingError, evaluate_windings, full_designs
from electrical.winding_stage import layout_of, possible_connections, winding_stage
from electrical.wire import Wire
from electrical.wound_machine import WoundMachine
from materials.enamelled_wire import gauge
from tests.electrical.analytic_map import DEMAND, GOOD, INPUTS, LINEAR, MATCHED, POLE_PAIRS, flux_map
from tests.electrical.test_winding_selection import LENGTH, LIMITS, THESIS
from tests.electrical.wires import HALF_MILLIMETRE, given_lengths, series_star
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE

DELTA, TWO_PATHS = WindingConnection(1, Delta()), WindingConnection(2, Star())
BOTH = WindingConnection(2, Delta())
ALL = (SERIES_STAR, TWO_PATHS, DELTA, BOTH)
DENSITY = 10 * AMPERE_PER_SQUARE_MILLIMETRE
MAP = flux_map()
SPEED = 100.0  # rad/s, mechanical


def wound(connection, turns=12, strands=12):
    return WoundMachine(MATCHED.machine, 4, 1, series_star(turns, strands, connection=connection), 0.04)


@pytest.mark.physics
@pytest.mark.parametrize(
    "connection, r, psi, ampere",
    [(SERIES_STAR, 1, 1, 1), (TWO_PATHS, 4, 2, 2), (DELTA, 3, sqrt(3), sqrt(3)), (BOTH, 12, sqrt(12), sqrt(12))],
)
def test_terminal_constants_change_and_losses_do_not(connection, r, psi, ampere):
    """12 turns of 12 wires: R/a^2, psi/a; a delta takes a third of R and psi/sqrt(3), and sqrt(3) of the current."""
    series, other = wound(SERIES_STAR), wound(connection)
    assert other.phase_resistance == pytest.approx(series.phase_resistance / r)
    one, two = (machine.on_map(MAP.data) for machine in (series, other))
    assert float(two.flux_linkage(0.0, 0.0)[0]) == pytest.approx(float(one.flux_linkage(0.0, 0.0)[0]) / psi)
    assert two.incremental_inductances(0.0, 0.0)[1, 1] == pytest.approx(one.incremental_inductances(0.0, 0.0)[1, 1] / r)
    currents = [machine.current_peak(DENSITY) for machine in (series, other)]
    assert currents[1] == pytest.approx(ampere * currents[0])
    assert float(two.torque(0.0, currents[1])) == pytest.approx(float(one.torque(0.0, currents[0])))
    losses = [1.5 * machine.phase_resistance * i**2 for machine, i in zip((series, other), currents)]
    # 12 coils of a double layer of 12 turns, each with two sides and ends, at J in the copper, RMS
    volume = 12 * 12 * 12 * HALF_MILLIMETRE.area * 2 * (0.04 + series.end_turn_length)
    assert losses == pytest.approx([HALF_MILLIMETRE.resistivity * DENSITY**2 * volume] * 2)


@pytest.mark.physics
@pytest.mark.parametrize("connection", ALL, ids=str)
def test_terminals_see_what_the_coils_make(connection):
    """EMFs and currents of the real phases over time, and what the equivalent star says of the terminals."""
    machine, t = wound(connection), np.linspace(0, 2 * pi, 240, endpoint=False)
    turn = 2 * pi / 3 * np.arange(3)[:, None]
    coil_peak = connection.coil_current(machine.current_peak(DENSITY))
    assert coil_peak / sqrt(2) / (12 * HALF_MILLIMETRE.area) == pytest.approx(DENSITY)
    phase_current = connection.paths * coil_peak * np.cos(t - turn)
    series_turns = 12 / connection.paths  # of each of the four coils
    emf = POLE_PAIRS * SPEED * series_turns * 0.04 * LINEAR.psi_m * -np.sin(t - turn)
    ends = [connection.closing.terminal_at_end(phase) for phase in range(3)]
    line = phase_current[0] - sum(phase_current[k] for k in range(3) if ends[k] == 0)
    across = emf[0] - emf[1] if ends[0] is None else emf[0] if ends[0] == 1 else -emf[1]  # from terminal A to B
    field = machine.on_map(MAP.data)
    assert np.max(line) == pytest.approx(machine.current_peak(DENSITY), rel=1e-3)
    voltage = np.hypot(*field.voltage(0.0, 0.0, SPEED))
    assert np.max(across) == pytest.approx(sqrt(3) * voltage, rel=1e-3)
    assert connection.phase_voltage(voltage) == pytest.approx(np.max(emf[0]), rel=1e-3)
    lag = np.angle(np.fft.fft(phase_current[0])[1] / np.fft.fft(line)[1])
    assert lag == pytest.approx(connection.closing.lag, abs=1e-9)
    assert connection.phase_resistance(machine.phase_resistance) == pytest.approx(  # coils in series, then in parallel
        4 / connection.paths * 12 * 2 * (0.04 + machine.end_turn_length) * HALF_MILLIMETRE.resistivity
        / (12 * HALF_MILLIMETRE.area * connection.paths)
    )  # fmt: skip


@pytest.mark.physics
def test_shorted_terminals_brake_alike_whatever_lies_behind_them():
    """T = 1.5 p^2 psi^2 R w / (R^2 + (p w L)^2) of one turn and one metre, times the length: no turns are in it."""
    machine = wound(SERIES_STAR)
    resistance = machine.phase_resistance / 144 / 0.04
    whole = resistance**2 + (POLE_PAIRS * SPEED * LINEAR.inductance_d) ** 2
    expected = 0.04 * 1.5 * POLE_PAIRS**2 * LINEAR.psi_m**2 * resistance * SPEED / whole
    for connection in ALL:
        braking = short_circuit(wound(connection).on_map(MAP.data), SPEED)
        assert float(braking.torque) == pytest.approx(expected, rel=1e-6)
        coil = connection.coil_current(float(braking.current_peak))
        assert 12 * coil == pytest.approx(POLE_PAIRS * SPEED * LINEAR.psi_m / whole**0.5, rel=1e-6)


@pytest.mark.physics
def test_the_bus_limits_a_star_at_v_over_root_three_and_a_delta_at_v():
    """Without resistance a salient-free machine at full current: w = V / (p sqrt(psi^2 + (L i)^2)) of a real phase."""
    free = replace(HALF_MILLIMETRE, resistivity=1e-15)
    for connection in ALL:
        design = series_star(12, 12, free, connection)
        (one,) = evaluate_windings(THESIS, LIMITS, (design,), given_lengths(1, LENGTH))
        turns, coil = 12 / connection.paths, connection.coil_current(one.current_peak)
        flux = turns * LENGTH * THESIS.dq.psi_m
        inductance = turns**2 * LENGTH * THESIS.dq.inductance_d
        volts = LIMITS.dc_voltage / (1 if connection.closing == Delta() else sqrt(3))
        expected = volts / (5 * np.hypot(flux, inductance * connection.paths * coil))
        assert one.base_speed == pytest.approx(expected, rel=1e-6)


def test_two_paths_of_twice_the_turns_are_the_same_winding():
    series, parallel = (
        evaluate_windings(THESIS, LIMITS, (design,), given_lengths(1, LENGTH))[0]
        for design in (series_star(6, 24), series_star(12, 12, connection=TWO_PATHS))
    )
    assert replace(parallel, design=series.design) == series


def choice(**changes):
    return winding_stage(MAP, MATCHED, DEMAND, replace(INPUTS, **changes), GOOD)


def test_more_freedom_never_needs_more_current_or_a_much_longer_machine():
    limits = replace(INPUTS.limits, phase_current_rms=400.0)
    one, two = choice(limits=limits), choice(limits=limits, paths=(1, 2))
    assert two.chosen.design.connection == TWO_PATHS and two.chosen.turns % 2 == 1  # half a turn in between
    assert two.chosen.current_rms < one.chosen.current_rms
    assert two.chosen.active_length <= 1.05 * one.chosen.active_length
    assert [a.verdict for a in two.alternatives].count("chosen") == 1
    assert "more current" in two.alternatives[0].verdict


def test_thinner_wires_fill_the_slot_where_thick_ones_leave_copper_out():
    sizes = [gauge(d * MILLIMETRE, 1) for d in (0.5, 1.6)]
    wires = tuple(Wire(s.copper_diameter, s.outer_diameter, HALF_MILLIMETRE.resistivity) for s in sizes)
    found = choice(wires=wires)
    assert found.chosen.design.wire == wires[0]
    assert {one.winding.design.wire for one in found.alternatives} == set(wires)


def test_the_enamel_limits_what_fits():
    """With 0.35 of the coil side for wires and enamel a grade with more of it leaves room for fewer wires."""
    limits = replace(LIMITS, insulated_fill=0.35)
    counts = []
    for grade in (1, 2):
        size = gauge(0.5 * MILLIMETRE, grade)
        wire = Wire(size.copper_diameter, size.outer_diameter, 1.7e-8)
        counts.append(max(d.turns for d in full_designs(THESIS.coil_side_area, (wire,), (SERIES_STAR,), limits)))
    area = THESIS.coil_side_area / (pi / 4)
    assert counts == [int(0.35 * area / (d * MILLIMETRE) ** 2) for d in (0.544, 0.566)]


def test_paths_that_the_star_of_slots_has_not_are_said_or_refused():
    found = choice(paths=(1, 4))
    assert found.left_out == (4,) and len(found.alternatives) == 1
    with pytest.raises(WindingError, match=r"parallel_paths = \[4\] .* \[1, 2\] only"):
        choice(paths=(4,))


def test_the_layout_of_a_map_is_that_of_its_star_of_slots():
    layout = layout_of(MAP, MATCHED)
    assert (layout.slots, layout.layers, layout.coils_in_series) == (12, 2, 4)
    assert len(possible_connections(layout, (1, 2), (Star(), Delta()))) == 4
