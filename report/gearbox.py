"""The gearbox for people: tables in drawing units, figures, and its section of the report."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from drivetrain.output import Output
from figures.files import File, figure_file, picture_name, table_file
from figures.gearbox import gear_end_view, load_spectrum, safety_factors
from figures.report import Picture, Remark, Section, Table
from gearbox.efficiency import loss_factor
from gearbox.material import LifeLine
from gearbox.outline import stage_outlines
from gearbox.planetary_set import share_a_factor
from gearbox.rating import GEARS, StageRating, endurance_ratios, load_cycles, pitting_budget
from gearbox.search import Safety
from gearbox.stage import GearboxOutcome, GearSearch, RatedSet
from gearbox.train import GearTrain
from units import DEGREE, FACTORS, MILLIMETRE, written

SETS, GEARS_TABLE = "gearbox_sets.csv", "gears.csv"
HOUR = FACTORS["h"]
_KINDS = tuple(Safety.__dataclass_fields__)
_BUDGET = (
    "Pitting safety of the sun of stage 1, factor by factor: of the RMS torque all the time with every other factor at "
    "one, what the load factors, the oil film and the spectrum take, and their product."
)
_SHOWN = ("module_mm", "teeth_sun", "teeth_planet", "teeth_ring", "face_width_mm", "contact_ratio_sun_planet",
          "contact_ratio_planet_ring", "profile_shift_sun", "profile_shift_planet", "profile_shift_ring")  # fmt: skip


# ---- files ----------------------------------------------------------------------------------------------------------


def files(found: GearboxOutcome) -> Iterator[File]:
    """The best sets, every number of the chosen gears, and figures; nothing for a direct drive."""
    if found.search is None:
        return
    yield table_file(SETS, sets_table(found.search))
    yield table_file(GEARS_TABLE, gears_table(found.search))
    for name, figure in _drawn(found.search):
        yield figure_file(name, figure)


def sets_table(search: GearSearch) -> pd.DataFrame:
    """The best sets of teeth with their smallest safety factors, one a row."""
    return pd.DataFrame([_set_row(one) for one in search.best])


def _set_row(one: RatedSet) -> dict[str, object]:
    train = one.train
    gears = train.stages[0].gears
    teeth = zip(GEARS, gears.teeth, strict=True)
    return {
        "module_mm": gears.sun.module / MILLIMETRE,
        **{f"teeth_{name}": round(count) for name, count in teeth},
        "ratio": train.ratio,
        "face_widths_mm": ", ".join(f"{stage.face_width / MILLIMETRE:g}" for stage in train.stages),
        "mass_kg": train.mass,
        "inertia_slow_shaft_kg_m2": train.inertia_at_slow_shaft,
        **{f"safety_{kind}": getattr(one, kind) for kind in _KINDS},
        "common_factor": one.common_factor,
        "cost": one.cost,
    }


def gears_table(search: GearSearch) -> pd.DataFrame:
    """Every stage of the chosen and of the stated gears with its teeth, safety factors and masses."""
    return pd.DataFrame([row for name, train in _trains(search).items() for row in _stage_rows(name, train, search)])


def _trains(search: GearSearch) -> dict[str, GearTrain]:
    trains = {"chosen": search.best[0].train}
    return trains if search.stated is None else {**trains, "stated": search.stated}


def _stage_rows(name: str, train: GearTrain, search: GearSearch) -> list[dict[str, object]]:
    ratings = train.rate(search.load, search.rules)
    return [
        {"gears": f"{name}, stage {k + 1}", **_teeth_row(train, k), **_safety_row(ratings[k]), **_mass_row(train, k)}
        for k in range(len(train.stages))
    ]


def _teeth_row(train: GearTrain, number: int) -> dict[str, object]:
    stage = train.stages[number]
    gears = stage.gears
    sun, planet, ring = gears.teeth
    row: dict[str, object] = {
        "module_mm": gears.sun.module / MILLIMETRE,
        "ratio": gears.ratio,
        "face_width_mm": stage.face_width / MILLIMETRE,
        "centre_distance_mm": gears.centre_distance / MILLIMETRE,
        "planet_gap_mm": gears.planet_gap / MILLIMETRE,
        "common_factor": bool(share_a_factor(sun, planet) or share_a_factor(planet, ring)),
    }
    for name in GEARS:
        gear = getattr(gears, name)
        row |= {f"teeth_{name}": round(float(gear.teeth)), f"profile_shift_{name}": float(gear.shift)}
        row |= {f"tip_diameter_{name}_mm": 2 * gear.tip_radius / MILLIMETRE}
        row |= {f"root_diameter_{name}_mm": 2 * gear.root_radius / MILLIMETRE}
    for name, mesh in (("sun_planet", gears.sun_mesh), ("planet_ring", gears.ring_mesh)):
        row |= {f"contact_ratio_{name}": float(mesh.contact_ratio), f"loss_factor_{name}": float(loss_factor(mesh))}
        row |= {f"working_pressure_angle_{name}_deg": float(mesh.working_pressure_angle / DEGREE)}
    return row


def _safety_row(rating: StageRating) -> dict[str, float]:
    return {f"safety_{kind}_{gear}": float(value) for kind in _KINDS for gear, value in getattr(rating, kind).items()}


def _mass_row(train: GearTrain, number: int) -> dict[str, float]:
    return {f"mass_{body.name.replace(' ', '_')}_kg": float(body.count * body.mass) for body in train.bodies[number]}


def _drawn(search: GearSearch) -> Iterator[tuple[str, Figure]]:
    best = search.best[0].train
    gears = best.stages[0].gears
    title = f"stage 1, module {gears.sun.module / MILLIMETRE:g} mm"
    outlines = stage_outlines(gears)
    yield "gear_end_view", gear_end_view(outlines, gears, envelope_diameter=best.envelope_diameter, title=title)
    yield "load_spectrum", load_spectrum(search.load.spectrum, _life_lines(best, search))
    ratings = {name: train.rate(search.load, search.rules) for name, train in _trains(search).items()}
    yield "gear_safety", safety_factors(ratings, asdict(search.safety))


def _life_lines(train: GearTrain, search: GearSearch) -> list[tuple[str, LifeLine, np.ndarray, np.ndarray]]:
    """Flank and root of the sun of stage 1 on their S-N lines."""
    stage, spectrum, material = train.stages[0], search.load.spectrum, search.rules.material
    flank, root = endurance_ratios(stage.gears, stage.face_width, spectrum, search.rules)
    cycles = load_cycles(stage.gears, spectrum)["sun"]
    return [
        ("sun, flank", material.flank_life, flank["sun"][0], cycles),
        ("sun, root", material.root_life, root["sun"][0], cycles),
    ]


def remarks(found: GearboxOutcome) -> Iterator[str]:
    """What the run says at once: the teeth, and what is too weak."""
    if found.search is None:
        return
    if found.search.weakness is not None:
        yield f"below the wanted safety: {found.search.weakness}"
    gears = found.search.best[0].train.stages[0].gears
    teeth = ", ".join(f"{round(count)}" for count in gears.teeth)
    yield (
        f"module {gears.sun.module / MILLIMETRE:g} mm, teeth {teeth}, ratio {found.train.ratio:.2f}, the best of "
        f"{found.search.sets_that_fit} sets that fit"
    )


# ---- section --------------------------------------------------------------------------------------------------------


def section(found: GearboxOutcome, output: Output) -> Section:
    """Teeth, strength, mass; a sentence for a direct drive."""
    if found.search is None:
        return Section("Transmission", ("A direct drive: the rotor sits on the shaft, without gears.",))
    return Section("Planetary gearbox", _searched(found, found.search, output))


def _searched(found: GearboxOutcome, search: GearSearch, output: Output) -> tuple[str | Table | Picture | Remark, ...]:
    return (
        _loads_text(search),
        Picture(picture_name("load_spectrum"), "Torque classes; the sun of stage 1 on its S-N lines."),
        _decision(found, output),
        *_weakness(search),
        Picture(picture_name("gear_end_view"), "Stage 1 along its axis."),
        Table(
            gears_table(search)[["gears", *_SHOWN]],
            "The chosen gears and, where there are any, those of the study file; internal teeth, those of a ring, "
            "count negative.",
        ),
        Picture(picture_name("gear_safety"), "Safety factors; lines: what is wanted, dotted where only reported."),
        Table(_budgets(search), _BUDGET),
        Table(
            sets_table(search), "The best sets of teeth, smallest safety factors of all gears and stages.", marked=(0,)
        ),
    )


def _loads_text(search: GearSearch) -> str:
    load = search.load
    swing = load.spectrum.swing
    turning = f"turning by at most {swing / DEGREE:.1f} degrees between reversals" if np.isfinite(swing) else (
        "turning on without reversals"
    )  # fmt: skip
    return (
        f"Loads at the slow shaft: {load.peak_torque:.0f} Nm peak, {load.spectrum.rms_torque:.1f} Nm RMS in "
        f"{len(load.spectrum.torque)} classes over {load.spectrum.duration / HOUR:g} h, {turning}. "
        f"{search.sets_formed} sets of teeth and profile shifts were formed for a ratio of "
        f"{search.requested_ratio:.2f}; {search.sets_that_fit} ({search.tooth_triples_that_fit} different tooth "
        f"numbers) can be made and assembled. Steel: {search.rules.material.name}."
    )


def _decision(found: GearboxOutcome, output: Output) -> str:
    step_up, _ = found.train.efficiency
    seen = f"{found.equivalent_mass / FACTORS[output.inertia_unit]:.3g} {written(output.inertia_unit)} {output.place}"
    return (
        f"Decision: least cost in mass and inertia, {found.train.mass:.2f} kg and {seen}, "
        f"{100 * step_up:.1f} % efficiency of the meshes. {output.overall_ratio(found.transmission_ratio)}."
    )


def _weakness(search: GearSearch) -> tuple[Remark, ...]:
    if search.weakness is None:
        return ()
    said = "The wanted safety factors are out of reach; shown is the least cost at a share of them"
    return (Remark(f"{said}: {search.weakness}."),)


def _budgets(search: GearSearch) -> pd.DataFrame:
    rows = []
    for name, train in _trains(search).items():
        first = train.stages[0]
        budget = pitting_budget(first.gears, first.face_width, search.load, search.rules)
        rows.append({"gears": name, "RMS torque alone": budget.bare, "load factors": budget.loads,
                     "oil film": budget.film, "spectrum": budget.spectrum, "safety": budget.safety})  # fmt: skip
    return pd.DataFrame(rows)
