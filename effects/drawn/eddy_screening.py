"""Solid iron under an alternating field."""

from __future__ import annotations

from dataclasses import dataclass

from effects.base import Columns, ResponseEffect
from effects.drawn_design import DrawnAsBuilt
from effects.parameter import parameter
from effects.prior import LogNormal
from effects.signature import Touches


@dataclass(frozen=True)
class EddyScreening(ResponseEffect):
    """An inductance meter drives alternating current: eddy currents in solid rotor iron keep its field out.

    The part of the flux that crosses the gap falls by the share, slots and ends keep theirs. Three phases 120 degrees
    apart have the mutual inductance M = -L_gap / 2, so that M -> (1 - s) M,  L -> L + 2 s M,  two phases in series
    L_ab -> L_ab + 6 s M.
    """

    title = "eddy currents under an inductance meter"
    looks_like = "a measured mutual inductance below that of the field, the self-inductance by twice as many henry"
    remedy = ("inductance at 50 or 100 Hz beside 1 kHz", "flux linkage by integrating the voltage of a current step")
    designs = (DrawnAsBuilt,)
    signature = (Touches("inductance.l_a"), Touches("inductance.l_m"))
    base_rate = 0.03
    base_rate_source = "engineering judgement: small machines have solid cups or cores, meters work at 1 kHz by default"
    model_error = 0.1  # one share for all of the gap's flux
    model_error_source = "engineering judgement: the skin is thinner than the cup; phases differ"

    share: float = parameter(
        0.0, "1", prior=LogNormal(0.15, 0.7), low=0.0, high=0.9,
        source="engineering judgement: the skin of steel at 1 kHz is a few tenths of a millimetre",
    )  # fmt: skip

    def on_response(self, response: Columns, conditions: Columns, kind: str, design: DrawnAsBuilt) -> Columns:
        if kind != "inductance" or self.is_null:
            return response
        across = self.share * response["l_m"]
        less = {"l_a": 2 * across, "l_m": -across, **{f"l_{pair}": 6 * across for pair in ("ab", "bc", "ca")}}
        return {name: values + less.get(name, 0.0) for name, values in response.items()}
