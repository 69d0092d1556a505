"""Imports between the packages go one way; the picture is the one in README.md."""

import ast
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
# Each room may import those named after it; everything may import what ``BOTTOM`` names. From top to
# bottom as in README.md.
_FIELD = {"magnetostatics", "geometry", "materials"}
_DESIGN = _FIELD | {"optimisation", "electrical", "losses", "thermal", "gearbox", "mechanics", "drivetrain",
                    "uncertainty", "control", "actuator", "vehicle"}
ALLOWED = {
    "units": set(),
    "tasks": set(),
    "disk": set(),
    "processes": set(),
    "compiling": set(),
    "labelled": set(),
    "materials": set(),
    "geometry": set(),
    "magnetostatics": {"materials", "geometry"},
    "optimisation": {"magnetostatics", "geometry"},
    "electrical": _FIELD,
    "losses": {*_FIELD, "electrical"},
    "thermal": {*_FIELD, "electrical", "losses"},
    "gearbox": set(),
    "mechanics": {*_FIELD, "gearbox"},
    "drivetrain": {*_FIELD, "optimisation", "electrical", "losses", "thermal", "gearbox", "mechanics"},
    "uncertainty": {*_FIELD, "optimisation", "electrical", "losses", "thermal", "gearbox", "drivetrain"},
    "control": set(),
    "actuator": {"electrical", "control"},
    "vehicle": {"magnetostatics", "electrical", "losses", "thermal", "drivetrain", "gearbox", "control", "actuator"},
    "study": _DESIGN,
    "effects": {"materials", "geometry"},
    "workbench": {"effects", *_FIELD, "electrical", "losses", "actuator", "study", "figures"},
    "bench": {"electrical", "actuator", "vehicle", "workbench", "figures"},
    "figures": _DESIGN - {"optimisation", "materials"},
    "export": {"magnetostatics", "geometry", "electrical", "losses", "drivetrain", "actuator"},
    "report": {*_DESIGN, "figures", "export"} - {"materials"},
    "pipeline": {*_DESIGN, "study", "figures", "export", "report", "effects", "workbench", "bench"},
}
BOTTOM = {"units", "tasks", "disk", "processes", "compiling", "labelled"}


def modules():
    for name in ALLOWED:
        place = PROJECT / name
        yield from (
            (name, path) for path in ([place.with_suffix(".py")] if not place.is_dir() else place.rglob("*.py"))
        )


def imported(path):
    """Packages of the project that a file imports anywhere, also inside functions."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
    return {name.split(".")[0] for name in names} & set(ALLOWED)


def test_no_import_goes_back():
    back = [
        f"{path.relative_to(PROJECT)} imports {other}"
        for package, path in modules()
        for other in imported(path) - {package} - BOTTOM - ALLOWED[package]
    ]
    assert not back, "; ".join(back)


def test_the_allowed_imports_have_no_cycle():
    reached = {name: set(others) for name, others in ALLOWED.items()}
    for _ in ALLOWED:
        reached = {name: others | set().union(*(reached[o] for o in others)) for name, others in reached.items()}
    assert not [name for name, others in reached.items() if name in others]


def test_gmsh_meshes_and_writes_solids_and_nothing_else():
    users = [
        path.relative_to(PROJECT).as_posix()
        for _, path in modules()
        if "import gmsh" in path.read_text(encoding="utf-8")
    ]
    assert sorted(users) == ["export/step.py", "geometry/plane_mesh.py"]


# Packages that are optional, or take a second to load and are needed by one command only.
HEAVY = {"pyvista", "vtkmodules", "vtk", "pymoo", "gmsh", "dask", "distributed"}


def test_imports_stand_at_the_top():
    """Only heavy packages are imported inside functions, in the rooms of the design half and the command."""
    inside = [
        f"{path.relative_to(PROJECT)}:{node.lineno}"
        for package, path in modules()
        if package not in ("workbench", "effects")
        for function in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(function, ast.FunctionDef)
        for node in ast.walk(function)
        if isinstance(node, (ast.Import, ast.ImportFrom)) and not _roots(node) <= HEAVY
    ]
    assert not inside, "; ".join(inside)


def _roots(node):
    names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module or ""]
    return {name.split(".")[0] for name in names}
