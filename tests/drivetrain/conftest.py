"""The thesis's match: 85 mm, 12 slots, w_bi 3.3 mm, R_ro 15.7 mm, 50 Nm/m at 6 A/mm^2 RMS, scaled linearly to 20."""

from types import SimpleNamespace

import pytest

from drivetrain.masses import SteelCylinder
from drivetrain.match import (
    CopperLoading,
    CostModel,
    CostScales,
    CostWeights,
    MatchLimits,
    SizedSection,
    linear_overload,
)
from drivetrain.planetary import STEEL_DENSITY, GearboxDesign
from drivetrain.requirements import Requirements
from electrical.resistance import COPPER_RESISTIVITY_20
from geometry.machine import Machine
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, SQUARE_MILLIMETRE


@pytest.fixture(scope="session")
def thesis():
    machine = Machine(
        slots=12, pole_pairs=5, stator_outer_radius=42.5 * MILLIMETRE, rotor_outer_radius=15.7 * MILLIMETRE,
        back_iron_width=3.3 * MILLIMETRE, tooth_width=5.5 * MILLIMETRE, magnet_length=2.5 * MILLIMETRE,
        airgap=0.5 * MILLIMETRE, slot_opening=2.0 * MILLIMETRE, shoe_d1=1.43 * MILLIMETRE, shoe_d2=1.43 * MILLIMETRE,
        shaft_radius=5.0 * MILLIMETRE,
    )  # fmt: skip
    section = SizedSection(
        machine=machine,
        coils_in_series=4,
        coil_pitch=1,
        coil_side_area=98.2 * SQUARE_MILLIMETRE,
        torque_per_length_nominal=50.0,
        torque_per_length_overload=linear_overload(50.0, 6.0, 20.0),
    )
    requirements = Requirements(
        maximum_damping=40e3, force_rms=300.0, velocity_rms=0.1, power_rms=37.4, velocity_peak=3.4, force_peak=2614.0,
        velocity_at_force_peak=1.6, power_peak=4253.0, force_at_power_peak=1343.0, velocity_at_power_peak=3.2,
    )  # fmt: skip
    scales = CostScales(mass=4.0, equivalent_mass=15.0, stator_radius=50 * MILLIMETRE)
    return SimpleNamespace(
        section=section,
        requirements=requirements,
        limits=MatchLimits(active_length=70 * MILLIMETRE, rotor_speed=2618.0),
        loading=CopperLoading(6 * AMPERE_PER_SQUARE_MILLIMETRE, 0.3, COPPER_RESISTIVITY_20),
        gearbox=GearboxDesign(stage_count=2, linkage_ratio=0.170, force_rms=300.0, velocity_rms=0.1),
        model=CostModel(SteelCylinder(STEEL_DENSITY), scales, CostWeights(inertia=0.5, stator_radius=0.2)),
    )
