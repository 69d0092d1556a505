"""``airgap shunt-laws FOLDER``: which static law the damping of a shunted machine follows."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from bench.errors import RecordError
from bench.report.shunt_laws import shunt_analysis
from bench.shunt_damping import ShuntDevice, ShuntPoints
from pipeline.analyse_command import print_results, write_results
from pipeline.own_effects import exit_on_wrong_campaign
from units import MILLIOHM
from workbench.data.campaign import read_campaign
from workbench.data.table import OPEN_CIRCUIT, Campaign
from workbench.models.damper.model import DamperModel

_KIND, _RESPONSE = "damping_shunt", "damping"


def add_shunt_laws(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``airgap shunt-laws``."""
    parser.description = "Static laws of a shunted damper beside a campaign's table of damping over shunt."
    parser.add_argument("campaign", help="folder of a campaign of a damper with a table damping_shunt")
    parser.add_argument("--constant-factor", type=float, default=1.0,
                        help="identified force constant over the stated one (thesis table 4.2: 0.866)")  # fmt: skip
    parser.add_argument("--rectifier-mohm", type=float, default=0.0,
                        help="resistance that the rectifier is said to add (thesis appendix B: 70)")  # fmt: skip
    parser.add_argument("--low-speed-friction", type=float, default=None, metavar="NS_PER_M",
                        help="slope of the open circuit at low speed (thesis: 351); default: the device's")  # fmt: skip
    parser.add_argument("--out", metavar="DIR", help="where results go; default results/<campaign>/")
    parser.set_defaults(run=shunt_laws)


def shunt_laws(options: argparse.Namespace) -> None:
    """See the module's text."""
    with exit_on_wrong_campaign():
        campaign = read_campaign(options.campaign)
        damper = DamperModel().design(campaign.device)
        low = damper.viscous_damping if options.low_speed_friction is None else options.low_speed_friction
        device = ShuntDevice(damper.force_constant, damper.internal_resistance, damper.viscous_damping, low,
                             options.constant_factor, options.rectifier_mohm * MILLIOHM)  # fmt: skip
        found = shunt_analysis(device, _points(campaign))
    out = Path(options.out) if options.out else Path("results") / campaign.id
    write_results(out, "shunt-laws", found)
    print_results(found, out)


def _points(campaign: Campaign) -> ShuntPoints:
    """All closed circuits of the campaign."""
    tables = [table for table in campaign.tables if table.kind == _KIND]
    if not tables:
        raise RecordError(
            f"{campaign.folder}: expected a table of kind {_KIND}, found none; `airgap analyse constant-speed` makes "
            "its values."
        )
    shunt = np.concatenate([table.conditions["shunt"] for table in tables])
    damping = np.concatenate([table.responses[_RESPONSE].values for table in tables])
    closed = shunt < OPEN_CIRCUIT
    return ShuntPoints(shunt[closed], damping[closed])
