"""Sun, planets and ring of a stage: which tooth numbers fit together, and the geometry that follows from them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy import pi, sin

from gearbox.batch import Batch
from gearbox.errors import GearError
from gearbox.involute import ISO_53_A, BasicRack, Gear, Mesh, centre_distance, shift_sum
from units import MILLIMETRE


@dataclass(frozen=True)
class PlanetarySet:
    """One set of teeth with a fixed ring; attributes of the gears may be arrays (a batch of sets).

    centre_distance: sun to planet and planet to ring [m]
    """

    sun: Gear
    planet: Gear
    ring: Gear
    centre_distance: Batch
    planets: int = 3

    @property
    def sun_mesh(self) -> Mesh:
        """Sun and planet."""
        return Mesh(self.sun, self.planet, self.centre_distance)

    @property
    def ring_mesh(self) -> Mesh:
        """Planet and ring."""
        return Mesh(self.planet, self.ring, self.centre_distance)

    @property
    def ratio(self) -> Batch:
        """i = 1 + |z_ring| / z_sun, sun speed relative to carrier speed."""
        return 1 - self.ring.teeth / self.sun.teeth

    @property
    def teeth(self) -> tuple[Batch, Batch, Batch]:
        """(z_sun, z_planet, z_ring), the ring negative."""
        return self.sun.teeth, self.planet.teeth, self.ring.teeth

    @property
    def planet_gap(self) -> Batch:
        """Distance between the tip circles of neighbouring planets [m]: 2 a sin(pi/N) - d_a."""
        return 2 * self.centre_distance * sin(pi / self.planets) - 2 * self.planet.tip_radius

    @property
    def plain(self) -> PlanetarySet:
        """A single set with plain numbers in the place of numpy's, as results are written with."""
        return _single(self).at(0)

    def at(self, index: int) -> PlanetarySet:
        """One set of a batch, its numbers plain."""

        def one(gear: Gear) -> Gear:
            numbers = {name: getattr(gear, name) for name in ("teeth", "shift", "module", "tip_radius")}
            shape = np.shape(self.centre_distance)
            return replace(gear, **{name: np.broadcast_to(x, shape)[index].item() for name, x in numbers.items()})

        return PlanetarySet(
            one(self.sun), one(self.planet), one(self.ring), float(self.centre_distance[index]), self.planets
        )


def _single(gears: PlanetarySet) -> PlanetarySet:
    """A set as a batch of one."""
    return replace(gears, centre_distance=np.atleast_1d(gears.centre_distance))


def equally_spaced(sun_teeth: Batch, ring_teeth: Batch, planets: int) -> Batch:
    """Whether equally spaced planets can be put in: z_sun + |z_ring| divisible by their number."""
    return (np.asarray(sun_teeth) + np.abs(ring_teeth)) % planets == 0


def share_a_factor(first: Batch, second: Batch) -> Batch:
    """Whether two tooth numbers have a common factor, so that the same teeth meet more often than they need to.

    first, second: number of teeth, dimensionless
    """
    return np.gcd(np.abs(np.asarray(first, dtype=int)), np.abs(np.asarray(second, dtype=int))) > 1


def planetary_set(
    teeth: Iterable[Batch],
    shifts: Iterable[Batch],
    module: Batch,
    *,
    planets: int = 3,
    rack: BasicRack = ISO_53_A,
    ring_shift: Batch | None = None,
) -> PlanetarySet:
    """The set of tooth numbers (z_sun, z_planet, z_ring < 0) and shifts (x_sun, x_planet) without backlash.

    module [m]; shifts, ring_shift: [modules]
    The sun-planet pair sets the centre distance, and that the shift of the ring, unless ``ring_shift``
    states it (then the ring has the backlash that results). Tips are one addendum over the shifted reference circle,
    less what keeps the clearance of the rack (h_f - h_a) to the mating root and ends contact before the mating fillet.
    Arrays broadcast; where no geometry exists the values are NaN. A single set raises GearError there.
    """
    z_sun, z_planet, z_ring = (np.asarray(z)[()] for z in teeth)
    x_sun, x_planet = (np.asarray(x, dtype=float)[()] for x in shifts)
    alpha = rack.pressure_angle
    distance = centre_distance(z_sun, z_planet, x_sun + x_planet, module, alpha)
    if ring_shift is None:
        ring_shift = shift_sum(z_planet, z_ring, distance, module, alpha) - x_planet
    bare = [Gear(z, x, module, 0.0, rack) for z, x in ((z_sun, x_sun), (z_planet, x_planet), (z_ring, ring_shift))]
    sun, planet, ring = (replace(g, tip_radius=_full_tip(g)) for g in bare)
    found = PlanetarySet(*_shortened(sun, planet, ring, distance), distance, planets)
    if np.ndim(distance) == 0 and not np.isfinite(found.ring.shift):
        raise GearError(
            f"teeth {z_sun}, {z_planet}, {z_ring} of module {module / MILLIMETRE:g} mm cannot mesh at the "
            f"{distance / MILLIMETRE:.3f} mm that the sun and planet need: change a tooth number or the profile shifts"
        )
    return found


def _full_tip(gear: Gear) -> Batch:
    """Tip radius without shortening, r + side m (x + h_a) [m]."""
    return gear.reference_radius + gear.side * gear.module * (gear.shift + gear.rack.addendum)


def _shortened(sun: Gear, planet: Gear, ring: Gear, distance: Batch) -> tuple[Gear, Gear, Gear]:
    """The gears with tips that leave clearance to the roots, and involute flank to the mating tips."""
    clearance = (sun.rack.dedendum - sun.rack.addendum) * sun.module
    outer, inner = (Mesh(*pair, distance).line_of_action for pair in ((sun, planet), (planet, ring)))
    with np.errstate(invalid="ignore"):
        sun_tip = _least(sun, distance - planet.root_radius - clearance, outer - planet.form_curvature)
        planet_tip = _least(planet, distance - sun.root_radius - clearance, outer - np.maximum(sun.form_curvature, 0))
        planet_tip = np.minimum(planet_tip, ring.root_radius - distance - clearance)
        fillet = np.hypot(ring.base_radius, inner + planet.form_curvature)
        ring_tip = np.maximum(np.maximum(ring.tip_radius, distance + planet.root_radius + clearance), fillet)
    return replace(sun, tip_radius=sun_tip), replace(planet, tip_radius=planet_tip), replace(ring, tip_radius=ring_tip)


def _least(gear: Gear, radius: Batch, curvature: Batch) -> Batch:
    """Tip radius of an external gear that is no larger than this radius, nor beyond this flank curvature [m]."""
    return np.minimum(np.minimum(gear.tip_radius, radius), np.hypot(gear.base_radius, np.maximum(curvature, 0)))
