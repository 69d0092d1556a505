"""Commands of ``airgap`` as a user gives them, run in this process: a new one would load all libraries again."""

import sys
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO

from pipeline.cli import main
from pipeline.modules import PROJECT


@dataclass(frozen=True)
class Done:
    returncode: int
    stdout: str
    stderr: str


def airgap(*arguments):
    """What a command left behind; anything but an exit or its end is an error of the test."""
    out, err = StringIO(), StringIO()
    with chdir(PROJECT), redirect_stdout(out), redirect_stderr(err):
        code = _code_of(list(map(str, arguments)))
    return Done(code, out.getvalue(), err.getvalue())


def _code_of(arguments):
    try:
        main(arguments)
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
            return 1
        return end.code or 0
    return 0
