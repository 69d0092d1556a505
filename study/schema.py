"""What a study file holds: sections and keys, each with its meaning and its allowed range, in drawing units.

The unit of a key is the end of its name. Numbers that the physics needs have no default: a study states them.
Defaults exist only for numerical resolution and for keys that are marked optional.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr, ValidationInfo, field_validator, model_validator

from units import split_unit, to_si


@dataclass(frozen=True)
class Quantity:
    """Meaning and allowed range (both ends included) of a number, in the unit of its key."""

    meaning: str
    low: float
    high: float

    def allowed(self, key: str) -> str:
        """The range in words: ``0.05 to 20 mm``."""
        return f"{self.low:g} to {self.high:g} {split_unit(key)[1]}".rstrip()

    def holds(self, number: float) -> bool:
        """Whether the number lies in the range; NaN and the infinities do not."""
        return self.low <= number <= self.high


_LARGEST_NUMBER = 1e300  # integers of a file may be larger than any number that is calculated with
Listed = Field(strict=False)  # a TOML array arrives as a list and is kept as a tuple


class Section(BaseModel):
    """One table of the file: no unknown keys, no conversions of type, values never change."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    @classmethod
    def quantity(cls, key: str) -> Quantity | None:
        """Meaning and range of a key, None for a key that is not a number."""
        return next((note for note in cls.model_fields[key].metadata if isinstance(note, Quantity)), None)

    @property
    def si(self) -> SimpleNamespace:
        """Every key as its quantity in SI: ``machine.si.airgap`` is metres where the file says ``airgap_mm``."""
        return SimpleNamespace(**dict(to_si(key, getattr(self, key)) for key in type(self).model_fields))

    @field_validator("*", mode="after")
    @classmethod
    def _stays_in_its_range(cls, value: Any, info: ValidationInfo) -> Any:
        key = str(info.field_name)
        quantity = cls.quantity(key)
        if quantity is None or value is None:
            return value
        for number in value if isinstance(value, tuple) else (value,):
            if not quantity.holds(number):
                raise ValueError(_out_of_range(number, quantity, key))
        return value


def _out_of_range(number: float, quantity: Quantity, key: str) -> str:
    expected = f"give {quantity.allowed(key)} ({quantity.meaning})"
    if not abs(number) < _LARGEST_NUMBER:  # also NaN
        return f"is not a finite number; {expected}"
    hint = " and looks like a value in metres" if key.endswith("_mm") and quantity.holds(number * 1e3) else ""
    return f"is outside the allowed range{hint}; {expected}"


class StudySection(Section):
    """Name of the study; the results go to ``results/<id>/``."""

    id: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_-]*$")]
    title: Annotated[str, Field(min_length=1)]


def _in_pairs(poles: int) -> int:
    if poles % 2:
        raise ValueError("is odd, but magnets come in pairs; give an even number")
    return poles


class MachineSection(Section):
    """Cross-section (thesis Fig. 3.16, Table 3.10)."""

    slots: Annotated[int, Quantity("number of slots", 3, 360)]
    poles: Annotated[int, Quantity("number of magnets", 2, 360)]
    stator_outer_radius_mm: Annotated[float, Quantity("stator outer radius R_so", 5, 1000)]
    rotor_outer_radius_mm: Annotated[float, Quantity("rotor outer radius R_ro over the magnets", 2, 1000)]
    back_iron_width_mm: Annotated[float, Quantity("stator back-iron width w_bi", 0.3, 200)]
    magnet_length_mm: Annotated[float, Quantity("radial magnet length l_m", 0.3, 50)]
    airgap_mm: Annotated[float, Quantity("air gap between magnets and teeth", 0.05, 20)]
    slot_opening_mm: Annotated[float, Quantity("slot opening w_s", 0.1, 50)]
    shoe_depth_fraction: Annotated[float, Quantity("shoe depth over tooth width, alpha_sd", 0.05, 2)]
    shoe_aspect_ratio: Annotated[float, Quantity("shoe depths d_1 over d_2, alpha_d", 0.05, 20)]
    shaft_radius_mm: Annotated[float, Quantity("shaft radius", 0.3, 900)]
    magnet_arc_fraction: Annotated[float, Quantity("magnet arc over pole pitch", 0.1, 1)]
    stacking_factor: Annotated[float, Quantity("steel over stack length of the laminations, of their mass", 0.5, 1)]
    magnetisation: Literal["parallel", "radial", "halbach"]
    # optional: stated instead of derived from the back iron (eqs 3.53, 3.57, 3.58)
    tooth_width_mm: Annotated[float | None, Quantity("tooth width w_tb", 0.3, 200)] = None
    shoe_d1_mm: Annotated[float | None, Quantity("depth of the parallel-sided slot opening d_1", 0.05, 50)] = None
    shoe_d2_mm: Annotated[float | None, Quantity("depth of the shoe's taper d_2", 0.05, 50)] = None

    @field_validator("poles", mode="after")
    @classmethod
    def _poles_come_in_pairs(cls, poles: int) -> int:
        return _in_pairs(poles)


class MaterialsSection(Section):
    """Steel, magnet and copper.

    What is stated of the magnets holds for the field; what is not follows from their grade.
    """

    steel: Annotated[str, Field(min_length=1)]
    loss_grade: str | None = None  # whose iron-loss data stand in for the steel's: losses, optimise
    magnet_grade: Annotated[str | None, Field(min_length=1)] = None  # whose knee counts in demagnetisation: magnets
    magnet_temperature_degC: Annotated[
        float | None, Quantity("temperature of the magnets at which their grade gives the remanence", -60, 350)
    ] = None
    remanence_T: Annotated[float | None, Quantity("remanence of the magnets B_r", 0.05, 2)] = None
    recoil_permeability: Annotated[float | None, Quantity("relative recoil permeability of the magnets", 1, 2)] = None
    copper_resistivity_Ohm_m: Annotated[float, Quantity("copper resistivity at its reference temperature", 1e-8, 1e-7)]
    copper_reference_temperature_degC: Annotated[float, Quantity("temperature of the copper resistivity", -50, 200)]
    copper_temperature_coefficient_per_K: Annotated[
        float, Quantity("linear temperature coefficient of the copper resistivity", 0, 0.02)
    ]
    lamination_density_kg_per_m3: Annotated[float, Quantity("density of the electrical steel", 1000, 20000)]
    magnet_density_kg_per_m3: Annotated[float | None, Quantity("density of the magnets", 1000, 20000)] = None
    copper_density_kg_per_m3: Annotated[float, Quantity("density of the copper", 1000, 20000)]

    @model_validator(mode="after")
    def _magnets_are_stated_or_of_a_grade(self) -> Self:
        own = ("remanence_T", "recoil_permeability", "magnet_density_kg_per_m3")
        missing = [key for key in own if getattr(self, key) is None]
        if missing and self.magnet_grade is None:
            raise ValueError(f"lacks {' and '.join(missing)}; add it, or magnet_grade, which has it")
        if self.remanence_T is None and self.magnet_temperature_degC is None:
            raise ValueError("has a magnet_grade without magnet_temperature_degC; add it, or state remanence_T itself")
        if self.remanence_T is not None and self.magnet_temperature_degC is not None:
            raise ValueError("states remanence_T and magnet_temperature_degC, which would give another; leave one out")
        return self


class MagnetsSection(Section):
    """What the magnets must stand; what is not stated has the default of ``study.inputs_magnets``."""

    cold_temperature_degC: Annotated[float | None, Quantity("coldest temperature of the magnets", -60, 100)] = None
    hot_temperature_degC: Annotated[float | None, Quantity("hottest temperature of the magnets", 0, 350)] = None
    lost_volume_max_percent: Annotated[
        float | None, Quantity("share of the magnets' volume that may go beyond the knee", 0, 100)
    ] = None

    @model_validator(mode="after")
    def _ends_are_in_order(self) -> Self:
        if self.cold_temperature_degC is not None and self.hot_temperature_degC is not None:
            _require_order(self, "cold_temperature_degC", "hot_temperature_degC", equal_allowed=True)
        return self


class WindingSection(Section):
    """Winding layout (three phases, star of slots) and copper fill."""

    layers: Literal[1, 2]
    packing_factor: Annotated[float, Quantity("copper over slot area k_cp", 0.05, 0.95)]
    coil_pitch: Annotated[int | None, Quantity("coil pitch in slots", 1, 180)] = None


class MeshSection(Section):
    """Resolution of the mesh; what is not stated has the default of ``geometry.half_cell.MeshDensity``."""

    gap_edges_per_revolution: Annotated[
        int | None, Quantity("least number of mesh edges around the air gap", 60, 14400)
    ] = None
    gap_layers: Annotated[int | None, Quantity("layers of elements in either half of the air gap", 1, 12)] = None
    elements_across_tooth: Annotated[float | None, Quantity("elements across a tooth", 1, 40)] = None


class FluxMapSection(Section):
    """Resolution of the flux map; what is not stated has the default of ``pipeline.flux_map``."""

    angles: Annotated[int | None, Quantity("rotor angles over 60 electrical degrees", 1, 720)] = None
    currents: Annotated[int | None, Quantity("currents along either axis", 5, 101)] = None


Bounds = Annotated[tuple[float, float] | None, Listed]


class VariablesSection(Section):
    """Dimensions that the optima choose beside back iron and rotor radius: smallest and largest; optional, and what is
    not named stays as [machine] states it."""

    magnet_length_mm: Annotated[Bounds, Quantity("radial magnet length", 0.3, 50)] = None
    magnet_arc_fraction: Annotated[Bounds, Quantity("magnet arc over pole pitch", 0.1, 1)] = None
    airgap_mm: Annotated[Bounds, Quantity("air gap between magnets and teeth", 0.05, 20)] = None
    tooth_width_mm: Annotated[Bounds, Quantity("tooth width", 0.3, 200)] = None
    slot_opening_mm: Annotated[Bounds, Quantity("slot opening", 0.1, 50)] = None
    shoe_d1_mm: Annotated[Bounds, Quantity("depth of the parallel-sided slot opening", 0.05, 50)] = None
    shoe_d2_mm: Annotated[Bounds, Quantity("depth of the shoe's taper", 0.05, 50)] = None

    @field_validator("*", mode="after")
    @classmethod
    def _ends_are_in_order(cls, ends: tuple[float, float] | None) -> tuple[float, float] | None:
        if ends is not None and not ends[0] < ends[1]:
            raise ValueError(f"goes from {ends[0]:g} to {ends[1]:g}; give the smallest value first, then the largest")
        return ends


class SweepSection(Section):
    """Grid of the cross-section optimisation and its two current densities."""

    slots: Annotated[tuple[int, ...], Listed, Field(min_length=1), Quantity("slot counts", 3, 360)]
    poles: Annotated[tuple[int, ...] | None, Listed, Field(min_length=1), Quantity("pole counts", 2, 360)] = None
    stator_diameters_mm: Annotated[
        tuple[float, ...], Listed, Field(min_length=1), Quantity("stator outer diameters", 10, 2000)
    ]
    back_iron_fraction_min: Annotated[float, Quantity("smallest back-iron width over R_so", 0.01, 0.5)]
    back_iron_fraction_max: Annotated[float, Quantity("largest back-iron width over R_so", 0.01, 0.5)]
    back_iron_steps: Annotated[int, Quantity("grid points along the back-iron width", 3, 101)]
    rotor_radius_fraction_min: Annotated[float, Quantity("smallest rotor radius over R_so", 0.05, 0.95)]
    rotor_radius_fraction_max: Annotated[float, Quantity("largest rotor radius over R_so", 0.05, 0.95)]
    rotor_radius_steps: Annotated[int, Quantity("grid points along the rotor radius", 3, 101)]
    j_nominal_rms_A_per_mm2: Annotated[float, Quantity("nominal current density in the copper", 0.1, 50)]
    j_overload_rms_A_per_mm2: Annotated[float, Quantity("overload current density in the copper", 0.1, 200)]

    @model_validator(mode="after")
    def _ends_are_in_order(self) -> Self:
        _require_order(self, "back_iron_fraction_min", "back_iron_fraction_max")
        _require_order(self, "rotor_radius_fraction_min", "rotor_radius_fraction_max")
        _require_order(self, "j_nominal_rms_A_per_mm2", "j_overload_rms_A_per_mm2")
        return self

    @field_validator("slots", "poles", "stator_diameters_mm", mode="after")
    @classmethod
    def _named_once(cls, values: tuple[Any, ...] | None) -> tuple[Any, ...] | None:
        return None if values is None else _each_once(values)

    @field_validator("poles", mode="after")
    @classmethod
    def _poles_come_in_pairs(cls, counts: tuple[int, ...] | None) -> tuple[int, ...] | None:
        return counts if counts is None else tuple(_in_pairs(poles) for poles in counts)


SaturationReading = Literal["aligned_tooth", "every_tooth", "every_tooth_and_back_iron_over_period"]


class SaturationSection(Section):
    """How the limit on the stator's flux density is read."""

    reading: SaturationReading
    limit_T: Annotated[float, Quantity("limit of the probe flux density", 0.3, 2.5)]
    limits_compared_T: Annotated[tuple[float, ...], Listed, Quantity("limits compared in the report", 0.3, 2.5)]


_BELOW_THEIR_PEAK = (
    ("force_rms_N", "force_peak_N"),
    ("velocity_rms_m_per_s", "velocity_peak_m_per_s"),
    ("power_rms_W", "power_peak_W"),
    ("velocity_at_force_peak_m_per_s", "velocity_peak_m_per_s"),
    ("force_at_power_peak_N", "force_peak_N"),
    ("velocity_at_power_peak_m_per_s", "velocity_peak_m_per_s"),
)
_ROUNDED = 0.05  # of stated products: tables are rounded


class RequirementsSection(Section):
    """What the actuator must do, at the wheel (thesis Table 3.7); magnitudes, without the table's signs.

    No damping, holding without motion and a peak force at standstill are zeros that mean something.
    """

    maximum_damping_kNs_per_m: Annotated[float, Quantity("maximum regenerative damping", 0, 1e4)]
    force_rms_N: Annotated[float, Quantity("RMS actuator force", 1e-3, 1e6)]
    velocity_rms_m_per_s: Annotated[float, Quantity("RMS actuator velocity", 0, 1e2)]
    power_rms_W: Annotated[float, Quantity("RMS actuator power", 0, 1e6)]
    velocity_peak_m_per_s: Annotated[float, Quantity("peak actuator velocity", 1e-4, 1e2)]
    force_peak_N: Annotated[float, Quantity("peak actuator force", 1e-3, 1e6)]
    velocity_at_force_peak_m_per_s: Annotated[float, Quantity("actuator velocity at the peak force", 0, 1e2)]
    power_peak_W: Annotated[float, Quantity("peak actuator power", 1e-3, 1e7)]
    force_at_power_peak_N: Annotated[float, Quantity("actuator force at the peak power", 1e-3, 1e6)]
    velocity_at_power_peak_m_per_s: Annotated[float, Quantity("actuator velocity at the peak power", 1e-4, 1e2)]

    @model_validator(mode="after")
    def _no_mean_or_simultaneous_value_above_the_peak(self) -> Self:
        for low, high in _BELOW_THEIR_PEAK:
            _require_order(self, low, high, equal_allowed=True)
        most = self.force_peak_N * self.velocity_peak_m_per_s
        if self.power_peak_W > most * (1 + _ROUNDED):
            raise ValueError(
                f"has power_peak_W = {self.power_peak_W:g} above force_peak_N times velocity_peak_m_per_s = {most:g}; "
                "reduce the power, or raise force or velocity"
            )
        return self


class DriveSection(Section):
    """A load on the slow shaft in the place of a wheel: a robot joint, a pump; magnitudes."""

    torque_peak_Nm: Annotated[float, Quantity("peak torque of the shaft", 1e-3, 1e6)]
    speed_at_torque_peak_rpm: Annotated[float, Quantity("speed at the peak torque", 0, 1e5)]
    torque_rms_Nm: Annotated[float, Quantity("RMS torque of the shaft", 1e-3, 1e6)]
    speed_rms_rpm: Annotated[float, Quantity("RMS speed of the shaft", 0, 1e5)]
    power_rms_W: Annotated[float, Quantity("RMS power", 0, 1e6)]
    speed_peak_rpm: Annotated[float, Quantity("peak speed of the shaft", 1e-3, 1e5)]
    torque_at_power_peak_Nm: Annotated[float, Quantity("torque at the peak power", 0, 1e6)]
    speed_at_power_peak_rpm: Annotated[float, Quantity("speed at the peak power", 0, 1e5)]
    inertia_max_kg_m2: Annotated[
        float, Quantity("inertia of rotor and gears at the shaft that counts as 1 in the cost", 1e-9, 1e5)
    ]
    viscous_friction_Nms_per_rad: Annotated[float, Quantity("viscous friction at the shaft", 0, 1e5)]
    coulomb_friction_Nm: Annotated[float, Quantity("dry friction at the shaft", 0, 1e5)]
    # optional: an inertia that is compared with that of the drive, braking in short circuit, room for the casing
    load_inertia_kg_m2: Annotated[float | None, Quantity("inertia of the load at the shaft", 0, 1e6)] = None
    damping_Nms_per_rad: Annotated[float | None, Quantity("damping in short circuit", 0, 1e6)] = None
    diameter_max_mm: Annotated[float | None, Quantity("largest diameter of the casing", 5, 4000)] = None


class ChainSection(Section):
    """What feeds the match: results of the stages before it, or what the study states."""

    requirements: Literal["vehicle", "stated"]  # runs of the vehicle, or [requirements]
    linkage: Literal["optimised", "stated"]  # the choice from the Pareto front, or the ratios of [linkage]


class MotorcycleSection(Section):
    """Motorcycle of four degrees of freedom with the actuator at the rear (thesis Fig. 3.6, Table 3.2)."""

    sprung_mass_kg: Annotated[float, Quantity("mass of the body with rider", 1, 1e5)]
    pitch_inertia_kg_m2: Annotated[float, Quantity("inertia of the body about its pitch axis", 0.1, 1e6)]
    front_weight_fraction: Annotated[float, Quantity("share of the body that rests on the front axle", 0.05, 0.95)]
    front_wheel_distance_mm: Annotated[float, Quantity("front axle ahead of the centre of gravity", 10, 1e4)]
    rear_wheel_distance_mm: Annotated[float, Quantity("rear axle behind the centre of gravity", 10, 1e4)]
    cog_height_mm: Annotated[float, Quantity("centre of gravity above the road", 10, 1e4)]
    front_unsprung_mass_kg: Annotated[float, Quantity("mass of the front wheel", 0.1, 1e4)]
    rear_unsprung_mass_kg: Annotated[float, Quantity("mass of the rear wheel", 0.1, 1e4)]
    fork_leg_stiffness_kN_per_m: Annotated[float, Quantity("stiffness of one fork leg", 0.1, 1e5)]
    fork_inclination_deg: Annotated[float, Quantity("fork against the vertical", 0, 80)]
    rear_spring_stiffness_kN_per_m: Annotated[float, Quantity("stiffness of the rear spring", 0.1, 1e5)]
    rear_motion_ratio: Annotated[float, Quantity("spring travel over wheel travel", 0.01, 10)]
    front_tyre_stiffness_kN_per_m: Annotated[float, Quantity("vertical stiffness of the front tyre", 1, 1e5)]
    rear_tyre_stiffness_kN_per_m: Annotated[float, Quantity("vertical stiffness of the rear tyre", 1, 1e5)]
    stop_bump_mm: Annotated[float, Quantity("stroke of the rear at the bump stop, compression negative", -1e4, -1)]
    stop_rebound_mm: Annotated[float, Quantity("stroke of the rear at the rebound stop", 1, 1e4)]
    stop_stiffness_kN_per_m: Annotated[float, Quantity("stiffness of the end stops", 0, 1e6)]


class QuarterCarSection(Section):
    """One wheel with its part of the body (thesis Fig. 4.7, Table 4.4)."""

    sprung_mass_kg: Annotated[float, Quantity("mass of the body over this wheel", 1, 1e5)]
    unsprung_mass_kg: Annotated[float, Quantity("mass of the wheel", 0.1, 1e4)]
    spring_stiffness_kN_per_m: Annotated[float, Quantity("stiffness of the spring at the wheel", 0.1, 1e5)]
    tyre_stiffness_kN_per_m: Annotated[float, Quantity("vertical stiffness of the tyre", 1, 1e5)]


DamperTable = Annotated[str | None, Field(min_length=1)]


class DampersSection(Section):
    """Damper curves at the wheel: a table (shipped, or a csv beside the study), or one damping for all velocities."""

    front: DamperTable = None
    maximum: DamperTable = None
    minimum: DamperTable = None
    front_kNs_per_m: Annotated[float | None, Quantity("linear damping of the front", 1e-3, 1e4)] = None
    maximum_kNs_per_m: Annotated[float | None, Quantity("largest linear damping", 1e-3, 1e4)] = None
    minimum_kNs_per_m: Annotated[float | None, Quantity("smallest linear damping", 1e-3, 1e4)] = None


class RideSection(Section):
    """Random road at cruise speed, and how much of the damping the actuator must give as a generator."""

    maximum_regenerative_damping_kNs_per_m: Annotated[
        float, Quantity("damping without active power, 0: none is asked for", 0, 1e4)
    ]
    road_class: Literal["A", "B", "C", "D", "E"]
    cruise_speed_km_per_h: Annotated[float, Quantity("speed on the random road", 1, 500)]
    road_duration_s: Annotated[float, Quantity("length of a run on the random road", 1, 600)]
    road_seeds: Annotated[tuple[int, ...], Listed, Field(min_length=1), Quantity("seeds of the random road", 0, 2**31)]


class ObstaclesSection(Section):
    """Lumped obstacle, every speed with every amplitude and damping."""

    shape: Annotated[str, Field(min_length=1)]
    amplitudes_mm: Annotated[
        tuple[float, ...], Listed, Field(min_length=1), Quantity("amplitudes, bumps positive", -1000, 1000)
    ]
    speeds_km_per_h: Annotated[tuple[float, ...], Listed, Field(min_length=1), Quantity("speeds", 1, 500)]
    duration_s: Annotated[float, Quantity("length of a run", 0.1, 60)]

    @field_validator("amplitudes_mm", mode="after")
    @classmethod
    def _every_obstacle_has_a_height(cls, amplitudes: tuple[float, ...]) -> tuple[float, ...]:
        if 0 in amplitudes:
            raise ValueError("names an obstacle without amplitude; give millimetres above (bump) or below (pothole)")
        return amplitudes


class AccelerationSection(Section):
    """Full acceleration from rest, which loads the rear suspension (thesis eq. 3.25)."""

    longitudinal_m_per_s2: Annotated[float, Quantity("longitudinal acceleration", 0.1, 50)]
    duration_s: Annotated[float, Quantity("length of the run", 0.1, 60)]


Point = Annotated[tuple[float, float], Listed]
_COORDINATE = Quantity("coordinates x, y with the origin in hardpoint O", -1e4, 1e4)


class LinkageSection(Section):
    """Transmission from wheel travel to the actuator's lever; hardpoints are optional and for the record."""

    ratio_nominal_mm_per_rad: Annotated[float, Quantity("linkage ratio at the nominal wheel position", 1, 1e4)]
    ratio_max_mm_per_rad: Annotated[float, Quantity("largest linkage ratio along the wheel travel", 1, 1e4)]
    envelope_radius_max_mm: Annotated[float | None, Quantity("largest outer radius of the actuator", 5, 1e3)] = None
    link_ab_length_mm: Annotated[float | None, Quantity("length of link AB", 1, 1e4)] = None
    link_bc_length_mm: Annotated[float | None, Quantity("length of link BC", 1, 1e4)] = None
    hardpoint_a_mm: Annotated[Point | None, _COORDINATE] = None
    hardpoint_c_mm: Annotated[Point | None, _COORDINATE] = None
    wheel_axle_mm: Annotated[Point | None, _COORDINATE] = None
    hardpoint_b_min_mm: Annotated[Point | None, _COORDINATE] = None
    hardpoint_b_max_mm: Annotated[Point | None, _COORDINATE] = None
    hardpoint_c_min_mm: Annotated[Point | None, _COORDINATE] = None
    hardpoint_c_max_mm: Annotated[Point | None, _COORDINATE] = None

    @model_validator(mode="after")
    def _ends_are_in_order(self) -> Self:
        _require_order(self, "ratio_nominal_mm_per_rad", "ratio_max_mm_per_rad", equal_allowed=True)
        return self


class LinkageSearchSection(Section):
    """What the Pareto front of linkages is searched over, and which of its points is built (thesis eqs 3.43-3.50).

    Arm and boxes are the hardpoints of [linkage].
    """

    travel_rebound_mm: Annotated[float, Quantity("wheel travel below the nominal position", 1, 1e4)]
    travel_bump_mm: Annotated[float, Quantity("wheel travel above the nominal position", 1, 1e4)]
    ratio_limit_mm_per_rad: Annotated[float, Quantity("largest nominal ratio tau_lim", 1, 1e5)]
    ratio_spread_limit_mm_per_rad: Annotated[float, Quantity("spread of the ratio that counts as 1", 0.01, 1e5)]
    ratio_weight: Annotated[float, Quantity("weight of the nominal ratio against its spread", 0, 1)]
    angle_window_deg: Annotated[float, Quantity("transmission angles about 90 degrees", 1, 90)]
    lever_length_min_mm: Annotated[float, Quantity("shortest lever BC", 1, 1e4)]
    seeds: Annotated[tuple[int, ...], Listed, Field(min_length=1), Quantity("seeds of the search", 0, 2**31)]
    population: Annotated[int, Quantity("individuals of a generation", 4, 10000)]
    generations: Annotated[int, Quantity("generations of a run", 1, 100000)]
    choice: Literal["smallest_ratio", "best_angles", "knee"]
    angles_worst_rad2: Annotated[
        float | None, Quantity("worst angle objective f2 that smallest_ratio accepts", 0, 100)
    ] = None
    ratio_max_mm_per_rad: Annotated[
        float | None, Quantity("largest nominal ratio that best_angles accepts", 1, 1e5)
    ] = None

    @model_validator(mode="after")
    def _the_rule_has_its_number(self) -> Self:
        needed = {"smallest_ratio": "angles_worst_rad2", "best_angles": "ratio_max_mm_per_rad"}.get(self.choice)
        if needed and getattr(self, needed) is None:
            raise ValueError(f'has choice = "{self.choice}" without {needed}; add it')
        return self


class MatchSection(Section):
    """Limits, weights and gear data of the gearbox and motor match (thesis eqs 3.62-3.118)."""

    length_max_mm: Annotated[float, Quantity("largest active length", 1, 5000)]
    speed_max_rad_per_s: Annotated[float, Quantity("largest rotor speed", 1, 1e5)]
    mass_max_kg: Annotated[float, Quantity("mass that counts as 1 in the cost", 0.01, 1e4)]
    # optional: only with a wheel; a [drive] states its inertia_max_kg_m2
    equivalent_mass_max_kg: Annotated[
        float | None, Quantity("equivalent mass that counts as 1 in the cost", 0.01, 1e5)
    ] = None
    weight_inertia: Annotated[float, Quantity("weight of the equivalent inertia against the mass, w_m", 0, 1)]
    weight_radius: Annotated[float, Quantity("weight of the stator radius, w_Rso", 0, 100)]
    radius_limit_mm: Annotated[float, Quantity("stator radius that counts as 1 in the cost", 5, 1000)]
    overload_torque: Literal["field", "linear"]
    enforce_damping: bool
    # optional: the designer's choice of the machine to go on with; without it the least cost decides
    chosen_slots: Annotated[int | None, Quantity("slot count to go on with", 3, 360)] = None
    chosen_poles: Annotated[int | None, Quantity("pole count to go on with", 2, 360)] = None
    chosen_stator_diameter_mm: Annotated[float | None, Quantity("stator diameter to go on with", 10, 2000)] = None
    chosen_gear_ratio: Annotated[float | None, Quantity("linkage ratio over transmission ratio", 1, 1e5)] = None
    chosen_active_length_mm: Annotated[float | None, Quantity("active length to go on with", 1, 5000)] = None
    steel_density_kg_per_m3: Annotated[float, Quantity("density of gears and shaft", 1000, 20000)]
    gearbox_stages: Annotated[int, Quantity("planetary stages, 0: direct drive", 0, 6)]
    # optional: only with planetary stages
    gear_ring_diameter_fraction: Annotated[
        float | None, Quantity("ring pitch diameter over the outer diameter", 0.3, 1)
    ] = None
    gear_contact_stress_MPa: Annotated[float | None, Quantity("allowable contact stress sigma_H", 50, 5000)] = None
    gear_overload_factor: Annotated[float | None, Quantity("overload factor K_A", 1, 5)] = None
    gear_contact_ratio_factor: Annotated[float | None, Quantity("contact ratio factor Z_eps", 0.3, 1)] = None
    gear_pressure_angle_deg: Annotated[float | None, Quantity("pressure angle", 10, 35)] = None
    gear_youngs_modulus_GPa: Annotated[float | None, Quantity("Young's modulus of the gears", 10, 1000)] = None
    gear_poisson_ratio: Annotated[float | None, Quantity("Poisson's ratio of the gears", 0, 0.49)] = None


class GearboxSection(Section):
    """Teeth of the planetary stages: loads, strength, manufacture and construction (thesis eqs 3.119-3.124)."""

    ratio_tolerance: Annotated[float, Quantity("relative tolerance of the ratio", 1e-4, 0.5)]
    planets: Annotated[int, Quantity("planets of a stage", 2, 8)]
    life_h: Annotated[float, Quantity("operating life", 1, 1e6)]
    torque_class_Nm: Annotated[float, Quantity("width of the torque classes at the slow shaft", 0.01, 1e5)]
    swing_deg: Annotated[float | None, Quantity("largest turn of the slow shaft between two reversals", 0.01, 3600)] = (
        None  # where no vehicle is run
    )
    material: Literal["case_hardened_MQ", "case_hardened_ME"]
    accuracy_grade: Annotated[int, Quantity("accuracy grade of ISO 1328", 1, 12)]
    application_factor: Annotated[float, Quantity("application factor K_A", 0.5, 5)]
    oil_viscosity_mm2_per_s: Annotated[float, Quantity("viscosity of the oil at 40 degC", 1, 2000)]
    flank_roughness_um: Annotated[float, Quantity("roughness R_z of the flanks", 0.1, 100)]
    root_roughness_um: Annotated[float, Quantity("roughness R_z of the roots", 0.1, 200)]
    friction_coefficient: Annotated[float, Quantity("friction of the teeth", 0, 0.3)]
    safety_flank: Annotated[float, Quantity("safety of the flanks under the load spectrum", 0, 10)]
    safety_root: Annotated[float, Quantity("safety of the roots under the load spectrum", 0, 10)]
    safety_static_flank: Annotated[float, Quantity("safety of the flanks under the peak torque, 0: reported", 0, 10)]
    safety_static_root: Annotated[float, Quantity("safety of the roots under the peak torque, 0: reported", 0, 10)]
    planet_bore_fraction: Annotated[float, Quantity("bore over root diameter of a planet", 0.05, 0.9)]
    flange_fraction: Annotated[float, Quantity("thickness of a carrier flange over the face width", 0.01, 2)]
    flange_thickness_min_mm: Annotated[float, Quantity("least thickness of a carrier flange", 0.1, 100)]
    axial_gap_mm: Annotated[float, Quantity("gap between flange and teeth", 0.01, 50)]
    # optional: the gear set of somebody else, rated in the same way and shown beside ours
    printed_teeth: Annotated[
        tuple[int, int, int] | None, Listed, Quantity("stated teeth of sun, planet and ring", 4, 2000)
    ] = None
    printed_module_mm: Annotated[float | None, Quantity("stated module", 0.1, 50)] = None
    printed_shifts: Annotated[
        tuple[float, float] | None, Listed, Quantity("stated profile shifts of sun and planet", -2, 2)
    ] = None
    printed_face_widths_mm: Annotated[
        tuple[float, ...] | None, Listed, Quantity("stated face width of each stage", 0.1, 1000)
    ] = None


class AssemblySection(Section):
    """What the gearbox and the machine are built into, and the friction of the whole, at the wheel."""

    casing_wall_mm: Annotated[float, Quantity("radial wall of the casing", 0.1, 200)]
    lever_side_mm: Annotated[float, Quantity("bearings, spline and nut of the lever shaft", 0, 1000)]
    bearing_seat_mm: Annotated[float, Quantity("bearing seat on either side of the machine", 0, 500)]
    sensor_cover_mm: Annotated[float, Quantity("cover with the position sensor", 0, 500)]
    casing_mass_kg: Annotated[float, Quantity("casing, bearings, shafts and lever", 0, 1e4)]
    # optional: only with a wheel; a [drive] states its own
    viscous_friction_Ns_per_m: Annotated[float | None, Quantity("viscous friction at the wheel", 0, 1e6)] = None
    coulomb_friction_N: Annotated[float | None, Quantity("dry friction at the wheel", 0, 1e5)] = None


class MechanicsSection(Section):
    """Strength of rotor, shafts and bearings; what is not stated has the default of ``study.inputs_mechanics``."""

    overspeed_factor: Annotated[float | None, Quantity("overspeed over the largest speed of the rotor", 1, 3)] = None
    glue_tensile_strength_MPa: Annotated[float | None, Quantity("tensile strength of the glue, warm", 0.1, 100)] = None
    glue_shear_strength_MPa: Annotated[float | None, Quantity("shear strength of the glue, warm", 0.1, 100)] = None
    glue_safety: Annotated[float | None, Quantity("safety of the glue: peel, voids, age", 1, 20)] = None
    # a sleeve over the magnets in the place of glue: all of the first three keys, or none
    sleeve_material: Literal["carbon", "steel"] | None = None
    sleeve_thickness_mm: Annotated[float | None, Quantity("radial thickness of the sleeve", 0.05, 20)] = None
    sleeve_prestress_MPa: Annotated[float | None, Quantity("hoop stress of the fitted sleeve at rest", 1, 3000)] = None
    sleeve_safety: Annotated[float | None, Quantity("safety of the sleeve", 1, 10)] = None
    lamination_yield_MPa: Annotated[float | None, Quantity("yield strength of the electrical steel", 50, 1500)] = None
    shaft_yield_MPa: Annotated[float | None, Quantity("yield strength of the rotor shaft", 50, 3000)] = None
    sun_yield_MPa: Annotated[float | None, Quantity("yield strength of the sun gears' core", 50, 3000)] = None
    yield_safety: Annotated[float | None, Quantity("safety against yield", 1, 10)] = None
    lamination_tensile_MPa: Annotated[float | None, Quantity("tensile strength of the sheet", 50, 2000)] = None
    shaft_tensile_MPa: Annotated[float | None, Quantity("tensile strength of the rotor shaft", 50, 4000)] = None
    sun_tensile_MPa: Annotated[float | None, Quantity("tensile strength of the sun gears' core", 50, 4000)] = None
    notch_factor: Annotated[float | None, Quantity("fatigue factor of notch, surface and size", 1, 10)] = None
    fatigue_safety: Annotated[float | None, Quantity("safety of amplitudes over the life", 1, 10)] = None
    peak_load_cycles: Annotated[float | None, Quantity("peak torques over the life", 1, 1e12)] = None
    critical_speed_factor: Annotated[float | None, Quantity("critical speed over the largest speed", 1, 10)] = None
    eccentricity_fraction: Annotated[float | None, Quantity("eccentricity of the rotor in the air gap", 0, 0.9)] = None
    bearing_capacity_kN: Annotated[float | None, Quantity("dynamic load rating C of either bearing", 0.01, 1e4)] = None
    bearing_life_h: Annotated[float | None, Quantity("wanted life of the bearings", 1, 1e6)] = None

    @model_validator(mode="after")
    def _a_sleeve_is_described_whole(self) -> Self:
        keys = ("sleeve_material", "sleeve_thickness_mm", "sleeve_prestress_MPa")
        missing = [key for key in keys if getattr(self, key) is None]
        if 0 < len(missing) < len(keys):
            raise ValueError(f"describes a sleeve without {missing[0]}; add it, or remove the others of the sleeve")
        return self

    @model_validator(mode="after")
    def _a_life_is_that_of_a_stated_bearing(self) -> Self:
        if self.bearing_life_h is not None and self.bearing_capacity_kN is None:
            raise ValueError("has bearing_life_h without bearing_capacity_kN, which it is rated with; add it")
        return self


class PricesSection(Section):
    """Optional: what the materials cost, in a currency per kilogram; a price that is not stated is not guessed."""

    currency: Annotated[str, Field(min_length=1)]
    lamination: Annotated[float | None, Quantity("price of the electrical steel per kilogram", 0, 1e6)] = None
    magnet: Annotated[float | None, Quantity("price of the magnets per kilogram", 0, 1e6)] = None
    copper: Annotated[float | None, Quantity("price of the copper per kilogram", 0, 1e6)] = None
    shaft: Annotated[float | None, Quantity("price of the shaft's steel per kilogram", 0, 1e6)] = None


class TolerancesSection(Section):
    """How far the workshop may miss the drawing, each the half width a of +-a; what is not stated has the default of
    ``study.inputs_tolerances``."""

    bore_diameter_mm: Annotated[float | None, Quantity("tolerance of the stator's bore", 1e-4, 2)] = None
    rotor_diameter_mm: Annotated[float | None, Quantity("tolerance of the rotor core's diameter", 1e-4, 2)] = None
    stator_diameter_mm: Annotated[float | None, Quantity("tolerance of the stator's outer diameter", 1e-4, 2)] = None
    magnet_length_mm: Annotated[float | None, Quantity("tolerance of the magnets' thickness", 1e-4, 2)] = None
    magnet_width_mm: Annotated[float | None, Quantity("tolerance of the magnets' width along the arc", 1e-4, 2)] = None
    slot_opening_mm: Annotated[float | None, Quantity("tolerance of the slot openings", 1e-4, 2)] = None
    tooth_width_mm: Annotated[float | None, Quantity("tolerance of the teeth's width", 1e-4, 2)] = None
    back_iron_width_mm: Annotated[float | None, Quantity("tolerance of the back iron's width", 1e-4, 2)] = None
    shoe_depth_mm: Annotated[float | None, Quantity("tolerance of either depth of the shoes", 1e-4, 2)] = None
    active_length_mm: Annotated[float | None, Quantity("tolerance of the stack's length", 1e-4, 20)] = None
    remanence_percent: Annotated[float | None, Quantity("tolerance of the remanence of a batch", 1e-3, 20)] = None
    recoil_permeability: Annotated[float | None, Quantity("tolerance of the recoil permeability", 1e-4, 0.5)] = None
    stacking_percent: Annotated[float | None, Quantity("tolerance of the stacking factor", 1e-3, 10)] = None
    wire_diameter_percent: Annotated[float | None, Quantity("tolerance of the wires' copper diameter", 1e-3, 20)] = None
    magnet_scatter_percent: Annotated[float | None, Quantity("remanence from magnet to magnet", 1e-3, 20)] = None
    magnet_position_mm: Annotated[float | None, Quantity("place of each magnet along the arc", 1e-4, 2)] = None


class PrintedActuatorSection(Section):
    """The actuator of somebody else, for the comparison at the end (thesis Tables 3.12 and A.1)."""

    source: Annotated[str, Field(min_length=1)]
    force_peak_N: Annotated[float, Quantity("peak force at the wheel", 0.1, 1e6)]
    actuator_torque_peak_Nm: Annotated[float, Quantity("peak torque at the slow shaft", 0.01, 1e6)]
    machine_torque_peak_Nm: Annotated[float, Quantity("peak torque of the machine", 1e-3, 1e5)]
    equivalent_mass_kg: Annotated[float, Quantity("equivalent inertia at the wheel", 1e-3, 1e5)]
    gearbox_ratio: Annotated[float, Quantity("fast over slow speed of the gearbox", 1, 1e4)]
    linkage_ratio_mm_per_rad: Annotated[float, Quantity("nominal ratio of the linkage", 1, 1e4)]
    mass_kg: Annotated[float, Quantity("mass", 0.01, 1e4)]
    diameter_mm: Annotated[float, Quantity("diameter of the envelope", 1, 1e4)]
    length_mm: Annotated[float, Quantity("length of the envelope", 1, 1e4)]


class PrintedMachineSection(Section):
    """What somebody else states for the machine of ``[machine]``; it is matched in the same way, shown beside ours."""

    source: Annotated[str, Field(min_length=1)]
    torque_nominal_Nm_per_m: Annotated[
        float, Quantity("stated torque per length at the nominal current density", 0.01, 1e5)
    ]
    half_slot_area_mm2: Annotated[float, Quantity("stated half-slot area", 0.01, 1e5)]


class WindingChoiceSection(Section):
    """What may be wound, whatever the supply (thesis eqs 3.119-3.120)."""

    wire_diameters_mm: Annotated[
        tuple[float, ...], Listed, Field(min_length=1), Quantity("copper diameters of the allowed wires", 0.1, 2)
    ]
    enamel_grade: Annotated[int, Quantity("grade of the enamel, IEC 60317-0-1", 1, 2)]
    packing_tolerance: Annotated[float, Quantity("accepted excess over the packing factor, relative", 0, 0.3)]
    # optional: what else may be chosen, and what holds it back; defaults in ``study.inputs_electrical``
    parallel_paths: Annotated[
        tuple[int, ...] | None, Listed, Field(min_length=1), Quantity("allowed numbers of parallel paths", 1, 100)
    ] = None
    connections: Annotated[tuple[Literal["star", "delta"], ...] | None, Listed, Field(min_length=1)] = None
    insulated_fill_max: Annotated[
        float | None, Quantity("share of a coil side that the wires fill with their enamel", 0.01, 0.9)
    ] = None
    delta_circulating_loss_max: Annotated[
        float | None, Quantity("loss by the current round a delta over the copper loss", 0, 1)
    ] = None

    @field_validator("wire_diameters_mm", "parallel_paths", "connections", mode="after")
    @classmethod
    def _named_once(cls, values: tuple[Any, ...] | None) -> tuple[Any, ...] | None:
        return None if values is None else _each_once(values)


class WindingSelectionSection(WindingChoiceSection):
    """Wires, supply and limits from which turns, strands and connection of a study's machine are chosen."""

    dc_bus_voltage_V: Annotated[float, Quantity("voltage of the DC bus", 1, 2000)]
    phase_current_max_rms_A: Annotated[float, Quantity("RMS phase current that the power electronics allow", 0.1, 1e4)]
    speed_max_rpm: Annotated[float, Quantity("largest speed of the torque-speed map", 10, 2e5)]
    winding_temperature_degC: Annotated[float, Quantity("temperature of the winding", -50, 300)]
    insulation_class: Literal["A", "E", "B", "F", "H", "N"] | None = None


class ThermalSection(Section):
    """How the machine is cooled and how warm it may become; what is not stated has the default of
    ``thermal.cooling``."""

    continuous_length: Literal["temperature", "density"] | None = None  # what the length for good is made by

    ambient_temperature_degC: Annotated[float | None, Quantity("temperature of the surroundings", -60, 200)] = None
    magnet_temperature_max_degC: Annotated[float | None, Quantity("warmest magnets", 50, 400)] = None
    remanence_temperature_coefficient_per_K: Annotated[
        float | None, Quantity("reversible temperature coefficient of the remanence", -0.01, 0)
    ] = None
    slot_filler_conductivity_W_per_mK: Annotated[
        float | None, Quantity("heat conductivity of what fills the slot between the wires", 0.02, 5)
    ] = None
    slot_liner_mm: Annotated[float | None, Quantity("thickness of the slot liner", 1e-3, 5)] = None
    slot_liner_conductivity_W_per_mK: Annotated[float | None, Quantity("heat conductivity of the liner", 0.02, 5)] = (
        None
    )
    casing_gap_mm: Annotated[
        float | None, Quantity("gap of air that stands for the contact of laminations and casing", 1e-4, 1)
    ] = None
    emissivity: Annotated[float | None, Quantity("emissivity of the casing", 0, 1)] = None
    film_W_per_m2K: Annotated[
        float | None, Quantity("film coefficient of the casing, in the place of still air", 0, 1e5)
    ] = None
    mount_conductance_W_per_K: Annotated[
        float | None, Quantity("conductance from the casing to what it is mounted on", 0, 1e5)
    ] = None


class ActuatorSection(Section):
    """Mount, drive and force loop; what is not stated has the values of the prototype (``vehicle.designed``)."""

    mount_stiffness_kN_per_m: Annotated[float | None, Quantity("stiffness of the mount in full contact", 1, 1e6)] = None
    mount_damping_Ns_per_m: Annotated[float | None, Quantity("damping of the mount, in its play too", 0, 1e6)] = None
    mount_contact_damping_Ns_per_m: Annotated[float | None, Quantity("damping of the mount in contact", 0, 1e6)] = None
    mount_play_um: Annotated[float | None, Quantity("half of the clearance of mount and gears", 0, 1e4)] = None
    mount_transition_mm: Annotated[float | None, Quantity("deformation over which the contact builds up", 0, 100)] = (
        None
    )
    torque_lag_ms: Annotated[float | None, Quantity("time constant of the torque under current control", 0, 100)] = None
    loop_proportional: Annotated[float | None, Quantity("proportional gain of the force loop", 0, 1e3)] = None
    loop_integral_rad_per_s: Annotated[float | None, Quantity("integral gain of the force loop", 0, 1e6)] = None
    loop_derivative_ms: Annotated[float | None, Quantity("derivative gain of the force loop", 0, 1e3)] = None
    loop_filter_rad_per_s: Annotated[float | None, Quantity("filter of the derivative", 0, 1e6)] = None


class OptimiseSection(Section):
    """What the search over all stages is for."""

    judged_by: Literal["requirements", "road"] | None = None  # road: comfort, road holding and recovered power


class Study(Section):
    """A whole study file."""

    study: StudySection
    machine: MachineSection
    materials: MaterialsSection
    magnets: MagnetsSection = MagnetsSection()
    winding: WindingSection
    mesh: MeshSection = MeshSection()
    sweep: SweepSection
    variables: VariablesSection = VariablesSection()
    saturation: SaturationSection
    chain: ChainSection | None = None  # without it everything is as stated
    motorcycle: MotorcycleSection | None = None
    quarter_car: QuarterCarSection | None = None
    dampers: DampersSection | None = None
    ride: RideSection | None = None
    obstacles: ObstaclesSection | None = None
    acceleration: AccelerationSection | None = None
    requirements: RequirementsSection | None = None
    drive: DriveSection | None = None  # in the place of [requirements] and [linkage]
    linkage: LinkageSection | None = None
    linkage_search: LinkageSearchSection | None = None
    match: MatchSection
    printed_machine: PrintedMachineSection | None = None
    winding_selection: WindingSelectionSection
    flux_map: FluxMapSection = FluxMapSection()
    thermal: ThermalSection = ThermalSection()
    gearbox: GearboxSection | None = None  # not for a direct drive
    assembly: AssemblySection
    actuator: ActuatorSection = ActuatorSection()
    prices: PricesSection | None = None
    mechanics: MechanicsSection = MechanicsSection()
    optimise: OptimiseSection = OptimiseSection()
    tolerances: TolerancesSection = TolerancesSection()
    printed_actuator: PrintedActuatorSection | None = None

    _path: Path = PrivateAttr(default=Path("study.toml"))

    @property
    def path(self) -> Path:
        """The file that the study was read from."""
        return self._path


def _each_once(values: tuple[Any, ...]) -> tuple[Any, ...]:
    if len(set(values)) < len(values):
        raise ValueError("names a value twice; give each one once")
    return values


def _require_order(section: Section, low_key: str, high_key: str, equal_allowed: bool = False) -> None:
    low, high = getattr(section, low_key), getattr(section, high_key)
    if low > high or (low == high and not equal_allowed):
        relation = "above" if equal_allowed else "not below"
        raise ValueError(f"has {low_key} = {low:g} {relation} {high_key} = {high:g}; exchange or change them")
