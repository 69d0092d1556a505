"""A law that no effect is, on a damper whose readings are closed forms: it is noticed, described, and given no name."""

from dataclasses import replace
from math import gamma, pi, sqrt

import numpy as np
import pytest

from effects.damper_design import Damper
from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.explain.explore import beliefs_of, posterior
from workbench.likelihood.unknown_laws import LAWS, UnknownForceOfVelocity
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


def mean_of_power(power):
    """Fundamental of |sin|^power sign(sin): what a law of that power is worth at an amplitude of one."""
    return 2 / sqrt(pi) * gamma(power / 2 + 1) / gamma(power / 2 + 1.5)


def written(folder, drag, power):
    random, folder = np.random.default_rng(5), folder / "power_law"
    folder.mkdir()
    steady, waves = ["repeat,shunt_ohm,velocity_m_per_s,force_N"], ["repeat,shunt_ohm,frequency_Hz,amplitude_m,re,im"]
    for repeat in (0, 1):
        for shunt in (0.5, 5.0, FREE):
            for v in np.outer([0.02, 0.05, 0.1, 0.2, 0.3, 0.4], [1, -1]).ravel():
                force = (C + K**2 / (R + shunt)) * v + drag * np.sign(v) * abs(v) ** power
                force += (0.3 + 0.005 * abs(force)) * random.standard_normal()
                steady.append(f"{repeat},{shunt},{v},{force:.6f}")
        for amplitude in (1e-3, 4e-3):
            for f in np.geomspace(1.0, 30.0, 12):
                top = 2 * pi * f * amplitude
                z = C + K**2 / (R + 5.0) + 2j * pi * f * M + drag * mean_of_power(power) * top ** (power - 1)
                z += (1 + 0.01 * abs(z)) * (random.standard_normal() + 1j * random.standard_normal())
                waves.append(f"{repeat},5.0,{f:.6f},{amplitude},{z.real:.6f},{z.imag:.6f}")
    waves[0] = waves[0].replace("re,im", "re_Ns_per_m,im_Ns_per_m")
    (folder / "force_velocity.csv").write_text("\n".join(steady) + "\n", encoding="utf-8")
    (folder / "impedance.csv").write_text("\n".join(waves) + "\n", encoding="utf-8")
    (folder / "campaign.toml").write_text(TOML, encoding="utf-8")
    return read_campaign(folder)


@pytest.mark.parametrize(("drag", "power"), [(20.0, 0.5), (60.0, 1.5)])
def test_a_power_law_is_said_to_be_unknown_and_its_power_is_told(tmp_path, drag, power):
    campaign = written(tmp_path, drag, power)
    found = diagnose(nominal_model(campaign), campaign, package_effects())
    assert found.verdict == "none_of_these" and not found.names
    words, _, told = found.residual_signature["law"].rpartition(" ")
    assert words == "a force that goes with the velocity to the power"
    assert float(told) == pytest.approx(power, abs=0.1)


def test_a_law_through_the_model_has_the_closed_form_of_its_waves():
    """Its force at constant velocity and in the impedance are one law."""
    model = Model(DamperModel(), Damper(K, R, M, C))
    (law,) = UnknownForceOfVelocity.variants(model.design)
    whole = replace(law, size=20.0 * law.reference**0.5 / law.scale, power=0.5)
    sweep = {"frequency": np.array([2.0, 8.0]), "amplitude": np.array([4e-3, 4e-3]), "shunt": np.full(2, 5.0)}
    top = 2 * pi * sweep["frequency"] * sweep["amplitude"]
    plain, changed = (model.base.respond(e.on_design(model.design), "impedance", sweep) for e in (law, whole))
    assert changed["re"] - plain["re"] == pytest.approx(20.0 * mean_of_power(0.5) * top**-0.5, rel=0.02)


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
def test_a_law_of_no_size_changes_nothing(law):
    assert law().is_null and not law().at(np.array([1.0, 0.0])).is_null
    assert law().words().endswith("to the power 1")
