"""The winding as it is connected: the stator unrolled, coils in the colours of their phases, leads at the top."""

from __future__ import annotations

from itertools import groupby

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from electrical.winding_connection import Delta, Star
from figures.style import BLACK, GREY, PHASE_COLOURS, PHASE_NAMES, Look, new_figure, styled
from geometry.connections import Connection
from geometry.winding import WindingLayout

_TOOTH = "#D5D8DB"
_BESIDE = 0.2  # of a slot pitch: how far a coil side of a double layer lies beside the middle of its slot
_TOOTH_WIDTH = 0.44  # of a slot pitch
_LEAD, _FIRST_LEVEL, _STAR = 1.08, 1.22, 1.85  # heights over the stack, whose height is 1
_TERMINAL = _STAR + 0.22
_APEX = -0.2


@styled
def winding_diagram(
    layout: WindingLayout, connected: tuple[Connection, ...], closing: Star | Delta, title: str
) -> Figure:
    """Slots along x, tooth 0 at the left; arrows along a positive current of each phase. Leads that end at the same
    letter are joined.

    connected: every coil of the layout, path by path in series; closing: how the phases end
    """
    figure = new_figure(4.4)
    axes = figure.subplots()
    size = min(9.0, 190 / layout.slots)
    _draw_teeth(axes, layout, size)
    for one in connected:
        _draw_coil(axes, layout, one, size)
    _connect_paths(axes, layout, connected, closing)
    _draw_star(axes, layout, [one for one in connected if _at_star_point(one, closing)])
    axes.set(xlim=(-0.55, layout.slots - 0.45), ylim=(-0.5, _TERMINAL + 0.3), yticks=[])
    slots = range(layout.slots)
    axes.set_xticks([slot + 0.5 for slot in slots], [str(slot) for slot in slots], fontsize=size)
    axes.set(xlabel="slot")
    axes.spines["left"].set_visible(False)
    axes.set_title(title, loc="left")
    return figure


def _draw_teeth(axes: Axes, layout: WindingLayout, size: float) -> None:
    for tooth in range(layout.slots):
        axes.add_patch(Rectangle((tooth - _TOOTH_WIDTH / 2, 0.0), _TOOTH_WIDTH, 1.0, color=_TOOTH))
        axes.text(tooth, 0.5, str(tooth), ha="center", va="center", fontsize=size, color=GREY)


def _draw_coil(axes: Axes, layout: WindingLayout, one: Connection, size: float) -> None:
    """Sides, end turn and number; what leaves the picture on one side comes in again on the other."""
    down, up = _sides(layout, one)
    look: Look = {"color": PHASE_COLOURS[one.phase], "linewidth": 1.8, "solid_joinstyle": "round"}
    middle = (down + up) / 2
    for round_once in (0, layout.slots):
        x = [v + round_once for v in (down, down, middle, up, up)]
        axes.plot(x, [_LEAD, 0.0, _APEX, 0.0, _LEAD], **look)
        _arrow(axes, down + round_once, -1, one.phase)
        _arrow(axes, up + round_once, 1, one.phase)
        axes.text(middle + round_once, _APEX - 0.14, f"{one.coil}", ha="center", va="center", fontsize=size,
                  color=PHASE_COLOURS[one.phase], clip_on=True)  # fmt: skip


def _arrow(axes: Axes, x: float, direction: int, phase: int) -> None:
    style: Look = {"arrowstyle": "-|>,head_width=0.22,head_length=0.5", "color": PHASE_COLOURS[phase], "lw": 0}
    axes.annotate("", (x, 0.5 + 0.36 * direction), (x, 0.5 + 0.24 * direction), arrowprops=style, annotation_clip=True)


def _sides(layout: WindingLayout, one: Connection) -> tuple[float, float]:
    """Where the coil goes down and comes up, in slot pitches from tooth 0; a coil has the number of its right slot."""
    beside = _BESIDE if layout.layers == 2 else 0.0
    left, right = one.coil - layout.coil_pitch + 0.5 + beside, one.coil + 0.5 - beside
    return (right, left) if one.reversed else (left, right)


def _connect_paths(axes: Axes, layout: WindingLayout, connected: tuple[Connection, ...], closing: Star | Delta) -> None:
    paths = [tuple(group) for _, group in groupby(connected, key=lambda one: (one.phase, one.path))]
    heights = [max(_tracks(_wires(layout, coils)), default=0) + 1 for coils in paths]
    step = (_STAR - _FIRST_LEVEL) / sum(heights)
    for number, coils in enumerate(paths):
        _connect(axes, layout, coils, _FIRST_LEVEL + step * sum(heights[:number]), step)
        _draw_ends(axes, layout, coils, closing)


def _connect(axes: Axes, layout: WindingLayout, coils: tuple[Connection, ...], level: float, step: float) -> None:
    """Coil to coil; level: of the lowest wire, step: to the next."""
    phase = coils[0].phase
    look: Look = {"color": PHASE_COLOURS[phase], "linewidth": 1.2}
    wires = _wires(layout, coils)
    for (end, begin), track in zip(wires, _tracks(wires)):
        height = level + track * step
        axes.plot([end, end, begin, begin], [_LEAD, height, height, _LEAD], **look)


def _draw_ends(axes: Axes, layout: WindingLayout, coils: tuple[Connection, ...], closing: Star | Delta) -> None:
    """From the terminal of the phase, and to the star point or the terminal of the next phase."""
    phase, following = coils[0].phase, closing.terminal_at_end(coils[0].phase)
    begin, end = _inside(layout, _sides(layout, coils[0])[0]), _inside(layout, _sides(layout, coils[-1])[1])
    _draw_terminal(axes, begin, phase, phase)
    if following is None:
        axes.plot([end, end], [_LEAD, _STAR], color=PHASE_COLOURS[phase], linewidth=1.2)
    else:
        _draw_terminal(axes, end, phase, following)


def _draw_terminal(axes: Axes, x: float, phase: int, terminal: int) -> None:
    """A lead of a phase at a terminal."""
    look: Look = {"color": PHASE_COLOURS[phase], "linewidth": 1.2}
    axes.plot([x, x], [_LEAD, _TERMINAL], marker="o", markevery=[1], markersize=6, **look)
    name, colour = PHASE_NAMES[terminal], PHASE_COLOURS[terminal]
    axes.text(x, _TERMINAL + 0.12, name, color=colour, ha="center", weight="bold")


def _at_star_point(one: Connection, closing: Star | Delta) -> bool:
    return one.following is None and closing.terminal_at_end(one.phase) is None


def _wires(layout: WindingLayout, coils: tuple[Connection, ...]) -> list[tuple[float, float]]:
    """From where each coil comes up to where the next one goes down."""
    sides = [tuple(_inside(layout, x) for x in _sides(layout, one)) for one in coils]
    return [(end, begin) for (_, end), (begin, _) in zip(sides, sides[1:])]


def _tracks(wires: list[tuple[float, float]]) -> list[int]:
    """A height for each wire, so that no two lie on each other: the lowest that is free there."""
    found: list[int] = []
    for wire in wires:
        taken = {track for other, track in zip(wires, found) if _overlap(wire, other)}
        found.append(next(track for track in range(len(wires)) if track not in taken))
    return found


def _overlap(wire: tuple[float, float], other: tuple[float, float]) -> bool:
    return max(min(wire), min(other)) <= min(max(wire), max(other))


def _inside(layout: WindingLayout, x: float) -> float:
    """The same place in the picture."""
    return (x + 0.5) % layout.slots - 0.5


def _draw_star(axes: Axes, layout: WindingLayout, last: list[Connection]) -> None:
    """last: the coils that end at the star point, none in a delta."""
    if not last:
        return
    ends = [_inside(layout, _sides(layout, one)[1]) for one in last]
    axes.plot([min(ends), max(ends)], [_STAR, _STAR], color=BLACK, linewidth=1.6)
    axes.plot(ends, [_STAR] * len(ends), "o", color=BLACK, markersize=4)
    axes.text((min(ends) + max(ends)) / 2, _STAR + 0.06, "star point", ha="center", fontsize=9,
              bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})  # fmt: skip
