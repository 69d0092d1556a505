"""The torque that a search of dimensions compares is the mean over the slots, not that of one place over them."""

from math import lcm, pi

import numpy as np
import pytest

from electrical.kind_search import FEWEST_ANGLES
from magnetostatics.positions import angles_past_slots, torque_period
from study.machine_file import MACHINES, read_machine

NAMES = sorted(path.stem for path in MACHINES.glob("*.toml"))


@pytest.mark.parametrize("name", NAMES)
def test_no_machine_stands_at_the_same_place_of_its_slots_at_every_angle(name):
    """The wave that the slots make of the torque has no mean over the angles."""
    machine = read_machine(name).machine
    count, order = angles_past_slots(machine, FEWEST_ANGLES), lcm(machine.slots, machine.repeats) // machine.pole_pairs
    electrical = torque_period(machine) * np.arange(count) / count
    assert count >= FEWEST_ANGLES
    waves = [np.mean(np.cos(order * electrical - phase)) for phase in (0.0, pi / 2)]
    assert np.hypot(*waves) < 1e-9


@pytest.mark.parametrize(("name", "count"), [("v_48_8", 4), ("outrunner_9_12", 4), ("synrm_48_4", 5)])
def test_four_angles_are_kept_where_they_tell(name, count):
    assert angles_past_slots(read_machine(name).machine, FEWEST_ANGLES) == count
