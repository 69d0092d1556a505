"""Which readings of several repeats were taken at one place."""

import numpy as np
import pytest

from workbench.data.repeats import matched_rows
from workbench.data.table import Table

SPEED, CURRENT = (column.ravel() for column in np.meshgrid([50.0, 150.0, 250.0], [20.0, 40.0, 60.0, 80.0]))
PLACES = len(SPEED)


def table(temperature, repeat, lost):
    """The load points again and again. temperature, repeat: of all rows (n,);  lost: rows that were not read"""
    rows, again = np.setdiff1d(np.arange(len(repeat)), lost), len(repeat) // PLACES
    conditions = {"speed": np.tile(SPEED, again), "i_q": np.tile(CURRENT, again), "winding_T": temperature}
    chosen = {name: column[rows] for name, column in conditions.items()}
    return Table("dq_operation", "f.csv", chosen, {}, repeat[rows], repeat[rows], np.zeros(len(rows), dtype=bool))


@pytest.mark.parametrize("kelvin, matched", [(3.0, PLACES - 2), (8.0, PLACES - 2), (40.0, None)])
def test_a_device_that_becomes_warm_from_repeat_to_repeat_is_at_the_same_place(kelvin, matched):
    """Its temperature was logged, not set, as current and speed tell all rows apart; each repeat has lost another row.
    Where it is quite another temperature, nothing was repeated."""
    repeat = np.repeat(np.arange(3), PLACES)
    warm = 30.0 + 0.3 * np.tile(CURRENT, 3) + kelvin * repeat
    stations = matched_rows(table(warm, repeat, lost=(2, PLACES + 7)))
    assert (None if stations is None else len(stations)) == matched


def test_temperatures_that_were_set_are_places_of_their_own():
    """Every load point cold and hot in one repeat: a reading that is lost has no partner at the other temperature."""
    both = np.tile(np.repeat([20.0, 40.0], PLACES), 2)
    found = table(both, np.repeat([0, 1], 2 * PLACES), lost=(5,))
    stations = matched_rows(found)
    assert len(stations) == 2 * PLACES - 1
    assert (np.ptp(found.conditions["winding_T"][stations], axis=1) == 0).all()
