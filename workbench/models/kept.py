"""Field solutions on disk: arrays by name in a folder, whose name tells everything that they depend on."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

import geometry
import magnetostatics
import materials
from disk import write_atomically

Arrays = dict[str, np.ndarray]


class KeptArrays:
    """Arrays in a folder, a file each name; None keeps nothing."""

    def __init__(self, folder: Path | None):
        self.folder = folder

    def read(self, name: str) -> Arrays | None:
        """None where nothing was kept, or where it cannot be read."""
        if self.folder is None:
            return None
        try:
            with np.load(self.folder / f"{name}.npz", allow_pickle=False) as data:
                return dict(data)
        except (OSError, ValueError, EOFError, KeyError, BadZipFile):
            return None

    def write(self, name: str, arrays: Arrays) -> None:
        """Whole or not at all."""
        if self.folder is not None:
            write_atomically(self.folder / f"{name}.npz", lambda path: np.savez(path, **arrays))


def key_of(words: str, code: Iterable[Path]) -> str:
    """Of what is solved, in words, and of every line of code and every material curve that solutions depend on.

    code: files beside those of geometry, materials and field
    """
    digest = hashlib.sha256(words.encode())
    folders = [Path(package.__file__ or "").parent for package in (geometry, magnetostatics, materials)]
    files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.suffix in (".py", ".csv")]
    for path in [*files, *code]:
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
