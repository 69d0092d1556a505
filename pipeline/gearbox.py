"""Gears of the planetary stages: search over all tooth sets, rated under the loads of the vehicle (thesis Table 3.11).

Reads the study, ``match.json`` and the histories on the random road; writes ``gearbox.json`` (the choice with its
safety factors, mass, inertia and efficiency, and the stated gear set rated in the same way), ``gearbox_sets.csv`` (the
best sets) and figures.
"""

from __future__ import annotations

import json
import sys

from pipeline.feeds import fed, read_result
from pipeline.stage import Stage, StageError, command, results_folder
from study.chain import drives
from study.read import read_study

OUTPUT, SETS = "gearbox.json", "gearbox_sets.csv"
FIGURES = {
    "gear_end_view": "figures/gear_end_view.png",
    "load_spectrum": "figures/load_spectrum.png",
    "gear_safety": "figures/gear_safety.png",
}
_KEPT = 12  # sets of the table


def stage_of(study) -> Stage:
    """The gearbox of a study."""
    from pipeline.match import OUTPUT as MATCH
    from pipeline.requirements import HISTORIES

    folder = results_folder(study.study.id)
    values = fed(study).subset("chain", "requirements", "linkage", "match", "gearbox")
    files = (folder / MATCH, *([folder / HISTORIES] if drives(study) else []))
    code = ("units", "gearbox", "figures.style", "figures.gearbox", "study.convert_gearbox", "pipeline.gearbox")
    return Stage("gearbox", folder, values, files, code, (OUTPUT, SETS, *FIGURES.values()))


def load_of(study):
    """``StageLoad`` at the slow shaft, with the largest linkage ratio, where torques are largest (3.121-3.122).

    study: fed. The spectrum is that of the random road with the damping that sets the RMS force; without a vehicle a
    normal distribution with the stated RMS values stands in.
    """
    from gearbox.rating import StageLoad
    from units import MILLIMETRE

    ratio, required = study.linkage.ratio_max_mm_per_rad * MILLIMETRE, study.requirements
    spectrum = _road_spectrum(study, ratio) if drives(study) else _normal_spectrum(study, ratio)
    return StageLoad(spectrum, required.force_peak_N * ratio, required.velocity_at_force_peak_m_per_s / ratio)


def _road_spectrum(study, ratio: float):
    import xarray as xr
    from gearbox.spectrum import largest_swing, spectrum_from_history
    from pipeline.requirements import HISTORIES
    from study.convert_gearbox import life
    from units import MILLIMETRE

    nominal = study.linkage.ratio_nominal_mm_per_rad * MILLIMETRE
    with xr.open_dataset(results_folder(study.study.id) / HISTORIES) as data:
        force, velocity, stroke = (data[name].values for name in ("force_N", "velocity_m_per_s", "stroke_m"))
    return spectrum_from_history(
        force.ravel() * ratio,
        velocity.ravel() / ratio,
        class_width=study.gearbox.torque_class_Nm,
        duration=life(study.gearbox),
        swing=max(largest_swing(one / nominal) for one in stroke),
    )


def _normal_spectrum(study, ratio: float):
    from gearbox.spectrum import gaussian_spectrum
    from study.convert_gearbox import life
    from units import DEGREE

    section, required = study.gearbox, study.requirements
    return gaussian_spectrum(
        required.force_rms_N * ratio,
        required.velocity_rms_m_per_s / ratio,
        class_width=section.torque_class_Nm,
        duration=life(section),
        swing=section.swing_deg * DEGREE,
    )


def request_of(study, load):
    """``GearRequest``: the ratio of the match with the largest linkage ratio, inside the stator's diameter."""
    from pipeline.match import read_match
    from study.convert_gearbox import to_gear_request
    from units import MILLIMETRE

    found = read_match(study)
    ratio = study.linkage.ratio_max_mm_per_rad / found["transmission_ratio_mm_per_rad"]
    return to_gear_request(
        study, load, ratio=ratio, envelope_diameter=2 * found["stator_outer_radius_mm"] * MILLIMETRE
    )


def printed_train(study, request):
    """The gear set that the study states, as a ``GearTrain`` of the same construction; None where it states none."""
    from study.convert_gearbox import to_printed_gears
    from units import MILLIMETRE

    gears, widths = to_printed_gears(study.gearbox), study.gearbox.printed_face_widths_mm
    if gears is None or widths is None:
        return None
    return request.train(gears, [width * MILLIMETRE for width in widths])


def sets_table(found, load, rules):
    """The best sets in drawing units."""
    import pandas as pd
    from gearbox.summary import train_summary

    rows = []
    for train, cost, shared in zip(found.trains, found.costs, found.shared, strict=True):
        one = train_summary(train, load, rules)
        first = one["stages"][0]
        least = {kind: min(rating.least[kind] for rating in train.rate(load, rules)) for kind in _KINDS}
        rows.append(
            {
                "module_mm": first["module_mm"],
                **{f"teeth_{name}": first[f"teeth_{name}"] for name in ("sun", "planet", "ring")},
                "ratio": one["ratio"],
                "face_widths_mm": ", ".join(f"{stage['face_width_mm']:g}" for stage in one["stages"]),
                "mass_kg": one["mass_kg"],
                "inertia_slow_shaft_kg_m2": one["inertia_slow_shaft_kg_m2"],
                **{f"safety_{kind}": float(value) for kind, value in least.items()},
                "common_factor": bool(shared),
                "cost": cost,
            }
        )
    return pd.DataFrame(rows)


_KINDS = ("flank", "root", "static_flank", "static_root")


def described(train, load, rules, linkage_ratio: float) -> dict:
    """``train_summary`` with the inertia at the wheel, for a linkage ratio [m/rad], and the budget of the first sun."""
    from dataclasses import asdict

    from gearbox.rating import pitting_budget
    from gearbox.summary import train_summary

    found, first = train_summary(train, load, rules), train.stages[0]
    budget = pitting_budget(first.gears, first.face_width, load, rules)
    found["pitting_budget"] = {**asdict(budget), "safety": budget.safety}
    return {**found, "equivalent_mass_kg": found["inertia_slow_shaft_kg_m2"] / linkage_ratio**2}


def _draw(best, printed, load, request):
    """Yield (name, Figure)."""
    from dataclasses import asdict

    from figures import gearbox as draw
    from gearbox.outline import stage_outlines
    from units import MILLIMETRE

    gears = best.stages[0].gears
    title = f"stage 1, module {gears.sun.module / MILLIMETRE:g} mm"
    yield "gear_end_view", draw.gear_end_view(
        stage_outlines(gears), gears, envelope_diameter=best.envelope_diameter, title=title
    )
    yield "load_spectrum", draw.load_spectrum(load.spectrum, _life_lines(best, load, request.rules))
    trains = {"found": best.rate(load, request.rules)}
    trains |= {"stated": printed.rate(load, request.rules)} if printed is not None else {}
    yield "gear_safety", draw.safety_factors(trains, asdict(request.safety))


def _life_lines(train, load, rules):
    """Flank and root of the sun of stage 1 on their S-N lines."""
    from gearbox.rating import endurance_ratios, load_cycles

    stage = train.stages[0]
    flank, root = endurance_ratios(stage.gears, stage.face_width, load.spectrum, rules)
    cycles = load_cycles(stage.gears, load.spectrum)["sun"]
    material = rules.material
    return [
        ("sun, flank", material.flank_life, flank["sun"][0], cycles),
        ("sun, root", material.root_life, root["sun"][0], cycles),
    ]


def safety_checks(train, load, request) -> list[dict]:
    """Wanted and smallest reached safety factor of each kind that is asked for."""
    from dataclasses import asdict

    ratings = train.rate(load, request.rules)
    wanted = {kind: value for kind, value in asdict(request.safety).items() if value > 0}
    reached = {kind: min(float(rating.least[kind]) for rating in ratings) for kind in wanted}
    return [{"kind": kind, "wanted": wanted[kind], "reached": reached[kind]} for kind in wanted]


def _outcome(study, found, weakness, printed, load, request) -> dict:
    from units import DEGREE, MILLIMETRE

    ratio, rules = study.linkage.ratio_nominal_mm_per_rad * MILLIMETRE, request.rules
    chosen = described(found.best, load, rules, ratio)
    return {
        "chosen": chosen,
        "transmission_ratio_mm_per_rad": study.linkage.ratio_nominal_mm_per_rad / chosen["ratio"],
        "cost": found.costs[0],
        "weakness": weakness,
        "safety": safety_checks(found.best, load, request),
        "requested_ratio": request.ratio,
        "sets_formed": found.sets_formed,
        "sets_that_fit": found.sets_that_fit,
        "tooth_triples_that_fit": found.tooth_triples_that_fit,
        "stated": None if printed is None else described(printed, load, rules, ratio),
        "load": {
            "torque_rms_Nm": load.spectrum.rms_torque,
            "torque_peak_Nm": load.peak_torque,
            "swing_deg": load.spectrum.swing / DEGREE,
            "classes": len(load.spectrum.torque),
        },
        "steel": rules.material.name,
    }


def chosen_train(study):
    """(``GearTrain``, ``GearTrain`` stated or None, load, request) of a finished stage; study: fed."""
    from gearbox.planetary_set import planetary_set
    from units import MILLIMETRE

    load = load_of(study)
    request, stages = request_of(study, load), read_result(study, OUTPUT)["chosen"]["stages"]
    first = stages[0]
    teeth = (first["teeth_sun"], first["teeth_planet"], -abs(first["teeth_ring"]))
    shifts = (first["profile_shift_sun"], first["profile_shift_planet"])
    gears = planetary_set(teeth, shifts, first["module_mm"] * MILLIMETRE, planets=study.gearbox.planets)
    train = request.train(gears, [stage["face_width_mm"] * MILLIMETRE for stage in stages])
    return train, printed_train(study, request), load, request


def read_ratio(study) -> float:
    """Transmission ratio tau_t in the nominal position [m/rad] of a finished stage, with the teeth as they are."""
    from units import MILLIMETRE

    return read_result(study, OUTPUT)["transmission_ratio_mm_per_rad"] * MILLIMETRE


def main(name: str) -> None:
    """Search the gears of a study."""
    own = read_study(name)
    study = fed(own)

    def work(run):
        from figures.style import save_png
        from gearbox.errors import GearError
        from gearbox.search import strongest

        try:
            load = load_of(study)
            request = request_of(study, load)
            (found, weakness), printed = strongest(request, _KEPT), printed_train(study, request)
        except GearError as error:
            raise StageError(f"no gearbox: {error}") from None
        outcome = _outcome(study, found, weakness, printed, load, request)
        if weakness is not None:
            print(f"gearbox: below the wanted safety: {weakness}")
        first = outcome["chosen"]["stages"][0]
        teeth = ", ".join(str(first[f"teeth_{gear}"]) for gear in ("sun", "planet", "ring"))
        print(
            f"gearbox: module {first['module_mm']:g} mm, teeth {teeth}, ratio {outcome['chosen']['ratio']:.2f}, "
            f"the best of {outcome['sets_that_fit']} sets that fit"
        )
        table = sets_table(found, load, request.rules)
        run.note(sets_formed=found.sets_formed, sets_that_fit=found.sets_that_fit)
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")
        run.write(SETS, lambda path: table.to_csv(path, index=False))
        for figure_name, figure in _draw(found.best, printed, load, request):
            run.write(FIGURES[figure_name], lambda path, figure=figure: save_png(figure, path))

    stage_of(own).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
