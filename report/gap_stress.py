"""Cogging, torque ripple, waves of the radial stress and the magnetic pull for people."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from figures.files import File, figure_file, picture_name, table_file
from figures.gap_stress import gap_stress as gap_stress_figure
from figures.report import Picture, Section, Table
from geometry.machine import dimensions_of
from magnetostatics.case import FieldCase
from magnetostatics.gap_stress import amplitude_of, classical_pull, effective_gap, moving
from magnetostatics.gap_stress_stage import GapStress
from magnetostatics.rotation import STATES, Rotation
from units import DEGREE, FACTORS, MILLIMETRE, percent

WAVES, FIGURE = "gap_stress_waves.csv", "gap_stress"
_IN_REPORT = 10
_SMALL = 1e-3  # of the mean stress; smaller waves are left out
_MPA, _KN = FACTORS["MPa"], FACTORS["kN"]
_TORQUE = (
    "Torque per length over half an electrical period, the current on the q axis at the copper fill of the study; over "
    "the angle it stands in rotation_matched.csv."
)
_ORDERS = (
    "The ten largest waves of the radial stress at the overload current, and the same waves in the other states. "
    "Spatial orders: periods around the gap, negative against the rotor; temporal: multiples of the electrical "
    f"frequency, 0 stands still. More of them are in {WAVES}."
)


def files(found: GapStress) -> Iterator[File]:
    """Waves as a table, and the figure."""
    yield table_file(WAVES, waves_table(found.rotation))
    yield figure_file(FIGURE, gap_stress_figure(found))


def section(found: GapStress, case: FieldCase) -> Section:
    """What shakes the machine: torque over the angle, and the stress on stator and rotor."""
    return Section(
        "Cogging, ripple and radial stress",
        (
            Table(ripple_table(found.rotation), _TORQUE),
            _cogging(found),
            Picture(picture_name(FIGURE), "Radial stress around the gap, its moving waves, cogging and torque ripple."),
            _stress(found.rotation),
            Table(waves_table(found.rotation).head(_IN_REPORT), _ORDERS),
            _pull(found, case),
        ),
    )


def ripple_table(found: Rotation) -> pd.DataFrame:
    """One state with current a row."""
    return pd.DataFrame([_ripple_row(found, state) for state in STATES if state != "no_current"])


def _ripple_row(found: Rotation, state: str) -> dict[str, object]:
    mean, orders = found.mean_torque_per_length(state), list(found.ripple_orders(state).items())[:3]
    return {
        "current": state,
        "mean_torque_Nm_per_m": mean,
        "ripple_peak_to_peak_Nm_per_m": found.ripple(state),
        "ripple_percent": 100 * found.ripple(state) / abs(mean),
        "largest orders of the electrical frequency": ", ".join(f"{one}: {percent(share, 2)}" for one, share in orders),
    }


def waves_table(found: Rotation) -> pd.DataFrame:
    """Waves by their size at the overload current, with those of the other states, in drawing units."""
    states, least = {state: found.waves(state) for state in STATES}, _SMALL * found.mean_stress
    return pd.DataFrame(
        [
            {"spatial_order": wave.spatial_order, "temporal_order": wave.temporal_order}
            | {f"{state}_MPa": amplitude_of(waves, wave) / _MPA for state, waves in states.items()}
            for wave in states["overload"]
            if wave.amplitude > least
        ]
    )


def _cogging(found: GapStress) -> str:
    return (
        f"Without current the torque goes from peak to peak by {found.cogging:.3g} Nm/m every "
        f"{found.rotation.cogging_span / DEGREE:.3g}° of the rotor, solved on triangles of half the size; on the mesh "
        f"of the sweep it is {found.cogging_error:.2g} Nm/m apart."
    )


def _stress(found: Rotation) -> str:
    least = _SMALL * found.mean_stress
    spoken_of = [wave for wave in moving(found.waves("overload")) if wave.amplitude > least]
    bending = [wave for wave in spoken_of if wave.spatial_order]
    lowest = min(bending, key=lambda wave: (abs(wave.spatial_order), -wave.amplitude))
    return (
        f"The stator pulls the magnets outwards with {found.mean_stress / _MPA:.3g} MPa in the mean. Waves of few "
        "periods around the gap bend the stator most: the lowest spatial order that moves at the overload current is "
        f"{lowest.spatial_order} at {lowest.temporal_order} times the electrical frequency, with an amplitude of "
        f"{lowest.amplitude / _MPA:.2g} MPa."
    )


def _pull(found: GapStress, case: FieldCase) -> str:
    machine = dimensions_of(found.rotation.machine)
    gap = effective_gap(machine, case.materials.magnet.recoil_permeability)
    classical = classical_pull(found.rotation.mean_stress, machine.mid_gap_radius, gap)
    idle, overload, formula = (one * found.shift / _KN for one in (*found.pull_per_shift, classical))
    return (
        f"{_centred(found)} With the rotor {found.shift / MILLIMETRE:.3g} mm off centre the stator pulls it further "
        f"out, with {idle:.3g} kN/m of length without current and {overload:.3g} kN/m at the overload; the classical "
        f"formula, for a thin gap and a sinusoidal field, gives {formula:.3g} kN/m."
    )


def _centred(found: GapStress) -> str:
    """What is left of the pull on a rotor in the middle."""
    pull, off_centre = float(found.centred_pull.max()), float(found.pull_per_shift.max()) * found.shift
    if pull < 1e-3 * off_centre:
        return (
            f"A rotor in the middle is pulled nowhere, {pull / _KN:.0e} kN/m on a mesh of the whole machine, which "
            "repeats itself around the gap: the stress has no wave of order 1."
        )
    return f"Even in the middle of the bore the rotor is pulled aside, with up to {pull / _KN:.3g} kN/m of length."
