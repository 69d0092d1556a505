"""The machine as drawn: winding, magnets, probe segments and dimensions (thesis Figs 3.16 and 3.17)."""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from figures.dimension_lines import TO_THE_POINT, measure, place_of
from figures.field_map import draw_outlines
from figures.style import (
    BLACK,
    PHASE_COLOURS,
    PHASE_LIGHT,
    PHASE_NAMES,
    PURPLE,
    YELLOW,
    Look,
    new_figure,
    styled,
)
from figures.whole_field import WholeField, whole_geometry
from geometry.cross_section import CrossSection
from geometry.machine import Machine, dimensions_of
from units import MILLIMETRE

_IRON, _SHAFT, _MAGNET, _AIR = "#B5B9BD", "#8C9196", "#F3E3B3", "#FFFFFF"
_ARROWS_PER_MAGNET = 3


@styled
def cross_section(section: CrossSection, angle: float = 0.0) -> Figure:
    """The whole machine with winding, magnetisation and probes; one slot pitch with its dimensions beside it.

    section: meshed machine; angle: mechanical rotor angle [rad]
    """
    whole = whole_geometry(section, angle)
    figure = new_figure(6.4)
    places = figure.subplot_mosaic("md;mt", width_ratios=(1.6, 1.0), height_ratios=(1.7, 1.0))
    _draw_machine(places["m"], section, whole, angle)
    _draw_detail(places["d"], section, whole)
    _write_dimensions(places["t"], dimensions_of(section.machine))
    figure.legend(handles=_legend(section), loc="outside lower left", ncols=6, frameon=False)
    return figure


def _draw_machine(axes: Axes, section: CrossSection, whole: WholeField, angle: float) -> None:
    _fill(axes, section, whole)
    draw_outlines(axes, whole, "#303030", 0.6)
    _draw_magnetisation(axes, section, angle)
    _draw_probes(axes, section)
    _label_coil_sides(axes, section)
    _draw_sector(axes, section)
    reach = dimensions_of(section.machine).stator_outer_radius / MILLIMETRE * 1.08
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="x / mm", ylabel="y / mm")
    axes.set_aspect("equal")
    axes.set_title(_machine_title(dimensions_of(section.machine)), loc="left")


def _machine_title(m: Machine) -> str:
    return f"{m.slots} slots, {m.poles} poles, Ø {2 * m.stator_outer_radius / MILLIMETRE:.4g} mm"


def _legend(section: CrossSection) -> list[Artist]:
    phases = [
        Patch(color=shades[phase], label=f"{sign}{PHASE_NAMES[phase]}")
        for phase in range(3)
        for sign, shades in (("+", PHASE_COLOURS), ("\N{MINUS SIGN}", PHASE_LIGHT))
    ]
    parts = (("iron", _IRON), ("magnet", _MAGNET), ("tooth probe", YELLOW), ("back-iron probe", PURPLE))
    border = Line2D([], [], color=BLACK, linestyle="--", linewidth=1.0, label="border of the solved sector")
    areas = [Patch(facecolor=colour, edgecolor="#888888", label=name) for name, colour in parts]
    return phases + areas + ([border] if section.sectors > 1 else [])


# ---- areas ----------------------------------------------------------------------------------------------------------


def _fill(axes: Axes, section: CrossSection, whole: WholeField) -> None:
    colours = np.array([region_colour(name, section) for name in whole.region.names])
    corners = whole.points[:, whole.cells[:3]].transpose(2, 1, 0) / MILLIMETRE
    look: Look = {"facecolors": colours[whole.region.index], "edgecolors": "face", "linewidths": 0.6}
    # An array (cells, 3, 2) is taken as one, a list of arrays one by one; matplotlib's annotation knows the list only.
    axes.add_collection(PolyCollection(corners, **look))  # type: ignore[arg-type]


def region_colour(name: str, section: CrossSection) -> str:
    """Colour of a region: phase and sign of a half slot, or what the region is made of."""
    if name.startswith("slot"):
        _, slot, side = name.split("_")
        phase, sign = section.layout.coil_side(int(slot), side)
        return (PHASE_COLOURS if sign > 0 else PHASE_LIGHT)[phase]
    if name.startswith("magnet"):
        return _MAGNET
    return {"stator_iron": _IRON, "rotor_iron": _IRON, "shaft": _SHAFT}.get(name, _AIR)


# ---- what is drawn over them ----------------------------------------------------------------------------------------


def _draw_magnetisation(axes: Axes, section: CrossSection, angle: float) -> None:
    m = dimensions_of(section.machine)
    radius = (m.rotor_outer_radius - m.magnet_length / 2) / MILLIMETRE
    length = 0.8 * m.magnet_length / MILLIMETRE
    spread = m.magnet_arc_fraction * m.pole_pitch * np.linspace(-0.3, 0.3, _ARROWS_PER_MAGNET)
    for magnet in range(m.poles):
        centre = magnet * m.pole_pitch
        direction = m.rotor.direction(centre + spread, centre) + angle
        for place, pointing in zip(centre + spread + angle, direction, strict=True):
            _arrow(axes, radius * np.exp(1j * place), section.polarity(magnet) * length * np.exp(1j * pointing))


def _arrow(axes: Axes, centre: complex, vector: complex) -> None:
    tail, head = centre - vector / 2, centre + vector / 2
    style: Look = {"arrowstyle": "-|>,head_width=0.16,head_length=0.3", **TO_THE_POINT, "lw": 0.8}
    axes.annotate("", (head.real, head.imag), (tail.real, tail.imag), arrowprops=style)


def _draw_probes(axes: Axes, section: CrossSection) -> None:
    """The segments of the solved sector, with the numbers that their readings carry."""
    m = dimensions_of(section.machine)
    label_radius = 0.22 * m.shoe_top_radius + 0.78 * m.slot_bottom_radius
    for number, probe in enumerate(section.tooth_probes):
        _draw_segment(axes, probe.points, YELLOW)
        _write_at(axes, label_radius, number * m.slot_pitch, str(number))
    for number, probe in enumerate(section.back_iron_probes):
        one_side = probe.points[:, : probe.points.shape[1] // 2]  # the other side may lie on the far end of the sector
        _draw_segment(axes, one_side, PURPLE)
        _write_at(axes, 1.035 * m.stator_outer_radius, (number + 0.5) * m.slot_pitch, str(number))


def _draw_segment(axes: Axes, points: np.ndarray, colour: str) -> None:
    x, y = points[:, [0, -1]] / MILLIMETRE
    axes.plot(x, y, color=BLACK, linewidth=3.6, solid_capstyle="butt")
    axes.plot(x, y, color=colour, linewidth=2.4, solid_capstyle="butt")


def _write_at(axes: Axes, radius: float, angle: float, text: str, **look: Any) -> None:
    x, y = radius / MILLIMETRE * cos(angle), radius / MILLIMETRE * sin(angle)
    axes.text(x, y, text, **{"ha": "center", "va": "center", "fontsize": 9, **look})


def _label_coil_sides(axes: Axes, section: CrossSection) -> None:
    m = dimensions_of(section.machine)
    radius = 0.45 * m.shoe_top_radius + 0.55 * m.slot_bottom_radius
    for slot in range(m.slots):
        for side, part in (("R", 0.34), ("L", 0.66)):
            phase, sign = section.layout.coil_side(slot, side)
            text = ("+" if sign > 0 else "\N{MINUS SIGN}") + PHASE_NAMES[phase]
            look: Look = {"fontsize": 8, "color": "white" if sign > 0 else "black"}
            _write_at(axes, radius, (slot + part) * m.slot_pitch, text, **look)


def _draw_sector(axes: Axes, section: CrossSection) -> None:
    """Border of the part that is solved, where it is not the whole machine."""
    if section.sectors == 1:
        return
    m = dimensions_of(section.machine)
    for end in (-m.slot_pitch / 2, 2 * pi / section.sectors - m.slot_pitch / 2):
        inner, outer = m.stator_inner_radius / MILLIMETRE, m.stator_outer_radius / MILLIMETRE
        axes.plot(*([r * f(end) for r in (inner, outer)] for f in (cos, sin)), "--", color=BLACK, linewidth=1.0)


# ---- one slot pitch with dimensions ---------------------------------------------------------------------------------


def _draw_detail(axes: Axes, section: CrossSection, whole: WholeField) -> None:
    """Tooth 0 upright with the slots beside it; the turn puts the x axis upwards."""
    turned = _upright(whole)
    _fill(axes, section, turned)
    draw_outlines(axes, turned, "#303030", 0.8)
    _draw_dimensions(axes, dimensions_of(section.machine))
    m = dimensions_of(section.machine)
    half = 1.25 * m.slot_pitch / 2 * m.stator_outer_radius / MILLIMETRE
    bottom = (m.rotor_core_radius - 1.5 * m.magnet_length) / MILLIMETRE
    axes.set(xlim=(-half, half), ylim=(bottom, m.stator_outer_radius / MILLIMETRE * 1.03))
    axes.set_aspect("equal")
    axes.axis("off")


def _write_dimensions(axes: Axes, m: Machine) -> None:
    axes.axis("off")
    axes.text(0.0, 1.0, dimension_list(m), transform=axes.transAxes, va="top", fontsize=9, linespacing=1.4)


def _upright(whole: WholeField) -> WholeField:
    x, y = whole.points
    return WholeField(np.stack([-y, x]), whole.cells, whole.a, whole.region, whole.description)


def _draw_dimensions(axes: Axes, m: Machine) -> None:
    middle = (m.shoe_top_radius + m.slot_bottom_radius) / 2 / MILLIMETRE
    half_tooth = m.tooth_width / 2 / MILLIMETRE
    measure(axes, (-half_tooth, middle), (half_tooth, middle), "$w_{tb}$", (0.0, 0.7))
    _measure_radially(axes, m.slot_bottom_radius, m.stator_outer_radius, m.slot_pitch / 2, "$w_{bi}$")
    slot_axis = -m.slot_pitch / 2
    opening = m.opening_width / 2
    at = (m.stator_inner_radius + m.shoe_d1 * 0.5) / MILLIMETRE
    along, across = np.array([-sin(slot_axis), cos(slot_axis)]), np.array([cos(slot_axis), sin(slot_axis)])
    left, right = (place_of(at * along + side * opening / MILLIMETRE * across) for side in (-1, 1))
    measure(axes, left, right, "$w_s$", place_of(2.0 * along))
    _measure_radially(axes, m.rotor_core_radius, m.rotor_outer_radius, m.slot_pitch * 0.15, "$l_m$")
    _point_at_gap(axes, m)


def _point_at_gap(axes: Axes, m: Machine) -> None:
    """The gap is too thin for a dimension line: a leader from the tooth points at it."""
    x = -0.22 * m.tooth_width / MILLIMETRE
    style: Look = {"arrowstyle": "-|>,head_width=0.15,head_length=0.3", **TO_THE_POINT}
    above = (m.shoe_top_radius + 0.8 * m.tooth_width) / MILLIMETRE
    look: Look = {"ha": "center", "va": "bottom", "fontsize": 11, "arrowprops": style}
    axes.annotate("$g$", (x, m.mid_gap_radius / MILLIMETRE), (x, above), **look)


def _measure_radially(axes: Axes, inner: float, outer: float, angle: float, name: str) -> None:
    along = np.array([-sin(angle), cos(angle)])
    across = np.array([cos(angle), sin(angle)])
    ends = place_of(inner / MILLIMETRE * along), place_of(outer / MILLIMETRE * along)
    measure(axes, *ends, name, place_of(1.7 * across))


def dimension_list(m: Machine) -> str:
    """The dimensions with their symbols, in mm."""
    rows = (
        ("R_{so}", "stator outer radius", m.stator_outer_radius),
        ("R_{ro}", "rotor outer radius", m.rotor_outer_radius),
        ("w_{bi}", "back-iron width", m.back_iron_width),
        ("w_{tb}", "tooth width", m.tooth_width),
        ("l_m", "magnet length", m.magnet_length),
        ("g", "air gap", m.airgap),
        ("w_s", "slot opening", m.opening_width),
        ("d_1, d_2", "shoe depths", (m.shoe_d1, m.shoe_d2)),
        ("R_{sh}", "shaft radius", m.shaft_radius),
    )
    return "\n".join(f"${symbol}$  {name}: {_in_mm(value)} mm" for symbol, name, value in rows)


def _in_mm(value: float | tuple[float, ...]) -> str:
    lengths = value if isinstance(value, tuple) else (value,)
    return ", ".join(f"{length / MILLIMETRE:.2f}" for length in lengths)
