"""How a machine is cooled and how warm it may be, with what counts where nobody states it."""

from __future__ import annotations

from dataclasses import dataclass

from thermal.air import Film, StillAir
from thermal.slot import Liner
from units import MILLIMETRE

AMBIENT = 40.0  # degC, largest temperature of the coolant for which a rating counts (IEC 60034-1)
MAGNET_LIMIT = 120.0  # degC, working temperature of sintered NdFeB with the letter H (makers' data sheets)
EMISSIVITY = 0.9  # painted or anodised; bare machined aluminium 0.05 to 0.1 (Incropera, Table A.11)
FILLER_CONDUCTIVITY = 0.2  # W/(m K), unfilled varnish or epoxy; 0.03 where nothing is impregnated, to 1 where potted
LINER_THICKNESS = 0.25 * MILLIMETRE  # usual for low voltage; estimate
LINER_CONDUCTIVITY = 0.14  # W/(m K), aramid paper of 0.25 mm (maker's data)
# Of shrunk and pressed laminations in aluminium: 0.01 to 0.04 mm (Staton, Boglietti and Cavagnino, IEEE Trans. Energy
# Convers. 20(3) (2005)); 0.03 mm is what Altair FluxMotor takes where nothing is stated.
CASING_GAP = 0.03 * MILLIMETRE


@dataclass(frozen=True)
class Cooling:
    """What leads the heat away, beside the machine itself.

    ambient: of the air and of the mount [degC]; film: of the outside of the casing
    mount: conductance from the casing to what it is mounted on [W/K], 0 where nothing is known
    filler_conductivity: of what fills the slot between the wires [W/(m K)]; liner: of the slot
    casing_gap: gap of air that stands for the contact of laminations and casing [m]
    """

    ambient: float = AMBIENT
    film: Film = StillAir(EMISSIVITY)
    mount: float = 0.0
    filler_conductivity: float = FILLER_CONDUCTIVITY
    liner: Liner = Liner(LINER_THICKNESS, LINER_CONDUCTIVITY)
    casing_gap: float = CASING_GAP


@dataclass(frozen=True)
class HeatLimits:
    """copper: hottest place of the winding [degC]; magnets: their mean [degC]."""

    copper: float
    magnets: float = MAGNET_LIMIT
