"""The quarter car of thesis chapter 4: vehicle, damping, road and settings, on which its tables stand."""

from __future__ import annotations

from collections.abc import Sequence

from units import FACTORS
from vehicle.damping import linear_damper
from vehicle.demands import RideCase
from vehicle.models import QuarterCar
from vehicle.quarter_car import LqrWeights
from vehicle.ride import Scenario
from vehicle.road import IsoRoad, roughness_of_class

# Table 4.4
PRINTED_CAR = QuarterCar(sprung_mass=417.0, unsprung_mass=40.0, spring_stiffness=23e3, tyre_stiffness=126e3)
PRINTED_SPEED = 70 * FACTORS["km_per_h"]  # m/s, text to Fig. 4.22
PRINTED_DURATION = 15.0  # s, the same
PRINTED_ROAD = "B"  # class, the same
# s, for which the road's noise is held; not printed, but with 1 ms the indices of Tables 4.6-4.14 come out 3 to 8 %
# higher than the printed ones, with 10 ms they do not
PRINTED_SAMPLE = 1e-2
# Maximum and minimum damping: the steepest part of Fig. 4.21, which is a figure only, as straight lines
PRINTED_DAMPING = linear_damper(10e3, "maximum"), linear_damper(2.6e3, "minimum")  # Ns/m, text to Fig. 4.21
# Settings of Table 4.1; the decimals come from the grid 10^(8 k / 49) on which they were found.
HANDLING = LqrWeights(stroke=3.39e6, wheel=10 ** (8 * 45 / 49))  # printed 3.39e6 and 22.23e6
TRADE_OFF = LqrWeights(stroke=10 ** (8 * 10 / 49), wheel=10 ** (8 * 34 / 49))  # printed 42.9 and 3.56e5
COMFORT = LqrWeights(stroke=1.0, wheel=1.0)


def printed_road(seed: int) -> Scenario:
    """The random road of chapter 4 with a seed, which the thesis does not print."""
    road = IsoRoad(roughness_of_class(PRINTED_ROAD), seed, PRINTED_SAMPLE)
    return Scenario("road of chapter 4", PRINTED_SPEED, PRINTED_DURATION, road)


def printed_case(seeds: Sequence[int]) -> RideCase:
    """The rides of Tables 4.6-4.14, once a seed."""
    return RideCase(PRINTED_CAR, PRINTED_DAMPING, tuple(printed_road(seed) for seed in seeds), (), 0.0)
