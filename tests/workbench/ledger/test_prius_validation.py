"""The measured Prius motor: what one temperature taught predicts the other, better than the motor as drawn."""

import json
from dataclasses import replace

import numpy as np
import pytest

from effects.library import package_effects
from examples.prius.splits import EFFECTS, learned_on, part, splits
from examples.prius.story import CAMPAIGN
from pipeline.cli import main
from workbench.data.campaign import read_campaign
from workbench.ledger.model_file import write_model
from workbench.ledger.validate import validate
from workbench.report.validation import chi2, share

KEYS = {"channel", "unit", "n", "rms_error", "bias", "chi2_per_n", "share_in_90", "outside_range"}


@pytest.fixture(scope="module")
def campaign():
    return read_campaign(CAMPAIGN)


@pytest.fixture(scope="module")
def cold(campaign):
    """What the sweep at 35 degC and the back-EMF teach."""
    return learned_on(part(campaign, next(iter(splits(campaign).values()))))


def test_the_warm_sweep_is_predicted_from_the_cold_one(campaign, cold):
    assert [effect.name() for effect in cold.effects] == list(EFFECTS)
    chosen = next(iter(splits(campaign).values()))
    found = validate(cold, part(campaign, [~mask for mask in chosen]), package_effects())
    assert chi2(found.corrected) < 3.2 and chi2(found.base) > 6
    assert share(found.corrected) > 0.9 and found.range_left == ()
    current, power = found.corrected
    assert power.chi2_per_n < 0.5 and power.rms_error < 25 < 65 < found.base[1].rms_error


def test_what_was_learned_helps_beyond_the_torque_it_was_learned_at(campaign):
    chosen = splits(campaign)["torque below 95 Nm learned, above predicted"]
    found = validate(learned_on(part(campaign, chosen)), part(campaign, [~m for m in chosen]), package_effects())
    assert chi2(found.corrected) < 0.4 * chi2(found.base) and share(found.corrected) > 0.8
    assert all(channel.outside_range == 1.0 for channel in found.corrected)
    assert any("torque is" in words and "rows lie beyond" in words for words in found.range_left)


def test_the_effects_without_the_fitted_inputs_would_not_do(campaign, cold):
    """Why inputs are kept: effects were learned beside them, and beside others they are wrong."""
    chosen = next(iter(splits(campaign).values()))
    rest = part(campaign, [~mask for mask in chosen])
    alone = replace(cold, inputs=tuple(replace(x, shift=0.0) for x in cold.inputs))
    with_inputs, without = (validate(learned, rest, package_effects()) for learned in (cold, alone))
    assert chi2(without.corrected) > 3 * chi2(with_inputs.corrected)


def test_the_command(cold, campaign, tmp_path, capsys):
    data = tmp_path / "warm"
    data.mkdir()
    text = (CAMPAIGN / "campaign.toml").read_text()
    head, _, _, warm = text.split("[[table]]")
    bare = head[: head.index("[device]")] + head[head.index("[systematic]") :]  # neither device nor tolerances
    (data / "campaign.toml").write_text(bare.replace('"prius-2004"', '"warm"') + "[[table]]" + warm)
    (data / "torque_sweep_75C.csv").write_bytes((CAMPAIGN / "torque_sweep_75C.csv").read_bytes())
    write_model(tmp_path / "model.toml", cold)
    main(["validate", str(tmp_path / "model.toml"), str(data), "--out", str(tmp_path / "out")])
    said, found = capsys.readouterr().out, json.loads((tmp_path / "out" / "validation.json").read_text())
    assert found["channels"] == found["corrected"]["channels"] and len(found["base"]["channels"]) == 2
    assert all(KEYS <= set(channel) for side in ("corrected", "base") for channel in found[side]["channels"])
    assert found["corrected"]["chi2_per_n"] < 0.6 * found["base"]["chi2_per_n"]
    assert "torque_sweep_75C.current" in said and "as drawn" in said and found["sentence"] in said
    page = (tmp_path / "out" / "validation.html").read_text()
    assert "Does the model hold?" in page and page.count("data:image/png") == 2 and "http" not in page.split("<body")[1]


def test_the_command_says_what_is_wrong(tmp_path, capsys):
    (tmp_path / "m.toml").write_text('[model]\nbase = "dq"\n')
    with pytest.raises(SystemExit, match="2"):
        main(["validate", str(tmp_path / "m.toml"), str(CAMPAIGN), "--out", str(tmp_path / "out")])
    assert "no fitted inputs" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_parts_of_the_data_are_complements(campaign):
    for chosen in splits(campaign).values():
        rows = [part(campaign, masks).tables for masks in (chosen, [~mask for mask in chosen])]
        assert sum(t.rows for side in rows for t in side) == sum(t.rows for t in campaign.tables)
        assert np.all([t.rows > 0 for side in rows for t in side])
