"""Drawing a mesh leaves broken pipes and the traceback of a crash as they were."""

import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[2]
DRAW = """
import faulthandler, os, signal
faulthandler.enable()
from geometry.plane_mesh import Drawing, triangulate
drawing = Drawing()
for name, angle in zip("abc", (0.1, 2.1, 4.1)):
    drawing.point(name, 1.0, angle, 0.5)
for ends in ("ab", "bc", "ca"):
    drawing.line(*ends)
drawing.region("triangle", *"abc")
triangulate(drawing)
{after}
"""


def run(after: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-c", DRAW.format(after=after)], cwd=PROJECT, capture_output=True, text=True)


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_broken_pipe_is_an_exception():
    writing = "try: os.write(write, b'x')\nexcept BrokenPipeError: print('told')"
    done = run(f"read, write = os.pipe(); os.close(read)\n{writing}")
    assert (done.returncode, done.stdout) == (0, "told\n")


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_a_crash_still_shows_where_it_was():
    assert "Fatal Python error" in run("os.kill(os.getpid(), signal.SIGSEGV)").stderr
