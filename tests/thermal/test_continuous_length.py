"""The length for a continuous torque by temperature, against the rating of the machine that has this length."""

from dataclasses import dataclass, replace
from math import inf
from types import SimpleNamespace

import numpy as np
import pytest

from electrical.dq import DriveLimits
from electrical.winding_connection import Delta, WindingConnection
from electrical.winding_stage import over_copper
from losses.iron import FrequencyTerms
from losses.map import FieldLosses, LossGrid
from tests.electrical.analytic_map import ERROR, MATCHED, AnyLength, Saturating, flux_map
from tests.electrical.wires import series_star
from tests.thermal.test_stage import BUILT, HEAT
from thermal.continuous_length import LengthByTemperature, first_root
from thermal.cooling import HeatLimits
from thermal.field_loss import FieldHeat, FieldLoss, NoLossData
from thermal.rating import continuous
from thermal.stage import Assembled
from units import MILLIMETRE

MAP = flux_map(Saturating())
DESIGN = series_star(10, 15)
SPEED = 100.0  # rad/s
IRON = 0.4  # W s/m, hysteresis of the stator at any current
NOTHING = FrequencyTerms(0.0, 0.0, 0.0)
GRID = LossGrid.of(MATCHED.machine.rotor, 1.02 * MAP.overload_ampere_turns)
TABLE = GRID.table([FieldLosses(FrequencyTerms(IRON, 0.0, 0.0), NOTHING, NOTHING) for _ in GRID.points])


@dataclass(frozen=True)
class SameCasing:
    """One that does not grow with the machine."""

    def around(self, wound):
        return BUILT


def need(torque, speed=0.0, table=None, inputs=HEAT, longest=70 * MILLIMETRE):
    return LengthByTemperature(MAP, MATCHED.machine, table, SameCasing(), inputs, torque, speed, longest)


@dataclass(frozen=True)
class Hysteresis(FieldLoss):
    """That of the table, of a length [m]."""

    length: float
    known = True

    def at(self, torque, speed):
        stator = IRON * MATCHED.machine.pole_pairs * np.abs(speed) / (2 * np.pi) * self.length + 0.0 * torque
        return FieldHeat(stator, 0 * stator, 0 * stator, 0 * stator)


def rated(length, speed, field, inputs=HEAT):
    """Continuous torque by the currents, on a supply without limit [Nm]."""
    wound = need(1.0).wound(DESIGN, length)
    winding = SimpleNamespace(wound=wound, limits=DriveLimits(MAP.overload_ampere_turns / DESIGN.turns, 1e6))
    return continuous(Assembled(MAP, winding, BUILT, field, inputs).heated(speed * BUILT.ratio)).torque


@pytest.mark.parametrize(
    ("limits", "speed", "table"),
    ((HeatLimits(155.0, 120.0), 0.0, None), (HeatLimits(110.0, 200.0), 0.0, None), (HEAT.limits, SPEED, TABLE)),
    ids=("magnets", "winding", "turning"),
)
def test_the_machine_of_the_length_is_rated_at_the_torque_and_the_error_of_its_mesh(limits, speed, table):
    """The rating searches a current at one length, the need a length at one torque."""
    inputs = replace(HEAT, limits=limits)
    length = need(2.0, speed, table, inputs).length(DESIGN)
    field = NoLossData() if table is None else Hysteresis(length)
    assert rated(length, speed, field, inputs) == pytest.approx(2.0 / (1 - ERROR), rel=2e-4)


def test_more_torque_a_turning_field_and_less_copper_need_more_length():
    plain = need(2.0).length(DESIGN)
    assert need(2.4).length(DESIGN) > 1.1 * plain
    assert need(2.0, SPEED, TABLE).length(DESIGN) > plain
    assert need(2.0).length(series_star(10, 12)) > 1.05 * plain


def test_turns_at_the_same_copper_do_not_change_it():
    assert need(2.0).length(series_star(5, 30)) == pytest.approx(need(2.0).length(DESIGN), rel=1e-6)


def test_a_delta_pays_for_the_current_round_it():
    """The map's zero sequence is a linkage in phase in all three, which closes round the triangle."""
    delta = series_star(10, 15, connection=WindingConnection(1, Delta()))
    data = MAP.data.assign(psi_0=(("order", "id", "iq"), np.full((1, *MAP.data.psi_d.shape[1:]), 3e-3)), l_0=4e-5)
    mapped = replace(MAP, data=data.assign_coords(order=[3]))
    star, closed = (replace(need(2.0, SPEED), flux_map=mapped).length(one) for one in (DESIGN, delta))
    assert closed > 1.005 * star


def test_no_length_is_enough_where_the_surroundings_are_at_the_limit():
    assert need(2.0, inputs=replace(HEAT, limits=HeatLimits(155.0, 39.0))).length(DESIGN) == inf


def test_a_length_beyond_the_longest_is_still_found():
    assert need(2.0).length(DESIGN) == pytest.approx(need(2.0, longest=20 * MILLIMETRE).length(DESIGN), rel=1e-5)


@pytest.mark.parametrize(("high", "root"), ((9.0, 3.0), (2.5, inf)))
def test_the_first_root_is_the_smallest_length(high, root):
    assert first_root(lambda x: (x - 3.0) * (x - 8.0), 1.0, high) == pytest.approx(root)
    assert first_root(lambda x: x - 2.0, 1.0, high) == 1.0


def test_between_coppers_the_length_is_interpolated():
    """The inverse of a length in proportion to the inverse of the copper is a straight line."""

    @dataclass(frozen=True)
    class Inverse(AnyLength):
        def length(self, design):
            return 1e-6 / design.copper_area

    designs = tuple(series_star(turns, 1) for turns in range(40, 80))
    law = over_copper(Inverse(), designs)
    assert [law(one.copper_area) for one in designs] == pytest.approx([one.copper_area / 1e-6 for one in designs])
    assert over_copper(AnyLength(inf), designs)(designs[5].copper_area) == 0.0
    assert over_copper(AnyLength(0.02), designs[:1])(designs[0].copper_area) == pytest.approx(50.0)
