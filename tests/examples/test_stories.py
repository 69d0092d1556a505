"""The stories of examples/ end as their page says: nothing of the library helps, the user's own effect does."""

from pathlib import Path

import pytest

from examples.dc_motor.story import DROP, told

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_a_model_of_ones_own_is_one_class_and_finds_the_brushes():
    verdict = told()
    assert (verdict.verdict, verdict.names) == ("effect", ("brush_drop",))
    drop = verdict.ranking[0].parameters["drop"]
    assert drop.value == pytest.approx(DROP, abs=0.1), "the law of the bench is another one"


def test_examples_are_as_short_as_promised():
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in EXAMPLES.rglob("*.py")}
    assert all(count <= 30 for path, count in lines.items() if path.name == "my_effect.py"), lines
    assert all(count <= 65 for path, count in lines.items() if path.name == "story.py" and path.parent != EXAMPLES)
    assert lines[EXAMPLES / "dc_motor" / "model.py"] <= 41


def test_the_page_shows_what_there_is():
    text = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    shown = [EXAMPLES / part.split(")")[0] for part in text.split("](")[1:] if ".png" in part.split(")")[0]]
    assert len(shown) >= 4 and all(path.exists() for path in shown)
    assert sum(path.stat().st_size for path in EXAMPLES.rglob("*.png")) < 1_000_000
