"""A study in a few lines."""

from __future__ import annotations

from study.chain import drives, searches_linkage
from study.schema import Study


def summary(study: Study) -> str:
    """The study in a few lines."""
    machine, sweep = study.machine, study.sweep
    slots, poles = (", ".join(map(str, counts)) for counts in (sweep.slots, sweep.poles or (machine.poles,)))
    diameters = sweep.stator_diameters_mm
    return "\n".join(
        (
            f"{study.path}: {study.study.title}",
            f"  machine     {machine.slots} slots, {machine.poles} poles, stator radius "
            f"{machine.stator_outer_radius_mm:g} mm, steel {study.materials.steel}",
            f"  sweep       slots {slots}; poles {poles}; {len(diameters)} diameters {min(diameters):g} to "
            f"{max(diameters):g} mm; {sweep.back_iron_steps} x {sweep.rotor_radius_steps} designs each",
            f"  saturation  {study.saturation.reading} below {study.saturation.limit_T:g} T",
            f"  required    {_required(study)}",
            f"  linkage     {_linkage(study)}",
            "  usable",
        )
    )


def _required(study: Study) -> str:
    ride, required = study.ride, study.requirements
    if drives(study) and ride is not None:
        what = "motorcycle" if study.motorcycle is not None else "quarter car"
        return (
            f"from runs of the {what}: road class {ride.road_class} at {ride.cruise_speed_km_per_h:g} km/h, "
            f"{ride.maximum_regenerative_damping_kNs_per_m:g} kNs/m"
        )
    if study.drive is not None:
        drive = study.drive
        return (
            f"{drive.torque_peak_Nm:g} Nm peak, {drive.torque_rms_Nm:g} Nm RMS, {drive.speed_peak_rpm:g} rpm at most, "
            "on a shaft"
        )
    if required is None:
        return "nothing"
    return (
        f"{required.force_peak_N:g} N peak, {required.force_rms_N:g} N RMS, "
        f"{required.maximum_damping_kNs_per_m:g} kNs/m, as stated"
    )


def _linkage(study: Study) -> str:
    if study.linkage is None:
        return "none, the load sits on the shaft"
    if study.linkage_search is not None and searches_linkage(study):
        return f"searched, choice {study.linkage_search.choice}"
    return f"{study.linkage.ratio_nominal_mm_per_rad:g} mm/rad, as stated"
