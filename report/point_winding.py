"""The winding of a drawn machine for people: what the points refuse, the best of each kind, and the chosen one."""

from __future__ import annotations

from collections.abc import Iterator
from math import sqrt

import numpy as np
import pandas as pd

from electrical.dq import DriveLimits, Envelope, torque_speed_envelope
from electrical.driven_machine import BegunMachine
from electrical.point_field import FieldPoint, FieldPoints
from electrical.point_winding_stage import Candidates, PointWinding, wound_as
from electrical.point_windings import (
    AS_LITTLE_LOSS,
    Candidate,
    OperatingPoint,
    best_of_each_kind,
    competitors,
    counts,
    needed_density,
    verdict,
)
from figures.files import File, figure_file, picture_name, table_file
from figures.report import KeyNumber, KeyNumbers, Part, Picture, Section, Table
from figures.winding import RequiredPoint, torque_speed
from magnetostatics.flux_map_stage import FluxMap
from report.winding import ALTERNATIVES, TABLE, design_row
from units import AMPERE_PER_SQUARE_MILLIMETRE, MILLIMETRE, RPM, SQUARE_MILLIMETRE, drawn, percent

ENVELOPES, POINTS = "torque_speed", "operating_points.csv"
_SHOWN = 4  # turns either side of the chosen winding in the table
_DRAWN = 1  # and in the figure
_SPEEDS = 121
_FILL = ("packing", "insulated_fill", "current_peak_A", "base_speed_rpm", "peak_torque_Nm")


def candidates_files(candidates: Candidates) -> Iterator[File]:
    """Every full slot with what it gives and what stands against it."""
    yield table_file(TABLE, candidates_table(candidates, candidates.valued, None))


def candidates_remarks(candidates: Candidates) -> Iterator[str]:
    """What the run says at once."""
    yield " ".join(_counted(candidates))


def winding_files(
    found: PointWinding, candidates: Candidates, begun: BegunMachine, flux_map: FluxMap
) -> Iterator[File]:
    """The best of each gauge and connection, and torque over speed of the chosen one and its neighbours."""
    kinds = best_of_each_kind(candidates.valued, candidates.inputs.points)
    yield table_file(ALTERNATIVES, candidates_table(candidates, kinds, found.chosen))
    required = tuple(RequiredPoint(str(one), one.speed, one.torque) for one in candidates.inputs.points)
    shown = {_name(one): _envelope(one, found, begun, flux_map) for one in _near(found, candidates, _DRAWN)}
    yield figure_file(ENVELOPES, torque_speed(shown, _name(found.chosen), required))


def winding_remarks(found: PointWinding, candidates: Candidates) -> Iterator[str]:
    """What the run says at once."""
    yield reason(found, candidates)


def points_files(points: FieldPoints) -> Iterator[File]:
    """Currents, torques and voltages of the operating points."""
    yield table_file(POINTS, points_table(points))


def points_remarks(points: FieldPoints) -> Iterator[str]:
    """What the run says at once."""
    yield checked(points)


def section(
    candidates: Candidates | None, found: PointWinding | None, points: FieldPoints | None
) -> Section | None:
    """What was to be chosen from, what was refused by what, what was chosen, and what it does in the field; none for a
    stated winding."""
    if candidates is None:
        return None
    chosen = None if found is None else found.chosen
    kinds = best_of_each_kind(candidates.valued, candidates.inputs.points)
    alternatives = Table(
        candidates_table(candidates, kinds, chosen).drop(columns=["insulated_fill"]),
        "What would be wound of each gauge and connection and why it was chosen or not; where all are refused, the one "
        f"that comes nearest. {f'In {ALTERNATIVES} too.' if found else f'Every winding is in {TABLE}.'}",
        marked=tuple(k for k, one in enumerate(kinds) if one == chosen),
    )
    text = " ".join((*_asked(candidates), *_counted(candidates), _LEGEND))
    return Section("Winding", (text, *_choice(candidates, found, points), alternatives))


_LEGEND = (
    "Below, the current is the full one that copper or drive allows, the needed one the least with which every point "
    "is reached, with its RMS density in the copper and its copper loss; torques at a speed are the largest, less what "
    "the mesh may have put on top."
)


def _choice(candidates: Candidates, found: PointWinding | None, points: FieldPoints | None) -> tuple[Part, ...]:
    if found is None:
        return ("Nothing was chosen.",)
    near = _near(found, candidates, _SHOWN)
    table = candidates_table(candidates, near, found.chosen)
    return (
        _key_numbers(found),
        f"Decision: {reason(found, candidates)}",
        Picture(
            picture_name(ENVELOPES), "Largest torque and power over speed at the full current, of the chosen winding "
            "and of its neighbours in turns, with the operating points."
        ),
        *_in_the_field(points),
        Table(
            table.drop(columns=["wire_mm", "connection", "paths", "insulated_fill"]),
            f"{_kind(found.chosen)}: for each number of turns the most wires in hand that fit. "
            f"{_refused(found, candidates)}Every winding is in {TABLE}.",
            marked=tuple(k for k, one in enumerate(near) if one == found.chosen),
        ),
    )  # fmt: skip


def reason(found: PointWinding, candidates: Candidates) -> str:
    """Why this winding, and what it leaves at every point."""
    one, competing = found.chosen, competitors(candidates.valued)
    allowed = sum(not other.refused_by for other in candidates.valued)
    return (
        f"{one.winding.design}: of {allowed} windings that reach every operating point {len(competing)} have the least "
        f"copper loss or up to {percent(AS_LITTLE_LOSS)} more, and of these it needs the lowest line current, "
        f"{one.needed_current:.4g} A peak at {needed_density(one) / AMPERE_PER_SQUARE_MILLIMETRE:.3g} A/mm² RMS; its "
        f"full current is {one.winding.current_peak:.4g} A peak. {_margins(one, candidates.inputs.points)}"
    )


def _in_the_field(points: FieldPoints | None) -> tuple[Part, ...]:
    if points is None:
        return ()
    caption = (
        f"The operating points at the least line current, peak, solved in the field. {checked(points)} In {POINTS} too."
    )
    return (Table(points_table(points), caption),)


def points_table(points: FieldPoints) -> pd.DataFrame:
    """An operating point a row, in drawing units."""
    return pd.DataFrame([_point_row(one, points.voltage_limit) for one in points.points])


def _point_row(one: FieldPoint, limit: float) -> dict[str, object]:
    return {
        "speed_rpm": one.asked.speed / RPM, "asked_torque_Nm": one.asked.torque, "i_d_A": one.direct,
        "i_q_A": one.quadrature, "current_peak_A": one.current, "torque_Nm": one.torque,
        "ring_average_torque_Nm": one.ring_torque, "phase_voltage_peak_V": one.voltage,
        "map_phase_voltage_peak_V": one.map_voltage, "largest_phase_voltage_peak_V": limit,
    }  # fmt: skip


def checked(points: FieldPoints) -> str:
    """How far the field is from what the choice counts on."""
    torque = min(one.torque / one.asked.torque for one in points.points) - 1
    voltage = max(one.voltage / points.voltage_limit for one in points.points) - 1
    given = f"{percent(abs(torque), 2)} {'less' if torque < 0 else 'more'} torque than is asked for, or better"
    taken = f"{percent(abs(voltage), 2)} {'less' if voltage < 0 else 'more'} voltage than the bus gives, or less"
    advice = " A little more current than the least brings it below." if voltage > 0 else ""
    return f"At these currents the field gives {given}, and takes {taken}.{advice}"


def _refused(found: PointWinding, candidates: Candidates) -> str:
    """Which numbers of turns of the chosen gauge and connection each limit refuses."""
    alike = [one for one in candidates.valued if one.winding.design.is_like(found.chosen.winding.design)]
    turns = {by: [int(one.winding.turns) for one in alike if one.refused_by == by] for by in counts(tuple(alike))}
    said = [f"{ranges(some)} by {by}" for by, some in turns.items()]
    return f"Turns that are refused: {', '.join(said)}. " if said else ""


def ranges(numbers: list[int]) -> str:
    """``1 to 5, 8`` of rising whole numbers."""
    begins = [n for n in numbers if n - 1 not in numbers]
    ends = [n for n in numbers if n + 1 not in numbers]
    return " and ".join(f"{a}" if a == b else f"{a} to {b}" for a, b in zip(begins, ends, strict=True))


def _margins(one: Candidate, points: tuple[OperatingPoint, ...]) -> str:
    given = (f"{torque:.4g} Nm where {point} are asked" for torque, point in zip(one.torques, points, strict=True))
    return f"It gives {', '.join(given)}."


def candidates_table(
    candidates: Candidates, some: tuple[Candidate, ...], chosen: Candidate | None
) -> pd.DataFrame:
    """Some of the candidates in drawing units."""
    return pd.DataFrame([_row(one, candidates, chosen) for one in some])


def _row(one: Candidate, candidates: Candidates, chosen: Candidate | None) -> dict[str, object]:
    pairs = zip(candidates.inputs.points, one.torques, strict=True)
    needed = {
        "needed_current_peak_A": one.needed_current,
        "needed_density_A_per_mm2": needed_density(one) / AMPERE_PER_SQUARE_MILLIMETRE,
        "copper_loss_W": one.copper_loss,
        "verdict": verdict(one, candidates.valued, chosen),
    }
    at_points = {f"torque_at_{point.speed / RPM:g}_rpm_Nm": torque for point, torque in pairs}
    return {**design_row(one.winding), **drawn(one.winding, _FILL), **at_points, **needed}


def _asked(candidates: Candidates) -> Iterator[str]:
    limits, points = candidates.inputs.limits, " and ".join(map(str, candidates.inputs.points))
    yield (
        f"Asked for are {points}, at {limits.dc_voltage:g} V of the bus, {sqrt(2) * limits.phase_current_rms:.4g} A of "
        f"line current (peak) and {limits.overload_current_density / AMPERE_PER_SQUARE_MILLIMETRE:g} A/mm² RMS in the "
        "copper; the active length is that of the drawing."
    )


def _counted(candidates: Candidates) -> Iterator[str]:
    """What fits, and how many each limit refuses."""
    refused = [f"{number} are refused by {by}" for by, number in counts(candidates.valued).items()]
    reaching = sum(not one.refused_by for one in candidates.valued)
    yield (
        f"{len(candidates.valued)} windings fill the slot: {', '.join(refused + [f'{reaching} reach every point'])}."
    )
    yield _fitting(candidates)
    if candidates.left_out:
        numbers = " and ".join(map(str, candidates.left_out))
        yield f"Paths by the number of {numbers} would not be equal by the star of slots and were left out."


def _fitting(candidates: Candidates) -> str:
    """The slot's own refusal: what a coil side holds."""
    limits = candidates.inputs.limits
    most = {one: 0 for one in candidates.inputs.wires}
    for one in candidates.valued:
        design = one.winding.design
        most[design.wire] = max(most[design.wire], int(design.turns) * design.strands)
    counted = ", ".join(f"{count or 'none'} of {w.copper_diameter / MILLIMETRE:g} mm" for w, count in most.items())
    return (
        f"Beyond that nothing fits: a coil side of {candidates.coil_side_area / SQUARE_MILLIMETRE:.4g} mm² holds "
        f"{counted}, copper filling {limits.largest_packing:.3g} of it at most, wires with their enamel "
        f"{limits.insulated_fill:g}."
    )


def _near(found: PointWinding, candidates: Candidates, turns: int) -> tuple[Candidate, ...]:
    """Candidates of the chosen gauge and connection with a few turns more or less."""
    chosen = found.chosen.winding
    return tuple(
        one for one in candidates.valued
        if one.winding.design.is_like(chosen.design) and abs(one.winding.turns - chosen.turns) <= turns
    )  # fmt: skip


def _envelope(one: Candidate, found: PointWinding, begun: BegunMachine, flux_map: FluxMap) -> Envelope:
    machine = wound_as(begun, one.winding.design).on_map(flux_map.data)
    limits = DriveLimits(one.winding.current_peak, found.driven.limits.voltage_peak)
    return torque_speed_envelope(machine, limits, np.linspace(0.0, found.driven.fastest, _SPEEDS))


def _name(one: Candidate) -> str:
    return one.winding.design.wound


def _kind(one: Candidate) -> str:
    design = one.winding.design
    return f"{design.wire.copper_diameter / MILLIMETRE:g} mm wire, {design.connection}"


def _key_numbers(found: PointWinding) -> KeyNumbers:
    one = found.chosen
    return KeyNumbers((
        KeyNumber("turns", one.winding.turns, "", str(one.winding.design)),
        KeyNumber("needed line current, peak", one.needed_current, "A"),
        KeyNumber("full line current, peak", one.winding.current_peak, "A"),
        KeyNumber("copper loss at the needed current", one.copper_loss, "W"),
    ))  # fmt: skip
