"""What freeing each dimension of the cross-section gains in torque per metre under the same saturation limit.

``python -m benchmarks.freed_variables`` takes the motorcycle's slots and stator diameter, frees one dimension at a time
beside back iron and rotor radius, then all together, then takes other slot and pole counts, and writes
``results/reference/benchmarks/freed_variables.csv``. A minute of computing on an idle core.
"""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from geometry.family import Combination
from geometry.variables import FURTHER
from magnetostatics.case import FamilyCase
from optimisation.constrained_optimum import NoOptimumError
from optimisation.design import Judge
from optimisation.freedom import Freedom
from optimisation.gradient_optimum import find_optimum_by_gradients
from optimisation.sweep import SaturationLimit
from optimisation.torque import QuickMeanTorque
from pipeline.modules import PROJECT
from study.inputs_field import field_case, saturation_limit
from study.inputs_variables import freedom
from study.read import read_study

TABLE = PROJECT / "results" / "reference" / "benchmarks" / "freed_variables.csv"
BOUNDS = {
    "magnet_length_mm": (1.5, 3.5),
    "magnet_arc_fraction": (0.6, 0.98),
    "airgap_mm": (0.4, 0.8),
    "tooth_width_mm": (3.0, 9.0),
    "slot_opening_mm": (1.0, 3.5),
    "shoe_d1_mm": (0.5, 3.0),
    "shoe_d2_mm": (0.5, 3.0),
}  # what such a machine may have; estimates
_OTHERS = (Combination(12, 14), Combination(9, 10), Combination(9, 8))


def freed_with(keys: tuple[str, ...]) -> Freedom:
    """The motorcycle's freedom with these keys of [variables]."""
    return freedom(read_study("motorcycle", [f"variables.{key}=[{BOUNDS[key][0]}, {BOUNDS[key][1]}]" for key in keys]))


def found(case: FamilyCase, limit: SaturationLimit, combination: Combination, free: Freedom) -> dict[str, object]:
    """One optimum from the study's own machine, in drawing units; without numbers where none was found."""
    judge = Judge(case, limit.reading, case.nominal_density, QuickMeanTorque())
    start = [one.of(case.family.machine(combination)) for one in free.variables]
    try:
        best = find_optimum_by_gradients(judge, combination, case.family.stator_outer_radius, limit.limit, start, free)
    except NoOptimumError as error:
        return {"said": str(error)}
    machine = best.design.machine
    values = {one.key: one.drawn(one.of(machine)) for one in (*free.variables[:2], *FURTHER)}
    return {"torque_Nm_per_m": best.design.torque, "limited_T": best.design.limited, "designs": best.solves, **values}


def rows() -> Iterator[dict[str, object]]:
    """Nothing freed, each alone, all together, all but the gap; then other slots and poles, as swept."""
    study = read_study("motorcycle")
    case, limit = field_case(study), saturation_limit(study)
    own, every = case.family.combination, tuple(BOUNDS)
    alone = [(key, (key,)) for key in every]
    groups = [("nothing", ()), *alone, ("all but the gap", tuple(k for k in every if k != "airgap_mm")), ("all", every)]
    for name, keys in groups:
        yield {"freed": name, "slots": own.slots, "poles": own.poles} | found(case, limit, own, freed_with(keys))
    for other in _OTHERS:
        free = freed_with(())
        yield {"freed": "nothing", "slots": other.slots, "poles": other.poles} | found(case, limit, other, free)


def table() -> pd.DataFrame:
    """With the gain over the machine that is optimised in back iron and rotor radius alone [%]."""
    made = pd.DataFrame(rows())
    made.insert(4, "gain_percent", 100 * (made.torque_Nm_per_m / made.torque_Nm_per_m[0] - 1))
    return made


if __name__ == "__main__":
    result = table()
    result.to_csv(TABLE, index=False, float_format="%.6g")
    print(result.to_string(index=False))
