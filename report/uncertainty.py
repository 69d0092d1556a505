"""How sure the headline numbers are, and how the match moves with what is not sure, for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import numpy as np
import pandas as pd

from drivetrain.matching import MatchOutcome
from drivetrain.output import Output, in_unit
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Section, Table
from figures.uncertainty import match_moves
from report.datasheet import plus_minus
from uncertainty.budget import Budget, Uncertain
from uncertainty.match_spread import DrawnMatch
from uncertainty.stage import Uncertainty
from units import percent, written

TABLE, FIGURE = "uncertainty.csv", "match_moves"
_PERCENT = 100.0
_METHOD = (
    "By the GUM (JCGM 100): first order, independent contributions, u² = u_mesh² + u_fit² + u_tolerance², U = 2u, "
    "which holds the number with about 95 %. Mesh: twice what triangles of half the size change, as a uniform bound. "
    "Fit: the match again with polynomials drawn by lot within their covariance and held-out residual; the wound "
    "machine is drawn and solved again, so that no fit is left in its numbers. Tolerance: as in the section above. "
    "Not in it is what the model leaves out: end effects, friction, data of materials, films of air."
)
_MOVES = (
    "The match again with fit, mesh and tolerances drawn by lot, as if what the machine gives had been known to it: "
    "the chosen machine, and with radius and slots free to take the least cost. 5 and 95 %: shares of the draws below."
)
_WORDS = {
    "torque_nominal": ("torque per length, nominal, fitted", "Nm_per_m"),
    "torque_overload": ("torque per length, overload, fitted", "Nm_per_m"),
    "matched_length": ("active length, matched", "mm"),
    "matched_mass": ("mass of motor and gears, matched", "kg"),
    "peak_torque": ("peak torque", "Nm"),
    "continuous_torque": ("continuous torque, nominal current density", "Nm"),
    "torque_constant": ("torque constant, no load", "mNm_per_A"),
    "resistance": ("phase resistance", "mOhm"),
    "inductance_d": ("L_d, incremental, no load", "uH"),
    "inductance_q": ("L_q, incremental, no load", "uH"),
    "loaded_inductance_d": ("L_d, apparent, overload current", "uH"),
    "loaded_inductance_q": ("L_q, apparent, overload current", "uH"),
    "base_speed": ("base speed", "rpm"),
    "ripple": ("ripple of the peak torque, peak to peak", "Nm"),
    "cogging": ("cogging, peak to peak", "Nm"),
    "copper_loss": ("copper loss at the continuous torque", "W"),
    "stator_laminations": ("mass of the stator laminations", "kg"),
    "rotor_laminations": ("mass of the rotor laminations", "kg"),
    "magnets": ("mass of the magnets", "kg"),
    "shaft": ("mass of the shaft", "kg"),
    "copper": ("mass of the copper with end turns", "kg"),
    "mass": ("mass of the active parts", "kg"),
    "rotor_inertia": ("rotor inertia", "kg_mm2"),
    "needed_length": ("active length that the peak torque needs", "mm"),
    "power_at_base_speed": ("power at base speed", "W"),
    "largest_power": ("largest power, ideal field weakening", "W"),
    "rated_speed": ("rated speed", "rpm"),
    "overload_input": ("electrical input at peak torque and rated speed", "W"),
    "rated_input": ("electrical input at the rated point", "W"),
    "rated_power": ("power at the rated point", "W"),
    "iron_loss": ("stator iron loss at the rated point, its mesh not counted", "W"),
    "losses": ("losses at the rated point", "W"),
    "efficiency": ("efficiency at the rated point", "percent"),
    "loaded_constant": ("torque constant at the overload current", "mNm_per_A"),
    "continuous_current": ("continuous line current by temperature, RMS", "A"),
    "copper_rise": ("rise of the hottest copper at the continuous torque by temperature", "degC"),
    "magnet_rise": ("rise of the magnets there", "degC"),
    "demagnetising_current": ("demagnetising current, peak", "A"),
    "kept": ("volume of the magnets before the knee, worst state", "percent"),
    "short_circuit_current": ("short-circuit current, peak", "A"),
    "braking_torque": ("largest braking torque, shorted", "Nm"),
    "braking_speed": ("speed of the largest braking torque, cold", "rpm"),
}


def files(found: Uncertainty, matched: MatchOutcome, output: Output) -> Iterator[File]:
    """The budget as a table, and the figure of the match."""
    yield table_file(TABLE, budget_table(found.budget, output))
    yield figure_file(FIGURE, match_moves(found.spread, matched.chosen, output))


def section(found: Uncertainty, output: Output) -> Section:
    """The budget of every headline number, and the match that moves."""
    return Section(
        "Uncertainty",
        (
            _METHOD,
            Table(
                _shown(budget_table(found.budget, output)),
                "Headline numbers with their relative standard uncertainties, combined, and ± U in the unit of the "
                "value.",
                {"plus_minus": "±"},
            ),
            Table(spread_table(found, output), _MOVES),
            _binding(found, output),
            Picture(
                picture_name(FIGURE),
                "Transmission ratio and active length of the chosen machine, dashed as it stands, and diameters and "
                "lengths of the least cost.",
            ),
        ),
    )


def budget_table(budget: Budget, output: Output) -> pd.DataFrame:
    """One headline number a row, in drawing units."""
    words = _words(output)
    return pd.DataFrame([_row(*words[name], one) for name, one in budget.known.items()])


def spread_table(found: Uncertainty, output: Output) -> pd.DataFrame:
    """One number of the match a row, of the chosen machine and of the free choice."""
    numbers: list[tuple[str, str, Callable[[DrawnMatch], float]]] = [
        ("transmission ratio", output.ratio_unit, lambda one: one.transmission_ratio),
        ("active length", "mm", lambda one: one.active_length),
        ("stator diameter", "mm", lambda one: 2 * one.stator_outer_radius),
        ("mass of motor and gears", "kg", lambda one: one.total_mass),
    ]
    return pd.DataFrame(
        [
            _spread_row(choice, words, unit, [read(one) for one in draws if one is not None])
            for choice, draws in (("chosen machine", found.spread.together), ("free", found.spread.free))
            for words, unit, read in numbers
        ]
    )


def _shown(table: pd.DataFrame) -> pd.DataFrame:
    return table.assign(plus_minus=[plus_minus(one) for one in table.plus_minus])


def _spread_row(choice: str, words: str, unit: str, values: Sequence[float]) -> dict[str, object]:
    shown = in_unit(np.array(values), unit)
    return {
        "choice": choice,
        "number": words,
        "unit": written(unit),
        "mean": shown.mean(),
        "standard_deviation_percent": _PERCENT * shown.std(ddof=1) / shown.mean(),
        "5 %": np.percentile(shown, 5),
        "95 %": np.percentile(shown, 95),
    }


def _row(words: str, unit: str, one: Uncertain) -> dict[str, object]:
    value = in_unit(one.value, unit)
    return {
        "number": words,
        "value": value,
        "plus_minus": value * one.expanded,
        "unit": written(unit),
        "mesh_percent": _PERCENT * one.mesh,
        "fit_percent": _PERCENT * one.fit,
        "tolerance_percent": _PERCENT * one.tolerance,
        "combined_percent": _PERCENT * one.combined,
        "expanded_percent": _PERCENT * one.expanded,
    }


def _words(output: Output) -> dict[str, tuple[str, str]]:
    """Words and drawing unit of every headline number, by its name."""
    return _WORDS | {
        "transmission_ratio": ("transmission ratio, matched", output.ratio_unit),
        "peak_effort": (f"peak {output.effort} {output.place}, at rest", output.effort_unit),
        "fast_effort": (f"peak {output.effort} {output.place}, at the speed where it is asked for", output.effort_unit),
        "peak_power": (f"peak power {output.place}, where it is asked for", "W"),
        "continuous_effort": (f"continuous {output.effort} {output.place}, turning slowly", output.effort_unit),
        "low_speed_damping": (f"short-circuit damping {output.place}, at low speed", output.damping_unit),
        "controlled_damping": (f"controlled damping {output.place}, where it is asked for", output.damping_unit),
        "equivalent_mass": (f"{output.inertia} {output.place}", output.inertia_unit),
    }


def _binding(found: Uncertainty, output: Output) -> str:
    """Which constraint sets the length, how often a bound is met, and how many draws have no match."""
    chosen, free = found.spread.together, found.spread.free
    return (
        f"Of the {len(chosen)} draws of the chosen machine {_shares(chosen, output)}; of the {len(free)} draws with "
        f"radius and slots free {_shares(free, output)}, and {_share(free, _on_radius_bound)} lie on an end "
        "of the investigated radii, which then do not move."
    )


def _shares(draws: Sequence[DrawnMatch | None], output: Output) -> str:
    found = Counter(one.binding.name(output) for one in draws if one is not None)
    lengths = ", ".join(f"the {name} sets the length in {percent(count / len(draws))}" for name, count in found.items())
    on_bound = _share(draws, lambda one: one is not None and one.ratio_bound)
    return f"{lengths}, the ratio is on a bound in {on_bound}, {_share(draws, lambda one: one is None)} have no match"


def _share(draws: Sequence[DrawnMatch | None], counts: Callable[[DrawnMatch | None], bool]) -> str:
    return f"{percent(sum(map(counts, draws)) / len(draws))}"


def _on_radius_bound(one: DrawnMatch | None) -> bool:
    return one is not None and one.radius_bound
