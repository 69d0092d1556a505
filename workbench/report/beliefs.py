"""Pictures of a diagnosis: probabilities, size of the effect, power, what to measure next."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from figures.style import BLUE, GREEN, GREY, LIGHT_GREY, ORANGE, new_figure, show_grid, styled
from workbench.findings import Diagnosis, NextMeasurement, SizePosterior
from workbench.report.channels import ALARM, bar_rows
from workbench.report.words import amount, label, plain, probability_text

_LEAST, _MOST = 4, 10  # explanations of the probability chart
_NEGLIGIBLE = 1e-3  # probability
_NOTHING, _NONE = "nothing missing", "none of these"


@styled
def probabilities(d: Diagnosis) -> Figure:
    """Probability of every explanation, the likeliest effects first, with nothing missing and none of these."""
    rows = _explanations(d)
    figure, axes, place = bar_rows(len(rows), 0.85)
    axes.barh(place, [p for _, p, _ in rows], height=0.65, color=[colour for *_, colour in rows])
    axes.set_yticks(place, [name for name, *_ in rows])
    for y, (_, p, _) in zip(place, rows):
        axes.text(p + 0.01, y, probability_text(p), va="center", fontsize=9)
    axes.axvline(0.9, color=GREY, linestyle=":", linewidth=1.0)
    axes.set(xlim=(0, 1.12), xticks=np.arange(0, 1.01, 0.2), xlabel="probability (dotted: needed for a definite name)")
    return figure


def _explanations(d: Diagnosis) -> list[tuple[str, float, str]]:
    named = set(d.names)
    effects = [(plain(r.name), r.probability, BLUE if r.name in named else LIGHT_GREY) for r in d.ranking]
    pairs = [(plain(name), p, BLUE if set(name.split(" + ")) <= named else LIGHT_GREY) for name, p in d.p_pairs.items()]
    parts = [(f"{plain(name)} and something unknown", p, _partly(d, name)) for name, p in d.p_partial.items()]
    likely = sorted(effects + pairs + parts, key=lambda row: -row[1])
    shown = likely[:_LEAST] + [row for row in likely[_LEAST:_MOST] if row[1] > _NEGLIGIBLE]
    rest = sum(p for _, p, _ in likely[len(shown) :])
    others = [(f"{len(likely) - len(shown)} others together", rest, LIGHT_GREY)] if len(likely) > len(shown) else []
    return [(_NOTHING, d.p_nothing_missing, GREEN), (_NONE, d.p_none_of_these, ALARM), *shown, *others]


def _partly(d: Diagnosis, name: str) -> str:
    return BLUE if d.verdict == "partial" and name in d.names else LIGHT_GREY


@styled
def size_posteriors(found: tuple[SizePosterior, ...]) -> Figure:
    """Density of each parameter of the named effect, its 90 % interval, and what was believed before."""
    columns = min(2, len(found))
    rows = -(-len(found) // columns)
    figure = new_figure(2.7 * rows)
    axes = figure.subplots(rows, columns, squeeze=False).ravel()
    for axis, posterior in zip(axes, found):
        _density(axis, posterior)
    for axis in axes[len(found) :]:
        axis.set_axis_off()
    return figure


def _density(axes, p: SizePosterior) -> None:
    inside = (p.values >= p.estimate.low90) & (p.values <= p.estimate.high90)
    axes.fill_between(p.values, p.density, where=inside, color=BLUE, alpha=0.25, linewidth=0, label="90 % interval")
    axes.plot(p.values, p.density, color=BLUE, label="after the measurement")
    axes.plot(p.values, p.prior, color=GREY, linestyle=":", label="believed before")
    axes.axvline(p.estimate.value, color=BLUE, linewidth=1.0)
    axes.set(xlabel=label(p.parameter, p.unit), ylabel="density", yticks=[], ylim=(0, 1.2 * p.density.max()))
    axes.set_title(plain(p.effect), loc="left")
    axes.legend(loc="upper right", fontsize=8)


@styled
def next_measurements(options: tuple[NextMeasurement, ...]) -> Figure:
    """Expected gain of evidence of each measurement, for its declared cost, the best first."""
    shown = sorted(options, key=lambda m: -m.gain_nats / m.cost)[:_MOST]
    figure, axes, place = bar_rows(len(shown))
    axes.barh(place, [m.gain_nats / m.cost for m in shown], height=0.62, color=ORANGE)
    axes.set_yticks(place, [m.words or plain(m.kind) for m in shown])
    for y, m in zip(place, shown):
        words = f" {amount(m.gain_nats, digits=2)} nats, cost {amount(m.cost, digits=2)}"
        axes.text(m.gain_nats / m.cost, y, words, va="center", fontsize=9)
    axes.set(xlim=(0, 1.35 * max(m.gain_nats / m.cost for m in shown) or 1.0), xlabel="gain per cost / nats")
    show_grid(axes)
    return figure
