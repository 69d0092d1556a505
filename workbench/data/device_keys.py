"""Keys of ``[device]`` by the model that reads them, and how well such devices and instruments are usually known: for
drafts and the manual. The models decide what they take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

COPPER: Final = 0.00393  # 1/K at 20 degC, annealed copper (IEC 60028)


@dataclass(frozen=True)
class DeviceKey:
    """key: as a file may spell it, any other unit of the quantity goes as well;  needed: no answer without it

    usual: value that a draft gives it, what that is of, and the condition that a table must have for it
    """

    key: str
    meaning: str
    needed: bool = True
    usual: tuple[float, str, str] | None = None


_DIMENSIONS: Final = (
    DeviceKey("stator_outer_radius_mm", "outer radius of the stator"),
    DeviceKey("rotor_outer_radius_mm", "radius over the magnets"),
    DeviceKey("back_iron_width_mm", "width of the stator's back iron"),
    DeviceKey("tooth_width_mm", "width of a tooth"),
    DeviceKey("magnet_length_mm", "radial length of a magnet"),
    DeviceKey("airgap_mm", "gap between magnets and teeth"),
    DeviceKey("slot_opening_mm", "opening of a slot"),
    DeviceKey("shoe_d1_mm", "depth of the parallel part of the slot opening"),
    DeviceKey("shoe_d2_mm", "depth of the taper of the shoe"),
    DeviceKey("shaft_radius_mm", "radius of the shaft, not magnetic"),
)
DEVICE_KEYS: Final[dict[str, tuple[DeviceKey, ...]]] = {
    "damper": (
        DeviceKey("force_constant_N_per_A", "force over current, also voltage over velocity"),
        DeviceKey("internal_resistance_ohm", "resistance of the winding between its terminals"),
        DeviceKey("moving_mass_kg", "mass that moves"),
        DeviceKey("viscous_damping_Ns_per_m", "force over velocity with open terminals"),
        DeviceKey("inductance_mH", "inductance between the terminals; default 0", False),
        DeviceKey("mount_stiffness_N_per_m", "stiffness of the mount; default: rigid", False),
        DeviceKey("mount_damping_Ns_per_m", "damping of the mount; default 0", False),
        DeviceKey("mount_clearance_mm", "free play of the mount, stop to stop; default 0", False),
        DeviceKey("test_velocity_m_per_s", "top velocity of the line that damping_shunt is the slope of", False),
    ),
    "dq": (
        DeviceKey("pole_pairs", "pole pairs"),
        DeviceKey("psi_m_Vs", "flux linkage of the magnets, peak of a phase"),
        DeviceKey("inductance_d_mH", "inductance along the magnets"),
        DeviceKey("inductance_q_mH", "inductance across the magnets"),
        DeviceKey("resistance_mohm", "resistance of one phase"),
        DeviceKey("reference_T_degC", "temperature at which flux linkage and resistance hold; default 20", False),
        DeviceKey("copper_coefficient_per_K", "relative change of the resistance with winding_T; default 0", False,
                  (COPPER, "copper", "winding_T")),
        DeviceKey("remanence_coefficient_per_K", "relative change of psi_m with magnet_T; default 0", False),
        DeviceKey("iron_conductance", "1/ohm, in parallel with the induced voltage; default 0", False),
        DeviceKey("voltage_per_dc", "largest peak phase voltage over v_dc; default 0.577, six steps 0.637", False),
    ),
    "machine": (
        DeviceKey("slots", "slots, a coil on every tooth"),
        DeviceKey("poles", "magnets"),
        *_DIMENSIONS,
        DeviceKey("remanence_T", "remanence of the magnets at remanence_reference_degC"),
        DeviceKey("active_length_mm", "length of the stack"),
        DeviceKey("turns_per_coil", "turns of a coil"),
        DeviceKey("steel", "grade of the laminations, in quotes"),
        DeviceKey("magnetisation", '"parallel", "radial" or "halbach"; default "parallel"', False),
        DeviceKey("magnet_arc_fraction", "magnet arc over pole pitch; default 1", False),
        DeviceKey("remanence_coefficient_percent_per_K", "relative change of the remanence; default -0.11", False),
        DeviceKey("remanence_reference_degC", "temperature at which the remanence holds; default 22", False),
        DeviceKey("recoil_permeability", "relative; default 1.05", False),
        DeviceKey("stacking_factor", "steel over stack length; default 1", False),
        DeviceKey("coils_in_series_per_phase", "slots / 3, for the check", False),
        DeviceKey("phase_resistance_mohm_20degC", "of one phase at 20 degC, without leads", False),
        DeviceKey("magnet_temperature_degC", "of the magnets where no magnet_T is read; default: the reference", False),
        DeviceKey("end_winding_inductance_uH", "of a phase; default 0, uncertain by what half circles have", False),
        DeviceKey("iron_loss_grade", "M235-35A, M400-50A or M19; without it no iron loss", False),
    ),
    "drawn": (
        DeviceKey("machine_file", "in quotes: a name in machines/, or the path of a file like those"),
        DeviceKey("phase_resistance_mohm", "half of that between two terminals, at 20 degC", False),
        DeviceKey("phase_resistance_a_mohm", "of A alone, where the phases are not alike, in its place", False),
        DeviceKey("phase_resistance_b_mohm", "of B", False),
        DeviceKey("phase_resistance_c_mohm", "of C", False),
        DeviceKey("remanence_T", "of the magnets where it is not that of the file", False),
        DeviceKey("remanence_coefficient_percent_per_K", "relative change of the remanence; default -0.11", False),
        DeviceKey("remanence_reference_degC", "temperature at which the remanence holds; default 20", False),
        DeviceKey("magnet_temperature_degC", "of the magnets where no magnet_T is read; default: the reference", False),
        DeviceKey("stacking_factor", "steel over stack length; default 1", False),
        DeviceKey("end_winding_inductance_uH", "of a phase; default 0", False),
        DeviceKey("largest_current_A", "peak, up to which flux is mapped; needed for currents at speed", False),
        DeviceKey("wire_diameter_mm", "bare, for a check of the resistance", False),
        DeviceKey("wires_in_hand", "parallel wires of a turn; default 1", False),
        DeviceKey("iron_loss_grade", "M235-35A, M400-50A or M19; without it no iron loss", False),
        DeviceKey("slots", "those of the file once more, where angles are to be checked", False),
        DeviceKey("poles", "the same", False),
    ),
}


@dataclass(frozen=True)
class Spread:
    """key: of ``[tolerance]`` or ``[systematic]``;  size: as a file spells it;  source: where the figure comes from"""

    key: str
    size: str
    source: str


# Of a device that nobody has described better. Without any, what a device is off by would be taken for an effect.
TOLERANCES: Final[dict[str, tuple[Spread, ...]]] = {
    "damper": (
        Spread("force_constant_N_per_A", "sigma_rel = 0.02", "assumed: remanence +-2 %, air gap"),
        Spread("internal_resistance_ohm", "sigma_rel = 0.02", "assumed: wire and leads"),
        Spread("moving_mass_kg", "sigma_rel = 0.02", "assumed: drawn parts"),
        Spread("viscous_damping_Ns_per_m", "sigma_rel = 0.3", "assumed: seals and grease scatter"),
    ),
    "dq": (
        Spread("psi_m_Vs", "sigma_rel = 0.02", "assumed: remanence +-2 %, air gap"),
        Spread("inductance_d_mH", "sigma_rel = 0.1", "assumed: air gap, end turns, saturation"),
        Spread("inductance_q_mH", "sigma_rel = 0.1", "assumed: air gap, end turns, saturation"),
        Spread("resistance_mohm", "sigma_rel = 0.02", "assumed: wire and end turns"),
    ),
    "machine": (
        Spread("remanence", "sigma_rel = 0.02", "assumed: grades are sold within +-2 to 3 %"),
        Spread("airgap_mm", "sigma = 0.02", "assumed: ground rotor and bore"),
        Spread("active_length_mm", "sigma = 0.1", "assumed: stack of sheets"),
    ),
}
# Of instruments of which no certificate is at hand, by the quantities that they read.
CALIBRATIONS: Final[dict[tuple[str, ...], Spread]] = {
    ("force", "re", "im", "damping"): Spread(
        "force_gain", 'sigma = 0.005, kind = "gain"', "assumed: load cell of class 0.5"
    ),
    ("torque",): Spread("torque_gain", 'sigma = 0.005, kind = "gain"', "assumed: torque cell of class 0.5"),
    ("voltage", "v_*"): Spread("voltage_gain", 'sigma = 0.005, kind = "gain"', "assumed: recorder and probes"),
    ("current", "i_*"): Spread("current_gain", 'sigma = 0.005, kind = "gain"', "assumed: clamps of class 0.5"),
    ("angle_mech",): Spread("encoder_zero_deg", 'sigma = 0.5, kind = "offset"', "assumed: zeroed by hand"),
}
# Zeros of cells drift by some share of the largest load: the quantity and the error of its zero.
ZEROS: Final[dict[str, str]] = {"force": "force_offset", "torque": "torque_offset"}
ZERO_DRIFT: Final = 0.001  # of the largest reading, assumed: load and torque cells of class 0.1 in their zero
