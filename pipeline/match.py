"""Gearbox and motor matched over the stator radius, for every slot count, with the overload torque solved and scaled.

Reads the study, what the vehicle and the linkage feed it and ``fits.csv``; writes ``match.csv`` (one row per slot
count, overload torque and radius), ``match.json`` (the chosen machine in drawing units, why, what it violates, what the
stated requirements and linkage would give, and what the linear overload assumption would cost).
"""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from functools import partial

from pipeline.feeds import fed, stated
from pipeline.stage import Stage, StageError, command, results_folder
from study.read import read_study

TABLE, OUTPUT = "match.csv", "match.json"
_RADII = 46  # stator radii of the table and of the figures
OVERLOADS = {"field": "torque_overload_Nm_per_m", "linear": "torque_overload_linear_Nm_per_m"}


def stage_of(study) -> Stage:
    """The match of a study."""
    from pipeline.fits import OUTPUT as FITS
    from pipeline.models import FIELD_CODE, FIELD_SECTIONS
    from pipeline.sweep import steel_files

    folder = results_folder(study.study.id)
    used = ("requirements", "linkage", "match", "printed_machine", "winding_selection")
    values = fed(study).subset(*FIELD_SECTIONS, *used)
    values["stated"] = study.subset("requirements", "linkage")
    code = (*FIELD_CODE, "drivetrain", "electrical", "pipeline.feeds", "pipeline.fits", "pipeline.match")
    return Stage("match", folder, values, (folder / FITS, *steel_files(study)), code, (TABLE, OUTPUT))


@dataclass(frozen=True)
class Matcher:
    """Everything a match needs of a study, SI; demands: requirements, limits and copper loading."""

    study: object
    fits: dict
    gearbox: object
    scales: object
    weights: object
    demands: tuple

    @classmethod
    def of(cls, study) -> Matcher:
        """The matcher of a study whose fits are done."""
        from pipeline.fits import read_fits
        from study import convert

        return cls(
            study,
            read_fits(study),
            convert.to_gearbox_design(study),
            convert.to_cost_scales(study.match),
            convert.to_cost_weights(study.match),
            (
                convert.to_actuator_requirements(study.requirements),
                convert.to_match_limits(study.match),
                convert.to_copper_loading(study),
            ),
        )

    def section(self, slots: int, overload: str, radius: float):
        """``CrossSection`` from the fits at a stator radius [m]; overload "field" or "linear"."""
        from drivetrain.match import CrossSection
        from pipeline.models import StudyFamily, layout_of
        from units import MILLIMETRE, SQUARE_MILLIMETRE

        def fit(quantity):
            return float(self.fits[slots, quantity](radius / MILLIMETRE))

        machine = StudyFamily(self.study.machine).machine(
            slots, radius, fit("back_iron_width_mm") * MILLIMETRE, fit("rotor_outer_radius_mm") * MILLIMETRE
        )
        return CrossSection(
            slots=slots,
            coils_in_series=layout_of(self.study, slots).coils_in_series,
            stator_outer_radius=radius,
            rotor_outer_radius=machine.rotor_outer_radius,
            back_iron_width=machine.back_iron_width,
            tooth_width=machine.tooth_width,
            shoe_d1=machine.shoe_d1,
            shoe_d2=machine.shoe_d2,
            airgap=machine.airgap,
            half_slot_area=fit("half_slot_area_mm2") * SQUARE_MILLIMETRE,
            torque_per_length_nominal=fit("torque_nominal_Nm_per_m"),
            torque_per_length_overload=fit(OVERLOADS[overload]),
        )

    def reference_section(self, torque_nominal: float, torque_overload: float, half_slot_area: float):
        """``CrossSection`` of the study's own machine with given torques [Nm/m] and half-slot area [m^2]."""
        from drivetrain.match import CrossSection
        from pipeline.models import layout_of
        from study.convert import to_machine

        machine = to_machine(self.study.machine)
        shared = (
            "slots stator_outer_radius rotor_outer_radius back_iron_width tooth_width shoe_d1 shoe_d2 airgap".split()
        )
        return CrossSection(
            **{name: getattr(machine, name) for name in shared},
            coils_in_series=layout_of(self.study).coils_in_series,
            half_slot_area=half_slot_area,
            torque_per_length_nominal=torque_nominal,
            torque_per_length_overload=torque_overload,
        )

    def constraints(self, section):
        """Enforced and reported constraints as the study asks for them."""
        from drivetrain import match

        choose = match.damping_enforced if self.study.match.enforce_damping else match.damping_reported
        return choose(section, *self.demands)

    def over_radius(self, slots: int, overload: str):
        """``RadiusMatches`` over the range of the fits."""
        import numpy as np
        from drivetrain.match import match_over_radius
        from units import MILLIMETRE

        low, high = self.fits[slots, "torque_nominal_Nm_per_m"].x_range
        radii = np.linspace(low, high, _RADII) * MILLIMETRE
        return match_over_radius(
            partial(self.section, slots, overload),
            radii,
            constraints_of=self.constraints,
            gearbox=self.gearbox,
            scales=self.scales,
            weights=self.weights,
        )

    def curves(self, section, ratios):
        """``MatchCurves`` of one cross-section over transmission ratios [m/rad]."""
        from drivetrain.match import match_curves

        chosen = self.constraints(section)
        return match_curves(
            section, ratios, **vars(chosen), gearbox=self.gearbox, scales=self.scales, weights=self.weights
        )

    def all(self) -> dict:
        """``RadiusMatches`` by (slots, overload) for every slot count with usable fits."""
        return {
            (slots, overload): self.over_radius(slots, overload)
            for slots in self.study.sweep.slots
            for overload in OVERLOADS
        }

    def choose(self, results: dict) -> tuple[object, str]:
        """(match, reason): the study's choice of machine, or the least cost; with the overload torque the study names."""
        overload, wanted = self.study.match.overload_torque, self.study.match
        best = min(
            (results[slots, overload] for slots in self.study.sweep.slots), key=lambda result: result.best.cost.total
        )
        if wanted.chosen_slots is None and wanted.chosen_stator_diameter_mm is None:
            return best.best, "least cost over all radii and slot counts"
        chosen = self._wanted(overload, best.best.section)
        return chosen, self._compare(chosen, best)

    def _wanted(self, overload: str, least):
        from units import MILLIMETRE

        wanted = self.study.match
        slots = wanted.chosen_slots or least.slots
        if slots not in self.study.sweep.slots:
            raise StageError(
                f"match.chosen_slots = {slots} is not among sweep.slots {list(self.study.sweep.slots)}; add it there."
            )
        diameter = wanted.chosen_stator_diameter_mm
        return self.match_at(slots, overload, diameter / 2 * MILLIMETRE if diameter else least.stator_outer_radius)

    def match_at(self, slots: int, overload: str, radius: float):
        """``Match`` of one slot count and stator radius [m]."""
        return self.match_section(self.section(slots, overload, radius))

    def match_section(self, section):
        """``Match`` of one cross-section."""
        from drivetrain.match import match

        chosen = self.constraints(section)
        return match(section, **vars(chosen), gearbox=self.gearbox, scales=self.scales, weights=self.weights)

    def _compare(self, chosen, best) -> str:
        from units import MILLIMETRE

        least = best.best
        edge = f"; {best.at_edge}" if best.at_edge else ""
        return (
            f"chosen in the study file ({chosen.section.slots} slots, {2e3 * chosen.section.stator_outer_radius:g} "
            f"mm, cost {chosen.cost.total:.3f}); the least cost, {least.cost.total:.3f}, belongs to "
            f"{least.section.slots} slots and {2 * least.section.stator_outer_radius / MILLIMETRE:.1f} mm{edge}"
        )


def reference_matches(matcher: Matcher) -> dict:
    """Summaries of the machine of [machine], matched with its solved torques and, if stated, with somebody else's."""
    from drivetrain.match import linear_overload
    from units import SQUARE_MILLIMETRE

    study = matcher.study
    nominal, overload, area = _solved_reference(study)
    solved = matcher.match_section(matcher.reference_section(nominal, overload, area))
    found = {
        "field": summary(solved, "the study's machine with its torques from the field solution, mean over a period")
    }
    printed = study.printed_machine
    if printed is not None:
        sweep = study.sweep
        scaled = linear_overload(
            printed.torque_nominal_Nm_per_m, sweep.j_nominal_rms_A_per_mm2, sweep.j_overload_rms_A_per_mm2
        )
        area = printed.half_slot_area_mm2 * SQUARE_MILLIMETRE
        section = matcher.reference_section(printed.torque_nominal_Nm_per_m, scaled, area)
        reason = f"the study's machine with the torque stated by {printed.source}, scaled linearly to the overload"
        found["printed"] = summary(matcher.match_section(section), reason)
    return found


def _solved_reference(study) -> tuple[float, float, float]:
    """Mean torques at the nominal and the overload current density [Nm/m] and half-slot area [m^2] of [machine]."""
    from magnetostatics.per_turn import per_turn_values
    from pipeline.models import field_model, nominal_amplitude, overload_amplitude
    from study.convert import to_machine, to_mesh_density

    model = field_model(study, to_machine(study.machine), to_mesh_density(study.mesh))
    packing = study.winding.packing_factor
    nominal, overload = (per_turn_values(model, f(study), packing) for f in (nominal_amplitude, overload_amplitude))
    return nominal.torque, overload.torque, model.section.half_slot_area * model.section.half_slots_per_coil_side


def summary(chosen, reason: str) -> dict:
    """The chosen match in drawing units."""
    from units import MILLIMETRE, SQUARE_MILLIMETRE

    section, cost = chosen.section, chosen.cost
    return {
        "slots": section.slots,
        "stator_outer_radius_mm": section.stator_outer_radius / MILLIMETRE,
        "rotor_outer_radius_mm": section.rotor_outer_radius / MILLIMETRE,
        "back_iron_width_mm": section.back_iron_width / MILLIMETRE,
        "half_slot_area_mm2": section.half_slot_area / SQUARE_MILLIMETRE,
        "torque_nominal_Nm_per_m": section.torque_per_length_nominal,
        "torque_overload_Nm_per_m": section.torque_per_length_overload,
        "transmission_ratio_mm_per_rad": chosen.transmission_ratio / MILLIMETRE,
        "active_length_mm": chosen.active_length / MILLIMETRE,
        "cost": cost.total,
        "mass_kg": cost.mass,
        "equivalent_mass_kg": cost.equivalent_mass,
        "binding": chosen.binding.name,
        "at_bound": chosen.bound,
        "notes": list(chosen.notes),
        "reason": reason,
    }


def stated_match(matcher: Matcher, section) -> dict | None:
    """The chosen cross-section under the requirements and the linkage that the study states, or why it has no match."""
    from drivetrain.match import MatchError

    try:
        return summary(matcher.match_section(section), "the chosen cross-section, stated requirements and linkage")
    except MatchError as error:
        return {"refused": str(error)}


def _table(results: dict):
    import pandas as pd
    from figures.match import radius_table

    return pd.concat([radius_table(slots, overload, result) for (slots, overload), result in results.items()])


def main(name: str) -> None:
    """Match gearbox and motor of a study."""
    own = read_study(name)
    study, other = fed(own), stated(own)

    def work(run):
        from drivetrain.match import MatchError
        from optimisation.polynomial_fits import FitRefused

        matcher = Matcher.of(study)
        try:
            results = matcher.all()
            chosen, reason = matcher.choose(results)
        except (MatchError, FitRefused) as error:
            raise StageError(f"no match: {error}") from None
        outcome = {**summary(chosen, reason), "overload_torque": study.match.overload_torque}
        beside = matcher if other is None else Matcher.of(other)
        outcome["reference_machine"] = reference_matches(beside)
        outcome["stated_feed"] = None if other is None else stated_match(beside, chosen.section)
        for line in (reason, *chosen.notes):
            print(f"match: {line}")
        for name, found in outcome["reference_machine"].items():
            for note in found["notes"]:
                print(f"match: reference machine, {name}: {note}")
        run.write(TABLE, lambda path: _table(results).to_csv(path, index=False))
        run.write_text(OUTPUT, json.dumps(outcome, indent=2) + "\n")

    stage_of(own).run(work)


def read_match(study) -> dict:
    """The outcome of a finished stage."""
    return json.loads((results_folder(study.study.id) / OUTPUT).read_text(encoding="utf-8"))


if __name__ == "__main__":
    with command():
        main(sys.argv[1])
