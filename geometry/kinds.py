"""The kinds of stators and rotors by name: one file each in ``geometry/stators`` and ``geometry/rotors``.

The name of a kind is that of its file, so that a new kind is a new file and nothing else. A user's own kind is a class
in a file of his own, ``my_rotor.py:MyRotor``.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType

from geometry import rotors, stators
from geometry.errors import GeometryError
from geometry.own_kinds import module_name
from geometry.parts import Part, Rotor, Stator


@dataclass(frozen=True)
class Kinds:
    """The known kinds of one sort of part, by name."""

    sort: str
    base: type[Part]
    known: Mapping[str, type[Part]]

    def named(self, name: str, folder: Path = Path(".")) -> type[Part]:
        """The class of a kind; folder: from which the path of a user's own file counts.

        Raises GeometryError where there is no such kind.
        """
        file, colon, own = name.rpartition(":")
        if colon:
            return self._own(folder / file, own)
        if name not in self.known:
            raise GeometryError(
                f"unknown kind of {self.sort} {name!r}: known are {', '.join(sorted(self.known))}, or name a class of "
                "your own as file.py:Class"
            )
        return self.known[name]

    def _own(self, file: Path, name: str) -> type[Part]:
        found = getattr(_loaded(file), name, None)
        if not (isinstance(found, type) and issubclass(found, self.base)):
            raise GeometryError(f"{file} has no class {name} that is a {self.base.__name__} of geometry.parts")
        if not is_dataclass(found) or found.__hash__ is None:
            raise GeometryError(f"{name} in {file} is not frozen: write @dataclass(frozen=True) above it")
        if lacking := _lacking(found, self.base):
            what = f"{self.base.__name__} in geometry.parts says what is asked"
            raise GeometryError(f"{name} in {file} lacks {', '.join(lacking)}; {what}")
        return found


def _kinds(sort: str, package: ModuleType, base: type[Part]) -> Kinds:
    names = (found.name for found in iter_modules(package.__path__))
    return Kinds(sort, base, {name: _kind_of(import_module(f"{package.__name__}.{name}"), base) for name in names})


def _kind_of(module: ModuleType, base: type[Part]) -> type[Part]:
    """The one class of a module that is such a part."""
    own = (one for one in vars(module).values() if isinstance(one, type) and one.__module__ == module.__name__)
    (kind,) = (one for one in own if issubclass(one, base))
    return kind


def _lacking(found: type[Part], base: type[Part]) -> list[str]:
    """Names that a part must have of its own: neither fields nor another thing than in the base."""
    stated = {one.name for one in fields(found)}  # type: ignore[arg-type]  # a part is a dataclass
    return [name for name in base.asked if name not in stated and _of(found, name) is _of(base, name)]


def _of(cls: type[Part], name: str) -> object:
    return getattr(cls, name, None)


def _loaded(file: Path) -> ModuleType:
    if not file.is_file() or file.suffix != ".py":
        raise GeometryError(f"there is no Python file {file}; its path counts from the folder of the machine's file")
    try:
        return import_module(module_name(file))
    except Exception as error:  # whatever the file does
        raise GeometryError(f"{file} cannot be loaded: {type(error).__name__}: {error}") from error


STATORS = _kinds("stator", stators, Stator)
ROTORS = _kinds("rotor", rotors, Rotor)
