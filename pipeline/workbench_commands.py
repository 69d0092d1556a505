"""The commands of the workbench: compare, diagnose, add, ledger, effects, new-effect, import."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import cleandoc
from pathlib import Path

from tqdm import tqdm

from effects.base import Effect
from effects.library import Library, effects_of_file, library
from effects.parameter import parameters_of
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.data.draft import write_draft
from workbench.data.table import Campaign
from workbench.errors import WorkbenchError
from workbench.explain.conventions import settle
from workbench.explain.diagnosis import SEED, diagnose
from workbench.findings import Comparison, Diagnosis, Ledger, LedgerStep
from workbench.ledger.model_file import NAME, with_effects_of
from workbench.ledger.skeleton import write_new
from workbench.ledger.walk import add_effect, skeleton_for, walk
from workbench.models.bases import nominal_model
from workbench.models.model import Model
from workbench.report import write_comparison_report, write_diagnosis_report, write_ledger_report
from workbench.report.as_json import comparison_json, diagnosis_json
from workbench.report.sentences import conclusions, readings, verdict_sentence

EXIT_WRONG_INPUT = 2

Run = Callable[[argparse.Namespace], None]  # a command


def add_compare(parser: argparse.ArgumentParser) -> None:
    """Where does the model fail against a campaign?"""
    _bench(parser, _compare)


def add_diagnose(parser: argparse.ArgumentParser) -> None:
    """Which effect is missing, how sure, what to measure next?"""
    _diagnose_parser(parser, _diagnose)


def add_add(parser: argparse.ArgumentParser) -> None:
    """Add an effect to the model: accepted only if the held-out error falls."""
    parser.add_argument("effect", help="name of an effect, see `airgap effects`")
    _diagnose_parser(parser, _add)


def add_ledger(parser: argparse.ArgumentParser) -> None:
    """Diagnose and add until nothing more is named."""
    _diagnose_parser(parser, _ledger)


def add_effects(parser: argparse.ArgumentParser) -> None:
    """What the library knows; a name shows its equation."""
    parser.add_argument("name", nargs="?")
    _own_effects(parser)
    parser.set_defaults(run=_effects)


def add_new_effect(parser: argparse.ArgumentParser) -> None:
    """A skeleton of one's own effect."""
    parser.add_argument("file", help="Python file to write, my_effect.py")
    _bench(parser, _new_effect, positional=False)


def add_import(parser: argparse.ArgumentParser) -> None:
    """A ``campaign.toml`` for a plain CSV file."""
    parser.add_argument("csv", help="CSV file, one column a quantity; it is only read")
    parser.set_defaults(run=_import)


def _bench(parser: argparse.ArgumentParser, run: Run, positional: bool = True) -> None:
    if positional:
        parser.add_argument("campaign", help="folder with campaign.toml and its tables")
    else:
        parser.add_argument("campaign", nargs="?", help="folder of a campaign whose residual gives the first guess")
    parser.add_argument("--out", metavar="DIR", help="where results go; default results/<campaign id>/")
    parser.add_argument("--model", metavar="FILE", help="model file; default model.toml in the results, if it is there")
    _own_effects(parser)
    parser.set_defaults(run=run)


def _diagnose_parser(parser: argparse.ArgumentParser, run: Run) -> None:
    _bench(parser, run)
    parser.add_argument("--seed", type=int, help="of the simulated campaigns")
    parser.add_argument(
        "--accept-conventions",
        action="store_true",
        help="go on with what the columns of the files look like, where campaign.toml does not say it",
    )


def _own_effects(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--effects-from",
        action="append",
        default=[],
        metavar="FILE.py",
        help="import effects of one's own: this runs the file; repeatable, a folder means its .py files",
    )


@contextmanager
def exit_on_wrong_campaign() -> Iterator[None]:
    """A ``WorkbenchError`` as its sentence on standard error and exit code 2."""
    try:
        yield
    except WorkbenchError as error:
        print(error, file=sys.stderr)
        raise SystemExit(EXIT_WRONG_INPUT) from None


def _library(options: argparse.Namespace) -> Library:
    for file in options.effects_from:
        if not Path(file).exists():
            raise WorkbenchError(f"--effects-from {file}: there is no such file.")
        print(f"importing effects from {file}: this runs the file", file=sys.stderr, flush=True)
        _must_hold_an_effect(file)
    return library(options.effects_from)


def _must_hold_an_effect(file: str) -> None:
    """One sentence where a named file (or every file of a named folder) cannot be imported or holds no effect."""
    path = Path(file)
    found: Library = {}
    for own in sorted(path.glob("*.py")) if path.is_dir() else [path]:
        try:
            found |= effects_of_file(own)
        except Exception as error:  # whatever the user's own file raises
            raise WorkbenchError(f"{own}: cannot be imported: {type(error).__name__}: {error}.") from None
    if not found:
        raise WorkbenchError(
            f"{file}: holds no effect; one is a frozen dataclass derived from effects.base, with a title and a "
            "parameter."
        )


def _set_up(options: argparse.Namespace) -> tuple[Campaign, Library, Model, Path]:
    """Campaign, library, model with its effects, and the folder of the results."""
    campaign, effects = read_campaign(options.campaign), _library(options)
    out = Path(options.out) if options.out else Path("results") / campaign.id
    model, saved = nominal_model(campaign), Path(options.model) if options.model else out / NAME
    if options.model or saved.exists():
        model = with_effects_of(saved, model, effects)
    out.mkdir(parents=True, exist_ok=True)
    return campaign, effects, model, out


def _settled(options: argparse.Namespace, campaign: Campaign, effects: Library, model: Model) -> Campaign:
    """The campaign with the conventions that were found in it, where the user accepts them."""
    if not options.accept_conventions:
        return campaign
    with _progress() as progress:
        conventions = settle(model, campaign, effects, progress)
    if not conventions.are_right:
        print("accepted:", *conventions.sentences, "", conventions.fix, sep="\n")
    return conventions.campaign


def _compare(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        with _progress() as progress:
            comparison = compare(model, campaign, effects, progress)
        _write_comparison(out, comparison)
        _print_comparison(comparison, out)


def _diagnose(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        campaign = _settled(options, campaign, effects, model)
        with _progress() as progress:
            diagnosis = diagnose(model, campaign, effects, SEED if options.seed is None else options.seed, progress)
        _write_diagnosis(out, diagnosis)
        _print_diagnosis(diagnosis, out)


def _add(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        campaign, effects, model, out = _set_up(options)
        campaign = _settled(options, campaign, effects, model)
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
        campaign = _settled(options, campaign, effects, model)
        with _progress() as progress:
            ledger, diagnosis = walk(model, campaign, effects, out, options.seed, progress)
        _write_diagnosis(out, diagnosis)
        _write_ledger(out, ledger)
        _print_ledger(ledger)
        _print_diagnosis(diagnosis, out)


def _effects(options: argparse.Namespace) -> None:
    with exit_on_wrong_campaign():
        found = _library(options)
        if options.name is None:
            width = max(len(name) for name in found)
            for name, cls in found.items():
                print(f"{name:{width}}  {cls.title}: {_equation(cls)}")
            return
        if options.name not in found:
            raise WorkbenchError(f"there is no effect {options.name!r}; `airgap effects` lists all.")
        _print_effect(found[options.name])


def _equation(cls: type[Effect]) -> str:
    """The first line of the docstring that holds an equation, else its first line."""
    lines = [line.strip() for line in (cls.__doc__ or "").splitlines() if line.strip()]
    return next((line for line in lines if " = " in line or " -> " in line), lines[0] if lines else "")


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
        print(f'wrote {write_draft(Path(options.csv))}: fill in every "?"')


@contextmanager
def _progress() -> Iterator[Callable[[str], None]]:
    """A bar on a terminal, nothing elsewhere."""
    with tqdm(bar_format="{desc} {elapsed}", leave=False, disable=not sys.stderr.isatty()) as bar:
        yield bar.set_description_str


def _write_comparison(out: Path, comparison: Comparison) -> None:
    (out / "comparison.json").write_text(comparison_json(comparison), encoding="utf-8")
    write_comparison_report(out / "comparison.html", comparison)


def _write_diagnosis(out: Path, diagnosis: Diagnosis) -> None:
    (out / "diagnosis.json").write_text(diagnosis_json(diagnosis), encoding="utf-8")
    write_diagnosis_report(out / "diagnosis.html", diagnosis)


def _write_ledger(out: Path, ledger: Ledger) -> None:
    write_ledger_report(out / "ledger.html", ledger)


def _print_comparison(c: Comparison, out: Path) -> None:
    print(
        f"\n{'channel':28} {'unit':>9} {'n':>8} {'rms error':>10} {'%':>6} {'noise':>9} {'chi2/n':>8} {'held out':>8}"
    )
    for s in c.scoreboard:
        held = "-" if s.held_out_chi2_per_n is None else f"{s.held_out_chi2_per_n:.2f}"
        print(
            f"{s.channel:28} {s.unit:>9} {s.n:8d} {s.rms_error:10.4g} {s.rms_error_percent:6.2f} {s.noise_floor:9.3g} "
            f"{s.chi2_per_n:8.2f} {held:>8}"
        )
    for reading in readings(c):
        print(f"{'!' if reading.alarming else ' '} {reading.view}: {reading.sentence}")
    for words in c.checks + c.complaints:
        print(f"! {words}")
    print(f"results in {out}")


def _print_diagnosis(d: Diagnosis, out: Path) -> None:
    print(f"\n{'effect':28} {'P':>6} {'ln Z':>8} {'held out':>16}  size")
    for r in d.ranking[:8]:
        held = (
            "-"
            if r.held_out_chi2_per_n_after is None
            else (f"{r.held_out_chi2_per_n_before:.2f} -> {r.held_out_chi2_per_n_after:.2f}")
        )
        sizes = ", ".join(
            f"{n} {e.value:.4g} [{e.low90:.4g}, {e.high90:.4g}] {e.unit}" for n, e in r.parameters.items()
        )
        print(f"{r.name:28} {r.probability:6.3f} {r.log_evidence:8.1f} {held:>16}  {sizes}")
    print(f"nothing missing {d.p_nothing_missing:.3f}, none of these {d.p_none_of_these:.3f}")
    for option in d.next_measurements[:3]:
        print(f"next: {option.words} ({option.gain_nats:.1f} nats)")
    if d.fix:
        print("", d.fix, sep="\n")
    print("", verdict_sentence(d), *conclusions(d), f"results in {out}", sep="\n")


def _print_ledger(ledger: Ledger) -> None:
    print(f"\n{'step':>4} {'effect':28} {'decision':9} {'ln Z gain':>9} {'chi2/n':>9} {'held out':>9}  then")
    for s in ledger.steps:
        held = "-" if s.held_out_chi2_per_n is None else f"{s.held_out_chi2_per_n:.3f}"
        print(
            f"{s.step:4d} {s.effect or '-':28} {s.decision:9} {s.log_evidence_gain:9.1f} {s.chi2_per_n:9.3f} {held:>9}"
            f"  {s.verdict}"
        )


def _print_step(step: LedgerStep) -> None:
    held = "" if step.held_out_chi2_per_n is None else f", held-out chi2/n {step.held_out_chi2_per_n:.3f}"
    print(f"{step.effect}: {step.decision}; {step.reason}{held}")
