"""Mount, drive and force loop of the actuator, in SI; what a study does not state has the values of the prototype."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any, TypeVar

from study.schema import Study
from vehicle.designed import PROTOTYPE_LAG, PROTOTYPE_LOOP, PROTOTYPE_MOUNT, ActuatorInputs

Part = TypeVar("Part", bound=Any)


def actuator_inputs(study: Study) -> ActuatorInputs:
    """Mount, torque lag and force loop."""
    section = study.actuator.si
    return ActuatorInputs(
        mount=_stated(PROTOTYPE_MOUNT, section, "mount"),
        torque_lag=PROTOTYPE_LAG if section.torque_lag is None else section.torque_lag,
        loop=_stated(PROTOTYPE_LOOP, section, "loop"),
    )


def _stated(part: Part, section: Any, prefix: str) -> Part:
    """The part with what the section states of it, ``<prefix>_<field>``."""
    values = {field.name: getattr(section, f"{prefix}_{field.name}") for field in fields(part)}
    return replace(part, **{name: value for name, value in values.items() if value is not None})
