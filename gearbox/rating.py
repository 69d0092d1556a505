"""Safety factors of a planetary stage: pitting and root bending under a load spectrum and under the peak torque.

ISO 6336, method B, spur gears. Simplified: the relative speed N of the dynamic factor has its main resonance from 0.85
on at any load (the standard lowers that below 100 N/mm, which these slow gears never come near); factors for size,
work hardening, rim and grinding notch are 1; load sharing of the planets is one number; teeth are not modified.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from gearbox.batch import Batch
from gearbox.errors import GearError
from gearbox.fatigue import miner_sum, spectrum_safety
from gearbox.flank import (
    Lubrication,
    contact_stress,
    permissible_contact_stress,
    pitch_velocity,
    single_contact_factors,
)
from gearbox.involute import Mesh
from gearbox.load_factors import LoadFactors, Quality, load_factors
from gearbox.material import GearMaterial, LifeLine
from gearbox.planetary_set import PlanetarySet
from gearbox.root import (
    RootSection,
    outer_single_contact_radii,
    permissible_root_stress,
    root_section,
    root_stress,
    static_root_strength,
)
from gearbox.spectrum import LoadSpectrum, cycles_per_revolution

GEARS = ("sun", "planet", "ring")


@dataclass(frozen=True)
class Rules:
    """What teeth are rated by.

    alternating: Y_M, dimensionless, on the root strength of gears loaded both ways, fatigue; 0.7 for an idler (thesis
        above eq. 3.123), here for sun and ring too, as the actuator turns back and forth
    alternating_static: the same, dimensionless, on the static root strength; 1 takes the peak as a single load
    """

    material: GearMaterial
    quality: Quality
    oil: Lubrication
    alternating: float = 0.7
    alternating_static: float = 1.0


@dataclass(frozen=True)
class StageLoad:
    """What the carrier of a stage transmits: load spectrum, peak_torque [Nm] and peak_speed [rad/s] of the overload."""

    spectrum: LoadSpectrum
    peak_torque: float
    peak_speed: float

    def __post_init__(self) -> None:
        if not (self.peak_torque > 0 and self.peak_speed >= 0):
            raise GearError(
                "a stage needs a peak torque above 0 and a peak speed not below 0; found "
                f"{self.peak_torque:g} Nm at {self.peak_speed:g} rad/s"
            )

    def behind(self, ratio: float) -> StageLoad:
        """The load of the next stage: torque over the ratio of this one, dimensionless, speed times it; lossless."""
        spectrum = self.spectrum.scaled(1 / ratio, ratio)
        return StageLoad(spectrum, self.peak_torque / ratio, self.peak_speed * ratio)


@dataclass(frozen=True)
class StageRating:
    """Safety factors by gear ("sun", "planet", "ring"; the planet's are the lower ones of its two meshes).

    flank, root: dimensionless, fatigue under the spectrum
    static_flank, static_root: dimensionless, the peak torque, once
    """

    flank: dict[str, Batch]
    root: dict[str, Batch]
    static_flank: dict[str, Batch]
    static_root: dict[str, Batch]

    @property
    def least(self) -> dict[str, float]:
        """Smallest safety factor of each kind, dimensionless."""
        return {kind.name: min(np.min(value) for value in getattr(self, kind.name).values()) for kind in fields(self)}


@dataclass(frozen=True)
class PittingBudget:
    """Where the pitting safety of a sun goes: ``safety`` is the product of the other four.

    bare, loads, film, spectrum: dimensionless
    bare: sigma_Hlim Z_N over the stress of the RMS torque all the time, all other factors 1; loads: 1/sqrt(K_V K_Hbeta
    K_Halpha K_A K_gamma) at that torque; film: Z_L Z_V Z_R; spectrum: Miner's sum over the classes in the place of
    their RMS torque
    """

    bare: float
    loads: float
    film: float
    spectrum: float

    @property
    def safety(self) -> float:
        """Pitting safety of the sun under the spectrum, dimensionless."""
        return self.bare * self.loads * self.film * self.spectrum


@dataclass(frozen=True)
class _Stresses:
    """Pinion and wheel of a mesh: contact and root stress over the strength at the knee (fatigue) or once (static)."""

    contact: tuple[Batch, ...]
    root: tuple[Batch, ...]


def rate_stage(gears: PlanetarySet, face_width: Batch, load: StageLoad, rules: Rules) -> StageRating:
    """Safety factors of a stage; gears and face_width [m] may be a batch."""
    static_flank, static_root = static_ratings(gears, face_width, load, rules)
    flank, root = endurance_ratios(gears, face_width, load.spectrum, rules)
    material, cycles = rules.material, load_cycles(gears, load.spectrum)
    safe_flank = {name: _worst(material.flank_life, flank[name], cycles[name]) for name in GEARS}
    safe_root = {name: _worst(material.root_life, root[name], cycles[name]) for name in GEARS}
    return StageRating(safe_flank, safe_root, static_flank, static_root)


def pitting_budget(gears: PlanetarySet, face_width: float, load: StageLoad, rules: Rules) -> PittingBudget:
    """The pitting safety of the sun of one set, factor by factor; face_width [m]."""
    spectrum, mesh = load.spectrum, gears.sun_mesh
    speed = float(spectrum.share @ spectrum.speed)  # as many revolutions as the spectrum has
    steady = replace(spectrum, torque=np.array([spectrum.rms_torque]), share=np.ones(1), speed=np.array([speed]))
    safety, at_rms = (
        float(rate_stage(gears, face_width, replace(load, spectrum=one), rules).flank["sun"])
        for one in (spectrum, steady)
    )
    force, pinion_speed = sun_force(gears, spectrum.rms_torque), _pinion_speed(gears, mesh, speed)
    factors = load_factors(mesh, face_width, force, pinion_speed, rules.material.density, rules.quality)
    limit = permissible_contact_stress(mesh, rules.material, rules.oil, pitch_velocity(mesh, pinion_speed))
    loads, film = float(factors.contact**-0.5), float(limit / rules.material.contact_limit)
    return PittingBudget(at_rms / (loads * film), loads, film, safety / at_rms)


def static_ratings(
    gears: PlanetarySet, face_width: Batch, load: StageLoad, rules: Rules
) -> tuple[dict[str, Batch], dict[str, Batch]]:
    """(flank, root) safety factors, dimensionless, against the peak torque by gear, (batch).

    The film plays no part in the static strength of the flank: Z_L Z_V Z_R = 1 (ISO 6336-2).
    """
    material = rules.material
    contact_limit = material.contact_limit * material.flank_life.strength
    flank: dict[str, Batch] = {}
    root: dict[str, Batch] = {}
    for mesh, names in _meshes(gears):
        force = sun_force(gears, load.peak_torque)
        factors = load_factors(
            mesh, face_width, force, _pinion_speed(gears, mesh, load.peak_speed), material.density, rules.quality
        )
        stresses = _mesh_ratios(
            mesh, force, face_width, factors, material, contact_limit,
            lambda section: static_root_strength(section, material) * rules.alternating_static,
        )  # fmt: skip
        for k, name in enumerate(names):
            _keep_least(flank, name, 1 / stresses.contact[k])
            _keep_least(root, name, 1 / stresses.root[k])
    return flank, root


def survives(
    gears: PlanetarySet, face_width: Batch, load: StageLoad, rules: Rules, safety: tuple[float, float]
) -> np.ndarray:
    """Whether fatigue safety factors (flank, root) are reached, by Miner's sum below 1, (batch).

    safety: wanted of flank and root, dimensionless; face_width: [m]
    """
    flank, root = endurance_ratios(gears, face_width, load.spectrum, rules)
    cycles, passed = load_cycles(gears, load.spectrum), np.array(True)
    for ratios, line, wanted in (
        (flank, rules.material.flank_life, safety[0]),
        (root, rules.material.root_life, safety[1]),
    ):
        for name in GEARS:
            for ratio in ratios[name]:
                passed = passed & (miner_sum(line, ratio * wanted, cycles[name]) <= 1)
    return passed


def load_cycles(gears: PlanetarySet, spectrum: LoadSpectrum) -> dict[str, Batch]:
    """Number of load cycles of a tooth of each gear in each class over the life, (classes, ...), with eq. 3.123."""
    turns = {"sun": gears.ratio - 1, "planet": -gears.ring.teeth / gears.planet.teeth}
    turns["ring"] = np.ones_like(gears.ratio)
    contacts = {"sun": (gears.planets, 0.5), "planet": (1, 1.0), "ring": (gears.planets, 0.5)}
    revolutions = _over_classes(spectrum.revolutions, gears)
    return {
        name: revolutions * turns[name] * cycles_per_revolution(*contacts[name], spectrum.swing, turns[name])
        for name in GEARS
    }


def sun_force(gears: PlanetarySet, carrier_torque: Batch) -> Batch:
    """Tangential force at the reference circles [N]: T_c / (i N r_sun), the same in both meshes of a planet."""
    return carrier_torque / (gears.ratio * gears.planets * gears.sun.reference_radius)


def endurance_ratios(
    gears: PlanetarySet, face_width: Batch, spectrum: LoadSpectrum, rules: Rules
) -> tuple[dict[str, list[Batch]], dict[str, list[Batch]]]:
    """(flank, root): stress relative to the endurance limit by gear, a list for its meshes, each (classes, batch)."""
    torque, speed = (_over_classes(values, gears) for values in (spectrum.torque, spectrum.speed))
    flank: dict[str, list[Batch]] = {name: [] for name in GEARS}
    root: dict[str, list[Batch]] = {name: [] for name in GEARS}
    material, oil = rules.material, rules.oil
    for mesh, names in _meshes(gears):
        force, pinion_speed = sun_force(gears, torque), _pinion_speed(gears, mesh, speed)
        factors = load_factors(mesh, face_width, force, pinion_speed, material.density, rules.quality)
        stresses = _mesh_ratios(
            mesh, force, face_width, factors, material,
            permissible_contact_stress(mesh, material, oil, pitch_velocity(mesh, pinion_speed)),
            lambda section: permissible_root_stress(section, material, oil.root_roughness) * rules.alternating,
        )  # fmt: skip
        for k, name in enumerate(names):
            flank[name].append(stresses.contact[k])
            root[name].append(stresses.root[k])
    return flank, root


def _mesh_ratios(
    mesh: Mesh,
    force: Batch,
    face_width: Batch,
    factors: LoadFactors,
    material: GearMaterial,
    contact_limit: Batch,
    root_limit: Callable[[RootSection], Batch],
) -> _Stresses:
    """Stresses of pinion and wheel over a contact limit [Pa] and over ``root_limit(section)`` [Pa]."""
    nominal = contact_stress(mesh, force, face_width, material.elasticity_factor) * np.sqrt(factors.contact)
    contact = tuple(nominal * factor / contact_limit for factor in single_contact_factors(mesh))
    sections = _sections(mesh)
    root = (root_stress(section, force, face_width) * factors.root / root_limit(section) for section in sections)
    return _Stresses(contact, tuple(root))


def _sections(mesh: Mesh) -> list[RootSection]:
    return [
        root_section(gear, radius)
        for gear, radius in zip((mesh.pinion, mesh.wheel), outer_single_contact_radii(mesh), strict=True)
    ]


def _meshes(gears: PlanetarySet) -> tuple[tuple[Mesh, tuple[str, str]], tuple[Mesh, tuple[str, str]]]:
    return (gears.sun_mesh, ("sun", "planet")), (gears.ring_mesh, ("planet", "ring"))


def _pinion_speed(gears: PlanetarySet, mesh: Mesh, carrier_speed: Batch) -> Batch:
    """Speed of sun or planet relative to the carrier [rad/s]: z_ring / z_pinion times that of the carrier."""
    return carrier_speed * np.abs(gears.ring.teeth) / mesh.pinion.teeth


def _worst(line: LifeLine, ratios: list[Batch], cycles: Batch) -> Batch:
    return np.min([spectrum_safety(line, ratio, cycles) for ratio in ratios], axis=0)


def _keep_least(found: dict[str, Batch], name: str, value: Batch) -> None:
    found[name] = np.minimum(found[name], value) if name in found else value


def _over_classes(values: np.ndarray, gears: PlanetarySet) -> np.ndarray:
    """Batch of the classes, (classes,), as (classes, 1, ...) above the axes of a batch."""
    return np.reshape(values, (-1, *[1] * np.ndim(gears.centre_distance)))
