"""Files: .vtu and back, the scene, the report, and looking into the fields of a study."""

import base64
import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from figures.export import FieldFileError, read_vtu, to_grid, write_vtu
from figures.report import (
    Code,
    KeyNumber,
    KeyNumbers,
    Picture,
    Remark,
    Section,
    Table,
    heading,
    number_text,
    render_report,
    write_report,
)
from figures.scene import render_scene
from figures.style import new_figure
from figures.whole_field import whole_field
from pipeline import inspect_fields
from pipeline.results import ResultsError


@pytest.fixture(scope="module")
def field(half_machine):
    return whole_field(half_machine)


# ---- .vtu -----------------------------------------------------------------------------------------------------------


def test_vtu_round_trip(half_machine, field, tmp_path):
    path = tmp_path / "nominal.vtu"
    write_vtu(path, half_machine)
    back = read_vtu(path)
    assert back.description == field.description
    assert np.hypot(*back.flux_density).max() == pytest.approx(np.hypot(*field.flux_density).max(), rel=1e-12)
    assert back.region.names == field.region.names
    for name in field.region.names:
        areas = [one.areas[one.region.cells_of(name)].sum() for one in (back, field)]
        assert areas[0] == pytest.approx(areas[1], rel=1e-12)


def test_vtu_holds_what_paraview_shows(field):
    grid = to_grid(field)
    assert set(grid.cell_data) == {"B_T", "B_norm_T", "region"} and set(grid.point_data) == {"A_Wb_per_m"}
    assert grid.cell_data["B_T"].shape == (field.cells.shape[1], 3)
    assert grid.cell_data["B_norm_T"].max() == pytest.approx(np.hypot(*field.flux_density).max(), rel=0.2)
    assert grid.field_data["region_names"][grid.cell_data["region"][0]] == "stator_iron"


def test_other_files_are_refused(tmp_path):
    import pyvista

    wrong = tmp_path / "wrong.vtu"
    wrong.write_text("not a field")
    with pytest.raises(FieldFileError, match="wrong.vtu is not a .vtu file"):
        read_vtu(wrong)
    foreign = tmp_path / "foreign.vtu"
    pyvista.UnstructuredGrid({5: np.array([[0, 1, 2]])}, np.eye(3)).save(foreign)
    with pytest.raises(FieldFileError, match="foreign.vtu holds no A_Wb_per_m, region"):
        read_vtu(foreign)


# ---- scene ----------------------------------------------------------------------------------------------------------


def packed(page):
    return json.loads(re.search(r"const FIELDS = (.*);\n", page)[1])


def test_scene_carries_the_field(field):
    (data,) = packed(render_scene({"nominal": field}, "a title"))
    points = np.frombuffer(base64.b64decode(data["points"]), "<f4").reshape(-1, 2)
    triangles = np.frombuffer(base64.b64decode(data["triangles"]), "<u4").reshape(-1, 3)
    b = np.frombuffer(base64.b64decode(data["b"]), "<f4")
    assert len(points) == len(b) and triangles.max() == len(points) - 1
    assert len(triangles) == 4 * field.cells.shape[1]
    assert np.hypot(*points.T).max() == pytest.approx(42.5, rel=1e-5)
    assert b.max() == pytest.approx(field.smooth.b.max(), rel=1e-6)


def test_scene_stands_alone_and_is_safe(field):
    page = render_scene({"</script><b>": field}, "<title>")
    assert page.count("</script>") == 1 and "&lt;title&gt;" in page
    assert not re.search(r"""(src|href)=["']?http""", page)
    assert packed(page)[0]["name"] == "</script><b>"
    with pytest.raises(ValueError, match="at least one field"):
        render_scene({}, "nothing")


# ---- report ---------------------------------------------------------------------------------------------------------


def picture():
    figure = new_figure(2.0)
    figure.subplots().plot([0, 1], [0, 1])
    return figure


def test_report_reads_from_top_to_bottom(tmp_path):
    frame = pd.DataFrame({"slots": [9, 12], "back_iron_width_mm": [3.3456, np.nan], "why": ["a < b", "chosen"]})
    numbers = KeyNumbers((KeyNumber("torque per length", 55.5512, "Nm/m", "6 A/mm² RMS"),))
    sections = (
        Section("The result", ("A paragraph.", numbers, Remark("damping is short"))),
        Section("Maps & fits", (Picture(picture(), "Fig. A"), Table(frame, "Optima", marked=(1,)))),
    )
    path = tmp_path / "report.html"
    write_report(path, sections, title="Study", subtitle="of a machine", provenance={"commit": "abc"})
    page = path.read_text(encoding="utf-8")
    order = ["<h1>Study", "1. The result", "A paragraph.", "55.55 Nm/m", "damping is short", "2. Maps &amp; fits"]
    order += ["data:image/png;base64,", "Fig. A</figcaption>", "Optima</caption>", "<dt>commit</dt><dd>abc</dd>"]
    places = [page.index(text) for text in order]
    assert places == sorted(places)
    assert '<a href="#maps-fits">' in page and 'id="maps-fits"' in page
    assert "a &lt; b" in page and '<tr class="marked"><td class="number">12</td>' in page
    assert not re.search(r"""(src|href)=["']?http""", page)


def test_picture_from_a_file_is_the_file(tmp_path):
    (tmp_path / "one.png").write_bytes(b"\x89PNG picture")
    source = Picture("one.png", "").source(tmp_path)
    assert source == Picture(b"\x89PNG picture", "").source(Path())
    assert base64.b64decode(source.split(",")[1]) == b"\x89PNG picture"


@pytest.mark.parametrize(
    "column, expected",
    [
        ("back_iron_width_mm", "back iron width / mm"),
        ("torque_nominal_Nm_per_m", "torque nominal / (Nm/m)"),
        ("half_slot_area_mm2", "half slot area / mm²"),
        ("transmission_ratio_mm_per_rad", "transmission ratio / (mm/rad)"),
        ("slots", "slots"),
        ("reading", "reading"),
    ],
)
def test_headings_have_units(column, expected):
    assert heading(column).replace("\N{NO-BREAK SPACE}", " ") == expected


@pytest.mark.parametrize(
    "value, expected",
    [
        (55.5512, "55.55"),
        (0.0123456, "0.01235"),
        (15000.4, "15000"),
        (-2.5, "−2.500"),
        (12.0, "12"),
        (np.int64(7), "7"),
        (np.nan, "–"),
        (None, "–"),
        (True, "yes"),
        (np.bool_(False), "no"),
        (1.5e-9, "1.500e−09"),
        (float("inf"), "∞"),
        ("text", "text"),
    ],
)
def test_numbers_are_written_plainly(value, expected):
    assert number_text(value) == expected


def test_numbers_of_sentences_and_cells_have_minus_signs_and_code_and_names_do_not():
    said = "-43 % (-2 of it) by ISO 6336-5, 2e-13, --jobs 4 and lamination-2"
    sections = Section("signs", (said, Table(pd.DataFrame({"power": ["-15.7 ± 1.2"]}), "less: -1"), Code("x = -1")))
    page = render_report((sections,), title="signs")
    assert "<p>−43 % (−2 of it) by ISO 6336-5, 2e-13, --jobs 4 and lamination-2</p>" in page
    assert "−15.7 ± 1.2</td>" in page and "less: −1</caption>" in page and "x = -1" in page


def test_empty_report_is_a_page():
    assert "<h1>nothing</h1>" in render_report((), title="nothing")


# ---- inspect --------------------------------------------------------------------------------------------------------


def test_files_where_there_is_no_window(field, tmp_path, capsys):
    paths = inspect_fields.write_files({"a": field, "b": field}, tmp_path / "inspect", "title")
    assert [path.name for path in paths] == ["a.png", "b.png", "scene.html"]
    assert all(path.stat().st_size > 10_000 for path in paths)
    assert "scene.html" in capsys.readouterr().out


def test_fields_of_a_study(half_machine, tmp_path):
    with pytest.raises(ResultsError, match="no fields to look at yet"):
        inspect_fields.read_fields(tmp_path)
    write_vtu(tmp_path / "nominal.vtu", half_machine)
    (tmp_path / ".half.partxy.vtu").write_text("being written")
    assert list(inspect_fields.read_fields(tmp_path)) == ["nominal"]
    (tmp_path / "broken.vtu").write_text("broken")
    with pytest.raises(ResultsError, match="broken.vtu is not a .vtu file.*make fields"):
        inspect_fields.read_fields(tmp_path)


def test_display_without_graphics_libraries_is_said(monkeypatch, capsys):
    monkeypatch.setattr(inspect_fields, "has_display", lambda: True)
    monkeypatch.setattr(inspect_fields, "window_opens", lambda: False)
    assert not inspect_fields.wants_window()
    assert "sudo apt-get install libglu1-mesa libgl1" in capsys.readouterr().out


def test_no_display_means_no_window(monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(inspect_fields.sys, "platform", "linux")
    assert not inspect_fields.has_display()
    monkeypatch.setenv("PYVISTA_OFF_SCREEN", "false")
    monkeypatch.setenv("DISPLAY", ":0")
    assert inspect_fields.has_display()
    monkeypatch.setenv("PYVISTA_OFF_SCREEN", "true")
    assert not inspect_fields.has_display()
