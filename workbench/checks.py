"""Checks that need no model: instruments are caught before any model is blamed."""

from __future__ import annotations

import numpy as np

from workbench.noise import matched_rows
from workbench.table import Campaign, Table

LOUD = 4.0  # standard errors from which a check speaks
COPPER = 0.00393  # 1/K at 20 degC, annealed copper (IEC 60028)
CLIPPED = 0.05  # share of readings at exactly the largest value that looks like clipping


def checks_of(campaign: Campaign) -> tuple[str, ...]:
    """One sentence for each thing that no device can do, or that an instrument does."""
    found: list[str] = []
    for table in campaign.tables:
        for check in (_repeats_agree, _clipping, _phase_sum, _cogging, _copper, _impedance, _reversal):
            found += check(table)
    return tuple(found + _constants(campaign))


def _repeats_agree(table: Table) -> list[str]:
    stations = matched_rows(table)
    found = []
    for r in table.responses.values() if stations is not None else ():
        z = (r.values[stations] - r.values[stations].mean(axis=1, keepdims=True)) / r.random[stations]
        size = float(np.sqrt(np.mean(z**2) * stations.shape[1] / (stations.shape[1] - 1)))
        shift = z.mean(axis=0) * np.sqrt(len(stations))
        if size > 3:
            found.append(f"{table.file}: repeats of {r.name} disagree by {size:.1f} times the declared uncertainty")
        elif np.abs(shift).max() > 3 * LOUD * max(size, 1):
            found.append(f"{table.file}: one repeat of {r.name} is shifted as a whole against the others")
    return found


def _clipping(table: Table) -> list[str]:
    found = []
    for r in table.responses.values():
        for edge in (r.values.max(), r.values.min()):
            share = float(np.mean(r.values == edge))
            if table.rows > 20 and share > CLIPPED and np.ptp(r.values) > 0:
                found.append(
                    f"{table.file}: {share:.0%} of {r.name} stand at exactly {edge / r.scale:g} {r.unit}: clipped?"
                )
    return found


def _phase_sum(table: Table) -> list[str]:
    """Three open-circuit phase voltages of a balanced winding add up to a wave of multiples of three only."""
    if not (table.kind == "back_emf" and {"v_a", "v_b", "v_c"} <= set(table.responses)):
        return []
    a, b, c = (table.responses[name] for name in ("v_a", "v_b", "v_c"))
    sizes = [np.sqrt(np.mean(r.values**2)) for r in (a, b, c)]
    spread = (max(sizes) - min(sizes)) / np.mean(sizes)
    u = np.sqrt(2 / table.rows) * np.mean(a.random) / np.mean(sizes)
    mean = np.mean(a.values + b.values + c.values) / (np.sqrt(3) * np.mean(a.random) / np.sqrt(table.rows))
    found = []
    if spread > LOUD * u and spread > 0.005:
        found.append(f"{table.file}: the phase voltages differ by {spread:.1%} in rms: unequal phases or gains")
    if abs(mean) > LOUD * 3:
        found.append(f"{table.file}: the sum of the phase voltages has a mean: a voltage channel has an offset")
    return found


def _cogging(table: Table) -> list[str]:
    """Cogging has no mean over a turn; forward and backward branches differ by friction only."""
    if table.kind != "cogging" or "angle_mech" not in table.conditions or np.ptp(table.conditions["angle_mech"]) < 6.1:
        return []
    torque, direction = table.responses["torque"], table.conditions.get("direction")
    u = float(np.mean(torque.random))
    found = []
    if direction is not None and (direction > 0).any() and (direction < 0).any():
        forward, backward = torque.values[direction > 0].mean(), torque.values[direction < 0].mean()
        error = u * np.sqrt(4 / table.rows)
        if abs(forward - backward) / 2 > LOUD * error:
            half = abs(forward - backward) / 2 / torque.scale
            found.append(
                f"{table.file}: forward and backward differ, half-difference {half:.3g} {torque.unit}: friction"
            )
        mean = 0.5 * (forward + backward)
    else:
        mean, error = torque.values.mean(), u * np.sqrt(1 / table.rows)
    if abs(mean) > LOUD * error:
        found.append(
            f"{table.file}: the mean over a turn is {mean / torque.scale:.3g} {torque.unit}: zero of the torque cell"
        )
    return found


def _copper(table: Table) -> list[str]:
    """R(T) of copper: R = R20 (1 + 0.00393 (T - 20))."""
    if table.kind != "phase_resistance" or "winding_T" not in table.conditions:
        return []
    warm = table.conditions["winding_T"] - 20.0
    found = []
    for r in table.responses.values():
        if np.ptp(warm) < 10:
            continue
        (slope, level), covariance = np.polyfit(warm, r.values, 1, w=1 / r.random, cov="unscaled")
        ratio, error = slope / level, np.sqrt(covariance[0, 0]) / level
        if abs(ratio - COPPER) > LOUD * error and abs(ratio / COPPER - 1) > 0.02:
            found.append(
                f"{table.file}: {r.name} rises by {ratio:.5f} per kelvin, copper by {COPPER}: temperature or leads"
            )
    return found


def _impedance(table: Table) -> list[str]:
    """A passive device takes power: the real part of its impedance is not negative."""
    if table.kind != "impedance" or "re" not in table.responses:
        return []
    re = table.responses["re"]
    wrong = int(np.sum(re.values < -LOUD * re.random))
    return (
        [f"{table.file}: {wrong} real parts are negative, which no passive device has: phase of a sensor"]
        if wrong
        else []
    )


def _reversal(table: Table) -> list[str]:
    """The power taken at constant velocity is not negative."""
    if table.kind != "damping_velocity" or not {"velocity"} <= set(table.conditions) or "force" not in table.responses:
        return []
    force, velocity = table.responses["force"], table.conditions["velocity"]
    wrong = int(np.sum(force.values * np.sign(velocity) < -LOUD * force.random))
    return (
        [f"{table.file}: {wrong} readings give power instead of taking it: sign or zero of a sensor"] if wrong else []
    )


def _constants(campaign: Campaign) -> list[str]:
    """K_t from torque or force equals K_e from the open-circuit voltage, for lumped linear devices."""
    emf = next((t for t in campaign.tables if t.kind == "back_emf" and "voltage" in t.responses), None)
    shunted = next((t for t in campaign.tables if t.kind == "damping_velocity" and "shunt" in t.conditions), None)
    resistance = campaign.device.get("internal_resistance_ohm")
    if emf is None or shunted is None or resistance is None:
        return []
    voltage, velocity = emf.responses["voltage"], emf.conditions["velocity"]
    k_e = float(np.sum(voltage.values * velocity) / np.sum(velocity**2))
    force, v, shunt = shunted.responses["force"].values, shunted.conditions["velocity"], shunted.conditions["shunt"]
    levels = np.unique(shunt)
    slopes = np.array([np.sum((force * v)[shunt == s]) / np.sum((v**2)[shunt == s]) for s in levels])
    design = np.column_stack([1 / (levels + float(resistance)), np.ones(len(levels))])
    (square, _), *_ = np.linalg.lstsq(design, slopes, rcond=None)
    k_t = float(np.sqrt(max(square, 0.0)))
    if abs(k_t / k_e - 1) > 0.05:
        return [
            f"force constant from the forces is {k_t:.4g}, from the voltage {k_e:.4g}: a gain, or losses in the circuit"
        ]
    return []
