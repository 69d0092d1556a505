"""The results folder of a study: artefacts, the files made of them, and where each came from.

Beside the results stands ``provenance/<name>.json``: hashes of everything that was read, hashes of everything that was
written. A result is current when both are as they were; a byte edited in either is noticed.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TextIO

from disk import PART, write_atomically
from labelled import xr
from pipeline.codec import CodecError, decoded, encoded
from pipeline.modules import PROJECT
from study.schema import Study

if sys.platform != "win32":  # which has no advisory locks of this kind
    import fcntl


class ResultsError(RuntimeError):
    """A results folder that cannot be used; one sentence says why and what to do."""


@dataclass(frozen=True)
class Results:
    """The folder of one study's results."""

    folder: Path

    # ---- one run at a time ------------------------------------------------------------------------------------------

    @contextmanager
    def held(self) -> Iterator[None]:
        """Hold the folder against other runs; ResultsError where one is at work in it, or it cannot be written."""
        with said_of(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
            lock = open(self.folder / ".lock", "a", encoding="utf-8")
        with lock:
            _take(lock, self.folder)
            self._sweep_up()
            yield

    def _sweep_up(self) -> None:
        """Temporary files of a run that was killed."""
        for path in self.folder.rglob(f".*{PART}*"):
            with suppress(OSError):
                path.unlink()

    # ---- what is there ----------------------------------------------------------------------------------------------

    def record(self, name: str) -> dict[str, Any] | None:
        """The provenance of a result, None where it is absent, malformed, or does not fit what lies in the folder."""
        try:
            found = json.loads(self._provenance(name).read_text(encoding="utf-8"))
            outputs = {str(key): str(value["sha256"]) for key, value in found["outputs"].items()}
            dict(found["inputs"])
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            return None
        return found if all(self._hash(key) == value for key, value in outputs.items()) else None

    def _hash(self, name: str) -> str | None:
        try:
            return hashlib.sha256((self.folder / name).read_bytes()).hexdigest()
        except OSError:
            return None

    def _provenance(self, name: str) -> Path:
        return self.folder / "provenance" / f"{name}.json"

    def checkpoint_file(self, stage: str, what: str) -> Path:
        """Where the finished tasks of one call of a stage are kept."""
        return self.folder / "checkpoints" / f"{stage}, {what}.jsonl"

    # ---- writing ----------------------------------------------------------------------------------------------------

    def write(self, name: str, writer: Callable[[Path], object]) -> None:
        """Fill a file of the folder; ResultsError where the disk does not take it."""
        with said_of(self.folder / name):
            write_atomically(self.folder / name, writer)

    def forget(self, name: str) -> None:
        """From here on the result does not look current."""
        with said_of(self._provenance(name)):
            self._provenance(name).unlink(missing_ok=True)

    def keep(self, name: str, outputs: list[str], record: dict[str, Any]) -> None:
        """Write the provenance of a finished result; outputs: the files it consists of."""
        hashes = {one: {"sha256": self._hash(one), "bytes": (self.folder / one).stat().st_size} for one in outputs}
        text = json.dumps({**record, "outputs": hashes}, indent=2, default=str) + "\n"
        with said_of(self._provenance(name)):
            write_atomically(self._provenance(name), lambda path: path.write_text(text, encoding="utf-8"))

    # ---- artefacts --------------------------------------------------------------------------------------------------

    def save(self, name: str, artefact: Any) -> list[str]:
        """Write an artefact as ``<name>.json``, its datasets as ``<name>.nc``, ``<name>_2.nc``; returns the names."""
        datasets: list[xr.Dataset] = []
        content = encoded(artefact, datasets)
        text = json.dumps(content, indent=1, allow_nan=False) + "\n"
        self.write(f"{name}.json", lambda path: path.write_text(text, encoding="utf-8"))
        for number, data in enumerate(datasets):
            self.write(_dataset_file(name, number), data.to_netcdf)
        return [f"{name}.json", *(_dataset_file(name, number) for number in range(len(datasets)))]

    def load(self, name: str) -> Any:
        """The artefact of a finished stage; CodecError where the file is none."""
        try:
            content = json.loads((self.folder / f"{name}.json").read_text(encoding="utf-8"))
            return decoded(content, _Datasets(self.folder, name))
        except (OSError, ValueError, RecursionError) as error:
            raise CodecError(f"{name}.json cannot be read ({error})") from error


def results_of(study: Study) -> Results:
    """The results folder of a study."""
    return Results(PROJECT / "results" / study.study.id)


@dataclass(frozen=True)
class _Datasets:
    """The datasets of an artefact, opened when asked for."""

    folder: Path
    name: str

    def __getitem__(self, number: int, /) -> xr.Dataset:
        with xr.open_dataset(self.folder / _dataset_file(self.name, number)) as data:
            return data.load()


def _dataset_file(name: str, number: int) -> str:
    return f"{name}.nc" if number == 0 else f"{name}_{number + 1}.nc"


def _take(lock: TextIO, folder: Path) -> None:
    if sys.platform == "win32":
        return
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise ResultsError(
            f"another run is at work in {folder}; wait until it has ended, or give the study another study.id"
        ) from None


@contextmanager
def said_of(path: Path) -> Iterator[None]:
    """An ``OSError`` at a path as one sentence."""
    try:
        yield
    except OSError as error:
        raise ResultsError(
            f"{path} cannot be written ({error.strerror or error}); free space or rights there and run the same "
            "command again, what was finished is kept"
        ) from error
