"""A unit that measures something else than its quantity is a slip of the pen: millihenries of a resistance."""

from __future__ import annotations

from fnmatch import fnmatch
from typing import Final

from units import same_quantity
from workbench.data.column_units import split_unit
from workbench.data.device_keys import DEVICE_KEYS
from workbench.errors import WorkbenchError

# Patterns of names of columns and of zeros of instruments, the first that fits, with a unit of each quantity that they
# may be: what moves along a line may turn as well.
_MEASURED_IN: Final[tuple[tuple[str, tuple[str, ...]], ...]] = (
    ("*_T", ("degC",)),
    ("*angle*", ("deg",)), ("encoder*", ("deg",)),
    ("efficiency", ("1", "percent")), ("power_factor", ("1", "percent")),
    ("speed*", ("rpm",)), ("velocity*", ("m_per_s", "rpm")),
    ("displacement", ("m", "deg")), ("amplitude", ("m", "deg")), ("frequency", ("Hz",)),
    ("force*", ("N",)), ("torque*", ("Nm",)), ("damping", ("Ns_per_m", "Nms_per_rad")),
    ("re", ("Ns_per_m", "Nms_per_rad")), ("im", ("Ns_per_m", "Nms_per_rad")),
    ("voltage*", ("V",)), ("v_?", ("V",)), ("v_??", ("V",)),
    ("current*", ("A",)), ("i_?", ("A",)),
    ("psi_?", ("Vs",)), ("dpsi_?", ("Vs",)), ("l_?", ("H",)), ("l_??", ("H",)),
    ("shunt", ("ohm",)), ("resistance", ("ohm",)), ("r_?", ("ohm",)), ("r_??", ("ohm",)),
    ("power", ("W",)), ("loss", ("W",)),
)  # fmt: skip
_ALIKE: Final = frozenset(("N_per_A", "Vs_per_m"))  # one constant of a linear machine, by its force or its voltage


def _of_inputs() -> dict[str, set[str]]:
    """Quantity of an input of any device -> the units it is given in, none for a pure number."""
    found: dict[str, set[str]] = {}
    for name, unit in (split_unit(known.key) for keys in DEVICE_KEYS.values() for known in keys):
        found.setdefault(name, set()).add(unit)
    return found


_INPUTS: Final = _of_inputs()


def check_reading(name: str, unit: str, where: str) -> None:
    """Of a column or the zero of an instrument; names that mean nothing here may have any unit.

    Raises:
        WorkbenchError: the unit is one of another quantity.
    """
    known = next((units for pattern, units in _MEASURED_IN if fnmatch(name, pattern)), ())
    _require(name, unit, set(known), where)


def check_input(name: str, unit: str, where: str) -> None:
    """Of an input of a device or its tolerance; inputs of other models may have any unit.

    Raises:
        WorkbenchError: the unit is one of another quantity.
    """
    _require(name, unit, _INPUTS.get(name, set()), where)


def _require(name: str, unit: str, known: set[str], where: str) -> None:
    """A unit that nobody knows is refused where it is read."""
    is_unit = unit == "1" or same_quantity(unit, unit)
    if not is_unit or not known or any(_is_alike(unit, other) for other in known):
        return
    usual = " or ".join(sorted(other for other in known if other)) or "nothing: it is a pure number"
    raise WorkbenchError(f"{where}: {name} is measured in {usual}, found {unit!r}; correct the unit or the name.")


def _is_alike(unit: str, other: str) -> bool:
    return unit == other or same_quantity(unit, other) or {unit, other} <= _ALIKE
