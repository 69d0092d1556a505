"""Imports between the packages go one way; the picture is the one in README.md."""

import ast
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
# Each package may import those named after it; everything may import units.
ALLOWED = {
    "units": set(),
    "materials": set(),
    "geometry": set(),
    "magnetostatics": {"materials", "geometry"},
    "optimisation": {"magnetostatics", "materials", "geometry"},
    "electrical": {"materials"},
    "losses": {"magnetostatics", "materials", "geometry", "electrical"},
    "drivetrain": {"electrical"},
    "gearbox": set(),
    "vehicle": {"drivetrain"},
    "effects": {"materials", "geometry"},
    "workbench": {"effects", "magnetostatics", "geometry", "materials", "electrical", "figures"},
    "study": {"geometry", "materials", "electrical", "drivetrain", "gearbox", "vehicle"},
    "figures": {"geometry", "magnetostatics", "drivetrain", "vehicle"},
    "pipeline": {
        "study",
        "figures",
        "optimisation",
        "magnetostatics",
        "geometry",
        "materials",
        "electrical",
        "drivetrain",
        "losses",
        "gearbox",
        "vehicle",
        "effects",
        "workbench",
    },
}


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
        for other in imported(path) - {package, "units"} - ALLOWED[package]
    ]
    assert not back, "; ".join(back)


def test_the_allowed_imports_have_no_cycle():
    reached = {name: set(others) for name, others in ALLOWED.items()}
    for _ in ALLOWED:
        reached = {name: others | set().union(*(reached[o] for o in others)) for name, others in reached.items()}
    assert not [name for name, others in reached.items() if name in others]


def test_only_one_module_draws_with_gmsh():
    users = [
        path.relative_to(PROJECT).as_posix()
        for _, path in modules()
        if "import gmsh" in path.read_text(encoding="utf-8")
    ]
    assert users == ["geometry/plane_mesh.py"]
