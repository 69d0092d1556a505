"""Where does the model fail? The model with its tolerances fitted, against every row of the campaign."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from effects.base import Effect
from workbench.compare import views
from workbench.data.checks import checks_of
from workbench.data.column_units import unit_inside
from workbench.data.stack import rows_of, stacked
from workbench.data.table import Campaign
from workbench.findings import ChannelScore, Comparison, Pull, SignatureMatch
from workbench.likelihood.bench import Bench, bench_of, sealed_tables
from workbench.likelihood.noise import measured_noise
from workbench.likelihood.nuisance import DeclaredError, InstrumentError, TolerancedInput
from workbench.likelihood.own_errors import left_open_by_base
from workbench.likelihood.signatures import candidates, nearest, signatures_of
from workbench.likelihood.whitening import whitener
from workbench.models.model import Model

BLOCK = 50_000  # rows that the model is asked for at once
FAILS = 3.0  # standard deviations of chi2 above its expectation
LARGE_PULL = 3.0


def compare(
    model: Model,
    campaign: Campaign,
    library: Mapping[str, type[Effect]],
    progress: Callable[[str], None] = lambda words: None,
) -> Comparison:
    """The comparison of a model with a campaign.

    Raises:
        WorkbenchError: the campaign cannot be used, see ``workbench.likelihood.bench``.
    """
    progress("fitting tolerances and calibrations")
    bench = bench_of(model, campaign, library)
    return comparison_of(bench, library, progress)


def comparison_of(bench: Bench, library: Mapping[str, type[Effect]], progress=lambda words: None) -> Comparison:
    """The comparison of a bench that was fitted already."""
    scores = scoreboard(bench)
    pulls = pulls_of(bench)
    every = views.channel_views(bench)
    signatures = signatures_of(bench, candidates(bench, library), progress)
    titles = {name: variants[0].effect.title for name, variants in signatures.found.items()}
    matches = nearest(bench, signatures)
    held = [s for s in scores if s.held_out_chi2_per_n is not None]
    maps = [views.regime_map(v) for v in every]
    return Comparison(
        campaign=bench.campaign.id,
        model=bench.model.base.name,
        effects=bench.model.names,
        failing=failing(scores, pulls),
        chi2_per_n=_mean([(s.chi2_per_n, s.n) for s in scores]),
        held_out_chi2_per_n=_mean([(s.held_out_chi2_per_n, s.n) for s in held]) if held else None,
        scoreboard=scores,
        pulls=pulls,
        fits=tuple(views.channel_fit(v) for v in every),
        regimes=tuple(m for m in maps if m is not None),
        orders=tuple(s for v in every for s in views.order_spectra(v)),
        scalings=tuple(s for v in every for s in views.scalings(v)),
        parities=tuple(p for v in every for p in views.parities(v)),
        sequences=tuple(s for v in every for s in views.sequences(v)),
        whiteness=tuple(views.whiteness(v) for v in every),
        signatures=tuple(SignatureMatch(n, titles[n], c) for n, c in matches.items()),
        checks=checks_of(bench.campaign) + bench.model.base.doubts(bench.model.design),
        complaints=bench.complaints,
        provenance=dict(bench.campaign.file_hashes),
        predictions=bench.campaign.predictions,
    )


def scoreboard(bench: Bench) -> tuple[ChannelScore, ...]:
    """V0: one score a channel over all rows of the campaign, fitted or not; the model is asked block by block, and of
    tables that are too long for a fit not what the laws of its effects leave open."""
    stack = stacked(sealed_tables(bench.campaign).tables)
    predictor = bench.fit.predictor.on(stack)
    nominal, fitted = (_in_blocks(predictor, x) for x in (predictor.start, bench.null.x))
    if stack.size == bench.stack.size:
        white, noise = bench.white, bench.noise
    else:
        stack = replace(stack, left_open=left_open_by_base(bench.model, stack))
        noise = measured_noise(stack, nominal)
        white = whitener(stack, noise)
    squares = white(stack.y - fitted) ** 2
    before = white(stack.y - nominal) ** 2
    scores = [
        replace(_score(stack, c, squares, before, fitted, white.sigma / noise.inflation), noise_dof=float(known.dof))
        for c, known in zip(stack.channels, noise.channels)
    ]
    excess = np.array([max(s.chi2_per_n - 1.0, 0.0) * s.n for s in scores])
    shares = excess / excess.sum() if excess.sum() > 0 else excess
    return tuple(replace(s, excess_share=float(share)) for s, share in zip(scores, shares))


def _in_blocks(predictor, x: np.ndarray) -> np.ndarray:
    model = predictor.model_at(x)
    answers = []
    for table in predictor.stack.tables:
        parts = [model.answers(rows_of(table, slice(k, k + BLOCK))) for k in range(0, table.rows, BLOCK)]
        answers.append({name: np.concatenate([part[name] for part in parts]) for name in table.responses})
    return predictor.stack.vector(answers)


def _score(stack, channel, squares, before, fitted, sigma_of_noise) -> ChannelScore:
    rows, held = channel.rows, stack.tables[channel.table].held_out
    error = (stack.y[rows] - fitted[rows]) / channel.scale
    sigma = sigma_of_noise[rows] / channel.scale
    size = np.sqrt(np.mean((stack.y[rows] / channel.scale) ** 2))
    rms = float(np.sqrt(np.mean(error**2)))
    return ChannelScore(
        channel=channel.name,
        unit=channel.unit,
        n=channel.size,
        rms_error=rms,
        rms_error_percent=float(100 * rms / size) if size > 0 else float("nan"),
        bias=float(np.mean(error)),
        chi2_per_n=float(np.mean(squares[rows][~held])) if (~held).any() else float("nan"),
        chi2_per_n_nominal=float(np.mean(before[rows][~held])) if (~held).any() else float("nan"),
        held_out_chi2_per_n=float(np.mean(squares[rows][held])) if held.any() else None,
        noise_floor=float(np.sqrt(np.mean(sigma**2))),
        u_val=float(np.sqrt(np.mean(sigma**2))),
        excess_share=0.0,
    )


def pulls_of(bench: Bench) -> tuple[Pull, ...]:
    """V1: shift over sigma of everything the campaign declares as uncertain, and of parameters fitted again."""
    declared = [_pull(n, float(z)) for n, z in zip(bench.fit.predictor.nuisances, bench.null.x)]
    names = bench.fit.predictor.names[len(declared) :]
    return tuple(declared) + tuple(
        Pull(n, float(z), 1.0, "of its prior", "effect") for n, z in zip(names, bench.null.x[len(declared) :])
    )


def _pull(nuisance, z: float) -> Pull:
    if isinstance(nuisance, TolerancedInput):
        tolerance = nuisance.tolerance
        unit = "relative" if tolerance.relative else unit_inside(nuisance.name)
        return Pull(nuisance.name, z, tolerance.sigma, unit, "tolerance", tolerance.source)
    assert isinstance(nuisance, (InstrumentError, DeclaredError))
    unit = "relative" if nuisance.systematic.kind == "gain" else unit_inside(nuisance.name)
    return Pull(nuisance.name, z, nuisance.systematic.sigma, unit, "instrument")


def failing(scores: tuple[ChannelScore, ...], pulls: tuple[Pull, ...]) -> str:
    """Channel with the largest share of the excess; where only pulls are too large, the one that was furthest off
    before."""
    loud = [s for s in scores if (s.chi2_per_n - 1) * np.sqrt(s.n / 2) > FAILS]
    if loud:
        return max(loud, key=lambda s: s.excess_share).channel
    if any(abs(p.pull) > LARGE_PULL for p in pulls if p.what != "effect"):
        return max(scores, key=lambda s: (s.chi2_per_n_nominal - 1) * s.n).channel
    return ""


def _mean(pairs: list[tuple[float, int]]) -> float:
    total = sum(n for _, n in pairs)
    return float(sum(v * n for v, n in pairs) / total) if total else float("nan")
