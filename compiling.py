"""Functions that numba compiles on the first use, some seconds, and keeps.

numba keeps compiled code beside its source and asks whether that one file has changed, not those that it calls. All of
them are therefore asked for here, as far as they are there (an exported actuator comes alone): their folder bears the
hash of every file with compiled code.
"""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

from numba import config, njit

SOURCES = (
    "actuator/compiled.py",
    "actuator/imposed.py",
    "actuator/step.py",
    "electrical/bicubic.py",
    "magnetostatics/fronts.py",
    "magnetostatics/multifrontal.py",
    "magnetostatics/passes.py",
    "magnetostatics/two_level.py",
    "materials/compiled_law.py",
    "vehicle/motion.py",
)
_PROJECT = Path(__file__).resolve().parent
_THERE = [_PROJECT / source for source in SOURCES if (_PROJECT / source).is_file()]
_HASH = sha256(b"".join(source.read_bytes() for source in _THERE)).hexdigest()[:16]
config.CACHE_DIR = str(_PROJECT / "__pycache__" / f"compiled-{_HASH}")

# A division by zero gives inf, as in numpy, which makes the code smaller and faster.
compiled = njit(cache=True, error_model="numpy")
# Sums in any order, products added in one instruction: what the processor's vectors need.
vectorised = njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
