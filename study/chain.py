"""Which sections the design chain of a study needs."""

from __future__ import annotations

from study.errors import StudyError
from study.schema import MatchSection, Study

TEMPLATE = "studies/template.toml"
_OF_A_WHEEL = (
    ("match", "equivalent_mass_max_kg"),
    ("assembly", "viscous_friction_Ns_per_m"),
    ("assembly", "coulomb_friction_N"),
)
_OF_GEARS = tuple(key for key in MatchSection.model_fields if key.startswith("gear_"))
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
    said = _output_problem(study) or _gearbox_problem(study)
    if said is None and judges_by_road(study) and not drives(study):
        said = 'optimise.judged_by = "road" needs a vehicle that is driven; set chain.requirements = "vehicle"'
    if study.drive is None and said is None:
        said = _vehicle_problem(study) if drives(study) else _stated_problem(study)
        said = said or (_linkage_problem(study) if searches_linkage(study) else None)
    if said is not None:
        raise StudyError(f"{origin}: {said}.")


def _output_problem(study: Study) -> str | None:
    """A wheel and a shaft state different things."""
    wheel = ("requirements", "linkage", "chain", "printed_actuator")
    if study.drive is not None:
        found = [name for name in wheel if getattr(study, name) is not None]
        return f"[drive] stands in the place of [{found[0]}]; remove one of the two" if found else None
    if study.linkage is None:
        return f"section [linkage] is missing; take it over from {TEMPLATE}, or state a load on a shaft in [drive]"
    for section, key in _OF_A_WHEEL:
        if getattr(getattr(study, section), key) is None:
            return f"{section}.{key} is missing; add it under [{section}]"
    return None


def _gearbox_problem(study: Study) -> str | None:
    stages = study.match.gearbox_stages
    if stages == 0:
        return None
    if study.gearbox is None:
        return f"match.gearbox_stages = {stages} needs the section [gearbox]; take it over from {TEMPLATE}"
    missing = [key for key in _OF_GEARS if getattr(study.match, key) is None]
    return f"match.gearbox_stages = {stages} needs match.{missing[0]}; add it under [match]" if missing else None


def _stated_problem(study: Study) -> str | None:
    if study.requirements is None:
        return (
            "section [requirements] is missing; add it, or let runs of the vehicle give them with "
            'chain.requirements = "vehicle"'
        )
    if study.gearbox is not None and study.gearbox.swing_deg is None:
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


def rates_by_density(study: Study) -> bool:
    """Whether the length for the continuous torque is that of the nominal current density, and not of temperatures."""
    return study.thermal.continuous_length == "density"


def judges_by_road(study: Study) -> bool:
    """Whether the search over all stages is for comfort, road holding and recovered power."""
    return study.optimise.judged_by == "road"
