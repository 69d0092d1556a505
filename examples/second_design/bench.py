"""The bench of the story. Run: python -m examples.second_design.bench CAMPAIGN RESULTS

Fills in the drafted campaign of a design as it was built. What is measured is not the model: the flux linkages are
GetDP's, another program with its own weak form and Newton's method, on quadratic triangles of another density. Mesh
generator and steel curve are those of the project. Hidden are magnets with 93 % of their remanence, and a seal that
takes 60 mNm. Iron loss is left out on either side. What GetDP found stays in truth.json beside the campaign, so that
the instruments can be read again without it.
"""

from __future__ import annotations

import csv
import json
import sys
import tomllib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from math import pi, sqrt
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.getdp_run import solve_getdp
from benchmarks.reference_case import SHORT_LAW, FieldCase, State
from electrical.wound_machine import WoundMachine
from geometry.cross_section import mesh_cross_section
from geometry.half_cell import MeshDensity
from magnetostatics.flux_linkage import park
from magnetostatics.model import MachineMaterials, OperatingPoint
from materials.magnet import Magnet
from pipeline.results import Results
from study.inputs_field import field_case
from study.read import read_study
from units import RPM

STUDY = Path(__file__).with_name("pump.toml")
REMANENCE_LEFT, SEAL = 0.93, 0.06  # share; Nm
ANGLES = 4  # rotor positions over 60 electrical degrees
SHARES = np.linspace(0.0, 1.0, 5)  # of the peak current, on the q axis
TOLERANCE = 1e-6  # of GetDP's residual over the load
DENSITY = MeshDensity(gap_edges=240)
GAIN, SEED = 0.002, 20261122  # of the instruments, drawn once a campaign
ALPHA = 0.00393  # 1/K, copper

Row = dict[str, float]


@dataclass(frozen=True)
class Truth:
    """The machine on the bench.

    currents: on the q axis [A peak];  psi_d, psi_q: flux linkages there [Vs];  resistance: of a phase at 20 degC [ohm]
    continuous: current of the torque that is asked for good [A peak]
    """

    pole_pairs: int
    currents: tuple[float, ...]
    psi_d: tuple[float, ...]
    psi_q: tuple[float, ...]
    resistance: float
    continuous: float

    def flux(self, i_q: float) -> tuple[float, float]:
        """psi_d, psi_q [Vs] at a current on the q axis [A]."""
        d, q = (float(CubicSpline(self.currents, one)(abs(i_q))) for one in (self.psi_d, self.psi_q))
        return d, float(np.sign(i_q)) * q

    def shaft_torque(self, i_q: float, speed: float) -> float:
        """Mean over a turn, behind the seal [Nm]."""
        return 1.5 * self.pole_pairs * self.flux(i_q)[0] * i_q - SEAL * float(np.sign(speed))


def built(results: Path) -> Truth:
    """The design of a results folder as it was built, solved by GetDP."""
    study, winding = read_study(STUDY), Results(results).load("winding")
    wound: WoundMachine = winding.wound
    currents = winding.limits.current_peak * SHARES
    flux = wound.equivalent_turns * wound.active_length * np.array([mean_flux(wound, float(i_q)) for i_q in currents])
    warm = 1 + ALPHA * (study.winding_selection.winding_temperature_degC - 20.0)
    continuous = wound.current_peak(study.sweep.si.j_nominal_rms)
    psi_d, psi_q = (tuple(column) for column in flux.T.tolist())
    cold = wound.phase_resistance / warm
    return Truth(wound.machine.pole_pairs, tuple(currents.tolist()), psi_d, psi_q, cold, continuous)


def mean_flux(wound: WoundMachine, i_q: float) -> np.ndarray:
    """psi_d, psi_q per turn and metre [Wb/m] at a current on the q axis [A], mean over the rotor angle (2,)."""
    case, machine = field_case(read_study(STUDY)), wound.machine
    layout = case.layout(machine)
    section = mesh_cross_section(machine, layout, DENSITY)
    steel, drawn = case.materials.stator_steel, case.materials.magnet
    materials = MachineMaterials(steel, steel, Magnet(REMANENCE_LEFT * drawn.remanence, drawn.recoil_permeability))
    density = wound.equivalent_turns * i_q / (section.half_slot_area * section.half_slots_per_coil_side)
    found = []
    for angle in (layout.phase_axis + pi / 3 * np.arange(ANGLES) / ANGLES) / machine.pole_pairs:
        state = State("bench", OperatingPoint(float(angle), density, 0.0, 1.0))
        solved = solve_getdp(FieldCase(section, materials, state, "P2", SHORT_LAW), TOLERANCE)
        found.append(park(solved.flux_linkage, machine.pole_pairs * angle, layout.phase_axis))
    return np.mean(found, axis=0)


def _emf(truth: Truth, row: Row) -> dict[str, float]:
    return {"v_ll_V": sqrt(1.5) * truth.pole_pairs * row["speed_rpm"] * RPM * truth.flux(0.0)[0]}


def _operation(truth: Truth, row: Row) -> dict[str, float]:
    speed, i_q = row["speed_rpm"] * RPM, row["i_q_A"]
    psi_d, psi_q = truth.flux(i_q)
    omega = truth.pole_pairs * speed
    torque = truth.shaft_torque(i_q, speed)
    return {"v_d_V": -omega * psi_q, "v_q_V": truth.resistance * i_q + omega * psi_d, "torque_Nm": torque}


def _drag(truth: Truth, row: Row) -> dict[str, float]:
    return {"torque_Nm": SEAL * float(np.sign(row["speed_rpm"]))}


def _resistance(truth: Truth, row: Row) -> dict[str, float]:
    return {"resistance_mohm": 1e3 * truth.resistance * (1 + ALPHA * (row["winding_T_degC"] - 20.0))}


READ: dict[str, Callable[[Truth, Row], dict[str, float]]] = {
    "back_emf": _emf, "dq_operation": _operation, "drag": _drag, "phase_resistance": _resistance,
}  # fmt: skip


def measure(folder: Path, truth: Truth) -> None:
    """Fill in every table of a drafted campaign: a gain for each instrument, and noise of the declared size."""
    random = np.random.default_rng(SEED)
    gains = {name: 1.0 + GAIN * random.normal() for name in ("torque", "v", "resistance")}
    for table in tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))["table"]:
        path = folder / table["file"]
        rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
        for row in rows:
            set_there = {key: float(value) for key, value in row.items() if value and key not in table["u_random"]}
            for heading, value in READ[table["kind"]](truth, set_there).items():
                shown = gains[heading.split("_")[0]] * value + table["u_random"][heading] * random.normal()
                row[heading] = f"{shown:.6g}"
        with path.open("w", encoding="utf-8", newline="") as out:
            writer = csv.DictWriter(out, list(rows[0]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def measured_torque(folder: Path, current: float) -> float:
    """Shaft torque that the bench read at a motoring current [A peak], straight between its rows [Nm]."""
    rows = list(csv.DictReader((folder / "operation.csv").read_text(encoding="utf-8").splitlines()))
    points = sorted((float(row["i_q_A"]), float(row["torque_Nm"])) for row in rows if float(row["i_q_A"]) >= 0)
    currents = sorted({i for i, _ in points})
    means = [np.mean([torque for i, torque in points if i == at]) for at in currents]
    return float(np.interp(current, currents, means))


def truth_of(folder: Path, results: Path) -> Truth:
    """What stands in truth.json of a campaign; else what GetDP finds, which is then put there."""
    path = folder / "truth.json"
    if not path.exists():
        path.write_text(json.dumps(asdict(built(results)), indent=1) + "\n", encoding="utf-8")
    content = json.loads(path.read_text(encoding="utf-8"))
    return Truth(**{key: tuple(value) if isinstance(value, list) else value for key, value in content.items()})


if __name__ == "__main__":
    campaign = Path(sys.argv[1])
    machine = truth_of(campaign, Path(sys.argv[2]))
    measure(campaign, machine)
    reached, asked = measured_torque(campaign, machine.continuous), read_study(STUDY).drive.torque_rms_Nm
    verdict = "holds" if reached >= asked else "DOES NOT HOLD"
    print(f"continuous torque on the bench {reached:.3f} Nm, {asked:.3f} Nm asked: {verdict}")
