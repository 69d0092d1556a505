"""A section that a part of the design cannot do without."""

from __future__ import annotations

from typing import TypeVar

from study.errors import StudyError
from study.schema import Section

SectionType = TypeVar("SectionType", bound=Section)


def needed(section: SectionType | None, name: str) -> SectionType:
    """The section, which must be there. Raises StudyError where it is not; name: as it stands in the file."""
    if section is None:
        raise StudyError(f"the section [{name}] is missing; add it.")
    return section
