"""Designs found together beside the one found stage by stage: every pair of objectives.

The functions take tables and import nothing of ``drivetrain``.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import pandas as pd
from matplotlib.figure import Figure

from figures.style import BLACK, BLUE, LIGHT_GREY, VERMILION, letter, new_figure, show_grid, styled


@styled
def whole_designs(front: pd.DataFrame, verified: pd.DataFrame, staged: pd.Series, labels: Mapping[str, str]) -> Figure:
    """Every pair of objectives.

    front, verified: columns of ``labels``, from the model and solved by the field; staged: the same of the design found
    stage by stage; labels: of the four columns
    """
    figure = new_figure(6.4)
    axes = figure.subplots(2, 3).ravel()
    for axis, (x, y) in zip(axes, combinations(labels, 2), strict=True):
        axis.plot(front[x], front[y], ".", color=LIGHT_GREY, label="front, model", markersize=5)
        axis.plot(verified[x], verified[y], "o", color=BLUE, label="front, solved by the field", markersize=5)
        star = {"color": VERMILION, "markersize": 14, "markeredgecolor": BLACK}
        axis.plot(staged[x], staged[y], "*", label="stage by stage", **star)
        axis.set(xlabel=labels[x], ylabel=labels[y])
    letter(axes)
    show_grid(*axes)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure
