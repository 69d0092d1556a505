"""The stories of examples/ end as their page says: nothing of the library helps, the user's own effect does."""

from pathlib import Path

import pytest

from examples.damper.story import STORY as DAMPER
from examples.dc_motor.story import DROP, told
from examples.dq.story import STORY as DQ
from examples.story import tell
from workbench.report.sentences import channels_off

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
NOISE = 1.2  # chi2/n up to which the error is that of the noise


@pytest.fixture(scope="module", params=[(DAMPER, "impedance.re"), (DQ, "short_circuit.torque")], ids=["damper", "dq"])
def walk(request):
    """(told, failing channel) of a story, without its diagnosis."""
    story, failing = request.param
    return tell(story, with_diagnosis=False), failing


def test_the_failing_channel_is_found_and_mended(walk):
    found, failing = walk
    assert found.before.failing == failing
    assert failing in [score.channel for score in channels_off(found.before)]
    assert not channels_off(found.after)


def test_the_own_effect_brings_the_error_to_the_noise(walk):
    start, _, own, _ = walk[0].ledger.steps
    assert own.decision == "accepted" and own.effect == walk[0].after.effects[0]
    assert start.held_out_chi2_per_n > 2.5
    assert own.held_out_chi2_per_n < NOISE and own.chi2_per_n < NOISE


def test_wrong_turns_are_refused_and_leave_the_model_alone(walk):
    _, wrong, own, greedy = walk[0].ledger.steps
    assert wrong.decision == greedy.decision == "refused" and walk[0].after.effects == (own.effect,)
    assert greedy.chi2_per_n < own.chi2_per_n, "it fits ..."
    assert greedy.held_out_chi2_per_n > own.held_out_chi2_per_n, "... but does not predict"


@pytest.mark.slow
def test_the_verdict_on_the_motor_is_none_of_these():
    verdict = tell(DQ).verdict
    assert verdict.verdict == "none_of_these" and verdict.names == ()
    assert verdict.p_nothing_missing < 0.01


def test_a_model_of_ones_own_is_one_class_and_finds_the_brushes():
    verdict = told()
    assert (verdict.verdict, verdict.names) == ("effect", ("brush_drop",))
    drop = verdict.ranking[0].parameters["drop"]
    assert drop.value == pytest.approx(DROP, abs=0.1), "the law of the bench is another one"


def test_examples_are_as_short_as_promised():
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in EXAMPLES.rglob("*.py")}
    assert all(count <= 30 for path, count in lines.items() if path.name == "my_effect.py"), lines
    assert all(count <= 65 for path, count in lines.items() if path.name == "story.py" and path.parent != EXAMPLES)
    assert lines[EXAMPLES / "dc_motor" / "model.py"] <= 40


def test_the_page_shows_what_there_is():
    text = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    shown = [EXAMPLES / part.split(")")[0] for part in text.split("](")[1:] if ".png" in part.split(")")[0]]
    assert len(shown) >= 6 and all(path.exists() for path in shown)
    assert sum(path.stat().st_size for path in EXAMPLES.rglob("*.png")) < 1_000_000
