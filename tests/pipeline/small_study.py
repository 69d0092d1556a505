"""A study small enough to run as a whole in a test."""

from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
SMALL = {
    'id = "motorcycle"': 'id = "small-test-study"',
    "slots = [9, 12]": "slots = [12]",
    "[70, 75, 80, 85, 90, 95, 100, 105, 110, 115]": "[75, 80, 85, 90]",
    "back_iron_steps = 7": "back_iron_steps = 4",
    "rotor_radius_steps = 6": "rotor_radius_steps = 4",
    "road_seeds = [0, 1, 2, 3, 4, 5]": "road_seeds = [0]",
    "road_duration_s = 30.0": "road_duration_s = 5.0",
    "amplitudes_mm = [-50, -40, -30, -20, -10, 10, 20, 30, 40, 50]": "amplitudes_mm = [-50, 50]",
    "speeds_km_per_h = [10, 20, 30, 40, 50, 60, 70, 80, 90, 100]": "speeds_km_per_h = [50]",
    "\nseeds = [1, 2, 3, 4]": "\nseeds = [1]",
    "population = 100": "population = 24",
    "generations = 150": "generations = 20",
    "[flux_map]": "[flux_map]\nangles = 2\ncurrents = 5",
    "ratio_tolerance = 0.03": "ratio_tolerance = 0.015",
    "dc_bus_voltage_V = 48.0": "dc_bus_voltage_V = 90.0",
}


def small_study(path: Path, **replaced: str) -> Path:
    """The study of the thesis with small grids and short roads, written to a path; replaced: further texts by old ones."""
    text = (PROJECT / "studies" / "motorcycle.toml").read_text(encoding="utf-8")
    for old, new in (SMALL | replaced).items():
        assert old in text, old
        text = text.replace(old, new)
    path.write_text(text, encoding="utf-8")
    return path
