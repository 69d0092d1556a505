"""What the report says in words, and when it alarms."""

from dataclasses import replace

import numpy as np
import pytest

from workbench.findings import Dependence, Estimate, Pull
from workbench.report.sentences import (
    by_chance,
    channels_off,
    comparison_sentence,
    leading,
    ledger_sentence,
    power_sentence,
    readings,
    verdict_sentence,
)
from workbench.report.words import amount, interval, label, listed, number, percent, probability_text, unit_text


def reading(comparison, view):
    return next(r for r in readings(comparison) if r.view == view)


# ---- words ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.4, "0.4"), (-12.34, "−12.3"), (3811.6, "3812"), (14921.0, "14921"), (0.0, "0"), (None, "–"), (np.nan, "–")],
)
def test_numbers_have_three_digits_and_no_needless_exponent(value, text):
    assert number(value) == text


def test_units_are_printed_and_take_a_prefix_where_small():
    assert [unit_text(u) for u in ("Ns_per_m", "ohm", "degC", "1", "N s^2/m^2")] == ["Ns/m", "Ω", "°C", "", "N s²/m²"]
    assert amount(4.5e-6, "m") == "4.5\N{NO-BREAK SPACE}µm"
    assert amount(8.9e-7, "m/N") == "890\N{NO-BREAK SPACE}nm/N"
    assert amount(0.5, "N") == "0.5\N{NO-BREAK SPACE}N" and amount(1e-5, "1/A^2") == "1e−05\N{NO-BREAK SPACE}1/A²"
    assert label("damping", "Ns_per_m") == "damping / (Ns/m)" and label("i_q", "A") == "i q / A"


def test_the_interval_is_in_the_unit_of_the_value():
    assert interval(Estimate(2e-3, 1e-3, 5e-4, 0.011, "m")) == "2\N{NO-BREAK SPACE}mm (90 % interval 0.5 to 11)"


def test_a_probability_is_never_rounded_to_certainty():
    assert probability_text(1 - 1e-9) == "> 99.9 %" and probability_text(0.0) == "< 0.1 %"
    assert percent(0.0) == "0 %" and percent(0.851) == "85 %" and percent(0.996) == "99.6 %"


def test_names_are_listed_as_in_a_sentence():
    assert listed(["a", "b", "c"], "or") == "a, b or c" and listed([]) == "" and listed(["a"]) == "a"


# ---- alarms ---------------------------------------------------------------------------------------------------------


def test_every_view_of_a_failing_model_alarms(comparison):
    assert [r.view for r in readings(comparison)] == [f"V{k}" for k in range(9)]
    assert all(r.alarming for r in readings(comparison))


def test_no_view_of_a_sound_model_alarms(clean):
    assert not any(r.alarming for r in readings(clean))
    assert {r.view for r in readings(clean) if r.alarming is None} == {"V3", "V4"}, "nothing measured for these"
    assert comparison_sentence(clean).startswith("The model explains these data")


def test_sentences_carry_the_numbers(comparison):
    assert "force_velocity.force" in comparison_sentence(comparison) and "93 %" in comparison_sentence(comparison)
    assert "viscous damping by +5.2 sigma" in reading(comparison, "V1").sentence
    assert "12, 24, 36 of a defect on the rotor" in reading(comparison, "V3").sentence
    assert "open_circuit.voltage moves by +2.4 u" in reading(comparison, "V6").sentence
    assert "mostly odd (5.4 u" in reading(comparison, "V5").sentence


def test_the_regime_named_is_the_largest_of_the_clear_cells(comparison):
    assert "velocity 0.3 to 0.5 m/s and shunt 0.5 to 2" in reading(comparison, "V2").sentence


def test_an_effect_hidden_in_a_tolerance_is_reported_at_the_noise(clean):
    pulled = replace(clean, pulls=(Pull("force_constant", -8.9, 0.01, "", "tolerance"),))
    assert reading(pulled, "V1").alarming and not reading(pulled, "V0").alarming
    assert "had to leave the declared tolerance" in comparison_sentence(pulled)


def test_the_size_of_noise_from_few_repeats_is_itself_uncertain(clean):
    """chi2/n of 1.8 in 48 readings: beyond 1 % for known noise (chi2 table: 1.53), not where 24 pairs gave its size."""
    few, many = (replace(clean.scoreboard[0], chi2_per_n=1.8, n=n) for n in (48, 20_000))
    assert not channels_off(replace(clean, scoreboard=(few,)))
    assert channels_off(replace(clean, scoreboard=(many,)))


def test_alarms_of_pure_noise_are_as_rare_as_promised():
    """p-values of pure noise are uniform; k/401 as few permutations give them."""
    p_values = np.random.default_rng(1).integers(1, 402, (4000, 30)) / 401
    rate = np.mean([by_chance(row) < 0.01 for row in p_values])
    assert rate < 0.013
    assert by_chance([0.0025] * 5 + [0.5] * 25) < 1e-4, "many small ones are no chance even at the smallest p possible"
    assert by_chance([]) == 1.0


def test_one_order_of_sixty_just_above_its_floor_is_noise(comparison):
    spectrum = comparison.orders[0]
    amplitude = np.full(60, 0.2)
    amplitude[7] = 0.44
    quiet = replace(comparison, orders=(replace(spectrum, amplitude=amplitude),))
    assert not reading(quiet, "V3").alarming
    amplitude[7] = 0.66
    loud = replace(comparison, orders=(replace(spectrum, amplitude=amplitude),))
    assert reading(loud, "V3").alarming, "0.01 ** (0.66 / 0.4) ** 2 = 3.6e-6 of 60"


def test_one_lag_outside_its_band_is_no_structure(clean):
    values = clean.whiteness[0].autocorrelation.copy()
    values[3] = 0.25
    one = replace(clean.whiteness[0], autocorrelation=values)
    assert not reading(replace(clean, whiteness=(one,)), "V7").alarming
    on_speed = replace(one, dependences=(Dependence("speed", 5e-4), Dependence("i_q", 0.4)))
    said = reading(replace(clean, whiteness=(on_speed,)), "V7")
    assert said.alarming and "depends on speed" in said.sentence and "reading to reading" not in said.sentence


# ---- verdicts -------------------------------------------------------------------------------------------------------


def test_every_verdict_is_a_plain_sentence(diagnosis):
    two = ("coulomb_friction", "stribeck")
    said = {
        "effect": "What is missing is coulomb friction: force 4.1",
        "group": "one of coulomb friction or stribeck; these data cannot tell which",
        "pair": "Two effects are missing together: coulomb friction and stribeck",
        "partial": "Coulomb friction explains a part",
        "none_of_these": "none of the 6 effects tried; look at force_velocity.force",
        "cannot_tell": "cannot tell",
        "nothing_missing": "Nothing is missing",
    }
    for verdict, words in said.items():
        names = two if verdict in ("group", "pair") else two[:1] if verdict in ("effect", "partial") else ()
        sentence = verdict_sentence(replace(diagnosis, verdict=verdict, names=names))
        assert words in sentence and sentence.endswith("Probability 95 %.")


def test_two_effects_may_leave_something(diagnosis):
    both = replace(diagnosis, verdict="partial", names=("coulomb_friction", "stribeck"))
    assert verdict_sentence(both).startswith("Coulomb friction and stribeck together explain a part, but something")


def test_the_leader_is_the_named_effect_even_if_it_is_not_first(diagnosis):
    assert leading(replace(diagnosis, names=("stribeck",))).name == "stribeck"
    assert leading(replace(diagnosis, names=(), ranking=diagnosis.ranking[::-1])).name == "coulomb_friction"
    assert leading(replace(diagnosis, names=(), ranking=())) is None


def test_data_that_cannot_abstain_are_said_to(diagnosis):
    assert "62 % of those of 3 u" in power_sentence(diagnosis) and "cannot abstain" not in power_sentence(diagnosis)
    assert "cannot abstain" in power_sentence(replace(diagnosis, abstention_power={3.0: 0.02, 10.0: 0.1}))


def test_the_ledger_is_judged_on_held_out_rows_and_names_refusals(ledger):
    said = ledger_sentence(ledger)
    assert "from chi²/n = 28.2 to 1.04, at the goal of 1.2" in said and said.endswith("Refused: velocity polynomial.")
    unfinished = ledger_sentence(replace(ledger, steps=ledger.steps[:3]))
    assert "to 12.6, above the goal" in unfinished, "a refused step does not count"
