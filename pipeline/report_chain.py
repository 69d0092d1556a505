"""Sections of the report on the stages around the machine: requirements, linkage, drive, gearbox, outcome."""

from __future__ import annotations

from pipeline.feeds import read_result
from pipeline.stage import results_folder
from study.chain import drives, searches_linkage


def chain_figures(study) -> dict[str, str]:
    """Files of all figures that these sections show, by name."""
    from pipeline import drive, gearbox, linkage, outcome, requirements

    return (
        requirements.figures_of(study)
        | linkage.figures_of(study)
        | drive.FIGURES
        | gearbox.FIGURES
        | outcome.figures_of(study)
    )


def chain_results(study) -> list[str]:
    """Files that these sections read."""
    from pipeline import drive, flux_map, gearbox, linkage, outcome, requirements

    names = [flux_map.OUTPUT, drive.OUTPUT, drive.WINDINGS, gearbox.OUTPUT, gearbox.SETS, outcome.OUTPUT]
    names += [requirements.OUTPUT] if drives(study) else []
    names += [linkage.OUTPUT] if searches_linkage(study) else []
    return names


class ChainSections:
    """The sections of a study; fed: the study with what the stages found in the place of what it states."""

    def __init__(self, study, fed):
        self.study, self.fed = study, fed
        self.folder, self.figures = results_folder(study.study.id), chain_figures(study)
        self.outcome = read_result(study, "outcome.json")

    def picture(self, name: str, caption: str):
        """A figure of one of the stages."""
        from figures.report import Picture

        return Picture(self.folder / self.figures[name], caption)

    # ---- requirements -----------------------------------------------------------------------------------------------

    def requirements(self):
        """What the actuator must do, and which scenario asks for it."""
        from figures.report import Section, Table, heading

        values = self.fed.requirements.model_dump()
        rows = [{"requirement": heading(key), "value": value} for key, value in values.items()]
        if not drives(self.study):
            return Section("Requirements", ("As stated in the study file.", Table(_frame(rows), "At the wheel.")))
        found, given = read_result(self.study, "requirements.json"), self.study.requirements
        for row, key in zip(rows, values, strict=True):
            row |= {"stated": getattr(given, key)} if given is not None else {}
            row["set by"] = found["scenarios"][key]
        return Section(
            "Requirements from the vehicle",
            (
                self._runs_text(found),
                self.picture("ride_road", "The random road with each damping strategy."),
                Table(_frame(found["ride"]), "The random road, means over the seeds."),
                *self._obstacles(),
                self.picture("ride_worst", "The case that sets the peak force."),
                self.picture("ride_points", "Its working points; the damper curve of each strategy is seen."),
                Table(_frame(rows), "What the actuator is asked for at the wheel, magnitudes."),
                *([self.picture("requirements", "Against the values that the study states.")] if given else []),
                self._requirements_decision(),
            ),
        )

    def _runs_text(self, found: dict) -> str:
        runs, modes = found["runs"], ", ".join(f"{f:.2f}" for f in found["natural_frequencies_Hz"])
        over = f" and {runs['overload']} over obstacles and manoeuvres" if runs["overload"] else ""
        return (
            f"{runs['road']} runs on the random road{over}, each with maximum, minimum and mixed damping, none above "
            f"the regenerative damping of {self.study.ride.maximum_regenerative_damping_kNs_per_m:g} kNs/m. Undamped "
            f"natural frequencies of the vehicle: {modes} Hz. The energy balance of every run closes to "
            f"{100 * found['largest_energy_error']:.2f} %. The RMS values are those of the damping with "
            f"the largest RMS force; the peaks come from {found['peaks_from']}."
        )

    def _obstacles(self) -> tuple:
        if self.study.obstacles is None:
            return ()
        return (self.picture("ride_obstacles", "Peaks over speed and amplitude of the obstacle."),)

    def _requirements_decision(self) -> str:
        if self.study.requirements is None:
            return "Decision: these values feed the match; the study states none of its own."
        return "Decision: these values feed the match; what the stated ones would give is shown beside it."

    # ---- linkage ----------------------------------------------------------------------------------------------------

    def linkage(self):
        """The linkage that is built."""
        from figures.report import Section

        linkage = self.fed.linkage
        if not searches_linkage(self.study):
            text = (
                f"Stated in the study file: {linkage.ratio_nominal_mm_per_rad:g} mm/rad in the nominal position, "
                f"{linkage.ratio_max_mm_per_rad:g} mm/rad at most."
            )
            return Section("Linkage", (text,))
        found = read_result(self.study, "linkage.json")
        return Section(
            "Linkage",
            (
                f"{found['points']} linkages of the Pareto front, {len(self.study.linkage_search.seeds)} seeds merged "
                "and sharpened.",
                self.picture("linkage_front", "The front, the choice, and where its hardpoints lie in their boxes."),
                f"Decision: {found['reason']}.",
                *self._linkages(found),
                self.picture("linkage_motion", "Ratio and transmission angles over the wheel travel."),
                self.picture("linkage_view", "Side view over the wheel travel."),
            ),
        )

    def _linkages(self, found: dict) -> tuple:
        from figures.report import Table

        stated, window = found["stated"], self.study.linkage_search.angle_window_deg
        rows = [_linkage_row("chosen", found["chosen"], window)]
        rows += [_linkage_row("stated in the study", stated, window)] if stated is not None else []
        table = Table(_frame(rows), "Linkages over the wheel travel; margin: of the angles to their limits.")
        if stated is None or not stated["dominated"]:
            return (table,)
        level = stated.get("ratio_at_same_angles_mm_per_rad")
        ratio = "" if level is None else (
            f"at its angles the front has {level:.1f} instead of {stated['ratio_nominal_mm_per_rad']:.1f} mm/rad, "
        )  # fmt: skip
        text = (
            f"The stated linkage is dominated: {ratio}at its ratio an angle objective of "
            f"{stated['second_at_same_first']:.3f} instead of {stated['objectives'][1]:.3f} rad²."
        )
        return (table, text)

    # ---- feeds ------------------------------------------------------------------------------------------------------

    def feeds(self, match: dict) -> tuple:
        """The match with both feeds beside each other."""
        from figures.report import Remark, Table

        other = match.get("stated_feed")
        if other is None:
            return ()
        if "refused" in other:
            return (Remark(f"With the stated requirements and linkage there is no match: {other['refused']}"),)
        columns = "transmission_ratio_mm_per_rad active_length_mm cost mass_kg equivalent_mass_kg binding".split()
        rows = [
            {"fed by": name, **{c: one[c] for c in columns}}
            for name, one in (("vehicle and front", match), ("stated values", other))
        ]
        notes = [Remark(f"With the stated values: {note}.") for note in other["notes"]]
        return (Table(_frame(rows), "The chosen cross-section, matched with either feed."), *notes)

    # ---- drive ------------------------------------------------------------------------------------------------------

    def drive(self):
        """The wound machine on its flux map."""
        import pandas as pd
        from figures.report import Section, Table
        from pipeline import flux_map

        found, table = read_result(self.study, "drive.json"), pd.read_csv(self.folder / "windings_field.csv")
        best = read_result(self.study, flux_map.OUTPUT)["field"]
        text = (
            f"At full current the flux map gives {best['mtpa_torque_Nm']:.3f} ± {best['mtpa_torque_error_Nm']:.3f} Nm "
            "(± bounds the error of the mesh). "
            f"With saturation in every number the chosen winding has a base speed of {found['base_speed_rpm']:.0f} "
            f"rpm and {found['power_at_base_speed_W']:.0f} W there; constant parameters say "
            f"{100 * found['base_speed_difference']:+.1f} % in base speed, "
            f"{100 * found['peak_torque_difference']:+.1f} % in peak torque and "
            f"{100 * found['maximum_power_difference']:+.1f} % in largest power. Decision: {found['comparison']}."
        )
        shown = table.drop(columns=["chosen"])
        return Section(
            "The wound machine on its flux map",
            (
                text,
                self.picture("flux_map", "Flux linkages over the currents, with MTPA, MTPV and the envelope."),
                self.picture("field_envelope", "Torque and power over speed: flux map against constant parameters."),
                Table(shown, "Neighbouring windings by both models.", marked=tuple(table.index[table.chosen])),
                self.picture("force_velocity_field", "Peak phase voltage and current at the wheel, from the flux map."),
            ),
        )

    # ---- gearbox ----------------------------------------------------------------------------------------------------

    def gearbox(self):
        """Teeth, strength, mass."""
        import pandas as pd
        from figures.report import Section, Table

        found, sets = read_result(self.study, "gearbox.json"), pd.read_csv(self.folder / "gearbox_sets.csv")
        load, chosen = found["load"], found["chosen"]
        text = (
            f"Loads at the slow shaft: {load['torque_peak_Nm']:.0f} Nm peak, {load['torque_rms_Nm']:.1f} Nm RMS in "
            f"{load['classes']} classes over {self.study.gearbox.life_h:g} h, turning by at most "
            f"{load['swing_deg']:.1f} degrees between reversals. {found['sets_formed']} sets of teeth and profile "
            f"shifts were formed for a ratio of {found['requested_ratio']:.2f}; {found['sets_that_fit']} "
            f"({found['tooth_triples_that_fit']} different tooth numbers) can be made and "
            f"assembled. Steel: {found['steel']}."
        )
        decision = (
            f"Decision: least cost in mass and inertia, {chosen['mass_kg']:.2f} kg and "
            f"{chosen['equivalent_mass_kg']:.2f} kg at the wheel, {100 * chosen['efficiency_slow_drives_fast']:.1f} % "
            f"efficiency of the meshes. Overall ratio {found['transmission_ratio_mm_per_rad']:.3f} mm/rad."
        )
        return Section(
            "Planetary gearbox",
            (
                text,
                self.picture("load_spectrum", "Torque classes on the road; the sun of stage 1 on its S-N lines."),
                decision,
                *self._weakness(found),
                self.picture("gear_end_view", "Stage 1 along its axis."),
                Table(_frame(_stages(found)), "The chosen gears and, where there are any, those of the study file."),
                self.picture("gear_safety", "Safety factors; lines: what is wanted, dotted where only reported."),
                Table(_frame(_budgets(found)), _BUDGET),
                Table(sets, "The best sets of teeth, smallest safety factors of all gears and stages.", marked=(0,)),
            ),
        )

    def _weakness(self, found: dict) -> tuple:
        from figures.report import Remark

        if found["weakness"] is None:
            return ()
        return (Remark(f"The wanted safety factors are out of reach, the nearest is shown: {found['weakness']}."),)

    # ---- outcome ----------------------------------------------------------------------------------------------------

    def result(self):
        """The actuator on one screen, and which requirements hold."""
        from figures.report import KeyNumber, KeyNumbers, Remark, Section, Table

        rows = self.outcome["features"]
        named = [(row["feature"].partition(" / "), row["ours"]) for row in rows]
        numbers = tuple(KeyNumber(name, float(f"{ours:.4g}"), unit.strip("()")) for (name, _, unit), ours in named)
        failing = [row for row in self.outcome["requirements"] if not row["holds"]]
        remarks = [Remark(_failure(row)) for row in failing]
        held = len(self.outcome["requirements"]) - len(failing)
        source = self.study.printed_actuator.source if self.study.printed_actuator is not None else "stated"
        return Section(
            "Outcome",
            (
                KeyNumbers(numbers),
                f"{held} of {len(self.outcome['requirements'])} requirements hold.",
                *remarks,
                Table(_checks(self.outcome["requirements"]), "What is asked and what is reached, at the wheel."),
                *self._remedy_table(),
                Table(_frame(rows), "Features of the actuator.", headings={"stated": source}),
                self.picture("axial_section", "Axial section with the envelope."),
            ),
        )

    def _remedy_table(self) -> tuple:
        from figures.report import Table

        rows = self.outcome["remedies"]
        if not rows:
            return ()
        caption = (
            "Which input would make a failing requirement hold, moved alone; a dash: not within a third to three "
            "times its value. Fewer turns at the same copper mean more current in the same proportion."
        )
        return (Table(_frame(rows), caption),)

    def ride(self):
        """The vehicle with the designed actuator; None where no vehicle is run."""
        from figures.report import Section, Table

        if not self.outcome["ride"]:
            return None
        ideal, designed = self.outcome["worst"]
        held = designed["time_saturated_ms"]
        limit = f"its limit holds it back for {held:.0f} ms" if held >= 1 else "its limit is not reached"
        text = (
            f"The designed actuator in the vehicle: its force-speed limit, {designed_mass(self.outcome):.1f} kg of "
            f"equivalent inertia and {self.study.assembly.viscous_friction_Ns_per_m:g} Ns/m of friction in the place "
            f"of the ideal one. In the worst case ({self.outcome['worst_case']}) {limit}; the largest force of the "
            f"machine is {designed['force_peak_N']:.0f} instead of {ideal['force_peak_N']:.0f} N, the largest tyre "
            f"load {designed['tyre_load_max_N']:.0f} instead of {ideal['tyre_load_max_N']:.0f} N."
        )
        return Section(
            "The vehicle with the designed actuator",
            (
                text,
                self.picture("outcome_points", "Working points of the worst case with the limit of the actuator."),
                self.picture("outcome_histories", "The worst case with the ideal and with the designed actuator."),
                Table(_frame(self.outcome["worst"]), "The worst case."),
                Table(_frame(self.outcome["ride"]), "The random road, means over the seeds."),
            ),
        )


def designed_mass(outcome: dict) -> float:
    """Equivalent inertia of the designed actuator [kg]."""
    return next(row["ours"] for row in outcome["features"] if row["feature"].startswith("equivalent inertia"))


def _frame(rows: list[dict]):
    import pandas as pd

    return pd.DataFrame(rows)


def _linkage_row(name: str, one: dict, window: float) -> dict:
    numbers = ("ratio_nominal_mm_per_rad", "ratio_min_mm_per_rad", "ratio_max_mm_per_rad", "link_ab_length_mm",
               "link_bc_length_mm")  # fmt: skip
    row = {"linkage": name, **{key: one[key] for key in numbers}}
    for angle in ("gamma", "lambda"):
        row |= {f"{angle}_min_deg": one[f"{angle}_deg"][0], f"{angle}_max_deg": one[f"{angle}_deg"][1]}
    angles = (*one["gamma_deg"], *one["lambda_deg"])
    return {**row, "margin_deg": window - max(abs(angle - 90) for angle in angles)}


def _stages(found: dict) -> list[dict]:
    rows = []
    for name in ("chosen", "stated"):
        for stage in found[name]["stages"] if found[name] is not None else ():
            keys = ["module_mm", "teeth_sun", "teeth_planet", "teeth_ring", "face_width_mm"]
            keys += [f"contact_ratio_{mesh}" for mesh in ("sun_planet", "planet_ring")]
            keys += [f"profile_shift_{gear}" for gear in ("sun", "planet", "ring")]
            rows.append({"gears": f"{name}, stage {stage['stage']}", **{key: stage[key] for key in keys}})
    return rows


_BUDGET = (
    "Pitting safety of the sun of stage 1, factor by factor: of the RMS torque all the time with every other factor at "
    "one, what the load factors, the oil film and the spectrum take, and their product."
)


def _budgets(found: dict) -> list[dict]:
    names = {"bare": "RMS torque alone", "loads": "load factors", "film": "oil film", "spectrum": "spectrum"}
    return [
        {"gears": gears, **{said: found[gears]["pitting_budget"][key] for key, said in names.items()},
         "safety": found[gears]["pitting_budget"]["safety"]}
        for gears in ("chosen", "stated") if found[gears] is not None
    ]  # fmt: skip


def _checks(rows: list[dict]):
    table = _frame(rows)
    return table.assign(holds=["yes" if holds else "NO" for holds in table.holds])


def _failure(row: dict) -> str:
    return (
        f"{row['requirement']} does not hold: {row['reached']:.4g} {row['unit']} reached, {row['sense']} "
        f"{row['needed']:.4g} {row['unit']} asked ({row['margin_percent']:.0f} %)."
    )
