"""The numbers of the nine views: where does the model fail, and how does the residual look there?

Residual: (measured - model) / u, tolerances and calibrations at their most probable values, u after the noise was
measured.
"""

from __future__ import annotations

from collections.abc import Sequence as Sequence_
from dataclasses import dataclass
from functools import cached_property
from math import gcd

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import stdtrit

from effects.base import Effect
from workbench.data.column_units import for_people
from workbench.data.kinds import KINDS
from workbench.data.stack import Channel
from workbench.data.table import OPEN_CIRCUIT, Table
from workbench.findings import (
    Axis,
    ChannelFit,
    Dependence,
    OrderSpectrum,
    Parity,
    RegimeMap,
    Scaling,
    Sequence,
    Whiteness,
)
from workbench.likelihood.bench import Bench

SHUFFLES = 2000  # of a permutation test; the smallest p-value is 1/2001
SEED = 1863  # of the permutations
CELLS = 7  # of a map along an axis with many levels
LEVELS = 10  # up to so many different values a condition counts as set in levels
LAGS = 10
LARGEST_ORDER = 80
SHOWN_ROWS = 2000  # of a channel in a picture
# exponent -> law
CURRENT_LAWS = {0: "cogging or friction", 1: "torque constant or gain", 2: "reluctance", 3: "saturation"}
SPEED_LAWS = {0: "Coulomb friction or hysteresis", 1: "viscous or eddy", 2: "windage"}
SHUNT_LAWS = {0: "friction or viscous", -1: "force constant or gain", -2: "resistance in series"}  # of shunt + internal
IMPEDANCE_LAWS = {  # of the frequency; a force over a velocity
    "re": {-1: "Coulomb friction or hysteresis", 0: "viscous or circuit", 1: "quadratic drag"},
    "im": {-1: "stiffness", 1: "mass"},
}


@dataclass(frozen=True, eq=False)
class ChannelView:
    """One channel of a bench with its residuals; rows as fitted and scored."""

    bench: Bench
    channel: Channel
    nominal: np.ndarray
    fitted: np.ndarray

    @property
    def table(self) -> Table:
        return self.bench.stack.tables[self.channel.table]

    @cached_property
    def u(self) -> np.ndarray:
        return self.bench.white.sigma[self.channel.rows]

    @cached_property
    def measured(self) -> np.ndarray:
        return self.bench.stack.y[self.channel.rows]

    @cached_property
    def residual(self) -> np.ndarray:
        """In u (n,)."""
        return (self.measured - self.fitted) / self.u

    @cached_property
    def whitened(self) -> np.ndarray:
        """Residual freed of the correlation of neighbours, for tests (n,)."""
        full = np.zeros(self.bench.stack.size)
        full[self.channel.rows] = self.residual * self.u
        return self.bench.white(full)[self.channel.rows]

    @property
    def scale(self) -> float:
        return self.channel.scale

    @property
    def varying(self) -> list[str]:
        """Conditions that vary, natural axes of the kind first."""
        axes = KINDS[self.table.kind].axes
        names = [name for name, v in self.table.conditions.items() if np.ptp(v) > 0]
        return sorted(names, key=lambda n: (axes.index(n) if n in axes else len(axes), names.index(n)))


def channel_views(bench: Bench, x: np.ndarray | None = None, effects: Sequence_[Effect] = ()) -> list[ChannelView]:
    """One view a channel; x, effects: what "fitted" means, the null where they are not given."""
    predictor = bench.fit.predictor.on(bench.stack)
    fitted = predictor.predict(bench.null.x if x is None else x, effects)
    nominal = predictor.predict(predictor.start)
    return [ChannelView(bench, c, nominal[c.rows], fitted[c.rows]) for c in bench.stack.channels]


def axis_of(name: str) -> tuple[Axis, float]:
    """Axis of a condition as people read it, and the factor on its SI values."""
    unit, factor = for_people(name)
    return Axis(name, unit), factor


def channel_fit(view: ChannelView) -> ChannelFit:
    """A channel against its natural axis."""
    name = view.varying[0] if view.varying else next(iter(view.table.conditions))
    axis, factor = axis_of(name)
    step = -(-view.channel.size // SHOWN_ROWS)
    rows = slice(None, None, step)
    return ChannelFit(
        view.channel.name,
        view.channel.unit,
        axis,
        factor * view.table.conditions[name][rows],
        view.measured[rows] / view.scale,
        view.nominal[rows] / view.scale,
        view.fitted[rows] / view.scale,
        view.u[rows] / view.scale,
        view.table.held_out[rows],
        _series(view, name)[rows],
    )


def _series(view: ChannelView, along: str) -> tuple[str, ...]:
    """Label of each row by the conditions, other than the axis, that are set in levels."""
    parts = []
    for name in view.varying:
        values = np.round(view.table.conditions[name], 9)
        if name != along and len(np.unique(values)) <= LEVELS:
            parts.append([_level(name, value) for value in values])
    return tuple(", ".join(row) for row in zip(*parts)) if parts else ("",) * view.channel.size


def _level(name: str, value: float) -> str:
    axis, factor = axis_of(name)
    is_open = name == "shunt" and value >= OPEN_CIRCUIT
    return f"{name} open" if is_open else f"{name} {factor * value:g} {axis.unit}".strip()


def regime_map(view: ChannelView) -> RegimeMap | None:
    """V2: mean residual over the two natural axes, with a permutation p-value for every cell."""
    if not view.varying:
        return None
    names = view.varying[:2]
    edges = [_edges(view.table.conditions[name]) for name in names]
    cells = [
        np.clip(np.searchsorted(e, view.table.conditions[n], side="right") - 1, 0, len(e) - 2)
        for n, e in zip(names, edges)
    ]
    (x, x_factor) = axis_of(names[0])
    y, y_factor = axis_of(names[1]) if len(names) > 1 else (None, 1.0)
    shape = (len(edges[1]) - 1 if len(names) > 1 else 1, len(edges[0]) - 1)
    place = cells[0] + (cells[1] * shape[1] if len(names) > 1 else 0)
    mean, p_value, count = _cell_means(view, place, shape[0] * shape[1])
    y_edges = y_factor * edges[1] if len(names) > 1 else np.array([0.0, 1.0])
    return RegimeMap(
        view.channel.name,
        x,
        y,
        x_factor * edges[0],
        y_edges,
        mean.reshape(shape),
        p_value.reshape(shape),
        count.reshape(shape),
    )


def _edges(values: np.ndarray) -> np.ndarray:
    """Edges of cells, from the least to the greatest value: between levels where there are few, else at even shares of
    the rows."""
    levels = np.unique(np.round(values, 9))
    if len(levels) > LEVELS:
        return np.unique(np.quantile(values, np.linspace(0, 1, CELLS + 1)))
    between = 0.5 * (levels[1:] + levels[:-1])
    return np.concatenate([[values.min()], between, [values.max()]])


def _cell_means(view: ChannelView, place: np.ndarray, cells: int):
    """Mean residual of every cell; its p-value by random signs of the whitened residuals."""
    count = np.bincount(place, minlength=cells)
    member = (place[:, None] == np.arange(cells)) / np.maximum(count, 1)
    mean, tested = view.residual @ member, view.whitened @ member
    signs = np.random.default_rng(SEED).choice([-1.0, 1.0], (SHUFFLES, len(place)))
    larger = np.sum(np.abs((signs * view.whitened) @ member) >= np.abs(tested), axis=0)
    p_value = (1.0 + larger) / (SHUFFLES + 1.0)
    empty = count == 0
    return np.where(empty, np.nan, mean), np.where(empty, np.nan, p_value), count


def order_spectra(view: ChannelView) -> list[OrderSpectrum]:
    """V3: amplitude of every mechanical order of the residual, where full turns were scanned.

    Of a channel that was turned both ways the mean and half the difference of the two directions, each a spectrum: a
    loss is opposite both ways and would cancel in the mean.
    """
    angle = view.table.conditions.get("angle_mech")
    if angle is None or view.channel.size < 32:
        return []
    turns = [rows for rows in _scans(view.table) if np.ptp(angle[rows]) > 0.95 * 2 * np.pi and len(rows) >= 32]
    if not turns:
        return []
    orders = np.arange(1, min(LARGEST_ORDER, min(len(rows) for rows in turns) // 2))
    error = (view.measured - view.fitted) / view.scale
    waves = np.array([2 * np.mean(error[rows] * np.exp(-1j * np.outer(orders, angle[rows])), axis=1) for rows in turns])
    readings = sum(len(rows) for rows in turns)
    sigma = np.sqrt(np.mean(view.u**2)) / view.scale
    floor = np.full(len(orders), sigma * np.sqrt(4 * np.log(100) / readings))
    classes = order_classes(view, orders)
    return [
        OrderSpectrum(view.channel.name, view.channel.unit, orders, np.abs(wave), floor, classes, part)
        for part, wave in _by_direction(waves, np.array([_direction(view.table, rows) for rows in turns]))
    ]


def _by_direction(waves: np.ndarray, direction: np.ndarray) -> list[tuple[str, np.ndarray]]:
    """Mean wave (k,) of all turns (turns, k), or both parts where there are turns in both directions."""
    forward, backward = waves[direction > 0], waves[direction < 0]
    if not len(forward) or not len(backward):
        return [("", waves.mean(axis=0))]
    there, back = forward.mean(axis=0), backward.mean(axis=0)
    return [("the same both ways", 0.5 * (there + back)), ("opposite both ways", 0.5 * (there - back))]


def _direction(table: Table, rows: np.ndarray) -> float:
    """Of the turning in some rows: +1, -1, or 0 where the table does not say."""
    for name in ("direction", "speed"):
        if name in table.conditions:
            return float(np.sign(np.mean(table.conditions[name][rows])))
    return 0.0


def order_classes(view: ChannelView, orders: np.ndarray) -> tuple[str, ...]:
    """Family of each order: which part of the machine can make it."""
    device = view.bench.campaign.device
    slots, poles = int(device.get("slots", 0)), int(device.get("poles", 0))
    return tuple(_order_class(int(k), slots, poles, view.table.kind) for k in orders)


def _order_class(order: int, slots: int, poles: int, kind: str) -> str:
    if not slots or not poles:
        return "encoder" if order <= 2 else "other"
    pairs = poles // 2
    if kind == "back_emf":
        return "emf" if order % pairs == 0 and (order // pairs) % 2 == 1 else "encoder" if order <= 2 else "other_emf"
    if order % (slots * poles // gcd(slots, poles)) == 0:
        return "native"
    for step, name in ((slots, "rotor"), (poles, "stator"), (6 * pairs, "current"), (2 * pairs, "imbalance")):
        if order % step == 0:
            return name
    return "encoder" if order <= 2 else "other"


def _scans(table: Table) -> list[np.ndarray]:
    """Rows of each scan of each repeat, apart for the two directions."""
    direction = np.sign(table.conditions.get("direction", np.zeros(table.rows)))
    keys = np.column_stack([table.scan, table.repeat, direction])
    number = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    return [np.flatnonzero(number == value) for value in range(number.max() + 1)]


def scalings(view: ChannelView) -> list[Scaling]:
    """V4: exponent of the residual against every condition that is set in levels."""
    found = [
        _scaling(view, name) for name in view.varying if name not in ("direction", "angle_mech") and name[-2:] != "_T"
    ]
    return [scaling for scaling in found if scaling is not None]


def _scaling(view: ChannelView, name: str) -> Scaling | None:
    """Slope of ln A against ln q over levels q; A^2: mean square of the error less that of the noise."""
    sizes = np.abs(view.table.conditions[name]) + _in_series(view, name)
    levels = _levels(sizes[sizes > 0])
    error, rows = view.measured - view.fitted, []
    for level in levels:
        here = np.isclose(sizes, level, rtol=0.05)
        n = here.sum()
        power, noise = np.mean(error[here] ** 2), np.mean(view.u[here] ** 2)
        if n >= 3 and power - noise > 3 * noise * np.sqrt(2 / n):
            spread = 0.5 * np.sqrt(2 / n) * power / (power - noise)
            rows.append((np.log(level), 0.5 * np.log(power - noise), spread))
    if len(rows) < 3:
        return None
    x, y, spread = np.array(rows).T
    exponent, half = _slope(x, y, 1 / spread**2)
    axis, _ = axis_of(name)
    meaning = _meaning(view, name, exponent - half, exponent + half)
    return Scaling(view.channel.name, axis.name, exponent, exponent - half, exponent + half, len(rows), meaning)


def _levels(sizes: np.ndarray) -> np.ndarray:
    """Different sizes; readings within 5 % are one level."""
    levels: list[float] = []
    for size in np.unique(sizes):
        if not levels or size > 1.05 * levels[-1]:
            levels.append(float(size))
    return np.array(levels)


def _slope(x: np.ndarray, y: np.ndarray, weight: np.ndarray) -> tuple[float, float]:
    """Weighted slope and half of its 90 % interval, scatter about the line included."""
    x0, y0 = np.average(x, weights=weight), np.average(y, weights=weight)
    spread = np.sum(weight * (x - x0) ** 2)
    slope = float(np.sum(weight * (x - x0) * (y - y0)) / spread)
    chi2 = np.sum(weight * (y - y0 - slope * (x - x0)) ** 2) / (len(x) - 2)
    return slope, float(stdtrit(len(x) - 2, 0.95) * np.sqrt(max(chi2, 1.0) / spread))


def _meaning(view: ChannelView, name: str, low: float, high: float) -> str:
    """The law that an exponent speaks for; empty where the interval allows none or several."""
    inside = [words for power, words in _laws(view, name).items() if low <= power <= high]
    return inside[0] if len(inside) == 1 else ""


def _in_series(view: ChannelView, name: str) -> float:
    """What stands in series with a shunt: laws go with the whole resistance of the circuit."""
    return float(getattr(view.bench.model.design, "internal_resistance", 0.0)) if name == "shunt" else 0.0


def _laws(view: ChannelView, name: str) -> dict[int, str]:
    if name == "shunt":
        return SHUNT_LAWS
    if view.table.kind == "impedance" and name == "frequency":
        return IMPEDANCE_LAWS.get(view.channel.response, {})
    if name.startswith("i_"):
        return CURRENT_LAWS
    return SPEED_LAWS if name in ("speed", "velocity") and view.channel.response in ("torque", "force") else {}


def parities(view: ChannelView) -> list[Parity]:
    """V5: odd and even part of the residual under every reversal that was measured."""
    names = [n for n in view.varying if (view.table.conditions[n] > 0).any() and (view.table.conditions[n] < 0).any()]
    found = [_parity(view, name) for name in names if name == "direction" or not name.endswith(("_T", "angle_mech"))]
    return [parity for parity in found if parity is not None]


def _parity(view: ChannelView, name: str) -> Parity | None:
    value = view.table.conditions[name]
    places = np.column_stack(
        [_unit_range(np.abs(v) if _flips(n, name) else v) for n, v in view.table.conditions.items()]
    )
    places = np.column_stack([places, view.table.repeat * 10.0])
    plus, minus = np.flatnonzero(value > 0), np.flatnonzero(value < 0)
    apart, partner = cKDTree(places[minus]).query(places[plus])
    near = apart < 0.02
    if near.sum() < 4:
        return None
    there, back = view.residual[plus[near]], view.residual[minus[partner[near]]]
    rms = lambda r: float(np.sqrt(np.mean(r**2)))  # noqa: E731
    return Parity(view.channel.name, name, rms(0.5 * (there - back)), rms(0.5 * (there + back)), float(np.sqrt(0.5)))


def _flips(name: str, reversed_name: str) -> bool:
    """Conditions that change sign together with the reversed one."""
    return (
        name == reversed_name
        or (reversed_name == "direction" and name == "speed")
        or (reversed_name == "speed" and name == "direction")
        or (name.startswith("i_") and reversed_name.startswith("i_"))
    )


def _unit_range(v: np.ndarray) -> np.ndarray:
    return (v - v.min()) / (np.ptp(v) or 1.0)


def sequences(view: ChannelView) -> list[Sequence]:
    """V6: residual in the order of acquisition, and over time and temperatures where they vary."""
    along = [name for name in view.varying if name == "time" or name.endswith("_T")]
    sample = (Axis("sample"), np.arange(view.channel.size, dtype=float))
    found = [sample]
    for name in along:
        axis, factor = axis_of(name)
        found.append((axis, factor * view.table.conditions[name]))
    return [_sequence(view, axis, x) for axis, x in found]


def _sequence(view: ChannelView, axis: Axis, x: np.ndarray) -> Sequence:
    """Residual over x with the straight trend from the smallest to the largest x."""
    place = (x - x.mean()) / (np.ptp(x) or 1.0)
    found = float(place @ view.residual / (place @ place or 1.0))
    mixed = _permutations(view.whitened) @ place
    larger = int(np.sum(np.abs(mixed) >= abs(place @ view.whitened)))
    rows = slice(None, None, -(-view.channel.size // SHOWN_ROWS))
    p_value = (1 + larger) / (SHUFFLES + 1)
    return Sequence(view.channel.name, axis, x[rows], view.residual[rows], view.table.scan[rows], found, p_value)


def _permutations(values: np.ndarray) -> np.ndarray:
    """Many random orders of some values (SHUFFLES, n)."""
    return np.random.default_rng(SEED).permuted(np.tile(values, (SHUFFLES, 1)), axis=1)


def whiteness(view: ChannelView) -> Whiteness:
    """V7: autocorrelation of the whitened residual inside scans, and whether it still depends on a condition."""
    z = view.whitened
    lags = min(LAGS, max(view.channel.size // 4, 1))
    values, pairs = [], []
    for lag in range(1, lags + 1):
        same = (view.table.scan[lag:] == view.table.scan[:-lag]) & (view.table.repeat[lag:] == view.table.repeat[:-lag])
        pairs.append(max(same.sum(), 1))
        values.append(np.sum((z[lag:] * z[:-lag])[same]) / max(np.mean(z**2), 1e-30) / pairs[-1])
    depends = tuple(Dependence(name, _dependence(view.whitened, view.table.conditions[name])) for name in view.varying)
    return Whiteness(view.channel.name, np.array(values), float(2.576 / np.sqrt(pairs[0])), depends)


def _dependence(residual: np.ndarray, condition: np.ndarray) -> float:
    """Permutation p-value of the variance between cells of a condition."""
    edges = _edges(condition)
    place = np.clip(np.searchsorted(edges, condition, side="right") - 1, 0, len(edges) - 2)
    member = place[:, None] == np.arange(len(edges) - 1)
    member = member / np.sqrt(np.maximum(member.sum(axis=0), 1))
    centred = residual - residual.mean()
    found = np.sum((centred @ member) ** 2)
    larger = int(np.sum(np.sum((_permutations(centred) @ member) ** 2, axis=1) >= found))
    return (1 + larger) / (SHUFFLES + 1)


def describe(bench: Bench, raw: np.ndarray) -> dict[str, object]:
    """Where an unknown residual sits and what it looks like.

    raw: expected unknown function in u on the rows to fit (n,)
    Returns: channel, regime (condition -> range of the largest third), orders, exponents, parity
    """
    sizes = [float(np.mean(raw[c.rows] ** 2)) for c in bench.fit.stack.channels]
    number = int(np.argmax([size * c.size for size, c in zip(sizes, bench.fit.stack.channels)]))
    view = channel_views(bench)[number]
    fit_channel = bench.fit.stack.channels[number]
    shape = np.abs(raw[fit_channel.rows])
    table = bench.fit.stack.tables[fit_channel.table]
    large = shape >= np.quantile(shape, 2 / 3)
    regime = {}
    for name in view.varying:
        _, factor = axis_of(name)
        values = factor * table.conditions[name][large]
        regime[name] = [float(values.min()), float(values.max())]
    return {
        "channel": view.channel.name,
        "size_in_u": float(np.sqrt(sizes[number])),
        "regime": regime,
        "orders": _loud_orders(view),
        "exponents": {s.quantity: [s.low90, s.exponent, s.high90] for s in scalings(view)},
        "parity": {p.reversal: {"odd": p.odd, "even": p.even} for p in parities(view)},
    }


def _loud_orders(view: ChannelView) -> list[int]:
    spectra = order_spectra(view)
    if not spectra:
        return []
    amplitude = np.max([spectrum.amplitude for spectrum in spectra], axis=0)
    loud = np.flatnonzero(amplitude > spectra[0].floor)
    return [int(spectra[0].orders[k]) for k in loud[np.argsort(-amplitude[loud])][:6]]
