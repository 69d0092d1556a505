"""How the stories are told: compare, diagnose, a wrong turn, an own effect, the error at the noise, one too many."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.virtual_benches.hiding import Catalogue, hide
from effects.base import Effect
from effects.library import effects_of_file, package_effects
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.findings import Comparison, Diagnosis, Ledger, LedgerStep
from workbench.ledger.step import start_step, try_effect
from workbench.models.bases import nominal_model
from workbench.report import channels, write_comparison_report, write_diagnosis_report, write_ledger_report
from workbench.report.sentences import comparison_sentence, ledger_sentence, readings, verdict_sentence
from workbench.report.waterfall import waterfall

DPI = 90  # of the small pictures beside the stories


@dataclass(frozen=True)
class Story:
    """bench: writes the campaign into a folder;  wrong: an effect of the library that looked promising

    own: file of the user's effect
    """

    title: str
    bench: Callable[[Path], Path]
    wrong: str
    own: Path


@dataclass(frozen=True, eq=False)
class Told:
    """What happened: before anything was added, the verdict, every step, and how the model stands at the end."""

    before: Comparison
    verdict: Diagnosis | None
    ledger: Ledger
    after: Comparison

    @property
    def channel(self) -> str:
        """Where the model fails; where its error is no larger than noise, the channel that the verdict points at."""
        return self.before.failing or self.verdict.residual_signature["channel"]

    @property
    def own_step(self) -> LedgerStep:
        """The step of the user's own effect."""
        return self.ledger.steps[2]


def tell(story: Story, with_diagnosis: bool = True) -> Told:
    """Walks through a story. The campaign lives in a folder that is gone afterwards."""
    with TemporaryDirectory() as folder:
        campaign = read_campaign(story.bench(Path(folder)))
        library: dict[str, type[Effect]] = package_effects()
        model = nominal_model(campaign)
        before = compare(model, campaign, library)
        verdict = diagnose(model, campaign, library) if with_diagnosis else None
        wrong = try_effect(model, campaign, library, story.wrong, 1)
        own = effects_of_file(story.own)
        right = try_effect(wrong.model, campaign, library | own, next(iter(own)), 2)
        curve = effects_of_file(Path(__file__).parent / "one_too_many.py")
        greedy = try_effect(right.model, campaign, library | curve, "one_too_many", 3)
        steps = (start_step(wrong.before), wrong.step, right.step, greedy.step)
        after = compare(greedy.model, campaign, library)
    return Told(before, verdict, Ledger(campaign.id, model.base.name, steps), after)


def show(told: Told, out: Path) -> None:
    """Prints the story and writes its three pictures and its three pages."""
    out.mkdir(parents=True, exist_ok=True)
    print(comparison_sentence(told.before))
    for reading in readings(told.before):
        print(f"  {reading.title}: {reading.flag}. {reading.sentence}")
    print(verdict_sentence(told.verdict))
    for step in told.ledger.steps[1:]:
        print(f"{step.effect}: {step.decision}; {step.reason}.")
    print(ledger_sentence(told.ledger))
    print(comparison_sentence(told.after))
    own = told.own_step
    draw(told.before, told.after, told.channel, own.effect, told.ledger, out)
    write_comparison_report(out / "comparison.html", told.before)
    write_diagnosis_report(out / "diagnosis.html", told.verdict)


def draw(before: Comparison, after: Comparison, channel: str, added: str, ledger: Ledger, out: Path) -> None:
    """The three pictures of a story and the page of its ledger."""
    one, other = (next(f for f in c.fits if f.channel == channel) for c in (before, after))
    channels.channel_fit(one).savefig(out / "residual.png", dpi=DPI)
    channels.before_and_after(one, other, added).savefig(out / "before_and_after.png", dpi=DPI)
    waterfall(ledger).savefig(out / "falling_error.png", dpi=DPI)
    write_ledger_report(out / "ledger.html", ledger)


def hidden(catalogue: Callable[[], Catalogue], seed: int, outside: str) -> Callable[[Path], Path]:
    """Writes the campaign of a virtual bench with something that no effect of the library describes."""
    return lambda folder: hide(catalogue(), "outside", seed, wanted=(outside,))[0].write(folder)


def folder_of_results(name: str) -> Path:
    """Where a story writes: the first word of the command line, else results/examples/ and its name."""
    return Path(sys.argv[1] if len(sys.argv) > 1 else f"results/examples/{name}")
