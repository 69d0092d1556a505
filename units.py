"""SI is used inside the project; these factors are the only way drawing units get in and out.

``2.5 * MILLIMETRE`` is a length in metres; ``length / MILLIMETRE`` is the number a drawing shows.
"""

from math import pi

MILLIMETRE = 1e-3  # m
SQUARE_MILLIMETRE = 1e-6  # m^2
DEGREE = pi / 180.0  # rad
RPM = 2.0 * pi / 60.0  # rad/s
AMPERE_PER_SQUARE_MILLIMETRE = 1e6  # A/m^2
MILLIOHM = 1e-3  # ohm
MICROHENRY = 1e-6  # H

MU_0 = 4e-7 * pi  # H/m, vacuum permeability (the 2019 SI value differs by 1e-10)
GRAVITY = 9.80665  # m/s^2, standard acceleration of free fall
