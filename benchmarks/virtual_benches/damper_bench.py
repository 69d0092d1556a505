"""A damper with a shunt on the bench: force-velocity lines, back-EMF and impedance."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from benchmarks.virtual_benches.damper_truth import TrueDamper, impedance, steady
from benchmarks.virtual_benches.hiding import Hidden, Layout, Setup

VELOCITIES = np.array([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4])  # m/s, each in both directions
EMF_VELOCITIES = np.array([0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45])  # m/s
SHUNTS = np.array([0.5, 1.0, 3.0, 10.0, 1e6])  # ohm; 1e6 is open
FREQUENCIES = np.geomspace(1.0, 40.0, 12)  # Hz
SWEEPS = ((1.0, 2e-3), (5.0, 2e-3), (1e6, 2e-3), (1.0, 5e-4))  # shunt, amplitude of an impedance sweep
COPPER = 0.00393  # 1/K, IEC 60028

TOLERANCE = {  # relative
    "force_constant_N_per_A": 0.01,
    "internal_resistance_ohm": 0.01,
    "moving_mass_kg": 0.02,
    "viscous_damping_Ns_per_m": 0.15,
}

@dataclass(frozen=True)
class State:
    """The damper in truth and what its instruments do. Gains relative, offsets and drifts SI."""

    damper: TrueDamper
    force_gain: float = 0.0
    force_offset: float = 0.0
    voltage_gain: float = 0.0
    voltage_offset: float = 0.0
    speed_gain: float = 0.0
    force_drift: float = 0.0
    voltage_drift: float = 0.0


def _damper(field: str, state: State, size: float) -> State:
    return replace(state, damper=replace(state.damper, **{field: getattr(state.damper, field) + size}))


def _scaled(field: str, factor_of_size, state: State, size: float) -> State:
    value = getattr(state.damper, field) * factor_of_size(size)
    return replace(state, damper=replace(state.damper, **{field: value}))


def _instrument(field: str, state: State, size: float) -> State:
    return replace(state, **{field: getattr(state, field) + size})


def _stribeck(state: State, size: float, excess: float = 0.8, velocity: float = 0.06) -> State:
    d = state.damper
    friction = replace(d, coulomb=d.coulomb + size, static_excess=excess * size, stribeck_velocity=velocity)
    return replace(state, damper=friction)


def _eddy(state: State, size: float, corner: float = 0.25) -> State:
    return replace(state, damper=replace(state.damper, eddy=size, eddy_corner=corner))


def _hysteresis(state: State, size: float, distance: float) -> State:
    return replace(state, damper=replace(state.damper, hysteresis=size, hysteresis_distance=distance))


def _saturated(state: State, size: float) -> State:
    return replace(state, damper=replace(state.damper, saturation_current=float(np.sqrt(0.5 / size))))


class DamperBench:
    """See ``hiding.Catalogue``. Sizes in the unit of the first parameter of the library's effect."""

    name = "damper"
    effects = {
        "winding_temperature": Hidden(6.0, 120.0, partial(_scaled, "resistance", lambda rise: 1 + COPPER * rise)),
        "contact_resistance": Hidden(0.02, 0.5, partial(_damper, "resistance")),
        "weak_magnets": Hidden(0.01, 0.15, partial(_scaled, "force_constant", lambda loss: 1 - loss)),
        "diode_drop": Hidden(0.04, 1.4, partial(_damper, "diode")),
        "winding_inductance": Hidden(8e-5, 5e-3, partial(_damper, "inductance"), alone=True),
        "eddy_drag": Hidden(4.0, 80.0, _eddy, alone=True),
        "hysteresis_drag": Hidden(0.15, 15.0, partial(_damper, "hysteresis"), alone=True),
        "force_constant_saturation": Hidden(3e-5, 2e-3, _saturated, alone=True),
        "coulomb_friction": Hidden(0.05, 15.0, partial(_damper, "coulomb")),
        "stribeck_friction": Hidden(0.15, 12.0, _stribeck),
        "excess_viscous": Hidden(4.0, 60.0, partial(_damper, "viscous")),
        "quadratic_drag": Hidden(3.0, 150.0, partial(_damper, "quadratic"), alone=True),
        "inertance": Hidden(0.03, 2.0, partial(_damper, "mass")),
        "mount_compliance": Hidden(2e-8, 2e-6, partial(_damper, "mount_compliance"), alone=True),
        "backlash": Hidden(2e-6, 2e-4, partial(_damper, "play"), alone=True),
        "guide_misalignment": Hidden(60.0, 6e3, partial(_damper, "misalignment"), alone=True),
        "rig_loss": Hidden(0.006, 0.12, partial(_damper, "rig_share"), alone=True),
        "force_gain": Hidden(0.01, 0.08, partial(_instrument, "force_gain"), signed=True),
        "force_offset": Hidden(0.15, 6.0, partial(_instrument, "force_offset"), signed=True),
        "voltage_gain": Hidden(0.01, 0.08, partial(_instrument, "voltage_gain"), signed=True),
        "voltage_offset": Hidden(0.01, 0.3, partial(_instrument, "voltage_offset"), signed=True),
        "speed_gain": Hidden(0.01, 0.08, partial(_instrument, "speed_gain"), signed=True),
        "force_drift": Hidden(0.2, 8.0, partial(_instrument, "force_drift"), signed=True),
        "sensor_lag": Hidden(1e-5, 1e-3, partial(_damper, "force_lag"), alone=True),
    }
    forms = {
        "stribeck_friction": (
            partial(_stribeck, excess=0.0),
            partial(_stribeck, velocity=0.03),
            partial(_stribeck, velocity=0.12),
        ),
        "eddy_drag": (partial(_eddy, corner=0.1), partial(_eddy, corner=1.0)),
        "hysteresis_drag": (partial(_hysteresis, distance=3e-4), partial(_hysteresis, distance=3e-3)),
    }
    outside = {
        "cubic stiffness": Hidden(1e10, 1e10, partial(_damper, "cubic_stiffness")),
        "drag with v^1.5": Hidden(40.0, 40.0, partial(_damper, "three_halves")),
        "friction pressed on by the load": Hidden(0.1, 0.1, partial(_damper, "load_friction")),
        "resonance of the rig": Hidden(0.02, 0.02, partial(_damper, "rig_resonance")),
        "dead band of the force cell": Hidden(3.0, 3.0, partial(_damper, "dead_band")),
        "force ripple over velocity": Hidden(2.0, 2.0, partial(_damper, "stick_ripple")),
        "second circuit in the iron": Hidden(20.0, 20.0, partial(_damper, "pole_split")),
        "fluid that thins after Cross": Hidden(2.0, 2.0, partial(_damper, "thinning")),
        "drag that slips": Hidden(20.0, 20.0, partial(_damper, "slip")),
        "mount that creeps": Hidden(3e-7, 3e-7, partial(_damper, "creep")),
        "strap between spring and dashpot": Hidden(500.0, 500.0, partial(_damper, "strap")),
        "amplifier that compresses": Hidden(0.05, 0.05, partial(_damper, "compression")),
        "drag with sqrt(v)": Hidden(1.0, 1.0, partial(_damper, "root_drag")),
        "shear-thinning lubricant": Hidden(0.5, 0.5, partial(_damper, "grease")),
        "drag from a threshold speed on": Hidden(20.0, 20.0, partial(_damper, "relief")),
        "arm that relaxes": Hidden(500.0, 500.0, partial(_damper, "spring_arm")),
        "rubber bush": Hidden(1e3, 1e3, partial(_damper, "bush")),
        "stop near the end of the travel": Hidden(2e4, 2e4, partial(_damper, "bump")),
        "drag of a boundary layer": Hidden(2.0, 2.0, partial(_damper, "history")),
        "range switch of the force amplifier": Hidden(0.02, 0.02, partial(_damper, "range_step")),
    }
    tuning_kinds = frozenset(list(outside)[:12])
    alike = (
        frozenset({"winding_temperature", "contact_resistance"}),
        frozenset({"coulomb_friction", "stribeck_friction"}),
    )

    def setup(self, rng: np.random.Generator) -> Setup:
        k, r, m, c = rng.uniform(40, 80), rng.uniform(0.8, 2.0), rng.uniform(1.0, 4.0), rng.uniform(10, 40)
        device = {
            "kind": "electromagnetic damper",
            "force_constant_N_per_A": k,
            "internal_resistance_ohm": r,
            "moving_mass_kg": m,
            "viscous_damping_Ns_per_m": c,
        }
        systematic = {"force_gain": ("gain", 0.003), "force_offset_N": ("offset", 0.15)}
        return Setup(device, TOLERANCE, systematic, _layouts(), State(TrueDamper(k, r, m, c)), int(rng.integers(2, 4)))

    def moved(self, setup: Setup, state: State, name: str, z: float) -> State:
        if name in setup.systematic:
            return _instrument(name.removesuffix("_N"), state, setup.systematic[name][1] * z)
        fields = dict(zip(setup.tolerance, ("force_constant", "resistance", "mass", "viscous")))
        return _damper(fields[name], state, setup.tolerance[name] * setup.device[name] * z)

    def simulate(self, setup: Setup, state: State) -> list[dict[str, np.ndarray]]:
        steady_table, emf, sweep = (layout.conditions for layout in setup.layouts)
        d, slow = state.damper, 1.0 / (1.0 + state.speed_gain)
        force = steady(d, steady_table["velocity_m_per_s"] * slow, steady_table["shunt_ohm"])[0]
        force = force * (1 + state.force_gain) + state.force_offset
        still = replace(d, heating=0.0)
        voltage = steady(still, emf["velocity_m_per_s"] * slow, np.full(len(emf["velocity_m_per_s"]), 1e6))[1]
        voltage = voltage * (1 + state.voltage_gain) + state.voltage_offset
        z = impedance(d, sweep["frequency_Hz"], sweep["amplitude_m"] * slow, sweep["shunt_ohm"])
        z = z * (1 + state.force_gain) * slow
        return [
            {"force_N": force},
            {"voltage_V": voltage},
            {"re_Ns_per_m": z.real, "im_Ns_per_m": z.imag},
        ]

    def drifts(self, state: State) -> dict[str, float]:
        return {"force_N": state.force_drift, "voltage_V": state.voltage_drift}


def _layouts() -> tuple[Layout, ...]:
    both = np.stack([VELOCITIES, -VELOCITIES], axis=1).ravel()
    shunt, amplitude = (np.repeat(values, len(FREQUENCIES)) for values in zip(*SWEEPS))
    return (
        Layout(
            "force_velocity.csv",
            "damping_velocity",
            {"shunt_ohm": np.repeat(SHUNTS, len(both)), "velocity_m_per_s": np.tile(both, len(SHUNTS))},
            {"force_N": "0.3 + 0.008*abs(y)"},
            lambda y: {"force_N": 0.3 + 0.008 * np.abs(y["force_N"])},
        ),
        Layout(
            "open_circuit.csv",
            "back_emf",
            {"velocity_m_per_s": EMF_VELOCITIES},
            {"voltage_V": "0.02 + 0.003*abs(y)"},
            lambda y: {"voltage_V": 0.02 + 0.003 * np.abs(y["voltage_V"])},
        ),
        Layout(
            "impedance.csv",
            "impedance",
            {"shunt_ohm": shunt, "frequency_Hz": np.tile(FREQUENCIES, len(SWEEPS)), "amplitude_m": amplitude},
            dict.fromkeys(("re_Ns_per_m", "im_Ns_per_m"), "1 + 0.01*abs(z) + 0.016/(frequency_Hz*amplitude_m)"),
            partial(_impedance_uncertainty, 0.016 / (np.tile(FREQUENCIES, len(SWEEPS)) * amplitude)),  # 0.1 N of force
        ),
    )


def _impedance_uncertainty(force_noise, y):
    u = 1.0 + force_noise + 0.01 * np.hypot(y["re_Ns_per_m"], y["im_Ns_per_m"])
    return {"re_Ns_per_m": u, "im_Ns_per_m": u}


CATALOGUE = DamperBench()
