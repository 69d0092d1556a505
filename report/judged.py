"""The designs of the search over all stages on the road, for people: what each recovers, how it rides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from figures.files import File, figure_file, table_file, text_file
from figures.judged import judged_designs
from figures.report import Picture, Remark, Section, Table, render_report
from units import GRAVITY, MILLIMETRE
from vehicle.judged_designs import JudgedDesign, JudgedDesigns

TABLE, PAGE, FIGURE = "judged.csv", "judged.html", "judged_designs"
_STAGED = 1  # number of the design that was found stage by stage


def files(found: JudgedDesigns) -> Iterator[File]:
    """Every design, the figure, and the page."""
    figure = _figure(found)
    yield table_file(TABLE, table(found.designs))
    yield figure_file(FIGURE, figure)
    title, subtitle = "Designs judged on the road", "Comfort, road holding and recovered power of every design found"
    yield text_file(PAGE, render_report((section(found, figure),), title=title, subtitle=subtitle))


def section(found: JudgedDesigns, figure: Figure) -> Section:
    """What the road says of the designs."""
    answers = (("most recovered power", lambda one: -one.recovered), ("best comfort", lambda one: one.comfort),
               ("best road holding", lambda one: one.road_holding))  # fmt: skip
    chosen = [(words, min(found.designs, key=key)) for words, key in answers]
    rows = table([one for _, one in chosen])
    rows.insert(0, "judged by", [words for words, _ in chosen])
    return Section(
        "Designs on the road",
        (
            f"{len(found.designs)} designs, each driven over the first random road with every damping and force loop; "
            "an index counts with the damping that serves it best. All of them meet the requirements by the fits. "
            "Friction, gear efficiency, mount and loop are those of the actuator designed stage by stage; torque is "
            "bounded by the overload current, since the search chooses no winding.",
            *(Remark(line) for line in remarks(found)),
            Table(rows, "The designs that win by one index."),
            Picture(figure, "Recovered power, comfort and road holding over the mass."),
            Table(table(_some(found.best)), "Designs that no other betters in mass, comfort, road holding and "
                  "recovered power together, comfort and road holding to a hundredth; of many every so many, all in "
                  "judged.csv. A number is the design's in optimise.csv, which “airgap take-over” goes on with."),
        ),
    )  # fmt: skip


def _some(designs: Sequence[JudgedDesign]) -> Sequence[JudgedDesign]:
    """Of many designs so many that a table is read, over the whole range."""
    places = np.unique(np.linspace(0, len(designs) - 1, _ROWS).round().astype(int))
    return [designs[k] for k in places]


_ROWS = 16


def remarks(found: JudgedDesigns) -> Iterator[str]:
    """Designs that could not be driven, and what the road tells apart."""
    if found.refused:
        name, reason = next(iter(found.refused.items()))
        yield f"{len(found.refused)} designs could not be driven; {name}: {reason}."
    comfort = [one.comfort for one in found.designs]
    apart = max(comfort) / min(comfort) - 1
    power = [one.recovered for one in found.designs]
    yield (
        f"Comfort differs by {100 * apart:.1f} % between the designs, recovered power by "
        f"{max(power) - min(power):.1f} W: the force loop hides the mechanics from the vehicle; the battery pays."
    )


def table(designs: Sequence[JudgedDesign]) -> pd.DataFrame:
    """One design a row, in drawing units."""
    return pd.DataFrame([_row(one) for one in designs])


def _row(one: JudgedDesign) -> dict[str, object]:
    design, (mass, inertia, *_) = one.rated.design, one.rated.values.objectives
    return {
        "number": "front" if one.number is None else str(one.number),
        "slots": design.combination.slots,
        "poles": design.combination.poles,
        "stator_diameter_mm": 2 * design.stator_outer_radius / MILLIMETRE,
        "active_length_mm": design.active_length / MILLIMETRE,
        "transmission_ratio_mm_per_rad": design.transmission_ratio / MILLIMETRE,
        "mass_kg": mass,
        "equivalent_mass_kg": inertia,
        "recovered_W": one.recovered,
        "recovered_with": one.recovered_command,
        "comfort_g": one.comfort / GRAVITY,
        "comfort_with": one.comfort_command,
        "road_holding": one.road_holding,
        "holding_with": one.holding_command,
    }


def _figure(found: JudgedDesigns) -> Figure:
    staged = [one for one in found.designs if one.number == _STAGED]
    return judged_designs(table(found.designs), table(found.best), table(staged).iloc[0] if staged else None)
