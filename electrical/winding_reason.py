"""Why a winding was chosen, in sentences."""

from __future__ import annotations

from math import inf

from electrical.winding_selection import AS_SHORT, Winding, WindingChoice, WindingLimits, WindingRequirement
from units import RPM, percent

_VISIBLE = 1e-3  # relative; what is closer is called the same


def choice_reason(choice: WindingChoice, limits: WindingLimits, requirement: WindingRequirement) -> str:
    """What decided, what is relaxed, and what the winding misses or uses up."""
    chosen = choice.chosen
    if chosen.satisfies(requirement):
        text = _reason_met(chosen, limits, requirement)
    else:
        text = _reason_relaxed(chosen, choice.unrestricted, limits, requirement)
    return " ".join(filter(None, (text, _torque_remark(chosen, requirement), _packing_remark(chosen, limits))))


def verdict(one: Winding, choice: WindingChoice, limits: WindingLimits, requirement: WindingRequirement) -> str:
    """Why the best of a gauge and connection was chosen, or what another has over it."""
    if one == choice.chosen:
        return "chosen"
    if one.circulating_share > limits.circulating_share:
        return f"its current round the delta loses {percent(one.circulating_share, 1)} of the copper loss"
    if one.current_rms > limits.phase_current_rms:
        return f"{one.current_rms:.1f} A RMS at least"
    if not choice.chosen.satisfies(requirement):
        return f"{percent(1 - _power_density(one) / _power_density(choice.chosen), 1)} less power for its length"
    if not one.satisfies(requirement):
        return "misses: " + _relaxed(one, requirement)
    meeting = (w for w in choice.table if w.satisfies(requirement) and w.current_rms <= limits.phase_current_rms)
    return _behind(one, choice.chosen, shortest=min(w.needed_length for w in meeting))


def _power_density(one: Winding) -> float:
    """At base speed over the length that is needed [W/m]."""
    return one.power_at_base_speed / one.needed_length


def _behind(one: Winding, chosen: Winding, shortest: float) -> str:
    """What a winding that meets the requirement lacks against the chosen one; shortest: of those that do [m]."""
    longer, more = one.needed_length / shortest - 1, one.current_rms / chosen.current_rms - 1
    if longer > AS_SHORT:
        return f"{percent(longer, 1)} longer than the shortest"
    if more > _VISIBLE:
        return f"{percent(more, 1)} more current"
    if one.packing < chosen.packing * (1 - _VISIBLE):
        return "as much current, less copper"
    return "as good, with more paths, wires or in delta"


def _reason_met(chosen: Winding, limits: WindingLimits, requirement: WindingRequirement) -> str:
    within = "" if limits.phase_current_rms == inf else f" and within the limit of {limits.phase_current_rms:.1f} A RMS"
    return (
        f"{chosen.design}: lowest current of the full slots that meet the requirement and are at most "
        f"{percent(AS_SHORT)} longer than the shortest, {chosen.current_rms:.1f} A RMS ({chosen.current_peak:.1f} A "
        f"peak){within}; base speed {chosen.base_speed / RPM:.0f} rpm against "
        f"{requirement.base_speed / RPM:.0f} rpm required, power at base speed {chosen.power_at_base_speed:.0f} W "
        f"against {requirement.power:.0f} W."
    )


def _reason_relaxed(
    chosen: Winding, unrestricted: Winding | None, limits: WindingLimits, requirement: WindingRequirement
) -> str:
    limit = "" if limits.phase_current_rms == inf else f" within {limits.phase_current_rms:.1f} A RMS of line current"
    return (
        f"{chosen.design}: no full slot meets the requirement{limit}, so the one with the most power at base speed for "
        f"its length is taken, at {chosen.current_rms:.1f} A RMS ({chosen.current_peak:.1f} A peak). "
        f"Relaxed: {_relaxed(chosen, requirement)}. {_without_limit(unrestricted)}"
    )


def _relaxed(chosen: Winding, requirement: WindingRequirement) -> str:
    parts = (
        _relaxation("base speed", chosen.base_speed / RPM, requirement.base_speed / RPM, "rpm"),
        _relaxation("power at base speed", chosen.power_at_base_speed, requirement.power, "W"),
    )
    return " and ".join(filter(None, parts))


def _relaxation(what: str, reached: float, required: float, unit: str) -> str:
    if reached >= required:
        return ""
    return f"{what} from {required:.0f} to {reached:.0f} {unit} ({percent(reached / required)} of the requirement)"


def _without_limit(unrestricted: Winding | None) -> str:
    if unrestricted is None:
        return "No winding of this machine meets the requirement at any current: its length or voltage has to grow."
    return (
        f"{unrestricted.design} would meet it, with {unrestricted.current_rms:.1f} A RMS "
        f"({unrestricted.current_peak:.1f} A peak)."
    )


def _torque_remark(chosen: Winding, requirement: WindingRequirement) -> str:
    if chosen.peak_torque >= requirement.torque:
        return ""
    missing = requirement.torque - chosen.peak_torque
    return (
        f"Its peak torque of {chosen.peak_torque:.3f} Nm is {missing:.3f} Nm "
        f"({percent(missing / requirement.torque, 1)}) below the peak force requirement."
    )


def _packing_remark(chosen: Winding, limits: WindingLimits) -> str:
    if chosen.packing <= limits.packing_limit:
        return ""
    return (
        f"Its packing factor {chosen.packing:.4f} exceeds the limit {limits.packing_limit:g} by "
        f"{percent(chosen.packing / limits.packing_limit - 1, 2)}, inside the "
        f"accepted {percent(limits.packing_tolerance, 2)}."
    )
