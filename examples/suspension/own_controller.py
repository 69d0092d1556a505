"""A controller of one's own in a quarter car with a real actuator: `python -m examples.suspension.own_controller`.

A skyhook that is switched off where it would push: it damps the body as long as that takes power from the suspension.
"""

from actuator.drive import MappedMotor, QuadraticLoss, flat_limit
from actuator.model import Actuator
from actuator.parts import CompliantMount, MechanicalLoss, fixed_ratio
from control.force_loop import ForceLoop
from units import GRAVITY
from vehicle.commands import Controller, Felt
from vehicle.energy import ride_energy
from vehicle.models import QuarterCar
from vehicle.ride import Run, Scenario, simulate
from vehicle.road import IsoRoad, roughness_of_class

CAR = QuarterCar(sprung_mass=417.0, unsprung_mass=40.0, spring_stiffness=23e3, tyre_stiffness=126e3)
MOTOR = MappedMotor(flat_limit(2.3, 2000.0), QuadraticLoss(copper=24.7, iron=1.5e-4), time_constant=1e-3)
MOUNT = CompliantMount(676e3, damping=295.0, play=9.2e-6, contact_damping=545.0, transition=3.84e-3)
ACTUATOR = Actuator(MOTOR, fixed_ratio(1.32e-3), 6.16, MOUNT, MechanicalLoss(viscous=106.0))
LOOP = ForceLoop(proportional=7.4, integral=1000.0, derivative=5.9e-3, filter=6283.0)


def semi_active_skyhook(felt: Felt) -> float:
    """1.8 kNs/m between body and wheel, and 1.4 kNs/m to the sky where that does not cost power."""
    velocity = felt.body_velocity - felt.wheel_velocity
    sky = 1400.0 * felt.body_velocity
    return 1800.0 * velocity + (sky if sky * velocity > 0 else 0.0)


def main() -> None:
    """Drive 15 s of an ISO-B road at 70 km/h and print what came of it."""
    road = Scenario("ISO B", 70 / 3.6, 15.0, IsoRoad(roughness_of_class("B"), seed=0))
    found = ride_energy(simulate([Run(CAR, Controller(semi_active_skyhook, 1e-3), road, ACTUATOR, LOOP)])[0])
    print(f"comfort {found.comfort / GRAVITY:.4f} g, road holding {found.road_holding:.4f}")
    print(f"from the suspension {found.shaft.active:.1f} W, to the battery {found.battery.active:.1f} W")


if __name__ == "__main__":
    main()
