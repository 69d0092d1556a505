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
from magnetostatics.fields_stage import NullFields, SolvedFields
from magnetostatics.gap_stress_stage import GapStress
from magnetostatics.rotation import STATES, Rotation
from units import DEGREE, percent

_FIELD_FIGURES = {"reference": ("nominal",), "matched": ("nominal", "overload")}


def files(found: SolvedFields, stress: GapStress | None, case: FieldCase) -> Iterator[File]:
    """For each machine its drawing, table and figure over the turning rotor, fields as .vtu and as figures."""
    yield from _of_machine("reference", found.rotation, found.reference, case)
    if stress is not None and found.matched is not None:
        yield from _of_machine("matched", stress.rotation, found.matched, case)


def machine(found: SolvedFields) -> Section:
    """The study's own machine and its field."""
    text = (
        f"The machine of the study file at the nominal current density: {_torques(found.rotation, found.reference)}. "
        f"The two torque routes differ by at most {percent(found.rotation.routes_apart('nominal'), 2)}."
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


def matched(found: SolvedFields, stress: GapStress) -> Section | None:
    """The matched machine solved again, None where nothing was matched."""
    if found.matched is None:
        return None
    text = (
        "The machine that the polynomials lead to, meshed and solved again at the nominal current density: "
        f"{_torques(stress.rotation, found.matched)}."
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


def rotation_table(seen: Rotation, torque_error: float) -> pd.DataFrame:
    """Torques, and probes at the nominal current, over one electrical period in drawing units.

    torque_error: at the nominal current [Nm/m]
    """
    data = seen.one_period
    nominal = data.sel(state="nominal")
    columns = {
        "angle_mech_deg": data.angle.values / DEGREE,
        "torque_arkkio_Nm_per_m": nominal.torque.values,
        "torque_maxwell_Nm_per_m": nominal.torque_circle.values,
        "torque_error_Nm_per_m": torque_error,
        "torque_no_current_Nm_per_m": data.torque.sel(state="no_current").values,
        "torque_overload_Nm_per_m": data.torque.sel(state="overload").values,
    }
    probes = sorted((str(name) for name in data.probe.values), key=_place_in_table)
    return pd.DataFrame(columns | {f"{name}_T": nominal.flux_density.sel(probe=name).values for name in probes})


def _place_in_table(probe: str) -> tuple[str, int]:
    kind, _, number = probe.rpartition("_")
    return kind, int(number)


def _of_machine(name: str, seen: Rotation, fields: NullFields, case: FieldCase) -> Iterator[File]:
    section = mesh_cross_section(seen.machine, case.layout(seen.machine))
    yield figure_file(f"cross_section_{name}", cross_section(section, seen.null_angle))
    table = rotation_table(seen, fields.torque_error)
    yield table_file(f"rotation_{name}.csv", table)
    null, q_axis = seen.null_angle / DEGREE, seen.q_axis_angle / DEGREE
    yield figure_file(f"rotation_{name}", rotation_figure(table, null_angle_deg=null, q_axis_angle_deg=q_axis))
    for state in STATES:
        field = null_field(fields, case, state)
        yield _vtu(f"{name}_{state}.vtu", field)
        if state in _FIELD_FIGURES[name]:
            yield figure_file(f"field_{name}_{state}", field_map(field))


def _vtu(name: str, field: WholeField) -> File:
    return File(name, lambda path: write_field(path, field))


def _torques(seen: Rotation, fields: NullFields) -> str:
    ripple, cogging = seen.ripple("nominal"), seen.ripple("no_current")
    return (
        f"mean torque {seen.mean_torque_per_length('nominal'):.2f} ± {fields.torque_error:.2f} Nm/m over one "
        "electrical period (± bounds the error of the mesh) with the current on the q axis, ripple "
        f"{ripple:.2f} Nm/m peak to peak, cogging {cogging:.2f} Nm/m peak to peak"
    )


def _picture(name: str, caption: str) -> Picture:
    return Picture(picture_name(name), caption)
