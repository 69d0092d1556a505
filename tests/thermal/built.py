"""The reference machine, wound and in a casing, for the tests of this room."""

from electrical.wound_machine import WoundMachine
from geometry.machine import hanselman_machine
from tests.electrical.wires import series_star
from thermal.cooling import Cooling
from thermal.machine import Casing, CooledMachine, Weights

MM = 1e-3
MACHINE = hanselman_machine(
    slots=12, pole_pairs=5, stator_outer_radius=42.5 * MM, rotor_outer_radius=15.7 * MM, back_iron_width=3.3 * MM,
    magnet_length=2.5 * MM, airgap=0.5 * MM, slot_opening=2 * MM, shoe_depth_fraction=0.52, shoe_aspect_ratio=1.0,
    shaft_radius=5 * MM,
)  # fmt: skip
WOUND = WoundMachine(MACHINE, 4, 1, series_star(7, 22), 40 * MM)
WEIGHTS = Weights(copper=0.45, stator=0.75, rotor=0.12, magnets=0.07, shaft=0.03)
CASING = Casing(diameter=110 * MM, length=190 * MM, mass=2.4, bearing_seat=14 * MM, end_space=5 * MM)
COOLING = Cooling()


def cooled(speed=0.0, cooling=COOLING, wound=WOUND):
    """The machine turning at a speed [rad/s]."""
    return CooledMachine(wound, WEIGHTS, 0.95, CASING, cooling, speed)
