"""Resistance of one phase: length of the wire over its copper section."""

from __future__ import annotations

from electrical.dq import Values
from materials.conductor import COPPER

COPPER_RESISTIVITY_20 = COPPER.reference_resistivity  # ohm m at 20 degC, thesis below eq. 3.82
COPPER_VALID_CELSIUS = (-100.0, 250.0)  # the linear law is used inside this range only


def copper_resistivity(temperature_celsius: float = 20.0) -> float:
    """Resistivity of copper, rho_20 (1 + alpha (T - 20 degC)) [ohm m].

    temperature_celsius: copper temperature [degC], -100 to 250
    Raises ValueError outside the range in which the linear law holds.
    Source: rho_20 thesis below eq. 3.82; alpha IEC 60028.
    """
    low, high = COPPER_VALID_CELSIUS
    if not low <= temperature_celsius <= high:
        raise ValueError(
            f"copper temperature must lie between {low:g} and {high:g} degC for the linear law; "
            f"found {temperature_celsius:g} degC"
        )
    return float(COPPER.resistivity(temperature_celsius))


def phase_resistance(
    *,
    turns: Values,
    strands: Values,
    wire_area: Values,
    active_length: Values,
    end_turn_length: float,
    coils_in_series: int,
    resistivity: Values,
) -> Values:
    """Resistance of one phase with its coils in series [ohm].

    R_ph = 2 (l_em + l_et) rho N_c N_t / (N_h A_w)      (3.82, first form)

    turns: turns of one coil N_t, or of the equivalent star; number or array
    strands: wires in hand N_h, int or array of the same shape
    wire_area: copper section of one wire A_w [m^2]
    active_length, end_turn_length: l_em, l_et [m]; a turn runs through both twice
    coils_in_series: N_c = N_s / N_ph
    resistivity: [ohm m], see ``copper_resistivity``
    Direct current: neither skin nor proximity effect. Source: thesis eq. 3.82.
    """
    turn_length = 2 * (active_length + end_turn_length)
    return turn_length * resistivity * coils_in_series * turns / (strands * wire_area)


def phase_resistance_of_filled_slot(
    *,
    turns: Values,
    packing: float,
    half_slot_area: float,
    active_length: Values,
    end_turn_length: float,
    coils_in_series: int,
    resistivity: float,
) -> Values:
    """Resistance of one phase whose coils fill the slot to the packing factor exactly [ohm].

    R_ph = 2 (l_em + l_et) rho N_c N_t^2 / (k_cp A_s)   (3.82, second form)

    Equation 3.82 prints 2 rho here; the leading 2 already counts both sides of the turn, and only the single rho
    equals the first form and gives the 6 of eq. 3.83.
    packing: k_cp, copper over half-slot area; half_slot_area: A_s [m^2]; the others as in ``phase_resistance``.
    """
    return phase_resistance(
        turns=turns,
        strands=1,
        wire_area=packing * half_slot_area / turns,
        active_length=active_length,
        end_turn_length=end_turn_length,
        coils_in_series=coils_in_series,
        resistivity=resistivity,
    )
