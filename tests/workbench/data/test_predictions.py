"""What a campaign predicts is read with its interval, and shipped predictions hold what they say."""

from pathlib import Path

import pytest

from workbench.data.campaign import read_campaign
from workbench.data.predictions import read_predictions
from workbench.errors import WorkbenchError

HEADINGS = "of,quantity,unit,value,low,high,given\n"
OUTRUNNER = Path(__file__).resolve().parents[3] / "measurements" / "outrunner-14mm"


def written(folder, text):
    path = folder / "predictions.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_row_is_a_prediction(tmp_path):
    (one,) = read_predictions(written(tmp_path, HEADINGS + "other rotor,linkage,mWb,0.31,0.28,0.35,thin ring\n"))
    assert (one.of, one.value, one.low, one.high, one.given) == ("other rotor", 0.31, 0.28, 0.35, "thin ring")


WRONG = {
    "column": ("of,quantity,unit,value,low,given\n", "lack the column high"),
    "number": (HEADINGS + "a,b,c,much,1,2,d\n", "line 2: value is 'much' where a number is expected"),
    "infinite": (HEADINGS + "a,b,c,1,-inf,2,d\n", "line 2: low is '-inf'"),
    "outside": (HEADINGS + "a,b,c,3,1,2,d\n", "value 3 lies outside of low 1 and high 2"),
    "short": (HEADINGS + "a,b,c,3\n", "low is None"),
}


@pytest.mark.parametrize("text, words", WRONG.values(), ids=WRONG)
def test_wrong_predictions_are_one_sentence(tmp_path, text, words):
    with pytest.raises(WorkbenchError, match=words):
        read_predictions(written(tmp_path, text))


def test_the_prediction_for_the_other_rotor_is_an_interval_over_all_explanations():
    """Three explanations of four rings each; the first row holds them all, the second those with the gauged gaps."""
    campaign = read_campaign(OUTRUNNER)
    whole, gauged, *each = campaign.predictions
    assert len(each) == 12 and "predictions.csv" in campaign.file_hashes
    for row, some in ((whole, each), (gauged, [one for one in each if "wider gap" not in one.given])):
        assert row.low == min(one.low for one in some) and row.high == max(one.high for one in some)
    for thin, thick in zip(each, each[1:]):
        assert thick.value > thin.value or thick.given.endswith("0.3 mm"), "a thicker ring carries more flux"


def test_the_prediction_for_the_locked_rotor_is_an_interval_over_all_explanations():
    """Three explanations of the voltage at five currents, behind the interval over them; more current, more torque."""
    rows = read_campaign(OUTRUNNER.with_name("prius-2004-field")).predictions
    each = [rows[k : k + 4] for k in range(0, len(rows), 4)]
    assert len(each) == 5
    for whole, *some in each:
        assert whole.low == min(one.low for one in some) and whole.high == max(one.high for one in some)
        assumed, *weaker = (one.value for one in some)
        assert assumed > max(weaker), "less flux of the magnets, less torque"
    assert sorted(whole.low for whole, *_ in each) == [whole.low for whole, *_ in each]
