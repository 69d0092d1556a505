"""Designs on the road: recovered power, comfort and road holding over mass."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, LIGHT_GREY, VERMILION, letter, new_figure, show_grid, styled


@styled
def judged_designs(designs: pd.DataFrame, best: pd.DataFrame, staged: pd.Series | None) -> Figure:
    """Three indices of every design over its mass.

    designs, best: columns mass_kg, recovered_W, comfort_g, road_holding; best: those that no other betters in all
    staged: the design found stage by stage, None where it was not driven
    """
    figure = new_figure(3.6)
    axes = figure.subplots(1, 3)
    words = {"recovered_W": "recovered / W", "comfort_g": "comfort / g", "road_holding": "road holding"}
    for axis, (column, label) in zip(axes, words.items(), strict=True):
        axis.plot(designs["mass_kg"], designs[column], ".", color=LIGHT_GREY, label="every design", markersize=6)
        axis.plot(best["mass_kg"], best[column], "o", color=BLUE, label="bettered by none", markersize=4)
        if staged is not None:
            star = {"color": VERMILION, "markersize": 14, "markeredgecolor": BLACK, "linestyle": ""}
            axis.plot(staged["mass_kg"], staged[column], marker="*", label="stage by stage", **star)
        axis.set(xlabel="mass / kg", ylabel=label)
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure
