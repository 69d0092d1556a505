"""Numbers that the thesis prints for its two vehicles, in SI, each with its source. Inputs first, then results.

Damper curves and the obstacle are figures in the thesis; the tables in ``vehicle/data`` stand in for them.
"""

from __future__ import annotations

from units import DEGREE, GRAVITY, MILLIMETRE
from vehicle.damping import DamperCurve, mixed, read_damper_curve
from vehicle.models import Axle, EndStops, Motorcycle, QuarterCar, Tyre, fork_stiffness, swing_arm_stiffness
from vehicle.printed_car import (
    COMFORT,
    HANDLING,
    PRINTED_CAR,
    PRINTED_DAMPING,
    PRINTED_DURATION,
    PRINTED_SPEED,
    TRADE_OFF,
)
from vehicle.road import ObstacleShape, read_obstacle_shape
from vehicle.tables import DATA

KILOMETRE_PER_HOUR = 1 / 3.6  # m/s
CRUISE_SPEED = PRINTED_SPEED  # text to Table 3.4 and to Fig. 4.22
ROAD_CLASS = "B"  # the same
MOTORCYCLE_ROAD_DURATION = 30.0  # s, text to Table 3.4
QUARTER_CAR_ROAD_DURATION = PRINTED_DURATION
OBSTACLE_DURATION = 2.0  # s, text to Fig. 3.10
WORST_OBSTACLE_SPEED = 50 * KILOMETRE_PER_HOUR  # Table 3.5
WORST_OBSTACLE_AMPLITUDE = -50 * MILLIMETRE  # Table 3.5, a pothole
LONGITUDINAL_ACCELERATION = 0.9 * GRAVITY  # text to eq. 3.25
MAXIMUM_REGENERATIVE_DAMPING = 40e3  # Ns/m, text to Table 3.4
NOT_UNCOMFORTABLE = 0.032 * GRAVITY  # m/s^2, limit of ISO 2631, text to Fig. 4.54


def motorcycle() -> Motorcycle:
    """The Benelli 752s, Table 3.2, with a stand-in for the front damper (Fig. 3.7a)."""
    body, front_share = 227.0, 0.506
    front = Axle(
        position=721.7 * MILLIMETRE,
        sprung_mass=body * front_share,
        unsprung_mass=20.0,
        spring_stiffness=fork_stiffness(7e3, 22.8 * DEGREE),
        tyre=Tyre(250e3),
    )
    rear = Axle(
        position=-728.5 * MILLIMETRE,
        sprung_mass=body * (1 - front_share),
        unsprung_mass=28.0,
        spring_stiffness=swing_arm_stiffness(170e3, 0.454),
        tyre=Tyre(170e3),
        stops=EndStops(bump=-140 * MILLIMETRE, rebound=20 * MILLIMETRE, stiffness=1e7),
    )
    fork = read_damper_curve(DATA / "front_mixed.csv", "front")
    return Motorcycle(body, 119.3, 505.2 * MILLIMETRE, front, rear, front_damper=fork)


def motorcycle_damping() -> tuple[DamperCurve, DamperCurve, DamperCurve]:
    """Rear damper, maximum, minimum and mixed: stand-ins for Fig. 3.7b, not yet capped."""
    maximum = read_damper_curve(DATA / "rear_maximum.csv", "maximum")
    minimum = read_damper_curve(DATA / "rear_minimum.csv", "minimum")
    return maximum, minimum, mixed(rebound=maximum, bump=minimum)


def obstacle_shape() -> ObstacleShape:
    """Stand-in for Fig. 3.8."""
    return read_obstacle_shape(DATA / "obstacle.csv")


def quarter_car() -> QuarterCar:
    """The car of chapter 4, Table 4.4."""
    return PRINTED_CAR


def quarter_car_damping() -> tuple[DamperCurve, DamperCurve]:
    """Maximum and minimum damping of chapter 4: the steepest part of Fig. 4.21 as straight lines."""
    return PRINTED_DAMPING


def digressive_minimum() -> DamperCurve:
    """A guess at the minimum damping of Fig. 4.21: its steepest part up to 200 N, 1200 Ns/m beyond."""
    knee, end = 200.0 / 2.6e3, 3.0
    force = 200.0 + 1200.0 * (end - knee)
    return DamperCurve(
        "minimum, digressive", (-end, -knee, 0.0, knee, end), (-force, -200.0, 0.0, 200.0, force), "guess"
    )


# ---- results of the motorcycle, columns maximum, minimum, mixed -----------------------------------------------------

TABLE_3_4 = {  # ISO B at 70 km/h, 30 s, one seed that is not printed
    "road_holding_rms": (0.26, 0.26, 0.25),
    "comfort_rms": (0.14 * GRAVITY, 0.11 * GRAVITY, 0.13 * GRAVITY),
    "stroke_peak": (-15e-3, -21e-3, -19e-3),
    "force_rms": (290.8, 149.3, 300.5),
    "velocity_rms": (0.09, 0.16, 0.10),
    "power_rms": (35.7, 34.6, 37.4),
}
TABLE_3_5 = {  # pothole of 50 mm at 50 km/h
    "velocity_peak": (-3.2, -3.3, -3.4),
    "force_peak": (2277.0, 2335.0, 2614.0),
    "velocity_at_force_peak": (1.4, 1.6, 1.6),
    "power_peak": (4253.0, 3770.0, 4133.0),
    "force_at_power_peak": (-1343.0, 2335.0, 2614.0),
    "velocity_at_power_peak": (-3.2, 1.6, 1.6),
}
TABLE_3_6 = {  # acceleration with 0.9 g
    "velocity_peak": (-0.3, -0.3, -0.3),
    "force_peak": (482.0, 279.0, 586.0),
    "velocity_at_force_peak": (0.1, 0.2, 0.2),
    "power_peak": (66.0, 56.0, 91.0),
    "force_at_power_peak": (-242.0, 279.0, 586.0),
    "velocity_at_power_peak": (-0.3, 0.2, 0.2),
}
TABLE_3_7 = {  # requirements
    "maximum_damping": MAXIMUM_REGENERATIVE_DAMPING,
    "force_rms": 300.0,
    "velocity_rms": 0.1,
    "power_rms": 37.4,
    "velocity_peak": -3.4,
    "force_peak": 2614.0,
    "velocity_at_force_peak": 1.6,
    "power_peak": 4253.0,
    "force_at_power_peak": -1343.0,
    "velocity_at_power_peak": -3.2,
}
PITCH_FREQUENCY = 1.8  # Hz, undamped, text to Table 3.4
REAR_DAMPER_LARGEST_DAMPING = 80e3  # Ns/m, in rebound, text to Fig. 3.7

# ---- results of the quarter car -------------------------------------------------------------------------------------

# Coefficients as ``quarter_car.printed_form`` names them; what is not printed is left out.
LQR_COEFFICIENTS = {
    HANDLING: {"a1": -1.46e4, "a2": 1.62e4, "a3": 1.57e3, "a5": 4.38e3},  # eq. 4.25, a4 there
    COMFORT: {"a1": 2.3e4, "a3": 0.5, "a5": 13e1},  # eq. 4.26, which exchanges the last two and prints 13e5
    TRADE_OFF: {"a1": 2.25e4, "a3": 217.0, "a5": 118.0},  # eq. 4.27; a1 follows as 2.287e4
}
TABLE_4_1 = {  # comfort [m/s^2], road holding, largest stroke [m]
    COMFORT: (1e-4 * GRAVITY, 0.49, 61e-3),
    TRADE_OFF: (1.4e-2 * GRAVITY, 0.13, 71e-3),
    HANDLING: (3.8e-2 * GRAVITY, 0.05, 18e-3),
}
QUASI_IDEAL_PASSIVE = {  # damping [Ns/m]: comfort [m/s^2], road holding; Tables 4.6 and 4.7
    10e3: (0.077 * GRAVITY, 0.096),
    2.6e3: (0.042 * GRAVITY, 0.061),
}

# ---- the automotive prototype ---------------------------------------------------------------------------------------

# Table A.1. Torques and forces do not agree with the ratios to better than 3 %: 2.3 Nm * 87.3 = 200.8 Nm,
# 204 Nm / 0.115 m = 1774 N. No requirement is printed for it: appendix A names the maximum regenerative damping and
# the RMS force on a random road as its only constraints and leaves the peak force free.
AUTOMOTIVE_PROTOTYPE = {
    "force_peak": 1727.0,  # N at the wheel
    "actuator_torque_peak": 204.0,  # Nm at the slow shaft
    "machine_torque_peak": 2.3,  # Nm
    "equivalent_mass": 6.7,  # kg, after the rotor was changed; 15.9 kg before, text to Table A.1
    "gearbox_ratio": 1 / 87.3,
    "linkage_ratio": 0.115,  # m/rad
    "transmission_ratio": 1.35e-3,  # m/rad, text to Fig. A.2; 0.115 / 87.3 is 1.317e-3
    "active_length": 22 * MILLIMETRE,  # text to Fig. A.2
    "mass": 3.2,  # kg: gearbox 1.5, electric machine 1.7
    "envelope_diameter": 110 * MILLIMETRE,
    "envelope_length": 194 * MILLIMETRE,
}
