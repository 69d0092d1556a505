"""The command ``airgap``."""

from __future__ import annotations

import argparse
import json
import sys
from math import sqrt
from pathlib import Path

from pipeline.workbench_commands import add_commands
from study.errors import StudyError, exit_on_wrong_study


def main(arguments: list[str] | None = None) -> None:
    """Entry of the console script. Exit codes: 0 done, 2 wrong input, 1 the field did not converge."""
    options = _parser().parse_args(arguments)
    with exit_on_wrong_study():
        options.run(options)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="airgap", description="Design electric machines, test the design, meet the bench.")
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    _add_solve(commands.add_parser("solve", help="solve the field of one operating point"))
    _add_check(commands.add_parser("check", help="is a study file usable?"))
    add_commands(commands)
    return parser


def _add_check(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("study", help="name of a file in studies/ or a path")
    _add_overrides(parser)
    parser.set_defaults(run=_check)


def _add_solve(parser: argparse.ArgumentParser) -> None:
    parser.description = "Solve the field of one operating point; angles and signs as in README.md."
    parser.add_argument("study", help="name of a file in studies/ or a path")
    _add_overrides(parser)
    parser.add_argument("--angle-deg", type=float, default=0.0, help="mechanical rotor angle; 0: magnet 0 on tooth 0")
    density = parser.add_mutually_exclusive_group()
    density.add_argument("--j-amplitude", type=float, help="amplitude of the current density in the copper / A/mm2")
    density.add_argument("--j-rms", type=float, help="RMS current density in the copper / A/mm2")
    parser.add_argument(
        "--current-angle-deg", type=float, default=0.0, help="electrical, from the q axis; > 0 weakens the field"
    )
    parser.add_argument("--json", metavar="FILE", help="write the result as JSON; - for standard output")
    parser.add_argument("--vtu", metavar="FILE", help="write the field for ParaView or pyvista")
    parser.add_argument("--png", metavar="FILE", help="write a picture of the field")
    parser.add_argument(
        "--sweep-mesh", action="store_true", help="use the mesh of the sweep instead of twice its resolution"
    )
    parser.set_defaults(run=_solve)


def _add_overrides(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="SECTION.KEY=VALUE",
        help="replace a value of the study; repeatable",
    )


def _check(options) -> None:
    from study.check import summary
    from study.read import read_study
    from study.usable import check_study

    study = read_study(options.study, options.set)
    check_study(study)
    print(summary(study))


def _solve(options) -> None:
    from study.operating_point import asked_point
    from study.read import read_study
    from study.usable import check_steel

    study = read_study(options.study, options.set)
    asked = asked_point(options.angle_deg, _amplitude(options), options.current_angle_deg)
    check_steel(study)
    solution = _field(study, asked, options.sweep_mesh)
    result = _result(solution)
    _print(result, options.json)
    if options.vtu:
        from figures.export import write_vtu

        write_vtu(_writable(options.vtu), solution)
    if options.png:
        from figures.field_map import field_map
        from figures.whole_field import whole_field

        field_map(whole_field(solution)).savefig(_writable(options.png), dpi=150)


def _field(study, asked, sweep_mesh: bool):
    from magnetostatics.model import OperatingPoint
    from pipeline.models import detail_density, field_model
    from study.inputs_machine import machine_family
    from study.usable import check_mesh, mesh_density

    density = mesh_density(study) if sweep_mesh else detail_density(study)
    machine = machine_family(study.machine).reference
    check_mesh(study, machine, density)
    point = OperatingPoint(asked.angle, asked.amplitude, asked.current_angle, study.winding.packing_factor)
    return field_model(study, machine, density).solve(point)


def _amplitude(options) -> float:
    """Amplitude of the current density [A/mm2]; none stated means no current."""
    if options.j_rms is not None:
        return sqrt(2) * options.j_rms
    return options.j_amplitude or 0.0


def _result(solution) -> dict:
    """Everything a user may want to know of one solved state, units in the keys."""
    from magnetostatics.flux_linkage import park, phase_flux_linkage
    from magnetostatics.mesh_error import refined_solution, torque_error
    from magnetostatics.probes import probe_reader
    from magnetostatics.torque import arkkio_torque, maxwell_torque
    from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, SQUARE_MILLIMETRE

    model, point = solution.model, solution.point
    section = model.section
    linkage = phase_flux_linkage(solution)
    dq = park(linkage, section.machine.pole_pairs * point.angle, section.layout.phase_axis)
    densities = point.phase_densities(section.machine.pole_pairs, section.layout.phase_axis)
    return {
        "torque_per_length_Nm_per_m": {"arkkio": arkkio_torque(solution), "maxwell": maxwell_torque(solution)},
        "torque_error_Nm_per_m": torque_error(solution, refined_solution(solution)),
        "flux_linkage_Wb_per_turn_per_m": dict(zip("abc", linkage.tolist())),
        "flux_linkage_dq_Wb_per_turn_per_m": dict(zip("dq", dq.tolist())),
        "probes_T": probe_reader(model).read(solution),
        "operating_point": {
            "angle_deg": point.angle / DEGREE,
            "current_angle_deg": point.current_angle / DEGREE,
            "j_phase_A_per_mm2": dict(zip("abc", (densities / AMPERE_PER_SQUARE_MILLIMETRE).tolist())),
        },
        "half_slot_area_mm2": section.half_slot_area / SQUARE_MILLIMETRE,
        "sectors": section.sectors,
        "unknowns": model.unknowns.count,
        "newton": {"residuals": list(solution.newton.residuals), "steps": list(solution.newton.steps)},
        "cpu_seconds": solution.cpu_seconds,
    }


def _print(result: dict, target: str | None) -> None:
    text = json.dumps(result, indent=2)
    if target == "-":
        print(text)
        return
    if target:
        _writable(target).write_text(text + "\n", encoding="utf-8")
    torque = result["torque_per_length_Nm_per_m"]
    print(
        f"torque per length   {torque['arkkio']:.3f} ± {result['torque_error_Nm_per_m']:.3f} Nm/m (ring average; ± bounds the "
        f"error of the mesh), {torque['maxwell']:.3f} Nm/m (mid-gap contour)"
    )
    linkage = result["flux_linkage_Wb_per_turn_per_m"]
    print(
        "flux linkage        " + ", ".join(f"{k} {1e3 * v:.4f}" for k, v in linkage.items()) + " mWb per turn and metre"
    )
    worst = sorted(result["probes_T"].items(), key=lambda item: -item[1])[:3]
    print("highest probes      " + ", ".join(f"{name} {value:.3f} T" for name, value in worst))
    print(f"unknowns            {result['unknowns']}, Newton iterations {len(result['newton']['residuals'])}")


def _writable(target: str) -> Path:
    path = Path(target)
    if not path.resolve().parent.is_dir():
        raise StudyError(f"cannot write {target}: the folder {path.parent} does not exist; create it first.")
    return path


if __name__ == "__main__":
    sys.exit(main())
