"""The code that a function depends on: the closure of the imports of its module, found, not listed.

Data files that lie in the folder of a module (steel curves, damper tables, templates) count with it.
"""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Callable, Iterator
from functools import cache
from importlib.metadata import packages_distributions, version
from pathlib import Path
from typing import Any

from pipeline.modules import PROJECT, module_file


@cache
def _imported(path: Path) -> frozenset[str]:
    """Every module name that a file may import, anywhere in it; ``from a import b`` counts as a and a.b."""
    names: set[str] = set()
    for node in _statements(ast.parse(path.read_bytes()).body):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(names)


def _statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Every statement, inside functions, classes and branches too.

    Expressions hold no imports and would take most of the time.
    """
    for node in body:
        yield node
        for inner in ("body", "orelse", "finalbody"):
            yield from _statements(getattr(node, inner, []))
        for branch in (*getattr(node, "handlers", ()), *getattr(node, "cases", ())):
            yield from _statements(branch.body)


@cache
def files_of(module: str) -> frozenset[Path]:
    """The files of the project that a module runs with, its own among them."""
    found: set[Path] = set()
    waiting = [module]
    while waiting:
        path = module_file(waiting.pop())
        if path is not None and path not in found:
            found.add(path)
            waiting += _imported(path)
    return frozenset(found | {data for folder in {path.parent for path in found} for data in _data_of(folder)})


@cache
def _data_of(folder: Path) -> frozenset[Path]:
    """Files that are no code, in the folder of a module and below."""
    if folder == PROJECT or not folder.is_relative_to(PROJECT):
        return frozenset()
    files = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return frozenset(path for path in files if path.suffix not in (".py", ".pyc") and not path.name.startswith("."))


@cache
def _file_hash(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def code_digest(*functions: Callable[..., Any]) -> str:
    """Hash of the names and contents of all files that the functions depend on."""
    files = sorted(frozenset().union(*(files_of(function.__module__) for function in functions)))
    lines = (f"{path.relative_to(PROJECT).as_posix()} {_file_hash(path)}" for path in files)
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def packages_of(*functions: Callable[..., Any]) -> dict[str, str]:
    """Installed version of every package that the code of the functions imports, and of Python."""
    files = frozenset().union(*(files_of(function.__module__) for function in functions))
    names = {name.partition(".")[0] for path in files if path.suffix == ".py" for name in _imported(path)}
    found = {owner for name in names for owner in _distributions().get(name, ())}
    return {"python": sys.version.split()[0], **{owner: _version(owner) for owner in sorted(found)}}


@cache
def _version(owner: str) -> str:
    return version(owner)


@cache
def _distributions() -> dict[str, list[str]]:
    return dict(packages_distributions())
