"""A machine on the bench as the effects see it: as drawn, and where it may differ as built."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

from geometry.machine import Machine
from geometry.winding import star_of_slots
from materials.iron_loss import IronLossLaw
from materials.magnet import Magnet


@dataclass(frozen=True, kw_only=True)
class BuiltMachine:
    """What every machine on a bench has, whatever its kind.

    magnet: what all magnets are made of;  length: active length [m]
    field_scale: H of the steel over that of the grade at the same polarisation [1]
    saturation_scale: polarisation of the steel over that of the grade at the same field [1]
    stacking_factor: share of the length that is steel [1]
    end_leakage: share of the magnets' flux that closes beyond the ends instead of through the winding [1]
    end_winding_inductance: of the end winding of a phase [H]
    dry_friction [Nm], viscous_friction [Nms/rad], windage [Nm s^2/rad^2]: against the motion, all bearings together
    iron_loss: law of the sheet, None where none is declared;  iron_loss_factor: loss of the stack over it [1]
    """

    magnet: Magnet
    length: float
    field_scale: float = 1.0
    saturation_scale: float = 1.0
    stacking_factor: float = 1.0
    end_leakage: float = 0.0
    end_winding_inductance: float = 0.0
    dry_friction: float = 0.0
    viscous_friction: float = 0.0
    windage: float = 0.0
    iron_loss: IronLossLaw | None = None
    iron_loss_factor: float = 1.0

    def with_magnet(self, **changes: float) -> Self:
        """Another material of all magnets."""
        return replace(self, magnet=replace(self.magnet, **changes))  # type: ignore[type-var]

    def with_airgap(self, change: float) -> Self:
        """The bore moved so that the gap is wider by ``change`` [m], slots and shoes with it."""
        raise NotImplementedError


@dataclass(frozen=True)
class MachineAsBuilt(BuiltMachine):
    """One machine, all that its field and its terminals depend on. Tuples count round it from magnet, slot or coil 0.

    machine: cross-section, all magnets, slots and teeth alike;  steel: grade
    turns: of every coil [1];  phase_resistance: A, B, C at 20 degC [ohm]
    lead_resistance: of what is between terminals and winding, A, B, C [ohm]
    magnet_strengths: remanence of every magnet over that of ``magnet`` [1]
    magnet_turns: angle by which every magnet sits too far on, counter-clockwise [rad]
    opening_changes: by which every slot opening is wider than drawn [m]
    stator_shift: of the stator against the axis of rotation, x and y [m]
    rotor_shift: of the rotor against the axis of rotation, from the axis of magnet 0, turning with it [m]
    magnet_grinding, bore_grinding: by which the magnets were ground thinner, the bore wider, the slots staying [m]
    edge_damage: share of its permeability that the stator steel has lost at its cut edges [1]
    edge_depth: how far in from the edges [m]
    skew: angle between the two ends of the machine, even along its length [rad]
    segment_angles: of a rotor in two, and in three segments along its length, each turned against its neighbour [rad]
    rotor_turn: angle by which the pattern of all magnets sits too far on, against the zero of the encoder [rad]
    radial_share: by which the magnetisation has turned on from the drawn one towards radial: 1 from parallel ones [1]
    shorted_turns, shorted_coil: turns that are closed on themselves, and the coil that they belong to
    undeclared_iron_loss: loss of a stack without a declared law over that of a usual sheet [1]
    cogging_of_mesh: what a mesh makes of cogging over what it should be [1]; no property of the machine
    recorder_loss: share of the voltage far above half the rate of readings that a recorder keeps back [1]; no property
        of the machine either
    rise_beyond_table: polarisation that the steel takes up beyond the end of its table over what is expected there [1]
    """

    machine: Machine
    steel: str
    turns: tuple[float, ...]
    phase_resistance: tuple[float, float, float]
    magnet_strengths: tuple[float, ...]
    magnet_turns: tuple[float, ...]
    opening_changes: tuple[float, ...]
    lead_resistance: tuple[float, float, float] = (0.0, 0.0, 0.0)
    stator_shift: tuple[float, float] = (0.0, 0.0)
    rotor_shift: tuple[float, float] = (0.0, 0.0)
    edge_damage: float = 0.0
    edge_depth: float = 0.7e-3
    skew: float = 0.0
    segment_angles: tuple[float, float] = (0.0, 0.0)
    rotor_turn: float = 0.0
    radial_share: float = 0.0
    magnet_grinding: float = 0.0
    bore_grinding: float = 0.0
    shorted_turns: float = 0.0
    shorted_coil: int = 0
    undeclared_iron_loss: float = 0.0
    cogging_of_mesh: float = 1.0
    recorder_loss: float = 0.0
    rise_beyond_table: float = 1.0

    @classmethod
    def drawn(
        cls, machine: Machine, steel: str, magnet: Magnet, length: float, turns_per_coil: float, resistance: float
    ) -> MachineAsBuilt:
        """The machine with a coil on every tooth, all magnets, slots and coils alike; resistance: of a phase [ohm]."""
        return cls(
            machine,
            steel,
            magnet=magnet,
            length=length,
            turns=(turns_per_coil,) * machine.slots,
            phase_resistance=(resistance,) * 3,
            magnet_strengths=(1.0,) * machine.poles,
            magnet_turns=(0.0,) * machine.poles,
            opening_changes=(0.0,) * machine.slots,
        )

    @property
    def cross_section(self) -> Machine:
        """The machine after grinding: thinner magnets leave rotor core and stator, a wider bore leaves the slots."""
        thinner, wider, drawn = self.magnet_grinding, self.bore_grinding, self.machine
        if not (thinner or wider):
            return drawn
        return replace(
            drawn,
            airgap=drawn.airgap + thinner + wider,
            rotor_outer_radius=drawn.rotor_outer_radius - thinner,
            magnet_length=drawn.magnet_length - thinner,
            shoe_d1=drawn.shoe_d1 - wider,
        )

    def with_one(self, name: str, index: int, value: float) -> MachineAsBuilt:
        """One entry of one of the tuples replaced."""
        values = list(getattr(self, name))
        values[index] = value
        return replace(self, **{name: tuple(values)})

    def with_machine(self, **changes) -> MachineAsBuilt:
        """Other dimensions of the cross-section."""
        return replace(self, machine=replace(self.machine, **changes))

    def with_airgap(self, change: float) -> MachineAsBuilt:
        return self.with_machine(airgap=self.machine.airgap + change)

    def without_turns(self, coil: int, missing: float) -> MachineAsBuilt:
        """One coil with fewer turns, and its phase with less resistance."""
        phase = star_of_slots(self.machine.slots, self.machine.pole_pairs).coils[coil].phase
        share = missing / sum(self._turns_of(phase))
        return self.with_one("turns", coil, self.turns[coil] - missing)._with_resistance(phase, 1.0 - share)

    def with_scattered(self, name: str, changes: Sequence[float]) -> MachineAsBuilt:
        """All entries of one of the tuples changed by a number each."""
        return replace(self, **{name: tuple(a + b for a, b in zip(getattr(self, name), changes, strict=True))})

    def with_phase_turns(self, phase: int, factor: float) -> MachineAsBuilt:
        """All coils of one phase with ``factor`` times their turns, and as much resistance."""
        coils = star_of_slots(self.machine.slots, self.machine.pole_pairs).coils
        turns = tuple(n * (factor if coil.phase == phase else 1.0) for n, coil in zip(self.turns, coils))
        return replace(self, turns=turns)._with_resistance(phase, factor)

    @property
    def turns_of_phases(self) -> tuple[float, ...]:
        """Turns of A, B and C in series."""
        return tuple(sum(self._turns_of(phase)) for phase in range(3))

    def _turns_of(self, phase: int) -> list[float]:
        coils = star_of_slots(self.machine.slots, self.machine.pole_pairs).coils
        return [n for n, coil in zip(self.turns, coils) if coil.phase == phase]

    def _with_resistance(self, phase: int, factor: float) -> MachineAsBuilt:
        return self.with_one("phase_resistance", phase, self.phase_resistance[phase] * factor)
