"""What kind of structure a residual has: orders, powers, parity, order of acquisition, whiteness, signatures, pulls."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    LIGHT_GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    YELLOW,
    show_grid,
    styled,
)  # fmt: skip
from workbench.findings import OrderSpectrum, Parity, Pull, Scaling, Sequence, SignatureMatch, Whiteness
from workbench.report.channels import ALARM, MOST_POINTS, bar_rows, panels
from workbench.report.sentences import ALARMING_P, ALARMING_PULL
from workbench.report.words import amount, axis_label, label, p_text, plain, quantity_of, signed

ORDER_COLOURS = {
    "native": (GREY, "native, LCM(Q, 2p)"),
    "rotor": (VERMILION, "rotor side, k Q"),
    "stator": (BLUE, "stator side, k 2p"),
    "emf": (GREEN, "EMF, odd p"),
    "other_emf": (SKY, "new in the EMF"),
    "encoder": (YELLOW, "encoder, 1 and 2"),
    "current": (PURPLE, "current, 6 electrical"),
    "imbalance": (ORANGE, "imbalance, 2 electrical"),
    "other": (LIGHT_GREY, "no family"),
}
MOST_CHANNELS = 6  # of one picture
_MOST_EFFECTS = 15  # of the signature chart
_MOST_ORDERS_NAMED = 8


@styled
def pulls(found: tuple[Pull, ...]) -> Figure:
    """Shift of every declared uncertainty over its sigma; red beyond three."""
    figure, axes, place = bar_rows(len(found))
    values = np.array([pull.pull for pull in found])
    axes.axvspan(-ALARMING_PULL, ALARMING_PULL, color=LIGHT_GREY, alpha=0.5, linewidth=0)
    axes.axvline(0.0, color=BLACK, linewidth=0.8)
    axes.barh(place, values, height=0.6, color=np.where(np.abs(values) > ALARMING_PULL, ALARM, BLUE))
    axes.set_yticks(place, [_pull_name(pull) for pull in found])
    reach = 1.15 * max(4.0, np.abs(values).max())
    for y, value in zip(place, values):
        side = "left" if value >= 0 else "right"
        axes.text(
            value + (0.02 if value >= 0 else -0.02) * reach, y, signed(value, 2), va="center", ha=side, fontsize=9
        )
    axes.set(xlim=(-reach, reach), xlabel="shift of the fit / declared sigma (grey: up to 3)")
    return figure


def _pull_name(pull: Pull) -> str:
    if pull.what == "effect":
        return plain(pull.name)
    return (
        f"{plain(pull.name)} (± {amount(100 * pull.sigma)} %)"
        if _is_relative(pull)
        else f"{plain(pull.name)} (± {amount(pull.sigma, pull.unit)})"
    )


def _is_relative(pull: Pull) -> bool:
    return pull.unit in ("", "1", "relative")


@styled
def order_spectra(spectra: tuple[OrderSpectrum, ...]) -> Figure:
    """Residual amplitude of every mechanical order, coloured by family, against the noise."""
    shown = spectra[:MOST_CHANNELS]
    figure, axes = panels(len(shown), 2.5, rest=0.6)
    axes = axes.ravel()
    for axis, spectrum in zip(axes, shown):
        _spectrum(axis, spectrum)
    axes[-1].set_xlabel("mechanical order / (1/revolution)")
    families = [c for c in ORDER_COLOURS if any(c in s.classes for s in shown)]
    handles = [Patch(facecolor=ORDER_COLOURS[c][0], edgecolor=GREY, linewidth=0.4) for c in families]
    figure.legend(handles, [ORDER_COLOURS[c][1] for c in families], loc="outside lower center", ncols=5, frameon=False)
    return figure


def _spectrum(axes, spectrum: OrderSpectrum) -> None:
    orders, amplitude = spectrum.orders, spectrum.amplitude
    colours = [ORDER_COLOURS[name][0] for name in spectrum.classes]
    width = 0.8 * float(np.min(np.diff(orders))) if len(orders) > 1 else 0.8
    axes.bar(orders, amplitude, width=width, color=colours, edgecolor=GREY, linewidth=0.3)
    axes.step(orders, spectrum.floor, where="mid", color=BLACK, linewidth=1.0)
    axes.text(
        1.0, spectrum.floor[-1], "noise", fontsize=8, va="bottom", ha="right", transform=axes.get_yaxis_transform()
    )
    above = np.flatnonzero(amplitude > spectrum.floor)
    for k in above[np.argsort(-amplitude[above])][:_MOST_ORDERS_NAMED]:
        axes.annotate(
            f"{orders[k]:g}", (orders[k], amplitude[k]), (0, 2), textcoords="offset points", ha="center", fontsize=9
        )
    axes.set_title(spectrum.title, loc="left")
    axes.set_ylabel(label(f"residual {quantity_of(spectrum.channel)}", spectrum.unit))
    axes.set_ylim(0, 1.18 * max(amplitude.max(), spectrum.floor.max()))
    show_grid(axes)


@styled
def scalings(found: tuple[Scaling, ...]) -> Figure:
    """Exponent of the residual's growth with each condition and its 90 % interval."""
    figure, axes, place = bar_rows(len(found))
    for y, s in zip(place, found):
        colour = BLUE if s.meaning else GREY
        axes.plot([s.low90, s.high90], [y, y], color=colour, linewidth=2.5, solid_capstyle="butt")
        axes.plot(s.exponent, y, marker="o", color=colour)
    axes.set_yticks(place, [f"{s.channel} with {plain(s.quantity)}" for s in found])
    low, high = min(min(s.low90 for s in found), -0.2), max(max(s.high90 for s in found), 2.2)
    low, high = max(low, -4.0), min(high, 5.0)
    axes.set_xlim(low - 0.2, high + 0.2)
    for power in range(int(np.ceil(low)), int(high) + 1):
        axes.axvline(power, color=LIGHT_GREY, linewidth=0.9, zorder=0)
    for y, s in zip(place, found):
        if s.meaning:
            axes.annotate(s.meaning, (s.exponent, y), (0, 7), textcoords="offset points", ha="center", fontsize=8.5)
    axes.set(xlabel="exponent and 90 % interval", ylim=(-0.6, len(found) - 0.3))
    return figure


@styled
def parities(found: tuple[Parity, ...]) -> Figure:
    """Odd and even part of the residual under each reversal, against what noise alone gives."""
    figure, axes, place = bar_rows(len(found), 1.5)
    axes.barh(place + 0.2, [p.odd for p in found], height=0.36, color=BLUE, label="odd part (loss, friction)")
    axes.barh(place - 0.2, [p.even for p in found], height=0.36, color=ORANGE, label="even part (offset, misalignment)")
    for y, p in zip(place, found):
        axes.plot([p.floor, p.floor], [y - 0.45, y + 0.45], color=BLACK, label="noise" if y == place[0] else None)
    axes.set_yticks(place, [f"{p.channel}\nunder {plain(p.reversal)}" for p in found])
    axes.set_xlabel("rms residual / u")
    show_grid(axes)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False)
    return figure


@styled
def sequences(found: tuple[Sequence, ...]) -> Figure:
    """Residual in the order of acquisition, scans in alternating colours, with the straight trend."""
    shown = found[:MOST_CHANNELS]
    figure, axes = panels(len(shown), 1.75, rest=0.4)
    for axis, sequence in zip(axes.ravel(), shown):
        _sequence(axis, sequence)
    return figure


def _sequence(axes, s: Sequence) -> None:
    rows = np.unique(np.linspace(0, len(s.x) - 1, min(len(s.x), MOST_POINTS)).astype(int))
    number = np.unique(s.scan, return_inverse=True)[1]
    axes.scatter(s.x[rows], s.residual[rows], s=7, c=np.array([BLUE, SKY])[number[rows] % 2])
    alarming = s.p_value < ALARMING_P
    middle = float(np.mean(s.residual))
    ends = [middle - s.trend / 2, middle + s.trend / 2]
    axes.plot([s.x.min(), s.x.max()], ends, color=ALARM if alarming else BLACK, linewidth=1.6)
    axes.set_title(f"{s.channel}: trend {signed(s.trend, 2)} u, {p_text(s.p_value)}", loc="left")
    reach = 1.1 * max(3.0, float(np.percentile(np.abs(s.residual), 99.5)))
    axes.set(xlabel=axis_label(s.axis), ylabel="residual / u", ylim=(-reach, reach))
    show_grid(axes)


@styled
def whiteness(found: tuple[Whiteness, ...]) -> Figure:
    """Autocorrelation within scans with its 99 % band, and the dependence on each condition."""
    shown = found[:MOST_CHANNELS]
    figure, axes = panels(len(shown), 2.0, rest=0.4, columns=2, width_ratios=(3, 2))
    for (left, right), w in zip(axes, shown):
        _autocorrelation(left, w)
        _dependences(right, w)
    axes[-1, 0].set_xlabel("lag / readings")
    axes[-1, 1].set_xlabel("p-value (left of the line: depends)")
    return figure


def _autocorrelation(axes, w: Whiteness) -> None:
    lags = np.arange(1, len(w.autocorrelation) + 1)
    outside = np.abs(w.autocorrelation) > w.band99
    axes.axhspan(-w.band99, w.band99, color=LIGHT_GREY, alpha=0.6, linewidth=0)
    axes.bar(lags, w.autocorrelation, width=0.7, color=np.where(outside, ALARM, BLUE))
    axes.axhline(0.0, color=BLACK, linewidth=0.8)
    reach = 1.15 * max(0.4, w.band99, float(np.abs(w.autocorrelation).max()) if len(lags) else 0.0)
    axes.set(ylim=(-reach, reach), ylabel="autocorrelation")
    axes.xaxis.get_major_locator().set_params(integer=True)
    axes.set_title(w.channel, loc="left")


def _dependences(axes, w: Whiteness) -> None:
    place = np.arange(len(w.dependences))[::-1]
    values = np.array([max(d.p_value, 1e-3) for d in w.dependences])
    axes.set(xscale="log", xlim=(8e-4, 1.2), ylim=(-0.7, max(len(place) - 0.3, 0.7)))
    axes.hlines(place, values, 1.0, color=LIGHT_GREY, linewidth=2)
    axes.scatter(values, place, color=np.where(values < ALARMING_P, ALARM, BLUE), zorder=3)
    axes.axvline(ALARMING_P, color=BLACK, linestyle=":", linewidth=1.0)
    axes.set_yticks(place, [plain(d.condition) for d in w.dependences])
    axes.set_xticks([1e-3, 1e-2, 0.1, 1.0], ["≤ 0.001", "0.01", "0.1", "1"])
    axes.minorticks_off()


@styled
def signatures(found: tuple[SignatureMatch, ...]) -> Figure:
    """Cosine of the residual with what each effect would leave, the nearest first."""
    shown = sorted(found, key=lambda s: -abs(s.cosine))[:_MOST_EFFECTS]
    figure, axes, place = bar_rows(len(shown), 0.8)
    values = np.array([s.cosine for s in shown])
    axes.barh(place, np.abs(values), height=0.65, color=np.where(values < 0, SKY, BLUE))
    axes.set_yticks(place, [plain(s.name) for s in shown])
    for y, value in zip(place, values):
        axes.text(abs(value) + 0.01, y, signed(value, 2), va="center", fontsize=9)
    axes.set(xlim=(0, 1.08), xlabel="|cosine| (1: the same shape; pale: opposite sign)")
    show_grid(axes)
    return figure
