"""The simulated benches: the thesis's prototype on them, closed forms, what people read."""

import json
from dataclasses import replace

import numpy as np
import pytest

import bench.simulated as benches
from actuator.errors import ActuatorError
from actuator.imposed import imposed_motion
from actuator.model import IDEAL
from actuator.parts import GearEfficiency, MechanicalLoss
from actuator.terminals import Terminals
from bench.report import simulated as report
from bench.simulated import bench_stage, four_quadrants, lumped_actuator, static_force
from electrical.synchronous_machine import SynchronousMachine
from pipeline.codec import decoded, encoded
from tests.actuator.thesis import FORCE_LOOP, prototype
from vehicle.designed import BenchMachine, DesignedActuator

MACHINE = SynchronousMachine(5, 42.7e-3 / 7.5, 348.7e-6, 348.7e-6, 68.3e-3)
BENCH = BenchMachine(MACHINE, Terminals(48.0, (0.0, 2.3), (0.0, 54.0)))


@pytest.fixture(scope="module")
def found():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(benches, "FREQUENCIES", np.geomspace(2.0, 60.0, 6))
        patch.setattr(benches, "CHIRP", (5.0, 120.0, 12.0))
        patch.setattr(benches, "HIL_DURATION", 0.3)
        yield bench_stage(DesignedActuator(prototype(), FORCE_LOOP), BENCH)


@pytest.mark.reference
def test_the_prototype_on_its_benches(found):
    """Short circuit of H1 in lumped-stages G, B.6 with Table 4.2, eight parameters of a model without gears."""
    shorted = next(row for row in found.shunts if row.shunt == 0)
    assert shorted.damping == pytest.approx(10.36e3, rel=0.01)  # 10.32 with a friction of 70 Ns/m
    assert found.lumped.natural_frequency == pytest.approx(52.7, abs=0.1)
    assert {one.unknown.name: one.value / found.true[one.unknown.name] for one in found.identification.found} == (
        pytest.approx(dict.fromkeys(found.true, 1.0), abs=0.05)
    )
    resonance = float(found.active.frequency[int(np.argmax(found.active.force.values))])
    assert resonance == pytest.approx(52.0, abs=3.0)  # 51.8 Hz is the tangent at 12 A


@pytest.mark.physics
def test_force_at_constant_speed_is_that_of_the_simulation():
    """Driven until the mount has settled, in both quadrants of power, with gears and friction."""
    device = replace(prototype(), gears=GearEfficiency(0.9, 0.8), loss=MechanicalLoss(120.0, 30.0))
    time = np.arange(0.0, 0.5, 1e-3)
    for torque in (0.8, -0.8):
        run = imposed_motion(device, time, 0.3 * time, np.full(time.size, 0.3), np.full(time.size, torque))
        expected = static_force(device, np.array(0.3), np.array(torque))
        assert run.force[-1] == pytest.approx(float(expected), rel=1e-3)


@pytest.mark.physics
def test_maps_close_their_balance():
    """P_el = F v - mechanical loss - loss of the machine, with the gears lossless."""
    device = prototype()
    data = four_quadrants(device)
    speed = data.velocity / device.ratio.nominal
    friction = device.loss.viscous * data.velocity**2
    expected = data.force * data.velocity - friction - device.drive.loss.at(data.torque * 1.0, speed)
    assert np.nanmax(np.abs(data.electrical - expected)) < 1e-6 * float(np.nanmax(data.electrical))
    assert float(np.nanmax(data.efficiency)) < 1.0


@pytest.mark.physics
def test_controlled_impedance_is_that_of_the_lumped_model(found):
    """Without a command both are the open circuit; at the lowest frequency a command adds its damping."""
    open_circuit = found.impedance.shunted.isel(shunt=0)
    assert found.impedance.controlled.sel(damping=0.0)[0] == pytest.approx(float(open_circuit[0]), rel=0.1)
    added = found.impedance.controlled.sel(damping=4e3)[0] - found.impedance.controlled.sel(damping=0.0)[0]
    assert float(added) == pytest.approx(4e3, rel=0.1)


@pytest.mark.physics
def test_more_samples_a_period_change_no_impedance(monkeypatch):
    """A quarter of the step that the sines are simulated with."""
    usual = [benches._controlled(prototype(), 2e3, f) for f in (2.0, 20.0, 60.0)]
    monkeypatch.setattr(benches, "_PER_PERIOD", 4 * benches._PER_PERIOD)
    fine = [benches._controlled(prototype(), 2e3, f) for f in (2.0, 20.0, 60.0)]
    assert np.abs(np.array(usual) / fine - 1).max() < 1e-4


def test_the_loop_helps_and_what_is_kept_is_what_was_found(found):
    alone, cell = found.in_the_loop
    assert cell.numbers["force_error_rms_N"] < 0.6 * alone.numbers["force_error_rms_N"]
    datasets = []
    again = decoded(json.loads(json.dumps(encoded(found, datasets))), datasets)
    assert again.shunts[1:-1] == found.shunts[1:-1] and again.active.equals(found.active)


@pytest.mark.physics
def test_powers_in_the_loop_are_those_of_a_damper(found):
    """The mean power from the suspension is that of force and velocity; losses lie between it and the battery."""
    one = found.loops_in_time.sel(test="load cell")
    damped = float((one.wanted**2).mean()) / benches.HIL_DAMPING
    assert float(one.mechanical.mean()) == pytest.approx(damped, rel=0.2)
    assert float(one.electrical.mean()) < float(one.mechanical.mean())
    assert one.body.values == pytest.approx(one.stroke.values + one.wheel.values)
    assert np.allclose(one.current * 48.0, one.electrical)


def test_what_people_read(found):
    assert report.section(found).title == "On the benches of the thesis"
    assert len(report.parameter_table(found)) == 8 and len(report.shunt_table(found)) == 5
    assert sum(one.name.endswith(".png") for one in report.files(found)) == 7


def test_a_rigid_mount_is_refused():
    with pytest.raises(ActuatorError, match="expected an actuator behind a compliant mount"):
        lumped_actuator(IDEAL, MACHINE)
