"""Effects that act through the magnets of a machine."""

from __future__ import annotations

from typing import Any

from effects.base import DesignEffect
from effects.machine_design import BuiltMachine


class MagnetEffect(DesignEffect):
    """Acts on machines that have magnets; a reluctance machine has none."""

    designs = (BuiltMachine,)

    @classmethod
    def can_act_on(cls, design: Any) -> bool:
        return super().can_act_on(design) and design.magnet.remanence > 0
