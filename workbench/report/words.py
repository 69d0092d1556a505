"""How names, units and numbers are written for people."""

from __future__ import annotations

from math import exp, floor, isfinite, log, log10

import units
from figures.report import number_text
from workbench.findings import Axis, Estimate

_TAKES_PREFIX = ("m", "s", "V", "A", "N", "H", "Ω", "Nm", "Vs", "W", "T", "rad")
_PREFIXES = (("m", 1e3), ("µ", 1e6), ("n", 1e9))
_SMALL = 0.01  # below it a prefix reads better than zeros
_WIDE = 10.0  # times its value, from which on an interval says in what unit both are written
_NEAR_ONE = 2.0  # factors up to which the third digit counts
_READABLE = 1e5  # odds up to which digits read better than a power of ten
_DIGITS_AT_MOST = 5  # zeros behind the digits that count, rather than an exponent


def unit_text(unit: str) -> str:
    """A unit as printed: ``Ns_per_m`` becomes ``Ns/m``."""
    return "" if unit == "1" else units.written(unit).replace("^2", "²").replace("^3", "³")


def plain(name: str) -> str:
    """A name of the code in plain letters: ``magnet_temperature`` becomes ``magnet temperature``."""
    return name.replace("_", " ")


def label(name: str, unit: str) -> str:
    """Label of an axis: ``damping / (Ns/m)``, ``force / N``."""
    written = unit_text(unit)
    if not written:
        return plain(name)
    return f"{plain(name)} / {f'({written})' if '/' in written else written}"


def axis_label(axis: Axis) -> str:
    """Name and unit of an axis, for a figure."""
    return label(axis.name, axis.unit)


def quantity_of(channel: str) -> str:
    """The measured column of a channel: ``force_velocity.force`` is a force."""
    return channel.rpartition(".")[2]


def number(value: float | None, digits: int = 3) -> str:
    """A number without idle zeros or an exponent it can do without: ``0.4``, ``−12.3``, ``3812``, ``–`` for none."""
    if value is None or not isfinite(value):
        return number_text(value)
    rounded = float(f"{value:.{digits}g}")
    places = 0 if rounded == 0 else digits - 1 - floor(log10(abs(rounded)))
    text = f"{value:.0f}" if -_DIGITS_AT_MOST < places < 0 else f"{value:.{digits}g}"
    return text.replace("-", "\N{MINUS SIGN}")


def signed(value: float, digits: int = 3) -> str:
    """A number with its sign."""
    return ("+" if value > 0 else "") + number(value, digits)


def chi2_text(value: float | None) -> str:
    """chi2/n with two places, three digits where large."""
    return number(value) if value is None or abs(value) >= 10 else f"{value:.2f}"


def amount(value: float | None, unit: str = "", digits: int = 3) -> str:
    """A number with its unit: ``3.2 N``, ``4.5 µm``, ``12 %``, ``–`` where there is none."""
    factor, written = prefixed(value or 0.0, unit)
    return number(None) if value is None else _with_unit(value * factor, written, digits)


def _with_unit(value: float, written: str, digits: int = 3) -> str:
    gap = "" if written in ("", "°") else "\N{NO-BREAK SPACE}"
    return f"{number(value, digits)}{gap}{written}"


def prefixed(size: float, unit: str) -> tuple[float, str]:
    """Factor to, and print of, the unit with the prefix in which a number of this size reads best."""
    written = unit_text(unit)
    small = 0 < abs(size) < _SMALL and written.split("/")[0].split(" ")[0] in _TAKES_PREFIX
    for prefix, factor in _PREFIXES if small else ():
        if abs(size) * factor >= 1:
            return factor, prefix + written
    return 1.0, written


def interval(estimate: Estimate) -> str:
    """``4.1 N (90 % interval 3.6 to 4.6)``."""
    return f"{estimated(estimate)} (90 % interval {bounds(estimate)})"


def estimated(estimate: Estimate) -> str:
    """The value of an estimate with its unit: ``4.1 N``."""
    factor, written = _unit_of(estimate)
    return _with_unit(estimate.value * factor, written)


def bounds(estimate: Estimate) -> str:
    """The 90 % interval in the unit in which ``estimated`` writes the value: ``3.6 to 4.6``."""
    factor, _ = _unit_of(estimate)
    return f"{number(estimate.low90 * factor)} to {number(estimate.high90 * factor)}"


def _unit_of(estimate: Estimate) -> tuple[float, str]:
    """Factor and unit that suit the value, but where it is next to nothing in a wide interval."""
    widest = max(abs(estimate.low90), abs(estimate.high90))
    return prefixed(max(abs(estimate.value), widest / _WIDE), estimate.unit)


def percent(share: float) -> str:
    """A share: ``85 %``, ``99.6 %``."""
    return f"{number(100 * share, 3 if share > 0.99 else 2)} %"


def probability_text(p: float) -> str:
    """A probability, never rounded up to certainty or down to impossibility."""
    return "> 99.9 %" if p > 0.999 else "< 0.1 %" if p < 0.001 else percent(p)


def odds_text(log_odds: float) -> str:
    """Odds from their logarithm: ``2000 : 1``, ``1 : 40``, ``10^8.3 : 1``, ``–`` for none."""
    if not isfinite(log_odds):
        return number(None)
    size = _factor(abs(log_odds))
    return f"{size} : 1" if log_odds >= 0 else f"1 : {size}"


def factor_text(log_factor: float) -> str:
    """A factor in the odds from its logarithm: ``×1.3``, ``×2000``, ``×10^8.3``."""
    return f"×{_factor(log_factor)}"


def _factor(log_size: float) -> str:
    """Two digits, three near one, and powers of ten where large."""
    if log_size >= log(_READABLE):
        return f"10^{log_size / log(10):.1f}"
    return number(float(f"{exp(log_size):.2g}") if exp(log_size) > _NEAR_ONE else exp(log_size))


def p_text(p_value: float) -> str:
    """``p = 0.03``; permutations that were all beaten give ``p < 0.001``."""
    return "p < 0.001" if p_value < 0.001 else f"p = {p_value:.2g}"


def listed(names, last: str = "and") -> str:
    """``a, b and c``."""
    names = list(names)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}" if names else ""


def sentence(words: str) -> str:
    """With a capital, unless the first word is a name, and one full stop."""
    first = words.split(" ")[0]
    start = words[0] if "." in first or "_" in first else words[0].upper()
    return f"{start}{words[1:].rstrip('.')}."
