"""The expansion against field solutions of the changed machine on the same meshes."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.workbench.models.machine_case import COARSE, STATES, builder, drawn, surrogate
from units import DEGREE
from workbench.errors import WorkbenchError
from workbench.models.machine.coordinates import smooth_coordinates
from workbench.models.machine.expansion import loaded_slopes
from workbench.models.machine.field import LoadedState, MachineField
from workbench.models.machine.spectra import averaged, coefficients, evaluated, slope
from workbench.models.machine.terms import hermite, through

ANGLES = np.linspace(0.0, 2 * np.pi, 101)


def test_functions_over_the_revolution():
    """Values, slopes and means of a sum of known orders."""
    angle = 2 * np.pi * np.arange(240) / 240
    spectrum = coefficients(np.stack([0.3 + np.sin(5 * angle) + 0.2 * np.cos(60 * angle - 1)], axis=1), 100)
    at = np.array([0.01, 1.234, 6.2])
    expected = 0.3 + np.sin(5 * at) + 0.2 * np.cos(60 * at - 1)
    assert_allclose(evaluated(spectrum, at)[0], expected, atol=1e-5)
    assert_allclose(evaluated(slope(spectrum), at)[0], 5 * np.cos(5 * at) - 12 * np.sin(60 * at - 1), atol=1e-3)
    width = 2 * np.pi / 60  # a whole period of the sixtieth order
    mean = 0.3 + np.sin(5 * at) * np.sin(2.5 * width) / (2.5 * width)
    assert_allclose(evaluated(averaged(spectrum, width), at)[0], mean, atol=1e-5)


CHANGES = {
    "remanence": drawn().with_magnet(remanence=1.3 * 0.96),
    "recoil permeability": drawn().with_magnet(recoil_permeability=1.05),
    "air gap": drawn().with_machine(airgap=0.54e-3),
    "slot opening": drawn().with_machine(slot_opening=2.2e-3),
    "magnet arc": drawn().with_machine(magnet_arc_fraction=0.93),
    "magnet arc, hardly": drawn().with_machine(magnet_arc_fraction=0.985),
    "saturation": replace(drawn(), saturation_scale=0.97),
    "grade": replace(drawn(), field_scale=1.4),
    "stacking": replace(drawn(), stacking_factor=0.93),
    "cut edges": replace(drawn(), edge_damage=0.3),
    "pattern": replace(drawn(), radial_share=0.2),
    "weak magnet": drawn().with_one("magnet_strengths", 4, 0.9),
    "magnet position": drawn().with_one("magnet_turns", 7, 0.008),
    "wide slot": drawn().with_one("opening_changes", 9, 0.2e-3),
    "static eccentricity": replace(drawn(), stator_shift=(0.05e-3, -0.07e-3)),
    "dynamic eccentricity": replace(drawn(), rotor_shift=(0.05e-3, -0.07e-3)),
}


TOGETHER = {
    "magnets and steel": replace(
        drawn().with_magnet(remanence=1.3 * 0.95), saturation_scale=0.96, stacking_factor=0.97
    ),
    "four at once": replace(
        drawn().with_magnet(remanence=1.3 * 0.98).with_machine(airgap=0.53e-3, slot_opening=2.15e-3), edge_damage=0.3
    ),
    "gap and a weak magnet": drawn().with_machine(airgap=0.53e-3).with_one("magnet_strengths", 4, 0.8),
}
EVERY = CHANGES | TOGETHER
WORST = {"magnet arc, hardly": 0.15, "cut edges": 0.05}


@pytest.mark.parametrize("name", EVERY)
def test_without_current(name):
    """Change of torque and of flux linkage to 1.5 % of itself at the worst angle; cut edges change cogging by nothing
    that a coarse mesh could tell."""
    design = EVERY[name]
    nominal = surrogate().spectrum(drawn())
    exact = builder().about(surrogate(), design).spectrum(design) - nominal
    found = surrogate().spectrum(design) - nominal
    for rows in (slice(0, 1), slice(1, 4)):
        wanted = evaluated(exact[rows], ANGLES)
        error = np.abs(evaluated(found[rows], ANGLES) - wanted).max() / np.abs(wanted).max()
        assert error < WORST.get(name, 0.015)


WITH_CURRENT = [name for name in EVERY if "eccentricity" not in name]


@pytest.mark.parametrize("name", WITH_CURRENT)
def test_with_current(name):
    """To 4 % of itself; of one magnet or slot, whose curve is that without current, to a quarter."""
    design, state = EVERY[name], STATES[0]
    at = np.array([state.angle]), np.array([state.currents])
    nominal = surrogate().with_current(drawn(), *at)[0]
    exact = builder().about(surrogate(), design).with_current(design, *at)[0] - nominal
    found = surrogate().with_current(design, *at)[0] - nominal
    share = 0.25 if name in ("weak magnet", "magnet position", "wide slot", "gap and a weak magnet") else 0.04
    for part in (slice(0, 1), slice(1, 4)):
        error = np.abs(found[part] - exact[part]).max() / np.abs(exact[part]).max()
        assert error < WORST.get(name, share)


def test_what_is_kept_of_other_designs_and_places_does_not_show():
    """One after the other, and each asked of a surrogate that has kept nothing."""
    state, kept = STATES[0], surrogate()
    turns = (drawn().turns[0] - 1.0, *drawn().turns[1:])
    designs = replace(drawn(), turns=turns), replace(drawn(), skew=0.05), EVERY["magnets and steel"]
    currents = np.array([state.currents])
    for design in designs:
        for angle in (np.array([state.angle]), np.array([state.angle + 0.01])):
            for at in ((angle, currents), (angle, 1.01 * currents)):
                found = kept.with_current(design, *at)
                assert np.array_equal(found, replace(kept).with_current(design, *at))
                assert not np.array_equal(found, kept.with_current(drawn(), *at))


def test_steel_that_carries_more_flux_between_stronger_magnets_makes_the_same_field():
    """B_r and the saturation times s: psi times s, torque times s^2, where currents are none."""
    design = replace(drawn().with_magnet(remanence=1.3 * 0.95), saturation_scale=0.95)
    exact = builder().solver.fields.idle.no_load(design)
    drawing = builder().solver.fields.idle.no_load(drawn())
    assert_allclose(exact[:, 0], 0.95**2 * drawing[:, 0], atol=1e-4 * np.abs(drawing[:, 0]).max())
    assert_allclose(exact[:, 1:], 0.95 * drawing[:, 1:], atol=1e-5 * np.abs(drawing[:, 1:]).max())
    found, nominal = (surrogate().spectrum(d) for d in (design, drawn()))
    assert_allclose(found[1:, 5], 0.95 * nominal[1:, 5], rtol=1e-5)


def test_cubics_between_nodes():
    """A cubic comes back from values and slopes at any nodes, a parabola from its values alone; both go on beyond."""
    nodes = np.array([-2.0, -0.5, 0.0, 1.5])
    for x in (-2.5, -1.0, -0.1, 0.4, 1.5, 2.0):
        values, slopes = hermite(tuple(nodes), x)
        assert_allclose(values @ (nodes**3 - nodes) + slopes @ (3 * nodes**2 - 1), x**3 - x, atol=1e-12)
        assert_allclose(through(tuple(nodes), x) @ (2 * nodes**2 - nodes + 1), 2 * x**2 - x + 1, atol=1e-12)
    assert_allclose(hermite((0.0,), 0.7), ([1.0], [0.7]))


@pytest.mark.parametrize("turn", [0.5 * DEGREE, 1.2 * DEGREE])
def test_turns_current_and_angle_beside_a_solved_state(turn):
    """Turned on, 3 % more current, one phase 2 A off and half a turn missing, against its own field solution."""
    fields = builder().solver.fields.loaded
    design = drawn().without_turns(0, 0.5)
    angle, currents = STATES[0].angle + turn, (41.2, -20.6, -18.6)
    state = replace(STATES[0], angle=angle, currents=currents)
    sample = fields.loaded(design, [state])[0]
    phases = [
        sum(c.sign * design.turns[k] * sample[1 + k] for k, c in enumerate(fields.layout.coils) if c.phase == i)
        for i in range(3)
    ]
    found = surrogate().with_current(design, np.array([angle]), np.array([currents]))[0]
    assert_allclose(found[0], sample[0], rtol=5e-3)
    assert_allclose(found[1:], phases, atol=3e-3 * np.abs(phases).max())


SHIFTED = replace(drawn(), rotor_shift=(0.05e-3, -0.07e-3))


def test_what_a_shifted_rotor_does_to_single_coils_shows_where_one_lacks_turns():
    """Order 6 of the phase of ten poles, against field solutions; nothing where all coils have their turns."""
    lacking = SHIFTED.without_turns(0, 1.0)
    exact = builder().about(surrogate(), lacking).spectrum(lacking)[1, 6]
    assert abs(surrogate().spectrum(SHIFTED)[1, 6]) < 1e-6 * abs(exact)
    assert_allclose(surrogate().spectrum(lacking)[1, 6], exact, rtol=0.02)


def test_about_a_design_and_beyond_the_states_it_is_the_field_there():
    """The rotor off its axis and turned by 0.6 degrees, against the field on the same mesh."""
    turn, state = 0.6 * DEGREE, STATES[0]
    wanted = builder().solver.fields.loaded.loaded(SHIFTED, [state], turn)[0, 0]
    at = np.array([state.angle + turn]), np.array([state.currents])
    turned, not_turned = (
        builder().about(surrogate(), SHIFTED, there).with_current(SHIFTED, *at)[0, 0] for there in (turn, 0.0)
    )
    assert_allclose(turned, wanted, rtol=1e-6)
    assert abs(not_turned - wanted) > 2e-4 * abs(wanted), "the derivatives at the drawing know no shift"


def test_far_from_every_solved_state_is_refused():
    with pytest.raises(WorkbenchError, match="far from every solved state"):
        surrogate().with_current(drawn(), np.array([0.5]), np.array([[40.0, -20.0, -20.0]]))


def test_steel_beyond_its_table_is_followed_with_current():
    """Where teeth are saturated beyond 1.8 T, the end of this grade's table; less than no rise is none."""
    nominal = replace(drawn(), steel="M270-35A")
    fields = MachineField(nominal, COARSE)
    states = [LoadedState(state.angle, (400.0, -200.0, -200.0)) for state in STATES[:2]]
    rise = next(c for c in smooth_coordinates(nominal) if c.path == ("rise_beyond_table",))
    slope = loaded_slopes(fields, states, [rise])[rise.name]
    up, down = (fields.loaded(rise.changed(nominal, change), states) for change in (0.02, -0.02))
    assert np.abs(slope).max() > 0
    assert_allclose((up - down) / 0.04, slope, atol=2e-3 * np.abs(slope).max())
    assert_allclose(*(fields.loaded(replace(nominal, rise_beyond_table=share), states) for share in (0.0, -1.0)))
