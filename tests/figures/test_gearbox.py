"""Figures of the gearbox: end view, load spectrum, safety factors, axial section."""

from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.patches import Circle, Rectangle
from matplotlib.text import Text

from figures.gearbox import axial_section, gear_end_view, load_spectrum, safety_factors


def words(figure):
    return "\n".join(text.get_text() for text in figure.findobj(Text))


def circle(radius, centre=0j):
    return centre + radius * np.exp(1j * np.linspace(0, 2 * np.pi, 90))


@pytest.fixture
def gears():
    parts = {"sun": 5.25e-3, "planet": 17.25e-3, "ring": 40.9e-3}
    named = {name: SimpleNamespace(reference_radius=r, module=0.75e-3) for name, r in parts.items()}
    return SimpleNamespace(**named, teeth=(14, 46, -109))


@pytest.fixture
def outlines():
    centres = 22.9e-3 * np.exp(2j * np.pi * np.arange(3) / 3)
    planets = tuple(circle(17.3e-3, centre) for centre in centres)
    return SimpleNamespace(sun=circle(5.4e-3), planets=planets, ring=circle(40.3e-3), centres=centres)


def test_end_view_is_in_millimetres_inside_the_envelope(outlines, gears, assert_readable):
    figure = gear_end_view(outlines, gears, envelope_diameter=85e-3, title="stage 1")
    assert "sun 14, planet 46, ring 109 teeth" in words(figure) and "x / mm" in words(figure)
    radii = [patch.radius for patch in figure.axes[0].patches if isinstance(patch, Circle)]
    assert max(radii) == pytest.approx(42.5) and radii.count(pytest.approx(17.25)) == 3
    assert_readable(figure)


class Line:
    """A straight S-N line."""

    first, strength = 1e3, 2.5

    def cycles(self, stress):
        return 3e6 * np.asarray(stress) ** -8.7


def test_spectrum_stacks_its_classes_from_the_highest(assert_readable):
    spectrum = SimpleNamespace(
        torque=np.array([10.0, 20.0, 30.0]), share=np.array([0.6, 0.3, 0.1]), speed=np.array([0.1, 0.2, 0.3])
    )
    ratio, cycles = np.array([0.3, 0.6, 0.9]), np.array([1e6, 1e5, 1e4])
    figure = load_spectrum(spectrum, [("sun root", Line(), ratio, cycles)])
    bars = [patch.get_height() for patch in figure.axes[0].patches]
    assert bars == pytest.approx([60, 30, 10])
    steps = [line for line in figure.axes[1].lines if line.get_linestyle() == ":"][0]
    assert steps.get_xdata() == pytest.approx([1e4, 1.1e5, 1.11e6])
    assert steps.get_ydata() == pytest.approx([0.9, 0.6, 0.3])
    assert "torque at the slow shaft / Nm" in words(figure) and "stress over endurance limit" in words(figure)
    assert_readable(figure)


def test_bars_carry_their_numbers_and_fade_below_the_wanted(assert_readable):
    good = {"sun": 1.3, "planet": 1.4, "ring": 2.0}
    rating = SimpleNamespace(flank={**good, "sun": 0.87}, root=good, static_flank=good, static_root=good)
    figure = safety_factors(
        {"chosen": (rating, rating), "printed": (rating, rating)},
        {"flank": 1.0, "root": 1.1, "static_flank": 0.0, "static_root": 1.1},
    )
    assert len(figure.axes) == 4 and words(figure).count("0.87") == 4
    faded = [patch for patch in figure.axes[0].patches if patch.get_alpha() == 0.5]
    assert [patch.get_height() for patch in faded] == [0.87]
    assert "chosen, stage 1" in words(figure) and "pitting\nfatigue" in words(figure)
    assert_readable(figure)


def test_section_is_mirrored_and_dimensioned(assert_readable):
    parts = (
        SimpleNamespace(name="casing", kind="casing", start=0.0, length=0.19, inner_radius=0.0425, outer_radius=0.055),
        SimpleNamespace(name="rotor", kind="rotor", start=0.1, length=0.036, inner_radius=0.005, outer_radius=0.0157),
    )
    figure = axial_section(SimpleNamespace(parts=parts, length=0.19, diameter=0.11), title="actuator")
    boxes = [patch for patch in figure.axes[0].patches if isinstance(patch, Rectangle)]
    assert len(boxes) == 4 and {box.get_y() for box in boxes[:2]} == {42.5, -55.0}
    assert "190.0 mm" in words(figure) and "Ø 110.0 mm" in words(figure)
    assert_readable(figure)
