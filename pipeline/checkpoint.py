"""Finished points of a long run on disk, so that a stopped run goes on where it was."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from pipeline.codec import CodecError, decoded, encoded


class Checkpoint:
    """Append-only file of finished points: a header with the hash of the inputs, then one JSON line a point.

    Each line is on disk before ``add`` returns. A line that was cut by a killed process, or that is not one of ours, is
    dropped with all after it; a file written for other inputs is started anew, so that a stale point is never taken for
    a result.

    path: the file; made with its folder when the first point is added
    inputs: hash of everything that the points depend on
    """

    def __init__(self, path: Path, inputs: str) -> None:
        self.path = Path(path)
        self.inputs = inputs
        self._results, self._good_bytes = self._read()

    def __len__(self) -> int:
        return len(self._results)

    def __contains__(self, key: str) -> bool:
        return key in self._results

    def __getitem__(self, key: str) -> Any:
        return decoded(self._results[key])

    def add(self, key: str, result: Any) -> None:
        """Keep the result of a finished point; CodecError where it cannot be written."""
        content = encoded(result)
        self._append({"point": key, "result": content})
        self._results[key] = content

    def remove(self) -> None:
        """Delete the file once the results stand elsewhere."""
        self.path.unlink(missing_ok=True)
        self._results, self._good_bytes = {}, 0

    def _append(self, line: dict[str, Any]) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        lines = [line] if self._good_bytes else [{"inputs": self.inputs}, line]
        with open(self.path, "ab") as file:
            file.truncate(self._good_bytes)  # cuts off a broken last line, or points of other inputs
            file.write("".join(json.dumps(entry) + "\n" for entry in lines).encode())
            file.flush()
            os.fsync(file.fileno())
            self._good_bytes = file.tell()

    def _read(self) -> tuple[dict[str, Any], int]:
        """Results of the intact lines and the number of bytes that they fill."""
        if not self.path.is_file():
            return {}, 0
        lines = self.path.read_bytes().splitlines(keepends=True)
        if not lines or _entry(lines[0]) != {"inputs": self.inputs}:
            return {}, 0
        results, good_bytes = {}, len(lines[0])
        for line in lines[1:]:
            entry = _entry(line)
            if entry is None or not _is_point(entry):
                break
            results[entry["point"]] = entry["result"]
            good_bytes += len(line)
        return results, good_bytes


def _entry(line: bytes) -> dict[str, Any] | None:
    """The JSON object of one whole line, None for a line that was cut or is something else."""
    if not line.endswith(b"\n"):
        return None
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


def _is_point(entry: dict[str, Any]) -> bool:
    """Whether an entry is one that ``add`` wrote."""
    if entry.keys() != {"point", "result"} or not isinstance(entry["point"], str):
        return False
    try:
        decoded(entry["result"])
    except CodecError:
        return False
    return True
