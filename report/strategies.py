"""Control laws for people: their best settings and the LQR beside those of the thesis, carpets, responses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from figures.files import File, figure_file, picture_name, table_file
from figures.report import Picture, Section, Table
from figures.strategies import carpets, responses
from units import FACTORS, GRAVITY, MILLIMETRE
from vehicle.models import QuarterCar
from vehicle.printed_car import PRINTED_CAR
from vehicle.quarter_car import printed_form
from vehicle.strategies import LAWS, LqrSetting, Strategies

TABLE, CARPETS, RESPONSES = "strategies.csv", "strategies_carpets", "strategies_responses"


@dataclass(frozen=True)
class PrintedBest:
    """A best setting of section 4.2.2: settings as ``vehicle.strategies.LAWS`` names them, and the index there.

    value: comfort [g] or road holding, None where it is not printed
    """

    first: float
    second: float
    value: float | None


# Text of section 4.2.2. The 0.038 that it gives as the LQR's best road holding is the comfort index of Table 4.1, whose
# 0.05 no road gives; 0.057 is that of the non-linear model (Table 4.9).
PRINTED = {
    ("skyhook", "comfort"): PrintedBest(168.0, 20e3, 2e-2),
    ("skyhook", "road holding"): PrintedBest(1842.0, 1431.0, 0.055),
    ("groundhook", "comfort"): PrintedBest(910.0, 10.0, None),
    ("groundhook", "road holding"): PrintedBest(2121.0, 40.0, 0.057),
    ("spring negation", "comfort"): PrintedBest(10.0, 23e3, 0.002),
    ("spring negation", "road holding"): PrintedBest(2154.0, 9230.0, 0.056),
    ("LQR", "comfort"): PrintedBest(1.0, 1.0, 1e-4),
    ("LQR", "road holding"): PrintedBest(3.39e6, 22.23e6, 0.057),
}
# Table 4.1: comfort [g], road holding, largest stroke [mm]
PRINTED_LQR = {
    "comfort-oriented": (1e-4, 0.49, 61.0),
    "trade-off": (1.4e-2, 0.13, 71.0),
    "handling-oriented": (3.8e-2, 0.05, 18.0),
}


def files(found: Strategies) -> Iterator[File]:
    """The best settings and the figures."""
    yield table_file(TABLE, best_table(found))
    yield figure_file(CARPETS, carpets(found))
    yield figure_file(RESPONSES, responses(found))


def section(found: Strategies) -> Section:
    """What the control laws can do with the vehicle of the study."""
    settings = sum(one.comfort.size for one in found.carpets.values())
    return Section(
        "Control laws over their settings",
        (
            f"{settings:,} settings of four laws by covariance, with an ideal actuator on the corner of the vehicle "
            "that carries it, linear, on the study's random road (thesis section 4.2.2). The thesis's numbers are "
            "those of its quarter car. Comfort is the weighted acceleration, road holding the missing tyre load over "
            "the static one, both RMS. A best comfort at an end of the grid is the law without bounds: a body that "
            "the road no longer reaches, on a wheel that nothing damps.",
            Table(car_table(found.car), "The corner beside the thesis's quarter car (Table 4.4)."),
            Table(best_table(found), "Best settings of every law, stationary. With the whole spring "
                  "negated nothing holds the body and no ride is stationary; the thesis's 0.002 g is 15 s from rest."),
            Picture(picture_name(CARPETS), "Each line: the first setting held; dots: the second one at its least."),
            Table(lqr_table(found), "The LQR from rest over the road's duration (Table 4.1); its weights over m_s are "
                  "those of the thesis. The comfort setting never becomes stationary."),
            Table(law_table(found), "The laws as forces: F = -a1 dz - a2 z_u + a3 dz' + a5 z_s' (eqs 4.25 to 4.27, "
                  "signs and names put right)."),
            Picture(picture_name(RESPONSES), "The LQR settings over frequency (Fig. 4.18)."),
        ),
    )  # fmt: skip


def car_table(car: QuarterCar) -> pd.DataFrame:
    """The corner beside Table 4.4, in drawing units."""
    rows = {
        "sprung mass / kg": ("sprung_mass", 1.0),
        "unsprung mass / kg": ("unsprung_mass", 1.0),
        "spring / (kN/m)": ("spring_stiffness", FACTORS["kN_per_m"]),
        "tyre / (kN/m)": ("tyre_stiffness", FACTORS["kN_per_m"]),
    }
    return pd.DataFrame(
        [
            {"quantity": name, "here": getattr(car, key) / unit, "thesis": getattr(PRINTED_CAR, key) / unit}
            for name, (key, unit) in rows.items()
        ]
    )


def best_table(found: Strategies) -> pd.DataFrame:
    """Two rows a law: its best comfort and its best road holding, beside the printed ones."""
    return pd.DataFrame([row for law in LAWS for row in _best(law.name, law.first, law.second, found)])


def _best(name: str, first: str, second: str, found: Strategies) -> Iterator[dict[str, object]]:
    one = found.carpets[name]
    for index, values, unit in (("comfort", one.comfort, GRAVITY), ("road holding", one.road_holding, 1.0)):
        a, b, value = one.best(values)
        printed = PRINTED[name, index]
        yield {
            "law": name, "best": index, "settings": f"{first}, {second}",
            "here": f"{a:.4g}, {b:.4g}", "index": value / unit,
            "thesis": f"{printed.first:.4g}, {printed.second:.4g}",
            "index of the thesis": np.nan if printed.value is None else printed.value,
        }  # fmt: skip


def lqr_table(found: Strategies) -> pd.DataFrame:
    """The three settings beside Table 4.1."""
    return pd.DataFrame([_lqr_row(one) for one in found.settings])


def _lqr_row(one: LqrSetting) -> dict[str, object]:
    comfort, holding, stroke = PRINTED_LQR[one.name]
    return {
        "setting": one.name,
        "r_s": one.weights.stroke,
        "r_h": one.weights.wheel,
        "comfort / g": one.indices.comfort / GRAVITY,
        "thesis / g": comfort,
        "road holding": one.indices.road_holding,
        "road holding, thesis": holding,
        "largest stroke / mm": one.stroke_peak / MILLIMETRE,
        "thesis / mm": stroke,
    }


def law_table(found: Strategies) -> pd.DataFrame:
    """Coefficients of the three settings."""
    return pd.DataFrame([{"setting": one.name} | _coefficients(one) for one in found.settings])


def _coefficients(one: LqrSetting) -> dict[str, float]:
    units = {"a1": "a1 / (N/m)", "a2": "a2 / (N/m)", "a3": "a3 / (Ns/m)", "a5": "a5 / (Ns/m)"}
    return {units[name]: value for name, value in printed_form(one.feedback).items()}
