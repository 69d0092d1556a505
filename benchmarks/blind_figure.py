"""Pictures of a blind score: confusion of effects, and how far stated probabilities can be trusted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.blind_metrics import confusion, reliability
from figures.style import new_figure, save_png, show_grid, styled

BIN_EDGES = np.array([0.5, 0.7, 0.85, 0.95])


@styled
def confusion_figure(cases: Sequence[dict], title: str, path: Path) -> None:
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
    axes.set_xlabel("verdict (a group counts for its members in equal parts)")
    axes.set_ylabel("hidden in the campaign")
    axes.set_title(title)
    figure.colorbar(image, ax=axes, label="share of the cases of a row", fraction=0.03, pad=0.02)
    save_png(figure, path)


@styled
def reliability_figure(blind: Sequence[dict], crime: Sequence[dict], path: Path) -> None:
    """Share of right verdicts against the probability that was stated."""
    figure = new_figure(height=5.0, width=6.5)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color="0.6", linewidth=1)
    for cases, label, marker, below in ((blind, "blind", "o", -11), (crime, "inverse crime", "s", 6)):
        points = reliability(cases, BIN_EDGES)
        if points:
            stated, hit, count = zip(*points)
            axes.plot(stated, hit, marker=marker, label=label)
            for x, y, n in zip(stated, hit, count):
                axes.annotate(f"{n}", (x, y), textcoords="offset points", xytext=(0, below), fontsize=7, ha="center")
    axes.set_xlabel("stated probability of the verdict")
    axes.set_ylabel("share of right verdicts")
    axes.set_ylim(0, 1.06)
    axes.set_title("Numbers are cases of a bin")
    axes.legend()
    show_grid(axes)
    save_png(figure, path)
