"""Every test that the list of the thesis's numbers names is there."""

import re
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
LIST = (PROJECT / "docs" / "thesis_numbers.md").read_text(encoding="utf-8")


def test_the_named_tests_are_there_and_every_row_names_one():
    rows = [row for row in LIST.splitlines() if row.startswith("|") and not re.match(r"\| (row|simulation|---)", row)]
    named = [re.findall(r"`(tests/[\w/]+\.py)::(test_\w+)`", row) for row in rows]
    assert len(rows) > 45 and all(named)
    missing = [
        f"{path}::{name}" for row in named for path, name in row if f"def {name}(" not in (PROJECT / path).read_text()
    ]
    assert not missing
