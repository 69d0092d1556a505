"""Broken campaigns end in a sentence or are read; never in anything else. By hand: see ``mutations``."""

import numpy as np
import pytest

from tests.workbench.data.mutations import BASES, in_a_folder, mutated, toml_of
from workbench.data.campaign import read_campaign
from workbench.data.draft import draft_of
from workbench.errors import WorkbenchError
from workbench.models.bases import nominal_model

BATCHES, SIZE = 10, 30


@pytest.mark.parametrize("batch", range(BATCHES))
def test_a_broken_campaign_is_one_sentence_or_is_read(batch):
    for seed in range(100_000 + batch * SIZE, 100_000 + (batch + 1) * SIZE):
        outcome, done = in_a_folder(seed, nominal_model)
        assert outcome in ("read", "sentence"), f"seed {seed} ({done}): {outcome}"


def test_a_draft_for_broken_files_is_one_sentence_or_is_written(tmp_path):
    drafted = 0
    for seed in range(500_000, 500_120):
        folder = tmp_path / str(seed)
        folder.mkdir()
        mutated(folder, seed)
        try:
            drafted += draft_of(sorted(folder.glob("*.csv"))).startswith("# A campaign")
        except WorkbenchError as error:
            assert "\n" not in str(error)
    assert drafted > 60


def test_what_is_broken_was_whole(tmp_path):
    """The campaigns that the mutations start from are read without complaint, so that what they break counts."""
    for number, (content, rows_of) in enumerate(BASES):
        folder = tmp_path / str(number)
        folder.mkdir()
        for name, rows in rows_of(np.random.default_rng(0)).items():
            (folder / name).write_text("\n".join(map(",".join, rows)), encoding="utf-8")
        (folder / "campaign.toml").write_text(toml_of(content), encoding="utf-8")
        campaign = read_campaign(folder)
        assert nominal_model(campaign).base.name in ("damper", "dq")
        assert not [words for words in campaign.complaints if "one repeat" not in words]
