"""Every effect there is: those of the package, and those of files that the user names."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import pkgutil
import sys
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

import effects
from effects.base import Effect
from effects.parameter import parameters_of

Library = dict[str, type[Effect]]


def package_effects() -> Library:
    """Effects of the package by name, in alphabetical order."""
    modules = pkgutil.walk_packages(effects.__path__, effects.__name__ + ".")
    return _named(cls for module in modules for cls in effects_in(importlib.import_module(module.name)))


def effects_of_file(path: str | Path) -> Library:
    """Effects written in one Python file. The file is imported, which runs it: only for files that the user named."""
    path = Path(path).resolve()
    spec = importlib.util.spec_from_file_location(f"user_effects_{path.stem}", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their own module up
    spec.loader.exec_module(module)
    return _named(effects_in(module))


def library(user_files: Iterable[str | Path] = ()) -> Library:
    """All effects of the package and of the named files (a folder: its .py files); a user's effect replaces its
    namesake."""
    found = package_effects()
    for path in map(Path, user_files):
        for file in sorted(path.glob("*.py")) if path.is_dir() else [path]:
            found |= effects_of_file(file)
    return _named(found.values())


def effects_in(module: ModuleType) -> list[type[Effect]]:
    """Concrete effects defined in a module: frozen dataclasses with a title and at least one parameter."""
    classes = [cls for _, cls in inspect.getmembers(module, inspect.isclass) if cls.__module__ == module.__name__]
    return [cls for cls in classes if issubclass(cls, Effect) and hasattr(cls, "title") and _has_parameters(cls)]


def _has_parameters(cls: type) -> bool:
    return hasattr(cls, "__dataclass_fields__") and bool(parameters_of(cls))


def _named(classes: Iterable[type[Effect]]) -> Library:
    return {cls.name(): cls for cls in sorted(classes, key=lambda cls: cls.name())}
