"""The vehicle of a study, its dampers and what it drives over, as the objects of the package ``vehicle``."""

from __future__ import annotations

from pathlib import Path

from study.schema import DampersSection, MotorcycleSection, QuarterCarSection, Study
from units import DEGREE, MILLIMETRE
from vehicle.damping import DamperCurve, capped, linear_damper, mixed, read_damper_curve
from vehicle.models import (
    Axle,
    EndStops,
    Motorcycle,
    QuarterCar,
    Tyre,
    Vehicle,
    fork_stiffness,
    swing_arm_stiffness,
)
from vehicle.requirements import acceleration_scenario, obstacle_scenarios, road_scenarios
from vehicle.ride import Scenario
from vehicle.road import read_obstacle_shape, roughness_of_class
from vehicle.tables import DATA

KILO = 1e3
KILOMETRE_PER_HOUR = 1 / 3.6  # m/s


def to_vehicle(study: Study) -> Vehicle:
    """The vehicle that the study describes; VehicleError where it cannot be."""
    if study.motorcycle is not None:
        return _motorcycle(study.motorcycle, _curve(study, "front"))
    return _quarter_car(study.quarter_car)


def _motorcycle(section: MotorcycleSection, front_damper: DamperCurve) -> Motorcycle:
    body, share = section.sprung_mass_kg, section.front_weight_fraction
    stops = EndStops(
        section.stop_bump_mm * MILLIMETRE,
        section.stop_rebound_mm * MILLIMETRE,
        section.stop_stiffness_kN_per_m * KILO,
    )
    front = Axle(
        position=section.front_wheel_distance_mm * MILLIMETRE,
        sprung_mass=body * share,
        unsprung_mass=section.front_unsprung_mass_kg,
        spring_stiffness=fork_stiffness(
            section.fork_leg_stiffness_kN_per_m * KILO, section.fork_inclination_deg * DEGREE
        ),
        tyre=Tyre(section.front_tyre_stiffness_kN_per_m * KILO),
    )
    rear = Axle(
        position=-section.rear_wheel_distance_mm * MILLIMETRE,
        sprung_mass=body * (1 - share),
        unsprung_mass=section.rear_unsprung_mass_kg,
        spring_stiffness=swing_arm_stiffness(section.rear_spring_stiffness_kN_per_m * KILO, section.rear_motion_ratio),
        tyre=Tyre(section.rear_tyre_stiffness_kN_per_m * KILO),
        stops=stops,
    )
    return Motorcycle(
        body, section.pitch_inertia_kg_m2, section.cog_height_mm * MILLIMETRE, front, rear, front_damper=front_damper
    )


def _quarter_car(section: QuarterCarSection) -> QuarterCar:
    return QuarterCar(
        sprung_mass=section.sprung_mass_kg,
        unsprung_mass=section.unsprung_mass_kg,
        spring_stiffness=section.spring_stiffness_kN_per_m * KILO,
        tyre_stiffness=section.tyre_stiffness_kN_per_m * KILO,
    )


def to_damping(study: Study) -> list[DamperCurve]:
    """Maximum, minimum and mixed damping, none above the regenerative damping that is asked for."""
    maximum, minimum = _curve(study, "maximum"), _curve(study, "minimum")
    limit = study.ride.maximum_regenerative_damping_kNs_per_m * KILO
    return [capped(curve, limit) for curve in (maximum, minimum, mixed(rebound=maximum, bump=minimum))]


def _curve(study: Study, name: str) -> DamperCurve:
    """The damper curve ``name`` of [dampers], from a table or linear."""
    damping = getattr(study.dampers, f"{name}_kNs_per_m")
    if damping is not None:
        return linear_damper(damping * KILO, name)
    return read_damper_curve(table_file(study, getattr(study.dampers, name)), name)


def table_file(study: Study, text: str) -> Path:
    """A csv file beside the study, or one of the tables that come with the project, by its name."""
    return study.path.parent / text if text.lower().endswith(".csv") else DATA / f"{text}.csv"


def vehicle_files(study: Study) -> tuple[Path, ...]:
    """The tables that the runs of the vehicle depend on."""
    names = [getattr(study.dampers, name) for name in DampersSection.model_fields if not name.endswith("_per_m")]
    names += [study.obstacles.shape] if study.obstacles is not None else []
    return tuple(table_file(study, name) for name in names if name is not None)


def to_road_scenarios(study: Study) -> list[Scenario]:
    """The random road, once a seed."""
    ride = study.ride
    roughness, speed = roughness_of_class(ride.road_class), ride.cruise_speed_km_per_h * KILOMETRE_PER_HOUR
    return road_scenarios(roughness, speed, ride.road_duration_s, ride.road_seeds)


def to_overload_scenarios(study: Study) -> list[Scenario]:
    """Obstacles and acceleration, as far as the study has them."""
    found = []
    if study.obstacles is not None:
        shape = read_obstacle_shape(table_file(study, study.obstacles.shape))
        speeds = [speed * KILOMETRE_PER_HOUR for speed in study.obstacles.speeds_km_per_h]
        amplitudes = [amplitude * MILLIMETRE for amplitude in study.obstacles.amplitudes_mm]
        found += obstacle_scenarios(shape, speeds, amplitudes, study.obstacles.duration_s)
    if study.acceleration is not None:
        found.append(acceleration_scenario(study.acceleration.longitudinal_m_per_s2, study.acceleration.duration_s))
    return found
