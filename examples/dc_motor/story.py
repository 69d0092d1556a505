"""A new model on the workbench: a DC motor whose brushes were forgotten. Run: python -m examples.dc_motor.story

The bench is not the model: its brush voltage grows with the logarithm of the current, as contact voltages do.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from effects.library import effects_of_file, package_effects
from examples.dc_motor.model import BASE
from workbench.data.campaign import read_campaign
from workbench.explain.diagnosis import diagnose
from workbench.findings import Diagnosis
from workbench.models.model import Model
from workbench.report.sentences import verdict_sentence

DROP = 1.2  # V at 5 A
CAMPAIGN = """
[campaign]
id = "dc-motor"
repeats = 3
holdout = { rule = "last repeat of every table" }
[device]
torque_constant_Nm_per_A = 0.05
resistance_ohm = 0.4
[tolerance]
torque_constant_Nm_per_A = { sigma_rel = 0.01 }
resistance_ohm = { sigma_rel = 0.02 }
[[table]]
file = "load.csv"
kind = "generic"
u_random = { current_A = 0.03, speed_rad_per_s = 0.5 }
"""


def bench(folder: Path, seed: int = 7) -> Path:
    """Campaign of a motor with k = 0.0503 Nm/A, R = 0.398 ohm and carbon brushes."""
    random = np.random.default_rng(seed)
    voltage, torque, repeat = (v.ravel() for v in np.meshgrid([12.0, 18, 24], np.linspace(0.1, 0.5, 9), range(3)))
    current = torque / 0.0503
    speed = (voltage - DROP - 0.05 * np.log(current / 5.0) - 0.398 * current) / 0.0503
    noise = random.standard_normal((2, len(torque)))
    columns = {"repeat": repeat, "voltage_V": voltage, "torque_Nm": torque}
    measured = {"current_A": current + 0.03 * noise[0], "speed_rad_per_s": speed + 0.5 * noise[1]}
    pd.DataFrame(columns | measured).sort_values("repeat", kind="stable").to_csv(folder / "load.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN, encoding="utf-8")
    return folder


def told() -> Diagnosis:
    """The verdict on the motor without brushes in its model."""
    with TemporaryDirectory() as folder:
        campaign = read_campaign(bench(Path(folder)))
        library = package_effects() | effects_of_file(Path(__file__).parent / "brush_drop.py")
        return diagnose(Model(BASE, BASE.design(campaign.device)), campaign, library)


if __name__ == "__main__":
    print(verdict_sentence(told()))
