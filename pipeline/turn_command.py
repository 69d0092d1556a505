"""``airgap turn MACHINE``: a machine of any kind turned at one current."""

from __future__ import annotations

import argparse
import csv
from collections.abc import Iterator
from math import pi
from pathlib import Path

import numpy as np
from tqdm import tqdm

from figures.field_map import field_map
from figures.whole_field import whole_field
from geometry.cross_section import mesh_cross_section
from geometry.errors import GeometryError
from magnetostatics.model import FieldModel
from magnetostatics.turn import Supply, Turned, turned
from pipeline.arguments import finite, writable
from study.errors import StudyError
from study.machine_file import MachineFile, read_machine
from units import DEGREE

COLUMNS = ("angle_deg", "i_a_A", "i_b_A", "i_c_A", "torque_Nm", "torque_by_fluxes_Nm", "psi_a_Wb", "psi_b_Wb",
           "psi_c_Wb", "psi_d_Wb", "psi_q_Wb")  # fmt: skip
FEWEST = 12  # positions of a period that tell its fundamental from the orders 5 and 7


def add_turn(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap turn``."""
    parser.description = (
        "Turn a machine at one current: torque and flux linkages of its stack. Angle 0: pole 0 on the axis of tooth 0."
    )
    parser.add_argument("machine", help="name of a file in machines/ or a path")
    parser.add_argument("--current-A", type=float, default=0.0, help="amplitude of the phase current")
    parser.add_argument("--current-angle-deg", type=float, default=0.0, help="electrical, from the q axis")
    parser.add_argument("--start-deg", type=float, default=0.0, help="first rotor angle, mechanical")
    parser.add_argument("--span-deg", type=float, help="of all positions, mechanical; default: an electrical period")
    parser.add_argument("--positions", type=int, default=60, help="evenly over the span, its end left out")
    parser.add_argument("--csv", metavar="FILE", help="write a row for every position")
    parser.add_argument("--png", metavar="FILE", help="write a picture of the field at the first position")
    parser.set_defaults(run=turn)


def turn(options: argparse.Namespace) -> None:
    """See the module's text."""
    read = read_machine(options.machine)
    angles = _angles(options, read.machine.pole_pairs)
    supply = Supply(
        finite("--current-A", options.current_A), finite("--current-angle-deg", options.current_angle_deg) * DEGREE,
        read.equivalent_turns,
    )  # fmt: skip
    model = _model(options.machine, read)
    found = turned(model, supply, read.active_length, tqdm(angles, unit="position", disable=None))
    _print(read, found, options.span_deg is None and options.positions >= FEWEST)
    if options.csv:
        _write(writable(options.csv), found)
    if options.png:
        field_map(whole_field(model.solve(supply.at(angles[0], model)))).savefig(writable(options.png), dpi=150)


def _angles(options: argparse.Namespace, pole_pairs: int) -> np.ndarray:
    if options.positions < 1:
        raise StudyError(f"--positions must be 1 or more, found {options.positions}.")
    span = 2 * pi / pole_pairs if options.span_deg is None else finite("--span-deg", options.span_deg) * DEGREE
    start = finite("--start-deg", options.start_deg) * DEGREE
    return start + span * np.arange(options.positions) / options.positions


def _model(name: str, read: MachineFile) -> FieldModel:
    try:
        return FieldModel(mesh_cross_section(read.machine, read.layout, read.density), read.materials)
    except GeometryError as error:
        raise StudyError(f"{name}: {error}.") from error


def _print(read: MachineFile, found: Turned, is_period: bool) -> None:
    for line in _lines(read, found, is_period):
        print(line)


def _lines(read: MachineFile, found: Turned, is_period: bool) -> Iterator[str]:
    ring, fluxes = found.torque.mean(axis=0)
    yield read.title
    yield f"torque, mean        {ring:.6g} Nm (ring average), {fluxes:.6g} Nm (consistent fluxes)"
    yield f"torque, peak to peak {found.ripple:.6g} Nm over {len(found.angle)} positions"
    d, q = found.dq_linkage.mean(axis=0)
    yield f"flux linkage, mean  d {1e3 * d:.6g} mWb, q {1e3 * q:.6g} mWb"
    if is_period:
        yield f"fundamental of a phase {1e3 * found.fundamental:.6g} mWb"


def _write(path: Path, found: Turned) -> None:
    rows = np.column_stack([found.angle / DEGREE, found.currents, found.torque, found.linkage, found.dq_linkage])
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows([f"{value:.9g}" for value in row] for row in rows)
