"""Public functions and values of the physics rooms say in which unit their numbers are, and of what shape arrays are.

A number is covered when its name says it (``units.SYMBOLS``), or when its docstring or the comment on its line names it
with a unit in brackets, or as dimensionless. Units that are stated must be those of the names. The shares below may
rise; they may not fall.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

from units import usual_unit

PROJECT = Path(__file__).resolve().parent.parent
ROOMS = ("materials", "geometry", "magnetostatics", "optimisation", "electrical", "losses", "thermal", "gearbox",
         "mechanics", "drivetrain", "uncertainty", "control", "actuator", "vehicle", "bench", "export")  # fmt: skip
# In percent; raise them when more is stated.
UNITS_STATED = 99.0
SHAPES_STATED = 99.0
# Room, name and unit where a docstring states another unit than the name's last word has, looked at one by one.
OTHERWISE = {
    ("gearbox", "tip_thickness", "modules"),
    ("gearbox", "class_width", "Nm"),
    ("optimisation", "torque", "Nm/m"),  # of a section, per metre of its length
    ("vehicle", "stroke", "kg/s^4"),  # the weight of the stroke
}
_NUMBER = re.compile(r"\b(float|complex|ndarray|Values|Batch|ArrayLike)\b")
_ARRAY = re.compile(r"\bndarray\b")  # ``units.Values`` says itself that any shape goes
_PURE = re.compile(r"dimensionless|relative|per unit|number of|share|fraction|\bind(ex|ices)\b|whether", re.IGNORECASE)
_DIMENSION = r"(?:\.\.\.|[\w +*-]{1,14})"
_DIMENSIONS = rf"(?<!\w)\({_DIMENSION},(?: ?{_DIMENSION},?)*\)"
_SHAPE = re.compile(_DIMENSIONS + r"|shape|scalar|broadcast|per interval|one per|arrays? that match", re.IGNORECASE)
_REACH = 160  # characters behind a name within which its unit is looked for, unless what is said about it ends before
_OTHERS = re.compile(r"(?: \[[^\]]*\])?(?:, \w+(?: \[[^\]]*\])?)*: ")  # names of one list behind a name
# A blank line, a semicolon, a full stop, and a line or a list entry that speaks of other names.
_END = re.compile(r"\n\n|;|\.(?=\s+[A-Z]|$)|\n(?=\w+(?:, \w+)*(?: \[[^\]]*\])?: )|, (?=\w+: )")


@dataclass(frozen=True)
class Number:
    """A float or an array that goes in or out somewhere public.

    text: what is said about it: docstrings of function and class, and the comment on its line
    """

    where: str
    name: str
    kind: str
    text: str

    @property
    def said(self) -> str:
        """What follows the name wherever it stands in the text, as far as it is about this name."""
        found = re.finditer(rf"\b{re.escape(self.name)}\b", self.text)
        return "\n".join(about(self.text[one.end() : one.end() + _REACH]) for one in found)

    @property
    def has_unit(self) -> bool:
        """By its name, in brackets behind it, or as a pure number."""
        return usual_unit(self.name) is not None or "[" in self.said or _PURE.search(self.said) is not None

    @property
    def stated_units(self) -> list[str]:
        """Units in brackets right behind the name, or behind a list of names that it stands in."""
        found = re.findall(rf"\b{re.escape(self.name)}\b(?:, \w+)* ?(?:: )?\[([^\]]+)\]", self.text)
        return [unit.replace("Ohm", "ohm") for unit in found]

    @property
    def has_shape(self) -> bool:
        """Whether dimensions, or that any shape goes, are said behind the name."""
        return _SHAPE.search(self.said) is not None


def about(text: str) -> str:
    """As much of what follows a name as is about it, or about the list of names that it stands in."""
    others = _OTHERS.match(text)
    begin = others.end() if others else 0
    return text[:begin] + _END.split(text[begin:])[0]


@cache
def numbers() -> tuple[Number, ...]:
    files = (path for room in ROOMS for path in sorted((PROJECT / room).rglob("*.py")))
    return tuple(one for path in files for one in numbers_of(path))


def arrays() -> list[Number]:
    return [one for one in numbers() if _ARRAY.search(one.kind)]


def numbers_of(path: Path) -> Iterator[Number]:
    source = path.read_text(encoding="utf-8")
    lines, where = source.splitlines(), path.relative_to(PROJECT).as_posix()
    for node in ast.parse(source).body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            yield from numbers_of_class(node, lines, where)
        elif isinstance(node, ast.FunctionDef) and not node.name.startswith("_"):
            yield from numbers_of_function(node, where, "")


def numbers_of_class(node: ast.ClassDef, lines: list[str], where: str) -> Iterator[Number]:
    text, place = ast.get_docstring(node) or "", f"{where}: {node.name}"
    for part in node.body:
        if isinstance(part, ast.AnnAssign) and isinstance(part.target, ast.Name) and not is_private(part.target.id):
            comment = lines[part.lineno - 1].partition("#")[2]
            yield from number(place, part.target.id, part.annotation, f"{text}\n\n{part.target.id} {comment}")
        elif isinstance(part, ast.FunctionDef) and not is_private(part.name):
            yield from numbers_of_function(part, place, text)


def numbers_of_function(node: ast.FunctionDef, where: str, around: str) -> Iterator[Number]:
    place, text = f"{where}.{node.name}", f"{ast.get_docstring(node) or ''}\n\n{around}"
    for argument in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs):
        if argument.arg not in ("self", "cls"):
            yield from number(place, argument.arg, argument.annotation, text)
    if node.returns is not None:
        yield from number(place, node.name, node.returns, f"{node.name} {text}")


def number(where: str, name: str, annotation: ast.expr | None, text: str) -> Iterator[Number]:
    kind = "ndarray" if annotation is None else ast.unparse(annotation)
    if annotation is not None and _NUMBER.search(kind):
        yield Number(where, name, kind, text)


def is_private(name: str) -> bool:
    return name.startswith("_")


def share(covered: int, of: int) -> float:
    return 100 * covered / of


def test_the_share_of_numbers_with_a_unit_does_not_fall():
    missing = [f"{one.where} {one.name}" for one in numbers() if not one.has_unit]
    found = share(len(numbers()) - len(missing), len(numbers()))
    assert found >= UNITS_STATED, f"{found:.1f} % of {len(numbers())}; without: " + "; ".join(missing)


def test_the_share_of_arrays_with_a_shape_does_not_fall():
    missing = [f"{one.where} {one.name}" for one in arrays() if not one.has_shape]
    found = share(len(arrays()) - len(missing), len(arrays()))
    assert found >= SHAPES_STATED, f"{found:.1f} % of {len(arrays())}; without: " + "; ".join(missing)


@pytest.mark.parametrize("room", ROOMS)
def test_stated_units_are_those_of_the_names(room):
    """``radius`` is in metres everywhere, so a docstring that says millimetres is wrong, or the name is."""
    wrong = [
        f"{one.where} {one.name} [{unit}], usually [{usual_unit(one.name)}]"
        for one in numbers()
        if one.where.startswith(f"{room}/") and usual_unit(one.name) is not None
        for unit in one.stated_units
        if unit != usual_unit(one.name) and (room, one.name, unit) not in OTHERWISE
    ]
    assert not wrong, "; ".join(wrong)


def test_a_wrong_unit_and_a_missing_one_are_seen():
    wrong = Number("x.py", "rotor_radius", "float", "rotor_radius [mm], force: [N]")
    assert wrong.stated_units == ["mm"] and usual_unit("rotor_radius") == "m"
    assert not Number("x.py", "speed", "float", "speed of the rotor").has_unit
    assert Number("x.py", "speed", "float", "speed: of the rotor [rad/s]").has_unit
    assert usual_unit("transmission_ratio") == "m/rad" and usual_unit("gear_ratio") is None


def test_a_quotient_has_no_unit_of_its_last_word():
    assert usual_unit("torque_per_length") is None and usual_unit("active_length") == "m"


def test_a_unit_of_another_name_does_not_count():
    for text in ("speed: of the rotor; force: [N]", "speed: of the rotor\nforce: [N]", "speed: of it, force: [N]"):
        assert not Number("x.py", "speed", "float", text).has_unit
    assert Number("x.py", "speed", "float", "speed, slip: of the rotor [rad/s]").has_unit


@pytest.mark.parametrize("text", ["b: (2, n)", "b: [T], (n,)", "b: [T], (..., 2 n)", "b: of any shape"])
def test_a_shape_is_seen(text):
    assert Number("x.py", "b", "ndarray", text).has_shape


@pytest.mark.parametrize("text", ["b: f(x, y)", "b: [T] (thesis, eq. 3.12)", "b: an array", "b: [T]; c: (n,)"])
def test_other_parentheses_are_no_shape(text):
    assert not Number("x.py", "b", "ndarray", text).has_shape
