"""Pictures of a diagnosis: probabilities, size of the effect, power, what to measure next."""

from __future__ import annotations

from math import log

import numpy as np
from matplotlib.figure import Figure

from figures.style import BLUE, GREEN, GREY, LIGHT_GREY, ORANGE, new_figure, show_grid, styled
from workbench.findings import Diagnosis, NextMeasurement, SizePosterior
from workbench.report.channels import ALARM, bar_rows
from workbench.report.sentences import NEGLIGIBLE
from workbench.report.words import amount, factor_text, label, plain, probability_text

_LEAST, _MOST = 4, 10  # effects of the probability chart, options of what to measure next


@styled
def probabilities(d: Diagnosis) -> Figure:
    """Probability of every effect, alone or with others, the likeliest first, beside nothing and the unknown."""
    rows = _statements(d)
    figure, axes, place = bar_rows(len(rows), 0.85)
    axes.barh(place, [p for _, p, _ in rows], height=0.65, color=[colour for *_, colour in rows])
    axes.set_yticks(place, [name for name, *_ in rows])
    for y, (_, p, _) in zip(place, rows):
        axes.text(p + 0.01, y, probability_text(p), va="center", fontsize=9)
    axes.axvline(d.sure, color=GREY, linestyle=":", linewidth=1.0)
    axes.set(xlim=(0, 1.12), xticks=np.arange(0, 1.01, 0.2))
    axes.set_xlabel(f"probability (dotted: a name is printed from {probability_text(d.sure)})")
    return figure


def _statements(d: Diagnosis) -> list[tuple[str, float, str]]:
    """Words, probability and colour of each bar."""
    likely = sorted(d.ranking, key=lambda r: (r.name not in d.names, -r.probability))
    shown = likely[:_LEAST] + [r for r in likely[_LEAST:_MOST] if r.probability > NEGLIGIBLE]
    return [
        ("nothing missing", d.p_nothing_missing, GREEN),
        ("something unknown", d.p_something_remains, ALARM),
        ("none of these", d.p_none_of_these, ALARM),
        *((plain(r.name), r.probability, BLUE if r.name in d.names else LIGHT_GREY) for r in shown),
    ]


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
    """Expected gain of each measurement in powers of ten of the odds, for its declared cost, the best first."""
    shown = sorted(options, key=lambda m: -m.gain_nats / m.cost)[:_MOST]
    figure, axes, place = bar_rows(len(shown))
    powers = [m.gain_nats / m.cost / log(10) for m in shown]
    axes.barh(place, powers, height=0.62, color=ORANGE)
    axes.set_yticks(place, [m.words or plain(m.kind) for m in shown])
    for y, power, m in zip(place, powers, shown):
        words = f" {factor_text(m.gain_nats)} in the odds, cost {amount(m.cost, digits=2)}"
        axes.text(power, y, words, va="center", fontsize=9)
    axes.set(xlim=(0, 1.45 * max(powers) or 1.0), xlabel="powers of ten in the odds for a cost of one")
    show_grid(axes)
    return figure
