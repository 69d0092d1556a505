"""The gearbox: end view of a stage, load spectrum on its S-N line, safety factors, axial section of the actuator."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Patch, Rectangle

from figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    PURPLE,
    SERIES,
    SKY,
    VERMILION,
    letter,
    new_figure,
    show_grid,
    styled,
)
from gearbox.layout import Layout, Part
from gearbox.material import LifeLine
from gearbox.outline import StageOutlines
from gearbox.planetary_set import PlanetarySet
from gearbox.rating import StageRating
from gearbox.spectrum import LoadSpectrum
from units import MILLIMETRE

_LIGHT = {"sun": "#F2B48C", "planet": "#8FC3E3", "ring": "#D9D9D9"}
_KINDS = (("flank", "pitting, fatigue"), ("root", "root, fatigue"), ("static_flank", "flank, peak"),
          ("static_root", "root, peak"))  # fmt: skip
_STRESS_SHOWN, _STRESS_TICKS = (0.18, 3.2), (0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0)  # over the endurance limit
_GEAR_COLOURS = {"sun": VERMILION, "planet": BLUE, "ring": GREY}
_PART_COLOURS = {"casing": LIGHT_GREY, "shaft": GREY, "ring": "#A6A6A6", "sun": VERMILION, "planet": SKY,
                 "carrier": GREEN, "stator": BLUE, "winding": ORANGE, "rotor": PURPLE}  # fmt: skip


@styled
def gear_end_view(outlines: StageOutlines, gears: PlanetarySet, *, envelope_diameter: float, title: str) -> Figure:
    """A stage seen along its axis, with a close view of its two meshes.

    outlines: of the teeth of this one set of gears; envelope_diameter: of the casing around them [m]
    """
    figure = new_figure(5.2)
    axes = figure.subplots(1, 2, width_ratios=(1.15, 1))
    for axis in axes:
        _draw_stage(axis, outlines, gears, envelope_diameter)
        axis.set(aspect="equal", xlabel="x / mm", ylabel="y / mm")
    half = envelope_diameter / 2 / MILLIMETRE * 1.03
    axes[0].set(xlim=(-half, half), ylim=(-half, half))
    axes[0].set_title(title, loc="left")
    _close_view(axes[1], gears)
    letter(axes)
    return figure


def _draw_stage(axis: Axes, outlines: StageOutlines, gears: PlanetarySet, envelope_diameter: float) -> None:
    ring = outlines.ring / MILLIMETRE
    axis.add_patch(Circle((0, 0), envelope_diameter / 2 / MILLIMETRE, facecolor=_LIGHT["ring"], edgecolor=BLACK))
    axis.fill(ring.real, ring.imag, facecolor="white", edgecolor=BLACK, linewidth=0.6)
    rows = [("planet", outline) for outline in outlines.planets] + [("sun", outlines.sun)]
    for name, outline in rows:
        axis.fill(*_xy(outline), facecolor=_LIGHT[name], edgecolor=_GEAR_COLOURS[name], linewidth=0.6)
    pitch = [(0j, gears.sun)] + [(centre, gears.planet) for centre in outlines.centres] + [(0j, gears.ring)]
    for centre, gear in pitch:
        place = (centre.real / MILLIMETRE, centre.imag / MILLIMETRE)
        axis.add_patch(
            Circle(place, gear.reference_radius / MILLIMETRE, fill=False, linestyle=(0, (6, 3)), linewidth=0.5)
        )


def _xy(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return points.real / MILLIMETRE, points.imag / MILLIMETRE


def _close_view(axis: Axes, gears: PlanetarySet) -> None:
    """The sun with the beginning of a planet: six sun pitches wide."""
    x = gears.sun.reference_radius / MILLIMETRE
    half = 6 * gears.sun.module / MILLIMETRE
    axis.set(xlim=(x - half, x + half), ylim=(-half, half))
    z_sun, z_planet, z_ring = (round(float(z)) for z in gears.teeth)
    axis.set_title(f"sun {z_sun}, planet {z_planet}, ring {abs(z_ring)} teeth", loc="left")


@styled
def load_spectrum(spectrum: LoadSpectrum, lines: Sequence[tuple[str, LifeLine, np.ndarray, np.ndarray]]) -> Figure:
    """Torque classes with their share of the time, and the stress of each class on the S-N line.

    lines: (name, life line, stress over endurance limit, cycles endured in each class); the classes are
        stacked from the highest stress downwards
    """
    figure = new_figure(4.6)
    axes = figure.subplots(1, 2)
    width = np.min(np.diff(spectrum.torque), initial=spectrum.torque[-1])
    axes[0].bar(spectrum.torque - width / 2, 100 * spectrum.share, width=0.9 * width, color=BLUE, label="share of time")
    axes[0].set(xlabel="torque at the slow shaft / Nm", ylabel="share of the time / %")
    speed = axes[0].twinx()
    speed.plot(spectrum.torque - width / 2, spectrum.speed, color=VERMILION, marker=".")
    speed.set_ylabel("mean speed / (rad/s)", color=VERMILION)
    speed.spines["right"].set_visible(True)
    axes[0].set_title("load spectrum", loc="left")
    for number, (name, line, ratio, cycles) in enumerate(lines):
        _draw_life(axes[1], name, line, ratio, cycles, SERIES[number])
    axes[1].set(xscale="log", yscale="log", xlabel="load cycles", ylabel="stress over endurance limit")
    axes[1].set_ylim(_STRESS_SHOWN)
    axes[1].set_yticks(_STRESS_TICKS, [f"{tick:g}" for tick in _STRESS_TICKS])
    axes[1].minorticks_off()
    axes[1].set_title("classes and S-N lines", loc="left")
    axes[1].legend(frameon=False, loc="lower left")
    letter(axes)
    show_grid(axes[1])
    return figure


def _draw_life(axis: Axes, name: str, line: LifeLine, ratio: np.ndarray, cycles: np.ndarray, colour: str) -> None:
    stress = np.geomspace(min(0.8, max(ratio.min(), 0.2)), line.strength, 400)
    life = line.cycles(stress)
    known = np.isfinite(life)
    ends = np.append(life[known], line.first / 100), np.append(stress[known], line.strength)
    axis.plot(*ends, color=colour, label=f"{name}: S-N line")
    order = np.argsort(ratio)[::-1]
    axis.step(np.cumsum(cycles[order]), ratio[order], color=colour, linestyle=":", label=f"{name}: spectrum")


@styled
def safety_factors(trains: Mapping[str, Sequence[StageRating]], wanted: Mapping[str, float]) -> Figure:
    """Safety factors of each stage, gear and check as bars, with the wanted ones as lines.

    trains: ratings of the stages by the name of the gearbox; wanted: by kind ("flank", "root",
    "static_flank", "static_root"), 0 where a check is only reported
    """
    stages = max(len(ratings) for ratings in trains.values())
    figure = new_figure(2.9 * stages)
    axes = figure.subplots(stages, len(trains), sharey="row", squeeze=False)
    for column, (name, ratings) in enumerate(trains.items()):
        for row, rating in enumerate(ratings):
            _draw_bars(axes[row, column], rating, wanted)
            axes[row, column].set_title(f"{name}, stage {row + 1}", loc="left")
    for axis in axes[:, 0]:
        axis.set_ylabel("safety factor")
    letter(axes.ravel())
    handles = [Patch(color=colour, label=gear) for gear, colour in _GEAR_COLOURS.items()]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, frameon=False)
    return figure


def _draw_bars(axis: Axes, rating: StageRating, wanted: Mapping[str, float]) -> None:
    for place, (kind, _) in enumerate(_KINDS):
        for offset, (gear, colour) in enumerate(_GEAR_COLOURS.items()):
            value = float(getattr(rating, kind)[gear])
            x = place + 0.26 * (offset - 1)
            axis.bar(x, value, width=0.24, color=colour, alpha=1.0 if value >= wanted[kind] else 0.5)
            above = value if not 0.8 < value / (wanted[kind] or 1.0) < 1 else wanted[kind] or 1.0  # clear of the line
            axis.annotate(f"{value:.2f}", (x, above), ha="center", va="bottom", fontsize=7)
        line = "-" if wanted[kind] else ":"
        axis.plot([place - 0.42, place + 0.42], [wanted[kind] or 1.0] * 2, line, color=BLACK, linewidth=1.2)
    axis.set_xticks(range(len(_KINDS)), [label.replace(", ", "\n") for _, label in _KINDS])
    axis.margins(y=0.15)


@styled
def axial_section(layout: Layout, *, title: str, end: str = "lever side") -> Figure:
    """Half section of the actuator along its axis, mirrored, with its outer dimensions.

    end: what the side is called that faces what is moved
    """
    figure = new_figure(4.8)
    axis = figure.subplots()
    for part in layout.parts:
        for side in (1, -1):
            _draw_part(axis, part, side)
    length, half = layout.length / MILLIMETRE, layout.diameter / 2 / MILLIMETRE
    axis.plot((-2, length + 2), (0, 0), color=BLACK, linewidth=0.7, linestyle=(0, (8, 3, 2, 3)))
    _dimension(axis, (0, half * 1.1), (length, half * 1.1), f"{length:.1f}")
    _dimension(axis, (length * 1.04, -half), (length * 1.04, half), f"Ø {2 * half:.1f}")
    axis.set(xlim=(-3, length * 1.12), ylim=(-1.15 * half, 1.3 * half), aspect="equal")
    axis.set(xlabel=f"axial position from the {end} / mm", ylabel="radius / mm")
    axis.set_title(title, loc="left")
    kinds = dict.fromkeys(part.kind for part in layout.parts)
    handles = [Patch(facecolor=_PART_COLOURS[kind], edgecolor=BLACK, linewidth=0.5, label=kind) for kind in kinds]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False)
    return figure


def _draw_part(axis: Axes, part: Part, side: int) -> None:
    low, high = sorted((side * part.inner_radius, side * part.outer_radius))
    box = (part.start / MILLIMETRE, low / MILLIMETRE), part.length / MILLIMETRE, (high - low) / MILLIMETRE
    axis.add_patch(Rectangle(*box, facecolor=_PART_COLOURS[part.kind], edgecolor=BLACK, linewidth=0.5))


def _dimension(axis: Axes, start: tuple[float, float], end: tuple[float, float], text: str) -> None:
    axis.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.8})
    vertical = start[0] == end[0]
    place = ((start[0] + end[0]) / 2 + (2 if vertical else 0), (start[1] + end[1]) / 2 + (0 if vertical else 2))
    axis.annotate(f"{text} mm", place, rotation=90 if vertical else 0, ha="left" if vertical else "center",
                  va="center" if vertical else "bottom")  # fmt: skip
