"""Teeth as drawn: involute flanks with straight fillets, for the end view of a stage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy import pi

from gearbox.involute import Gear
from gearbox.planetary_set import PlanetarySet

_FLANK_POINTS = 9


@dataclass(frozen=True)
class StageOutlines:
    """Closed outlines of a stage with the sun at the origin.

    sun, planets: x + jy [m], (points,); ring: its inner edge, x + jy [m], (points,)
    centres: of the planets, x + jy [m], (planets,)
    """

    sun: np.ndarray
    planets: tuple[np.ndarray, ...]
    ring: np.ndarray
    centres: np.ndarray


def gear_outline(gear: Gear, phase: float = 0.0) -> np.ndarray:
    """Closed outline of a gear about the origin, (points,) x + jy [m]; a tooth centre stands at ``phase`` [rad].

    Between its fillet and its tip the flank is the involute; the fillet is drawn as a chamfer as wide as its radius.
    """
    inner = np.hypot(gear.base_radius, max(float(gear.form_curvature), 0.0))
    lowest, highest = (inner, gear.tip_radius) if gear.side > 0 else (gear.tip_radius, inner)
    radius = np.linspace(lowest, highest, _FLANK_POINTS)[:: int(gear.side)]  # from the root to the tip
    half = gear.half_tooth_angle(radius)
    space = pi / abs(gear.teeth) - half[0]
    foot = half[0] + min(gear.rack.fillet_radius * gear.module / gear.root_radius, 0.8 * space)
    radius, half = np.append(gear.root_radius, radius), np.append(foot, half)
    flank = radius * np.exp(-1j * half)
    tooth = np.concatenate([flank, np.conj(flank[::-1])])
    turns = np.exp(1j * (phase + 2 * pi * np.arange(int(abs(gear.teeth))) / abs(gear.teeth)))
    points = (turns[:, None] * tooth).ravel()
    return np.append(points, points[0])


def planet_phases(gears: PlanetarySet, sun_phase: float = 0.0) -> np.ndarray:
    """Angle of a tooth of each planet [rad], (planets,), so that the sun's teeth stand in its spaces.

    sun_phase: angle of a tooth of the sun [rad]
    """
    at = 2 * pi * np.arange(gears.planets) / gears.planets
    sun, planet = abs(gears.sun.teeth), abs(gears.planet.teeth)
    return at + pi - (pi - (at - sun_phase) * sun) / planet


def ring_phases(gears: PlanetarySet, sun_phase: float = 0.0) -> np.ndarray:
    """Angle of a ring tooth [rad] that each planet asks for, (planets,); equal modulo the pitch if they assemble.

    sun_phase: angle of a tooth of the sun [rad]
    """
    at = 2 * pi * np.arange(gears.planets) / gears.planets
    planet, ring = abs(gears.planet.teeth), abs(gears.ring.teeth)
    return at - ((at - planet_phases(gears, sun_phase)) * planet + pi) / ring


def stage_outlines(gears: PlanetarySet) -> StageOutlines:
    """End view of a stage, first planet on the x axis."""
    centres = gears.centre_distance * np.exp(2j * pi * np.arange(gears.planets) / gears.planets)
    phases = planet_phases(gears)
    planets = tuple(c + gear_outline(gears.planet, phase) for c, phase in zip(centres, phases, strict=True))
    return StageOutlines(gear_outline(gears.sun), planets, gear_outline(gears.ring, ring_phases(gears)[0]), centres)
