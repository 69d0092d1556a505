"""Keys set in the text of a study: what was written stays, and the result reads as it should."""

import tomllib

import pytest

from study.edit import toml_value, with_settings

TEXT = """# A study.
[study]  # its name
id = "one"   # short
title = "One"

[match]
chosen_slots = 9       # by hand
weights = [1, 2]  # kept

[last]
chosen_slots = 3
"""


def test_keys_are_set_in_their_section_and_all_else_stays():
    new = with_settings(TEXT, {"study": {"id": "one_3"}, "match": {"chosen_slots": 12, "mm": 36.5}}, "design 3")
    assert tomllib.loads(new) == {
        "study": {"id": "one_3", "title": "One"},
        "match": {"chosen_slots": 12, "mm": 36.5, "weights": [1, 2]},
        "last": {"chosen_slots": 3},
    }
    changed = [line for line in new.splitlines() if line not in TEXT.splitlines()]
    assert changed == ['id = "one_3"  # design 3', "mm = 36.5  # design 3", "chosen_slots = 12  # design 3"]
    assert [line for line in TEXT.splitlines() if line not in new.splitlines()] == [
        'id = "one"   # short', "chosen_slots = 9       # by hand",
    ]  # fmt: skip


def test_a_section_that_is_missing_comes_at_the_end():
    new = with_settings(TEXT, {"search": {"choice": "best", "on": True}}, "x")
    assert new.startswith(TEXT.rstrip()) and tomllib.loads(new)["search"] == {"choice": "best", "on": True}


@pytest.mark.parametrize("value", (True, 12, 1.0 / 3, 2e-9, 'a "quoted" \\ text', 36.0))
def test_a_value_reads_as_it_was(value):
    assert tomllib.loads(f"a = {toml_value(value)}")["a"] == (
        value if isinstance(value, str) else pytest.approx(value, rel=1e-8)
    )
