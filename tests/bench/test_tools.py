"""The tools on records whose results are known: synthetic ones with closed answers, and through the command."""

import json

import numpy as np
import pandas as pd
import pytest
from scipy.signal import chirp, freqz, lfilter, sawtooth

from bench.constant_speed import shunt_points, steady_point, straight_lines
from bench.errors import RecordError
from bench.frequency_response import frequency_response
from bench.impedance import sine_impedance, sweep_impedance, sweep_points
from bench.quadrants import best, passes
from bench.record import Record
from bench.report.impedance import impedance_campaign
from electrical.shunted_machine import Bridge
from electrical.synchronous_machine import SynchronousMachine
from pipeline.cli import main
from workbench.data.campaign import read_campaign
from workbench.data.expression import evaluate

SAMPLING = 2000.0


def record(name="r", **channels):
    length = len(next(one for one in channels.values() if np.ndim(one)))
    return Record(
        name, 1 / SAMPLING, {key: np.broadcast_to(one, (length,)).astype(float) for key, one in channels.items()}
    )


# ---- constant speed ------------------------------------------------------------------------------------------------


def run(velocity, shunt, rng, damping=3000.0, dead=0.0):
    force = damping * velocity - dead + 5 * rng.standard_normal(4000)
    voltage = np.sqrt(0.6 * (damping * velocity - dead) * velocity * shunt)
    return record(velocity=np.full(4000, velocity), force=force, shunt_voltage=voltage, shunt=shunt)


def test_slope_intercept_and_efficiency_are_those_that_made_the_records():
    rng = np.random.default_rng(0)
    points = [steady_point(run(v, 0.135, rng, dead=40.0)) for v in (0.05, 0.1, 0.2, 0.3)]
    (line,) = straight_lines(points)
    assert line.damping == pytest.approx(3000.0, abs=3.5 * line.damping_error) and line.damping_error < 5
    assert line.intercept == pytest.approx(-40.0, abs=3.5 * line.intercept_error)
    assert [p.efficiency for p in points] == pytest.approx([0.6] * 4, rel=0.01)
    pulls = [(p.efficiency - 0.6) / p.efficiency_error for p in points]
    assert max(map(abs, pulls)) < 3.5 and points[0].efficiency_error < 0.01
    assert shunt_points([line, line]).damping == pytest.approx([line.damping] * 2)


def test_the_efficiency_of_a_bridge_is_what_its_resistances_leave():
    """eta = R I / (E_0 - ...): without friction, by the power balance of the direct current."""
    machine, bridge, rng = (
        SynchronousMachine(5, 49.3e-3 / 7.5, 1e-9, 1e-9, 0.034),
        Bridge(0.3),
        np.random.default_rng(1),
    )
    speed, ratio, shunt = 150.0, 0.115 / 87.3, 0.135
    current = float(bridge.current(machine, speed, shunt))
    force = float(bridge.torque(machine, speed, shunt)) / ratio
    made = record(
        velocity=np.full(3000, speed * ratio),
        force=force + rng.standard_normal(3000),
        shunt_voltage=current * shunt,
        shunt=shunt,
    )
    expected = shunt * current / (current * (2 * 0.034 + shunt) + 2 * 0.3)
    assert steady_point(made).efficiency == pytest.approx(expected, rel=1e-3)


def test_a_speed_that_drifts_is_refused():
    ramp = record(velocity=np.linspace(0.1, 0.2, 400), force=np.ones(400), shunt=np.inf)
    with pytest.raises(RecordError, match="expected a constant speed other than zero, found 0.11"):
        steady_point(ramp)


# ---- four quadrants ------------------------------------------------------------------------------------------------


def strokes(velocity, force, efficiency, friction=0.0):
    period = 4 * 0.03 / velocity
    time = np.arange(0, 3 * period, 1 / SAMPLING)
    moving = np.where((time / period) % 1 < 0.5, velocity, -velocity)
    mechanical = force * moving + friction * velocity
    electrical = np.where(mechanical > 0, mechanical * efficiency, mechanical / efficiency)
    return record(
        stroke=0.03 * sawtooth(2 * np.pi * time / period, 0.5),
        force=force + friction * np.sign(moving),
        dc_voltage=48.0,
        dc_current=electrical / 48.0,
    )


def test_both_quadrants_of_a_record_have_their_efficiency():
    found = passes(strokes(0.2, 400.0, 0.7), 10e-3)
    assert len(found) == 6 and sum(one.is_passive for one in found) == 3
    assert best(found, True) == pytest.approx(0.7, rel=1e-6) and best(found, False) == pytest.approx(0.7, rel=1e-6)
    assert {round(one.velocity, 4) for one in found} == {0.2, -0.2}
    assert all(one.mechanical == pytest.approx(400.0 * one.velocity) for one in found)


def test_a_pass_that_begins_with_the_record_does_not_count():
    whole = strokes(0.2, 400.0, 0.7)
    place = int(np.argmin(np.abs(whole.channel("stroke")[:600]))) + 5  # just behind the middle
    cut = Record("cut", whole.step, {name: values[place:] for name, values in whole.channels.items()})
    assert len(passes(whole, 10e-3)) == 6 and len(passes(cut, 10e-3)) == 5


def test_where_both_ends_lose_there_is_no_efficiency():
    still = record(stroke=strokes(0.2, 1.0, 0.7).channel("stroke"), force=50.0, dc_voltage=48.0, dc_current=-1.0)
    assert all(np.isnan(one.efficiency) for one in passes(still, 10e-3) if one.is_passive)


def test_a_sine_is_no_saw_tooth():
    time = np.arange(0, 2, 1 / SAMPLING)
    sine = record(stroke=0.03 * np.sin(2 * np.pi * time), force=1.0, dc_voltage=48.0, dc_current=1.0)
    with pytest.raises(RecordError, match="expected a constant speed in the middle of the stroke"):
        passes(sine, 59e-3)
    with pytest.raises(RecordError, match="expected passes of 8 samples or more"):
        passes(sine, 1e-5)


# ---- impedance and responses ---------------------------------------------------------------------------------------


def driven(frequency, z, noise=0.0, cubic=0.0, periods=12.3, rng=None):
    time = np.arange(0, periods / frequency, 1 / SAMPLING)
    omega, phase = 2 * np.pi * frequency, 2 * np.pi * frequency * time + 0.4
    velocity = 5e-3 * omega * np.cos(phase)
    force = np.real(z * 5e-3 * omega * np.exp(1j * phase)) + cubic * velocity**3
    if noise:
        force = force + noise * rng.standard_normal(len(time))
    return record(stroke=5e-3 * np.sin(phase) + 0.01, force=force, shunt=0.135)


@pytest.mark.parametrize("frequency", (0.73, 7.3713, 41.07))
def test_a_sine_gives_its_impedance_at_any_frequency(frequency):
    found = sine_impedance(driven(frequency, 300 - 120j))
    assert found.impedance == pytest.approx(300 - 120j, rel=1e-6)
    assert found.frequency == pytest.approx(frequency, rel=1e-6) and found.amplitude == pytest.approx(5e-3, rel=1e-6)
    assert found.distortion < 1e-6


def test_a_cubic_damper_has_three_quarters_of_it_in_the_fundamental():
    """F = c v^3: fundamental 3/4 c V^2 and a third harmonic a third as large, which is no noise."""
    top = 5e-3 * 2 * np.pi * 5.0
    found = sine_impedance(driven(5.0, 0.0, cubic=1e5))
    assert found.impedance.real == pytest.approx(0.75e5 * top**2, rel=1e-5)
    assert found.distortion == pytest.approx(1 / 3, rel=1e-4) and found.error < 1e-3 * found.impedance.real


def test_the_error_of_an_impedance_is_what_repeats_scatter_by():
    rng = np.random.default_rng(2)
    found = [sine_impedance(driven(7.3, 300 - 120j, noise=4.0, rng=rng)) for _ in range(40)]
    pulls = np.array([(one.impedance - (300 - 120j)) / one.error for one in found])
    assert 0.7 < np.std(pulls.real) < 1.3 and 0.7 < np.std(pulls.imag) < 1.3


def test_the_campaign_states_the_error_of_the_worst_point_at_its_place():
    (point,) = points = [sine_impedance(driven(7.3, 300 - 120j, noise=4.0, rng=np.random.default_rng(8)))]
    at = {"frequency": np.array(point.frequency), "amplitude": np.array(1e3 * point.amplitude), "z": np.array(323.0)}
    stated = evaluate(impedance_campaign(points).uncertainty["im_Ns_per_m"], at, "")
    assert stated == pytest.approx(point.error + 1e-4 * 323, rel=0.05)


def test_too_few_periods_or_samples_are_refused():
    with pytest.raises(RecordError, match="3 periods or more"):
        sine_impedance(driven(2.0, 100.0, periods=1.4))
    with pytest.raises(RecordError, match="samples each"):
        sine_impedance(driven(300.0, 100.0, periods=90))


FILTER = ([0.2, 0.1], [1.0, -1.2, 0.6])


def filtered(kind, rng, noise=0.3, samples=20000):
    time = np.arange(samples) / SAMPLING
    cause = rng.standard_normal(samples) if kind == "noise" else chirp(time, 10, time[-1], 600)
    answer = lfilter(*FILTER, cause) + noise * rng.standard_normal(samples)
    return record(cause=cause, answer=answer)


@pytest.mark.parametrize("kind", ("noise", "sweep"))
def test_the_band_holds_nineteen_times_in_twenty(kind):
    rng, inside = np.random.default_rng(3), []
    for _ in range(12):
        one = filtered(kind, rng)
        found = frequency_response(one, one.channel("cause"), one.channel("answer"), 0.25).between(20, 500)
        true = freqz(*FILTER, found.frequency, fs=SAMPLING)[1]
        inside.append(np.mean(np.abs(found.h1 - true) < found.radius))
    assert np.mean(inside) == pytest.approx(0.95, abs=0.02)


def test_coherence_is_the_share_of_the_power_that_the_input_makes():
    one = filtered("noise", np.random.default_rng(4), noise=0.3, samples=100000)
    found = frequency_response(one, one.channel("cause"), one.channel("answer"), 0.25).between(20, 500)
    true = np.abs(freqz(*FILTER, found.frequency, fs=SAMPLING)[1]) ** 2
    assert found.coherence == pytest.approx(true / (true + 0.09), abs=0.06)
    assert found.h2 / found.h1 == pytest.approx(1 / found.coherence + 0j, rel=1e-9)


def test_a_sweep_gives_the_impedance_of_a_mass_with_a_damper():
    time = np.arange(0, 40, 1 / SAMPLING)
    velocity = 0.1 * chirp(time, 1, 40, 60)
    force = 250 * velocity + 5.6 * np.gradient(velocity, time) + np.random.default_rng(5).standard_normal(len(time))
    found = sweep_impedance(record(velocity=velocity, force=force), 1.0).between(3, 50)
    assert np.mean(np.abs(found.h1 / (250 + 2j * np.pi * found.frequency * 5.6) - 1)) < 0.02


def test_a_sweep_becomes_rows_of_a_campaign_with_errors_that_hold():
    """Parts of the impedance lie within their stated deviations: as many beyond one and two as a normal number has."""
    time, rng = np.arange(0, 60, 1 / SAMPLING), np.random.default_rng(7)
    stroke = 1e-3 * chirp(time, 3, 60, 30)
    velocity = np.gradient(stroke, 1 / SAMPLING)
    one = record(
        stroke=stroke, velocity=velocity, force=300 * velocity + 2 * rng.standard_normal(len(time)), shunt=0.135
    )
    points = sweep_points(one, sweep_impedance(one, 1.0).between(6, 26))
    pulls = np.array([(p.impedance - 300) / p.error for p in points])
    assert len(points) == 21 and points[0].amplitude == pytest.approx(1e-3, rel=0.02)
    assert 0.6 < np.sqrt(np.mean(np.abs(pulls) ** 2) / 2) < 1.5
    assert impedance_campaign(points).frame["shunt_mohm"].eq(135).all()


def test_too_short_a_record_is_refused():
    one = filtered("noise", np.random.default_rng(6), samples=1000)
    with pytest.raises(RecordError, match="expected 4 segments of 0.25 s or more"):
        frequency_response(one, one.channel("cause"), one.channel("answer"), 0.25)


# ---- the command ---------------------------------------------------------------------------------------------------

LIKE = """[campaign]
id = "like"
[device]
force_constant_N_per_A = 30.5
internal_resistance_mohm = 68.3
moving_mass_kg = 5.6
viscous_damping_Ns_per_m = 70
[[table]]
file = "a.csv"
kind = "damping_shunt"
u_random = { damping_kNs_per_m = "0.1" }
"""


@pytest.fixture
def sines(tmp_path):
    (tmp_path / "like").mkdir()
    (tmp_path / "like" / "campaign.toml").write_text(LIKE)
    (tmp_path / "like" / "a.csv").write_text("shunt_mohm,damping_kNs_per_m\n135,3\n465,1\n")
    for frequency in (2.0, 5.0, 12.0):
        one = driven(frequency, 300 + 2j * np.pi * frequency * 5.6)
        columns = {"time_s": one.time, "stroke_mm": 1e3 * one.channel("stroke"), "force_N": one.channel("force")}
        pd.DataFrame(columns).to_csv(tmp_path / f"{frequency:g}.csv", index=False)
    return tmp_path


def test_records_become_a_campaign_that_the_workbench_reads(sines, capsys):
    files = [str(sines / f"{f}.csv") for f in (2, 5, 12)]
    main(
        [
            "analyse",
            "impedance",
            *files,
            "--value",
            "shunt_mohm=135",
            "--like",
            str(sines / "like"),
            "--out",
            str(sines / "out"),
        ]
    )
    campaign = read_campaign(sines / "out" / "campaign")
    (table,) = campaign.tables
    assert table.kind == "impedance" and table.conditions["shunt"] == pytest.approx([0.135] * 3)
    assert table.responses["im"].values == pytest.approx(2 * np.pi * np.array([2, 5, 12]) * 5.6, rel=1e-5)
    numbers = json.loads((sines / "out" / "impedance.json").read_text())
    assert numbers["points"][1]["re_Ns_per_m"] == pytest.approx(300, rel=1e-5)
    assert (
        "[[table]]" in (sines / "out" / "impedance.html").read_text() and "airgap diagnose" in capsys.readouterr().out
    )


def test_a_lever_of_the_bench_turns_forces_up_and_strokes_down(sines):
    main(
        [
            "analyse",
            "impedance",
            str(sines / "2.csv"),
            "--value",
            "shunt_mohm=135",
            "--value",
            "lever_factor=1.25",
            "--out",
            str(sines),
        ]
    )
    (point,) = json.loads((sines / "impedance.json").read_text())["points"]
    assert point["re_Ns_per_m"] == pytest.approx(300 * 1.25**2, rel=1e-5)
    assert point["amplitude_mm"] == pytest.approx(4.0, rel=1e-5)


@pytest.mark.parametrize(
    "arguments, words",
    (
        (["impedance", "2.csv"], "expected a column 'shunt' with its unit, such as shunt_mohm, found stroke, force"),
        (["impedance", "2.csv", "--value", "shunt=135"], "--value shunt: expected one of shunt_mohm, lever_factor"),
        (["impedance", "2.csv", "--value", "shunt_mm=135"], "correct the name or its unit"),
        (["impedance", "2.csv", "--value", "shunt_mohm=x"], "--value shunt_mohm=x: expected a number"),
        (["impedance", "2.csv", "--value", "shunt"], "expected NAME=..., found no equals sign"),
        (["quadrants", "2.csv"], "expected --value window_mm=10, found no window"),
        (["sweep", "2.csv", "5.csv", "--value", "segment_s=1"], "expected one record, found 2"),
        (["sound", "2.csv", "--like", "like"], "expected a column 'pressure'"),
        (["impedance", "missing.csv"], "missing.csv"),
    ),
)
def test_what_is_wrong_ends_with_one_sentence(arguments, words, sines, capsys, monkeypatch):
    monkeypatch.chdir(sines)
    with pytest.raises(SystemExit) as end:
        main(["analyse", *arguments, "--out", "out"])
    said = capsys.readouterr().err.strip()
    assert end.value.code == 2 and words in said and "\n" not in said
