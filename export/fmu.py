"""The actuator as a unit for other simulation tools (FMI 2, co-simulation), built by pythonfmu.

The unit holds the room ``actuator/`` as it stands here, the actuator of the study as text, and pythonfmu's binaries for
Linux and Windows on 64 bits; the tool that loads it needs a Python with numpy, scipy and numba of the pinned versions.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import copyfile, copytree, ignore_patterns
from tempfile import TemporaryDirectory

from pythonfmu.builder import FmuBuilder

from actuator.model import Actuator
from actuator.terminals import Terminals
from actuator.text import text_of

_ROOT = Path(__file__).resolve().parent.parent
_SLAVE = _ROOT / "export" / "unit" / "airgap_actuator.py"
_DESCRIPTION = "actuator.json"
_ROOMS = ("actuator", "control")  # what the slave's imports reach, and these files:
_FILES = ("compiling.py", "units.py", "electrical/__init__.py", "electrical/diode_bridge.py")


def write_fmu(path: Path, actuator: Actuator, terminals: Terminals) -> None:
    """Write the unit of an actuator.

    Inputs: ``velocity`` [m/s] and ``force_demand`` [N], held over a step; outputs as in ``export/unit``.
    Raises ActuatorError for an actuator that nobody commands step by step.
    """
    text = text_of(actuator, terminals)
    with TemporaryDirectory() as folder, _path_restored():
        description = Path(folder) / _DESCRIPTION
        description.write_text(text, encoding="utf-8")
        rooms = [copytree(_ROOT / room, Path(folder) / room, ignore=ignore_patterns("__pycache__")) for room in _ROOMS]
        files = {_copied(name, Path(folder)) for name in _FILES}
        FmuBuilder.build_FMU(_SLAVE, path, project_files=[description, *rooms, *sorted(files)])


def _copied(name: str, folder: Path) -> Path:
    """A file of the project in its place under a folder; its uppermost part there, which is what goes into the unit."""
    place = folder / name
    place.parent.mkdir(exist_ok=True)
    copyfile(_ROOT / name, place)
    return folder / Path(name).parts[0]


@contextmanager
def _path_restored() -> Iterator[None]:
    """pythonfmu puts the folder of the slave on the path for good."""
    before = list(sys.path)
    try:
        yield
    finally:
        sys.path[:] = before
