"""What can be found out about a study before anything is computed: each finding is one sentence.

``study.read`` has checked every number by itself and the machine that the study states; here stands what needs the
libraries, and what only the sweep and the stages after it need.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import product

from drivetrain.four_bar import LinkageError
from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.family import Combination
from geometry.half_cell import MeshDensity
from geometry.machine import Machine
from geometry.mesh_size import check_mesh_size
from geometry.winding import star_of_slots
from materials.errors import MaterialError
from materials.library import load_steel
from study.chain import drives, searches_linkage
from study.errors import StudyError
from study.inputs_electrical import winding_limits, wires
from study.inputs_linkage import linkage_search, stated_hardpoints
from study.inputs_machine import combinations, machine_family, mesh_density
from study.inputs_variables import freedom
from study.inputs_vehicle import ride_case
from study.magnet_choice import design_magnet
from study.read import check_winding, sentence_part, with_keys
from study.schema import Study
from units import MILLIMETRE, SQUARE_MILLIMETRE
from vehicle.errors import VehicleError

FEWEST_DIAMETERS = 4  # a quadratic through three points has no residual, so that nobody would see a wrong one


def check_study(study: Study) -> None:
    """Raise StudyError with one sentence for the first thing that would stop a run of the whole study."""
    for check in (
        check_diameters,
        check_windings,
        check_paths,
        check_wires,
        check_steel,
        check_magnets,
        check_variables,
        check_sweep,
        check_libraries,
    ):
        check(study)


def check_diameters(study: Study) -> None:
    """The torque of a slot count is fitted over the diameters."""
    diameters = study.sweep.stator_diameters_mm
    if len(diameters) < FEWEST_DIAMETERS:
        raise StudyError(
            f"{study.path}: sweep.stator_diameters_mm names {len(diameters)}, but the polynomials over the diameter "
            f"need {FEWEST_DIAMETERS}; add {FEWEST_DIAMETERS - len(diameters)} or more."
        )


def check_windings(study: Study) -> None:
    """Every slot count of the sweep must have a balanced winding with every pole count."""
    poles = "machine.poles" if study.sweep.poles is None else "sweep.poles"
    for one in combinations(study):
        check_winding(study, one, ("sweep.slots", poles), str(study.path))


def check_steel(study: Study) -> None:
    """The steel must exist and its curve be usable."""
    key = f'{study.path}: materials.steel = "{study.materials.steel}"'
    try:
        load_steel(study.materials.steel, study.path.parent)
    except MaterialError as error:
        raise StudyError(f"{key} cannot be used, {sentence_part(error)}.") from error
    except (OSError, UnicodeDecodeError) as error:
        raise StudyError(f"{key} cannot be read ({error}); give a readable csv file or a known grade.") from error


def check_magnets(study: Study) -> None:
    """The grade of the magnets must exist, and what the study states beside it must be its own."""
    design_magnet(study)


def check_variables(study: Study) -> None:
    """What the optima may choose must leave machines that can be built."""
    freedom(study)


def check_sweep(study: Study) -> None:
    """Every combination and diameter must have a design that can be built and meshed; one of all must take the wire."""
    largest = 0.0
    for one, diameter in product(combinations(study), study.sweep.stator_diameters_mm):
        machines, what = _buildable(study, one, diameter), f"a design of the sweep ({one.words}, {diameter:g} mm)"
        for machine in machines:
            check_mesh(study, machine, mesh_density(study.mesh), what)
        largest = max(largest, *(machine.half_slot_area for machine in machines))
    _check_wire(study, largest)


def check_mesh(study: Study, machine: Machine, density: MeshDensity, what: str = "[machine]") -> None:
    """The machine must not need a mesh that nobody can solve."""
    try:
        check_mesh_size(machine, density, machine.sectors)
    except GeometryError as error:
        raise StudyError(f"{study.path}: {what} cannot be meshed, {with_keys(study, error)}.") from error


def _buildable(study: Study, combination: Combination, diameter: float) -> list[Machine]:
    """The machines of the sweep with these slots, poles and stator diameter [mm]; StudyError when there is none."""
    found, refused = [], Counter[str]()
    for machine in _designs(study, combination, diameter * MILLIMETRE / 2):
        try:
            check_machine(machine)
            found.append(machine)
        except GeometryError as error:
            refused[_rule(error)] += 1
    if not found:
        raise StudyError(
            f"{study.path}: no design of the sweep with sweep.slots = {combination.slots} and "
            f"sweep.stator_diameters_mm = {diameter:g} can be built, mostly since {refused.most_common(1)[0][0]}; "
            "change the ranges sweep.back_iron_fraction_* and sweep.rotor_radius_fraction_*, or leave that number out."
        )
    return found


def _rule(error: GeometryError) -> str:
    """The rule that a machine breaks, without its own numbers and advice."""
    return str(error).partition(":")[0]


def _designs(study: Study, combination: Combination, radius: float) -> Iterator[Machine]:
    """Every machine of the sweep with these slots, poles and stator radius [m]."""
    s, family = study.sweep, machine_family(study.machine)
    widths = _steps(s.back_iron_fraction_min, s.back_iron_fraction_max, s.back_iron_steps)
    radii = _steps(s.rotor_radius_fraction_min, s.rotor_radius_fraction_max, s.rotor_radius_steps)
    for width, rotor in product(widths, radii):
        lengths = {"back_iron_width": width * radius, "rotor_outer_radius": rotor * radius}
        yield family.machine(combination, stator_outer_radius=radius, **lengths)


def _steps(low: float, high: float, count: int) -> list[float]:
    return [low + (high - low) * k / (count - 1) for k in range(count)]


def check_wires(study: Study) -> None:
    """Every wire must be one that is sold."""
    try:
        wires(study)
    except MaterialError as error:
        raise StudyError(f"{study.path}: winding_selection.wire_diameters_mm, {sentence_part(error)}.") from error


def check_paths(study: Study) -> None:
    """Every number of parallel paths must be possible with one of the slot counts."""
    layouts = [star_of_slots(slots, study.machine.poles // 2, study.winding.layers, study.winding.coil_pitch)
               for slots in study.sweep.slots]  # fmt: skip
    possible = sorted({number for layout in layouts for number in layout.path_numbers})
    for number in study.winding_selection.parallel_paths or ():
        if number not in possible:
            raise StudyError(
                f"{study.path}: winding_selection.parallel_paths = {number} are not equal by the star of slots, with "
                f"sweep.slots = {list(study.sweep.slots)} and machine.poles = {study.machine.poles}; take some of "
                f"{possible}."
            )


def _check_wire(study: Study, area: float) -> None:
    """One turn of one wire must fit the largest half slot of the sweep [m^2] (thesis eq. 3.119)."""
    limits, thinnest = winding_limits(study), wires(study)[0]
    bare = limits.largest_packing * area / thinnest.area
    if min(bare, limits.insulated_fill * area / (thinnest.area + thinnest.enamel_area)) < 1:
        raise StudyError(
            f"{study.path}: no wire of winding_selection.wire_diameters_mm = "
            f"{list(study.winding_selection.wire_diameters_mm)} fits a slot of the sweep, a coil side has "
            f"{area / SQUARE_MILLIMETRE:.3g} mm2 at most, winding.packing_factor = {limits.packing_limit:g} of that is "
            f"copper and {limits.insulated_fill:g} with enamel; take a thinner wire."
        )


def check_libraries(study: Study) -> None:
    """Build the vehicle, its dampers and scenarios and the linkage problem, as far as they are used.

    StudyError with the sentence of the package that refuses them.
    """
    try:
        _build(study)
    except (VehicleError, LinkageError) as error:
        raise StudyError(f"{study.path}: {sentence_part(error)}.") from error


def _build(study: Study) -> None:
    if drives(study):
        ride_case(study)
    if searches_linkage(study):
        linkage_search(study)
    if study.linkage is not None:
        stated_hardpoints(study.linkage)
