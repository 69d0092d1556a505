"""Mount, drive and force loop of the actuator, in SI; what a study does not state has the values of the prototype."""

from __future__ import annotations

from actuator.parts import CompliantMount
from control.force_loop import ForceLoop
from study.schema import Study
from vehicle.designed import ActuatorInputs


def actuator_inputs(study: Study) -> ActuatorInputs:
    """Mount, torque lag and force loop."""
    section = study.actuator.si
    return ActuatorInputs(
        mount=CompliantMount(
            section.mount_stiffness,
            section.mount_damping,
            section.mount_play,
            section.mount_contact_damping,
            section.mount_transition,
        ),
        torque_lag=section.torque_lag,
        loop=ForceLoop(section.loop_proportional, section.loop_integral, section.loop_derivative, section.loop_filter),
    )
