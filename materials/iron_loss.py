"""Specific iron loss of electrical sheet: Bertotti's three terms with a saturation factor on the eddy term.

    p(f, B) = k_h f B^alpha + k_c f^2 B^2 (1 + k_s B^2) + k_e (f B)^1.5          [W/kg]

Chosen over the generalised Steinmetz equation because each term has its own time form, so that a locus of B with
harmonics, rotation and minor loops needs no new coefficient, and because one power of f cannot follow 50 to 2500 Hz
(one Steinmetz term misses the same data by up to 39 %). Without the factor (1 + k_s B^2) three terms miss 2500 Hz
of the 0.5 mm sheet by 34 %; it stands for the flux that crowds at the surface of a saturating sheet.
Source of the form: G. Bertotti, "General properties of power losses in soft ferromagnetic materials", IEEE Trans. Magn.
24 (1988) 621; the factor is that of the IEM formula (D. Eggers, S. Steentjes, K. Hameyer, "Advanced iron-loss
estimation for nonlinear material behavior", IEEE Trans. Magn. 48 (2012) 3021) with its exponent held at 2, because a
free one trades against k_c and drives it to a tenth of the classical value.

The split into terms is a fit to the total, not a measurement of each. Below 0.2 T the law may be 57 % too high (there
the hysteresis falls with B^3, and the makers' tables have one digit left). Cut edges, stress and stacking are left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import gamma, inf, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from materials.errors import MaterialError
from units import Values

# <|d/dt sin(2 pi t)|^1.5> over a period: what turns the excess term of a sine wave into its time form, 8.763.
EXCESS_OF_SINE = (2 * pi) ** 1.5 * gamma(1.25) / (sqrt(pi) * gamma(1.75))
_FIT_FLOOR = 0.03  # relative scatter of the data beyond their rounding
_SCALES = (1e-2, 1e-5, 1e-4, 1.0, 1.0)  # size of the five numbers of a fit


@dataclass(frozen=True)
class IronLossLaw:
    """Loss law of one grade.

    hysteresis: k_h [W/kg s T^-alpha], exponent: alpha, dimensionless; eddy: k_c [W/kg s^2/T^2]
    saturation: k_s [1/T^2]; excess: k_e [W/kg s^1.5/T^1.5]; density: [kg/m^3]
    grade, source: where the numbers come from
    frequencies, peaks: range of the data they were fitted to [Hz], [T]
    rms_error, largest_error: relative, of the law against the data from 0.2 T up
    """

    grade: str
    hysteresis: float
    exponent: float
    eddy: float
    saturation: float
    excess: float
    density: float
    source: str
    frequencies: tuple[float, float] = (0.0, inf)
    peaks: tuple[float, float] = (0.0, inf)
    rms_error: float = 0.0
    largest_error: float = 0.0

    def __post_init__(self) -> None:
        for name in ("hysteresis", "exponent", "eddy", "saturation", "excess", "density"):
            value = getattr(self, name)
            if not (value >= 0 and np.isfinite(value)):
                raise MaterialError(f"{name} of the iron loss of {self.grade} must be a number >= 0, found {value}")
        if not (self.exponent > 0 and self.density > 0):
            raise MaterialError(f"exponent and density of the iron loss of {self.grade} must be positive")

    def times(self, factor: float) -> IronLossLaw:
        """The law with every term multiplied by a factor, dimensionless."""
        terms = {name: factor * getattr(self, name) for name in ("hysteresis", "eddy", "excess")}
        return replace(self, **terms)

    def specific_loss(self, frequency: Values, peak: Values) -> Values:
        """Loss [W/kg] for a sinusoidal flux density of this frequency [Hz] and peak [T]; arrays that broadcast."""
        hysteresis = self.hysteresis * frequency * peak**self.exponent
        eddy = self.eddy * (frequency * peak) ** 2 * (1 + self.saturation * peak**2)
        return hysteresis + eddy + self.excess * (frequency * peak) ** 1.5


def classical_eddy(thickness: float, resistivity: float, density: float) -> float:
    """k_c of a sheet without skin effect, pi^2 d^2 / (6 rho density) [W/kg s^2/T^2].

    In the time domain sigma d^2/12 <(dB/dt)^2> per volume, that is sigma d^2/24 times the squared peak of dB/dt for a
    sine. thickness: d [m]; resistivity: rho [Ohm m]; density [kg/m^3]. Valid while d is below two skin depths.
    """
    return pi**2 * thickness**2 / (6 * resistivity * density)


def fit_iron_loss(
    frequency: ArrayLike,
    peak: ArrayLike,
    loss: ArrayLike,
    *,
    grade: str,
    density: float,
    source: str,
    resolution: Values = 0.0,
) -> IronLossLaw:
    """Fit the law to measured losses in relative error, each point weighted by its rounding.

    frequency [Hz], peak [T], loss [W/kg]: arrays (n,); density: [kg/m^3]
    resolution: last digit of the losses [W/kg], scalar or (n,)
    Raises MaterialError for fewer points than coefficients or values that are not positive.
    """
    f, b, p = (np.asarray(x, dtype=float) for x in (frequency, peak, loss))
    if len(p) < len(_SCALES) + 1 or min(f.min(), b.min(), p.min()) <= 0:
        raise MaterialError(f"a loss fit needs {len(_SCALES) + 1} points or more, all positive; found {len(p)}")
    weight = _FIT_FLOOR / np.hypot(_FIT_FLOOR, resolution / 2 / p)

    def law(x: np.ndarray, **facts: Any) -> IronLossLaw:
        k_h, k_c, k_e, alpha, k_s = x * _SCALES
        return IronLossLaw(grade, k_h, alpha, k_c, k_s, k_e, density, source, **facts)

    def misfit(x: np.ndarray) -> np.ndarray:
        return weight * (law(x).specific_loss(f, b) / p - 1)

    x = least_squares(misfit, (1.5, 4.0, 5.0, 1.8, 0.3), bounds=(0, (100, 100, 1000, 3, 20)), xtol=1e-12, ftol=1e-12).x
    errors = (law(x).specific_loss(f, b) / p - 1)[b > 0.2 - 1e-9]
    facts = {"rms_error": float(np.sqrt(np.mean(errors**2))), "largest_error": float(np.abs(errors).max())}
    return law(x, frequencies=(float(f.min()), float(f.max())), peaks=(float(b.min()), float(b.max())), **facts)


_STEM = (
    "typical losses of thyssenkrupp's powercore as given by github.com/StefanMathis/stem_test_database (MIT), fitted "
    "here in relative error"
)
_TABLES = "the maker's loss table as given by pyleecan's material files (Apache-2.0), fitted here in relative error"


def loop_loss(
    grade: str,
    energy: float,
    peak: float,
    *,
    thickness: float,
    conductivity: float,
    density: float,
    source: str,
) -> IronLossLaw:
    """The law of a sheet whose static loop and whose conductivity have been measured, but not its loss over frequency.

    The loop gives the hysteresis, its exponent taken as below; the eddy term is the classical one at 1 T; what would be
    left for the excess is not known and left out. For M400-50A this gives 1.05 to 1.21 of what its table gives from 50
    to 1000 Hz at 1.0 and 1.5 T.

    energy: of the loop [J/m^3] with its tips at plus and minus a peak [T]; thickness: of the sheet [m]; conductivity
    [S/m]; density [kg/m^3]
    """
    hysteresis = energy / (density * peak**_EXPONENT)
    eddy = _eddy(thickness, 1 / conductivity, density)
    return _without_excess(grade, hysteresis, eddy, density, source, (0.0, 0.0), (peak, peak))


def guaranteed_loss(
    grade: str,
    loss: float,
    *,
    thickness: float,
    resistivity: float,
    density: float,
    source: str,
    frequency: float = 50.0,
) -> IronLossLaw:
    """The law of a sheet of which no more is known than the loss that its standard guarantees at 1.5 T.

    At 1 T the eddy term is the classical one; exponent and saturation are the means of the first three fitted laws
    below; the rest of the guaranteed loss is hysteresis, and the excess is in the two. An estimate: for these three
    grades it gives 0.92 to 1.22 of their loss from 50 to 1000 Hz at 1.0 and 1.5 T, more at 50 Hz, where the
    guarantee is a maximum; of M800-50A, a third below its guarantee, 1.13 to 1.63.

    loss: at 1.5 T [W/kg] and a frequency [Hz]; thickness: of the sheet [m]; resistivity [Ohm m]; density [kg/m^3]
    """
    eddy = _eddy(thickness, resistivity, density)
    at_peak = eddy * (frequency * GUARANTEED_PEAK) ** 2 * (1 + _SATURATION * GUARANTEED_PEAK**2)
    hysteresis = (loss - at_peak) / (frequency * GUARANTEED_PEAK**_EXPONENT)
    at = (frequency, frequency), (GUARANTEED_PEAK, GUARANTEED_PEAK)
    return _without_excess(grade, hysteresis, eddy, density, source, *at)


def _eddy(thickness: float, resistivity: float, density: float) -> float:
    """k_c that is the classical one at 1 T."""
    return classical_eddy(thickness, resistivity, density) / (1 + _SATURATION)


def _without_excess(
    grade: str,
    hysteresis: float,
    eddy: float,
    density: float,
    source: str,
    frequencies: tuple[float, float],
    peaks: tuple[float, float],
) -> IronLossLaw:
    """Of two terms, with the usual exponent and saturation."""
    return IronLossLaw(
        grade, hysteresis, _EXPONENT, eddy, _SATURATION, 0.0, density, source, frequencies=frequencies, peaks=peaks
    )


GUARANTEED_PEAK = 1.5  # T; of the loss in the name of a grade, which is at 50 Hz (EN 10106)
_EXPONENT, _SATURATION = 1.78, 0.5  # dimensionless, 1/T^2; means of the first three fitted laws below
_STANDARD = (
    "the loss that EN 10106 guarantees at 1.5 T and 50 Hz, split by the classical eddy term; an estimate, no table"
)
_LOOPS = (
    "static loop and conductivity as measured in an Epstein frame and given by the Modelica Standard Library (BSD-3), "
    "Magnetic.FluxTubes.Material.HysteresisTableData; classical eddy term, no table over frequency"
)

# Five numbers a grade, from ``fit_iron_loss``; errors are those against the table from 0.2 T up.
FITTED = {
    law.grade: law
    for law in (
        IronLossLaw(
            grade="M235-35A",  # 0.35 mm
            hysteresis=1.43525e-2,
            exponent=1.80476,
            eddy=2.66763e-5,
            saturation=0.543284,
            excess=5.14461e-4,
            density=7650.0,
            source=_TABLES,
            frequencies=(50.0, 2500.0),
            peaks=(0.1, 1.8),
            rms_error=0.0489,
            largest_error=0.0909,
        ),
        IronLossLaw(
            grade="M19",  # 29 gauge, 0.36 mm
            hysteresis=1.98862e-2,
            exponent=1.76216,
            eddy=3.70012e-5,
            saturation=0.128146,
            excess=5.04064e-4,
            density=7650.0,  # not in the data; that of the other two grades
            source=_TABLES,
            frequencies=(50.0, 1000.0),
            peaks=(0.1, 1.8),
            rms_error=0.0438,
            largest_error=0.1437,
        ),
        IronLossLaw(
            grade="M400-50A",  # 0.50 mm
            hysteresis=1.71590e-2,
            exponent=1.76031,
            eddy=5.78366e-5,
            saturation=0.859949,
            excess=1.345137e-3,
            density=7650.0,
            source=_TABLES,
            frequencies=(50.0, 2500.0),
            peaks=(0.1, 1.8),
            rms_error=0.0502,
            largest_error=0.1052,
        ),
        IronLossLaw(
            grade="M800-50A",  # 0.50 mm; another maker's is at 6.60 W/kg in the place of 5.52, at 1.5 T and 50 Hz
            hysteresis=4.06099e-2,
            exponent=1.52952,
            eddy=1.05711e-4,
            saturation=0.445780,
            excess=6.51321e-4,
            density=7800.0,
            source=_STEM,
            frequencies=(50.0, 200.0),
            peaks=(0.5, 1.9),
            rms_error=0.0145,
            largest_error=0.0483,
        ),
        IronLossLaw(
            grade="M530-65A",  # 0.65 mm; at 50 Hz alone: eddy term classical at 1 T with 0.40 uOhm m, an estimate
            hysteresis=2.56570e-2,
            exponent=1.57495,
            eddy=1.50432e-4,
            saturation=0.5,
            excess=0.0,
            density=7700.0,
            source=_TABLES,
            frequencies=(50.0, 50.0),
            peaks=(0.1, 1.8),
            rms_error=0.0294,
            largest_error=0.0637,
        ),
        IronLossLaw(
            grade="NO20-150Y320",  # 0.20 mm
            hysteresis=1.36800e-2,
            exponent=2.29353,
            eddy=7.16755e-6,
            saturation=0.599434,
            excess=7.05170e-4,
            density=7600.0,
            source=_STEM,
            frequencies=(50.0, 2000.0),
            peaks=(0.2, 1.8),
            rms_error=0.0489,
            largest_error=0.1375,
        ),
    )
}


# Area of the loop [J/m^3] and its peak [T] at 1500 A/m, thickness [m], conductivity [S/m], maker's density [kg/m^3].
LOOPED = {
    grade: loop_loss(grade, *loop, thickness=thickness, conductivity=conductivity, density=density, source=_LOOPS)
    for grade, loop, thickness, conductivity, density in (
        ("M270-50A", (226.6, 1.481), 0.50e-3, 1.72e6, 7600.0),
        ("M330-50A", (352.4, 1.560), 0.50e-3, 2.20e6, 7650.0),
    )
}

# (grade, density [kg/m^3] of the maker as in its curve's source, resistivity [Ohm m]); 0.50 mm. The resistivities are
# typical of the silicon that goes with the density, estimates to 10 %; the classical eddy term goes with them.
_HALF_MILLIMETRE = (
    ("M310-50A", 7650.0, 0.52e-6),
    ("M350-50A", 7650.0, 0.44e-6),
    ("M470-50A", 7700.0, 0.39e-6),
    ("M530-50A", 7700.0, 0.36e-6),
    ("M700-50A", 7800.0, 0.25e-6),
)
GUARANTEED = {
    grade: guaranteed_loss(
        grade, float(grade[1:4]) / 100, thickness=0.5e-3, resistivity=resistivity, density=density, source=_STANDARD
    )
    for grade, density, resistivity in _HALF_MILLIMETRE
}
MEASURED = FITTED | LOOPED
LAWS = MEASURED | GUARANTEED


def iron_loss_law(loss_grade: str | None) -> IronLossLaw:
    """The law of a grade. A sheet without loss data of its own needs another grade named as its stand-in.

    loss_grade: a name in ``LAWS``. For 35PN270 and M270-35A no loss data are at hand; the grade of their thickness is
        M235-35A, whose loss is lower (guaranteed 2.35 against 2.70 W/kg at 1.5 T, 50 Hz, EN 10106)
    Raises MaterialError when none is named or it is unknown: losses are not invented for a sheet that has no data.
    """
    known = ", ".join(LAWS)
    if not loss_grade:
        raise MaterialError(f"iron loss needs a loss_grade, whose data stand for the sheet's own: name one of {known}")
    if loss_grade not in LAWS:
        raise MaterialError(
            f"there are no loss data for '{loss_grade}': name one of {known} as its stand-in, or fit its own data with "
            "fit_iron_loss"
        )
    return LAWS[loss_grade]
