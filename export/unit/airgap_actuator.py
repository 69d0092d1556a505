"""The actuator as a co-simulation slave of FMI 2: this file goes into the exported unit, ``actuator/`` beside it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real
from pythonfmu.enums import Fmi2Status

from actuator.errors import ActuatorError
from actuator.step import Moment, SteppedActuator
from actuator.text import actuator_of

DESCRIPTION = "actuator.json"
INPUTS = {
    "velocity": ("m/s", "velocity of the suspension, rebound positive, held over a step"),
    "force_demand": ("N", "force asked of the motor at the wheel, positive against rebound, held over a step"),
}
OUTPUTS = {
    "force": ("N", "force on the suspension, positive against rebound"),
    "stroke": ("m", "stroke of the suspension, rebound positive"),
    "torque": ("N.m", "torque of the rotor"),
    "rotor_angle": ("rad", "angle of the rotor from static equilibrium"),
    "rotor_speed": ("rad/s", "speed of the rotor"),
    "current": ("A", "peak phase current, signed as the torque"),
    "electrical_power": ("W", "power to the battery, losses of machine and drive taken off"),
    "battery_current": ("A", "direct current to the battery"),
}


class AirgapActuator(Fmi2Slave):
    """Inputs are held over a step, as FMI 2 has it; a step before both inputs were set is refused."""

    author = "Airgap"
    description = "Electromechanical suspension actuator: mapped motor, gears, linkage, friction, mount with play"

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        device, self.terminals = actuator_of((Path(self.resources) / DESCRIPTION).read_text(encoding="utf-8"))
        self.stepped = SteppedActuator(device)
        self.initial_stroke = 0.0
        self.inputs: dict[str, float] = {}
        self.moment = self.stepped.at_rest()
        self._register()

    def _register(self) -> None:
        for name, (unit, words) in INPUTS.items():
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality.input,
                    description=f"{words} [{unit}]",
                    start=0.0,
                    getter=lambda name=name: self.inputs.get(name, 0.0),
                    setter=lambda value, name=name: self.inputs.update({name: value}),
                )
            )
        stroke = "stroke in which it rests at the beginning [m]"
        parameter, fixed = Fmi2Causality.parameter, Fmi2Variability.fixed
        self.register_variable(
            Real("initial_stroke", causality=parameter, variability=fixed, description=stroke, start=0.0)
        )
        for name, (unit, words) in OUTPUTS.items():
            self.register_variable(
                Real(
                    name,
                    causality=Fmi2Causality.output,
                    description=f"{words} [{unit}]",
                    getter=lambda name=name: seen(self, self.moment)[name],
                )
            )

    def exit_initialization_mode(self) -> None:
        """At rest in the initial stroke."""
        self.moment = self.stepped.at_rest(self.initial_stroke)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """One communication step; refused, with a sentence in the log, where an input is missing or not a number."""
        try:
            self._require_inputs()
            velocity, force = self.inputs["velocity"], self.inputs["force_demand"]
            self.moment = self.stepped.after(self.moment, velocity, force, step_size)
        except ActuatorError as wrong:
            sentence = f"at {current_time:g} s: {wrong}"
            self.log(sentence, Fmi2Status.error)  # many tools show the log only when they are asked to
            print(sentence, file=sys.stderr)
            raise
        return True

    def _require_inputs(self) -> None:
        missing = [f"{name} [{INPUTS[name][0]}]" for name in INPUTS if name not in self.inputs]
        if missing:
            raise ActuatorError(f"actuator: expected a value for {' and '.join(missing)}, found none; connect it")

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """The description of pythonfmu with what it leaves out: units, and the outputs as known from the beginning."""
        root = super().to_xml(model_options or {})
        units = {**INPUTS, **OUTPUTS, "initial_stroke": ("m", "")}
        definitions = Element("UnitDefinitions")
        for unit in sorted({unit for unit, _ in units.values()}):
            SubElement(definitions, "Unit", name=unit)
        root.insert(1, definitions)  # behind CoSimulation
        initial = SubElement(root.find("ModelStructure"), "InitialUnknowns")
        for index, variable in enumerate(root.find("ModelVariables"), start=1):
            variable.find("Real").set("unit", units[variable.get("name")][0])
            if variable.get("causality") == "output":
                SubElement(initial, "Unknown", index=str(index))
        return root


def seen(slave: AirgapActuator, moment: Moment) -> dict[str, float]:
    """The outputs at a moment, by name."""
    force, torque, speed = moment.answer
    power = torque * speed - float(slave.stepped.actuator.drive.loss.at(np.array(torque), np.array(speed)))
    return {
        "force": force,
        "stroke": moment.stroke,
        "torque": torque,
        "rotor_angle": slave.stepped.actuator.ratio.angle(moment.mass_stroke),
        "rotor_speed": speed,
        "current": float(slave.terminals.current_at(torque)),
        "electrical_power": power,
        "battery_current": power / slave.terminals.bus_voltage,
    }
