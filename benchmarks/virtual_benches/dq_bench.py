"""A servo motor on the bench: back-EMF, drag, short circuit, and voltages and torque over currents and speed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from benchmarks.virtual_benches.dq_truth import TrueMachine, back_emf, drag, operation, short_circuit
from benchmarks.virtual_benches.hiding import Hidden, Layout, Setup

RPM = np.pi / 30
EMF_SPEEDS = np.linspace(250.0, 3000.0, 12)  # rpm
DRAG_SPEEDS = np.array([150, 400, 800, 1300, 2000, 2800, -150, -400, -800, -1300, -2000, -2800.0])  # rpm
SHORT_SPEEDS = np.array([100, 200, 400, 700, 1100, 1600, 2200, 3000.0])  # rpm
SPEEDS = np.array([500.0, 1400.0, 2800.0])  # rpm, of the grid of currents
I_D, I_Q = np.array([0.0, -8.0, 5.0]), np.array([-16.0, -8.0, 8.0, 16.0, 24.0])  # A
COPPER = 0.00393  # 1/K, IEC 60028
FUNDAMENTAL = 4 / np.pi  # of a square wave

TOLERANCE = {  # relative
    "psi_m_Vs": 0.01,
    "inductance_d_H": 0.03,
    "inductance_q_H": 0.03,
    "resistance_ohm": 0.02,
}

@dataclass(frozen=True)
class State:
    """The machine in truth and what its instruments do. Gains relative, the rest SI."""

    machine: TrueMachine
    torque_gain: float = 0.0
    torque_offset: float = 0.0
    torque_drift: float = 0.0
    voltage_gain: float = 0.0
    current_gain: float = 0.0
    speed_gain: float = 0.0
    rotor_zero: float = 0.0


def _machine(field: str, state: State, size: float) -> State:
    return replace(state, machine=replace(state.machine, **{field: getattr(state.machine, field) + size}))


def _scaled(fields: tuple[str, ...], powers: tuple[int, ...], state: State, size: float) -> State:
    m = state.machine
    return replace(state, machine=replace(m, **{f: getattr(m, f) * (1 + size) ** n for f, n in zip(fields, powers)}))


def _warm(state: State, rise: float) -> State:
    return _scaled(("resistance",), (1,), state, COPPER * rise)


def _weak(state: State, loss: float) -> State:
    return _scaled(("psi_m",), (1,), state, -loss)


def _dead_time(state: State, drop: float) -> State:
    return replace(state, machine=replace(state.machine, dead_time=drop / FUNDAMENTAL))


def _instrument(field: str, state: State, size: float) -> State:
    return replace(state, **{field: getattr(state, field) + size})


_TURNS = partial(_scaled, ("psi_m", "inductance_d", "inductance_q", "resistance"), (1, 2, 2, 2))


class DqBench:
    """See ``hiding.Catalogue``. Sizes in the unit of the first parameter of the library's effect."""

    name = "dq"
    effects = {
        "winding_temperature": Hidden(7.0, 100.0, _warm),
        "contact_resistance": Hidden(0.012, 0.25, partial(_machine, "resistance")),
        "weak_magnets": Hidden(0.02, 0.15, _weak),
        "quadrature_saturation": Hidden(3e-4, 2e-2, partial(_machine, "saturation")),
        "cross_saturation": Hidden(4e-7, 2e-5, partial(_machine, "cross")),
        "direct_inductance": Hidden(0.05, 0.4, partial(_scaled, ("inductance_d",), (1,)), signed=True),
        "quadrature_inductance": Hidden(0.05, 0.4, partial(_scaled, ("inductance_q",), (1,)), signed=True),
        "iron_loss_resistance": Hidden(5e-5, 1e-2, partial(_machine, "iron")),
        "inverter_drop": Hidden(0.01, 1.5, _dead_time),
        "winding_turns": Hidden(0.016, 0.1, _TURNS, signed=True),
        "friction_torque": Hidden(0.003, 0.3, partial(_machine, "friction")),
        "viscous_torque": Hidden(2e-5, 2e-3, partial(_machine, "viscous")),
        "windage_torque": Hidden(8e-8, 8e-6, partial(_machine, "windage")),
        "load_loss": Hidden(0.002, 0.08, partial(_machine, "load_share")),
        "torque_gain": Hidden(0.01, 0.08, partial(_instrument, "torque_gain"), signed=True),
        "torque_offset": Hidden(0.06, 0.6, partial(_instrument, "torque_offset"), signed=True),
        "torque_drift": Hidden(0.005, 0.3, partial(_instrument, "torque_drift"), signed=True),
        "voltage_gain": Hidden(0.006, 0.08, partial(_instrument, "voltage_gain"), signed=True),
        "current_gain": Hidden(0.01, 0.08, partial(_instrument, "current_gain"), signed=True),
        "speed_gain": Hidden(0.008, 0.08, partial(_instrument, "speed_gain"), signed=True),
        "rotor_position_zero": Hidden(0.0005, 0.06, partial(_instrument, "rotor_zero"), signed=True),
    }
    outside = {
        "resonance of the drive train": Hidden(0.05, 0.05, partial(_machine, "speed_bump")),
        "drag with speed^1.5": Hidden(0.05, 0.05, partial(_machine, "drag_power")),
        "dead band of the torque cell": Hidden(0.02, 0.02, partial(_machine, "torque_dead_band")),
        "magnets give way to negative i_d": Hidden(0.05, 0.05, partial(_machine, "demagnetisation")),
        "speed sensor that bends": Hidden(0.01, 0.01, partial(_machine, "tacho_bend")),
        "bearing pulled by the current": Hidden(0.05, 0.05, partial(_machine, "pulled_bearing")),
        "drag with the root of the speed": Hidden(0.05, 0.05, partial(_machine, "root_drag")),
        "shear-thinning lubricant": Hidden(0.03, 0.03, partial(_machine, "grease")),
        "drag from a threshold speed on": Hidden(5e-4, 5e-4, partial(_machine, "relief")),
        "soft knee of the switches": Hidden(0.3, 0.3, partial(_machine, "soft_knee")),
        "range switch of the torque amplifier": Hidden(0.02, 0.02, partial(_machine, "range_step")),
        "current sensor that bends": Hidden(0.02, 0.02, partial(_machine, "shunt_bend")),
        "bridges saturated by |i_q|": Hidden(2e-4, 2e-4, partial(_machine, "bridges")),
        "magnets shielded by eddy currents": Hidden(0.01, 0.01, partial(_machine, "shielding")),
    }
    tuning_kinds = frozenset(list(outside)[:6])
    alike = (frozenset({"winding_temperature", "contact_resistance"}),)

    def setup(self, rng: np.random.Generator) -> Setup:
        psi, l_d, r = rng.uniform(0.08, 0.13), rng.uniform(2e-3, 4e-3), rng.uniform(0.3, 0.7)
        l_q = l_d * rng.uniform(1.0, 1.8)
        device = {
            "kind": "permanent-magnet synchronous machine",
            "pole_pairs": 4,
            "psi_m_Vs": psi,
            "inductance_d_H": l_d,
            "inductance_q_H": l_q,
            "resistance_ohm": r,
        }
        systematic = {
            "torque_gain": ("gain", 0.003),
            "torque_offset_Nm": ("offset", 0.02),
            "voltage_gain": ("gain", 0.002),
            "current_gain": ("gain", 0.003),
        }
        state = State(TrueMachine(4, psi, l_d, l_q, r))
        return Setup(device, TOLERANCE, systematic, _layouts(), state, int(rng.integers(2, 4)))

    def moved(self, setup: Setup, state: State, name: str, z: float) -> State:
        if name in setup.systematic:
            return _instrument(name.removesuffix("_Nm"), state, setup.systematic[name][1] * z)
        fields = dict(zip(setup.tolerance, ("psi_m", "inductance_d", "inductance_q", "resistance")))
        return _machine(fields[name], state, setup.tolerance[name] * setup.device[name] * z)

    def simulate(self, setup: Setup, state: State) -> list[dict[str, np.ndarray]]:
        m = state.machine
        slow, smaller = RPM / (1 + state.speed_gain), 1 / (1 + state.current_gain)
        emf, drags, shorts, grid = (layout.conditions for layout in setup.layouts)
        i = (grid["i_d_A"] + 1j * grid["i_q_A"]) * smaller * np.exp(-1j * state.rotor_zero)
        v_d, v_q, torque = operation(m, i.real, i.imag, grid["speed_rpm"] * slow)
        v = (v_d + 1j * v_q) * np.exp(1j * state.rotor_zero) * (1 + state.voltage_gain)
        braking, current = short_circuit(m, shorts["speed_rpm"] * slow)
        return [
            {"v_ll_V": back_emf(m, emf["speed_rpm"] * slow) * (1 + state.voltage_gain)},
            {"torque_Nm": _shown(state, drag(m, drags["speed_rpm"] * slow))},
            {"torque_Nm": _shown(state, braking), "current_A": current * (1 + state.current_gain)},
            {"v_d_V": v.real, "v_q_V": v.imag, "torque_Nm": _shown(state, torque)},
        ]

    def drifts(self, state: State) -> dict[str, float]:
        return {"torque_Nm": state.torque_drift}


def _shown(state: State, torque: np.ndarray) -> np.ndarray:
    return torque * (1 + state.torque_gain) + state.torque_offset


def _sized(floor: float, share: float) -> tuple[str, object]:
    return f"{floor:g} + {share:g}*abs(y)", lambda y: floor + share * np.abs(y)


VOLTAGE, CURRENT = _sized(0.05, 0.002), _sized(0.03, 0.002)
TORQUE, SMALL_TORQUE = _sized(0.03, 0.003), _sized(0.008, 0.01)


def _layout(file, kind, conditions, uncertainty) -> Layout:
    def declared(y):
        return {name: size(y[name]) for name, (_, size) in uncertainty.items()}

    return Layout(file, kind, conditions, {name: text for name, (text, _) in uncertainty.items()}, declared)


def _layouts() -> tuple[Layout, ...]:
    speed, i_d, i_q = (axis.ravel() for axis in np.meshgrid(SPEEDS, I_D, I_Q, indexing="ij"))
    return (
        _layout("back_emf.csv", "back_emf", {"speed_rpm": EMF_SPEEDS}, {"v_ll_V": VOLTAGE}),
        _layout("drag.csv", "drag", {"speed_rpm": DRAG_SPEEDS}, {"torque_Nm": SMALL_TORQUE}),
        _layout(
            "short_circuit.csv",
            "short_circuit",
            {"speed_rpm": SHORT_SPEEDS},
            {"torque_Nm": TORQUE, "current_A": CURRENT},
        ),
        _layout(
            "operation.csv",
            "dq_operation",
            {"speed_rpm": speed, "i_d_A": i_d, "i_q_A": i_q},
            {"v_d_V": VOLTAGE, "v_q_V": VOLTAGE, "torque_Nm": TORQUE},
        ),
    )


CATALOGUE = DqBench()
