"""A wrong turn: a curve with four free coefficients and no physics, laid through whatever is left of one column."""

from dataclasses import astuple, dataclass

import numpy as np

from effects.base import ResponseEffect
from effects.parameter import parameter
from effects.prior import Normal

COLUMNS = {"impedance": ("re", "frequency"), "dq_operation": ("v_d", "i_q"), "cogging": ("torque", "angle_mech")}


def coefficient():
    """Weight of one polynomial: of any size, as nothing is known of it."""
    return parameter(0.0, "1", prior=Normal(1.0), low=-20.0, high=20.0, source="none: it is free")


@dataclass(frozen=True)
class OneTooMany(ResponseEffect):
    """y + 0.02 max|y| sum c_k T_(k+2)(x): Chebyshev polynomials over the range x of one condition."""

    title = "a curve through what is left"
    looks_like = "anything"

    c1: float = coefficient()
    c2: float = coefficient()
    c3: float = coefficient()
    c4: float = coefficient()

    def on_response(self, response, conditions, kind, design):
        if kind not in COLUMNS or self.is_null:
            return response
        column, over = COLUMNS[kind]
        x = np.log(np.abs(conditions[over])) if over == "frequency" else conditions[over]
        x = 2 * (x - x.min()) / np.ptp(x) - 1
        curve = np.polynomial.chebyshev.chebval(x, (0.0, 0.0, 0.0, *astuple(self)))
        return {**response, column: response[column] + 0.02 * np.abs(response[column]).max() * curve}
