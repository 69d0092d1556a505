"""The pages as a whole: complete, self-contained, in reading order, and pictures with nothing cut off."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Text

from figures.style import BLUE, VERMILION
from workbench.findings import Diagnosis, Prediction
from workbench.report import (
    beliefs,
    channels,
    operating_range,
    structure,
    write_comparison_report,
    write_diagnosis_report,
    write_ledger_report,
)
from workbench.report.as_json import diagnosis_json
from workbench.report.sentences import readings, verdict_sentence
from workbench.report.waterfall import waterfall

SLACK = 0.03  # inch, beyond the edge of a picture


def assert_readable(figure):
    """Nothing is cut off at the edge of the picture, no axes is empty, no text is smaller than 8 points."""
    figure.draw_without_rendering()
    drawn, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    assert min(drawn.x0, drawn.y0) > -SLACK and drawn.x1 < width + SLACK and drawn.y1 < height + SLACK, drawn
    assert all(axes.has_data() or axes.collections for axes in figure.axes if axes.axison)
    assert all(text.get_fontsize() >= 8 for text in figure.findobj(Text) if text.get_text().strip())


def texts(figure):
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def headings(html):
    return re.findall(r"<h2 [^>]*>\d+\. (.*?)</h2>", html)


def pictures(html):
    return len(re.findall(r'<img src="data:image/png;base64,', html))


@pytest.fixture(scope="module")
def pages(tmp_path_factory, comparison, diagnosis, ledger):
    """Name -> text of the three pages."""
    folder = tmp_path_factory.mktemp("pages")
    writers = {"compare": write_comparison_report, "diagnose": write_diagnosis_report, "ledger": write_ledger_report}
    for (name, write), found in zip(writers.items(), (comparison, diagnosis, ledger), strict=True):
        write(folder / f"{name}.html", found)
    return {name: (folder / f"{name}.html").read_text(encoding="utf-8") for name in writers}


def test_pages_need_nothing_beside_them(pages):
    for html in pages.values():
        assert not re.search(r'(src|href)="(?!data:|#)', html)
        assert len(html) < 2_000_000


def test_the_comparison_reads_summary_then_failing_channel_then_the_views(pages, comparison):
    found = headings(pages["compare"])
    assert found[:2] == ["What was found", "Where it fails: force_velocity.force"]
    assert found[2:11] == [r.title for r in readings(comparison)]
    assert found[-1] == "What limits the conclusions" and pictures(pages["compare"]) == 10
    assert pages["compare"].index("The model does not explain") < pages["compare"].index("Scoreboard</h2>")


def test_the_diagnosis_says_everything_that_was_found(pages):
    found = headings(pages["diagnose"])
    assert found[:2] == ["What the data say before any model", "Verdict"]
    assert {"What was tried", "Rows that no fit has seen", "What to measure next"} < set(found)
    assert pictures(pages["diagnose"]) == 4
    for words in ("coulomb_friction", "contact_resistance", "force loop at 2 mm and 1 Hz", "by 16 times", "40 rows"):
        assert words in pages["diagnose"]


def test_pages_speak_of_odds_and_not_of_nats_or_numbered_views(pages):
    for html in pages.values():
        text = re.sub(r"<[^>]*>", " ", html)
        assert not re.search(r"\bnats?\b|\bln\b|\bV\d\b", text)
    assert "10^178.9 : 1" in pages["diagnose"] and "×9900" in pages["diagnose"], "gains of 412 and 9.2 nats"


def test_a_convention_is_settled_before_any_effect_is_spoken_of(tmp_path, diagnosis):
    fix = '[conventions]\nswap = ["v_b", "v_c"]'
    found = replace(diagnosis, verdict="convention", names=("swapped_phases",), fix=fix, sealed=None)
    write_diagnosis_report(tmp_path / "d.html", replace(found, conventions=("v_b and v_c look swapped.",)))
    html = (tmp_path / "d.html").read_text(encoding="utf-8")
    assert "<pre>[conventions]\nswap = [&#34;v_b&#34;, &#34;v_c&#34;]</pre>" in html
    assert "v_b and v_c look swapped" in html and "--accept-conventions" in html
    assert pictures(html) == 0 and not any(r.name in html for r in diagnosis.ranking)


def test_both_sides_of_a_picture_have_the_same_axes(diagnosis):
    figure = channels.before_and_after(diagnosis.before, diagnosis.after, "coulomb_friction")
    for left, right in np.array(figure.axes).reshape(2, 2):
        assert left.get_xlim() == right.get_xlim() and left.get_ylim() == right.get_ylim()
    assert max(np.abs(figure.axes[2].lines[1].get_ydata())) < figure.axes[3].get_ylim()[1], "the worse side fits in"


def test_the_ledger_ends_with_final_parameters_and_where_they_were_learned(pages):
    assert headings(pages["ledger"])[-1] == "Where the model was learned"
    assert "The final parameters" in headings(pages["ledger"])
    for words in (
        "3.77 to 4.43",
        "−6.29 to 0.29",
        "velocity −0.5 to 0.5 m/s; shunt 1\N{NO-BREAK SPACE}Ω",
        "was not tested",
    ):
        assert words in pages["ledger"]


def test_the_signature_is_shown_where_no_effect_explains(tmp_path, diagnosis):
    write_diagnosis_report(tmp_path / "d.html", replace(diagnosis, verdict="none_of_these", names=(), posteriors=()))
    html = (tmp_path / "d.html").read_text(encoding="utf-8")
    assert "What the residual looks like" in headings(html) and "small velocity" in html


def test_it_is_said_where_effects_may_only_fill_what_the_unknown_function_lacks(tmp_path, diagnosis):
    said = "may only be what its shape lacks of the true law"
    for remains, expected in ((0.6, True), (0.4, False)):
        write_diagnosis_report(tmp_path / "d.html", replace(diagnosis, p_something_remains=remains))
        assert (said in (tmp_path / "d.html").read_text(encoding="utf-8")) == expected


def test_reasons_of_every_step_stay_visible(pages):
    assert "was refused: the data speak for the effect, 10^13.0 to 1; chi²/n left out goes from" in pages["ledger"]
    assert len(re.findall(r"Step \d, [a-z ]+, was accepted: the data speak for", pages["ledger"])) == 3


def test_predictions_stand_on_the_page_with_their_interval(tmp_path, clean):
    told = Prediction("the other rotor", "flux linkage of a phase, peak", "mWb", 0.3166, 0.281, 0.352, "ring of 0.5 mm")
    write_comparison_report(tmp_path / "c.html", replace(clean, predictions=(told,)))
    html = (tmp_path / "c.html").read_text(encoding="utf-8")
    assert "Predicted, not yet compared" in headings(html)
    assert all(words in html for words in ("0.3166", "0.281 to 0.352", "peak / mWb", "ring of 0.5 mm"))


def test_a_page_is_written_from_what_there_is(tmp_path, clean, diagnosis, ledger):
    """Views, posteriors and options that cannot be had leave no empty section, no empty column, and raise nothing."""
    bare = replace(clean, pulls=(), regimes=(), parities=(), sequences=(), whiteness=(), signatures=(), fits=())
    write_comparison_report(tmp_path / "c.html", bare)
    assert headings((tmp_path / "c.html").read_text(encoding="utf-8")) == ["What was found", "Scoreboard"]
    nothing = Diagnosis("bare", "damper", "nothing_missing", (), 0.9)
    write_diagnosis_report(tmp_path / "d.html", nothing)
    found = headings((tmp_path / "d.html").read_text(encoding="utf-8"))
    assert found == ["Verdict", "How likely each explanation is", "What can and cannot be concluded",
                     "Rows that no fit has seen"]  # fmt: skip
    unheld = replace(ledger, steps=tuple(replace(s, held_out_chi2_per_n=None) for s in ledger.steps[:1]))
    write_ledger_report(tmp_path / "l.html", unheld)
    html = (tmp_path / "l.html").read_text(encoding="utf-8")
    assert "no conditions could be left out) stands at 27.4" in html and '<th class="text">left out</th>' not in html


@pytest.mark.parametrize(
    "has, said", [((), "Model damper"), (("inertance", "sensor_lag"), "damper with inertance and sensor lag")]
)
def test_both_pages_say_which_effects_the_model_has(tmp_path, clean, has, said):
    write_comparison_report(tmp_path / "c.html", replace(clean, model="damper", effects=has))
    write_diagnosis_report(tmp_path / "d.html", Diagnosis("bare", "damper", "nothing_missing", (), 0.9, has))
    for name in "cd":
        html = (tmp_path / f"{name}.html").read_text(encoding="utf-8")
        assert said in html and ("Model damper with" in html) is bool(has)


def test_one_picture_where_before_and_after_are_the_same(tmp_path, diagnosis):
    same = replace(diagnosis, verdict="nothing_missing", names=(), after=diagnosis.before)
    write_diagnosis_report(tmp_path / "d.html", same)
    assert "The fit" in headings((tmp_path / "d.html").read_text(encoding="utf-8"))


def test_the_json_keeps_its_keys_and_gains_the_new_ones(diagnosis):
    content = json.loads(diagnosis_json(diagnosis))
    kept = {"verdict", "names", "probability", "ranking", "p_nothing_missing", "p_none_of_these", "abstention_power",
            "detection_limits", "next_measurements", "residual_signature", "seed", "wall_s"}  # fmt: skip
    new = {"p_something_remains", "p_sets", "sealed", "checks", "fix", "sure", "alternatives", "conventions"}
    assert kept | new < set(content) and content["sealed"]["holds"] is True
    assert content["sentence"] == verdict_sentence(diagnosis)
    assert {"name", "probability", "log_evidence", "parameters", "at_bound"} < set(content["ranking"][0])
    assert {"kind", "conditions", "gain_nats", "cost"} < set(content["next_measurements"][0])


def test_names_from_files_cannot_write_into_the_page(tmp_path, ledger):
    write_ledger_report(tmp_path / "l.html", replace(ledger, campaign="<script>alert(1)</script>"))
    assert "<script>" not in (tmp_path / "l.html").read_text(encoding="utf-8")


def test_pictures_have_units_and_nothing_cut_off(comparison, diagnosis, ledger):
    figures = {
        "force / N": channels.channel_fit(comparison.fits[0]),
        "velocity / (m/s)": channels.before_and_after(diagnosis.before, diagnosis.after, "coulomb_friction"),
        "chi²/n (1: pure noise)": channels.scoreboard(comparison.scoreboard),
        "viscous damping (± 15 %)": structure.pulls(comparison.pulls),
        "shunt / Ω": operating_range.regime_maps(comparison.regimes),
        "residual torque / mNm": structure.order_spectra(comparison.orders),
        "exponent and 90 % interval": structure.scalings(comparison.scalings),
        "rms residual / u": structure.parities(comparison.parities),
        "residual / u": structure.sequences(comparison.sequences),
        "lag / readings": structure.whiteness(comparison.whiteness),
        "coulomb friction": structure.signatures(comparison.signatures),
        "none of these": beliefs.probabilities(diagnosis),
        "powers of ten in the odds": beliefs.next_measurements(diagnosis.next_measurements),
        "chi²/n": waterfall(ledger),
    }
    for words, figure in figures.items():
        assert words in texts(figure)
        assert_readable(figure)


def test_the_waterfall_draws_each_error_at_its_height(ledger):
    axes = waterfall(ledger).axes[0]
    heights = [bar.get_height() for bar in axes.patches]
    assert heights == [27.4, 12.1, 8.0, 2.3, 1.01, 28.2, 12.6, 19.4, 2.2, 1.04]
    hatched = [bar.get_height() for bar in axes.patches if bar.get_hatch()]
    assert hatched == [8.0, 19.4], "the refused step only"


def test_pulls_beyond_three_are_red(comparison):

    bars = structure.pulls(comparison.pulls).axes[0].containers[0]
    assert [to_hex(bar.get_facecolor()).upper() for bar in bars] == [VERMILION.upper(), BLUE.upper(), BLUE.upper()]


def test_the_chart_shows_every_probability_at_its_length(diagnosis):
    small = tuple(replace(diagnosis.ranking[-1], name=f"small_{k}", probability=5e-4) for k in range(9))
    named = replace(diagnosis, names=("diode_drop",), ranking=diagnosis.ranking + small)
    axes = beliefs.probabilities(named).axes[0]
    shown = dict(zip([t.get_text() for t in axes.get_yticklabels()], [bar.get_width() for bar in axes.patches]))
    assert shown["something unknown"] == 0.03 and shown["none of these"] == 0.02
    assert shown["coulomb friction"] == 0.95 and shown["diode drop"] == 1e-12, "what is named is always shown"
    assert len(shown) == 3 + 4, "negligible ones are not"


def test_large_channels_are_thinned_for_the_picture_only(comparison):
    fit = comparison.fits[0]
    many = {name: np.tile(getattr(fit, name), 200) for name in ("x", "measured", "nominal", "fitted", "u", "held_out")}
    figure = channels.channel_fit(replace(fit, **many, series=fit.series * 200))
    drawn = sum(len(line.get_xdata()) for line in figure.axes[1].lines)
    assert 500 < drawn <= channels.MOST_POINTS + 2
