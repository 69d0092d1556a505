"""The vehicle of a study and what it is driven over, or the requirements that the study states, in SI."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

from drivetrain.requirements import Requirements, StatedRequirements
from study.inputs_drive import drive_requirements
from study.needed import needed
from study.schema import MotorcycleSection, QuarterCarSection, Study
from units import to_si
from vehicle.damping import DamperCurve, linear_damper, mixed, read_damper_curve
from vehicle.demands import RideCase
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
from vehicle.ride import Scenario
from vehicle.road import read_obstacle_shape, roughness_of_class
from vehicle.scenarios import acceleration_scenario, obstacle_scenarios, road_scenarios
from vehicle.tables import DATA


def ride_case(study: Study) -> RideCase:
    """Vehicle, dampers and roads of a study that drives one; VehicleError where they cannot be."""
    maximum, minimum = damper_curve(study, "maximum"), damper_curve(study, "minimum")
    return RideCase(
        vehicle=vehicle(study),
        curves=(maximum, minimum, mixed(rebound=maximum, bump=minimum)),
        road=tuple(_road(study)),
        overload=tuple([*_obstacles(study), *_acceleration(study)]),
        maximum_damping=needed(study.ride, "ride").si.maximum_regenerative_damping,
    )


def stated_requirements(study: Study) -> Requirements:
    """The requirements that the study states, of a wheel or of a shaft. Raises StudyError where it states none."""
    if study.drive is not None:
        return drive_requirements(study.drive)
    section = needed(study.requirements, "requirements").si
    return Requirements(**{f.name: getattr(section, f.name) for f in fields(Requirements)})


def requirements_beside(study: Study) -> StatedRequirements | None:
    """What the study states of its own, to be held against what its vehicle asks for; None where it states nothing."""
    return None if study.requirements is None else StatedRequirements(stated_requirements(study))


def vehicle(study: Study) -> Vehicle:
    """The vehicle that the study describes; VehicleError where it cannot be."""
    if study.motorcycle is not None:
        return _motorcycle(study.motorcycle, damper_curve(study, "front"))
    return _quarter_car(needed(study.quarter_car, "quarter_car"))


def _motorcycle(section: MotorcycleSection, front_damper: DamperCurve) -> Motorcycle:
    bike = section.si
    return Motorcycle(
        sprung_mass=bike.sprung_mass,
        pitch_inertia=bike.pitch_inertia,
        cog_height=bike.cog_height,
        front=_front(section),
        rear=_rear(section),
        front_damper=front_damper,
    )


def _front(section: MotorcycleSection) -> Axle:
    bike = section.si
    return Axle(
        position=bike.front_wheel_distance,
        sprung_mass=bike.sprung_mass * bike.front_weight_fraction,
        unsprung_mass=bike.front_unsprung_mass,
        spring_stiffness=fork_stiffness(bike.fork_leg_stiffness, bike.fork_inclination),
        tyre=Tyre(bike.front_tyre_stiffness),
    )


def _rear(section: MotorcycleSection) -> Axle:
    bike = section.si
    return Axle(
        position=-bike.rear_wheel_distance,
        sprung_mass=bike.sprung_mass * (1 - bike.front_weight_fraction),
        unsprung_mass=bike.rear_unsprung_mass,
        spring_stiffness=swing_arm_stiffness(bike.rear_spring_stiffness, bike.rear_motion_ratio),
        tyre=Tyre(bike.rear_tyre_stiffness),
        stops=EndStops(bike.stop_bump, bike.stop_rebound, bike.stop_stiffness),
    )


def _quarter_car(section: QuarterCarSection) -> QuarterCar:
    car = section.si
    return QuarterCar(car.sprung_mass, car.unsprung_mass, car.spring_stiffness, car.tyre_stiffness)


def damper_curve(study: Study, name: str) -> DamperCurve:
    """The curve ``name`` of [dampers], from a table or linear; VehicleError for a table that is no damper."""
    key = f"{name}_kNs_per_m"
    stated = getattr(study.dampers, key)
    if stated is not None:
        return linear_damper(to_si(key, stated)[1], name)  # not through ``si``: the table's name is the same there
    return read_damper_curve(table_file(study, getattr(study.dampers, name)), name)


def table_file(study: Study, text: str) -> Path:
    """A csv file beside the study, or one of the tables that come with the project, by its name."""
    return study.path.parent / text if text.lower().endswith(".csv") else DATA / f"{text}.csv"


def _road(study: Study) -> list[Scenario]:
    """The random road, once a seed."""
    ride = needed(study.ride, "ride").si
    return road_scenarios(roughness_of_class(ride.road_class), ride.cruise_speed, ride.road_duration, ride.road_seeds)


def _obstacles(study: Study) -> list[Scenario]:
    if study.obstacles is None:
        return []
    section = study.obstacles.si
    shape = read_obstacle_shape(table_file(study, section.shape))
    return obstacle_scenarios(shape, section.speeds, section.amplitudes, section.duration)


def _acceleration(study: Study) -> list[Scenario]:
    if study.acceleration is None:
        return []
    section = study.acceleration.si
    return [acceleration_scenario(section.longitudinal, section.duration)]
