"""A machine of every kind of rotor, two of them drawings that another code has solved, and one with one's own rotor."""

from dataclasses import replace
from math import atan2

import numpy as np

from benchmarks.drawn_kinds import cut_out_with_magnets, own, read_back
from geometry.cross_section import CrossSection, mesh_cross_section
from geometry.half_cell import MeshDensity
from geometry.magnetisation import PARALLEL, HalbachMagnetisation
from geometry.parts import ComposedMachine
from geometry.rotors.bread_loaf_magnets import BreadLoafMagnets
from geometry.rotors.consequent_pole import ConsequentPole
from geometry.rotors.flux_barriers import FluxBarriers
from geometry.rotors.inset_magnets import InsetMagnets
from geometry.rotors.outer_magnets import OuterMagnets
from geometry.rotors.outline_rotor import OutlineRotor
from geometry.rotors.ribbed_v_shape import RibbedVShape
from geometry.rotors.spoke import Spoke
from geometry.rotors.surface_magnets import SurfaceMagnets
from geometry.rotors.two_layer_v_shape import TwoLayerVShape
from geometry.rotors.v_shape import VShape
from geometry.stators.outward_teeth import OutwardTeeth
from geometry.stators.round_bottom_slots import RoundBottomSlots
from geometry.stators.straight_teeth import StraightTeeth
from geometry.winding import star_of_slots
from magnetostatics.currents import PhaseCurrents
from magnetostatics.model import FieldModel, MachineMaterials
from materials.library import load_steel
from materials.magnet import Magnet
from units import DEGREE, MILLIMETRE

mm = MILLIMETRE
STEEL = load_steel("M270-35A")

# Outer rotor, 9 slots and 12 poles: a small motor of a robot, idealised (magnets with round faces).
OUTRUNNER = ComposedMachine(
    OutwardTeeth(9, 3.0 * mm, 3.95 * mm, 5.95 * mm, 6.35 * mm, 6.95 * mm, 1.8 * mm, 0.8 * mm),
    OuterMagnets(12, 7.478 * mm, 1.287 * mm, 0.9 * mm, 20.0 * mm, 0.635),
)
# Corners of half a pole of the traction motor of the Prius 2004 [mm].
_FACE = (69.24, 0.0), (74.9118, 18.0289)
_TIP, _CORNER = (75.8465, 21.0), (75.0999, 23.5307)
V_SHAPE = ComposedMachine(
    RoundBottomSlots(48, 80.95 * mm, 134.62 * mm, 1.93 * mm, 1.0 * mm, 5.0 * mm, 8.0 * mm, 29.3 * mm),
    VShape(
        8, 80.2 * mm, 55.32 * mm, tip_depth=69.24 * mm, tilt=atan2(_FACE[1][1], _FACE[1][0] - _FACE[0][0]),
        magnet_length=6.5 * mm, magnet_width=18.9 * mm, recess=1.0 * mm, hole_depth=63.4743 * mm, bridge=1.5 * mm,
        bridge_start=atan2(*_TIP[::-1]), bridge_end=atan2(*_CORNER[::-1]),
    ),
)  # fmt: skip
RIBBED = ComposedMachine(V_SHAPE.stator, RibbedVShape(rib=1.2 * mm, **vars(V_SHAPE.rotor)))
STATOR = StraightTeeth(12, 42.5 * mm, 16.2 * mm, 3.3 * mm, 5.5 * mm, 2.0 * mm, 1.4 * mm, 1.4 * mm)
INSET = ComposedMachine(STATOR, InsetMagnets(10, 15.7 * mm, 2.5 * mm, 5.0 * mm, 0.8))
SPOKE = ComposedMachine(STATOR, Spoke(10, 15.7 * mm, 3.0 * mm, 6.0 * mm))
RELUCTANCE = ComposedMachine(
    RoundBottomSlots(24, 42.5 * mm, 67.5 * mm, 2.0 * mm, 0.8 * mm, 5.2 * mm, 7.6 * mm, 11.0 * mm),
    FluxBarriers(4, 3, 42.0 * mm, 14.0 * mm, 48.0 * mm, 15.0 * mm, 3.0 * mm, 4.0 * mm, 0.5 * mm),
)
TWO_LAYERS = ComposedMachine(
    V_SHAPE.stator,
    TwoLayerVShape(
        8, 80.2 * mm, 50.0 * mm, magnet_length=4.5 * mm, recess=0.8 * mm,
        inner_tip_depth=64.0 * mm, inner_tilt=61 * DEGREE, inner_magnet_width=18.0 * mm, inner_bridge=1.4 * mm,
        inner_bridge_start=16.3 * DEGREE, inner_bridge_end=18.6 * DEGREE,
        outer_tip_depth=74.0 * mm, outer_tilt=76 * DEGREE, outer_magnet_width=10.0 * mm, outer_bridge=1.2 * mm,
        outer_bridge_start=9.0 * DEGREE, outer_bridge_end=11.3 * DEGREE,
    ),
)  # fmt: skip
LOAVES = ComposedMachine(STATOR, BreadLoafMagnets(10, 15.7 * mm, 12.8 * mm, 7.6 * mm, 5.0 * mm))
CONSEQUENT = ComposedMachine(STATOR, ConsequentPole(8, 15.7 * mm, 2.5 * mm, 5.0 * mm, 1.1, 0.08))
SURFACE = ComposedMachine(STATOR, SurfaceMagnets(8, 15.7 * mm, 2.5 * mm, 5.0 * mm, 0.85, PARALLEL))
HALBACH = replace(OUTRUNNER, rotor=replace(OUTRUNNER.rotor, magnetisation=HalbachMagnetisation()))
CUT_OUT = replace(RELUCTANCE, rotor=OutlineRotor(4, *read_back(RELUCTANCE, "lamination_rotor"), 42.0 * mm))
PITCHES = {(48, 8): 6, (24, 4): 5, (48, 4): 11}  # of coils, by slots and poles; of all others one tooth
NAMED = {
    "outrunner": OUTRUNNER, "V shape": V_SHAPE, "inset": INSET, "spoke": SPOKE, "reluctance": RELUCTANCE,
    "two layers": TWO_LAYERS, "loaves": LOAVES, "consequent": CONSEQUENT, "ribbed V": RIBBED, "Halbach": HALBACH,
    "cut out": CUT_OUT, "cut out, magnets": cut_out_with_magnets()[1].machine, "own": own()[1].machine,
    "surface": SURFACE,
}  # fmt: skip


def section_of(machine: ComposedMachine, density: MeshDensity, whole: bool = False) -> CrossSection:
    layout = star_of_slots(machine.slots, machine.pole_pairs, 2, PITCHES.get((machine.slots, machine.poles), 1))
    return mesh_cross_section(machine, layout, density, whole)


def model_of(machine, density, steel=STEEL, magnet=Magnet(1.2, 1.05), whole=False, **settings):
    return FieldModel(section_of(machine, density, whole), MachineMaterials(steel, steel, magnet), **settings)


def currents(model: FieldModel, angle: float, amplitude: float, gamma: float, turns: float) -> PhaseCurrents:
    """i_d = -I sin gamma, i_q = I cos gamma; amplitude I [A], gamma and angle [rad]."""
    lag = model.section.machine.pole_pairs * angle - model.section.layout.phase_axis - 2 * np.pi / 3 * np.arange(3)
    phases = -amplitude * (np.sin(gamma) * np.cos(lag) + np.cos(gamma) * np.sin(lag))
    return PhaseCurrents(angle, tuple(phases.tolist()), turns)
