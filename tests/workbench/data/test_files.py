"""Data files as laboratories write them arrive as the same numbers; what cannot be understood is one sentence."""

import numpy as np
import pandas as pd
import pytest

from workbench.data.cells import values_of
from workbench.data.headings import heading_parts
from workbench.data.raw_table import Layout, decoded, read_raw, table_of_text
from workbench.errors import WorkbenchError

NAN = float("nan")


def columns(text, layout=Layout()):
    raw = table_of_text(text, "f.csv", layout)
    return raw, [raw.values(place) for place in range(len(raw.headings))]


@pytest.mark.parametrize(
    "text, expected",
    [
        ("a,b\n1.5,2\n3,-4e-1\n", [[1.5, 3], [2, -0.4]]),
        ("a;b\n1,5;2\n3;-4e-1\n", [[1.5, 3], [2, -0.4]]),
        ("a\tb\n1.5\t2\n3\t4\n", [[1.5, 3], [2, 4]]),
        ("a|b\n1,5|2\n3|4\n", [[1.5, 3], [2, 4]]),
        ("a  b\n1.5   2\n 3  4\n", [[1.5, 3], [2, 4]]),
        ("sep=;\na;b\n1,5;2\n", [[1.5], [2]]),
        ('a,b\n"1,5",2\n"2,25",3\n', [[1.5, 2.25], [2, 3]]),
        ("a;b\n1.234,5;2\n2,5;1.000.000\n", [[1234.5, 2.5], [2, 1e6]]),
        ("a;b\n1,234.5;2\n2.5;3\n", [[1234.5, 2.5], [2, 3]]),
        ("a;b\n1 234,5;2\n2'000,5;3\n", [[1234.5, 2000.5], [2, 3]]),
        ("a;b\n0,123;2\n", [[0.123], [2]]),
        ("a,b\n1,\n---,2\nn/a,#N/A\n3,4\n", [[1, NAN, NAN, 3], [NAN, 2, NAN, 4]]),
        ("a,b\ninf,1\nopen,2\n9.9E37,3\n1e308,4\n", [[np.inf, np.inf, NAN, NAN], [1, 2, 3, 4]]),
        ("a,b\n1_000,2\n0x10,3\n\u22125,4\n", [[NAN, NAN, -5], [2, 3, 4]]),
        ("# made by hand\na,b\n1,2\n% pause\n3,4\n", [[1, 3], [2, 4]]),
        ("# a b\n1.0 2.0\n3.0 4.0\n", [[1, 3], [2, 4]]),
        ("a,b\n1,2\n,\n\n3,4\n", [[1, 3], [2, 4]]),
    ],
)
def test_numbers_of_a_text(text, expected):
    _, found = columns(text)
    assert len(found) == len(expected)
    for values, wanted in zip(found, expected):
        assert np.array_equal(values, wanted, equal_nan=True)


def test_titles_headings_and_units_in_lines_of_their_own():
    raw, found = columns("Prüfstand 3\nDatum;22.11.2026\n\nt;F;Note\ns;kN;\n0;1,5;x\n1;---;y\n2;2,5;z\n")
    assert [(h.name, h.unit) for h in raw.headings] == [("t", "s"), ("F", "kN"), ("Note", "")]
    assert list(raw.lines) == [6, 7, 8] and np.array_equal(found[1], [1.5, NAN, 2.5], equal_nan=True)


@pytest.mark.parametrize(
    "heading, name, unit",
    [("Kraft [kN]", "Kraft", "kN"), ("force (N)", "force", "N"), ("F / kN", "F", "kN"), ("Kraft in kN", "Kraft", "kN"),
     ("F, kN", "F", "kN"), ("torque_Nm", "torque", "Nm"), ("v [m/s]", "v", "m_per_s"), ("n [1/min]", "n", "rpm"),
     ("T (°C)", "T", "degC"), ("phi [°]", "phi", "deg"), ("R [mΩ]", "R", "mohm"), ("x [µm]", "x", "um"),
     ("c [N·s/m]", "c", "Ns_per_m"), ("torque (filtered)", "torque (filtered)", ""), ("Phase A", "Phase A", ""),
     ("I_1 [A rms]", "I_1", "A"), ("U [V eff.]", "U", "V"), ("I [Arms]", "I", "A"), ("x [rms]", "x", "rms"),
     ("magnet_T", "magnet_T", ""), ("x [furlong]", "x", "furlong"), ("eta [-]", "eta", "1")],
)  # fmt: skip
def test_units_in_headings(heading, name, unit):
    assert heading_parts(heading) == (name, unit)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "cp1252", "latin-1"])
def test_encodings(encoding):
    text = "Größe [µm];Kraft [N]\n1,5;2\n" * 1
    assert decoded(text.encode(encoding), "f.csv") == text


@pytest.mark.parametrize(
    "cells, expected",
    [
        (["2026-01-31T23:59:59.5", "2026-02-01 00:00:01"], [0, 1.5]),
        (["31.01.2026 23:59:59,5", "01.02.2026 00:00:01"], [0, 1.5]),
        (["01/31/2026 11:59:59 PM", "02/01/2026 12:00:01 AM"], [0, 2]),
        (["23:59:59", "00:00:01", "00:00:04"], [0, 2, 5]),
        (["2026-01-31T12:00:00+01:00", "2026-01-31T11:00:01Z"], [0, 1]),
        (["---", "12:00", "12:01"], [NAN, 0, 60]),
    ],
)
def test_times_become_seconds_since_the_first_row(cells, expected):
    _, (times, _) = columns("t;x\n" + "".join(f"{cell};1\n" for cell in cells))
    assert np.array_equal(times, expected, equal_nan=True)


@pytest.mark.parametrize(
    "text, says",
    [
        ("a,b\n1,2\n3,4,5\n", "line 3 has 3 cells, its headings are 2"),
        ("a,b,c\n1,5,2,3,4,1\n", "decimal commas need another delimiter"),
        ("1,2\n3,4\n", "has no line of headings"),
        ("a;b\n1,234;2,345\n", "may be a decimal number or thousands"),
        ("a;b\n1,5;2.5\n", "has a decimal comma and"),
        ('a,b\n1,2\n"3,4\n5,6\n', "a quote is opened and not closed"),
        ('"a","b\n1,2\n3,4\n', "a quote is opened and not closed"),
        ("t;x\n01/02/2026 12:00;1\n03/04/2026 12:00;2\n", "may have the day or the month first"),
        ("a,b\n", "has no rows"),
        ("", "has no rows"),
        ("\n\n", "has no rows"),
    ],
)
def test_what_cannot_be_understood_is_said(text, says):
    with pytest.raises(WorkbenchError) as caught:
        columns(text)
    assert says in str(caught.value) and "\n" not in str(caught.value)


def test_a_cell_too_many_is_dropped_only_where_it_is_empty():
    raw, found = columns("a,b\n1,2,\n3,4,\n")
    assert np.array_equal(found, [[1, 3], [2, 4]]) and "all rows with an empty cell more" in raw.remarks[0]
    raw, found = columns("a,b\n1,2\n3\n")
    assert np.isnan(found[1][1]) and "1 of 2 rows with fewer cells than headings (first line 3)" in raw.remarks[0]


def test_what_cannot_be_found_out_can_be_said():
    _, found = columns("a;b\n1,234;2,345\n", Layout(decimal=","))
    assert np.array_equal(found, [[1.234], [2.345]])
    _, found = columns("a;b\n1,234;2,345\n", Layout(decimal="."))
    assert np.array_equal(found, [[1234], [2345]])
    _, found = columns("a:b\n1:2\n", Layout(delimiter=":"))
    assert np.array_equal(found, [[1], [2]])


@pytest.mark.parametrize("gap", ["", "---;3\n"])
def test_a_point_that_may_be_of_thousands_is_asked_about(gap):
    raw, found = columns("n;v\n1.000;38\n1.500;58\n" + gap)
    assert found[0][1] == 1.5 and "1.000 is read as a decimal number" in raw.remarks[0]
    for text, layout in (("n;v\n1.000;38.5\n", Layout()), ("n;v\n1.000;38\n", Layout(decimal="."))):
        assert columns(text, layout)[0].remarks == ()


def test_the_quick_way_and_the_careful_way_read_the_same():
    values = np.random.default_rng(0).standard_normal((50, 3)) * 10.0 ** np.arange(-8, 10, 6)
    text = "a,b,c\n" + "\n".join(",".join(f"{v!r}" for v in row) for row in values.tolist()) + "\n"
    quick, careful = columns(text)[1], columns(text + "---,,\n")[1]
    assert np.array_equal(np.transpose(quick), values)
    assert np.array_equal(np.transpose(careful)[:-1], values)


def test_junk_is_no_table(tmp_path):
    for data in (b"\x00\x01\x02\x03" * 50, b"a,b\n1,\x07\n", b"PAR1junk"):
        (tmp_path / "x.csv").write_bytes(data)
        with pytest.raises(WorkbenchError):
            read_raw(tmp_path / "x.csv")
    (tmp_path / "x.parquet").write_bytes(b"PAR1 not really PAR1")
    with pytest.raises(WorkbenchError, match="cannot be read as Parquet"):
        read_raw(tmp_path / "x.parquet")


def test_parquet_is_read_as_csv_is(tmp_path):
    times = pd.to_datetime(["2026-01-01 12:00:00.0", "2026-01-01 12:00:01.5"])
    pd.DataFrame({"F [kN]": [1.5, None], "text": ["x", "2,5"], "t": times, "n": [1, 2]}).to_parquet(
        tmp_path / "x.parquet"
    )
    raw = read_raw(tmp_path / "x.parquet")
    assert (raw.headings[0].name, raw.headings[0].unit) == ("F", "kN")
    assert np.array_equal(raw.values(0), [1.5, NAN], equal_nan=True)
    assert np.array_equal(raw.values(2), [0, 1.5]) and np.array_equal(raw.values(3), [1, 2])


def test_a_column_that_mixes_decimal_signs_is_refused():
    """12.786 among 3,192 is no 12786; beside 1.234,5 it is."""
    lines, where = [2, 3, 4], "a.csv"
    with pytest.raises(WorkbenchError, match="line 4 says 12.786, which may be a decimal number or thousands"):
        values_of(["3,192", "9,826", "12.786"], ",", where, lines)
    assert values_of(["3,192", "1.234,5", "12.786"], ",", where, lines).tolist() == [3.192, 1234.5, 12786.0]
