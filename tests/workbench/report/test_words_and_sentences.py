"""What the report says in words, and when it alarms."""

from dataclasses import replace

import numpy as np
import pytest

from workbench.findings import Dependence, Estimate, Pull
from workbench.report.sentences import (
    bound_sentences,
    by_chance,
    channels_off,
    comparison_sentence,
    conclusions,
    leading,
    ledger_sentence,
    left_out_sentence,
    meaning,
    open_questions,
    power_sentence,
    readings,
    sealed_sentence,
    set_words,
    verdict_sentence,
)
from workbench.report.words import (
    amount,
    factor_text,
    interval,
    label,
    listed,
    number,
    odds_text,
    percent,
    probability_text,
    unit_text,
)

NINE = (
    "effect",
    "group",
    "pair",
    "several",
    "partial",
    "none_of_these",
    "cannot_tell",
    "nothing_missing",
    "convention",
)


def reading(comparison, title):
    return next(r for r in readings(comparison) if r.title == title)


# ---- words ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.4, "0.4"),
        (-12.34, "−12.3"),
        (3811.6, "3812"),
        (14921.0, "14921"),
        (999.7, "1000"),
        (0.0, "0"),
        (None, "–"),
        (np.nan, "–"),
    ],
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


def test_a_value_next_to_nothing_takes_the_unit_of_its_interval():
    nothing = Estimate(171e-9, 1e-5, -16.069e-6, 16.412e-6, "m")
    assert interval(nothing) == "0.171\N{NO-BREAK SPACE}µm (90 % interval −16.1 to 16.4)"


def test_a_probability_is_never_rounded_to_certainty():
    assert probability_text(1 - 1e-9) == "> 99.9 %" and probability_text(0.0) == "< 0.1 %"
    assert percent(0.0) == "0 %" and percent(0.851) == "85 %" and percent(0.996) == "99.6 %"


def test_odds_are_read_without_logarithms():
    assert odds_text(np.log(2000.0)) == "2000 : 1" and odds_text(-np.log(40.0)) == "1 : 40"
    assert odds_text(8.3 * np.log(10)) == "10^8.3 : 1" and odds_text(-np.inf) == "–"
    assert factor_text(np.log(1.07)) == "×1.07" and factor_text(9.2) == "×9900"


def test_names_are_listed_as_in_a_sentence():
    assert listed(["a", "b", "c"], "or") == "a, b or c" and listed([]) == "" and listed(["a"]) == "a"


# ---- alarms ---------------------------------------------------------------------------------------------------------


def test_every_view_of_a_failing_model_alarms(comparison):
    assert len({r.title for r in readings(comparison)}) == 9
    assert all(r.alarming for r in readings(comparison))


def test_no_view_of_a_sound_model_alarms(clean):
    assert not any(r.alarming for r in readings(clean))
    assert {r.title for r in readings(clean) if r.alarming is None} == {"Order spectrum", "Scaling"}, (
        "nothing measured for these"
    )
    assert comparison_sentence(clean).startswith("The model explains these data")


def test_sentences_carry_the_numbers(comparison):
    assert "force_velocity.force" in comparison_sentence(comparison) and "93 %" in comparison_sentence(comparison)
    assert "viscous damping by +5.2 sigma" in reading(comparison, "Tolerance pulls").sentence
    assert "12, 24, 36 of a defect on the rotor" in reading(comparison, "Order spectrum").sentence
    assert "open_circuit.voltage moves by +2.4 u" in reading(comparison, "Order of acquisition").sentence
    assert "mostly odd (5.4 u" in reading(comparison, "Parity").sentence


def test_the_regime_named_is_the_largest_of_the_clear_cells(comparison):
    assert "velocity 0.3 to 0.5 m/s and shunt 0.5 to 2" in reading(comparison, "Regime map").sentence


def test_an_effect_hidden_in_a_tolerance_is_reported_at_the_noise(clean):
    pulled = replace(clean, pulls=(Pull("force_constant", -8.9, 0.01, "", "tolerance"),))
    assert reading(pulled, "Tolerance pulls").alarming and not reading(pulled, "Scoreboard").alarming
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
    assert not reading(quiet, "Order spectrum").alarming
    amplitude[7] = 0.66
    loud = replace(comparison, orders=(replace(spectrum, amplitude=amplitude),))
    assert reading(loud, "Order spectrum").alarming, "0.01 ** (0.66 / 0.4) ** 2 = 3.6e-6 of 60"


def test_one_lag_outside_its_band_is_no_structure(clean):
    values = clean.whiteness[0].autocorrelation.copy()
    values[3] = 0.25
    one = replace(clean.whiteness[0], autocorrelation=values)
    assert not reading(replace(clean, whiteness=(one,)), "Whiteness").alarming
    on_speed = replace(one, dependences=(Dependence("speed", 5e-4), Dependence("i_q", 0.4)))
    said = reading(replace(clean, whiteness=(on_speed,)), "Whiteness")
    assert said.alarming and "depends on speed" in said.sentence and "reading to reading" not in said.sentence


# ---- verdicts -------------------------------------------------------------------------------------------------------


def of(diagnosis, verdict):
    """The diagnosis with another verdict and names that fit."""
    names = ("coulomb_friction", "stribeck", "force_offset")
    count = {"effect": 1, "partial": 1, "group": 2, "pair": 2, "several": 3}.get(verdict, 0)
    return replace(diagnosis, verdict=verdict, names=names[:count], sure=0.97)


def test_every_verdict_is_a_plain_sentence(diagnosis):
    said = {
        "effect": "What is missing is coulomb friction: force 4.1",
        "group": "one of coulomb friction or stribeck; these data cannot tell which",
        "pair": "Two effects are missing together: coulomb friction and stribeck",
        "several": "Three effects are missing together: coulomb friction, stribeck and force offset",
        "partial": "Coulomb friction explains a part",
        "none_of_these": "none of the 6 effects tried, alone or beside coulomb friction",
        "cannot_tell": "cannot tell",
        "nothing_missing": "Nothing is missing",
        "convention": "No effect is named until this is settled",
    }
    assert set(said) == set(NINE)
    for verdict, words in said.items():
        sentence = verdict_sentence(of(diagnosis, verdict))
        assert words in sentence and sentence.endswith("Probability 95 %.")


@pytest.mark.parametrize("count", range(3, 9))
def test_any_number_of_effects_is_said(diagnosis, count):
    """A machine bench names four beside the friction that every bench has."""
    names = tuple(f"effect_{k}" for k in range(count))
    sentence = verdict_sentence(replace(diagnosis, verdict="several", names=names))
    assert f"{listed([f'effect {k}' for k in range(count)])}." in sentence


def test_every_verdict_says_what_its_probability_is_of(diagnosis):
    said = {verdict: meaning(of(diagnosis, verdict)) for verdict in NINE}
    assert all(words.startswith("The probability is that of the statement that") for words in said.values())
    assert said["pair"].endswith("coulomb friction and stribeck are there, alone or with others.")
    assert "22000 : 1" in said["nothing_missing"] and "at least one of these" in said["group"]


def test_a_convention_is_its_own_sentence_and_names_no_effect(diagnosis):
    found = replace(of(diagnosis, "convention"), conventions=("v_b and v_c look swapped.",), names=("swapped_phases",))
    assert verdict_sentence(found).startswith("v_b and v_c look swapped. Probability")
    assert conclusions(found) == () and not any(r.name in verdict_sentence(found) for r in diagnosis.ranking)


def test_cannot_tell_is_of_what_its_probability_is_of(diagnosis):
    quiet = replace(of(diagnosis, "cannot_tell"), p_nothing_missing=0.6, probability=0.6)
    assert "whether something is missing" in verdict_sentence(quiet) and "that nothing is missing" in meaning(quiet)
    loud = replace(quiet, probability=0.4)
    assert verdict_sentence(loud).startswith("Something is missing") and "that something is missing" in meaning(loud)


def test_what_is_probably_there_but_too_small_to_show_is_no_contradiction(diagnosis):
    first = replace(diagnosis.ranking[0], probability=0.52)
    found = replace(
        of(diagnosis, "nothing_missing"), names=(), ranking=(first,), sure=0.97, probability=0.6, p_nothing_missing=0.05
    )
    said = verdict_sentence(found)
    assert "would show plainly; something smaller probably is: likeliest" in said and "there with 52 %" in said
    assert "explains them" not in said and not any("does not explain" in line for line in conclusions(found))
    quiet = replace(found, p_nothing_missing=0.9)
    assert "the model with its tolerances explains them" in verdict_sentence(quiet)


def test_what_is_likely_and_not_sure_enough_for_its_name_is_told_all_the_same(diagnosis):
    first = replace(diagnosis.ranking[0], probability=0.888)
    found = replace(of(diagnosis, "cannot_tell"), names=(), ranking=(first,), sure=0.97, probability=0.99)
    said = f"{first.name.replace('_', ' ')} (there with 89 %; a name is said from 97 % on)"
    assert f"cannot tell what: likeliest is {said}." in verdict_sentence(found)
    strange = verdict_sentence(replace(found, verdict="none_of_these"))
    assert f"none of the 1 effects tried, alone or beside {said}; look at" in strange
    for other in (0.3, 0.98):
        unlikely = replace(found, ranking=(replace(first, probability=other),))
        for verdict in ("cannot_tell", "none_of_these"):
            assert "there with" not in verdict_sentence(replace(unlikely, verdict=verdict))


def test_what_remains_beside_names_is_said_as_what_it_is(diagnosis):
    both = replace(diagnosis, verdict="partial", names=("coulomb_friction", "stribeck"), p_something_remains=0.8)
    assert verdict_sentence(both).startswith("Coulomb friction and stribeck together explain a part, but something")
    ambiguous = replace(both, p_something_remains=0.1, alternatives={"force_offset": ("diode_drop",)})
    assert "but something" not in verdict_sentence(ambiguous), "nothing unknown is likely to remain"
    assert "Besides, one of force offset or diode drop is there" in verdict_sentence(ambiguous)
    assert meaning(replace(ambiguous, sure=0.93)).endswith("at least 93 %.")


def test_sealed_rows_that_disagree_are_not_taken_for_an_unknown_function(diagnosis):
    """The fitted rows show nothing: the probability is one minus that of such sealed rows by chance."""
    bad = replace(diagnosis.sealed, p_value=1e-5, chi2_per_n=3.1, holds=False)
    found = replace(of(diagnosis, "none_of_these"), sealed=bad, probability=1 - 1e-5, p_nothing_missing=0.9)
    assert "rows that no fit has seen disagree" in verdict_sentence(found) and "noise alone" in meaning(found)
    assert "does not hold there" in sealed_sentence(found) and "chi²/n = 3.10" in sealed_sentence(found)


@pytest.mark.parametrize("p, said", [(0.3, "The model holds there"), (2e-3, "can hardly be said to hold there")])
def test_sealed_rows_that_a_model_hardly_meets_are_no_success(diagnosis, p, said):
    assert said in sealed_sentence(replace(diagnosis, sealed=replace(diagnosis.sealed, p_value=p, holds=True)))


def test_without_sealed_rows_and_regions_prediction_is_said_to_be_untested(diagnosis):
    assert "40 rows" in sealed_sentence(diagnosis) and "never fitted: they test prediction" in sealed_sentence(
        diagnosis
    )
    whole = tuple(replace(r, held_out_chi2_per_n_before=None) for r in diagnosis.ranking)
    untested = replace(diagnosis, sealed=None, ranking=whole)
    assert "prediction was not tested" in sealed_sentence(untested)
    assert "beyond these conditions was not tested" in left_out_sentence(untested)
    said = " ".join(conclusions(untested))
    assert "none are sealed" in said and "beyond these conditions was not tested" in said
    assert "not tested" not in " ".join(conclusions(diagnosis))


def test_what_the_fitted_rows_show_is_not_blamed_on_sealed_rows(diagnosis):
    """Both probabilities are nearly one."""
    bad = replace(diagnosis.sealed, p_value=0.0, chi2_per_n=23.4, holds=False)
    found = replace(of(diagnosis, "none_of_these"), sealed=bad, probability=1.0, p_something_remains=1.0)
    assert "do not show it" not in verdict_sentence(found)


def test_parameters_on_a_bound_are_said_where_they_are_named(diagnosis):
    bound = tuple(replace(r, at_bound=("force",)) for r in diagnosis.ranking)
    assert bound_sentences(diagnosis) == ()
    (said,) = bound_sentences(replace(diagnosis, ranking=bound))
    assert said.startswith("Force of coulomb friction ends on a bound")


def test_a_size_that_the_data_leave_as_it_was_believed_says_so(diagnosis):
    assert "next to nothing" not in verdict_sentence(diagnosis)
    untold = tuple(replace(r, as_believed=("force",)) for r in diagnosis.ranking)
    assert "of which these data tell next to nothing" in verdict_sentence(replace(diagnosis, ranking=untold))


def test_what_would_show_an_effect_that_is_not_sure_is_said(diagnosis):
    """The named one is sure, one of 2 % is no question; where one of 20 % is, its calibration is said."""
    with_remedy = [replace(r, shown_by=("hang a weight on the cell", "zero it")) for r in diagnosis.ranking]
    known = replace(diagnosis, sure=0.9)
    assert open_questions(replace(known, ranking=tuple(with_remedy))) == ()
    with_remedy[1] = replace(with_remedy[1], probability=0.2)
    assert open_questions(replace(known, ranking=tuple(with_remedy))) == (
        "Whether stribeck is there (20 %) would be shown by: hang a weight on the cell or zero it.",
    )


def test_an_unknown_law_that_could_stand_for_the_names_is_said(diagnosis):
    assert "one unknown law and no effect, with probability 2 %" in " ".join(conclusions(diagnosis))
    assert "unknown law" not in " ".join(conclusions(replace(diagnosis, p_none_of_these=1e-5)))


def test_an_explanation_is_not_taken_for_one_of_its_parts():
    assert set_words("coulomb_friction") == "coulomb friction alone"
    assert set_words("coulomb_friction + something unknown") == "coulomb friction + something unknown"
    assert set_words("nothing") == "nothing missing"


def test_the_leader_is_the_named_effect_even_if_it_is_not_first(diagnosis):
    assert leading(replace(diagnosis, names=("stribeck",))).name == "stribeck"
    assert leading(replace(diagnosis, names=(), ranking=diagnosis.ranking[::-1])).name == "coulomb_friction"
    assert leading(replace(diagnosis, names=(), ranking=())) is None


def test_data_that_cannot_abstain_are_said_to(diagnosis):
    assert "62 % of those of 3 u" in power_sentence(diagnosis) and "cannot abstain" not in power_sentence(diagnosis)
    assert "cannot abstain" in power_sentence(replace(diagnosis, abstention_power={3.0: 0.02, 10.0: 0.1}))


def test_the_ledger_is_judged_on_what_was_left_out_and_names_refusals(ledger):
    said = ledger_sentence(ledger)
    assert "from chi²/n = 28.2 to 1.04, at the goal of 1.2" in said
    assert "Refused: velocity polynomial. Nothing more is" in said
    unfinished = ledger_sentence(replace(ledger, steps=ledger.steps[:3]))
    assert "to 12.6, above the goal" in unfinished, "a refused step does not count"


def test_the_ledger_says_what_the_last_diagnosis_found(ledger):
    *before, last = ledger.steps
    ended = {v: ledger_sentence(replace(ledger, steps=(*before, replace(last, decision="accepted", verdict=v))))
             for v in ("none_of_these", "nothing_missing", "cannot_tell", "effect")}  # fmt: skip
    assert ended["none_of_these"].endswith("that no effect of the library describes.")
    assert len(set(ended.values())) == 4 and "missing" not in ended["effect"]


def test_the_ledger_compares_one_kind_of_error_only(ledger):
    first, *rest = ledger.steps
    mixed = ledger_sentence(replace(ledger, steps=(replace(first, held_out_chi2_per_n=None), *rest)))
    assert "from chi²/n = 27.4 to 1.01" in mixed and "no conditions could be left out" in mixed
