"""A gearbox in drawing units, for tables and reports."""

from __future__ import annotations

from typing import Any

from gearbox.bodies import Body
from gearbox.efficiency import loss_factor
from gearbox.planetary_set import share_a_factor
from gearbox.rating import Rules, StageLoad, StageRating
from gearbox.train import GearTrain, Stage
from units import DEGREE, MILLIMETRE


def train_summary(train: GearTrain, load: StageLoad, rules: Rules) -> dict[str, Any]:
    """Numbers of a gearbox and, under "stages", of each stage with its safety factors."""
    pairs = zip(train.stages, train.rate(load, rules), train.bodies, strict=True)
    step_up, step_down = train.efficiency
    return {
        "ratio": float(train.ratio),
        "mass_kg": float(train.mass),
        "inertia_slow_shaft_kg_m2": float(train.inertia_at_slow_shaft),
        "inertia_fast_shaft_kg_m2": float(train.inertia_at_fast_shaft),
        "length_mm": float(train.length / MILLIMETRE),
        "efficiency_slow_drives_fast": step_up,
        "efficiency_fast_drives_slow": step_down,
        "stages": [_stage(number, *pair) for number, pair in enumerate(pairs, start=1)],
    }


def _stage(number: int, stage: Stage, rating: StageRating, bodies: tuple[Body, ...]) -> dict[str, Any]:
    gears = stage.gears
    shared = share_a_factor(*gears.teeth[:2]) or share_a_factor(*gears.teeth[1:])
    row = {"stage": number, "module_mm": float(gears.sun.module / MILLIMETRE), "ratio": float(gears.ratio)}
    row |= {"face_width_mm": float(stage.face_width / MILLIMETRE)}
    row |= {"centre_distance_mm": float(gears.centre_distance / MILLIMETRE)}
    row |= {"planet_gap_mm": float(gears.planet_gap / MILLIMETRE), "common_factor": bool(shared)}
    for name in ("sun", "planet", "ring"):
        gear = getattr(gears, name)
        row |= {f"teeth_{name}": round(float(gear.teeth)), f"profile_shift_{name}": float(gear.shift)}
        row |= {f"tip_diameter_{name}_mm": float(2 * gear.tip_radius / MILLIMETRE)}
        row |= {f"root_diameter_{name}_mm": float(2 * gear.root_radius / MILLIMETRE)}
    for name, mesh in (("sun_planet", gears.sun_mesh), ("planet_ring", gears.ring_mesh)):
        row |= {f"contact_ratio_{name}": float(mesh.contact_ratio), f"loss_factor_{name}": float(loss_factor(mesh))}
        row |= {f"working_pressure_angle_{name}_deg": float(mesh.working_pressure_angle / DEGREE)}
    for kind in ("flank", "root", "static_flank", "static_root"):
        row |= {f"safety_{kind}_{name}": float(value) for name, value in getattr(rating, kind).items()}
    row |= {f"mass_{body.name.replace(' ', '_')}_kg": float(body.count * body.mass) for body in bodies}
    return row
