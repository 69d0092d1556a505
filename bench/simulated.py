"""What the benches of thesis chapter 5 would read of an actuator that was designed: simulated, test by test.

The same tools that read records of a real bench read these (impedance, frequency response, identification), so that
what is measured later stands beside it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi

import numpy as np
from scipy.optimize import brentq

from actuator.errors import ActuatorError
from actuator.imposed import imposed_motion
from actuator.model import Actuator
from actuator.parts import CompliantMount
from actuator.terminals import Terminals
from bench.force_loops import (
    CONTACT,
    LOSS,
    MASS,
    MOUNT_DAMPING,
    NOMINAL,
    PLAY,
    STIFFNESS,
    TORQUE_CONSTANT,
    TRANSITION,
    ForceLoop,
    LoopMatch,
    identify_loops,
)  # fmt: skip
from bench.frequency_response import frequency_response
from bench.identification import Identification
from bench.impedance import sine_impedance
from bench.record import Record
from electrical.shunted_machine import Bridge, Circuit, ShortedAtTerminals
from electrical.synchronous_machine import SynchronousMachine
from labelled import xr
from vehicle.comfort import weighted_acceleration
from vehicle.designed import BenchMachine, DesignedActuator
from vehicle.hardware_case import LOAD_CELL, NO_LOOP, LoopTest, WantedLoop, loop_numbers, low_levels
from vehicle.hardware_loop import LoopRun, SimulatedDevice
from vehicle.impedance import LumpedActuator
from vehicle.printed_car import PRINTED_CAR, printed_road

SHUNTS = (inf, 0.465, 0.135, 0.055, 0.0)  # ohm, Table 5.1
DIODE_DROP = 0.2  # V of one diode; two of them are the 0.4 V of the text to Fig. 5.3
# N: what the runs of Table 5.1 ended at, sqrt(P c / eta) of its three shunted rows: 584, 625 and 743 N
BENCH_FORCE = 650.0
FREQUENCIES = np.geomspace(1.0, 80.0, 40)  # Hz, of the impedance (Figs 5.9, 5.10 and B.2)
DAMPINGS = (0.0, 1e3, 2e3, 4e3)  # Ns/m of the control, Fig. 5.10; its values are not printed
IMPEDANCE_STROKE = 1e-3  # m, not printed
BIAS, SWING = 12.0, 2.0  # A, text to Fig. 5.12
CHIRP = (5.0, 200.0, 60.0)  # Hz from, Hz to, s; the thesis prints none, its resonance lies at 60 to 70 Hz
SEGMENT = 1.0  # s, of the averaged spectra
LOOPS = ((15.0, 3e-3, 0.0), (15.0, 3e-3, 4e3), (5.0, 8e-3, 4e3))  # Hz, m (not printed), Ns/m: Table 4.3
NOISE = 1.0  # N, of the load cell
SAMPLING = 4000.0  # Hz, text to eq. 4.28
_RAMP = 0.15  # s in which a loop's amplitude grows
_LOOP_PERIODS = 8
HIL_DAMPING, HIL_DURATION = 1000.0, 4.0  # Ns/m (section 5.5), s
_VELOCITIES = np.linspace(0.01, 1.0, 100)  # m/s, of the maps
_SETTLED = 4  # periods of a sine that are cut off
_PERIODS = 8
_PER_PERIOD = 400  # samples
_THINNED = 8  # of the samples of the chirp that a figure shows


@dataclass(frozen=True)
class ShuntRow:
    """One row of Table 5.1.

    shunt [ohm]; damping: slope of force over velocity [Ns/m]; best_efficiency: dimensionless, nan without a load
    most_power: in the shunt at the force at which the bench of the thesis ended [W], nan without a load
    """

    shunt: float
    damping: float
    best_efficiency: float
    most_power: float


@dataclass(frozen=True)
class LoopRow:
    """A test in the loop of Fig. 5.15.

    low_level: by name; numbers: by name [of the unit in the name]; lost: whether it left all bounds
    """

    low_level: str
    numbers: dict[str, float]
    lost: bool


@dataclass(frozen=True, eq=False)
class BenchTests:
    """What the benches would read.

    lumped: the parameters of Table B.1, with the mount's stiffness beyond its transition
    shunts: Table 5.1; shunted: force [N] and efficiency over (shunt, velocity): shunt [ohm], velocity [m/s]
    quadrants: over (torque, velocity): force [N], electrical [W] and efficiency of the controlled machine, in rebound
    impedance: |Z| [Ns/m]: of the shunted machine over (shunt, frequency) (B.4 with the pole of a synchronous machine),
    with its phase [rad], of the controlled one over (damping, frequency)
    chirp: that of ``active`` over time [s]: frequency [Hz], current [A], force [N], angle of the rotor [rad], each (t,)
    active: force over current [N/A] and angle over force [rad/N] over frequency [Hz], with coherence
    identification: of the eight parameters from the loops; true: what the actuator states of them [SI], by name
    matches: the loops beside the identified model; in_the_loop: tests of section 5.5; loops_in_time: of these over
    (test, time): force, wanted [N], stroke, axis, body, wheel [m], acceleration, felt [m/s^2], holding: missing tyre
    load, torque [Nm], angle [rad], mechanical, electrical: powers [W], current: to the battery [A]; road [m], (time,)
    """

    lumped: LumpedActuator
    shunts: tuple[ShuntRow, ...]
    shunted: xr.Dataset
    quadrants: xr.Dataset
    impedance: xr.Dataset
    chirp: xr.Dataset
    active: xr.Dataset
    identification: Identification
    true: dict[str, float]
    matches: tuple[LoopMatch, ...]
    in_the_loop: tuple[LoopRow, ...]
    loops_in_time: xr.Dataset


def bench_stage(own: DesignedActuator, bench: BenchMachine) -> BenchTests:
    """All tests. Raises ActuatorError for a rigid mount, ControlError where the bench has no force loop."""
    actuator, machine = own.actuator, bench.machine
    lumped = lumped_actuator(actuator, machine)
    found, matches = identified(actuator, float(machine.torque_constant))
    tests = hardware_tests(actuator)
    chirp = active_chirp(actuator, float(machine.torque_constant))
    return BenchTests(
        lumped=lumped,
        shunts=tuple(shunt_row(lumped, actuator, shunt) for shunt in SHUNTS),
        shunted=shunt_curves(lumped, actuator),
        quadrants=four_quadrants(actuator),
        impedance=impedances(lumped, actuator),
        chirp=chirp.isel(time=slice(None, None, _THINNED)),
        active=active_response(chirp),
        identification=found,
        true=stated_parameters(actuator, float(machine.torque_constant)),
        matches=matches,
        in_the_loop=tuple(LoopRow(name, loop_numbers(_loop_test(), run), run.lost) for name, run in tests.items()),
        loops_in_time=_in_time(tests, actuator, bench.terminals),
    )


def _mount(actuator: Actuator) -> CompliantMount:
    if not isinstance(actuator.mount, CompliantMount):
        raise ActuatorError("simulated bench: expected an actuator behind a compliant mount, found a rigid one")
    return actuator.mount


# ---- constant speed ------------------------------------------------------------------------------------------------


def circuit() -> Circuit:
    """A diode bridge with the shunt behind it; the short circuit is that of the machine's terminals."""
    return ShortedAtTerminals(Bridge(DIODE_DROP))


def lumped_actuator(actuator: Actuator, machine: SynchronousMachine) -> LumpedActuator:
    """Table B.1 of an actuator."""
    mount = _mount(actuator)
    return LumpedActuator(
        machine,
        circuit(),
        transmission_ratio=actuator.ratio.nominal,
        equivalent_mass=actuator.equivalent_mass,
        viscous_friction=actuator.loss.viscous,
        mount_stiffness=mount.stiffness,
        mount_damping=mount.damping,
    )


def static_force(actuator: Actuator, velocity: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Force at the suspension at constant velocity and nominal ratio [N], of the broadcast shape.

    velocity: [m/s], torque: of the rotor [Nm], broadcast
    c v + F_c sign(v) + T / tau behind the meshes; without dry friction's breakaway: valid above some mm/s
    """
    loss = actuator.loss
    behind = loss.viscous * velocity + loss.coulomb * np.sign(velocity) + torque / actuator.ratio.nominal
    return actuator.gears.through(behind, velocity)


def shunt_row(lumped: LumpedActuator, actuator: Actuator, shunt: float) -> ShuntRow:
    """One shunt [ohm]: slope, best efficiency up to the force of the bench, and the power in it there; shunt: [ohm]."""
    damping = float(actuator.loss.viscous if shunt == inf else lumped.static_damping(shunt)) / actuator.gears.driven
    if shunt in (0.0, inf):
        return ShuntRow(shunt, damping, float("nan"), float("nan"))
    velocity = np.linspace(1e-3, _velocity_at(lumped, actuator, shunt), 200)
    force, power = _shunted(lumped, actuator, velocity, shunt)
    return ShuntRow(shunt, damping, float(np.max(power / (force * velocity))), float(power[-1]))


def _velocity_at(lumped: LumpedActuator, actuator: Actuator, shunt: float) -> float:
    """At which the shunted actuator takes the force at which the bench ended [m/s]; the fastest one where it never
    does."""

    def missing(velocity: float) -> float:
        """Of the force [N] at a velocity [m/s]."""
        return float(_shunted(lumped, actuator, np.array([velocity]), shunt)[0][0]) - BENCH_FORCE

    fastest = float(_VELOCITIES[-1])
    return float(brentq(missing, 1e-3, fastest)) if missing(fastest) > 0 else fastest


def _shunted(
    lumped: LumpedActuator, actuator: Actuator, velocity: np.ndarray, shunt: float
) -> tuple[np.ndarray, np.ndarray]:
    """Force [N] and power in the shunt [W] over velocity [m/s]."""
    speed = velocity / lumped.transmission_ratio
    if shunt == inf:
        return static_force(actuator, velocity, 0.0 * velocity), 0.0 * velocity
    torque = np.asarray(lumped.circuit.torque(lumped.machine, speed, shunt))
    current = Bridge(DIODE_DROP).current(lumped.machine, speed, shunt)
    return static_force(actuator, velocity, torque), current**2 * shunt


def shunt_curves(lumped: LumpedActuator, actuator: Actuator) -> xr.Dataset:
    """Force and efficiency over (shunt, velocity) (Figs 5.3 and 5.4)."""
    rows = [_shunted(lumped, actuator, _VELOCITIES, shunt) for shunt in SHUNTS]
    force, power = (np.array(one) for one in zip(*rows, strict=True))
    data = {"force": force, "efficiency": power / (force * _VELOCITIES)}
    return xr.Dataset(
        {name: (("shunt", "velocity"), one) for name, one in data.items()},
        {"shunt": list(SHUNTS), "velocity": _VELOCITIES},
    )


def four_quadrants(actuator: Actuator) -> xr.Dataset:
    """The controlled machine at constant speed over (torque, velocity), in rebound (Figs 5.6 and 5.8).

    Efficiency: electrical over mechanical power where both flow to the battery, its inverse where both flow from it,
    nan where power flows in from both sides. NaN beyond the limit of current and voltage.
    """
    limit, ratio = actuator.drive.limit, actuator.ratio.nominal
    most = max(*limit.braking, *limit.driving)
    torque, velocity = np.linspace(-most, most, 81)[:, None], _VELOCITIES[None, :]
    speed = velocity / ratio
    bound = np.where(torque > 0, limit.braking_at(speed), limit.driving_at(speed))
    force = static_force(actuator, velocity, torque)
    held = np.clip(torque, -limit.driving_at(speed), limit.braking_at(speed))
    electrical = held * speed - actuator.drive.loss.at(held, speed + 0 * held)
    mechanical = force * velocity
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(mechanical > 0, electrical / mechanical, mechanical / electrical)
    share = np.where(electrical * mechanical > 0, share, np.nan)
    inside = np.abs(torque) <= bound * (1 + 1e-9)
    data = {
        name: (("torque", "velocity"), np.where(inside, one, np.nan))
        for name, one in (("force", force), ("electrical", electrical), ("efficiency", share))
    }
    return xr.Dataset(data, {"torque": torque[:, 0], "velocity": _VELOCITIES})


# ---- sines ---------------------------------------------------------------------------------------------------------


def impedances(lumped: LumpedActuator, actuator: Actuator) -> xr.Dataset:
    """Magnitudes over frequency: by the lumped model over every shunt, by simulation with every damping asked for."""
    top = 2 * pi * FREQUENCIES * IMPEDANCE_STROKE
    shunted = np.array([lumped.impedance(FREQUENCIES, min(one, 1e6), top) for one in SHUNTS])
    controlled = [[abs(_controlled(actuator, damping, f)) for f in FREQUENCIES] for damping in DAMPINGS]
    return xr.Dataset(
        {
            "shunted": (("shunt", "frequency"), np.abs(shunted)),
            "phase": (("shunt", "frequency"), np.angle(shunted)),
            "controlled": (("damping", "frequency"), np.array(controlled)),
        },
        {"shunt": list(SHUNTS), "damping": list(DAMPINGS), "frequency": FREQUENCIES},
    )


def _controlled(actuator: Actuator, damping: float, frequency: float) -> complex:
    """Impedance with the motor asked for a damping times the velocity of the output, and no force loop [Ns/m]."""
    time = np.arange(_PERIODS * _PER_PERIOD) / (_PER_PERIOD * frequency)
    stroke = IMPEDANCE_STROKE * np.sin(2 * pi * frequency * time)
    velocity = 2 * pi * frequency * IMPEDANCE_STROKE * np.cos(2 * pi * frequency * time)
    run = imposed_motion(actuator, time, stroke, velocity, damping * velocity * actuator.ratio.nominal)
    settled = slice(_SETTLED * _PER_PERIOD, None)
    channels = {"stroke": stroke[settled], "force": run.force[settled], "shunt": np.zeros_like(stroke[settled])}
    return sine_impedance(Record("simulated", float(time[1]), channels)).impedance


def active_chirp(actuator: Actuator, torque_constant: float) -> xr.Dataset:
    """Force and angle over time with the output held and a chirp of current on a bias (Fig. 5.12).

    torque_constant: K_t [Nm/A], turns the current into torque; see ``BenchTests``
    """
    begin, end, duration = CHIRP
    time = np.arange(0.0, duration, 1 / SAMPLING)
    grown = np.log(end / begin) / duration
    frequency = begin * np.exp(grown * time)
    current = BIAS + SWING * np.sin(2 * np.pi * (frequency - begin) / grown)
    still = np.zeros_like(time)
    run = imposed_motion(actuator, time, still, still, -torque_constant * current)
    angle = run.mass_stroke / actuator.ratio.nominal
    data = {"frequency": frequency, "current": current, "force": run.force, "angle": angle}
    return xr.Dataset({name: ("time", one) for name, one in data.items()}, {"time": time})


def active_response(chirp: xr.Dataset) -> xr.Dataset:
    """Force over current [N/A] and angle over force [rad/N], with coherence (Fig. 5.13); chirp: of ``active_chirp``."""
    current, force, angle = (chirp[name].values for name in ("current", "force", "angle"))
    record = Record("simulated", 1 / SAMPLING, {"current": current, "force": force, "angle": angle})
    over_current = frequency_response(record, current, force, SEGMENT).between(*CHIRP[:2])
    over_force = frequency_response(record, force, angle, SEGMENT).between(*CHIRP[:2])
    data = {"force": np.abs(over_current.h1), "coherence": over_current.coherence, "angle": np.abs(over_force.h1)}
    return xr.Dataset({name: ("frequency", one) for name, one in data.items()}, {"frequency": over_current.frequency})


# ---- identification ------------------------------------------------------------------------------------------------


def stated_parameters(actuator: Actuator, torque_constant: float) -> dict[str, float]:
    """The eight parameters of Table 4.2 as the actuator states them [SI], by name; torque_constant: K_t [Nm/A]."""
    mount = _mount(actuator)
    return {
        MASS: actuator.equivalent_mass, PLAY: mount.play, STIFFNESS: mount.stiffness, CONTACT: mount.contact_damping,
        TRANSITION: mount.transition, LOSS: actuator.loss.viscous, MOUNT_DAMPING: mount.damping,
        TORQUE_CONSTANT: torque_constant,
    }  # fmt: skip


def identified(actuator: Actuator, torque_constant: float) -> tuple[Identification, tuple[LoopMatch, ...]]:
    """The eight parameters from loops of the whole actuator, with noise of the load cell; torque_constant: [Nm/A].

    Gears, dry friction and a ratio that varies are in the loops, and not in the model of Table 4.2 that is fitted, as
    on a real bench. The current is the one that flows: with the reference, which the thesis takes, a lag of 1 ms makes
    the mass of its prototype 30 % too small.
    """
    rng = np.random.default_rng(1)
    loops = [_loop(actuator, torque_constant, *one, rng) for one in LOOPS]
    stated = stated_parameters(actuator, torque_constant)
    start = {name: stated[name] or NOMINAL[name] for name in NOMINAL}
    return identify_loops(loops, start, actuator.ratio.nominal, NOISE)


def _loop(
    actuator: Actuator, torque_constant: float, frequency: float, amplitude: float, damping: float,
    rng: np.random.Generator,
) -> ForceLoop:  # fmt: skip
    time = np.arange(0.0, _RAMP + _LOOP_PERIODS / frequency, 1 / SAMPLING)
    stroke, velocity = _grown_sine(time, frequency, amplitude)
    torque = damping * velocity * actuator.ratio.nominal
    run = imposed_motion(actuator, time, stroke, velocity, torque)
    force = run.force + NOISE * rng.standard_normal(time.size)
    name = f"{frequency:g} Hz, {damping / 1e3:g} kNs/m"
    return ForceLoop(name, time, stroke, velocity, run.torque / torque_constant, force, settled=_RAMP)


def _grown_sine(time: np.ndarray, frequency: float, amplitude: float) -> tuple[np.ndarray, np.ndarray]:
    """Stroke [m] and velocity [m/s] of a sine whose amplitude grows smoothly from rest."""
    omega, part = 2 * pi * frequency, np.minimum(time / _RAMP, 1.0)
    grown, growth = part**3 * (10 - 15 * part + 6 * part**2), 30 * part**2 * (1 - part) ** 2 / _RAMP
    sine, cosine = np.sin(omega * time), np.cos(omega * time)
    return amplitude * grown * sine, amplitude * (growth * sine + grown * omega * cosine)


# ---- hardware in the loop ------------------------------------------------------------------------------------------


def _loop_test() -> LoopTest:
    road = replace(printed_road(0), duration=HIL_DURATION)
    return LoopTest(PRINTED_CAR, road, HIL_DAMPING, WantedLoop().sample_time)


def hardware_tests(actuator: Actuator) -> dict[str, LoopRun]:
    """The test of section 5.5 without and with a force loop, as fast as it goes."""
    wanted, test = WantedLoop(), _loop_test()
    levels = low_levels(actuator, wanted)
    device = {name: SimulatedDevice(actuator, wanted.sample_time, 2**14) for name in (NO_LOOP, LOAD_CELL)}
    return {name: test.run(device[name], levels[name](), paced=False) for name in (NO_LOOP, LOAD_CELL)}


def _in_time(tests: dict[str, LoopRun], actuator: Actuator, terminals: Terminals) -> xr.Dataset:
    shortest = min(run.time.size for run in tests.values())
    road, time = _loop_test().road[:shortest, 0], next(iter(tests.values())).time[:shortest]
    seen = [_seen(run, road, actuator, terminals, shortest) for run in tests.values()]
    data = {name: (("test", "time"), np.array([one[name] for one in seen])) for name in seen[0]}
    return xr.Dataset({**data, "road": ("time", road)}, {"test": list(tests), "time": time})


def _seen(
    run: LoopRun, road: np.ndarray, actuator: Actuator, terminals: Terminals, samples: int
) -> dict[str, np.ndarray]:
    """What figures show of a test in the loop, each (t,); road [m], (t,)."""
    names = ("force", "wanted", "stroke", "axis", "wheel", "acceleration", "angle", "torque")
    one = {name: getattr(run, name)[:samples] for name in names}
    speed, step = np.gradient(one["angle"], run.time[:samples]), float(run.time[1] - run.time[0])
    electrical = one["torque"] * speed - actuator.drive.loss.at(one["torque"], speed)
    return one | {
        "body": one["stroke"] + one["wheel"],
        "holding": PRINTED_CAR.tyre_stiffness * (one["wheel"] - road) / PRINTED_CAR.actuated.static_load,
        "felt": weighted_acceleration(one["acceleration"], step),
        "mechanical": one["force"] * np.gradient(one["axis"], run.time[:samples]),
        "electrical": electrical,
        "current": electrical / terminals.bus_voltage,
    }
