"""What every element of the machine sees over time, from a few field solutions and the symmetry of the machine.

In the stator the field repeats after one electrical period. A point of the rotor is different: after one period it
stands before other teeth, in the place of the magnet two poles on, so its own period is another one (12 slots, 10
poles: 5/6, it meets orders 1.2 and 2.4). The picture of the field in the machine repeats sooner than either,

    picture(t + T/parts) = sign * picture(t) turned by some slots        T: electrical period

and this alone turns the solutions of one part into the whole locus of every element, copied from element to element:

    stator:  b(y, t + T/parts) = sign * b(y - slots, t),     rotor:  b(x, t + T/parts) = sign * b(x + poles, t)

each vector in the frame of its own tooth or magnet.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from geometry.cross_section import CrossSection
from geometry.errors import GeometryError
from geometry.winding import WindingLayout
from magnetostatics.elements import Elements
from magnetostatics.model import FieldModel, FieldSolution, OperatingPoint

PHASES = 3


@dataclass(frozen=True)
class Repetition:
    """After 1/parts of an electrical period the picture returns turned by ``slots``, times ``sign``.

    poles: how many magnets further on, seen from the rotor, the earlier picture is found
    """

    parts: int
    slots: int
    poles: int
    sign: int

    def pitches(self, section: CrossSection) -> int:
        """The same in equal pitches of the rotor."""
        return self.poles * section.machine.repeats // section.machine.poles


WHOLE_PERIOD = Repetition(1, 0, 2, 1)
HALF_WAVE = Repetition(2, 0, 1, -1)  # north and south poles change places, and so do the currents


def finest_repetition(section: CrossSection) -> Repetition:
    """A sixth of the period where a turn by some slots exchanges the phases of the winding, else a half.

    Needs equal magnets, equal teeth and sinusoidal balanced currents; a machine with one odd magnet or an eccentric
    rotor repeats neither after a half nor after a whole electrical period. Where north and south poles are not alike
    only the whole period repeats.
    """
    machine = section.machine
    if not machine.half_wave:
        return WHOLE_PERIOD
    for slots in range(machine.slots):
        # a sixth of the period turns the rotor by a third of a pole pitch, the picture by slots: the rest in poles
        poles, rest = divmod(machine.slots - 3 * machine.poles * slots, 3 * machine.slots)
        sign = -1 if poles % 2 else 1
        if rest == 0 and _phases_exchange(section.layout, slots, sign):
            return Repetition(6, slots, poles % machine.poles, sign)
    return HALF_WAVE


def _phases_exchange(layout: WindingLayout, slots: int, sign: int) -> bool:
    """Whether the currents a sixth of a period later, i_k -> -i_(k+1), are those ``slots`` before, times sign."""
    for slot in range(layout.slots):
        for side in ("R", "L"):
            (now, direction), (before, other) = layout.coil_side(slot, side), layout.coil_side(slot - slots, side)
            if before != (now + 1) % PHASES or -direction != sign * other:
                return False
    return True


@dataclass(frozen=True, eq=False)
class PartOfPeriod:
    """Solutions at equally spaced angles over 1/parts of an electrical period, at one current."""

    solutions: tuple[FieldSolution, ...]
    repetition: Repetition

    def __post_init__(self) -> None:
        points = [solution.point for solution in self.solutions]
        machine = self.model.section.machine
        span = 2 * pi / machine.pole_pairs / self.repetition.parts
        wanted = points[0].angle + span * np.arange(len(points)) / len(points)
        if not np.allclose([point.angle for point in points], wanted, rtol=0, atol=1e-9 * span):
            raise ValueError(f"the angles must be equally spaced over {span:.6g} rad from the first, its end left out")
        balanced = [point for point in points if isinstance(point, OperatingPoint)]
        currents = {(point.current_density, point.current_angle, point.packing_factor) for point in balanced}
        if len(currents) > 1 or len(balanced) < len(points):
            raise ValueError("all solutions of a period must be at the same current, balanced and sinusoidal")

    @property
    def model(self) -> FieldModel:
        return self.solutions[0].model


def solve_part(
    model: FieldModel, point: OperatingPoint, steps: int = 48, repetition: Repetition | None = None
) -> PartOfPeriod:
    """Solve one part of an electrical period from the angle of ``point`` on.

    steps: per whole electrical period, a multiple of the parts; best a divisor of the edges of the sliding circle per
        period, so that every step is whole edges; harmonics up to steps/2 are seen
    repetition: None takes the finest that the winding has
    """
    repetition = repetition or finest_repetition(model.section)
    if steps % repetition.parts:
        raise ValueError(f"steps per period must be a multiple of {repetition.parts}, found {steps}")
    step = 2 * pi / model.section.machine.pole_pairs / steps
    solutions: list[FieldSolution] = []
    for k in range(steps // repetition.parts):
        here = OperatingPoint(point.angle + k * step, point.current_density, point.current_angle, point.packing_factor)
        solutions.append(model.solve(here, start=solutions[-1] if solutions else None))
    return PartOfPeriod(tuple(solutions), repetition)


@dataclass(frozen=True, eq=False)
class Loci:
    """A field quantity of some elements over one full period of what they see.

    elements: indices in the mesh of the sector (E,); area (E,) [m^2]
    values [T, or that of the quantity], (steps, E, components): equally spaced in time, the end of the period left out
    periods: number of electrical periods that the steps cover; sectors: sectors that make up the machine
    """

    elements: np.ndarray
    area: np.ndarray
    values: np.ndarray
    periods: float
    sectors: int

    def rate(self) -> np.ndarray:
        """d(values)/d(electrical periods) [as values], (steps, E, components), of all harmonics; times f it is d/dt."""
        steps = len(self.values)
        orders = np.fft.rfftfreq(steps, 1 / steps)
        if steps % 2 == 0:
            orders[-1] = 0.0  # the highest has no derivative of its own
        spectrum = np.fft.rfft(self.values, axis=0) * (2j * pi / self.periods * orders)[:, None, None]
        return np.fft.irfft(spectrum, steps, axis=0)

    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Orders of the electrical frequency, dimensionless, (H,), and peak amplitudes of values (H, E, components)."""
        steps = len(self.values)
        amplitude = 2 / steps * np.abs(np.fft.rfft(self.values, axis=0))
        amplitude[0] /= 2
        return np.arange(len(amplitude)) / self.periods, amplitude


def stator_loci(part: PartOfPeriod) -> Loci:
    """Mean B of every stator-iron element (steps, E, 2) [T], in the frame of its own tooth."""
    section = part.model.section
    return _iron_loci(part, "stator_iron", section.teeth, section.machine.slot_pitch, -part.repetition.slots)


def rotor_loci(part: PartOfPeriod) -> Loci:
    """Mean B of every rotor-iron element (steps, E, 2) [T], in the frame of its own pole; turns with the rotor."""
    section = part.model.section
    pitches, pitch = section.rotor_pitches, section.machine.rotor.pitch
    return _iron_loci(part, "rotor_iron", pitches, pitch, part.repetition.pitches(section))


def magnet_potential_loci(part: PartOfPeriod) -> tuple[Loci, ...]:
    """A at the quadrature points of every magnet (steps, E, Q) [Wb/m], seen from the rotor; one ``Loci`` a magnet, none
    for a rotor without magnets."""
    section = part.model.section
    if section.magnets == 0:
        return ()
    per_pitch = section.machine.rotor.magnets_per_pitch
    regions = [section.mesh.subdomains[f"magnet_{m}"] for m in range(section.magnets)]
    elements = part.model.elements.take(np.concatenate(regions))
    block = np.stack([_potential(elements, solution.a) for solution in part.solutions])
    block = block.reshape(len(block), section.magnets, -1, block.shape[-1])
    values, blocks = _extend(block, part.repetition.pitches(section) * per_pitch, part.repetition.sign, section.sign)
    area = elements.weights.sum(0).reshape(section.magnets, -1)
    periods = blocks / part.repetition.parts
    return tuple(Loci(regions[m], area[m], values[:, m], periods, section.sectors) for m in range(section.magnets))


def _potential(elements: Elements, a: np.ndarray) -> np.ndarray:
    """A at the quadrature points (E, Q)."""
    return np.einsum("iq,ie->eq", elements.order.values, a[elements.dofs])


def _iron_loci(part: PartOfPeriod, region: str, copies: int, pitch: float, shift: int) -> Loci:
    section = part.model.section
    which = section.mesh.subdomains[region]
    _check_copies(section.mesh.p[:, section.mesh.t[:, which]].mean(axis=1), copies, pitch, region)
    elements = part.model.elements.take(which)
    block = np.stack([_mean_flux_density(elements, solution.a) for solution in part.solutions])
    block = _in_own_frame(block.reshape(len(block), copies, -1, 2), pitch)
    values, blocks = _extend(block, shift, part.repetition.sign, section.sign)
    values = values.reshape(len(values), -1, 2)
    return Loci(which, elements.weights.sum(0), values, blocks / part.repetition.parts, section.sectors)


def _mean_flux_density(elements: Elements, a: np.ndarray) -> np.ndarray:
    """B = (dA/dy, -dA/dx), mean over each element (E, 2)."""
    x, y = elements.gradient(a)
    area = elements.weights.sum(0)
    return np.stack([(y * elements.weights).sum(0) / area, -(x * elements.weights).sum(0) / area], axis=-1)


def _check_copies(centres: np.ndarray, copies: int, pitch: float, region: str) -> None:
    """The elements must be listed copy by copy, each the one before turned by a pitch."""
    if centres.shape[1] % copies == 0:
        x, y = centres.reshape(2, copies, -1)
        turned = (x + 1j * y) * np.exp(-1j * pitch * np.arange(copies))[:, None]
        if np.abs(turned - turned[0]).max() < 1e-6 * np.abs(turned).max():
            return
    raise GeometryError(f"the mesh of {region} is not made of {copies} equal parts: build it with mesh_cross_section")


def _in_own_frame(vectors: np.ndarray, pitch: float) -> np.ndarray:
    """Vectors (steps, copies, E, 2) of copy c turned back by c pitches."""
    angle = pitch * np.arange(vectors.shape[1])[:, None]
    c, s = np.cos(angle), np.sin(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x + s * y, c * y - s * x], axis=-1)


def _extend(block: np.ndarray, shift: int, sign: int, sector_sign: int) -> tuple[np.ndarray, int]:
    """Repeat a block (steps, copies, ...) with its copies exchanged until every copy is back; (values, blocks).

    Block n of copy c is sign^n times copy c + n shift; a copy beyond the sector's end is one inside times its sign.
    """
    copies = block.shape[1]
    blocks = [block]
    while True:
        sectors, index = np.divmod(np.arange(copies) + len(blocks) * shift, copies)
        signs = float(sign) ** len(blocks) * np.where(sectors % 2, sector_sign, 1)
        if index[0] == 0 and signs[0] == 1:
            return np.concatenate(blocks), len(blocks)
        blocks.append(block[:, index] * signs.reshape((1, -1) + (1,) * (block.ndim - 2)))
