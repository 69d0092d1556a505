"""The page of ``validate``: does a model file hold on data that it was not learned from, and where not."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.special import bdtr

from figures.report import KeyNumber, KeyNumbers, Part, Picture, Remark, Section, Table, write_report
from figures.style import BLACK, BLUE, ORANGE, new_figure, show_grid, styled
from workbench.findings import PredictedChannel, Pull, ValidatedChannel, Validation
from workbench.report.channels import below
from workbench.report.sentences import ALARMING_P, ALARMING_PULL, GOAL
from workbench.report.words import (
    amount,
    axis_label,
    chi2_text,
    label,
    listed,
    percent,
    plain,
    quantity_of,
    sentence,
    signed,
)

IN_BAND = 0.90


def write_validation_report(path: Path, validation: Validation) -> None:
    """Write the page of a validation: errors of both models, where the learned range is left, every channel."""
    about = f" with {listed(map(plain, validation.effects))}" if validation.effects else " without effects"
    write_report(
        path,
        validation_sections(validation),
        title=f"Predicted and measured: {validation.campaign}",
        subtitle=f"Model {validation.model}{about}, learned from {validation.learned_from}",
        provenance=dict(validation.provenance),
    )


def validation_sections(v: Validation) -> tuple[Section, ...]:
    """Sections of the page in reading order; a section is left out where there is nothing to show."""
    warned = tuple(Remark(words) for words in warnings(v))
    return (
        Section("Does the model hold?", (validation_sentence(v), *warned, _numbers(v))),
        Section("Error of each channel", (_errors(v),)),
        *_range(v),
        *(Section(f"{plain(p.channel)}", (Picture(prediction(p), _caption(p)),)) for p in v.predictions),
        *_calibration(v),
        *_limits(v),
    )


# ---- sentences ------------------------------------------------------------------------------------------------------


def validation_sentence(v: Validation) -> str:
    """Error and band of the corrected model against those of the device as drawn; before them, that instruments would
    have to be wrong for them."""
    return (
        f"{_with_wrong_instruments(v)}Without anything of the device being fitted to these {rows(v.corrected)} "
        f"readings, chi²/n is {chi2_text(chi2(v.corrected))} where the device as drawn gives {chi2_text(chi2(v.base))}"
        f"{' though its instruments may be further off than they are declared' if _far(v.base_calibrations) else ''}; "
        f"{percent(share(v.corrected))} of the readings lie in the predicted 90 % band "
        f"(as drawn {percent(share(v.base))})."
    )


def _with_wrong_instruments(v: Validation) -> str:
    far = sorted(_far(v.calibrations), key=lambda p: -abs(p.pull))
    if not far:
        return ""
    worst = f"{plain(far[0].name)} by {signed(far[0].pull, 2)} sigma"
    return (
        f"For what follows instruments would have to be off by more than they are declared, {worst}: is it the same "
        "device? "
    )


def warnings(v: Validation) -> tuple[str, ...]:
    """What speaks against using the model here, one sentence each."""
    return (*_too_sure(v), *_worse(v), *_unanswered(v), *_pulled(v))


def _too_sure(v: Validation) -> list[str]:
    few = [c for c in v.corrected if bdtr(round(c.share_in_90 * c.n), c.n, IN_BAND) < ALARMING_P]
    said = listed(f"{c.channel} ({percent(c.share_in_90)})" for c in few)
    return [f"The model is surer than it may be: fewer readings lie in its band than 90 % in {said}."] if few else []


def _worse(v: Validation) -> list[str]:
    """Nothing where the device as drawn is right only with instruments that are wrong."""
    if _far(v.base_calibrations) and not _far(v.calibrations):
        return []
    worse = [c.channel for c, drawn in zip(v.corrected, v.base) if _is_worse(c, drawn)]
    return [f"What was learned makes {listed(worse)} worse than the device as drawn."] if worse else []


def _is_worse(c: ValidatedChannel, drawn: ValidatedChannel) -> bool:
    """Of a channel that is not at its noise."""
    return c.rms_error > drawn.rms_error and c.chi2_per_n > GOAL


def _unanswered(v: Validation) -> list[str]:
    said = []
    for words, channels in (("The corrected model", v.corrected), ("The device as drawn", v.base)):
        without = [f"{c.no_answer} of {c.n} rows of {c.channel}" for c in channels if c.no_answer]
        said += (
            [f"{words} has no steady state in {listed(without)}; they count as outside its band."] if without else []
        )
    return said


def _pulled(v: Validation) -> list[str]:
    said = []
    for words, pulls in (("", v.calibrations), (" of the device as drawn", v.base_calibrations)):
        moved = listed(f"{plain(p.name)} by {signed(p.pull, 2)} sigma" for p in _far(pulls))
        said += [f"The calibration{words} moves further than its declaration allows: {moved}."] if moved else []
    return said


def _far(pulls: Sequence[Pull]) -> list[Pull]:
    return [p for p in pulls if abs(p.pull) > ALARMING_PULL]


def rows(channels: Sequence[ValidatedChannel]) -> int:
    """Readings of all channels together."""
    return sum(c.n for c in channels)


def chi2(channels: Sequence[ValidatedChannel]) -> float:
    """chi2/n over all channels, of the rows with a prediction."""
    known = [(c.chi2_per_n, c.n - c.no_answer) for c in channels if c.n > c.no_answer]
    return sum(value * n for value, n in known) / sum(n for _, n in known) if known else float("nan")


def share(channels: Sequence[ValidatedChannel]) -> float:
    """Share of all readings inside the 90 % band."""
    return sum(c.share_in_90 * c.n for c in channels) / rows(channels)


# ---- parts of the page ----------------------------------------------------------------------------------------------


def _numbers(v: Validation) -> KeyNumbers:
    beyond = sum(c.outside_range * c.n for c in v.corrected) / rows(v.corrected)
    return KeyNumbers(
        (
            KeyNumber("chi²/n, corrected", chi2_text(chi2(v.corrected)), remark="1 for a model without error"),
            KeyNumber("chi²/n, as drawn", chi2_text(chi2(v.base))),
            KeyNumber("in the 90 % band", percent(share(v.corrected)), remark=f"as drawn {percent(share(v.base))}"),
            KeyNumber("beyond what was learned", percent(beyond), remark="of the readings"),
        )
    )


def _errors(v: Validation) -> Table:
    table = [
        {
            "channel": c.channel,
            "n": c.n,
            "rms error": amount(c.rms_error, c.unit),
            "as drawn": amount(drawn.rms_error, c.unit),
            "bias": amount(c.bias, c.unit),
            "bias as drawn": amount(drawn.bias, c.unit),
            "chi²/n": chi2_text(c.chi2_per_n),
            "chi²/n as drawn": chi2_text(drawn.chi2_per_n),
            "in band": percent(c.share_in_90),
            "in band as drawn": percent(drawn.share_in_90),
        }
        for c, drawn in zip(v.corrected, v.base)
    ]
    marked = tuple(k for k, (c, drawn) in enumerate(zip(v.corrected, v.base)) if c.rms_error > drawn.rms_error)
    return Table(
        pd.DataFrame(table),
        "Reading minus prediction; chi²/n over the noise of the readings alone. The band holds the uncertainty of "
        "inputs, effects and calibration, the noise, and what was left unexplained where it was learned. Marked: worse "
        "than as drawn.",
        marked=marked,
    )


def _range(v: Validation) -> tuple[Section, ...]:
    """Nothing where all readings lie inside what was learned."""
    if not v.range_left:
        return ()
    beyond = [c for c in v.corrected if c.outside_range]
    content: tuple[Part, ...] = v.range_left
    return (Section("Where the learned range is left", (*content, *((_beyond(beyond),) if beyond else ()))),)


def _beyond(channels: Sequence[ValidatedChannel]) -> Table:
    table = [
        {
            "channel": c.channel,
            "rows beyond": percent(c.outside_range),
            "rms error there": amount(c.outside_rms_error, c.unit),
            "of all": amount(c.rms_error, c.unit),
            "chi²/n there": chi2_text(c.outside_chi2_per_n),
            "in band there": percent(c.outside_share_in_90 or 0.0),
        }
        for c in channels
    ]
    return Table(pd.DataFrame(table), "The corrected model at conditions that it was not learned at.")


def _calibration(v: Validation) -> tuple[Section, ...]:
    if not v.calibrations:
        return ()
    table = [
        {"instrument": plain(p.name), "declared": f"± {_size(p, p.sigma)}", "found": _size(p, p.pull * p.sigma),
         "in sigma": signed(p.pull, 2)}
        for p in v.calibrations
    ]  # fmt: skip
    said = "The only numbers that were fitted to these readings: what the campaign declares of its own instruments."
    return (Section("Calibration of the instruments", (said, Table(pd.DataFrame(table), "With the corrected model."))),)


def _size(p: Pull, value: float) -> str:
    return f"{amount(100 * value)} %" if p.unit == "relative" else amount(value, p.unit)


def _limits(v: Validation) -> tuple[Section, ...]:
    said = tuple(map(sentence, v.complaints))
    return (Section("What limits the conclusions", said),) if said else ()


# ---- pictures -------------------------------------------------------------------------------------------------------


def _caption(p: PredictedChannel) -> str:
    hollow = " Hollow: beyond the conditions that were learned from." if p.outside.any() else ""
    return (
        "Left the device as drawn, right what was learned; above the readings on the predicted 90 % band, below "
        f"reading minus prediction on the same band. Left and right have the same axes.{hollow}"
    )


@styled
def prediction(p: PredictedChannel) -> Figure:
    """Readings and predicted 90 % bands above, residuals below; as drawn left, corrected right, same axes."""
    figure = new_figure(5.8)
    axes = figure.subplots(2, 2, sharex=True, sharey="row", height_ratios=(3, 2))
    sides = (("as drawn", ORANGE, p.base, p.base_half), ("corrected", BLUE, p.corrected, p.corrected_half))
    for (top, bottom), (title, colour, predicted, half) in zip(axes.T, sides):
        _bars(top, p.x, predicted, half, colour)
        _points(top, p, p.measured)
        top.set_title(title, loc="left")
        _bars(bottom, p.x, np.zeros_like(half), half, colour)
        bottom.axhline(0.0, color=BLACK, linewidth=0.8)
        _points(bottom, p, p.measured - predicted)
        bottom.set_xlabel(axis_label(p.axis))
    axes[0, 0].set_ylabel(label(quantity_of(p.channel), p.unit))
    axes[1, 0].set_ylabel(label("residual", p.unit))
    below(figure, _legend(axes[0, 1]))
    return figure


def _bars(axes: Axes, x: np.ndarray, middle: np.ndarray, half: np.ndarray, colour: str) -> None:
    axes.vlines(x, middle - half, middle + half, color=colour, alpha=0.45, linewidth=3)
    axes.plot(x, middle, linestyle="", marker="_", markersize=5, color=colour)
    show_grid(axes)


def _points(axes: Axes, p: PredictedChannel, values: np.ndarray) -> None:
    look = {"linestyle": "", "marker": "o", "markersize": 3.5, "color": BLACK}
    for chosen, fill in ((~p.outside, BLACK), (p.outside, "white")):
        axes.plot(p.x[chosen], values[chosen], markerfacecolor=fill, **look)


def _legend(axes: Axes) -> Axes:
    axes.plot([], [], linestyle="", marker="o", markersize=3.5, color=BLACK, label="measured")
    axes.plot([], [], color=ORANGE, alpha=0.45, linewidth=3, label="90 % band as drawn")
    axes.plot([], [], color=BLUE, alpha=0.45, linewidth=3, label="90 % band, corrected")
    return axes
