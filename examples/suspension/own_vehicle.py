"""A vehicle of one's own over a pothole: `python -m examples.suspension.own_vehicle`.

Whatever has a body on axles is a vehicle; the last axle has the actuator.
"""

from actuator.drive import MappedMotor, TorqueLimit
from actuator.model import Actuator
from actuator.parts import MechanicalLoss, fixed_ratio
from vehicle.damping import linear_damper
from vehicle.models import Axle, EndStops, Tyre, Vehicle
from vehicle.ride import Run, Scenario, simulate
from vehicle.road import Obstacle, ObstacleShape


class Van(Vehicle):
    """Half of a van, seen from the side, in SI: 300 kg over the front wheel, 420 kg over the rear one."""

    sprung_mass, pitch_inertia, cog_height = 720.0, 1400.0, 0.7
    axles = (
        Axle(1.75, 300.0, 40.0, 24e3, Tyre(180e3)),
        Axle(-1.25, 420.0, 45.0, 38e3, Tyre(200e3), EndStops(bump=-0.09, rebound=0.1, stiffness=5e5)),
    )
    passive_dampers = (linear_damper(2.2e3, "front"),)


LIMIT = TorqueLimit((0.0, 700.0, 2000.0), (6.0, 6.0, 1.5), (6.0, 6.0, 3.0))
ACTUATOR = Actuator(MappedMotor(LIMIT), fixed_ratio(2.2e-3), equivalent_mass=4.9, loss=MechanicalLoss(coulomb=40.0))
POTHOLE = Obstacle(ObstacleShape((0.0, 0.1, 0.9, 1.0), (0.0, 1.0, 1.0, 0.0), "drawn by hand"), amplitude=-0.05)


def main() -> None:
    """Drive through at 50 km/h and print the largest values at the rear."""
    pothole = Scenario("pothole", 50 / 3.6, 2.0, POTHOLE, time_step=2.5e-4)
    found = simulate([Run(Van(), linear_damper(2.6e3, "wanted"), pothole, ACTUATOR)])[0]
    print(f"stroke {1e3 * found.stroke.min():.0f} to {1e3 * found.stroke.max():.0f} mm")
    print(f"force {abs(found.suspension_force).max():.0f} N, rotor {abs(found.inside.rotor_speed).max():.0f} rad/s")


if __name__ == "__main__":
    main()
