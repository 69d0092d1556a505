"""The pages of ``compare``, ``diagnose`` and the ledger, read from top to bottom: what was found, where, the views."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import pandas as pd

from figures.report import KeyNumber, KeyNumbers, Picture, Remark, Section, Table, write_report
from workbench.findings import ChannelFit, Comparison, Diagnosis, Ledger, LedgerStep, Ranked, Separation
from workbench.report import beliefs, channels, operating_range, structure
from workbench.report.sentences import (
    TOLD_APART,
    Reading,
    channels_off,
    comparison_sentence,
    conclusions,
    leading,
    ledger_sentence,
    power_sentence,
    readings,
    size_words,
    verdict_sentence,
)  # fmt: skip
from workbench.report.waterfall import waterfall
from workbench.report.words import (
    amount,
    bounds,
    chi2_text,
    interval,
    percent,
    plain,
    probability_text,
    sentence,
    signed,
)

_NOTHING_MORE: Mapping[str, str] = MappingProxyType({})
_FEW_MAPS = 6  # regime maps of one picture
_MOST_SEPARATIONS = 12  # rows of the table


def write_comparison_report(path: Path, comparison: Comparison) -> None:
    """Write the page of a comparison: summary, failing channel, the nine views V0 to V8."""
    effects = f" with {', '.join(map(plain, comparison.effects))}" if comparison.effects else ""
    _write(path, comparison, comparison_sections, "Model against measurement", effects)


def write_diagnosis_report(path: Path, diagnosis: Diagnosis) -> None:
    """Write the page of a diagnosis: verdict, probabilities, the fit, sizes, what was tried, what to measure next."""
    made = {"seed": str(diagnosis.seed), "time": f"{diagnosis.wall_s:.0f} s"}
    tried = f"; {len(diagnosis.ranking)} effects tried"
    _write(path, diagnosis, diagnosis_sections, "What is missing", tried, made)


def write_ledger_report(path: Path, ledger: Ledger) -> None:
    """Write the page of a ledger: waterfall of the falling error, every step, errors of the channels."""
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
    views = tuple(_view(reading, pictures) for reading, pictures in zip(read, _pictures(c)))
    return (summary, *first, *views, *_limits(c.checks, c.complaints))


def _numbers(c: Comparison) -> KeyNumbers:
    off = len(channels_off(c))
    numbers = [
        KeyNumber("chi²/n, tolerances fitted", chi2_text(c.chi2_per_n), remark="pure noise gives 1"),
        KeyNumber("on held-out rows", chi2_text(c.held_out_chi2_per_n)),
        KeyNumber("channels off", f"{off} of {len(c.scoreboard)}"),
    ]
    if c.pulls:
        worst = max(c.pulls, key=lambda pull: abs(pull.pull))
        numbers.append(KeyNumber("largest pull", signed(worst.pull), "sigma", plain(worst.name)))
    return KeyNumbers(tuple(numbers))


def _overview(read: tuple[Reading, ...]) -> Table:
    rows = [{"view": f"{r.view} {r.title}", "": r.flag, "what it says": r.sentence} for r in read]
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
    """Content of each view in the order of ``readings``."""
    yield (_scoreboard(c), _picture(channels.scoreboard, c.scoreboard, "chi²/n of every channel."))
    yield (_picture(structure.pulls, c.pulls, "Shift of each declared uncertainty; red beyond three sigma."),)
    yield tuple(
        _picture(
            operating_range.regime_maps, c.regimes[k : k + _FEW_MAPS],
            "Mean residual of each cell in u; framed (or red) cells are not chance at p < 0.01.",
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
    return Section(f"{reading.view} {reading.title}", (reading.shows, says, *(part for part in content if part)))


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
            "held out": chi2_text(s.held_out_chi2_per_n),
            "of excess": percent(s.excess_share),
        }
        for s in c.scoreboard
    ]
    off = channels_off(c)
    marked = tuple(number for number, s in enumerate(c.scoreboard) if s in off)
    return Table(
        pd.DataFrame(rows),
        "Error of each channel after the tolerances were fitted; marked: more than noise.",
        marked=marked,
    )


def _limits(checks: tuple[str, ...], complaints: tuple[str, ...]) -> tuple[Section, ...]:
    """What was noticed on the instruments and what limits the conclusions; no section where there is nothing."""
    found = [Remark(check) for check in checks] + [sentence(complaint) for complaint in complaints]
    return (Section("What limits the conclusions", tuple(found)),) if found else ()


# ---- diagnosis ------------------------------------------------------------------------------------------------------


def diagnosis_sections(d: Diagnosis) -> tuple[Section, ...]:
    """Sections of the page in reading order."""
    says = verdict_sentence(d)
    calm = d.verdict == "nothing_missing"
    sections = [
        Section("Verdict", (says if calm else Remark(says), *_verdict_numbers(d), power_sentence(d))),
        Section("How likely each explanation is", (_probabilities(d),)),
        *_concluded(d),
        *_before_and_after(d),
        *_sizes(d),
        *_signature(d),
        *_separations(d),
        Section("What was tried", (_ranking(d),)),
        *_can_be_seen(d),
        *_next(d),
        *_limits((), d.complaints),
    ]
    return tuple(sections)


def _verdict_numbers(d: Diagnosis) -> tuple[KeyNumbers, ...]:
    best = leading(d)
    if best is None or d.verdict in ("nothing_missing", "cannot_tell"):
        return ()
    sizes = [
        KeyNumber(plain(name), amount(e.value, e.unit), remark=f"90 %: {bounds(e)}")
        for name, e in best.parameters.items()
    ]
    before, after = best.held_out_chi2_per_n_before, best.held_out_chi2_per_n_after
    errors = [
        KeyNumber(
            "chi²/n, fitted rows",
            _fall(best.chi2_per_n_before, best.chi2_per_n_after),
            remark=_leader_words(d),
        ),
        KeyNumber("chi²/n, held-out rows", _fall(before, after), remark="pure noise gives 1"),
    ]
    return (KeyNumbers(tuple(sizes * (d.verdict != "none_of_these") + errors)),)


def _leader_words(d: Diagnosis) -> str:
    name = plain(leading(d).name)
    return f"with {name}" if d.names else f"with {name}, the best tried"


def _fall(before: float | None, after: float | None) -> str:
    if before is None and after is None:
        return "–"
    return f"{chi2_text(before)}\N{NO-BREAK SPACE}→\N{NO-BREAK SPACE}{chi2_text(after)}"


def _probabilities(d: Diagnosis) -> Picture:
    caption = (
        "Blue: what the verdict names. Green: the model is complete. Red: something outside the library, or an effect "
        "of another form."
    )
    return Picture(beliefs.probabilities(d), caption)


def _before_and_after(d: Diagnosis) -> tuple[Section, ...]:
    if d.before is None or d.after is None:
        return ()
    name = leading(d).name
    caption = f"{d.before.channel} without and {_leader_words(d)}; tolerances fitted both times."
    picture = Picture(channels.before_and_after(d.before, d.after, name), caption)
    return (Section("The fit before and after", (picture,)),)


def _sizes(d: Diagnosis) -> tuple[Section, ...]:
    if not d.posteriors:
        return ()
    said = (f"{plain(p.effect)}: {plain(p.parameter)} {interval(p.estimate)}." for p in d.posteriors)
    picture = Picture(beliefs.size_posteriors(d.posteriors), "Probability density of each parameter before and after.")
    return (Section("How large it is", (*said, picture)),)


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
        return ", ".join(f"{plain(str(key))} {_found(item)}" for key, item in value.items()) or "–"
    if isinstance(value, (list, tuple)):
        ranges = 2 <= len(value) <= 3 and all(isinstance(item, float) for item in value)
        return (" … " if ranges else ", ").join(map(_found, value)) or "–"
    return amount(value) if isinstance(value, (int, float)) else plain(str(value or "–"))


def _separations(d: Diagnosis) -> tuple[Section, ...]:
    """The pairs that a named effect is in, the hardest to tell apart first."""
    about = set(d.names)
    closest = [s for s in _either_way(d.separations) if {s.first, s.second} & about][:_MOST_SEPARATIONS]
    if not closest:
        return ()
    rows = [
        {
            "one": plain(s.first),
            "other": plain(s.second),
            "nats": amount(s.nats),
            "told apart": "yes" if s.nats >= TOLD_APART else "no",
            "told apart by": s.separated_by or "–",
        }
        for s in closest
    ]
    marked = tuple(number for number, s in enumerate(closest) if s.nats < TOLD_APART)
    said = "Expected log-Bayes factor of one effect against another, at the fitted size; 3 nats are needed to tell."
    table = Table(pd.DataFrame(rows), "The closest pairs.", marked=marked)
    return (Section("What is told apart, and by what", (said, table)),)


def _either_way(separations: tuple[Separation, ...]) -> list[Separation]:
    """The smaller of the two directions of every pair, the closest pair first."""
    smaller: dict[frozenset, Separation] = {}
    for s in sorted(separations, key=lambda s: s.nats):
        smaller.setdefault(frozenset((s.first, s.second)), s)
    return list(smaller.values())


def _ranking(d: Diagnosis) -> Table:
    ordered = sorted(d.ranking, key=lambda r: (-r.probability, -r.log_evidence))
    rows = [
        {
            "effect": r.name,
            "probability": probability_text(r.probability),
            "ln evidence": amount(r.log_evidence),
            "size (90 % interval)": _sizes_of(r),
            "chi²/n": _fall(r.chi2_per_n_before, r.chi2_per_n_after) if r.parameters else "–",
            "held out": _fall(r.held_out_chi2_per_n_before, r.held_out_chi2_per_n_after) if r.parameters else "–",
        }
        for r in ordered
    ]
    marked = tuple(number for number, r in enumerate(ordered) if r.name in d.names)
    caption = (
        "Every effect, alone; ln evidence against the model as it is; chi²/n without → with it. Effects far behind "
        "were judged by their signature only and have no fitted size."
    )
    return Table(pd.DataFrame(rows), caption, marked=marked)


def _sizes_of(ranked: Ranked) -> str:
    return (
        "; ".join(f"{plain(n)} {interval(e)}".replace("90 % interval ", "") for n, e in ranked.parameters.items())
        or "–"
    )


def _can_be_seen(d: Diagnosis) -> tuple[Section, ...]:
    if not d.detection_limits:
        return ()
    rows = [
        {"effect": plain(x.name), "parameter": plain(x.parameter), "smallest seen": amount(x.value, x.unit)}
        for x in d.detection_limits
    ]
    said = (
        "The smallest size of each effect that these data would have shown; an effect that is not listed never shows."
    )
    return (Section("What these data can show", (said, Table(pd.DataFrame(rows), "Detection limits."))),)


def _concluded(d: Diagnosis) -> tuple[Section, ...]:
    said = conclusions(d)
    return (Section("What can and cannot be concluded", said),) if said else ()


def _next(d: Diagnosis) -> tuple[Section, ...]:
    if not d.next_measurements:
        return ()
    best = max(d.next_measurements, key=lambda m: m.gain_nats / m.cost)
    gain = f"expected to gain {amount(best.gain_nats)} nats at cost {amount(best.cost)}"
    said = f"Best: {best.words or plain(best.kind)}, {gain}."
    picture = Picture(beliefs.next_measurements(d.next_measurements), "A nat is a factor of 2.7 in the odds.")
    return (Section("What to measure next", (said, picture)),)


# ---- ledger ---------------------------------------------------------------------------------------------------------


def ledger_sections(ledger: Ledger) -> tuple[Section, ...]:
    """Sections of the page in reading order."""
    caption = (
        "Error after each step on the rows that were fitted and on those that no fit has seen. A step that does not "
        "lower the held-out error is refused (hatched) and the model stays as it was."
    )
    return (
        Section("Where the walk stands", (ledger_sentence(ledger),)),
        Section("The falling error", (Picture(waterfall(ledger), caption),)),
        Section("Every step", (_steps(ledger), *_reasons(ledger))),
        Section("Error of each channel", _channels(ledger)),
    )


def _steps(ledger: Ledger) -> Table:
    rows = [
        {
            "step": s.step,
            "effect": plain(s.effect) or "–",
            "decision": s.decision,
            "size [90 % interval]": size_words(s) or "–",
            "gain / nats": amount(s.log_evidence_gain) if s.decision != "start" else "–",
            "chi²/n": chi2_text(s.chi2_per_n),
            "held out": chi2_text(s.held_out_chi2_per_n),
            "verdict after it": plain(s.verdict) or "–",
        }
        for s in ledger.steps
    ]
    marked = tuple(number for number, s in enumerate(ledger.steps) if s.decision == "refused")
    return Table(pd.DataFrame(rows), "The ledger; refused steps are marked and stay.", marked=marked)


def _reasons(ledger: Ledger) -> tuple[Remark, ...]:
    return tuple(
        Remark(f"Step {s.step}, {plain(s.effect)}, was refused: {s.reason.rstrip('.')}.")
        for s in ledger.steps
        if s.reason and s.decision == "refused"
    )


def _channels(ledger: Ledger) -> tuple[Table, ...]:
    """Rms errors over all rows, and over those held out where there are any."""
    caption = "Rms error of each channel after each step, and what noise alone leaves."
    every = _errors(ledger, [s.rms_error for s in ledger.steps], caption)
    held_out = [s.held_out_rms_error for s in ledger.steps]
    return (every, _errors(ledger, held_out, "The same of held-out rows only.")) if any(held_out) else (every,)


def _errors(ledger: Ledger, errors: list[Mapping[str, float]], caption: str) -> Table:
    last = ledger.steps[-1]
    rows = []
    for channel, unit in last.units.items():
        row = {"channel": channel, "noise": amount(last.noise_floor.get(channel), unit)}
        rows.append(row | {_column(s): amount(e.get(channel), unit) for s, e in zip(ledger.steps, errors)})
    return Table(pd.DataFrame(rows), caption)


def _column(step: LedgerStep) -> str:
    if step.decision == "start":
        return "start"
    return f"{step.step} {plain(step.effect)}{' (refused)' * (step.decision == 'refused')}"
