"""What a bench has taught about the machines of a study, and what it changes in the inputs of a design.

A lesson is one physical reason with its size: magnets 6 % weaker, 0.06 Nm of friction on the rotor. Nothing learned
changes no input, bit for bit.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import prod
from typing import TypeVar

from drivetrain.added_friction import AddedFriction
from drivetrain.requirements import Requirements, Transmission, shaft_demand
from electrical.shaft_demand import ShaftDemand
from magnetostatics.case import FieldCase
from magnetostatics.local_steel import with_law
from magnetostatics.model import MachineMaterials
from materials.altered_steel import ScaledSaturation, hardened, stacked
from materials.reluctivity import Reluctivity

Case = TypeVar("Case", bound=FieldCase)

@dataclass(frozen=True)
class Quantity:
    """Something about a machine that a bench may teach; unit: of ``units.FACTORS``, empty for a pure number."""

    name: str
    words: str
    unit: str = ""

    def joined(self, values: Iterable[float]) -> float:
        """Several lessons about it as one value [unit of the quantity]; without any, that of the study.

        values: [unit of the quantity]
        """
        raise NotImplementedError

    def shown(self, value: float) -> str:
        """A value [unit of the quantity] for people."""
        raise NotImplementedError


class Factor(Quantity):
    """Over what the study states; lessons multiply, 1 is the study's own. values, joined, value: dimensionless."""

    def joined(self, values: Iterable[float]) -> float:
        return prod(values, start=1.0)

    def shown(self, value: float) -> str:
        return f"times {value:.4f}"


class Share(Quantity):
    """Of something that is lost; each lesson takes its share of what the others leave, 0 is the study's own.

    values, joined, value: dimensionless
    """

    def joined(self, values: Iterable[float]) -> float:
        return 1.0 - prod((1.0 - value for value in values), start=1.0)

    def shown(self, value: float) -> str:
        return f"{100 * value:.2f} %"


class Added(Quantity):
    """On top of what the study states; lessons add up, 0 is the study's own.

    values, joined, value: [unit of the quantity]
    """

    def joined(self, values: Iterable[float]) -> float:
        return sum(values, start=0.0)

    def shown(self, value: float) -> str:
        return f"{value:.4g} {self.unit}"


REMANENCE = Factor("remanence", "remanence of the magnets")
RECOIL = Factor("recoil", "recoil permeability of the magnets")
STACKING = Factor("stacking", "share of the length that is steel")
STEEL_FIELD = Factor("steel_field", "field that the steel needs")
STEEL_SATURATION = Factor("steel_saturation", "polarisation at which the steel saturates")
END_LEAKAGE = Share("end_leakage", "flux of the magnets that closes beyond the ends")
MAGNET_FLUX = Share("magnet_flux", "flux of the magnets that the winding lacks")
RESISTANCE = Factor("resistance", "resistance of the winding")
IRON_LOSS = Factor("iron_loss", "iron loss")
ROTOR_FRICTION = Added("rotor_friction", "dry friction on the rotor", "Nm")
ROTOR_VISCOUS = Added("rotor_viscous", "viscous friction on the rotor", "Nms/rad")
OUTPUT_FRICTION = Added("output_friction", "dry friction at the output", "N or Nm")
OUTPUT_VISCOUS = Added("output_viscous", "viscous friction at the output", "Ns/m or Nms/rad")
LOAD_LOSS = Share("load_loss", "effort that the transmission keeps")

QUANTITIES = (
    REMANENCE, RECOIL, STACKING, STEEL_FIELD, STEEL_SATURATION, END_LEAKAGE, MAGNET_FLUX, RESISTANCE, IRON_LOSS,
    ROTOR_FRICTION, ROTOR_VISCOUS, OUTPUT_FRICTION, OUTPUT_VISCOUS, LOAD_LOSS,
)  # fmt: skip


@dataclass(frozen=True)
class Lesson:
    """One thing that was learned.

    reason: the effect or input of the model file;  title: the same for people
    value: [unit of the quantity];  uncertainty: standard, [unit of the quantity], None where the file states none
    """

    reason: str
    title: str
    quantity: Quantity
    value: float
    uncertainty: float | None = None

    @property
    def words(self) -> str:
        """``remanence of the magnets times 0.9300 ± 0.0040``."""
        spread = "" if self.uncertainty is None else f" ± {self.uncertainty:.2g}"
        return f"{self.quantity.words} {self.quantity.shown(self.value)}{spread}"


@dataclass(frozen=True)
class Learned:
    """All lessons of one model file; unused: a sentence for each of its entries that means nothing for a design."""

    lessons: tuple[Lesson, ...] = ()
    unused: tuple[str, ...] = ()
    source: str = ""

    def of(self, quantity: Quantity) -> float:
        """What was learned about a quantity [its unit]; the study's own where nothing was."""
        return quantity.joined(one.value for one in self.lessons if one.quantity == quantity)

    def alone(self, lesson: Lesson) -> Learned:
        """As if this were all that was learned."""
        return replace(self, lessons=(lesson,), unused=())

    @property
    def friction(self) -> AddedFriction:
        """Losses between air gap and output."""
        return AddedFriction(
            rotor_coulomb=self.of(ROTOR_FRICTION),
            rotor_viscous=self.of(ROTOR_VISCOUS),
            output_coulomb=self.of(OUTPUT_FRICTION),
            output_viscous=self.of(OUTPUT_VISCOUS),
            load_loss=self.of(LOAD_LOSS),
        )


NOTHING_LEARNED = Learned()


def case_as_learned(case: Case, learned: Learned) -> Case:
    """The machines and materials of a study with the magnets, the steel and the end leakage of the bench.

    Flux that the winding lacks, for a reason that the bench did not tell, acts as end leakage does: the field inside
    the stack stays, so that iron which is less saturated gives nothing back.
    """
    lost = END_LEAKAGE.joined((case.end_leakage, learned.of(END_LEAKAGE), learned.of(MAGNET_FLUX)))
    return replace(case, materials=materials_as_learned(case.materials, learned), end_leakage=lost)


def materials_as_learned(materials: MachineMaterials, learned: Learned) -> MachineMaterials:
    """Magnets and steel as the bench has shown them; untouched laws stay the same objects."""
    magnet = materials.magnet
    changed = replace(
        magnet,
        remanence=magnet.remanence * learned.of(REMANENCE),
        recoil_permeability=magnet.recoil_permeability * learned.of(RECOIL),
    )
    stator, rotor = (
        with_law(steel, lambda law: _steel(law, learned)) for steel in (materials.stator_steel, materials.rotor_steel)
    )
    return replace(materials, stator_steel=stator, rotor_steel=rotor, magnet=changed)


def _steel(law: Reluctivity, learned: Learned) -> Reluctivity:
    """Saturation first, then permeability, then the insulation between the sheets."""
    saturation, field = learned.of(STEEL_SATURATION), learned.of(STEEL_FIELD)
    law = law if saturation == 1.0 else ScaledSaturation(law, saturation)
    law = law if field == 1.0 else hardened(law, field)
    return stacked(law, learned.of(STACKING))


def demand_as_learned(required: Requirements, transmission: Transmission, learned: Learned) -> ShaftDemand:
    """What is asked of the rotor, with the losses that the bench has shown on the way to the output.

    They count where the ratio is largest, as the forces do.
    """
    friction, ratio = learned.friction, transmission.largest
    asked = shaft_demand(required, transmission)
    peak = friction.needed(required.force_peak, required.velocity_at_force_peak, ratio)
    rms = friction.needed(required.force_rms, required.velocity_rms, ratio)
    at_power = friction.needed(required.force_at_power_peak, required.velocity_at_power_peak, ratio)
    more = (at_power - required.force_at_power_peak) * required.velocity_at_power_peak
    return replace(asked, torque_peak=peak * ratio, torque_rms=rms * ratio, power=asked.power + more)
