"""How wrong the laws of effects are: ``python -m benchmarks.law_errors``.

Each effect is held against another law of the same physics: where a virtual bench has one, the truth of that bench
(integration in time instead of harmonic balance, smooth corners of another shape, phases instead of a dq frame); where
none has, another textbook law. The effect's own parameters are fitted to the change that the other law makes, over the
rows and uncertainties of a bench, and what is left is its error; the larger of two sizes, the median of its prior and
one standard deviation above:

    error = |change of the effect - change of the other law| / |change of the other law|,  each over its uncertainty
    size error = |first parameter as fitted / as it is in the other law - 1|

The size is fitted as a bench fits it, beside what is uncertain of the device: what the effect cannot follow of the
other law, a tolerance may, and take or give a part of the size with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from benchmarks.virtual_benches import damper_bench, damper_truth, dq_bench, dq_truth
from benchmarks.virtual_benches.damper_truth import TrueDamper
from benchmarks.virtual_benches.dq_truth import TrueMachine
from effects.base import Effect
from effects.damper_design import Damper
from effects.dq_design import DqMachine
from effects.electrical.ac_winding_loss import SCALE, AcWindingLoss
from effects.electrical.direct_saturation import DirectSaturation
from effects.electrical.force_constant_over_stroke import ForceConstantOverStroke
from effects.electrical.hysteresis_drag import HysteresisDrag
from effects.electrical.iron_loss_resistance import REFERENCE, IronLossResistance
from effects.electrical.shunt_heating import ShuntHeating, rms_velocity
from effects.instrument.sensor_lag import SensorLag
from effects.library import package_effects
from effects.mechanical.viscosity_temperature import ViscosityTemperature
from effects.parameter import parameters_of
from workbench.data.table import Response, Table, Tolerance
from workbench.models.damper.model import DamperModel
from workbench.models.dq.model import DqModel
from workbench.models.model import Model

Answers = list[dict[str, np.ndarray]]
RPM = np.pi / 30
_BOTH = np.outer([0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4], [1.0, -1.0]).ravel()  # m/s
_SHUNTS = np.array([0.5, 1.0, 3.0, 10.0, 1e6])  # ohm
_FREQUENCIES = np.geomspace(1.0, 40.0, 12)  # Hz
_SWEEPS = np.array([[1.0, 2e-3], [5.0, 2e-3], [1e6, 2e-3], [1.0, 5e-4]])  # shunt, amplitude
_EMF = np.linspace(0.05, 0.45, 9)  # m/s


def _table(kind: str, responses: tuple[str, ...], **conditions: np.ndarray) -> Table:
    rows = len(next(iter(conditions.values())))
    none = np.zeros(rows)
    read = {name: Response(name, none, np.ones(rows), "1") for name in responses}
    return Table(kind, kind, conditions, read, none.astype(int), none.astype(int), none.astype(bool))


DAMPER_TABLES = (
    _table("damping_velocity", ("force",), velocity=np.tile(_BOTH, 5), shunt=np.repeat(_SHUNTS, 16)),
    _table("back_emf", ("voltage",), velocity=_EMF),
    _table(
        "impedance",
        ("re", "im"),
        frequency=np.tile(_FREQUENCIES, 4),
        shunt=np.repeat(_SWEEPS[:, 0], 12),
        amplitude=np.repeat(_SWEEPS[:, 1], 12),
    ),
)
_GRID = [a.ravel() for a in np.meshgrid([500.0, 1400, 2800], [0.0, -8, 5], [-16.0, -8, 8, 16, 24], indexing="ij")]
DQ_TABLES = (
    _table("back_emf", ("v_ll",), speed=np.linspace(250, 3000, 12) * RPM),
    _table("drag", ("torque",), speed=np.outer([150.0, 400, 800, 1300, 2000, 2800], [1, -1]).ravel() * RPM),
    _table(
        "short_circuit", ("torque", "current"), speed=np.array([100.0, 200, 400, 700, 1100, 1600, 2200, 3000]) * RPM
    ),
    _table("dq_operation", ("v_d", "v_q", "torque"), speed=_GRID[0] * RPM, i_d=_GRID[1], i_q=_GRID[2]),
)
DAMPER = Model(DamperModel(), Damper(60.0, 1.2, 2.0, 20.0, test_velocity=0.3))
DQ = Model(DqModel(), DqMachine(4, 0.1, 3e-3, 4e-3, 0.5))
TOLERANCES: Mapping[type, Mapping[str, float]] = {Damper: damper_bench.TOLERANCE, DqMachine: dq_bench.TOLERANCE}
_FLOOR = {"force": 0.3, "voltage": 0.02, "re": 1.5, "im": 1.5, "v_ll": 0.05, "torque": 0.03, "current": 0.03}
_SHARE = {"force": 0.008, "voltage": 0.003, "re": 0.01, "im": 0.01}


def _scaled(change: Answers, base: Answers) -> np.ndarray:
    """Changes of all readings over the uncertainty of each, (n,)."""
    parts = []
    for changed, plain in zip(change, base):
        size = np.hypot(plain["re"], plain["im"]) if "re" in plain else None
        for name, values in plain.items():
            u = _FLOOR.get(name, 0.05) + _SHARE.get(name, 0.003) * (np.abs(values) if size is None else size)
            parts.append((changed[name] - values) / u)
    return np.concatenate(parts)


def true_damper(d: TrueDamper) -> Answers:
    """What the bench of a damper shows of the truth."""
    steady, emf, sweep = (table.conditions for table in DAMPER_TABLES)
    z = damper_truth.impedance(d, sweep["frequency"], sweep["amplitude"], sweep["shunt"])
    return [
        {"force": damper_truth.steady(d, steady["velocity"], steady["shunt"])[0]},
        {"voltage": damper_truth.steady(d, emf["velocity"], np.full(len(_EMF), 1e6))[1]},
        {"re": z.real, "im": z.imag},
    ]


def true_machine(m: TrueMachine) -> Answers:
    """What the bench of a motor shows of the truth."""
    emf, drag, short, grid = (table.conditions for table in DQ_TABLES)
    v_d, v_q, torque = dq_truth.operation(m, grid["i_d"], grid["i_q"], grid["speed"])
    braking, current = dq_truth.short_circuit(m, short["speed"])
    return [
        {"v_ll": dq_truth.back_emf(m, emf["speed"])},
        {"torque": dq_truth.drag(m, drag["speed"])},
        {"torque": braking, "current": current},
        {"v_d": v_d, "v_q": v_q, "torque": torque},
    ]


def answers(model: Model) -> Answers:
    """What the bench of a model shows."""
    tables = DAMPER_TABLES if isinstance(model.design, Damper) else DQ_TABLES
    return [model.answers(table) for table in tables]


class LawError(NamedTuple):
    """change: share of the other law's change that the effect cannot follow;  size: error of its first parameter"""

    change: float
    size: float


def worst(errors: Iterable[LawError]) -> LawError:
    """The larger of each over several sizes."""
    return LawError(*map(max, zip(*errors)))


def law_error(effect: type[Effect], model: Model, base: Answers, other: Answers, size: float) -> LawError:
    """Errors of an effect where another law holds, of its forms the one that follows it best, its own parameters
    fitted. size: first parameter of that law"""
    nominal, wanted = answers(model), _scaled(other, base)
    tolerances = len(TOLERANCES[type(model.design)])

    def left(place: np.ndarray, form: Effect) -> np.ndarray:
        z, x = np.split(place, [len(parameters_of(form))])
        return np.append(_scaled(answers(_within(model, x) + form.at(z)), nominal) - wanted, x)

    def error(form: Effect) -> LawError:
        start = np.zeros(len(parameters_of(form)) + tolerances)
        alone, beside = (
            least_squares(left, begin, x_scale=0.3, diff_step=1e-4, args=(form,))
            for begin in (start[:-tolerances], start)
        )
        fitted = next(iter(parameters_of(form).values())).prior.value(float(beside.x[0]))
        return LawError(float(np.linalg.norm(alone.fun) / np.linalg.norm(wanted)), abs(fitted / size - 1))

    return min(map(error, effect.variants(model.design)))


def _within(model: Model, x: np.ndarray) -> Model:
    """The model with its tolerances so many standard deviations from the drawing (4,); there for none."""
    design = model.design
    for (name, sigma), z in zip(TOLERANCES[type(design)].items(), x):
        design = model.base.with_tolerance(design, Tolerance(name, sigma, relative=True), z)
    return replace(model, design=design)


SIZES = (0.0, 1.0)  # of the first parameter, in standard deviations of its prior


def sizes(effect: type[Effect]) -> tuple[float, ...]:
    """Sizes of the first parameter at which the other law is looked at."""
    prior = next(iter(parameters_of(effect).values())).prior
    return tuple(prior.value(z) for z in SIZES)


def declared(effect: type[Effect]) -> LawError:
    """What an effect declares, at the larger of its sizes."""
    first = np.eye(len(parameters_of(effect)))[0]
    return worst(LawError(law.model_error, law.size_error) for law in (effect().at(z * first) for z in SIZES))


# ---- truths of the virtual benches -----------------------------------------------------------------------------------

TRUE_DAMPER = TrueDamper(60.0, 1.2, 2.0, 20.0)
TRUE_MACHINE = TrueMachine(4, 0.1, 3e-3, 4e-3, 0.5)
DAMPER_TRUTHS: Mapping[str, Callable[[float], Mapping[str, float]]] = {
    "backlash": lambda s: {"play": s},
    "coulomb_friction": lambda s: {"coulomb": s},
    "diode_drop": lambda s: {"diode": s},
    "eddy_drag": lambda s: {"eddy": s, "eddy_corner": 0.25},
    "force_constant_saturation": lambda s: {"saturation_current": float(np.sqrt(0.5 / s))},
    "guide_misalignment": lambda s: {"misalignment": s},
    "mount_compliance": lambda s: {"mount_compliance": s},
    "quadratic_drag": lambda s: {"quadratic": s},
    "rig_loss": lambda s: {"rig_share": s},
    "stribeck_friction": lambda s: {"coulomb": s, "static_excess": 0.8 * s, "stribeck_velocity": 0.06},
    "winding_inductance": lambda s: {"inductance": s},
}
MACHINE_TRUTHS: Mapping[str, str] = {
    "cross_saturation": "cross",
    "friction_torque": "friction",
    "load_loss": "load_share",
    "quadrature_saturation": "saturation",
    "windage_torque": "windage",
}


def against_truths() -> dict[str, LawError]:
    """Errors of the effects that a virtual bench has its own law of."""
    library, found = package_effects(), {}
    for name, fields in DAMPER_TRUTHS.items():
        base, effect = true_damper(TRUE_DAMPER), library[name]
        truths = {size: true_damper(replace(TRUE_DAMPER, **fields(size))) for size in sizes(effect)}
        found[name] = worst(law_error(effect, DAMPER, base, truth, size) for size, truth in truths.items())
    for name, field in MACHINE_TRUTHS.items():
        base, effect = true_machine(TRUE_MACHINE), library[name]
        truths = {size: true_machine(replace(TRUE_MACHINE, **{field: size})) for size in sizes(effect)}
        found[name] = worst(law_error(effect, DQ, base, truth, size) for size, truth in truths.items())
    return found


# ---- other textbook laws ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class ParabolaOverStroke(ForceConstantOverStroke):
    """K (1 - curvature x^2)."""

    def coupling(self, position, current):
        return 1.0 - self.curvature * position**2


@dataclass(frozen=True)
class DahlOfSecondPower(HysteresisDrag):
    """dF/dx = level / distance (1 - F sign(v) / level)^2 (Dahl 1968, exponent 2 instead of 1), after a turn at -A."""

    def force(self, position, velocity):
        if position.ndim == 1:
            return self.level * np.tanh(velocity / 1e-4)
        amplitude = np.abs(position).max(axis=-1, keepdims=True)
        left = np.full_like(amplitude, 2.0)  # 1 - F sign(v) / level right after the turn
        for _ in range(60):
            left = 2.0 - 1.0 / (1.0 / left + 2.0 * amplitude / self.distance)
        gone = (position * np.sign(velocity) + amplitude) / self.distance
        return self.level * np.tanh(velocity / 1e-4) * (1.0 - 1.0 / (1.0 / left + gone))


@dataclass(frozen=True)
class ShuntInBalance(ShuntHeating):
    """The balance found to the last digit."""

    def on_state(self, conditions, kind, design):
        if "shunt" not in conditions:
            return conditions
        warm, emf = conditions["shunt"], design.force_constant * rms_velocity(conditions)
        for _ in range(40):
            current = emf / (design.internal_resistance + warm)
            warm = 0.5 * (warm + self.warmed(conditions["shunt"], warm, current))
        return {**conditions, "shunt": warm}


@dataclass(frozen=True)
class BesselFilter(SensorLag):
    """Bessel's of two poles, H = 3 / (3 + 3 s lag + (s lag)^2): between one pole and the filters that are flat."""

    def passed(self, frequency):
        s = 2j * np.pi * frequency * self.lag
        return 3 / (3 + 3 * s + s**2)


@dataclass(frozen=True)
class SaturatingDirectAxis(DirectSaturation):
    """Iron held at half its saturation by the magnets: psi_d - psi_m = a (tanh(i_d / I + c) - tanh(c)), tanh(c) = 1/2,
    with the slope L_d and the curvature -2 k at i_d = 0: I = L_d / (2 k).
    """

    def flux(self, i_d, i_q, machine):
        inductance, bias = machine.inductance_d, np.arctanh(0.5)
        scale = 0.5 * inductance / self.coefficient
        slope = inductance / (1.0 - 0.5**2)
        curve = slope * scale * (np.tanh(i_d / scale + bias) - np.tanh(bias))
        return curve - inductance * i_d, np.zeros_like(i_q)


@dataclass(frozen=True)
class DowellLoss(AcWindingLoss):
    """Dowell's law of four layers: R / R_dc = X (M'(X) + 5 D'(X)), X = thickness over skin depth."""

    def on_state(self, conditions, kind, design):
        if "speed" not in conditions:
            return conditions
        x = (np.abs(design.pole_pairs * conditions["speed"]) / SCALE) ** 0.5 * (self.excess / FIRST_OF_DOWELL) ** 0.25
        factor = conditions.get("resistance_factor", 1.0) * dowell(x)
        return {**conditions, "resistance_factor": factor}


LAYERS = 4
FIRST_OF_DOWELL = (5 * LAYERS**2 - 1) / 45.0  # R / R_dc - 1 = this times X^4


def dowell(x: np.ndarray) -> np.ndarray:
    """R / R_dc of ``LAYERS`` layers (Dowell 1966)."""
    skin = x * (np.sinh(2 * x) + np.sin(2 * x)) / (np.cosh(2 * x) - np.cos(2 * x))
    near = x * (np.sinh(x) - np.sin(x)) / (np.cosh(x) + np.cos(x))
    return skin + 2.0 * (LAYERS**2 - 1) / 3.0 * near


def against_textbook() -> dict[str, LawError]:
    """Errors of the effects of which there is another textbook law."""
    pairs = (
        (ForceConstantOverStroke, ParabolaOverStroke, DAMPER),
        (HysteresisDrag, DahlOfSecondPower, DAMPER),
        (ShuntHeating, ShuntInBalance, DAMPER),
        (SensorLag, BesselFilter, DAMPER),
        (DirectSaturation, SaturatingDirectAxis, DQ),
        (AcWindingLoss, DowellLoss, DQ),
    )
    found = {}
    for effect, other, model in pairs:
        base = answers(model)
        found[effect.name()] = worst(
            law_error(effect, model, base, answers(model + other(s)), s) for s in sizes(effect)
        )
    return {**found, ViscosityTemperature.name(): viscosity_error(), IronLossResistance.name(): iron_error()}


def iron_error() -> LawError:
    """Conductance over frequency against Bertotti's law: at 100 Hz a third hysteresis, a fifth excess (1988); its size
    against a tenth of hysteresis at 800 rad/s, which at 100 Hz is another total."""
    slower = REFERENCE / (4 * RPM * np.linspace(250.0, 3000.0, 12))
    bertotti = 7 / 15 + 1 / 3 * slower + 1 / 5 * np.sqrt(slower)
    shapes = np.column_stack([np.ones_like(slower), slower]) / bertotti[:, None]
    left = np.linalg.lstsq(shapes, np.ones_like(slower), rcond=None)[1]
    return LawError(float(np.sqrt(left[0] / len(slower))), 0.9 + 0.1 * 800.0 / REFERENCE - 1)


def viscosity_error() -> LawError:
    """The exponential law against Walther's (ASTM D341) of an ISO VG 32 oil, 32 mm^2/s at 40 and 5.4 at 100 degC."""
    temperature = np.linspace(20.0, 45.0, 26)  # degC
    kelvin, at = np.log10(temperature + 273.15), np.log10(np.array([40.0, 100.0]) + 273.15)
    known = np.log10(np.log10(np.array([32.0, 5.4]) + 0.7))
    line = np.polyfit(at, known, 1)
    viscosity = 10**10 ** np.polyval(line, kelvin) - 0.7
    change = viscosity / viscosity[0] - 1.0
    fit = least_squares(lambda b: np.expm1(-b[0] * (temperature - 20.0)) - change, [0.03])
    slope = -np.gradient(viscosity, temperature)[0] / viscosity[0]
    return LawError(float(np.linalg.norm(fit.fun) / np.linalg.norm(change)), abs(float(fit.x[0]) / slope - 1))


def main() -> None:
    library = package_effects()
    for name, error in sorted({**against_truths(), **against_textbook()}.items()):
        known = declared(library[name])
        print(f"{name:28s} measured {error.change:7.4f}   declared {known.change:.4f}   ", end="")
        print(f"of the size measured {error.size:7.4f}   declared {known.size:.4f}")


if __name__ == "__main__":
    main()
