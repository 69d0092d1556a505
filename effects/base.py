"""The kinds of effect. An effect is one physical reason, with its own parameters, acting at one place:

    conditions as read --InstrumentEffect.on_condition--> true conditions
    true conditions --StateEffect.on_state--> conditions and state of the device in each row
    design --DesignEffect.on_design--> design as built, as warm --model--> response
    response --ResponseEffect.on_response--> what the model leaves out --InstrumentEffect.on_reading--> reading

An effect is a frozen dataclass; its parameters are fields made by ``effects.parameter.parameter``. At the null of every
parameter it changes nothing, bit for bit. An effect never calls a solver.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from effects.parameter import parameters_of
from effects.signature import Claim

Columns = Mapping[str, np.ndarray]  # column name -> values in SI (n,)


class Effect:
    """Common to all kinds.

    title: a few words for a table;  looks_like: one sentence, what it does to the data
    remedy: measurements that show it
    designs: types of design it can act on; empty means any
    contains: effects that are special cases of this one, never combined with it
    exceeds: input that its first parameter moves, beyond the tolerance that a campaign may declare of it
    signature: what its vanishing size does to readings, to be verified on the model [claims]
    model_error: declared relative error of the effect's own law; zero where the law defines the effect
    size_error: declared relative error of its first parameter for the same reason, where it stands
    model_error_source: what they were measured against, or rest on
    base_rate: how often a bench campaign of such a device has it, before anything is measured [1]
    base_rate_source: why it is believed to be that
    """

    title: ClassVar[str]
    looks_like: ClassVar[str]
    remedy: ClassVar[tuple[str, ...]] = ()
    designs: ClassVar[tuple[type, ...]] = ()
    contains: ClassVar[tuple[str, ...]] = ()
    exceeds: ClassVar[str] = ""
    signature: ClassVar[tuple[Claim, ...]] = ()
    model_error: ClassVar[float] = 0.0
    size_error: ClassVar[float] = 0.0
    model_error_source: ClassVar[str] = ""
    base_rate: ClassVar[float] = 0.02
    base_rate_source: ClassVar[str] = "one of about fifty things that a campaign may hide, none of them likelier"

    @classmethod
    def name(cls) -> str:
        """The class name in snake case; how files and the command line speak of it."""
        return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", cls.__name__).lower()

    @classmethod
    def variants(cls, design: Any) -> tuple[Effect, ...]:
        """Null effects that are alternatives of one effect, for example one for each magnet that may be weak."""
        return (cls(),)

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return not cls.designs or isinstance(design, cls.designs)

    @property
    def law_error(self) -> float:
        """Relative error of its own law that a fit takes it with [1]."""
        return self.model_error

    @property
    def with_errors(self) -> tuple[Effect, ...]:
        """The effect with every error that its law may have, believed alike; only one where that was measured."""
        return (self,)

    @property
    def is_null(self) -> bool:
        return all(getattr(self, name) == p.null for name, p in parameters_of(self).items())

    def at(self, z: np.ndarray) -> Effect:
        """This effect with its parameters at standard normal numbers z (one a parameter), kept inside their bounds."""
        priors = parameters_of(self).items()
        values = {name: float(min(max(p.prior.value(z_i), p.low), p.high)) for (name, p), z_i in zip(priors, z)}
        return replace(self, **values)


class DesignEffect(Effect):
    """The thing on the bench is not as drawn, or not as cold."""

    def on_design(self, design: Any) -> Any:
        """The changed design."""
        raise NotImplementedError


class StateEffect(Effect):
    """What state the device is in, row by row, that nobody read: its own heating.

    States are columns beside the conditions, each over its value in the design [1], and one where there is none:
    "resistance_factor" of the winding, "viscous_factor" of a damper, "flux_factor" of the magnets of a dq machine.
    """

    def on_state(self, conditions: Columns, kind: str, design: Any) -> Columns:
        """The conditions with states added or changed.

        conditions: true ones, and "order", how far each row is through its scan in the order of acquisition, 0 to 1
        """
        raise NotImplementedError


class ResponseEffect(Effect):
    """What the model leaves out, added to what it answers."""

    def on_response(self, response: Columns, conditions: Columns, kind: str, design: Any) -> Columns:
        """The changed response columns of one table.

        response, conditions: columns of the table in SI, and "order" as in ``InstrumentEffect.on_reading``
        kind: measurement kind of the table
        """
        raise NotImplementedError


class InstrumentEffect(Effect):
    """What an instrument shows instead of what is there."""

    def on_condition(self, conditions: Columns, kind: str) -> Columns:
        """True conditions from those read."""
        return conditions

    def on_reading(self, response: Columns, conditions: Columns, kind: str) -> Columns:
        """Readings from the true response.

        conditions: true ones, and "order", how far each row is through its scan in the order of acquisition, 0 to 1
        """
        return response
