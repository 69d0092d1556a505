"""What a 2-D field leaves out at the two ends of the stack: fringing of the magnets' flux, and the end turns' own flux.

psi_i = l_e psi_i(2-D) + L_end i_i,   T = l_e T(2-D)
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log, pi

import numpy as np

from units import MU_0, Values


@dataclass(frozen=True)
class EndEffects:
    """Turns values per metre and turn into those of a machine of finite length.

    active_length: of the stack l [m]
    flux_factor: effective over active length, l_e/l; below 1 where flux escapes beyond the ends, above 1 where it
        fringes in (``fringing_factor``) or the magnets are longer than the stack; 1 leaves 2-D values as they are
    end_inductance: of the end turns of one phase, its turns included [H]; couplings between phases are left out
    """

    active_length: float
    flux_factor: float = 1.0
    end_inductance: float = 0.0

    def torque(self, per_length: Values) -> Values:
        """Torque [Nm] from that of the 2-D field, per_length [Nm/m]; end turns carry flux, but make no torque."""
        return self.active_length * self.flux_factor * per_length

    def flux_linkage(self, per_length_and_turn: Values, turns: float, currents: Values) -> np.ndarray:
        """Flux linkage [Wb] of the phases, of the shape of their currents [A].

        per_length_and_turn: that of the 2-D field [Wb/m per turn]
        """
        inside = self.active_length * self.flux_factor * turns * np.asarray(per_length_and_turn)
        return inside + self.end_inductance * np.asarray(currents)


def fringing_factor(active_length: float, airgap: float) -> float:
    """l_e/l = 1 + 2 g/l of a stator and a rotor of equal length l, without ventilation ducts.

    Source: Pyrhonen, Jokinen, Hrabovcova, Design of Rotating Electrical Machines, 2nd ed. (2014), the effective length
    of the core in the chapter on the magnetic circuit.
    airgap: g [m]; behind surface magnets the field decays over gap and magnet, and what fringes in is a matter for 3-D
    """
    return 1 + 2 * airgap / active_length


def end_turn_inductance(mean_radius: float, bundle_radius: float, turns: float, coils_in_series: int) -> float:
    """Leakage inductance of the end turns of one phase of tooth coils [H].

    The end turns of a coil are two half circles, together a ring:  L = mu_0 N^2 R (ln(8 R/a) - 7/4) per coil
    Source: inductance of a ring of round section, Rosa and Grover, Bull. Bur. Standards 8 (1912), section on circular
    rings. Good to terms of (a/R)^2; iron at the end faces, which raises it, and neighbouring coils are left out.

    mean_radius: R of the half circle [m]; bundle_radius: a of the conductors of one coil side taken as round [m]
    """
    if not 0 < bundle_radius < mean_radius:
        raise ValueError(
            f"the bundle of an end turn must be thinner than its bend, found radius {bundle_radius:g} m in one of "
            f"{mean_radius:g} m: check the slot area and the tooth width"
        )
    return coils_in_series * MU_0 * turns**2 * mean_radius * (log(8 * mean_radius / bundle_radius) - 7 / 4)


def bundle_radius(copper_area: float) -> float:
    """Radius [m] of a round bundle with the area of a coil side [m^2]."""
    return (copper_area / pi) ** 0.5
