"""pandas and xarray, loaded when they are first used: workers that solve fields have no table to make, and the two
bring 80 MB."""

from __future__ import annotations

import sys
from importlib import util
from types import ModuleType
from typing import TYPE_CHECKING


def _when_used(name: str) -> ModuleType:
    """A module that is loaded where the first of its names is asked for."""
    if name in sys.modules:
        return sys.modules[name]
    spec = util.find_spec(name)
    if spec is None or spec.loader is None:
        raise ModuleNotFoundError(f"{name} is not installed: run make again")
    spec.loader = util.LazyLoader(spec.loader)
    sys.modules[name] = module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
else:
    pd, xr = _when_used("pandas"), _when_used("xarray")

__all__ = ["pd", "xr"]
