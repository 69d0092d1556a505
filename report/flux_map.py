"""The flux map for people and for other programs: files that motulator, SyR-e and Simulink read, and a paragraph."""

from __future__ import annotations

from collections.abc import Iterator

from electrical.flux_map_export import flux_tables, write_mat, write_npz
from electrical.winding_stage import WindingOutcome
from figures.files import File
from figures.report import Section
from magnetostatics.flux_map_stage import FluxMap


def files(found: FluxMap, winding: WindingOutcome) -> Iterator[File]:
    """The wound machine as ``flux_map_export.mat`` and ``.npz``."""
    tables = flux_tables(winding.wound.on_map(found.data))
    yield File("flux_map_export.mat", lambda path: write_mat(path, tables))
    yield File("flux_map_export.npz", lambda path: write_npz(path, tables))


def section(found: FluxMap) -> Section:
    """What was solved and how far it is trusted."""
    data = found.data
    solved = data["iterations"].sel(iq=data["iq"] >= 0)
    text = (
        f"Flux linkages and torque per turn and metre at {data.sizes['angle']} rotor angles over 60 electrical degrees "
        f"and {data.sizes['id']} × {solved.sizes['iq']} currents up to {float(data['iq'].max()):.0f} A peak in one "
        f"coil ({solved.size} field solutions, {int(solved.sum())} Newton iterations, at most {int(solved.max())} "
        f"each). The map is solved before the winding is chosen and serves every winding that the slot can hold. At "
        f"the overload current the mesh may put the torque off by {100 * found.torque_error:.2f} %."
    )
    return Section("Flux map", (text,))
