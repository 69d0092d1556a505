"""The commands of the workbench: compare, diagnose, add, ledger, validate, effects, new-effect, import."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import cleandoc
from pathlib import Path

from tqdm import tqdm

from disk import write_atomically
from effects.base import Effect
from effects.library import Library
from effects.parameter import parameters_of
from pipeline.own_effects import add_own_effects, exit_on_wrong_campaign, own_library
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.data.conventions import accepted
from workbench.data.draft import write_draft
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.conventions import settle
from workbench.explain.diagnosis import SEED, diagnose
from workbench.explain.verdict import CONVENTION
from workbench.findings import Comparison, Diagnosis, Ledger, LedgerStep, Ranked, Validation
from workbench.ledger.model_file import NAME, read_model, with_effects
from workbench.ledger.skeleton import write_new
from workbench.ledger.validate import validate
from workbench.ledger.walk import add_effect, skeleton_for, walk
from workbench.models.bases import nominal_model, redesigned
from workbench.models.model import Model
from workbench.report import (
    write_comparison_report,
    write_diagnosis_report,
    write_ledger_report,
    write_validation_report,
)
from workbench.report.as_json import comparison_json, diagnosis_json, validation_json
from workbench.report.sentences import (
    NO_GAIN,
    bound_sentences,
    conclusions,
    left_out_sentence,
    meaning,
    open_questions,
    readings,
    sealed_sentence,
    verdict_sentence,
)
from workbench.report.validation import validation_sentence, warnings
from workbench.report.words import factor_text, odds_text

Run = Callable[[argparse.Namespace], None]  # a command


def add_compare(parser: argparse.ArgumentParser) -> None:
    """Where does the model fail against a campaign?"""
    _bench(parser, _compare)


def add_diagnose(parser: argparse.ArgumentParser) -> None:
    """Which effect is missing, how sure, what to measure next?"""
    _diagnose_parser(parser, _diagnose)


def add_add(parser: argparse.ArgumentParser) -> None:
    """Add an effect to the model: accepted only if the data speak for it and prediction does not get worse."""
    parser.add_argument("effect", help="name of an effect, see `airgap effects`")
    _diagnose_parser(parser, _add)


def add_ledger(parser: argparse.ArgumentParser) -> None:
    """Diagnose and add until nothing more is named."""
    _diagnose_parser(parser, _ledger)


def add_validate(parser: argparse.ArgumentParser) -> None:
    """Apply a model file to data that it was not learned from."""
    parser.add_argument("model", help="model.toml that `airgap ledger` or `airgap add` wrote")
    parser.add_argument("data", help="folder of a campaign of the same device; its [device] may be left out")
    parser.add_argument("--out", metavar="DIR", help="where results go; default results/<id of the data>/")
    add_own_effects(parser)
    parser.set_defaults(run=_validate)


def add_effects(parser: argparse.ArgumentParser) -> None:
    """What the library knows; a name shows its equation."""
    parser.add_argument("name", nargs="?")
    add_own_effects(parser)
    parser.set_defaults(run=_effects)


def add_new_effect(parser: argparse.ArgumentParser) -> None:
    """A skeleton of one's own effect."""
    parser.add_argument("file", help="Python file to write, my_effect.py")
    _bench(parser, _new_effect, positional=False)


def add_import(parser: argparse.ArgumentParser) -> None:
    """A ``campaign.toml`` for plain data files."""
    parser.add_argument("files", nargs="+", metavar="FILE", help="CSV, text or Parquet files of one folder; only read")
    parser.add_argument("--like", metavar="DIR", help="campaign of the same device: takes its device and instruments")
    parser.add_argument("--decimal", choices=(",", "."), help="sign of the files, where their numbers do not show it")
    parser.set_defaults(run=_import)


def _bench(parser: argparse.ArgumentParser, run: Run, positional: bool = True) -> None:
    if positional:
        parser.add_argument("campaign", help="folder with campaign.toml and its tables")
    else:
        parser.add_argument("campaign", nargs="?", help="folder of a campaign whose residual gives the first guess")
    parser.add_argument("--out", metavar="DIR", help="where results go; default results/<campaign id>/")
    parser.add_argument("--model", metavar="FILE", help="model file; default model.toml in the results, if it is there")
    add_own_effects(parser)
    parser.set_defaults(run=run)


def _diagnose_parser(parser: argparse.ArgumentParser, run: Run) -> None:
    _bench(parser, run)
    parser.add_argument("--seed", type=int, help="of the simulated campaigns")
    parser.add_argument(
        "--accept-conventions",
        action="store_true",
        help="go on with what the columns of the files look like, where campaign.toml does not say it",
    )


def _set_up(options: argparse.Namespace) -> tuple[Campaign, Library, Model, Path]:
    """Campaign, library, model with its effects, and the folder of the results."""
    campaign, effects = read_campaign(options.campaign), own_library(options)
    out = _results_of(options, campaign)
    model, saved = nominal_model(campaign), Path(options.model) if options.model else out / NAME
    if options.model or saved.exists():
        learned = read_model(saved, effects)
        model = with_effects(learned, model, saved)
        if model.effects and not options.model:
            names = ", ".join(model.names)
            print(f"{saved}: the model starts with what was learned before, {names}; without the file it is as drawn")
        if learned.source is not None and learned.source.campaign != campaign.id:
            print(f"{saved}: {_from_elsewhere(learned.source.campaign, campaign.id)}", file=sys.stderr)
    return campaign, effects, model, out


def _results_of(options: argparse.Namespace, campaign: Campaign) -> Path:
    """The folder of the results."""
    out = Path(options.out) if options.out else Path("results") / campaign.id
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise WorkbenchError(f"{out}: cannot be a folder of results ({error.strerror}); name another, --out.") from None
    return out


def _from_elsewhere(source: str, here: str) -> str:
    return (
        f"learned from {source}; its effects are the start, the inputs are fitted to {here} anew. "
        "`airgap validate` applies it as it is."
    )


def _settled(options: argparse.Namespace, campaign: Campaign, model: Model) -> tuple[Campaign, Model]:
    """The campaign with the conventions that were found in it, where the user accepts them, and the model of its
    device."""
    if not options.accept_conventions:
        return campaign, model
    with _progress() as progress:
        conventions = settle(model, campaign, progress)
    if not conventions.are_right:
        print("accepted:", *conventions.sentences, "", conventions.fix, sep="\n")
    return conventions.campaign, redesigned(model, campaign, conventions.campaign)


def _compare(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        with _progress() as progress:
            comparison = compare(model, campaign, effects, progress)
        _write_comparison(out, comparison)
        _print_comparison(comparison, out)
        if comparison.failing:
            _print_conventions(campaign, model)


def _print_conventions(campaign: Campaign, model: Model) -> None:
    """What the columns of the files look like, where campaign.toml does not say it: an error of a factor of a thousand
    is seen before any effect."""
    with _progress() as progress:
        conventions = settle(model, campaign, progress)
    if not conventions.are_right:
        print("", *(f"! {words}" for words in conventions.sentences), "", conventions.fix, sep="\n")


def _diagnose(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        campaign, model = _settled(options, campaign, model)
        diagnosis = _diagnosed(options, model, campaign, effects)
        if options.accept_conventions and diagnosis.verdict == CONVENTION:  # it showed beside an effect only
            print("accepted:", diagnosis.conventions[0], "", diagnosis.fix, sep="\n")
            diagnosis = _diagnosed(options, model, accepted(campaign, diagnosis.fix), effects)
        _write_diagnosis(out, diagnosis)
        _print_diagnosis(diagnosis, out)


def _diagnosed(options: argparse.Namespace, model: Model, campaign: Campaign, effects: Library) -> Diagnosis:
    with _progress() as progress:
        return diagnose(model, campaign, effects, SEED if options.seed is None else options.seed, progress)


def _add(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        campaign, model = _settled(options, campaign, model)
        with _progress() as progress:
            added = add_effect(model, campaign, effects, options.effect, out, options.seed, progress)
        _write_comparison(out, added.comparison)
        _write_diagnosis(out, added.diagnosis)
        _write_ledger(out, added.ledger)
        _print_step(added.step)
        _print_comparison(added.comparison, out)


def _ledger(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        campaign, model = _settled(options, campaign, model)
        with _progress() as progress:
            ledger, diagnosis = walk(model, campaign, effects, out, options.seed, progress)
        _write_diagnosis(out, diagnosis)
        if ledger.steps:
            _write_ledger(out, ledger)
            _print_ledger(ledger)
        _print_diagnosis(diagnosis, out)


def _validate(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        effects = own_library(options)
        learned, campaign = read_model(options.model, effects), read_campaign(options.data)
        with _progress() as progress:
            validation = validate(learned, campaign, effects, progress)
        out = _results_of(options, campaign)
        _write_text(out / "validation.json", validation_json(validation))
        write_atomically(out / "validation.html", lambda part: write_validation_report(part, validation))
        _print_validation(validation, out)


def _effects(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        found = own_library(options)
        if options.name is None:
            width = max(len(name) for name in found)
            for name, cls in found.items():
                print(f"{name:{width}}  {cls.title}: {_equation(cls)}")
            return
        if options.name not in found:
            raise WorkbenchError(f"there is no effect {options.name!r}; `airgap effects` lists all.")
        _print_effect(found[options.name])


def _equation(cls: type[Effect]) -> str:
    """The first sentence of the docstring that holds an equation, else its first one."""
    blocks = [" ".join(block.split()) for block in re.split(r"(?<!:)\n\n", cleandoc(cls.__doc__ or ""))]
    said = [sentence for block in blocks for sentence in re.split(r"(?<!eq\.)(?<=[.;])\s+(?=[A-Z])", block)]
    return next((sentence for sentence in said if " = " in sentence or " -> " in sentence), said[0])


def _print_effect(cls: type[Effect]) -> None:
    print(f"{cls.name()}: {cls.title}\n\n{cleandoc(cls.__doc__ or '')}\n\n{cls.looks_like}")
    for name, p in parameters_of(cls).items():
        print(f"  {name} [{p.unit}]: null {p.null:g}, from {p.low:g} to {p.high:g}; prior {p.prior}; {p.source}")
    for line in cls.remedy:
        print(f"  shown by: {line}")


def _new_effect(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        path = Path(options.file)
        if options.campaign is None:
            text = skeleton_for(path, None, None, None)
        else:
            campaign, effects, model, _ = _set_up(options)
            text = skeleton_for(path, campaign, effects, model)
        write_new(path, text)
        print(f"wrote {path}; use it with --effects-from {path}")


def _import(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        like = None if options.like is None else Path(options.like)
        target, lines = write_draft([Path(file) for file in options.files], like, options.decimal)
        todo = f'fill in the "?" of line {", ".join(map(str, lines))}' if lines else "read it once"
        print(f"wrote {target}: {todo}, then airgap compare {target.parent}")


@contextmanager
def _progress() -> Iterator[Callable[[str], None]]:
    """A bar on a terminal, nothing elsewhere."""
    with tqdm(bar_format="{desc} {elapsed}", leave=False, disable=not sys.stderr.isatty()) as bar:
        yield bar.set_description_str


def _write_comparison(out: Path, comparison: Comparison) -> None:
    _write_text(out / "comparison.json", comparison_json(comparison))
    write_atomically(out / "comparison.html", lambda part: write_comparison_report(part, comparison))


def _write_diagnosis(out: Path, diagnosis: Diagnosis) -> None:
    _write_text(out / "diagnosis.json", diagnosis_json(diagnosis))
    write_atomically(out / "diagnosis.html", lambda part: write_diagnosis_report(part, diagnosis))


def _write_ledger(out: Path, ledger: Ledger) -> None:
    write_atomically(out / "ledger.html", lambda part: write_ledger_report(part, ledger))


def _write_text(path: Path, text: str) -> None:
    write_atomically(path, lambda part: part.write_text(text, encoding="utf-8"))


def _print_comparison(c: Comparison, out: Path) -> None:
    print(f"\n{'channel':28} {'unit':>9} {'n':>8} {'rms error':>10} {'%':>6} {'noise':>9} {'chi2/n':>8} {'sealed':>8}")
    for s in c.scoreboard:
        sealed = "-" if s.held_out_chi2_per_n is None else f"{s.held_out_chi2_per_n:.2f}"
        print(
            f"{s.channel:28} {s.unit:>9} {s.n:8d} {s.rms_error:10.4g} {s.rms_error_percent:6.2f} {s.noise_floor:9.3g} "
            f"{s.chi2_per_n:8.2f} {sealed:>8}"
        )
    for reading in readings(c):
        print(f"{'!' if reading.alarming else ' '} {reading.title}: {reading.sentence}")
    for words in c.checks + c.complaints:
        print(f"! {words}")
    print(f"results in {out}")


def _print_diagnosis(d: Diagnosis, out: Path) -> None:
    print("", *(f"! {words}" for words in d.checks + d.complaints), sep="\n")
    if d.verdict != "convention":
        _print_found(d)
    print(verdict_sentence(d), meaning(d), *bound_sentences(d), *d.contradictions, *conclusions(d), sep="\n")
    if d.fix:
        print("", d.fix, "", sep="\n")
    print(f"results in {out}")


def _print_found(d: Diagnosis) -> None:
    """What was tried, the other probabilities, the sealed rows and what to measure next."""
    print(f"{'effect':28} {'is there':>8} {'best with it':>12} {'left out':>16}  size [90 % interval]")
    for r in d.ranking[:8]:
        sizes = ", ".join(
            f"{n} {e.value:.4g} [{e.low90:.4g}, {e.high90:.4g}]{f' {e.unit}' * (e.unit != '1')}"
            f"{' on a bound' * (n in r.at_bound)}"
            for n, e in r.parameters.items()
        )
        print(f"{r.name:28} {r.probability:8.3f} {odds_text(r.log_evidence):>12} {_left_out(r):>16}  {sizes}")
    print(
        f"nothing missing {d.p_nothing_missing:.3f}, something unknown {d.p_something_remains:.3f}, "
        f"none of these (unknown, no effect) {d.p_none_of_these:.3f}"
    )
    print("Is there: probability, alone or with others. Best with it: evidence of the best explanation that holds it.")
    print(left_out_sentence(d), f"Rows that no fit has seen: {sealed_sentence(d)}", sep="\n")
    for option in (m for m in d.next_measurements[:3] if m.gain_nats >= NO_GAIN):
        print(f"next: {option.words} (expected {factor_text(option.gain_nats)} in the odds)")
    print(*open_questions(d), "", sep="\n")


def _left_out(r: Ranked) -> str:
    before, after = r.held_out_chi2_per_n_before, r.held_out_chi2_per_n_after
    return "-" if before is None or after is None or not r.parameters else f"{before:.2f} -> {after:.2f}"


def _print_ledger(ledger: Ledger) -> None:
    print(f"\n{'step':>4} {'effect':28} {'decision':9} {'evidence':>12} {'chi2/n':>9} {'left out':>9}  then")
    for s in ledger.steps:
        left_out = "-" if s.held_out_chi2_per_n is None else f"{s.held_out_chi2_per_n:.3f}"
        evidence = "-" if s.decision == "start" else odds_text(s.log_evidence_gain)
        print(
            f"{s.step:4d} {s.effect or '-':28} {s.decision:9} {evidence:>12} {s.chi2_per_n:9.3f} {left_out:>9}"
            f"  {s.verdict}"
        )
    for s in ledger.steps:
        if s.reason:
            print(f"step {s.step}, {s.effect}, was {s.decision}: {s.reason}")


def _print_validation(v: Validation, out: Path) -> None:
    print(
        f"\n{'':10} {'channel':28} {'unit':>9} {'n':>6} {'rms error':>10} {'bias':>10} {'chi2/n':>8} {'in 90 %':>8}",
        end="",
    )
    print(f" {'outside':>8} {'error there':>11}")
    for words, channels in (("corrected", v.corrected), ("as drawn", v.base)):
        for c in channels:
            there = "-" if c.outside_rms_error is None else f"{c.outside_rms_error:.4g}"
            print(
                f"{words:10} {c.channel:28} {c.unit:>9} {c.n:6d} {c.rms_error:10.4g} {c.bias:10.3g} "
                f"{c.chi2_per_n:8.2f} {c.share_in_90:8.0%} {c.outside_range:8.0%} {there:>11}"
            )
    for words in v.complaints + v.range_left:
        print(f"! {words}")
    print(validation_sentence(v), *warnings(v), f"results in {out}", sep="\n")


def _print_step(step: LedgerStep) -> None:
    print(f"{step.effect}: {step.decision}; {step.reason}")
