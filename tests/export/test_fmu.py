"""The exported actuator: what it declares, what it answers, what it refuses; FMPy checks it in ``benchmarks``."""

import sys
import zipfile
from xml.etree import ElementTree

import numpy as np
import pytest

from actuator.errors import ActuatorError
from actuator.model import IDEAL
from actuator.step import SteppedActuator
from actuator.terminals import Terminals
from actuator.text import actuator_of, text_of
from export.fmu import write_fmu
from export.unit.airgap_actuator import DESCRIPTION, INPUTS, OUTPUTS, AirgapActuator
from tests.actuator.thesis import PEAK_TORQUE, RATIO, prototype

TERMINALS = Terminals(48.0, (0.0, PEAK_TORQUE), (0.0, PEAK_TORQUE / 42.7e-3))
STEP = 5e-4  # s


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    path = tmp_path_factory.mktemp("unit") / "actuator.fmu"
    before = list(sys.path)
    write_fmu(path, prototype(), TERMINALS)
    assert sys.path == before
    return path


@pytest.fixture
def slave(tmp_path):
    (tmp_path / DESCRIPTION).write_text(text_of(prototype(), TERMINALS), encoding="utf-8")
    return AirgapActuator(instance_name="test", resources=str(tmp_path))


def test_the_file_declares_its_variables_with_units_and_holds_what_it_runs(unit):
    with zipfile.ZipFile(unit) as found:
        names = set(found.namelist())
        description = ElementTree.fromstring(found.read("modelDescription.xml"))
    assert {"resources/actuator/step.py", "resources/actuator.json", "resources/airgap_actuator.py",
            "binaries/linux64/AirgapActuator.so", "binaries/win64/AirgapActuator.dll"} <= names  # fmt: skip
    assert not any("__pycache__" in name for name in names)
    units = {one.get("name"): one.find("Real").get("unit") for one in description.iter("ScalarVariable")}
    assert units == {name: unit for name, (unit, _) in {**INPUTS, **OUTPUTS}.items()} | {"initial_stroke": "m"}
    assert len(description.findall("ModelStructure/InitialUnknowns/Unknown")) == len(OUTPUTS)


def test_the_slave_answers_as_the_stepped_actuator_does_and_its_power_closes(slave):
    device = SteppedActuator(prototype())
    moment, references = device.at_rest(), {one.name: one.value_reference for one in slave.vars.values()}
    for k in range(200):
        velocity, force = 0.3 * np.sin(0.02 * k), 200 * np.sin(0.03 * k)
        slave.set_real([references["velocity"], references["force_demand"]], [velocity, force])
        assert slave.do_step(k * STEP, STEP)
        moment = device.after(moment, velocity, force, STEP)
        found = dict(zip(OUTPUTS, slave.get_real([references[name] for name in OUTPUTS])))
        assert (found["force"], found["torque"], found["rotor_speed"]) == tuple(moment.answer)
        lost = prototype().drive.loss.at(found["torque"], found["rotor_speed"])
        assert found["battery_current"] * 48.0 == pytest.approx(found["torque"] * found["rotor_speed"] - lost)
        assert found["current"] * 42.7e-3 == pytest.approx(found["torque"])
    assert found["stroke"] == pytest.approx(0.3 * STEP * np.sin(0.02 * np.arange(200)).sum())


def test_a_missing_input_is_one_sentence(slave, capsys):
    slave.set_real([0], [0.1])
    with pytest.raises(ActuatorError, match=r"expected a value for force_demand \[N\], found none; connect it"):
        slave.do_step(0.0, STEP)
    assert "force_demand [N]" in slave.log_queue[0].msg and "force_demand [N]" in capsys.readouterr().err


def test_an_actuator_comes_back_from_its_text():
    actuator, terminals = actuator_of(text_of(prototype(), TERMINALS))
    assert (actuator, terminals) == (prototype(), TERMINALS)
    assert terminals.torque_of(terminals.current_at(-1.3)) == pytest.approx(-1.3)
    assert actuator.ratio.nominal == RATIO


def test_what_nobody_can_command_is_not_exported():
    with pytest.raises(ActuatorError, match="found MappedMotor behind RigidMount"):
        text_of(IDEAL, TERMINALS)
    with pytest.raises(ActuatorError, match="currents that rise with the torque from 0"):
        Terminals(48.0, (0.0, 1.0), (0.0, -1.0))
    with pytest.raises(ActuatorError, match="'terminals' does not fit"):
        actuator_of(text_of(prototype(), TERMINALS).replace('"terminals"', '"ports"'))
