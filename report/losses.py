"""Losses and efficiency of the wound machine for people."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
import xarray as xr

from electrical.winding_stage import WindingOutcome
from figures.files import File, figure_file, picture_name
from figures.losses import loss_maps
from figures.report import Picture, Section, Table
from losses.stage import BestPoint, LossMap
from units import RPM

MAP, FIGURE = "loss_map.nc", "losses"
CAPTION = "Electrical loss and efficiency, motoring above and braking below."


def files(found: LossMap, winding: WindingOutcome) -> Iterator[File]:
    """The map as NetCDF in drawing units, and its figure."""
    data = dataset(found)
    yield File(MAP, lambda path: data.to_netcdf(path))
    yield figure_file(FIGURE, loss_maps(found.losses, _title(found, winding)))


def section(found: LossMap) -> Section:
    """What the losses rest on and where the machine is best."""
    stands_in = f", which stand in for {found.steel}" if found.law_is_of_another_grade else ""
    text = (
        f"Copper at {found.winding_temperature:g} °C ({100 * found.end_turn_share:.0f} % of its loss in the end "
        f"turns), iron by the loss data of {found.law.grade}{stands_in}, eddy currents in the magnets; currents are "
        "the least that the flux map allows at each torque and speed. Without bearings, windage and the inverter."
    )
    table = pd.DataFrame([_row("motor", found.motor), _row("generator", found.generator)])
    return Section(
        "Losses and efficiency",
        (
            text,
            Picture(picture_name(FIGURE), CAPTION),
            Table(table, "Best points."),
        ),
    )


def dataset(found: LossMap) -> xr.Dataset:
    """The map over torque and speed as a labelled data set in drawing units."""
    losses, names = found.losses, ("torque_Nm", "speed_rpm")
    values = {"copper_W": losses.copper, "stator_iron_W": losses.stator_iron, "rotor_iron_W": losses.rotor_iron}
    values |= {
        "magnet_W": losses.magnet,
        "circulating_W": losses.circulating,
        "total_W": losses.total,
        "efficiency": losses.efficiency,
    }
    axes = dict(zip(names, (losses.torque[:, 0], losses.speed[0] / RPM), strict=True))
    return xr.Dataset({name: (names, value) for name, value in values.items()}, axes)


def _row(sense: str, best: BestPoint) -> dict[str, object]:
    return {
        "as": sense,
        "efficiency_percent": 100 * best.efficiency,
        "torque_Nm": best.torque,
        "speed_rpm": best.speed / RPM,
    }


def _title(found: LossMap, winding: WindingOutcome) -> str:
    return f"{winding.chosen.design}; iron loss data of {found.law.grade} for {found.steel}"
