"""The pages as a whole: complete, self-contained, in reading order, and pictures with nothing cut off."""

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.text import Text

from figures.style import BLUE, VERMILION
from workbench.report import (
    beliefs,
    channels,
    operating_range,
    structure,
    write_comparison_report,
    write_diagnosis_report,
    write_ledger_report,
)
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


def test_the_comparison_reads_summary_then_failing_channel_then_the_views(pages):
    found = headings(pages["compare"])
    assert found[:2] == ["What was found", "Where it fails: force_velocity.force"]
    assert [h[:2] for h in found[2:11]] == [f"V{k}" for k in range(9)]
    assert found[-1] == "What limits the conclusions" and pictures(pages["compare"]) == 10
    assert pages["compare"].index("The model does not explain") < pages["compare"].index("V0 Scoreboard</h2>")


def test_the_diagnosis_says_everything_that_was_found(pages):
    found = headings(pages["diagnose"])
    assert found[0] == "Verdict" and "What was tried" in found and "What to measure next" in found
    assert pictures(pages["diagnose"]) == 4
    for words in ("coulomb_friction", "contact_resistance", "force loop at 2 mm and 1 Hz", "below 5 mm/s", "0.35"):
        assert words in pages["diagnose"]


def test_the_signature_is_shown_where_no_effect_explains(tmp_path, diagnosis):
    write_diagnosis_report(tmp_path / "d.html", replace(diagnosis, verdict="none_of_these", names=(), posteriors=()))
    html = (tmp_path / "d.html").read_text(encoding="utf-8")
    assert "What the residual looks like" in headings(html) and "small velocity" in html


def test_refused_steps_stay_visible(pages):
    assert "the held-out error rose from 12.6 to 19.4." in pages["ledger"]
    assert pages["ledger"].count("refused") >= 3


def test_a_page_is_written_from_what_there_is(tmp_path, clean, diagnosis, ledger):
    """Views, posteriors and options that cannot be had leave no empty section and raise nothing."""
    bare = replace(clean, pulls=(), regimes=(), parities=(), sequences=(), whiteness=(), signatures=(), fits=())
    write_comparison_report(tmp_path / "c.html", bare)
    empty = {"before": None, "after": None, "posteriors": (), "separations": (), "detection_limits": ()}
    nothing = replace(diagnosis, verdict="nothing_missing", names=(), next_measurements=(), **empty)
    write_diagnosis_report(tmp_path / "d.html", nothing)
    assert headings((tmp_path / "d.html").read_text(encoding="utf-8"))[1] == "How likely each explanation is"
    unheld = replace(ledger, steps=tuple(replace(s, held_out_chi2_per_n=None) for s in ledger.steps[:1]))
    write_ledger_report(tmp_path / "l.html", unheld)
    assert "none are held out) stands at 27.4" in (tmp_path / "l.html").read_text(encoding="utf-8")


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
        "gain per cost / nats": beliefs.next_measurements(diagnosis.next_measurements),
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


def test_probabilities_of_the_chart_add_up(diagnosis):
    small = tuple(replace(diagnosis.ranking[-1], name=f"small_{k}", probability=5e-4) for k in range(5))
    axes = beliefs.probabilities(replace(diagnosis, ranking=diagnosis.ranking + small)).axes[0]
    shown = sum(bar.get_width() for bar in axes.patches)
    assert shown == pytest.approx(0.95 + 0.02 + 1e-5 + 0.02 + 0.01 + 5 * 5e-4, abs=1e-6), "none is dropped"


def test_large_channels_are_thinned_for_the_picture_only(comparison):
    fit = comparison.fits[0]
    many = {name: np.tile(getattr(fit, name), 200) for name in ("x", "measured", "nominal", "fitted", "u", "held_out")}
    figure = channels.channel_fit(replace(fit, **many, series=fit.series * 200))
    drawn = sum(len(line.get_xdata()) for line in figure.axes[1].lines)
    assert 500 < drawn <= channels.MOST_POINTS + 2
