"""The page of a lumped model from sines: shunt in star, or behind a diode bridge."""

from __future__ import annotations

import numpy as np

from bench.analysis import Analysis, Records, Settings
from bench.impedance import sine_impedance
from bench.lumped_fit import fit_lumped
from bench.report import pictures
from bench.report.identified import identification_remarks, identified_table, weakest_words
from electrical.shunted_machine import Bridge, Circuit, Star
from electrical.synchronous_machine import SynchronousMachine
from figures.report import Picture, Remark, Section, Table
from vehicle.impedance import LumpedActuator


def lumped(records: Records, settings: Settings) -> Analysis:
    """Mass, friction and mount from sines, the shunt in star."""
    return _lumped(records, settings, Star(settings.get("rectifier", 0.0)))


def lumped_bridge(records: Records, settings: Settings) -> Analysis:
    """Mass, friction and mount from sines, the shunt behind a diode bridge."""
    return _lumped(records, settings, Bridge(settings.get("diode_drop", 0.0), settings.get("diode", 0.0)))


def _lumped(records: Records, settings: Settings, circuit: Circuit) -> Analysis:
    points = [sine_impedance(record) for record in records]
    device, found = fit_lumped(_stated_actuator(settings, circuit), points)
    table, remarks = identified_table(found), identification_remarks(found)
    section = Section(
        "Lumped model",
        (
            "Mass, friction and mount of thesis eq. B.4, fitted to the sizes of all points; the machine is as "
            "stated. Its electrical pole acts on the electrical speed as well as on the frequency, so the stroke of "
            "every point counts.",
            weakest_words(found),
            *map(Remark, remarks),
            Table(table, "Values with their 90 % intervals (thesis table B.1)."),
            Picture(pictures.lumped_model(points, device), "Measured (marks) and lumped model (lines)."),
        ),
    )
    rms = float(np.std(found.residuals[0]))
    numbers = {"parameters": table.to_dict("records"), "log_rms": rms, "natural_frequency_Hz": device.natural_frequency}
    return Analysis("Lumped model of the impedance", (section,), table, numbers, remarks=remarks)


# Where the search begins: thesis table B.1.
_STARTS = {"equivalent_mass": 5.6, "viscous_friction": 250.0, "mount_stiffness": 2e5, "mount_damping": 50.0}


def _stated_actuator(settings: Settings, circuit: Circuit) -> LumpedActuator:
    """Machine and ratio as stated, mass, friction and mount where the search begins."""
    pole_pairs = int(settings.needed("pole_pairs", "pole_pairs=5"))
    psi_m = settings.needed("torque_constant", "torque_constant_mNm_per_A=49.3") / (1.5 * pole_pairs)
    inductance = settings.needed("phase_inductance", "phase_inductance_uH=349")
    resistance = settings.needed("phase_resistance", "phase_resistance_mohm=68.3")
    machine = SynchronousMachine(pole_pairs, psi_m, inductance, inductance, resistance)
    ratio = settings.needed("transmission", "transmission_mm_per_rad=1.317")
    starts = {name: settings.get(name, value) for name, value in _STARTS.items()}
    return LumpedActuator(machine, circuit, ratio, **starts)
