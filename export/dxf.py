"""Outlines as DXF for the cutting of laminations and magnets: closed polylines with true arcs, and circles, in mm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from math import tan
from pathlib import Path

import ezdxf
from ezdxf.document import Drawing
from ezdxf.layouts import Modelspace
from ezdxf.units import MM

from geometry.outline import Arc, Contour, Curve, Outline, Part
from units import MILLIMETRE

Layers = Mapping[str, tuple[Part, ...]]  # parts by the name of their layer


def laminations(outline: Outline) -> dict[str, Layers]:
    """What is cut, by the name of its file: both laminations with their bores, and the magnets in their places."""
    return {
        "lamination_stator.dxf": {"STATOR_LAMINATION": (outline.stator,)},
        "lamination_rotor.dxf": {"ROTOR_LAMINATION": (outline.rotor,)},
        "magnets.dxf": {"MAGNETS": outline.magnets},
    }


def write_dxf(path: Path, layers: Layers) -> None:
    """A file of AutoCAD 2010's format, the same to the byte for the same parts."""
    with _without_time_stamps():
        drawing_of(layers).saveas(path)


def drawing_of(layers: Layers) -> Drawing:
    """The parts in the model space, a layer for each name; holes are contours on the layer of their part."""
    drawing = ezdxf.new("R2010", units=MM)
    for name, parts in layers.items():
        drawing.layers.add(name)
        for contour in (contour for part in parts for contour in part.contours):
            _add(drawing.modelspace(), contour, name)
    return drawing


def _add(space: Modelspace, contour: Contour, layer: str) -> None:
    first = contour.curves[0]
    if isinstance(first, Arc) and first.is_circle:
        space.add_circle((0.0, 0.0), first.radius / MILLIMETRE, dxfattribs={"layer": layer})
    else:
        points = [_vertex(curve) for curve in contour.curves]
        space.add_lwpolyline(points, format="xyb", close=True, dxfattribs={"layer": layer})


def _vertex(curve: Curve) -> tuple[float, float, float]:
    """Start [mm] and bulge of a curve: tan of a quarter of the angle that an arc sweeps, 0 for a line."""
    start = curve.start / MILLIMETRE
    return start.real, start.imag, tan(curve.sweep / 4) if isinstance(curve, Arc) else 0.0


@contextmanager
def _without_time_stamps() -> Iterator[None]:
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before
