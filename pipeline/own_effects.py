"""Effects of one's own on the command line, and how a wrong campaign, model or effect file ends a command."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from effects.library import Library, effects_of_file, library
from workbench.errors import WorkbenchError

EXIT_WRONG_INPUT = 2


def add_own_effects(parser: argparse.ArgumentParser) -> None:
    """``--effects-from``: effects of one's own."""
    parser.add_argument(
        "--effects-from",
        action="append",
        default=[],
        metavar="FILE.py",
        help="import effects of one's own: this runs the file; repeatable, a folder means its .py files",
    )


@contextmanager
def exit_on_wrong_campaign() -> Iterator[None]:
    """A ``WorkbenchError`` as its sentence on standard error and exit code 2."""
    try:
        yield
    except WorkbenchError as error:
        print(error, file=sys.stderr)
        raise SystemExit(EXIT_WRONG_INPUT) from None


def own_library(options: argparse.Namespace) -> Library:
    """All effects, those of the named files among them; WorkbenchError where a file holds none."""
    for file in options.effects_from:
        if not Path(file).exists():
            raise WorkbenchError(f"--effects-from {file}: there is no such file.")
        print(f"importing effects from {file}: this runs the file", file=sys.stderr, flush=True)
        _must_hold_an_effect(file)
    return library(options.effects_from)


def _must_hold_an_effect(file: str) -> None:
    """One sentence where a named file (or every file of a named folder) cannot be imported or holds no effect."""
    path = Path(file)
    found: Library = {}
    for own in sorted(path.glob("*.py")) if path.is_dir() else [path]:
        try:
            found |= effects_of_file(own)
        except Exception as error:  # whatever the user's own file raises
            raise WorkbenchError(f"{own}: cannot be imported: {type(error).__name__}: {error}.") from None
    if not found:
        raise WorkbenchError(
            f"{file}: holds no effect; one is a frozen dataclass derived from effects.base, with a title and a "
            "parameter."
        )
