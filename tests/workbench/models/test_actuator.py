"""The actuator bench against the machine in dq behind the same ratio, and against balances of power."""

from dataclasses import replace

import numpy as np
import pytest

from actuator.imposed import imposed_motion
from effects.dq_design import DqMachine
from effects.electrical.weak_magnets import WeakMagnets
from effects.library import package_effects
from effects.mechanical.coulomb_friction import CoulombFriction
from workbench.data.table import Tolerance
from workbench.errors import WorkbenchError
from workbench.models.actuator.design import read, written
from workbench.models.actuator.model import BASE
from workbench.models.bases import base_models
from workbench.models.dq.model import BASE as DQ
from workbench.models.model import Model

DEVICE = {
    "output": "wheel",
    "pole_pairs": 5,
    "psi_m_mVs": 16.0,
    "inductance_uH": 300.0,
    "phase_resistance_mohm": 120.0,
    "transmission_ratio_mm_per_rad": 2.5,
    "equivalent_mass_kg": 6.0,
}
TAU = 2.5e-3
MACHINE = DqMachine(5, 0.016, 300e-6, 300e-6, 0.12)


def actuator(**more):
    return BASE.design(DEVICE | more)


def test_it_is_found_by_its_device():
    assert base_models()["actuator"] is BASE and BASE.accepts(DEVICE)
    assert not DQ.accepts(DEVICE) and not BASE.accepts({"force_constant": 60.0})


def test_in_short_circuit_it_brakes_as_the_machine_does():
    velocity = np.linspace(0.02, 2.0, 20)
    force = BASE.respond(actuator(), "damping_velocity", {"velocity": velocity, "shunt": np.zeros(20)})["force"]
    torque = DQ.respond(MACHINE, "short_circuit", {"speed": velocity / TAU})["torque"]
    assert force == pytest.approx(torque / TAU, rel=1e-9)
    assert np.argmax(force) < 19, "beyond w L = R it falls again"


def test_voltage_force_and_resistance_are_those_of_the_machine():
    velocity, current = np.array([0.5, 1.0]), np.array([5.0, 10.0])
    line = BASE.respond(actuator(), "back_emf", {"velocity": velocity})["v_ll"]
    assert line == pytest.approx(DQ.respond(MACHINE, "back_emf", {"speed": velocity / TAU})["v_ll"])
    held = BASE.respond(actuator(), "locked_force", {"current": current})["force"]
    assert held == pytest.approx(1.5 * 5 * 0.016 * current / TAU)
    warm = BASE.respond(actuator(), "phase_resistance", {"winding_T": np.array([20.0, 120.0])})["resistance"]
    assert warm == pytest.approx([0.12, 0.12 * 1.393])


def test_the_meshes_and_the_friction_take_their_part_on_either_way():
    design = actuator(
        efficiency_driven=0.9, efficiency_driving=0.8, coulomb_friction_N=7.0, viscous_friction_Ns_per_m=50.0
    )
    current = np.array([10.0, 10.0, -10.0])
    made = 1.5 * 5 * 0.016 * 10.0 / TAU
    asked = {"current": current, "direction": np.array([1.0, -1.0, 1.0])}
    expected = [0.8 * (made - 7.0), (made + 7.0) / 0.9, -0.8 * (made - 7.0)]
    assert BASE.respond(design, "locked_force", asked)["force"] == pytest.approx(expected)
    drag = BASE.respond(design, "drag", {"velocity": np.array([1.0, -1.0])})["force"]
    assert drag == pytest.approx([57.0 / 0.9, -57.0 / 0.9])
    slow = {"velocity": np.array([0.01]), "shunt": np.zeros(1)}
    braking = 0.9 * BASE.respond(design, "damping_velocity", slow)["force"][0] - 50.0 * 0.01 - 7.0
    assert braking == pytest.approx(1.5 * (5 * 0.016 / TAU) ** 2 * 0.01 / 0.12, rel=5e-3)


ROUGH = {"efficiency_driven": 0.9, "efficiency_driving": 0.8, "coulomb_friction_N": 7.0,
         "viscous_friction_Ns_per_m": 50.0}  # fmt: skip


@pytest.mark.physics
def test_the_bench_reads_what_the_simulation_of_the_same_description_gives():
    """Drag and braking moved at constant velocity, the output held while the current creeps either way, by the step
    that simulation and exported unit take."""
    design = actuator(**ROUGH)
    described, time = design.drawn.actuator, np.linspace(0.0, 0.2, 400)
    for velocity, torque in ((0.4, 0.0), (-0.4, 0.0), (0.05, 0.9), (0.05, -0.9), (-0.05, -0.9)):
        moving = np.full(time.size, velocity)
        run = imposed_motion(described, time, velocity * time, moving, np.full(time.size, torque))
        if torque == 0:
            read = BASE.respond(design, "drag", {"velocity": np.array([velocity])})["force"][0]
        else:
            current = np.array([torque / (1.5 * 5 * 0.016)])
            ahead = {"current": current, "direction": np.array([-np.sign(torque * velocity)])}
            quiet = replace(design, viscous_damping=0.0)  # at a creep the viscous part is none
            read = BASE.respond(quiet, "locked_force", ahead)["force"][0]
            through = 1 / 0.9 if torque * velocity > 0 else 0.8
            read += through * 50.0 * velocity
        assert run.force[-1] == pytest.approx(read, rel=1e-6)


@pytest.mark.physics
def test_a_slow_loop_is_that_of_the_simulation():
    """Without a machine that is shunted: inertia, friction and meshes of the one description over a period."""
    design = actuator(coulomb_friction_N=7.0, viscous_friction_Ns_per_m=50.0)
    phase = np.linspace(0.0, 2 * np.pi, 401)
    rows = {name: np.full(401, value) for name, value in (("frequency", 2.0), ("amplitude", 0.02), ("shunt", 1e6))}
    force = BASE.respond(design, "force_loop", rows | {"phase": phase})["force"]
    stroke, velocity = 0.02 * np.sin(phase), 0.02 * 4 * np.pi * np.cos(phase)
    run = imposed_motion(design.drawn.actuator, phase / (4 * np.pi), stroke, velocity, 0 * phase)
    moving = np.abs(velocity) > 0.01  # beyond the breakaway of the dry friction
    assert run.force[moving] == pytest.approx(force[moving], abs=0.01 * np.abs(force).max())


def test_the_description_is_written_as_it_is_read():
    design = actuator(**ROUGH, saturation=1e-4, reference_T_degC=25.0)
    again = read(written(design.drawn))
    assert again == design.drawn and again.actuator.gears.driven == 0.9


def test_a_slow_loop_is_friction_braking_and_inertia():
    design = actuator(coulomb_friction_N=7.0)
    phase = np.linspace(0.0, 2 * np.pi, 9)
    rows = {name: np.full(9, value) for name, value in (("frequency", 1.0), ("amplitude", 0.02), ("shunt", 0.1))}
    force = BASE.respond(design, "force_loop", rows | {"phase": phase})["force"]
    assert force[2] == pytest.approx(-6.0 * 0.02 * (2 * np.pi) ** 2, abs=1e-6), "at the end of the stroke"
    velocity = {"velocity": np.array([0.02 * 2 * np.pi]), "shunt": np.array([0.1])}
    assert force[0] == pytest.approx(BASE.respond(design, "damping_velocity", velocity)["force"][0])
    with pytest.raises(WorkbenchError, match="a tenth"):
        BASE.respond(design, "force_loop", rows | {"phase": phase, "frequency": np.full(9, 50.0)})


def test_on_a_shaft_it_speaks_of_speed_and_torque():
    shaft = {key: value for key, value in DEVICE.items() if not key.startswith(("transmission", "equivalent"))}
    design = BASE.design(shaft | {"output": "shaft", "transmission_ratio": 0.025, "equivalent_mass_kg_m2": 0.1})
    assert set(BASE.respond(design, "drag", {"speed": np.array([1.0])})) == {"torque"}
    held = BASE.respond(design, "locked_force", {"current": np.array([2.0])})["torque"]
    assert held == pytest.approx(1.5 * 5 * 0.016 * 2.0 * 40)


def test_effects_of_a_damper_act_and_tolerances_move_what_is_drawn():
    model = Model(BASE, actuator()) + WeakMagnets(0.1) + CoulombFriction(level=5.0)
    assert model.design_as_built.force_constant == pytest.approx(0.9 * 1.5**0.5 * 5 * 0.016 / TAU)
    able = [name for name, cls in package_effects().items() if cls.can_act_on(actuator())]
    assert {"weak_magnets", "winding_temperature", "coulomb_friction", "force_gain"} <= set(able)
    moved = BASE.with_tolerance(actuator(), Tolerance("psi_m", 0.01, True, ""), 2.0)
    assert moved.force_constant == pytest.approx(1.02 * 1.5**0.5 * 5 * 0.016 / TAU)
    assert moved.drawn.machine.psi_m == pytest.approx(1.02 * 0.016)


@pytest.mark.parametrize(
    "change, said",
    [
        ({"output": "lever"}, "output must be"),
        ({"psi_m_mVs": -1.0}, "psi_m must be a? ?positive"),
        ({"pole_pairs": 4.5}, "pole_pairs must be a whole number"),
        ({"efficiency_driven": 1.1}, "the efficiency when driven must lie above 0 and not above 1, found 1.1"),
    ],
)
def test_a_wrong_device_is_said(change, said):
    with pytest.raises(WorkbenchError, match=said):
        actuator(**change)
