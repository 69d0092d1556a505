"""The pages of ``compare``, ``diagnose`` and the ledger, read from top to bottom: what was found, where, the views."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pandas as pd

from figures.report import Code, KeyNumber, KeyNumbers, Picture, Remark, Section, Table, write_report
from workbench.believed import LIKELY
from workbench.findings import ChannelFit, Comparison, Diagnosis, LearnedAt, Ledger, LedgerStep, Prediction, Ranked
from workbench.report import beliefs, channels, operating_range, structure
from workbench.report.sentences import (
    NO_GAIN,
    Reading,
    bound_sentences,
    channels_off,
    comparison_sentence,
    conclusions,
    leading,
    ledger_sentence,
    left_out_sentence,
    meaning,
    open_questions,
    power_sentence,
    readings,
    sealed_sentence,
    set_words,
    size_words,
    verdict_sentence,
)  # fmt: skip
from workbench.report.waterfall import waterfall
from workbench.report.words import (
    amount,
    bounds,
    chi2_text,
    estimated,
    factor_text,
    interval,
    listed,
    number,
    odds_text,
    percent,
    plain,
    probability_text,
    sentence,
    signed,
    unit_text,
)

_NOTHING_MORE: Mapping[str, str] = MappingProxyType({})
_UNKNOWN = "–"
_FEW_MAPS = 6  # regime maps of one picture


def write_comparison_report(path: Path, comparison: Comparison) -> None:
    """Write the page of a comparison: summary, failing channel, the nine views."""
    _write(path, comparison, comparison_sections, "Model against measurement", _that_it_has(comparison.effects))


def write_diagnosis_report(path: Path, diagnosis: Diagnosis) -> None:
    """Write the page of a diagnosis: checks, verdict, probabilities, fit, sizes, sealed rows, what was tried."""
    made = {"seed": str(diagnosis.seed), "time": f"{diagnosis.wall_s:.0f} s"}
    tried = f"; {len(diagnosis.ranking)} effects tried" if diagnosis.ranking else ""
    _write(path, diagnosis, diagnosis_sections, "What is missing", _that_it_has(diagnosis.effects) + tried, made)


def _that_it_has(effects: Sequence[str]) -> str:
    return f" with {listed(map(plain, effects))}" if effects else ""


def write_ledger_report(path: Path, ledger: Ledger) -> None:
    """Write the page of a ledger: the falling error, every step and why, the final model, where it was learned."""
    _write(path, ledger, ledger_sections, "The falling error", ", effect after effect")


def _write(path: Path, found, sections_of, heading: str, about: str, made: Mapping[str, str] = _NOTHING_MORE) -> None:
    """A page. about: what follows the name of the model;  made: provenance beside the hashes of the files"""
    write_report(
        path,
        sections_of(found),
        title=f"{heading}: {found.campaign}",
        subtitle=f"Model {found.model}{about}",
        provenance={**made, **found.provenance},
    )


# ---- comparison -----------------------------------------------------------------------------------------------------


def comparison_sections(c: Comparison) -> tuple[Section, ...]:
    """Sections of the page in reading order; a section is left out where there is nothing to show."""
    read = readings(c)
    alarming = any(reading.alarming for reading in read)
    says = comparison_sentence(c)
    summary = Section("What was found", (Remark(says) if alarming else says, _numbers(c), _overview(read)))
    failing = next((fit for fit in c.fits if fit.channel == c.failing), None)
    first = () if failing is None else (_failing(failing, c),)
    views = tuple(_view(r, pictures) for r, pictures in zip(read, _pictures(c)) if r.alarming is not None)
    return (summary, *first, *views, *_predicted(c.predictions), *_limits(c.checks, c.complaints))


def _numbers(c: Comparison) -> KeyNumbers:
    off = len(channels_off(c))
    numbers = [
        KeyNumber("chi²/n, tolerances fitted", chi2_text(c.chi2_per_n), remark="pure noise gives 1"),
        *_known("on sealed rows", c.held_out_chi2_per_n),
        KeyNumber("channels off", f"{off} of {len(c.scoreboard)}"),
    ]
    if c.pulls:
        worst = max(c.pulls, key=lambda pull: abs(pull.pull))
        numbers.append(KeyNumber("largest pull", signed(worst.pull), "sigma", plain(worst.name)))
    return KeyNumbers(tuple(numbers))


def _known(name: str, value: float | None) -> tuple[KeyNumber, ...]:
    return () if value is None else (KeyNumber(name, chi2_text(value), remark="pure noise gives 1"),)


def _overview(read: tuple[Reading, ...]) -> Table:
    rows = [{"view": r.title, "": r.flag, "what it says": r.sentence} for r in read]
    marked = tuple(number for number, r in enumerate(read) if r.alarming)
    return Table(pd.DataFrame(rows), "The nine views; those that alarm are marked.", marked=marked)


def _failing(fit: ChannelFit, c: Comparison) -> Section:
    caption = (
        f"{fit.channel}: readings and model above, residual in standard uncertainties u below; 95 of 100 residuals of "
        "pure noise lie in the grey band."
    )
    off = fit.channel in [s.channel for s in channels_off(c)]
    title = "Where it fails" if off else "Where to look first"
    return Section(f"{title}: {fit.channel}", (Picture(channels.channel_fit(fit), caption),))


def _pictures(c: Comparison):
    """Pictures and tables of each view in the order of ``readings``."""
    yield (_scoreboard(c), _picture(channels.scoreboard, c.scoreboard, "chi²/n of every channel."))
    yield (_picture(structure.pulls, c.pulls, "Shift of each declared uncertainty; red beyond three sigma."),)
    yield tuple(
        _picture(
            operating_range.regime_maps, c.regimes[k : k + _FEW_MAPS],
            "Mean residual of each cell in u; framed cells, red bars, are not chance (p < 0.01 for a map).",
        )
        for k in range(0, max(len(c.regimes), 1), _FEW_MAPS)
    )  # fmt: skip
    yield (_picture(structure.order_spectra, c.orders, "Amplitude of each order; the line is what noise stays below."),)
    yield (_picture(structure.scalings, c.scalings, "Exponents with 90 % intervals; grey ones allow several laws."),)
    yield (_picture(structure.parities, c.parities, "Odd and even parts; the black mark is noise alone."),)
    yield (_picture(structure.sequences, c.sequences, "Residual as it was measured; shades change with the scan."),)
    yield (_picture(structure.whiteness, c.whiteness, "Autocorrelation with its 99 % band; dependence on conditions."),)
    yield (_picture(structure.signatures, c.signatures, "Nearest effects by shape alone, whatever their size."),)


def _picture(draw, found, caption: str):
    """The picture and its caption, or nothing where nothing was found."""
    return Picture(draw(found), caption) if found else None


def _view(reading: Reading, content) -> Section:
    says = Remark(reading.sentence) if reading.alarming else reading.sentence
    return Section(reading.title, (reading.shows, says, *(part for part in content if part)))


def _scoreboard(c: Comparison) -> Table:
    rows = [
        {
            "channel": s.channel,
            "n": s.n,
            "rms error": amount(s.rms_error, s.unit),
            "of signal": f"{amount(s.rms_error_percent)} %",
            "noise": amount(s.noise_floor, s.unit),
            "u_val": amount(s.u_val, s.unit),
            "bias": amount(s.bias, s.unit),
            "chi²/n": chi2_text(s.chi2_per_n),
            "sealed": chi2_text(s.held_out_chi2_per_n),
            "of excess": percent(s.excess_share),
        }
        for s in c.scoreboard
    ]
    off = channels_off(c)
    marked = tuple(number for number, s in enumerate(c.scoreboard) if s in off)
    sealed = any(s.held_out_chi2_per_n is not None for s in c.scoreboard)
    caption = "Error of each channel after the tolerances were fitted; marked: more than noise."
    says = " Sealed: chi²/n of rows that no fit has seen." if sealed else ""
    return _table(rows, caption + says, marked)


def _table(rows: list[dict[str, object]], caption: str, marked: tuple[int, ...] = ()) -> Table:
    """Without the columns in which nothing is known."""
    frame = pd.DataFrame(rows)
    return Table(frame.loc[:, (frame != _UNKNOWN).any()], caption, marked=marked)


def _predicted(predictions: tuple[Prediction, ...]) -> tuple[Section, ...]:
    """What this campaign predicts for devices that are not measured yet; no section where it predicts nothing."""
    if not predictions:
        return ()
    rows = [
        {"of": p.of, "quantity": f"{p.quantity} / {p.unit}" if p.unit else p.quantity, "value": number(p.value, 4),
         "interval": f"{number(p.low, 4)} to {number(p.high, 4)}", "given": p.given}
        for p in predictions
    ]  # fmt: skip
    words = "These were stored before they were held against any measurement."
    table = Table(pd.DataFrame(rows), "Predictions of this campaign.")
    return (Section("Predicted, not yet compared", (words, table)),)


def _limits(checks: tuple[str, ...], complaints: tuple[str, ...]) -> tuple[Section, ...]:
    """What was noticed on the instruments and what limits the conclusions; no section where there is nothing."""
    found = [Remark(sentence(check)) for check in checks] + [sentence(complaint) for complaint in complaints]
    return (Section("What limits the conclusions", tuple(found)),) if found else ()


# ---- diagnosis ------------------------------------------------------------------------------------------------------


def diagnosis_sections(d: Diagnosis) -> tuple[Section, ...]:
    """Sections of the page in reading order; where a convention has to be settled first, no effect is spoken of."""
    found = (*_fix(d), *_limits((), d.complaints)) if d.verdict == "convention" else _found_sections(d)
    return (*_checks(d), _verdict(d), *found)


def _checks(d: Diagnosis) -> tuple[Section, ...]:
    said = tuple(Remark(sentence(check)) for check in d.checks)
    return (Section("What the data say before any model", said),) if said else ()


def _verdict(d: Diagnosis) -> Section:
    says = verdict_sentence(d)
    first = says if d.verdict == "nothing_missing" else Remark(says)
    if d.verdict == "convention":
        return Section("Verdict", (first, meaning(d)))
    sealed = () if d.sealed is None or d.sealed.holds else (Remark(sealed_sentence(d)),)
    bounds_met = tuple(map(Remark, (*bound_sentences(d), *d.contradictions)))
    return Section("Verdict", (first, meaning(d), *bounds_met, *sealed, *_verdict_numbers(d), power_sentence(d)))


def _fix(d: Diagnosis) -> tuple[Section, ...]:
    hint = "airgap diagnose FOLDER --accept-conventions goes on with it without a change of the file."
    said = "Put this into campaign.toml if it is right:"
    return (Section("What to put into campaign.toml", (said, Code(d.fix), hint)),) if d.fix else ()


def _found_sections(d: Diagnosis) -> tuple[Section, ...]:
    return (
        Section("How likely each explanation is", _probabilities(d)),
        *_concluded(d),
        *_before_and_after(d),
        *_sizes(d),
        *_signature(d),
        Section("Rows that no fit has seen", (sealed_sentence(d),)),
        *_ranking(d),
        *_can_be_seen(d),
        *_next(d),
        *_limits((), d.complaints + d.not_tried),
    )


def _verdict_numbers(d: Diagnosis) -> tuple[KeyNumbers, ...]:
    best = leading(d)
    if best is None or d.verdict in ("nothing_missing", "cannot_tell"):
        return ()
    sizes = [KeyNumber(plain(name), estimated(e), remark=f"90 %: {bounds(e)}") for name, e in best.parameters.items()]
    fitted = KeyNumber(
        "chi²/n, fitted rows",
        _fall(best.chi2_per_n_before, best.chi2_per_n_after),
        remark=f"by the best with {plain(best.name)}",
    )
    left_out = KeyNumber(
        "chi²/n, left out",
        _fall(best.held_out_chi2_per_n_before, best.held_out_chi2_per_n_after),
        remark="pure noise gives 1",
    )
    tested = best.held_out_chi2_per_n_before is not None
    return (KeyNumbers((*sizes * (len(d.names) == 1), fitted, *(left_out,) * tested)),)


def _fall(before: float | None, after: float | None) -> str:
    if before is None and after is None:
        return _UNKNOWN
    return f"{chi2_text(before)}\N{NO-BREAK SPACE}→\N{NO-BREAK SPACE}{chi2_text(after)}"


def _probabilities(d: Diagnosis) -> tuple[str | Picture | Table, ...]:
    caption = (
        "Of an effect: that it is there, alone or with others, so that effects do not add up to 100 %. Nothing "
        "missing: no effect and nothing unknown. Something unknown: a smooth function that no effect describes, with "
        "or without effects. None of these: the same without effects. Blue: what the verdict names."
    ) + _beside_the_unknown(d)
    return (Picture(beliefs.probabilities(d), caption), *_sets(d))


def _beside_the_unknown(d: Diagnosis) -> str:
    if d.p_something_remains < LIKELY:
        return ""
    return (
        " As something unknown is likely there, an effect that helps beside it may only be what its shape lacks of "
        "the true law, unless it explains a hundred times as much. The probabilities count that, by how often an "
        "effect is met and how many are needed beside it."
    )


def _sets(d: Diagnosis) -> tuple[str | Table, ...]:
    if not d.p_sets:
        return ()
    rows = [{"explanation": set_words(words), "probability": probability_text(p)} for words, p in d.p_sets.items()]
    said = (
        "Below, the probability of an explanation is that all of it is there and nothing else: explanations exclude "
        f"one another. These have {probability_text(sum(d.p_sets.values()))} together, less likely ones the rest."
    )
    return (said, Table(pd.DataFrame(rows), "The likeliest explanations."))


def _before_and_after(d: Diagnosis) -> tuple[Section, ...]:
    if d.before is None or d.after is None:
        return ()
    if np.array_equal(d.before.fitted, d.after.fitted):
        picture = Picture(channels.channel_fit(d.before), f"{d.before.channel}, tolerances fitted.")
        return (Section("The fit", (picture,)),)
    name = listed(map(plain, d.names[:1] if d.verdict == "group" else d.names)) or "the best of the library"
    caption = f"{d.before.channel} without and with {name}; tolerances fitted both times, the same axes on both sides."
    return (
        Section("The fit before and after", (Picture(channels.before_and_after(d.before, d.after, name), caption),)),
    )


def _sizes(d: Diagnosis) -> tuple[Section, ...]:
    """Of what is named, as in the most probable explanation that holds it."""
    rows = [
        {
            "effect": plain(r.name), "parameter": plain(name), "value": estimated(e),
            "90 % interval": bounds(e), "remark": _remark(r, name) or _UNKNOWN,
        }
        for r in d.ranking if r.name in d.names
        for name, e in r.parameters.items()
    ]  # fmt: skip
    if not rows:
        return ()
    table = _table(rows, "Of each named effect, in the most probable explanation that holds it.")
    caption = "Probability density of the parameter of an effect by itself, before and after the measurement."
    pictures = (Picture(beliefs.size_posteriors(d.posteriors), caption),) if d.posteriors else ()
    return (Section("How large it is", (table, *pictures)),)


def _remark(ranked: Ranked, name: str) -> str:
    """What a reader must know of a fitted parameter besides its size."""
    return "on a bound" if name in ranked.at_bound else "as believed before" if name in ranked.as_believed else ""


def _signature(d: Diagnosis) -> tuple[Section, ...]:
    """What the unexplained residual looks like, where no effect explains it."""
    if d.verdict not in ("none_of_these", "partial", "cannot_tell") or not d.residual_signature:
        return ()
    rows = [{"property": plain(name), "found": _found(value)} for name, value in d.residual_signature.items()]
    table = Table(pd.DataFrame(rows), "Where to look, and what an effect of your own must do; ranges are low to high.")
    hint = "airgap new-effect FILE.py writes a skeleton of an effect with this signature."
    return (Section("What the residual looks like", (table, hint)),)


def _found(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{plain(str(key))} {_found(item)}" for key, item in value.items()) or _UNKNOWN
    if isinstance(value, (list, tuple)):
        ranges = 2 <= len(value) <= 3 and all(isinstance(item, float) for item in value)
        return (" … " if ranges else ", ").join(map(_found, value)) or _UNKNOWN
    return amount(value) if isinstance(value, (int, float)) else plain(str(value or _UNKNOWN))


def _ranking(d: Diagnosis) -> tuple[Section, ...]:
    ordered = sorted(d.ranking, key=lambda r: (-r.probability, -r.log_evidence))
    rows = [
        {
            "effect": r.name,
            "probability": probability_text(r.probability),
            "best with it": odds_text(r.log_evidence),
            "size (90 % interval)": _sizes_of(r),
            "chi²/n": _fall(r.chi2_per_n_before, r.chi2_per_n_after) if r.parameters else _UNKNOWN,
            "left out": _fall(r.held_out_chi2_per_n_before, r.held_out_chi2_per_n_after) if r.parameters else _UNKNOWN,
        }
        for r in ordered
    ]
    marked = tuple(number for number, r in enumerate(ordered) if r.name in d.names)
    caption = (
        "Probability: that the effect is there, alone or with others. Best with it: how much more probable the fitted "
        "rows are by the best explanation that holds the effect, and others where they help, than by nothing; size "
        "and chi²/n (nothing → explanation) are of that explanation. Effects without a fitted size are far behind and "
        "were judged by their signature, most of them alone."
    )
    table = _table(rows, caption, marked) if rows else None
    return (Section("What was tried", (left_out_sentence(d), table)),) if table is not None else ()


def _sizes_of(ranked: Ranked) -> str:
    sizes = (
        f"{plain(n)} {interval(e)} {_remark(ranked, n)}".rstrip().replace("90 % interval ", "")
        for n, e in ranked.parameters.items()
    )
    return "; ".join(sizes) or _UNKNOWN


def _can_be_seen(d: Diagnosis) -> tuple[Section, ...]:
    if not d.detection_limits:
        return ()
    rows = [
        {"effect": plain(x.name), "parameter": plain(x.parameter), "smallest seen": amount(x.value, x.unit)}
        for x in d.detection_limits
    ]
    said = (
        "The smallest size of each effect that nine of ten such measurements would have shown; an effect that is not "
        "listed never shows."
    )
    return (Section("What these data can show", (said, Table(pd.DataFrame(rows), "Detection limits."))),)


def _concluded(d: Diagnosis) -> tuple[Section, ...]:
    said = conclusions(d)
    return (Section("What can and cannot be concluded", said),) if said else ()


def _next(d: Diagnosis) -> tuple[Section, ...]:
    said = (*_best_measurement(d), *open_questions(d))
    return (Section("What to measure next", said),) if said else ()


def _best_measurement(d: Diagnosis) -> tuple[str | Picture, ...]:
    if not d.next_measurements:
        return ()
    best = max(d.next_measurements, key=lambda m: m.gain_nats / m.cost)
    if best.gain_nats < NO_GAIN:
        return ("No measurement that was weighed is expected to change the odds by 10 %.",)
    gain = f"expected to change the odds by {factor_text(best.gain_nats)} at cost {amount(best.cost)}"
    said = f"Best: {best.words or plain(best.kind)}, {gain}."
    caption = "Expected factor in the odds of the right explanation against the others, averaged over their logarithm."
    return (said, Picture(beliefs.next_measurements(d.next_measurements), caption))


# ---- ledger ---------------------------------------------------------------------------------------------------------


def ledger_sections(ledger: Ledger) -> tuple[Section, ...]:
    """Sections of the page in reading order."""
    caption = (
        "Error after each step on the rows that were fitted and on conditions that were left out of the fit, region by "
        "region. A step against which the data speak, or which raises the error of what is left out, is refused "
        "(hatched) and the model stays as it was."
    )
    return (
        Section("Where the walk stands", (ledger_sentence(ledger),)),
        Section("The falling error", (Picture(waterfall(ledger), caption),)),
        Section("Every step", (_steps(ledger), *_reasons(ledger))),
        *_final(ledger),
        Section("Error of each channel", (_errors(ledger),)),
        *_learned(ledger),
    )


def _steps(ledger: Ledger) -> Table:
    rows = [
        {
            "step": s.step,
            "effect": plain(s.effect) or _UNKNOWN,
            "decision": s.decision,
            "size [90 % interval]": size_words(s) or _UNKNOWN,
            "evidence": odds_text(s.log_evidence_gain) if s.decision != "start" else _UNKNOWN,
            "chi²/n": chi2_text(s.chi2_per_n),
            "left out": chi2_text(s.held_out_chi2_per_n),
            "verdict after it": plain(s.verdict) or _UNKNOWN,
        }
        for s in ledger.steps
    ]
    marked = tuple(number for number, s in enumerate(ledger.steps) if s.decision == "refused")
    caption = (
        "Evidence: how much more probable the fitted rows are with the effect than without; the reasons below weigh it "
        "with how often such devices have the effect. Left out: chi²/n of conditions left out of the fit, region by "
        "region. Refused steps are marked and stay."
    )
    return _table(rows, caption, marked)


def _reasons(ledger: Ledger) -> tuple[str | Remark, ...]:
    """Why each step was taken or refused."""
    said = (
        (s.decision, f"Step {s.step}, {plain(s.effect)}, was {s.decision}: {_reason(s)}.")
        for s in ledger.steps
        if s.reason
    )
    return tuple(Remark(words) if decision == "refused" else words for decision, words in said)


def _reason(step: LedgerStep) -> str:
    return step.reason.rstrip(".").replace("chi2", "chi²")


def _final(ledger: Ledger) -> tuple[Section, ...]:
    if not ledger.parameters:
        return ()
    rows = [
        {"of": plain(p.owner), "parameter": plain(p.name), "value": estimated(p.estimate),
         "90 % interval": bounds(p.estimate)}
        for p in ledger.parameters
    ]  # fmt: skip
    caption = (
        "After the last fit of all together, intervals by its curvature. Of an input: shift from the drawing; of an "
        "instrument: its error."
    )
    return (Section("The final parameters", (Table(pd.DataFrame(rows), caption),)),)


def _errors(ledger: Ledger) -> Table:
    last = ledger.steps[-1]
    rows = []
    for channel, unit in last.units.items():
        row = {"channel": channel, "noise": amount(last.noise_floor.get(channel), unit)}
        rows.append(row | {_column(s): amount(s.rms_error.get(channel), unit) for s in ledger.steps})
    return Table(pd.DataFrame(rows), "Rms error of each channel after each step, and what noise alone leaves.")


def _column(step: LedgerStep) -> str:
    if step.decision == "start":
        return "start"
    return f"{step.step} {plain(step.effect)}{' (refused)' * (step.decision == 'refused')}"


def _learned(ledger: Ledger) -> tuple[Section, ...]:
    """The conditions that the model was fitted at, and that it was not tested elsewhere."""
    if not ledger.ranges:
        return ()
    rows = [
        {"kind and response": r.channel, "rows": r.rows, "chi²/n": chi2_text(r.chi2_per_n), "conditions": _spans(r)}
        for r in ledger.ranges
    ]
    table = Table(pd.DataFrame(rows), "Range of the conditions of the rows that were fitted.")
    beyond = (
        "Beyond these conditions the model was not tested, except on the rows that no fit has seen, of which the "
        "diagnosis says where they lie. airgap validate MODEL DATA applies it to other data and says where they leave "
        "this range."
    )
    return (Section("Where the model was learned", (table, Remark(beyond))),)


def _spans(r: LearnedAt) -> str:
    return "; ".join(f"{plain(name)} {_span(*span)}" for name, span in r.conditions.items()) or _UNKNOWN


def _span(low: float, high: float, unit: str) -> str:
    return amount(low, unit) if low == high else f"{number(low)} to {number(high)} {unit_text(unit)}".rstrip()
