"""The match drawn by lot: ratio and length of the chosen machine, and where the least cost goes."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from drivetrain.match import Match
from drivetrain.output import Output, in_unit, labelled
from figures.style import BLACK, BLUE, letter, new_figure, series_style, show_grid, styled
from uncertainty.match_spread import DrawnMatch, MatchSpread
from units import MILLIMETRE


@styled
def match_moves(spread: MatchSpread, drawn: Match, output: Output) -> Figure:
    """Ratios and lengths of the chosen machine over all draws, and diameters and lengths of the free choice.

    drawn: the match as it stands
    """
    figure = new_figure(3.4)
    ratio, length, free = figure.subplots(1, 3)
    together = [one for one in spread.together if one is not None]
    ratio.hist([in_unit(one.transmission_ratio, output.ratio_unit) for one in together], bins=20, color=BLUE)
    ratio.axvline(in_unit(drawn.transmission_ratio, output.ratio_unit), color=BLACK, linestyle="--")
    ratio.set(xlabel=labelled("transmission ratio", output.ratio_unit), ylabel="draws", title="chosen machine")
    length.hist([one.active_length / MILLIMETRE for one in together], bins=20, color=BLUE)
    length.axvline(drawn.active_length / MILLIMETRE, color=BLACK, linestyle="--", label="as it stands")
    length.set(xlabel="active length / mm", ylabel="draws", title="chosen machine")
    length.legend()
    _free(free, [one for one in spread.free if one is not None])
    letter((ratio, length, free))
    show_grid(ratio, length, free)
    return figure


def _free(axes: Axes, draws: Sequence[DrawnMatch]) -> None:
    looks = series_style(one.slots for one in draws)
    for slots, look in looks.items():
        own = [one for one in draws if one.slots == slots]
        diameters = [2 * one.stator_outer_radius / MILLIMETRE for one in own]
        lengths = [one.active_length / MILLIMETRE for one in own]
        axes.scatter(diameters, lengths, s=18, alpha=0.7, label=f"{slots} slots", **look)
    axes.set(xlabel="stator diameter / mm", ylabel="active length / mm", title="radius and slots free")
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.legend()
