"""A flux map without a field solution: a saturating machine in closed form, with a ripple over the angle."""

from dataclasses import dataclass
from math import pi

import numpy as np
import xarray as xr

from drivetrain.requirements import Requirements, Transmission, shaft_demand
from electrical.final_length import ContinuousNeed
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_connection import Star
from electrical.winding_selection import WindingLimits
from electrical.winding_stage import WindingInputs
from geometry.family import MatchedMachine
from geometry.machine import hanselman_machine
from magnetostatics.flux_map_stage import FluxMap
from materials.insulation import insulation_class
from tests.electrical.wires import HALF_MILLIMETRE
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, RPM, SQUARE_MILLIMETRE

POLE_PAIRS = 5
AREA = 98.2 * SQUARE_MILLIMETRE
OVERLOAD = 20 * AMPERE_PER_SQUARE_MILLIMETRE
AMPERE_TURNS = 2**0.5 * OVERLOAD * 0.3 * 1.04 * AREA  # of the fullest coil side
ERROR = 2e-3  # share of the torque
RIPPLE = 5.0  # Nm/m, largest less smallest torque at the largest current on the q axis

LINEAR = SynchronousMachine(POLE_PAIRS, 0.0205, 4.2e-5, 4.2e-5, 0.0)  # of one turn and one metre


class Saturating:
    """psi = grad of L |i|^2/2 + Psi I_k sqrt(1 + ((i_d + I_m)^2 + i_q^2)/I_k^2): convex and reciprocal."""

    leakage, swing, knee, magnet = 1.0e-5, 2.2e-2, 700.0, 900.0

    def flux_linkage(self, i_d, i_q):
        root = np.sqrt(1 + ((i_d + self.magnet) ** 2 + i_q**2) / self.knee**2)
        return (self.leakage * i_d + self.swing * (i_d + self.magnet) / self.knee / root,
                self.leakage * i_q + self.swing * i_q / self.knee / root)  # fmt: skip


def flux_map(machine=LINEAR, angles=6, points=15) -> FluxMap:
    """The artefact of a machine of one turn and one metre, torque rippling with the q-axis current."""
    reach = 1.05 * AMPERE_TURNS
    i_d, i_q = np.linspace(-reach, reach / 4, points), np.linspace(-reach, reach, 2 * points - 1)
    d, q = np.meshgrid(i_d, i_q, indexing="ij")
    psi_d, psi_q = machine.flux_linkage(d, q)
    wave = np.cos(2 * pi * np.arange(angles) / angles)[:, None, None]
    torque = 1.5 * POLE_PAIRS * (psi_d * q - psi_q * d) + RIPPLE / 2 * q / AMPERE_TURNS * wave
    tables = {"psi_d": psi_d + 1e-4 * wave, "psi_q": psi_q + 1e-4 * wave, "torque": torque}
    tables["iterations"] = 4 + 0 * torque
    data = xr.Dataset(
        {name: (("angle", "id", "iq"), table) for name, table in tables.items()},
        {"angle": np.arange(angles) * pi / 3 / POLE_PAIRS / angles, "id": i_d, "iq": i_q},
        {"pole_pairs": POLE_PAIRS},
    )
    return FluxMap(data, POLE_PAIRS, 4, 1, AREA, AMPERE_TURNS, ERROR)


MATCHED = MatchedMachine(
    hanselman_machine(
        slots=12, pole_pairs=POLE_PAIRS, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0,
        stator_outer_radius=42.5 * MILLIMETRE, rotor_outer_radius=15.7 * MILLIMETRE,
        back_iron_width=3.3 * MILLIMETRE, magnet_length=2.5 * MILLIMETRE, airgap=0.5 * MILLIMETRE,
        slot_opening=2.0 * MILLIMETRE, shaft_radius=5.0 * MILLIMETRE,
    )
)  # fmt: skip
REQUIRED = Requirements(
    maximum_damping=40e3, force_rms=300.0, velocity_rms=0.1, power_rms=37.4, velocity_peak=3.4, force_peak=2614.0,
    velocity_at_force_peak=1.6, power_peak=4253.0, force_at_power_peak=1343.0, velocity_at_power_peak=3.2,
)  # fmt: skip
TRANSMISSION = Transmission(nominal=2.3 * MILLIMETRE, largest=2.4 * MILLIMETRE)
DEMAND = shaft_demand(REQUIRED, TRANSMISSION)


@dataclass(frozen=True)
class AnyLength(ContinuousNeed):
    """A length for good [m] that the copper does not change."""

    needed: float = 1 * MILLIMETRE
    name = "the continuous torque of a test"

    def length(self, design):
        return self.needed


GOOD = AnyLength()
INPUTS = WindingInputs(
    wires=(HALF_MILLIMETRE,),
    paths=(1,),
    closings=(Star(),),
    limits=WindingLimits(
        packing_limit=0.3, packing_tolerance=0.04, overload_current_density=OVERLOAD, dc_voltage=48.0,
        maximum_speed=15000 * RPM, insulated_fill=0.55, circulating_share=0.05, phase_current_rms=90.0,
    ),
    insulation=insulation_class("F"),
    nominal_density=6 * AMPERE_PER_SQUARE_MILLIMETRE,
    longest=70 * MILLIMETRE,
    damping_asked=False,
)  # fmt: skip
