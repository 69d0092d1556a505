"""Samples over a revolution: symmetry, signs, and the orders that each defect makes (12 slots, 10 poles)."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geometry.magnetisation import PATTERNS
from tests.workbench.models.machine_case import COARSE, MIDDLE, PLAN, drawn, field
from workbench.models.machine.expansion import no_load_slopes
from workbench.models.machine.field import LoadedState, MachineField, idle, read
from workbench.models.machine.pieces import Fields, Machinery

PHASES = np.array([[(coil.phase == i) * coil.sign for coil in field().layout.coils] for i in range(3)])


def orders(samples, floor):
    """Mechanical orders whose amplitude exceeds ``floor`` of the largest."""
    amplitude = np.abs(np.fft.rfft(samples))[1:-1]
    return set((np.flatnonzero(amplitude > floor * amplitude.max()) + 1).tolist())


def torque_change(design):
    return (field(MIDDLE).no_load(design) - field(MIDDLE).no_load(drawn()))[:, 0]


def linkages(samples):
    return samples[:, 1:] @ PHASES.T


@pytest.mark.parametrize("step", (7, 50, 111))
@pytest.mark.parametrize(
    "design",
    (
        drawn(),
        drawn().with_one("magnet_strengths", 2, 0.8),
        drawn().with_one("opening_changes", 3, 0.4e-3),
        replace(drawn(), stator_shift=(0.05e-3, 0.08e-3)),
        replace(drawn(), rotor_shift=(0.05e-3, 0.08e-3)),
        drawn().with_one("magnet_strengths", 3, 0.8),  # a south pole, which its mirror shows at another number
        drawn().with_one("magnet_turns", 1, 0.01),  # no mirror
        drawn().with_one("magnet_turns", 1, 0.01).with_one("magnet_turns", 4, -0.01),
        replace(drawn(), stator_shift=(0.08e-3, 0.0)),
        replace(drawn(), rotor_shift=(-0.08e-3, 0.0)).with_one("opening_changes", 0, 0.4e-3),
    ),
    ids=("regular", "magnet", "slot", "static", "dynamic", "south", "turned", "two turned", "along", "both along"),
)
def test_revolution_from_its_window_is_what_is_solved_there(design, step):
    model = field().model(design, whole=True)
    solved = read(model.solve(idle(2 * np.pi * step / field().edges)))
    assert_allclose(field().no_load(design)[step], solved, rtol=1e-5, atol=1e-6)


DEFECTS = {
    "weak magnet": (drawn().with_one("magnet_strengths", 0, 0.9), 12, {24, 36, 48}),
    "magnet position": (drawn().with_one("magnet_turns", 0, 0.01), 12, {12, 24, 36, 48}),
    "slot opening": (drawn().with_one("opening_changes", 0, 0.4e-3), 10, {10, 20, 30}),
    "static eccentricity": (replace(drawn(), stator_shift=(0.1e-3, 0.0)), 10, {10}),
    "dynamic eccentricity": (replace(drawn(), rotor_shift=(0.1e-3, 0.0)), 12, {12}),
}


@pytest.mark.parametrize("name", DEFECTS)
def test_cogging_orders(name):
    """A defect of the rotor makes multiples of the slots, one of the stator multiples of the poles."""
    design, base, seen = DEFECTS[name]
    found = orders(torque_change(design), 0.03)
    assert seen <= found
    assert all(order % base == 0 for order in found)


def test_orders_of_the_voltage():
    """Weak magnet: new orders beside the fundamental and 1 % less of it; wide slot: no new orders."""
    base = linkages(field().no_load(drawn()))[:, 0]
    weak = linkages(field().no_load(DEFECTS["weak magnet"][0]))[:, 0]
    wide = linkages(field().no_load(DEFECTS["slot opening"][0]))[:, 0]
    assert {3, 7} <= orders(weak - base, 0.05)
    assert all(order % 10 == 5 for order in orders(wide - base, 1e-3))
    lost = np.abs(np.fft.rfft(weak))[5] / np.abs(np.fft.rfft(base))[5] - 1
    assert_allclose(lost, -0.01, atol=0.002)


def test_sum_of_the_phases_has_triple_orders_only():
    total = linkages(field().no_load(drawn())).sum(axis=1)
    assert all(order % 15 == 0 for order in orders(total, 1e-3))


def test_mean_cogging_of_a_defective_machine_is_zero():
    """Without current no energy comes out of a revolution."""
    design = drawn().with_one("magnet_strengths", 0, 0.9)
    torque = field(MIDDLE).no_load(design)[:, 0]
    assert abs(torque.mean()) < 5e-3 * np.abs(torque).max()


def test_torque_per_ampere_is_voltage_per_speed():
    """Small currents: T(i) - T(0) = sum of i d psi/d angle, per phase (virtual work)."""
    samples = linkages(field(MIDDLE).no_load(drawn()))
    edges, current = field(MIDDLE).edges, 1.0
    slopes = np.fft.irfft(np.fft.rfft(samples, axis=0) * 1j * np.arange(edges // 2 + 1)[:, None], edges, axis=0)
    for step in (9, 25):
        states = [LoadedState(2 * np.pi * step / edges, i) for i in ((current, 0, 0), (-current, 0, 0))]
        forward, back = field(MIDDLE).loaded(drawn(), states)[:, 0]
        assert_allclose((forward - back) / 2, 7 * slopes[step, 0] * current, rtol=0.01, atol=0.01)


def test_derivative_for_another_magnet_is_that_of_its_own_solution():
    """Magnet 3 and slot 4 from the window of the regular machine, against a central difference of whole solutions."""
    fields = field(COARSE)
    found = no_load_slopes(fields, ("both", "magnet", "slot"))
    for name, index, step in (("magnet_strengths", 3, 2e-3), ("opening_changes", 4, 4e-6), ("magnet_turns", 7, 1e-4)):
        start = getattr(drawn(), name)[index]
        ends = [fields.no_load(drawn().with_one(name, index, start + sign * step)) for sign in (1, -1)]
        expected = (ends[0] - ends[1]) / (2 * step)
        for column in (0, 1, 6):
            scale = np.abs(expected[:, column]).max()
            assert_allclose(found[f"{name}[{index}]"][:, column], expected[:, column], atol=0.02 * scale)


@pytest.mark.parametrize("breaks", ("stator", "rotor"))
def test_derivative_for_a_shift_is_that_of_a_solution_there(breaks):
    """In both halves of the window, of which one is the mirror image of the other; the torque goes with its square."""
    fields, step = field(COARSE), 5e-6
    found = no_load_slopes(fields, (breaks,))
    for index, shift in enumerate(np.eye(2) * step):
        designs = [replace(drawn(), **{f"{breaks}_shift": tuple(sign * shift)}) for sign in (1, -1)]
        models = [fields.model(design, whole=True) for design in designs]
        for n in (2, -2):
            ahead, back = (read(model.solve(idle(2 * np.pi * n / fields.edges))) for model in models)
            slope = found[f"{breaks}_shift[{index}]"]
            assert_allclose(((ahead - back) / (2 * step))[1:], slope[n, 1:], atol=3e-3 * np.abs(slope).max())


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_a_magnetisation_is_turned_on_from_the_drawn_one(pattern):
    design = drawn().with_machine(magnetisation=pattern)
    mine = MachineField(design, COARSE)
    there, moved = (mine.no_load(replace(design, radial_share=share))[:, 1:] for share in (0.0, 1e-5))
    assert np.abs(moved - there).max() < 1e-5 * np.abs(there).max()


def test_radial_magnets_turned_back_are_parallel_ones():
    parallel, radial = (drawn().with_machine(magnetisation=PATTERNS[name]) for name in ("parallel", "radial"))
    mine = MachineField(radial, COARSE)
    there, back = mine.no_load(parallel), mine.no_load(replace(radial, radial_share=-1.0))
    assert_allclose(back, there, atol=1e-6 * np.abs(there).max())
    assert np.abs(mine.no_load(radial) - there).max() > 1e-2 * np.abs(there).max()


def test_positive_current_makes_outward_flux_in_its_own_coils():
    """Coil 0 belongs to +A, coil 1 to -A."""
    loaded = field().loaded(drawn(), [LoadedState(0.3, (20.0, 0.0, 0.0)), LoadedState(0.3, (0.0, 0.0, 0.0))])
    change = (loaded[0] - loaded[1])[1:]
    assert change[0] > 0 > change[1]


def test_samples_of_the_drawing_are_solved_once_until_they_are_forgotten():
    mine = MachineField(drawn(), COARSE)
    first = mine.no_load(drawn())
    assert mine.no_load(drawn()) is first
    mine.forget()
    again = mine.no_load(drawn())
    assert again is not first and (again == first).all()


def test_only_the_mesh_that_is_solved_on_keeps_its_memory():
    fields = Fields(Machinery(drawn(), PLAN))
    fields.loaded.model(drawn(), whole=False)
    assert fields.only(fields.idle) is fields.idle and fields.loaded._meshes == {}


def test_of_machines_with_meshes_of_their_own_the_last_one_is_kept():
    """Beside the one whose magnets touch, which all others share."""
    mine = MachineField(drawn(), COARSE)
    for arc in (1.0, 0.9, 0.8):
        mine.model(drawn().with_machine(magnet_arc_fraction=arc), whole=False)
    assert [machine.magnet_arc_fraction for machine, _ in mine._meshes] == [1.0, 0.8]
