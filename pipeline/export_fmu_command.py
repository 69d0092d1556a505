"""``airgap export-fmu STUDY``: the actuator of a study as a unit for other simulation tools."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from actuator.model import Actuator
from actuator.terminals import Terminals
from disk import write_atomically
from export.fmu import write_fmu
from pipeline.artefacts import artefact
from pipeline.results import Results, results_of
from study.chain import drives
from study.errors import StudyError
from study.read import read_study
from study.schema import Study
from vehicle.designed import designed_terminals
from vehicle.energy_stage import EnergyOutcome


def add_export_fmu(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap export-fmu``."""
    parser.add_argument("study", help="name of a file in studies/ or a path; its stage energy must have been run")
    parser.add_argument("--out", metavar="FILE.fmu", help="to write; default <study>_actuator.fmu in this folder")
    parser.add_argument("--results", metavar="DIR", help="of the design; default results/<study>/")
    parser.set_defaults(run=export_fmu)


def export_fmu(options: argparse.Namespace) -> None:
    """Write the unit; a file that exists is left alone."""
    study = read_study(options.study)
    results = results_of(study) if options.results is None else Results(Path(options.results))
    path = Path(options.out or f"{study.study.id}_actuator.fmu")
    if path.exists():
        raise StudyError(f"{path}: exists already; it is not overwritten, name another file with --out.")
    actuator, terminals = designed_unit(study, results)
    write_atomically(path, partial(write_fmu, actuator=actuator, terminals=terminals))
    print(f"wrote {path}: velocity [m/s] and force_demand [N] in, force and electrical quantities out")


def designed_unit(study: Study, results: Results) -> tuple[Actuator, Terminals]:
    """The actuator of a study that has been run. Raises StudyError where it has none, or no result of it."""
    if not drives(study):
        raise StudyError(
            f"{study.path.name}: an actuator is exported where a vehicle is driven, here none is; "
            'set chain.requirements = "vehicle".'
        )
    energy: EnergyOutcome = artefact(study, results, "energy")
    winding, flux_map = (artefact(study, results, name) for name in ("winding", "flux_map"))
    return energy.own.actuator, designed_terminals(winding, flux_map)
