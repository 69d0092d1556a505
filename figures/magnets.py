"""Flux density along the magnetisation in the magnets, with the knee under which they lose remanence."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.tri import Triangulation

from electrical.magnets_stage import MagnetsOutcome
from figures.field_map import draw_outlines
from figures.style import FIELD_MAP, LIGHT_GREY, VERMILION, degrees, letter, new_figure, styled
from figures.whole_field import whole_geometry
from geometry.cross_section import CrossSection
from magnetostatics.demagnetisation import MagnetMap
from units import DEGREE, MILLIMETRE

_AROUND = 1.22  # of the bore: how much of the teeth is shown


@styled
def magnets_at_worst(found: MagnetsOutcome, section: CrossSection) -> Figure:
    """The worst state: all magnets at its worst rotor angle, and the smallest that one magnet sees over a turn.

    section: meshed machine, for its outlines
    """
    figure = new_figure(4.8)
    whole, one = figure.subplots(1, 2, width_ratios=(1.0, 1.1))
    flux = np.concatenate([found.at_once.flux.ravel(), found.turn.flux.ravel(), [found.knee]])
    ends = float(flux.min()), float(flux.max())
    _draw_machine(whole, found, section, ends)
    colours = _draw(one, found.turn, found.knee, ends)
    one.set_title("smallest over a turn, one magnet", loc="left")
    for axes in (whole, one):
        axes.set(xlabel="x / mm", ylabel="y / mm")
        axes.set_aspect("equal")
    letter((whole, one))
    bar = figure.colorbar(colours, ax=(whole, one), pad=0.02, shrink=0.85)
    bar.set_label("flux density along the magnetisation / T")
    bar.ax.axhline(found.knee, color=VERMILION, linewidth=2.0)
    figure.legend(handles=[_knee_line(found)], loc="outside lower center", frameon=False)
    return figure


def _draw_machine(axes: Axes, found: MagnetsOutcome, section: CrossSection, ends: tuple[float, float]) -> None:
    """All magnets between the outlines of teeth and rotor; in every sector they see the same along themselves."""
    draw_outlines(axes, whole_geometry(section, found.worst.angle), LIGHT_GREY, 0.8)
    for angle in 2 * np.pi / section.sectors * np.arange(section.sectors):
        _draw(axes, found.at_once.turned(angle), found.knee, ends)
    reach = _AROUND * section.machine.stator.rim_radius / MILLIMETRE
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.set_title(f"worst rotor angle, {degrees(found.worst.angle / DEGREE)}", loc="left")


def _knee_line(found: MagnetsOutcome) -> Line2D:
    label = f"knee of {found.inputs.grade.name}, {found.knee:.3f} T".replace("-0", "\N{MINUS SIGN}0")
    return Line2D([], [], color=VERMILION, linewidth=1.6, label=label)


def _draw(axes: Axes, seen: MagnetMap, knee: float, ends: tuple[float, float]) -> Collection:
    """Colours between the ends [T], and the knee [T] as a line where it is met."""
    x, y = seen.corners.transpose(0, 2, 1).reshape(2, -1) / MILLIMETRE
    flux = seen.flux.T.ravel()
    elements = Triangulation(x, y, np.arange(len(x)).reshape(-1, 3))
    colours = axes.tripcolor(elements, flux, shading="gouraud", cmap=FIELD_MAP, vmin=ends[0], vmax=ends[1])
    if flux.min() < knee < flux.max():
        axes.tricontour(elements, flux, levels=[knee], colors=VERMILION, linewidths=1.6)
    return colours
