"""Ends of a command that are no faults of the program: one sentence and an exit code each."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from pipeline.pools import Interrupted, TaskError
from pipeline.results import ResultsError

EXIT_FAILED, EXIT_INTERRUPTED = 1, 130  # 130: what a shell reports after Ctrl-C


@contextmanager
def sentences() -> Iterator[None]:
    """Ends that are no faults of the program, as a sentence on standard error and an exit code."""
    try:
        yield
    except (ResultsError, TaskError) as error:
        print(error, file=sys.stderr)
        raise SystemExit(EXIT_FAILED) from None
    except KeyboardInterrupt as error:
        print(str(error) if isinstance(error, Interrupted) else "stopped; what was finished is kept", file=sys.stderr)
        raise SystemExit(EXIT_INTERRUPTED) from None
