"""Style and types of the code, as pyproject.toml asks for them: which rules, and in which rooms."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parent.parent


def run(*command: str) -> subprocess.CompletedProcess[str]:
    """A tool of this environment in the project's folder."""
    return subprocess.run([sys.executable, "-m", *command], cwd=PROJECT, capture_output=True, text=True)


@pytest.mark.parametrize("command", (("ruff", "check", "--output-format=concise"), ("mypy",)), ids=("style", "types"))
def test_nothing_is_found(command):
    """Both keep what they know in the project's folder: seconds the first time, then a fraction of one."""
    result = run(*command)
    assert result.returncode == 0, result.stdout + result.stderr


MISTAKES = {
    "type": ("mypy", 'def twice(number: float) -> float:\n    return "no"\n', "return-value"),
    "annotation": ("mypy", "def twice(number):\n    return 2 * number\n", "no-untyped-def"),
    "name": ("ruff", "print(twice)\n", "F821"),
    "import": ("ruff", "import os\n", "F401"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_found(mistake, tmp_path):
    """The configuration is read, and it is strict."""
    tool, text, code = MISTAKES[mistake]
    file = tmp_path / "mistaken.py"
    file.write_text(text)
    options = ("check", "--config=pyproject.toml") if tool == "ruff" else ("--config-file=pyproject.toml",)
    result = run(tool, *options, str(file))
    assert result.returncode == 1 and code in result.stdout
