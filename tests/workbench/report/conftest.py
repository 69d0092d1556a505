"""Findings made by hand, small but complete: a damper with Coulomb friction that its model does not have."""

from dataclasses import replace

import numpy as np
import pytest

from workbench.findings import (
    Axis,
    ChannelFit,
    ChannelScore,
    Comparison,
    Dependence,
    DetectionLimit,
    Diagnosis,
    Estimate,
    FinalParameter,
    LearnedAt,
    Ledger,
    LedgerStep,
    NextMeasurement,
    OrderSpectrum,
    Parity,
    Pull,
    Ranked,
    RegimeMap,
    Scaling,
    Sealed,
    Sequence,
    SignatureMatch,
    SizePosterior,
    Whiteness,
)  # fmt: skip

FORCE = "force_velocity.force"
VOLTAGE = "open_circuit.voltage"
TORQUE = "cogging.torque"
DEPENDS = (Dependence("velocity", 5e-4), Dependence("shunt", 0.3))
SIGNATURES = (
    SignatureMatch("coulomb_friction", "Coulomb friction", 0.97),
    SignatureMatch("stribeck", "Stribeck friction", 0.93),
    SignatureMatch("diode_drop", "diode drop", -0.42),
    SignatureMatch("force_gain", "force gain", 0.11),
)


def score(channel, unit, chi2, share=0.0, held_out=None):
    held_out = chi2 if held_out is None else held_out
    return ChannelScore(
        channel, unit, 120, 0.4 * chi2**0.5, 1.3, 0.1 * chi2, chi2, 1.4 * chi2, held_out, 0.4, 0.41, share
    )


def fit(friction_left):
    """Force over velocity at two shunts; friction of 4 N that the model lacks by that share."""
    rng = np.random.default_rng(3)
    velocity = np.tile(np.linspace(-0.5, 0.5, 30), 4)
    velocity = velocity[np.abs(velocity) > 1e-9]
    shunt = np.repeat([1.0, 10.0], len(velocity) // 2)
    model = velocity * (20.0 + 3600.0 / (1.2 + shunt))
    u = 0.3 + 0.008 * np.abs(model)
    measured = model + friction_left * 4.0 * np.sign(velocity) + u * rng.standard_normal(len(velocity))
    held_out = np.arange(len(velocity)) // 30 % 2 == 1
    series = tuple(f"shunt {s:g} Ω" for s in shunt)
    return ChannelFit(
        FORCE, "N", Axis("velocity", "m_per_s"), velocity, measured, 1.05 * model, model, u, held_out, series
    )


def regime():
    mean = np.array([[-7.1, -5.2, 0.3, 5.5, 7.2], [-6.0, -4.1, np.nan, 4.3, 6.6]])
    p_value = np.where(np.abs(mean) > 2, 5e-4, 0.4)
    count = np.where(np.isnan(mean), 0, 12)
    edges = np.linspace(-0.5, 0.5, 6)
    return RegimeMap(
        FORCE, Axis("velocity", "m_per_s"), Axis("shunt", "ohm"), edges, np.array([0.5, 2, 20]), mean, p_value, count
    )


def line_of_cells():
    p = np.array([[0.3, 0.2, 0.9, 0.5]])
    return RegimeMap(VOLTAGE, Axis("velocity", "m_per_s"), None, np.linspace(0, 0.4, 5), np.array([0.0, 1.0]),
                     np.array([[0.3, -0.5, 0.1, 0.2]]), p, np.full((1, 4), 9))  # fmt: skip


def spectrum():
    orders = np.arange(1.0, 61.0)
    amplitude = 0.15 + 0.1 * np.abs(np.sin(7 * orders))
    for order, height in ((12, 3.1), (24, 1.6), (36, 0.8), (60, 0.9)):
        amplitude[order - 1] = height
    families = tuple(
        "native"
        if k == 60
        else "rotor"
        if k % 12 == 0
        else "encoder"
        if k < 3
        else "stator"
        if k % 10 == 0
        else "other"
        for k in orders
    )
    return OrderSpectrum(TORQUE, "mNm", orders, amplitude, np.full(60, 0.4), families)


def sequence(channel, trend, p_value):
    noise = np.random.default_rng(5).standard_normal(200)
    ramp = trend * (np.arange(200) / 199 - 0.5)
    return Sequence(channel, Axis("sample"), np.arange(200.0), noise + ramp, np.arange(200) // 50, trend, p_value)


@pytest.fixture(scope="session")
def comparison():
    """A model that fails in one channel, pulls one tolerance, and leaves structure."""
    return Comparison(
        campaign="damper-demo",
        model="damper",
        effects=(),
        failing=FORCE,
        chi2_per_n=7.4,
        held_out_chi2_per_n=7.9,
        scoreboard=(score(FORCE, "N", 12.3, 0.93), score(VOLTAGE, "V", 1.02), score(TORQUE, "mNm", 1.5, 0.07)),
        pulls=(Pull("viscous_damping", 5.2, 0.15, "", "tolerance"), Pull("force_constant", -1.1, 0.01, "", "tolerance"),
               Pull("force_offset", 0.4, 0.15, "N", "instrument")),
        fits=(fit(1.0),),
        regimes=(regime(), line_of_cells()),
        orders=(spectrum(),),
        scalings=(Scaling(FORCE, "velocity", 0.04, -0.06, 0.13, 30, "friction: independent of speed"),
                  Scaling(TORQUE, "speed", 0.9, -0.4, 2.1, 4)),
        parities=(Parity(FORCE, "direction", 5.4, 0.8, 0.7), Parity(VOLTAGE, "direction", 0.7, 0.75, 0.7)),
        sequences=(sequence(FORCE, 0.1, 0.7), sequence(VOLTAGE, 2.4, 0.0005)),
        whiteness=(Whiteness(FORCE, 0.75 ** np.arange(1, 21), 0.22, DEPENDS),
                   Whiteness(VOLTAGE, 0.05 * np.cos(np.arange(1.0, 21)), 0.22, (Dependence("velocity", 0.4),))),
        signatures=SIGNATURES,
        complaints=("force_velocity.csv: 2 of 122 rows have a gap and are left out",),
        provenance={"data": "9f2c0000", "seed": "1"},
    )  # fmt: skip


@pytest.fixture(scope="session")
def clean(comparison):
    """The same where the model holds."""
    return replace(
        comparison,
        failing="",
        chi2_per_n=1.01,
        held_out_chi2_per_n=0.99,
        scoreboard=(score(FORCE, "N", 1.04), score(VOLTAGE, "V", 0.98)),
        pulls=(Pull("force_constant", -1.1, 0.01, "", "tolerance"),),
        fits=(fit(0.0),),
        regimes=(line_of_cells(),),
        orders=(),
        scalings=(),
        parities=(Parity(FORCE, "direction", 0.7, 0.8, 0.7),),
        sequences=(sequence(FORCE, 0.1, 0.7),),
        whiteness=(Whiteness(VOLTAGE, 0.05 * np.cos(np.arange(1.0, 21)), 0.22, ()),),
        signatures=(SignatureMatch("stribeck", "Stribeck friction", 0.2),),
        complaints=(),
    )


def estimate(value, std, unit):
    return Estimate(value, std, value - 1.645 * std, value + 1.645 * std, unit)


def ranked(name, probability, gain, size, after):
    return Ranked(
        name, name, probability, gain, {"force": estimate(size, 0.08 * size, "N")}, 7.4, after, 7.9, 1.05 * after
    )


def posterior():
    values = np.linspace(2.5, 6.0, 200)
    density = np.exp(-0.5 * ((values - 4.1) / 0.3) ** 2) / (0.3 * (2 * np.pi) ** 0.5)
    return SizePosterior("coulomb_friction", "force", "N", values, density, np.full(200, 0.12), estimate(4.1, 0.3, "N"))


@pytest.fixture(scope="session")
def diagnosis():
    """One effect named."""
    names = ("coulomb_friction", "stribeck", "force_offset", "mount_compliance", "diode_drop", "contact_resistance")
    probabilities, gains = (0.95, 0.02, 1e-5, 1e-9, 1e-12, 0.0), (412.0, 408.1, 90.0, 20.0, 3.0, -1.2)
    after = (1.03, 1.04, 5.0, 6.6, 7.2, 7.4)
    return Diagnosis(
        campaign="damper-demo",
        model="damper",
        verdict="effect",
        names=("coulomb_friction",),
        probability=0.95,
        ranking=tuple(ranked(n, p, g, 4.1, a) for n, p, g, a in zip(names, probabilities, gains, after)),
        p_nothing_missing=1e-40,
        p_none_of_these=0.02,
        p_something_remains=0.03,
        p_sets={"coulomb_friction": 0.9, "coulomb_friction + force_offset": 0.05, "something unknown": 0.02,
                "coulomb_friction + something unknown": 0.01},
        sealed=Sealed(40, 1.04, 0.37, "conditions that were never fitted: they test prediction", True),
        abstention_power={3.0: 0.62, 10.0: 0.99},
        detection_limits=(DetectionLimit("coulomb_friction", "Coulomb friction", "force", 0.35, "N"),
                          DetectionLimit("diode_drop", "diode drop", "voltage", 0.12, "V")),
        next_measurements=(NextMeasurement("force_loop", "force loop at 2 mm and 1 Hz", {"frequency": 1.0}, 9.2, 2.0),
                           NextMeasurement("damping_velocity", "force at low speed once more", {}, 3.1, 1.0)),
        residual_signature={"channel": FORCE, "regime": "small velocity", "orders": [], "exponents": {"v": 0.04}},
        seed=1,
        wall_s=12.4,
        before=fit(1.0),
        after=fit(0.0),
        posteriors=(posterior(),),
        checks=("impedance.csv: real and imaginary part miss a causal device by 16 times their uncertainty",),
        complaints=("impedance.csv: only 10 rows; its noise and its residuals say little",),
    )  # fmt: skip


FOR = "the data speak for the effect, 10^13.0 to 1"


def step(number, effect, decision, chi2, held_out, reason=FOR):
    sizes = {} if not effect else {"force": estimate(4.1, 0.2, "N")}
    rms, noise, units = (
        {FORCE: 0.4 * chi2**0.5, VOLTAGE: 0.021},
        {FORCE: 0.4, VOLTAGE: 0.02},
        {FORCE: "N", VOLTAGE: "V"},
    )
    verdict = "nothing_missing" if held_out < 1.2 else "effect"
    return LedgerStep(
        number,
        effect,
        effect,
        decision,
        sizes,
        30.0,
        chi2,
        held_out,
        rms,
        noise,
        units,
        verdict,
        reason if effect else "",
    )


@pytest.fixture(scope="session")
def ledger():
    """Three accepted steps and a refused one."""
    return Ledger(
        "damper-demo",
        "damper",
        (
            step(0, "", "start", 27.4, 28.2),
            step(1, "contact_resistance", "accepted", 12.1, 12.6),
            step(
                2,
                "velocity_polynomial",
                "refused",
                8.0,
                19.4,
                f"{FOR}; chi2/n left out goes from 12.6 to 19.4: it rises",
            ),
            step(3, "coulomb_friction", "accepted", 2.3, 2.2),
            step(4, "position_drag", "accepted", 1.01, 1.04),
        ),
        parameters=(
            FinalParameter("coulomb_friction", "force", estimate(4.1, 0.2, "N")),
            FinalParameter("input", "viscous_damping", estimate(-3.0, 2.0, "%")),
        ),
        ranges=(LearnedAt(FORCE, 120, 1.01, {"velocity": (-0.5, 0.5, "m/s"), "shunt": (1.0, 1.0, "ohm")}),),
    )
