"""The duty of the road is every seed, one after the other, as it was driven."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from vehicle.heat_duty import road_duty


def test_all_seeds_count_with_their_time_step():
    force, velocity = np.arange(6.0).reshape(2, 3), -np.arange(6.0).reshape(2, 3)
    data = {"force": (("seed", "time"), force), "velocity": (("seed", "time"), velocity)}
    found = road_duty(SimpleNamespace(nominal=xr.Dataset(data, {"seed": [0, 1], "time": [0.0, 0.01, 0.02]})))
    assert found.effort.tolist() == [0, 1, 2, 3, 4, 5] and found.step == pytest.approx(0.01)
    assert found.speed_rms == pytest.approx(np.sqrt(55 / 6))
