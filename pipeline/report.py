"""One page that shows a study from its vehicle to the actuator and back to the vehicle, stage by stage.

Reads the results of all stages, writes ``report.html``: every figure, the key numbers, what was decided and why.
"""

from __future__ import annotations

import sys

from pipeline.feeds import fed
from pipeline.report_chain import ChainSections, chain_figures, chain_results
from pipeline.stage import Stage, command, results_folder
from study.read import read_study

OUTPUT = "report.html"


def stage_of(study) -> Stage:
    """The report of a study."""
    from pipeline import figures, fits, limits, match, optima, winding

    folder = results_folder(study.study.id)
    inputs = [
        optima.OUTPUT,
        limits.OUTPUT,
        fits.OUTPUT,
        match.OUTPUT,
        winding.TABLE,
        winding.OUTPUT,
        *figures.FILES.values(),
        *chain_results(study),
        *chain_figures(study).values(),
    ]
    code = ("figures.report", "pipeline.report", "pipeline.report_chain")
    return Stage(
        "report", folder, study.model_dump(mode="json"), tuple(folder / name for name in inputs), code, (OUTPUT,)
    )


class _Page:
    """The results of a study, and the sections made of them."""

    def __init__(self, study):
        import pandas as pd
        from pipeline import fits, limits, optima, winding
        from pipeline.match import read_match

        self.study, self.folder = study, results_folder(study.study.id)
        self.chain = ChainSections(study, fed(study))
        self.match, self.winding = read_match(study), winding.read_winding(study)
        self.optima, self.limits, self.fits, self.windings = (
            pd.read_csv(self.folder / name) for name in (optima.OUTPUT, limits.OUTPUT, fits.OUTPUT, winding.TABLE)
        )

    def picture(self, name: str, caption: str):
        """A figure of the figures stage."""
        from figures.report import Picture
        from pipeline.figures import FILES

        return Picture(self.folder / FILES[name], caption)

    def rotation(self, machine: str) -> dict[str, float]:
        """Mean and worst values of a machine over one electrical period."""
        import pandas as pd
        from pipeline.fields import ROTATIONS

        table = pd.read_csv(self.folder / ROTATIONS[machine]).iloc[:-1]  # the last row repeats the first
        torque, idle = table.torque_arkkio_Nm_per_m, table.torque_no_current_Nm_per_m
        apart = (table.torque_maxwell_Nm_per_m / torque - 1).abs().max()
        return {
            "mean": torque.mean(),
            "ripple": torque.max() - torque.min(),
            "cogging": idle.abs().max(),
            "apart": apart,
            "error": table.torque_error_Nm_per_m.max(),
        }

    # ---- sections, in reading order -------------------------------------------------------------------------------

    def machine(self):
        """The study's own machine and its field."""
        from figures.report import Section

        seen = self.rotation("reference")
        text = (
            f"The machine of the study file at the nominal current density: mean torque {seen['mean']:.2f} ± {seen['error']:.2f} Nm/m over "
            f"one electrical period (± bounds the error of the mesh) with the current on the q axis, ripple {seen['ripple']:.2f} Nm/m peak to peak, cogging up to "
            f"{seen['cogging']:.2f} Nm/m. The two torque routes differ by at most {seen['apart']:.2%}."
        )
        return Section(
            "Reference machine and its field",
            (
                self.picture(
                    "cross_section_reference", "Cross-section with winding, magnetisation and probe segments."
                ),
                self.picture(
                    "field_reference_nominal", "Flux density and flux lines in the null position, nominal current."
                ),
                text,
                self.picture("rotation_reference", "Torque, cogging and probes over one electrical period."),
            ),
        )

    def optimisation(self):
        """Sweep, feasible domain and refined optima."""
        from figures.report import Section, Table

        s = self.study
        shown = "slots stator_diameter_mm back_iron_width_mm rotor_outer_radius_mm half_slot_area_mm2 torque_nominal_Nm_per_m"
        shown += " torque_nominal_error_Nm_per_m torque_overload_Nm_per_m torque_overload_error_Nm_per_m torque_overload_linear_Nm_per_m limited_T tooth_worst_T"
        over = (self.optima.torque_overload_linear_Nm_per_m / self.optima.torque_overload_Nm_per_m - 1) * 100
        text = (
            f"Largest torque per metre with a flux density of at most {s.saturation.limit_T:g} T, read as {s.saturation.reading}: "
            f"{s.sweep.back_iron_steps} × {s.sweep.rotor_radius_steps} designs for every slot count and diameter, then refined "
            "with further field solutions until the limit is met to 0.02 %."
        )
        cost = (
            f"At the overload of {s.sweep.j_overload_rms_A_per_mm2:g} A/mm² RMS the field gives less than linear scaling from "
            f"{s.sweep.j_nominal_rms_A_per_mm2:g} A/mm² promises: the assumption is too high by {over.min():.0f} to {over.max():.0f} %."
        )
        reading = (
            "What the limit means decides about the optimum. The readings differ in which probes and which rotor angles count; "
            "points of this figure are read off a map by interpolation."
        )
        return Section(
            "Optimum cross-sections",
            (
                text,
                self.picture("design_map", "Torque and probe flux densities over back-iron width and rotor radius."),
                self.picture("design_maps", "The same for every stator diameter, as shares of the stator radius."),
                Table(
                    self.optima[shown.split()],
                    "Refined optima. Torque per metre of active length; flux densities are means over the probes.",
                ),
                cost,
                reading,
                self.picture("limits", "Optimum against the flux-density limit, for each reading of it."),
            ),
        )

    def polynomials(self):
        """Fits over the stator radius."""
        from figures.report import Section, Table

        from figures.report import heading

        columns = ["slots", "quantity", "p2", "p1", "p0", "r_squared", "rms_residual", "largest_residual"]
        shown = self.fits[columns].assign(quantity=self.fits.quantity.map(heading))
        caption = "y = p2 R² + p1 R + p0 with the stator radius R in mm and y in the unit of its name."
        table = Table(shown, caption, headings={"r_squared": "R²"})
        refused = [
            f"Refused: {row.quantity}, {row.slots} slots: {row.refused}"
            for row in self.fits.dropna(subset="refused").itertuples()
        ]
        picture = self.picture("fits", "Optima (points) and second-order polynomials (lines) over the stator radius.")
        return Section("Polynomials over the stator radius", (picture, table, *refused))

    def matching(self):
        """Gearbox and motor."""
        import pandas as pd
        from figures.report import Remark, Section, Table

        rows = {
            "chosen machine": self.match,
            "reference machine, field torque": self.match["reference_machine"]["field"],
        }
        if "printed" in self.match["reference_machine"]:
            rows[f"reference machine, torque stated by {self.study.printed_machine.source}"] = self.match[
                "reference_machine"
            ]["printed"]
        columns = "stator_outer_radius_mm torque_nominal_Nm_per_m torque_overload_Nm_per_m transmission_ratio_mm_per_rad active_length_mm cost mass_kg equivalent_mass_kg binding"
        frame = pd.DataFrame([{"machine": name, **{c: row[c] for c in columns.split()}} for name, row in rows.items()])
        notes = [Remark(f"{name}: {note}.") for name, row in rows.items() for note in row["notes"]]
        return Section(
            "Gearbox and motor matched",
            (
                self.picture(
                    "match_curves",
                    "Active length asked for by each constraint, and the cost, over the transmission ratio.",
                ),
                self.picture(
                    "match_over_radius",
                    "Best match over the stator radius; solid with solved, dashed with scaled overload torque.",
                ),
                f"Decision: {self.match['reason']}.",
                *self.chain.feeds(self.match),
                Table(frame, "The chosen machine beside the machine of the study file, which is matched as stated."),
                *notes,
                *self._assumption(),
            ),
        )

    def _assumption(self):
        found = self.match["reference_machine"]
        if "printed" not in found:
            return ()
        solved, stated = found["field"], found["printed"]
        return (
            f"With the torque solved at the overload, the reference machine needs {solved['active_length_mm']:.1f} mm; with the "
            f"stated torque scaled linearly {stated['active_length_mm']:.1f} mm seem to be enough.",
        )

    def wound(self):
        """Turns and wires."""
        from figures.report import Section, Table

        fullest = self.windings[self.windings.fullest].drop(columns=["fullest"])
        near = fullest[(fullest.turns - self.winding["chosen"]["turns"]).abs() <= 6].reset_index(drop=True)
        marked = tuple(near.index[near.chosen])
        caption = (
            "For each number of turns the most wires that fit; all pairs are in windings.csv. The chosen one is marked."
        )
        return Section(
            "Winding",
            (
                f"{self.winding['reason']} Decision: {self.winding['length']['reason']}",
                Table(near.drop(columns=["chosen"]), caption, marked=marked),
                self.picture("torque_speed", "Largest torque and power of neighbouring windings over the speed."),
                self.picture(
                    "force_velocity",
                    "Peak phase voltage and current at the wheel, up to the largest speed of the study.",
                ),
            ),
        )

    def matched(self):
        """The matched machine solved again."""
        from figures.report import Section

        seen, nominal = self.rotation("matched"), self.match["torque_nominal_Nm_per_m"]
        text = (
            f"The machine that the polynomials lead to, meshed and solved again: mean torque {seen['mean']:.2f} ± {seen['error']:.2f} Nm/m on the q axis "
            f"(the fit, in the state of the reading: {nominal:.2f} Nm/m), cogging up to {seen['cogging']:.2f} Nm/m."
        )
        return Section(
            "The matched machine",
            (
                text,
                self.picture("cross_section_matched", "Cross-section of the matched machine."),
                self.picture("field_matched_nominal", "Flux density at the nominal current."),
                self.picture("field_matched_overload", "Flux density at the overload current: the teeth saturate."),
                self.picture("rotation_matched", "Torque, cogging and probes over one electrical period."),
            ),
        )

    def sections(self) -> tuple:
        """All sections in reading order."""
        chain = self.chain
        all_of_them = (
            chain.result(),
            chain.requirements(),
            chain.linkage(),
            self.machine(),
            self.optimisation(),
            self.polynomials(),
            self.matching(),
            self.matched(),
            chain.gearbox(),
            self.wound(),
            chain.drive(),
            chain.ride(),
        )
        return tuple(section for section in all_of_them if section is not None)


def main(name: str) -> None:
    """Write the report of a study."""
    study = read_study(name)

    def work(run):
        from figures.report import write_report
        from pipeline.stage import git_commit, package_versions

        sections = _Page(study).sections()
        provenance = {"study": study.path.name, "commit": git_commit() or "unknown", **package_versions()}
        title, subtitle = study.study.title, "From the vehicle to a sized actuator, and back to the vehicle"
        run.write(
            OUTPUT, lambda path: write_report(path, sections, title=title, subtitle=subtitle, provenance=provenance)
        )
        print(f"report: {results_folder(study.study.id) / OUTPUT}")

    stage_of(study).run(work)


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
