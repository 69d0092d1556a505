"""A flux map for other programs: one .mat or .npz file that motulator, SyR-e and Simulink look-up tables read.

All values in SI, peak phase values in the amplitude-invariant rotor frame with the magnet on the d axis. In every table
the first index runs along d, the second along q, which is how a Simulink 2-D Lookup Table takes breakpoints 1 and 2.

    for                                     fields
    Simulink, Flux-Based PM Controller      id_index (n,), iq_index (m,): currents [A]
                                            lambda_d, lambda_q, torque (n, m): flux linkages [Wb], torque [Nm]
    Simulink, Flux-Based PMSM               flux_d (k,), flux_q (l,): flux linkages [Wb]
                                            id, iq (k, l): currents [A]; inside (k, l): 1 where the map was solved,
                                            0 in corners where it is continued along straight lines
    Simscape, FEM-Parameterized PMSM (2-D)  id_index, iq_index, lambda_d, lambda_q, torque
    motulator (MagneticModel)               i_s_dq, psi_s_dq (n, m) complex d + jq [A, Wb], tau_M (n, m) [Nm]
    motulator import_syre_data, SyR-e       motorModel.FluxMap_dq with Id, Iq, Fd, Fq, T in SyR-e's axes, whose d
                                            axis is our q axis and whose q axis is our -d axis; i_q >= 0, .mat only
    all                                     pole_pairs, resistance [ohm], description

In motulator: ``MagneticModel(i_s_dq=f["i_s_dq"], psi_s_dq=f["psi_s_dq"], tau_M=f["tau_M"], type="flux_map")``, then
``.invert()`` gives the current map that its machine model takes; or ``import_syre_data("flux_map_export.mat")``.
Field names: MathWorks "Generate Parameters for Flux-Based Blocks"; motulator 0.5 and 0.6 ``_flux_maps``.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import savemat

from electrical.flux_map_machine import FluxMapMachine

DESCRIPTION = (
    "Flux map, mean over the rotor angle. SI units, peak phase values, amplitude-invariant rotor frame, magnet flux on "
    "the d axis, T = 1.5 p (psi_d i_q - psi_q i_d). First index along d, second along q."
)


@dataclass(frozen=True, eq=False)
class FluxTables:
    """Fields of the export, each under its name in the file, SI.

    id_index (n,), iq_index (m,): currents [A]; lambda_d, lambda_q, torque (n, m): at them [Wb, Wb, Nm]
    flux_d (k,), flux_q (l,): flux linkages [Wb]; id, iq (k, l): currents at them [A]; inside (k, l),
        dimensionless: 1 where the map was solved, 0 where it is continued
    """

    id_index: np.ndarray
    iq_index: np.ndarray
    lambda_d: np.ndarray
    lambda_q: np.ndarray
    torque: np.ndarray
    flux_d: np.ndarray
    flux_q: np.ndarray
    id: np.ndarray
    iq: np.ndarray
    inside: np.ndarray
    pole_pairs: int
    resistance: float
    description: str = DESCRIPTION

    @property
    def fields(self) -> dict[str, Any]:
        """Everything that the file holds, with the names that motulator has for the same tables."""
        current_d, current_q = np.meshgrid(self.id_index, self.iq_index, indexing="ij")
        complex_tables = {"i_s_dq": current_d + 1j * current_q, "psi_s_dq": self.lambda_d + 1j * self.lambda_q}
        return {**vars(self), **complex_tables, "tau_M": self.torque}


def flux_tables(machine: FluxMapMachine, points: int = 41) -> FluxTables:
    """Fields of the export over regular currents and over regular flux linkages.

    points: along each axis of either table. The flux linkages span those of all currents in the map.
    """
    i_d, i_q = (np.linspace(axis[0], axis[-1], points) for axis in (machine.i_d, machine.i_q))
    flux_d, flux_q = (np.linspace(psi.min(), psi.max(), points) for psi in (machine.psi_d, machine.psi_q))
    by_current = machine(*np.meshgrid(i_d, i_q, indexing="ij"))
    current_d, current_q, inside = machine.continued_currents(*np.meshgrid(flux_d, flux_q, indexing="ij"))
    by_flux = (flux_d, flux_q, current_d, current_q, inside.astype(float))
    return FluxTables(i_d, i_q, *by_current, *by_flux, machine.pole_pairs, machine.resistance)


def syre_structure(tables: FluxTables) -> dict[str, dict[str, np.ndarray]]:
    """``motorModel`` as SyR-e stores it, [A], [Wb] and [Nm], i_q >= 0: our q axis along the columns, our negative d
    axis along the rows."""
    half = tables.iq_index >= 0
    names = (("Fd", tables.lambda_q), ("Fq", -tables.lambda_d), ("T", tables.torque))
    turned = {name: table[::-1, half] for name, table in names}
    i_d, i_q = np.meshgrid(tables.iq_index[half], -tables.id_index[::-1])
    return {"FluxMap_dq": {**turned, "Id": i_d, "Iq": i_q}}


def write_mat(path: Path, tables: FluxTables) -> None:
    """Write ``FluxTables`` as a MATLAB file, with SyR-e's structure."""
    savemat(path, {**tables.fields, "motorModel": syre_structure(tables)}, oned_as="column")


def write_npz(path: Path, tables: FluxTables) -> None:
    """Write ``FluxTables`` for ``numpy.load``."""
    np.savez_compressed(path, **tables.fields)
