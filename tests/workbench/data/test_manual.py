"""The manual of campaign.toml and the template say what the code does."""

import numpy as np
import pytest

from workbench.data.campaign import read_campaign
from workbench.data.column_units import split_unit
from workbench.data.device_keys import DEVICE_KEYS
from workbench.data.expression import FUNCTIONS
from workbench.data.manual import MANUAL, filled
from workbench.data.schema import BY_REGION, LAST_REPEAT, NO_HOLDOUT, ROLES
from workbench.errors import WorkbenchError
from workbench.models.bases import base_models, nominal_model

TEXT = MANUAL.read_text(encoding="utf-8")


def test_generated_tables_are_those_of_the_code():
    assert filled(TEXT) == TEXT, "run python -m workbench.data.manual"
    assert filled(TEXT.replace("| `cogging` |", "| `coging` |")) == TEXT


def test_what_is_written_by_hand_names_everything():
    for word in (*ROLES, *(f"{name}(" for name in FUNCTIONS), BY_REGION, LAST_REPEAT, f'"{NO_HOLDOUT}"', "column:NAME"):
        assert f"`{word}" in TEXT or word in TEXT, word
    for role in ROLES:
        assert f"| `{role}` |" in TEXT


EXAMPLES = {"steel": "M400-50A", "magnetisation": "parallel", "iron_loss_grade": "M400-50A"}
EXAMPLES["machine_file"] = "prius_2004"


@pytest.mark.parametrize("model", DEVICE_KEYS)
def test_a_model_asks_for_the_keys_that_the_manual_calls_needed(model):
    """Without a needed key the model says its name; a key that it does not know is refused."""
    base = base_models()[model]
    whole = {k.key: EXAMPLES.get(k.key, 1.0) for k in DEVICE_KEYS[model]}
    with pytest.raises(WorkbenchError, match="extra_key"):
        base.design({**whole, "extra_key": 1.0})
    for key in DEVICE_KEYS[model]:
        quantity = split_unit(key.key)[0]
        if key.needed and key.key != "steel":
            with pytest.raises(WorkbenchError, match="lacks.*" + quantity.replace("remanence_T", "remanence")):
                base.design({k: v for k, v in whole.items() if k != key.key})


def test_the_template_is_a_campaign(tmp_path):
    (tmp_path / "campaign.toml").write_bytes((MANUAL.parent / "campaign_template.toml").read_bytes())
    rows = [(lap, shunt, v) for lap in (1, 2) for shunt in (0.5, 5) for v in np.linspace(0.1, 0.5, 8)]
    force = "".join(f"{v};{shunt};{(3600 / (1.2 + shunt) + 20) * v / 1e3:.5f};{lap}\n" for lap, shunt, v in rows)
    (tmp_path / "force.csv").write_text(
        "v [m/s];Shunt [Ohm];Kraft [kN];Lauf\n" + force.replace(".", ","), encoding="utf-8"
    )
    voltage = "".join(f"{lap},{v},{60 * v}\n" for lap, _, v in rows)
    (tmp_path / "open_circuit.csv").write_text("repeat,velocity_m_per_s,voltage_V\n" + voltage, encoding="utf-8")
    campaign = read_campaign(tmp_path)
    model = nominal_model(campaign)
    for table in campaign.tables:
        answers = model.answers(table)
        for name, response in table.responses.items():
            assert np.allclose(answers[name], response.values, atol=0.1)
