"""Drawing of the active parts with dimensions, from the outline that the files for the workshop are written from."""

from __future__ import annotations

from cmath import exp
from collections.abc import Iterable, Iterator
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from figures.dimension_lines import TO_THE_POINT, Place, measure
from figures.style import BLACK, GREY, PHASE_COLOURS, PHASE_LIGHT, Look, new_figure, styled
from geometry.machine import Machine
from geometry.outline import Arc, Contour, Curve, Outline, Part, outline_of
from geometry.parts import DrawnMachine
from geometry.winding import WindingLayout
from units import MILLIMETRE

_IRON, _SHAFT, _MAGNET = "#B5B9BD", "#8C9196", "#F3E3B3"
_CHORD = 0.01  # rad of an arc that is drawn as a straight line
_UPRIGHT = 1j  # turns the axis of tooth 0 upwards
_LABEL: Look = {"fontsize": 9.0, "bbox": {"facecolor": "white", "edgecolor": "none", "pad": 1.0}}


@styled
def lamination(machine: Machine, layout: WindingLayout) -> Figure:
    """The whole machine with its diameters, and tooth 0 enlarged; dimensions in mm."""
    outline = outline_of(machine)
    figure = new_figure(5.6)
    whole, tooth = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
    for axes in (whole, tooth):
        _fill(axes, outline, layout)
        axes.set_aspect("equal")
        axes.axis("off")
    _measure_diameters(whole, machine)
    _measure_tooth(tooth, machine)
    whole.set_title(f"{machine.slots} slots, {machine.poles} poles; dimensions in mm", loc="left")
    tooth.set_title("Tooth 0, enlarged", loc="left")
    return figure


@styled
def outline_picture(machine: DrawnMachine, layout: WindingLayout) -> Figure:
    """The whole machine of any kind, without dimensions."""
    figure = new_figure(6.0)
    axes = figure.subplots()
    _fill(axes, outline_of(machine), layout)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set(xlabel="mm", ylabel="mm")
    axes.set_title(f"{machine.slots} slots, {machine.poles} poles", loc="left")
    return figure


def _fill(axes: Axes, outline: Outline, layout: WindingLayout) -> None:
    for part, colour in _coloured(outline, layout):
        axes.add_patch(PathPatch(_path(part), facecolor=colour, edgecolor=BLACK, linewidth=0.5))


def _coloured(outline: Outline, layout: WindingLayout) -> Iterator[tuple[Part, str]]:
    yield outline.stator, _IRON
    yield outline.rotor, _IRON
    yield outline.shaft, _SHAFT
    yield from ((magnet, _MAGNET) for magnet in outline.magnets)
    for (slot, side), part in outline.coil_sides.items():
        phase, sign = layout.coil_side(slot, side)
        yield part, (PHASE_COLOURS if sign > 0 else PHASE_LIGHT)[phase]


def _path(part: Part) -> Path:
    return Path.make_compound_path(*(_closed(contour) for contour in part.contours))


def _closed(contour: Contour) -> Path:
    around = [point for curve in contour.curves for point in _points(curve)]
    points = np.array([*around, around[0]]) * _UPRIGHT / MILLIMETRE
    return Path(np.stack([points.real, points.imag], axis=-1), closed=True)


def _points(curve: Curve) -> Iterable[complex]:
    """From the start up to the next curve, which brings the end."""
    if not isinstance(curve, Arc):
        return (curve.start,)
    chords = max(2, int(abs(curve.sweep) / _CHORD))
    return (curve.part(step / chords, 1 / chords).start for step in range(chords))


# ---- dimensions -----------------------------------------------------------------------------------------------------


def _measure_diameters(axes: Axes, m: Machine) -> None:
    """One below the other under the machine, with lines down from the circles."""
    outer = m.stator_outer_radius / MILLIMETRE
    radii = (m.shaft_radius, m.rotor_core_radius, m.rotor_outer_radius, m.stator_inner_radius, m.stator_outer_radius)
    names = ("shaft", "rotor core", "magnets", "bore", "outer")
    for row, (radius, name) in enumerate(zip(radii, names)):
        r, y = radius / MILLIMETRE, -outer * (1.12 + 0.16 * row)
        for x in (-r, r):
            axes.plot([x, x], [0.0, y - 0.02 * outer], color=GREY, linewidth=0.4)
        _horizontal(axes, r, y, f"Ø {2 * r:.2f}  {name}", outer)
    axes.set(xlim=(-1.06 * outer, 1.06 * outer), ylim=(-1.86 * outer, 1.04 * outer))


def _horizontal(axes: Axes, r: float, y: float, text: str, outer: float) -> None:
    """A dimension line with its text on it where there is room, and at its right where there is not."""
    wide = r > 0.75 * outer
    measure(axes, (-r, y), (r, y), "", (0.0, 0.0))
    axes.text(0.0 if wide else r + 0.04 * outer, y, text, ha="center" if wide else "left", va="center", **_LABEL)


def _measure_tooth(axes: Axes, m: Machine) -> None:
    """Widths and depths around tooth 0, which stands upright: slot 0 at its left, the last slot at its right."""
    left, right, line = exp(0.5j * m.slot_pitch), exp(-0.5j * m.slot_pitch), _line(m)
    tooth, half = m.shoe_top_radius + 0.75 * (m.slot_bottom_radius - m.shoe_top_radius), 0.5j * m.tooth_width
    _dimension(axes, tooth - half, tooth + half, "tooth", tooth + line)
    yoke = m.slot_bottom_radius * left, m.stator_outer_radius * left
    _dimension(axes, *yoke, "yoke", sum(yoke) / 2 - 3 * line * 1j)
    opening, across = (m.stator_inner_radius + m.shoe_d1 / 2) * right, 0.5j * m.opening_width * right
    _dimension(axes, opening - across, opening + across, "opening", (m.shoe_top_radius + 1.5 * line) * right)
    tops = (m.stator_inner_radius, m.opening_top_radius, m.shoe_top_radius)
    for number, (low, high) in enumerate(pairwise(tops)):
        text = (m.shoe_top_radius + (1.5 + 1.2 * number) * line) * left
        _dimension(axes, low * left, high * left, f"shoe $d_{number + 1}$", text)
    _dimension(axes, m.rotor_core_radius, m.rotor_outer_radius, "magnet", m.rotor_core_radius - line)
    _point_at_gap(axes, m)
    _frame(axes, m)


def _half_width(m: Machine) -> float:
    """Of the picture of one tooth [m]."""
    return 1.3 * m.slot_pitch / 2 * m.stator_outer_radius


def _line(m: Machine) -> float:
    """Height of a line of text in it [m]."""
    return 0.08 * _half_width(m)


def _dimension(axes: Axes, start: complex, end: complex, name: str, at: complex) -> None:
    """The distance of two points of the machine [m] with its name, the text at a third one."""
    measure(axes, _drawn(start), _drawn(end), "", (0.0, 0.0))
    _write(axes, f"{name} {abs(end - start) / MILLIMETRE:.2f}", at)


def _write(axes: Axes, text: str, at: complex) -> None:
    axes.text(*_drawn(at), text, ha="center", va="center", **_LABEL)


def _drawn(point: complex) -> Place:
    """A point of the machine [m] in the drawing [mm]."""
    turned = point * _UPRIGHT / MILLIMETRE
    return turned.real, turned.imag


def _point_at_gap(axes: Axes, m: Machine) -> None:
    """The gap is too thin for a dimension line: a leader from the tooth points at it."""
    at, text = m.mid_gap_radius, m.shoe_top_radius + 3.9 * _line(m)
    style: Look = {"arrowstyle": "-|>,head_width=0.15,head_length=0.3", **TO_THE_POINT}
    axes.annotate("", _drawn(at), _drawn(text), arrowprops=style)
    _write(axes, f"air gap {m.airgap / MILLIMETRE:.2f}", text)


def _frame(axes: Axes, m: Machine) -> None:
    half, bottom = _half_width(m) / MILLIMETRE, (m.rotor_core_radius - 2 * _line(m)) / MILLIMETRE
    axes.set(xlim=(-half, half), ylim=(bottom, 1.02 * m.stator_outer_radius / MILLIMETRE))
