"""The machine of the study and the matched one for people: drawings, fields, and what happens as the rotor turns."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from figures.cross_section import cross_section
from figures.export import write_field
from figures.field_map import field_map
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Section
from figures.rotation import rotation as rotation_figure
from figures.whole_field import WholeField, null_field
from geometry.cross_section import mesh_cross_section
from magnetostatics.case import FieldCase
from magnetostatics.rotation_stage import STATES, Rotation, Rotations
from units import DEGREE

_FIELD_FIGURES = {"reference": ("nominal",), "matched": ("nominal", "overload")}


def files(found: Rotations, case: FieldCase) -> Iterator[File]:
    """For each machine its drawing, table and figure over the turning rotor, fields as .vtu and as figures."""
    machines = {"reference": found.reference} | ({"matched": found.matched} if found.matched is not None else {})
    for name, one in machines.items():
        yield from _of_machine(name, one, case)


def machine(found: Rotations) -> Section:
    """The study's own machine and its field."""
    seen = found.reference
    text = (
        f"The machine of the study file at the nominal current density: mean torque {_torque(seen)} over one "
        "electrical period (± bounds the error of the mesh) with the current on the q axis, ripple "
        f"{seen.ripple:.2f} Nm/m peak to peak, cogging {seen.cogging:.2f} Nm/m peak to peak. "
        f"The two torque routes differ by at most {seen.routes_apart:.2%}."
    )
    return Section(
        "Reference machine and its field",
        (
            _picture("cross_section_reference", "Cross-section with winding, magnetisation and probe segments."),
            _picture("field_reference_nominal", "Flux density and flux lines in the null position, nominal current."),
            text,
            _picture("rotation_reference", "Torque, cogging and probes over one electrical period."),
        ),
    )


def matched(found: Rotations) -> Section | None:
    """The matched machine solved again, None where nothing was matched."""
    seen = found.matched
    if seen is None:
        return None
    text = (
        f"The machine that the polynomials lead to, meshed and solved again: mean torque {_torque(seen)} over one "
        f"electrical period with the current on the q axis, ripple {seen.ripple:.2f} Nm/m peak to peak, cogging "
        f"{seen.cogging:.2f} Nm/m peak to peak."
    )
    return Section(
        "The matched machine",
        (
            text,
            _picture("cross_section_matched", "Cross-section of the matched machine."),
            _picture("field_matched_nominal", "Flux density at the nominal current."),
            _picture("field_matched_overload", "Flux density at the overload current: the teeth saturate."),
            _picture("rotation_matched", "Torque, cogging and probes over one electrical period."),
        ),
    )


def rotation_table(seen: Rotation) -> pd.DataFrame:
    """Torques and probes over the rotor angle in drawing units."""
    data = seen.data
    columns = {
        "angle_mech_deg": data.angle.values / DEGREE,
        "torque_arkkio_Nm_per_m": data.torque_ring.values,
        "torque_maxwell_Nm_per_m": data.torque_circle.values,
        "torque_error_Nm_per_m": seen.torque_error,
        "torque_no_current_Nm_per_m": data.torque_no_current.values,
    }
    probes = sorted((str(name) for name in data.probe.values), key=_place_in_table)
    return pd.DataFrame(columns | {f"{name}_T": data.flux_density.sel(probe=name).values for name in probes})


def _place_in_table(probe: str) -> tuple[str, int]:
    kind, _, number = probe.rpartition("_")
    return kind, int(number)


def _of_machine(name: str, seen: Rotation, case: FieldCase) -> Iterator[File]:
    section = mesh_cross_section(seen.machine, case.layout(seen.machine))
    yield figure_file(f"cross_section_{name}", cross_section(section, seen.null_angle))
    table = rotation_table(seen)
    yield table_file(f"rotation_{name}.csv", table)
    null, q_axis = seen.null_angle / DEGREE, seen.q_axis_angle / DEGREE
    yield figure_file(f"rotation_{name}", rotation_figure(table, null_angle_deg=null, q_axis_angle_deg=q_axis))
    for state in STATES:
        field = null_field(seen.fields, case, state)
        yield _vtu(f"{name}_{state}.vtu", field)
        if state in _FIELD_FIGURES[name]:
            yield figure_file(f"field_{name}_{state}", field_map(field))


def _vtu(name: str, field: WholeField) -> File:
    return File(name, lambda path: write_field(path, field))


def _torque(seen: Rotation) -> str:
    return f"{seen.mean_torque:.2f} ± {seen.torque_error:.2f} Nm/m"


def _picture(name: str, caption: str) -> Picture:
    return Picture(picture_name(name), caption)
