"""A machine of any kind from a TOML file: what it is put together from, its winding, its materials."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, Field, dataclass, fields
from difflib import get_close_matches
from math import isfinite
from pathlib import Path
from typing import Any

from electrical.end_turn import END_TURNS, EndTurn, Lap, Wave, coil_seat, usual_end_turn
from electrical.kind_search import KindSearch
from electrical.winding_connection import CLOSINGS, WindingConnection
from geometry.checks import check_machine
from geometry.errors import GeometryError
from geometry.half_cell import MeshDensity
from geometry.kinds import ROTORS, STATORS, Kinds
from geometry.magnetisation import PATTERNS, Magnetisation
from geometry.moves import Move
from geometry.outline import Curve
from geometry.outline_file import read_outline
from geometry.parts import ComposedMachine, Part, part_units
from geometry.winding import WindingLayout, star_of_slots
from magnetostatics.flux_map_stage import ANGLES, CURRENTS
from magnetostatics.model import MachineMaterials
from materials.errors import MaterialError
from materials.library import load_steel
from materials.magnet import Magnet
from materials.reluctivity import SplineReluctivity
from study.errors import StudyError
from study.machine_winding import (
    POINTS,
    SELECTION,
    MachineWindingSelection,
    OperatingPointSection,
    read_points,
    read_selection,
)
from study.toml_file import read_table
from units import to_si

VARIABLES = "variables"
_OUTLINES = ("outline", "magnets")  # dimensions of a part that are curves of a DXF file
MACHINES = Path(__file__).resolve().parent.parent / "machines"
# Sections and keys beside those of the two parts; those with a value may be left out.
_OTHERS: dict[str, dict[str, Any]] = {
    "machine": {"title": "", "active_length_mm": None},
    "winding": {"layers": 2, "coil_pitch": None, "turns_per_coil": None, "parallel_paths": 1, "connection": "star",
                "end_turn": None, "overlength": None, "wires_in_hand": 1, "wire_diameter_mm": None},
    "drive": {"dc_bus_voltage_V": None, "line_current_peak_A": None, "speed_max_rpm": None,
              "winding_temperature_degC": 20.0},
    "flux_map": {"angles": ANGLES, "currents": CURRENTS},
    "search": {"flux_density_max_T": None, "samples": 64},
    "materials": {"stator_steel": None, "rotor_steel": None, "remanence_T": None, "recoil_permeability": 1.05,
                  "loss_grade": None},
    "mesh": {"gap_edges_per_revolution": 720, "gap_layers": 2, "elements_across_iron": 2.0},
}


@dataclass(frozen=True, eq=False)
class MachineFile:
    """A machine as it is drawn and wound, and what stands beside it in the file.

    active_length: [m]
    end_turn: how the coils go round the ends
    conductors, supply: what is stated of the wires and of the drive, by key with unit; None where a key is left out
    map_points: angles over 60 electrical degrees and currents along an axis of the flux map
    steel: grade of the stator; loss_grade: whose loss data stand for it, None without
    search: what may vary of the machine, None where nothing may
    selection: what its winding is chosen from, None where it is stated; points: that it is chosen for
    """

    path: Path
    title: str
    machine: ComposedMachine
    layout: WindingLayout
    connection: WindingConnection
    end_turn: EndTurn
    active_length: float
    materials: MachineMaterials
    density: MeshDensity
    conductors: Mapping[str, Any]
    supply: Mapping[str, Any]
    map_points: tuple[int, int]
    steel: str
    loss_grade: str | None
    search: KindSearch | None
    selection: MachineWindingSelection | None
    points: tuple[OperatingPointSection, ...]

    @property
    def turns(self) -> float:
        """Of every coil, dimensionless. Raises StudyError where they are left out, as they may be where they are to be
        chosen."""
        return self.number("winding", "turns_per_coil")

    @property
    def equivalent_turns(self) -> float:
        """Of a coil of the equivalent star, all coils of a phase in series."""
        return float(self.connection.equivalent_turns(self.turns))

    @property
    def end_turn_length(self) -> float:
        """Of one end turn [m]."""
        return self.end_turn.length(coil_seat(self.machine, self.layout.coil_pitch, self.layout.layers))

    def number(self, section: str, key: str) -> float:
        """What [winding] or [drive] states, in SI. Raises StudyError where it is left out or no number."""
        stated = self.supply if section == "drive" else self.conductors
        found = _number(_Table(self.path, {}), section, key, stated[key])
        return to_si(key, found)[1]


def names_machine(path_or_name: str | Path) -> bool:
    """Whether a path or a name means a machine's file and not a study: both its parts are stated by their kinds."""
    path = _path_of(path_or_name)
    if not path.is_file():
        return False
    sections = read_table(path)
    return all(isinstance(sections.get(part), dict) and "kind" in sections[part] for part in ("stator", "rotor"))


def _path_of(path_or_name: str | Path) -> Path:
    path = Path(path_or_name)
    return path if path.suffix else MACHINES / f"{path_or_name}.toml"


def read_machine(path_or_name: str | Path) -> MachineFile:
    """The machine of a file, or of a file in ``machines/`` named without its ending.

    Raises StudyError with one sentence about the first thing that is wrong.
    """
    path = _path_of(path_or_name)
    if not path.exists():
        known = ", ".join(sorted(file.stem for file in MACHINES.glob("*.toml")))
        raise StudyError(f"{path} does not exist; give the path of a machine file or one of the names {known}.")
    try:
        return _machine(_Table(path, read_table(path)))
    except (GeometryError, MaterialError) as error:
        raise StudyError(f"{path}: {error}.") from error


@dataclass(frozen=True)
class _Table:
    path: Path
    sections: Mapping[str, Any]

    def section(self, name: str) -> dict[str, Any]:
        found = self.sections.get(name, {})
        if not isinstance(found, dict):
            raise StudyError(f"{self.path}: {name} stands where the section [{name}] is expected; make it a table.")
        return dict(found)

    def wrong(self, section: str, what: str) -> StudyError:
        return StudyError(f"{self.path}: [{section}] {what}.")


def _machine(table: _Table) -> MachineFile:
    known = (*_OTHERS, VARIABLES, SELECTION, POINTS, "stator", "rotor")
    _check_names(table, "the file", "section", table.sections, known)
    values = {name: _values(table, name) for name in _OTHERS}
    machine = ComposedMachine(_part(table, "stator", STATORS), _part(table, "rotor", ROTORS))  # type: ignore[arg-type]
    check_machine(machine)
    winding, mesh = values["winding"], values["mesh"]
    layout = star_of_slots(machine.slots, machine.pole_pairs, winding["layers"], winding["coil_pitch"])
    selection = read_selection(table.path, table.sections)
    if selection is None:
        _number(table, "winding", "turns_per_coil", winding["turns_per_coil"])
    steel = _stator_steel(table, values["materials"]["stator_steel"])
    return MachineFile(
        table.path,
        values["machine"]["title"],
        machine,
        layout,
        _connection(table, winding),
        _end_turn(table, winding, machine, layout),
        1e-3 * _number(table, "machine", "active_length_mm", values["machine"]["active_length_mm"]),
        _materials(table, values["materials"], steel, machine.rotor.magnets_per_pitch),
        MeshDensity(
            mesh["gap_edges_per_revolution"], gap_layers=mesh["gap_layers"], across_iron=mesh["elements_across_iron"]
        ),
        winding,
        values["drive"],
        (_count(table, "flux_map", values, "angles", 1), _count(table, "flux_map", values, "currents", 4)),
        steel.name,
        values["materials"]["loss_grade"],
        _search(table, machine, values) if VARIABLES in table.sections else None,
        selection,
        () if selection is None else read_points(table.path, table.sections),
    )


def _connection(table: _Table, stated: Mapping[str, Any]) -> WindingConnection:
    if stated["connection"] not in CLOSINGS:
        raise table.wrong("winding", f"connection = {stated['connection']!r} is unknown; take {' or '.join(CLOSINGS)}")
    return WindingConnection(
        _count(table, "winding", {"winding": stated}, "parallel_paths", 1), CLOSINGS[stated["connection"]]
    )


def _end_turn(table: _Table, stated: Mapping[str, Any], machine: ComposedMachine, layout: WindingLayout) -> EndTurn:
    """Of the name that is stated, or as is usual for the coil pitch."""
    name, overlength = stated["end_turn"], stated["overlength"]
    if name is not None and name not in END_TURNS:
        raise table.wrong("winding", f"end_turn = {name!r} is unknown; take {' or '.join(END_TURNS)}")
    kind = type(usual_end_turn(layout.coil_pitch)) if name is None else END_TURNS[name]
    if overlength is not None and not issubclass(kind, Lap):
        raise table.wrong("winding", f"overlength belongs to {Lap.name} and {Wave.name}, not to {kind.name}: remove it")
    found = kind() if overlength is None else kind(_number(table, "winding", "overlength", overlength))  # type: ignore
    try:
        found.length(coil_seat(machine, layout.coil_pitch, layout.layers))
    except ValueError as error:
        raise table.wrong("winding", f"end_turn: {error}") from error
    return found


def _count(table: _Table, section: str, values: Mapping[str, Any], key: str, least: int) -> int:
    number = _number(table, section, key, values[section][key])
    if number < least or number != int(number):
        raise table.wrong(section, f"{key} = {number:g} is not a whole number of {least} or more")
    return int(number)


def _values(table: _Table, name: str) -> dict[str, Any]:
    """Of one of the other sections, with its defaults."""
    stated = table.section(name)
    _check_names(table, f"[{name}]", "key", stated, _OTHERS[name])
    return _OTHERS[name] | stated


def _check_names(table: _Table, where: str, what: str, found: Mapping[str, Any], known: Any) -> None:
    for name in found:
        if name not in known:
            near = get_close_matches(name, known, n=1)
            advice = f"did you mean {near[0]}" if near else f"known are {', '.join(known)}"
            raise StudyError(f"{table.path}: {where} has no {what} {name}; {advice}.")


def _number(table: _Table, section: str, key: str, value: Any) -> float:
    if value is None:
        raise table.wrong(section, f"lacks {key}; add it")
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise table.wrong(section, f"{key} = {value!r} is not a number")
    return float(value)


def _stator_steel(table: _Table, name: Any) -> SplineReluctivity:
    if not isinstance(name, str):
        raise table.wrong("materials", "lacks stator_steel; add the name of a steel or the path of its curve")
    return load_steel(name, table.path.parent)


def _materials(
    table: _Table, stated: Mapping[str, Any], steel: SplineReluctivity, magnets_per_pitch: int
) -> MachineMaterials:
    other = stated["rotor_steel"]
    remanence = _number(table, "materials", "remanence_T", stated["remanence_T"]) if magnets_per_pitch else 0.0
    permeability = _number(table, "materials", "recoil_permeability", stated["recoil_permeability"])
    rotor_steel = steel if other is None else load_steel(other, table.path.parent)
    return MachineMaterials(steel, rotor_steel, Magnet(remanence, permeability))


# ---- what may vary ---------------------------------------------------------------------------------------------------


def _search(table: _Table, machine: ComposedMachine, values: Mapping[str, Any]) -> KindSearch:
    found = table.sections[VARIABLES]
    if not isinstance(found, list) or not all(isinstance(one, dict) for one in found):
        raise StudyError(f"{table.path}: {VARIABLES} must be tables, each headed [[{VARIABLES}]].")
    limit = _number(table, "search", "flux_density_max_T", values["search"]["flux_density_max_T"])
    return KindSearch(
        tuple(_move(table, machine, one) for one in found), limit, _count(table, "search", values, "samples", 8)
    )


def _move(table: _Table, machine: ComposedMachine, stated: Mapping[str, Any]) -> Move:
    """One of [[variables]]: a name, the dimensions that move together, and by how much, ``by_mm`` or ``by``."""
    name, dimensions = str(stated.get("name", "")), stated.get("moves", [])
    bounds = [key for key in stated if key == "by" or key.startswith("by_")]
    if not name or not isinstance(dimensions, list) or not dimensions or len(bounds) != 1:
        raise table.wrong(VARIABLES, 'needs name = "...", moves = ["stator.tooth_width", ...] and by_mm = [-0.2, 0.2]')
    unit = bounds[0].removeprefix("by").removeprefix("_")
    moves = tuple(_dimension(table, machine, name, str(one), unit) for one in dimensions)
    low, high = _bounds(table, name, bounds[0], stated[bounds[0]])
    return Move(name, moves, unit, low, high)


def _dimension(table: _Table, machine: ComposedMachine, name: str, stated: str, unit: str) -> tuple[str, str]:
    part, _, dimension = stated.partition(".")
    parts = {"stator": machine.stator, "rotor": machine.rotor}
    units = part_units(type(parts[part])) if part in parts else {}
    if units.get(dimension) != unit:
        known = ", ".join(f"{where}.{one}" for where, own in parts.items() for one, has in part_units(type(own)).items()
                          if has == unit)  # fmt: skip
        raise table.wrong(VARIABLES, f"{name!r}: {stated} is no dimension in {unit or 'pure numbers'}; take of {known}")
    return part, dimension


def _bounds(table: _Table, name: str, key: str, stated: Any) -> tuple[float, float]:
    if not isinstance(stated, list) or len(stated) != 2:
        raise table.wrong(VARIABLES, f"{name!r}: {key} = {stated!r} is not a pair of bounds")
    low, high = (to_si(key, _number(table, VARIABLES, key, one))[1] for one in stated)
    if low >= high:
        raise table.wrong(VARIABLES, f"{name!r}: the bounds of {key} must rise, found {stated}")
    return low, high


# ---- a stator or a rotor from its section ----------------------------------------------------------------------------


def _part(table: _Table, section: str, kinds: Kinds) -> Part:
    stated = table.section(section)
    kind = stated.pop("kind", None)
    if not isinstance(kind, str):
        raise table.wrong(section, f'lacks kind; write kind = "{next(iter(sorted(kinds.known)))}" or another one')
    cls = kinds.named(kind, table.path.parent)
    keys = part_keys(cls)
    _check_names(table, f"[{section}]", "key", stated, keys.values())
    return cls(**{one.name: _field(table, section, one, keys[one.name], stated) for one in fields(cls)  # type: ignore
                  if keys[one.name] in stated or _must_be_stated(one)})  # fmt: skip


def part_keys(cls: type[Part]) -> dict[str, str]:
    """Keys of a part in a file by the names of its fields: the unit is the end of the key, none for a pure number."""
    return {name: f"{name}_{unit}" if unit else name for name, unit in part_units(cls).items()}


def _must_be_stated(one: Field[Any]) -> bool:
    return one.default is MISSING and one.default_factory is MISSING


def _field(table: _Table, section: str, one: Field[Any], key: str, stated: Mapping[str, Any]) -> Any:
    if key not in stated:
        raise table.wrong(section, f"lacks {key}; add it")
    value = stated[key]
    if one.name == "magnetisation":
        return _magnetisation(table, section, value)
    if one.name in _OUTLINES:
        return _outline(table, section, key, value)
    if "tuple" in str(one.type):
        return _numbers(table, section, key, value)
    number = _number(table, section, key, value)
    if one.type in ("int", int):  # a text where the file of the class postpones its annotations
        if number != int(number):
            raise table.wrong(section, f"{key} = {value!r} is not a whole number")
        return int(number)
    return to_si(key, number)[1]


def _numbers(table: _Table, section: str, key: str, stated: object) -> tuple[float, ...]:
    if not isinstance(stated, list):
        raise table.wrong(section, f"{key} = {stated!r} is no list; write {key} = [...] with one number for each")
    return tuple(to_si(key, tuple(_number(table, section, key, number) for number in stated))[1])


def _outline(table: _Table, section: str, key: str, stated: object) -> tuple[Curve, ...]:
    """Of a DXF file, ``"rotor.dxf"`` or one layer, ``"rotor.dxf:cut"``; its path counts from the machine's file."""
    if not isinstance(stated, str):
        raise table.wrong(section, f'{key} = {stated!r} is no file; write {key} = "rotor.dxf" or "rotor.dxf:layer"')
    name, _, layer = stated.partition(":")
    return read_outline(table.path.parent / name, layer or None)


def _magnetisation(table: _Table, section: str, name: object) -> Magnetisation:
    if name not in PATTERNS:
        raise table.wrong(section, f"magnetisation = {name!r} is unknown; take {' or '.join(PATTERNS)}")
    return PATTERNS[str(name)]
