"""Keep a library from changing what this process does on a signal."""

from __future__ import annotations

import ctypes
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_ROOM = 1024  # bytes, several times the C library's struct sigaction; what is in it is only handed back


@contextmanager
def kept_signal_handlers() -> Iterator[None]:
    """Every signal does after the body what it did before, whatever the body set in C.

    gmsh sets SIGPIPE and the signals of a crash back to their defaults when it starts: writing to a worker process that
    has ended would then end the writer without a word, and a crash would show no traceback. Python knows nothing of it,
    so ``sigaction`` of the C library keeps and restores the dispositions. On Windows there is nothing to keep.
    """
    if sys.platform == "win32":
        yield
        return
    sigaction, kept = ctypes.CDLL(None).sigaction, {}
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        disposition = ctypes.create_string_buffer(_ROOM)
        if sigaction(int(number), None, disposition) == 0:
            kept[number] = disposition
    try:
        yield
    finally:
        for number, disposition in kept.items():
            sigaction(int(number), disposition, None)
