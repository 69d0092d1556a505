"""The network of a machine with coils in slots, magnets on the rotor and a closed casing.

    slot copper -- teeth -- yoke -- casing -- ambient (and mount)
         |   \\------------/             |
    end windings -- end air ------------/
                       |
    teeth ---- magnets -- rotor ----- casing (shaft and bearings)

Every part has one temperature, its mean; a part that is heated throughout conducts from its mean to its edge as a slab
or a hollow cylinder does. The casing has one temperature, too: of aluminium and some millimetres thick it carries heat
over sqrt(k t / h), 0.3 m and more, so that its ends over gears and sensor count as cooled surface.

Left out: radiation inside, heat of the teeth into the air gap's ends, glue under the magnets, gears as a store of heat,
and what fills the slot as one (short overloads come out on the safe side). All mass of the casing counts as aluminium.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import log, pi

from electrical.wound_machine import WoundMachine
from geometry.areas import part_areas
from geometry.machine import Machine
from thermal.air import Air, air_gap_film, cylinder_surface, end_space_film
from thermal.cooling import Cooling
from thermal.network import Link, Network, Node, Temperatures
from thermal.slot import MEAN_OF_SLAB, Filling, SlotPaths, equal_area_perimeter, slot_paths

SLOT, ENDS, TEETH, YOKE, CASING = "slot copper", "end windings", "teeth", "yoke", "casing"
MAGNETS, ROTOR, END_AIR = "magnets", "rotor and shaft", "air in the ends"
AMBIENT, MOUNT = "ambient", "mount"
PARTS = (SLOT, ENDS, TEETH, YOKE, CASING, MAGNETS, ROTOR, END_AIR)

# Conductivities [W/(m K)] and specific heats [J/(kg K)] near 100 degC.
COPPER_CONDUCTIVITY, COPPER_HEAT = 393.0, 397.0  # Incropera, Table A.1, at 400 K
# Silicon steel of 2 to 3 % along the sheet, 20 to 30 in makers' data: estimate in the middle.
STEEL_CONDUCTIVITY, STEEL_HEAT = 25.0, 490.0
MAGNET_CONDUCTIVITY, MAGNET_HEAT = 8.0, 450.0  # sintered NdFeB, makers' data 7 to 9 and 350 to 500
SHAFT_CONDUCTIVITY = 45.0  # low-alloy steel, standard textbook value
ALUMINIUM_HEAT = 900.0  # standard textbook value
BEARING_GAP = 0.3e-3  # m of air over its seat, as which a bearing conducts; estimate


@dataclass(frozen=True)
class Casing:
    """The closed cylinder around everything.

    diameter, length: outside [m]; mass [kg]; bearing_seat: length of one of the two [m]; end_space: from the stack to
    the bearing seat, on either side [m]
    """

    diameter: float
    length: float
    mass: float
    bearing_seat: float
    end_space: float


@dataclass(frozen=True)
class Weights:
    """copper [kg], with end turns; stator, rotor: of their laminations [kg]; magnets, shaft: [kg]."""

    copper: float
    stator: float
    rotor: float
    magnets: float
    shaft: float


@dataclass(frozen=True, eq=False)
class CooledMachine:
    """A wound machine in its casing, turning at one speed [rad/s]; stacking: steel over stack, dimensionless."""

    wound: WoundMachine
    weights: Weights
    stacking: float
    casing: Casing
    cooling: Cooling
    speed: float

    @cached_property
    def slot(self) -> SlotPaths:
        """Ways out of the copper in the slots."""
        machine = self.wound.dimensions
        return slot_paths(machine, self.wound.active_length, self.filling.conductivity, self.cooling.liner)

    @cached_property
    def filling(self) -> Filling:
        """What lies in the slots."""
        machine, wound, cooling = self.wound.dimensions, self.wound, self.cooling
        copper = self._sides * wound.copper_area / (2 * machine.slots * machine.half_slot_area)
        enamel = copper * wound.design.wire.enamel_area / wound.design.wire.area
        return Filling(copper, enamel, COPPER_CONDUCTIVITY, cooling.filler_conductivity)

    def network(self, temperature: Temperatures) -> Network:
        """Of the films at these temperatures [degC]."""
        surroundings = {AMBIENT: self.cooling.ambient}
        links = [*self._still_links, *self._rotor_links(temperature), self._casing_link(temperature)]
        if self.cooling.mount:
            surroundings[MOUNT] = self.cooling.ambient
            links.append(Link(CASING, MOUNT, self.cooling.mount))
        return Network(self._nodes, tuple(links), surroundings)

    def cold(self) -> dict[str, float]:
        """Every part as warm as the surroundings [degC]."""
        return dict.fromkeys((*PARTS, AMBIENT, MOUNT), self.cooling.ambient)

    def hottest_copper(self, temperature: Temperatures) -> float:
        """The hottest place of the winding [degC] at the mean temperatures of the parts [degC]."""
        slot = self.slot.hottest(temperature[SLOT], temperature[TEETH], temperature[YOKE])
        return max(slot, temperature[ENDS])

    # ---- stores -----------------------------------------------------------------------------------------------------

    @cached_property
    def _nodes(self) -> tuple[Node, ...]:
        weights, ends = self.weights, self.wound.end_turn_share
        copper, yoke = weights.copper * COPPER_HEAT, yoke_share(self.wound.dimensions)
        stores = {
            SLOT: copper * (1 - ends),
            ENDS: copper * ends,
            TEETH: weights.stator * STEEL_HEAT * (1 - yoke),
            YOKE: weights.stator * STEEL_HEAT * yoke,
            CASING: self.casing.mass * ALUMINIUM_HEAT,
            MAGNETS: weights.magnets * MAGNET_HEAT,
            ROTOR: (weights.rotor + weights.shaft) * STEEL_HEAT,
            END_AIR: self._end_volume * Air(self.cooling.ambient).volumetric_heat,
        }
        return tuple(Node(name, stores[name]) for name in PARTS)

    @property
    def _end_volume(self) -> float:
        """Of the air on both sides [m^3]; the end windings in it are left out."""
        return 2 * pi * self.wound.dimensions.stator_outer_radius**2 * self.casing.end_space

    # ---- ways -------------------------------------------------------------------------------------------------------

    @cached_property
    def _still_links(self) -> tuple[Link, ...]:
        """Those that no temperature changes."""
        return *self._copper_links(), *self._iron_links(), *self._end_links()

    @property
    def _sides(self) -> int:
        """Coil sides of the machine, and as many end turns."""
        return 6 * self.wound.coils_in_series

    def _copper_links(self) -> tuple[Link, ...]:
        """Through the liner, and along the wires to the end windings: two slabs, each half as long as its part."""
        wound, slot = self.wound, self.slot
        along = MEAN_OF_SLAB * (wound.active_length + wound.end_turn_length) / 2
        paths = 2 * self._sides * wound.copper_area
        return (
            Link(SLOT, TEETH, slot.flank),
            Link(SLOT, YOKE, slot.bottom),
            Link(SLOT, ENDS, COPPER_CONDUCTIVITY * paths / along),
        )

    def _iron_links(self) -> tuple[Link, ...]:
        """Along the teeth and from their roots around the yoke; outwards through the yoke and its contact."""
        machine, length = self.wound.dimensions, self.wound.active_length
        middle = (machine.slot_bottom_radius + machine.stator_outer_radius) / 2
        steel = STEEL_CONDUCTIVITY * self.stacking
        inner = shell_resistance(machine.slot_bottom_radius, middle, steel, length)
        outer = shell_resistance(middle, machine.stator_outer_radius, steel, length)
        gap = Air(self.cooling.ambient).conductivity * 2 * pi * machine.stator_outer_radius * length
        along = tooth_resistance(machine, steel, length) + spreading_resistance(machine, steel, length)
        return Link(TEETH, YOKE, 1 / (along + inner)), Link(YOKE, CASING, 1 / (outer + self.cooling.casing_gap / gap))

    def _rotor_links(self, temperature: Temperatures) -> tuple[Link, ...]:
        machine, length = self.wound.dimensions, self.wound.active_length
        gap = air_gap_film(
            machine.airgap, machine.mid_gap_radius, self.speed, (temperature[TEETH] + temperature[MAGNETS]) / 2
        )
        middle = machine.rotor_outer_radius - machine.magnet_length / 2
        magnet = shell_resistance(
            machine.rotor_core_radius, middle, MAGNET_CONDUCTIVITY * machine.magnet_arc_fraction, length
        )
        return (
            Link(TEETH, MAGNETS, gap * 2 * pi * machine.mid_gap_radius * length),
            Link(MAGNETS, ROTOR, 1 / magnet),
            Link(ROTOR, CASING, self._shaft_conductance(temperature[ROTOR])),
        )

    def _shaft_conductance(self, temperature: float) -> float:
        """Along the shaft out of the rotor and through the bearing, both sides [W/K]."""
        radius, casing = self.wound.dimensions.shaft_radius, self.casing
        shaft = (casing.end_space + casing.bearing_seat / 2) / (SHAFT_CONDUCTIVITY * pi * radius**2)
        bearing = BEARING_GAP / (Air(temperature).conductivity * 2 * pi * radius * casing.bearing_seat)
        return 2 / (shaft + bearing)

    def _end_links(self) -> tuple[Link, ...]:
        """End windings, faces of the rotor and inside of the casing, each with the air beside the stack."""
        wound, machine = self.wound, self.wound.dimensions
        film = end_space_film(self.speed * machine.rotor_outer_radius)
        bundle = equal_area_perimeter(wound.copper_area / self.filling.copper)
        covers = 2 * pi * machine.stator_outer_radius * (machine.stator_outer_radius + 2 * self.casing.end_space)
        return (
            Link(ENDS, END_AIR, film * self._sides * wound.end_turn_length * bundle),
            Link(ROTOR, END_AIR, film * 2 * pi * machine.rotor_outer_radius**2),
            Link(END_AIR, CASING, film * covers),
        )

    def _casing_link(self, temperature: Temperatures) -> Link:
        casing, ambient = self.casing, self.cooling.ambient
        film = self.cooling.film.at(casing.diameter, temperature[CASING], ambient)
        return Link(CASING, AMBIENT, film * cylinder_surface(casing.diameter, casing.length))


def shell_resistance(inner: float, outer: float, conductivity: float, length: float) -> float:
    """Of a hollow cylinder, ln(r_o / r_i) / (2 pi k l) [K/W].

    inner, outer: radii [m]; conductivity [W/(m K)]; length [m]
    """
    return log(outer / inner) / (2 * pi * conductivity * length)


def tooth_resistance(machine: Machine, conductivity: float, length: float) -> float:
    """From the mean of the teeth to their roots, heated evenly along their flanks, all in parallel [K/W].

    conductivity: of the stack [W/(m K)]; length [m]
    """
    height = machine.slot_bottom_radius - machine.stator_inner_radius
    return MEAN_OF_SLAB * height / (conductivity * machine.slots * machine.tooth_width * length)


def spreading_resistance(machine: Machine, conductivity: float, length: float) -> float:
    """From the roots of the teeth around the yoke to its mean, all in parallel [K/W].

    Behind a slot the yoke is a slab on either side, heated at the root, cooled outside: f^2 b / (3 k w l), where b is
    half the bottom of the slot, w the yoke and f the share of its length that lies behind slots. Estimate.

    conductivity: of the stack [W/(m K)]; length [m]
    """
    half_pitch = machine.slot_pitch / 2 * machine.slot_bottom_radius
    bottom = half_pitch - machine.tooth_width / 2
    around = conductivity * machine.back_iron_width * length * 2 * machine.slots
    return (bottom / half_pitch) ** 2 * MEAN_OF_SLAB * bottom / around


def yoke_share(machine: Machine) -> float:
    """Share of the stator's laminations that lies behind the slots, dimensionless."""
    ring = pi * (machine.stator_outer_radius**2 - machine.slot_bottom_radius**2)
    return ring / part_areas(machine).stator_laminations
