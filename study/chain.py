"""Which sections the design chain of a study needs, and whether its vehicle, linkage and gears can be."""

from __future__ import annotations

from drivetrain.four_bar import LinkageError
from study.errors import StudyError
from study.inputs_linkage import linkage_search
from study.inputs_vehicle import ride_case
from study.schema import Study
from vehicle.errors import VehicleError

TEMPLATE = "studies/template.toml"
_HARDPOINTS = ("hardpoint_a", "wheel_axle", "hardpoint_b_min", "hardpoint_b_max", "hardpoint_c_min", "hardpoint_c_max")


def drives(study: Study) -> bool:
    """Whether the requirements come from runs of the vehicle."""
    return study.chain is not None and study.chain.requirements == "vehicle"


def searches_linkage(study: Study) -> bool:
    """Whether the linkage comes from the Pareto front."""
    return study.chain is not None and study.chain.linkage == "optimised"


def check_chain(study: Study, origin: str) -> None:
    """Every section that the chain needs must be there; StudyError with one sentence otherwise.

    origin: where the values come from, for the sentence
    """
    said = _vehicle_problem(study) if drives(study) else _stated_problem(study)
    said = said or (_linkage_problem(study) if searches_linkage(study) else None)
    if said is not None:
        raise StudyError(f"{origin}: {said}.")


def _stated_problem(study: Study) -> str | None:
    if study.requirements is None:
        return (
            "section [requirements] is missing; add it, or let runs of the vehicle give them with "
            'chain.requirements = "vehicle"'
        )
    if study.gearbox.swing_deg is None:
        return "stated requirements need gearbox.swing_deg, since no vehicle is run; add it under [gearbox]"
    return None


def _vehicle_problem(study: Study) -> str | None:
    vehicles = [name for name in ("motorcycle", "quarter_car") if getattr(study, name) is not None]
    if len(vehicles) != 1:
        found = " and ".join(f"[{name}]" for name in vehicles) or "neither"
        return f'chain.requirements = "vehicle" needs one of [motorcycle] and [quarter_car], found {found}; keep one'
    for name in ("dampers", "ride"):
        if getattr(study, name) is None:
            return f'chain.requirements = "vehicle" needs the section [{name}]; take it over from {TEMPLATE}'
    if study.quarter_car is not None and study.acceleration is not None:
        return "a [quarter_car] does not pitch, so that [acceleration] would not load it; remove that section"
    return _damper_problem(study)


def _damper_problem(study: Study) -> str | None:
    needed = ("maximum", "minimum") if study.motorcycle is None else ("front", "maximum", "minimum")
    for name in needed:
        stated = [key for key in (name, f"{name}_kNs_per_m") if getattr(study.dampers, key) is not None]
        if len(stated) != 1:
            found = "both" if stated else "neither"
            return f"[dampers] needs one of {name} (a table) and {name}_kNs_per_m (linear), found {found}; state one"
    return None


def _linkage_problem(study: Study) -> str | None:
    if study.linkage_search is None:
        return f'chain.linkage = "optimised" needs the section [linkage_search]; take it over from {TEMPLATE}'
    missing = [f"{name}_mm" for name in _HARDPOINTS if getattr(study.linkage, f"{name}_mm") is None]
    if missing:
        return f'chain.linkage = "optimised" needs linkage.{missing[0]}; add it, or state the ratios and write "stated"'
    return None


def check_libraries(study: Study) -> None:
    """Build the vehicle, its dampers and scenarios, the linkage problem and the gear rules, as far as they are used.

    StudyError with the sentence of the package that refuses them.
    """
    if drives(study):
        _build_vehicle(study)
    if searches_linkage(study):
        _build_linkage(study)


def _build_vehicle(study: Study) -> None:
    try:
        ride_case(study)
    except VehicleError as error:
        raise StudyError(f"{study.path}: {str(error).rstrip('.')}.") from error


def _build_linkage(study: Study) -> None:
    try:
        linkage_search(study)
    except LinkageError as error:
        raise StudyError(f"{study.path}: {str(error).rstrip('.')}.") from error
