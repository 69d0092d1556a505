"""Where the modules of this project lie."""

from __future__ import annotations

import sys
from functools import cache
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent


@cache
def module_file(name: str) -> Path | None:
    """The file of a module of the project, None for one from elsewhere."""
    place = PROJECT.joinpath(*name.split("."))
    if place.with_suffix(".py").is_file():
        return place.with_suffix(".py")
    initial = place / "__init__.py"
    return initial if initial.is_file() else _file_of_package_without_init(place, name)


def _file_of_package_without_init(place: Path, name: str) -> Path | None:
    """A module that is loaded from a folder outside the project's root, such as one of its tests."""
    loaded = getattr(sys.modules.get(name), "__file__", None)
    own = loaded is not None and Path(loaded).resolve().is_relative_to(PROJECT)
    return Path(loaded) if own and ".venv" not in loaded else None
