"""``airgap take-over STUDY --design N``: a study of a design that the search over all stages has found."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from disk import write_atomically
from drivetrain.linkage_choice import BestAngles
from drivetrain.linkage_stage import LinkageFront
from drivetrain.whole_design import WholeDesign
from drivetrain.whole_search import WholeSearch
from pipeline.artefacts import artefact
from pipeline.results import Results, results_of
from report.optimise import solved_table
from study.chain import searches_linkage
from study.edit import Setting, with_settings
from study.errors import StudyError
from study.inputs_drive import output
from study.read import read_study
from study.schema import Study
from study.usable import check_study
from units import MILLIMETRE

_SAME = 1e-6  # relative; a linkage ratio closer to that of the study is that of the study
_COLUMNS = ("number", "design", "slots", "poles", "stator_diameter_mm", "active_length_mm", "constraint_excess_percent")


def add_take_over(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap take-over``."""
    parser.add_argument("study", help="name of a file in studies/ or a path; its stage optimise must have been run")
    parser.add_argument("--design", type=int, metavar="N", help="number in optimise.csv; without it they are listed")
    parser.add_argument("--out", metavar="FILE", help="to write; default <study>_<N>.toml beside the study")
    parser.add_argument("--results", metavar="DIR", help="of the search; default results/<study>/")
    parser.set_defaults(run=take_over)


def take_over(options: argparse.Namespace) -> None:
    """Write the study of a design, or list the designs; a file that exists is left alone."""
    study = read_study(options.study)
    results = results_of(study) if options.results is None else Results(Path(options.results))
    found: WholeSearch = artefact(study, results, "optimise")
    if options.design is None:
        print(solved_table(found, output(study))[list(_COLUMNS)].to_string(index=False))
        return
    taken = taken_design(study, results, found, options.design)
    path = Path(options.out) if options.out else study.path.with_name(f"{taken.id}.toml")
    write_study(path, taken)
    print(f"wrote {path}: `airgap run {path}` makes everything of design {taken.number}")


@dataclass(frozen=True)
class TakenDesign:
    """A design as a study.

    number: in optimise.csv; gear_ratio: linkage ratio over transmission ratio; on_ends: of what could be chosen
    linkage_limit: largest nominal ratio that the linkage may have [m/rad], None where it stays the study's
    """

    study: Study
    number: int
    name: str
    design: WholeDesign
    gear_ratio: float
    linkage_limit: float | None
    on_ends: tuple[str, ...]

    @property
    def id(self) -> str:
        """Name of the new study."""
        return f"{self.study.study.id}_{self.number}"

    @property
    def settings(self) -> dict[str, dict[str, Setting]]:
        """What the new study states otherwise, by section and key."""
        one, old = self.design, self.study.study
        chosen: dict[str, Setting] = {
            "chosen_slots": one.combination.slots,
            "chosen_poles": one.combination.poles,
            "chosen_stator_diameter_mm": 2 * one.stator_outer_radius / MILLIMETRE,
            "chosen_active_length_mm": one.active_length / MILLIMETRE,
            "enforce_damping": True,  # the search asks for the damping of every design
        }
        if self.study.match.gearbox_stages:
            chosen["chosen_gear_ratio"] = self.gear_ratio
        found: dict[str, dict[str, Setting]] = {
            "study": {"id": self.id, "title": f"{old.title}, design {self.number}"},
            "match": chosen,
        }
        if self.linkage_limit is not None:
            limit = self.linkage_limit / MILLIMETRE
            found["linkage_search"] = {"choice": "best_angles", "ratio_max_mm_per_rad": limit}
        return found

    @property
    def text(self) -> str:
        """The new study file."""
        old = self.study.path.read_text(encoding="utf-8")
        return self._header() + with_settings(old, self.settings, f"design {self.number}")

    def _header(self) -> str:
        ends = "".join(f"# It lies on {words}.\n" for words in self.on_ends)
        return (
            f"# Design {self.number} ({self.name}) of the search over all stages,\n"
            f"# taken over by `airgap take-over {self.study.path.stem} --design {self.number}`.\n"
            f'# The lines that end with "design {self.number}" are its own; the match goes on with it,\n'
            "# and turns, wires, teeth and the final length are chosen for it as for any other.\n"
            f"{ends}\n"
        )


def taken_design(study: Study, results: Results, found: WholeSearch, number: int) -> TakenDesign:
    """A design of the search by its number. Raises StudyError where there is none of that number."""
    if not 1 <= number <= len(found.solved):
        raise StudyError(f"--design {number} is not there: optimise.csv has the designs 1 to {len(found.solved)}.")
    design = found.solved[number - 1].model.design
    names = solved_table(found, output(study)).design
    limit, linkage_ratio = _linkage(study, results, design)
    return TakenDesign(
        study=study,
        number=number,
        name=str(names[number - 1]),
        design=design,
        gear_ratio=linkage_ratio / design.transmission_ratio,
        linkage_limit=limit,
        on_ends=found.choices.hits(design),
    )


def _linkage(study: Study, results: Results, design: WholeDesign) -> tuple[float | None, float]:
    """(largest ratio that the choice of the linkage may have, ratio that it then has) [m/rad].

    The front has single points: of those up to the ratio of the design the one with the best angles is built.
    """
    if not searches_linkage(study):
        return None, design.linkage_ratio
    linkages: LinkageFront = artefact(study, results, "linkage")
    own = linkages.built.ratio_nominal
    if abs(design.linkage_ratio / own - 1) < _SAME:
        return None, own
    limit = design.linkage_ratio * (1 + _SAME)
    return limit, float(linkages.nominal_ratios[BestAngles(limit).pick(linkages.front)])


def write_study(path: Path, taken: TakenDesign) -> None:
    """Write the study file. Raises StudyError where it is there already, or would not be usable."""
    if path.exists():
        raise StudyError(f"{path} exists already; it is not overwritten, name another file with --out.")
    try:
        write_atomically(path, _writer(taken.text))
    except OSError as error:
        raise StudyError(f"{path} cannot be written ({error.strerror or error}).") from None
    check_study(read_study(path))


def _writer(text: str) -> Any:
    return lambda path: path.write_text(text, encoding="utf-8")
