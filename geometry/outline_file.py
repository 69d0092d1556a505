"""Outlines from DXF files: the lines and arcs that a workshop or a laboratory has, in metres."""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from pathlib import Path

import ezdxf
from ezdxf.entities import DXFEntity
from ezdxf.lldxf.const import DXFError

from geometry.errors import GeometryError
from geometry.outline import Arc, Curve, Line
from units import MILLIMETRE

_FULL_TURN = 360.0


def read_outline(path: Path, layer: str | None = None) -> tuple[Curve, ...]:
    """Lines, arcs, circles and polylines of the model space in mm, of one layer or of all.

    Raises GeometryError for a file that cannot be read or has none of them.
    """
    try:
        drawing = ezdxf.readfile(path)
    except (OSError, DXFError) as error:
        raise GeometryError(f"{path} is no DXF file that can be read ({error})") from error
    entities = [one for one in drawing.modelspace() if layer is None or one.dxf.layer == layer]
    curves = tuple(curve for one in entities for curve in _curves(one))
    if not curves:
        layers = ", ".join(sorted({one.dxf.layer for one in drawing.modelspace()})) or "none"
        where = f" on layer {layer}" if layer else ""
        raise GeometryError(f"{path} has no lines and arcs{where}; its layers: {layers}")
    return curves


def _curves(entity: DXFEntity) -> Iterator[Curve]:
    kind = entity.dxftype()
    if kind == "LINE":
        yield Line(_place(entity.dxf.start), _place(entity.dxf.end))
    elif kind == "ARC":
        yield _arc(entity, entity.dxf.start_angle, (entity.dxf.end_angle - entity.dxf.start_angle) % _FULL_TURN)
    elif kind == "CIRCLE":
        yield from (_arc(entity, start, _FULL_TURN / 2) for start in (0.0, _FULL_TURN / 2))
    elif kind in ("LWPOLYLINE", "POLYLINE"):
        for one in entity.virtual_entities():  # type: ignore[attr-defined]
            yield from _curves(one)


def _arc(entity: DXFEntity, start: float, sweep: float) -> Arc:
    return Arc(entity.dxf.radius * MILLIMETRE, radians(start), radians(sweep), _place(entity.dxf.center))


def _place(point: tuple[float, float, float]) -> complex:
    return complex(point[0], point[1]) * MILLIMETRE
