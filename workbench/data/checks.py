"""Checks that need no model: instruments are caught before any model is blamed."""

from __future__ import annotations

from itertools import combinations, combinations_with_replacement

import numpy as np

from units import percent
from workbench.data.column_units import factor, split_unit
from workbench.data.device_keys import COPPER
from workbench.data.kinds import KINDS
from workbench.data.repeats import matched_rows, places_of
from workbench.data.robust import size_of
from workbench.data.table import Campaign, Response, Table

LOUD = 4.0  # standard errors from which a check speaks
FREQUENCIES = 8  # of a sweep that says something about causality
NOT_CAUSAL = 3.0  # uncertainties that a sweep may miss a causal linear device by
FEWEST_SHARED, SHARED = 10, 0.8  # readings of two tables, and the share of the shorter one, that are no chance
WORKED_OUT = 0.003  # relative, of numbers that are worked out of others and rounded
UNLIKE = 0.005  # of the range of a condition, by which the same reading may stand at another one
SAME_RESISTANCE = 0.2  # relative, of readings between lines that are taken for those of a phase
QUIET, ENOUGH = 0.2, 6  # of the declared uncertainty, below which repeats are quieter than any instrument; stations
CLIPPED = 0.05  # share of readings at exactly the largest value that looks like clipping,
NEXT_LEVEL = 3.0  # where so many times as many stand there as on the next level: a coarse converter has few of them all


def checks_of(campaign: Campaign) -> tuple[str, ...]:
    """One sentence for each thing that no device can do, or that an instrument does."""
    found: list[str] = []
    for table in campaign.tables:
        for check in _OF_A_TABLE:
            found += check(table)
    for check in _OF_A_CAMPAIGN:
        found += check(campaign)
    return tuple(found)


def _unsaid_shunt(table: Table) -> list[str]:
    kind = KINDS[table.kind]
    if "shunt" not in kind.axes + kind.besides or "shunt" in table.conditions:
        return []
    return [
        f"{table.file}: nothing says what was connected to the terminals, so that they count as open; give shunt_ohm "
        "as a column, or in constants of the table, where they were not"
    ]


def _repeats_agree(table: Table) -> list[str]:
    stations = matched_rows(table)
    found = []
    for r in table.responses.values() if stations is not None else ():
        z, size = _scatter(table, r, stations)
        shift = z.mean(axis=0) * np.sqrt(len(stations))
        if size > 3:
            found.append(f"{table.file}: repeats of {r.name} disagree by {size:.1f} times the declared uncertainty")
        elif np.abs(shift).max() > 3 * LOUD * max(size, 1):
            found.append(f"{table.file}: one repeat of {r.name} is shifted as a whole against the others")
        elif size < QUIET and len(stations) >= ENOUGH:
            found.append(
                f"{table.file}: repeats of {r.name} differ by {size:.2g} of the declared uncertainty; lower u_random, "
                "or they are copies"
            )
    return found


def _scatter(table: Table, r: Response, stations: np.ndarray) -> tuple[np.ndarray, float]:
    """Deviations from the mean of the repeats over the declared uncertainty (stations, repeats), and their size, single
    wild ones cut; less what comes of conditions that were not met alike, by a curved surface over them."""
    values = (r.values - _surface(table, r))[stations]
    z = (values - values.mean(axis=1, keepdims=True)) / r.random[stations]
    return z, size_of(z.ravel()) * float(np.sqrt(stations.shape[1] / (stations.shape[1] - 1)))


def _surface(table: Table, r: Response) -> np.ndarray:
    """The readings by a quadratic form in the conditions (n,)."""
    places = places_of(table)
    products = [places[:, i] * places[:, j] for i, j in combinations_with_replacement(range(places.shape[1]), 2)]
    shapes = np.column_stack([np.ones(table.rows), places, *products]) / r.random[:, None]
    return r.random * (shapes @ np.linalg.lstsq(shapes, r.values / r.random, rcond=None)[0])


def _clipping(table: Table) -> list[str]:
    found = []
    for r in table.responses.values():
        levels, counts = np.unique(r.values, return_counts=True)
        for edge, following in ((-1, -2), (0, 1)) if len(levels) > 1 and table.rows > 20 else ():
            share = float(counts[edge] / table.rows)
            if share > CLIPPED and counts[edge] >= NEXT_LEVEL * counts[following]:
                found.append(
                    f"{table.file}: {percent(share)} of {r.name} stand at exactly {levels[edge] / r.scale:g} {r.unit}: "
                    "clipped?"
                )
    return found


def _phase_sum(table: Table) -> list[str]:
    """Three open-circuit phase voltages of a balanced winding add up to a wave of multiples of three only."""
    if not (table.kind == "back_emf" and {"v_a", "v_b", "v_c"} <= set(table.responses)):
        return []
    if "angle_mech" not in table.conditions:
        return []  # RMS
    a, b, c = (table.responses[name] for name in ("v_a", "v_b", "v_c"))
    sizes = [np.sqrt(np.mean(r.values**2)) for r in (a, b, c)]
    spread = (max(sizes) - min(sizes)) / np.mean(sizes)
    u = np.sqrt(2 / table.rows) * np.mean(a.random) / np.mean(sizes)
    mean = np.mean(a.values + b.values + c.values) / (np.sqrt(3) * np.mean(a.random) / np.sqrt(table.rows))
    found = []
    if spread > LOUD * u and spread > 0.005:
        found.append(f"{table.file}: the phase voltages differ by {percent(spread, 1)} in rms: unequal phases or gains")
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


def _causality(table: Table) -> list[str]:
    """Kramers-Kronig: one set of real coefficients makes both parts of the impedance of a causal linear device.

        Z = c + j w m + k / (j w) + sum over tau of a_tau / (1 + j w tau)

    with relaxation times over the measured band, fitted to each scan of frequencies (Boukamp, J. Electrochem. Soc. 142
    (1995) 1885). A wave through a spring or a drift between points leaves more than noise.
    """
    if table.kind != "impedance" or not {"re", "im"} <= set(table.responses) or "frequency" not in table.conditions:
        return []
    stations = matched_rows(table)
    parts = (table.responses[name] for name in ("re", "im"))
    noise = 1.0 if stations is None else max(1.0, *(_scatter(table, part, stations)[1] for part in parts))
    worst = max((_not_causal(table, rows) for rows in _sweeps(table)), default=1.0) / noise
    if worst < NOT_CAUSAL:
        return []
    return [
        f"{table.file}: real and imaginary part miss a causal linear device by {worst:.2g} times their uncertainty: "
        "drift between the frequencies, the phase of a sensor, or friction and backlash"
    ]


def _sweeps(table: Table) -> list[np.ndarray]:
    """Rows that differ in frequency and repeat only, where there are enough frequencies."""
    others = [np.round(v, 9) for n, v in table.conditions.items() if n != "frequency"]
    keys = np.column_stack([np.zeros(table.rows), *others])
    number = np.unique(keys, axis=0, return_inverse=True)[1].ravel()
    sets = [np.flatnonzero(number == value) for value in range(number.max() + 1)]
    return [rows for rows in sets if len(np.unique(table.conditions["frequency"][rows])) >= FREQUENCIES]


def _not_causal(table: Table, rows: np.ndarray) -> float:
    """Rms of what a causal linear device leaves of one sweep, over the uncertainty."""
    omega = 2 * np.pi * table.conditions["frequency"][rows]
    re, im = (table.responses[name] for name in ("re", "im"))
    count = max(3, len(np.unique(omega)) // 2)
    relaxations = 1 / (1 + 1j * omega[:, None] * np.geomspace(0.3 / omega.max(), 3.0 / omega.min(), count))
    device = np.column_stack([np.ones(len(omega)), 1j * omega, 1 / (1j * omega), relaxations])
    u = np.concatenate([re.random[rows], im.random[rows]])
    design = np.vstack([device.real, device.imag]) / u[:, None]
    measured = np.concatenate([re.values[rows], im.values[rows]]) / u
    left = measured - design @ np.linalg.lstsq(design, measured, rcond=1e-10)[0]
    return float(np.sqrt(left @ left / (len(left) - design.shape[1])))


def _loop(table: Table) -> list[str]:
    """The work of a closed loop of force over displacement is not negative: no device gives energy in every turn."""
    if table.kind != "force_loop" or "force" not in table.responses or "displacement" not in table.conditions:
        return []
    force, place = table.responses["force"], table.conditions["displacement"]
    number = np.unique(np.column_stack([table.scan, table.repeat]), axis=0, return_inverse=True)[1].ravel()
    found = []
    for value in range(number.max() + 1):
        rows = np.flatnonzero(number == value)
        way = 0.5 * (np.roll(place[rows], -1) - np.roll(place[rows], 1))
        work, u = np.sum(force.values[rows] * way), np.sqrt(np.sum((force.random[rows] * way) ** 2))
        if work < -LOUD * u:
            found.append(f"{table.file}: a closed loop gives {-work:.3g} J instead of taking it: sign of a sensor")
    return found[:1]


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


def _same_readings(campaign: Campaign) -> list[str]:
    """Two tables with one and the same readings were taken at the same conditions."""
    found = []
    for one, other in combinations(campaign.tables, 2):
        for name in set(one.responses) & set(other.responses) if one.kind == other.kind else ():
            here, there = (_by_reading(table, name) for table in (one, other))
            most = min(len(here), len(there))
            shared = sorted(set(here) & set(there))
            if most < FEWEST_SHARED or len(shared) < SHARED * most:
                continue
            for condition in sorted(set(one.conditions) & set(other.conditions)):
                apart = max(abs(here[r][condition] - there[r][condition]) for r in shared)
                range_ = float(np.ptp(one.conditions[condition]))
                if apart > UNLIKE * range_ > 0:
                    found.append(
                        f"{one.file} and {other.file} hold the same {len(shared)} readings of {name}, but their "
                        f"{condition} differ by up to {percent(apart / range_, 1)} of its range: one of them was "
                        "changed"
                    )
    return found


def _by_reading(table: Table, name: str) -> dict[float, dict[str, float]]:
    """Conditions of every reading that stands once in a table."""
    values, first, count = np.unique(table.responses[name].values, return_index=True, return_counts=True)
    rows = zip(values[count == 1].tolist(), first[count == 1].tolist(), strict=True)
    return {value: {n: float(v[row]) for n, v in table.conditions.items()} for value, row in rows}


def _between_lines(campaign: Campaign) -> list[str]:
    """Two phases in series have twice the resistance of one."""
    phase = _declared_resistance(campaign)
    found = []
    for table in campaign.tables if phase else ():
        readings = [r.values.mean() for n, r in table.responses.items() if n in ("r_ab", "r_bc", "r_ca")]
        if readings and abs(float(np.mean(readings)) / phase - 1) < SAME_RESISTANCE:
            found.append(
                f"{table.file}: between two lines there are {np.mean(readings) / phase:.2f} times the phase resistance "
                "of [device], two phases in series have twice as much: what is declared is that between lines"
            )
    return found


def _declared_resistance(campaign: Campaign) -> float:
    """Of a phase [ohm], zero where none is declared."""
    for key, value in campaign.device.items():
        if key.startswith("phase_resistance") and isinstance(value, (int, float)):
            return value * factor(split_unit(key.replace("_20degC", ""))[1] or "ohm", key)
    return 0.0


def _positions(campaign: Campaign) -> list[str]:
    """The inductance between two lines repeats once a pole."""
    poles = campaign.device.get("poles")
    found = []
    for table in campaign.tables if isinstance(poles, int) and poles > 2 else ():
        for r in table.responses.values():
            if table.kind == "inductance" and len(r.name) == 4 and "angle_mech" in table.conditions:
                order = _strongest(table.conditions["angle_mech"], r.values, 2 * poles)
                if order is not None and order != poles:
                    found.append(
                        f"{table.file}: {r.name} repeats after {360 / order:.3g} deg, the field of {poles} poles after "
                        f"{360 / poles:.3g} deg: mechanical and electrical angles are exchanged"
                    )
    return found


def _strongest(angle: np.ndarray, values: np.ndarray, most: int) -> int | None:
    """Order of the wave that takes most of the variance, None where none takes half of it."""
    rest = values - values.mean()
    left = []
    for order in range(1, most + 1):
        waves = np.column_stack([np.cos(order * angle), np.sin(order * angle), np.ones(len(angle))])
        left.append(float(np.sum((rest - waves @ np.linalg.lstsq(waves, rest, rcond=1e-10)[0]) ** 2)))
    return 1 + int(np.argmin(left)) if min(left) < 0.5 * float(rest @ rest) else None


def _known_exactly(campaign: Campaign) -> list[str]:
    if campaign.tolerances or not campaign.device:
        return []
    return [
        "[tolerance] is empty: the device counts as exactly as drawn, and what it is off by is taken for an effect; "
        "say how well its inputs are known"
    ]


def _efficiency(table: Table) -> list[str]:
    """Shaft over electrical power of a motor, the other way round of a generator."""
    columns = {name: r.values for name, r in table.responses.items()} | dict(table.conditions)
    if not {"efficiency", "power", "torque", "speed"} <= set(columns):
        return []
    shaft, electrical = columns["torque"] * columns["speed"], columns["power"]
    one, other = np.where(shaft > 0, shaft, electrical), np.where(shaft > 0, electrical, shaft)
    off = np.abs(columns["efficiency"] * other - one)
    if (off <= WORKED_OUT * np.abs(one)).mean() < SHARED:
        return []
    return [
        f"{table.file}: efficiency was worked out from torque, speed and power of the same rows and counts as if it "
        "had been measured once more; leave it out, or the power"
    ]


_OF_A_CAMPAIGN = (_known_exactly, _constants, _between_lines, _positions, _same_readings)
_OF_A_TABLE = (
    _unsaid_shunt, _repeats_agree, _clipping, _efficiency, _phase_sum, _cogging, _copper, _impedance, _causality,
    _reversal, _loop,
)  # fmt: skip
