"""``airgap solve STUDY``: the field of one operating point."""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from math import sqrt

from figures.export import write_vtu
from figures.field_map import field_map
from figures.whole_field import whole_field
from magnetostatics.case import FamilyCase
from magnetostatics.flux_linkage import park, phase_flux_linkage
from magnetostatics.mesh_error import refined_solution, torque_error
from magnetostatics.model import FieldSolution, OperatingPoint
from magnetostatics.probes import probe_reader
from magnetostatics.torque import arkkio_torque, maxwell_torque
from pipeline.arguments import add_overrides, writable
from study.inputs_field import field_case
from study.operating_point import asked_point
from study.read import read_study
from study.schema import Study
from study.usable import check_mesh, check_steel
from units import AMPERE_PER_SQUARE_MILLIMETRE, DEGREE, SQUARE_MILLIMETRE


def add_solve(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap solve``."""
    parser.description = "Solve the field of one operating point; angles and signs as in README.md."
    parser.add_argument("study", help="name of a file in studies/ or a path")
    add_overrides(parser)
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
    parser.set_defaults(run=solve)


def solve(options: argparse.Namespace) -> None:
    """See the module's text."""
    study = read_study(options.study, options.set)
    asked = asked_point(options.angle_deg, _amplitude(options), options.current_angle_deg)
    check_steel(study)
    case = field_case(study)
    point = OperatingPoint(asked.angle, asked.amplitude, asked.current_angle, case.packing)
    solution = _field(study, case, point, options.sweep_mesh)
    result = _result(solution, point)
    _print(result, options.json)
    if options.vtu:
        write_vtu(writable(options.vtu), solution)
    if options.png:
        field_map(whole_field(solution)).savefig(writable(options.png), dpi=150)


def _field(study: Study, case: FamilyCase, point: OperatingPoint, sweep_mesh: bool) -> FieldSolution:
    machine = case.family.reference
    check_mesh(study, machine, case.density if sweep_mesh else case.detail)
    model = (case.model if sweep_mesh else case.detailed_model)(machine)
    return model.solve(point)


def _amplitude(options: argparse.Namespace) -> float:
    """Amplitude of the current density [A/mm2]; none stated means no current."""
    if options.j_rms is not None:
        return sqrt(2) * options.j_rms
    return options.j_amplitude or 0.0


@dataclass(frozen=True)
class _Result:
    """Everything a user may want to know of one solved state; the names are the keys of the JSON, with their units."""

    torque_per_length_Nm_per_m: dict[str, float]
    torque_error_Nm_per_m: float
    flux_linkage_Wb_per_turn_per_m: dict[str, float]
    flux_linkage_dq_Wb_per_turn_per_m: dict[str, float]
    probes_T: dict[str, float]
    operating_point: dict[str, float | dict[str, float]]
    half_slot_area_mm2: float
    sectors: int
    unknowns: int
    newton: dict[str, list[float]]
    cpu_seconds: float


def _result(solution: FieldSolution, point: OperatingPoint) -> _Result:
    model = solution.model
    section = model.section
    linkage = phase_flux_linkage(solution)
    dq = park(linkage, section.machine.pole_pairs * point.angle, section.layout.phase_axis)
    densities = point.phase_densities(section.machine.pole_pairs, section.layout.phase_axis)
    return _Result(
        torque_per_length_Nm_per_m={"arkkio": arkkio_torque(solution), "maxwell": maxwell_torque(solution)},
        torque_error_Nm_per_m=torque_error(solution, refined_solution(solution)),
        flux_linkage_Wb_per_turn_per_m=dict(zip("abc", linkage.tolist())),
        flux_linkage_dq_Wb_per_turn_per_m=dict(zip("dq", dq.tolist())),
        probes_T=probe_reader(model).read(solution),
        operating_point={
            "angle_deg": point.angle / DEGREE,
            "current_angle_deg": point.current_angle / DEGREE,
            "j_phase_A_per_mm2": dict(zip("abc", (densities / AMPERE_PER_SQUARE_MILLIMETRE).tolist())),
        },
        half_slot_area_mm2=section.half_slot_area / SQUARE_MILLIMETRE,
        sectors=section.sectors,
        unknowns=model.unknowns.count,
        newton={"residuals": list(solution.newton.residuals), "steps": list(solution.newton.steps)},
        cpu_seconds=solution.cpu_seconds,
    )


def _print(result: _Result, target: str | None) -> None:
    text = json.dumps(asdict(result), indent=2)
    if target == "-":
        print(text)
        return
    if target:
        writable(target).write_text(text + "\n", encoding="utf-8")
    torque = result.torque_per_length_Nm_per_m
    print(
        f"torque per length   {torque['arkkio']:.3f} ± {result.torque_error_Nm_per_m:.3f} Nm/m (ring average; ± bounds "
        f"the error of the mesh), {torque['maxwell']:.3f} Nm/m (mid-gap contour)"
    )
    linkage = result.flux_linkage_Wb_per_turn_per_m
    print(
        "flux linkage        " + ", ".join(f"{k} {1e3 * v:.4f}" for k, v in linkage.items()) + " mWb per turn and metre"
    )
    worst = sorted(result.probes_T.items(), key=lambda item: -item[1])[:3]
    print("highest probes      " + ", ".join(f"{name} {value:.3f} T" for name, value in worst))
    print(f"unknowns            {result.unknowns}, Newton iterations {len(result.newton['residuals'])}")
