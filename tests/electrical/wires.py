"""Wires and simple windings for the tests of all rooms."""

from math import pi, sqrt

from electrical.final_length import FinalLength, LengthNeed
from electrical.resistance import COPPER_RESISTIVITY_20
from electrical.winding_connection import SERIES_STAR
from electrical.winding_design import WindingDesign
from electrical.wire import Wire
from units import MILLIMETRE

HALF_MILLIMETRE = Wire(0.5 * MILLIMETRE, 0.544 * MILLIMETRE, COPPER_RESISTIVITY_20)  # grade 1


def wire_of(area, resistivity=COPPER_RESISTIVITY_20):
    """A wire of a copper section [m^2] and a resistivity [ohm m], its enamel a tenth of its diameter."""
    diameter = 2 * sqrt(area / pi)
    return Wire(diameter, 1.1 * diameter, resistivity)


def series_star(turns, strands, wire=HALF_MILLIMETRE, connection=SERIES_STAR):
    """Turns of wires in hand, all coils of a phase in series, in star."""
    return WindingDesign(turns, strands, wire, connection)


def given_lengths(count, length):
    """As many machines of one length [m]."""
    return (FinalLength(length, (LengthNeed("what is given", length),), length),) * count
