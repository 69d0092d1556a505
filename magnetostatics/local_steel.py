"""Steel that is not the same everywhere in its region."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from geometry.cross_section import CrossSection
from materials.reluctivity import Reluctivity


@dataclass(frozen=True)
class LocalSteel:
    """Stands in ``MachineMaterials`` for a reluctivity law; the model asks it for the law of each element.

    law: of the steel before its local changes
    """

    law: Reluctivity

    def in_region(self, section: CrossSection, region: str) -> Reluctivity:
        """Law whose arrays (E,), if any, follow the elements of a named region of the mesh."""
        raise NotImplementedError


def law_in(steel: Reluctivity | LocalSteel, section: CrossSection, region: str) -> Reluctivity:
    """The law of a region's elements, whether its steel is the same everywhere or not."""
    return steel.in_region(section, region) if isinstance(steel, LocalSteel) else steel


def with_law(steel: Reluctivity | LocalSteel, change: Callable[[Reluctivity], Reluctivity]) -> Reluctivity | LocalSteel:
    """The same steel with its law changed everywhere."""
    return replace(steel, law=change(steel.law)) if isinstance(steel, LocalSteel) else change(steel)
