"""The gear set of thesis Table 3.11 and the request that it answers, with a Gaussian stand-in for the load spectrum."""

from dataclasses import replace

import pytest

from gearbox.bodies import Construction
from gearbox.flank import Lubrication
from gearbox.load_factors import Quality
from gearbox.material import CASE_HARDENED_ME
from gearbox.planetary_set import planetary_set
from gearbox.rating import Rules, StageLoad
from gearbox.search import CostScale, GearRequest, Safety
from gearbox.spectrum import gaussian_spectrum
from units import DEGREE, MILLIMETRE

MM = MILLIMETRE


@pytest.fixture(scope="session")
def printed():
    """Thesis Table 3.11: module 0.75 mm, 14, 46 and 109 teeth."""
    return planetary_set((14, 46, -109), (0.483, 0.076), 0.75 * MM)


@pytest.fixture(scope="session")
def rules():
    return Rules(CASE_HARDENED_ME, Quality(), Lubrication(100e-6, 4.8e-6, 20e-6))


@pytest.fixture(scope="session")
def load():
    """300 N RMS and 2614 N peak at 175 mm/rad for 750 h, swing 7.6 degrees (thesis text to eqs 3.121-3.123)."""
    spectrum = gaussian_spectrum(300 * 0.175, 0.1 / 0.175, class_width=10.0, duration=750 * 3600, swing=7.6 * DEGREE)
    return StageLoad(spectrum, 2614 * 0.175, 1.6 / 0.175)


@pytest.fixture(scope="session")
def request_of(load, rules):
    """Function: the motorcycle's gearbox request with changes."""
    base = GearRequest(
        ratio=76.0,
        ratio_tolerance=0.03,
        stage_count=2,
        envelope_diameter=85 * MM,
        load=load,
        rules=rules,
        safety=Safety(flank=1.0, root=1.1, static_flank=1.0, static_root=1.1),
        construction=Construction(bore_fraction=0.45, flange_fraction=0.25, least_flange=1.5 * MM, axial_gap=0.5 * MM),
        cost=CostScale(mass=4.0, equivalent_mass=15.0, weight=0.5, linkage_ratio=0.170),
        friction=0.06,
    )
    return lambda **changes: replace(base, **changes)
