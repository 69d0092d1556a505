"""The table in a TOML file, or one sentence about why there is none; nothing that the path leads to is waited for."""

from __future__ import annotations

import os
import stat
import tomllib
from pathlib import Path
from typing import Any

from study.errors import StudyError

LARGEST_FILE = 1_000_000  # bytes; the studies that come with the project have 10 000
DEEPEST_NESTING = 8  # a study has sections, keys and lists
_WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a named pipe",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
}


def read_table(path: Path) -> dict[str, Any]:
    """Sections and keys of a TOML file.

    Raises StudyError with one sentence when the path leads to anything but a readable file of moderate size, when it is
    no text in UTF-8, no TOML, or nested deeper than any study.
    """
    return parsed(_text(path, _content(path)), f"{path} is not valid TOML: ", "correct that place")


def parsed(text: str, subject: str, advice: str) -> dict[str, Any]:
    """TOML text as a table.

    subject, advice: first and last words of the sentence that says what is wrong
    """
    try:
        table = tomllib.loads(text)
    except RecursionError:
        raise StudyError(f"{subject}it is nested too deeply to be read; {advice}.") from None
    except ValueError as error:  # also an integer of more digits than Python reads
        raise StudyError(f"{subject}{str(error).partition(';')[0]}; {advice}.") from error
    if _depth_exceeds(table, DEEPEST_NESTING):
        raise StudyError(f"{subject}tables and lists are nested more than {DEEPEST_NESTING} deep; {advice}.")
    return table


def _content(path: Path) -> bytes:
    try:
        descriptor = os.open(path, os.O_RDONLY | _WITHOUT_WAITING)
        try:
            return _content_of_file(path, descriptor)
        finally:
            os.close(descriptor)
    except StudyError:
        raise
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        raise StudyError(f"{path} cannot be read ({_reason(error)}); give a readable TOML file.") from error


def _content_of_file(path: Path, descriptor: int) -> bytes:
    status = os.fstat(descriptor)
    if not stat.S_ISREG(status.st_mode):
        kind = _KINDS.get(stat.S_IFMT(status.st_mode), "no file")
        raise StudyError(f"{path} cannot be read (it is {kind}); give the path of a TOML file.")
    if status.st_size > LARGEST_FILE:
        raise StudyError(
            f"{path} has {status.st_size} bytes, more than any study ({LARGEST_FILE}); give the path of a study file."
        )
    with open(descriptor, "rb", closefd=False) as file:
        return file.read()


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def _text(path: Path, content: bytes) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise StudyError(
            f"{path} is not a text file in UTF-8 (byte {error.start}); save it as UTF-8 text or give the right file."
        ) from error


def _depth_exceeds(value: object, most: int) -> bool:
    """Whether tables and lists stand in each other more than ``most`` deep; looked through level by level."""
    level = [value]
    for _ in range(most):
        level = [inner for outer in level for inner in _inside(outer)]
    return any(_inside(one) for one in level)


def _inside(value: object) -> list[object]:
    if isinstance(value, dict):
        return list(value.values())
    return value if isinstance(value, list) else []
