"""A convention that the nominal device does not feel is told from the effects that could stand for it."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from benchmarks.virtual_benches import damper_bench
from benchmarks.virtual_benches.hiding import hide
from benchmarks.virtual_benches.mistakes import Mistake, mistaken, scaled
from effects.library import package_effects
from workbench.data.campaign import read_campaign
from workbench.data.conventions import accepted
from workbench.explain.conventions import Conventions, settle
from workbench.explain.misread import misread
from workbench.explain.search import searched
from workbench.likelihood.bench import bench_of
from workbench.models.bases import nominal_model

LIBRARY = package_effects()
STROKE = Mistake("peak to peak", ("peak_to_peak",), ("impedance.csv",), scaled(("amplitude_m",), 2.0))


def looked_at(campaign) -> tuple[Conventions | None, frozenset[str]]:
    """What is misread, and the leading set of effects; nothing is to be settled before."""
    model = nominal_model(campaign)
    assert settle(model, campaign).are_right
    search = searched(bench_of(model, campaign, LIBRARY), LIBRARY)
    return misread(search, LIBRARY), search.ranked[0]


@pytest.fixture(scope="module")
def rubbing(tmp_path_factory) -> Path:
    """A damper with dry friction."""
    bench = hide(damper_bench.CATALOGUE, "single", 70003, ("coulomb_friction",))[0]
    return bench.write(tmp_path_factory.mktemp("right") / "damper")


def test_a_stroke_from_peak_to_peak_is_no_effect(rubbing, tmp_path):
    """Friction with twice the stroke looks like friction with another effect beside it, beyond doubt."""
    campaign = read_campaign(mistaken(STROKE, rubbing, tmp_path / "wrong"))
    found, leading = looked_at(campaign)
    assert len(leading) > 1
    assert found.names == ("peak_to_peak",) and found.probability > 0.97
    assert '"impedance.csv" = { factor = { amplitude = 0.5 } }' in found.fix
    assert looked_at(accepted(campaign, found.fix)) == (None, frozenset({"coulomb_friction"}))



POLE_PAIRS, LINKAGE, RESISTANCE = 4, 0.1, 0.5
MACHINE = f"""[campaign]
id = "generator"
repeats = 2

[device]
kind = "permanent-magnet synchronous machine"
pole_pairs = {POLE_PAIRS}
psi_m_Vs = {LINKAGE}
inductance_d_H = 3e-3
inductance_q_H = 3e-3
resistance_ohm = {RESISTANCE}

[tolerance]
psi_m_Vs = {{ sigma_rel = 0.01 }}
resistance_ohm = {{ sigma_rel = 0.02 }}

[[table]]
file = "map.csv"
kind = "dyno_map"
u_random = {{ power_W = "0.5 + 0.003*abs(y)" }}
"""


def driven(folder: Path, friction: float) -> Path:
    """A generator's map with torque and power as it gives them, by the closed form of a machine without saliency."""
    rng = np.random.default_rng(3)
    rpm, torque = (a.ravel() for a in np.meshgrid(np.linspace(500, 3000, 8), np.linspace(1, 8, 8)))
    in_gap = torque - friction
    power = in_gap * rpm * np.pi / 30 - 1.5 * RESISTANCE * (in_gap / (1.5 * POLE_PAIRS * LINKAGE)) ** 2
    given = {"speed_rpm": rpm, "torque_Nm": torque}
    read = (rng.normal(power, 0.5 + 0.003 * power) for _ in range(2))
    tables = [pd.DataFrame({"repeat": k, **given, "power_W": values}) for k, values in enumerate(read)]
    folder.mkdir()
    pd.concat(tables).to_csv(folder / "map.csv", index=False)
    (folder / "campaign.toml").write_text(MACHINE, encoding="utf-8")
    return folder


def test_power_that_a_generator_gives_is_one_mistake(tmp_path):
    """Torque and power are one habit. What drags besides is found in a search of its own."""
    found, leading = looked_at(read_campaign(driven(tmp_path / "map", 0.3)))
    assert leading != {"friction_torque"} and found.names == ("motoring_or_generating",)
    assert '"map.csv" = { invert = ["torque", "power"] }' in found.fix


def test_without_drag_the_signs_of_a_generator_are_settled_at_once(tmp_path):
    campaign = read_campaign(driven(tmp_path / "map", 0.0))
    assert settle(nominal_model(campaign), campaign).names == ("motoring_or_generating",)
