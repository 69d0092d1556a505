"""What is wrong with a study file, said in sentences."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

EXIT_WRONG_INPUT = 2


class StudyError(ValueError):
    """A study that cannot be used; every sentence names the file, the key, what was found and what to do."""

    def __init__(self, *sentences: str) -> None:
        super().__init__("\n".join(sentences))
        self.sentences = sentences


@contextmanager
def exit_on_wrong_study() -> Iterator[None]:
    """Turn a ``StudyError`` into its sentences on standard error and exit code 2, without a traceback."""
    try:
        yield
    except StudyError as error:
        print(error, file=sys.stderr)
        raise SystemExit(EXIT_WRONG_INPUT) from None
