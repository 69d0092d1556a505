"""The traction motor of the 2004 Prius as measured at Oak Ridge. Run: python -m examples.prius.story [folder]

Nobody hid anything here: the motor is real, the model is the dq machine with constant parameters. The tool names what
the model lacks, adds it, and stops by itself; then a user tries two ideas of his own.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

from effects.library import package_effects
from examples.story import draw, folder_of_results
from workbench.compare.comparison import compare
from workbench.data.campaign import read_campaign
from workbench.findings import LedgerStep
from workbench.ledger.model_file import NAME, with_effects_of
from workbench.ledger.walk import Added, add_effect, walk
from workbench.models.bases import nominal_model
from workbench.report import write_comparison_report, write_diagnosis_report
from workbench.report.sentences import comparison_sentence, ledger_sentence, size_words, verdict_sentence

CAMPAIGN = Path(__file__).resolve().parents[2] / "measurements" / "prius-2004"
IDEAS = ("remanence_drift", "load_loss")  # magnets get weaker when warm; the coupling to the torque cell loses a share
CURRENT = ("torque_sweep_35C.current", "torque_sweep_75C.current")


def walked(out: Path) -> Added:
    """The walk by itself, then the user's ideas; how it stands after the last. out: an empty folder for its files"""
    campaign, library = read_campaign(CAMPAIGN), package_effects()
    walk(nominal_model(campaign), campaign, library, out)
    for idea in IDEAS:
        model = with_effects_of(out / NAME, nominal_model(campaign), library)
        added = add_effect(model, campaign, library, idea, out)
    return added


def current_error(step: LedgerStep) -> float:
    """Mean of both sweeps' rms error of the current over all rows [A]."""
    return sum(step.rms_error[name] for name in CURRENT) / len(CURRENT)


def show(out: Path) -> None:
    """Prints the story and writes its pictures and pages."""
    out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        end = walked(Path(folder))
    campaign = read_campaign(CAMPAIGN)
    before = compare(nominal_model(campaign), campaign, package_effects())
    print(comparison_sentence(before))
    for s in end.ledger.steps:
        words = f"{s.effect} {s.decision}; {size_words(s)}; chi2/n {s.chi2_per_n:.2f}, left out"
        print(f"{words} {s.held_out_chi2_per_n:.2f}, current {current_error(s):.2f} A; then {s.verdict}")
    print(ledger_sentence(end.ledger), verdict_sentence(end.diagnosis), comparison_sentence(end.comparison), sep="\n")
    draw(before, end.comparison, before.failing, f"{len(end.comparison.effects)} effects", end.ledger, out)
    write_comparison_report(out / "comparison.html", end.comparison)
    write_diagnosis_report(out / "diagnosis.html", end.diagnosis)


if __name__ == "__main__":
    show(folder_of_results("prius"))
