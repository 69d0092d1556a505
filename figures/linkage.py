"""The linkage: Pareto front, ratio and angles over the wheel travel, side view.

Of what they are given the functions read attributes only.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from drivetrain.four_bar import FourBar, Motion
from drivetrain.linkage_front import ParetoFront, Standing
from drivetrain.linkage_problem import Box
from figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    PURPLE,
    SERIES,
    VERMILION,
    letter,
    new_figure,
    show_grid,
    styled,
)
from units import DEGREE, MILLIMETRE


@styled
def pareto_front(front: ParetoFront, chosen: int, *, others: Sequence[tuple[str, Standing]] = ()) -> Figure:
    """The front with its choice, other linkages beside it, and where on the front B and C lie.

    front: objectives (points, 2), designs (points, 4) [m], problem.bounds [m]
    others: (name, standing) of linkages to compare, standing as of ``drivetrain.linkage_front.standing``
    """
    figure = new_figure(4.6)
    axes = figure.subplots(1, 2, width_ratios=(1.25, 1))
    _draw_front(axes[0], front, chosen, others)
    _draw_hardpoints(axes[1], front, chosen)
    letter(axes)
    show_grid(*axes)
    return figure


def _draw_front(axis: Axes, front: ParetoFront, chosen: int, others: Sequence[tuple[str, Standing]]) -> None:
    first, second = front.objectives.T
    axis.plot(first, second, color=BLUE, marker=".", markersize=4, label="Pareto front")
    for number, (name, standing) in enumerate(others):
        _draw_standing(axis, name, standing, SERIES[(number + 4) % len(SERIES)])
    axis.plot(first[chosen], second[chosen], "*", color=BLACK, markersize=13, label="chosen")
    axis.set(xlabel="objective 1: transmission ratio (1 = limit)", ylabel="objective 2: transmission angles / rad²")
    axis.set_title("Pareto front", loc="left")
    axis.legend(frameon=False)


def _draw_standing(axis: Axes, name: str, standing: Standing, colour: str) -> None:
    """A linkage with arrows to the front at the same second and at the same first objective."""
    x, y = standing.objectives
    verdict = "dominated" if standing.dominated else "not dominated"
    axis.plot(x, y, "D", color=colour, label=f"{name} ({verdict})")
    for end in ((standing.first_at_same_second, y), (x, standing.second_at_same_first)):
        if standing.dominated and np.all(np.isfinite(end)):
            axis.annotate("", end, (x, y), arrowprops={"arrowstyle": "->", "color": colour})


def _draw_hardpoints(axis: Axes, front: ParetoFront, chosen: int) -> None:
    lower, upper = front.problem.bounds
    names = ("x of B", "y of B", "x of C", "y of C")
    looks = ((BLUE, "-"), (GREEN, "-"), (ORANGE, "-"), (PURPLE, "--"))  # x and y of C often lie on each other
    for k, (name, (colour, line)) in enumerate(zip(names, looks, strict=True)):
        share = (front.designs[:, k] - lower[k]) / (upper[k] - lower[k])
        axis.plot(front.objectives[:, 0], share, line, color=colour, label=name)
    axis.axvline(front.objectives[chosen, 0], color=BLACK, linewidth=0.8, linestyle=":")
    axis.set(xlabel="objective 1: transmission ratio (1 = limit)", ylabel="position in its box (0 to 1)")
    axis.set_ylim(-0.05, 1.05)
    axis.set_title("hardpoints along the front", loc="left")
    axis.legend(frameon=False, ncols=2)


@styled
def linkage_motion(motions: Mapping[str, Motion], *, angle_window: float) -> Figure:
    """Transmission ratio and transmission angles over the wheel travel.

    motions: ``Motion`` by name, single linkages; the first is drawn solid. angle_window: allowed distance from 90
    degrees [rad]
    """
    figure = new_figure(4.4)
    axes = figure.subplots(1, 2)
    for number, (name, motion) in enumerate(motions.items()):
        travel, line = motion.travel / MILLIMETRE, ("-", "--", "-.", ":")[number % 4]
        axes[0].plot(travel, motion.transmission_ratio / MILLIMETRE, line, color=SERIES[number], label=name)
        axes[1].plot(travel, motion.gamma / DEGREE, line, color=BLUE, label=f"γ at B, {name}")
        axes[1].plot(travel, motion.lambda_ / DEGREE, line, color=VERMILION, label=f"λ at A, {name}")
    for edge in (90 - angle_window / DEGREE, 90 + angle_window / DEGREE):
        axes[1].axhline(edge, color=GREY, linewidth=0.8, linestyle=":")
    axes[0].set(ylabel="transmission ratio / (mm/rad)")
    axes[1].set(ylabel="transmission angle / °")
    for axis, title in zip(axes, ("wheel travel per lever angle", "transmission angles and their limits"), strict=True):
        axis.set_xlabel("wheel travel, bump positive / mm")
        axis.set_title(title, loc="left")
        axis.axvline(0, color=LIGHT_GREY, linewidth=0.8, zorder=0)
    letter(axes)
    show_grid(*axes)
    axes[0].legend(frameon=False)
    figure.legend(*axes[1].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
    return figure


@styled
def linkage_side_view(linkage: FourBar, motion: Motion, *, boxes: Sequence[Box] = (), positions: int = 5) -> Figure:
    """The linkage drawn at positions of its wheel travel, with the paths of its joints.

    linkage: arm.wheel_axle, arm.hardpoint_a, hardpoint_c (``FourBar``); motion: the same linkage over the travel;
    boxes: low, high and name of the domains of hardpoints
    """
    figure = new_figure(5.4)
    axis = figure.subplots()
    turn = motion.a / linkage.arm.hardpoint_a
    wheel = linkage.arm.wheel_axle * turn
    for box in boxes:
        _draw_box(axis, box)
    for path, colour in ((wheel, GREY), (motion.a, BLUE), (motion.b, GREEN)):
        axis.plot(path.real / MILLIMETRE, path.imag / MILLIMETRE, color=colour, linewidth=0.9, linestyle=":")
    shown = np.unique(np.append(np.linspace(0, len(motion.travel) - 1, positions).astype(int), _nominal(motion)))
    for k in shown:
        _draw_links(axis, linkage, motion.a[k], motion.b[k], wheel[k], strong=k == _nominal(motion))
    _name_points(axis, linkage, motion.b[_nominal(motion)])
    ends = " to ".join(f"{end / MILLIMETRE:g}" for end in (motion.travel[0], motion.travel[-1]))
    ends = ends.replace("-", "\N{MINUS SIGN}")
    axis.set_title(f"side view over a wheel travel of {ends} mm, nominal position thick", loc="left")
    axis.set(xlabel="x, rearward / mm", ylabel="y, upward / mm", aspect="equal")
    show_grid(axis)
    axis.legend(loc="upper right", frameon=False)
    return figure


def _nominal(motion: Motion) -> int:
    return int(np.argmin(np.abs(motion.travel)))


def _draw_box(axis: Axes, box: Box) -> None:
    low, size = box.low / MILLIMETRE, (box.high - box.low) / MILLIMETRE
    axis.add_patch(
        Rectangle((low.real, low.imag), size.real, size.imag, fill=False, edgecolor=GREY, linestyle="--", linewidth=0.8)
    )
    axis.annotate(f"box of {box.name}, nominal", (low.real, low.imag - 6), color=GREY, fontsize=8, va="top")


def _draw_links(axis: Axes, linkage: FourBar, a: complex, b: complex, wheel: complex, *, strong: bool) -> None:
    look: dict[str, Any] = {"linewidth": 2.6 if strong else 0.9, "alpha": 1.0 if strong else 0.45, "marker": "o"}
    look |= {"markersize": 5 if strong else 2.5}
    rows = ((0, a, BLUE, None), (a, wheel, BLUE, "swing arm"), (a, b, GREEN, "coupler AB"),
            (b, linkage.hardpoint_c, VERMILION, "lever BC"))  # fmt: skip
    for start, end, colour, name in rows:
        x, y = (np.array([np.real(start), np.real(end)]), np.array([np.imag(start), np.imag(end)]))
        axis.plot(x / MILLIMETRE, y / MILLIMETRE, color=colour, label=name if strong else None, **look)


def _name_points(axis: Axes, linkage: FourBar, b: complex) -> None:
    points = {"O": 0j, "A": linkage.arm.hardpoint_a, "B": b, "C": linkage.hardpoint_c, "W": linkage.arm.wheel_axle}
    for name, point in points.items():
        place = (np.real(point) / MILLIMETRE, np.imag(point) / MILLIMETRE)
        axis.annotate(name, place, xytext=(5, 5), textcoords="offset points", fontweight="bold")
