"""Points that no other one betters."""

import numpy as np
import pytest

from drivetrain.pareto import non_dominated


@pytest.mark.parametrize("objectives", [1, 2, 4])
def test_it_is_the_pairwise_definition(objectives):
    points = np.random.default_rng(1).integers(0, 5, (60, objectives)).astype(float)
    kept = points[non_dominated(points)]
    wanted = {tuple(p) for p in points if not any(np.all(q <= p) and np.any(q < p) for q in points)}
    assert {tuple(p) for p in kept} == wanted and len(kept) == len(wanted)
    assert (np.diff(kept[:, 0]) >= 0).all()
