"""Airgap against scikit-fem, GetDP and NGSolve on identical triangles: ``python -m benchmarks.other_codes``.

Every code solves the same triangles with the same material law, sources and stopping rule, converges with Newton's
method from zero field, and integrates torque and flux linkage itself; GetDP and NGSolve read the law from a table.
scikit-fem solves the forms of ``magnetostatics/weak_form.py``, so that its time against that of this project's solver
is what hand-written assembly and factorisation buy. Times are CPU times (user and system) on one thread, medians over
rounds in which every code runs once; other programs may share the machine.
Writes results/reference/benchmarks/other_codes.json, .csv and .png.
"""

from __future__ import annotations

import csv
import json
from dataclasses import asdict
from pathlib import Path

from threadpoolctl import threadpool_limits

from benchmarks.airgap_run import COLD, PREPARED
from benchmarks.comparison import EXACT, TIMED, USUAL, Agreement, Timing, compare, ratio, time_codes
from benchmarks.getdp_run import AS_INSTALLED, FASTEST, getdp_version
from benchmarks.ngsolve_run import ngsolve_version
from benchmarks.other_codes_figure import draw_comparison
from benchmarks.reference_case import (
    FINE_LAW,
    ORDERS,
    SHORT_LAW,
    FieldCase,
    State,
    reference_materials,
    reference_section,
    reference_states,
)
from benchmarks.this_machine import machine_name
from benchmarks.weak_form_run import SCIKIT_FEM
from figures.style import save_png
from units import MILLIMETRE

RESULTS = Path(__file__).resolve().parent.parent / "results" / "reference" / "benchmarks"
ROUNDS = 7
LARGEST_DIFFERENCE = 2e-4  # of torque and flux linkage
# Of scikit-fem: for less, a second way to solve the same equations would not be worth its lines.
LEAST_RATIOS = {FASTEST.name: 20.0, AS_INSTALLED.name: 20.0, "NGSolve": 10.0, SCIKIT_FEM: 5.0}


def main() -> None:
    """Compare, time, print and write."""
    versions = {"getdp": getdp_version(), "ngsolve": ngsolve_version()}
    with threadpool_limits(1):
        machine = machine_name() | versions
        agreements = [row for case in _cases_to_compare() for row in compare(case)]
        timings = [row for case in _cases_to_time() for row in time_codes(case, ROUNDS)]
    machine["load_average_at_end"] = machine_name()["load_average"]
    ratios = _ratios(timings)
    _print(machine, agreements, timings, ratios)
    _write(machine, agreements, timings, ratios)


def _cases_to_compare() -> list[FieldCase]:
    """All states on the sector, the first one on the whole machine."""
    return _cases(False, reference_states(), FINE_LAW) + _cases(True, reference_states()[:1], FINE_LAW)


def _cases_to_time() -> list[FieldCase]:
    """The first state, on the sector and on the whole machine."""
    return [case for whole in (False, True) for case in _cases(whole, reference_states()[:1], SHORT_LAW)]


def _cases(whole: bool, states: tuple[State, ...], law_tolerance: float) -> list[FieldCase]:
    section, materials = reference_section(whole=whole), reference_materials()
    return [FieldCase(section, materials, state, order, law_tolerance) for order in ORDERS for state in states]


def _ratios(timings: list[Timing]) -> list[dict]:
    """CPU time of each peer over that of this project, cold and prepared, with the least that is wanted."""
    cases = list(dict.fromkeys((t.extent, t.order) for t in timings))
    return [
        {
            "extent": extent,
            "order": order,
            "peer": peer,
            "ratio": ratio(timings, COLD, peer, extent, order),
            "ratio_prepared": ratio(timings, PREPARED, peer, extent, order),
            "wanted": wanted,
        }
        for extent, order in cases
        for peer, wanted in LEAST_RATIOS.items()
    ]


# ---- output -------------------------------------------------------------------------------------------------------


def _print(machine: dict, agreements: list[Agreement], timings: list[Timing], ratios: list[dict]) -> None:
    print(f"{machine['processor']}, {machine['cores']} cores, load {machine['load_average']:.1f}")
    print(f"GetDP {machine['getdp']}; NGSolve {machine['ngsolve']}")
    worst = sorted(agreements, key=lambda row: -max(row.torque_difference, row.flux_difference))
    for row in worst:
        print(
            f"{row.extent:7}{row.order:4}{row.state:18}{row.code:11}T {row.torque:9.4f} Nm/m, differences: torque "
            f"{row.torque_difference:.1e}, flux {row.flux_difference:.1e}, potential {row.potential_difference:.1e}; "
            f"torque with more quadrature points {row.fine_torque_difference:.1e}"
        )
    for row in timings:
        print(f"{row.extent:7}{row.order:4}{row.code:18}{row.iterations:3} iterations {row.cpu_median:8.3f} s CPU")
    for row in sorted(ratios, key=lambda row: row["ratio"] / row["wanted"]):
        print(
            f"{row['extent']:7}{row['order']:4}{row['peer']:16}{row['ratio']:6.1f} times our cold solve (wanted "
            f"{row['wanted']:g}), {row['ratio_prepared']:.1f} times the prepared one"
        )


def _write(machine: dict, agreements: list[Agreement], timings: list[Timing], ratios: list[dict]) -> None:
    RESULTS.mkdir(parents=True, exist_ok=True)
    content = {
        "machine": machine,
        "mesh": _mesh_facts(),
        "settings": {"residual_compared": EXACT, "residual_timed": USUAL, "rounds": ROUNDS, "timed": TIMED},
        "largest_difference_accepted": LARGEST_DIFFERENCE,
        "largest_difference": max(max(row.torque_difference, row.flux_difference) for row in agreements),
        "ratios": ratios,
        "agreement": [asdict(row) for row in agreements],
        "timing": [asdict(row) | {"cpu_median": row.cpu_median, "wall_median": row.wall_median} for row in timings],
    }
    (RESULTS / "other_codes.json").write_text(json.dumps(content, indent=2) + "\n")
    _write_table(agreements, timings)
    save_png(draw_comparison(agreements, timings), RESULTS / "other_codes.png")


def _mesh_facts() -> dict:
    section = reference_section()
    return {
        "triangles_in_sector": section.mesh.nelements,
        "mid_gap_radius_mm": section.machine.mid_gap_radius / MILLIMETRE,
        "slots": section.machine.slots,
        "poles": section.machine.poles,
    }


def _write_table(agreements: list[Agreement], timings: list[Timing]) -> None:
    """One row a case and code: first the differences of the peers, then the times of all."""
    columns = (
        *("extent", "order", "state", "code", "torque_Nm_per_m", "airgap_torque_Nm_per_m", "torque_difference"),
        *("flux_difference", "potential_difference", "torque_difference_with_7_points", "unknowns", "iterations"),
        *("cpu_median_s", "cpu_lowest_s", "cpu_highest_s", "wall_median_s"),
    )
    rows = [(*asdict(row).values(), *[""] * 6) for row in agreements]
    for row in timings:
        times = (row.cpu_median, min(row.cpu), max(row.cpu), row.wall_median)
        case = row.extent, row.order, row.state, row.code
        rows.append((*case, row.torque, *[""] * 5, row.unknowns, row.iterations, *times))
    with open(RESULTS / "other_codes.csv", "w", newline="") as file:
        csv.writer(file).writerows([columns, *rows])


if __name__ == "__main__":
    main()
