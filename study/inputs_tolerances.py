"""How far a workshop may miss the drawing, in SI, and what counts where the study says nothing."""

from __future__ import annotations

from geometry.family import MatchedMachine
from magnetostatics.case import FieldCase
from mechanics.stage import MechanicsInputs
from study.schema import Study
from uncertainty.deviations import (
    BackIron,
    BoreRadius,
    Deviation,
    MagnetArc,
    MagnetLength,
    MagnetPermeability,
    MagnetRemanence,
    MagnetScatter,
    OpeningDepth,
    RotorRadius,
    SlotOpening,
    Stacking,
    StackLength,
    StatorRadius,
    TaperDepth,
    Tolerances,
    ToothWidth,
    WireDiameter,
)
from uncertainty.general_tolerances import fine_tolerance, international_tolerance
from units import FACTORS, MILLIMETRE

_PERCENT = FACTORS["percent"]
TURNED = 8  # ISO 286 grade of bore and outer diameter of the stator; usual for a stack that is bonded and turned
GROUND = 7  # ISO 286 grade of the rotor core; usual for a ground seat
MAGNET = 0.05 * MILLIMETRE  # of length and arc: makers' usual tolerance of ground sintered magnets
REMANENCE = 3 * _PERCENT  # of a batch: the range of B_r in makers' data sheets is 2 to 6 % wide
PERMEABILITY = 0.03  # data sheets of sintered NdFeB state 1.03 to 1.10
STACKING = 1 * _PERCENT  # estimate; EN 10106 gives a least value only
STACK_LENGTH = 0.2 * MILLIMETRE  # half a sheet of 0.35 mm: a stack has a whole number of them
WIRE = 1 * _PERCENT  # IEC 60317-0-1, +-0.005 mm at 0.5 mm
SCATTER = 1.5 * _PERCENT  # estimate: within a batch half of what batches differ by
POSITION = 0.1 * MILLIMETRE  # estimate, glued against a fixture


def tolerances(study: Study, matched: MatchedMachine, case: FieldCase, mechanics: MechanicsInputs) -> Tolerances:
    """Half widths of every dimension and property; the eccentricity is the one that the strength is reckoned with."""
    machine, remanence = matched.dimensions, case.materials.magnet.remanence
    si = study.tolerances.si
    position = _stated(si.magnet_position, POSITION) / machine.rotor_core_radius
    scatter = MagnetScatter(_stated(si.magnet_scatter, SCATTER) * remanence, position)
    return Tolerances((*_of_the_section(study, matched), *_of_parts(study, remanence)), scatter, mechanics.eccentricity)


def _of_the_section(study: Study, matched: MatchedMachine) -> tuple[Deviation, ...]:
    """Of the cross-section; the study states tolerances of diameters, a radius has half of them."""
    si, m = study.tolerances.si, matched.dimensions
    magnet_length, magnet_arc = (_stated(one, MAGNET) for one in (si.magnet_length, si.magnet_width))
    return (
        BoreRadius(_of_radius(si.bore_diameter, m.stator_inner_radius, TURNED)),
        RotorRadius(_of_radius(si.rotor_diameter, m.rotor_core_radius, GROUND)),
        MagnetLength(magnet_length),
        MagnetArc(magnet_arc),
        SlotOpening(_stated(si.slot_opening, fine_tolerance(m.opening_width))),
        ToothWidth(_stated(si.tooth_width, fine_tolerance(m.tooth_width))),
        BackIron(_stated(si.back_iron_width, fine_tolerance(m.back_iron_width))),
        OpeningDepth(_stated(si.shoe_depth, fine_tolerance(m.shoe_d1))),
        TaperDepth(_stated(si.shoe_depth, fine_tolerance(m.shoe_d2))),
        StatorRadius(_of_radius(si.stator_diameter, m.stator_outer_radius, TURNED)),
    )


def _of_parts(study: Study, remanence: float) -> tuple[Deviation, ...]:
    """Of magnets, stack and wire; remanence: of the design [T]."""
    si = study.tolerances.si
    return (
        MagnetRemanence(_stated(si.remanence, REMANENCE) * remanence),
        MagnetPermeability(_stated(si.recoil_permeability, PERMEABILITY)),
        Stacking(_stated(si.stacking, STACKING)),
        StackLength(_stated(si.active_length, STACK_LENGTH)),
        WireDiameter(_stated(si.wire_diameter, WIRE)),
    )


def _of_radius(stated: float | None, radius: float, grade: int) -> float:
    """Half width of a radius [m] from that of its diameter [m], or from a grade of ISO 286."""
    of_diameter = international_tolerance(2 * radius, grade) / 2 if stated is None else stated
    return of_diameter / 2


def _stated(stated: float | None, usual: float) -> float:
    return usual if stated is None else stated
