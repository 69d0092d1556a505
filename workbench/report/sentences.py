"""One sentence for every view of a comparison, whether it is alarming, and the verdicts in words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isclose

import numpy as np
from scipy.special import bdtrc, fdtri

from workbench.believed import LIKELY, PLAIN
from workbench.findings import (
    ChannelScore,
    Comparison,
    Diagnosis,
    Ledger,
    LedgerStep,
    OrderSpectrum,
    Parity,
    Ranked,
    RegimeMap,
    Sealed,
    Sequence,
    Whiteness,
)  # fmt: skip
from workbench.report.words import (
    amount,
    bounds,
    chi2_text,
    estimated,
    interval,
    listed,
    number,
    odds_text,
    p_text,
    percent,
    plain,
    prefixed,
    probability_text,
    sentence,
    signed,
)

GOAL = 1.2  # chi2/n up to which a channel is at the noise
UNSURE = 0.05  # the same, from which nothing speaks against a model
ALARMING_PULL = 3.0  # sigma
ALARMING_P = 0.01  # probability that noise alone gives what a view shows
ALARMING_COSINE = 0.7  # half of the residual's square lies along the signature
IMPROBABLE = 0.05  # probability of "nothing is missing" below which something is
POOR = 2.0  # chi2/n of fitted rows above which an effect does not explain them
OPEN, OPEN_ONES = 0.1, 3  # probability from which it is said how an effect that is not sure could be shown; of so many
NO_GAIN = 0.1  # nats, 10 % of the odds, below which a measurement is not worth its cost
NEGLIGIBLE = 1e-3  # probability that is not worth a word
ALARMING_PART = 1.5  # odd or even part over what noise alone gives

ORDER_WORDS = {
    "native": "of the machine as drawn (multiples of LCM(Q, 2p))",
    "rotor": "of a defect on the rotor (multiples of Q)",
    "stator": "of a defect on the stator (multiples of 2p)",
    "emf": "of the EMF (odd multiples of p)",
    "other_emf": "that the EMF of a sound machine does not have",
    "encoder": "of the encoder or its run-out (1, 2)",
    "current": "of current harmonics (6 per electrical period)",
    "imbalance": "of unequal phases (2 per electrical period)",
    "other": "of no known family",
}


@dataclass(frozen=True)
class Reading:
    """What a view says. alarming: None where these data do not allow the view."""

    title: str
    shows: str
    sentence: str
    alarming: bool | None

    @property
    def flag(self) -> str:
        return {True: "alarming", False: "in order", None: "not to be had"}[self.alarming]


_VIEWS = (
    ("Scoreboard", "Error of every channel against its noise."),
    ("Tolerance pulls", "How far the fit had to move each declared tolerance and calibration, in its own sigma."),
    ("Regime map", "Mean residual over the operating range; p is by permutation of the residuals."),
    ("Order spectrum", "Residual amplitude of every mechanical order; noise passes the line once in 100."),
    ("Scaling", "Power of the residual's growth with each condition."),
    ("Parity", "Odd and even part of the residual when a direction or sign is reversed."),
    ("Order of acquisition", "Residual in the order in which it was measured."),
    ("Whiteness", "Whether structure is left from reading to reading, and on any condition."),
    ("Signature match", "Cosine between the residual and what each effect of the library would leave."),
)  # fmt: skip


def readings(comparison: Comparison) -> tuple[Reading, ...]:
    """The nine views in their order."""
    said = (_scoreboard, _pulls, _regimes, _orders, _scalings, _parities, _sequences, _whiteness, _signatures)
    return tuple(Reading(*view, *say(comparison)) for view, say in zip(_VIEWS, said, strict=True))


def fails(score: ChannelScore, channels: int) -> bool:
    """Whether a channel is further off than noise makes likely.

    chi2/n above 1.2 and above the 1 % / channels quantile of F(n, dof): the size of the noise is itself known only as
    well as the dof of its measurement say; n/2, as two repeats give, where they are not told.
    """
    dof = score.n / 2 if score.noise_dof is None else score.noise_dof
    return score.chi2_per_n > max(GOAL, float(fdtri(score.n, dof, 1 - ALARMING_P / channels)))


def channels_off(c: Comparison) -> list[ChannelScore]:
    """Channels that are off by more than noise."""
    return [score for score in c.scoreboard if fails(score, len(c.scoreboard))]


def comparison_sentence(comparison: Comparison) -> str:
    """The verdict-like summary of a comparison."""
    alarms = [reading for reading in readings(comparison) if reading.alarming]
    failing = _failing(comparison)
    if failing:
        return (
            f"The model does not explain these data: {failing.channel} is off by "
            f"{amount(failing.rms_error, failing.unit)} rms where its noise is "
            f"{amount(failing.noise_floor, failing.unit)}; it carries {percent(failing.excess_share)} of the excess."
        )
    if _pulled(comparison):
        names = listed(plain(pull.name) for pull in _pulled(comparison))
        return (
            f"The error is at the noise, but only because {names} had to leave the declared tolerance: an effect may "
            "hide there."
        )
    if alarms:
        names = listed(alarm.title.lower() for alarm in alarms)
        return f"The size of the error is that of the noise, but it is not random: see {names}."
    return "The model explains these data: every channel is at its noise and no view finds structure."


def _scoreboard(c: Comparison) -> tuple[str, bool]:
    off = channels_off(c)
    if not off:
        worst = max(c.scoreboard, key=lambda score: score.chi2_per_n)
        return (
            f"Every channel is at its noise, as far as the size of it is known; the worst, {worst.channel}, has "
            f"chi²/n = {chi2_text(worst.chi2_per_n)}.",
            False,
        )
    worst = max(off, key=lambda score: score.excess_share)
    return (
        f"{len(off)} of {len(c.scoreboard)} channels {'is' if len(off) == 1 else 'are'} off by more than noise; "
        f"{worst.channel} has chi²/n = {chi2_text(worst.chi2_per_n)}, an rms error of "
        f"{amount(worst.rms_error, worst.unit)} ({amount(worst.rms_error_percent)} %) and a bias of "
        f"{amount(worst.bias, worst.unit)}.",
        True,
    )


def _pulls(c: Comparison):
    if not c.pulls:
        return "The campaign declares no tolerance and no calibration uncertainty.", None
    pulled = _pulled(c)
    if not pulled:
        worst = max(c.pulls, key=lambda pull: abs(pull.pull))
        return (
            f"Nothing is moved by more than {ALARMING_PULL:g} sigma; the most, {plain(worst.name)}, by "
            f"{signed(worst.pull)}.",
            False,
        )
    moved = listed(f"{plain(pull.name)} by {signed(pull.pull)} sigma" for pull in pulled)
    return f"The fit moves {moved}: this is not a tolerance any more, an effect hides in it.", True


def _pulled(c: Comparison):
    return sorted((pull for pull in c.pulls if abs(pull.pull) > ALARMING_PULL), key=lambda pull: -abs(pull.pull))


def _regimes(c: Comparison):
    if not c.regimes:
        return "No channel has conditions that span a range.", None
    worst = min(c.regimes, key=_chance_of)
    chance = min(1.0, len(c.regimes) * _chance_of(worst))
    if chance > ALARMING_P:
        return (
            f"No part of the operating range stands out from what chance gives ({p_text(chance)} for all cells "
            "together).",
            False,
        )
    row, column = _clearest_cell(worst)
    where = f"{plain(worst.x.name)} {_span(worst.x_edges, column, worst.x.unit)}"
    if worst.y is not None:
        where += f" and {plain(worst.y.name)} {_span(worst.y_edges, row, worst.y.unit)}"
    return (
        f"{worst.channel} is off most clearly at {where}: on average {signed(worst.mean[row, column])} u "
        f"({p_text(worst.p_value[row, column])}).",
        True,
    )


def _clearest_cell(regime: RegimeMap) -> tuple[int, int]:
    """Row and column of the largest mean among the cells that are least likely by chance."""
    p_value = np.where(regime.count > 0, regime.p_value, np.inf)
    mean = np.where(p_value <= p_value.min(), np.abs(regime.mean), -1.0)
    return np.unravel_index(int(np.argmax(mean)), mean.shape)


def _chance_of(regime: RegimeMap) -> float:
    return by_chance(regime.p_value[regime.count > 0])


def by_chance(p_values: Iterable[float]) -> float:
    """Probability that so many tests of pure noise give p-values this small.

    Twice the smaller of Bonferroni's bound for the smallest and the binomial tail for the number below ``ALARMING_P``:
    few permutations bound the smallest p-value from below, but cannot make many of them small.
    """
    p = np.asarray(list(p_values), dtype=float)
    if not len(p):
        return 1.0
    many = bdtrc(np.sum(p < ALARMING_P) - 1, len(p), ALARMING_P)
    return float(min(1.0, 2 * min(len(p) * p.min(), many)))


def _span(edges: np.ndarray, cell: int, unit: str) -> str:
    factor, written = prefixed(float(np.max(np.abs(edges[cell : cell + 2]))), unit)
    return f"{number(edges[cell] * factor)} to {number(edges[cell + 1] * factor)} {written}".rstrip()


def _orders(c: Comparison):
    if not c.orders:
        return "No channel was measured over a whole turn.", None
    tests = sum(len(spectrum.orders) for spectrum in c.orders)
    worst = max(c.orders, key=lambda spectrum: np.max(spectrum.amplitude / spectrum.floor))
    above = np.flatnonzero(tests * _order_chance(worst) < ALARMING_P)
    if not len(above):
        return (
            f"No order of {listed(dict.fromkeys(s.channel for s in c.orders))} stands above what {tests} orders of "
            "noise give.",
            False,
        )
    families = {}
    for k in above[np.argsort(-worst.amplitude[above])]:
        families.setdefault(worst.classes[k], []).append(f"{worst.orders[k]:g}")
    said = "; ".join(f"{', '.join(orders[:5])} {ORDER_WORDS[family]}" for family, orders in families.items())
    return f"{worst.title} has orders above the noise: {said}.", True


def _order_chance(spectrum: OrderSpectrum) -> np.ndarray:
    """Probability that noise reaches the amplitude of each order: Rayleigh's law, 1 % at the floor."""
    return 0.01 ** ((spectrum.amplitude / spectrum.floor) ** 2)


def _scalings(c: Comparison):
    if not c.scalings:
        return "No condition takes enough different values where the residual stands above the noise.", None
    telling = [s for s in c.scalings if s.meaning]
    if not telling:
        return "The intervals are too wide to speak for one law.", False
    best = min(telling, key=lambda s: (s.channel != c.failing, s.high90 - s.low90))
    return (
        f"The residual of {best.channel} goes with {plain(best.quantity)} to the power {number(best.exponent, 2)} "
        f"({number(best.low90, 2)} to {number(best.high90, 2)}), like {best.meaning}.",
        any(score.channel == best.channel for score in channels_off(c)),
    )


def _parities(c: Comparison):
    if not c.parities:
        return "Nothing was measured both ways: in both directions, or at the same value of both signs.", None
    worst = max(c.parities, key=_part)
    if _part(worst) < ALARMING_PART:
        return "Odd and even parts are what noise alone gives.", False
    odd = worst.odd > worst.even
    means = "friction, hysteresis or another loss" if odd else "an offset or a misalignment"
    return (
        f"Under reversal of {plain(worst.reversal)} the residual of {worst.channel} is mostly "
        f"{'odd' if odd else 'even'} ({number(max(worst.odd, worst.even))} u against {number(worst.floor, 2)} u of "
        f"noise), as {means} makes it.",
        True,
    )


def _part(parity: Parity) -> float:
    return max(parity.odd, parity.even) / parity.floor


def _sequences(c: Comparison):
    if not c.sequences:
        return "The tables do not say in which order they were measured.", None
    worst = min(c.sequences, key=lambda s: s.p_value)
    if worst.p_value * len(c.sequences) > ALARMING_P:
        return (
            f"No drift: the strongest trend, in {worst.channel}, is {signed(worst.trend)} u from the {_ends(worst)} "
            f"({p_text(worst.p_value)}).",
            False,
        )
    return (
        f"{worst.channel} moves by {signed(worst.trend)} u from the {_ends(worst)} "
        f"({p_text(worst.p_value)}): a drift, unless a condition was changed in this order.",
        True,
    )


def _ends(s: Sequence) -> str:
    name = plain(s.axis.name)
    return f"first to the last {name}" if name in ("sample", "time") else f"lowest to the highest {name}"


def _whiteness(c: Comparison):
    if not c.whiteness:
        return "The scans are too short for an autocorrelation.", None
    found = [said for said in (_structure(w, len(c.whiteness)) for w in c.whiteness) if said]
    if not found:
        return "What is left is white: no autocorrelation within scans and no dependence on a condition.", False
    return f"Structure is left in {listed(found)}.", True


def _structure(w: Whiteness, channels: int) -> str:
    """In words what is not white in a channel; empty where all is."""
    lags = len(w.autocorrelation)
    outside = int(np.sum(np.abs(w.autocorrelation) > w.band99))
    in_lags = bool(channels * bdtrc(outside - 1, lags, 0.01) < ALARMING_P)
    depends = bool(channels * by_chance(d.p_value for d in w.dependences) < ALARMING_P)
    on = [plain(d.condition) for d in w.dependences if d.p_value < ALARMING_P]
    parts = ["from reading to reading"] * in_lags + [f"depends on {listed(on)}"] * depends
    return f"{w.channel} ({' and '.join(parts)})" if parts else ""


def _signatures(c: Comparison):
    if not c.signatures:
        return "No effect of the library acts on these measurements.", None
    best = max(c.signatures, key=lambda s: abs(s.cosine))
    failing = bool(_failing(c) or _pulled(c))
    if abs(best.cosine) < ALARMING_COSINE or not failing:
        rest = (
            "no channel fails; whether a tolerance hides it, diagnose says"
            if not failing
            else "no single known effect looks like the residual"
        )
        return f"The nearest effect is {plain(best.name)} with a cosine of {best.cosine:.2f}; {rest}.", False
    return (
        f"The residual looks most like {plain(best.name)} (cosine {best.cosine:.2f}); diagnose says whether that is "
        "enough.",
        True,
    )


def _failing(c: Comparison) -> ChannelScore | None:
    """The channel that is named as failing, where it does fail."""
    return next((score for score in channels_off(c) if score.channel == c.failing), None)


# ---- diagnosis ------------------------------------------------------------------------------------------------------


def verdict_sentence(d: Diagnosis) -> str:
    """The verdict of a diagnosis in plain words."""
    names = [plain(name) for name in d.names]
    return {
        "nothing_missing": lambda: _nothing_missing(d),
        "effect": lambda: f"What is missing is {names[0]}{_size(d)}.",
        "group": lambda: f"What is missing is one of {listed(names, 'or')}; these data cannot tell which.{_besides(d)}",
        "pair": lambda: f"Two effects are missing together: {listed(names)}.",
        "several": lambda: f"{_COUNTS.get(len(names), len(names))} effects are missing together: {listed(names)}.",
        "partial": lambda: f"{_explains(names)} a part{_size(d)}{_rest(d)}.{_besides(d)}",
        "none_of_these": lambda: _none_of_these(d),
        "cannot_tell": lambda: _cannot_tell(d),
        "convention": lambda: " ".join(d.conventions) or _convention(names),
    }[d.verdict]() + f" Probability {probability_text(d.probability)}."


def _convention(names: list[str]) -> str:
    return f"The data look as if read by another convention: {listed(names)}. No effect is named until this is settled."


_COUNTS = {3: "Three", 4: "Four", 5: "Five", 6: "Six"}


def _nothing_missing(d: Diagnosis) -> str:
    plainly = "Nothing is missing that these data would show plainly"
    if d.p_nothing_missing >= LIKELY:
        return f"{plainly}: the model with its tolerances explains them."
    return f"{plainly}; something smaller probably is{_likely(d, ': likeliest ')}."


def _explains(names: list[str]) -> str:
    said = listed(names)
    return f"{said[0].upper()}{said[1:]} {'explains' if len(names) == 1 else 'together explain'}"


def _rest(d: Diagnosis) -> str:
    return ", but something unknown remains" if d.p_something_remains >= LIKELY else ""


def _besides(d: Diagnosis) -> str:
    """The further effects of which only a group of names is known."""
    groups = [listed(map(plain, (name, *others)), "or") for name, others in d.alternatives.items()]
    return "".join(f" Besides, one of {group} is there; these data cannot tell which." for group in groups)


def _size(d: Diagnosis) -> str:
    leader = leading(d)
    if len(d.names) > 1 or leader is None or not leader.parameters:
        return ""
    sizes = (f"{plain(n)} {interval(e)}{_unlearned(n in leader.as_believed)}" for n, e in leader.parameters.items())
    return f": {listed(sizes)}"


def _unlearned(as_believed: bool) -> str:
    return ", of which these data tell next to nothing" if as_believed else ""


def set_words(words: str) -> str:
    """An explanation, so that it is not taken for the probability of one of its parts."""
    alone = {"nothing": "nothing missing", "something unknown": "something unknown alone (none of these)"}
    return alone.get(words, plain(words) if " + " in words else f"{plain(words)} alone")


def leading(d: Diagnosis) -> Ranked | None:
    """The ranked effect that the verdict is about, else the most probable one."""
    by_name = {ranked.name: ranked for ranked in d.ranking}
    ordered = sorted(d.ranking, key=lambda ranked: -ranked.probability)
    return next((by_name[name] for name in d.names if name in by_name), ordered[0] if ordered else None)


def _none_of_these(d: Diagnosis) -> str:
    if _by_sealed_rows(d):
        return "Something is missing: the fitted rows do not show it, but rows that no fit has seen disagree."
    beside = _likely(d, ", alone or beside ")
    return f"Something is missing that is none of the {len(d.ranking)} effects tried{beside}{_where(d)}."


def _by_sealed_rows(d: Diagnosis) -> bool:
    """Whether only the sealed rows speak for something missing."""
    shown = isclose(d.probability, d.p_something_remains)
    return d.sealed is not None and not d.sealed.holds and not shown


def _where(d: Diagnosis) -> str:
    channel = d.residual_signature.get("channel")
    return f"; look at {channel}" if channel else ""


def _cannot_tell(d: Diagnosis) -> str:
    if _of_nothing(d):
        return "These data cannot tell whether something is missing."
    return f"Something is missing, but these data cannot tell what{_likely(d, ': likeliest is ')}."


def _likely(d: Diagnosis, before: str) -> str:
    """The effect that is likelier there than not, and what it lacks for its name to be said; empty where none is."""
    leader = leading(d)
    if leader is None or not LIKELY <= leader.probability < d.sure:
        return ""
    return (
        f"{before}{plain(leader.name)} (there with {probability_text(leader.probability)}; a name is said from "
        f"{probability_text(d.sure)} on)"
    )


def _of_nothing(d: Diagnosis) -> bool:
    """Whether the probability of "cannot tell" is that of nothing."""
    return isclose(d.probability, d.p_nothing_missing)


def meaning(d: Diagnosis) -> str:
    """What the probability of the verdict is the probability of."""
    verb = "is" if len(d.names) == 1 else "are"
    there = f"that {listed(map(plain, d.names))} {verb} there, alone or with others"
    what = {
        "nothing_missing": lambda: (
            f"that nothing is missing which these data would show by odds of {odds_text(PLAIN)}; that nothing at all "
            f"is missing has {probability_text(d.p_nothing_missing)}"
        ),
        "effect": lambda: there,
        "group": lambda: "that at least one of these effects is there",
        "pair": lambda: there,
        "several": lambda: there,
        "partial": lambda: there,
        "none_of_these": lambda: _meaning_of_none(d),
        "cannot_tell": lambda: "that nothing is missing" if _of_nothing(d) else "that something is missing",
        "convention": lambda: "that the data follow another convention than campaign.toml says",
    }[d.verdict]()
    also = f"; that one of each further group is there, at least {percent(d.sure)}" if d.alternatives else ""
    return f"The probability is that of the statement {what}{also}."


def _meaning_of_none(d: Diagnosis) -> str:
    if _by_sealed_rows(d):
        return "that noise alone does not make the sealed rows disagree so much"
    return "that something is there which no effect describes, alone or beside effects"


def bound_sentences(d: Diagnosis) -> tuple[str, ...]:
    """Parameters of what is named that end on a bound."""
    return tuple(
        f"{sentence(f'{listed(map(plain, r.at_bound))} of {plain(r.name)}')[:-1]} "
        f"{'ends' if len(r.at_bound) == 1 else 'end'} on a bound of what is possible: the size is not to be believed, "
        "and its law may have another form."
        for r in d.ranking
        if r.name in d.names and r.at_bound
    )


def sealed_sentence(d: Diagnosis) -> str:
    """What the rows that no fit has seen say of the final model."""
    if d.sealed is None:
        return "There are none: all rows were fitted, so that prediction was not tested on rows that no fit has seen."
    return (
        f"{d.sealed.n} rows were sealed and opened once, after every fit and choice. Where they lie: {d.sealed.tests}. "
        f"{_holds(d.sealed)} there: chi²/n = {chi2_text(d.sealed.chi2_per_n)}; noise and what the fit leaves uncertain "
        f"give as much or more with {p_text(d.sealed.p_value)}."
    )


def _holds(sealed: Sealed) -> str:
    if not sealed.holds:
        return "The model does not hold"
    return "The model holds" if sealed.p_value >= UNSURE else "The model can hardly be said to hold"


def left_out_sentence(d: Diagnosis) -> str:
    """Whether prediction was tested on conditions left out of the fit; empty where nothing was tried."""
    if not d.ranking:
        return ""
    if all(r.held_out_chi2_per_n_before is None for r in d.ranking):
        return "The fitted conditions have no regions to leave out: prediction beyond these conditions was not tested."
    return "Left out: chi²/n of conditions that were left out of the fit, one region after the other, and predicted."


def power_sentence(d: Diagnosis) -> str:
    """How often these data would notice an effect outside the library."""
    if not d.abstention_power:
        return "The power to say “none of these” was not computed for these data."
    said = listed(f"{percent(share)} of those of {size:g} u" for size, share in sorted(d.abstention_power.items()))
    weak = max(d.abstention_power.values()) < LIKELY
    closing = (
        " A definite name from data this weak must not be trusted: a set like this cannot abstain." if weak else ""
    )
    return f"Of unknown smooth discrepancies these data would flag {said}, u being that of one reading.{closing}"


def open_questions(d: Diagnosis) -> tuple[str, ...]:
    """What would show the likeliest effects of which these data are not sure."""
    open_ones = [r for r in d.ranking if r.shown_by and OPEN <= r.probability < d.sure]
    return tuple(
        f"Whether {plain(r.name)} is there ({percent(r.probability)}) would be shown by: {listed(r.shown_by, 'or')}."
        for r in open_ones[:OPEN_ONES]
    )


def conclusions(d: Diagnosis) -> tuple[str, ...]:
    """What these data allow to be concluded, and then what they do not; nothing before conventions are settled."""
    return () if d.verdict == "convention" else _can_be_said(d) + _cannot_be_said(d)


def _can_be_said(d: Diagnosis) -> tuple[str, ...]:
    if d.p_nothing_missing > IMPROBABLE or d.verdict == "nothing_missing":
        return ()
    said = ["It can be concluded that the model with its tolerances does not explain these data."]
    best = min((r for r in d.ranking if r.parameters), key=lambda r: r.chi2_per_n_after, default=None)
    if best is not None and best.chi2_per_n_after > POOR:
        left = chi2_text(best.chi2_per_n_after)
        said.append(
            f"The effects of the library do not explain them either: the best, with {plain(best.name)}, leaves chi²/n "
            f"= {left}."
        )
    return tuple(said)


def _cannot_be_said(d: Diagnosis) -> tuple[str, ...]:
    said = []
    if d.verdict == "cannot_tell" and not _of_nothing(d):
        said.append("It cannot be concluded which effect it is: no name or group of names is sure enough.")
    if d.names and d.p_none_of_these > NEGLIGIBLE:
        said.append(
            f"Instead of {listed(map(plain, d.names))} there may be one unknown law and no effect, with probability "
            f"{probability_text(d.p_none_of_these)}."
        )
    missed = {size: 1 - share for size, share in d.abstention_power.items() if share < LIKELY}
    if missed:
        size = max(missed)
        said.append(
            f"Nor can these data abstain: {percent(missed[size])} of unknown discrepancies of {size:g} u would be "
            "overlooked or taken for a known effect, so that a name from them alone is not to be believed."
        )
    if d.sealed is None:
        said.append("Nothing was checked on rows that no fit has seen: none are sealed.")
    if d.ranking and all(r.held_out_chi2_per_n_before is None for r in d.ranking):
        said.append(left_out_sentence(d))
    return tuple(said)


# ---- ledger ---------------------------------------------------------------------------------------------------------


_AFTER_THE_WALK = {
    "nothing_missing": " Nothing more is missing that these data would show plainly.",
    "none_of_these": " What is left is something that no effect of the library describes.",
    "cannot_tell": " What is left these data cannot tell.",
}


def ledger_sentence(ledger: Ledger) -> str:
    """Where the walk stands."""
    kept = [step for step in ledger.steps if step.decision != "refused"]
    refused = [step for step in ledger.steps if step.decision == "refused"]
    first, last = kept[0], kept[-1]
    left_out = all(step.held_out_chi2_per_n is not None for step in (first, last))
    start, now = (step.held_out_chi2_per_n if left_out else step.chi2_per_n for step in (first, last))
    where = "conditions left out of the fit" if left_out else "the fitted rows (no conditions could be left out)"
    added = listed(plain(step.effect) for step in kept[1:]) or "nothing yet"
    goal = "at the goal" if now <= ledger.goal else "above the goal"
    moved = "fell" if now < start else "went"
    change = "stands at" if last is first else f"{moved} from chi²/n = {chi2_text(start)} to"
    said = f"Added: {added}. The error on {where} {change} {chi2_text(now)}, {goal} of {ledger.goal:g} (noise: 1)."
    said += f" Refused: {listed(plain(step.effect) for step in refused)}." if refused else ""
    return said + _AFTER_THE_WALK.get(last.verdict, "")


def size_words(step: LedgerStep) -> str:
    """Parameters of a step with their 90 % intervals; empty for the start."""
    return "; ".join(f"{plain(name)} {_short(e)}" for name, e in step.parameters.items())


def _short(e) -> str:
    return f"{estimated(e)} [{bounds(e)}]"
