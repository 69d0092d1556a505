"""The examples of the suspension run, and their controller and vehicle do what they say."""

import re

import numpy as np

from examples.suspension import own_controller, own_vehicle
from vehicle.commands import Felt


def test_own_controller(capsys):
    own_controller.main()
    comfort, holding, power, battery = (float(number) for number in re.findall(r"-?\d+\.\d+", capsys.readouterr().out))
    assert 0.03 < comfort < 0.05 and 0.05 < holding < 0.08  # between skyhook and the minimum damping
    assert battery < power and 10 < power < 20
    assert own_controller.semi_active_skyhook(Felt(0.0, 0.0, 0.0, 0.1, 0.2, 0.0, 0.0)) == np.float64(-180.0)
    assert own_controller.semi_active_skyhook(Felt(0.0, 0.0, 0.0, 0.2, 0.1, 0.0, 0.0)) == np.float64(460.0)


def test_own_vehicle(capsys):
    own_vehicle.main()
    words = capsys.readouterr().out
    low, high = (int(number) for number in re.findall(r"stroke (-?\d+) to (-?\d+)", words)[0])
    assert -120 < low < -20 and 20 < high < 120 and "rad/s" in words
    assert own_vehicle.Van().natural_frequencies[0] > 0.8
