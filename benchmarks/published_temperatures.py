"""The thermal network against a machine whose temperatures were measured.

``python -m benchmarks.published_temperatures``: the traction motor of the Prius 2004 on the bench of Oak Ridge National
Laboratory (``measurements/prius-2004-heat``), in steady state at four temperatures of its coolant. Slot, iron, wires
and what the copper loses at its temperatures are those of ``thermal``, from the drawing and the resistance of the
winding. Two conductances that no drawing gives are taken from the hottest and the coldest coolant: from the casing to
the coolant, with what the contact of stator and casing is off by, and from the end windings to the oil, whose
temperature was measured. The other tests are predicted. So how heat divides between slots and ends, and how it grows
with load and resistance, is held against a machine; contact, jacket and films are not.

Writes results/reference/benchmarks/published_temperatures.csv.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.optimize import least_squares

from electrical.winding_connection import SERIES_STAR
from electrical.winding_design import WindingDesign
from electrical.wire import Wire
from electrical.wound_machine import WoundMachine
from geometry.machine import Machine
from materials.conductor import COPPER
from pipeline.modules import PROJECT
from thermal.cooling import Cooling
from thermal.machine import AMBIENT, CASING, END_AIR, ENDS, SLOT, TEETH, YOKE, Casing, CooledMachine, Weights
from thermal.network import Heat, Link, Network, Temperatures, settled
from units import MILLIMETRE, RPM

DATA = PROJECT / "measurements" / "prius-2004-heat"
SWEEPS = PROJECT / "measurements" / "prius-2004"
TABLE = PROJECT / "results" / "reference" / "benchmarks" / "published_temperatures.csv"
COOLANT, OIL = "coolant", "oil"

# Dimensions, wires and masses: ORNL/TM-2010/253, comparison of designs, column of the 2004 motor. Straight teeth stand
# for those of ``machines/prius_2004.toml``, and leave its slot its area.
SLOTS, BORE, OUTSIDE, LENGTH = 48, 80.95 * MILLIMETRE, 134.62 * MILLIMETRE, 83.82 * MILLIMETRE
SLOT_DEPTH, TOOTH, OPENING = 33.5 * MILLIMETRE, 6.2 * MILLIMETRE, 1.93 * MILLIMETRE
RISING = {"torque_sweep_35C.csv": 34.6, "torque_sweep_75C.csv": 73.9}  # coolant [degC]
COLD, RESISTANCE = 21.0, 0.069  # degC, ohm of a phase
TURNS, WIRES, COILS = 9, 13, 8  # of a coil; coils in series of a phase
AWG_19 = 0.912 * MILLIMETRE  # bare; ASTM B258
ENAMEL = 0.08 * MILLIMETRE  # both sides, of heavy build; estimate
CORE, COPPER_MASS, ROTOR_MASS, CASING_MASS = 19.05, 6.8, 10.2, 8.9  # kg
CORE_LOSS = 40.0  # W at 60 Hz: 2 W/kg, of some 1.2 T in a sheet of 0.33 mm; estimate, 2 % of the heat


@dataclass(frozen=True)
class MeasuredEnds(WoundMachine):
    """A winding whose end turns are as long as its measured resistance asks for."""

    @property
    def end_turn_length(self) -> float:
        """[m]"""
        wires = RESISTANCE * WIRES * self.design.wire.area / float(COPPER.resistivity(COLD))
        return wires / (2 * TURNS * COILS) - LENGTH


@dataclass(frozen=True)
class Sinks:
    """What no drawing gives: from the casing to the coolant, from the end windings to the oil [W/K]."""

    casing: float
    ends: float


@dataclass(frozen=True)
class BenchState:
    """One steady state: temperatures of the coolant and of the oil [degC]; current: RMS of a phase [A]."""

    coolant: float
    oil: float
    current: float


@dataclass(frozen=True, eq=False)
class WarmMachine:
    """The motor on the bench, a ``thermal.network.Body``."""

    machine: CooledMachine
    sinks: Sinks
    state: BenchState

    def network(self, temperature: Temperatures) -> Network:
        """That of the machine, oil in the place of the air in its ends, and coolant around the casing."""
        drawn = self.machine.network(temperature)
        inside = [one for one in drawn.links if not {AMBIENT, END_AIR} & {one.first, one.second}]
        nodes = tuple(node for node in drawn.nodes if node.name != END_AIR)
        sinks = Link(CASING, COOLANT, self.sinks.casing), Link(ENDS, OIL, self.sinks.ends)
        return Network(nodes, (*inside, *sinks), {COOLANT: self.state.coolant, OIL: self.state.oil})

    def heat(self, temperature: Temperatures) -> Heat:
        """Of the copper by its temperatures, and of the core [W]; temperature: [degC]."""
        ends = self.machine.wound.end_turn_share
        cold = 3 * RESISTANCE * self.state.current**2
        shares = {SLOT: 1 - ends, ENDS: ends}
        copper = {place: cold * share * _warmer(temperature[place]) for place, share in shares.items()}
        return copper | {TEETH: CORE_LOSS / 2, YOKE: CORE_LOSS / 2}

    def warm(self) -> dict[str, float]:
        """The steady state [degC]."""
        start = self.machine.cold() | {COOLANT: self.state.coolant, OIL: self.state.oil}
        return settled(self, start)

    def winding(self) -> float:
        """The hottest place of the winding [degC]."""
        return self.machine.hottest_copper(self.warm())

    def loss(self) -> float:
        """Electrical, in steady state [W]."""
        return sum(self.heat(self.warm()).values())


def _warmer(temperature: float) -> float:
    """Resistance over that at which it was measured; temperature: [degC]."""
    return float(COPPER.resistivity(temperature) / COPPER.resistivity(COLD))


def drawn_machine() -> CooledMachine:
    """The motor in its casing at 900 rpm; its rotor, which loses next to nothing at 60 Hz, as a ring of magnets."""
    machine = Machine(
        slots=SLOTS, pole_pairs=4, stator_outer_radius=OUTSIDE, rotor_outer_radius=BORE - 0.73 * MILLIMETRE,
        back_iron_width=OUTSIDE - BORE - SLOT_DEPTH, tooth_width=TOOTH, magnet_length=6.5 * MILLIMETRE,
        airgap=0.73 * MILLIMETRE, slot_opening=OPENING, shoe_d1=1.0 * MILLIMETRE, shoe_d2=0.5 * MILLIMETRE,
        shaft_radius=55.3 * MILLIMETRE,
    )  # fmt: skip
    wire = Wire(AWG_19, AWG_19 + ENAMEL, float(COPPER.resistivity(COLD)))
    design = WindingDesign(TURNS, WIRES, wire, SERIES_STAR)
    return CooledMachine(
        wound=MeasuredEnds(machine, COILS, 6, design, LENGTH),
        weights=Weights(copper=COPPER_MASS, stator=CORE, rotor=ROTOR_MASS, magnets=1.2, shaft=0.0),
        stacking=0.95,
        casing=Casing(299 * MILLIMETRE, 205 * MILLIMETRE, CASING_MASS, 15 * MILLIMETRE, 45 * MILLIMETRE),
        cooling=Cooling(),
        speed=900 * RPM,
    )


def continuous() -> pd.DataFrame:
    """The tests that were held until they stood."""
    return pd.read_csv(DATA / "continuous.csv")


def rising(name: str) -> pd.DataFrame:
    """A torque sweep of the electrical campaign, whose magnets have the temperature of the oil [degC]."""
    return pd.read_csv(SWEEPS / name).rename(columns={"magnet_T_degC": "oil_T_degC"})


def states_of(table: pd.DataFrame, coolant: float | None = None) -> list[BenchState]:
    """One a row; coolant: [degC], None where the table has its own."""
    coolants = table.coolant_T_degC if coolant is None else [coolant] * len(table)
    return [BenchState(*row) for row in zip(coolants, table.oil_T_degC, table.current_A)]


def identified(machine: CooledMachine, tests: Sequence[BenchState], measured: Sequence[float]) -> Sinks:
    """The two conductances that give the temperatures of the winding [degC] of some tests."""

    def off(logarithms: np.ndarray) -> np.ndarray:
        sinks = Sinks(*np.exp(logarithms).tolist())
        return np.array([WarmMachine(machine, sinks, one).winding() for one in tests]) - np.array(measured)

    return Sinks(*np.exp(least_squares(off, np.log([50.0, 15.0])).x).tolist())


def compared(machine: CooledMachine, sinks: Sinks, table: pd.DataFrame, coolant: float | None = None) -> pd.DataFrame:
    """Measured and predicted temperature of the winding and electrical loss, one test a row; coolant: [degC]."""
    warm = [WarmMachine(machine, sinks, one) for one in states_of(table, coolant)]
    shaft = table.torque_Nm * table.speed_rpm * RPM
    friction = table.get("friction_W", 160.0)
    return pd.DataFrame(
        {
            "coolant_degC": [one.state.coolant for one in warm],
            "torque_Nm": table.torque_Nm,
            "winding_measured_degC": table.winding_T_degC,
            "winding_predicted_degC": [one.winding() for one in warm],
            "electrical_loss_measured_W": table.power_W - shaft - friction,
            "electrical_loss_predicted_W": [one.loss() for one in warm],
        }
    )


def main() -> None:
    """Identify at the ends, predict between, write and print."""
    machine, table = drawn_machine(), continuous()
    ends = table.iloc[[0, -1]]
    sinks = identified(machine, states_of(ends), ends.winding_T_degC.tolist())
    held = compared(machine, sinks, table).assign(test=["identified", "predicted", "predicted", "identified"])
    sweeps = [
        compared(machine, sinks, rising(name), coolant).assign(test="rising load") for name, coolant in RISING.items()
    ]
    found = pd.concat([held, *sweeps])
    found.round(1).to_csv(TABLE, index=False, lineterminator="\n")
    print(found.round(1).to_string(index=False))
    print(f"casing to coolant {sinks.casing:.1f} W/K, end windings to oil {sinks.ends:.1f} W/K")


if __name__ == "__main__":
    main()
