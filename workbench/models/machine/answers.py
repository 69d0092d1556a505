"""What the terminals and the torque cell of one machine see, from its surrogate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from math import hypot, sqrt

import numpy as np

from effects.base import Columns
from effects.machine_design import MachineAsBuilt
from magnetostatics.positions import angles_past_slots, torque_period
from materials.conductor import COPPER
from workbench.models.machine.spectra import averaged, evaluated, half_rate, slope
from workbench.models.machine.surrogate import Surrogate

# What of a design does not change its field, by what it is about.
BRAKES = ("dry_friction", "viscous_friction", "windage", "iron_loss", "iron_loss_factor", "undeclared_iron_loss")
BRAKES += ("shorted_turns", "shorted_coil")
RESISTANCES = ("phase_resistance", "lead_resistance")
_AROUND_FIELD = ("end_winding_inductance", "cogging_of_mesh", "end_leakage", "rotor_turn", "segment_angles")
_AROUND_FIELD += ("recorder_loss",)
_FEWEST_ANGLES = 2  # rotor positions of a sixth of an electrical period; their mean has no sixth electrical order
_PROBE = 1e-3  # A, of an inductance; without current the surrogate is linear in it


@dataclass(frozen=True, eq=False)
class Answers:
    """Torque and phase flux linkages of one design at one temperature of its magnets."""

    surrogate: Surrogate
    design: MachineAsBuilt

    @cached_property
    def in_field(self) -> MachineAsBuilt:
        """The design with what its field does not know as drawn, so that effects outside it find the same answers.

        Of segments only the mean square of their angles counts for small angles: as of an even skew.
        """
        d, drawn = self.design, self.surrogate.nominal
        stepped = (angle * sqrt(n**2 - 1) for n, angle in enumerate(d.segment_angles, 2))
        return with_parts_of(drawn, replace(d, skew=hypot(d.skew, *stepped)), (*BRAKES, *RESISTANCES, *_AROUND_FIELD))

    @cached_property
    def spectrum(self) -> np.ndarray:
        """Of torque and phase flux linkages per metre over the revolution, skewed (4, orders)."""
        found = self.surrogate.spectrum(self.in_field).copy()
        found[0] += (self.design.cogging_of_mesh - 1.0) * self.surrogate.no_load[0]
        return self._along_the_length(found)

    def _along_the_length(self, spectrum: np.ndarray) -> np.ndarray:
        """The mean over skew and segments."""
        found = averaged(spectrum, self.design.skew) if self.design.skew else spectrum
        for segments, angle in enumerate(self.design.segment_angles, 2):
            places = angle * (np.arange(segments) - (segments - 1) / 2)
            found = found * np.cos(np.arange(spectrum.shape[1])[:, None] * places).mean(axis=1) if angle else found
        return found

    def _on_the_rotor(self, angle: np.ndarray) -> np.ndarray:
        """Angle of the magnets' pattern for one that the encoder means."""
        return angle - self.design.rotor_turn

    @property
    def kept(self) -> float:
        """Share of the magnets' flux that goes through the winding."""
        return 1.0 - self.design.end_leakage

    def cogging(self, angle: np.ndarray) -> np.ndarray:
        """Torque without current [Nm]; it goes with the square of the magnets' flux."""
        return self.design.length * self.kept**2 * evaluated(self.spectrum[:1], self._on_the_rotor(angle))[0]

    def flux_slopes(self, angle: np.ndarray) -> np.ndarray:
        """d psi / d angle of the phases [Wb] (3, n), as a recorder shows them."""
        slopes = slope(self.spectrum[1:]) * self._passed(_half_rate(np.asarray(angle, dtype=float).tobytes()))
        return self.design.length * self.kept * evaluated(slopes, self._on_the_rotor(angle))

    def _passed(self, half: float) -> np.ndarray:
        """Share of every order that a recorder passes (orders,): 1 - loss x^6 / (1 + x^6), x over half the readings a
        revolution."""
        x = (np.arange(self.spectrum.shape[1]) / half) ** 6
        return 1.0 - self.design.recorder_loss * x / (1.0 + x)

    def magnet_linkage(self, angle: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases without current [Wb] (n, 3)."""
        return self.design.length * self.kept * evaluated(self.spectrum[1:], self._on_the_rotor(angle)).T

    @cached_property
    def linkage_waves(self) -> np.ndarray:
        """Complex amplitudes over the revolution of the phases' flux linkages [Wb] (3, orders)."""
        back = np.exp(-1j * np.arange(self.spectrum.shape[1]) * self.design.rotor_turn)
        return self.design.length * self.kept * self.spectrum[1:] * back

    def tooth_wave(self, tooth: int) -> np.ndarray:
        """Complex amplitudes of the flux of the magnets through a tooth [Wb] (orders,), its shape as drawn."""
        return self.tooth_flux * self.surrogate.no_load[1 + tooth]

    @cached_property
    def tooth_flux(self) -> float:
        """Flux of the magnets through a tooth over that of the drawing per metre [m], in the proportion of the
        fundamental of the phases."""
        drawn = self.surrogate.nominal
        now, then = (self._fundamental(design) for design in (replace(self.in_field, turns=drawn.turns), drawn))
        return self.design.length * self.kept * (now / then)

    def _fundamental(self, design: MachineAsBuilt) -> float:
        return float(np.abs(self.surrogate.spectrum(design)[1:, self.design.machine.pole_pairs]).mean())

    def loaded_torque(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Torque [Nm]: cogging, and what magnets and currents make together, which goes with the magnets' flux."""
        both = self.design.length * self._with_current(angle, currents)[:, 0]
        alone = self.design.length * evaluated(self.spectrum[:1], self._on_the_rotor(angle))[0]
        return self.kept * (both - alone) + self.kept**2 * alone

    def _with_current(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        return self.surrogate.with_current(self.in_field, self._on_the_rotor(angle), currents)

    def flux_change(self, angle: np.ndarray, currents: np.ndarray) -> np.ndarray:
        """Flux linkages of the phases against those without current [Wb] (n, 3); the end winding adds L_end i."""
        both = self._with_current(np.tile(angle, 2), np.vstack([currents, 0 * currents]))
        change = both[: len(angle)] - both[len(angle) :]
        return self.design.length * change[:, 1:] + self.design.end_winding_inductance * currents

    @cached_property
    def inductances(self) -> np.ndarray:
        """d psi of a phase / d i of another [H] (3, 3), end winding included: without current, over the rotor angle.

        Self and mutual inductance per turn are taken alike for all phases, as they are over a whole period.
        """
        angle = load_angles(self.design)
        columns = [self.flux_change(angle, np.tile(_PROBE * unit, (len(angle), 1))) for unit in np.eye(3)]
        found = np.stack([column.mean(axis=0) / _PROBE for column in columns], axis=1)
        turns = self.design.turns_of_phases
        per_turn, own = found / np.outer(turns, turns), np.eye(3, dtype=bool)
        return np.where(own, per_turn[own].mean(), per_turn[~own].mean()) * np.outer(turns, turns)

    def resistances(self, at: Columns) -> np.ndarray:
        """Of the phases with their leads (n, 3) [ohm]: R_20 (1 + alpha (T - 20 degC)) at winding_T."""
        rows = len(next(iter(at.values())))
        winding = at.get("winding_T", np.full(rows, COPPER.reference_temperature))
        warm = 1.0 + COPPER.temperature_coefficient * (winding - COPPER.reference_temperature)
        warm = warm * at.get("resistance_factor", 1.0)
        return warm[:, None] * np.array(self.design.phase_resistance) + np.array(self.design.lead_resistance)


@lru_cache(maxsize=32)
def _half_rate(angle: bytes) -> float:
    """Of angles given as the bytes of their array: every fit asks for the same few tables."""
    return half_rate(np.frombuffer(angle))


def with_parts_of(drawn: MachineAsBuilt, design: MachineAsBuilt, names: Sequence[str]) -> MachineAsBuilt:
    """The design with what has these names as drawn."""
    return replace(design, **{name: getattr(drawn, name) for name in names}) if names else design


def load_angles(design: MachineAsBuilt) -> np.ndarray:
    """Rotor angles [rad] over a sixth of an electrical period, after which the phases change their places."""
    count = angles_past_slots(design.machine, _FEWEST_ANGLES)
    return (np.arange(count) + 0.5) * torque_period(design.machine) / (design.machine.pole_pairs * count)
