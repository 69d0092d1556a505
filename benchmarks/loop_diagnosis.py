"""What the workbench says of loops when compliance or backlash is left out of the model of the device.

    python -m benchmarks.loop_diagnosis        # a minute; writes results/reference/loop_diagnosis/

Loops of the virtual bench (another integrator, a contact that is stiff from its beginning) over shunts, strokes and
frequencies become impedances by ``bench.report.impedance`` and a campaign; its device lacks what is to be named. The
tests diagnose the campaigns that this command wrote.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

import numpy as np

from bench.analysis import Settings
from bench.record import Record
from bench.report.impedance import impedance
from benchmarks.virtual_benches.actuator_loops import RAMP, SAMPLING, Drive, Truth, loop_of

OUT = Path("results/reference/loop_diagnosis")
NOISE = 2.0  # N
FORCE_CONSTANT, RESISTANCE = 26.5, 0.0683  # N/A, ohm: thesis table B.1 with the torque constant of table 4.2
FREQUENCIES, STROKES, SHUNTS = (2.0, 6.0, 14.0, 30.0), (3e-4, 1.5e-3), (inf, 0.465)
PERIODS = 8  # that are read
SPRING = Truth(play=0.0, transition=1e-9)  # a contact of table 4.2 that is in full force at once

HEAD = f"""[campaign]
id = "{{name}}"
title = "loops of the virtual bench, python -m benchmarks.loop_diagnosis"

[device]
force_constant_N_per_A = {FORCE_CONSTANT}
internal_resistance_mohm = {1e3 * RESISTANCE:g}
moving_mass_kg = {SPRING.mass:g}
viscous_damping_Ns_per_m = {SPRING.loss:g}
{{known}}
[tolerance]
force_constant = {{{{ sigma_rel = 0.01, source = "virtual bench" }}}}
internal_resistance = {{{{ sigma_rel = 0.01, source = "virtual bench" }}}}
moving_mass = {{{{ sigma_rel = 0.01, source = "virtual bench" }}}}
viscous_damping = {{{{ sigma_rel = 0.05, source = "virtual bench" }}}}

"""


@dataclass(frozen=True)
class Case:
    """name: of the campaign; truth: what made the loops; known: what the device knows of the mount."""

    name: str
    truth: Truth
    known: str


MOUNT = (
    f"mount_stiffness_kN_per_m = {SPRING.stiffness / 1e3:g}\n"
    f"mount_damping_Ns_per_m = {SPRING.contact_damping + SPRING.mount_damping:g}\n"
)
CASES = (
    Case("compliance", SPRING, ""),
    Case("backlash", replace(SPRING, play=5e-5), MOUNT),
)


def record(truth: Truth, shunt: float, stroke: float, frequency: float, rng: np.random.Generator) -> Record:
    """Some periods of a loop, after it has settled; the shunted machine is a viscous loss of the mass."""
    machine = FORCE_CONSTANT**2 / (RESISTANCE + shunt)
    settled = RAMP + 3 / frequency
    drive = Drive(frequency, stroke, 0.0, settled + PERIODS / frequency)
    loop = loop_of(replace(truth, loss=truth.loss + machine), drive, NOISE, rng)
    kept = loop.time >= settled
    channels = {"stroke": loop.stroke[kept], "force": loop.force[kept], "shunt": np.full(kept.sum(), shunt)}
    return Record(f"{frequency:g} Hz, {stroke:g} m, {shunt:g} ohm", 1 / SAMPLING, channels)


def write(case: Case) -> Path:
    """The campaign of a case; returns its folder."""
    rng, folder = np.random.default_rng(0), OUT / case.name
    places = [(shunt, stroke, f) for shunt in SHUNTS for stroke in STROKES for f in FREQUENCIES]
    table = impedance([record(case.truth, *place, rng) for place in places], Settings({})).campaign
    folder.mkdir(parents=True, exist_ok=True)
    table.frame.to_csv(folder / "impedance.csv", index=False, float_format="%.8g")
    text = HEAD.format(name=f"loops-{case.name}", known=case.known) + table.entry("impedance.csv")
    (folder / "campaign.toml").write_text(text, encoding="utf-8")
    return folder


def main() -> None:
    """Write both campaigns."""
    for case in CASES:
        print(f"airgap diagnose {write(case)}")


if __name__ == "__main__":
    main()
