"""A section that is missing is said with its name."""

import pytest

from study.errors import StudyError
from study.inputs_linkage import linkage_search
from study.needed import needed
from study.read import read_study


def test_a_section_that_is_there_is_given_back():
    match = read_study("motorcycle").match
    assert needed(match, "match") is match


def test_a_study_without_a_search_has_none():
    with pytest.raises(StudyError, match=r"the section \[linkage_search\] is missing; add it"):
        linkage_search(read_study("automotive"))
