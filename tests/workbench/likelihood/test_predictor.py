"""What a predictor says of devices that cannot be: a fit must turn back there, not end."""

import numpy as np
import pytest

from geometry.errors import GeometryError
from materials.errors import MaterialError
from tests.workbench.toy_bench import LIBRARY, SpringModel, written
from workbench.data.campaign import read_campaign
from workbench.errors import WorkbenchError
from workbench.likelihood.bench import bench_of
from workbench.likelihood.fit import fitted
from workbench.models.model import Model

SOFTEST = 800.0  # N/m


class Wound(SpringModel):
    """Springs softer than the softest cannot be wound."""

    def __init__(self, error):
        self.error = error

    def with_tolerance(self, design, tolerance, z):
        moved = super().with_tolerance(design, tolerance, z)
        if moved.stiffness < SOFTEST:
            raise self.error(f"a spring of {moved.stiffness:g} N/m cannot be wound")
        return moved


@pytest.fixture(params=[GeometryError, MaterialError])
def problem(request, tmp_path):
    """One tolerance of one per cent; the readings are of a spring a little softer than can be wound."""
    campaign, model = read_campaign(written(tmp_path, stiffness=SOFTEST - 10)), Wound(request.param)
    return bench_of(Model(model, model.design(campaign.device)), campaign, LIBRARY).fit


def test_there_can_be_no_such_device(problem):
    far = np.zeros(len(problem.start))
    far[0] = -30.0
    with pytest.raises(WorkbenchError, match="no such device: a spring of 700 N/m cannot be wound"):
        problem.predictor.predict(far)


def test_a_step_to_such_a_device_is_shortened(problem):
    found = fitted(problem, (), np.zeros(len(problem.start)), np.zeros(0))
    assert -20.0 <= found.x[0] < -19.0
