"""A law that no effect is, on a damper whose readings are closed forms: it is noticed, described, and given no name."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import gamma, pi, sqrt

import numpy as np
import pytest

from effects.damper_design import Damper
from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.explain.explore import beliefs_of, posterior
from workbench.likelihood.unknown_laws import (
    LAWS,
    UnknownBendOfForce,
    UnknownForceOfVelocity,
    UnknownMount,
    UnknownPartBeside,
    UnknownThinningForce,
)
from workbench.models.bases import nominal_model
from workbench.models.damper.model import DamperModel
from workbench.models.model import Model

K, R, M, C = 60.0, 1.2, 1.5, 15.0  # N/A, ohm, kg, N s/m
FREE = 1e6  # ohm, open terminals
TOML = """
[campaign]
id = "power_law"
repeats = 2
[device]
kind = "electromagnetic damper"
force_constant_N_per_A = 60.0
internal_resistance_ohm = 1.2
moving_mass_kg = 1.5
viscous_damping_Ns_per_m = 15.0
[tolerance]
force_constant_N_per_A = { sigma_rel = 0.01 }
viscous_damping_Ns_per_m = { sigma_rel = 0.03 }
[[table]]
file = "force_velocity.csv"
kind = "damping_velocity"
u_random = { force_N = "0.3 + 0.005*abs(y)" }
[[table]]
file = "impedance.csv"
kind = "impedance"
u_random = { re_Ns_per_m = "1 + 0.01*abs(z)", im_Ns_per_m = "1 + 0.01*abs(z)" }
"""


THETA = (np.arange(2000) + 0.5) * 2 * pi / 2000


@dataclass(frozen=True)
class Drag:
    """A law of the velocity in newtons, and what it is worth in an impedance at an amplitude of the velocity [N]."""

    force: Callable
    fundamental: Callable


def power_law(size, power):
    mean = 2 / sqrt(pi) * gamma(power / 2 + 1) / gamma(power / 2 + 1.5)  # of |sin|^power sign(sin)
    return Drag(lambda v: size * np.sign(v) * abs(v) ** power, lambda top: size * mean * top**power)


def thinning_law(size, corner):
    force = lambda v: size * v / (corner + abs(v))  # noqa: E731
    return Drag(force, lambda top: 2 * np.mean(np.sin(THETA) * force(top * np.sin(THETA))))


def written(folder, drag):
    random, folder = np.random.default_rng(5), folder / "a_law"
    folder.mkdir()
    steady, waves = ["repeat,shunt_ohm,velocity_m_per_s,force_N"], ["repeat,shunt_ohm,frequency_Hz,amplitude_m,re,im"]
    for repeat in (0, 1):
        for shunt in (0.5, 5.0, FREE):
            for v in np.outer([0.02, 0.05, 0.1, 0.2, 0.3, 0.4], [1, -1]).ravel():
                force = (C + K**2 / (R + shunt)) * v + drag.force(v)
                force += (0.3 + 0.005 * abs(force)) * random.standard_normal()
                steady.append(f"{repeat},{shunt},{v},{force:.6f}")
        for amplitude in (1e-3, 4e-3):
            for f in np.geomspace(1.0, 30.0, 12):
                top = 2 * pi * f * amplitude
                z = C + K**2 / (R + 5.0) + 2j * pi * f * M + drag.fundamental(top) / top
                z += (1 + 0.01 * abs(z)) * (random.standard_normal() + 1j * random.standard_normal())
                waves.append(f"{repeat},5.0,{f:.6f},{amplitude},{z.real:.6f},{z.imag:.6f}")
    waves[0] = waves[0].replace("re,im", "re_Ns_per_m,im_Ns_per_m")
    (folder / "force_velocity.csv").write_text("\n".join(steady) + "\n", encoding="utf-8")
    (folder / "impedance.csv").write_text("\n".join(waves) + "\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    return read_campaign(folder)


def said_of(drag, folder):
    """The law in words, where no effect is named."""
    campaign = written(folder, drag)
    found = diagnose(nominal_model(campaign), campaign, package_effects())
    assert found.verdict == "none_of_these" and not found.names
    return found.residual_signature["law"]


def test_a_power_law_is_said_to_be_unknown_and_its_power_is_told(tmp_path):
    words, _, told = said_of(power_law(60.0, 1.5), tmp_path).rpartition(" ")
    assert words == "a force that goes with the velocity to the power"
    assert float(told) == pytest.approx(1.5, abs=0.1)


def test_a_thinning_fluid_is_no_friction_but_said_to_thin(tmp_path):
    assert said_of(thinning_law(15.0, 0.06), tmp_path).startswith("a force that goes with the velocity and thins")


MODEL = Model(DamperModel(), Damper(K, R, M, C))
SWEEP = {"frequency": np.array([2.0, 8.0, 20.0]), "amplitude": np.full(3, 4e-3), "shunt": np.full(3, 5.0)}
TOP = 2 * pi * SWEEP["frequency"] * SWEEP["amplitude"]


def law_of(kind, **values):
    """A law as it acts on the damper, first form."""
    return replace(kind.variants(MODEL.design)[0], **values)


def impedance(effect=None, design=MODEL.design):
    """With a law that changes the design, or what it answers, or what is read."""
    design = effect.on_design(design) if hasattr(effect, "on_design") else design
    found = MODEL.base.respond(design, "impedance", SWEEP)
    if hasattr(effect, "on_response"):
        found = effect.on_response(found, SWEEP, "impedance", design)
    if hasattr(effect, "on_reading"):
        found = effect.on_reading(found, SWEEP, "impedance")
    return found["re"] + 1j * found["im"]


def test_a_power_through_the_model_has_the_closed_form_of_its_waves():
    """Its force at constant velocity and in the impedance are one law."""
    law = law_of(UnknownForceOfVelocity)
    law = replace(law, size=20.0 * law.reference**0.5 / law.scale, power=0.5)
    change = power_law(20.0, 0.5).fundamental(TOP) / TOP
    assert (impedance(law) - impedance()).real == pytest.approx(change, rel=0.02)


def test_a_force_that_thins_ends_as_dry_friction_and_begins_as_a_dashpot():
    """Describing function of dry friction F: 4 F / pi / velocity."""
    friction = law_of(UnknownThinningForce, size=0.02, corner=1e-3, power=0.0)
    assert impedance(friction) - impedance() == pytest.approx(4 / pi * 0.02 * friction.scale / TOP, rel=0.03)
    dashpot = law_of(UnknownThinningForce, size=0.2, corner=10.0)
    assert impedance(dashpot) - impedance() == pytest.approx(
        0.2 * dashpot.scale / dashpot.reference + 0 * TOP, rel=0.01
    )


def test_parts_beside_the_device_are_springs_dashpots_and_masses_at_whole_powers():
    s, scale = 2j * pi * SWEEP["frequency"], K**2 / R
    known = (2 * pi * 10.0 * scale / s, scale + 0 * s, scale * s / (2 * pi * 10.0))
    for power, part in enumerate(known):
        law = law_of(UnknownPartBeside, size=0.1, power=float(power))
        assert impedance(law) - impedance() == pytest.approx(0.1 * part, rel=1e-9)


def test_a_spring_that_softens_with_its_amplitude_to_the_power_minus_one_carries_one_force():
    law = law_of(UnknownPartBeside, size=0.1, power=0.0, amplitude_power=-1.0)
    carried = 0.1 * K**2 / R * 2 * pi * 10.0 * 2e-3  # N, the spring at the travel where the law has its size
    spread = {**SWEEP, "amplitude": np.array([1e-3, 2e-3, 4e-3])}
    answer = {"re": np.zeros(3), "im": np.zeros(3)}
    found = law.on_response(answer, spread, "impedance", MODEL.design)
    assert -found["im"] * 2 * pi * spread["frequency"] * spread["amplitude"] == pytest.approx(carried + np.zeros(3))


def test_a_mount_without_loss_is_the_spring_of_the_model():
    """Thesis eq. B.4 with the stiffness that the law has at power zero."""
    mounted = replace(MODEL.design, mount_stiffness=K**2 / R * 2 * pi * 10.0 / 0.05)
    spring = law_of(UnknownMount, size=0.05, power=0.0)
    assert impedance(spring) == pytest.approx(impedance(design=mounted), rel=1e-9)


@pytest.mark.parametrize("form", [0, 1])
def test_a_reading_that_bends_shows_the_fundamental_of_the_bent_sine(form):
    law = replace(UnknownBendOfForce.variants(MODEL.design)[form], size=0.05, level=0.1)
    peak = abs(impedance()) * TOP
    wave = peak[:, None] * np.sin(THETA)
    shown = law.on_reading({"force": wave.ravel()}, {}, "damping_velocity")["force"].reshape(wave.shape)
    factor = 2 * np.mean(shown * np.sin(THETA), axis=1) / peak
    assert impedance(law) == pytest.approx(factor * impedance(), rel=2e-4)
    assert law.gain(np.array([1.0, 1e5])) == pytest.approx([1.0, 1.05], abs=1e-3)


def test_a_set_with_a_law_counts_as_its_effects_beside_something_unknown():
    library = package_effects() | LAWS
    names = ("coulomb_friction", "unknown_force_of_velocity", "unknown_force_of_position")
    beliefs = beliefs_of(library, names)
    none, friction, law = frozenset(), frozenset(names[:1]), frozenset(names[1:2])
    p = posterior({none: 0.0, friction: 5.0, law: 9.0, friction | law: 8.0}, {}, beliefs)
    assert set(p.alone) == {none, friction} and set(p.beside) == {none, friction}
    assert p.remains == pytest.approx(p.none_of_these + p.beside[friction])
    assert not beliefs.may_join(names[2], law), "one unknown law at a time"


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_law_of_no_size_is_none(law):
    assert law().is_null and not law().at(np.array([1.0, 0.0])).is_null
    assert law().words().startswith(law.goes_with)
