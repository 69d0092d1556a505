"""One mistake of a laboratory, made in the files of a right campaign.

for mistake in MISTAKES["damper"]: folder = mistaken(mistake, right_folder, new_folder)
"""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

Change = Callable[[pd.DataFrame], pd.DataFrame]


@dataclass(frozen=True)
class Mistake:
    """words: what was done;  files: in which;  change: of each;  names: that it may be called by, the first is its own

    toml: replacements in the text of campaign.toml
    """

    words: str
    names: tuple[str, ...]
    files: tuple[str, ...]
    change: Change = lambda frame: frame
    toml: tuple[tuple[str, str], ...] = ()


def mistaken(mistake: Mistake, right: Path, folder: Path) -> Path:
    """A copy of a campaign with the mistake in it; returns the folder."""
    shutil.copytree(right, folder)
    for file in mistake.files:
        frame = pd.read_csv(folder / file)
        mistake.change(frame.astype({c: float for c in frame.columns if c.rsplit("_", 1)[-1] != "repeat"})).to_csv(
            folder / file, index=False
        )
    text = (folder / "campaign.toml").read_text(encoding="utf-8")
    for old, new in mistake.toml:
        if old not in text:
            raise ValueError(f"{right}: campaign.toml has no {old!r}")
        text = text.replace(old, new)
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


# ---- what can be done to a table ------------------------------------------------------------------------------------


def scaled(columns: Sequence[str], factor: float) -> Change:
    """Columns are read so many times too large."""
    return lambda frame: frame.assign(**{c: frame[c] * factor for c in columns})


def inverted(*columns: str) -> Change:
    """Columns count the other way round."""
    return scaled(columns, -1.0)


def exchanged(columns: Sequence[str], sources: Sequence[str]) -> Change:
    """Each column gets the numbers of its source."""
    return lambda frame: frame.assign(**{c: frame[s].to_numpy() for c, s in zip(columns, sources)})


def turned(zero: float) -> Change:
    """The angle reads ``zero`` [deg] more."""
    return lambda frame: frame.assign(angle_mech_deg=np.mod(frame["angle_mech_deg"] + zero, 360.0))


def late(column: str, rows: int = 1) -> Change:
    """A column stands so many rows too late."""
    return lambda frame: frame.assign(**{column: np.roll(frame[column], rows)})


def clipped(column: str, share: float) -> Change:
    """A column ends at a share of its largest reading."""
    def cut(frame: pd.DataFrame) -> pd.DataFrame:
        end = share * frame[column].abs().max()
        return frame.assign(**{column: frame[column].clip(-end, end)})

    return cut


def stuck(column: str, start: float, stop: float) -> Change:
    """The same value from one part of the rows to another."""

    def hold(frame: pd.DataFrame) -> pd.DataFrame:
        values = frame[column].to_numpy().copy()
        first, last = int(start * len(values)), int(stop * len(values))
        values[first:last] = values[first]
        return frame.assign(**{column: values})

    return hold


def shifted(column: str, offset: float) -> Change:
    """A column reads so much more, in the unit of its heading."""
    return lambda frame: frame.assign(**{column: frame[column] + offset})


def between_lines(frame: pd.DataFrame) -> pd.DataFrame:
    """Voltages of lines in the columns of phases."""
    a, b, c = (frame[f"v_{x}_V"] for x in "abc")
    return frame.assign(v_a_V=a - b, v_b_V=b - c, v_c_V=c - a)


def both(*changes: Change) -> Change:
    """One mistake after the other."""
    def all_of(frame: pd.DataFrame) -> pd.DataFrame:
        for change in changes:
            frame = change(frame)
        return frame

    return all_of


# ---- the mistakes ---------------------------------------------------------------------------------------------------

ANGLE, SPEED = "angle_mech_deg", "speed_rpm"
V = ("v_a_V", "v_b_V", "v_c_V")
I = ("i_a_A", "i_b_A", "i_c_A")  # noqa: E741
EMF, COG, LOCKED, FLUX, OHM = (
    f"{n}.csv" for n in ("back_emf", "cogging", "locked_rotor", "flux_linkage", "phase_resistance")
)
TURNED = (EMF, COG, LOCKED, FLUX)
SWAPPED, ZERO, SIGN, UNIT = "swapped_phases", "angle_zero", "sign", "unit_factor"
DIRECTION, ELECTRICAL, LINE, PEAK = "angle_direction", "electrical_or_mechanical", "line_or_phase", "rms_or_peak"
MOTOR, COLUMNS, SHIFTED = "motoring_or_generating", "swapped_columns", "shifted_column"


def _angle_in_radians(frame: pd.DataFrame) -> pd.DataFrame:
    """Numbers in degrees under a heading in radians."""
    return frame.rename(columns={ANGLE: "angle_mech_rad"})


_MACHINE = (
    Mistake("phases rotated A, B, C", (SWAPPED, ZERO), (EMF,), exchanged(V, V[1:] + V[:1])),
    Mistake("B and C swapped", (SWAPPED,), (EMF,), exchanged(V[1:], V[:0:-1])),
    Mistake("all voltages inverted", (SIGN, ZERO), (EMF,), inverted(*V)),
    Mistake("phase B inverted", ("inverted_phase",), (EMF,), inverted("v_b_V")),
    Mistake("degrees declared as rad", (UNIT,), (EMF,), _angle_in_radians),
    Mistake("electrical angle", (ELECTRICAL,), (EMF,), scaled((ANGLE,), 5.0)),
    Mistake("electrical angle modulo 360", (ELECTRICAL,), (EMF,), both(scaled((ANGLE,), 5.0), turned(0.0))),
    Mistake("clockwise angle", (DIRECTION,), (EMF,), inverted(ANGLE)),
    Mistake("clockwise angle in all tables", (DIRECTION,), TURNED, inverted(ANGLE)),
    Mistake("factor 2", (UNIT,), (EMF,), scaled(V, 2.0)),
    Mistake("mV for V", (UNIT,), (EMF,), scaled(V, 1000.0)),
    Mistake("rad/s under rpm", (UNIT,), (EMF,), scaled((SPEED,), np.pi / 30)),
    Mistake("line voltages for phase voltages", (LINE,), (EMF,), between_lines),
    Mistake("zero off by a slot", (ZERO,), TURNED, turned(30.0)),
    Mistake("zero off by a pole", (ZERO,), TURNED, turned(36.0)),
    Mistake("zero off by 101.7 degrees", (ZERO,), TURNED, turned(101.7)),
    Mistake("zero off by 14.3 degrees in the back-EMF", (ZERO,), (EMF,), turned(14.3)),
    Mistake("RMS for peak voltages", (PEAK,), (EMF,), scaled(V, 1 / np.sqrt(2))),
    Mistake("sqrt 3 on the voltages", (LINE,), (EMF,), scaled(V, np.sqrt(3))),
    Mistake("v_b late by a row", (SHIFTED,), (EMF,), late("v_b_V")),
    Mistake("angle late by a row", (SHIFTED,), (EMF,), late(ANGLE)),
    Mistake("v_a clipped at 80 %", ("clipped",), (EMF,), clipped("v_a_V", 0.8)),
    Mistake("v_c stuck for a tenth of the rows", ("stuck",), (EMF,), stuck("v_c_V", 0.3, 0.4)),
    Mistake("v_c stuck always", ("stuck",), (EMF,), stuck("v_c_V", 0.0, 1.0)),
    Mistake("torque inverted, locked rotor", (SIGN, MOTOR), (LOCKED,), inverted("torque_Nm")),
    Mistake("torque inverted, both tables", (SIGN, MOTOR), (LOCKED, COG), inverted("torque_Nm")),
    Mistake("mNm for Nm, locked rotor", (UNIT,), (LOCKED,), scaled(("torque_Nm",), 1000.0)),
    Mistake("mNm for Nm, cogging", (UNIT,), (COG,), scaled(("torque_Nm",), 1000.0)),
    Mistake("torque cell not set to zero", ("zero",), (COG,), shifted("torque_Nm", 0.8)),
    Mistake("currents of a generator", (MOTOR, SIGN), (LOCKED,), inverted(*I)),
    Mistake("currents in mA", (UNIT,), (LOCKED,), scaled(I, 1000.0)),
    Mistake("current a and b swapped", (SWAPPED,), (LOCKED,), exchanged(I[:2], I[1::-1])),
    Mistake("resistance in ohm under mohm", (UNIT,), (OHM,), scaled(("r_a_mohm", "r_b_mohm", "r_c_mohm"), 1e-3)),
    Mistake("resistance of two phases in series", (UNIT,), (OHM,), scaled(("r_a_mohm", "r_b_mohm", "r_c_mohm"), 2.0)),
    Mistake("winding temperature in kelvin", (UNIT,), (OHM,), shifted("winding_T_degC", 273.15)),
    Mistake("linkage of phase a inverted", ("inverted_phase",), (FLUX,), inverted("dpsi_a_Vs")),
    Mistake("linkage in mVs", (UNIT,), (FLUX,), scaled(("dpsi_a_Vs", "dpsi_b_Vs", "dpsi_c_Vs"), 1e3)),
    Mistake("clockwise and B, C swapped", (ZERO, SIGN), (EMF,), both(inverted(ANGLE), exchanged(V[1:], V[:0:-1]))),
    Mistake("mV and phase A inverted", (UNIT, "inverted_phase"), (EMF,), both(scaled(V, 1e3), inverted("v_a_V"))),
)  # fmt: skip

FORCE = ("force_N",)
FV, OPEN, Z = "force_velocity.csv", "open_circuit.csv", "impedance.csv"
IMPEDANCE = ("re_Ns_per_m", "im_Ns_per_m")
VELOCITY, SHUNT, HERTZ = "velocity_m_per_s", "shunt_ohm", "frequency_Hz"

_DAMPER = (
    Mistake("force inverted", (SIGN,), (FV,), inverted(*FORCE)),
    Mistake("force of the impedance inverted", (SIGN,), (Z,), inverted(*IMPEDANCE)),
    Mistake("im inverted", (SIGN,), (Z,), inverted("im_Ns_per_m")),
    Mistake("voltage inverted", (SIGN,), (OPEN,), inverted("voltage_V")),
    Mistake("force in kN", (UNIT,), (FV,), scaled(FORCE, 1e-3)),
    Mistake("force in kgf", (UNIT,), (FV,), scaled(FORCE, 1 / 9.80665)),
    Mistake("force in pounds", (UNIT,), (FV,), scaled(FORCE, 1 / 4.4482216)),
    Mistake("velocity in mm/s", (UNIT,), (FV,), scaled((VELOCITY,), 1e3)),
    Mistake("velocity in mm/s, open circuit", (UNIT,), (OPEN,), scaled((VELOCITY,), 1e3)),
    Mistake("mV for V", (UNIT,), (OPEN,), scaled(("voltage_V",), 1e3)),
    Mistake("factor 2 of the voltage", (UNIT,), (OPEN,), scaled(("voltage_V",), 2.0)),
    Mistake("sqrt 3 of the voltage", (LINE,), (OPEN,), scaled(("voltage_V",), np.sqrt(3))),
    Mistake("RMS for the voltage", (PEAK,), (OPEN,), scaled(("voltage_V",), 1 / np.sqrt(2))),
    Mistake("rad/s for Hz", (UNIT,), (Z,), scaled((HERTZ,), 2 * np.pi)),
    Mistake("shunt in mohm", (UNIT,), (FV,), scaled((SHUNT,), 1e3)),
    Mistake("force and velocity exchanged", (COLUMNS,), (FV,), exchanged((VELOCITY, *FORCE), (*FORCE, VELOCITY))),
    Mistake("re and im exchanged", (COLUMNS,), (Z,), exchanged(IMPEDANCE, IMPEDANCE[::-1])),
    Mistake("force late by a row", (SHIFTED,), (FV,), late("force_N")),
    Mistake("velocity late by a row", (SHIFTED,), (FV,), late(VELOCITY)),
    Mistake("im late by a row", (SHIFTED,), (Z,), late("im_Ns_per_m")),
    Mistake("force clipped", ("clipped",), (FV,), clipped("force_N", 0.4)),
    Mistake("force stuck", ("stuck",), (FV,), stuck("force_N", 0.2, 0.3)),
    Mistake("force cell not set to zero", ("zero",), (FV,), shifted("force_N", 2000.0)),
    Mistake("force inverted and in kN", (SIGN, UNIT), (FV,), scaled(FORCE, -1e-3)),
)  # fmt: skip

GRID, DRAG, SHORT = "operation.csv", "drag.csv", "short_circuit.csv"
DQ, VDQ, BRAKE = ("i_d_A", "i_q_A"), ("v_d_V", "v_q_V"), ("torque_Nm", "current_A")

_DQ = (
    Mistake("rad/s under rpm, back-EMF", (UNIT,), (EMF,), scaled((SPEED,), np.pi / 30)),
    Mistake("rad/s under rpm, everywhere", (UNIT,), (EMF, GRID, SHORT, DRAG), scaled((SPEED,), np.pi / 30)),
    Mistake("electrical speed", (ELECTRICAL,), (EMF,), scaled((SPEED,), 4.0)),
    Mistake("electrical speed, operation", (ELECTRICAL,), (GRID,), scaled((SPEED,), 4.0)),
    Mistake("phase for line voltage", (LINE,), (EMF,), scaled(("v_ll_V",), 1 / np.sqrt(3))),
    Mistake("peak for RMS voltage", (PEAK,), (EMF,), scaled(("v_ll_V",), np.sqrt(2))),
    Mistake("mV for V", (UNIT,), (EMF,), scaled(("v_ll_V",), 1e3)),
    Mistake("factor 2", (UNIT,), (EMF,), scaled(("v_ll_V",), 2.0)),
    Mistake("v_d and v_q swapped", (COLUMNS,), (GRID,), exchanged(VDQ, VDQ[::-1])),
    Mistake("i_d and i_q swapped", (COLUMNS,), (GRID,), exchanged(DQ, DQ[::-1])),
    Mistake("RMS currents", (PEAK,), (GRID,), scaled(DQ, 1 / np.sqrt(2))),
    Mistake("RMS voltages", (PEAK,), (GRID,), scaled(VDQ, 1 / np.sqrt(2))),
    Mistake("currents in mA", (UNIT,), (GRID,), scaled(DQ, 1e3)),
    Mistake("torque inverted", (SIGN,), (GRID,), inverted("torque_Nm")),
    Mistake("motoring for generating", (MOTOR,), (GRID,), inverted(*DQ)),
    Mistake("v_d inverted", (SIGN,), (GRID,), inverted("v_d_V")),
    Mistake("torque in mNm", (UNIT,), (GRID,), scaled(("torque_Nm",), 1e3)),
    Mistake("torque in lbf in", (UNIT,), (GRID,), scaled(("torque_Nm",), 1 / 0.11298483)),
    Mistake("braking torque negative", (SIGN,), (SHORT,), inverted("torque_Nm")),
    Mistake("drag gives power", (SIGN,), (DRAG,), inverted("torque_Nm")),
    Mistake("peak for RMS current", (PEAK,), (SHORT,), scaled(("current_A",), np.sqrt(2))),
    Mistake("torque and current exchanged", (COLUMNS,), (SHORT,), exchanged(BRAKE, BRAKE[::-1])),
    Mistake("i_q late by a row", (SHIFTED,), (GRID,), late("i_q_A")),
    Mistake("torque late by a row", (SHIFTED,), (GRID,), late("torque_Nm")),
    Mistake("v_q clipped", ("clipped",), (GRID,), clipped("v_q_V", 0.7)),
    Mistake("torque cell not set to zero", ("zero",), (GRID,), shifted("torque_Nm", 60.0)),
    Mistake("v_q stuck always", ("stuck",), (GRID,), stuck("v_q_V", 0.0, 1.0)),
    Mistake("speed inverted", (SIGN, DIRECTION), (GRID,), inverted(SPEED)),
)  # fmt: skip

MISTAKES: dict[str, tuple[Mistake, ...]] = {"machine": _MACHINE, "damper": _DAMPER, "dq": _DQ}
