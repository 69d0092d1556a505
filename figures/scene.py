"""A stand-alone HTML page to look into fields: zoom, move, read values under the pointer; needs nothing but a browser.

Triangles, |B| and A travel in the page as binary text and are drawn with WebGL 2; flux lines are drawn by the graphics
card from A, so they stay sharp at any zoom.
"""

from __future__ import annotations

import json
from base64 import b64encode
from pathlib import Path

import numpy as np
from markupsafe import Markup
from matplotlib import colormaps

from figures.field_map import FLUX_LINES, colour_limit, outlines
from figures.report import template_environment
from figures.style import FIELD_MAP
from figures.whole_field import WholeField
from units import MILLIMETRE

TEMPLATE = "scene.html.j2"


def write_scene(path: Path, fields: dict[str, WholeField], title: str) -> None:
    """Write one page with all fields to choose from.

    fields: name -> field, at least one
    """
    Path(path).write_text(render_scene(fields, title), encoding="utf-8")


def render_scene(fields: dict[str, WholeField], title: str) -> str:
    """The page as text."""
    if not fields:
        raise ValueError("a scene needs at least one field, found none: solve and write some first")
    data = json.dumps([_packed(name, field) for name, field in fields.items()])
    template = template_environment().get_template(TEMPLATE)
    return template.render(title=title, data=_inside_script(data), colours=_colours(), flux_lines=FLUX_LINES)


def _packed(name: str, field: WholeField) -> dict[str, object]:
    smooth = field.smooth
    return {
        "name": name,
        "description": field.description,
        "largest_b": colour_limit(field),
        "points": _base64(smooth.points.T / MILLIMETRE, np.float32),
        "b": _base64(smooth.b, np.float32),
        "a": _base64(smooth.a, np.float32),
        "triangles": _base64(smooth.triangles.T, np.uint32),
        "region": _base64(smooth.region, np.uint16),
        "region_names": list(field.region.names),
        "outlines": _base64(outlines(field.points, field.cells, field.region), np.float32),
    }


def _base64(array: np.ndarray, kind: type[np.generic]) -> str:
    return b64encode(np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<")).tobytes()).decode("ascii")


def _colours() -> str:
    """256 colours of the map as RGBA bytes."""
    return _base64(colormaps[FIELD_MAP](np.arange(256), bytes=True), np.uint8)


def _inside_script(text: str) -> str:
    """JSON that cannot end the script element it stands in; safe to leave unescaped."""
    return Markup(text.replace("<", "\\u003c"))
