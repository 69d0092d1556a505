"""Temperatures for people: what they allow for ever and for a while, which limit binds, and where the heat goes."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from drivetrain.output import Output, amount, in_unit
from figures.files import File, figure_file, picture_name, table_file
from figures.heat import heat_of_machine
from figures.report import Picture, Remark, Section, Table
from thermal.machine import MAGNETS, PARTS
from thermal.rating import COPPER_LIMIT, CURRENT_LIMIT, MAGNET_LIMIT, Overload, Rating, State
from thermal.stage import SHORT, HeatOutcome
from units import written

TEMPERATURES, FLOWS, OVERLOAD, FIGURE = "heat_temperatures.csv", "heat_flows.csv", "heat_overload.csv", "heat"
HOTTEST = "hottest copper"
_OTHER_DENSITY = 0.1  # relative, from which on another nominal current density is worth a sentence
_TEMPERATURES = "Mean temperatures and heat (friction: in the casing) in the end, at both continuous ratings and"
_BOUND = {
    COPPER_LIMIT: "the winding",
    MAGNET_LIMIT: "the magnets",
    CURRENT_LIMIT: "no temperature, but the current limit",
}


def binding(rating: Rating) -> str:
    """Which limit a continuous rating is bound by, as a sentence."""
    return f"{_BOUND[rating.bound_by]} {'bind' if rating.bound_by == MAGNET_LIMIT else 'binds'}"


def files(found: HeatOutcome, output: Output) -> Iterator[File]:
    """Temperatures, ways of the heat and overloads as tables, and their figure."""
    yield table_file(TEMPERATURES, temperature_table(found, output))
    yield table_file(FLOWS, flow_table(found.at_speed.state))
    yield table_file(OVERLOAD, overload_table(found, output))
    yield figure_file(FIGURE, heat_of_machine(found, output))


def section(found: HeatOutcome, output: Output) -> Section:
    """What the temperatures allow, and what that rests on."""
    speed = _speed(found, output)
    return Section(
        f"Heat and continuous {output.effort}",
        (
            _text(found, output),
            *(Remark(line) for line in remarks(found, output)),
            Table(rating_table(found, output), f"What the temperatures allow, {output.place}."),
            Table(temperature_table(found, output), f"{_TEMPERATURES} {output.duty}, and the limits."),
            Picture(
                picture_name(FIGURE),
                f"{output.effort.capitalize()} over the time for which it is allowed, and the temperatures in the end.",
            ),
            Table(flow_table(found.at_speed.state), f"Where the heat goes at the continuous {output.effort}, {speed}."),
            Table(what_if_table(found, output), "The estimates that matter, each moved alone."),
        ),
    )


def remarks(found: HeatOutcome, output: Output) -> Iterator[str]:
    """What the run says at once: the continuous effort, what binds it, and how warm the duty makes the machine."""
    slow, limits = found.slow, found.inputs.limits
    density = in_unit(found.slow_density, "A_per_mm2")
    yield (
        f"Continuous {output.effort}: {_effort(found, slow.torque, output)} slowly turning ({density:.3g} A/mm² RMS), "
        f"{_effort(found, found.at_speed.torque, output)} {_speed(found, output)}; {binding(slow)}"
        f"{_at_limit(found, slow)}. "
        f"{in_unit(found.nominal_density, 'A_per_mm2'):g} A/mm² with cold magnets would be "
        f"{amount(found.nominal_effort, output.effort_unit)}."
    )
    yield from _other_density(found, output)
    if found.duty is None:
        yield f"The duty {output.duty} warms the machine without end: no temperature balances its loss."
    elif not found.warm_is_possible:
        yield (
            f"The duty {output.duty} ends at {found.duty.hottest_copper:.0f} °C in the copper (limit "
            f"{limits.copper:g} °C) and {found.duty.temperature[MAGNETS]:.0f} °C in the magnets (limit "
            f"{limits.magnets:g} °C): beyond a limit, so that nothing is left for an overload."
        )
    if not found.field_known:
        yield "Losses in iron and magnets are not counted: the steel has no loss data (materials.loss_grade)."


def _other_density(found: HeatOutcome, output: Output) -> Iterator[str]:
    """Where the temperatures allow another current density than cross-section and match were made for."""
    allowed = found.slow_density * found.at_speed.current / found.slow.current if found.slow.current else 0.0
    if abs(allowed / found.nominal_density - 1) > _OTHER_DENSITY:
        counted, allowed = (in_unit(one, "A_per_mm2") for one in (found.nominal_density, allowed))
        yield (
            f"Cross-section and match count on {counted:g} A/mm² for good, the temperatures allow {allowed:.3g} A/mm² "
            f"{_speed(found, output)}: the length is made for that, and with sweep.j_nominal_rms_A_per_mm2 = "
            f"{allowed:.2g} the rest would be."
        )


# ---- tables ---------------------------------------------------------------------------------------------------------


def rating_table(found: HeatOutcome, output: Output) -> pd.DataFrame:
    """Efforts that are allowed, one a row."""
    column = f"{output.effort} / {written(output.effort_unit)}"
    rows = [
        ("continuous, slowly turning", found.effort(found.slow.torque), _BOUND[found.slow.bound_by]),
        (f"continuous {_speed(found, output)}", found.effort(found.at_speed.torque), _BOUND[found.at_speed.bound_by]),
        (f"for {SHORT:g} s from cold", found.cold_short, ""),
        (f"for {SHORT:g} s from the duty {output.duty}", found.warm_short, ""),
        ("at the largest current, cold", found.peak_effort, _largest(found)),
        (f"at {in_unit(found.nominal_density, 'A_per_mm2'):g} A/mm², cold", found.nominal_effort, ""),
    ]
    return pd.DataFrame(
        [{"what": what, column: in_unit(effort, output.effort_unit), "bound by": by} for what, effort, by in rows]
    )


def _largest(found: HeatOutcome) -> str:
    """For how long the largest current is allowed, in words."""
    times = [f"{one.duration[-1]:.3g} s from {words}" for one, words in _overloads(found) if len(one.duration)]
    return "allowed for " + ", ".join(times) if times else ""


def _overloads(found: HeatOutcome) -> tuple[tuple[Overload, str], ...]:
    return (found.cold, "cold"), (found.warm, "the duty")


def temperature_table(found: HeatOutcome, output: Output) -> pd.DataFrame:
    """Parts with their temperatures in the end, one a row."""
    limits = {HOTTEST: found.inputs.limits.copper, MAGNETS: found.inputs.limits.magnets}
    columns: dict[str, list[object]] = {"part": [HOTTEST, *PARTS]}
    for words, state in _states(found, output):
        columns[f"{words}_degC"] = [state.hottest_copper, *(state.temperature[name] for name in PARTS)]
    for words, state in _states(found, output):
        columns[f"heat_{words}_W"] = [None, *(state.heat.get(name, 0.0) for name in PARTS)]
    columns["limit_degC"] = [limits.get(str(name)) for name in columns["part"]]
    return pd.DataFrame(columns)


def _states(found: HeatOutcome, output: Output) -> Iterator[tuple[str, State]]:
    """States with their names in columns."""
    yield "slowly_turning", found.slow.state
    yield "at_RMS_speed", found.at_speed.state
    if found.duty is not None:
        yield output.duty_name, found.duty


def flow_table(state: State) -> pd.DataFrame:
    """Ways of the heat, from the warmer to the colder end, one a row."""
    rows = [(a, b, flow) if flow >= 0 else (b, a, -flow) for a, b, flow in state.flows]
    return pd.DataFrame(
        [{"from": a, "to": b, "heat_W": flow, "share_percent": 100 * flow / state.lost} for a, b, flow in rows]
    )


def overload_table(found: HeatOutcome, output: Output) -> pd.DataFrame:
    """Efforts over the time for which they are allowed, in drawing units."""
    column = f"{output.effort}_{output.effort_unit}"
    rows = [
        {"from": words, "duration_s": duration, column: in_unit(found.effort(torque), output.effort_unit)}
        for one, words in _overloads(found)
        for duration, torque in zip(one.duration, one.torque, strict=True)
    ]
    return pd.DataFrame(rows, columns=["from", "duration_s", column])


def what_if_table(found: HeatOutcome, output: Output) -> pd.DataFrame:
    """The continuous effort with other estimates, one a row."""
    column = f"continuous {output.effort} / {written(output.effort_unit)}"
    base = ("as the study has it", found.effort(found.slow.torque), found.slow.bound_by)
    rows = [base, *((one.words, one.effort, one.bound_by) for one in found.what_ifs)]
    return pd.DataFrame(
        [
            {"what": words, column: in_unit(effort, output.effort_unit), "bound by": _BOUND[by]}
            for words, effort, by in rows
        ]
    )


# ---- words ----------------------------------------------------------------------------------------------------------


def _text(found: HeatOutcome, output: Output) -> str:
    cooling = found.inputs.cooling
    sources = "copper with its warm resistance" + (", iron, magnets" if found.field_known else "")
    return (
        f"A thermal network of the machine in its casing, at {cooling.ambient:g} °C around it: {sources} and friction "
        "warm it, the remanence falls with the temperature of the magnets, and both are found together. "
        f"{_time_constants(found)}{_ripple(found, output)} Films, gaps and fillers are from the literature; until a "
        "machine is measured the rise of the temperatures is known to some 20 % (estimate). Slowly turning means that "
        "the phases share the current: one that holds still at its peak warms up to twice as much."
    )


def _time_constants(found: HeatOutcome) -> str:
    first, *others = found.slow.state.time_constants[:3]
    fast = " and ".join(f"{one:.0f} s" for one in others)
    return f"Its longest time constant is {first / 60:.0f} minutes, the next are {fast}."


def _ripple(found: HeatOutcome, output: Output) -> str:
    if not found.ripple:
        return ""
    return f" The mean loss {output.duty} decides: the copper moves by no more than {found.ripple:.2g} K about it."


def _speed(found: HeatOutcome, output: Output) -> str:
    return f"at {output.at_speed(found.at_speed.speed * found.ratio)}"


def _effort(found: HeatOutcome, torque: float, output: Output) -> str:
    return amount(float(found.effort(torque)), output.effort_unit)


def _at_limit(found: HeatOutcome, rating: Rating) -> str:
    if rating.bound_by == CURRENT_LIMIT:
        return ""
    limits = found.inputs.limits
    return f" at {limits.magnets if rating.bound_by == MAGNET_LIMIT else limits.copper:g} °C"
