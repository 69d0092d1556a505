"""Meshing losses of a planetary stage.

Loss of a mesh after Ohlendorf (Niemann/Winter, Maschinenelemente II, ch. 21.11): share mu H_V of the rolling power,
with a mean coefficient of friction mu. Bearings, seals and churning are not included.
"""

from __future__ import annotations

import numpy as np
from numpy import pi

from gearbox.batch import Batch
from gearbox.errors import GearError
from gearbox.involute import Mesh
from gearbox.planetary_set import PlanetarySet


def loss_factor(mesh: Mesh) -> Batch:
    """H_V = pi (u + 1)/(2 z_1 u) [e_1^2 + e_2^2 + s(1 - e_1) + s(1 - e_2)], s(x) = x |x|; u < 0: internal.

    Mean sliding over rolling speed along the path of contact of spur gears, half the load on each of two pairs, all
    of it on a single one. e_1, e_2: addendum contact ratios, sum below 2. Where both are below 1 it is the published
    form, 1 - eps + e_1^2 + e_2^2; the other matters where the pitch point lies outside the single contact, as in
    most ring meshes.
    """
    u, parts = mesh.ratio, mesh.addendum_contact_ratios
    path = sum(part**2 + (1 - part) * np.abs(1 - part) for part in parts) / 2
    return pi * (u + 1) / (mesh.pinion.teeth * u) * path


def basic_efficiency(gears: PlanetarySet, friction: float) -> Batch:
    """eta_0 with the carrier held: (1 - mu H_V,sun) (1 - mu H_V,ring); friction: mu, dimensionless."""
    if not 0 <= friction < 0.5:
        raise GearError(f"the coefficient of friction must lie between 0 and 0.5; found {friction:g}")
    return (1 - friction * loss_factor(gears.sun_mesh)) * (1 - friction * loss_factor(gears.ring_mesh))


def stage_efficiency(gears: PlanetarySet, friction: float) -> tuple[Batch, Batch]:
    """(carrier drives sun, sun drives carrier), ring fixed (VDI 2157; Mueller, Umlaufgetriebe).

    friction: mu of the teeth, dimensionless
    i_0 = z_ring/z_sun < 0; sun drives: (1 - i_0 eta_0)/(1 - i_0); carrier drives: (1 - i_0)/(1 - i_0/eta_0).
    """
    fixed, eta = gears.ring.teeth / gears.sun.teeth, basic_efficiency(gears, friction)
    return (1 - fixed) / (1 - fixed / eta), (1 - fixed * eta) / (1 - fixed)
