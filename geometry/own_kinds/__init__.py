"""Users' own files as modules, ``geometry.own_kinds.PATH_TEXT``: where the file lies and what stands in it, in hex.

Another process and a stored result know a class by the name of its module alone. By this name they find the file again,
and a class whose file was edited since is another one.
"""

from __future__ import annotations

import sys
from hashlib import sha256
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from importlib.util import spec_from_file_location
from os import fsdecode, fsencode
from pathlib import Path

_DIGITS = 16  # of the hash of the text


def module_name(file: Path) -> str:
    """Of a Python file as it stands now."""
    text = sha256(file.read_bytes()).hexdigest()[:_DIGITS]
    return f"{__name__}.{fsencode(file.resolve()).hex()}_{text}"


def is_loaded(module: str) -> bool:
    """Whether a name is that of a user's file which this process has imported already."""
    return module.startswith(f"{__name__}.") and module in sys.modules


class _ByItsName(MetaPathFinder):
    """Finds the file of such a module, unless it is gone or was edited."""

    def find_spec(self, fullname: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if not fullname.startswith(f"{__name__}."):
            return None
        file = Path(fsdecode(bytes.fromhex(fullname.removeprefix(f"{__name__}.").partition("_")[0])))
        return spec_from_file_location(fullname, file) if file.is_file() and module_name(file) == fullname else None


sys.meta_path.append(_ByItsName())
