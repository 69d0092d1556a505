"""A machine whose flux linkages are straight lines, wound, with its closed forms beside it."""

from dataclasses import replace
from math import sqrt

import numpy as np
import xarray as xr

from drivetrain.capability import ActuatorDesign
from electrical.flux_map_machine import FluxMapMachine
from electrical.resistance import phase_resistance
from electrical.synchronous_machine import SynchronousMachine

PSI, L_D, L_Q, POLES = 5e-3, 4e-6, 4e-6, 5  # per turn and metre: Wb, H, H; without saliency
TURNS, STRANDS, AREA, LENGTH, END, RHO = 8, 20, 0.2e-6, 0.04, 0.016, 1.7e-8
AMPERES = sqrt(2) * 20e6 * AREA * STRANDS  # peak, at the overload


def flux_map(reach=1500.0):
    """Per turn and metre over one angle."""
    i = np.linspace(-reach, reach, 9)
    d, q = np.meshgrid(i, i, indexing="ij")
    psi_d, psi_q = PSI + L_D * d, L_Q * q
    torque = 1.5 * POLES * (psi_d * q - psi_q * d)
    tables = {"psi_d": (("id", "iq"), psi_d), "psi_q": (("id", "iq"), psi_q), "torque": (("id", "iq"), torque)}
    return xr.Dataset(tables, {"id": i, "iq": i}, {"pole_pairs": POLES}).expand_dims(angle=[0.0])


def per_turn():
    """One turn, one metre, no resistance."""
    return FluxMapMachine.from_per_turn(flux_map(), turns=1, active_length=1.0, resistance=0.0)


def closed_form(turns=TURNS, strands=STRANDS, length=LENGTH, end=END):
    """The same machine, wound, with constant parameters."""
    scale = turns * length
    resistance = phase_resistance(
        turns=turns, strands=strands, wire_area=AREA, active_length=length, end_turn_length=end, coils_in_series=4,
        resistivity=RHO,
    )  # fmt: skip
    return SynchronousMachine(POLES, scale * PSI, turns * scale * L_D, turns * scale * L_Q, resistance)


def on_map():
    """The same machine as a map."""
    found = FluxMapMachine.from_per_turn(flux_map(), turns=TURNS, active_length=LENGTH, resistance=0.0)
    return replace(found, resistance=closed_form().resistance)


def actuator():
    """The same machine behind a transmission, on 48 V."""
    return ActuatorDesign(
        per_turn=per_turn(), peak_torque_per_length=1.5 * POLES * PSI * AMPERES * TURNS, turns=TURNS, strands=STRANDS,
        wire_area=AREA, resistivity=RHO, coils_in_series=4, active_length=LENGTH, end_turn_length=END,
        continuous_torque=1.5, rated_length=LENGTH, overload_density=20e6, dc_voltage=48.0, transmission_ratio=2e-3,
        rotor_inertia_per_length=8e-4, gearbox_inertia=2e-6,
    )  # fmt: skip
