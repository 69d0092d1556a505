"""What a comparison and a diagnosis found, as plain values: the only input of the reports and of the JSON files.

Numbers are in the unit that stands beside them (the unit of the data file), fit for people. A residual is measured
minus model. "u" is the standard uncertainty of one reading after the noise was measured from repeats; a residual
"in u" is divided by it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from workbench.believed import NAMED


@dataclass(frozen=True)
class Axis:
    """Something along which data lie: ``Axis("speed", "rpm")``; the unit is empty for a pure number."""

    name: str
    unit: str = ""


@dataclass(frozen=True)
class ChannelScore:
    """One channel. Errors [unit]; rms_error_percent of the channel's rms reading.

    excess_share: share of this channel in the sum of chi2 - n over all channels that exceed it
    noise_floor: rms error that noise alone leaves [unit];  u_val: rms of sqrt(u_D^2 + u_num^2) [unit]
    held_out_chi2_per_n: None where nothing is held out;  noise_dof: degrees of freedom of the size of the noise
    """

    channel: str
    unit: str
    n: int
    rms_error: float
    rms_error_percent: float
    bias: float
    chi2_per_n: float
    chi2_per_n_nominal: float
    held_out_chi2_per_n: float | None
    noise_floor: float
    u_val: float
    excess_share: float
    noise_dof: float | None = None


@dataclass(frozen=True)
class Pull:
    """How far the fit moved one declared uncertainty.

    pull: shift / sigma;  sigma: as declared, relative or [unit];  what: "tolerance", "instrument" or "effect"
    """

    name: str
    pull: float
    sigma: float
    unit: str
    what: str
    source: str = ""


@dataclass(frozen=True, eq=False)
class ChannelFit:
    """A channel against its natural axis, (n,): reading, model at nominal inputs, model with fitted inputs, u.

    series: label of each row by which the lines are told apart ("shunt 1 ohm"); held_out: rows no fit has seen
    """

    channel: str
    unit: str
    axis: Axis
    x: np.ndarray
    measured: np.ndarray
    nominal: np.ndarray
    fitted: np.ndarray
    u: np.ndarray
    held_out: np.ndarray
    series: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class RegimeMap:
    """Mean residual in u of the cells of a grid; NaN where no reading lies.

    x_edges (nx + 1,), y_edges (ny + 1,): cells; y is None for one condition only, and then ny is 1
    mean, p_value, count: (ny, nx); p_value by permutation of the residuals
    """

    channel: str
    x: Axis
    y: Axis | None
    x_edges: np.ndarray
    y_edges: np.ndarray
    mean: np.ndarray
    p_value: np.ndarray
    count: np.ndarray


@dataclass(frozen=True, eq=False)
class OrderSpectrum:
    """Residual amplitude of every order per revolution [unit], (k,).

    floor: amplitude that noise alone stays below in 99 of 100 spectra
    classes: family of each order, from ORDER_CLASSES
    part: of a channel that was turned both ways, what is "the same both ways" or "opposite both ways"; empty otherwise
    """

    channel: str
    unit: str
    orders: np.ndarray
    amplitude: np.ndarray
    floor: np.ndarray
    classes: tuple[str, ...]
    part: str = ""

    @property
    def title(self) -> str:
        return f"{self.channel}, {self.part}" if self.part else self.channel


ORDER_CLASSES = ("native", "rotor", "stator", "emf", "other_emf", "encoder", "current", "imbalance", "other")


@dataclass(frozen=True)
class Scaling:
    """Residual ~ quantity ** exponent, with its 90 % interval.

    meaning: the law that the exponent speaks for, empty where the interval allows several;  n: levels of the quantity
    """

    channel: str
    quantity: str
    exponent: float
    low90: float
    high90: float
    n: int
    meaning: str = ""


@dataclass(frozen=True)
class Parity:
    """Rms of the odd and the even part of the residual in u under a reversal, and what noise alone would give."""

    channel: str
    reversal: str
    odd: float
    even: float
    floor: float


@dataclass(frozen=True, eq=False)
class Sequence:
    """Residual in u in the order of acquisition, (n,).

    axis: Axis("sample"), time or a temperature;  scan: number of each row's scan
    trend: residual in u from the first to the last by a straight line;  p_value: by permutation
    """

    channel: str
    axis: Axis
    x: np.ndarray
    residual: np.ndarray
    scan: np.ndarray
    trend: float
    p_value: float


@dataclass(frozen=True)
class Dependence:
    """Permutation p-value of the residual on one condition."""

    condition: str
    p_value: float


@dataclass(frozen=True, eq=False)
class Whiteness:
    """Autocorrelation of the residual within scans at lags 1, 2, ... (k,) after whitening, its 99 % band."""

    channel: str
    autocorrelation: np.ndarray
    band99: float
    dependences: tuple[Dependence, ...] = ()


@dataclass(frozen=True)
class SignatureMatch:
    """Cosine between the residual and what an effect would leave, both freed of what tolerances can explain."""

    name: str
    title: str
    cosine: float


@dataclass(frozen=True)
class Prediction:
    """Of a quantity [unit] of a device that is not measured yet, stored before it is compared.

    of: which device, in words;  low, high: interval [unit];  given: what the value supposes
    """

    of: str
    quantity: str
    unit: str
    value: float
    low: float
    high: float
    given: str


@dataclass(frozen=True, eq=False)
class Comparison:
    """All that ``compare`` found. Views hold one entry a channel where they can be had for it, and are empty otherwise.

    failing: name of the channel with the largest share of the excess, empty when none fails
    effects: names of the effects that the model already has
    chi2_per_n, held_out_chi2_per_n: over all channels
    """

    campaign: str
    model: str
    effects: tuple[str, ...]
    failing: str
    chi2_per_n: float
    held_out_chi2_per_n: float | None
    scoreboard: tuple[ChannelScore, ...]
    pulls: tuple[Pull, ...]
    fits: tuple[ChannelFit, ...]
    regimes: tuple[RegimeMap, ...] = ()
    orders: tuple[OrderSpectrum, ...] = ()
    scalings: tuple[Scaling, ...] = ()
    parities: tuple[Parity, ...] = ()
    sequences: tuple[Sequence, ...] = ()
    whiteness: tuple[Whiteness, ...] = ()
    signatures: tuple[SignatureMatch, ...] = ()
    checks: tuple[str, ...] = ()
    complaints: tuple[str, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)
    predictions: tuple[Prediction, ...] = ()


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter: value, standard uncertainty and 90 % interval [unit]."""

    value: float
    std: float
    low90: float
    high90: float
    unit: str


@dataclass(frozen=True)
class Ranked:
    """One effect that was tried. probability: that it is there, alone or with others; where something unknown is
    likely, it may only be what its shape lacks of the true law, see ``explore.beside_the_unknown``.

    log_evidence: ln p of the fitted rows gained by its best explanation over nothing [nats]
    parameters: of that explanation;  at_bound: those that end on a bound of what is possible
    as_believed: those of which the readings tell next to nothing, so that their interval is what was believed before
    shown_by: measurements, calibrations among them, that show such an effect
    """

    name: str
    title: str
    probability: float
    log_evidence: float
    parameters: Mapping[str, Estimate]
    chi2_per_n_before: float
    chi2_per_n_after: float
    held_out_chi2_per_n_before: float | None
    held_out_chi2_per_n_after: float | None
    at_bound: tuple[str, ...] = ()
    as_believed: tuple[str, ...] = ()
    shown_by: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class SizePosterior:
    """Density of a parameter of the named effect over a grid of values [unit], (k,) each, and its prior density."""

    effect: str
    parameter: str
    unit: str
    values: np.ndarray
    density: np.ndarray
    prior: np.ndarray
    estimate: Estimate


@dataclass(frozen=True)
class Sealed:
    """Rows that no fit and no choice has seen, opened once. p_value: of their chi2 by chance under the final model

    tests: what they test, in words;  holds: whether the model holds there
    """

    n: int
    chi2_per_n: float
    p_value: float
    tests: str
    holds: bool


@dataclass(frozen=True)
class DetectionLimit:
    """The smallest size of an effect that these data would have shown."""

    name: str
    title: str
    parameter: str
    value: float
    unit: str


@dataclass(frozen=True)
class NextMeasurement:
    """A measurement that would help: where, its gain of evidence [nats] and its declared cost."""

    kind: str
    words: str
    conditions: Mapping[str, object]
    gain_nats: float
    cost: float


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """All that ``diagnose`` found.

    effects: names of the effects that the model already has
    verdict: nothing_missing, effect, group, pair, several, partial, none_of_these, cannot_tell or convention
    probability: that the sentence of the verdict is true: that the names are there (of a group: one of them), that
        nothing is missing which these data would show plainly, that something is there that no effect is
    p_nothing_missing: P(no effect and no unknown function);  p_none_of_these: P(an unknown function and no effect)
    p_something_remains: P(an unknown function, with or without effects);  p_sets: of the leading explanations, by words
    alternatives: of a name, what may stand for it;  sure: probability from which a name is printed on this bench
    abstention_power: share of unknown discrepancies that these data would flag, by their size in u, such as
        {3.0: 0.4, 10.0: 1.0}
    fix: of a convention, the text for campaign.toml;  conventions: what the columns look like, a sentence each
    checks: of the data alone, before any model;  not_tried: effects without an answer here, and why
    before, after: the failing channel without and with the leading effect, the same rows
    contradictions: declared tolerances that speak against what is named, and sealed rows that took a name back, a
        sentence each
    """

    campaign: str
    model: str
    verdict: str
    names: tuple[str, ...]
    probability: float
    effects: tuple[str, ...] = ()
    ranking: tuple[Ranked, ...] = ()
    p_nothing_missing: float = 0.0
    p_none_of_these: float = 0.0
    p_something_remains: float = 0.0
    p_sets: Mapping[str, float] = field(default_factory=dict)
    alternatives: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    sure: float = NAMED
    abstention_power: Mapping[float, float] = field(default_factory=dict)
    detection_limits: tuple[DetectionLimit, ...] = ()
    next_measurements: tuple[NextMeasurement, ...] = ()
    residual_signature: Mapping[str, object] = field(default_factory=dict)
    sealed: Sealed | None = None
    seed: int = 0
    wall_s: float = 0.0
    before: ChannelFit | None = None
    after: ChannelFit | None = None
    posteriors: tuple[SizePosterior, ...] = ()
    complaints: tuple[str, ...] = ()
    checks: tuple[str, ...] = ()
    not_tried: tuple[str, ...] = ()
    fix: str = ""
    conventions: tuple[str, ...] = ()
    contradictions: tuple[str, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class LedgerStep:
    """One row of the ledger. step 0 is the model before any effect; decision: "start", "accepted" or "refused".

    rms_error, noise_floor: per channel [unit of the channel];  rms_error_percent: of the rms of the readings
    held_out_chi2_per_n: of conditions left out of the fit, region by region; None where there are no regions
    """

    step: int
    effect: str
    title: str
    decision: str
    parameters: Mapping[str, Estimate]
    log_evidence_gain: float
    chi2_per_n: float
    held_out_chi2_per_n: float | None
    rms_error: Mapping[str, float]
    noise_floor: Mapping[str, float]
    units: Mapping[str, str]
    verdict: str = ""
    reason: str = ""
    rms_error_percent: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class FinalParameter:
    """A number of the final model. owner: its effect, ``input`` or ``instrument``; the latter are shifts from the
    drawing and from a right reading, in % or in their unit"""

    owner: str
    name: str
    estimate: Estimate


@dataclass(frozen=True)
class LearnedAt:
    """Where a response of a kind of measurement was fitted.

    channel: ``back_emf.voltage``;  conditions: name -> low and high of the fitted rows, unit
    """

    channel: str
    rows: int
    chi2_per_n: float
    conditions: Mapping[str, tuple[float, float, str]]


@dataclass(frozen=True)
class Ledger:
    """The steps in their order; goal: chi2/n at which the walk ends.

    parameters: of the final model;  ranges: where it was learned
    """

    campaign: str
    model: str
    steps: tuple[LedgerStep, ...]
    goal: float = 1.2
    parameters: tuple[FinalParameter, ...] = ()
    ranges: tuple[LearnedAt, ...] = ()
    provenance: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class ValidatedChannel:
    """How well one channel of new data was predicted, without anything of the device being fitted to them.

    n: rows;  rms_error, bias: reading minus prediction [unit], of the rows with a prediction
    chi2_per_n: squared residual over the noise of the readings, 1 for a model without error
    share_in_90: share of all rows inside the predicted 90 % band;  outside_range: share of rows at conditions beyond
    those that the model was learned at;  no_answer: rows where the model has no steady state, outside every band
    outside_*: of the rows beyond the learned conditions, None where there are none
    """

    channel: str
    unit: str
    n: int
    rms_error: float
    bias: float
    chi2_per_n: float
    share_in_90: float
    outside_range: float
    no_answer: int = 0
    outside_rms_error: float | None = None
    outside_chi2_per_n: float | None = None
    outside_share_in_90: float | None = None


@dataclass(frozen=True, eq=False)
class PredictedChannel:
    """Readings of a channel and what two models predict for them [unit] (n,); NaN where one has no steady state.

    *_half: half width of the predicted 90 % band;  outside: rows beyond the learned conditions
    """

    channel: str
    unit: str
    axis: Axis
    x: np.ndarray
    series: tuple[str, ...]
    measured: np.ndarray
    corrected: np.ndarray
    corrected_half: np.ndarray
    base: np.ndarray
    base_half: np.ndarray
    outside: np.ndarray


@dataclass(frozen=True, eq=False)
class Validation:
    """A model file applied to a campaign that it was not learned from.

    campaign: of the new data;  learned_from: campaign of the model file
    corrected, base: with what the file knows, and the device as drawn
    calibrations, base_calibrations: of the new instruments, found with the one and with the other
    range_left: one sentence for each condition
    complaints: what limits the conclusions
    """

    campaign: str
    model: str
    learned_from: str
    effects: tuple[str, ...]
    corrected: tuple[ValidatedChannel, ...]
    base: tuple[ValidatedChannel, ...]
    predictions: tuple[PredictedChannel, ...]
    calibrations: tuple[Pull, ...]
    base_calibrations: tuple[Pull, ...]
    range_left: tuple[str, ...]
    complaints: tuple[str, ...]
    provenance: Mapping[str, str]
