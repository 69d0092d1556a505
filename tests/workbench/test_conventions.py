"""Ordinary mistakes of a laboratory are named as what they are, and a right campaign gets no convention."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.virtual_benches import damper_bench, dq_bench
from benchmarks.virtual_benches.hiding import hide
from benchmarks.virtual_benches.mistakes import MISTAKES, Mistake, mistaken, scaled
from effects.mechanical.coulomb_friction import CoulombFriction
from tests.workbench.likelihood.tables import table
from tests.workbench.models.machine_case import drawn
from workbench.data.campaign import read_campaign
from workbench.data.conventions import NAMES, applied, fixes_of, section_text, with_conventions
from workbench.data.table import Campaign, Response, Table
from workbench.errors import WorkbenchError
from workbench.explain import mistakes
from workbench.explain.conventions import diagnosis_of, settle
from workbench.models.bases import nominal_model, redesigned
from workbench.models.machine.model import MachineBench
from workbench.models.model import Model

CATALOGUES = {"damper": damper_bench.CATALOGUE, "dq": dq_bench.CATALOGUE}
HIDDEN = {"damper": (88005, "coulomb_friction"), "dq": (88006, "friction_torque")}  # seed, name; far above the noise


@pytest.fixture(scope="module")
def right(tmp_path_factory) -> dict[str, Path]:
    """Campaigns with a hidden friction and no mistake."""
    folder = tmp_path_factory.mktemp("right")
    return {
        bench: hide(CATALOGUES[bench], "single", seed, (name,))[0].write(folder / bench)
        for bench, (seed, name) in HIDDEN.items()
    }


def settled(folder):
    campaign = read_campaign(folder)
    return settle(nominal_model(campaign), campaign)


CASES = [pytest.param(b, m, id=f"{b}: {m.words}") for b in ("damper", "dq") for m in MISTAKES[b]]


@pytest.mark.parametrize("bench, mistake", CASES)
def test_a_mistake_is_named(bench, mistake, right, tmp_path):
    found = settled(mistaken(mistake, right[bench], tmp_path / "wrong"))
    assert mistake.names[0] in found.names and set(found.names) <= set(mistake.names)


def test_what_other_mistakes_explain_as_well_is_said(right, tmp_path):
    """3.6 over the root of three is two within the gain of the voltage."""
    (doubled,) = (m for m in MISTAKES["damper"] if m.words == "factor 2 of the voltage")
    found = settled(mistaken(doubled, right["damper"], tmp_path / "wrong"))
    (beside,) = (line for line in found.sentences if line.startswith("These data cannot tell that from"))
    assert "velocity looks 3.6 times too small: another unit and voltage looks 1.73205 times too small" in beside


@pytest.mark.parametrize("bench", CATALOGUES)
def test_what_is_settled_may_be_written_down(bench, right, tmp_path):
    """With the text in campaign.toml the campaign is read as repaired, and nothing is left to settle."""
    folder = mistaken(MISTAKES[bench][0], right[bench], tmp_path / "wrong")
    found = settled(folder)
    with (folder / "campaign.toml").open("a", encoding="utf-8") as file:
        file.write("\n" + found.fix)
    again = read_campaign(folder)
    for one, other in zip(again.tables, found.campaign.tables):
        for name, response in one.responses.items():
            np.testing.assert_allclose(response.values, other.responses[name].values, rtol=1e-9)
    assert settle(nominal_model(again), again).are_right


def test_what_an_effect_may_be_is_no_convention(right, tmp_path):
    """sqrt(3/2) would be line for phase and peak for RMS at once; a device that is off by a fifth is likelier."""
    weak = Mistake("a fifth less", ("unit_factor",), ("back_emf.csv",), scaled(("v_ll_V",), np.sqrt(2 / 3)))
    assert settled(mistaken(weak, right["dq"], tmp_path / "weak")).are_right


@pytest.mark.parametrize(
    "bench, key, factor, name",
    [
        ("damper", "internal_resistance_ohm", 1000, "unit_factor"),
        ("dq", "inductance_q_H", 0.001, "unit_factor"),
        ("dq", "psi_m_Vs", 10, "unit_factor"),
        ("dq", "pole_pairs", 2, "poles"),
    ],
)
def test_a_wrong_constant_is_told_from_wrong_readings(bench, key, factor, name, right, tmp_path):
    """All readings that go with it are off at once; the text for campaign.toml holds what it should have been."""
    declared = read_campaign(right[bench]).device[key]
    wrong = shutil.copytree(right[bench], tmp_path / "wrong") / "campaign.toml"
    wrong.write_text(re.sub(rf"(?m)^{key} = .*$", f"{key} = {factor * declared!r}", wrong.read_text(), count=1))
    found = settled(wrong.parent)
    assert found.names == (name,) and found.sentences[0].startswith(f"[device]: {key} looks")
    assert found.fix.startswith(f"[device]\n{key} = ") and found.campaign.device[key] == pytest.approx(declared)
    before = read_campaign(wrong.parent)
    again = redesigned(nominal_model(before), before, found.campaign)
    assert settle(again, found.campaign).are_right


def test_it_is_said_of_the_model_with_the_effects_that_it_has(right):
    campaign = read_campaign(right["damper"])
    model = nominal_model(campaign) + CoulombFriction()
    assert diagnosis_of(settle(model, campaign), model, 1, 0.0).effects == ("coulomb_friction",)


def test_a_hot_winding_behind_a_rectifier_is_no_other_resistance(tmp_path):
    """With weak magnets besides it looks like twice the resistance."""
    names = ("diode_drop", "weak_magnets", "winding_temperature")
    assert settled(hide(damper_bench.CATALOGUE, "several", 88203, names)[0].write(tmp_path / "hot")).are_right


def test_a_drag_that_nobody_knows_is_no_other_unit_of_the_viscous_one(tmp_path):
    """Ten times the declared damping brakes nearly as one that goes with the root of the velocity."""
    catalogue = damper_bench.CATALOGUE
    kinds = [name for name in catalogue.outside if name not in catalogue.tuning_kinds]
    made, answer = hide(catalogue, "outside", 667, kinds=kinds)
    assert answer.outside == "drag with sqrt(v)" and settled(made.write(tmp_path / "root")).are_right


def test_a_wild_reading_of_the_drag_is_no_exchange(right, tmp_path):
    """It gives power; speed for torque makes that a small speed of a large torque, which gives as little."""

    def wild(frame):
        torque = frame["torque_Nm"].to_numpy().copy()
        torque[np.argmin(np.abs(frame["speed_rpm"]))] *= -2.0
        return frame.assign(torque_Nm=torque)

    folder = mistaken(Mistake("wild", (), ("drag.csv",), wild), right["dq"], tmp_path / "wild")
    assert settled(folder).are_right


@pytest.mark.parametrize("stated, is_right", [("v_ll_V = 1", True), ("speed_rpm = 1", False)])
def test_a_factor_that_is_stated_is_not_doubted(stated, is_right, right, tmp_path):
    line = next(mistake for mistake in MISTAKES["dq"] if mistake.words == "phase for line voltage")
    folder = mistaken(line, right["dq"], tmp_path / "wrong")
    with (folder / "campaign.toml").open("a", encoding="utf-8") as file:
        file.write(f'\n[conventions]\n"back_emf.csv" = {{ factor = {{ {stated} }} }}\n')
    assert settled(folder).are_right == is_right


@pytest.mark.parametrize("bench", CATALOGUES)
@pytest.mark.parametrize("group, seed", [("null", 3), ("single", 4), ("single", 5), ("pair", 6)])
def test_a_right_campaign_gets_none(bench, group, seed, tmp_path):
    found = settled(hide(CATALOGUES[bench], group, 88100 + seed)[0].write(tmp_path / "right"))
    assert found.are_right and found.fix == ""


LOOP = """[campaign]
id = "loop"

[device]
kind = "electromagnetic damper"
force_constant_N_per_A = 50
internal_resistance_ohm = 1.5
moving_mass_kg = 2
viscous_damping_Ns_per_m = 20

[tolerance]
viscous_damping_Ns_per_m = { sigma_rel = 0.15 }

[[table]]
file = "loop.csv"
kind = "force_loop"
constants = { frequency_Hz = 4, amplitude_mm = 3, shunt_ohm = 1 }
u_random = { force_N = 1 }
"""


@pytest.mark.parametrize("behind, fix", [(0, ""), (90, "-90"), (-90, "90"), (180, "180")])
def test_a_sine_may_be_counted_from_its_top(behind, fix, tmp_path):
    """F = (K^2 / (R + R_s) + c) v + m a of x = A sin(phase), with a phase that is read so many degrees less; half a
    period is a force that counts the other way round as well."""
    phase, omega, amplitude = np.arange(0.0, 360.0, 7.5), 8 * np.pi, 3e-3
    v = amplitude * omega * np.cos(np.radians(phase))
    a = -amplitude * omega**2 * np.sin(np.radians(phase))
    force = (50**2 / 2.5 + 20) * v + 2 * a + np.random.default_rng(4).standard_normal(len(phase))
    rows = [f"{angle - behind},{f:.4f}" for angle, f in zip(phase, force)]
    (tmp_path / "loop.csv").write_text("\n".join(["phase_deg,force_N", *rows]), encoding="utf-8")
    (tmp_path / "campaign.toml").write_text(LOOP, encoding="utf-8")
    found = settled(tmp_path)
    assert set(found.names) == ({"zero", "sign"} if behind == 180 else {"zero"} if behind else set())
    assert f"{{ offset = {{ phase_deg = {fix}" in found.fix if behind else found.fix == ""


# ---- the machine, on a campaign of its own model --------------------------------------------------------------------

DEVICE = {"slots": 12, "poles": 10}
ANGLE = np.linspace(0, 2 * np.pi, 160, endpoint=False)


@pytest.fixture(scope="module")
def machine() -> Model:
    """Fields of the drawing are solved once."""
    base = MachineBench(cache=None).anywhere(drawn())

    class Kept(type(base)):
        def anywhere(self, design):
            return self

    return Model(Kept(base.surrogate, base.other), drawn())


def emf_campaign(machine: Model, change=lambda table: table) -> Campaign:
    zero = np.zeros(len(ANGLE), dtype=int)
    table = Table("back_emf", "emf.csv", {"angle_mech": ANGLE, "speed": np.full(len(ANGLE), 100.0)}, {}, zero, zero,
                  zero.astype(bool), condition_units={"angle_mech": "rad", "speed": "rad_per_s"})  # fmt: skip
    names = ("v_a", "v_b", "v_c")
    asked = replace(table, responses=dict.fromkeys(names))
    answers = machine.answers(asked)
    noise = np.random.default_rng(2).standard_normal((3, len(ANGLE))) * 0.01
    weak = {n: 0.97 * answers[n] + e for n, e in zip(names, noise)}
    responses = {n: Response(n, v, np.full(len(ANGLE), 0.01), "V") for n, v in weak.items()}
    return Campaign("m", ".", DEVICE, (change(replace(table, responses=responses)),), (), (), 1, {})


def with_voltages(change):
    def of(table):
        values = change(*(table.responses[n].values for n in ("v_a", "v_b", "v_c")))
        found = {n: replace(r, values=v) for (n, r), v in zip(table.responses.items(), values)}
        return replace(table, responses=found)

    return of


def with_angle(change):
    return lambda table: replace(table, conditions={**table.conditions, "angle_mech": change(ANGLE)})


@pytest.mark.parametrize(
    "change, names",
    [
        (with_voltages(lambda a, b, c: (b, c, a)), ("swapped_phases", "angle_zero")),
        (with_voltages(lambda a, b, c: (a, c, b)), ("swapped_phases",)),
        (with_voltages(lambda a, b, c: (a, -b, c)), ("inverted_phase",)),
        (with_voltages(lambda a, b, c: (2 * a, 2 * b, 2 * c)), ("unit_factor",)),
        (with_voltages(lambda a, b, c: (a - b, b - c, c - a)), ("line_or_phase",)),
        (with_angle(lambda angle: -angle), ("angle_direction",)),
        (with_angle(lambda angle: angle * 180 / np.pi), ("unit_factor",)),
        (with_angle(lambda angle: 5 * angle), ("electrical_or_mechanical",)),
        (with_angle(lambda angle: angle + 0.25), ("angle_zero",)),
    ],
)
def test_the_angle_and_the_phases_of_a_machine(machine, change, names):
    found = settle(machine, emf_campaign(machine, change))
    assert found.names[0] == names[0] and set(found.names) <= set(names)


def test_a_right_machine_gets_none(machine):
    assert settle(machine, emf_campaign(machine)).are_right


# ---- the section of campaign.toml -----------------------------------------------------------------------------------


def a_table() -> Campaign:
    rows = np.arange(6.0)
    zero = np.zeros(6, dtype=int)
    responses = {n: Response(n, k + rows, np.ones(6), "mV", 1e-3) for k, n in enumerate(("v_a", "v_b", "v_c"))}
    conditions = {"angle_mech": 0.1 * rows, "speed": 10 + rows}
    table = Table("back_emf", "a.csv", conditions, responses, zero, zero, zero.astype(bool),
                  condition_units={"angle_mech": "deg", "speed": "rpm"})  # fmt: skip
    return Campaign("a", ".", DEVICE, (table,), (), (), 1, {})


def read(entry):
    return with_conventions(replace(a_table(), conventions={"a.csv": entry})).tables[0]


def test_the_vocabulary():
    before = a_table().tables[0]
    v = {n: r.values for n, r in before.responses.items()}
    rotated = read({"swap": [["v_a_mV", "v_b", "v_c"]]})
    assert np.array_equal(rotated.responses["v_b"].values, v["v_a"])
    assert np.array_equal(rotated.responses["v_a"].values, v["v_c"])
    assert np.array_equal(read({"invert": ["v_a"]}).responses["v_a"].values, -v["v_a"])
    doubled = read({"factor": {"v_a": 2.0}}).responses["v_a"]
    assert np.array_equal(doubled.values, 2 * v["v_a"]) and np.all(doubled.random == 2.0)
    np.testing.assert_allclose(read({"offset": {"v_a_mV": 500.0}}).responses["v_a"].values, v["v_a"] - 0.5)
    np.testing.assert_allclose(read({"angle": "electrical"}).conditions["angle_mech"], 0.02 * np.arange(6))
    turned = read({"angle_direction": -1, "angle_zero_deg": 180.0})
    np.testing.assert_allclose(turned.conditions["angle_mech"], -0.1 * np.arange(6) - np.pi)
    assert np.array_equal(turned.conditions["speed"], -before.conditions["speed"])
    late = read({"shift": {"v_a": 1}})
    assert late.rows == 5 and np.array_equal(late.responses["v_a"].values, v["v_a"][1:])
    assert set(read({"voltages": "line"}).responses) == {"v_ab", "v_bc", "v_ca"}
    assert set(read({"ignore": ["v_b"]}).responses) == {"v_a", "v_c"}
    assert read({"leave_out": {"v_a_mV": 2000.0}}).rows == 5


@pytest.mark.parametrize(
    "entry, words",
    [
        ({"turn": 1}, "is not known"),
        ({"invert": ["v_x"]}, "no column 'v_x'"),
        ({"factor": {"v_a": "two"}}, "a number is needed"),
        ({"factor": {"v_a": 0}}, "leaves nothing"),
        ({"swap": [["v_a", "v_a"]]}, "two different columns"),
        ({"swap": 3}, "cannot be read"),
        ({"angle": "grads"}, "is not known here"),
        ({"angle_direction": 2}, "-1 for clockwise"),
        ({"shift": {"v_a": 9}}, "whole number of rows"),
        ({"voltages": "delta"}, 'only "line"'),
        ({"ignore": ["v_a", "v_b", "v_c"]}, "leaves no reading"),
        ("invert", "write a table of keys"),
    ],
)
def test_what_cannot_be_read_is_one_sentence(entry, words):
    with pytest.raises(WorkbenchError, match=words):
        read(entry)


def test_a_file_that_is_not_there():
    with pytest.raises(WorkbenchError, match="no file of this campaign"):
        with_conventions(replace(a_table(), conventions={"b.csv": {}}))


def test_line_voltages_are_answered(machine):
    """A table with columns v_ab, v_bc, v_ca needs no convention."""
    campaign = emf_campaign(machine)
    line = {"v_ab": ("v_a", "v_b"), "v_bc": ("v_b", "v_c"), "v_ca": ("v_c", "v_a")}
    table = campaign.tables[0]
    responses = {
        n: Response(n, table.responses[p].values - table.responses[m].values, np.full(len(ANGLE), 0.015), "V")
        for n, (p, m) in line.items()
    }
    wired = replace(campaign, tables=(replace(table, responses=responses),))
    assert settle(machine, wired).are_right


def test_every_name_is_documented():
    named = {name for bench in MISTAKES.values() for mistake in bench for name in mistake.names}
    assert named <= set(NAMES)


def test_the_text_names_what_was_found():
    campaign = a_table()
    entry = {"swap": [["v_a", "v_b"]], "factor": {"v_c": 0.5}, "angle": "electrical"}
    fixes = fixes_of(replace(campaign, conventions={"a.csv": entry}))
    assert section_text({"a.csv": entry}).startswith('[conventions]\n"a.csv" = {')
    assert len(applied(campaign, fixes).tables) == 1 and len(fixes) == 3


def test_a_temperature_is_not_exchanged_for_what_no_temperature_can_be():
    """A logged room temperature and a speed of both signs: nobody's thermometer reads -2800 degC."""
    speed, room = np.linspace(-2800.0, 2800.0, 8), np.full(8, 21.5)
    drag = table({"torque": np.full(8, 0.1)}, 0.01, np.zeros(8, int), np.zeros(8, int), speed=speed, room_T=room)
    assert not mistakes._can_be_exchanged(drag, "speed", "room_T")
    warm = replace(drag, conditions={"speed": np.linspace(20.0, 90.0, 8), "room_T": room})
    assert mistakes._can_be_exchanged(warm, "speed", "room_T")


@pytest.mark.parametrize("shown, scale", [(294.2, "kelvin"), (21.0, None), (230.0, None), (-252.15, "celsius")])
def test_a_winding_that_would_burn_is_one_in_kelvin_and_one_that_would_freeze_is_none(shown, scale):
    """Four rows are too few for a model to tell it by."""
    warm = table({"resistance": np.ones(4)}, 0.01, np.zeros(4, int), np.zeros(4, int), winding_T=shown + np.arange(4.0))
    found = list(mistakes.wrong_kelvins(warm))
    assert [(fix.column, fix.scale) for fix in found] == ([("winding_T", scale)] if scale else [])
    assert all(20 < fix.apply(warm).conditions["winding_T"].max() < 25 for fix in found)
