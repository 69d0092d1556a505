"""What a deviation does to the wound machine, from what it does to the field of its cross-section.

To first order and with the phase currents as they are. Length and wire act by closed formulas. The copper loss is that
of a given torque, so that a weaker machine takes more current for it,

    d ln P = d ln R - (2/e) d ln T,    e = d ln T / d ln I at the least current of the torque
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from math import nan

import numpy as np

from drivetrain.masses import PartMaterials
from drivetrain.outcome import active_masses
from electrical.dq import DriveLimits, corner_speed, mtpa_currents
from electrical.flux_map_machine import FluxMapMachine
from electrical.magnets_stage import MagnetsOutcome
from electrical.synchronous_machine import SynchronousMachine
from electrical.winding_stage import WindingInputs, WindingOutcome, rated_speed
from electrical.wound_machine import WoundMachine
from losses.copper import copper_loss
from magnetostatics.flux_map_stage import FluxMap
from uncertainty.deviations import Deviation
from uncertainty.field_slopes import FLUX_D, FLUX_Q, IRON_LOSS, RIPPLE, TORQUE
from uncertainty.powers import LITTLE, LOG_STEP, power

NO_LOAD, NOMINAL, FULL, COGGING = "no load", "nominal", "full", "cogging"  # states of the field
QUADRATURE = "full, on the q axis"
KNEE, OPPOSED = "magnets at their knee", "magnets in their worst state"
FieldSlopes = Mapping[str, np.ndarray]  # state -> derivatives of its quantities over themselves, of one deviation


@dataclass(frozen=True)
class Quantities:
    """One number for each quantity of the wound machine: its value, or a derivative or an error relative to it.

    peak_torque, continuous_torque: at the currents of overload and of the nominal current density [Nm]
    magnet_flux: of a phase, no load, which torque constant and back-EMF go with [Wb]
    inductance_d, inductance_q: incremental, no load [H]; resistance: of a phase [ohm]; base_speed [rad/s]
    copper_loss: at the continuous torque [W]; iron_loss: there, at the rated speed, NaN without loss data [W]
    ripple: of the peak torque, cogging: from peak to peak [Nm]
    loaded_flux: on the d axis [Wb], loaded_inductance_d, loaded_inductance_q: apparent [H], with the overload current
        on the q axis
    demagnetising_current: against the magnets [A], opposing_field: against them in their worst state [A/m]; NaN where
        none is known
    stator_laminations, rotor_laminations, magnets, shaft, copper, mass: of the parts and all of them [kg]
    rotor_inertia: [kg m^2]
    """

    peak_torque: float
    continuous_torque: float
    magnet_flux: float
    inductance_d: float
    inductance_q: float
    resistance: float
    base_speed: float
    copper_loss: float
    iron_loss: float
    ripple: float
    cogging: float
    loaded_flux: float
    loaded_inductance_d: float
    loaded_inductance_q: float
    demagnetising_current: float
    opposing_field: float
    stator_laminations: float
    rotor_laminations: float
    magnets: float
    shaft: float
    copper: float
    mass: float
    rotor_inertia: float


PARTS = {
    name: "total" if name == "mass" else name  # of ``drivetrain.masses.PartMasses``
    for name in ("stator_laminations", "rotor_laminations", "magnets", "shaft", "copper", "mass", "rotor_inertia")
}
QUANTITIES = tuple(one.name for one in fields(Quantities))


@dataclass(frozen=True, eq=False)
class OperatedMachine:
    """The wound machine at its two currents.

    machine: on its flux map; limits: peak phase current and voltage; nominal, full: (i_d, i_q) of least current at the
        nominal current density and at the overload [A peak]
    speed: rated, mechanical [rad/s]
    """

    wound: WoundMachine
    machine: FluxMapMachine
    limits: DriveLimits
    nominal: tuple[float, float]
    full: tuple[float, float]
    speed: float

    @property
    def elasticity(self) -> float:
        """e = d ln T / d ln I at the nominal current, dimensionless; 1 without saturation."""
        current = float(np.hypot(*self.nominal)) * np.array([1 + LITTLE, 1 - LITTLE])
        return power(*self.machine.torque(*mtpa_currents(self.machine, current)).tolist())

    @property
    def frequency(self) -> float:
        """Electrical, at the rated speed [Hz]."""
        return self.machine.pole_pairs * self.speed / (2 * np.pi)

    def ampere_turns(self, current: tuple[float, float]) -> tuple[float, float]:
        """Of a coil [A peak]; current: (i_d, i_q) of a phase [A peak]."""
        d, q = self.wound.ampere_turns(*current)
        return float(d), float(q)

    def base_speed(self, flux_d: float, flux_q: float, resistance: float) -> float:
        """Where the full current meets the voltage [rad/s]; flux_d, flux_q: linkages there [Wb]; resistance [ohm]."""
        i_d, i_q = self.full
        inductance = flux_q / i_q  # any machine with these flux linkages at this current
        psi_m = flux_d - inductance * i_d
        same = SynchronousMachine(self.machine.pole_pairs, psi_m, inductance, inductance, resistance)
        return float(corner_speed(same, self.limits, i_d, i_q))

    def base_speed_slope(self, flux_d: float, flux_q: float, resistance: float) -> float:
        """d ln(base speed) for d ln of what it rests on; flux_d, flux_q, resistance: those, per unit of the same."""
        values = *self.machine.flux_linkage(*self.full), self.wound.phase_resistance
        slopes = np.array([flux_d, flux_q, resistance])
        size = float(np.abs(slopes).max()) or 1.0
        moved = (np.array(values) * np.exp(step * slopes / size) for step in (LOG_STEP, -LOG_STEP))
        return power(*(self.base_speed(*one.tolist()) for one in moved)) * size

    def base_speed_error(self, flux_d: float, flux_q: float) -> float:
        """Bound of the base speed, relative, from those of both linkages; flux_d, flux_q: relative, of any sign."""
        return abs(self.base_speed_slope(flux_d, 0.0, 0.0)) + abs(self.base_speed_slope(0.0, flux_q, 0.0))


def operated_machine(flux_map: FluxMap, winding: WindingOutcome, windings: WindingInputs) -> OperatedMachine:
    """At full current, and at the nominal density."""
    wound, limits = winding.wound, winding.limits
    machine = wound.on_map(flux_map.data)
    nominal = mtpa_currents(machine, wound.current_peak(windings.nominal_density))
    return OperatedMachine(
        wound=wound,
        machine=machine,
        limits=limits,
        nominal=(float(nominal[0]), float(nominal[1])),
        full=(winding.direct_current, winding.quadrature_current),
        speed=rated_speed(winding, windings.limits),
    )


def values_of(
    operated: OperatedMachine,
    winding: WindingOutcome,
    iron_loss: float,
    cogging: float,
    magnets: MagnetsOutcome | None,
    materials: PartMaterials,
) -> Quantities:
    """Of the machine as drawn; iron_loss [W]; cogging: from peak to peak [Nm]; magnets: None without a grade."""
    machine, resistance, chosen = operated.machine, operated.wound.phase_resistance, winding.chosen
    (l_dd, _), (_, l_qq) = machine.incremental_inductances(0.0, 0.0)
    return Quantities(
        peak_torque=float(machine.torque(*operated.full)),
        continuous_torque=float(machine.torque(*operated.nominal)),
        magnet_flux=float(machine.flux_linkage(0.0, 0.0)[0]),
        inductance_d=float(l_dd),
        inductance_q=float(l_qq),
        resistance=resistance,
        base_speed=float(corner_speed(machine, operated.limits, *operated.full)),
        copper_loss=float(copper_loss(resistance, *operated.nominal)),
        iron_loss=iron_loss,
        ripple=winding.peak_torque_ripple,
        cogging=cogging,
        loaded_flux=chosen.torque_constant / (1.5 * machine.pole_pairs),
        loaded_inductance_d=chosen.inductance_d,
        loaded_inductance_q=chosen.inductance_q,
        demagnetising_current=nan if magnets is None else magnets.demagnetising_current,
        opposing_field=nan if magnets is None else magnets.opposing_field,
        **_masses(operated.wound, materials),
    )


def relative_slopes(
    deviation: Deviation, field: FieldSlopes, operated: OperatedMachine, materials: PartMaterials
) -> Quantities:
    """Derivative of each quantity over itself by a deviation [1 per unit of the deviation]."""
    length = _of_wound(deviation, operated.wound, lambda one: one.active_length)
    resistance = _of_wound(deviation, operated.wound, lambda one: one.phase_resistance)
    magnets, inductance_d, inductance_q = field[NO_LOAD] + length
    nominal, full = field[NOMINAL] + length, field[FULL] + length
    loaded_flux, loaded_d, loaded_q = field[QUADRATURE] + length
    return Quantities(
        peak_torque=float(full[TORQUE]),
        continuous_torque=float(nominal[TORQUE]),
        magnet_flux=float(magnets),
        inductance_d=float(inductance_d),
        inductance_q=float(inductance_q),
        resistance=resistance,
        base_speed=operated.base_speed_slope(float(full[FLUX_D]), float(full[FLUX_Q]), resistance),
        copper_loss=resistance - 2 / operated.elasticity * float(nominal[TORQUE]),
        iron_loss=float(nominal[IRON_LOSS]) if len(nominal) > IRON_LOSS else nan,
        ripple=float(full[RIPPLE]),
        cogging=float(field[COGGING][0]) + length,
        loaded_flux=float(loaded_flux),
        loaded_inductance_d=float(loaded_d),
        loaded_inductance_q=float(loaded_q),
        demagnetising_current=float(field[KNEE][0]) if KNEE in field else nan,
        opposing_field=float(field[OPPOSED][0]) if OPPOSED in field else nan,
        **_mass_slopes(deviation, operated.wound, materials),
    )


def _of_wound(deviation: Deviation, wound: WoundMachine, read: Callable[[WoundMachine], float]) -> float:
    """d ln(read)/d(deviation) of what length, wire and drawing make [1 per unit of the deviation]."""
    middle = replace(wound, machine=deviation.centre(wound.dimensions))
    more, less = (read(deviation.wound(middle, way * deviation.step)) for way in (1, -1))
    return (more - less) / (2 * deviation.step * read(middle))


def _masses(wound: WoundMachine, materials: PartMaterials) -> dict[str, float]:
    """Masses and inertia [kg, kg m^2] by their names in ``Quantities``."""
    found = active_masses(wound, materials)
    return {name: float(getattr(found, part)) for name, part in PARTS.items()}


def _mass_slopes(deviation: Deviation, wound: WoundMachine, materials: PartMaterials) -> dict[str, float]:
    """d ln(masses and inertia)/d(deviation) [1 per unit of the deviation], by drawing and stacking together."""
    middle = replace(wound, machine=deviation.centre(wound.dimensions))

    def moved(way: int) -> dict[str, float]:
        change = way * deviation.step
        return _masses(deviation.wound(middle, change), deviation.parts(materials, change))

    more, less, value = moved(1), moved(-1), _masses(middle, materials)
    return {name: (more[name] - less[name]) / (2 * deviation.step * value[name]) for name in PARTS}
