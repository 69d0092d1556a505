"""The active parts as solids in a STEP file: outlines extruded over the active length, by gmsh's OpenCASCADE, in mm."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import ceil, pi
from pathlib import Path

import gmsh

from geometry.outline import Arc, Contour, Curve, Line, Outline, Part
from geometry.signal_handlers import kept_signal_handlers
from units import MILLIMETRE

_LONGEST_ARC = pi / 2  # rad; an arc by its ends and its centre must be shorter than half a turn
_NUMBER = re.compile(r"'Open CASCADE STEP translator [\d.]+ \d+(?:\.(\d+))?'")  # of the file and of each solid
_WHOLE = "active parts"


class StepError(RuntimeError):
    """Solids that could not be made or written; the message is that of gmsh."""


def active_parts(outline: Outline) -> dict[str, Part]:
    """The solids by their names: both stacks, shaft and every magnet."""
    magnets = {f"magnet {number}": magnet for number, magnet in enumerate(outline.magnets)}
    return {"stator stack": outline.stator, "rotor core": outline.rotor, "shaft": outline.shaft} | magnets


def write_step(path: Path, parts: Mapping[str, Part], length: float) -> None:
    """Extrude the parts from z = 0 over a length [m] and write them under their names."""
    with _gmsh():
        for part in parts.values():
            _extrude(part, length / MILLIMETRE)
        gmsh.model.occ.synchronize()
        with _silence():
            gmsh.write(str(path))
    path.write_text(_named(path.read_text(encoding="utf-8"), tuple(parts)), encoding="utf-8")


def _named(text: str, names: tuple[str, ...]) -> str:
    """The file with the parts' names in the place of OpenCASCADE's numbers."""
    return _NUMBER.sub(lambda found: f"'{names[int(found[1]) - 1] if found[1] else _WHOLE}'", text)


@contextmanager
def _silence() -> Iterator[None]:
    """OpenCASCADE prints statistics of every file, past Python and past gmsh's own switch."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


@contextmanager
def _gmsh() -> Iterator[None]:
    with kept_signal_handlers():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    try:
        yield
    except Exception as error:  # gmsh raises bare Exception
        raise StepError(f"gmsh could not write the solids: {error}") from error
    finally:
        gmsh.finalize()


def _extrude(part: Part, height: float) -> None:
    """Add the solid; height [mm]."""
    outside_first = sorted(part.contours, key=lambda contour: -contour.area)
    face = gmsh.model.occ.addPlaneSurface([_loop(contour) for contour in outside_first])
    gmsh.model.occ.extrude([(2, face)], 0.0, 0.0, height)


def _loop(contour: Contour) -> int:
    occ, first = gmsh.model.occ, contour.curves[0]
    if isinstance(first, Arc) and first.is_circle:
        return occ.addCurveLoop([occ.addCircle(0.0, 0.0, 0.0, first.radius / MILLIMETRE)])
    curves = [piece for curve in contour.curves for piece in _pieces(curve)]
    points = [_point(curve.start) for curve in curves]
    ends = [*points[1:], points[0]]
    return occ.addCurveLoop([_curve(*one) for one in zip(curves, points, ends)])


def _pieces(curve: Curve) -> list[Curve]:
    """A line as it is, an arc in as many equal parts as it needs."""
    if isinstance(curve, Line):
        return [curve]
    count = ceil(abs(curve.sweep) / _LONGEST_ARC)
    return [curve.part(k / count, 1 / count) for k in range(count)]


def _point(place: complex) -> int:
    return gmsh.model.occ.addPoint(place.real / MILLIMETRE, place.imag / MILLIMETRE, 0.0)


def _curve(curve: Curve, start: int, end: int) -> int:
    if isinstance(curve, Line):
        return gmsh.model.occ.addLine(start, end)
    centre = _point(curve.centre)
    arc = gmsh.model.occ.addCircleArc(start, centre, end)
    gmsh.model.occ.remove([(0, centre)])  # or it goes into the file as a part of its own
    return int(arc)
