"""Loading what stays without looking for garbage."""

import gc

import pytest

from pipeline.cli import _loaded
from processes import without_collecting


def test_what_comes_is_looked_at_no_more_and_garbage_afterwards_is():
    before = gc.get_freeze_count()
    with without_collecting():
        assert not gc.isenabled()
        came = [[] for _ in range(100)]
    assert gc.isenabled() and gc.get_freeze_count() >= before + len(came)


def test_garbage_is_looked_for_again_where_loading_fails():
    with pytest.raises(ImportError), without_collecting():
        raise ImportError
    assert gc.isenabled()


def test_a_module_that_is_there_leaves_what_came_since_to_be_collected():
    before = gc.get_freeze_count()
    assert _loaded("processes").without_collecting is without_collecting
    assert gc.get_freeze_count() <= before  # what was kept before may have gone
