"""Pictures of a blind score: confusion of effects, and how far stated probabilities can be trusted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.blind_metrics import confusion, reliability
from figures.style import new_figure, save_png, show_grid, styled

KINDS = ("verdict", "effect", "nothing", "remains")


@styled
def confusion_figure(cases: Sequence[Mapping], title: str, path: Path) -> None:
    """Truth downwards, verdict sideways, share of the cases of a row as colour."""
    truths, verdicts, table = confusion(cases)
    figure = new_figure(height=0.22 * len(truths) + 3.0, width=0.24 * len(verdicts) + 4.0)
    axes = figure.subplots()
    image = axes.imshow(table, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    axes.set_xticks(range(len(verdicts)), [v.replace("_", " ") for v in verdicts], rotation=90, fontsize=6)
    axes.set_yticks(range(len(truths)), [t.replace("_", " ") for t in truths], fontsize=6)
    for row, column in zip(*np.nonzero(table >= 0.05)):
        dark = table[row, column] > 0.6
        text = f"{table[row, column]:.2f}"
        axes.text(column, row, text, ha="center", va="center", fontsize=4.5, color="white" if dark else "black")
    axes.set_xlabel("verdict (sets that are printed count alike, and their members)")
    axes.set_ylabel("hidden in the campaign")
    axes.set_title(title)
    figure.colorbar(image, ax=axes, label="share of the cases of a row", fraction=0.03, pad=0.02)
    save_png(figure, path)


@styled
def reliability_figure(cases: Sequence[Mapping], path: Path) -> None:
    """Share of the statements that are so against the probability that was stated, for every kind of statement."""
    figure = new_figure(height=5.0, width=6.5)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color="0.6", linewidth=1)
    for kind, marker in zip(KINDS, "osvd"):
        points = reliability(cases, kind)
        if points:
            stated, hit, count = zip(*points)
            axes.plot(stated, hit, marker=marker, label=f"{kind}, n = {sum(count)}")
    axes.set_xlabel("stated probability")
    axes.set_ylabel("share that is so")
    axes.set_ylim(0, 1.06)
    axes.legend()
    show_grid(axes)
    save_png(figure, path)
