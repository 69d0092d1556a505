"""What looks wrong in a table is said, and nothing is said of a sound one."""

import numpy as np
import pytest

from workbench.data.suspicions import suspicions
from workbench.data.table import Response, Table

N = 60
RANDOM = np.random.default_rng(2)
ANGLE = np.linspace(0.0, 6.0, N)
TORQUE = np.round(0.05 * np.sin(7 * ANGLE) + 0.002 * RANDOM.standard_normal(N), 5)
OTHER = np.round(RANDOM.standard_normal(N), 5)


def said(torque=TORQUE, force=OTHER, angle=ANGLE, repeat=None, **conditions):
    repeat = np.repeat([0, 1], N // 2) if repeat is None else repeat
    responses = {n: Response(n, v, np.full(len(v), 0.002), "") for n, v in (("torque", torque), ("force", force))}
    n = len(torque)
    scan = np.zeros(n, dtype=int)
    table = Table(
        "cogging", "f.csv", {"angle_mech": angle, **conditions}, responses, scan, repeat[:n], scan.astype(bool),
        lines=np.arange(2, n + 2),
    )  # fmt: skip
    return " ".join(suspicions(table))


@pytest.mark.parametrize(
    "words, wrong",
    [
        ("torque has the same value in every row", said(torque=np.full(N, 0.1))),
        ("torque has the same value in 10 rows from line 22 on", said(torque=TORQUE[np.r_[0:20, [20] * 9, 20:51]])),
        ("torque and force are equal in every row", said(force=TORQUE)),
        ("angle_mech has the same value in every row", said(angle=np.zeros(N))),
        ("time runs backwards in line 12", said(time=np.r_[0:10.0, 3:53.0])),
        ("only 6 rows", said(TORQUE[:6], OTHER[:6], ANGLE[:6])),
    ],
)  # fmt: skip
def test_a_fault_is_said_and_a_sound_table_is_not_accused(words, wrong):
    assert words in wrong
    assert said(time=np.arange(N) * 1.0) == ""


def test_coarse_digits_are_no_stuck_sensor():
    """Readings of a quiet signal in coarse digits are often equal; that alone means nothing."""
    coarse = np.round(np.linspace(0.0, 1.0, N) + 0.01 * RANDOM.standard_normal(N), 1)
    assert "stuck" not in said(torque=coarse)
