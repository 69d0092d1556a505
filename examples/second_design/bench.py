"""The bench of the story: fills in a drafted campaign. Run: python -m examples.second_design.bench FOLDER RESULTS

What is measured is not the model. The field is GetDP's: another program, weak form and Newton's method, quadratic
triangles on a mesh of another density, at currents on both axes. The circuit is solved on that map. Mesh generator and
steel curve are those of the project. Hidden from the model: magnets with 93 % of their remanence, and a seal that takes
60 mNm. Iron loss is left out on either side.
"""

from __future__ import annotations

import csv
import sys
import tomllib
from dataclasses import dataclass
from math import sqrt
from pathlib import Path

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import fsolve

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
REVERSAL = 0.5  # rad/s, over which the seal's torque turns round
ANGLES = 4  # rotor positions over 60 electrical degrees
DIRECT, QUADRATURE = np.array([-1.2, -0.6, 0.0]), np.array([0.0, 1 / 3, 2 / 3, 1.0])  # of the peak current
TOLERANCE = 1e-6  # of GetDP's residual over the load
DENSITY = MeshDensity(gap_edges=240)
GAIN, SEED = 0.002, 20261122  # of the instruments, drawn once a campaign
ALPHA = 0.00393  # 1/K


@dataclass(frozen=True, eq=False)
class Truth:
    """The machine on the bench: flux linkages of its winding [Vs] over i_d and i_q [A], resistance at 20 degC [ohm]."""

    psi_d: RectBivariateSpline
    psi_q: RectBivariateSpline
    pole_pairs: int
    resistance: float

    def flux(self, i_d: float, i_q: float) -> tuple[float, float]:
        """psi_d, psi_q [Vs]; the map holds i_q >= 0, the other half is its mirror image."""
        return float(self.psi_d(i_d, abs(i_q))[0, 0]), float(np.sign(i_q) * self.psi_q(i_d, abs(i_q))[0, 0])

    def torque(self, i_d: float, i_q: float) -> float:
        """Mean over the rotor angle [Nm]."""
        psi_d, psi_q = self.flux(i_d, i_q)
        return 1.5 * self.pole_pairs * (psi_d * i_q - psi_q * i_d)

    def braking(self, speed: float, shunt: float) -> float:
        """Torque that the rotor must be driven with, terminals closed by a shunt to a phase [Nm]."""
        omega, resistance = self.pole_pairs * speed, self.resistance + shunt

        def voltage(currents: np.ndarray) -> list[float]:
            psi_d, psi_q = self.flux(*currents)
            return [resistance * currents[0] - omega * psi_q, resistance * currents[1] + omega * psi_d]

        return -self.torque(*fsolve(voltage, [-1.0, -np.sign(speed)]))


def built(results: Path) -> Truth:
    """The design of a results folder as it was built."""
    wound = Results(results).load("winding").wound
    points = Results(results).load("winding").limits.current_peak * DIRECT, wound.current_peak(_overload()) * QUADRATURE
    tables = np.array([[mean_flux(wound, i_d, i_q) for i_q in points[1]] for i_d in points[0]])
    scale = wound.turns * wound.active_length
    psi_d, psi_q = (RectBivariateSpline(*points, scale * tables[..., k], kx=2) for k in range(2))
    cold = 1 + ALPHA * (read_study(STUDY).winding_selection.winding_temperature_degC - 20.0)
    return Truth(psi_d, psi_q, wound.machine.pole_pairs, wound.phase_resistance / cold)


def _overload() -> float:
    return read_study(STUDY).sweep.si.j_overload_rms


def mean_flux(wound: WoundMachine, i_d: float, i_q: float) -> np.ndarray:
    """psi_d, psi_q per turn and metre [Wb/m] at phase currents [A], mean over the rotor angle, by GetDP (2,)."""
    case = field_case(read_study(STUDY))
    machine, layout = wound.machine, case.layout(wound.machine)
    section = mesh_cross_section(machine, layout, DENSITY)
    steel = case.materials.stator_steel
    magnet = Magnet(REMANENCE_LEFT * case.materials.magnet.remanence, case.materials.magnet.recoil_permeability)
    area = section.half_slot_area * section.half_slots_per_coil_side
    density, lead = wound.turns * np.hypot(i_d, i_q) / area, np.arctan2(-i_d, i_q)
    found = []
    for step in range(ANGLES):
        angle = (layout.phase_axis + step * np.pi / 3 / ANGLES) / machine.pole_pairs
        state = State("bench", OperatingPoint(float(angle), float(density), float(lead), 1.0))
        field = FieldCase(section, MachineMaterials(steel, steel, magnet), state, "P2", SHORT_LAW)
        solved = solve_getdp(field, TOLERANCE)
        found.append(park(solved.flux_linkage, machine.pole_pairs * angle, layout.phase_axis))
    return np.mean(found, axis=0)


class Instruments:
    """What the bench shows: a gain for each instrument, drawn once, and noise of the declared size."""

    def __init__(self, seed: int):
        self.random = np.random.default_rng(seed)
        self.gains = {name: 1.0 + GAIN * self.random.normal() for name in ("torque", "v", "resistance")}

    def shown(self, heading: str, value: float, noise: float) -> str:
        name = next((one for one in self.gains if heading.startswith(one)), None)
        return f"{self.gains[name] * value + noise * self.random.normal():.6g}"


def seal(speed: float) -> float:
    """Torque of the seal against the motion [Nm] at a speed [rad/s]."""
    return SEAL * float(np.tanh(speed / REVERSAL))


def reading(truth: Truth, kind: str, row: dict[str, float]) -> float:
    """What there is to be read in one row of a table."""
    speed = row.get("speed_rpm", 0.0) * RPM
    if kind == "locked_force":
        return truth.torque(0.0, row["current_A"]) - row["direction"] * SEAL
    if kind == "back_emf":
        return sqrt(1.5) * truth.pole_pairs * speed * truth.flux(0.0, 0.0)[0]
    if kind == "damping_velocity":
        return truth.braking(speed, row["shunt_ohm"]) + seal(speed)
    if kind == "drag":
        return seal(speed)
    return truth.resistance * (1 + ALPHA * (row["winding_T_degC"] - 20.0)) / 1e-3


def measure(folder: Path, truth: Truth, seed: int) -> None:
    """Fill in every table of a drafted campaign."""
    instruments = Instruments(seed)
    for table in tomllib.loads((folder / "campaign.toml").read_text(encoding="utf-8"))["table"]:
        ((heading, noise),) = table["u_random"].items()
        path = folder / table["file"]
        rows = list(csv.DictReader(path.read_text(encoding="utf-8").splitlines()))
        for row in rows:
            known = {key: float(value) for key, value in row.items() if value}
            row[heading] = instruments.shown(heading, reading(truth, table["kind"], known), noise)
        with path.open("w", encoding="utf-8", newline="") as out:
            writer = csv.DictWriter(out, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    measure(Path(sys.argv[1]), built(Path(sys.argv[2])), SEED)
