"""What the benches would read of a designed actuator, for people, beside what the thesis read of its prototype."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np
import pandas as pd

from bench.force_loops import MASS, NOMINAL
from bench.report import pictures
from bench.report.identified import identification_remarks
from bench.report.simulated_figures import active_mode, chirp, impedance, in_the_loop, quadrant_maps, static_shunts
from bench.simulated import BENCH_FORCE, BenchTests
from figures.files import File, figure_file, picture_name, table_file
from figures.report import Part, Picture, Remark, Section, Table
from units import FACTORS, GRAVITY, MICROHENRY, MILLIOHM, split_unit

PARAMETERS, SHUNTS, LOOPS = "bench_parameters.csv", "bench_shunts.csv", "bench_loops.csv"
STATIC, QUADRANTS, IMPEDANCE = "bench_static", "bench_quadrants", "bench_impedance"
CHIRP, ACTIVE = "bench_chirp", "bench_active_mode"
FORCE_LOOPS, HIL = "bench_force_loops", "bench_in_the_loop"


@dataclass(frozen=True)
class PrintedShunt:
    """A row of Table 5.1: damping [Ns/m], best efficiency (dimensionless) and power [W], nan where none is printed."""

    damping: float
    efficiency: float
    power: float


_NONE = float("nan")
PRINTED_SHUNTS = {
    inf: PrintedShunt(70.0, _NONE, _NONE), 0.465: PrintedShunt(1370.0, 0.599, 146.8),
    0.135: PrintedShunt(3380.0, 0.422, 48.7), 0.055: PrintedShunt(5780.0, 0.277, 26.4),
    0.0: PrintedShunt(19570.0, _NONE, _NONE),
}  # fmt: skip
# Gains of Table 4.2 by the names of ``bench.force_loops.NOMINAL``; Table 4.3 in the order of ``bench.simulated.LOOPS``
PRINTED_GAINS = dict(zip(NOMINAL, (1.100, 0.046, 1.352, 5.452, 2.558, 1.519, 0.590, 0.866), strict=True))
PRINTED_MATCHES = ((63.0, 1.75), (307.0, 1.79), (128.0, -0.27))  # N, %
PRINTED_RESONANCE = "60 to 70"  # Hz, text to Fig. 5.13
PRINTED_BEST = (82.0, 74.0)  # %, best efficiency of the controlled machine, passive (Fig. 5.6) and active (Fig. 5.8)


def files(found: BenchTests) -> Iterator[File]:
    """Tables and figures."""
    yield table_file(PARAMETERS, parameter_table(found))
    yield table_file(SHUNTS, shunt_table(found))
    yield table_file(LOOPS, loop_table(found))
    yield figure_file(STATIC, static_shunts(found))
    yield figure_file(QUADRANTS, quadrant_maps(found))
    yield figure_file(IMPEDANCE, impedance(found))
    yield figure_file(CHIRP, chirp(found))
    yield figure_file(ACTIVE, active_mode(found))
    yield figure_file(FORCE_LOOPS, pictures.loops(found.matches))
    yield figure_file(HIL, in_the_loop(found))


def section(found: BenchTests) -> Section:
    """Chapter 5, appendix B and the identification of section 4.3.1."""
    return Section(
        "On the benches of the thesis",
        (_TEXT, *_steady(found), *_over_frequency(found), *_identified(found), *_in_the_loop(found), _sound()),
    )


_TEXT = (
    "What the benches of thesis chapter 5 would read of this actuator, simulated with its own description, and read "
    "with the tools of “airgap analyse”. The thesis's numbers are measurements of its automotive prototype. Mount, "
    "torque lag and friction are as good as what the study states of them."
)


def _steady(found: BenchTests) -> tuple[Part, ...]:
    """At constant speed, shunted and controlled."""
    return (
        Table(lumped_table(found), "Lumped parameters (Table B.1)."),
        Table(shunt_table(found), f"Shunted machine behind a diode bridge (Table 5.1). The power is that at "
              f"{BENCH_FORCE:g} N, where the thesis's own rows ended. The printed open circuit is a straight line "
              "through a curve that bends; its short circuit fits no model of its other rows."),
        Picture(picture_name(STATIC), "Force (a) and conversion efficiency (b) at constant speed (Fig. 5.4)."),
        Picture(picture_name(QUADRANTS), _best_words(found)),
    )  # fmt: skip


def _over_frequency(found: BenchTests) -> tuple[Part, ...]:
    return (
        Picture(picture_name(IMPEDANCE), "Mechanical impedance at 1 mm of stroke: shunted (Figs 5.9 and B.2), and "
                "with a damping asked for without force loop (Fig. 5.10)."),
        Picture(picture_name(CHIRP), "The chirp over time (Fig. 5.12)."),
        Picture(picture_name(ACTIVE), _resonance_words(found)),
    )  # fmt: skip


def _identified(found: BenchTests) -> tuple[Part, ...]:
    """Parameters from force loops, and how well they describe them."""
    return (
        Table(parameter_table(found), "Parameters identified from the loops below (Table 4.2), 90 % intervals."),
        *(Remark(line) for line in identification_remarks(found.identification)),
        *_missed(found),
        Table(match_table(found), "The identified model beside the loops (Table 4.3): gears, dry friction and a ratio "
              "that varies are in the loops and not in the model."),
        Picture(picture_name(FORCE_LOOPS), "Force over stroke and over time (Figs 4.19 and 4.20)."),
    )  # fmt: skip


def _in_the_loop(found: BenchTests) -> tuple[Part, ...]:
    return (
        Table(loop_table(found), "In the loop with the thesis's quarter car, 1000 Ns/m asked for (section 5.5); "
              "“airgap hil” runs it by the clock."),
        Picture(picture_name(HIL), "In the loop: heights, stroke, force, felt acceleration, road holding (Fig. 5.16), "
                "powers and battery current (Fig. 5.17)."),
    )  # fmt: skip


def _sound() -> Table:
    return Table(sound_table(), "Sound pressure levels measured in the thesis (Table 5.2). None is computed: nothing "
                 "here knows how a casing radiates; “airgap analyse sound” reads one's own records.")  # fmt: skip


# Table 5.2: velocity [mm/s], frequency [Hz] (0: constant), levels in front and at the side [dBA]
PRINTED_SOUND = (
    (96.0, 0.0, 36.03, 36.92), (178.0, 0.0, 42.3, 44.08), (341.0, 0.0, 47.89, 49.63), (41.0, 2.0, 37.07, 35.23),
    (62.0, 1.5, 37.01, 37.36), (328.0, 1.0, 46.97, 48.69),
)  # fmt: skip


def sound_table() -> pd.DataFrame:
    """Table 5.2 as printed."""
    names = ["velocity_mm_per_s", "frequency_Hz", "front / dBA", "side / dBA"]
    return pd.DataFrame(PRINTED_SOUND, columns=names)


def lumped_table(found: BenchTests) -> pd.DataFrame:
    """Table B.1 beside the actuator's."""
    one, machine = found.lumped, found.lumped.machine
    rows = (
        ("m_eq / kg", one.equivalent_mass, 5.6),
        ("c_eq / (Ns/m)", one.viscous_friction, 250.0),
        ("k_m / (kN/m)", one.mount_stiffness / FACTORS["kN_per_m"], 200.0),
        ("c_m / (Ns/m)", one.mount_damping, 50.0),
        ("L_ph / µH", float(np.mean([machine.inductance_d, machine.inductance_q])) / MICROHENRY, 348.7),
        ("R_ph / mΩ", float(machine.resistance) / MILLIOHM, 68.3),
        ("K_t / (mNm/A)", float(machine.torque_constant) / FACTORS["mNm_per_A"], 49.3),
        ("mount resonance / Hz", one.natural_frequency, (2e5 / 5.6) ** 0.5 / (2 * np.pi)),
    )
    return pd.DataFrame([{"quantity": name, "here": here, "thesis": printed} for name, here, printed in rows])


def shunt_table(found: BenchTests) -> pd.DataFrame:
    """Table 5.1 beside the actuator's."""
    return pd.DataFrame(
        [
            {
                "shunt": pictures.shunt_words(min(row.shunt, 1e9)),
                "damping_kNs_per_m": row.damping / FACTORS["kNs_per_m"],
                "damping_thesis_kNs_per_m": PRINTED_SHUNTS[row.shunt].damping / FACTORS["kNs_per_m"],
                "best_efficiency_percent": 100 * row.best_efficiency,
                "best_efficiency_thesis_percent": 100 * PRINTED_SHUNTS[row.shunt].efficiency,
                "power_W": row.most_power,
                "power_thesis_W": PRINTED_SHUNTS[row.shunt].power,
            }
            for row in found.shunts
        ]
    )


def parameter_table(found: BenchTests) -> pd.DataFrame:
    """Table 4.2: stated, identified with its interval, and the thesis's prototype."""
    return pd.DataFrame([row for row in _parameters(found)])


def _parameters(found: BenchTests) -> Iterator[dict[str, object]]:
    for one in found.identification.found:
        quantity, unit = split_unit(one.unknown.name)
        factor = FACTORS[unit]
        yield {
            "parameter": quantity.replace("_", " "),
            "unit": unit.replace("_per_", "/"),
            "stated": found.true[one.unknown.name] / factor,
            "identified": one.value / factor,
            "low90": one.interval[0] / factor,
            "high90": one.interval[1] / factor,
            "thesis": NOMINAL[one.unknown.name] * PRINTED_GAINS[one.unknown.name] / factor,
        }


def _missed(found: BenchTests) -> Iterator[Remark]:
    """What of the stated mass the fit misses, and why that may be."""
    missed = found.identification.values[MASS] / found.true[MASS] - 1
    if abs(missed) > _OFF:
        yield Remark(
            f"The identified mass is {100 * missed:+.0f} % off the stated one: the model of Table 4.2 has no gear "
            "losses and no dry friction, which its parameters take over."
        )


_OFF = 0.05


def match_table(found: BenchTests) -> pd.DataFrame:
    """Table 4.3 beside the actuator's."""
    rows = zip(found.matches, PRINTED_MATCHES, strict=True)
    return pd.DataFrame(
        [
            {
                "loop": match.loop.name,
                "largest_mismatch_N": match.largest_mismatch,
                "largest_mismatch_thesis_N": printed[0],
                "energy_error_percent": 100 * match.energy_error,
                "energy_error_thesis_percent": printed[1],
            }
            for match, printed in rows
        ]
    )


def loop_table(found: BenchTests) -> pd.DataFrame:
    """Tests in the loop, one a row."""
    return pd.DataFrame([_loop_row(row.low_level, row.numbers, row.lost) for row in found.in_the_loop])


def _loop_row(control: str, numbers: dict[str, float], lost: bool) -> dict[str, object]:
    names = ("wanted_rms_N", "force_rms_N", "force_error_rms_N", "force_peak_N")
    shown: dict[str, object] = {name: numbers[name] for name in names}
    comfort = numbers["comfort_rms_m_per_s2"] / GRAVITY
    return {"force control": control, **shown, "comfort / g": comfort, "lost": lost}


def _best_words(found: BenchTests) -> str:
    data = found.quadrants
    passive = data.efficiency.where(data.force > 0).max()
    active = data.efficiency.where(data.force < 0).max()
    return (
        "Controlled machine at constant speed, in rebound: power to the battery (a) and efficiency (b), at best "
        f"{100 * float(passive):.0f} % passive and {100 * float(active):.0f} % active; measured "
        f"{PRINTED_BEST[0]:g} and {PRINTED_BEST[1]:g} % (Figs 5.6 and 5.8). White: power flows in from both sides."
    )


def _resonance_words(found: BenchTests) -> str:
    peak = float(found.active.frequency[int(np.argmax(found.active.force.values))])
    return (
        f"Output held, a chirp of 2 A on 12 A (Fig. 5.13): force over current (a) with its resonance at {peak:.0f} Hz "
        f"({PRINTED_RESONANCE} Hz measured), angle over force (b), coherence (c)."
    )
