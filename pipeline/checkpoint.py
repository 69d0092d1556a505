"""Finished points of a long run on disk, so that a stopped run goes on where it was."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
from pathlib import Path


def canonical(value) -> str:
    """One text for one value: JSON with sorted keys, dataclasses and arrays included."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), default=_plain)


def digest(value) -> str:
    """SHA-256 of the canonical text of a value."""
    return hashlib.sha256(canonical(value).encode()).hexdigest()


def _plain(value):
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
        return {"type": type(value).__qualname__, **fields}
    if hasattr(value, "tolist"):  # numpy arrays and scalars
        return value.tolist()
    if isinstance(value, Path):
        return str(value)
    raise TypeError(f"{value!r} of type {type(value).__name__} cannot be written as JSON; use numbers, texts, lists, "
                    "dictionaries, arrays or dataclasses")


class Checkpoint:
    """Append-only file of finished points: a header with the hash of the inputs, then one JSON line a point.

    Each line is on disk before ``add`` returns. A last line that was cut by a killed process is dropped; a file
    written for other inputs is started anew, so that a stale point is never taken for a result.

    path: the file; made with its folder when the first point is added
    inputs: hash of everything that a point depends on besides its own arguments
    """

    def __init__(self, path: Path, inputs: str):
        self.path = Path(path)
        self.inputs = inputs
        self._results, self._good_bytes = self._read()

    def __len__(self) -> int:
        return len(self._results)

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def __getitem__(self, key: str):
        return self._results[key]

    def add(self, key: str, result) -> None:
        """Keep the result of a finished point; it comes back as JSON gives it (lists for arrays)."""
        text = canonical(result)
        self._append({"point": key, "result": json.loads(text)})
        self._results[key] = json.loads(text)

    def remove(self) -> None:
        """Delete the file once the results stand elsewhere."""
        self.path.unlink(missing_ok=True)
        self._results, self._good_bytes = {}, 0

    def _append(self, line: dict) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        lines = [line] if self._good_bytes else [{"inputs": self.inputs}, line]
        with open(self.path, "ab") as file:
            file.truncate(self._good_bytes)  # cuts off a broken last line, or points of other inputs
            file.write("".join(json.dumps(entry) + "\n" for entry in lines).encode())
            file.flush()
            os.fsync(file.fileno())
            self._good_bytes = file.tell()

    def _read(self) -> tuple[dict, int]:
        """Results of the intact lines and the number of bytes that they fill."""
        if not self.path.is_file():
            return {}, 0
        lines = self.path.read_bytes().splitlines(keepends=True)
        if not lines or _entry(lines[0]) != {"inputs": self.inputs}:
            return {}, 0
        results, good_bytes = {}, len(lines[0])
        for line in lines[1:]:
            entry = _entry(line)
            if entry is None:
                break
            results[entry["point"]] = entry["result"]
            good_bytes += len(line)
        return results, good_bytes


def _entry(line: bytes) -> dict | None:
    """The JSON of one whole line, None for a line that was cut."""
    if not line.endswith(b"\n"):
        return None
    try:
        return json.loads(line)
    except ValueError:
        return None
